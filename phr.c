/* phr: parallel hierarchical radiosity.
 *
 * This file is the algorithm: compute_light() below is the outline of the paper's Sec. 3.2, its
 * eight steps as eight calls. Around it stand reading on rank 0, stored snapshot, pictures and
 * reports. Errors of the user or the system are values (geom/error.h) on which all ranks agree after
 * each phase; rank 0 prints them once and all ranks leave with the same exit code. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/hash.h"
#include "geom/stop.h"
#include "io/scene/camera.h"
#include "io/picture/image.h"
#include "io/picture/mesh.h"
#include "io/picture/render.h"
#include "io/picture/viewpoint.h"
#include "io/run/machine.h"
#include "io/run/options.h"
#include "io/run/output.h"
#include "io/run/progress.h"
#include "io/run/stats.h"
#include "io/run/store.h"
#include "io/scene/obj.h"
#include "io/scene/ply.h"
#include "mpi/broadcast.h"
#include "mpi/beyond/keep.h"
#include "mpi/memory.h"
#include "mpi/picture.h"
#include "mpi/signals.h"
#include "mpi/beyond/beyond.h"
#include "tools/pairs.h"
#include "tools/table.h"
#include "tools/validate.h"

struct run {
    struct comm comm;
    struct options options;
    struct scene *scene;
    struct camera camera;
    struct octree *octree;
    struct node_block block; /* what scene and octree look into */
    struct solver *solver;
    bool half_linked; /* linking has ended at the memory limit */
    struct vote vote; /* of the last iteration */
    struct stats stats;
    struct progress_view progress; /* on rank 0, unless --quiet */
    const char *kept; /* path of the last checkpoint made or read, NULL: there is none */
    struct error error;
    double start; /* comm_seconds() at the beginning */
};

