/* The roots in a binary tree of boxes, so that pairs of them can be treated in groups: what
 * holds for all pairs between two boxes is found out once. */
#ifndef RAD_BOXTREE_H
#define RAD_BOXTREE_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/scene.h"

enum {
    BOX_ROOTS = 2,  /* roots in a leaf at most */
    BLOCK_MAX = 128 /* roots in a block at most */
};

struct boxnode {
    struct vec3 low, high;               /* box around the roots, scene units */
    struct vec3 normal_low, normal_high; /* box around their unit normals */
    int32_t first, count;                /* its roots are roots[first] to roots[first + count - 1] */
    int32_t children;                    /* number of the first child, the other one follows;
                                            0: a leaf */
    int32_t block;                       /* its number if it is a block, else -1 */
};

/* Blocks are the first nodes on the way down that have at most `block_roots` roots. They are
 * numbered in the order of their roots. */
struct boxtree {
    struct boxnode *nodes; /* [node_count]; the first holds all */
    int32_t *roots;        /* [root_count], those that have an area */
    int32_t node_count, root_count, block_count, block_roots;
};

/* The tree over all roots of the scene that have an area; at least one has. */
struct boxtree *boxtree_create(const struct scene *scene);
void boxtree_destroy(struct boxtree *tree);

static inline bool boxnode_is_leaf(const struct boxnode *node)
{
    return node->children == 0;
}

/* A node of one root alone. */
struct boxnode boxnode_of_root(const struct scene *scene, int32_t root);

/* False if it is certain that no root of one node faces any of the other: facets_face() is false
 * for all pairs between them. */
bool boxnodes_may_face(const struct boxnode *p, const struct boxnode *q);
#endif
