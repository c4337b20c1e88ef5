/* Scenes from Wavefront OBJ files.
 *
 * One pass over the lines. Faces are checked against the vertices before them, cut into
 * triangles at once and kept as vertex numbers; the scene is made when all counts are known and
 * the text is gone from memory. Vertices that come after their face are refused: negative
 * indices count back from the line of the face, so a reader that allowed both would give
 * another meaning to some wrong files instead of a message.
 *
 * Repairs are for what does not touch the geometry: a missing library or material gives grey.
 * A wrong index, number or face ends the reading, since what was meant cannot be known.
 *
 * `mtllib` lists names between blanks, but programs also write single names with blanks in
 * them. So the whole rest of the line is tried first, then its words, where a backslash before a
 * blank keeps a word together. A name is tried once, however often it occurs.
 *
 * Cutting a concave face takes a time that is quadratic in its corners; the limit on them keeps
 * one line of a file from taking minutes. */
#include "io/obj.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/polygon.h"
#include "io/mtl.h"
#include "io/text.h"

enum {
    COUNT_MAX = (1 << 30) - 1, /* vertices; triangles, which with their twins fit an int32_t */
    CORNER_MAX = 1 << 14,      /* corners of one face */
    LIBRARY_MAX = 1000         /* names in mtllib lines */
};

struct obj_triangle {
    int32_t vertex[3];
    int32_t material; /* number in the material table */
    int32_t group;    /* number of the group's name */
};

struct obj_reader {
    struct text text;
    struct vec3 *vertices;
    int64_t vertex_count, vertex_capacity;
    struct obj_triangle *triangles;
    int64_t triangle_count, triangle_capacity;
    int32_t *corners;              /* vertex numbers of the present face */
    int64_t corner_count, corner_capacity;
    struct mtl_table materials;    /* the first one is for faces without a material */
    int32_t material;              /* of the next face */
    struct text_names libraries;   /* names that have been tried */
    struct text_names groups;      /* names of groups, also of those without a face */
    int32_t group;                 /* of the next face */
    struct obj_repairs *repairs;
    struct error *error;
};

static const char DEFAULT_GROUP[] = "default";

static void note_missing(struct obj_repairs *repairs, int64_t *counter, const char *name)
{
    ++*counter;
    if (!repairs->first_missing[0])
        snprintf(repairs->first_missing, sizeof repairs->first_missing, "%s", name);
}

static bool read_vertex(struct obj_reader *reader, char *rest)
{
    double value[3];
    for (int i = 0; i < 3; i++) {
        const char *word = text_word(&rest);
        if (!word)
            return error_set(reader->error, EXIT_USAGE,
                             "%s:%ld: vertex has %d coordinates instead of 3",
                             reader->text.path, reader->text.line, i);
        if (!text_number(&reader->text, word, &value[i], reader->error))
            return false;
    }
    if (reader->vertex_count == COUNT_MAX)
        return error_set(reader->error, EXIT_USAGE, "%s:%ld: more than %d vertices",
                         reader->text.path, reader->text.line, COUNT_MAX);
    reader->vertices = alloc_reserve(reader->vertices, &reader->vertex_capacity,
                                     reader->vertex_count + 1, sizeof *reader->vertices);
    reader->vertices[reader->vertex_count++] = (struct vec3){value[0], value[1], value[2]};
    return true;
}

/* A corner is V, V/VT, V//VN or V/VT/VN; the two last numbers only have to be integers. */
static bool parse_corner(const char *word, int64_t *index)
{
    if (!text_integer(&word, index))
        return false;
    for (int i = 0; i < 2 && *word == '/'; i++) {
        int64_t unused;
        word++;
        text_integer(&word, &unused);
    }
    return *word == '\0';
}

static bool read_corner(struct obj_reader *reader, const char *word, int32_t *vertex)
{
    int64_t index;
    if (!parse_corner(word, &index))
        return error_set(reader->error, EXIT_USAGE, "%s:%ld: bad corner '%.40s' of a face",
                         reader->text.path, reader->text.line, word);
    int64_t count = reader->vertex_count;
    int64_t from_start = index > 0 ? index - 1 : count + index; /* index 0 is out of range */
    if (from_start < 0 || from_start >= count) {
        size_t digits = strcspn(word, "/");
        return error_set(reader->error, EXIT_USAGE,
                         "%s:%ld: face refers to vertex %.*s of %" PRId64, reader->text.path,
                         reader->text.line, digits < 40 ? (int)digits : 40, word, count);
    }
    *vertex = (int32_t)from_start;
    return true;
}

