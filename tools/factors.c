/* --form-factors: exchanges between groups in place of light.
 *
 * With --accuracy, pairs of groups that are not good enough are done again with a smaller
 * epsilon, at most ROUNDS times: each round costs several times the one before, so that
 * those before cost little. */
#include "tools/factors.h"

#include "geom/stop.h"
#include "tools/pairs.h"
#include "tools/table.h"

enum { ROUNDS = 12, STUCK_MOST = 2 };

/* An error that is not below this part of the last round's, in STUCK_MOST rounds one
 * after another, no longer falls. */
static const double STUCK = 0.95;

/* Adds all pairs, in rounds. Returns the largest error of F; stops at a signal. */
static double add_in_rounds(struct run *run, struct viewfactors *factors)
{
    double accuracy = run->options.criterion.accuracy, error = 0.0, last;
    int stuck = 0; /* rounds in a row */
    for (int round = 1;; round++) {
        last = error;
        progress_begin(&run->progress.progress, "form factors", -1, 0);
        pairs_add(&run->comm, factors, &run->progress.progress);
        progress_view_clear(&run->progress);
        if (!run_goes_on(run))
            return 0.0;
        error = viewfactors_error(factors);
        stuck = round > 1 && error > STUCK * last ? stuck + 1 : 0;
        if (!(accuracy > 0.0) || error <= accuracy || stuck == STUCK_MOST ||
            round == ROUNDS)
            return error;
        viewfactors_refine(factors, accuracy);
    }
}

static void report(struct run *run, double error)
{
    double accuracy = run->options.criterion.accuracy;
    if (accuracy > 0.0 && error > accuracy)
        run_say(run,
                "warning: the largest error of F is %.2g, not the %.3g of --accuracy: "
                "a smaller epsilon no longer helps, or --max-level is in the way",
                error, accuracy);
    run_say(run, "%.1f s; largest error of F: %.2g", comm_seconds() - run->start, error);
}

void factors_tabulate(struct run *run)
{
    const struct criterion *criterion = &run->options.criterion;
    run_say(run, "%s: %lld triangles in %lld groups", run->options.scene,
            (long long)run->scene->input_count, (long long)run->scene->groups.count);
    struct viewfactors *factors = viewfactors_create(
        run->scene, run->octree, criterion->epsilon, criterion->max_level);
    double error = add_in_rounds(run, factors);
    if (run->error.code == EXIT_DONE && run->comm.rank == 0) {
        table_print(factors, stdout);
        stop_check(&run->error);
    }
    if (run_agree(run))
        report(run, error);
    viewfactors_destroy(factors);
}
