/* The solution as a PLY mesh. */
#ifndef IO_PICTURE_MESH_H
#define IO_PICTURE_MESH_H

#include <stdbool.h>

#include "io/picture/shading.h"
#include "io/picture/tone.h"
#include "io/run/output.h"

/* Writes binary little-endian PLY: vertices with float x y z (input units) and uchar red
 * green blue (sRGB of the vertex radiosity); faces with `list uchar int vertex_indices`,
 * float radiosity_r radiosity_g radiosity_b (of the leaf, W/m^2), uint root and uint
 * hierarchy: one face per leaf, roots in order, depth first. `errors`: [patches] errors
 * of the leaves, W/m^2, written as float error; or NULL.
 * Errors: as output_close(). */
bool mesh_write(const struct shading *shading, const struct tone *tone,
                const float *errors, const char *path, struct error *error);

/* Writes the header of such a mesh, with errors or without. */
void mesh_write_header(struct output *output, int64_t vertices, int64_t faces,
                       bool errors);

/* Returns the radiosities of all leaves as linear RGB pixels, for tone_automatic()
 * without a picture, and sets `*count` to their number. To be freed with alloc_free(). */
float *mesh_colours(const struct forest *forest, int64_t *count);

#endif
