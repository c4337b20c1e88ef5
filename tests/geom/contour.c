/* Tests of geom/contour.h: identities. Rows of closed solids add up to 1, parts add up to
 * the whole, neither the order of arguments nor the unit matters. (Exact values, closed
 * forms of rectangles among them, are tests/rad/beyond/factors.c's.) */
#include "geom/contour.h"

#include "tests/scenes.h"
#include "tests/tap.h"
#include "geom/gauss.h"

/* The tolerance of any value: 1e-11 of the smaller area, and 1e-6 of the value. The sums
 * behind it are right to some 1e-16 of the square of the size: the first is for areas
 * that are thin, down to 1e-5 of that square, the second for exchanges down to 1e-10 of
 * it. */
static const double ABSOLUTE = 1e-11, RELATIVE = 1e-6;

enum { CORNERS = 64 };

struct polygon {
    int32_t count;
    struct vec3 corner[CORNERS];
};

static double exchange_of(const struct polygon *a, const struct polygon *b)
{
    return polygon_exchange(a->corner, a->count, b->corner, b->count);
}

/* The rectangle o, o + u, o + u + v, o + v. */
static struct polygon rectangle(struct vec3 o, struct vec3 u, struct vec3 v)
{
    struct vec3 end = vec3_add(o, u);
    return (struct polygon){4, {o, end, vec3_add(end, v), vec3_add(o, v)}};
}

/* Largest error over its tolerance, and how many were looked at. */
struct tally {
    double worst;
    int count;
};

static void tally_add(struct tally *tally, double value, double right, double area)
{
    double error = fabs(value - right);
    double part =
        fmax(error / (ABSOLUTE * area), right > 0.0 ? error / (RELATIVE * right) : 0.0);
    tally->worst = part > tally->worst || !(part == part) ? part : tally->worst;
    tally->count++;
}

static void tally_ok(const struct tally *tally, const char *name)
{
    tap_ok(tally->worst <= 1.0, "%s, %d pairs: off by %.2g of the tolerance", name,
           tally->count, tally->worst);
}

/* --- closed solids --- */

enum { FACES = 20 };

struct solid {
    int count;
    struct polygon face[FACES];
};

/* The rows of a convex solid: the light of a face arrives at the others. */
static void add_rows(struct tally *tally, const struct solid *solid)
{
    for (int i = 0; i < solid->count; i++) {
        const struct polygon *own = &solid->face[i];
        double sum = 0.0, area = polygon_area(own->corner, own->count);
        for (int j = 0; j < solid->count; j++)
            sum += exchange_of(own, &solid->face[j]);
        tally_add(tally, sum, area, area);
    }
}

/* The map x -> origin + x u + y v + z w, turned inside out where it mirrors. */
static void map_solid(struct solid *solid, const struct vec3 axes[4])
{
    bool mirror = vec3_dot(vec3_cross(axes[1], axes[2]), axes[3]) < 0.0;
    for (int i = 0; i < solid->count; i++) {
        struct polygon *face = &solid->face[i], old = *face;
        for (int32_t k = 0; k < face->count; k++) {
            struct vec3 x = old.corner[mirror ? face->count - 1 - k : k];
            struct vec3 y = vec3_add(vec3_scale(axes[1], x.x), vec3_scale(axes[2], x.y));
            face->corner[k] = vec3_add(axes[0], vec3_add(y, vec3_scale(axes[3], x.z)));
        }
    }
}

/* With its faces turned inwards. */
static struct solid unit_tetrahedron(void)
{
    struct vec3 o = {0, 0, 0}, x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
    return (struct solid){
        4, {{3, {o, x, y}}, {3, {o, y, z}}, {3, {o, z, x}}, {3, {x, z, y}}}};
}

/* 16 triangles: three and four in one plane, many with common edges and corners. */
static struct solid split_tetrahedron(void)
{
    struct solid whole = unit_tetrahedron(), solid = {.count = 16};
    for (int i = 0; i < 16; i++) {
        const struct vec3 *c = whole.face[i / 4].corner;
        struct triangle t = {{c[0], c[1], c[2]}};
        t = triangle_child(&t, i % 4);
        solid.face[i] = (struct polygon){3, {t.corner[0], t.corner[1], t.corner[2]}};
    }
    return solid;
}

/* A prism over a pentagon: rectangles and pentagons. */
static struct solid unit_prism(void)
{
    static const double at[5][2] = {{0, 0}, {1, 0}, {1.3, 0.9}, {0.6, 1.4}, {-0.2, 0.8}};
    struct solid solid = {.count = 7};
    for (int k = 0; k < 5; k++) {
        struct vec3 from = point(at[k][0], at[k][1], 0), rise = {0, 0, 1};
        struct vec3 to = point(at[(k + 1) % 5][0], at[(k + 1) % 5][1], 0);
        solid.face[k] = rectangle(from, rise, vec3_sub(to, from));
        solid.face[5].corner[k] = from;
        solid.face[6].corner[4 - k] = vec3_add(from, rise);
    }
    solid.face[5].count = solid.face[6].count = 5;
    return solid;
}

