/* Output files.
 *
 * A reader never sees half a file: the bytes go to a new file PATH.N.tmp, and rename()
 * replaces the old file by the whole new one. A symbolic link is followed first, so that
 * its target is replaced and the link stays. A device or a pipe (/dev/stdout) has no
 * place beside it and is written directly. */
#if defined(__unix__) || defined(__APPLE__)
#define _XOPEN_SOURCE 700
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#define HAVE_POSIX 1
#endif

#include "io/run/output.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "geom/alloc.h"

static bool is_special(const char *path)
{
#ifdef HAVE_POSIX
    struct stat status;
    return stat(path, &status) == 0 && !S_ISREG(status.st_mode) &&
           !S_ISDIR(status.st_mode);
#else
    (void)path;
    return false;
#endif
}

static bool is_directory(const char *path)
{
#ifdef HAVE_POSIX
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
#else
    (void)path;
    return false;
#endif
}

static bool fail(const char *path, int reason, struct error *error)
{
    return error_set(error, EXIT_FAILED, "%s: cannot write: %s", path, strerror(reason));
}

static void release(struct output *output)
{
    alloc_free(output->shown);
    alloc_free(output->path);
    alloc_free(output->temporary);
    *output = (struct output){0};
}

/* Returns the path with symbolic links resolved, or the path itself if there is no file
 * yet. To be freed. */
static char *follow_links(const char *path)
{
    char *copy;
#ifdef HAVE_POSIX
    char *real = realpath(path, NULL);
    copy = alloc_string(real ? real : path);
    free(real);
#else
    copy = alloc_string(path);
#endif
    return copy;
}

/* Creates a file. Returns NULL and sets errno if it exists or cannot be made. */
static FILE *open_new(const char *path)
{
#ifdef HAVE_POSIX
    int file = open(path, O_WRONLY | O_CREAT | O_EXCL, 0666);
    return file < 0 ? NULL : fdopen(file, "wb");
#else
    return fopen(path, "wb");
#endif
}

static FILE *open_temporary(struct output *output)
{
    enum { TRIES = 100, EXTRA = 16 };
    size_t room = strlen(output->path) + EXTRA;
    output->temporary = alloc_array(room, 1);
    FILE *file = NULL;
    for (int n = 0; n < TRIES && !file; n++) {
        snprintf(output->temporary, room, "%s.%d.tmp", output->path, n);
        file = open_new(output->temporary);
        if (!file && errno != EEXIST)
            break;
    }
    return file;
}

bool output_open(struct output *output, const char *path, struct error *error)
{
    *output = (struct output){0};
    if (!*path || is_directory(path))
        return fail(path, *path ? EISDIR : ENOENT, error);
    output->shown = alloc_string(path);
    output->path = follow_links(path);
    output->file = is_special(path) ? fopen(path, "wb") : open_temporary(output);
    if (output->file)
        return true;
    int reason = errno;
    release(output);
    return fail(path, reason, error);
}

void output_sync(struct output *output, struct error *error)
{
    if (fflush(output->file) != 0)
        fail(output->shown, errno, error);
#ifdef HAVE_POSIX
    else if (output->temporary && fsync(fileno(output->file)) != 0)
        fail(output->shown, errno, error);
#endif
}

bool output_close(struct output *output, struct error *error)
{
    if (!output->file)
        return false;
    errno = 0;
    bool written = !ferror(output->file);
    if (fclose(output->file) != 0)
        written = false;
    if (!written)
        fail(output->shown, errno ? errno : EIO, error);
    bool good = error->code == EXIT_DONE;
    if (good && output->temporary && rename(output->temporary, output->path) != 0)
        good = fail(output->shown, errno, error);
    if (!good && output->temporary)
        remove(output->temporary);
    release(output);
    return good;
}

bool output_probe(const char *path, struct error *error)
{
    struct output output;
    if (!output_open(&output, path, error))
        return false;
    fclose(output.file);
    if (output.temporary)
        remove(output.temporary);
    release(&output);
    return true;
}

void output_uint32(struct output *output, uint32_t value)
{
    for (int k = 0; k < 4; k++)
        putc((int)(value >> (8 * k) & 255u), output->file);
}

void output_uint32_big(struct output *output, uint32_t value)
{
    for (int k = 3; k >= 0; k--)
        putc((int)(value >> (8 * k) & 255u), output->file);
}

void output_float(struct output *output, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    output_uint32(output, bits);
}

void output_float_big(struct output *output, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    output_uint32_big(output, bits);
}
