/* Row sums of the links, and the caps on them. */
#include "rad/beyond/caps.h"

#include <math.h>

#include "geom/alloc.h"
#include "rad/pushpull.h"

void caps_free(struct caps *caps)
{
    alloc_free(caps->factor);
    *caps = (struct caps){0};
}

void caps_extend(struct caps *caps, const struct forest *forest)
{
    caps->factor = alloc_reserve(caps->factor, &caps->capacity, forest->count,
                                    sizeof *caps->factor);
    for (; caps->count < forest->count; caps->count++)
        caps->factor[caps->count] = 1.0;
}

/* Row sum times reflectance is the factor that light grows by from bounce to bounce. It
 * is kept at or below this, or half way from rho to 1 where that is more. A lower limit
 * took light from leaves close to lamps, which have links of many levels; at 0.95 the
 * errors are those without caps. */
static const double MOST_REFLECTED = 0.95;

void caps_choose(struct caps *caps, const struct forest *forest, int32_t leaf,
                 double row_sum)
{
    struct rgb rho = forest_material(forest, leaf)->reflectance;
    double largest = fmax(rho.band[0], fmax(rho.band[1], rho.band[2]));
    double most = fmax(MOST_REFLECTED, 0.5 * (1.0 + largest));
    caps->factor[leaf] = largest > 0.0 ? fmin(1.0, most / largest / row_sum) : 1.0;
}

struct row_sums row_sums_measure(const struct forest *forest, const bool *own,
                                    struct flux_unit unit)
{
    struct row_sums sums = {.min = HUGE_VAL, .max = -HUGE_VAL};
    struct flux_unit coarse = {unit.per_watt / ROW_SUMS_ROOM, unit.watt * ROW_SUMS_ROOM};
    for (int64_t p = 0; p < forest->count; p++) {
        const struct patch *patch = &forest->patches[p];
        double area = forest_area(forest, (int32_t)p);
        if (!own[patch->id.root] || !patch_is_leaf(patch) || area <= 0.0 ||
            material_is_dark(forest_material(forest, (int32_t)p)))
            continue;
        double sum = leaf_irradiance(forest, (int32_t)p, unit).band[0];
        double square = area * (sum - 1.0) * (sum - 1.0);
        sums.min = fmin(sums.min, sum);
        sums.max = fmax(sums.max, sum);
        sums.area = flux_add(sums.area, flux_from_watts(coarse, area));
        sums.rows = flux_add(sums.rows, flux_from_watts(coarse, area * sum));
        sums.squares = flux_add(sums.squares, flux_from_watts(coarse, square));
    }
    return sums;
}
