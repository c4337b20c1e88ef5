/* Tests of viewfactors/outlook.h and screened.h: what a point sees through a hole; exact
 * answers where whole shadows fall on the target, or where two sets of screens tile a
 * wall, so that each segment is stopped by one of them; sums over many segments; screens
 * that nothing passes, that hide nothing, that reach behind the two triangles, and too
 * many of them. The error that is told holds. */
#include "tools/viewfactors/screened.h"

#include "geom/contour.h"
#include "geom/lambert.h"
#include "tests/scenes.h"
#include "tests/tap.h"
#include "tools/viewfactors/outlook.h"

enum { PAIRS = 40, PARTS = 256 };

static const double TOLERANCES[] = {1e-3, 1e-4, 1e-5};

/* Smaller errors of F are not told (viewfactor.c). */
static const double LEAST = 1e-5;

static struct facet facet_of(struct triangle t)
{
    return (struct facet){t, triangle_plane(&t), triangle_area(&t), -1};
}

/* A triangle around a place near the axis, of about the size, between two heights, that
 * looks up or down. */
static struct triangle level_triangle(struct random *random, double half, double size,
                                      double low, double high, bool up)
{
    struct vec3 c = random_point(random, half);
    double aside = c.x + random_between(random, -0.2, 0.2) * size;
    struct triangle t = {{point(c.x - size, c.y - size, 0.0), point(c.x + size, c.y, 0.0),
                          point(aside, c.y + size, 0.0)}};
    for (int k = 0; k < 3; k++)
        t.corner[k].z = random_between(random, low, high);
    if (!up) {
        struct vec3 last = t.corner[2];
        t.corner[2] = t.corner[1];
        t.corner[1] = last;
    }
    return t;
}

static double open_exchange(const struct facet *p, const struct facet *q)
{
    return triangle_exchange(&p->triangle, &q->triangle);
}

/* The exchange past some triangles; below 0 if they are too many. */
static struct screened past(const struct facet *viewer, const struct facet *target,
                            const struct triangle *triangles, int32_t count,
                            double tolerance)
{
    int32_t blockers[SCREENS_MAX];
    struct screened result;
    for (int32_t i = 0; i < count; i++)
        blockers[i] = i;
    if (!screened_exchange(viewer, target, triangles, blockers, count,
                           open_exchange(viewer, target), tolerance, &result))
        result.exchange = -1.0;
    return result;
}

/* The largest error of F, and of it over the one that is told. */
struct tally {
    double worst, beyond;
};

static void tally_add(struct tally *tally, double found, double exact, double told,
                      double area)
{
    double error = fabs(found - exact) / area;
    tally->worst = fmax(tally->worst, error);
    tally->beyond = fmax(tally->beyond, error / fmax(told / area, LEAST));
}

/* Small triangles below a large one: they take from it what they receive. */
static void test_whole_shadows(double tolerance)
{
    struct random random = random_seed(1);
    struct tally tally = {0.0, 0.0};
    for (int i = 0; i < PAIRS; i++) {
        struct facet viewer =
            facet_of(level_triangle(&random, 0.1, 0.3, 0.0, 0.05, true));
        struct facet target =
            facet_of(level_triangle(&random, 0.1, 90.0, 1.0, 1.1, false));
        struct triangle screens[3];
        double exact = open_exchange(&viewer, &target);
        for (int s = 0; s < 3; s++) { /* apart, so that none shades another */
            screens[s] = level_triangle(&random, 0.05, 0.1, 0.55, 0.6, false);
            for (int c = 0; c < 3; c++)
                screens[s].corner[c].x += s - 1;
            struct facet screen = facet_of(screens[s]);
            exact -= open_exchange(&viewer, &screen);
        }
        struct screened found =
            past(&viewer, &target, screens, 3, tolerance * viewer.area);
        tally_add(&tally, found.exchange, exact, found.error, viewer.area);
    }
    tap_ok(tally.worst < tolerance && tally.beyond < 1.5,
           "whole shadows, tolerance %g: F is off by %.1e, %.2f of what is told",
           tolerance, tally.worst, tally.beyond);
}

