/* Step 3: re-assignment. Roots in descending order of area, each to the rank with the
 * smallest sum so far (Graham's rule: no sum is above 4/3 of the best possible maximum).
 * The paper's root processor decides and informs the others; here all have the areas and
 * decide alike.
 *
 * Then each link goes to the home of one of its two roots, i or j by the parity of
 * i + j. */
#include "mpi/assign.h"

#include <stdlib.h>

#include "geom/alloc.h"
#include "mpi/migrate.h"

/* --- homes of roots --- */

/* A heap of ranks, the smallest load on top. */
struct heap {
    int *ranks; /* [count] */
    int count;
    int64_t *loads; /* [count] of each rank */
};

static bool goes_before(const struct heap *heap, int a, int b)
{
    int64_t x = heap->loads[a], y = heap->loads[b];
    return x != y ? x < y : a < b;
}

static void sink(struct heap *heap, int at)
{
    for (int child = 2 * at + 1; child < heap->count; child = 2 * at + 1) {
        if (child + 1 < heap->count &&
            goes_before(heap, heap->ranks[child + 1], heap->ranks[child]))
            child++;
        int rank = heap->ranks[at], below = heap->ranks[child];
        if (!goes_before(heap, below, rank))
            return;
        heap->ranks[at] = below;
        heap->ranks[child] = rank;
        at = child;
    }
}

struct weighted {
    int64_t weight;
    int32_t number;
};

static int compare_items(const void *left, const void *right)
{
    const struct weighted *a = left, *b = right;
    if (a->weight != b->weight)
        return a->weight > b->weight ? -1 : 1;
    return a->number < b->number ? -1 : 1;
}

void items_deal(const int64_t *weights, int32_t count, int ranks, int *owner)
{
    struct weighted *items = alloc_array((size_t)count, sizeof *items);
    for (int32_t i = 0; i < count; i++)
        items[i] = (struct weighted){weights[i], i};
    qsort(items, (size_t)count, sizeof *items, compare_items);
    struct heap heap = {.count = ranks};
    heap.ranks = alloc_array((size_t)ranks, sizeof *heap.ranks);
    heap.loads = alloc_array((size_t)ranks, sizeof *heap.loads);
    for (int r = 0; r < ranks; r++)
        heap.ranks[r] = r; /* a heap, as all loads are 0 */
    for (int32_t i = 0; i < count; i++) {
        owner[items[i].number] = heap.ranks[0];
        heap.loads[heap.ranks[0]] += items[i].weight;
        sink(&heap, 0);
    }
    alloc_free(heap.loads);
    alloc_free(heap.ranks);
    alloc_free(items);
}

/* --- step 3 --- */

static void send_home(struct solver *solver)
{
    const struct patch *patches = solver->model.forest->patches;
    int *destination = alloc_array((size_t)solver->links.count, sizeof *destination);
    for (int64_t i = 0; i < solver->links.count; i++) {
        const struct link *link = &solver->links.items[i];
        uint32_t a = patches[link->p].id.root, b = patches[link->q].id.root;
        destination[i] = solver->homes.owner[(a ^ b) % 2 == 0 ? a : b];
    }
    links_migrate(solver, &solver->links, destination);
    alloc_free(destination);
}

void solver_assign_roots(struct solver *solver)
{
    double start = comm_seconds();
    const struct model *model = &solver->model;
    int32_t roots = model->forest->root_count;
    int64_t *weights = alloc_array((size_t)roots, sizeof *weights);
    for (int32_t root = 0; root < roots; root++) /* areas, in parts of 2^-40 of all */
        weights[root] =
            (int64_t)(scene_root_area(model->scene, root) / model->whole_area * 0x1p40);
    items_deal(weights, roots, solver->comm->size, solver->homes.owner);
    alloc_free(weights);
    for (int32_t root = 0; root < roots; root++)
        solver->homes.own[root] = solver->homes.owner[root] == solver->comm->rank;
    if (!solver->memory.clusters) /* clusters have no home */
        send_home(solver);
    solver->account.seconds[PHASE_LINKING] += comm_seconds() - start;
}
