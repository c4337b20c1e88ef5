/* Lines about a run. */
#ifndef TOOLS_REPORT_H
#define TOOLS_REPORT_H

#include "tools/run.h"

/* Warns where --memory is less than the limit in force; with --verbose prints the memory
 * of each rank before linking. */
void report_memory(struct run *run);

/* Ticks the progress of the iterations over the same links. Pre: run->first_bound is
 * HUGE_VAL before the first. */
void report_solving(struct run *run);

/* Collective. With --verbose: prints the levels of refinement from number `first` on. */
void report_levels(struct run *run, int64_t first);

/* Print the pass just ended, and with --accuracy the error of a round. */
void report_iteration(struct run *run);
void report_round(struct run *run);

/* Collective. Prints warnings and the summary, and writes --stats. False on an error, on
 * all ranks. */
bool report_summary(struct run *run);

#endif
