/* Step 3: roots in descending order of weight, each to the rank with the smallest sum
 * so far (Graham's rule: no sum is above 4/3 of the best possible maximum). The paper's
 * root processor decides and informs the others; here all have the weights and decide
 * alike. */
#include "mpi/assign.h"

#include <stdbool.h>
#include <stdlib.h>

#include "geom/alloc.h"

/* A heap of ranks, the smallest load on top. */
struct heap {
    int *ranks; /* [count] */
    int count;
    const int64_t *loads;
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

static void deal_items(const int64_t *costs, int64_t count, int64_t *loads, int ranks,
                int *owner)
{
    struct heap heap = {.ranks = alloc_array((size_t)ranks, sizeof *heap.ranks),
                        .count = ranks,
                        .loads = loads};
    for (int r = 0; r < ranks; r++)
        heap.ranks[r] = r;
    for (int at = ranks / 2; at >= 0; at--)
        sink(&heap, at);
    for (int64_t i = 0; i < count; i++) {
        owner[i] = heap.ranks[0];
        loads[owner[i]] += costs[i];
        sink(&heap, 0);
    }
    alloc_free(heap.ranks);
}

/* --- roots --- */

struct candidate {
    int64_t weight;
    int32_t root;
};

static int compare_candidates(const void *left, const void *right)
{
    const struct candidate *a = left, *b = right;
    if (a->weight != b->weight)
        return a->weight > b->weight ? -1 : 1;
    return a->root < b->root ? -1 : 1;
}

void roots_assign(const int64_t *weights, int32_t roots, int ranks, int *owner)
{
    struct candidate *candidates = alloc_array((size_t)roots, sizeof *candidates);
    int64_t *sorted = alloc_array((size_t)roots, sizeof *sorted);
    int64_t *sums = alloc_array((size_t)ranks, sizeof *sums);
    int *homes = alloc_array((size_t)roots, sizeof *homes);
    for (int32_t root = 0; root < roots; root++)
        candidates[root] = (struct candidate){weights[root], root};
    qsort(candidates, (size_t)roots, sizeof *candidates, compare_candidates);
    for (int32_t i = 0; i < roots; i++)
        sorted[i] = candidates[i].weight;
    deal_items(sorted, roots, sums, ranks, homes);
    for (int32_t i = 0; i < roots; i++)
        owner[candidates[i].root] = homes[i];
    alloc_free(homes);
    alloc_free(sums);
    alloc_free(sorted);
    alloc_free(candidates);
}
