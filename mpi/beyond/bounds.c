/* Step 4: what refinement by error reads of the light: mean radiosities of clusters, and
 * ranges of radiosity over patches, both as they are before a pass.
 *
 * Where all ranks know all leaves, as before the first pass, each finds all of it. Else
 * homes find the means by step 7, and ranges of their patches. Other ranks learn both as
 * they learn radiosities: for the ends of their links before the pass, and for the
 * children of these before each level. */
#include "mpi/beyond/bounds.h"

#include <string.h>

#include "mpi/beyond/beyond.h"
#include "rad/beyond/range.h"

static void pack_range(struct solver *solver, int32_t node, void *record)
{
    if (!node_is_cluster(node))
        memcpy(record, &solver->model.forest->ranges[node], sizeof(float));
}

static void unpack_range(struct solver *solver, int32_t node, void *record)
{
    if (!node_is_cluster(node))
        memcpy(&solver->model.forest->ranges[node], record, sizeof(float));
}

void bounds_learn(struct solver *solver, const struct route *originals,
                  const struct route *proxies)
{
    static const struct record_kind RANGES = {CARGO_LIGHT, sizeof(float), pack_range,
                                              unpack_range};
    routes_carry(solver, originals, proxies, RANGES);
}

void bounds_prepare(struct solver *solver)
{
    const struct homes *homes = &solver->homes;
    struct forest *forest = solver->model.forest;
    struct cluster_light *clusters = solver->model.clusters;
    if (solver->turn.complete) {
        forest_bound(forest, NULL, forest->count);
        if (clusters)
            cluster_light_average(clusters, forest, forest->radiosity,
                                  clusters->radiosity);
        return;
    }
    if (solver->model.criterion.solver == SOLVER_CG)
        solver->beyond->scatter(solver); /* the light of the last iteration */
    homes_renew(solver);
    forest_bound(forest, homes->patches, homes->count);
    bounds_learn(solver, &solver->routes.originals, &solver->routes.proxies);
    solver_learn(solver, &solver->links, false);
}