static bool read_corners(struct obj_reader *reader, char *rest)
{
    reader->corner_count = 0;
    for (const char *word; (word = text_word(&rest)) != NULL;) {
        if (reader->corner_count == CORNER_MAX)
            return error_set(reader->error, EXIT_USAGE, "%s:%ld: face of more than %d corners",
                             reader->text.path, reader->text.line, CORNER_MAX);
        reader->corners = alloc_reserve(reader->corners, &reader->corner_capacity,
                                        reader->corner_count + 1, sizeof *reader->corners);
        if (!read_corner(reader, word, &reader->corners[reader->corner_count]))
            return false;
        reader->corner_count++;
    }
    if (reader->corner_count < 3)
        return error_set(reader->error, EXIT_USAGE,
                         "%s:%ld: face has %" PRId64 " corners instead of 3 or more",
                         reader->text.path, reader->text.line, reader->corner_count);
    return true;
}

static void add_triangle(struct obj_reader *reader, int32_t a, int32_t b, int32_t c)
{
    const int32_t *corners = reader->corners;
    reader->triangles[reader->triangle_count++] =
        (struct obj_triangle){{corners[a], corners[b], corners[c]}, reader->material,
                              reader->group};
}

static void add_polygon(struct obj_reader *reader)
{
    int32_t count = (int32_t)reader->corner_count;
    struct vec3 *positions = alloc_array((size_t)count, sizeof *positions);
    int32_t *cut = alloc_array(3 * ((size_t)count - 2), sizeof *cut);
    for (int32_t i = 0; i < count; i++)
        positions[i] = reader->vertices[reader->corners[i]];
    polygon_triangulate(positions, count, cut);
    for (int32_t i = 0; i < count - 2; i++)
        add_triangle(reader, cut[3 * i], cut[3 * i + 1], cut[3 * i + 2]);
    alloc_free(positions);
    alloc_free(cut);
}

static bool read_face(struct obj_reader *reader, char *rest)
{
    if (!read_corners(reader, rest))
        return false;
    int64_t needed = reader->triangle_count + reader->corner_count - 2;
    if (needed > COUNT_MAX)
        return error_set(reader->error, EXIT_USAGE, "%s:%ld: more than %d triangles",
                         reader->text.path, reader->text.line, COUNT_MAX);
    reader->triangles = alloc_reserve(reader->triangles, &reader->triangle_capacity, needed,
                                      sizeof *reader->triangles);
    reader->materials.entries[reader->material].used = true;
    if (reader->corner_count == 3)
        add_triangle(reader, 0, 1, 2);
    else
        add_polygon(reader);
    return true;
}

/* The path of a file that the OBJ file names: relative to its folder. The caller frees it. */
static char *path_beside(const char *path, const char *name)
{
    const char *slash = strrchr(path, '/');
    size_t folder = slash && name[0] != '/' ? (size_t)(slash - path) + 1 : 0;
    char *joined = alloc_array(folder + strlen(name) + 1, 1);
    memcpy(joined, path, folder);
    strcpy(joined + folder, name);
    return joined;
}

/* Reads the library `name`, unless it has been tried before. `*missing` says whether this is
 * the first time that it turns out not to exist. */
static bool try_library(struct obj_reader *reader, const char *name, bool *missing)
{
    *missing = false;
    int32_t known = reader->libraries.count;
    if (text_names_add(&reader->libraries, name) < known)
        return true;
    if (known == LIBRARY_MAX)
        return error_set(reader->error, EXIT_USAGE, "%s:%ld: more than %d material libraries",
                         reader->text.path, reader->text.line, LIBRARY_MAX);
    char *path = path_beside(reader->text.path, name);
    bool found;
    bool good = mtl_read(&reader->materials, path, &found, reader->error);
    *missing = !found;
    alloc_free(path);
    return good;
}

/* Cuts the next name off `*rest`; a backslash keeps the blank that follows it. */
static char *next_library(char **rest)
{
    char *name = *rest + strspn(*rest, " \t");
    char *to = name, *from = name;
    while (*from && *from != ' ' && *from != '\t') {
        if (*from == '\\' && from[1] == ' ')
            from++;
        *to++ = *from++;
    }
    *rest = *from ? from + 1 : from;
    *to = '\0';
    return *name ? name : NULL;
}

static bool read_libraries(struct obj_reader *reader, char *rest)
{
    char *whole = text_trim(rest);
    bool missing;
    if (!*whole)
        return true;
    if (!try_library(reader, whole, &missing))
        return false;
    if (!missing)
        return true;
    if (!strpbrk(whole, " \t")) {
        note_missing(reader->repairs, &reader->repairs->missing_libraries, whole);
        return true;
    }
    for (char *name; (name = next_library(&whole)) != NULL;) {
        if (!try_library(reader, name, &missing))
            return false;
        if (missing)
            note_missing(reader->repairs, &reader->repairs->missing_libraries, name);
    }
    return true;
}

