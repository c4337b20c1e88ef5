/* Reading files once.
 *
 * A pipe gives its bytes to its first reader, and ends when this reader closes. So the
 * first bytes, by which a format is recognised, are kept for the reader of that format.
 * Rejected: ungetc(), for which C promises one byte. */
#if defined(__unix__) || defined(__APPLE__)
#define _XOPEN_SOURCE 700
#include <sys/stat.h>
#define HAVE_POSIX 1
#endif

#include "io/scene/source.h"

#include <errno.h>
#include <string.h>

#include "geom/stop.h"

static bool fail_to_read(const struct source *source, struct error *error)
{
    return error_set(error, EXIT_USAGE, "%s: cannot read: %s", source->path,
                     errno ? strerror(errno) : "unknown reason");
}

/* True if the last call of fread() was neither stopped nor failed. */
static bool is_good(const struct source *source, struct error *error)
{
    return stop_check(error) && (!ferror(source->file) || fail_to_read(source, error));
}

bool source_open(struct source *source, const char *path, struct error *error)
{
    errno = 0;
    return source_of_file(source, path, fopen(path, "rb"), error);
}

bool source_open_regular(struct source *source, const char *path, struct error *error)
{
#ifdef HAVE_POSIX
    struct stat status;
    *source = (struct source){.path = path};
    if (stat(path, &status) == 0 && !S_ISREG(status.st_mode))
        return error_set(error, EXIT_USAGE, "%s: not a regular file", path);
#endif
    return source_open(source, path, error);
}

bool source_of_file(struct source *source, const char *path, FILE *file,
                    struct error *error)
{
    *source = (struct source){.path = path, .file = file};
    if (!source->file)
        return fail_to_read(source, error);
    source->start_count = fread(source->start, 1, SOURCE_START, source->file);
    return is_good(source, error);
}

void source_close(struct source *source)
{
    if (source->file)
        fclose(source->file);
    source->file = NULL;
}

bool source_read(struct source *source, char *bytes, size_t *got, struct error *error)
{
    *got = source->start_count - source->taken;
    memcpy(bytes, source->start + source->taken, *got);
    source->taken = source->start_count;
    *got += fread(bytes + *got, 1, SOURCE_CHUNK - *got, source->file);
    return is_good(source, error);
}
