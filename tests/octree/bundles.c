/* Bundles of the octree, and their segments one by one, against brute force in double
 * precision: 100,000 segments in each of five scenes, ten times as many in `make prove`;
 * a third of their end points lie on edges and corners. No answer may differ, near edges
 * or not: cases that float cannot decide are decided by the same test in double. */
#include "octree/lanes.h"
#include "tests/scenes.h"
#include "tests/tap.h"

static int bundles = 6250; /* 16 segments each */

static void make_soup(struct soup *soup)
{
    struct random random = random_seed(11);
    for (int i = 0; i < 800; i++)
        soup_add(soup, random_triangle(&random, 0.5, i % 8 ? 0.06 : 0.3));
}

static void make_room(struct soup *soup)
{
    soup_add_box(soup, point(0, 0, 0), point(4, 3, 2.5), 6, true);
    for (int i = 0; i < 8; i++) {
        struct vec3 low = {0.2 + 0.45 * i, 0.3 + 0.2 * (i % 3), 0.0};
        struct vec3 high = {low.x + 0.4, low.y + 0.9, 0.4 + 0.2 * (i % 4)};
        soup_add_box(soup, low, high, 2, false);
    }
}

/* A thousand triangles through one point. */
static void make_star(struct soup *soup)
{
    struct random random = random_seed(12);
    for (int i = 0; i < 1000; i++)
        soup_add(soup, (struct triangle){{{0, 0, 0}, random_point(&random, 0.5),
                                          random_point(&random, 0.5)}});
}

/* Tiles in two planes, many of them twice, and needles across the whole scene. */
static void make_planes(struct soup *soup)
{
    struct random random = random_seed(13);
    soup_add_quad(soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 12);
    soup_add_quad(soup, point(0, 0, 0.3), point(1, 0, 0.2), point(0, 1, 0), 12);
    for (int i = 0; i < 200; i++)
        soup_add(soup, soup->items[2 * i]);
    for (int i = 0; i < 100; i++) {
        struct vec3 a = random_point(&random, 1.0), b = random_point(&random, 1.0), c = b;
        c.x += random_between(&random, -1e-5, 1e-5);
        soup_add(soup, (struct triangle){{a, b, c}});
    }
}

/* A fine ball in a coarse one: many small triangles, seen from far. */
static void make_balls(struct soup *soup)
{
    soup_add_sphere(soup, 1.0, 1);
    soup_add_sphere(soup, 0.2, 3);
}

/* On the triangle: inside, on an edge, or at a corner. */
static struct vec3 point_on(struct random *random, const struct triangle *t)
{
    int kind = random_below(random, 6), k = random_below(random, 3);
    if (kind == 0)
        return t->corner[k];
    if (kind > 1)
        return random_point_on(random, t);
    double share = random_unit(random);
    struct vec3 along = vec3_sub(t->corner[(k + 1) % 3], t->corner[k]);
    return vec3_add(t->corner[k], vec3_scale(along, share));
}

static unsigned brute_force(const struct scene *scene, const struct bundle *bundle)
{
    unsigned blocked = 0;
    for (int ray = 0; ray < BUNDLE_RAYS; ray++) {
        struct segment s = segment_make(bundle->from[ray / BUNDLE_ENDS],
                                        bundle->to[ray % BUNDLE_ENDS]);
        for (int32_t t = 0; t < scene->input_count && !(blocked >> ray & 1u); t++)
            if (t != bundle->own[0] && t != bundle->own[1] && scene->areas[t] > 0.0 &&
                segment_is_blocked_by(&s, &scene->triangles[t], &scene->planes[t]))
                blocked |= 1u << ray;
    }
    return blocked;
}

static unsigned block_one_by_one(const struct octree *octree, const struct bundle *bundle,
                                 int32_t *guess, struct octree_counts *counts)
{
    unsigned blocked = 0;
    for (int ray = 0; ray < BUNDLE_RAYS; ray++)
        if (octree_blocks_segment(octree, bundle->from[ray / BUNDLE_ENDS],
                                  bundle->to[ray % BUNDLE_ENDS], bundle->own, guess,
                                  counts))
            blocked |= 1u << ray;
    return blocked;
}

static struct bundle random_bundle(struct random *random, const struct scene *scene)
{
    struct bundle bundle = {.asked = (1u << BUNDLE_RAYS) - 1};
    for (int side = 0; side < 2; side++) {
        bundle.own[side] = random_below(random, scene->input_count);
        for (int k = 0; k < BUNDLE_ENDS; k++)
            (side ? bundle.to : bundle.from)[k] =
                point_on(random, &scene->triangles[bundle.own[side]]);
    }
    return bundle;
}

static void test_scene(void (*make)(struct soup *), const char *name)
{
    struct soup soup = {0};
    make(&soup);
    struct world world = world_make(scene_of_soup(&soup));
    struct random random = random_seed(14);
    struct octree_counts counts = {0}, alone = {0};
    int wrong = 0, wrong_alone = 0, blocked = 0;
    int32_t guess = -1, guess_alone = -1;
    for (int i = 0; i < bundles; i++) {
        struct bundle bundle = random_bundle(&random, world.scene);
        unsigned answer = octree_block(world.octree, &bundle, &guess, &counts);
        unsigned right = brute_force(world.scene, &bundle);
        wrong += bit_count(answer ^ right);
        wrong_alone += bit_count(
            block_one_by_one(world.octree, &bundle, &guess_alone, &alone) ^ right);
        blocked += answer != 0;
    }
    tap_ok(wrong == 0 && counts.rays == (int64_t)bundles * BUNDLE_RAYS,
           "%s: of %d segments %d have another answer than brute force", name,
           bundles * BUNDLE_RAYS, wrong);
    tap_ok(wrong_alone == 0 && alone.rays == counts.rays, "%s: one by one, %d", name,
           wrong_alone);
    tap_ok(blocked > bundles / 20, "%s: %d bundles meet something", name, blocked);
    world_free(&world);
}

int main(void)
{
    if (tap_proves())
        bundles *= 10;
    test_scene(make_soup, "soup");
    test_scene(make_room, "room");
    test_scene(make_star, "star");
    test_scene(make_planes, "planes");
    test_scene(make_balls, "balls");
    return tap_done();
}
