/* Scenes from Wavefront OBJ files.
 *
 * The lines are read in one pass. A face is checked against the vertices before it, cut
 * into triangles at once and kept as vertex numbers; the scene is made when all counts
 * are known and the text is freed. A vertex after its face is refused: negative indices
 * count back from the line of the face, so a reader that allowed both would misread some
 * wrong files without a message.
 *
 * Materials are repaired: a missing library or material gives grey. Geometry is not: a
 * wrong index, number or face ends the reading, since its meaning cannot be guessed.
 * Normals change pictures alone: a missing one, or one of length 0, leaves the corner
 * without a normal.
 *
 * Cutting a concave face takes time quadratic in its corners; their limit keeps one line
 * of a file from taking minutes. */
#include "io/scene/obj.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/polygon.h"
#include "geom/stop.h"
#include "io/scene/library.h"
#include "io/scene/palette.h"

enum {
    COUNT_MAX = (1 << 30) - 1, /* vertices; triangles: with twins in an int32_t */
    CORNER_MAX = 1 << 14       /* corners of one face */
};

struct obj_corner {
    int32_t vertex;
    int32_t normal; /* negative: none */
    int32_t place;  /* texture coordinates; negative: none */
};

struct obj_corners {
    struct obj_corner *at; /* [count] */
    int64_t count, capacity;
};

struct obj_triangle {
    struct obj_corner corner[3];
    int32_t material; /* number in the material table */
    int32_t group;    /* number of the group's name */
    int32_t colour;   /* number of the mean colour of the face's corners, or -1 */
    bool goes_on;     /* of the same face as the one before */
};

/* The vectors of all v lines, the colours behind them, or those of all vn lines. */
struct obj_vectors {
    struct vec3 *at; /* [count] */
    int64_t count, capacity;
};

struct obj_colours {
    struct obj_vectors vertices; /* of those up to the last with one */
    struct palette faces;        /* as reflectances */
};

struct obj_triangles {
    struct obj_triangle *at; /* [count] */
    int64_t count, capacity;
};

struct obj_reader {
    struct text text;
    struct obj_vectors vertices;
    struct obj_colours colours;
    struct obj_vectors normals;    /* of length 1, or 0 where the line has no direction */
    struct obj_vectors places;     /* texture coordinates of all vt lines */
    bool has_normals;              /* a face has a normal with a direction */
    struct obj_triangles triangles;
    struct obj_corners corners;    /* of the current face */
    struct mtl_table materials;    /* NO_MATERIAL, NAMELESS, those with names */
    int32_t material;              /* of the next face */
    struct text_names libraries;   /* names tried by library_read() */
    struct text_names groups;      /* names of groups, also of those without a face */
    int32_t group;                 /* of the next face */
    struct obj_repairs *repairs;
    struct error *error;
};

/* A shorter normal counts as 0: its square may have lost digits. */
static const double DIRECTION_MIN = 1e-100;

/* The colour of a vertex without one. */
static const struct vec3 COLOURLESS = {-1.0, -1.0, -1.0};

static const char DEFAULT_GROUP[] = "default";

/* The first materials: of faces before any usemtl, and behind one without a name. If no
 * newmtl lacks its name, the second is the first. */
enum { NO_MATERIAL, NAMELESS };

static void vectors_add(struct obj_vectors *vectors, struct vec3 vector)
{
    RESERVE(vectors->at, &vectors->capacity, vectors->count + 1);
    vectors->at[vectors->count++] = vector;
}

/* Counts the line as passed over, in whole or in part. */
static bool pass_over(struct obj_reader *reader)
{
    if (reader->repairs->unknown_lines++ == 0)
        reader->repairs->first_unknown = reader->text.line;
    return true;
}

/* Takes the numbers behind the coordinates of the last vertex: three are its colour, and
 * one is a weight, which polygons have no use for. */