/* A wall of which the first part hides what the others do not, seen from both sides. */
static void test_halves(double tolerance)
{
    struct random random = random_seed(2);
    struct tally tally = {0.0, 0.0};
    double passing = 0.0;
    for (int i = 0; i < PAIRS; i++) {
        struct facet p = facet_of(level_triangle(&random, 0.3, 0.4, 0.0, 0.1, true));
        struct facet q = facet_of(level_triangle(&random, 0.3, 0.4, 1.0, 1.5, false));
        struct triangle wall = level_triangle(&random, 0.3, 9.0, 0.4, 0.5, i % 2);
        struct triangle parts[4];
        for (int c = 0; c < 4; c++) {
            parts[c] = triangle_child(&wall, (c + 3) % 4); /* the middle is child 3 */
            for (int k = 0; k < 3; k++)                    /* an edge of it is above p */
                parts[c].corner[k].x -= i % 3 ? 2.5 : -2.5;
        }
        struct screened one = past(&p, &q, parts, 1, tolerance * p.area);
        struct screened others = past(&q, &p, parts + 1, 3, tolerance * p.area);
        double open = open_exchange(&p, &q);
        tally_add(&tally, one.exchange + others.exchange, open, one.error + others.error,
                  p.area);
        passing += one.exchange / open / PAIRS;
    }
    tap_ok(tally.worst < 2.0 * tolerance && tally.beyond < 1.5 && passing > 0.3 &&
               passing < 0.7,
           "parts of a wall, tolerance %g: F is off by %.1e, %.2f of what is told; %.2f "
           "pass", tolerance, tally.worst, tally.beyond, passing);
}

/* --- many segments --- */

/* The centre of part i of 256. */
static struct vec3 centre_of(const struct triangle *t, int i)
{
    struct triangle part = *t;
    for (int size = PARTS / 4; size > 0; size /= 4)
        part = triangle_child(&part, i / size % 4);
    return triangle_centroid(&part);
}

/* The share of the light that passes, by 65,536 segments. */
static double sum_of_segments(const struct facet *p, const struct facet *q,
                              const struct triangle *screens, int count)
{
    double all = 0.0, seen = 0.0;
    for (int i = 0; i < PARTS; i++)
        for (int j = 0; j < PARTS; j++) {
            struct vec3 x = centre_of(&p->triangle, i),
                        y = centre_of(&q->triangle, j);
            double weight = disk_exchange(x, p->plane.normal, p->area / PARTS, y,
                                          q->plane.normal, q->area / PARTS);
            struct segment s = segment_make(x, y);
            bool blocked = false;
            for (int k = 0; k < count && !blocked; k++) {
                struct plane plane = triangle_plane(&screens[k]);
                blocked = segment_is_blocked_by(&s, &screens[k], &plane);
            }
            all += weight;
            seen += blocked ? 0.0 : weight;
        }
    return seen / all;
}

/* Screens that overlap, cross each other, and reach through both triangles. */
static void test_segments(void)
{
    enum { CASES = 12, SCREENS = 5 };
    struct random random = random_seed(3);
    double worst = 0.0, least = 1.0, most = 0.0;
    for (int i = 0; i < CASES; i++) {
        struct facet p = facet_of(level_triangle(&random, 0.2, 0.5, 0.0, 0.2, true));
        struct facet q = facet_of(level_triangle(&random, 0.2, 0.8, 1.0, 1.5, false));
        struct triangle screens[SCREENS];
        for (int s = 0; s < SCREENS; s++)
            screens[s] = level_triangle(&random, 0.7, 0.25, s == 0 ? -0.5 : 0.2,
                                        s == 1 ? 2.0 : 0.9, s % 2);
        double share = past(&p, &q, screens, SCREENS, 1e-4 * p.area).exchange /
                       open_exchange(&p, &q);
        worst = fmax(worst, fabs(share - sum_of_segments(&p, &q, screens, SCREENS)));
        least = fmin(least, share);
        most = fmax(most, share);
    }
    /* Parts of a sixteenth of the sides: of those on edges of shadows many err. */
    tap_ok(worst < 0.01 && most - least > 0.2,
           "%.2f to %.2f pass random screens, as many segments say, but for %.1e", least,
           most, worst);
}

/* --- nothing, all, too many --- */

