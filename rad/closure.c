/* Which leaves are enclosed, and their factors.
 *
 * A correction must know what a row sum should be. It is 1 only where every direction ends on a
 * front. A leaf that looks out of an open scene, or at a back, or that is covered in part by a
 * box that stands on it, has an honest row sum below 1, and dividing by it would make light of
 * nothing: a leaf that is wholly covered would blaze. Such leaves are left alone. They are found
 * with rays, four from each quarter of the leaf: cosine-weighted directions in four rings, turned
 * by an angle that depends on the patch ID and the ring.
 *
 * A gap that 16 rays miss may still take a tenth of the light. So all ancestors of a leaf are asked
 * too, each with rays of its own: where one of them sees a way out or a back, all its leaves are
 * left alone. Only quarters that are covered, from which all rays meet backs at once, tell nothing
 * about the leaves beside them. */
#include "rad/closure.h"

#include <math.h>

#include "geom/alloc.h"
#include "rad/pushpull.h"

enum { QUARTERS = 4, RINGS = 4 };

void closure_free(struct closure *closure)
{
    alloc_free(closure->factor);
    alloc_free(closure->enclosure);
    *closure = (struct closure){0};
}

void closure_extend(struct closure *closure, const struct forest *forest)
{
    closure->factor = alloc_reserve(closure->factor, &closure->factor_capacity, forest->count,
                                    sizeof *closure->factor);
    closure->enclosure = alloc_reserve(closure->enclosure, &closure->enclosure_capacity,
                                      forest->count, sizeof *closure->enclosure);
    for (int64_t p = closure->count; p < forest->count; p++) {
        int32_t parent = forest->patches[p].parent;
        closure->factor[p] = parent >= 0 ? closure->factor[parent] : 1.0;
        closure->enclosure[p] = UNKNOWN;
    }
    closure->count = forest->count;
}

/* A number in -1 .. 1 from a patch ID and a count. */
static double scatter_id(struct patch_id id, uint32_t number)
{
    uint64_t bits = ((uint64_t)id.root << 32 | id.hierarchy) + UINT64_C(0x9E3779B97F4A7C15) * number;
    bits = (bits ^ bits >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    bits = (bits ^ bits >> 27) * UINT64_C(0x94D049BB133111EB);
    bits ^= bits >> 31;
    return (double)(bits >> 11) * 0x1p-52 - 1.0;
}

/* A direction of ring `ring` of quarter `quarter`; x, y and the normal are at right angles. */
static struct vec3 ring_direction(struct patch_id id, int quarter, int ring, struct vec3 x,
                                  struct vec3 y, struct vec3 normal)
{
    uint32_t number = (uint32_t)(2 * (RINGS * quarter + ring));
    double a = scatter_id(id, number), b = scatter_id(id, number + 1);
    double length = sqrt(a * a + b * b) + 1e-300;
    double sine2 = (ring + 0.5) / RINGS, scale = sqrt(sine2) / length;
    struct vec3 along = vec3_add(vec3_scale(x, a * scale), vec3_scale(y, b * scale));
    return vec3_add(along, vec3_scale(normal, sqrt(1.0 - sine2)));
}

/* What the rays of one leaf or of one of its quarters found. */
struct view {
    int fronts, backs, escapes;
};

static struct view look_around(struct method *method, int32_t patch, int quarter)
{
    const struct forest *forest = method->forest;
    struct patch_id id = forest->patches[patch].id;
    struct triangle t = forest_triangle(forest, patch), child = triangle_child(&t, quarter);
    struct vec3 normal = scene_root_plane(forest->scene, (int32_t)id.root).normal;
    struct vec3 start = vec3_add(triangle_centroid(&child),
                                 vec3_scale(normal, 1024.0 * GEOM_ROUNDING));
    struct vec3 x = vec3_sub(t.corner[1], t.corner[0]);
    x = vec3_scale(x, 1.0 / vec3_length(x));
    struct vec3 y = vec3_cross(normal, x);
    struct view view = {0, 0, 0};
    for (int ring = 0; ring < RINGS; ring++) {
        struct octree_hit hit;
        struct vec3 direction = ring_direction(id, quarter, ring, x, y, normal);
        if (!octree_first_hit(method->octree, start, direction, false, &hit, &method->counts))
            view.escapes++;
        else if (scene_root_on(forest->scene, hit.triangle, hit.front) >= 0)
            view.fronts++;
        else
            view.backs++;
    }
    return view;
}

static enum enclosure find_enclosure(struct method *method, int32_t patch)
{
    enum enclosure found = ENCLOSED;
    for (int quarter = 0; quarter < QUARTERS; quarter++) {
        struct view view = look_around(method, patch, quarter);
        if (view.backs == RINGS)
            found = COVERED;
        else if (view.fronts < RINGS)
            return OPEN;
    }
    return found;
}

bool closure_is_due(struct closure *closure, struct method *method, int32_t leaf)
{
    for (int32_t p = leaf; p >= 0; p = method->forest->patches[p].parent) {
        if (closure->enclosure[p] == UNKNOWN)
            closure->enclosure[p] = (uint8_t)find_enclosure(method, p);
        if (closure->enclosure[p] == OPEN || (p == leaf && closure->enclosure[p] == COVERED))
            return false;
    }
    return true;
}

struct closure_sums closure_measure(const struct forest *forest, const bool *own,
                                    struct flux_unit unit)
{
    struct closure_sums sums = {.min = HUGE_VAL, .max = -HUGE_VAL};
    struct flux_unit coarse = {unit.per_watt / CLOSURE_ROOM, unit.watt * CLOSURE_ROOM};
    for (int64_t p = 0; p < forest->count; p++) {
        const struct patch *patch = &forest->patches[p];
        double area = forest_area(forest, (int32_t)p);
        if (!own[patch->id.root] || !patch_is_leaf(patch) || area <= 0.0 ||
            material_is_dark(forest_material(forest, (int32_t)p)))
            continue;
        double row = leaf_irradiance(forest, (int32_t)p, unit).band[0];
        sums.min = fmin(sums.min, row);
        sums.max = fmax(sums.max, row);
        sums.area = flux_add(sums.area, flux_from_watts(coarse, area));
        sums.rows = flux_add(sums.rows, flux_from_watts(coarse, area * row));
        sums.squares = flux_add(sums.squares,
                                flux_from_watts(coarse, area * (row - 1.0) * (row - 1.0)));
    }
    return sums;
}