static bool take_colour(struct obj_reader *reader, char *rest)
{
    double value[3];
    int count = 0, words = 0;
    for (const char *word; words < 4 && (word = text_word(&rest)) != NULL; words++)
        count += words < 3 && text_is_number(word, &value[words]) &&
                 value[words] >= 0.0 && value[words] <= TEXT_NUMBER_MAX;
    if (words != 3 || count != 3)
        return words < 2 || pass_over(reader);
    while (reader->colours.vertices.count < reader->vertices.count - 1)
        vectors_add(&reader->colours.vertices, COLOURLESS);
    vectors_add(&reader->colours.vertices, (struct vec3){value[0], value[1], value[2]});
    return true;
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
    if (reader->vertices.count == COUNT_MAX)
        return error_set(reader->error, EXIT_USAGE, "%s:%ld: more than %d vertices",
                         reader->text.path, reader->text.line, COUNT_MAX);
    vectors_add(&reader->vertices, (struct vec3){value[0], value[1], value[2]});
    return take_colour(reader, rest);
}

/* Returns the direction of three numbers, of length 1, or 0 without any. */
static struct vec3 parse_direction(char *rest)
{
    double value[3];
    for (int i = 0; i < 3; i++) {
        const char *word = text_word(&rest);
        if (!word || !text_is_number(word, &value[i]) || fabs(value[i]) > TEXT_NUMBER_MAX)
            return (struct vec3){0.0, 0.0, 0.0};
    }
    struct vec3 x = {value[0], value[1], value[2]};
    double length = vec3_length(x);
    return length > DIRECTION_MIN ? vec3_scale(x, 1.0 / length)
                                  : (struct vec3){0.0, 0.0, 0.0};
}

static bool read_normal(struct obj_reader *reader, char *rest)
{
    if (reader->normals.count == COUNT_MAX)
        return error_set(reader->error, EXIT_USAGE, "%s:%ld: more than %d normals",
                         reader->text.path, reader->text.line, COUNT_MAX);
    vectors_add(&reader->normals, parse_direction(rest));
    return true;
}

/* Reads the numbers of texture coordinates; 0 without. */
static bool read_place(struct obj_reader *reader, char *rest)
{
    double value[2] = {0.0, 0.0};
    for (int i = 0; i < 2; i++) {
        const char *word = text_word(&rest);
        if (!word || !text_is_number(word, &value[i]) || fabs(value[i]) > TEXT_NUMBER_MAX)
            value[i] = 0.0;
    }
    if (reader->places.count < COUNT_MAX)
        vectors_add(&reader->places, (struct vec3){value[0], value[1], 0.0});
    return true;
}

/* Reads a corner: V, V/VT, V//VN or V/VT/VN. A missing VT is 0. */
static bool parse_corner(const char *word, int64_t *vertex, int64_t *place,
                         int64_t *normal, bool *has_normal)
{
    *has_normal = false;
    if (!text_integer(&word, vertex))
        return false;
    if (*word == '/') {
        word++;
        text_integer(&word, place);
    }
    if (*word == '/') {
        word++;
        *has_normal = text_integer(&word, normal);
    }
    return *word == '\0';
}

/* Returns the place in a list of `count` meant by an index of this line, or a negative
 * number. Index 0 would be the place behind the last. */
static int32_t find_place(int64_t index, int64_t count)
{
    int64_t place = index > 0 ? index - 1 : count + index;
    return place >= 0 && place < count ? (int32_t)place : -1;
}

static int32_t find_normal(struct obj_reader *reader, int64_t index)
{
    int32_t normal = find_place(index, reader->normals.count);
    const struct vec3 *n = reader->normals.at;
    if (normal < 0 || vec3_dot(n[normal], n[normal]) == 0.0) {
        reader->repairs->bad_normals++;
        return -1;
    }
    reader->has_normals = true;
    return normal;
}

static bool read_corner(struct obj_reader *reader, const char *word,
                        struct obj_corner *corner)
{
    int64_t vertex, place = 0, normal = 0;
    bool has_normal;
    if (!parse_corner(word, &vertex, &place, &normal, &has_normal))
        return error_set(reader->error, EXIT_USAGE,
                         "%s:%ld: bad corner '%.40s' of a face", reader->text.path,
                         reader->text.line, word);
    corner->vertex = find_place(vertex, reader->vertices.count);
    if (corner->vertex < 0) {
        size_t digits = strcspn(word, "/");
        return error_set(reader->error, EXIT_USAGE,
                         "%s:%ld: face refers to vertex %.*s of %" PRId64,
                         reader->text.path, reader->text.line,
                         digits < 40 ? (int)digits : 40, word, reader->vertices.count);
    }
    corner->normal = has_normal ? find_normal(reader, normal) : -1;
    corner->place = place != 0 ? find_place(place, reader->places.count) : -1;
    return true;
}

