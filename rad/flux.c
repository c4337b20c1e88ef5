/* Fixed-point flux; see rad/flux.h.
 *
 * Rejected: sums in double (their last bits depend on the order, and one bit is enough
 * to split a patch on 3 ranks that is whole on 2), and reproducible floating-point sums
 * (six words an accumulator where one integer does). */
#include "rad/flux.h"

#include <math.h>

struct flux_unit flux_unit_for(double largest)
{
    int exponent;
    frexp(largest, &exponent); /* largest < 2^exponent */
    exponent = exponent > -960 ? exponent : -960; /* 2^(62 + 960) is finite, its
                                                     inverse exact */
    return (struct flux_unit){ldexp(1.0, 62 - exponent), ldexp(1.0, exponent - 62)};
}

struct flux_unit flux_unit_choose(const struct scene *scene)
{
    double largest = 0.0;
    for (int32_t root = 0; root < scene_root_count(scene); root++)
        for (int c = 0; c < BANDS; c++)
            largest = fmax(largest,
                           scene_root_material(scene, root)->reflectance.band[c]);
    return flux_unit_for(16.0 * scene_emitted_power(scene) / (1.0 - largest));
}
