/* Smooth shading as pictures have it. For tests on one rank. */
#ifndef TESTS_SHADED_H
#define TESTS_SHADED_H

#include "geom/alloc.h"
#include "io/picture/shading.h"

/* Surveys the leaves, and shades them as shading_create(). */
static inline struct shading *shade_forest(const struct forest *forest,
                                           const struct octree *octree,
                                           const struct rgb *less, const float *error)
{
    int64_t leaves;
    uint8_t *open = shading_open_parts(forest, octree, 0, 1, &leaves);
    struct shading *shading = shading_create(forest, less, error, open);
    alloc_free(open);
    return shading;
}

#endif
