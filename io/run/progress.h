/* Progress as the user sees it: one line of a terminal, rewritten again and again, or now
 * and then a line of a log. */
#ifndef IO_RUN_PROGRESS_H
#define IO_RUN_PROGRESS_H

#include <stdbool.h>

#include "geom/progress.h"

enum { PROGRESS_WIDTH = 79 }; /* columns at most */

struct progress_view {
    struct progress progress; /* ticked by the loops; has to be the first field */
    double (*clock)(void);    /* seconds since a fixed moment */
    bool terminal;            /* stderr is a terminal */
    int64_t stage;            /* progress.stage at the last tick */
    double begun;             /* clock at the first tick of the stage */
    double shown;             /* clock at the last line written */
    int width;                /* of the line on the terminal; 0: there is none */
};

/* Shows the progress from now on; without this call, ticks do nothing. Of a phase of more
 * than half a minute a lasting line says so early, with the options for a shorter one. */
void progress_view_open(struct progress_view *view, double (*clock)(void));

/* Removes the line. To be called before any other output on stderr. */
void progress_view_clear(struct progress_view *view);

/* Writes the line for a progress whose stage began `seconds` ago, such as "phr: refining,
 * level 3, 1200 links, 40 %, about 9 s left". The time left is extrapolated from the part
 * done, and omitted at the start of a stage. `text` has room for PROGRESS_WIDTH
 * characters and a zero. Returns their number. */
int progress_text(char text[PROGRESS_WIDTH + 1], const struct progress *progress,
                  double seconds);

#endif
