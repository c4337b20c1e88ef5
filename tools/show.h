/* --show: pictures of the algorithm in place of, or over, the light. */
#ifndef TOOLS_SHOW_H
#define TOOLS_SHOW_H

#include "io/picture/shading.h"
#include "tools/run.h"

/* On rank 0, when scene and cameras are read. True unless the contents of pictures cannot
 * be there: errors without a final gather, owners and links of a stored solution, links
 * of a missing root or pixel. Sets the error then. */
bool show_check(struct run *run);

/* Colours of leaves by --show owner, level or error, [patches], linear, to be freed with
 * alloc_free(); NULL: their light is shown. Sets an exposure of 1 unless one is given. */
struct rgb *show_colours(struct run *run);

/* The flat shading of these colours, in place of the radiosities of the leaves. */
struct shading *show_shading(struct run *run, struct rgb *colours);

/* Collective. Returns on rank 0 the leaf of each pixel, [width * height] local numbers,
 * -1 where there is none, to be freed with alloc_free(). NULL on the others, and where
 * show_overlay() draws nothing. A signal leaves holes in it. */
int32_t *show_leaves(struct run *run, const struct camera *camera);

/* Collective. Draws over a picture, which rank 0 has, as it has the leaves of its pixels:
 * outlines of the leaves (--show mesh, owner, level), or the links of a patch. False on
 * an error, on all ranks. */
bool show_overlay(struct run *run, const struct camera *camera, const int32_t *leaves,
                  float *picture);

#endif
