/* Things that stand on a leaf, and faces in its plane that cover it.
 *
 * Rays that begin inside of a thing bring no light, and none of theirs leaves the scene:
 * they are told by probes that meet bounds of the thing on all sides, which may be faces
 * of its own or those of walls that it touches. Other faces in the leaf's plane, as of a
 * picture on a wall, are found by a few points just above it. */
#include "rad/beyond/met.h"

#include <math.h>

#include "rad/beyond/sequence.h"
#include "rad/beyond/sample.h"

/* Faces in one place are less far apart, in scene units. */
static const double ABOVE = 0x1p-26;

/* Points of a leaf that are tested for being bare. */
enum { BARE_POINTS = 4 };

/* True if another face lies back to back with the front at this point. */
static bool is_backed(struct receiver *r, const struct point *front)
{
    struct model *model = r->gather->model;
    struct vec3 step = vec3_scale(front->normal, ABOVE);
    int32_t own[2] = {front->input, -1}, other = -1;
    return octree_blocks_segment(model->octree, vec3_add(front->at, step),
                                 vec3_sub(front->at, step), own, &other,
                                 &model->counts) &&
           vec3_dot(scene_root_plane(model->scene, other).normal, front->normal) < 0.0;
}

/* True if a ray's end may bound the thing that it began in: a back; the front of a wall
 * that the thing touches, which counts before the back in the same place; or, where the
 * thing has no face there, a front across from one of these. `single` becomes true if a
 * back is met with no front in its place. */
static bool is_bound(struct receiver *r, enum met met, struct point *point, bool *single)
{
    if (met == MET_FRONT && !is_backed(r, point)) {
        struct vec3 normal = point->normal;
        met = probe(r, point_above(point->at, normal), normal, point);
        if (met == MET_FRONT && !is_backed(r, point))
            return false;
    }
    *single = *single || met == MET_BACK;
    return met != MET_NOTHING;
}

/* True if rays from the point, along the plane in four directions, all meet bounds. */
static bool is_among_bounds(struct receiver *r, struct vec3 origin, struct vec3 normal,
                            bool *single)
{
    static const double RISE = 0.1;
    struct vec3 along = direction_along(normal);
    struct point point;
    for (int k = 0; k < 4; k++, along = vec3_cross(normal, along)) {
        enum met met =
            probe(r, origin, vec3_add(along, vec3_scale(normal, RISE)), &point);
        if (!is_bound(r, met, &point, single))
            return false;
    }
    return true;
}

/* True if the point is inside of a thing: it is among bounds, and below one, or, where a
 * column reaches the ceiling, below a point among them. Below the back of a canopy a
 * point is not among them, in a bin not below one. Where all walls are double nothing
 * tells the inside of a box from a room, and it is taken for a room. */
static bool is_inside(struct receiver *r, struct vec3 origin)
{
    struct vec3 normal = r->facet.plane.normal;
    bool single = false;
    struct point point;
    if (!is_among_bounds(r, origin, normal, &single))
        return false;
    enum met met = probe(r, origin, normal, &point);
    if (met == MET_BACK)
        return true;
    return met == MET_FRONT &&
           (is_backed(r, &point) ||
            is_among_bounds(r, point_above(point.at, point.normal), point.normal,
                            &single)) &&
           single;
}

bool ray_comes_from_inside(struct receiver *r, struct vec3 origin, enum met met,
                           const struct point *at)
{
    struct point point;
    bool single = false;
    if (!r->sums.on_back)
        return false;
    point = *at;
    return is_bound(r, met, &point, &single) && is_inside(r, origin);
}

void receiver_find_covers(struct receiver *r)
{
    struct model *model = r->gather->model;
    struct sequence sequence = sequence_start(r->seed + 24);
    struct vec3 normal = r->facet.plane.normal;
    double u[SEQUENCE_DIMENSIONS];
    int covered = 0;
    r->row.bare = 0.0f;
    r->row.outside = 1.0f - (float)r->sums.inside / (float)r->rays;
    if (r->sums.inside == r->rays ||
        (r->gather->sums.count == 0 && !(rgb_sum(r->row.source) > 0.0)))
        return;
    for (uint32_t i = 0; i < BARE_POINTS; i++) {
        sequence_point(&sequence, i, u);
        struct vec3 x = triangle_of_square(&r->facet.triangle, u[0], u[1]);
        struct octree_hit hit;
        covered +=
            octree_first_hit(model->octree, vec3_add(x, vec3_scale(normal, ABOVE)),
                             vec3_scale(normal, -1.0), false, &hit, &model->counts) &&
            hit.triangle != r->facet.input && (hit.front || r->sums.inside == 0);
    }
    double share = (double)covered / BARE_POINTS / (double)r->row.outside;
    r->row.bare = 1.0f - (float)fmin(1.0, share);
}
