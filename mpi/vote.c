/* Steps 6 and 8: push-pull, and the vote on another iteration.
 *
 * Each rank casts a ballot of integers and one maximum; all ranks add all ballots, so the
 * outcome is the same on any number of them. The iterations end when nothing was split and the
 * bound on what further ones could add, q / (1 - q) of the last change (rad/pushpull.c), is
 * small enough.
 *
 * The power that escapes is what leaves the surfaces, emitted or reflected, less what the links
 * delivered: an open scene's real loss plus whatever the form factors lack or have too much. */
#include "mpi/solver.h"

#include <math.h>

#include "geom/alloc.h"

/* What a rank says; 64 bytes, no padding. */
struct ballot {
    int64_t light, absorbed, change, moved; /* flux units */
    int64_t split, links;
    int64_t diverged;
    double shrink;
};

void solver_push_pull(struct solver *solver)
{
    double start = comm_seconds();
    solver->sums = push_pull(&solver->method, solver->own, solver->touched, solver->root_change);
    solver->seconds[PHASE_PUSH_PULL] += comm_seconds() - start;
}

static void add_ballot(struct ballot *sum, const struct ballot *ballot)
{
    sum->light = flux_add(sum->light, ballot->light);
    sum->absorbed = flux_add(sum->absorbed, ballot->absorbed);
    sum->change = flux_add(sum->change, ballot->change);
    sum->moved = flux_add(sum->moved, ballot->moved);
    sum->split += ballot->split;
    sum->links += ballot->links;
    sum->diverged += ballot->diverged;
    sum->shrink = fmax(sum->shrink, ballot->shrink);
}

/* Bound on the remaining error relative to all light; `before` is the change of the iteration
 * before. */
static double remaining_error(const struct ballot *sum, int64_t before)
{
    if (sum->change == 0)
        return 0.0;
    double shrink = before > 0 ? (double)sum->change / (double)before : HUGE_VAL;
    shrink = fmax(shrink, sum->shrink);
    if (!(shrink < 1.0))
        return HUGE_VAL;
    return shrink / (1.0 - shrink) * ((double)sum->change / (double)sum->light);
}

struct vote solver_vote(struct solver *solver)
{
    const struct comm *comm = solver->comm;
    const struct push_pull_sums *sums = &solver->sums;
    struct ballot own = {sums->light, sums->absorbed, sums->change, solver->moved,
                         solver->split_here, solver->links.count, sums->diverged, sums->shrink};
    struct ballot *all = alloc_array((size_t)comm->size, sizeof *all), sum = {0};
    MPI_Request request;
    double start = comm_seconds();
    MPI_Iallgather(&own, (int)sizeof own, MPI_BYTE, all, (int)sizeof own, MPI_BYTE, comm->handle,
                   &request);
    comm_wait(&request);
    solver->seconds[PHASE_IDLE] += comm_seconds() - start;
    for (int r = 0; r < comm->size; r++)
        add_ballot(&sum, &all[r]);
    alloc_free(all);
    struct flux_unit unit = solver->method.flux_unit;
    struct vote vote = {
        .diverged = sum.diverged > 0 || sum.light >= FLUX_LIMIT || sum.moved >= FLUX_LIMIT,
        .split = sum.split,
        .links = sum.links,
        .remaining = remaining_error(&sum, solver->last_change),
        .absorbed = flux_to_watts(unit, sum.absorbed),
        .escaped = flux_to_watts(unit, sum.light - sum.moved),
    };
    solver->last_change = sum.change;
    vote.converged = vote.split == 0 && vote.remaining <= solver->method.criterion.tolerance;
    return vote;
}
