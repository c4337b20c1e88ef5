/* A form factor in four ways: chapter 2 of the course.
 *
 * Two unit squares face each other at distance h; or they stand at right angles, with
 * a gap of h between the edge of the one and the plane of the other. Printed is F by
 *
 *     one disk     Eq. 2 of the paper, from centre to centre,
 *     16 disks     Eq. 2 between the quarters, the mean of 4 x 4, as the paper's Fig. 2,
 *     a point      Lambert's formula, from the centre of one square to the whole other,
 *     exact        phr's own contour integral (geom/contour.h),
 *
 * and how wrong the first three are. Nothing stands between the squares. */
#include <stdio.h>

#include "geom/lambert.h"
#include "rad/formfactor.h"
#include "geom/contour.h"

struct square {
    struct vec3 corner[4]; /* m; counter-clockwise as seen from the front */
    struct vec3 normal;
};

/* Corner (i, j) of a grid of 2 x 2 quarters, or the middle of one for halves. */
static struct vec3 point(const struct square *s, double i, double j)
{
    struct vec3 u = vec3_sub(s->corner[1], s->corner[0]);
    struct vec3 v = vec3_sub(s->corner[3], s->corner[0]);
    return vec3_add(s->corner[0],
                    vec3_add(vec3_scale(u, i / 2.0), vec3_scale(v, j / 2.0)));
}

static double one_disk(const struct square *p, const struct square *q)
{
    return disk_exchange(point(p, 1.0, 1.0), p->normal, 1.0, point(q, 1.0, 1.0),
                         q->normal, 1.0);
}

static double sixteen_disks(const struct square *p, const struct square *q)
{
    double sum = 0.0;
    for (int k = 0; k < 16; k++)
        sum += disk_exchange(point(p, k / 8 + 0.5, k / 4 % 2 + 0.5), p->normal, 0.25,
                             point(q, k / 2 % 2 + 0.5, k % 2 + 0.5), q->normal, 0.25);
    return sum;
}

static void print_row(double h, const struct square *p, const struct square *q)
{
    double exact = polygon_exchange(p->corner, 4, q->corner, 4);
    double ways[3] = {one_disk(p, q), sixteen_disks(p, q),
                      point_polygon_factor(point(p, 1.0, 1.0), p->normal, q->corner, 4)};
    printf("%6.3f  %8.5f", h, exact);
    for (int k = 0; k < 3; k++)
        printf("   %8.5f %+6.1f %%", ways[k], 100.0 * (ways[k] / exact - 1.0));
    printf("\n");
}

int main(void)
{
    const double distances[] = {4.0, 2.0, 1.0, 0.5, 0.25, 0.125};
    const struct square floor = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 0, 1}};
    printf("%6s  %8s%20s%20s%20s\nfacing\n", "h", "exact", "one disk", "16 disks",
           "a point");
    for (int k = 0; k < 6; k++) {
        double h = distances[k];
        struct square lamp = {{{0, 0, h}, {0, 1, h}, {1, 1, h}, {1, 0, h}}, {0, 0, -1}};
        print_row(h, &floor, &lamp);
    }
    printf("at right angles\n");
    for (int k = 0; k < 6; k++) {
        double h = distances[k] - 0.125;
        struct square wall = {{{-h, 0, 0}, {-h, 1, 0}, {-h, 1, 1}, {-h, 0, 1}},
                              {1, 0, 0}};
        print_row(h, &floor, &wall);
    }
    return 0;
}
