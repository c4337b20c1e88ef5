/* Step 3: roots in descending order of weight, each to the rank with the smallest sum so far
 * (Graham's rule: no sum is above 4/3 of the best possible maximum). The paper's root processor
 * decides and informs the others; here everyone has the weights and decides alike. */
#include "mpi/assign.h"

#include <stdlib.h>

#include "geom/alloc.h"
#include "mpi/balance.h"

/* Push-pull and a step of the solver take as long for a patch as light over so many links. */
enum { LINKS_PER_OWN = 7 };

/* Itself, and by its part of the area as many patches more as there are roots. */
int64_t root_weight(const struct model *model, int32_t root)
{
    double share = scene_root_area(model->scene, root) / model->area;
    return LINKS_PER_OWN + (int64_t)(LINKS_PER_OWN * share * scene_root_count(model->scene));
}

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
    items_deal(sorted, roots, sums, ranks, homes);
    for (int32_t i = 0; i < roots; i++)
        owner[candidates[i].root] = homes[i];
    alloc_free(homes);
    alloc_free(sums);
    alloc_free(sorted);
    alloc_free(candidates);
}
