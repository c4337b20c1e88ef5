/* Refinement by error: links of any two nodes. */
#ifndef RAD_BEYOND_ERROR_ORACLE_H
#define RAD_BEYOND_ERROR_ORACLE_H

#include "rad/link.h"

/* As side_to_split of struct method: the side causing more of the error. */
int32_t error_oracle_side_to_split(const struct model *model, const struct link *link);

/* The same of a link with a cluster; one of two patches is split by its energy. */
int32_t error_oracle_side_by_energy(const struct model *model, const struct link *link);

/* Gives patches of an unsplit link children, to deal its light to, where the link varies
 * over a patch more than the criterion allows. */
void error_oracle_divide(struct model *model, const struct link *link);

#endif
