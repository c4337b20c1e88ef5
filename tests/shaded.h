/* Smooth shading as pictures have it. For tests on one rank. */
#ifndef TESTS_SHADED_H
#define TESTS_SHADED_H

#include "io/picture/shading.h"
#include "tests/scenes.h"

/* A scene with all that stands on it. */
struct stage {
    struct scene *scene;
    struct octree *octree;
    struct forest *forest;
    struct shading *shading;
};

static inline struct stage stage_of(struct scene *scene)
{
    struct world world = world_make(scene);
    return (struct stage){scene, world.octree, world.model.forest, NULL};
}

static inline void shade_stage(struct stage *stage, bool flat)
{
    shading_destroy(stage->shading);
    stage->shading =
        flat ? shading_create_flat(stage->forest)
             : shading_create(stage->forest, stage->octree, NULL, NULL, NULL);
}

static inline void dismantle(struct stage *stage)
{
    shading_destroy(stage->shading);
    forest_destroy(stage->forest);
    octree_destroy(stage->octree);
    scene_destroy(stage->scene);
}

static inline void split_regularly(struct forest *forest, int level)
{
    for (int32_t p = 0; p < forest->count; p++)
        if (id_level(forest->patches[p].id) < level)
            forest_split(forest, p);
}

static inline struct rgb value_at(const struct stage *stage, int32_t root, struct vec3 w)
{
    const double weight[3] = {w.x, w.y, w.z};
    return shading_at(stage->shading, stage->shading->values, root, weight);
}

#endif
