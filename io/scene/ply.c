/* Scenes from PLY files.
 *
 * Faces may come before their vertices. So faces are kept as numbers of corners and
 * become triangles after the last record; their corners are checked at once, against the
 * number of vertices in the header.
 *
 * Colours are taken as linear reflectances. Modellers may mean sRGB, but the format
 * cannot say so; decoding would falsify every mesh made for computing, and 128 would no
 * longer mean one half. Alpha is skipped: surfaces are opaque. */
#include "io/scene/ply.h"

#include <stdio.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/polygon.h"
#include "geom/stop.h"
#include "io/scene/palette.h"
#include "io/scene/text.h"

enum {
    COUNT_MAX = (1 << 30) - 1, /* vertices; triangles: with twins in an int32_t */
    CORNER_MAX = 1 << 14       /* corners of one face: cutting it takes quadratic time */
};

static const struct material NEUTRAL = {.reflectance = {{0.5, 0.5, 0.5}}};

struct face {
    int64_t first;    /* of its corners */
    int32_t count;    /* of its corners */
    int32_t material; /* in the palette */
};

struct reader {
    struct ply_file *file;
    struct vec3 *vertices;
    struct rgb *colours;   /* of the vertices; NULL if faces have colours */
    int64_t vertex_count;  /* as the header declares */
    struct face *faces;    /* of strips too, triangle by triangle */
    int64_t face_count, face_capacity;
    int32_t *corners;      /* of all faces */
    int64_t corner_count, corner_capacity;
    int64_t triangle_count;
    struct palette palette;
    struct error *error;
};

/* True if there is an element with the three properties from `first` on. */
static bool has_three(const struct ply_element *element, enum ply_field first)
{
    return element && element->type_of[first] != PLY_NONE &&
           element->type_of[first + 1] != PLY_NONE &&
           element->type_of[first + 2] != PLY_NONE;
}

/* Returns the first field of the colours of an element, or PLY_FIELDS. */
static enum ply_field colours_of(const struct ply_element *element)
{
    for (int first = PLY_RED; first <= PLY_COLOR_0; first += BANDS)
        if (has_three(element, (enum ply_field)first))
            return (enum ply_field)first;
    return PLY_FIELDS;
}

/* Returns the value of a colour for a reflectance of 1. */
static double unit_of(enum ply_type type)
{
    return type >= PLY_FLOAT                         ? 1.0
           : type == PLY_SHORT || type == PLY_USHORT ? 65535.0
                                                     : 255.0;
}

/* Takes three values of the current record from `first` on; if `scaled`, divided by
 * unit_of(). */
static bool take_rgb(struct reader *reader, const struct ply_element *element,
                     enum ply_field first, bool scaled, struct rgb *colour)
{
    for (int c = 0; c < BANDS; c++) {
        double value = reader->file->value[(int)first + c];
        if (value < 0.0)
            return ply_fail(reader->file, reader->error,
                            "a negative colour or emission");
        colour->band[c] =
            scaled ? value / unit_of(element->type_of[(int)first + c]) : value;
    }
    return true;
}

static bool read_vertices(struct reader *reader, const struct ply_element *element)
{
    const double *value = reader->file->value;
    enum ply_field colours = colours_of(element);
    reader->vertices = alloc_array((size_t)element->count, sizeof *reader->vertices);
    if (colours != PLY_FIELDS &&
        colours_of(ply_file_find(reader->file, PLY_FACE)) == PLY_FIELDS)
        reader->colours = alloc_array((size_t)element->count, sizeof *reader->colours);
    for (int64_t i = 0; i < element->count; i++) {
        if (!ply_file_record(reader->file, element, i, reader->error))
            return false;
        reader->vertices[i] = (struct vec3){value[PLY_X], value[PLY_Y], value[PLY_Z]};
        if (reader->colours &&
            !take_rgb(reader, element, colours, true, &reader->colours[i]))
            return false;
    }
    return true;
}

