/* Output files.
 *
 * A reader never sees half a file: the bytes go to a new file FILE.N.tmp (phr.N.tmp,
 * where that name is too long) in the folder of FILE, and rename() replaces the old file
 * by the whole new one, which takes on its mode. The bytes and, behind them, the folder
 * are brought to the disk. A symbolic link is followed first, so that its target is
 * replaced, or made, and the link stays.
 *
 * A device, a pipe or an open descriptor has no place for a file beside it. All bytes
 * wait in memory; only then the stream is opened, so a named pipe is opened once, when
 * there is something to read. Neither opening nor writing waits without looking whether
 * the program is asked to stop: a pipe may have no reader, or a sleeping one. A
 * descriptor is duplicated, not opened anew: under a launcher it may be a socket, and in
 * a file the bytes before stay. */
#if defined(__unix__) || defined(__APPLE__)
#define _XOPEN_SOURCE 700
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>
#define HAVE_POSIX 1
#endif

#include "io/run/output.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/stop.h"
#include "io/run/place.h"

static bool fail(const char *path, int reason, struct error *error)
{
    return error_set(error, EXIT_FAILED, "%s: cannot write: %s", path, strerror(reason));
}

static void release(struct output *output)
{
    alloc_free(output->shown);
    alloc_free(output->path);
    alloc_free(output->temporary);
    free(output->bytes);
    *output = (struct output){0};
}

#ifdef HAVE_POSIX

/* --- devices, pipes and descriptors --- */

bool output_is_stream(const char *path)
{
    char *place = place_follow(path);
    struct stat status;
    bool stream = place && (place_descriptor(place) >= 0 ||
                            (stat(place, &status) == 0 && !S_ISREG(status.st_mode) &&
                             !S_ISDIR(status.st_mode)));
    alloc_free(place);
    return stream;
}

/* True if a stream can be written, as far as can be told without opening. Sets errno. */
static bool takes_bytes(const char *path)
{
    int descriptor = place_descriptor(path);
    if (descriptor < 0)
        return access(path, W_OK) == 0;
    int flags = fcntl(descriptor, F_GETFL);
    if (flags >= 0 && (flags & O_ACCMODE) == O_RDONLY)
        errno = EBADF;
    return flags >= 0 && (flags & O_ACCMODE) != O_RDONLY;
}

/* Opens a stream; a named pipe when there is a reader. Returns -1 and sets errno on an
 * error, and when the program is asked to stop. */
static int open_stream(const char *path)
{
    enum { PAUSE = 20 }; /* milliseconds */
    struct stat status;
    int descriptor = place_descriptor(path);
    if (descriptor >= 0)
        return dup(descriptor);
    bool waits = stat(path, &status) == 0 && S_ISFIFO(status.st_mode);
    for (;;) {
        int file = open(path, O_WRONLY | O_NONBLOCK | O_NOCTTY);
        if (file >= 0 || !waits || errno != ENXIO)
            return file;
        if (stop_was_asked()) {
            errno = EINTR;
            return -1;
        }
        poll(NULL, 0, PAUSE);
    }
}

/* Writes pieces small enough for any pipe ready for a byte. Returns false and sets errno
 * on an error, and when the program is asked to stop. */
static bool send_bytes(int file, const char *bytes, size_t size)
{
    enum { PAUSE = 100 }; /* milliseconds */
    while (size > 0) {
        struct pollfd ready = {.fd = file, .events = POLLOUT};
        bool is_ready = poll(&ready, 1, PAUSE) > 0;
        if (stop_is_asked() || (!is_ready && stop_was_asked())) {
            errno = EINTR;
            return false;
        }
        if (!is_ready)
            continue;
        ssize_t sent = write(file, bytes, size < PIPE_BUF ? size : PIPE_BUF);
        if (sent < 0 && errno != EAGAIN && errno != EINTR)
            return false;
        bytes += sent > 0 ? sent : 0;
        size -= sent > 0 ? (size_t)sent : 0;
    }
    return true;
}

static bool send_all(const struct output *output)
{
    int file = open_stream(output->path);
    bool sent = file >= 0 && send_bytes(file, output->bytes, output->size);
    int reason = errno;
    if (file >= 0 && close(file) != 0 && sent)
        return false;
    errno = reason;
    return sent;
}

/* --- files --- */

/* Creates a file with the mode of the one to replace. Returns NULL and sets errno if the
 * file exists or cannot be made. */
static FILE *open_new(const char *path, const char *old)
{
    enum { MODES = 0777 };
    struct stat status;
    int file = open(path, O_WRONLY | O_CREAT | O_EXCL, 0666);
    if (file < 0)
        return NULL;
    if (stat(old, &status) == 0)
        (void)fchmod(file, status.st_mode & MODES);
    FILE *stream = fdopen(file, "wb");
    int reason = errno;
    if (!stream) {
        close(file);
        remove(path);
    }
    errno = reason;
    return stream;
}

