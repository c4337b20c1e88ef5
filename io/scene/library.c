/* Material libraries by name.
 *
 * `mtllib` lists names between blanks, but programs also write names with blanks in them.
 * So the whole rest of the line is tried first. Then it is cut into names from its
 * beginning: a name is as many words as there is a file of, or else one word. A backslash
 * before a blank keeps a word together. A name is tried once, however often named.
 *
 * Programs also write folders of their own machine, with either slash. Where such a file
 * does not exist, the file of the same last name beside the OBJ file is taken. If only
 * the folders have blanks, the line may as well be a list, and its words are tried.
 *
 * A scene may come from anybody, so a pipe or a device, for which phr would wait for
 * ever, is no library. */
#if defined(__unix__) || defined(__APPLE__)
#define _XOPEN_SOURCE 700
#include <sys/stat.h>
#endif

#include "io/scene/library.h"

#include <stdio.h>
#include <string.h>

#include "geom/alloc.h"

enum {
    LIBRARY_MAX = 1000, /* names in mtllib lines */
    WORDS_MOST = 16     /* words of a name in a list */
};

struct lookup {
    struct mtl_table *table;
    struct text_names *tried, *files;
    const struct text *obj;
    struct error *error;
};

/* The part of a path behind its last slash or backslash; may be empty. */
static const char *last_part(const char *name)
{
    const char *part = name;
    for (const char *at = name; *at; at++)
        if (*at == '/' || *at == '\\')
            part = at + 1;
    return part;
}

/* A descriptor already open has no folder but the current one. */
static bool is_descriptor(const char *path)
{
    return strcmp(path, "/dev/stdin") == 0 || strncmp(path, "/dev/fd/", 8) == 0;
}

/* True if the path leads to a file, a folder or nowhere. */
static bool is_harmless(const char *path)
{
#ifdef S_ISREG
    struct stat status;
    return stat(path, &status) != 0 || S_ISREG(status.st_mode) || S_ISDIR(status.st_mode);
#else
    return *path != '\0';
#endif
}

/* Turns backslashes into slashes, but for those before a blank. */
static void turn_slashes(char *name)
{
    for (char *at = name; *at; at++)
        *at = *at == '\\' && at[1] != ' ' ? '/' : *at;
}

static bool read_file(const struct lookup *lookup, const char *name, bool *found)
{
    const char *beside = lookup->obj->path;
    char *path = text_path_beside(is_descriptor(beside) ? "" : beside, name);
    *found = false;
    bool good = is_harmless(path)
                    ? mtl_read(lookup->table, path, found, lookup->error)
                    : error_set(lookup->error, EXIT_USAGE, "%s:%ld: %s is not a file",
                                beside, lookup->obj->line, path);
    if (*found && lookup->files)
        text_names_add(lookup->files, path);
    alloc_free(path);
    return good;
}

/* Reads the library `name`, unless tried before. Sets `*missing` if the file does not
 * exist and was not tried before. */
static bool try_name(const struct lookup *lookup, const char *name, bool *missing)
{
    *missing = false;
    int32_t known = lookup->tried->count;
    if (text_names_add(lookup->tried, name) < known)
        return true;
    if (known == LIBRARY_MAX)
        return error_set(lookup->error, EXIT_USAGE,
                         "%s:%ld: more than %d material libraries", lookup->obj->path,
                         lookup->obj->line, LIBRARY_MAX);
    bool found;
    const char *part = last_part(name);
    bool good = read_file(lookup, name, &found);
    bool is_one_name = !strpbrk(name, " \t") == !strpbrk(part, " \t");
    if (good && !found && strchr(name, '\\')) {
        char *turned = alloc_string(name);
        turn_slashes(turned);
        good = read_file(lookup, turned, &found);
        alloc_free(turned);
    }
    if (good && !found && part != name && *part && is_one_name)
        good = read_file(lookup, part, &found);
    *missing = !found;
    return good;
}

/* True if there is a file beside the OBJ file with the name from `name` to `end`. */
static bool exists(const struct lookup *lookup, const char *name, const char *end)
{
    const char *beside = lookup->obj->path;
    char *copy = alloc_array((size_t)(end - name) + 1, 1);
    memcpy(copy, name, (size_t)(end - name));
    turn_slashes(copy);
    char *path = text_path_beside(is_descriptor(beside) ? "" : beside, copy);
    FILE *file = is_harmless(path) ? fopen(path, "rb") : NULL;
    bool good = file && (fgetc(file) != EOF || !ferror(file)); /* not a folder */
    if (file)
        fclose(file);
    alloc_free(path);
    alloc_free(copy);
    return good;
}

/* Returns the end of the word at `at`; a backslash keeps the blank behind it. */
static char *word_end(char *at)
{
    while (*at && *at != ' ' && *at != '\t')
        at += *at == '\\' && at[1] == ' ' ? 2 : 1;
    return at;
}

/* Cuts the next name off `*rest`. */
static char *next_name(const struct lookup *lookup, char **rest)
{
    char *name = *rest + strspn(*rest, " \t"), *end = word_end(name), *to = name;
    char *longer = end;
    for (int words = 1; words < WORDS_MOST && *longer; words++) {
        longer = word_end(longer + strspn(longer, " \t"));
        end = exists(lookup, name, longer) ? longer : end;
    }
    *rest = *end ? end + 1 : end;
    for (char *from = name; from < end; from++) {
        from += *from == '\\' && from[1] == ' ';
        *to++ = *from;
    }
    *to = '\0';
    return *name ? name : NULL;
}

bool library_read(struct mtl_table *table, struct text_names *tried,
                  const struct text *obj, char *rest, struct text_missing *lost,
                  struct text_names *files, struct error *error)
{
    struct lookup lookup = {table, tried, files, obj, error};
    char *whole = text_trim(rest);
    bool missing;
    if (!*whole)
        return true;
    if (!try_name(&lookup, whole, &missing))
        return false;
    bool is_list = strpbrk(whole, " \t") != NULL;
    if (missing && !is_list)
        text_missing_add(lost, whole);
    if (!missing || !is_list)
        return true;
    for (char *name; (name = next_name(&lookup, &whole)) != NULL;) {
        if (!try_name(&lookup, name, &missing))
            return false;
        if (missing)
            text_missing_add(lost, name);
    }
    return true;
}
