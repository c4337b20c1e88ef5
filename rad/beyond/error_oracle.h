/* Refinement by error: links of two patches. */
#ifndef RAD_BEYOND_ERROR_ORACLE_H
#define RAD_BEYOND_ERROR_ORACLE_H

#include "rad/link.h"

/* As side_to_split of struct method: the patch that causes more of the error. */
int32_t error_oracle_side_to_split(const struct model *model, const struct link *link);

/* Gives p and q of a link that is not split children, where the link varies over them
 * more than the criterion allows: it deals its light to them. */
void error_oracle_divide(struct model *model, const struct link *link);

#endif