static FILE *open_temporary(struct output *output)
{
    enum { TRIES = 100, EXTRA = 32 };
    char *folder = place_folder(output->path);
    size_t room = strlen(output->path) + EXTRA;
    output->temporary = alloc_array(room, 1);
    FILE *file = NULL;
    bool is_short = false;
    for (int n = 0; n < TRIES && !file; n++) {
        if (is_short)
            snprintf(output->temporary, room, "%s/phr.%d.tmp", folder, n);
        else
            snprintf(output->temporary, room, "%s.%d.tmp", output->path, n);
        file = open_new(output->temporary, output->path);
        if (!file && errno != EEXIST && (is_short || errno != ENAMETOOLONG))
            break;
        is_short = is_short || (!file && errno == ENAMETOOLONG);
    }
    alloc_free(folder);
    return file;
}

/* Returns NULL and sets errno on an error. */
static FILE *open_file(struct output *output)
{
    struct stat status;
    const char *path = output->path;
    bool stream = output_is_stream(path), exists = stat(path, &status) == 0;
    if (!*path || (exists && S_ISDIR(status.st_mode))) {
        errno = *path ? EISDIR : ENOENT;
        return NULL;
    }
    if ((stream || exists) && !takes_bytes(path))
        return NULL;
    return stream ? open_memstream(&output->bytes, &output->size)
                  : open_temporary(output);
}

/* Flushes the bytes, those of a file to the disk. */
static bool flush(const struct output *output)
{
    return fflush(output->file) == 0 &&
           (!output->temporary || fsync(fileno(output->file)) == 0);
}

/* Takes the whole output to its place; the name of a file to the disk as well, where the
 * system can. */
static bool deliver(const struct output *output)
{
    if (!output->temporary)
        return send_all(output);
    if (rename(output->temporary, output->path) != 0)
        return false;
    char *name = place_folder(output->path);
    int folder = open(name, O_RDONLY);
    alloc_free(name);
    if (folder >= 0) {
        fsync(folder);
        close(folder);
    }
    return true;
}

#else /* the file itself is written */

bool output_is_stream(const char *path)
{
    (void)path;
    return false;
}

static FILE *open_file(struct output *output)
{
    return fopen(output->path, "wb");
}

static bool flush(const struct output *output)
{
    return fflush(output->file) == 0;
}

static bool deliver(const struct output *output)
{
    (void)output;
    return true;
}

#endif

/* --- all outputs --- */

bool output_open(struct output *output, const char *path, struct error *error)
{
    *output = (struct output){0};
    const char *shown = strcmp(path, "-") == 0 ? "standard output" : path;
    output->shown = alloc_string(shown);
    output->path = place_follow(path);
    output->file = output->path ? open_file(output) : NULL;
    if (output->file)
        return true;
    int reason = errno;
    if (output->temporary && reason == EEXIST)
        error_set(error, EXIT_FAILED, "%s: cannot write: %s and all before it are there, "
                  "as killed runs leave them", shown, output->temporary);
    release(output);
    return fail(shown, reason, error);
}

bool output_close(struct output *output, struct error *error)
{
    if (!output->file)
        return false;
    errno = 0;
    bool written = flush(output) && !ferror(output->file); /* tells why, once more */
    int reason = errno;
    if (fclose(output->file) != 0 && written) {
        written = false;
        reason = errno;
    }
    if (!written)
        fail(output->shown, reason ? reason : EIO, error);
    bool good = error->code == EXIT_DONE;
    if (good && !deliver(output))
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

static const char *note = "";

void output_set_note(const char *lines)
{
    note = lines;
}

const char *output_note(void)
{
    return note;
}

void output_write_note(struct output *output, const char *before)
{
    for (const char *line = note; *line; line = strchr(line, '\n') + 1)
        fprintf(output->file, "%s%.*s\n", before, (int)strcspn(line, "\n"), line);
}

void output_uint32(struct output *output, uint32_t value)
{
    unsigned char bytes[4];
    for (int k = 0; k < 4; k++)
        bytes[k] = (unsigned char)(value >> (8 * k) & 255u);
    fwrite(bytes, 1, sizeof bytes, output->file);
}

void output_uint32_big(struct output *output, uint32_t value)
{
    unsigned char bytes[4];
    for (int k = 0; k < 4; k++)
        bytes[3 - k] = (unsigned char)(value >> (8 * k) & 255u);
    fwrite(bytes, 1, sizeof bytes, output->file);
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
