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
 * No free ray does not mean that nothing passes. It is only taken as blocked with a proof: a
 * triangle T whose plane has p on one side and q on the other, and that stops all nine segments
 * between corners of p and corners of q. Then every segment from x in p to y in q is stopped:
 * x and y are weighted averages of corners, and the point where xy crosses the plane is a
 * weighted average (weights l_i m_j (e_i + f_j), with l, m the weights of the corners and e, f
 * their distances to the plane, normalised) of the nine crossing points, all of which lie in T,
 * which is convex. */
#include "rad/formfactor.h"

#include <math.h>
#include <stddef.h>

enum { SUBAREAS = 4, RAYS = SUBAREAS * SUBAREAS };

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

static bool plane_separates(const struct plane *plane, const struct triangle *p,
                            const struct triangle *q)
{
    int sides[2] = {0, 0};
    for (int k = 0; k < 3; k++) {
        double dp = plane_distance(plane, p->corner[k]), dq = plane_distance(plane, q->corner[k]);
        sides[0] += (dp > GEOM_ROUNDING) - (dp < -GEOM_ROUNDING);
        sides[1] += (dq > GEOM_ROUNDING) - (dq < -GEOM_ROUNDING);
    }
    return sides[0] * sides[1] == -9;
}

/* The proof of the essay: true only if `blocker` stops every segment between p and q. */
static bool blocks_for_sure(const struct octree *octree, int32_t blocker, const struct triangle *p,
                            const struct triangle *q)
{
    const struct triangle *t = octree_triangle(octree, blocker);
    if (!plane_separates(octree_plane(octree, blocker), p, q))
        return false;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            struct segment s = segment_make(p->corner[i], q->corner[j]);
            if (!segment_line_meets(&s, t, NULL))
                return false;
        }
    }
    return true;
}

static bool is_proved_blocked(const struct octree *octree, const int32_t *blockers, int count,
                              const struct facet *p, const struct facet *q)
{
    for (int i = 0; i < count; i++) {
        bool tried = false;
        for (int j = 0; j < i; j++)
            tried = tried || blockers[j] == blockers[i];
        if (!tried && blocks_for_sure(octree, blockers[i], &p->triangle, &q->triangle))
            return true;
    }
    return false;
}

static void subarea_centroids(const struct triangle *t, struct vec3 centroids[SUBAREAS])
{
    for (int k = 0; k < SUBAREAS; k++) {
        struct triangle child = triangle_child(t, k);
        centroids[k] = triangle_centroid(&child);
    }
}

struct exchange exchange_by_disks(const struct facet *p, const struct facet *q,
                                  const struct octree *octree, struct octree_counts *counts)
{
    struct vec3 x[SUBAREAS], y[SUBAREAS];
    subarea_centroids(&p->triangle, x);
    subarea_centroids(&q->triangle, y);
    const int32_t own[2] = {p->input, q->input};
    int32_t blockers[RAYS], last = -1;
    int fired = 0, blocked = 0;
    struct exchange exchange = {0.0, 0.0, false};
    for (int a = 0; a < SUBAREAS; a++) {
        for (int b = 0; b < SUBAREAS; b++) {
            double kernel = disk_kernel(x[a], p->plane.normal, 0.25 * p->area, y[b],
                                        q->plane.normal, 0.25 * q->area);
            if (kernel <= 0.0)
                continue;
            fired++;
            exchange.unoccluded += kernel;
            int32_t blocker = octree_blocker(octree, x[a], y[b], own, last, counts);
            if (blocker < 0)
                exchange.area += kernel;
            else
                last = blockers[blocked++] = blocker;
        }
    }
    double limit = fmin(p->area, q->area);
    if (exchange.unoccluded > limit) {
        exchange.area = fmin(limit, exchange.area * (limit / exchange.unoccluded));
        exchange.unoccluded = limit;
    }
    if (fired < RAYS)
        exchange.unoccluded = fmax(exchange.unoccluded, horizon_estimate(p, q));
    if (fired > 0 && blocked == fired)
        exchange.blocked = is_proved_blocked(octree, blockers, blocked, p, q);
    return exchange;
}
