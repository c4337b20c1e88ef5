/* Tests of rad/beyond/patch_exchange.h: sums over subdivided squares converge to exact
 * factors, bounds and symmetry hold for any pair, and pairs that are proved to be blocked
 * are. */
#include "rad/beyond/patch_exchange.h"

#include "geom/lambert.h"

#include "tests/scenes.h"
#include "tests/tap.h"
#include "geom/contour.h"

/* Nothing known. */
static struct exchange estimate(const struct facet *p, const struct facet *q,
                                enum form_factor kind, const struct octree *octree,
                                struct octree_counts *counts)
{
    struct visibility visibility = {.open = false, .blocker = -1};
    return exchange_estimate(p, q, kind, octree, &visibility, counts);
}

/* 16 disks, 16 segments: the paper's. */
static struct exchange exchange_of(const struct facet *p, const struct facet *q,
                                   const struct octree *octree,
                                   struct octree_counts *counts)
{
    return estimate(p, q, FORM_FACTOR_DISK, octree, counts);
}

enum { PAIRS = 20000 };

/* --- sums over subdivided squares --- */

/* The facets of all patches of this level under roots first .. first + 1. */
static int64_t make_facets(const struct forest *forest, int32_t first, int level,
                           struct facet *facets)
{
    int64_t count = 0;
    for (int32_t root = first; root < first + 2; root++)
        for (int32_t p = root; p >= 0; p = forest_next(forest, p, true))
            if (id_level(forest->patches[p].id) == level)
                facets[count++] = facet_make(forest, p);
    return count;
}

static void split_all(struct forest *forest, int levels)
{
    for (int level = 0; level < levels; level++)
        for (int64_t p = 0, count = forest->count; p < count; p++)
            forest_split(forest, (int32_t)p);
}

/* The parallelogram origin, origin + u, origin + u + v, origin + v. */
struct square {
    struct vec3 origin, u, v;
};

static double exact_factor(const struct square *p, const struct square *q)
{
    struct vec3 corner[2][4];
    for (int k = 0; k < 2; k++) {
        const struct square *s = k ? q : p;
        corner[k][0] = s->origin;
        corner[k][1] = vec3_add(s->origin, s->u);
        corner[k][2] = vec3_add(corner[k][1], s->v);
        corner[k][3] = vec3_add(s->origin, s->v);
    }
    return polygon_exchange(corner[0], 4, corner[1], 4) / polygon_area(corner[0], 4);
}

/* Form factor from p to q, each in two triangles, with patches of these levels. */
static double form_factor(const struct square *p, const struct square *q, int level_p,
                          int level_q)
{
    struct soup soup = {0};
    soup_add_quad(&soup, p->origin, p->u, p->v, 1);
    soup_add_quad(&soup, q->origin, q->u, q->v, 1);
    struct world world = world_make(scene_of_soup(&soup));
    struct forest *forest = world.model.forest;
    split_all(forest, level_p > level_q ? level_p : level_q);
    struct facet *from = alloc_array((size_t)2 << (2 * level_p), sizeof *from);
    struct facet *to = alloc_array((size_t)2 << (2 * level_q), sizeof *to);
    int64_t count_p = make_facets(forest, 0, level_p, from);
    int64_t count_q = make_facets(forest, 2, level_q, to);
    struct octree_counts counts = {0};
    double sum = 0.0, area = 0.0;
    for (int64_t i = 0; i < count_p; i++) {
        area += from[i].area;
        for (int64_t j = 0; j < count_q; j++)
            if (facets_face(&from[i], &to[j]))
                sum += exchange_of(&from[i], &to[j], world.octree, &counts).area;
    }
    alloc_free(from);
    alloc_free(to);
    world_free(&world);
    return sum / area;
}

/* A small area is a point, and the disk has a wrong shape and its area in the
 * denominator: both errors fall with the square of the size, so 4 times with each level.
 * At a common edge distance and size shrink alike: there the error of each pair stays,
 * and the share of such pairs falls, half with each level. Bounds are the measured errors
 * and a quarter more: the method's honest accuracy. */
