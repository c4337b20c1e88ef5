/* Things that stand on a leaf, and faces in its plane that cover it.
 *
 * Rays beginning inside of a thing bring no light and do not count as escaped: probes
 * meeting bounds of the thing on all sides tell such rays (inside.h). A few points just
 * above the leaf find other faces in its plane, as of a picture on a wall. Pictures take
 * narrow gaps for covered, too, as behind the frame of a window: a ray ending in one has
 * begun there if the upright ray ends there as well. */
#include "rad/beyond/gather/covers.h"

#include <math.h>

#include "rad/beyond/gather/inside.h"
#include "rad/beyond/gather/met.h"
#include "rad/beyond/sequence.h"
#include "rad/beyond/sample.h"

/* Points of a leaf tested for being bare. */
enum { BARE_POINTS = 4 };

/* A gap is narrow for a leaf if the square of its width is no more than this part of the
 * leaf's area. */
static const double NARROW = 0x1p-9;

/* True if rays from the point, along the plane in four directions, all meet bounds. */
static bool is_among_bounds(struct model *model, struct vec3 origin, struct vec3 normal,
                            bool *single)
{
    static const double RISE = 0.1;
    struct vec3 along = direction_along(normal);
    for (int k = 0; k < 4; k++, along = vec3_cross(normal, along)) {
        struct vec3 direction = vec3_add(along, vec3_scale(normal, RISE));
        if (!ray_is_bound(model, origin, vec3_unit(direction), single))
            return false;
    }
    return true;
}

/* True if the point is inside of a thing: among bounds, and below one, or, where a column
 * reaches the ceiling, below a point among bounds. Below the back of a canopy a point is
 * not among bounds, in a bin not below one. Where all walls are double nothing tells the
 * inside of a box from a room, and the box is taken for a room. */
static bool is_inside(struct receiver *r, struct vec3 origin)
{
    struct model *model = r->gather->model;
    struct vec3 normal = r->facet.plane.normal;
    bool single = false;
    if (!is_among_bounds(model, origin, normal, &single))
        return false;
    if (ray_is_bound(model, origin, normal, &single))
        return single;
    struct point point;
    return probe(r, origin, normal, &point) == MET_FRONT &&
           is_among_bounds(model, point_above(point.at, point.normal), point.normal,
                           &single) &&
           single;
}

bool ray_comes_from_inside(struct receiver *r, struct vec3 origin, struct vec3 direction)
{
    bool single = false;
    return ray_is_bound(r->gather->model, origin, direction, &single) &&
           is_inside(r, origin);
}

bool ray_ends_in_gap(struct receiver *r, struct vec3 x, struct vec3 end)
{
    struct model *model = r->gather->model;
    struct vec3 normal = r->facet.plane.normal;
    struct octree_hit hit;
    double height = vec3_dot(vec3_sub(end, x), normal), most = NARROW * r->facet.area;
    if (height * height > most ||
        !octree_first_hit(model->octree, x, normal, false, &hit, &model->counts))
        return false;
    height = plane_ahead(&model->scene->planes[hit.triangle], x, normal);
    return height * height <= most;
}

/* True if a ray of the receiver begins outside of things. */
static bool is_partly_outside(struct receiver *r)
{
    struct sequence sequence = sequence_start(r->seed);
    double u[SEQUENCE_DIMENSIONS];
    for (int i = 0; i < r->rays; i++) {
        sequence_point(&sequence, (uint32_t)i, u);
        struct vec3 x = receiver_start(r, u[2], u[3]);
        if (!is_inside(r, point_above(x, r->facet.plane.normal)))
            return true;
    }
    return false;
}

void receiver_find_outside(struct receiver *r)
{
    int lost = 0;
    if (r->sums->inside > 0 && r->sums->inside < r->rays && !is_partly_outside(r)) {
        lost = r->sums->inside;
        r->sums->inside = 0;
    }
    int outside = r->rays - r->sums->inside;
    if (outside > 0)
        r->row->cover.kept =
            1.0f - fminf(1.0f, (float)(r->escaped + lost) / (float)outside);
}

void receiver_find_covers(struct receiver *r)
{
    struct model *model = r->gather->model;
    struct sequence sequence = sequence_start(r->seed + 24);
    struct vec3 normal = r->facet.plane.normal;
    double u[SEQUENCE_DIMENSIONS];
    int covered = 0;
    bool pane = material_is_pane(forest_material(model->forest, r->row->leaf));
    r->row->cover.bare = 0.0f;
    r->row->cover.outside = 1.0f - (float)r->sums->inside / (float)r->rays;
    r->row->cover.open = r->row->cover.outside - (float)r->sums->in_gap / (float)r->rays;
    if (r->sums->inside == r->rays ||
        (r->gather->sums->count == 0 && !(rgb_sum(r->row->source) > 0.0)))
        return;
    for (uint32_t i = 0; i < BARE_POINTS && !pane; i++) { /* below a pane is a way out */
        sequence_point(&sequence, i, u);
        struct vec3 x = triangle_of_square(&r->facet.triangle, u[0], u[1]);
        struct octree_hit hit;
        covered +=
            octree_first_hit(model->octree, vec3_add(x, vec3_scale(normal, FACES_APART)),
                             vec3_scale(normal, -1.0), false, &hit, &model->counts) &&
            hit.triangle != r->facet.input && (hit.front || r->sums->inside == 0);
    }
    double share = (double)covered / BARE_POINTS / (double)r->row->cover.outside;
    r->row->cover.bare = 1.0f - (float)fmin(1.0, share);
}
