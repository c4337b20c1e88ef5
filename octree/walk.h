/* The walk down a tree, for every question; for octree/ only.
 *
 * A question goes down to the nearest child of a node as long as there is one, looks at
 * the triangles of the leaf, and goes on with the waiting children. Two functions of the
 * question, inlined at its place, say which children are met and which triangles end the
 * walk. */
#ifndef OCTREE_WALK_H
#define OCTREE_WALK_H

#include <stddef.h>

#include "octree/counts.h"
#include "octree/tree.h"

/* A node some of whose children wait. */
struct waiting {
    const struct node *node;
    unsigned met;       /* bit k: the child in octant k ^ near waits */
    float enter[LANES]; /* where a ray enters each child's box, by octant */
};

/* Returns the children met in a node, the one in octant k ^ near as bit k. Sets `enter`,
 * unless NULL, to the distance of each octant's box. */
typedef unsigned node_enter(const void *beam, const struct node *node,
                            float enter[LANES]);

/* Looks at the triangles of a leaf, and counts them. Returns true if the walk may end. */
typedef bool leaf_visit(void *query, const struct record *records, int32_t count,
                        struct octree_counts *counts);

/* Takes the next child within reach off the stack. Returns false if there is none. */
INLINE bool take_next(struct waiting *stack, int *height, int near, const float *reach,
                      int32_t *child)
{
    while (*height > 0) {
        struct waiting *top = &stack[*height - 1];
        int k = lowest_bit(top->met) ^ near;
        top->met &= top->met - 1;
        *height -= top->met == 0;
        if (!reach || top->enter[k] <= *reach) {
            *child = top->node->child[k];
            return true;
        }
    }
    return false;
}

/* Asks `query` of the leaves met by `beam`, the child in octant `near` first. `*reach` is
 * how far away boxes are still of use, and visits may shorten this; NULL: all are.
 * Returns true if a visit ends the walk. */
INLINE bool tree_walk(const struct tree *tree, node_enter *enter, const void *beam,
                      int near, const float *reach, leaf_visit *visit, void *query,
                      struct octree_counts *counts)
{
    struct waiting stack[TREE_LEVELS]; /* at most one for each level */
    int height = 0;
    int32_t child = 0;
    if (tree->node_count == 0)
        return false;
    do {
        while (child >= 0) {
            struct waiting *top = &stack[height];
            const struct node *node = &tree->nodes[child];
            unsigned met = enter(beam, node, reach ? top->enter : NULL);
            counts->node_tests++;
            if (met == 0)
                break;
            top->node = node;
            top->met = met & (met - 1);
            height += top->met != 0;
            child = node->child[lowest_bit(met) ^ near];
        }
        if (child < 0) {
            struct leaf leaf = leaf_of(child);
            if (visit(query, &tree->records[leaf.first], leaf.count, counts))
                return true;
        }
    } while (take_next(stack, &height, near, reach, &child));
    return false;
}

#endif
