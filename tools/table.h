/* Light as tables: at points, and by object. */
#ifndef TOOLS_TABLE_H
#define TOOLS_TABLE_H

#include "tools/run.h"

/* Collective. Prints H at the points of --at on the standard output, a line of numbers
 * each. False on an error, on all ranks. */
bool table_print_points(struct run *run);

/* Collective. Writes --report: a line for each object and each material. False if the
 * run is asked to stop, on all ranks. */
bool table_write_report(struct run *run);

#endif
