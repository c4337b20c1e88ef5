/* The caps on row sums of the links. */
#include "rad/beyond/caps.h"

#include <math.h>

#include "geom/alloc.h"

void caps_free(struct caps *caps)
{
    alloc_free(caps->factor);
    *caps = (struct caps){0};
}

void caps_extend(struct caps *caps, const struct forest *forest)
{
    RESERVE(caps->factor, &caps->capacity, forest->count);
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
