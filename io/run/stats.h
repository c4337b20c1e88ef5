/* Reporting a run: the summary for people and the JSON for programs. */
#ifndef IO_RUN_STATS_H
#define IO_RUN_STATS_H

#include <stdbool.h>
#include <stdio.h>

#include "geom/error.h"
#include "rad/stats.h"

/* Prints the summary, whose figures do not depend on the machine or the number of
 * ranks. */
void stats_print(const struct stats *stats, FILE *file);

/* Writes the JSON file of --stats. Errors: as output_close(). */
bool stats_write(const struct stats *stats, const char *path, struct error *error);

#endif
