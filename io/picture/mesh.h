/* The solution as a PLY mesh. */
#ifndef IO_PICTURE_MESH_H
#define IO_PICTURE_MESH_H

#include <stdbool.h>

#include "io/picture/shading.h"
#include "io/picture/solution.h"
#include "io/picture/tone.h"
#include "io/run/output.h"

/* The answer of a final gather, for pictures of the solution in later runs. */
struct mesh_answer {
    const float *error;          /* [patches] of the leaves, W/m^2; or NULL */
    const struct rgb *straight;  /* [patches] light straight from lamps, reflected by a
                                    leaf, W/m^2; NULL: there is no answer */
    const float *outside;        /* [patches] share of a leaf outside of things on it and
                                    of narrow gaps, 1; or NULL */
    const struct rgb *irradiance; /* [patches] H of the leaves, W/m^2; or NULL */
    const float *irradiance_error; /* [patches] of a band of H, W/m^2; or NULL */
    const struct rgb *irradiance_at; /* [vertices] H, W/m^2; with `irradiance` */
    struct solution_lamps lamps; /* known: there is `straight` */
};

/* Writes binary little-endian PLY: vertices with float x y z (input units), uchar red
 * green blue (sRGB of their radiosity) and float radiosity_r radiosity_g radiosity_b (of
 * the smooth shading, W/m^2); faces with `list uchar int vertex_indices`, float
 * radiosity_r radiosity_g radiosity_b (of the leaf, W/m^2), uint root and uint hierarchy:
 * one face per leaf, roots in order, depth first. After a final gather, float error and
 * float rest_r rest_g rest_b follow, the radiosity less the light straight from lamps:
 * where lamps give most, two floats would lose the rest; and float outside, the share of
 * the leaf outside of things on it and of narrow gaps. With `irradiance`, vertices have
 * float irradiance_r irradiance_g irradiance_b, and so have faces, last, and float
 * irradiance_error, W/m^2. Then come the roots, as
 * io/picture/solution.h has them.
 * Errors: as output_close(). */
bool mesh_write(const struct shading *shading, const struct tone *tone,
                const struct mesh_answer *answer, const char *path, struct error *error);

/* Writes the header of such a mesh up to the hierarchy of its faces; vertices have an
 * irradiance if asked for. */
void mesh_write_header(struct output *output, int64_t vertices, int64_t faces,
                       bool irradiance);

/* Returns the next leaf of a mesh in canonical order, as forest_next_leaf(): none of a
 * sky; and their number. */
int32_t mesh_next_leaf(const struct forest *forest, int32_t leaf);
int64_t mesh_count(const struct forest *forest);

/* Returns the radiosities of all its leaves as linear RGB pixels, for tone_automatic()
 * without a picture, and sets `*count` to their number. To be freed with alloc_free(). */
float *mesh_colours(const struct forest *forest, int64_t *count);

#endif
