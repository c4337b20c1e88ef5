/* The command line. */
#ifndef IO_RUN_OPTIONS_H
#define IO_RUN_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "geom/error.h"
#include "rad/model.h"

#define PHR_VERSION "0.3"

enum output_format { FORMAT_PPM, FORMAT_PFM, FORMAT_PLY };

struct options {
    const char *scene;        /* path of the scene, NULL with help, version or validate */
    const char **outputs;     /* [output_count] paths of -o, borrowed; owned array */
    int output_count;
    int *view_of;             /* [output_count] the view of a picture, 0 if there is no
                                 view; owned */
    const char **views;       /* [view_count] paths of --view, borrowed; owned array */
    int view_count;
    const char *stats;        /* path of the JSON file, or NULL */
    const char *save_links;   /* path of the link cache to write, or NULL */
    const char *load_links;   /* path of the link cache to read, or NULL */
    const char *checkpoint;   /* path of the checkpoint to write, or NULL */
    const char *resume;       /* path of the checkpoint to read, or NULL */
    int every;                /* passes from checkpoint to checkpoint, at least 1 */
    int64_t memory;           /* bytes for links and patches; 0: 80 % of the machine's */
    int width, height;        /* of --size; 0: those of the view */
    int samples;              /* samples x samples rays a pixel */
    bool pixels;              /* the final gather is done at each pixel, too */
    double exposure;          /* 0: chosen from the picture */
    bool two_sided;           /* backs reflect */
    bool two_sided_lamps;     /* backs of lamps, too; only with two_sided */
    bool flat, quiet, verbose, help, version, validate, form_factors;
    struct criterion criterion;
};

/* Reads the arguments; the strings stay those of argv. Release with options_free(), also
 * after a failure. Errors: one line that names the wrong argument, EXIT_USAGE. */
bool options_parse(struct options *options, int argc, char **argv, struct error *error);
void options_free(struct options *options);

/* Return the settings that a link cache or a checkpoint is bound to, as lines "--option
 * value" in a fixed order: those that determine the links of all pairs, or the coming
 * passes. Outputs, ranks, memory and the limits of iteration (--tolerance,
 * --max-iterations) are not among them and may differ from run to run. Overwritten by the
 * next call. */
const char *options_link_settings(const struct options *options);
const char *options_run_settings(const struct options *options);

/* Returns the format of an output by its suffix. Pre: options_parse() has accepted it. */
enum output_format output_format_of(const char *path);

/* True if an output is a picture, and no mesh. */
bool output_is_picture(const char *path);

/* True if a picture of the view is asked for; without --view, view 0 is the automatic
 * one. */
bool options_show(const struct options *options, int view);

/* Prints the text of --help. */
void options_print_help(FILE *file);

#endif
