/* Work done, for predicting and reporting cost. */
#ifndef OCTREE_COUNTS_H
#define OCTREE_COUNTS_H

#include <stdint.h>

struct octree_counts {
    int64_t rays;           /* segments asked about */
    int64_t node_tests;     /* nodes, with all eight boxes, against a bundle or segment */
    int64_t triangle_tests; /* triangles against a bundle or segment */
};

static inline void octree_counts_add(struct octree_counts *counts,
                                     const struct octree_counts *more)
{
    counts->rays += more->rays;
    counts->node_tests += more->node_tests;
    counts->triangle_tests += more->triangle_tests;
}

#endif
