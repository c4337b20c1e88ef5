/* The octree: a tree of boxes, eight to a node, cut where cuts save most.
 *
 *     cell (space)          stored for it
 *     +-----+-----+         node: eight boxes side by side, each the box of all
 *     |  /\ |     |           triangles below that child
 *     | /__\|_____|         leaf: a run of records of 80 bytes
 *     |   \ | /\  |         record: a triangle's plane, two affine maps in float
 *     +-----+-----+
 *
 * The tree is an octree by its fan-out and by the place of its children: each takes the
 * octant in its direction, so the order in which a ray meets children depends on the
 * ray's signs alone. The boxes are no cubes: a cell is cut where queries become cheapest
 * (octree/build.c). Eight boxes fill one vector of lanes (octree/lanes.h), so a node
 * costs about as much as one box.
 *
 * One walk (octree/walk.h) answers all questions. Rays go down for first hits
 * (octree/hit.c), single segments and walls (octree/segment.c); packets of rays for the
 * first hits of a picture (octree/packet.c); shafts for bundles of 16 segments
 * (octree/bundle.c) and for empty shafts (octree/shaft.c); a half space for the hull,
 * below.
 *
 * Triangles with the whole scene on one side, the walls of a room, can block nothing
 * between two of its points. These are the hull, a tree of their own for first hits
 * only. */
#include "octree/octree.h"

#include <math.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/stop.h"
#include "geom/wall.h"
#include "octree/walk.h"

/* --- the hull of the scene --- */

/* A question: which triangles are above a plane? */
struct above {
    struct plane plane;
    const struct triangle *triangles;
    struct vec3 corner; /* the last one looked at */
    double highest;     /* distance of the highest corner so far */
};

static const double HULL_MARGIN = 0.5 * GEOM_ROUNDING;

/* Children whose boxes reach above the plane. */
INLINE unsigned above_enters(const void *beam, const struct node *node,
                             float enter[LANES])
{
    const struct above *above = beam;
    unsigned met = 0;
    (void)enter;
    for (int k = 0; k < LANES; k++) {
        double reach = -above->plane.offset;
        for (int axis = 0; axis < 3; axis++) {
            double n = vec3_axis(above->plane.normal, axis);
            reach += n * (double)node->bound[axis][n > 0.0][k];
        }
        met |= (unsigned)(reach > HULL_MARGIN) << k;
    }
    return met;
}

/* Visits a leaf: is any corner of its triangles above the plane? */
INLINE bool find_corner(void *at, const struct record *records, int32_t count,
                        struct octree_counts *counts)
{
    struct above *above = at;
    counts->triangle_tests += count;
    for (int32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            above->corner = above->triangles[records[i].triangle].corner[k];
            double height = plane_distance(&above->plane, above->corner);
            above->highest = real_max(above->highest, height);
            if (height > HULL_MARGIN)
                return true;
        }
    return false;
}

enum { ROOFS_MAX = 16 };

/* A plane with all corners of the scene at most `most` above. */
struct roof {
    struct plane plane;
    double most;
};

/* Answers so far, which spare a wall of many triangles a walk over the wall for each. */
struct roofs {
    const struct octree *octree; /* whose trees have all triangles */
    double reach;          /* no corner is farther from the origin */
    struct vec3 corner;    /* the last one found above a plane */
    struct roof last[ROOFS_MAX];
    int64_t count;         /* of all roofs found; the last ones are kept */
};

/* True if a known roof is so much alike that nothing is above this plane either. */
static bool is_under_roof(const struct roofs *roofs, const struct plane *plane)
{
    for (int64_t i = 0; i < roofs->count && i < ROOFS_MAX; i++) {
        const struct roof *roof = &roofs->last[i];
        double tilt = vec3_length(vec3_sub(plane->normal, roof->plane.normal));
        double shift = fabs(plane->offset - roof->plane.offset);
        if (roof->most + tilt * roofs->reach + shift <= HULL_MARGIN)
            return true;
    }
    return false;
}

static bool reaches_above(struct roofs *roofs, struct vec3 normal, double offset)
{
    const struct octree *octree = roofs->octree;
    const struct tree *trees[] = {&octree->inside, &octree->hull};
    struct above above = {{normal, offset}, octree->triangles, roofs->corner, -HUGE_VAL};
    struct octree_counts counts = {0};
    if (plane_distance(&above.plane, roofs->corner) > HULL_MARGIN)
        return true;
    if (is_under_roof(roofs, &above.plane))
        return false;
    for (int k = 0; k < 2; k++)
        if (tree_walk(trees[k], above_enters, &above, 0, NULL, find_corner, &above,
                      &counts)) {
            roofs->corner = above.corner;
            return true;
        }
    roofs->last[roofs->count++ % ROOFS_MAX] = (struct roof){above.plane, above.highest};
    return false;
}

/* True if no corner of the scene is in front of the plane, or none behind it. */
static bool is_on_hull(struct roofs *roofs, const struct plane *plane)
{
    struct vec3 back = vec3_scale(plane->normal, -1.0);
    return !reaches_above(roofs, plane->normal, plane->offset) ||
           !reaches_above(roofs, back, -plane->offset);
}

/* Directions in which the farthest corners are looked for, to both sides. */
enum { LINES = 7, FAR_CORNERS = 2 * LINES };

