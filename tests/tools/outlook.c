/* Tests of viewfactors/outlook.h: the visible part of a triangle, by its factor and by
 * segments. */
#include "tools/viewfactors/outlook.h"

#include <math.h>

#include "geom/lambert.h"
#include "tests/scenes.h"
#include "tests/tap.h"

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

/* Barycentric coordinates tell if a point of the lamp's plane is in a piece. */
static bool is_left(const struct outlook *outlook, struct vec3 y)
{
    for (int i = 0; i < outlook->count; i++) {
        const struct outlook_piece *p = &outlook->piece[i];
        bool left = false, right = false;
        for (int k = 0; k < p->count; k++) {
            struct vec3 side = vec3_sub(p->corner[(k + 1) % p->count], p->corner[k]);
            double turn = vec3_cross(side, vec3_sub(y, p->corner[k])).z;
            left = left || turn > 0.0;
            right = right || turn < 0.0;
        }
        if (!left || !right)
            return true;
    }
    return false;
}

/* Random blockers, some of which are met by no segment, until pieces are too many: the
 * part that is blocked may be left over then, but nothing that is not may be missing. */
static void test_random(int blockers, bool exact)
{
    const struct triangle lamp = {{{0, 0, 1}, {0, 1, 1}, {1, 0, 1}}};
    struct random random = random_seed(3);
    int missing = 0, extra = 0, left = 0, points = 0;
    for (int trial = 0; trial < 200; trial++) {
        struct vec3 x =
            point(random_between(&random, 0, 1), random_between(&random, 0, 1), 0.0);
        struct triangle t[40];
        struct outlook outlook;
        outlook_start(&outlook, x, &lamp);
        for (int i = 0; i < blockers; i++) {
            for (int k = 0; k < 3; k++)
                t[i].corner[k] =
                    point(random_between(&random, 0, 1), random_between(&random, 0, 1),
                       random_between(&random, -0.2, 0.9));
            outlook_hide(&outlook, &t[i]);
        }
        for (int n = 0; n < 100; n++, points++) {
            double u = random_between(&random, 0, 1), v = random_between(&random, 0, 1);
            struct vec3 y = u + v < 1.0 ? point(u, v, 1.0) : point(1.0 - u, 1.0 - v, 1.0);
            struct segment segment = segment_make(x, y);
            bool blocked = false;
            for (int i = 0; i < blockers && !blocked; i++) {
                struct plane plane = triangle_plane(&t[i]);
                blocked = segment_is_blocked_by(&segment, &t[i], &plane);
            }
            left += !blocked;
            missing += !blocked && !is_left(&outlook, y);
            extra += blocked && is_left(&outlook, y);
        }
    }
    tap_ok(missing == 0 && (!exact || extra == 0) && left > 1000,
           "%d blockers: of %d points %d are seen, %d of them are missing, %d too many",
           blockers, points, left, missing, extra);
}

int main(void)
{
    test_hole();
    test_random(1, true);
    test_random(3, true);
    test_random(40, false);
    return tap_done();
}
