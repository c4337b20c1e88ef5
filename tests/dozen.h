/* A dozen roots that light is pushed down and pulled up, for tests of step 6. */
#ifndef TESTS_DOZEN_H
#define TESTS_DOZEN_H

#include "tests/scenes.h"

enum { ROOTS = 12, NO_AREA = 5, BLACK = 7 };

/* Random triangles, one without an area. Materials: two that reflect, the first emits,
 * and a black one. */
static inline struct world make_world(void)
{
    struct soup soup = {0};
    struct random random = random_seed(1);
    for (int i = 0; i < ROOTS; i++)
        soup_add(&soup, random_triangle(&random, 0.5, 0.3));
    soup.items[NO_AREA].corner[2] = soup.items[NO_AREA].corner[0];
    struct scene *scene = scene_of_soup(&soup, 3);
    for (int32_t i = 0; i < ROOTS; i++)
        scene->material_of[i] = i == BLACK ? 2 : i % 2;
    scene->materials[0] = (struct material){{{0.5, 0.25, 0.75}}, {{1.0, 2.0, 0.5}}};
    scene->materials[1] = (struct material){{{0.98, 0.0, 0.1}}, {{0.0, 0.0, 0.0}}};
    soup_free(&soup);
    return world_make(scene);
}

#endif