static bool check_corners(const struct reader *reader, const int32_t *corners,
                          int64_t count)
{
    char text[100] = "";
    if (count < 3 || count > CORNER_MAX)
        snprintf(text, sizeof text, "%lld corners instead of 3 to %d", (long long)count,
                 CORNER_MAX);
    for (int64_t i = 0; i < count && !text[0]; i++)
        if (corners[i] >= reader->vertex_count)
            snprintf(text, sizeof text, "corner %ld, but the last vertex is %lld",
                     (long)corners[i], (long long)reader->vertex_count - 1);
    return !text[0] || ply_fail(reader->file, reader->error, text);
}

static bool add_face(struct reader *reader, const int32_t *corners, int64_t count,
                     const struct material *material)
{
    if (!check_corners(reader, corners, count))
        return false;
    RESERVE(reader->faces, &reader->face_capacity, reader->face_count + 1);
    reader->faces[reader->face_count++] =
        (struct face){reader->corner_count, (int32_t)count,
                      palette_add(&reader->palette, material)};
    RESERVE(reader->corners, &reader->corner_capacity, reader->corner_count + count);
    memcpy(reader->corners + reader->corner_count, corners,
           (size_t)count * sizeof *corners);
    reader->corner_count += count;
    reader->triangle_count += count - 2;
    return reader->triangle_count <= COUNT_MAX ||
           ply_fail(reader->file, reader->error, "too many triangles");
}

static bool take_face(struct reader *reader, const struct ply_element *element)
{
    struct material material = NEUTRAL;
    enum ply_field colours = colours_of(element);
    return (colours == PLY_FIELDS ||
            take_rgb(reader, element, colours, true, &material.reflectance)) &&
           (!has_three(element, PLY_EMISSION_R) ||
            take_rgb(reader, element, PLY_EMISSION_R, false, &material.emission)) &&
           add_face(reader, reader->file->corners, reader->file->corner_count,
                    &material);
}

/* Takes a strip: its third corner and each further one make a triangle with the two
 * before, of which every other one is turned over. */
static bool take_strip(struct reader *reader)
{
    const int32_t *corners = reader->file->corners;
    bool good = true;
    for (int64_t k = 0, first = 0; k < reader->file->corner_count && good; k++) {
        first = corners[k] < 0 ? k + 1 : first;
        if (k < first + 2)
            continue;
        int64_t odd = (k - first) % 2;
        const int32_t triangle[] = {corners[k - 2 + odd], corners[k - 1 - odd],
                                    corners[k]};
        good = add_face(reader, triangle, 3, &NEUTRAL);
    }
    return good;
}

static bool read_faces(struct reader *reader, const struct ply_element *element)
{
    for (int64_t i = 0; i < element->count; i++)
        if (!ply_file_record(reader->file, element, i, reader->error) ||
            !(element->kind == PLY_FACE ? take_face(reader, element)
                                        : take_strip(reader)))
            return false;
    return true;
}

/* True if there is an element of faces or strips with their corners. */
static bool has_corners(const struct ply_element *element)
{
    return element && element->count > 0 &&
           (element->kind == PLY_FACE ? element->type_of[PLY_CORNERS] != PLY_NONE
                                      : element->type_of[PLY_STRIP] != PLY_NONE);
}

static bool check_header(struct reader *reader)
{
    const struct ply_element *vertex = ply_file_find(reader->file, PLY_VERTEX);
    const struct ply_element *face = ply_file_find(reader->file, PLY_FACE);
    const struct ply_element *strips = ply_file_find(reader->file, PLY_STRIPS);
    const char *path = reader->file->binary.path;
    if (!has_three(vertex, PLY_X))
        return error_set(reader->error, EXIT_USAGE, "%s: no vertices with x, y and z",
                         path);
    if (!has_corners(face) && !has_corners(strips))
        return error_set(reader->error, EXIT_USAGE, "%s: no faces with vertex_indices",
                         path);
    reader->vertex_count = vertex->count;
    if (vertex->count > COUNT_MAX || (face && face->count > COUNT_MAX))
        return error_set(reader->error, EXIT_USAGE, "%s: more than %d vertices or faces",
                         path, COUNT_MAX);
    return true;
}