static void test_closure(struct solid (*make)(void), int times, const char *name)
{
    struct random random = random_seed(2);
    struct tally tally = {0.0, 0};
    for (int i = 0; i < times; i++) {
        struct solid solid = make();
        struct vec3 axes[4];
        for (int k = 0; k < 4; k++)
            axes[k] = random_point(&random, 1.0);
        /* Flat ones have faces that are slivers, seen under angles near 0. */
        if (fabs(vec3_dot(vec3_cross(axes[1], axes[2]), axes[3])) < 0.05)
            continue;
        map_solid(&solid, axes);
        add_rows(&tally, &solid);
    }
    tally_ok(&tally, name);
}

/* --- parts --- */

static double sum_of_parts(const struct triangle *t, const struct triangle *u, int level)
{
    if (level == 0)
        return triangle_exchange(t, u);
    double sum = 0.0;
    for (int k = 0; k < 16; k++) {
        struct triangle a = triangle_child(t, k / 4), b = triangle_child(u, k % 4);
        sum += sum_of_parts(&a, &b, level - 1);
    }
    return sum;
}

/* Apart; a common corner; a common edge; one edge in a part of another. */
static void random_pair(struct random *random, int kind, struct triangle *t,
                        struct triangle *u)
{
    *t = random_triangle(random, 0.5, 0.5);
    *u = random_triangle(random, 0.5, 0.5);
    if (kind >= 1)
        u->corner[0] = t->corner[1];
    if (kind >= 2)
        u->corner[1] = kind == 2 ? t->corner[0] : vec3_middle(t->corner[0], t->corner[1]);
}

/* The whole goes by contours, half of the parts by points; planes cut many of them. */
static void test_parts(void)
{
    static const char *const names[4] = {"apart", "at a corner", "at an edge",
                                         "at half an edge"};
    for (int kind = 0; kind < 4; kind++) {
        struct random random = random_seed(10 + (uint64_t)kind);
        struct tally tally = {0.0, 0};
        while (tally.count < 60) {
            struct triangle t, u;
            random_pair(&random, kind, &t, &u);
            double least = fmin(triangle_area(&t), triangle_area(&u));
            double whole = triangle_exchange(&t, &u);
            if (least > 0.02 && whole > 1e-6 * least)
                tally_add(&tally, sum_of_parts(&t, &u, 1 + kind % 2), whole, least);
        }
        char name[60];
        snprintf(name, sizeof name, "parts make the whole, %s", names[kind]);
        tally_ok(&tally, name);
    }
}

/* --- far away and in one plane --- */

static double point_exchange(const struct triangle *t, const struct triangle *u)
{
    struct vec3 r = vec3_sub(triangle_centroid(u), triangle_centroid(t));
    double r2 = vec3_dot(r, r);
    return 0.25 * vec3_dot(triangle_cross(t), r) * -vec3_dot(triangle_cross(u), r) /
           (PI * r2 * r2);
}

/* Of triangles of size 1 at distance d all but 1 / d^2 is the exchange of two points;
 * coordinates are rounded by 1e-16 d. */
static void test_far(void)
{
    struct random random = random_seed(5);
    double worst = 0.0;
    int count = 0;
    for (int i = 0; i < 2000; i++) {
        struct triangle t, u;
        random_pair(&random, 0, &t, &u);
        double distance = pow(10.0, random_between(&random, 5.0, 6.0));
        struct vec3 step = vec3_scale(vec3_unit(random_point(&random, 1.0)), distance);
        for (int k = 0; k < 3; k++)
            u.corner[k] = vec3_add(u.corner[k], step);
        double right = point_exchange(&t, &u);
        /* Where neither cosine is small. */
        if (right * distance * distance < 0.002 ||
            vec3_dot(triangle_cross(&t), step) < 0.0)
            continue;
        worst = fmax(worst, fabs(triangle_exchange(&t, &u) / right - 1.0));
        count++;
    }
    tap_ok(count > 20 && worst < 1e-9, "%d far pairs are like points (off by %.1e)",
           count, worst);
}

/* Where the plane is tilted, rounding puts neighbours a little before each other. */
static void test_plane(void)
{
    struct random random = random_seed(6);
    int seen = 0;
    for (int i = 0; i < 1000; i++) {
        struct triangle whole = random_triangle(&random, 0.5, 0.5);
        for (int k = 0; k < 16; k++) {
            struct triangle t = triangle_child(&whole, k / 4),
                            u = triangle_child(&whole, k % 4);
            seen += triangle_area(&whole) > 0.02 && triangle_exchange(&t, &u) > 0.0;
        }
    }
    tap_ok(seen == 0, "triangles of one tilted plane exchange nothing");
}

/* --- order and size --- */

static struct triangle scaled(struct triangle t, double scale)
{
    for (int k = 0; k < 3; k++)
        t.corner[k] = vec3_scale(t.corner[k], scale);
    return t;
}

