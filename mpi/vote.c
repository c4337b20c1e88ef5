/* Step 8: the vote on another iteration.
 *
 * Each rank casts a ballot of integers and maxima, which travels with the radiosities of its leaves, and
 * all add them up, so the outcome is the same on any number of ranks. The iterations end
 * when nothing was split and the bound on what further ones could add, q / (1 - q) of the last change
 * (rad/pushpull.c), is small enough.
 *
 * The power that escapes is what leaves the surfaces, emitted or reflected, less what the links
 * delivered: an open scene's real loss plus whatever the form factors lack or have too much. */
#include "mpi/solver.h"

#include <math.h>

void ballot_add(struct ballot *sum, const struct ballot *ballot)
{
    sum->light = flux_add(sum->light, ballot->light);
    sum->absorbed = flux_add(sum->absorbed, ballot->absorbed);
    sum->change = flux_add(sum->change, ballot->change);
    sum->arriving = flux_add(sum->arriving, ballot->arriving);
    sum->split += ballot->split;
    sum->links += ballot->links;
    sum->divided += ballot->divided;
    sum->stop = sum->stop > ballot->stop ? sum->stop : ballot->stop;
    for (int c = 0; c < BANDS; c++)
        sum->square[c] += ballot->square[c];
    sum->negative = flux_add(sum->negative, ballot->negative);
    sum->bulk = flux_add(sum->bulk, ballot->bulk);
    sum->missing = flux_add(sum->missing, ballot->missing);
    sum->shrink = fmax(sum->shrink, ballot->shrink);
    sum->largest = fmax(sum->largest, ballot->largest);
    sum->brightest = fmax(sum->brightest, ballot->brightest);
}

/* Bound on the remaining error relative to all light; `before` is the change of the iteration
 * before. */
static double remaining_by_change(const struct ballot *sum, int64_t before)
{
    if (sum->change == 0)
        return 0.0;
    double shrink = before > 0 ? (double)sum->change / (double)before : HUGE_VAL;
    shrink = fmax(shrink, sum->shrink);
    if (!(shrink < 1.0))
        return HUGE_VAL;
    return shrink / (1.0 - shrink) * ((double)sum->change / (double)sum->light);
}

struct vote solver_vote_jacobi(struct solver *solver, const struct ballot *sum)
{
    double remaining = remaining_by_change(sum, solver->change.last);
    solver->change.last = sum->change;
    return vote_make(solver, sum, remaining);
}

struct vote vote_make(const struct solver *solver, const struct ballot *sum,
                      double remaining)
{
    struct flux_unit unit = solver->model.flux_unit;
    struct vote vote = {
        .diverged = sum->light >= FLUX_LIMIT || sum->bulk >= FLUX_LIMIT,
        .settled = sum->split == 0 && sum->divided == 0,
        .split = sum->split,
        .links = sum->links,
        .remaining = remaining,
        .absorbed = flux_to_watts(unit, sum->absorbed),
        .escaped = flux_to_watts(unit, flux_add(sum->light, -sum->arriving)),
    };
    vote.converged = vote.settled && remaining <= solver->model.criterion.tolerance;
    return vote;
}

struct vote solver_vote(struct solver *solver)
{
    struct ballot sum = solver->ballot;
    solver->turn.stop = (int)sum.stop;
    struct vote vote = solver->steps.vote(solver, &sum);
    solver_record_iteration(solver);
    return vote;
}