static void test_squares(void)
{
    static const struct {
        const char *name;
        struct square p, q;
        double bound[4]; /* of levels 0 to 3 */
        double ratio;    /* by which the error falls in the last level */
    } CASES[] = {{"parallel squares at 0.5",
                  {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                  {{0, 0, 0.5}, {0, 1, 0}, {1, 0, 0}},
                  {1.2e-2, 5.7e-3, 1.7e-3, 4.4e-4},
                  3.8},
                 {"parallel squares at 1",
                  {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                  {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}},
                  {2.6e-2, 5.6e-3, 1.4e-3, 3.4e-4},
                  3.8},
                 {"parallel squares at 4",
                  {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                  {{0, 0, 4}, {0, 1, 0}, {1, 0, 0}},
                  {5.1e-3, 1.3e-3, 3.1e-4, 7.8e-5},
                  3.8},
                 {"perpendicular squares with a gap",
                  {{1, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                  {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                  {5.6e-3, 1.1e-3, 2.4e-4, 5.9e-5},
                  3.8},
                 {"perpendicular squares with a common edge",
                  {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                  {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                  {1.4e-3, 8.3e-3, 7.3e-3, 4.7e-3},
                  1.5}};
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; i++) {
        const struct square *p = &CASES[i].p, *q = &CASES[i].q;
        double error[4], exact = exact_factor(p, q);
        for (int level = 0; level < 4; level++) {
            error[level] = fabs(form_factor(p, q, level, level) / exact - 1.0);
            tap_ok(error[level] < CASES[i].bound[level],
                   "%s, level %d: off by %.1e, allowed %.1e", CASES[i].name, level,
                   error[level], CASES[i].bound[level]);
        }
        tap_ok(error[3] < error[2] / CASES[i].ratio,
               "%s: the error falls %g times in the last level", CASES[i].name,
               CASES[i].ratio);
    }
}

/* The case in which the paper's equation, taken literally, gives 24. */
static void test_small_below_large(void)
{
    const struct square small = {{0.45, 0.45, 0}, {0.1, 0, 0}, {0, 0.1, 0}},
                        large = {{0, 0, 0.1}, {0, 1, 0}, {1, 0, 0}};
    bool bounded = true;
    for (int level = 0; level < 5; level++)
        bounded = bounded && form_factor(&small, &large, 0, level) <= 1.0;
    tap_ok(bounded, "a small square below a large one: never above 1");
    /* Eight triangles for the small square, and above it patches of half its size or
     * less, leave an error of 5.1e-3. */
    double exact = exact_factor(&small, &large);
    double error = fabs(form_factor(&small, &large, 1, 5) / exact - 1.0);
    tap_ok(error < 6.5e-3, "and %.3f in the end (off by %.1e)", exact, error);
}

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

/* Two of the four sub-areas of a flat triangle lie side by side, closer than a disk of
 * their area is wide, and each of them alone fills the view of a speck. */
static void test_flat(void)
{
    struct triangle large = {{{-0.5, 0, 0}, {0.5, 0, 0}, {0, 0.005, 0}}};
    struct triangle speck = {{{0, 0, 0.005}, {0, 0.001, 0.005}, {0.001, 0, 0.005}}};
    struct facet p = facet_of(large, -1), q = facet_of(speck, -1);
    struct octree *octree = octree_create(NULL, NULL, 0);
    struct octree_counts counts = {0};
    struct exchange exchange = exchange_of(&p, &q, octree, &counts);
    tap_ok(exchange.unoccluded <= q.area && exchange.area == exchange.unoccluded,
           "a speck above a flat triangle: F is at most 1 (%.4f)",
           exchange.area / q.area);
    octree_destroy(octree);
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
    struct exchange exchange = exchange_of(&p, &q, world.octree, &counts);
    tap_ok(facets_face(&p, &q) && counts.rays == 0 && exchange.area == 0.0 &&
               !facets_are_walled_off(&p, &q, world.octree, &counts) &&
               exchange.unoccluded > 0.0 && exchange.unoccluded <= fmin(p.area, q.area),
           "a pair at the horizon gets no ray, is not blocked, and keeps an estimate");
    world_free(&world);
}

/* --- blocked for sure --- */

enum pieces { WHOLE, HALVES, BENT }; /* in one piece, in two, in two that are not in
                                        one plane */

/* Exchange of two triangles face to face with one between them: scaled by `size` from a
 * cover of all straight lines, exactly. */
static struct exchange between(double size, bool reverse, enum pieces in_two,
                               struct octree_counts *counts,
                               bool *walled_off)
{
    struct triangle p = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    struct triangle t = moved(p, point(0, 0, 0.5)), q = moved(reversed(p),
                                                              point(0, 0, 1));
    struct vec3 centre = triangle_centroid(&t);
    for (int k = 0; k < 3; k++)
        t.corner[k] = vec3_add(centre, vec3_scale(vec3_sub(t.corner[k], centre), size));
    t = reverse ? reversed(t) : t;
    struct soup soup = {0};
    soup_add(&soup, p);
    soup_add(&soup, q);
    struct vec3 middle = vec3_middle(t.corner[0], t.corner[1]), lifted = middle;
    lifted.z += in_two == BENT ? 0.01 : 0.0;
    soup_add(&soup, in_two ? (struct triangle){{t.corner[0], lifted, t.corner[2]}} : t);
    if (in_two)
        soup_add(&soup, (struct triangle){{lifted, t.corner[1], t.corner[2]}});
    struct world world = world_make(scene_of_soup(&soup));
    struct facet facet_p = facet_make(world.model.forest, 0);
    struct facet facet_q = facet_make(world.model.forest, 1);
    struct exchange exchange = exchange_of(&facet_p, &facet_q, world.octree, counts);
    *walled_off = facets_are_walled_off(&facet_p, &facet_q, world.octree, counts);
    world_free(&world);
    return exchange;
}

static void test_proof(void)
{
    struct octree_counts counts = {0};
    bool walled_off;
    struct exchange free = between(1e-3, false, WHOLE, &counts, &walled_off);
    tap_ok(free.area > 0.9 * free.unoccluded && !walled_off && counts.rays == 16,
           "a speck between two triangles proves nothing; 16 rays are fired");
    struct exchange covered = between(1.01, false, WHOLE, &counts, &walled_off);
    tap_ok(walled_off && covered.area == 0.0 && covered.unoccluded == free.unoccluded,
           "a triangle a little larger than needed is a proof");
    between(1.01, true, WHOLE, &counts, &walled_off);
    tap_ok(walled_off, "from its back too");
    struct exchange open = between(0.99, false, WHOLE, &counts, &walled_off);
    tap_ok(!walled_off && open.area == 0.0 && open.unoccluded == free.unoccluded,
           "one a little too small is not, though no ray arrives");
    struct exchange halves = between(1.01, false, HALVES, &counts, &walled_off);
    tap_ok(walled_off && halves.area == 0.0, "two halves are");
    struct exchange bent = between(1.02, false, BENT, &counts, &walled_off);
    tap_ok(!walled_off && bent.area == 0.0, "unless they do not lie in one plane");
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
    struct exchange there = estimate(&p, &q, FORM_FACTOR_POLYGON, octree, &counts);
    struct exchange back = estimate(&q, &p, FORM_FACTOR_POLYGON, octree, &counts);
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
                       enum form_factor kind, const struct octree *octree,
                       const struct octree *none, struct findings *found)
{
    struct octree_counts counts = {0};
    struct exchange blocked = estimate(p, q, kind, octree, &counts);
    struct exchange back = estimate(q, p, kind, octree, &counts);
    struct exchange free = estimate(p, q, kind, none, &counts);
    struct visibility open = {.open = true, .blocker = -1};
    int64_t rays = counts.rays;
    struct exchange told = exchange_estimate(p, q, kind, octree, &open, &counts);
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
        (kind == FORM_FACTOR_DISK || p->area != q->area);
    found->one_way += blocked.area > 0.0 && !parts_match(&blocked, &back);
    found->dim += told.area != free.area || told.seen != free.seen || counts.rays != rays;
    bool walled_off = facets_are_walled_off(p, q, octree, &counts);
    found->walls += (walled_off && blocked.area > 0.0) ||
                    walled_off != facets_are_walled_off(q, p, octree, &counts);
}

/* 40 small blockers hang around, so that some pairs see each other in part. */
static void test_any(enum form_factor kind, int tries, const char *name)
{
    struct random random = random_seed(71);
    struct blockers blockers;
    struct octree *octree = hang_blockers(&blockers, 0.2, 5),
                  *none = octree_create(NULL, NULL, 0);
    struct findings found = {0};
    for (int i = 0; i < tries; i++) {
        struct facet p, q;
        if (make_facing(&random, i, &p, &q))
            judge_pair(&p, &q, kind, octree, none, &found);
    }
    tap_ok(found.facing > tries / 2 && found.partly > 50 &&
               found.outside == 0,
           "%s: %d pairs exchange from 0 to the smaller area, %d are seen in part", name,
           found.facing, found.partly);
    tap_ok(found.more == 0, "%s: blockers never add", name);
    tap_ok(found.broken == 0, "%s: parts are not negative and add up to 1", name);
    tap_ok(found.one_way == 0, "%s: the same in both directions, parts too", name);
    tap_ok(found.dim == 0, "%s: where nothing can stand in between no ray is fired",
           name);
    tap_ok(found.walls == 0, "%s: pairs proved to be blocked exchange nothing", name);
    octree_destroy(octree);
    octree_destroy(none);
}

int main(void)
{
    test_squares();
    test_small_below_large();
    test_flat();
    test_facing();
    test_horizon();
    test_proof();
    test_speck();
    test_any(FORM_FACTOR_DISK, 5 * PAIRS, "disks");
    test_any(FORM_FACTOR_POLYGON, PAIRS, "polygons");
    return tap_done();
}
