/* Stored solutions: the meshes written by phr, with the parts of the scene needed for
 * pictures.
 *
 * Behind vertices and faces (io/picture/mesh.h) a PLY file has the elements
 *
 *     material     double reflectance_r .. _b, 1; emission_r .. _b, W/m^2; where there
 *                  are panes, transmittance_r .. _b, 1
 *     root_corner  double x y z in scene units (geom/scene.h), int material; double
 *                  nx ny nz, the normal, where the scene has normals. Those of input
 *                  triangle i are 3 i, 3 i + 1 and 3 i + 2
 *     solution     one record: double x y z, the scene's centre in input units, int
 *                  exponent, uchar two_sided, two_sided_lamps; after a final gather,
 *                  double lamp_least and mean (struct solution_lamps)
 *
 * so that the scene is there to the last bit. A triangle without leaves was dropped, and
 * one without leaves of its twin has none. */
#ifndef IO_PICTURE_SOLUTION_H
#define IO_PICTURE_SOLUTION_H

#include <stdbool.h>
#include <stdint.h>

#include "io/run/output.h"
#include "io/scene/plyfile.h"
#include "rad/patch.h"

struct solution_leaf {
    struct patch_id id;
    struct triangle triangle; /* input units */
    int64_t start, end;       /* interval of the root, in 4^15ths of its area */
    double area;              /* square input units */
    struct rgb radiosity;     /* W/m^2 */
    struct rgb rest;          /* radiosity less what comes straight from lamps, W/m^2 */
    double error;             /* W/m^2 */
    double outside;           /* open share of the leaf, 1 */
};

/* The light of lamps in a final gather (rad/beyond/gather/gather.h). */
struct solution_lamps {
    bool known;        /* false: there was no final gather */
    double lamp_least; /* a lamp emits more than this over all bands, W/m^2 */
    double mean;       /* radiosity, over bands and all surface, W/m^2 */
};

/* A solution mesh of phr: its leaves, in their order. */
struct solution_mesh {
    struct solution_leaf *leaves; /* [count] */
    int64_t count;
    bool has_error, has_outside;
    struct solution_lamps lamps;  /* known: leaves have `rest` */
    struct scene *scene;          /* prepared, owned; NULL: the file lacks the roots */
};

/* True if the faces have radiosity_r and hierarchy. */
bool solution_is_stored(const struct ply_file *file);

/* Reads a mesh from an open file. To be freed with solution_mesh_free().
 * Errors: those of ply_file_open() and ply_file_record(); a property of
 * io/picture/mesh.h is missing; the leaves of a root leave gaps or overlap, or are not
 * those of the scene. EXIT_USAGE. */
bool solution_mesh_read(struct solution_mesh *solution, struct source *source,
                        struct error *error);

/* Does the same with a file whose header is read, which stays open. */
bool solution_mesh_of_file(struct solution_mesh *solution, struct ply_file *file,
                           struct error *error);

void solution_mesh_free(struct solution_mesh *solution);

/* Splits the undivided roots of a forest over the solution's scene into its leaves, with
 * their radiosities. */
void solution_mesh_restore(const struct solution_mesh *solution, struct forest *forest);

/* Write the last part of the header, which is about the scene, and its records, which
 * stand behind the faces. */
void solution_write_header(struct output *output, const struct scene *scene, bool known);
void solution_write_scene(struct output *output, const struct scene *scene,
                          const struct solution_lamps *lamps);

#endif
