/* A table of view factors, as CSV. */
#ifndef TOOLS_VIEWFACTORS_TABLE_H
#define TOOLS_VIEWFACTORS_TABLE_H

#include <stdio.h>

#include "tools/viewfactors/viewfactor.h"

/* Prints the header `from,to,area_from,F`, then for each group a line for each factor
 * that is not 0, or, if `dense`, for each, and one for the sum, whose `to` is `*`. Order:
 * as the groups in the file. Areas in square input units. The name `*` and names with a
 * comma or a quote are quoted, with quotes doubled (RFC 4180). */
void table_print(const struct viewfactors *factors, bool dense, FILE *file);

#endif
