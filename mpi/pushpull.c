/* Step 6: push-pull on the own roots, and the ballot of this rank. */
#include "mpi/solver.h"

#include "geom/signals.h"

static int64_t own_new_patches(const struct solver *solver)
{
    const struct homes *homes = &solver->homes;
    int64_t count = 0;
    while (count < homes->count &&
           homes->patches[homes->count - 1 - count] >= solver->turn.first_new)
        count++;
    return count;
}

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
    account_begin(&solver->account, PHASE_PUSH_PULL);
    solver->turn.iteration++;
    solver->steps.push_pull(solver);
    solver->turn.complete = solver->comm->size == 1;
    solver->ballot.split = solver->turn.split_here;
    solver->ballot.links = solver->links.count;
    solver->ballot.divided = own_new_patches(solver);
    solver->ballot.stop = signals_seen();
    account_end(&solver->account, PHASE_PUSH_PULL);
}
