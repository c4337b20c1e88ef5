/* Tests of rad/beyond/patch_exchange.h: sums over subdivided squares converge to closed
 * forms, bounds and symmetry hold for any pair, and pairs claimed to be blocked for sure
 * is blocked.
 *
 * Closed forms are those of Howell's catalogue: C-11, aligned parallel rectangles, and
 * C-14, perpendicular rectangles with a common edge, from which follows the case with a
 * gap. */
#include "rad/beyond/patch_exchange.h"

#include "geom/lambert.h"

#include "tests/scenes.h"
#include "tests/tap.h"

/* Nothing known, everything looked at. */
static struct exchange estimate(const struct facet *p, const struct facet *q,
                                enum form_factor kind, enum effort effort,
                                const struct octree *octree, struct octree_counts *counts)
{
    struct visibility visibility = {.open = false, .blocker = -1};
    return exchange_estimate(p, q, kind, effort, octree, &visibility, counts);
}

/* 16 disks, 16 segments: the paper's. */
static struct exchange exchange_of(const struct facet *p, const struct facet *q,
                                   const struct octree *octree,
                                   struct octree_counts *counts)
{
    return estimate(p, q, FORM_FACTOR_DISK, EFFORT_ALL, octree, counts);
}

enum { PAIRS = 20000 };

static struct vec3 point(double x, double y, double z)
{
    return (struct vec3){x, y, z};
}

/* --- closed forms --- */

/* Two unit squares at distance d, one above the other. */
static double parallel_squares(double d)
{
    double x = 1.0 / d, x2 = x * x, root = sqrt(1.0 + x2);
    double logarithm = 0.5 * log((1.0 + x2) * (1.0 + x2) / (1.0 + 2.0 * x2));
    return 2.0 / (PI * x2) *
           (logarithm + 2.0 * x * root * atan(x / root) - 2.0 * x * atan(x));
}

/* From a rectangle of width w to one of height h that stands on its edge, of length 1. */
static double perpendicular(double w, double h)
{
    double w2 = w * w, h2 = h * h, s = w2 + h2, root = sqrt(s);
    double logarithm = log((1.0 + w2) * (1.0 + h2) / (1.0 + s)) +
                       w2 * log(w2 * (1.0 + s) / ((1.0 + w2) * s)) +
                       h2 * log(h2 * (1.0 + s) / ((1.0 + h2) * s));
    return (w * atan(1.0 / w) + h * atan(1.0 / h) - root * atan(1.0 / root) +
            0.25 * logarithm) /
           (PI * w);
}

/* The formulas against published digits: 12 of them are given. */
static void test_closed_forms(void)
{
    tap_ok(fabs(parallel_squares(1.0) - 0.199824895698387) < 1e-14 &&
               fabs(parallel_squares(0.5) - 0.415253283577) < 1e-12 &&
               fabs(parallel_squares(4.0) - 0.0191069580) < 1e-10,
           "the formula for parallel squares");
    tap_ok(fabs(perpendicular(1.0, 1.0) - 0.200043776075) < 1e-12 &&
               fabs(perpendicular(2.0, 1.0) - 0.116426301398) < 1e-12 &&
               fabs(2.0 * perpendicular(2.0, 1.0) - perpendicular(1.0, 1.0) -
                    0.0328088267) < 1e-10,
           "the formula for perpendicular rectangles");
}

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

/* Form factor from the first square (two triangles) of the soup to the second, with
 * patches of these levels. */
static double form_factor(const struct soup *soup, int level_p, int level_q)
{
    struct world world = world_make(scene_of_soup(soup, 1));
    struct forest *forest = world.model.forest;
    split_all(forest, level_p > level_q ? level_p : level_q);
    struct facet *p = alloc_array((size_t)2 << (2 * level_p), sizeof *p);
    struct facet *q = alloc_array((size_t)2 << (2 * level_q), sizeof *q);
    int64_t count_p = make_facets(forest, 0, level_p, p);
    int64_t count_q = make_facets(forest, 2, level_q, q);
    struct octree_counts counts = {0};
    double sum = 0.0, area = 0.0;
    for (int64_t i = 0; i < count_p; i++) {
        area += p[i].area;
        for (int64_t j = 0; j < count_q; j++)
            if (facets_face(&p[i], &q[j]))
                sum += exchange_of(&p[i], &q[j], world.octree, &counts).area;
    }
    alloc_free(p);
    alloc_free(q);
    world_free(&world);
    return sum / area;
}

