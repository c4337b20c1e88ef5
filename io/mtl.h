/* Reading Wavefront MTL material libraries.
 *
 * Understood: newmtl, Kd (the reflectance rho, 1) and Ke (the emitted radiosity E, W/m^2),
 * each as three numbers or one for grey, in capitals or not. Kd and Ke in the forms `spectral`
 * and `xyz` and all other keywords are passed over. */
#ifndef IO_MTL_H
#define IO_MTL_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/error.h"
#include "geom/scene.h"
#include "io/text.h"

struct mtl_entry {
    struct material material; /* neutral grey until it is defined */
    bool defined;             /* a library defines it */
    bool used;                /* for the caller: a face has it */
};

/* The materials that are defined or asked for. Starts as {0}. */
struct mtl_table {
    struct text_names names;   /* material i has the name names.name[i] */
    struct mtl_entry *entries; /* [names.count] */
    int64_t capacity;          /* of entries */
};

/* The number of the material `name`, which is added, not defined, if it is new. */
int32_t mtl_find(struct mtl_table *table, const char *name);

/* Adds the materials of the library `path`. A material without Kd is black, one without Ke
 * emits nothing; of two definitions the later one counts. If the file cannot be read
 * `*found` is false and the table as before; that is no error.
 * Errors: "FILE:LINE: what is wrong"; EXIT_USAGE. */
bool mtl_read(struct mtl_table *table, const char *path, bool *found, struct error *error);

/* The same for a text that is in memory. Its lines are used up; it stays the caller's. */
bool mtl_of_text(struct mtl_table *table, struct text *text, struct error *error);

void mtl_free(struct mtl_table *table);

#endif