static bool read_file(struct reader *reader)
{
    struct ply_file *file = reader->file;
    bool good = check_header(reader);
    for (int64_t i = 0; good && i < file->header.element_count; i++) {
        const struct ply_element *element = &file->header.elements[i];
        if (element->kind == PLY_VERTEX)
            good = read_vertices(reader, element);
        else if (element->kind <= PLY_STRIPS && has_corners(element))
            good = read_faces(reader, element);
        else
            good = ply_file_skip(file, element, reader->error);
    }
    return good && ply_file_end(file, reader->error);
}

/* Gives the faces the mean colours of their corners, and leaves their emissions. */
static void mix_colours(struct reader *reader)
{
    struct palette mixed = {0};
    for (int64_t i = 0; i < reader->face_count; i++) {
        struct face *face = &reader->faces[i];
        struct material material = reader->palette.materials[face->material];
        struct rgb sum = {{0.0, 0.0, 0.0}};
        for (int32_t k = 0; k < face->count; k++)
            rgb_add(&sum, 1.0, reader->colours[reader->corners[face->first + k]]);
        for (int c = 0; c < BANDS; c++)
            material.reflectance.band[c] = sum.band[c] / face->count;
        face->material = palette_add(&mixed, &material);
    }
    palette_free(&reader->palette);
    reader->palette = mixed;
}

/* Cuts a face into triangles of the scene, from number `at` on. */
static void cut_face(const struct reader *reader, const struct face *face,
                     struct scene *scene, int32_t at)
{
    int32_t triangle[3] = {0, 1, 2}, *cut = triangle;
    struct vec3 *positions = alloc_array((size_t)face->count, sizeof *positions);
    for (int32_t k = 0; k < face->count; k++)
        positions[k] = reader->vertices[reader->corners[face->first + k]];
    if (face->count > 3) {
        cut = alloc_array(3 * ((size_t)face->count - 2), sizeof *cut);
        polygon_triangulate(positions, face->count, cut);
    }
    for (int32_t k = 0; k < 3 * (face->count - 2); k++) {
        scene->triangles[at + k / 3].corner[k % 3] = positions[cut[k]];
        scene->material_of[at + k / 3] = face->material;
        scene->groups.goes_on[at + k / 3] = k > 2;
    }
    alloc_free(positions);
    if (cut != triangle)
        alloc_free(cut);
}

/* Returns NULL if the program is asked to stop. */
static struct scene *make_scene(const struct reader *reader)
{
    struct scene *scene =
        scene_create((int32_t)reader->triangle_count, reader->palette.count);
    memcpy(scene->materials, reader->palette.materials,
           (size_t)reader->palette.count * sizeof *scene->materials);
    int32_t at = 0;
    for (int64_t i = 0; i < reader->face_count; i++) {
        if (!stop_check(reader->error)) {
            scene_destroy(scene);
            return NULL;
        }
        cut_face(reader, &reader->faces[i], scene, at);
        at += reader->faces[i].count - 2;
    }
    return scene;
}

struct scene *ply_of_file(struct ply_file *file, struct error *error)
{
    struct reader reader = {.file = file, .error = error};
    bool good = read_file(&reader);
    if (good && reader.colours)
        mix_colours(&reader);
    struct scene *scene = good ? make_scene(&reader) : NULL;
    alloc_free(reader.vertices);
    alloc_free(reader.colours);
    alloc_free(reader.faces);
    alloc_free(reader.corners);
    palette_free(&reader.palette);
    return scene;
}

bool ply_is_meant(const struct source *source)
{
    const char *path = source->path, *start = source->start;
    if (text_ends_with(path, ".ply") || text_ends_with(path, ".obj"))
        return text_ends_with(path, ".ply");
    return strcmp(start, "ply\n") == 0 || strcmp(start, "ply\r") == 0;
}
