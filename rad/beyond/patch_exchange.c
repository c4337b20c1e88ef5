/* The exchange of two patches.
 *
 * Visibility comes from the 16 segments of rad/formfactor.c, weighted by the disks. The
 * exchange area without blockers is exact, from points of one patch to the whole of the
 * other: disks overlap where patches are close.
 *
 * No free segment does not mean that nothing passes. Only a proof shows this: a wall that
 * stops every segment (geom/wall.c). */
#include "rad/beyond/patch_exchange.h"

#include <math.h>

#include "geom/lambert.h"

enum { SUBAREAS = BUNDLE_ENDS, RAYS = BUNDLE_RAYS, ALL_RAYS = (1 << RAYS) - 1 };

bool facets_face(const struct facet *p, const struct facet *q)
{
    return triangle_reach(&q->triangle, &p->plane) > GEOM_ROUNDING &&
           triangle_reach(&p->triangle, &q->plane) > GEOM_ROUNDING;
}

/* A guess for patches cut by the other's plane, by a disk with the heights of the highest
 * corners in place of those of the centroids: rather too much. The centroids may all lie
 * below the horizon while the corners do not: such a pair stays in play. */
static double exchange_across_horizon(const struct facet *p, const struct facet *q)
{
    struct vec3 d = vec3_sub(triangle_centroid(&q->triangle),
                             triangle_centroid(&p->triangle));
    double r2 = vec3_dot(d, d);
    double rise_p = triangle_reach(&q->triangle, &p->plane);
    double rise_q = triangle_reach(&p->triangle, &q->plane);
    double cosines = fmin(1.0, rise_p * rise_q / r2);
    return p->area * q->area * cosines / (PI * r2 + fmax(p->area, q->area));
}

/* The arriving segments, as bits. */
static unsigned pair_look(const struct facet_pair *pair, const struct octree *octree,
                          struct visibility *visibility, struct octree_counts *counts)
{
    unsigned facing = pair->bundle.asked;
    if (visibility->open || facing == 0)
        return facing;
    return facing & ~octree_block(octree, &pair->bundle, &visibility->blocker, counts);
}

/* Sums of the kernels of one sub-area of p (`of_p`) or q: all facing ones, and the
 * visible ones. */
static void sum_kernels(const struct facet_pair *pair, unsigned visible, bool of_p,
                        int sub, double *all, double *seen)
{
    *all = *seen = 0.0;
    for (int other = 0; other < SUBAREAS; other++) {
        int ray = of_p ? SUBAREAS * sub + other : SUBAREAS * other + sub;
        *all += pair->kernels[ray];
        *seen += visible >> ray & 1u ? pair->kernels[ray] : 0.0;
    }
}

/* Exchange areas of the four sub-areas of a side with the whole of the other: not
 * occluded, and as far as visible. */
struct side {
    double unoccluded[SUBAREAS], area[SUBAREAS];
};

/* The mean form factor from a sub-area to the other patch, by three points: exact for
 * factors varying with the square of the place (Stroud's formula of degree 2). */
static double factor_close_by(const struct facet *own, int sub, const struct facet *other)
{
    struct triangle area = triangle_child(&own->triangle, sub);
    struct vec3 centroid = triangle_centroid(&area);
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        struct vec3 point = vec3_middle(centroid, area.corner[k]);
        sum += point_triangle_factor(point, own->plane.normal, &other->triangle);
    }
    return sum / 3.0;
}

/* The visible share of a sub-area is its segments' kernels'; where none faces, the whole
 * pair's. */
static struct side side_of(const struct facet_pair *pair, unsigned visible, bool of_p,
                           bool apart)
{
    const struct facet *own = of_p ? pair->p : pair->q, *other = of_p ? pair->q : pair->p;
    const struct vec3 *points = of_p ? pair->bundle.from : pair->bundle.to;
    struct side side;
    double all[SUBAREAS], seen[SUBAREAS], all_sum = 0.0, seen_sum = 0.0;
    for (int sub = 0; sub < SUBAREAS; sub++) {
        sum_kernels(pair, visible, of_p, sub, &all[sub], &seen[sub]);
        all_sum += all[sub];
        seen_sum += seen[sub];
    }
    double share = all_sum > 0.0 ? seen_sum / all_sum : 0.0;
    for (int sub = 0; sub < SUBAREAS; sub++) {
        double factor = apart ? point_triangle_factor(points[sub], own->plane.normal,
                                                      &other->triangle)
                              : factor_close_by(own, sub, other);
        side.unoccluded[sub] = 0.25 * own->area * factor;
        side.area[sub] =
            side.unoccluded[sub] * (all[sub] > 0.0 ? seen[sub] / all[sub] : share);
    }
    return side;
}

static double sum_of(const double values[SUBAREAS])
{
    return (values[0] + values[1]) + (values[2] + values[3]);
}

/* The parts of the four sub-areas in the whole: a quarter each if there is nothing. */
static void set_parts(const struct side *side, double parts[SUBAREAS])
{
    double sum = sum_of(side->area);
    for (int sub = 0; sub < SUBAREAS; sub++)
        parts[sub] = sum > 0.0 ? side->area[sub] / sum : 0.25;
}

/* Distance over the sum of the radii. Nearer, a patch might receive more than all light
 * by one disk. */
static const double FAR = 1.5;

/* True if patches are far enough apart for their size to trust the form factor from one
 * point of each sub-area. */
static bool is_apart(const struct facet *p, const struct facet *q)
{
    struct vec3 x = triangle_centroid(&p->triangle), y = triangle_centroid(&q->triangle);
    double radii = triangle_radius(&p->triangle) + triangle_radius(&q->triangle);
    return vec3_length(vec3_sub(y, x)) > FAR * radii;
}

struct exchange exchange_estimate(const struct facet *p, const struct facet *q,
                                  const struct octree *octree,
                                  struct visibility *visibility,
                                  struct octree_counts *counts)
{
    struct facet_pair pair = facet_pair_make(p, q);
    unsigned visible = pair_look(&pair, octree, visibility, counts);
    bool apart = is_apart(p, q);
    struct side side_p = side_of(&pair, visible, true, apart);
    struct side side_q = side_of(&pair, visible, false, apart);
    const struct side *smaller = p->area <= q->area ? &side_p : &side_q;
    double sum = sum_of(smaller->unoccluded);
    struct exchange exchange = {.unoccluded = sum, .apart = apart};
    exchange.seen = sum > 0.0 ? sum_of(smaller->area) / sum : 0.0;
    exchange.area = exchange.seen * exchange.unoccluded;
    set_parts(&side_p, exchange.parts_p);
    set_parts(&side_q, exchange.parts_q);
    if (pair.bundle.asked != ALL_RAYS)
        exchange.unoccluded = fmax(exchange.unoccluded, exchange_across_horizon(p, q));
    double limit = fmin(p->area, q->area);
    if (exchange.unoccluded > limit) {
        exchange.area = fmin(limit, exchange.area * (limit / exchange.unoccluded));
        exchange.unoccluded = limit;
    }
    return exchange;
}

bool facets_are_walled_off(const struct facet *p, const struct facet *q,
                           const struct octree *octree, struct octree_counts *counts)
{
    return octree_has_wall(octree, p->triangle.corner, 3, q->triangle.corner, 3, counts);
}

bool facets_are_open(const struct facet *p, const struct facet *q,
                     const struct octree *octree, struct octree_counts *counts)
{
    const int32_t own[2] = {p->input, q->input};
    return octree_list_shaft(octree, &p->triangle, &p->plane, &q->triangle, &q->plane,
                             own, NULL, 0, counts) == 0;
}
