/* The files of a run: no output goes over an input of the run, or over another output. On
 * rank 0 alone, where the files are. */
#ifndef IO_RUN_FILES_H
#define IO_RUN_FILES_H

#include "io/run/options.h"

/* Refuses outputs without a format, but for devices and pipes, and outputs leading, in
 * any spelling, to a file read by the run, to the file of another output, or to the
 * standard output beside --dump; but a run may renew the checkpoint from which it was
 * resumed. EXIT_USAGE. */
bool files_check(const struct options *options, struct error *error);

/* The same for one more file to read. */
bool files_check_input(const struct options *options, const char *path,
                       struct error *error);

/* True if all outputs can be written (output_probe()). */
bool files_probe(const struct options *options, struct error *error);

/* True if an output goes to the standard output. */
bool files_take_stdout(const struct options *options);

#endif
