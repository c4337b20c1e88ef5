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
    soup_add_random(&soup, &random, ROOTS, 0.5, 0.3);
    soup.items[NO_AREA].corner[2] = soup.items[NO_AREA].corner[0];
    paint_with(&soup, (struct material){{{0.5, 0.25, 0.75}}, {{1.0, 2.0, 0.5}}});
    paint_with(&soup, (struct material){{{0.98, 0.0, 0.1}}, {{0.0, 0.0, 0.0}}});
    paint(&soup, 0, 0);
    struct scene *scene = scene_of_soup(&soup);
    for (int32_t i = 0; i < ROOTS; i++)
        scene->material_of[i] = i == BLACK ? 2 : i % 2;
    return world_make(scene);
}

#endif
