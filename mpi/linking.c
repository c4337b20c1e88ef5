/* Steps 2 and 3: initial linking, and the homes of roots and links.
 *
 * The pair (i, j) of roots is linked on rank (i + j) mod P: the counts per rank differ by a few
 * pairs at most, and neighbouring pairs, whose cost is alike, go to different ranks. The link
 * then goes to the home of one of its two roots, the lower or the higher one by the parity of
 * i + j, so that roots with low numbers do not collect all of them. */
#include "mpi/migrate.h"
#include "mpi/assign.h"

#include "geom/alloc.h"

void solver_link_roots(struct solver *solver)
{
    double start = comm_seconds();
    struct method *method = &solver->method;
    int32_t roots = method->forest->root_count;
    int ranks = solver->comm->size;
    struct facet *facets = alloc_array((size_t)roots, sizeof *facets);
    for (int32_t i = 0; i < roots; i++)
        facets[i] = facet_make(method->forest, i);
    for (int32_t i = 0; i < roots; i++) {
        int32_t first = i + 1;
        first += (int32_t)(((int64_t)solver->comm->rank - i - first) % ranks + ranks) % ranks;
        for (int32_t j = first; j < roots; j += ranks) {
            if (facets[i].area <= 0.0 || facets[j].area <= 0.0)
                continue;
            struct link link;
            if (link_make(method, i, &facets[i], j, &facets[j], 0, &link))
                link_list_append(&solver->links, link);
        }
    }
    alloc_free(facets);
    solver->seconds[PHASE_LINKING] += comm_seconds() - start;
}

void solver_assign_roots(struct solver *solver)
{
    double start = comm_seconds();
    roots_assign(solver->method.scene, solver->comm->size, solver->owner);
    for (int32_t root = 0; root < solver->method.forest->root_count; root++)
        solver->own[root] = solver->owner[root] == solver->comm->rank;
    int *destination = alloc_array((size_t)solver->links.count, sizeof *destination);
    for (int64_t i = 0; i < solver->links.count; i++) {
        const struct link *link = &solver->links.items[i]; /* p < q: both are roots */
        destination[i] = solver->owner[(link->p ^ link->q) % 2 == 0 ? link->p : link->q];
    }
    links_migrate(solver, &solver->links, destination);
    alloc_free(destination);
    solver->seconds[PHASE_LINKING] += comm_seconds() - start;
}
