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
    const char **outputs;     /* [output_count] paths of -o; owned array, borrowed strings */
    int output_count;
    const char *view;         /* path of the view file, or NULL */
    const char *stats;        /* path of the JSON file, or NULL */
    const char *save_links, *load_links; /* paths of link caches, or NULL */
    const char *checkpoint, *resume;     /* paths of checkpoints, or NULL */
    int every;                /* passes from checkpoint to checkpoint, at least 1 */
    int64_t memory;           /* bytes for links and patches; 0: most of what the machine has */
    int width, height;        /* of --size; 0: what the view says */
    int samples;              /* samples x samples rays a pixel */
    bool pixels;              /* the final gather is of each pixel, too */
    double exposure;          /* 0: chosen from the picture */
    bool two_sided, two_sided_lamps; /* the second is never without the first */
    bool flat, quiet, verbose, help, version, validate, form_factors;
    struct criterion criterion;
};

/* Reads the arguments; the strings stay those of argv. Release with options_free(), also after
 * a failure. Errors: one line that says which argument is wrong, EXIT_USAGE. */
bool options_parse(struct options *options, int argc, char **argv, struct error *error);
void options_free(struct options *options);

/* The settings that decide what the links of all pairs are, or what the passes to come
 * are, as lines "--option value" in a fixed order: what a link cache or a checkpoint is
 * bound to. Not among them is what may differ from run to run: outputs, ranks, memory,
 * and when to end (--tolerance, --max-iterations), which holds for all that was computed
 * before. Rewritten by the next call. */
const char *options_link_settings(const struct options *options);
const char *options_run_settings(const struct options *options);

/* Format of an output by its suffix. Pre: options_parse() has accepted it. */
enum output_format output_format_of(const char *path);

/* The text of --help. */
void options_print_help(FILE *file);

#endif
