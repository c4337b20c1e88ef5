/* Reading Wavefront MTL material libraries.
 *
 * Understood: newmtl, Kd (the reflectance rho, 1) and Ke (the emitted radiosity E,
 * W/m^2), each as three numbers or one for grey, in capitals or not; map_Kd and map_Ke,
 * pictures (io/scene/maps.h); d, or Tr where there is none, Tf and illum, of which the
 * transmittance of panes is made. Kd and Ke in the forms `spectral` and `xyz` only set
 * flags for a warning. All other statements are skipped, and named unless nothing is lost
 * without them. */
#ifndef IO_SCENE_MTL_H
#define IO_SCENE_MTL_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/error.h"
#include "geom/scene.h"
#include "io/scene/text.h"

struct mtl_entry {
    struct material material; /* neutral grey until defined */
    bool defined;             /* by a library */
    bool used;                /* by a face; set by the caller */
    double opacity;           /* d, or 1 - Tr, in [0, 1] */
    struct rgb filter;        /* Tf */
    bool has_d, has_tr;       /* d, Tr was read; d overrides Tr */
    bool clear;               /* Tf is not 1, or illum is 4, 6, 7 or 9 */
    int32_t maps[2];          /* pictures of Kd and Ke: numbers from 1; 0: none */
    bool unread;              /* has Kd or Ke as spectral or xyz */
    bool has_kd, has_ke;      /* Kd, Ke was read */
};

/* The materials defined or asked for. Starts as {0}. */
struct mtl_table {
    struct text_names names;   /* material i has the name names.name[i] */
    struct mtl_entry *entries; /* [names.count] */
    int64_t capacity;          /* of entries */
    int64_t nameless;          /* newmtl lines without a name: their name is "" */
    struct text_names maps;    /* paths of pictures */
    struct text_names passed;  /* keywords of statements passed over */
};

/* Returns the number of the material `name`. A new name is added, not yet defined. */
int32_t mtl_find(struct mtl_table *table, const char *name);

/* Adds the materials of the library `path`. A material without Kd is black, or grey if
 * its Kd is not read; one without Ke emits nothing; of two definitions the later one
 * counts. If the file cannot be read, `*found` is false and the table unchanged, without
 * an error.
 * Errors: "FILE:LINE: REASON"; EXIT_USAGE. */
bool mtl_read(struct mtl_table *table, const char *path, bool *found,
              struct error *error);

/* Does the same with a text in memory. The text stays the caller's, its lines used up. */
bool mtl_of_text(struct mtl_table *table, struct text *text, struct error *error);

/* The share of light let through, 1: 1 - d, times Tf. */
struct rgb mtl_transmittance(const struct mtl_entry *entry);

/* Makes a pane of a material that lets light through: it reflects Kd d, and emits
 * nothing. */
void mtl_make_pane(struct mtl_entry *entry);

void mtl_free(struct mtl_table *table);

#endif
