/* Step 4: what refinement by error reads of the light: mean radiosities of clusters, and
 * ranges of radiosity over patches, both as they are before a pass.
 *
 * Where all ranks know all leaves, as before the first pass, each finds all of it. Else
 * homes find the means by step 7, and ranges of their patches. Other ranks learn both as
 * they learn radiosities: for the ends of their links before the pass, and for the
 * children of these before each level. */
#include "mpi/beyond/bounds.h"

#include "geom/alloc.h"
#include "mpi/beyond/beyond.h"
#include "rad/beyond/range.h"

void bounds_learn(struct solver *solver, const struct route *originals,
                  const struct route *proxies)
{
    struct account *account = &solver->account;
    float *ranges = solver->model.forest->ranges;
    int64_t messages = comm_counts().messages;
    float *out = alloc_array((size_t)originals->count, sizeof *out);
    float *in = alloc_array((size_t)proxies->count, sizeof *in);
    for (int64_t i = 0; i < originals->count; i++)
        if (!node_is_cluster(originals->nodes[i]))
            out[i] = ranges[originals->nodes[i]];
    comm_deliver(solver->comm, out, originals->counts, in, proxies->counts, sizeof *out);
    for (int64_t i = 0; i < proxies->count; i++)
        if (!node_is_cluster(proxies->nodes[i]))
            ranges[proxies->nodes[i]] = in[i];
    account->bytes[CARGO_LIGHT] += originals->count * (int64_t)sizeof *out;
    account->messages[CARGO_LIGHT] += comm_counts().messages - messages;
    alloc_free(in);
    alloc_free(out);
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
