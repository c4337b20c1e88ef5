/* The command line. */
#ifndef IO_RUN_OPTIONS_H
#define IO_RUN_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "io/run/target.h"
#include "io/scene/sky.h"
#include "rad/model.h"

#define PHR_VERSION "0.3"
#define PHR_FORMAT 1 /* of --stats and of notes in outputs; a change breaks readers */

/* The contents of pictures, in the order of --show. */
enum show { SHOW_LIGHT, SHOW_RADIOSITY, SHOW_IRRADIANCE, SHOW_MESH, SHOW_OWNER,
            SHOW_LEVEL, SHOW_ERROR, SHOW_LINKS };

/* What --dump prints. */
enum dump { DUMP_NOTHING, DUMP_PATCHES, DUMP_LINKS };

/* Upward axes, in the order of --up. */
enum up { UP_GUESSED, UP_Y, UP_Z, UP_MINUS_Y, UP_MINUS_Z, UP_X, UP_MINUS_X };

/* How a scene states the light of its lamps. */
enum ke { KE_RADIOSITY, KE_RADIANCE };

struct options {
    const char *scene;        /* path of the scene, NULL with help or version */
    struct target *outputs;   /* [output_count] owned */
    int output_count;
    const char **views;       /* [view_count] paths of --view, borrowed; owned array */
    int view_count;
    const char *stats;        /* path of the JSON file, or NULL */
    const char *save_links;   /* path of the link cache to write, or NULL */
    const char *load_links;   /* path of the link cache to read, or NULL */
    const char *checkpoint;   /* path of the checkpoint to write, or NULL */
    const char *resume;       /* path of the checkpoint to read, or NULL */
    const char *at;           /* path of points to read, or NULL */
    const char *report;       /* path of the table of objects to write, or NULL */
    int seconds;              /* after which the run ends with what it has; 0: none */
    int every;                /* passes from checkpoint to checkpoint, at least 1 */
    int64_t memory;           /* bytes for links and patches; 0: 80 % of the machine's */
    int width, height;        /* of --size; 0: those of the view */
    int samples;              /* samples x samples rays a pixel */
    bool pixels;              /* the final gather is done at each pixel, too */
    int pixel_rays;           /* by this many rays at least; 0: by as many as for a leaf,
                                 as given by --final-gather */
    enum dump dump;
    enum show show;
    const char *show_patch;   /* of SHOW_LINKS: ROOT/PATH or X,Y; else NULL */
    double exposure;          /* 0: chosen from the picture */
    enum up up;               /* the upward axis */
    enum ke ke;               /* of Ke, and of the emissions of a PLY file */
    struct sky sky;           /* of --sky and --sun */
    bool two_sided;           /* backs reflect */
    bool two_sided_lamps;     /* backs of lamps, too; only with two_sided */
    const char *help_on;      /* option of --help=OPTION, or NULL */
    bool lux;                 /* numbers of light in lux, else W/m^2 */
    int lines;                /* of equal values in false colours; 0: none */
    bool flat, quiet, verbose, help, version;
    bool unlit;               /* viewfactors': no light is asked for, no lamp is needed */
    struct criterion criterion;
    uint64_t given;           /* bit i: the i-th option of the parser's table */
    uint64_t overruled;       /* the same: given before --paper, and not behind it */
};

/* Reads the arguments; the strings stay those of argv. Release with options_free(), also
 * after a failure. Errors: one line naming the wrong argument, EXIT_USAGE. */
bool options_parse(struct options *options, int argc, char **argv, struct error *error);
void options_free(struct options *options);

/* Return the settings to which a link cache or a checkpoint is bound, as lines "--option
 * value" in a fixed order: all that determine the links of all pairs, or the coming
 * passes. Outputs, ranks, memory and the limits of iteration (--tolerance,
 * --max-iterations) are no such settings and may differ from run to run. Overwritten by
 * the next call. */
const char *options_link_settings(const struct options *options);
const char *options_run_settings(const struct options *options);

/* Returns the settings of light other than the defaults, as above. */
const char *options_light_settings(const struct options *options);

/* True if a picture of the view is asked for; without --view, view 0 is the automatic
 * one. */
bool options_show(const struct options *options, int view);

/* Returns the options of the command line among `names` (with a NULL behind the last),
 * joined by commas; an empty text if there are none. Overwritten by the next call. */
const char *options_given(const struct options *options, const char *const *names);

/* Returns an option of the command line not in `names`, or NULL. */
const char *options_other(const struct options *options, const char *const *names);

/* Prints the text of --help, or the part on an option, with its range. */
void options_print_help(const char *option, FILE *file);

#endif
