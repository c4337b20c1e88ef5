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
#include "rad/beyond/closure.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/hash.h"
#include "rad/pushpull.h"
#include "rad/sample.h"

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

/* The seed of number `number` of a patch; hash_unit() adds the last step. */
static uint64_t seed_of(struct patch_id id, int number)
{
    return id_number(id) + HASH_STEP * (uint64_t)(int64_t)(number - 1);
}

/* What the rays of one leaf or of one of its quarters found. */
struct view {
    int fronts, backs, escapes;
};

static struct view look_around(struct model *model, int32_t patch, int quarter)
{
    const struct forest *forest = model->forest;
    struct patch_id id = forest->patches[patch].id;
    struct triangle t = forest_triangle(forest, patch), child = triangle_child(&t, quarter);
    struct vec3 normal = scene_root_plane(forest->scene, (int32_t)id.root).normal;
    struct ray ray = {.origin = point_above(triangle_centroid(&child), normal)};
    int32_t outside = forest->root_count;
    struct view view = {0, 0, 0};
    for (int ring = 0; ring < RINGS; ring++) {
        int number = 2 * (RINGS * quarter + ring);
        ray.direction = direction_above(&t, normal, hash_unit(seed_of(id, number)),
                                        hash_unit(seed_of(id, number + 1)),
                                        (ring + 0.5) / RINGS);
        int32_t root = root_met(forest->scene, model->octree, &ray, outside,
                                &model->counts);
        view.escapes += root == outside;
        view.backs += root < 0;
        view.fronts += root >= 0 && root != outside;
    }
    return view;
}

static enum enclosure find_enclosure(struct model *model, int32_t patch)
{
    enum enclosure found = ENCLOSED;
    for (int quarter = 0; quarter < QUARTERS; quarter++) {
        struct view view = look_around(model, patch, quarter);
        if (view.backs == RINGS)
            found = COVERED;
        else if (view.fronts < RINGS)
            return OPEN;
    }
    return found;
}

bool closure_is_due(struct closure *closure, struct model *model, int32_t leaf)
{
    for (int32_t p = leaf; p >= 0; p = model->forest->patches[p].parent) {
        if (closure->enclosure[p] == UNKNOWN)
            closure->enclosure[p] = (uint8_t)find_enclosure(model, p);
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
