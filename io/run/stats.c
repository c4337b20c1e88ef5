/* Reporting a run. Keys of the JSON stand in one order, one a line, for comparison with
 * diff. Times and memory depend on the machine; "balance", "proxies", "patches_at_home",
 * "work", "exchanges", "messages" and "bytes" depend on the number of ranks alone. */
#include "io/run/stats.h"

#include <inttypes.h>
#include <string.h>

#include "io/run/options.h"
#include "io/run/output.h"

static const char *const PHASE_NAMES[PHASE_COUNT] = {
    "total",     "read",        "linking",   "refinement", "idle",
    "migration", "gather",      "push_pull", "scatter",    "solve",
    "render",    "write",       "octree",    "spaces",     "tree",
    "prepare",   "looks",       "sums",      "routes",     "final_gather",
    "rows",      "products",    "spot_checks", "row_sums",  "shading",
    "viewpoint"};

/* In the order of enum hold. */
static const char *const HOLD_NAMES[] = {"none",    "level",      "area",
                                         "memory",  "iterations", "rays",
                                         "epsilon", "rounds",     "doubt",
                                         "nothing"};

static const char *const WORK_NAMES[WORK_COUNT] = {
    "linking", "looks", "splitting", "transfer", "own", "patches", "final_gather"};

void stats_print(const struct stats *stats, FILE *file)
{
    fprintf(file, "triangles   %" PRId64 " (%" PRId64 " roots)\n", stats->triangles,
            stats->roots);
    fprintf(file, "patches     %" PRId64 " (%" PRId64 " leaves)\n", stats->patches,
            stats->leaves);
    fprintf(file, "links       %" PRId64 " (%" PRId64 " rays)\n", stats->links,
            stats->rays);
    if (stats->gathered.rays + stats->gathered.exact > 0)
        fprintf(file,
                "gathered    %" PRId64 " rays, %" PRId64 " to lamps, %" PRId64
                " exact rows\n",
                stats->gathered.rays, stats->gathered.segments, stats->gathered.exact);
    fprintf(file, "iterations  %" PRId64 " (%s)\n", stats->iterations,
            stats->converged ? "converged" : "not converged");
    fprintf(file, "power       %.6g W emitted, %.6g W absorbed, %.6g W escaped",
            stats->emitted_power, stats->absorbed_power, stats->escaped_power);
    if (stats->touching_power > 0.0)
        fprintf(file, ", %.6g W where faces touch", stats->touching_power);
    fputc('\n', file);
    fprintf(file, "row sums    %.4f .. %.4f, mean %.4f (1 in a closed scene)\n",
            stats->row_sum_min, stats->row_sum_max, stats->row_sum_mean);
    if (stats->error_estimate > 0.0)
        fprintf(file, "error       %.2g %% RMS at the leaves, %s, at epsilon %.3g\n",
                100.0 * stats->error_estimate,
                stats->gathered.checked > 0 ? "measured" : "estimated", stats->epsilon);
    if (stats->gathered.error > 0.0)
        fprintf(file,
                "            %.2g %% of their own light in the median, a tenth exceeds "
                "%.3g %%\n",
                100.0 * stats->gathered.median, 100.0 * stats->gathered.worst_tenth);
    for (int64_t i = 0; i < stats->views; i++)
        if (stats->exposures[i] > 0.0)
            fprintf(file, "exposure    %.6g\n", stats->exposures[i]);
    fprintf(file, "checksum    %016" PRIx64 "\n", stats->checksum);
}

static void write_integer(FILE *file, const char *key, int64_t value)
{
    fprintf(file, "  \"%s\": %" PRId64 ",\n", key, value);
}

static void write_real(FILE *file, const char *key, double value)
{
    fprintf(file, "  \"%s\": %.17g,\n", key, value);
}

/* Writes the version, the scene and the settings. */
static void write_origin(FILE *file, const struct stats *stats)
{
    fprintf(file, "  \"version\": \"%s\",\n  \"format\": %d,\n", PHR_VERSION,
            PHR_FORMAT);
    fprintf(file,
            "  \"scene\": {\"name\": \"%s\", \"checksum\": \"%016" PRIx64 "\"},\n",
            stats->scene, stats->scene_checksum);
    fprintf(file, "  \"options\": [");
    for (const char *line = stats->options; *line; line = strchr(line, '\n') + 1)
        fprintf(file, "%s\"%.*s\"", line == stats->options ? "" : ", ",
                (int)strcspn(line, "\n"), line);
    fprintf(file, "],\n  \"exposures\": [");
    for (int64_t i = 0; i < stats->views; i++)
        fprintf(file, "%s%.17g", i ? ", " : "", stats->exposures[i]);
    fprintf(file, "],\n");
}

