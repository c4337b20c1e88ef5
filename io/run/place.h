/* The place behind a path, however spelt. */
#ifndef IO_RUN_PLACE_H
#define IO_RUN_PLACE_H

#include <stdbool.h>

/* Returns the open descriptor meant by a path of an output ("-", /dev/stdout,
 * /dev/stderr, /dev/fd/N, /proc/self/fd/N), or -1. */
int place_descriptor(const char *path);

/* True if an output to the path goes to the standard output. */
bool place_is_stdout(const char *path);

/* Returns the path behind all symbolic links, whether there is a file or not; NULL, and
 * errno, if the links go in a circle. To be freed with alloc_free(). */
char *place_follow(const char *path);

/* Returns the folder of a file. To be freed with alloc_free(). */
char *place_folder(const char *path);

/* True if writing an output would change or replace an input: both are one file, by
 * device and inode. */
bool place_is_read(const char *output, const char *input);

/* True if of two outputs the second would change or replace the first. Not so with
 * devices, such as /dev/null, and with two names of one file (hard links), which then
 * name two files. */
bool place_is_written(const char *output, const char *other);

#endif
