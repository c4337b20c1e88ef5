/* Refinement: which patch of a link has to be split. */
#ifndef RAD_ORACLE_H
#define RAD_ORACLE_H

#include "rad/link.h"

/* How closely a pair has to be looked at of which `guess` would be exchanged without blockers. */
enum look oracle_look(const struct model *model, int32_t p, int32_t q, double guess);

/* The patch of the link that the criterion wants to split, or -1 if the link is fine or splitting
 * is not allowed. Reads the radiosities of the last iteration. */
int32_t oracle_patch_to_split(const struct model *model, const struct link *link);

/* Gives p and q of a link that is not split children, where the link varies over them more than
 * the criterion allows: it deals its light to them. */
void oracle_divide_patches(struct model *model, const struct link *link);

/* True if the patch is neither too deep nor too small to be split. */
bool oracle_patch_may_split(const struct model *model, int32_t patch);

/* Largest range of radiosity within a child of a patch, summed over bands, W/m^2. */
double oracle_range_within(const struct forest *forest, int32_t patch);

#endif