/* A small area is a point, and the disk has a wrong shape and its area in the
 * denominator: both errors fall with the square of the size, so 4 times with each
 * level. */
static void check_convergence(const struct soup *soup, double exact,
                              const double bound[4],
                              double ratio, const char *name)
{
    double error[4];
    for (int level = 0; level < 4; level++) {
        error[level] = fabs(form_factor(soup, level, level) / exact - 1.0);
        tap_ok(error[level] < bound[level], "%s, level %d: off by %.1e, allowed %.1e",
               name, level,
               error[level], bound[level]);
    }
    tap_ok(error[3] < error[2] / ratio, "%s: the error falls %g times in the last level",
           name,
           ratio);
}

static void test_squares(void)
{
    struct vec3 o = {0, 0, 0}, x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
    /* Bounds are the measured errors and a quarter more: the method's honest accuracy. */
    static const double bound_parallel[3][4] = {{1.2e-2, 5.7e-3, 1.7e-3, 4.4e-4},
                                                {2.6e-2, 5.6e-3, 1.4e-3, 3.4e-4},
                                                {5.1e-3, 1.3e-3, 3.1e-4, 7.8e-5}};
    static const double distance[3] = {0.5, 1.0, 4.0};
    for (int k = 0; k < 3; k++) {
        char name[40];
        snprintf(name, sizeof name, "parallel squares at %g", distance[k]);
        struct soup soup = {0};
        soup_add_quad(&soup, o, x, y, 1);
        soup_add_quad(&soup, point(0, 0, distance[k]), y, x, 1);
        check_convergence(&soup, parallel_squares(distance[k]), bound_parallel[k], 3.8,
                          name);
        soup_free(&soup);
    }
    static const double bound_gap[4] = {5.6e-3, 1.1e-3, 2.4e-4, 5.9e-5};
    struct soup gap = {0}, edge = {0};
    soup_add_quad(&gap, x, x, y, 1);
    soup_add_quad(&gap, o, y, z, 1);
    double exact = 2.0 * perpendicular(2.0, 1.0) - perpendicular(1.0, 1.0);
    check_convergence(&gap, exact, bound_gap, 3.8, "perpendicular squares with a gap");
    soup_free(&gap);
    /* At the common edge distance and size shrink alike: there the error of each pair
     * stays, and the share of such pairs falls, half with each level. */
    static const double bound_edge[4] = {1.4e-3, 8.3e-3, 7.3e-3, 4.7e-3};
    soup_add_quad(&edge, o, x, y, 1);
    soup_add_quad(&edge, o, y, z, 1);
    check_convergence(&edge, perpendicular(1.0, 1.0), bound_edge, 1.5,
                      "perpendicular squares with a common edge");
    soup_free(&edge);
}

/* The case in which the paper's equation, taken literally, gives 24. */
static void test_small_below_large(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0.45, 0.45, 0), point(0.1, 0, 0), point(0, 0.1, 0), 1);
    soup_add_quad(&soup, point(0, 0, 0.1), point(0, 1, 0), point(1, 0, 0), 1);
    const double exact = 0.96800279;
    bool bounded = true;
    for (int level = 0; level < 5; level++)
        bounded = bounded && form_factor(&soup, 0, level) <= 1.0;
    tap_ok(bounded, "a small square below a large one: never above 1");
    /* Eight triangles for the small square, and above it patches of half its size or
     * less, leave an error of 5.1e-3. */
    double error = fabs(form_factor(&soup, 1, 5) / exact - 1.0);
    tap_ok(error < 6.5e-3, "and 0.968 in the end (off by %.1e)", error);
    soup_free(&soup);
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

