/* Tests of rad/beyond/patch_exchange.h: bounds and symmetry hold for any pair, and pairs
 * that are proved to be blocked are. */
#include "rad/beyond/patch_exchange.h"

#include "geom/lambert.h"

#include "tests/scenes.h"
#include "tests/tap.h"

/* Nothing known. */
static struct exchange estimate(const struct facet *p, const struct facet *q,
                                const struct octree *octree,
                                struct octree_counts *counts)
{
    struct visibility visibility = {.open = false, .blocker = -1};
    return exchange_estimate(p, q, octree, &visibility, counts);
}

enum { PAIRS = 20000 };

/* --- bounds and symmetry of any pair --- */

static struct facet facet_of(struct triangle t, int32_t input)
{
    return (struct facet){t, triangle_plane(&t), triangle_area(&t), input};
}

static struct triangle moved(struct triangle t, struct vec3 step)
{
    for (int k = 0; k < 3; k++)
        t.corner[k] = vec3_add(t.corner[k], step);
    return t;
}

/* Scaled about its first corner. */
static struct triangle scaled(struct triangle t, double scale)
{
    for (int k = 1; k < 3; k++)
        t.corner[k] = vec3_add(t.corner[0],
                               vec3_scale(vec3_sub(t.corner[k], t.corner[0]), scale));
    return t;
}

/* Obtuse and flat: its height over its longest side is a small part of that. */
static struct triangle flat_triangle(struct random *random)
{
    struct triangle t = random_triangle(random, 0.1, 0.4);
    double flatness = pow(10.0, random_between(random, -5.0, -0.5));
    struct vec3 foot = vec3_add(vec3_scale(t.corner[0], 0.4),
                                vec3_scale(t.corner[1], 0.6));
    t.corner[2] = vec3_add(foot, vec3_scale(vec3_sub(t.corner[2], foot), flatness));
    return t;
}

enum kind { APART, NEAR, TOUCHING, SMALL_OVER_LARGE, FLAT, KINDS };

/* Two triangles with an area, in a relation of this kind. */
static void random_pair(struct random *random, enum kind kind, struct triangle pair[2])
{
    struct triangle t = kind == FLAT ? flat_triangle(random) : random_triangle(random,
                                                                               0.1, 0.4);
    struct triangle u = random_triangle(random, 0.1, 0.4);
    struct vec3 normal = vec3_unit(triangle_cross(&t));
    double distance = pow(10.0, random_between(random, -8.0, 0.0)) * 0.2;
    struct vec3 above = vec3_scale(normal, distance);
    switch (kind) {
    case NEAR: /* almost parallel or parallel */
        u = moved(reversed(t), above);
        if (random_bits(random) & 1)
            u.corner[1] = vec3_add(u.corner[1], random_point(random, 0.5 * distance));
        break;
    case TOUCHING: /* at a corner, or along an edge */
        u.corner[0] = t.corner[0];
        if (random_bits(random) & 1)
            u.corner[1] = t.corner[2];
        break;
    case SMALL_OVER_LARGE:
    case FLAT:
        u = scaled(u, random_between(random, 0.001, 0.2));
        u = moved(u, vec3_sub(triangle_centroid(&t), u.corner[0]));
        if (random_bits(random) & 1) {
            double size = vec3_length(vec3_sub(u.corner[1], u.corner[0]));
            struct triangle similar = scaled(reversed(t), size);
            struct vec3 centre = triangle_centroid(&similar);
            u = moved(similar, vec3_sub(triangle_centroid(&t), centre));
        }
        u = moved(u, above);
        break;
    default: break;
    }
    pair[0] = t;
    pair[1] = u;
}

/* --- facing --- */

static void test_facing(void)
{
    struct triangle floor = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    struct facet p = facet_of(floor, 0);
    struct facet above = facet_of(moved(reversed(floor), point(0, 0, 1)), 1);
    struct facet up = facet_of(moved(floor, point(0, 0, 1)), 1);
    struct facet below = facet_of(moved(reversed(floor), point(0, 0, -1)), 1);
    struct facet beside = facet_of(moved(floor, point(2, 0, 0)), 1);
    struct facet inside = facet_of(floor, 1);
    struct facet cut = facet_of((struct triangle){{{2, 0, -1}, {2, 1, -1}, {2, 0, 0.1}}},
                                1);
    struct facet turned = facet_of(reversed(cut.triangle), 1);
    tap_ok(facets_face(&p, &above) && facets_face(&above, &p),
           "a ceiling faces the floor");
    tap_ok(!facets_face(&p, &up) && !facets_face(&up, &p) && !facets_face(&p, &below),
           "a floor above does not, nor one below");
    tap_ok(!facets_face(&p, &beside) && !facets_face(&p, &inside) && !facets_face(&p, &p),
           "nor does one in the plane");
    tap_ok(facets_face(&p, &turned) && !facets_face(&p, &cut),
           "a wall that rises above the floor faces it with its front");
}

