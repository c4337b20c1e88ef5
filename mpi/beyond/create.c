/* Exchanges steps of the paper's solver for phr's own, as the criterion names them. */
#include "mpi/beyond/create.h"

#include "mpi/beyond/above.h"
#include "mpi/beyond/accuracy.h"
#include "mpi/beyond/bounds.h"
#include "mpi/beyond/descent.h"
#include "mpi/beyond/step9.h"

/* Nodes receive by their clusters, too: twice as much fits into the unit. */
static void transfer(struct solver *solver, const struct rgb *vector)
{
    struct rgb *means = above_begin(solver, vector);
    account_begin(&solver->account, PHASE_SOLVE);
    double largest = 2.0 * solver_largest(solver, vector);
    solver->flux = flux_unit_for(largest * solver->model.whole_area);
    solver->model.method.transfer(&solver->links, &solver->model, vector, solver->flux);
    account_end(&solver->account, PHASE_SOLVE);
    above_end(solver, means);
}

struct solver *beyond_create(const struct comm *comm, const struct scene *scene,
                             const struct octree *octree,
                             const struct criterion *criterion)
{
    struct solver *solver =
        solver_create(comm, scene, octree, criterion, method_of(criterion));
    bool conjugate = criterion->solver == SOLVER_CG;
    bool tree = criterion->linking == LINKING_TREE;
    struct steps *steps = &solver->steps;
    if (solver->model.method.keep_link) {
        steps->prepare = bounds_prepare;
        steps->learn = bounds_learn;
    }
    if (!conjugate && !tree)
        return solver;
    beyond_attach(solver);
    if (conjugate) {
        steps->begin = descent_begin;
        steps->vote = descent_vote;
    }
    if (tree) {
        above_create(solver);
        steps->deal = above_deal;
        steps->transfer = transfer;
        steps->scatter = above_scatter;
        steps->collect = above_collect;
        if (criterion->final_gather > 0)
            steps->finish = criterion->accuracy > 0.0 ? accuracy_finish : solver_finish;
    }
    if (conjugate) {
        solver->beyond->scatter = steps->scatter;
        steps->scatter = NULL; /* after the vote, which changes the light */
    }
    return solver;
}
