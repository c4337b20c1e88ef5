/* Scenes from STL files.
 *
 * A binary file has 80 bytes of anything, the number of its faces, and 50 bytes for each:
 * its size tells it from text, which its first bytes do not, as some programs begin them
 * with "solid", too. In text only the words solid and vertex count; others of the format
 * stand between them for nothing, but the third vertex ends a face. */
#include "io/scene/stl.h"

#include <stdio.h>
#include <string.h>

#include "geom/alloc.h"
#include "io/scene/binary.h"
#include "io/scene/text.h"

enum { HEAD = 84, FACE = 50, FACES_MOST = (1 << 30) - 1 };

struct stl_reader {
    struct triangle *triangles; /* [count] */
    int32_t *group;             /* [count] number of the name */
    int64_t count, capacity, group_capacity;
    struct text_names names;    /* of solids */
    int64_t solids;             /* so far */
    struct vec3 corner[3];      /* [corners] of the face at hand */
    int corners;
    struct error *error;
};

bool stl_is_meant(const struct source *source)
{
    return text_ends_with(source->path, ".stl");
}

static bool add_face(struct stl_reader *reader, int32_t group, const char *path)
{
    if (reader->count == FACES_MOST)
        return error_set(reader->error, EXIT_USAGE, "%s: too many faces", path);
    RESERVE(reader->triangles, &reader->capacity, reader->count + 1);
    RESERVE(reader->group, &reader->group_capacity, reader->count + 1);
    for (int k = 0; k < 3; k++)
        reader->triangles[reader->count].corner[k] = reader->corner[k];
    reader->group[reader->count++] = group;
    reader->corners = 0;
    return true;
}

/* --- binary --- */

static bool is_binary(const struct binary *file)
{
    return file->size >= HEAD &&
           (uint64_t)(file->size - HEAD) ==
               FACE * binary_integer(file->data + HEAD - 4, 4, false);
}

static bool read_binary(struct stl_reader *reader, const struct binary *file)
{
    int32_t group = text_names_add(&reader->names, "default");
    for (int64_t at = HEAD; at < file->size; at += FACE) {
        for (int k = 0; k < 9; k++) {
            double x = (double)binary_float(file->data + at + 4 * (k + 3), false);
            if (!(x >= -TEXT_NUMBER_MAX && x <= TEXT_NUMBER_MAX))
                return error_set(reader->error, EXIT_USAGE,
                                 "%s: face %lld: a coordinate is not finite", file->path,
                                 (long long)reader->count);
            struct vec3 *corner = &reader->corner[k / 3];
            *(k % 3 == 0 ? &corner->x : k % 3 == 1 ? &corner->y : &corner->z) = x;
        }
        if (!add_face(reader, group, file->path))
            return false;
    }
    return true;
}

/* --- text --- */

static bool read_vertex(struct stl_reader *reader, const struct text *text, char *rest)
{
    double x[3];
    for (int k = 0; k < 3; k++) {
        const char *word = text_word(&rest);
        if (!word)
            return error_set(reader->error, EXIT_USAGE,
                             "%s:%ld: vertex has %d coordinates instead of 3", text->path,
                             text->line, k);
        if (!text_number(text, word, &x[k], reader->error))
            return false;
    }
    if (reader->corners == 3)
        return error_set(reader->error, EXIT_USAGE, "%s:%ld: a face of four corners",
                         text->path, text->line);
    reader->corner[reader->corners++] = (struct vec3){x[0], x[1], x[2]};
    return true;
}

static bool read_line(struct stl_reader *reader, const struct text *text, char *rest,
                      int32_t *group)
{
    static const char *const PASSED[] = {"facet", "outer", "endloop", "endsolid", NULL};
    const char *word = text_word(&rest);
    if (!word)
        return true;
    if (strcmp(word, "solid") == 0) {
        const char *name = text_trim(rest);
        char own[32];
        snprintf(own, sizeof own, "solid %lld", (long long)++reader->solids);
        *group = text_names_add(&reader->names, *name ? name : own);
        return true;
    }
    if (strcmp(word, "vertex") == 0)
        return read_vertex(reader, text, rest);
    if (strcmp(word, "endfacet") == 0)
        return reader->corners == 3
                   ? add_face(reader, *group, text->path)
                   : error_set(reader->error, EXIT_USAGE, "%s:%ld: a face of %d corners",
                               text->path, text->line, reader->corners);
    for (int k = 0; PASSED[k]; k++)
        if (strcmp(word, PASSED[k]) == 0)
            return true;
    return error_set(reader->error, EXIT_USAGE, "%s:%ld: '%.40s' is no word of STL",
                     text->path, text->line, word);
}

static bool read_text(struct stl_reader *reader, const struct binary *file)
{
    struct text text = {.path = file->path, .bytes = file->data, .size = file->size,
                        .next_line = 1};
    int32_t group = -1;
    if (memchr(file->data, '\0', (size_t)file->size))
        return error_set(reader->error, EXIT_USAGE,
                         "%s: not an STL file: no text, and %lld bytes, which do not fit "
                         "its number of faces", file->path, (long long)file->size);
    for (char *line; (line = text_line(&text)) != NULL;) {
        if (!read_line(reader, &text, line, &group))
            return false;
        if (group < 0)
            return error_set(reader->error, EXIT_USAGE, "%s: not an STL file: %s",
                             file->path, "no solid comes first, nor does its size fit");
    }
    return true;
}

/* --- the scene --- */

static struct scene *make_scene(const struct stl_reader *reader)
{
    struct scene *scene = scene_create((int32_t)reader->count, 1);
    int32_t *number = alloc_array((size_t)reader->names.count, sizeof *number);
    size_t bytes = 0;
    int32_t groups = 0;
    scene->materials[0] = (struct material){.reflectance = {{0.5, 0.5, 0.5}}};
    for (int32_t i = 0; i < scene->input_count; i++) {
        int32_t group = reader->group[i];
        scene->triangles[i] = reader->triangles[i];
        if (number[group] == 0) {
            number[group] = ++groups;
            bytes += strlen(reader->names.name[group]) + 1;
        }
        scene->groups.of[i] = number[group] - 1;
    }
    scene_set_groups(scene, groups, (int64_t)bytes);
    char *to = scene->groups.names;
    for (int32_t i = 0, next = 0; i < scene->input_count; i++)
        if (scene->groups.of[i] == next) {
            const char *name = reader->names.name[reader->group[i]];
            memcpy(to, name, strlen(name) + 1);
            to += strlen(name) + 1;
            next++;
        }
    alloc_free(number);
    return scene;
}

struct scene *stl_of_source(struct source *source, struct error *error)
{
    struct stl_reader reader = {.error = error};
    struct binary file;
    if (!binary_read(&file, source, "", "an STL file", error))
        return NULL;
    bool good =
        is_binary(&file) ? read_binary(&reader, &file) : read_text(&reader, &file);
    if (good && reader.count == 0)
        good = error_set(error, EXIT_USAGE, "%s: no faces", source->path);
    struct scene *scene = good ? make_scene(&reader) : NULL;
    binary_free(&file);
    alloc_free(reader.triangles);
    alloc_free(reader.group);
    text_names_free(&reader.names);
    return scene;
}
