/* The mesh of a final gather, on all ranks.
 *
 * Roots that may have exact rows are found first: nothing stands between such a root and
 * the roots it faces. Exact rows cost much, and their mesh is the links', which is good
 * only where nothing casts shadows. So there are exact rows only if half of the scene's
 * area is open. Proofs cost much as well, and most scenes are not open. So segments come
 * first, which show roots that are not; and the search ends once half is out of reach.
 *
 * Then all ranks look at leaves, round by round, between which the mesh splits leaves.
 * The looks are dealt by the work predicted for them, and all ranks learn all looks. */
#include "mpi/beyond/mesh.h"

#include <stdlib.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/stop.h"
#include "mpi/beyond/stages.h"
#include "mpi/memory.h"

enum { ROUNDS = 6 };

/* --- open roots --- */

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
                        view_is_open(gather->view, sorted[end].root, proof);
        comm_add(comm, open + begin, end - begin);
        for (int32_t i = begin; i < end; i++)
            blocked += open[i] ? 0.0 : sorted[i].area;
    }
    return 2.0 * blocked <= model->area;
}

/* Collective. Returns 1 for each root proved to have nothing between itself and the roots
 * it faces, else 0: [roots], to be freed. All are 0 if the open ones have less than half
 * of the scene's area. */
static uint8_t *find_open_roots(struct solver *solver, struct final_gather *gather)
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

/* --- looks --- */

/* Collective. Each rank makes the cuts of some regions, and all get them. Pre: there are
 * none. */
static void share_cuts(struct solver *solver, struct cuts *cuts)
{
    const struct comm *comm = solver->comm;
    int64_t regions = cuts->regions->count;
    int64_t count;
    cuts_make(cuts, regions * comm->rank / comm->size,
              regions * (comm->rank + 1) / comm->size);
    struct cut_node *nodes =
        comm_gather_all(comm, cuts->nodes, cuts->count, sizeof *nodes, &count);
    cuts_take(cuts, nodes, count);
    account_work(&solver->account, WORK_FINAL_GATHER, 0,
                 count * (int64_t)sizeof *nodes);
}

struct looking {
    struct meshing *meshing;
    const int32_t *leaves;     /* looked at */
    struct gather_look *looks; /* [count] of this rank */
    int64_t count;
};

static void look_at(void *context, int64_t item)
{
    struct looking *l = context;
    l->looks[l->count++] =
        final_gather_look(l->meshing->gather, l->leaves[item], l->meshing->rays);
}

/* Collective. Looks at leaves, [count]; [count], on all ranks, to be freed. */
static struct gather_look *look(struct solver *solver, struct meshing *meshing,
                                const int32_t *leaves, int64_t count)
{
    const struct comm *comm = solver->comm;
    int64_t *work = meshing_work(meshing, leaves, count, NULL);
    struct gather_look *looks = alloc_array((size_t)count, sizeof *looks);
    struct looking l = {.meshing = meshing, .leaves = leaves};
    struct stages stages = {.solver = solver, .gather = meshing->gather, .act = look_at,
                            .context = &l, .work = work, .count = count};
    l.looks = alloc_array((size_t)count, sizeof *looks);
    final_gather_renew(meshing->gather);
    stages_run(&stages);
    struct cuts *cuts = meshing->gather->aims->cuts[LAMPS];
    comm_add(comm, cuts->tally, 2 * cuts->count);
    cuts_learn(cuts);
    memmove(l.looks + stages.at[comm->rank], l.looks, (size_t)l.count * sizeof *looks);
    comm_share(comm, l.looks, stages.counts, stages.at, sizeof *looks);
    for (int64_t i = 0; i < count; i++)
        looks[i] = l.looks[stages.place[i]];
    stages_free(&stages);
    alloc_free(l.looks);
    alloc_free(work);
    return looks;
}

/* The number of patches from which on the memory limit keeps leaves from being split. */
static int64_t patches_most(const struct memory *memory, int64_t links)
{
    int64_t low = 0, high = INT32_MAX;
    while (low < high) {
        int64_t middle = (low + high) / 2;
        if (memory_has_room(memory, links, 1, middle))
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

bool solver_make_mesh(struct solver *solver, int64_t links, struct gather_mesh *mesh)
{
    struct model *model = &solver->model;
    struct final_gather *gather = mesh->gather =
        final_gather_create(model, model->criterion.final_gather, NULL, lit_find(model));
    uint8_t *open = find_open_roots(solver, gather);
    struct meshing meshing = {.model = model, .gather = gather, .mesh = mesh,
                              .open = open,
                              .patches_most = patches_most(&solver->memory, links)};
    meshing_begin(&meshing);
    int64_t count = 0;
    int32_t *leaves = meshing_looks(&meshing) ? meshing_choose(&meshing, &count) : NULL;
    if (count > 0) {
        share_cuts(solver, gather->aims->cuts[LAMPS]);
        cuts_count(gather->aims->cuts[LAMPS]);
    }
    for (int round = 0; round < ROUNDS && count > 0; round++) {
        progress_begin(solver->progress, "looking", round, 0);
        struct gather_look *looks = look(solver, &meshing, leaves, count);
        count = meshing_split(&meshing, looks, &leaves, count);
        alloc_free(looks);
    }
    meshing_end(&meshing);
    int64_t stopped = stop_is_asked();
    comm_add(solver->comm, &stopped, 1);
    alloc_free(leaves);
    alloc_free(open);
    return stopped == 0;
}
