/* The solution as one file for viewers: glTF. */
#ifndef IO_PICTURE_GLB_H
#define IO_PICTURE_GLB_H

#include "io/picture/shading.h"
#include "io/picture/tone.h"

/* Writes glTF 2.0, binary: a mesh with a triangle for each leaf; POSITION (floats, from
 * the middle of the scene, which the matrix of the node puts where it was, y up), COLOR_0
 * (normalized 16 bits, linear: radiosity times the exposure, at most 1); a material that
 * is unlit (KHR_materials_unlit), whose fronts alone are seen; and in the extras of the
 * asset the exposure and output_note().
 * Errors: more than 4 GB; as output_close(). */
bool glb_write(const struct shading *shading, const struct tone *tone, const char *path,
               struct error *error);

#endif
