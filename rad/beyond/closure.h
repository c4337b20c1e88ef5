/* Closure: in a closed scene the form factors of every leaf sum to 1.
 *
 * The row sum R of a leaf is what it receives over its links, and those of its ancestors, when
 * B = 1 everywhere. It is 1 for a leaf all of whose directions end on the front of some patch,
 * whatever stands in between; where links of different levels meet it comes out otherwise. The
 * correction multiplies the irradiance of a leaf by a factor d of its own. */
#ifndef RAD_BEYOND_CLOSURE_H
#define RAD_BEYOND_CLOSURE_H

#include <stdbool.h>
#include <stdint.h>

#include "rad/model.h"

/* What is known of the surroundings of a patch. OPEN: some ray escapes or ends on a back. COVERED:
 * the same, but only where the patch lies inside a solid. */
enum enclosure { UNKNOWN, ENCLOSED, OPEN, COVERED };

struct closure {
    enum closure_kind kind;
    double *factor;    /* [count] d of each leaf of the own roots, 1 where nothing is corrected */
    uint8_t *enclosure; /* [count] enum enclosure */
    int64_t count, factor_capacity, enclosure_capacity;
};

void closure_free(struct closure *closure);

/* Makes room for all patches; new ones inherit from their parents. */
void closure_extend(struct closure *closure, const struct forest *forest);

/* The factor by which a leaf multiplies its irradiance. */
static inline double closure_receives(const struct closure *closure, int32_t leaf)
{
    return closure->kind == CLOSURE_NONE ? 1.0 : closure->factor[leaf];
}

/* Its inverse: by this and its area a leaf counts in the scalar product that makes the corrected
 * form factors symmetric. */
static inline double closure_weight(const struct closure *closure, int32_t leaf)
{
    return closure->kind == CLOSURE_NONE ? 1.0 : 1.0 / closure->factor[leaf];
}

/* True if the row sum of the leaf has to be 1: it is enclosed, and none of its ancestors is open.
 * Fires rays, which are counted, for those of which nothing is known yet. */
bool closure_is_due(struct closure *closure, struct model *model, int32_t leaf);

enum { CLOSURE_ROOM = 16 };

/* Row sums of the form factors over the leaves of this rank's own roots, area-weighted. The sums
 * count in CLOSURE_ROOM of the units given to closure_measure(): a unit that has room for the area
 * of the scene may have none for rows that sum to more than 1. */
struct closure_sums {
    double min, max; /* +-HUGE_VAL where there is no leaf */
    int64_t area;    /* of the leaves counted */
    int64_t rows;    /* sum of A R */
    int64_t squares; /* sum of A (R - 1)^2 */
};

/* Row sums, after a transfer of B = 1 with the unit. Leaves of patches that neither reflect nor
 * emit are left out: they are not linked with each other. */
struct closure_sums closure_measure(const struct forest *forest, const bool *own,
                                    struct flux_unit unit);

#endif
