/* The tree above the roots as one rank makes it. */
#ifndef TESTS_TREES_H
#define TESTS_TREES_H

#include "geom/alloc.h"
#include "rad/beyond/cluster.h"

/* With rays through the octree; NULL: without. */
static inline struct cluster_tree *tree_create(const struct scene *scene,
                                               const struct octree *octree)
{
    int32_t *met = octree ? places_met(scene, octree, 0, scene_root_count(scene)) : NULL;
    struct spaces *spaces = spaces_create(scene, met);
    struct cluster_tree *tree = cluster_tree_build(scene, spaces);
    alloc_free(met);
    spaces_destroy(spaces);
    return tree;
}

#endif
