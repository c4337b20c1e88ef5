/* The state of a rank beyond the paper's, and its part of the report. */
#include "mpi/beyond/beyond.h"

#include "geom/alloc.h"

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

static void free_tree(struct solver *solver)
{
    struct branches *branches = solver->beyond->branches;
    if (!branches) /* no tree */
        return;
    alloc_free(branches->owner);
    alloc_free(branches->top);
    alloc_free(branches->own);
    route_free(&branches->all);
    alloc_free(branches);
    cluster_light_destroy(solver->model.clusters);
    cluster_tree_destroy(solver->beyond->tree);
    spaces_destroy(solver->beyond->spaces);
    node_block_destroy(&solver->beyond->tree_block);
}

void answer_clear(struct answer *answer)
{
    alloc_free(answer->error);
    alloc_free(answer->straight);
    alloc_free(answer->open);
    final_gather_destroy(answer->gather);
    *answer = (struct answer){.counts = answer->counts};
}

static void end(struct solver *solver)
{
    struct beyond *beyond = solver->beyond;
    free_tree(solver);
    conjugate_free(beyond->descent);
    alloc_free(beyond->descent);
    answer_clear(beyond->answer);
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