static void write_counts(FILE *file, const struct stats *stats)
{
    write_integer(file, "ranks", stats->ranks);
    write_integer(file, "triangles", stats->triangles);
    write_integer(file, "roots", stats->roots);
    write_integer(file, "patches", stats->patches);
    write_integer(file, "leaves", stats->leaves);
    write_integer(file, "links", stats->links);
    write_integer(file, "passes", stats->passes);
    write_integer(file, "iterations", stats->iterations);
    fprintf(file, "  \"converged\": %s,\n", stats->converged ? "true" : "false");
    write_integer(file, "clusters", stats->clusters);
    write_integer(file, "counted_bytes", stats->counted_bytes);
    write_integer(file, "memory_limit", stats->memory_limit);
    fprintf(file, "  \"memory_limited\": %s,\n",
            stats->memory_limited ? "true" : "false");
    write_real(file, "epsilon", stats->epsilon);
    write_real(file, "error_estimate", stats->error_estimate);
    fprintf(file,
            "  \"accuracy\": {\"goal\": %.17g, \"rounds\": %" PRId64
            ", \"leaves\": %" PRId64 ", \"paths\": %" PRId64 ", \"hold\": \"%s\"},\n",
            stats->accuracy, stats->rounds, stats->gathered.checked,
            stats->gathered.paths, HOLD_NAMES[stats->hold]);
    write_real(file, "emitted_power", stats->emitted_power);
    write_real(file, "absorbed_power", stats->absorbed_power);
    write_real(file, "escaped_power", stats->escaped_power);
    write_real(file, "touching_power", stats->touching_power);
    fprintf(file, "  \"checksum\": \"%016" PRIx64 "\",\n", stats->checksum);
    write_integer(file, "rays", stats->rays);
    write_integer(file, "node_tests", stats->node_tests);
    write_integer(file, "triangle_tests", stats->triangle_tests);
    fprintf(file,
            "  \"visibility\": {\"open\": %" PRId64 ", \"seen\": %" PRId64
            ", \"partly\": %" PRId64 ", \"unseen\": %" PRId64 ", \"walled_off\": %" PRId64
            ", \"rays_spared\": %" PRId64 "},\n",
            stats->links_of[0], stats->links_of[1], stats->links_of[2],
            stats->links_of[3], stats->walled_off, stats->rays_spared);
    fprintf(file,
            "  \"gathered\": {\"rays\": %" PRId64 ", \"segments\": %" PRId64
            ", \"exact\": %" PRId64 ", \"terms\": %" PRId64 ", \"looks\": %" PRId64
            ", \"split\": %" PRId64 ", \"pixels\": %" PRId64 ", \"closing\": %.17g"
            ", \"error\": %.17g, \"median\": %.17g, \"worst_tenth\": %.17g"
            ", \"by_rays\": %.17g, \"by_mesh\": %.17g},\n",
            stats->gathered.rays, stats->gathered.segments, stats->gathered.exact,
            stats->gathered.terms, stats->gathered.looks, stats->gathered.split,
            stats->gathered.pixels, stats->gathered.closing, stats->gathered.error,
            stats->gathered.median, stats->gathered.worst_tenth,
            stats->gathered.by_rays, stats->gathered.by_mesh);
    fprintf(file,
            "  \"closure\": {\"min\": %.17g, \"mean\": %.17g, \"max\": %.17g, \"rms\": "
            "%.17g},\n",
            stats->row_sum_min, stats->row_sum_mean, stats->row_sum_max,
            stats->row_sum_rms);
}

static void write_seconds(FILE *file, const struct stats *stats)
{
    fprintf(file, "  \"seconds\": {\n");
    for (int phase = 0; phase < PHASE_COUNT; phase++)
        fprintf(file, "    \"%s\": {\"min\": %.6f, \"mean\": %.6f, \"max\": %.6f}%s\n",
                PHASE_NAMES[phase], stats->seconds[phase].min, stats->seconds[phase].mean,
                stats->seconds[phase].max, phase + 1 < PHASE_COUNT ? "," : "");
    fprintf(file, "  },\n");
}

/* The fields of struct level_share. */
static const char *const SHARE_NAMES[] = {"split", "load", "predicted",
                                          "done",  "sent", "received"};

static int64_t share_field(const struct level_share *share, size_t field)
{
    const int64_t fields[] = {share->links, share->load, share->predicted,
                              share->done,  share->sent, share->received};
    return fields[field];
}

