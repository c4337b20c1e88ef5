/* Outputs, and their formats. */
#ifndef IO_RUN_TARGET_H
#define IO_RUN_TARGET_H

#include <stdbool.h>

#include "geom/error.h"

/* Formats of outputs, in the order of the table in io/run/target.c. FORMAT_ERROR: the
 * standard errors of the pixels of a picture, as PFM. */
enum output_format { FORMAT_PPM, FORMAT_PFM, FORMAT_PNG, FORMAT_HDR, FORMAT_PLY,
                     FORMAT_VTK, FORMAT_GLB, FORMAT_ERROR };

/* An output of -o. */
struct target {
    const char *path;         /* borrowed */
    enum output_format format;
    bool has_format;          /* false: a device or pipe, which gets a picture (PPM) */
    int view;                 /* of a picture, 0 if there is no view */
};

/* True if the format is a mesh, false for a picture. */
bool format_is_mesh(enum output_format format);

/* True if its colours are 8-bit codes, which --exposure changes. */
bool format_has_tone(enum output_format format);

/* Reads FORMAT:FILE, or a file whose suffix may be a format; its view is 0. */
struct target target_parse(const char *argument);

/* Refuses an output without a format. */
bool target_refuse(const char *argument, struct error *error);

#endif