/* A line on stderr from rank 0, unless --quiet. */
#ifdef __GNUC__
__attribute__((format(printf, 2, 3)))
#endif
static void say(struct run *run, const char *format, ...)
{
    if (run->comm.rank != 0 || run->options.quiet)
        return;
    progress_view_clear(&run->progress);
    va_list arguments;
    va_start(arguments, format);
    fputs("phr: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
}

/* --- errors and signals --- */

/* Says why the run ends here. */
static bool stopped(struct run *run, int signal)
{
    const char *path = run->kept;
    return error_set(&run->error, EXIT_FAILED, "stopped by %s%s%s", signals_name(signal),
                     path ? "; go on with --resume " : "", path ? path : "");
}

/* Collective. All ranks end with the error of one of them, if one has got any. On a rank
 * that is asked to stop, an error comes from that. */
static bool agree(struct run *run)
{
    if (run->error.code != EXIT_DONE && signals_seen() != 0) {
        run->error = (struct error){.code = EXIT_DONE};
        stopped(run, signals_seen());
    }
    return comm_agree(&run->comm, &run->error);
}

/* Collective. The end of a phase that breaks off when it is asked to: false if it was,
 * on any rank. */
static bool goes_on_from_phase(struct run *run)
{
    stop_check(&run->error);
    return agree(run);
}

/* --- reading, on rank 0 --- */

static void warn_repairs(struct run *run, const struct obj_repairs *read,
                         const struct scene_repairs *prepared)
{
    const char *path = run->options.scene;
    if (read->libraries.count > 0)
        say(run, "%s: warning: %lld material file(s) missing (first: %s)", path,
            (long long)read->libraries.count, read->libraries.first);
    if (read->materials.count > 0)
        say(run, "%s: warning: %lld material(s) without a definition, taken as grey (first: %s)",
            path, (long long)read->materials.count, read->materials.first);
    if (read->transparent > 0)
        say(run, "%s: warning: %lld transparent material(s) (d or Tr), taken as opaque", path,
            (long long)read->transparent);
    if (read->textured > 0)
        say(run, "%s: warning: %lld material(s) with a texture, which is not read: Kd counts, or grey",
            path, (long long)read->textured);
    if (read->bad_normals > 0)
        say(run, "%s: warning: %lld corner(s) with a vn that is no direction, or not there: ignored",
            path, (long long)read->bad_normals);
    if (read->unknown_lines > 0)
        say(run, "%s: warning: %lld line(s) with unknown keywords passed over (first: line %ld)",
            path, (long long)read->unknown_lines, read->first_unknown);
    if (prepared->clamped > 0)
        say(run, "%s: warning: %lld material(s) with a reflectance of 1 or more, set to 0.999",
            path, (long long)prepared->clamped);
    if (prepared->degenerate > 0)
        say(run, "%s: warning: %lld face(s) without area dropped", path,
            (long long)prepared->degenerate);
}

/* Emissions beyond these would leave the range of the float outputs. */
static const double EMISSION_MIN = 1e-30, EMISSION_MAX = 1e30;

static bool check_emission(const struct run *run, struct error *error)
{
    const struct scene *scene = run->scene;
    double largest = 0.0;
    for (int32_t i = 0; i < scene->input_count; i++)
        for (int c = 0; c < BANDS && scene->areas[i] > 0.0; c++)
            largest = fmax(largest, scene_root_material(scene, i)->emission.band[c]);
    if (!(largest > 0.0))
        return error_set(error, EXIT_USAGE,
                         "%s: nothing emits light (no face with Ke or emission_r above 0)",
                         run->options.scene);
    if (largest < EMISSION_MIN || largest > EMISSION_MAX)
        return error_set(error, EXIT_USAGE, "%s: the largest Ke, %g, is not within %g and %g",
                         run->options.scene, largest, EMISSION_MIN, EMISSION_MAX);
    return true;
}

static bool check_groups(const struct run *run, struct error *error)
{
    if (run->scene->group_count > VIEWFACTOR_GROUPS_MAX)
        return error_set(error, EXIT_USAGE, "%s: %lld groups are more than %d", run->options.scene,
                         (long long)run->scene->group_count, VIEWFACTOR_GROUPS_MAX);
    return true;
}

static bool read_scene(struct run *run)
{
    struct error *error = &run->error;
    struct obj_repairs read = {0};
    struct scene_repairs prepared = {0};
    const char *path = run->options.scene;
    run->scene = ply_is_meant(path) ? ply_read(path, error) : obj_read(path, &read, error);
    if (!run->scene || !stop_check(error))
        return false;
    run->scene->two_sided = run->options.two_sided;
    run->scene->two_sided_lamps = run->options.two_sided_lamps;
    struct error wrong = {0};
    if (!scene_prepare(run->scene, &prepared, &wrong))
        return error_set(error, wrong.code, "%s: %s", run->options.scene, wrong.text);
    warn_repairs(run, &read, &prepared);
    return run->options.form_factors ? check_groups(run, error) : check_emission(run, error);
}

/* The view file, if there is one. */
static bool read_camera(struct run *run)
{
    const struct options *options = &run->options;
    if (options->view && !camera_read(options->view, &run->camera, &run->error))
        return false;
    if (options->width > 0 || !options->view) {
        run->camera.width = options->width > 0 ? options->width : CAMERA_SIZE;
        run->camera.height = options->width > 0 ? options->height : CAMERA_SIZE;
    }
    return true;
}

static bool probe_outputs(struct run *run)
{
    const struct options *options = &run->options;
    const char *others[] = {options->stats, options->save_links, options->checkpoint};
    for (int i = 0; i < options->output_count; i++)
        if (!output_probe(options->outputs[i], &run->error))
            return false;
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
        if (others[i] && !output_probe(others[i], &run->error))
            return false;
    return true;
}

static void read_input(struct run *run)
{
    signals_end_calls(true);
    if (read_scene(run) && read_camera(run))
        probe_outputs(run);
    signals_end_calls(false);
}

/* Collective. Step 1: rank 0 reads, all agree on errors, all receive the scene. */
static bool read_and_broadcast(struct run *run)
{
    if (run->comm.rank == 0)
        read_input(run);
    if (!agree(run))
        return false;
    run->block = scene_broadcast(&run->comm, node_policy(), &run->scene, &run->octree);
    comm_broadcast(&run->comm, &run->camera, sizeof run->camera);
    if (run->block.shared && run->options.verbose)
        say(run, "one copy of scene and octree for %d ranks, %.1f MB", run->block.node.size,
            1e-6 * (double)run->block.bytes);
    return goes_on_from_phase(run);
}

/* --- stored snapshot --- */

static struct store_terms terms_of(const struct run *run, enum store_kind kind)
{
    const struct options *options = &run->options;
    return (struct store_terms){
        .kind = kind,
        .settings = kind == STORE_LINKS ? options_link_settings(options)
                                        : options_run_settings(options),
        .scene = run->scene,
        .tree = run->solver->beyond->tree,
    };
}

static void put_links(void *context, const struct link *links, int64_t count)
{
    store_put_links(context, links, count);
}

/* Collective. */
static bool save_snapshot(struct run *run, enum store_kind kind, const char *path)
{
    double start = comm_seconds();
    struct store_terms terms = terms_of(run, kind);
    struct store_writer writer;
    struct snapshot snapshot;
    snapshot_collect(run->solver, &run->vote, &snapshot);
    if (run->comm.rank == 0)
        store_create(&writer, path, &terms, &snapshot, &run->error);
    snapshot_free(&snapshot);
    if (!comm_agree(&run->comm, &run->error))
        return false;
    links_collect(run->solver, put_links, &writer);
    if (run->comm.rank == 0)
        store_finish(&writer, &run->error);
    run->solver->account.seconds[PHASE_WRITE] += comm_seconds() - start;
    bool good = comm_agree(&run->comm, &run->error);
    if (good && kind == STORE_CHECKPOINT)
        run->kept = path;
    return good;
}

/* Collective. Deals the links of an open file. */
static bool load_links(struct run *run, struct store_reader *reader, const int32_t *order,
                       int64_t count)
{
    enum { BLOCK = 65536 };
    struct link *block = alloc_array(BLOCK, sizeof *block);
    bool good = true;
    for (int64_t left = count; left > 0 && good; left -= BLOCK) {
        int64_t now = left < BLOCK ? left : BLOCK;
        if (run->comm.rank == 0)
            store_get_links(reader, block, now, &run->error);
        good = agree(run);
        if (good)
            links_deal(run->solver, order, block, now);
    }
    alloc_free(block);
    return good;
}

/* Collective, before homes are assigned. */
static bool load_snapshot(struct run *run, enum store_kind kind, const char *path)
{
    double start = comm_seconds();
    struct store_terms terms = terms_of(run, kind);
    struct store_reader reader = {0};
    if (run->comm.rank == 0)
        store_open(&reader, path, &terms, &run->error);
    bool good = agree(run);
    if (good) {
        int32_t *order = snapshot_restore(run->solver, &run->vote, &reader.snapshot);
        good = load_links(run, &reader, order, reader.snapshot.link_count);
        alloc_free(order);
    }
    if (good && kind == STORE_CHECKPOINT)
        run->kept = path;
    if (good)
        say(run, "%s: %lld links after %lld passes, %.1f s", path,
            (long long)reader.snapshot.link_count, (long long)run->solver->turn.pass,
            comm_seconds() - run->start);
    store_close(&reader);
    run->solver->account.seconds[PHASE_LINKING] += comm_seconds() - start;
    return good;
}

/* --- the algorithm --- */

/* What a rank has done of a level. */
static void report_share(struct run *run, int rank, const struct level_share *share)
{
    say(run, "  rank %d: load %lld, sent %lld links, received %lld; work predicted %lld, done %lld",
        rank, (long long)share->load, (long long)share->sent, (long long)share->received,
        (long long)share->predicted, (long long)share->done);
}

/* Collective. With --verbose, the levels of refinement since `first`. */
static void report_levels(struct run *run, int64_t first)
{
    if (run->options.verbose)
        ledger_share(&run->solver->account.ledger, &run->comm);
    for (int64_t i = first; i < run->solver->account.ledger.level_count && run->options.verbose; i++) {
        const struct level_balance *level = &run->solver->account.ledger.levels[i];
        say(run, "pass %lld, level %lld: %lld links split, most work %.3f of the mean",
            (long long)level->iteration, (long long)level->level, (long long)level->links,
            level->work_mean > 0.0 ? level->work_max / level->work_mean : 1.0);
        for (int r = 0; r < run->comm.size && run->comm.size > 1; r++)
            report_share(run, r, &level->shares[r]);
    }
}

static void report_iteration(struct run *run)
{
    const struct vote *vote = &run->vote;
    char bound[48] = "no bound yet on the remaining error";
    if (vote->remaining < HUGE_VAL)
        snprintf(bound, sizeof bound, "remaining error at most %.2g", vote->remaining);
    say(run, "iteration %lld: %lld links (%lld split), %s", (long long)run->solver->turn.iteration,
        (long long)vote->links, (long long)vote->split, bound);
}

/* With --accuracy, the error of a round. */
static void report_round(struct run *run)
{
    const struct gathered *gathered = &run->solver->beyond->answer.counts;
    if (gathered->checked > 0)
        say(run, "round %lld: error %.2g %% (rays %.2g %%, mesh %.2g %%), by %lld paths",
            (long long)run->solver->beyond->accuracy.rounds, 100.0 * gathered->error,
            100.0 * gathered->by_rays, 100.0 * gathered->by_mesh, (long long)gathered->paths);
}

/* How far the iterations have brought the bound on the remaining error from `first` down to the
 * tolerance: each takes off about the same part of it. */
static double share_solved(const struct run *run, double first)
{
    double tolerance = run->options.criterion.tolerance, now = run->vote.remaining;
    bool known = tolerance > 0.0 && now > tolerance && now < first && first < HUGE_VAL;
    return known ? log(first / now) / log(first / tolerance) : 0.0;
}

/* What each rank is going to hold before there are links; a cluster has two children at least. */
static void say_forecast(struct run *run)
{
    int64_t roots = scene_root_count(run->scene);
    struct memory memory = {.copies = 1};
    memory.clusters = run->options.criterion.linking == LINKING_TREE ? roots / 2 : 0;
    if (run->options.verbose)
        say(run, "%lld roots and some %lld clusters: %.1f MB on each rank before there are links",
            (long long)roots, (long long)memory.clusters,
            1e-6 * (double)memory_needed(&memory, 1, 0, roots));
}

/* Collective. Steps 2 and 3 of the paper's Sec. 3.2, or what a file holds in their place. */
static bool start_light(struct run *run)
{
    const struct options *options = &run->options;
    say_forecast(run);
    struct solver *solver = beyond_create(&run->comm, run->scene, run->octree,
                                          &options->criterion);
    run->solver = solver;
    memory_watch(solver, options->memory, machine_memory());
    solver->account.seconds[PHASE_READ] = comm_seconds() - run->start;
    solver->account.seconds[PHASE_OCTREE] = run->block.seconds;
    solver->progress = &run->progress.progress;
    if (options->load_links || options->resume) {
        enum store_kind kind = options->resume ? STORE_CHECKPOINT : STORE_LINKS;
        if (!load_snapshot(run, kind, options->resume ? options->resume : options->load_links))
            return false;
        solver_assign_roots(solver);
        return true;
    }
    progress_begin(solver->progress, "linking", -1, 0);
    say(run, "%s: %lld triangles; linking", options->scene, (long long)run->scene->input_count);
    run->half_linked = !solver_link_roots(solver); /* 2: initial linking */
    if (solver->turn.stop)
        return error_set(&run->error, EXIT_FAILED, "stopped by %s",
                         signals_name(solver->turn.stop));
    solver_assign_roots(solver);                   /* 3: re-assignment */
    if (run->half_linked && options->save_links)
        return error_set(&run->error, EXIT_FAILED,
                         "%s: not written: linking ended at the memory limit",
                         options->save_links);
    if (!solver->beyond->tree)
        say(run, "roots are linked, %.1f s", comm_seconds() - run->start);
    return !options->save_links || save_snapshot(run, STORE_LINKS, options->save_links);
}

/* True if there is another iteration over the same links. A signal ends them, unless
 * there is to be a checkpoint: that is of a whole pass, and without it the refinement
 * would be lost. */
static bool iterates(const struct run *run)
{
    return run->vote.again && (!run->solver->turn.stop || run->options.checkpoint);
}

/* Collective. Steps 5 to 8, until there is no other iteration. */
static void solve_pass(struct run *run)
{
    struct solver *solver = run->solver;
    double first = HUGE_VAL; /* bound on the remaining error */
    progress_begin(solver->progress, "solving", -1, 0);
    do {
        solver_gather(solver);           /* 5: light goes over links, and home */
        solver_push_pull(solver);        /* 6: push-pull on own roots */
        solver_scatter(solver);          /* 7: proxies are renewed */
        run->vote = solver_vote(solver); /* 8: is there another iteration? */
        first = first < HUGE_VAL ? first : run->vote.remaining;
        progress_tick(solver->progress, share_solved(run, first));
    } while (iterates(run));
}

/* Collective. True if there is another pass. */
static bool goes_on(struct run *run)
{
    struct solver *solver = run->solver;
    const struct vote *vote = &run->vote;
    if (solver->turn.stop || vote->diverged)
        return false;
    return !vote->converged && solver->turn.iteration < run->options.criterion.max_iterations;
}

/* True if the state of a whole pass is worth a checkpoint. */
static bool is_due(const struct run *run)
{
    const struct options *options = &run->options;
    const struct vote *vote = &run->vote;
    if (!options->checkpoint || run->half_linked || vote->unfinished || vote->diverged)
        return false;
    return run->solver->turn.pass % options->every == 0 || run->solver->turn.stop || vote->converged ||
           run->solver->turn.iteration >= options->criterion.max_iterations;
}

/* Collective. Steps 4 to 8, until the light over the links has converged, or has to do. */
static bool converge_links(struct run *run)
{
    while (goes_on(run)) {
        int64_t levels = run->solver->account.ledger.level_count;
        if (!solver_refine(run->solver)) /* 4: evaluate and refine, level by level */
            break;                       /* a signal: this pass is lost */
        solve_pass(run);
        report_levels(run, levels);
        report_iteration(run);
        if (is_due(run) && !save_snapshot(run, STORE_CHECKPOINT, run->options.checkpoint))
            return false;
    }
    return !run->vote.diverged ||
           error_set(&run->error, EXIT_FAILED,
                     "the solution diverges: surfaces reflect more light than they receive");
}

/* Collective. Steps 2 to 9. */
static bool compute_light(struct run *run)
{
    enum finish finish = FINISH_AGAIN;
    if (!start_light(run))
        return false;
    while (finish == FINISH_AGAIN) {
        if (!converge_links(run))
            return false;
        if (run->solver->turn.stop)
            return stopped(run, run->solver->turn.stop);
        finish = solver_finish(run->solver, &run->vote); /* 9: what leaves really see */
        report_round(run);
    }
    return finish == FINISH_DONE || goes_on_from_phase(run);
}

/* --- results --- */

/* The tone of 8-bit colours: --exposure, or chosen from the picture, or from the leaves. */
static struct tone choose_tone(const struct run *run, const float *picture)
{
    if (run->options.exposure > 0.0)
        return tone_make(run->options.exposure);
    if (picture)
        return tone_make(tone_automatic(picture, (int64_t)run->camera.width * run->camera.height));
    int64_t count;
    float *colours = mesh_colours(run->solver->model.forest, &count);
    struct tone tone = tone_make(tone_automatic(colours, count));
    alloc_free(colours);
    return tone;
}

/* Rank 0 only. */
static void write_outputs(struct run *run, const struct shading *shading, float *picture)
{
    struct tone tone = choose_tone(run, picture);
    struct image image = {run->camera.width, run->camera.height, picture};
    for (int i = 0; i < run->options.output_count; i++) {
        const char *path = run->options.outputs[i];
        switch (output_format_of(path)) {
        case FORMAT_PPM: ppm_write(&image, &tone, path, &run->error); break;
        case FORMAT_PFM: pfm_write(&image, path, &run->error); break;
        case FORMAT_PLY: mesh_write(shading, &tone, run->solver->beyond->answer.error, path, &run->error); break;
        }
    }
}

/* True if a mesh, or else a picture, is among the outputs. */
static bool wants(const struct options *options, bool mesh)
{
    for (int i = 0; i < options->output_count; i++)
        if ((output_format_of(options->outputs[i]) == FORMAT_PLY) == mesh)
            return true;
    return false;
}

/* Collective. How far leaves are covered: each rank looks at some of them. NULL: all show their
 * constants. */
static uint8_t *survey_leaves(struct run *run)
{
    if (run->options.flat)
        return NULL;
    int64_t leaves;
    uint8_t *open = shading_open_quarters(run->solver->model.forest, run->octree, run->comm.rank,
                                          run->comm.size, &leaves);
    comm_add_bytes(&run->comm, open, leaves);
    return open;
}

/* All leaves, less some of their radiosity, or NULL. */
static struct shading *shade_leaves(struct run *run, const struct rgb *less, const uint8_t *open)
{
    double start = comm_seconds();
    struct shading *shading = shading_create(run->solver->model.forest, less, open);
    run->solver->account.seconds[PHASE_SHADING] += comm_seconds() - start;
    return shading;
}

static void place_camera(struct run *run)
{
    struct camera *camera = &run->camera;
    double start = comm_seconds();
    if (!run->options.view) /* all ranks choose alike */
        *camera = viewpoint_choose(run->scene, run->octree, run->solver->model.forest,
                                   camera->width, camera->height);
    run->solver->account.seconds[PHASE_VIEWPOINT] = comm_seconds() - start;
}

/* Collective. The picture of the camera, on rank 0; NULL on the others. Rays that it takes are no
 * part of the solution's. */
static float *make_picture(struct run *run, const uint8_t *open)
{
    const struct comm *comm = &run->comm;
    struct model *model = &run->solver->model;
    struct octree_counts counts = model->counts;
    int64_t estimating = model->estimating;
    place_camera(run);
    bool gathers = run->solver->beyond->answer.straight && !run->options.flat;
    struct shading *shading = NULL;
    if (!run->options.pixels)
        shading = shade_leaves(run, gathers ? run->solver->beyond->answer.straight : NULL, open);
    struct renderer renderer =
        renderer_make(run->octree, shading, gathers ? &run->solver->beyond->answer.gather : NULL);
    run->solver->beyond->answer.gather.counts = (struct gather_counts){.rays = 0};
    progress_begin(&run->progress.progress, "rendering", -1, 0);
    float *rows = render_rows(&renderer, &run->camera, run->options.samples, comm->rank,
                              comm->size, &run->progress.progress);
    float *picture = picture_gather(comm, rows, 3 * (size_t)run->camera.width,
                                    run->camera.height);
    run->solver->beyond->answer.counts.pixels =
        run->solver->beyond->answer.gather.counts.rays + run->solver->beyond->answer.gather.counts.segments;
    comm_add(comm, &run->solver->beyond->answer.counts.pixels, 1);
    model->counts = counts;
    model->estimating = estimating;
    shading_destroy(shading);
    alloc_free(rows);
    return picture;
}

/* Collective. Renders by rows and writes. */
static bool show_results(struct run *run)
{
    double start = comm_seconds();
    if (run->options.output_count == 0)
        return true;
    uint8_t *open = survey_leaves(run);
    float *picture = wants(&run->options, false) ? make_picture(run, open) : NULL;
    struct shading *shading = wants(&run->options, true) ? shade_leaves(run, NULL, open) : NULL;
    run->solver->account.seconds[PHASE_RENDER] = comm_seconds() - start;
    start = comm_seconds();
    if (goes_on_from_phase(run) && run->comm.rank == 0)
        write_outputs(run, shading, picture);
    alloc_free(picture);
    alloc_free(open);
    shading_destroy(shading);
    run->solver->account.seconds[PHASE_WRITE] += comm_seconds() - start;
    return agree(run);
}

/* Parts of the light by which more may be absorbed than is emitted, and by which a closed scene may
 * be off its balance, before it is said. */
static const double ABSORBED_TOO_MUCH = 0.01, OFF_BALANCE = 0.05;

static void warn_balance(struct run *run)
{
    const struct stats *stats = &run->stats;
    double much = stats->absorbed_power / stats->emitted_power - 1.0;
    if (much > ABSORBED_TOO_MUCH)
        say(run,
            "warning: %.3g %% more light is absorbed than emitted: faces may lie on each other or be "
            "there twice, or --epsilon is too large",
            100.0 * much);
    else if (stats->gathered.closing > OFF_BALANCE)
        say(run,
            "warning: light of this closed scene was off its balance by %.3g %%, which is made up "
            "for: --epsilon is too large, rays are too few, or faces lie on each other",
            100.0 * stats->gathered.closing);
}

/* What keeps --accuracy from being reached, in the order of enum hold. */
static const char *const HOLDS[] = {
    "", "--max-level is in the way", "--min-area is in the way",
    "the memory limit is in the way", "--max-iterations is in the way",
    "leaves cannot have more rays", "a smaller epsilon no longer helps", "too many rounds",
    "paths do not tell it well enough"};

/* Collective. The summary and --stats. */
static bool report_run(struct run *run)
{
    run->solver->account.seconds[PHASE_TOTAL] = comm_seconds() - run->start;
    solver_report(run->solver, &run->vote, &run->stats);
    run->stats.bytes_broadcast = (int64_t)(run->block.bytes + run->solver->beyond->tree_block.bytes);
    progress_view_clear(&run->progress);
    if (run->comm.rank == 0) {
        if (run->stats.memory_limited)
            say(run,
                "warning: %s ended at the memory limit of %lld bytes, with %lld links%s",
                run->half_linked ? "linking" : "refinement",
                (long long)run->solver->memory.limit, (long long)run->stats.links,
                run->half_linked ? ": light is missing" : "");
        else if (!run->vote.converged)
            say(run, "warning: not converged after %lld iterations",
                (long long)run->stats.iterations);
        if (run->stats.hold != HOLD_NONE)
            say(run, "warning: the error is %.2g %%, not the %.3g %% of --accuracy: %s",
                100.0 * run->stats.error_estimate, 100.0 * run->stats.accuracy,
                HOLDS[run->stats.hold]);
        warn_balance(run);
        if (!run->options.quiet)
            stats_print(&run->stats, stdout);
        if (run->options.stats)
            stats_write(&run->stats, run->options.stats, &run->error);
    }
    return comm_agree(&run->comm, &run->error);
}

static void run_all(struct run *run)
{
    if (!read_and_broadcast(run) || !compute_light(run))
        return;
    solver_measure_closure(run->solver, &run->stats);
    if (show_results(run))
        report_run(run);
}

/* Collective. --form-factors: exchanges between groups in place of light. */
static void tabulate_factors(struct run *run)
{
    const struct criterion *criterion = &run->options.criterion;
    if (!read_and_broadcast(run))
        return;
    say(run, "%s: %lld triangles in %lld groups", run->options.scene,
        (long long)run->scene->input_count, (long long)run->scene->group_count);
    struct viewfactors *factors = viewfactors_create(run->scene, run->octree, criterion->epsilon,
                                                     criterion->max_level);
    progress_begin(&run->progress.progress, "form factors", -1, 0);
    pairs_add(&run->comm, factors, &run->progress.progress);
    progress_view_clear(&run->progress);
    if (goes_on_from_phase(run) && run->comm.rank == 0) {
        table_print(factors, stdout);
        stop_check(&run->error);
    }
    if (agree(run))
        say(run, "%.1f s", comm_seconds() - run->start);
    viewfactors_destroy(factors);
}

static void release(struct run *run)
{
    solver_destroy(run->solver);
    octree_destroy(run->octree);
    scene_destroy(run->scene);
    node_block_destroy(&run->block);
    options_free(&run->options);
}

/* Collective. True if all ranks have the arguments of rank 0: they decide alike from here on. */
static bool check_arguments(struct run *run, int argc, char **argv)
{
    uint64_t own = HASH_START, first;
    for (int i = 1; i < argc; i++)
        own = hash_bytes(own, argv[i], strlen(argv[i]) + 1);
    first = own;
    comm_broadcast(&run->comm, &first, sizeof first);
    if (own != first)
        error_set(&run->error, EXIT_USAGE, "the ranks have different arguments");
    return comm_agree(&run->comm, &run->error);
}

int main(int argc, char **argv)
{
    struct run run = {0};
    comm_start(&run.comm, &argc, &argv);
    run.start = comm_seconds();
    signals_catch();
    bool parsed = check_arguments(&run, argc, argv) &&
                  options_parse(&run.options, argc, argv, &run.error);
    if (run.comm.rank == 0 && !run.options.quiet)
        progress_view_open(&run.progress, comm_seconds);
    if (parsed && (run.options.help || run.options.version)) {
        if (run.comm.rank == 0 && run.options.help)
            options_print_help(stdout);
        else if (run.comm.rank == 0)
            printf("phr %s (%s build), MIT licence\n", PHR_VERSION, comm_build());
    } else if (parsed && run.options.validate) {
        if (run.comm.rank == 0 && !validate_print(stdout))
            error_set(&run.error, EXIT_FAILED, "form factors are worse than stated");
    } else if (parsed && run.options.form_factors) {
        tabulate_factors(&run);
    } else if (parsed) {
        run_all(&run);
    }
    if (run.comm.rank == 0 && (fflush(stdout) != 0 || ferror(stdout)))
        error_set(&run.error, EXIT_FAILED, "cannot write to the standard output");
    comm_agree(&run.comm, &run.error);
    progress_view_clear(&run.progress);
    if (run.error.code != EXIT_DONE && run.comm.rank == 0)
        fprintf(stderr, "phr: %s\n", run.error.text);
    release(&run);
    comm_stop(&run.comm);
    if (alloc_balance() != 0) {
        fprintf(stderr, "phr: BUG: %lld blocks of memory were not freed\n",
                (long long)alloc_balance());
        return EXIT_FAILED;
    }
    return run.error.code;
}
