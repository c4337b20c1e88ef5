/* Pairs of triangles that face each other, for tests of blockers between two patches. */
#ifndef TESTS_PAIRS_H
#define TESTS_PAIRS_H

#include "rad/link.h"

#include "tests/scenes.h"

/* A right triangle in the plane z, its right angle at x, facing up or down. */
static inline struct triangle tile(double x, double z, double size, bool up)
{
    struct vec3 a = {x, 0, z}, b = {x + size, 0, z}, c = {x, size, z};
    return up ? (struct triangle){{a, b, c}} : (struct triangle){{a, c, b}};
}

/* The link between two patches as an initial link. */
static inline bool make(struct world *world, int32_t p, int32_t q, struct link *link)
{
    struct facet facet_p = facet_make(world->model.forest, p);
    struct facet facet_q = facet_make(world->model.forest, q);
    return world->model.method.make_link(&world->model, p, &facet_p, q, &facet_q, NULL,
                                         link);
}

/* G = 1/8, even parts, and nothing can stand in between. */
static inline struct link link_of(int32_t p, int32_t q)
{
    return (struct link){.p = p, .q = q, .area = 0.125f, .blocker = -1,
                         .parts_p = {64, 64, 64},
                         .parts_q = {64, 64, 64}, .seen = LINK_OPEN, .cost = 0};
}

/* Floor 0 (material 0) and ceiling `size` times as large (material 1), then `more`, which
 * is emptied. */
static inline struct world make_pair(double size, struct material floor,
                                     struct material ceiling, struct soup *more)
{
    struct soup soup = {0};
    soup_add(&soup, tile(0, 0, 1, true));
    paint_with(&soup, floor);
    soup_add(&soup, tile(0, 1, size, false));
    paint_with(&soup, ceiling);
    for (int64_t i = 0; more && i < more->count; i++)
        soup_add(&soup, more->items[i]);
    paint(&soup, 0.0, 0.0);
    if (more)
        soup_free(more);
    return world_make(scene_of_soup(&soup));
}

static inline int64_t tests_done(const struct world *world)
{
    return world->model.counts.node_tests + world->model.counts.triangle_tests;
}

/* A triangle beside the pair, so that there is something to test: floor and ceiling
 * alone are the hull of their scene and block nothing. */
static inline struct soup bystander(void)
{
    struct soup more = {0};
    soup_add(&more,
             (struct triangle){{{0.5, 0.3, 0.5}, {0.5, 0.4, 0.5}, {0.5, 0.4, 0.6}}});
    return more;
}

#endif