static void find_far_corners(const struct octree *octree, const int32_t *order,
                             int32_t count, struct vec3 far[FAR_CORNERS])
{
    static const struct vec3 line[LINES] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1},
                                            {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};
    double most[FAR_CORNERS] = {0.0};
    for (int64_t i = 0; i < 3 * (int64_t)count; i++) {
        struct vec3 x = octree->triangles[order[i / 3]].corner[i % 3];
        for (int k = 0; k < FAR_CORNERS; k++) {
            double along = (k % 2 ? -1.0 : 1.0) * vec3_dot(line[k / 2], x);
            if (i == 0 || along > most[k]) {
                most[k] = along;
                far[k] = x;
            }
        }
    }
}

/* True if far corners are on both sides of the plane, as of most triangles that are not
 * on the hull. */
static bool is_between(const struct vec3 far[FAR_CORNERS], const struct plane *plane)
{
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int k = 0; k < FAR_CORNERS; k++) {
        low = real_min(low, plane_distance(plane, far[k]));
        high = real_max(high, plane_distance(plane, far[k]));
    }
    return low < -HULL_MARGIN && high > HULL_MARGIN;
}

/* --- building --- */

/* The ball around the triangles in `order`; around none it is no ball, and rays miss
 * it. */
static void set_ball(struct octree *octree, const int32_t *order, int32_t count)
{
    struct vec3 low = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high = vec3_scale(low, -1.0);
    for (int32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            struct vec3 x = octree->triangles[order[i]].corner[k];
            low = vec3_least(low, x);
            high = vec3_most(high, x);
        }
    octree->middle = vec3_middle(low, high);
    octree->radius = 0.5 * vec3_length(vec3_sub(high, low)) * 1.0001 + GEOM_ROUNDING;
}

/* Builds the trees over `count` triangles in `order`, [count] on the hull or inside. */
static void build_trees(struct octree *octree, const int32_t *order, const bool *on_hull,
                        int32_t count)
{
    int32_t *part = alloc_array((size_t)count, sizeof *part);
    struct tree *trees[] = {&octree->inside, &octree->hull};
    for (int k = 0; k < 2; k++) {
        int32_t own = 0;
        for (int32_t i = 0; i < count; i++)
            if (on_hull[i] == (k == 1))
                part[own++] = order[i];
        tree_free(trees[k]);
        *trees[k] = tree_build(octree->triangles, octree->planes, part, own);
    }
    alloc_free(part);
}

/* Builds the trees over the `kept` triangles in `order`: with all on the hull that may
 * be, and again if some of them are not. */
static void plant_trees(struct octree *octree, const int32_t *order, int32_t kept)
{
    bool *on_hull = alloc_array((size_t)kept, sizeof *on_hull), proved = true;
    struct vec3 far[FAR_CORNERS] = {{0.0, 0.0, 0.0}};
    find_far_corners(octree, order, kept, far);
    struct roofs found = {.octree = octree, .corner = far[0],
                          .reach = vec3_length(octree->middle) + octree->radius};
    for (int32_t i = 0; i < kept; i++)
        on_hull[i] = !is_between(far, &octree->planes[order[i]]);
    build_trees(octree, order, on_hull, kept);
    for (int32_t i = 0; i < kept && !stop_is_asked(); i++)
        if (on_hull[i] && !is_on_hull(&found, &octree->planes[order[i]]))
            on_hull[i] = proved = false;
    if (!proved)
        build_trees(octree, order, on_hull, kept);
    alloc_free(on_hull);
}

struct octree *octree_create(const struct triangle *triangles, const struct plane *planes,
                             int32_t count)
{
    struct octree *octree = alloc_array(1, sizeof *octree);
    octree->triangles = triangles;
    octree->planes = planes;
    octree->count = count;
    int32_t *order = alloc_array((size_t)count, sizeof *order);
    int32_t kept = 0;
    for (int32_t i = 0; i < count; i++)
        if (vec3_dot(planes[i].normal, planes[i].normal) > 0.0)
            order[kept++] = i;
    set_ball(octree, order, kept);
    plant_trees(octree, order, kept);
    alloc_free(order);
    octree->neighbours = walls_find_neighbours(triangles, planes, count);
    octree->place = alloc_array((size_t)count, sizeof *octree->place);
    for (int32_t i = 0; i < count; i++)
        octree->place[i] = -1;
    for (int64_t i = 0; i < octree->inside.record_count; i++)
        octree->place[octree->inside.records[i].triangle] = (int32_t)i;
    return octree;
}

void octree_destroy(struct octree *octree)
{
    if (!octree)
        return;
    if (!octree->is_view) {
        tree_free(&octree->inside);
        tree_free(&octree->hull);
        alloc_free(octree->place);
        alloc_free(octree->neighbours);
    }
    alloc_free(octree);
}

static void pack_arrays(struct octree *octree, struct pack *pack)
{
    tree_pack_arrays(&octree->inside, pack);
    tree_pack_arrays(&octree->hull, pack);
    PACK(pack, octree->place, octree->count);
    PACK(pack, octree->neighbours, 3 * (int64_t)octree->count);
}

void octree_pack(const struct octree *octree, struct pack *pack)
{
    struct octree view = *octree;
    view.is_view = true;
    pack_array(pack, &view, sizeof view);
    pack_arrays(&view, pack);
}

struct octree *octree_view(struct pack *pack, const struct triangle *triangles,
                           const struct plane *planes)
{
    struct octree *octree = alloc_array(1, sizeof *octree);
    memcpy(octree, pack_array(pack, NULL, sizeof *octree), sizeof *octree);
    octree->triangles = triangles;
    octree->planes = planes;
    pack_arrays(octree, pack);
    return octree;
}
