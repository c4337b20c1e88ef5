/* Why a picture is dark. */
#ifndef TOOLS_DARK_H
#define TOOLS_DARK_H

#include "tools/run.h"

/* On rank 0. Warns once if nine tenths of the picture of a view, or more, are black or
 * sky, and names the reason: the camera, a sky not getting in, lamps looking
 * away, a missing library. `picture`: RGB floats, the camera's size. */
void dark_warn(struct run *run, int view, const float *picture);

#endif
