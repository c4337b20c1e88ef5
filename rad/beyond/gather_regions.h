/* Surfaces in the dark, and lit ones. For the files of the final gather alone. */
#ifndef RAD_BEYOND_GATHER_REGIONS_H
#define RAD_BEYOND_GATHER_REGIONS_H

#include "rad/beyond/receiver.h"

/* From the dark, light is looked for that is this many times as much as arrives there. */
enum { DARK_TIMES = 30 };

/* Surfaces that are all in the dark, or not: roots, or patches of roots that are both. */
struct regions {
    int32_t *items; /* [count] patches, in the order of roots, depth first */
    int64_t count, capacity;
    int32_t *of;    /* [patches] the region of a leaf; of others, nothing */
    uint8_t *dark;  /* [patches] 1: a region, large, in the dark and not in a gap */
};

/* Finds them, once. */
const struct regions *gather_regions(struct final_gather *gather);
int32_t region_of(struct final_gather *gather, int32_t leaf);

/* True if it is one where light is looked for in the dark. */
bool region_is_dark(struct final_gather *gather, int32_t region);

/* True if little light comes to the patch, as the links or looks have it. Of a black one
 * it is not known. */
bool patch_is_dark(const struct final_gather *gather, int32_t patch);

/* True if a leaf of the patch is in the dark. */
bool patch_has_dark(const struct final_gather *gather, int32_t patch);

/* B less E, and H, of a patch, W/m^2 over all bands; H is NaN if it is black. */
double patch_reflected(const struct forest *forest, int32_t patch);
double patch_irradiance(const struct forest *forest, int32_t patch);

/* The part of the rays from a point of a region that end in the dark, 1, of those that
 * end there or on lit surfaces; 0 if none does, as where it looks out of the scene. */
double share_in_the_dark(struct final_gather *gather, int32_t region, struct vec3 x,
                         uint64_t seed);

/* Counts before work that each rank does which needs it: it is counted apart, as that of
 * proofs. */
struct apart {
    struct octree_counts tests;
    struct gather_counts rays;
    int64_t estimating; /* as in struct model */
};
struct apart apart_begin(const struct final_gather *gather);
void apart_end(struct final_gather *gather, const struct apart *apart);

#endif