static bool read_group(struct obj_reader *reader, char *rest)
{
    const char *name = text_trim(rest);
    reader->group = text_names_add(&reader->groups, *name ? name : DEFAULT_GROUP);
    return true;
}

static bool read_line(struct obj_reader *reader, char *line)
{
    const char *keyword = text_word(&line);
    if (!keyword)
        return true;
    if (strcmp(keyword, "v") == 0)
        return read_vertex(reader, line);
    if (strcmp(keyword, "f") == 0)
        return read_face(reader, line);
    if (strcmp(keyword, "mtllib") == 0)
        return read_libraries(reader, line);
    if (strcmp(keyword, "o") == 0 || strcmp(keyword, "g") == 0)
        return read_group(reader, line);
    if (strcmp(keyword, "usemtl") == 0)
        reader->material = mtl_find(&reader->materials, text_trim(line));
    return true;
}

static bool read_lines(struct obj_reader *reader)
{
    reader->material = mtl_find(&reader->materials, "");
    reader->materials.entries[reader->material].defined = true;
    reader->group = text_names_add(&reader->groups, DEFAULT_GROUP);
    for (char *line; (line = text_line(&reader->text)) != NULL;)
        if (!read_line(reader, line))
            return false;
    if (reader->triangle_count == 0)
        return error_set(reader->error, EXIT_USAGE, "%s: no faces", reader->text.path);
    return true;
}

/* Numbers the used materials of the table, in its order, for the scene. Returns how many. */
static int32_t number_materials(const struct obj_reader *reader, int32_t *number)
{
    int32_t count = 0;
    for (int32_t i = 0; i < reader->materials.names.count; i++) {
        const struct mtl_entry *entry = &reader->materials.entries[i];
        number[i] = count;
        count += entry->used;
        if (entry->used && !entry->defined)
            note_missing(reader->repairs, &reader->repairs->missing_materials,
                         reader->materials.names.name[i]);
    }
    return count;
}

/* Numbers the groups that have faces, in the order of these, and names them in the scene. */
static void make_groups(const struct obj_reader *reader, struct scene *scene)
{
    int32_t known = reader->groups.count, count = 0;
    int32_t *number = alloc_array((size_t)known, sizeof *number); /* from 1; 0: no face yet */
    int32_t *order = alloc_array((size_t)known, sizeof *order);
    size_t bytes = 0;
    for (int32_t i = 0; i < scene->input_count; i++) {
        int32_t group = reader->triangles[i].group;
        if (number[group] == 0) {
            order[count++] = group;
            number[group] = count;
            bytes += strlen(reader->groups.name[group]) + 1;
        }
        scene->group_of[i] = number[group] - 1;
    }
    scene_set_groups(scene, count, (int64_t)bytes);
    char *to = scene->group_names;
    for (int32_t i = 0; i < count; i++) {
        size_t length = strlen(reader->groups.name[order[i]]) + 1;
        memcpy(to, reader->groups.name[order[i]], length);
        to += length;
    }
    alloc_free(number);
    alloc_free(order);
}

static struct scene *make_scene(const struct obj_reader *reader)
{
    int32_t known = reader->materials.names.count;
    int32_t *number = alloc_array((size_t)known, sizeof *number);
    int32_t material_count = number_materials(reader, number);
    struct scene *scene = scene_create((int32_t)reader->triangle_count, material_count);
    for (int32_t i = 0; i < known; i++)
        if (reader->materials.entries[i].used)
            scene->materials[number[i]] = reader->materials.entries[i].material;
    for (int32_t i = 0; i < scene->input_count; i++) {
        const struct obj_triangle *triangle = &reader->triangles[i];
        for (int k = 0; k < 3; k++)
            scene->triangles[i].corner[k] = reader->vertices[triangle->vertex[k]];
        scene->material_of[i] = number[triangle->material];
    }
    make_groups(reader, scene);
    alloc_free(number);
    return scene;
}

struct scene *obj_of_text(struct text *text, struct obj_repairs *repairs, struct error *error)
{
    *repairs = (struct obj_repairs){0};
    struct obj_reader reader = {.text = *text, .repairs = repairs, .error = error};
    bool good = read_lines(&reader);
    text_free(&reader.text);
    struct scene *scene = good ? make_scene(&reader) : NULL;
    alloc_free(reader.vertices);
    alloc_free(reader.triangles);
    alloc_free(reader.corners);
    mtl_free(&reader.materials);
    text_names_free(&reader.libraries);
    text_names_free(&reader.groups);
    return scene;
}

struct scene *obj_read(const char *path, struct obj_repairs *repairs, struct error *error)
{
    struct text text;
    return text_read(&text, path, error) ? obj_of_text(&text, repairs, error) : NULL;
}
