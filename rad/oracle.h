/* Refinement: which patch of a link has to be split. */
#ifndef RAD_ORACLE_H
#define RAD_ORACLE_H

#include "rad/link.h"

/* See struct method, whose entry of the paper this is. */
int32_t oracle_side_to_split(const struct model *model, const struct link *link);

/* True if p is the larger patch of the link, or of equal ones that with the lower ID. */
bool p_is_larger(const struct forest *forest, const struct link *link);

/* True if the patch is neither too deep nor too small to be split. */
bool patch_may_split(const struct model *model, int32_t patch);

#endif
