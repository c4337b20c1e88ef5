/* Lines about a run: its progress, its warnings, its summary. */
#include "tools/report.h"

#include <math.h>
#include <stdio.h>

#include "io/run/files.h"
#include "io/run/stats.h"
#include "mpi/memory.h"
#include "tools/balance.h"

/* Prints the share of a rank in a level. */
static void report_share(struct run *run, int rank, const struct level_share *share)
{
    run_say(run,
            "  rank %d: load %lld, sent %lld links, received %lld; work predicted %lld, "
            "done %lld",
            rank, (long long)share->load, (long long)share->sent,
            (long long)share->received, (long long)share->predicted,
            (long long)share->done);
}

void report_levels(struct run *run, int64_t first)
{
    struct ledger *ledger = &run->solver->account.ledger;
    if (!run->options.verbose)
        return;
    ledger_share(ledger, &run->comm);
    for (int64_t i = first; i < ledger->level_count; i++) {
        const struct level_balance *level = &ledger->levels[i];
        run_say(run, "pass %lld, level %lld: %lld links %s, most work %.3f of the mean",
                (long long)level->pass, (long long)level->level,
                (long long)level->links, level->pass == 0 ? "made" : "split",
                level->work_mean > 0.0 ? level->work_max / level->work_mean : 1.0);
        for (int r = 0; r < run->comm.size && run->comm.size > 1; r++)
            report_share(run, r, &level->shares[r]);
    }
}

void report_iteration(struct run *run)
{
    const struct vote *vote = &run->vote;
    char bound[48] = "no bound yet on the remaining error";
    if (vote->remaining < HUGE_VAL)
        snprintf(bound, sizeof bound,
                 run->options.criterion.solver == SOLVER_JACOBI
                     ? "energy changed by %.2g" : "remaining error at most %.2g",
                 vote->remaining);
    run_say(run, "iteration %lld: %lld links (%lld split), %s",
            (long long)run->solver->turn.iteration, (long long)vote->links,
            (long long)vote->split, bound);
}

void report_round(struct run *run)
{
    const struct gathered *gathered = &beyond_answer(run->solver)->counts;
    if (gathered->checked > 0)
        run_say(run,
                "round %lld: error %.2g %% (rays %.2g %%, mesh %.2g %%), %.2g %% in the "
                "median, by %lld paths",
                (long long)run->solver->beyond->accuracy.rounds, 100.0 * gathered->error,
                100.0 * gathered->by_rays, 100.0 * gathered->by_mesh,
                100.0 * gathered->median, (long long)gathered->paths);
}

/* Each iteration reduces the bound on the remaining error by about the same factor. */
void report_solving(struct run *run)
{
    double tolerance = run->options.criterion.tolerance, now = run->vote.remaining;
    if (!(run->first_bound < HUGE_VAL))
        run->first_bound = now;
    double first = run->first_bound;
    bool known = tolerance > 0.0 && now > tolerance && now < first && first < HUGE_VAL;
    progress_tick(run->solver->progress,
                  known ? log(first / now) / log(first / tolerance) : 0.0);
}

/* A cluster has two children or more: there are at most half as many as roots. */
void report_memory(struct run *run)
{
    int64_t roots = scene_root_count(run->scene), limit = run->solver->memory.limit;
    if (run->options.memory > 0 && run->options.memory < limit)
        run_say(run,
                "warning: the scene takes more than --memory: the limit is %lld bytes, "
                "an eighth more than the scene takes before there are links",
                (long long)limit);
    struct memory memory = {.copies = 1};
    memory.clusters = run->options.criterion.linking == LINKING_TREE ? roots / 2 : 0;
    if (run->options.verbose)
        run_say(run,
                "%lld roots and some %lld clusters: "
                "%.1f MB on each rank before there are links",
                (long long)roots, (long long)memory.clusters,
                1e-6 * (double)memory_needed(&memory, 1, 0, roots));
}

/* Reasons why --accuracy was not reached, in the order of enum hold. */
static const char *const HOLDS[] = {
    "", "--max-level is in the way", "--min-area is in the way",
    "the memory limit is in the way", "--max-iterations is in the way",
    "leaves cannot have more rays", "a smaller epsilon no longer helps",
    "too many rounds", "paths do not tell it well enough", ""};

/* Of a stored solution, which has no links, powers or times. */
static void print_stored(struct run *run)
{
    const struct forest *forest = run->solver->model.forest;
    progress_view_clear(&run->progress);
    if (run->comm.rank == 0 && !run->options.quiet)
        printf("stored      %lld patches (%lld leaves) of %lld triangles\n",
               (long long)forest_count(forest).patches,
               (long long)forest_count(forest).leaves,
               (long long)run->scene->sky_first);
    bool told = run->exposures && !run->options.quiet;
    for (int i = 0; told && i < run_camera_count(run); i++)
        if (run->exposures[i] > 0.0)
            printf("exposure    %.6g\n", run->exposures[i]);
}

/* True if a run has no output but the summary. */
static bool writes_nothing(const struct options *options)
{
    return options->output_count == 0 && !options->dump && !options->stats &&
           !options->checkpoint && !options->save_links && !options->at &&
           !options->report;
}

bool report_summary(struct run *run)
{
    if (run->stored) {
        print_stored(run);
        return true;
    }
    run->solver->account.seconds[PHASE_TOTAL] = comm_seconds() - run->start;
    solver_report(run->solver, &run->vote, &run->stats);
    run->stats.bytes_broadcast += (int64_t)run->block.bytes;
    progress_view_clear(&run->progress);
    if (run->comm.rank == 0) {
        run->stats.scene = run_scene_name(run);
        run->stats.exposures = run->exposures;
        run->stats.views = run->exposures ? run_camera_count(run) : 0;
        run->stats.scene_checksum = scene_hash(run->scene);
        run->stats.options = options_light_settings(&run->options);
        if (run->stats.memory_limited)
            run_say(run,
                    "warning: %s ended at the memory limit of %lld bytes, "
                    "with %lld links%s",
                    run->half_linked ? "linking" : "refinement",
                    (long long)run->solver->memory.limit,
                    (long long)run->stats.links,
                    run->half_linked ? ": light is missing" : "");
        else if (!run->vote.converged)
            run_say(run, "warning: not converged after %lld iterations",
                    (long long)run->stats.iterations);
        if (run->stats.hold == HOLD_NOTHING)
            run_say(run, "warning: --accuracy has nothing to measure: "
                         "no light is reflected");
        else if (run->stats.hold != HOLD_NONE) {
            double median = run->stats.gathered.median;
            bool own = median > run->stats.error_estimate;
            run_say(run,
                    "warning: the error is %.2g %%%s, not the %.3g %% of --accuracy: %s",
                    100.0 * (own ? median : run->stats.error_estimate),
                    own ? " in the median of leaves" : "",
                    100.0 * run->stats.accuracy, HOLDS[run->stats.hold]);
        }
        run->stats.touching_power =
            fmin(balance_touching(run), fmax(0.0, run->stats.escaped_power));
        run->stats.escaped_power -= run->stats.touching_power;
        balance_judge(run);
        if (writes_nothing(&run->options))
            run_say(run, "nothing is written: -o room.png writes a picture, "
                         "-o room.ply a mesh");
        if (!run->options.quiet && !run->options.dump)
            stats_print(&run->stats,
                        files_take_stdout(&run->options) ? stderr : stdout);
        struct error error = {.code = EXIT_DONE};
        if (run->options.stats)
            stats_write(&run->stats, run->options.stats, &error);
        run_lose(run, &error);
    }
    return run_agree(run);
}
