/* The place behind a path.
 *
 * Paths are compared by device and inode of their files: neither "./m.ply" nor a link
 * hides a scene. Where there is no file yet, the folder, compared so, and the last name
 * are the place. Without POSIX the spelling is all there is. */
#if defined(__unix__) || defined(__APPLE__)
#define _XOPEN_SOURCE 700
#include <sys/stat.h>
#include <unistd.h>
#define HAVE_POSIX 1
#endif

#include "io/run/place.h"

#include <errno.h>
#include <limits.h>
#include <stdint.h>
#include <string.h>

#include "geom/alloc.h"
#include "io/scene/text.h"

char *place_folder(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *folder = alloc_string(slash ? path : ".");
    if (slash)
        folder[slash > path ? slash - path : 1] = '\0';
    return folder;
}

bool place_is_stdout(const char *path)
{
    char *place = place_follow(path);
    bool is_stdout = place && place_descriptor(place) == 1;
    alloc_free(place);
    return is_stdout;
}

#ifdef HAVE_POSIX

int place_descriptor(const char *path)
{
    static const char *const FOLDERS[] = {"/dev/fd/", "/proc/self/fd/"};
    if (strcmp(path, "-") == 0 || strcmp(path, "/dev/stdout") == 0)
        return STDOUT_FILENO;
    if (strcmp(path, "/dev/stderr") == 0)
        return STDERR_FILENO;
    for (size_t i = 0; i < sizeof FOLDERS / sizeof FOLDERS[0]; i++) {
        size_t length = strlen(FOLDERS[i]);
        const char *at = path + length;
        int64_t number;
        if (strncmp(path, FOLDERS[i], length) == 0 && text_integer(&at, &number) &&
            *at == '\0' && number >= 0 && number <= INT_MAX)
            return (int)number;
    }
    return -1;
}

char *place_follow(const char *path)
{
    enum { LINKS_MAX = 40, ROOM = 4096 };
    char *at = alloc_string(path), link[ROOM];
    for (int n = 0; n < LINKS_MAX; n++) {
        ssize_t length = place_descriptor(at) < 0 ? readlink(at, link, ROOM - 1) : -1;
        if (length < 0)
            return at;
        link[length] = '\0';
        char *next = text_path_beside(at, link);
        alloc_free(at);
        at = next;
    }
    alloc_free(at);
    errno = ELOOP;
    return NULL;
}

/* Fills the status of the file or descriptor of an output. False if there is none. */
static bool find(const char *output, struct stat *status)
{
    int descriptor = place_descriptor(output);
    return (descriptor >= 0 ? fstat(descriptor, status) : stat(output, status)) == 0;
}

static bool are_one(const struct stat *a, const struct stat *b)
{
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino && !S_ISCHR(a->st_mode);
}

/* True if two paths, behind all links, are the same name in the same folder. */
static bool are_one_entry(const char *a, const char *b)
{
    const char *slash_a = strrchr(a, '/'), *slash_b = strrchr(b, '/');
    char *folder_a = place_folder(a), *folder_b = place_folder(b);
    struct stat status_a, status_b;
    bool same = strcmp(slash_a ? slash_a + 1 : a, slash_b ? slash_b + 1 : b) == 0 &&
                find(folder_a, &status_a) && find(folder_b, &status_b) &&
                are_one(&status_a, &status_b);
    alloc_free(folder_a);
    alloc_free(folder_b);
    return same;
}

bool place_is_read(const char *output, const char *input)
{
    struct stat written, read;
    return find(output, &written) && stat(input, &read) == 0 && are_one(&written, &read);
}

bool place_is_written(const char *output, const char *other)
{
    struct stat a, b;
    bool exist = find(output, &a) && find(other, &b);
    if (exist && (!are_one(&a, &b) || !S_ISREG(a.st_mode) || a.st_nlink < 2))
        return are_one(&a, &b);
    char *first = place_follow(output), *second = place_follow(other);
    bool same = first && second && are_one_entry(first, second);
    alloc_free(first);
    alloc_free(second);
    return same;
}

#else

int place_descriptor(const char *path)
{
    (void)path;
    return -1;
}

char *place_follow(const char *path)
{
    return alloc_string(path);
}

bool place_is_read(const char *output, const char *input)
{
    return strcmp(output, input) == 0;
}

bool place_is_written(const char *output, const char *other)
{
    return strcmp(output, other) == 0;
}

#endif
