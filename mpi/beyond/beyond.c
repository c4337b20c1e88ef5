/* Exchanges steps of the paper's solver for phr's own, as the criterion names them. */
#include "mpi/beyond/beyond.h"

#include <math.h>

#include "geom/alloc.h"

/* Transfers a vector in a unit that fits its largest value: B, which all ranks know, or
 * rho z, the largest of which the ballots have brought. */
static void transfer(struct solver *solver, const struct rgb *vector)
{
    const struct beyond *beyond = solver->beyond;
    double largest = beyond->descent.fresh ? solver_largest(solver, vector)
                                           : fmax(solver->ballot.brightest, 1e-250);
    double room = beyond->tree ? 2.0 : 1.0; /* nodes receive by their clusters, too */
    if (beyond->tree)
        above_begin(solver, vector);
    double start = comm_seconds();
    solver->flux = flux_unit_for(room * largest * solver->model.area);
    solver->model.method.transfer(&solver->links, &solver->model, vector, solver->flux);
    solver->account.seconds[PHASE_SOLVE] += comm_seconds() - start;
}

static void report(const struct solver *solver, struct stats *stats)
{
    const struct beyond *beyond = solver->beyond;
    stats->accuracy = solver->model.criterion.accuracy;
    stats->hold = beyond->accuracy.hold;
    stats->rounds = beyond->accuracy.rounds;
    stats->converged = stats->converged && stats->hold == HOLD_NONE;
    stats->error_estimate = beyond->answer.counts.error;
    stats->gathered = beyond->answer.counts;
    stats->bytes_broadcast += (int64_t)beyond->tree_block.bytes;
}

static void end(struct solver *solver)
{
    struct beyond *beyond = solver->beyond;
    above_free(solver);
    caps_free(&beyond->caps);
    conjugate_free(&beyond->descent.vectors);
    alloc_free(beyond->answer.error);
    alloc_free(beyond->answer.straight);
    final_gather_free(&beyond->answer.gather);
    alloc_free(beyond);
}

struct beyond *beyond_attach(struct solver *solver)
{
    if (solver->beyond)
        return solver->beyond;
    struct beyond *beyond = solver->beyond = alloc_array(1, sizeof *beyond);
    beyond->descent.fresh = true;
    solver->steps.report = report;
    solver->steps.end = end;
    return beyond;
}

const struct answer *beyond_answer(const struct solver *solver)
{
    static const struct answer NONE = {.error = NULL};
    return solver->beyond ? &solver->beyond->answer : &NONE;
}

struct solver *beyond_create(const struct comm *comm, const struct scene *scene,
                             const struct octree *octree,
                             const struct criterion *criterion)
{
    struct solver *solver =
        solver_create(comm, scene, octree, criterion, method_of(criterion));
    bool conjugate = criterion->solver == SOLVER_CG;
    bool tree = criterion->linking == LINKING_TREE;
    if (!conjugate && !tree)
        return solver;
    struct steps *steps = &solver->steps;
    beyond_attach(solver);
    steps->transfer = transfer;
    if (conjugate) {
        steps->vector = descent_vector;
        steps->begin = caps_begin;
        steps->push_pull = descent_push_pull;
        steps->vote = descent_vote;
    }
    if (tree) {
        above_create(solver);
        steps->collect = above_collect;
        if (criterion->final_gather > 0)
            steps->finish = solver_finish;
    }
    return solver;
}
