/* The solution as a mesh for VTK and ParaView. */
#ifndef IO_PICTURE_VTK_H
#define IO_PICTURE_VTK_H

#include <stdbool.h>

#include "io/picture/mesh.h"

/* Writes the legacy format of VTK, version 3.0, binary (big-endian), as
 * UNSTRUCTURED_GRID: points (input units) and a triangle for each leaf, as in
 * mesh_write(). Cells have the fields radiosity (3 floats, of the leaf, W/m^2), root and
 * hierarchy (unsigned_int), level (unsigned_char) and, where the answer has them, error
 * (float, W/m^2), irradiance (3 floats, W/m^2) and irradiance_error (float, W/m^2);
 * points have radiosity (3 floats, of the smooth shading, W/m^2) and irradiance.
 * Errors: as output_close(). */
bool vtk_write(const struct shading *shading, const struct mesh_answer *answer,
               const char *path, struct error *error);

#endif
