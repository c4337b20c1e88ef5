/* Rows of the final gather, and their parts.
 *
 * The irradiance of a leaf is H = source + sum of weight B over its terms, band by band:
 * the row of the leaf. */
#ifndef RAD_BEYOND_GATHER_ROWS_H
#define RAD_BEYOND_GATHER_ROWS_H

#include "rad/beyond/gather/gather.h"

/* The form factor from a leaf to a patch, 1, band by band. Local numbers of patches
 * differ from rank to rank, so a patch is named by its place in forest_order(), here as
 * in all arrays of the final gather. */
struct gather_term {
    int32_t place; /* of the patch */
    int32_t near;  /* the place of the leaf too near met first by the ray; -1: none */
    float weight[BANDS];
};

/* What covers a leaf: things standing on it, and faces in its plane. Shares, 1. */
struct cover {
    float outside; /* of the leaf outside of things */
    float open;    /* of the leaf outside of things and of narrow gaps */
    float bare;    /* of `outside` not covered by faces in its plane */
    float kept;    /* of the leaf's light that arrives on fronts, as its rays do */
};

/* The form factors from a leaf to all patches in its view. */
struct gather_row {
    int32_t leaf;
    int64_t end;       /* of its terms, which begin at the end of the row before */
    struct rgb source; /* irradiance from lamps, W/m^2 */
    struct rgb straight; /* irradiance straight from lamps, W/m^2 */
    struct rgb chance; /* variance of H if rays and segments were chosen by chance,
                          (W/m^2)^2, for the links' radiosities */
    struct rgb of_segments; /* the part of `chance` by segments to lamps */
    struct rgb halves; /* squared difference of the first and second half of the
                          rays: a sample of the variance by the sequence */
    struct cover cover;
};

/* The number of terms of all rows. */
int64_t final_gather_terms(const struct final_gather *gather);

/* Returns H of a row, W/m^2, for the radiosities of all patches by place, with its source
 * if `lamps`. */
struct rgb final_gather_irradiance(const struct final_gather *gather, int64_t row,
                                   const struct rgb *radiosity, bool lamps);

#endif
