/* Links over which light is transferred, for tests of both kinds of links. */
#ifndef TESTS_TRANSFERS_H
#define TESTS_TRANSFERS_H

#include "tests/pairs.h"

enum { ROOTS = 20 };

static inline struct world make_many(void)
{
    struct soup soup = {0};
    struct random random = random_seed(1);
    soup_add_random(&soup, &random, ROOTS, 0.5, 0.2);
    paint(&soup, 0.5, 1);
    struct world world = world_make(scene_of_soup(&soup));
    for (int32_t r = 0; r < ROOTS; r += 2)
        forest_split(world.model.forest, r);
    set_randomly(world.model.forest, &random);
    return world;
}

static const struct link PLAIN = {.p = 3, .q = 7, .area = 0.25f, .parts_p = {64, 64, 64},
                                  .parts_q = {64, 64,
                                              64}, .seen = LINK_ALL_SEEN, .cost = 1};

#endif
