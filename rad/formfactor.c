/* The form factor of the paper: disks and 16 rays.
 *
 * Each patch is cut into its four children a = 0..3 and b = 0..3. With r the distance of
 * their centroids and theta the angles to the normals, the exchange area is
 *
 *     G = sum over a, b of
 *         v_ab A_a A_b cos theta_a cos theta_b / (pi r^2 + max(A_a, A_b)),
 *
 * v_ab = 1 if the segment between the centroids is free: Eq. 2 for each of the 16 rays
 * of Fig. 2.
 *
 * On the denominator: the paper prints F_ij = v cos cos A_j / (pi r^2 + A_i), which has
 * no bound when a small i lies close to a large j (F = 24 where 0.968 is right).
 * Wallace's disk has the area of the source j in both places; computed from the smaller
 * patch, its source is the larger one, hence the maximum, and G is symmetric. Of patches
 * that all but touch, the four disks of one side overlap as seen from the other; a G
 * larger than the smaller patch is cut down to its area, so F <= 1 in both directions.
 *
 * Sub-areas below each other's horizon exchange nothing, whatever is in between, and get
 * no ray. */
#include "rad/formfactor.h"

#include <math.h>

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

double disk_exchange(struct vec3 x, struct vec3 normal_x, double area_x, struct vec3 y,
                     struct vec3 normal_y, double area_y)
{
    struct vec3 d = vec3_sub(y, x);
    /* r cos theta at either end */
    double rise_x = vec3_dot(normal_x, d), rise_y = -vec3_dot(normal_y, d);
    if (rise_x <= 0.0 || rise_y <= 0.0)
        return 0.0;
    double r2 = vec3_dot(d, d);
    return area_x * area_y * (rise_x * rise_y / r2) / (PI * r2 + fmax(area_x, area_y));
}

struct facet_pair facet_pair_make(const struct facet *p, const struct facet *q)
{
    struct facet_pair pair = {.p = p, .q = q, .bundle = {.own = {p->input, q->input}}};
    struct bundle *bundle = &pair.bundle;
    for (int k = 0; k < BUNDLE_ENDS; k++) {
        struct triangle of_p = triangle_child(&p->triangle, k);
        struct triangle of_q = triangle_child(&q->triangle, k);
        bundle->from[k] = triangle_centroid(&of_p);
        bundle->to[k] = triangle_centroid(&of_q);
    }
    for (int ray = 0; ray < BUNDLE_RAYS; ray++) {
        pair.kernels[ray] = disk_exchange(bundle->from[ray / BUNDLE_ENDS],
                                          p->plane.normal,
                                          0.25 * p->area, bundle->to[ray % BUNDLE_ENDS],
                                          q->plane.normal, 0.25 * q->area);
        bundle->asked |= (unsigned)(pair.kernels[ray] > 0.0) << ray;
    }
    return pair;
}

double exchange_area(const struct facet *p, const struct facet *q,
                     const struct octree *octree,
                     int32_t *blocker, double *seen, struct octree_counts *counts)
{
    struct facet_pair pair = facet_pair_make(p, q);
    unsigned asked = pair.bundle.asked, blocked = 0;
    if (asked != 0)
        blocked = octree_block(octree, &pair.bundle, blocker, counts);
    double area = 0.0;
    int rays = 0, arrived = 0;
    for (int ray = 0; ray < BUNDLE_RAYS; ray++) {
        bool arrives = (asked & ~blocked) >> ray & 1u;
        rays += (int)(asked >> ray & 1u);
        arrived += arrives;
        area += arrives ? pair.kernels[ray] : 0.0;
    }
    *seen = rays > 0 ? (double)arrived / rays : 0.0;
    return fmin(area, fmin(p->area, q->area));
}
