/* Reading Wavefront MTL material libraries.
 *
 * Understood: newmtl, Kd (the reflectance rho, 1) and Ke (the emitted radiosity E,
 * W/m^2), each as three numbers or one for grey, in capitals or not. d, Tr and map_Kd
 * only set flags for a warning: every material is opaque and of one colour. So do Kd and
 * Ke in the forms `spectral` and `xyz`. All other keywords are skipped. */
#ifndef IO_SCENE_MTL_H
#define IO_SCENE_MTL_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/error.h"
#include "geom/scene.h"
#include "io/scene/text.h"

struct mtl_entry {
    struct material material; /* neutral grey until it is defined */
    bool defined;             /* a library defines it */
    bool used;                /* a face has it; set by the caller */
    bool transparent;         /* d below 1 or, without d, Tr above 0 */
    bool textured;            /* has map_Kd */
    bool unread;              /* has Kd or Ke as spectral or xyz */
    bool has_kd;              /* Kd was read */
    bool has_d;               /* d was read, which overrides Tr */
};

/* The materials that are defined or asked for. Starts as {0}. */
struct mtl_table {
    struct text_names names;   /* material i has the name names.name[i] */
    struct mtl_entry *entries; /* [names.count] */
    int64_t capacity;          /* of entries */
    int64_t nameless;          /* newmtl lines without a name: their name is "" */
};

/* Returns the number of the material `name`. A new name is added, not yet defined. */
int32_t mtl_find(struct mtl_table *table, const char *name);

/* Adds the materials of the library `path`. A material without Kd is black, or grey if it
 * has a texture, or a Kd that is not read; one without Ke emits nothing; of two
 * definitions the later one counts. If the file cannot be read, `*found` is false and the
 * table unchanged, without an error.
 * Errors: "FILE:LINE: REASON"; EXIT_USAGE. */
bool mtl_read(struct mtl_table *table, const char *path, bool *found,
              struct error *error);

/* Does the same with a text in memory. Its lines are used up; it stays the caller's. */
bool mtl_of_text(struct mtl_table *table, struct text *text, struct error *error);

void mtl_free(struct mtl_table *table);

#endif
