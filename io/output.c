/* Output files.
 *
 * A reader never sees half a file: the bytes go to PATH.tmp, and rename() puts the whole file
 * in place or nothing. What is not a regular file (/dev/stdout, a pipe) has no place beside it
 * and is written directly. */
#if defined(__unix__) || defined(__APPLE__)
#define _POSIX_C_SOURCE 200112L
#include <sys/stat.h>
#define HAVE_STAT 1
#endif

#include "io/output.h"

#include <errno.h>
#include <string.h>

#include "geom/alloc.h"

static bool is_special(const char *path)
{
#ifdef HAVE_STAT
    struct stat status;
    return stat(path, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
#else
    (void)path;
    return false;
#endif
}

static bool is_directory(const char *path)
{
#ifdef HAVE_STAT
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
    alloc_free(output->path);
    alloc_free(output->temporary);
    *output = (struct output){0};
}

bool output_open(struct output *output, const char *path, struct error *error)
{
    *output = (struct output){.path = alloc_string(path)};
    if (!*path || is_directory(path)) {
        release(output);
        return fail(path, *path ? EISDIR : ENOENT, error);
    }
    if (!is_special(path)) {
        size_t length = strlen(path);
        output->temporary = alloc_array(length + 5, 1);
        memcpy(output->temporary, path, length);
        memcpy(output->temporary + length, ".tmp", 5);
    }
    output->file = fopen(output->temporary ? output->temporary : path, "wb");
    if (output->file)
        return true;
    int reason = errno;
    release(output);
    return fail(path, reason, error);
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
        fail(output->path, errno ? errno : EIO, error);
    bool good = error->code == EXIT_DONE;
    if (good && output->temporary && rename(output->temporary, output->path) != 0)
        good = fail(output->path, errno, error);
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

void output_float(struct output *output, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    output_uint32(output, bits);
}
