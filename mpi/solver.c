/* The state of one rank. */
#include "mpi/solver.h"

#include "geom/alloc.h"

const struct steps STEPS_PAPER = {
    .deal = solver_deal_roots,
    .transfer = solver_transfer,
    .push_pull = solver_push_pull_jacobi,
    .scatter = solver_renew_proxies,
    .vote = solver_vote_jacobi,
};

struct solver *solver_create(const struct comm *comm, const struct scene *scene,
                             const struct octree *octree,
                             const struct criterion *criterion, struct method method)
{
    struct solver *solver = alloc_array(1, sizeof *solver);
    size_t roots = (size_t)scene_root_count(scene);
    solver->comm = comm;
    solver->model = model_make(scene, octree, forest_create(scene), criterion, method);
    solver->steps = STEPS_PAPER;
    solver->memory.rays = criterion->final_gather;
    solver->turn.fresh = solver->turn.complete = true;
    solver->homes.owner = alloc_array(roots, sizeof *solver->homes.owner);
    solver->homes.own = alloc_array(roots, sizeof *solver->homes.own);
    return solver;
}

void solver_destroy(struct solver *solver)
{
    if (!solver)
        return;
    if (solver->steps.end)
        solver->steps.end(solver);
    forest_destroy(solver->model.forest);
    link_list_free(&solver->links);
    alloc_free(solver->homes.owner);
    alloc_free(solver->homes.own);
    alloc_free(solver->homes.patches);
    routes_free(&solver->routes);
    account_free(&solver->account);
    alloc_free(solver);
}

void solver_report(struct solver *solver, const struct vote *vote, struct stats *stats)
{
    const struct scene *scene = solver->model.scene;
    double unit = scene_area_unit(scene);
    stats->ranks = solver->comm->size;
    stats->triangles = scene->sky_first;
    stats->roots = 0;
    for (int32_t root = 0; root < scene_root_count(scene); root++)
        stats->roots += scene_root_area(scene, root) > 0.0;
    struct forest_counts counts = forest_count(solver->model.forest);
    stats->patches = counts.patches;
    stats->leaves = counts.leaves;
    stats->links = vote->links;
    stats->passes = solver->turn.pass;
    stats->iterations = solver->turn.iteration;
    stats->clusters = solver->memory.clusters;
    stats->counted_bytes = memory_needed(&solver->memory, 1, stats->links,
                                         solver->model.forest->count);
    stats->memory_limit = solver->memory.limit;
    stats->memory_limited = solver->memory.reached > 0;
    stats->converged = vote->converged && !stats->memory_limited;
    stats->epsilon = solver->model.criterion.epsilon;
    stats->emitted_power = unit * scene_entering_power(scene);
    stats->absorbed_power = unit * vote->absorbed;
    stats->escaped_power = unit * vote->escaped;
    if (scene->sky_first < scene->input_count)
        stats->escaped_power = stats->emitted_power - stats->absorbed_power;
    stats->checksum = forest_checksum(solver->model.forest);
    account_report(&solver->account, solver->comm, &solver->model, &solver->links, stats);
    if (solver->steps.report)
        solver->steps.report(solver, stats);
}
