/* The files of a run: no output goes over a file that the run reads, or over another of
 * its outputs. On rank 0 alone, where the files are. */
#ifndef IO_RUN_FILES_H
#define IO_RUN_FILES_H

#include "io/run/options.h"

/* Refuses outputs without a format that are neither device nor pipe, and outputs that
 * lead to a file that is read, or to that of another output, however they are spelt, or
 * to the standard output beside --dump; but a run may renew the checkpoint that it was
 * resumed from. EXIT_USAGE. */
bool files_check(const struct options *options, struct error *error);

/* The same for one more file that is read. */
bool files_check_input(const struct options *options, const char *path,
                       struct error *error);

/* True if all outputs can be written (output_probe()). */
bool files_probe(const struct options *options, struct error *error);

/* True if an output goes to the standard output. */
bool files_take_stdout(const struct options *options);

#endif
