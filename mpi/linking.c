/* Steps 2 and 3: initial linking, and the homes of roots and links.
 *
 * Rows of the pairs of roots (rad/linking.h), all equally long, are dealt in turn. A link then goes to
 * the home of one of its two roots, the lower or the higher one by the parity of i + j, so that roots
 * with low numbers do not collect all of them. */
#include "mpi/migrate.h"
#include "mpi/assign.h"

#include "geom/alloc.h"
#include "rad/linking.h"

void solver_link_roots(struct solver *solver)
{
    double start = comm_seconds();
    struct linking linking = linking_start(&solver->method, &solver->links);
    int32_t rows = linking.tree->root_count;
    for (int32_t i = solver->comm->rank; i < rows; i += solver->comm->size) {
        progress_tick(solver->progress, (double)i / rows);
        linking_add_row(&linking, i);
    }
    solver->pairs_touched = linking.touched;
    linking_end(&linking);
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