static bool read_corners(struct obj_reader *reader, char *rest)
{
    reader->corners.count = 0;
    for (const char *word; (word = text_word(&rest)) != NULL;) {
        if (reader->corners.count == CORNER_MAX)
            return error_set(reader->error, EXIT_USAGE,
                             "%s:%ld: face of more than %d corners", reader->text.path,
                             reader->text.line, CORNER_MAX);
        RESERVE(reader->corners.at, &reader->corners.capacity, reader->corners.count + 1);
        if (!read_corner(reader, word, &reader->corners.at[reader->corners.count]))
            return false;
        reader->corners.count++;
    }
    if (reader->corners.count < 3)
        return error_set(reader->error, EXIT_USAGE,
                         "%s:%ld: face has %" PRId64 " corners instead of 3 or more",
                         reader->text.path, reader->text.line, reader->corners.count);
    return true;
}

/* Returns the number of the mean colour of the face's corners; -1 if one has none. */
static int32_t find_colour(struct obj_reader *reader)
{
    const struct obj_vectors *colours = &reader->colours.vertices;
    struct vec3 sum = {0.0, 0.0, 0.0};
    for (int64_t i = 0; i < reader->corners.count; i++) {
        int32_t vertex = reader->corners.at[i].vertex;
        if (vertex >= colours->count || colours->at[vertex].x < 0.0)
            return -1;
        sum = vec3_add(sum, colours->at[vertex]);
    }
    double count = (double)reader->corners.count;
    const struct material mean = {
        .reflectance = {{sum.x / count, sum.y / count, sum.z / count}}};
    return palette_add(&reader->colours.faces, &mean);
}

/* Adds the triangle between three corners of the face; `cut` are their numbers. */
static void add_triangle(struct obj_reader *reader, const int32_t cut[3], int32_t colour,
                         bool goes_on)
{
    const struct obj_corner *corners = reader->corners.at;
    reader->triangles.at[reader->triangles.count++] =
        (struct obj_triangle){{corners[cut[0]], corners[cut[1]], corners[cut[2]]},
                              reader->material, reader->group, colour, goes_on};
}

static void add_polygon(struct obj_reader *reader, int32_t colour)
{
    int32_t count = (int32_t)reader->corners.count;
    struct vec3 *positions = alloc_array((size_t)count, sizeof *positions);
    int32_t *cut = alloc_array(3 * ((size_t)count - 2), sizeof *cut);
    for (int32_t i = 0; i < count; i++)
        positions[i] = reader->vertices.at[reader->corners.at[i].vertex];
    polygon_triangulate(positions, count, cut);
    for (int32_t i = 0; i < count - 2; i++)
        add_triangle(reader, &cut[3 * i], colour, i > 0);
    alloc_free(positions);
    alloc_free(cut);
}

static bool read_face(struct obj_reader *reader, char *rest)
{
    if (!read_corners(reader, rest))
        return false;
    int64_t needed = reader->triangles.count + reader->corners.count - 2;
    if (needed > COUNT_MAX)
        return error_set(reader->error, EXIT_USAGE, "%s:%ld: more than %d triangles",
                         reader->text.path, reader->text.line, COUNT_MAX);
    struct obj_triangles *triangles = &reader->triangles;
    RESERVE(triangles->at, &triangles->capacity, needed);
    reader->materials.entries[reader->material].used = true;
    int32_t colour = find_colour(reader);
    if (reader->corners.count == 3)
        add_triangle(reader, (const int32_t[]){0, 1, 2}, colour, false);
    else
        add_polygon(reader, colour);
    return true;
}

static bool read_group(struct obj_reader *reader, char *rest)
{
    const char *name = text_trim(rest);
    reader->group = text_names_add(&reader->groups, *name ? name : DEFAULT_GROUP);
    return true;
}

/* True if the statement concerns neither triangles nor their colours. Smoothing is lost
 * without normals: then faces look flat. */
