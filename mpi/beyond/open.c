/* Roots that may have exact rows in a final gather: nothing stands between such a root
 * and the roots it faces.
 *
 * Exact rows cost much, and their mesh is the links', which is good where nothing casts
 * shadows: so there are exact rows only if half of the scene's area is open. Proofs cost
 * much as well, and most scenes are not open: segments show first where a root is not,
 * and the search ends once half of the area cannot be had. */
#include "mpi/beyond/open.h"

#include <stdlib.h>

#include "geom/alloc.h"
#include "geom/stop.h"

struct root_area {
    double area; /* square scene units */
    int32_t root;
};

/* Largest first. */
static int compare_areas(const void *left, const void *right)
{
    const struct root_area *a = left, *b = right;
    int order = (a->area < b->area) - (a->area > b->area);
    return order != 0 ? order : (a->root > b->root) - (a->root < b->root);
}

/* Returns all roots, largest first. */
static struct root_area *sort_roots(const struct scene *scene, int32_t roots)
{
    struct root_area *sorted = alloc_array((size_t)roots, sizeof *sorted);
    for (int32_t root = 0; root < roots; root++)
        sorted[root] = (struct root_area){scene_root_area(scene, root), root};
    qsort(sorted, (size_t)roots, sizeof *sorted, compare_areas);
    return sorted;
}

/* Collective. Finds the open roots, proved to be so if `proof`; each rank examines some.
 * True if these have half of the scene's area. Large roots come first, those of about the
 * same area together, until half is out of reach. */
static bool half_is_open(const struct solver *solver, struct final_gather *gather,
                         const struct root_area *sorted, bool proof, int64_t *open)
{
    const struct model *model = &solver->model;
    const struct comm *comm = solver->comm;
    int32_t roots = scene_root_count(model->scene), end;
    double blocked = 0.0;
    for (int32_t begin = 0; begin < roots && 2.0 * blocked <= model->area; begin = end) {
        for (end = begin; end < roots && 2.0 * sorted[end].area >= sorted[begin].area;
             end++)
            open[end] = end % comm->size == comm->rank && !stop_is_asked() &&
                        final_gather_root_is_open(gather, sorted[end].root, proof);
        comm_add(comm, open + begin, end - begin);
        for (int32_t i = begin; i < end; i++)
            blocked += open[i] ? 0.0 : sorted[i].area;
    }
    return 2.0 * blocked <= model->area;
}

uint8_t *solver_find_open_roots(struct solver *solver, struct final_gather *gather)
{
    int32_t roots = scene_root_count(solver->model.scene);
    int64_t before = final_gather_work(gather);
    struct root_area *sorted = sort_roots(solver->model.scene, roots);
    uint8_t *open = alloc_array((size_t)roots, sizeof *open);
    int64_t *found = alloc_array((size_t)roots, sizeof *found);
    if (half_is_open(solver, gather, sorted, false, found) &&
        half_is_open(solver, gather, sorted, true, found))
        for (int32_t i = 0; i < roots; i++)
            open[sorted[i].root] = found[i] != 0;
    account_work(&solver->account, WORK_FINAL_GATHER,
                 final_gather_work(gather) - before, 0);
    alloc_free(found);
    alloc_free(sorted);
    return open;
}