/* Writes one field of all ranks. */
static void write_shares(FILE *file, const struct stats *stats,
                         const struct level_balance *level, size_t field)
{
    fprintf(file, ",\n     \"%s\": [", SHARE_NAMES[field]);
    for (int64_t r = 0; r < stats->ranks; r++)
        fprintf(file, "%s%" PRId64, r ? ", " : "", share_field(&level->shares[r], field));
    fputc(']', file);
}

static void write_balance(FILE *file, const struct stats *stats)
{
    fprintf(file, "  \"balance\": [");
    for (int64_t i = 0; i < stats->level_count; i++) {
        const struct level_balance *level = &stats->levels[i];
        fprintf(file,
                "%s\n    {\"pass\": %" PRId64 ", \"level\": %" PRId64
                ", \"links\": %" PRId64
                ", \"predicted_max\": %.17g, \"predicted_mean\": %.17g"
                ", \"work_max\": %.17g, \"work_mean\": %.17g",
                i ? "," : "", level->pass, level->level, level->links,
                level->predicted_max, level->predicted_mean, level->work_max,
                level->work_mean);
        for (size_t field = 0; field < sizeof SHARE_NAMES / sizeof *SHARE_NAMES; field++)
            write_shares(file, stats, level, field);
        fputc('}', file);
    }
    fprintf(file, "%s],\n", stats->level_count ? "\n  " : "");
}

/* Writes what each rank holds, one list a field. */
static void write_holdings(FILE *file, const struct stats *stats)
{
    static const char *const NAMES[] = {"proxies", "patches_at_home",
                                        "peak_rss_bytes_each"};
    for (size_t field = 0; field < sizeof NAMES / sizeof *NAMES; field++) {
        fprintf(file, "  \"%s\": [", NAMES[field]);
        for (int64_t r = 0; r < stats->ranks; r++) {
            const struct holdings *own = &stats->holdings[r];
            const int64_t fields[] = {own->proxies, own->patches, own->memory};
            fprintf(file, "%s%" PRId64, r ? ", " : "", fields[field]);
        }
        fprintf(file, "],\n");
    }
}

static void write_work(FILE *file, const struct stats *stats)
{
    fprintf(file, "  \"work\": {\n");
    for (int kind = 0; kind < WORK_COUNT; kind++)
        fprintf(file,
                "    \"%s\": {\"phases\": %" PRId64 ", \"all\": %" PRId64
                ", \"slowest\": %" PRId64 ", \"bytes\": %" PRId64 "}%s\n",
                WORK_NAMES[kind], stats->work[kind].phases, stats->work[kind].all,
                stats->work[kind].slowest, stats->work[kind].bytes,
                kind + 1 < WORK_COUNT ? "," : "");
    fprintf(file, "  },\n");
    write_integer(file, "exchanges", stats->exchanges);
    write_integer(file, "messages", stats->messages);
    const int64_t *with = stats->messages_with;
    fprintf(file,
            "  \"messages_with\": {\"migration\": %" PRId64 ", \"gather\": %" PRId64
            ", \"scatter\": %" PRId64 ", \"whole\": %" PRId64 "},\n",
            with[CARGO_LINKS], with[CARGO_FLUX], with[CARGO_LIGHT], with[CARGO_WHOLE]);
}

bool stats_write(const struct stats *stats, const char *path, struct error *error)
{
    struct output output;
    if (!output_open(&output, path, error))
        return false;
    fprintf(output.file, "{\n");
    write_origin(output.file, stats);
    write_counts(output.file, stats);
    write_seconds(output.file, stats);
    write_balance(output.file, stats);
    write_holdings(output.file, stats);
    write_work(output.file, stats);
    fprintf(output.file,
            "  \"bytes\": {\"migration\": %" PRId64 ", \"gather\": %" PRId64
            ", \"scatter\": %" PRId64 ", \"whole\": %" PRId64 ", \"broadcast\": %" PRId64
            "},\n",
            stats->bytes_of[CARGO_LINKS], stats->bytes_of[CARGO_FLUX],
            stats->bytes_of[CARGO_LIGHT], stats->bytes_of[CARGO_WHOLE],
            stats->bytes_broadcast);
    int64_t most = 0, sum = 0;
    for (int64_t r = 0; r < stats->ranks; r++) {
        int64_t own = stats->holdings[r].memory;
        most = own > most ? own : most;
        sum += own;
    }
    write_integer(output.file, "peak_rss_bytes", most);
    fprintf(output.file, "  \"peak_rss_bytes_sum\": %" PRId64 "\n}\n", sum);
    return output_close(&output, error);
}
