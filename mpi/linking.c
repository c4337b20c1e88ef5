/* Steps 2 and 3: initial linking, and the homes of roots and links.
 *
 * The pairs of root i with higher ones are dealt in blocks of BLOCK neighbours j: block b goes to
 * rank (i + b) mod P. Within a block the last blocker is a good guess for the next pair; blocks
 * are short, so that the counts per rank are even and costs that are alike are spread. A link
 * then goes to the home of one of its two roots, the lower or the higher one by the parity of
 * i + j, so that roots with low numbers do not collect all of them. */
#include "mpi/migrate.h"
#include "mpi/assign.h"

#include "geom/alloc.h"

enum { BLOCK = 32 };

/* Links root i with the roots first to end - 1 that are above it. */
static void link_block(struct solver *solver, const struct facet *facets, int32_t i, int32_t first,
                       int32_t end)
{
    int32_t blocker = -1;
    for (int32_t j = first > i ? first : i + 1; j < end; j++) {
        struct link link;
        struct sight sight = {.blocker = blocker};
        if (facets[i].area > 0.0 && facets[j].area > 0.0 &&
            link_make(&solver->method, i, &facets[i], j, &facets[j], 0.0, &sight, &link))
            link_list_append(&solver->links, link);
        blocker = sight.blocker;
    }
}

void solver_link_roots(struct solver *solver)
{
    double start = comm_seconds();
    const struct forest *forest = solver->method.forest;
    int32_t roots = forest->root_count;
    struct facet *facets = alloc_array((size_t)roots, sizeof *facets);
    for (int32_t i = 0; i < roots; i++)
        facets[i] = facet_make(forest, i);
    for (int32_t i = 0; i < roots; i++) {
        progress_tick_pairs(solver->progress, i, roots);
        for (int32_t block = i / BLOCK; block * BLOCK < roots; block++) {
            int32_t end = (block + 1) * BLOCK < roots ? (block + 1) * BLOCK : roots;
            if ((i + block) % solver->comm->size == solver->comm->rank)
                link_block(solver, facets, i, block * BLOCK, end);
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
