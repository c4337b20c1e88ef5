/* The 16-ray disk form factor.
 *
 * Each patch is cut into its four children a = 0..3 and b = 0..3. With r the distance of their
 * centroids and theta the angles to the normals, the exchange area is
 *
 *     G = sum over a, b of  v_ab  A_a A_b cos theta_a cos theta_b / (pi r^2 + max(A_a, A_b)),
 *
 * v_ab = 1 if the segment between the centroids is free.
 *
 * On the denominator: the paper prints F_ij = v cos cos A_j / (pi r^2 + A_i), which has no
 * bound when a small i lies close to a large j (F = 24 where 0.968 is right). Wallace's disk
 * has the area of the source j in both places; computed from the smaller patch, its source is
 * the larger one, hence the maximum, and G is symmetric. Of patches that all but touch, the four
 * disks of one side overlap as seen from the other; where that makes G larger than the smaller
 * patch, it is cut down to it, so F <= 1 in both directions.
 *
 * Pairs of sub-areas below each other's horizon exchange nothing: they get no ray and do not
 * count as blocked.
 *
 * No free ray does not mean that nothing passes. That is only taken so with a proof: a
 * triangle T whose plane has p on one side and q on the other, and that stops all nine segments
 * between corners of p and corners of q. Then every segment from x in p to y in q is stopped:
 * x and y are weighted averages of corners, and the point where xy crosses the plane is a
 * weighted average (weights l_i m_j (e_i + f_j), with l, m the weights of the corners and e, f
 * their distances to the plane, normalised) of the nine crossing points, all of which lie in T,
 * which is convex. */
#include "rad/formfactor.h"

#include <math.h>

enum { SUBAREAS = BUNDLE_ENDS, RAYS = BUNDLE_RAYS, ALL_RAYS = (1 << RAYS) - 1 };

static const double PI = 3.14159265358979323846;

struct facet facet_make(const struct forest *forest, int32_t patch)
{
    int32_t root = (int32_t)forest->patches[patch].id.root;
    return (struct facet){
        .triangle = forest_triangle(forest, patch),
        .plane = scene_root_plane(forest->scene, root),
        .area = forest_area(forest, patch),
        .input = scene_input_of(forest->scene, root),
    };
}

/* Largest distance of a corner of `t` in front of `plane`. */
static double reach_above(const struct plane *plane, const struct triangle *t)
{
    double a = plane_distance(plane, t->corner[0]);
    double b = plane_distance(plane, t->corner[1]);
    double c = plane_distance(plane, t->corner[2]);
    return fmax(a, fmax(b, c));
}

bool facets_face(const struct facet *p, const struct facet *q)
{
    return reach_above(&p->plane, &q->triangle) > GEOM_ROUNDING &&
           reach_above(&q->plane, &p->triangle) > GEOM_ROUNDING;
}

/* A A' cos cos' / (pi r^2 + max(A, A')) of two small areas at x and y; 0 below a horizon. */
static double disk_kernel(struct vec3 x, struct vec3 normal_x, double area_x, struct vec3 y,
                          struct vec3 normal_y, double area_y)
{
    struct vec3 d = vec3_sub(y, x);
    double rise_x = vec3_dot(normal_x, d), rise_y = -vec3_dot(normal_y, d); /* r cos theta */
    if (rise_x <= 0.0 || rise_y <= 0.0)
        return 0.0;
    double r2 = vec3_dot(d, d);
    return area_x * area_y * (rise_x * rise_y / r2) / (PI * r2 + fmax(area_x, area_y));
}

/* For patches that the other's plane cuts: the centroids may all lie below the horizon while
 * the corners do not. A disk estimate with the heights of the highest corners, so that such a
 * pair stays in play. */
static double horizon_estimate(const struct facet *p, const struct facet *q)
{
    struct vec3 d = vec3_sub(triangle_centroid(&q->triangle), triangle_centroid(&p->triangle));
    double r2 = vec3_dot(d, d);
    double rise_p = reach_above(&p->plane, &q->triangle);
    double rise_q = reach_above(&q->plane, &p->triangle);
    double cosines = fmin(1.0, rise_p * rise_q / r2);
    return p->area * q->area * cosines / (PI * r2 + fmax(p->area, q->area));
}

static void subarea_centroids(const struct triangle *t, struct vec3 centroids[SUBAREAS])
{
    for (int k = 0; k < SUBAREAS; k++) {
        struct triangle child = triangle_child(t, k);
        centroids[k] = triangle_centroid(&child);
    }
}

/* Sets the segments of the bundle and their kernels; asks for those that face each other. */
static void aim(const struct facet *p, const struct facet *q, struct bundle *bundle,
                double kernels[RAYS])
{
    *bundle = (struct bundle){.own = {p->input, q->input}};
    subarea_centroids(&p->triangle, bundle->from);
    subarea_centroids(&q->triangle, bundle->to);
    for (int ray = 0; ray < RAYS; ray++) {
        kernels[ray] = disk_kernel(bundle->from[ray / SUBAREAS], p->plane.normal, 0.25 * p->area,
                                   bundle->to[ray % SUBAREAS], q->plane.normal, 0.25 * q->area);
        bundle->asked |= (unsigned)(kernels[ray] > 0.0) << ray;
    }
}

struct exchange exchange_by_disks(const struct facet *p, const struct facet *q,
                                  const struct octree *octree, int32_t *guess,
                                  struct octree_counts *counts)
{
    double kernels[RAYS];
    struct bundle bundle;
    aim(p, q, &bundle, kernels);
    unsigned blocked = octree_block(octree, &bundle, guess, counts);
    struct exchange exchange = {0.0, 0.0};
    for (int ray = 0; ray < RAYS; ray++) {
        exchange.unoccluded += kernels[ray];
        exchange.area += blocked >> ray & 1u ? 0.0 : kernels[ray];
    }
    double limit = fmin(p->area, q->area);
    if (exchange.unoccluded > limit) {
        exchange.area = fmin(limit, exchange.area * (limit / exchange.unoccluded));
        exchange.unoccluded = limit;
    }
    if (bundle.asked != ALL_RAYS)
        exchange.unoccluded = fmax(exchange.unoccluded, horizon_estimate(p, q));
    return exchange;
}

bool facets_are_walled_off(const struct facet *p, const struct facet *q,
                           const struct octree *octree, struct octree_counts *counts)
{
    const int32_t own[2] = {p->input, q->input};
    return octree_has_wall(octree, &p->triangle, &q->triangle, own, counts);
}
