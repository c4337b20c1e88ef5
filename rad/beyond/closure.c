/* Row sums of the links, and the caps on them. */
#include "rad/beyond/closure.h"

#include <math.h>

#include "geom/alloc.h"
#include "rad/pushpull.h"

void closure_free(struct closure *closure)
{
    alloc_free(closure->factor);
    *closure = (struct closure){0};
}

void closure_extend(struct closure *closure, const struct forest *forest)
{
    closure->factor = alloc_reserve(closure->factor, &closure->capacity, forest->count,
                                    sizeof *closure->factor);
    for (; closure->count < forest->count; closure->count++)
        closure->factor[closure->count] = 1.0;
}

/* Row sum times reflectance is the factor that light grows by from bounce to bounce; it is
 * kept below this, or half way from rho to 1 where that is more. Less took light from leaves
 * close to lamps, whose rows are made of links of many levels; at 0.95 the errors are those
 * of no cap. */
static const double MOST_REFLECTED = 0.95;

void closure_cap(struct closure *closure, const struct forest *forest, int32_t leaf,
                 double row)
{
    struct rgb rho = forest_material(forest, leaf)->reflectance;
    double largest = fmax(rho.band[0], fmax(rho.band[1], rho.band[2]));
    double most = fmax(MOST_REFLECTED, 0.5 * (1.0 + largest));
    closure->factor[leaf] = largest > 0.0 ? fmin(1.0, most / largest / row) : 1.0;
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