static void test_symmetries(void)
{
    struct random random = random_seed(3);
    int one_way = 0, unequal = 0, count = 0;
    for (int i = 0; i < 2000; i++) {
        struct triangle t, u;
        random_pair(&random, i % 4, &t, &u);
        double g = triangle_exchange(&t, &u);
        struct triangle v = scaled(t, 0x1p-20), w = scaled(u, 0x1p-20);
        count += g > 0.0;
        one_way += triangle_exchange(&u, &t) != g;
        unequal += triangle_exchange(&v, &w) != g * 0x1p-40;
    }
    tap_ok(one_way == 0 && count > 500, "the same bits in both orders");
    tap_ok(unequal == 0, "the same bits 2^20 times smaller");
}

/* --- bounds --- */

/* Slivers, specks, copies, neighbours and crossing ones, at all distances. */
static void test_bounds(void)
{
    struct random random = random_seed(4);
    int wrong = 0, lit = 0;
    for (int i = 0; i < 20000; i++) {
        struct triangle t, u;
        random_pair(&random, i % 4, &t, &u);
        double step = pow(10.0, random_between(&random, -17.0, 0.0));
        struct vec3 small = random_point(&random, step);
        switch (random_below(&random, 4)) {
        case 0:
            u.corner[2] = vec3_add(vec3_middle(u.corner[0], u.corner[1]), small);
            break;
        case 1: u.corner[2] = vec3_add(t.corner[2], small); break;
        case 2:
            for (int k = 0; k < 3; k++)
                u.corner[k] = vec3_add(t.corner[2 - k], random_point(&random, step));
            break;
        default: u = scaled(u, step);
        }
        double g = triangle_exchange(&t, &u),
               least = fmin(triangle_area(&t), triangle_area(&u));
        wrong += !(g >= 0.0 && g <= least * (1.0 + 1e-15));
        lit += g > 0.0;
    }
    tap_ok(wrong == 0 && lit > 5000, "20,000 pairs of all kinds, %d lit: 0 <= F <= 1",
           lit);
}

/* --- other polygons --- */

/* Concave ones are as rectangles together: an L, from each of its corners, below a lid,
 * and a U, of which a wall leaves one arm or two in front of it. */
static void test_polygons(void)
{
    struct vec3 o = {0, 0, 0}, x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
    struct polygon ell = {
        6, {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}};
    struct polygon u = {8, {{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {2, 2, 0},
                            {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}};
    const struct polygon piece[3] = {rectangle(o, x, point(0, 2, 0)), rectangle(x, x, y),
                                     rectangle(point(2, 0, 0), x, point(0, 2, 0))};
    struct tally tally = {0.0, 0};
    for (int k = 0; k < 18; k++) {
        double height = k < 6 ? 0.125 : k < 12 ? 1.5 : 15.0;
        struct polygon lid = rectangle(point(0.5, 0.25, height), point(0, 3.75, 0),
                                       point(4.5, 0, 0));
        struct polygon turn = {.count = 6};
        for (int i = 0; i < 6; i++)
            turn.corner[i] = ell.corner[(i + k) % 6];
        double sum = exchange_of(&piece[0], &lid) + exchange_of(&piece[1], &lid);
        tally_add(&tally, exchange_of(&turn, &lid), sum, 3.0);
    }
    tally_ok(&tally, "an L below a rectangle");
    tally = (struct tally){0.0, 0};
    for (int k = 0; k < 5; k++) {
        double at = 0.5 + 0.25 * k, sum = 0.0;
        struct polygon plate = rectangle(point(0, at, 0), z, point(2, 0, 0));
        for (int i = 0; i < 3; i++)
            sum += exchange_of(&piece[i], &plate);
        tally_add(&tally, exchange_of(&u, &plate), sum, 2.0 * (2.0 - at));
    }
    tally_ok(&tally, "a U cut by a wall");
    tap_ok(polygon_area(ell.corner, 6) == 3.0, "the area of an L");
}

/* x^(2 n - 1) is the last power that n points integrate exactly. */
static void test_gauss(void)
{
    static const int points[4] = {4, 6, 10, 16};
    double worst = 0.0;
    for (int i = 0; i < 4; i++) {
        struct gauss rule = gauss_rule(points[i]);
        for (int power = 0; power < 2 * points[i]; power++) {
            double sum = 0.0;
            for (int k = 0; k < points[i]; k++) {
                double weight, x = gauss_point(&rule, k, &weight);
                sum += weight * pow(x, power);
            }
            worst = fmax(worst, fabs(sum * (power + 1) - 1.0));
        }
    }
    /* Nodes are right to 1e-16, which the 31st power makes 3e-15 of it. */
    tap_ok(worst < 5e-15,
           "Gauss' rules integrate all powers that they should (off by %.1e)", worst);
}

int main(void)
{
    test_gauss();
    test_closure(unit_prism, 100, "rows of prisms");
    test_closure(split_tetrahedron, 50, "rows of tetrahedra of 16 triangles");
    test_parts();
    test_far();
    test_plane();
    test_symmetries();
    test_bounds();
    test_polygons();
    return tap_done();
}
