/* Open parts.
 *
 * Where a box stands on the floor, leaves are covered in part. A point is covered if
 * four rays from it, up and far aside, all begin inside of a solid (inside.h), and not
 * merely below a shelf; or in a gap that is narrow for the leaf, as behind a picture on a
 * wall. Where nothing ends near the leaf, all of it is alike. Else it is quartered, and
 * so are its quarters, as long as things are near and not all of four middles are
 * covered, down to 256 parts: the frame of a window may cover a strip at the edge of a
 * leaf of the wall, a fifteenth of it, that sixteen points do not meet. Taken for open,
 * such leaves were shown up to 8 % too dark. */
#include "io/picture/open_parts.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/stop.h"
#include "rad/beyond/gather/inside.h"

/* A gap is narrow for a leaf if it is less than this part of the distance from the middle
 * to a corner of its quarter. */
static const double NARROW = 0.1;

/* Points of a leaf at most that are examined, a power of four. */
enum { POINTS = 256 };

/* A leaf that things may stand on. */
struct footing {
    const struct scene *scene;
    const struct octree *octree;
    struct triangle leaf;
    struct plane plane;
    int32_t input; /* triangle of the leaf */
    double gap;    /* width of a narrow gap, scene units */
};

static struct footing footing_of(const struct forest *forest,
                                 const struct octree *octree, int32_t leaf)
{
    const struct scene *scene = forest->scene;
    int32_t root = (int32_t)forest->patches[leaf].id.root;
    struct footing footing = {.scene = scene, .octree = octree,
                              .leaf = forest_triangle(forest, leaf),
                              .plane = scene_root_plane(scene, root),
                              .input = scene_input_of(scene, root)};
    struct triangle quarter = triangle_child(&footing.leaf, 0);
    struct vec3 middle = triangle_centroid(&quarter);
    footing.gap = NARROW * vec3_length(vec3_sub(quarter.corner[0], middle));
    return footing;
}

/* True if the ray from a point of the plane ends less than a narrow gap above it. */
static bool ends_in_gap(const struct footing *footing, struct vec3 start,
                        struct vec3 direction)
{
    struct octree_counts counts = {0};
    struct octree_hit hit;
    if (!octree_first_hit(footing->octree, start, direction, false, &hit, &counts))
        return false;
    octree_hit_weights(footing->octree, start, direction, &hit);
    const struct triangle *t = &footing->scene->triangles[hit.triangle];
    double height = 0.0;
    for (int k = 0; k < 3; k++)
        height += hit.weight[k] * plane_distance(&footing->plane, t->corner[k]);
    return height < footing->gap;
}

/* True if the middle of a triangle is covered, whose corners give three directions along
 * the surface. */
static bool is_covered(const struct footing *footing, const struct triangle *part)
{
    struct vec3 point = triangle_centroid(part), normal = footing->plane.normal;
    struct vec3 start = vec3_add(point, vec3_scale(normal, 1024.0 * GEOM_ROUNDING));
    struct octree_counts counts = {0};
    bool single = false, gap = false;
    for (int k = -1; k < 3; k++) {
        struct vec3 direction = normal;
        if (k >= 0) {
            struct vec3 along = vec3_sub(part->corner[k], point);
            direction = vec3_add(along, vec3_scale(normal, 0.25 * vec3_length(along)));
        }
        direction = vec3_unit(direction);
        if (ends_in_gap(footing, start, direction))
            gap = true;
        else if (!ray_is_bound(footing->scene, footing->octree, start, direction, &single,
                               &counts))
            return false;
    }
    return single || gap;
}

bool leaf_is_shut_at(const struct forest *forest, const struct octree *octree,
                     int32_t leaf, struct vec3 point)
{
    struct footing footing = footing_of(forest, octree, leaf);
    struct triangle around = footing.leaf;
    struct vec3 moved = vec3_sub(point, triangle_centroid(&footing.leaf));
    for (int k = 0; k < 3; k++)
        around.corner[k] = vec3_add(footing.leaf.corner[k], moved);
    return is_covered(&footing, &around);
}

/* Counts the quarters of a triangle whose middles are open. */
static int open_quarters(const struct footing *footing, const struct triangle *t)
{
    int open = 0;
    for (int k = 0; k < 4; k++) {
        struct triangle child = triangle_child(t, k);
        open += !is_covered(footing, &child);
    }
    return open;
}

/* True if nothing reaches into the space over a part of the leaf up to a narrow gap: all
 * things over it are higher, or stand elsewhere, or around it, so all of its points are
 * covered or none is. */
static bool is_clear(const struct footing *footing, const struct triangle *part)
{
    struct octree_counts counts = {0};
    struct vec3 rise = vec3_scale(footing->plane.normal, footing->gap);
    struct triangle lid = {{vec3_add(part->corner[0], rise),
                            vec3_add(part->corner[2], rise),
                            vec3_add(part->corner[1], rise)}};
    struct plane down = triangle_plane(&lid);
    const int32_t own[2] = {footing->input, footing->input};
    return octree_list_shaft(footing->octree, part, &footing->plane, &lid, &down, own,
                             NULL, 0, &counts) == 0;
}

/* Counts the open points of `points` in a part of the leaf, the middles of as many parts
 * of it. */
static int count_open(const struct footing *footing, const struct triangle *part,
                      int points)
{
    int quarters = open_quarters(footing, part), open = 0;
    bool alike = quarters == 0 || quarters == 4;
    if (points == 4 || (points <= POINTS / 16 && quarters == 0) ||
        (alike && is_clear(footing, part)))
        return quarters * points / 4;
    for (int k = 0; k < 4; k++) {
        struct triangle child = triangle_child(part, k);
        open += count_open(footing, &child, points / 4);
    }
    return open;
}

/* Returns the open parts of a leaf. */
static uint8_t survey(const struct forest *forest, const struct octree *octree,
                      int32_t leaf)
{
    struct footing footing = footing_of(forest, octree, leaf);
    if (open_quarters(&footing, &footing.leaf) == 4 && is_clear(&footing, &footing.leaf))
        return PROVED_OPEN;
    return (uint8_t)(count_open(&footing, &footing.leaf, POINTS) * OPEN_PARTS / POINTS);
}

uint8_t *open_parts_survey(const struct forest *forest, const struct octree *octree,
                           int first, int step, int64_t *count)
{
    *count = forest_count(forest).leaves;
    uint8_t *open = alloc_array((size_t)*count, sizeof *open);
    int32_t leaf = forest_next_leaf(forest, -1);
    for (int64_t i = 0; leaf >= 0 && !stop_is_asked(); i++) {
        if (i % step == first)
            open[i] = survey(forest, octree, leaf);
        leaf = forest_next_leaf(forest, leaf);
    }
    return open;
}

double open_parts_fraction(uint8_t parts)
{
    return parts < OPEN_PARTS / 4 ? 0.0 : fmin(1.0, (double)parts / OPEN_PARTS);
}