static const char *const kind_names[KINDS] = {"apart", "near", "touching",
                                              "small over large",
                                              "flat"};

static struct triangle reversed(struct triangle t)
{
    return (struct triangle){{t.corner[0], t.corner[2], t.corner[1]}};
}

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

struct findings {
    int facing, lit;
    int negative, too_large, too_little, lop_sided, blocked, one_way;
    double worst; /* largest unoccluded G over the smaller area */
};

static void judge_pair(const struct facet *p, const struct facet *q,
                       const struct octree *octree,
                       struct findings *findings)
{
    struct octree_counts counts = {0};
    struct exchange there = exchange_of(p, q, octree, &counts);
    struct exchange back = exchange_of(q, p, octree, &counts);
    double least = fmin(p->area, q->area);
    findings->facing++;
    findings->lit += there.area > 0.0;
    findings->negative += !(there.area >= 0.0) || !(there.unoccluded >= 0.0);
    findings->too_large += !(there.area <= least) || !(there.unoccluded <= least);
    findings->too_little += !(there.area <= there.unoccluded);
    /* 16 positive terms in another order: 15 roundings of 1.1e-16 each. */
    findings->lop_sided +=
        fabs(there.area - back.area) > 1e-14 * there.area ||
        fabs(there.unoccluded - back.unoccluded) > 1e-14 * there.unoccluded;
    findings->blocked += facets_are_walled_off(p, q, octree, &counts) && there.area > 0.0;
    findings->one_way += facets_are_walled_off(p, q, octree, &counts) !=
                         facets_are_walled_off(q, p, octree, &counts);
    findings->worst = fmax(findings->worst, there.unoccluded / least);
}

