/* Step 8: the vote on another iteration.
 *
 * Each rank casts a ballot of integers and maxima, and all ranks add all ballots up: on
 * any number of ranks the outcome is the same. A small change of energy ends the
 * iterations, a bound those of mpi/beyond/descent.c.
 *
 * The escaped power is the power leaving surfaces, emitted or reflected, less the power
 * delivered by links: an open scene's real loss, plus the errors of form factors. */
#include "mpi/solver.h"

#include <string.h>

#include "geom/alloc.h"

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
}

/* "If the total energy change in the whole scene is above some threshold, the iterations
 * should continue" (Sec. 2.2): relative to all light. */
struct vote solver_vote_jacobi(struct solver *solver, const struct ballot *sum)
{
    double change = sum->change > 0 ? (double)sum->change / (double)sum->light : 0.0;
    struct vote vote = vote_make(solver, sum, change);
    vote.converged = change <= solver->model.criterion.tolerance;
    return vote;
}

struct vote vote_make(const struct solver *solver, const struct ballot *sum,
                      double remaining)
{
    struct flux_unit unit = solver->model.flux_unit;
    struct vote vote = {
        .diverged = sum->light >= FLUX_LIMIT,
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
    const struct comm *comm = solver->comm;
    struct account *account = &solver->account;
    struct ballot sum = {0}, *each;
    each = comm_gather_each(comm, &solver->ballot, sizeof *each);
    for (int r = 0; r < comm->size; r++)
        ballot_add(&sum, &each[r]);
    alloc_free(each);
    account->bytes[CARGO_LIGHT] += (comm->size - 1) * (int64_t)sizeof sum;
    solver->ballot = sum;
    solver->turn.stop = (int)sum.stop;
    struct vote vote = solver->steps.vote(solver, &sum);
    int64_t now[] = {account->bytes[CARGO_FLUX], account->bytes[CARGO_LIGHT],
                     account->copied}, *before = account->recorded;
    account_work(account, WORK_TRANSFER, solver->links.seen, now[0] - before[0]);
    account_work(account, WORK_OWN, account->leaves, now[1] - before[1]);
    account_work(account, WORK_PATCHES, now[2] - before[2], 0);
    memcpy(before, now, sizeof now);
    return vote;
}
