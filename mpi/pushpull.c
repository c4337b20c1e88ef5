/* Step 6: push-pull on the own roots, and the ballot of this rank. */
#include "mpi/solver.h"

#include "geom/signals.h"

void solver_push_pull_jacobi(struct solver *solver)
{
    struct push_pull_sums sums =
        push_pull(&solver->model, solver->flux, solver->homes.patches,
                  solver->homes.count);
    solver->ballot = (struct ballot){.light = sums.light,
                                     .absorbed = sums.absorbed,
                                     .change = sums.change,
                                     .arriving = sums.arriving};
    solver->account.leaves = sums.leaves;
}

void solver_push_pull(struct solver *solver)
{
    const struct homes *homes = &solver->homes;
    int64_t old = homes->count; /* own patches not made in this pass */
    account_begin(&solver->account, PHASE_PUSH_PULL);
    solver->turn.iteration++;
    solver->steps.push_pull(solver);
    solver->turn.complete = solver->comm->size == 1;
    solver->ballot.split = solver->turn.split_here;
    solver->ballot.links = solver->links.count;
    while (old > 0 && homes->patches[old - 1] >= solver->turn.first_new)
        old--;
    solver->ballot.divided = homes->count - old;
    solver->ballot.stop = signals_seen();
    account_end(&solver->account, PHASE_PUSH_PULL);
}