/* 40 small blockers hang around, so that some pairs see each other in part. */
static void test_bounds(enum kind kind)
{
    struct random random = random_seed(1 + (uint64_t)kind);
    struct triangle blockers[40];
    struct plane planes[40];
    for (int k = 0; k < 40; k++) {
        blockers[k] = random_triangle(&random, 0.5, 0.2);
        planes[k] = triangle_plane(&blockers[k]);
    }
    struct octree *octree = octree_create(blockers, planes, 40);
    struct findings findings = {0};
    for (int i = 0; i < PAIRS; i++) {
        struct triangle pair[2];
        random_pair(&random, kind, pair);
        if (triangle_is_degenerate(&pair[0]) || triangle_is_degenerate(&pair[1]))
            continue;
        struct facet p = facet_of(pair[0], -1), q = facet_of(pair[1], -1);
        if (facets_face(&p, &q) && facets_face(&q, &p))
            judge_pair(&p, &q, octree, &findings);
    }
    const char *name = kind_names[kind];
    tap_ok(findings.facing > PAIRS / 10 && findings.lit > PAIRS / 20 &&
               findings.negative == 0,
           "%s: %d pairs exchange nothing negative", name, findings.facing);
    tap_ok(findings.too_large == 0,
           "%s: nor more than the smaller area (at most %.4f of it)", name,
           findings.worst);
    tap_ok(findings.too_little == 0, "%s: nor more than without blockers", name);
    tap_ok(findings.lop_sided == 0, "%s: the same in both directions", name);
    tap_ok(findings.blocked == 0, "%s: pairs proved to be blocked exchange nothing",
           name);
    tap_ok(findings.one_way == 0, "%s: and is so in both directions", name);
    octree_destroy(octree);
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
    struct world world = world_make(scene_of_soup(&soup, 1));
    struct facet p = facet_make(world.model.forest, 0), q = facet_make(world.model.forest,
                                                                       1);
    struct octree_counts counts = {0};
    struct exchange exchange = exchange_of(&p, &q, world.octree, &counts);
    tap_ok(facets_face(&p, &q) && counts.rays == 0 && exchange.area == 0.0 &&
               !facets_are_walled_off(&p, &q, world.octree, &counts) &&
               exchange.unoccluded > 0.0 && exchange.unoccluded <= fmin(p.area, q.area),
           "a pair at the horizon gets no ray, is not blocked, and keeps an estimate");
    world_free(&world);
    soup_free(&soup);
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
    struct world world = world_make(scene_of_soup(&soup, 1));
    struct facet facet_p = facet_make(world.model.forest, 0);
    struct facet facet_q = facet_make(world.model.forest, 1);
    struct exchange exchange = exchange_of(&facet_p, &facet_q, world.octree, counts);
    *walled_off = facets_are_walled_off(&facet_p, &facet_q, world.octree, counts);
    world_free(&world);
    soup_free(&soup);
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

/* Two patches and a few large triangles between, beside or through them. Whenever a
 * proof is claimed no random segment from one to the other gets through. */
static void test_claims(void)
{
    struct random random = random_seed(9);
    int claims = 0, dark = 0, wrong = 0;
    for (int i = 0; i < PAIRS; i++) {
        struct triangle t[6];
        struct plane planes[6];
        t[0] = moved(random_triangle(&random, 0.1, 0.15), point(0, 0, -0.3));
        t[1] = moved(random_triangle(&random, 0.1, 0.15), point(0, 0, 0.3));
        for (int k = 2; k < 6; k++)
            t[k] = moved(random_triangle(&random, 0.0, 0.6), point(0, 0, 0));
        for (int k = 0; k < 6; k++)
            planes[k] = triangle_plane(&t[k]);
        struct facet p = facet_of(t[0], 0), q = facet_of(t[1], 1);
        if (!facets_face(&p, &q))
            continue;
        struct octree *octree = octree_create(t, planes, 6);
        struct octree_counts counts = {0};
        struct exchange exchange = exchange_of(&p, &q, octree, &counts);
        bool walled_off = facets_are_walled_off(&p, &q, octree, &counts);
        octree_destroy(octree);
        dark += exchange.area == 0.0;
        claims += walled_off;
        const int32_t own[2] = {0, 1};
        for (int k = 0; k < 1000 && walled_off; k++)
            wrong += brute_blocker(t, planes, 6, random_point_on(&random, &t[0]),
                                   random_point_on(&random, &t[1]), own) < 0;
    }
    tap_ok(claims > 100 && dark > claims,
           "%d of %d pairs that no ray joins are proved blocked",
           claims, dark);
    tap_ok(wrong == 0, "and of a thousand segments each none gets through");
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
    struct exchange there = estimate(&p, &q, FORM_FACTOR_POLYGON, EFFORT_ALL, octree,
                                     &counts);
    struct exchange back = estimate(&q, &p, FORM_FACTOR_POLYGON, EFFORT_ALL, octree,
                                    &counts);
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

static void test_any(enum form_factor kind, enum effort effort, const char *name)
{
    enum { TRIES = 20000 };
    struct random random = random_seed(71);
    struct blockers blockers;
    struct octree *octree = hang_blockers(&blockers, 0.2, 5),
                  *none = octree_create(NULL, NULL, 0);
    int facing = 0, partly = 0, outside = 0, more = 0, broken = 0, one_way = 0, dim = 0;
    for (int i = 0; i < TRIES; i++) {
        struct facet p, q;
        if (!make_facing(&random, i, &p, &q))
            continue;
        struct octree_counts counts = {0};
        struct exchange blocked = estimate(&p, &q, kind, effort, octree, &counts);
        struct exchange back = estimate(&q, &p, kind, effort, octree, &counts);
        struct exchange free = estimate(&p, &q, kind, effort, none, &counts);
        struct visibility open = {.open = true, .blocker = -1};
        int64_t rays = counts.rays;
        struct exchange told = exchange_estimate(&p, &q, kind, effort, octree, &open,
                                                 &counts);
        facing++;
        partly += blocked.seen > 0.0 && blocked.seen < 1.0;
        outside += !is_within_bounds(&blocked, &p, &q) || !is_within_bounds(&free, &p,
                                                                            &q);
        more += !(blocked.area <= free.area) || blocked.unoccluded != free.unoccluded;
        broken += !parts_are_whole(blocked.parts_p) || !parts_are_whole(blocked.parts_q);
        /* Sums of 16 terms in another order; of unequal areas the points are on the same
         * side. */
        one_way +=
            fabs(back.area - blocked.area) > 1e-14 * blocked.area && p.area != q.area;
        one_way += blocked.area > 0.0 && !parts_match(&blocked, &back);
        dim += told.area != free.area || told.seen != free.seen || counts.rays != rays;
    }
    tap_ok(facing > TRIES / 2 && (effort == EFFORT_ONE || partly > 50) && outside == 0,
           "%s: %d pairs exchange from 0 to the smaller area, %d are seen in part", name,
           facing, partly);
    tap_ok(more == 0, "%s: blockers never add", name);
    tap_ok(broken == 0, "%s: parts are not negative and add up to 1", name);
    tap_ok(one_way == 0, "%s: the same in both directions, parts too", name);
    tap_ok(dim == 0, "%s: where nothing can stand in between no ray is fired", name);
    octree_destroy(octree);
    octree_destroy(none);
}

static bool is_same_exchange(const struct exchange *a, const struct exchange *b)
{
    bool same =
        a->area == b->area && a->unoccluded == b->unoccluded && a->seen == b->seen;
    for (int k = 0; k < 4; k++)
        same = same && a->parts_p[k] == b->parts_p[k] && a->parts_q[k] == b->parts_q[k];
    return same;
}

/* Four segments are enough where nothing blocks, and where everything does. */
static void test_four(void)
{
    enum { TRIES = 10000 };
    struct random random = random_seed(72);
    struct blockers blockers;
    struct octree *octree = hang_blockers(&blockers, 0.25, 6);
    int free = 0, dark = 0, mixed = 0, wrong = 0, dear = 0, missed = 0;
    for (int i = 0; i < TRIES; i++) {
        struct facet p, q;
        if (!make_facing(&random, 0, &p, &q))
            continue;
        enum form_factor kind = i % 2 ? FORM_FACTOR_POLYGON : FORM_FACTOR_DISK;
        struct octree_counts all = {0}, four = {0};
        struct exchange whole = estimate(&p, &q, kind, EFFORT_ALL, octree, &all);
        struct exchange part = estimate(&p, &q, kind, EFFORT_FOUR_FIRST, octree, &four);
        bool agreed = whole.seen == 0.0 || whole.seen == 1.0;
        free += whole.seen == 1.0;
        dark += whole.seen == 0.0;
        mixed += !agreed;
        wrong += agreed && !is_same_exchange(&whole, &part);
        dear += agreed && all.rays == 16 && four.rays != 4;
        missed += !agreed && four.rays == all.rays && !is_same_exchange(&whole, &part);
    }
    tap_ok(free > 100 && dark > 20 && mixed > 100 && wrong == 0,
           "four first: as with all 16 where nothing (%d) or everything (%d) is blocked",
           free, dark);
    tap_ok(dear == 0, "with four segments");
    tap_ok(missed == 0,
           "and where they disagree (some of %d) all are asked, with the same answer",
           mixed);
    octree_destroy(octree);
}

/* One disk for all, from 1.5 times the sum of the radii. The disk and the points both
 * have the angles of centroids for those of whole patches: at grazing ones their
 * relative errors have no bound, so the pairs here see each other at 60 degrees from the
 * normals at most. */
static void test_one(void)
{
    enum { TRIES = 20000 };
    struct random random = random_seed(73);
    struct octree *octree = octree_create(NULL, NULL, 0);
    int far = 0, near = 0, wrong = 0, dear = 0;
    double worst = 0.0, worst_twice = 0.0;
    for (int i = 0; i < TRIES; i++) {
        struct facet p = facet_of(random_triangle(&random, 1.0, 0.4), -1);
        struct facet q = facet_of(random_triangle(&random, 1.0, 0.4), -1);
        if (!facets_face(&p, &q))
            continue;
        struct vec3 x = triangle_centroid(&p.triangle),
                    y = triangle_centroid(&q.triangle);
        struct vec3 d = vec3_sub(y, x);
        double distance = vec3_length(d), reach[2] = {0.0, 0.0};
        for (int k = 0; k < 3; k++) {
            reach[0] = fmax(reach[0], vec3_length(vec3_sub(p.triangle.corner[k], x)));
            reach[1] = fmax(reach[1], vec3_length(vec3_sub(q.triangle.corner[k], y)));
        }
        double radii = reach[0] + reach[1];
        double slope = fmin(vec3_dot(p.plane.normal, d),
                            -vec3_dot(q.plane.normal, d)) / distance;
        struct octree_counts all = {0}, one = {0};
        struct exchange whole = estimate(&p, &q, FORM_FACTOR_POLYGON, EFFORT_ALL, octree,
                                         &all);
        struct exchange single = estimate(&p, &q, FORM_FACTOR_POLYGON, EFFORT_ONE, octree,
                                          &one);
        if (distance > 1.500001 * radii) {
            dear += one.rays > 1;
            if (slope < 0.5)
                continue;
            far++;
            double off = fabs(single.area / whole.area - 1.0);
            worst = fmax(worst, off);
            worst_twice = fmax(worst_twice, distance > 2.0 * radii ? off : 0.0);
        } else if (distance < 1.499999 * radii) {
            near++;
            wrong += !is_same_exchange(&whole, &single) || one.rays != all.rays;
        }
    }
    /* Measured 15.4 and 7.0 %, and a quarter more. */
    tap_ok(far > 200 && worst < 0.19 && worst_twice < 0.1,
           "one look: within %.1f %% of the full one from 1.5 radii, %.1f %% from 2 (%d "
           "pairs)",
           100.0 * worst, 100.0 * worst_twice, far);
    tap_ok(dear == 0, "with one ray");
    tap_ok(near > 1000 && wrong == 0, "near by it is the full one");
    octree_destroy(octree);
}

/* One look is blocked or not as a whole. */
static void test_one_blocked(void)
{
    struct triangle p = {{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}}};
    struct triangle q = moved(reversed(p), point(0, 0, 1));
    struct triangle wall = {{{-1, -1, 0.5}, {1, -1, 0.5}, {0, 1, 0.5}}};
    struct triangle t[3] = {p, q, wall}; /* alone the wall would be a hull, which
                                            blocks nothing */
    struct plane planes[3] = {triangle_plane(&p), triangle_plane(&q),
                              triangle_plane(&wall)};
    struct octree *octree = octree_create(t, planes, 3);
    struct facet a = facet_of(p, 0), b = facet_of(q, 1);
    struct octree_counts counts = {0};
    struct visibility visibility = {.open = false, .blocker = -1};
    struct exchange e = exchange_estimate(&a, &b, FORM_FACTOR_POLYGON, EFFORT_ONE, octree,
                                          &visibility,
                                          &counts);
    tap_ok(e.area == 0.0 && e.seen == 0.0 && e.unoccluded == exchange_guess(&a, &b) &&
               visibility.blocker == 2 && counts.rays == 1,
           "one segment that is blocked keeps the unoccluded exchange, and the blocker");
    octree_destroy(octree);
}

int main(void)
{
    test_closed_forms();
    test_squares();
    test_small_below_large();
    for (enum kind kind = APART; kind < KINDS; kind++)
        test_bounds(kind);
    test_flat();
    test_facing();
    test_horizon();
    test_proof();
    test_claims();
    test_speck();
    test_any(FORM_FACTOR_DISK, EFFORT_ALL, "disks, all");
    test_any(FORM_FACTOR_POLYGON, EFFORT_ALL, "polygons, all");
    test_any(FORM_FACTOR_POLYGON, EFFORT_FOUR_FIRST, "polygons, four first");
    test_any(FORM_FACTOR_POLYGON, EFFORT_ONE, "polygons, one");
    test_four();
    test_one();
    test_one_blocked();
    return tap_done();
}