/* Only the tip of the wall rises above the floor, and all its centroids lie below: no
 * ray can be fired, but the pair stays in play. */
static void test_horizon(void)
{
    struct soup soup = {0};
    soup_add(&soup, (struct triangle){{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
    soup_add(&soup, (struct triangle){{{1, 0, -1}, {1, 0, 0.05}, {1, 1, -1}}});
    struct world world = world_make(scene_of_soup(&soup));
    struct facet p = facet_make(world.model.forest, 0), q = facet_make(world.model.forest,
                                                                       1);
    struct octree_counts counts = {0};
    struct exchange exchange = estimate(&p, &q, world.octree, &counts);
    tap_ok(facets_face(&p, &q) && counts.rays == 0 && exchange.area == 0.0 &&
               !facets_are_walled_off(&p, &q, world.octree, &counts) &&
               exchange.unoccluded > 0.0 && exchange.unoccluded <= fmin(p.area, q.area),
           "a pair at the horizon gets no ray, is not blocked, and keeps an estimate");
    world_free(&world);
}

/* --- blocked for sure --- */

/* Exchange of two triangles face to face with one between them: scaled by `size` from a
 * cover of all straight lines, exactly. */
static struct exchange between(double size, bool reverse, bool *walled_off)
{
    struct triangle p = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    struct triangle t = moved(p, point(0, 0, 0.5)), q = moved(reversed(p),
                                                              point(0, 0, 1));
    struct vec3 centre = triangle_centroid(&t);
    for (int k = 0; k < 3; k++)
        t.corner[k] = vec3_add(centre, vec3_scale(vec3_sub(t.corner[k], centre), size));
    struct soup soup = {0};
    struct octree_counts counts = {0};
    soup_add(&soup, p);
    soup_add(&soup, q);
    soup_add(&soup, reverse ? reversed(t) : t);
    struct world world = world_make(scene_of_soup(&soup));
    struct facet facet_p = facet_make(world.model.forest, 0);
    struct facet facet_q = facet_make(world.model.forest, 1);
    struct exchange exchange = estimate(&facet_p, &facet_q, world.octree, &counts);
    *walled_off = facets_are_walled_off(&facet_p, &facet_q, world.octree, &counts);
    world_free(&world);
    return exchange;
}

/* (Walls of several pieces: tests/geom/wall.c.) */
static void test_proof(void)
{
    bool speck, cover, back, small;
    struct exchange free = between(1e-3, false, &speck);
    struct exchange covered = between(1.01, false, &cover);
    between(1.01, true, &back);
    struct exchange open = between(0.99, false, &small);
    tap_ok(free.area > 0.9 * free.unoccluded && !speck,
           "a speck between two triangles proves nothing");
    tap_ok(cover && back && covered.area == 0.0 && covered.unoccluded == free.unoccluded,
           "a triangle a little larger than needed is a proof, from its back too");
    tap_ok(!small && open.area == 0.0 && open.unoccluded == free.unoccluded,
           "one a little too small is not, though no ray arrives");
}

/* --- points to polygons --- */

/* A speck close to a large triangle is a point to it, and the triangle is all but that
 * to the speck: the points have to be on the speck, whichever comes first. */
static void test_speck(void)
{
    struct triangle floor = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    struct triangle speck = {{{0.3, 0.3, 0.05}, {0.3, 0.3001, 0.05},
                              {0.3001, 0.3, 0.0501}}};
    struct facet p = facet_of(floor, -1), q = facet_of(speck, -1);
    struct octree *octree = octree_create(NULL, NULL, 0);
    struct octree_counts counts = {0};
    struct vec3 centre = triangle_centroid(&speck);
    double exact = q.area * point_triangle_factor(centre, q.plane.normal, &floor);
    struct exchange there = estimate(&p, &q, octree, &counts);
    struct exchange back = estimate(&q, &p, octree, &counts);
    /* Its size over its distance is 2e-3, and the error of a point is of second order. */
    tap_ok(exact > 0.5 * q.area && fabs(there.area / exact - 1.0) < 4e-6 &&
               fabs(back.area / exact - 1.0) < 4e-6,
           "a speck above a triangle: the points are on the speck (off by %.1e)",
           fabs(there.area / exact - 1.0));
    octree_destroy(octree);
}

/* --- any kind, any look --- */

struct blockers {
    struct triangle triangles[40];
    struct plane planes[40];
};

static struct octree *hang_blockers(struct blockers *blockers, double size, uint64_t seed)
{
    struct random random = random_seed(seed);
    for (int k = 0; k < 40; k++) {
        blockers->triangles[k] = random_triangle(&random, 0.5, size);
        blockers->planes[k] = triangle_plane(&blockers->triangles[k]);
    }
    return octree_create(blockers->triangles, blockers->planes, 40);
}

/* Two facets that face each other, of kinds in turn. */
static bool make_facing(struct random *random, int i, struct facet *p, struct facet *q)
{
    struct triangle pair[2];
    random_pair(random, (enum kind)(i % KINDS), pair);
    if (triangle_is_degenerate(&pair[0]) || triangle_is_degenerate(&pair[1]))
        return false;
    *p = facet_of(pair[0], -1);
    *q = facet_of(pair[1], -1);
    return facets_face(p, q);
}

static bool parts_are_whole(const double parts[4])
{
    bool positive = true;
    for (int k = 0; k < 4; k++)
        positive = positive && parts[k] >= 0.0;
    /* four quotients of a sum */
    return positive && fabs((parts[0] + parts[1]) + (parts[2] + parts[3]) - 1.0) < 1e-14;
}

static bool parts_match(const struct exchange *there, const struct exchange *back)
{
    bool same = true;
    for (int k = 0; k < 4; k++)
        same = same && fabs(there->parts_p[k] - back->parts_q[k]) < 1e-14 &&
               fabs(there->parts_q[k] - back->parts_p[k]) < 1e-14;
    return same;
}

static bool is_within_bounds(const struct exchange *e, const struct facet *p,
                             const struct facet *q)
{
    return e->area >= 0.0 && e->area <= e->unoccluded && e->unoccluded <= fmin(p->area,
                                                                               q->area) &&
           e->seen >= 0.0 && e->seen <= 1.0 && (e->seen > 0.0 || e->area == 0.0);
}

/* Pairs that are wrong, by the law that they break. */
struct findings {
    int facing, partly; /* pairs looked at; those seen in part */
    int outside, more, broken, one_way, dim, walls;
};

static void judge_pair(const struct facet *p, const struct facet *q,
                       const struct octree *octree, const struct octree *none,
                       struct findings *found)
{
    struct octree_counts counts = {0};
    struct exchange blocked = estimate(p, q, octree, &counts);
    struct exchange back = estimate(q, p, octree, &counts);
    struct exchange free = estimate(p, q, none, &counts);
    struct visibility open = {.open = true, .blocker = -1};
    int64_t rays = counts.rays;
    struct exchange told = exchange_estimate(p, q, octree, &open, &counts);
    found->facing++;
    found->partly += blocked.seen > 0.0 && blocked.seen < 1.0;
    found->outside += !is_within_bounds(&blocked, p, q) || !is_within_bounds(&free, p, q);
    found->more += !(blocked.area <= free.area) || blocked.unoccluded != free.unoccluded;
    found->broken += !parts_are_whole(blocked.parts_p) ||
                     !parts_are_whole(blocked.parts_q);
    /* Sums of 16 terms in another order; points are on the same side if areas differ. */
    found->one_way +=
        (fabs(back.area - blocked.area) > 1e-14 * blocked.area ||
         fabs(back.unoccluded - blocked.unoccluded) > 1e-14 * blocked.unoccluded) &&
        p->area != q->area;
    found->one_way += blocked.area > 0.0 && !parts_match(&blocked, &back);
    found->dim += told.area != free.area || told.seen != free.seen || counts.rays != rays;
    bool walled_off = facets_are_walled_off(p, q, octree, &counts);
    found->walls += (walled_off && blocked.area > 0.0) ||
                    walled_off != facets_are_walled_off(q, p, octree, &counts);
}

/* 40 small blockers hang around, so that some pairs see each other in part. */
static void test_any(void)
{
    struct random random = random_seed(71);
    struct blockers blockers;
    struct octree *octree = hang_blockers(&blockers, 0.2, 5),
                  *none = octree_create(NULL, NULL, 0);
    struct findings found = {0};
    for (int i = 0; i < PAIRS; i++) {
        struct facet p, q;
        if (make_facing(&random, i, &p, &q))
            judge_pair(&p, &q, octree, none, &found);
    }
    tap_ok(found.facing > PAIRS / 2 && found.partly > 50 &&
               found.outside == 0,
           "%d pairs exchange from 0 to the smaller area, %d are seen in part",
           found.facing, found.partly);
    tap_ok(found.more == 0, "blockers never add");
    tap_ok(found.broken == 0, "parts are not negative and add up to 1");
    tap_ok(found.one_way == 0, "the same in both directions, parts too");
    tap_ok(found.dim == 0, "where nothing can stand in between no ray is fired");
    tap_ok(found.walls == 0, "pairs proved to be blocked exchange nothing");
    octree_destroy(octree);
    octree_destroy(none);
}

int main(void)
{
    test_facing();
    test_horizon();
    test_proof();
    test_speck();
    test_any();
    return tap_done();
}