static void test_ends(void)
{
    struct random random = random_seed(4);
    struct facet p = facet_of(level_triangle(&random, 0.1, 0.3, 0.0, 0.0, true));
    struct facet q = facet_of(level_triangle(&random, 0.1, 0.3, 1.0, 1.0, false));
    double open = open_exchange(&p, &q);
    struct triangle screen = level_triangle(&random, 0.1, 5.0, 0.5, 0.6, true);
    struct screened found = past(&p, &q, &screen, 1, 1e-4 * p.area);
    tap_ok(found.exchange == 0.0 && found.error < 1e-4 * p.area && found.agreed,
           "nothing passes a wall: all points agree");
    for (int k = 0; k < 3; k++)
        screen.corner[k].x += 20.0;
    found = past(&p, &q, &screen, 1, 1e-4 * p.area);
    tap_ok(found.exchange == open && found.error < 1e-4 * p.area && found.agreed,
           "all passes beside it: all points agree");
    screen = level_triangle(&random, 0.1, 0.1, 0.5, 0.6, true);
    found = past(&p, &q, &screen, 1, 1e-4 * p.area);
    tap_ok(found.exchange > 0.0 && found.exchange < open && !found.agreed,
           "a part passes a small one: they do not");
    struct triangle many[SCREENS_MAX];
    for (int i = 0; i < SCREENS_MAX; i++) {
        many[i] = level_triangle(&random, 0.0, 0.02, 0.5, 0.5, true);
        for (int k = 0; k < 3; k++) {
            many[i].corner[k].x += 0.06 * (i % 6 - 3);
            many[i].corner[k].y += 0.06 * (i / 6 - 2);
        }
    }
    tap_ok(past(&p, &q, many, SCREENS_MAX, 1e-4 * p.area).exchange < 0.0,
           "%d scattered screens make too many parts, which is told", SCREENS_MAX);
}

/* --- what a point sees --- */

static const struct vec3 UP = {0.0, 0.0, 1.0};

static double factor_left(const struct outlook *outlook)
{
    double sum = 0.0;
    for (int i = 0; i < outlook->count; i++)
        sum += point_polygon_factor(outlook->from, UP, outlook->piece[i].corner,
                                    outlook->piece[i].count);
    return sum;
}

/* A screen of eight triangles with a hole of 2 cm by 10 cm, halfway to a lamp of 9 m: the
 * factor of the visible part is that of the hole. */
static void test_hole(void)
{
    static const double EDGE[4] = {-4.0, -0.01, 0.01, 4.0},
                        SIDE[4] = {-4.0, -0.05, 0.05, 4.0};
    const struct triangle lamp = {{{-3, -3, 1}, {0, 6, 1}, {3, -3, 1}}};
    const struct vec3 hole[4] = {{-0.01, -0.05, 0.5}, {-0.01, 0.05, 0.5},
                                 {0.01, 0.05, 0.5}, {0.01, -0.05, 0.5}};
    double worst = 0.0;
    for (int place = 0; place < 10; place++) {
        struct vec3 x = point(0.05 * place, 0.03 * place, 0.0);
        struct outlook outlook;
        outlook_start(&outlook, x, &lamp);
        for (int i = 0; i < 9; i++) {
            double x0 = EDGE[i % 3], x1 = EDGE[i % 3 + 1], y0 = SIDE[i / 3],
                   y1 = SIDE[i / 3 + 1];
            const struct triangle half[2] = { /* a front and a back */
                {{point(x0, y0, 0.5), point(x1, y0, 0.5), point(x1, y1, 0.5)}},
                {{point(x0, y0, 0.5), point(x0, y1, 0.5), point(x1, y1, 0.5)}}};
            for (int k = 0; k < 2 && i != 4; k++)
                outlook_hide(&outlook, &half[k]);
        }
        double exact = point_polygon_factor(x, UP, hole, 4);
        worst = fmax(worst, fabs(factor_left(&outlook) / exact - 1.0));
    }
    tap_ok(worst <= 1e-9, "a hole in a screen is all that is left over, within %.1e",
           worst);
}

int main(void)
{
    test_hole();
    for (size_t k = 0; k < sizeof TOLERANCES / sizeof TOLERANCES[0]; k++) {
        test_whole_shadows(TOLERANCES[k]);
        test_halves(TOLERANCES[k]);
    }
    test_segments();
    test_ends();
    return tap_done();
}
