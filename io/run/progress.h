/* What a user sees of the progress: one line of a terminal that is written over and over, or now and
 * then a line of a log. */
#ifndef IO_RUN_PROGRESS_H
#define IO_RUN_PROGRESS_H

#include <stdbool.h>

#include "geom/progress.h"

enum { PROGRESS_WIDTH = 79 }; /* columns at most */

struct progress_view {
    struct progress progress; /* first: what the loops tick */
    double (*clock)(void);    /* seconds since any moment */
    bool terminal;            /* stderr is one */
    int64_t stage;            /* that was seen last, */
    double begun;             /* when it began, */
    double shown;             /* and when something was written last */
    int width;                /* of the line that stands on the terminal; 0: none does */
};

/* Looks at the progress from now on; without this, ticks do nothing. */
void progress_view_open(struct progress_view *view, double (*clock)(void));

/* To be called before anything else is written: takes the line away. */
void progress_view_clear(struct progress_view *view);

/* The line for a progress whose stage began `seconds` ago, as "phr: refining, level 3, 1200 links,
 * 40 %, about 9 s left"; the time goes by the share that is done, and is left out while that says too
 * little. `text` has room for PROGRESS_WIDTH characters and a zero. Returns their number. */
int progress_text(char text[PROGRESS_WIDTH + 1], const struct progress *progress, double seconds);

#endif
