/* Bundles of the octree against brute force in double precision: 100,000 segments in each
 * of three scenes; a third of their end points lie on edges and corners. No answer may
 * differ, near edges or not: cases that float cannot decide are decided by the same test
 * in double. */
#include "octree/lanes.h"
#include "tests/scenes.h"
#include "tests/tap.h"

enum { BUNDLES = 6250 }; /* of 16 segments each */

static void make_soup(struct soup *soup)
{
    struct random random = random_seed(11);
    for (int i = 0; i < 800; i++)
        soup_add(soup, random_triangle(&random, 0.5, i % 8 ? 0.06 : 0.3));
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
    for (int ray = 0; ray < BUNDLE_RAYS; ray++)
        if (brute_blocker(scene->triangles, scene->planes, scene->input_count,
                          bundle->from[ray / BUNDLE_ENDS], bundle->to[ray % BUNDLE_ENDS],
                          bundle->own) >= 0)
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
    struct octree_counts counts = {0};
    int wrong = 0, blocked = 0;
    int32_t guess = -1;
    for (int i = 0; i < BUNDLES; i++) {
        struct bundle bundle = random_bundle(&random, world.scene);
        unsigned answer = octree_block(world.octree, &bundle, &guess, &counts);
        wrong += bit_count(answer ^ brute_force(world.scene, &bundle));
        blocked += answer != 0;
    }
    tap_ok(wrong == 0 && counts.rays == (int64_t)BUNDLES * BUNDLE_RAYS,
           "%s: of %d segments %d have another answer than brute force", name,
           BUNDLES * BUNDLE_RAYS, wrong);
    tap_ok(blocked > BUNDLES / 20, "%s: %d bundles meet something", name, blocked);
    world_free(&world);
}

int main(void)
{
    test_scene(make_soup, "soup");
    test_scene(make_star, "star");
    test_scene(make_planes, "planes");
    return tap_done();
}
