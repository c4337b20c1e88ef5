/* Exchanges steps of the paper's solver for phr's own, as the criterion names them. */
#include "mpi/beyond/beyond.h"

#include "geom/alloc.h"

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

static void report(const struct solver *solver, struct stats *stats)
{
    const struct beyond *beyond = solver->beyond;
    stats->accuracy = solver->model.criterion.accuracy;
    stats->hold = beyond->accuracy.hold;
    stats->rounds = beyond->accuracy.rounds;
    stats->memory_limited = stats->memory_limited || beyond->answer->counts.limited;
    stats->converged =
        stats->converged && stats->hold == HOLD_NONE && !stats->memory_limited;
    stats->error_estimate = beyond->answer->counts.error;
    stats->gathered = beyond->answer->counts;
    stats->bytes_broadcast += (int64_t)beyond->tree_block.bytes;
}

void beyond_free_vectors(struct solver *solver)
{
    routes_free(&solver->routes);
    if (solver->beyond)
        conjugate_free(solver->beyond->descent);
    if (solver->model.clusters)
        cluster_light_free_vectors(solver->model.clusters);
}

static void end(struct solver *solver)
{
    struct beyond *beyond = solver->beyond;
    above_free(solver);
    conjugate_free(beyond->descent);
    alloc_free(beyond->descent);
    alloc_free(beyond->answer->error);
    alloc_free(beyond->answer->straight);
    alloc_free(beyond->answer->outside);
    final_gather_destroy(beyond->answer->gather);
    alloc_free(beyond->answer);
    alloc_free(beyond);
}

struct beyond *beyond_attach(struct solver *solver)
{
    if (solver->beyond)
        return solver->beyond;
    struct beyond *beyond = solver->beyond = alloc_array(1, sizeof *beyond);
    beyond->descent = alloc_array(1, sizeof *beyond->descent);
    beyond->answer = alloc_array(1, sizeof *beyond->answer);
    solver->steps.report = report;
    solver->steps.end = end;
    return beyond;
}

const struct answer *beyond_answer(const struct solver *solver)
{
    static const struct answer NONE = {.error = NULL};
    return solver->beyond ? solver->beyond->answer : &NONE;
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
            steps->finish = solver_finish;
    }
    if (conjugate) {
        solver->beyond->scatter = steps->scatter;
        steps->scatter = NULL; /* after the vote, which changes the light */
    }
    return solver;
}