static bool is_harmless(const struct obj_reader *reader, const char *keyword, char *rest)
{
    static const char *const words[] = {"l", "p", "vp", "vw", "mg", "lod"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (strcmp(keyword, words[i]) == 0)
            return true;
    const char *value = strcmp(keyword, "s") == 0 ? text_trim(rest) : NULL;
    return value && (reader->normals.count > 0 || strcmp(value, "off") == 0 ||
                     strcmp(value, "0") == 0);
}

static bool read_line(struct obj_reader *reader, char *line)
{
    const char *keyword = text_word(&line);
    if (!keyword)
        return true;
    if (strcmp(keyword, "v") == 0)
        return read_vertex(reader, line);
    if (strcmp(keyword, "vn") == 0)
        return read_normal(reader, line);
    if (strcmp(keyword, "vt") == 0)
        return read_place(reader, line);
    if (strcmp(keyword, "f") == 0)
        return read_face(reader, line);
    if (strcmp(keyword, "mtllib") == 0)
        return library_read(&reader->materials, &reader->libraries, &reader->text, line,
                            &reader->repairs->libraries, reader->repairs->files,
                            reader->error);
    if (strcmp(keyword, "o") == 0 || strcmp(keyword, "g") == 0)
        return read_group(reader, line);
    if (strcmp(keyword, "usemtl") == 0)
        reader->material = mtl_find(&reader->materials, text_trim(line));
    else if (!is_harmless(reader, keyword, line))
        return pass_over(reader);
    return true;
}

static bool read_lines(struct obj_reader *reader)
{
    reader->material = mtl_find(&reader->materials, "\n"); /* no line has this name */
    reader->materials.entries[NO_MATERIAL].defined = true;
    mtl_find(&reader->materials, "");
    reader->group = text_names_add(&reader->groups, DEFAULT_GROUP);
    for (char *line; (line = text_line(&reader->text)) != NULL;)
        if (!stop_check(reader->error) || !read_line(reader, line))
            return false;
    if (reader->triangles.count == 0)
        return error_set(reader->error, EXIT_USAGE, "%s: no faces", reader->text.path);
    return true;
}

/* Finds a defined material with a name like the first one without a definition. */
static void find_meant(const struct mtl_table *materials, struct obj_repairs *repairs)
{
    struct text_missing *missing = &repairs->materials;
    for (int32_t i = 0; i < materials->names.count && !*missing->like; i++)
        if (materials->entries[i].defined &&
            text_is_like(missing->first, materials->names.name[i]))
            snprintf(missing->like, sizeof missing->like, "%s",
                     materials->names.name[i]);
}

/* Numbers the used materials of the table in its order. Returns their number. */
static int32_t number_materials(const struct obj_reader *reader, int32_t *number)
{
    struct obj_repairs *repairs = reader->repairs;
    struct mtl_entry *entries = reader->materials.entries;
    int32_t count = 0;
    repairs->nameless = reader->materials.nameless;
    repairs->passed_count = reader->materials.passed.count;
    text_names_list(&reader->materials.passed, repairs->passed, sizeof repairs->passed);
    if (!entries[NAMELESS].defined) {
        entries[NO_MATERIAL].used = entries[NO_MATERIAL].used || entries[NAMELESS].used;
        entries[NAMELESS].used = false;
    }
    for (int32_t i = 0; i < reader->materials.names.count; i++) {
        const struct mtl_entry *entry = &entries[i];
        number[i] = count;
        count += entry->used;
        if (entry->used && repairs->names)
            text_names_add(repairs->names, i > NO_MATERIAL
                               ? reader->materials.names.name[i] : "(none)");
        if (entry->used && !entry->defined) {
            text_missing_add(&repairs->materials, reader->materials.names.name[i]);
            if (repairs->materials.count == 1)
                find_meant(&reader->materials, repairs);
        }
        repairs->textured += entry->used && (entry->maps[0] || entry->maps[1]);
        repairs->unread += entry->used && entry->unread;
    }
    if (!entries[NAMELESS].defined)
        number[NAMELESS] = number[NO_MATERIAL];
    return count;
}

/* Numbers the groups with faces, by their first faces, and names the groups in the
 * scene. */
static void make_groups(const struct obj_reader *reader, struct scene *scene)
{
    int32_t known = reader->groups.count, count = 0;
    int32_t *number = alloc_array((size_t)known, sizeof *number); /* from 1; 0: no face */
    int32_t *order = alloc_array((size_t)known, sizeof *order);
    size_t bytes = 0;
    for (int32_t i = 0; i < scene->input_count; i++) {
        int32_t group = reader->triangles.at[i].group;
        if (number[group] == 0) {
            order[count++] = group;
            number[group] = count;
            bytes += strlen(reader->groups.name[group]) + 1;
        }
        scene->groups.of[i] = number[group] - 1;
    }
    scene_set_groups(scene, count, (int64_t)bytes);
    char *to = scene->groups.names;
    for (int32_t i = 0; i < count; i++) {
        size_t length = strlen(reader->groups.name[order[i]]) + 1;
        memcpy(to, reader->groups.name[order[i]], length);
        to += length;
    }
    alloc_free(number);
    alloc_free(order);
}

static void make_normals(const struct obj_reader *reader, struct scene *scene)
{
    scene_add_normals(scene);
    for (int32_t i = 0; i < scene->input_count; i++)
        for (int k = 0; k < 3; k++) {
            int32_t normal = reader->triangles.at[i].corner[k].normal;
            if (normal >= 0)
                scene->normals[3 * (int64_t)i + k] = reader->normals.at[normal];
        }
}

/* Makes the materials of faces with colours: the colour in place of Kd. The numbers of
 * their colours become those of these materials. */
static struct palette mix_materials(const struct obj_reader *reader)
{
    const struct mtl_entry *entries = reader->materials.entries;
    struct palette mixed = {0};
    for (int64_t i = 0; i < reader->triangles.count; i++) {
        struct obj_triangle *triangle = &reader->triangles.at[i];
        if (material_is_pane(&entries[triangle->material].material))
            triangle->colour = -1; /* a pane is of one colour */
        if (triangle->colour < 0)
            continue;
        struct material material = reader->colours.faces.materials[triangle->colour];
        material.emission = entries[triangle->material].material.emission;
        triangle->colour = palette_add(&mixed, &material);
    }
    return mixed;
}

/* Makes panes of materials that let light through, unless all faces would be panes:
 * programs write illum 4 or Tr 1 for walls. */
static void make_panes(struct obj_reader *reader)
{
    struct obj_repairs *repairs = reader->repairs;
    struct mtl_entry *entries = reader->materials.entries;
    bool all = true;
    for (int64_t i = 0; i < reader->triangles.count && all; i++) {
        const struct mtl_entry *entry = &entries[reader->triangles.at[i].material];
        all = rgb_sum(mtl_transmittance(entry)) > 0.0;
    }
    for (int32_t i = 0; i < reader->materials.names.count; i++) {
        bool pane = entries[i].used && rgb_sum(mtl_transmittance(&entries[i])) > 0.0;
        repairs->panes += pane;
        repairs->glowing += pane && material_emits(&entries[i].material);
        if (pane && !all)
            mtl_make_pane(&entries[i]);
    }
    repairs->all_panes = all;
}

static struct scene *make_scene(const struct obj_reader *reader)
{
    int32_t known = reader->materials.names.count;
    int32_t *number = alloc_array((size_t)known, sizeof *number);
    int32_t named = number_materials(reader, number);
    struct palette mixed = mix_materials(reader);
    struct scene *scene =
        scene_create((int32_t)reader->triangles.count, named + mixed.count);
    for (int32_t i = 0; i < known; i++)
        if (reader->materials.entries[i].used)
            scene->materials[number[i]] = reader->materials.entries[i].material;
    for (int32_t i = 0; i < mixed.count; i++)
        scene->materials[named + i] = mixed.materials[i];
    for (int32_t i = 0; i < scene->input_count; i++) {
        const struct obj_triangle *triangle = &reader->triangles.at[i];
        for (int k = 0; k < 3; k++)
            scene->triangles[i].corner[k] =
                reader->vertices.at[triangle->corner[k].vertex];
        scene->material_of[i] = triangle->colour < 0 ? number[triangle->material]
                                                     : named + triangle->colour;
        scene->groups.goes_on[i] = triangle->goes_on;
    }
    make_groups(reader, scene);
    if (reader->has_normals)
        make_normals(reader, scene);
    palette_free(&mixed);
    alloc_free(number);
    return scene;
}

/* Takes the pictures of materials, if there are any: a face unlike others has the colour
 * of its own part. */
static void take_maps(struct obj_reader *reader)
{
    struct obj_triangles *triangles = &reader->triangles;
    if (reader->materials.maps.count == 0)
        return;
    struct map_face *faces = alloc_array((size_t)triangles->count, sizeof *faces);
    struct rgb *colours = alloc_array((size_t)triangles->count, sizeof *colours);
    for (int64_t i = 0; i < triangles->count; i++) {
        const struct obj_triangle *triangle = &triangles->at[i];
        struct triangle t;
        faces[i] = (struct map_face){.material = triangle->material, .has_part = true};
        for (int k = 0; k < 3; k++) {
            const struct obj_corner *corner = &triangle->corner[k];
            t.corner[k] = reader->vertices.at[corner->vertex];
            faces[i].has_part = faces[i].has_part && corner->place >= 0;
            if (corner->place < 0)
                continue;
            faces[i].part.at[k][0] = reader->places.at[corner->place].x;
            faces[i].part.at[k][1] = reader->places.at[corner->place].y;
        }
        faces[i].area = triangle_area(&t);
    }
    maps_take(&reader->materials, faces, triangles->count, reader->repairs->mean_of,
              &reader->repairs->textures, reader->repairs->files, colours);
    for (int64_t i = 0; i < triangles->count; i++) {
        const struct material own = {.reflectance = colours[i]};
        if (triangles->at[i].colour < 0 && colours[i].band[0] >= 0.0)
            triangles->at[i].colour = palette_add(&reader->colours.faces, &own);
    }
    alloc_free(colours);
    alloc_free(faces);
}

/* Returns the format of meshes that the file seems to have, or NULL. */
static const char *format_of(const struct source *source)
{
    static const char *const FORMATS[][3] = {{"STL", "soli", ".stl"},
                                             {"glTF", "glTF", ".gltf"},
                                             {"glTF", "{", ".glb"},
                                             {"XML", "<", ".xml"}};
    for (size_t i = 0; i < sizeof FORMATS / sizeof FORMATS[0]; i++)
        if (strncmp(source->start, FORMATS[i][1], strlen(FORMATS[i][1])) == 0 ||
            text_ends_with(source->path, FORMATS[i][2]))
            return FORMATS[i][0];
    return NULL;
}

struct scene *obj_of_source(struct source *source, struct obj_repairs *repairs,
                            struct error *error)
{
    *repairs = (struct obj_repairs){repairs->files, repairs->names, repairs->mean_of,
                                    .textured = 0};
    struct obj_reader reader = {.repairs = repairs, .error = error};
    bool good = text_of_source(&reader.text, source, error);
    if (good && reader.text.bytes[reader.text.position] == '#')
        snprintf(repairs->exporter, sizeof repairs->exporter, "%.*s",
                 (int)strcspn(reader.text.bytes, "\r\n"), reader.text.bytes);
    good = good && read_lines(&reader);
    text_free(&reader.text);
    if (!good && !reader.text.unreadable && reader.vertices.count == 0 &&
        error->code == EXIT_USAGE && format_of(source)) {
        *error = (struct error){EXIT_DONE, ""};
        error_set(error, EXIT_USAGE, "%s: not an OBJ file: it looks like %s",
                  source->path, format_of(source));
    }
    if (good)
        take_maps(&reader);
    if (good)
        make_panes(&reader);
    struct scene *scene = good ? make_scene(&reader) : NULL;
    alloc_free(reader.vertices.at);
    alloc_free(reader.colours.vertices.at);
    palette_free(&reader.colours.faces);
    alloc_free(reader.normals.at);
    alloc_free(reader.places.at);
    alloc_free(reader.triangles.at);
    alloc_free(reader.corners.at);
    mtl_free(&reader.materials);
    text_names_free(&reader.libraries);
    text_names_free(&reader.groups);
    return scene;
}
