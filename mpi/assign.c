/* Step 3: roots in descending order of area, each to the rank with the smallest sum so far
 * (Graham's rule: no sum is above 4/3 of the best possible maximum). The paper's root processor
 * decides and informs the others; here everyone has the areas and decides alike. */
#include "mpi/assign.h"

#include <stdlib.h>

#include "geom/alloc.h"

struct candidate {
    double area;
    int32_t root;
};

static int compare_candidates(const void *left, const void *right)
{
    const struct candidate *a = left, *b = right;
    if (a->area != b->area)
        return a->area > b->area ? -1 : 1;
    return a->root < b->root ? -1 : 1;
}

void roots_assign(const struct scene *scene, int ranks, int *owner)
{
    int32_t roots = scene_root_count(scene);
    struct candidate *candidates = alloc_array((size_t)roots, sizeof *candidates);
    double *sums = alloc_array((size_t)ranks, sizeof *sums);
    for (int32_t root = 0; root < roots; root++)
        candidates[root] = (struct candidate){scene_root_area(scene, root), root};
    qsort(candidates, (size_t)roots, sizeof *candidates, compare_candidates);
    for (int32_t i = 0; i < roots; i++) {
        int emptiest = 0;
        for (int r = 1; r < ranks; r++)
            if (sums[r] < sums[emptiest])
                emptiest = r;
        sums[emptiest] += candidates[i].area;
        owner[candidates[i].root] = emptiest;
    }
    alloc_free(candidates);
    alloc_free(sums);
}
