/* Stored solutions. A picture needs more of a scene than its leaves: where its lamps are,
 * what reflects, the normals of smooth surfaces. All these are stored in full, for a
 * picture has edges: were a corner rounded to a float, some of a million rays would pass
 * it on the other side.
 *
 * A child has a quarter of its parent's area, so with a root as an interval of 4^15
 * units, depth first, each leaf is an interval. The leaves of a file have to fill the
 * interval of each root, in order; so a damaged file cannot ask for more patches than
 * about its own leaves. */
#include "io/picture/solution.h"

#include <math.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/little.h"
#include "rad/pushpull.h"

static const int64_t ROOT_UNITS = (int64_t)1 << 2 * ID_MAX_LEVEL;

/* --- reading --- */

struct solution_reader {
    struct ply_file *file;
    struct solution_mesh *solution;
    struct vec3 *vertices;      /* [vertex_count] input units */
    int64_t vertex_count;
    struct material *materials; /* [material_count] */
    int64_t material_count;
    struct error *error;
};

/* True if the element has all properties from `first` to `last`. */
static bool has_all(const struct ply_element *element, int first, int last)
{
    bool all = element != NULL;
    for (int field = first; all && field <= last; field++)
        all = element->type_of[field] != PLY_NONE;
    return all;
}

static struct vec3 take_point(const struct ply_file *file, enum ply_field first)
{
    const double *value = &file->value[first];
    return (struct vec3){value[0], value[1], value[2]};
}

static struct rgb take_colour(const struct ply_file *file, enum ply_field first)
{
    const double *value = &file->value[first];
    return (struct rgb){{value[0], value[1], value[2]}};
}

static bool read_vertices(struct solution_reader *reader,
                          const struct ply_element *element)
{
    reader->vertices = alloc_array((size_t)element->count, sizeof *reader->vertices);
    for (int64_t i = 0; i < element->count; i++) {
        if (!ply_file_record(reader->file, element, i, reader->error))
            return false;
        reader->vertices[i] = take_point(reader->file, PLY_X);
    }
    reader->vertex_count = element->count;
    return true;
}

/* Takes the leaf of the current record. Missing properties are 0. */
static bool take_leaf(const struct solution_reader *reader, struct solution_leaf *leaf)
{
    const struct ply_file *file = reader->file;
    const double *value = file->value;
    bool good = file->corner_count == 3 && value[PLY_ROOT] >= 0.0 &&
                value[PLY_ROOT] <= INT32_MAX && value[PLY_HIERARCHY] >= 1.0 &&
                value[PLY_HIERARCHY] <= UINT32_MAX;
    for (int k = 0; good && k < 3; k++)
        good = file->corners[k] < reader->vertex_count;
    struct patch_id id = {0, 0};
    if (good)
        id = (struct patch_id){(uint32_t)value[PLY_ROOT], (uint32_t)value[PLY_HIERARCHY]};
    if (!good || !id_is_valid(id))
        return ply_fail(file, reader->error, "not a leaf of a solution");
    int level = id_level(id), below = 2 * (ID_MAX_LEVEL - level);
    int64_t path = (int64_t)id.hierarchy - ((int64_t)1 << 2 * level);
    *leaf = (struct solution_leaf){
        .id = id, .start = path << below, .end = (path + 1) << below};
    for (int k = 0; k < 3; k++)
        leaf->triangle.corner[k] = reader->vertices[file->corners[k]];
    leaf->radiosity = take_colour(file, PLY_RADIOSITY_R);
    leaf->rest = take_colour(file, PLY_REST_R);
    leaf->error = value[PLY_ERROR];
    leaf->outside = value[PLY_OUTSIDE];
    leaf->area = triangle_area(&leaf->triangle);
    return true;
}

/* True if `leaf` begins at the end of `before`, or both are at the ends of roots. */
static bool is_in_order(const struct solution_leaf *before,
                        const struct solution_leaf *leaf)
{
    if (before && before->end < ROOT_UNITS)
        return leaf->id.root == before->id.root && leaf->start == before->end;
    return leaf->start == 0 && (!before || leaf->id.root > before->id.root);
}

static bool read_leaves(struct solution_reader *reader, const struct ply_element *element)
{
    struct solution_mesh *solution = reader->solution;
    solution->leaves = alloc_array((size_t)element->count, sizeof *solution->leaves);
    for (int64_t i = 0; i < element->count; i++) {
        if (!ply_file_record(reader->file, element, i, reader->error) ||
            !take_leaf(reader, &solution->leaves[i]))
            return false;
        if (!is_in_order(i > 0 ? &solution->leaves[i - 1] : NULL, &solution->leaves[i]))
            return ply_fail(reader->file, reader->error,
                            "the leaves are not those of whole roots");
    }
    solution->count = element->count;
    solution->has_error = element->type_of[PLY_ERROR] != PLY_NONE;
    solution->has_outside = element->type_of[PLY_OUTSIDE] != PLY_NONE;
    if (solution->leaves[solution->count - 1].end < ROOT_UNITS)
        return ply_fail(reader->file, reader->error, "the last root is not whole");
    return true;
}

static bool read_materials(struct solution_reader *reader,
                           const struct ply_element *element)
{
    reader->materials = alloc_array((size_t)element->count, sizeof *reader->materials);
    for (int64_t i = 0; i < element->count; i++) {
        if (!ply_file_record(reader->file, element, i, reader->error))
            return false;
        struct material m = {take_colour(reader->file, PLY_REFLECTANCE_R),
                             take_colour(reader->file, PLY_EMISSION_R),
                             {{0.0, 0.0, 0.0}}};
        if (has_all(element, PLY_TRANSMITTANCE_R, PLY_TRANSMITTANCE_B))
            m.transmittance = take_colour(reader->file, PLY_TRANSMITTANCE_R);
        for (int c = 0; c < BANDS; c++)
            if (!(m.reflectance.band[c] >= 0.0 && m.reflectance.band[c] < 1.0) ||
                !(m.emission.band[c] >= 0.0 && m.emission.band[c] <= 1e30) ||
                !(m.transmittance.band[c] >= 0.0 && m.transmittance.band[c] <= 1.0))
                return ply_fail(reader->file, reader->error, "not a material");
        reader->materials[i] = m;
    }
    reader->material_count = element->count;
    return true;
}

static bool is_within(struct vec3 x, double most)
{
    return fabs(x.x) <= most && fabs(x.y) <= most && fabs(x.z) <= most;
}

static bool read_root_corners(struct solution_reader *reader,
                              const struct ply_element *element)
{
    const struct ply_file *file = reader->file;
    if (element->count == 0 || element->count % 3 != 0 ||
        element->count / 3 > INT32_MAX / 2)
        return ply_fail(file, reader->error, "roots have three corners each");
    struct scene *scene = reader->solution->scene =
        scene_create((int32_t)(element->count / 3), (int32_t)reader->material_count);
    if (has_all(element, PLY_NX, PLY_NZ))
        scene_add_normals(scene);
    for (int64_t i = 0; i < element->count; i++) {
        if (!ply_file_record(reader->file, element, i, reader->error))
            return false;
        struct vec3 at = take_point(file, PLY_X), normal = take_point(file, PLY_NX);
        double material = file->value[PLY_MATERIAL_NUMBER];
        if (!is_within(at, 1.0) || (scene->normals && !is_within(normal, 1.0)) ||
            !(material >= 0.0 && material < (double)reader->material_count))
            return ply_fail(file, reader->error, "not a corner of a root");
        scene->triangles[i / 3].corner[i % 3] = at;
        scene->material_of[i / 3] = (int32_t)material;
        if (scene->normals)
            scene->normals[i] = normal;
    }
    memcpy(scene->materials, reader->materials,
           (size_t)reader->material_count * sizeof *scene->materials);
    return true;
}

/* Largest exponent of a scene for scene_prepare(). */
enum { EXPONENT_MAX = 500 };

static bool read_whole(struct solution_reader *reader, const struct ply_element *element)
{
    const struct ply_file *file = reader->file;
    struct scene *scene = reader->solution->scene;
    if (!ply_file_record(reader->file, element, 0, reader->error))
        return false;
    const double *value = file->value;
    double exponent = value[PLY_EXPONENT];
    if (!scene || !(fabs(exponent) <= EXPONENT_MAX) || !(value[PLY_LAMP_LEAST] >= 0.0) ||
        !(value[PLY_MEAN] >= 0.0))
        return ply_fail(file, reader->error, "not the scene of a solution");
    scene->two_sided = value[PLY_TWO_SIDED] != 0.0;
    scene->two_sided_lamps = value[PLY_TWO_SIDED_LAMPS] != 0.0;
    scene_restore(scene, take_point(file, PLY_X), (int32_t)exponent);
    reader->solution->lamps =
        (struct solution_lamps){has_all(element, PLY_LAMP_LEAST, PLY_MEAN),
                                value[PLY_LAMP_LEAST], value[PLY_MEAN]};
    return true;
}

bool solution_is_stored(const struct ply_file *file)
{
    const struct ply_element *face = ply_file_find(file, PLY_FACE);
    return has_all(face, PLY_RADIOSITY_R, PLY_RADIOSITY_R) &&
           has_all(face, PLY_HIERARCHY, PLY_HIERARCHY);
}

/* True if the file has vertices and, after them, the faces of a solution. */
static bool is_solution(const struct ply_file *file)
{
    const struct ply_element *vertex = ply_file_find(file, PLY_VERTEX);
    const struct ply_element *face = ply_file_find(file, PLY_FACE);
    return has_all(vertex, PLY_X, PLY_Z) &&
           has_all(face, PLY_RADIOSITY_R, PLY_HIERARCHY) &&
           has_all(face, PLY_CORNERS, PLY_CORNERS) && vertex < face && face->count > 0;
}

/* True if the file has either nothing of the scene, or all its elements, in order. */
static bool has_whole_scene(const struct ply_file *file)
{
    const struct ply_element *material = ply_file_find(file, PLY_MATERIAL);
    const struct ply_element *corner = ply_file_find(file, PLY_ROOT_CORNER);
    const struct ply_element *whole = ply_file_find(file, PLY_SOLUTION);
    const struct ply_element *face = ply_file_find(file, PLY_FACE);
    if (!corner && !whole)
        return true;
    if (has_all(face, PLY_REST_R, PLY_REST_B) != has_all(whole, PLY_LAMP_LEAST, PLY_MEAN))
        return false; /* one is of no use without the other */
    return has_all(material, PLY_REFLECTANCE_R, PLY_REFLECTANCE_B) &&
           has_all(material, PLY_EMISSION_R, PLY_EMISSION_B) &&
           has_all(corner, PLY_X, PLY_Z) &&
           has_all(corner, PLY_MATERIAL_NUMBER, PLY_MATERIAL_NUMBER) &&
           has_all(whole, PLY_X, PLY_Z) &&
           has_all(whole, PLY_EXPONENT, PLY_TWO_SIDED_LAMPS) && material < corner &&
           corner < whole && whole->count == 1;
}

static bool read_elements(struct solution_reader *reader)
{
    struct ply_file *file = reader->file;
    bool scene = ply_file_find(file, PLY_SOLUTION) != NULL, good = true;
    for (int64_t i = 0; good && i < file->header.element_count; i++) {
        const struct ply_element *element = &file->header.elements[i];
        if (element->kind == PLY_VERTEX)
            good = read_vertices(reader, element);
        else if (element->kind == PLY_FACE)
            good = read_leaves(reader, element);
        else if (scene && element->kind == PLY_MATERIAL)
            good = read_materials(reader, element);
        else if (scene && element->kind == PLY_ROOT_CORNER)
            good = read_root_corners(reader, element);
        else if (scene && element->kind == PLY_SOLUTION)
            good = read_whole(reader, element);
        else
            good = ply_file_skip(file, element, reader->error);
    }
    return good && ply_file_end(file, reader->error);
}

/* Fits the scene to the leaves: drops the triangles without any. False if these are not
 * the leaves of all its roots. */
static bool fit_scene(const struct solution_mesh *solution)
{
    struct scene *scene = solution->scene;
    int32_t roots = scene_root_count(scene);
    bool *has = alloc_array((size_t)roots, sizeof *has), good = true;
    for (int64_t i = 0; good && i < solution->count; i++) {
        good = solution->leaves[i].id.root < (uint32_t)roots;
        if (good)
            has[solution->leaves[i].id.root] = true;
    }
    for (int32_t input = 0; input < scene->input_count; input++)
        if (!has[input])
            scene_drop(scene, input);
    scene_find_backs(scene);
    for (int32_t root = 0; good && root < roots; root++)
        good = has[root] == (scene_root_area(scene, root) > 0.0);
    alloc_free(has);
    return good;
}

bool solution_mesh_of_file(struct solution_mesh *solution, struct ply_file *file,
                           struct error *error)
{
    struct solution_reader reader = {
        .file = file, .solution = solution, .error = error};
    *solution = (struct solution_mesh){0};
    bool good = is_solution(file) && has_whole_scene(file);
    if (!good)
        error_set(error, EXIT_USAGE, "%s: a mesh, but not a solution of phr",
                  file->binary.path);
    good = good && read_elements(&reader);
    if (good && solution->scene && !fit_scene(solution))
        good = error_set(error, EXIT_USAGE, "%s: the leaves are not those of the scene",
                         file->binary.path);
    alloc_free(reader.vertices);
    alloc_free(reader.materials);
    if (!good)
        solution_mesh_free(solution);
    return good;
}

bool solution_mesh_read(struct solution_mesh *solution, struct source *source,
                        struct error *error)
{
    struct ply_file file;
    *solution = (struct solution_mesh){0};
    bool good = ply_file_open(&file, source, error) &&
                solution_mesh_of_file(solution, &file, error);
    ply_file_close(&file);
    return good;
}

void solution_mesh_free(struct solution_mesh *solution)
{
    alloc_free(solution->leaves);
    scene_destroy(solution->scene);
    *solution = (struct solution_mesh){0};
}

void solution_mesh_restore(const struct solution_mesh *solution, struct forest *forest)
{
    for (int64_t i = 0; i < solution->count; i++) {
        int32_t leaf = forest_reach(forest, solution->leaves[i].id);
        forest->radiosity[leaf] = solution->leaves[i].radiosity;
    }
    forest_average(forest);
}

/* --- writing --- */

static void put_doubles(struct output *output, const double *values, int count)
{
    uint8_t bytes[8];
    for (int i = 0; i < count; i++) {
        little_put_double(bytes, values[i]);
        fwrite(bytes, sizeof bytes, 1, output->file);
    }
}

static void put_point(struct output *output, struct vec3 x)
{
    put_doubles(output, (const double[]){x.x, x.y, x.z}, 3);
}

void solution_write_header(struct output *output, const struct scene *scene, bool known)
{
    if (scene)
        fprintf(output->file,
                "element material %lld\n"
                "property double reflectance_r\nproperty double reflectance_g\n"
                "property double reflectance_b\nproperty double emission_r\n"
                "property double emission_g\nproperty double emission_b\n%s"
                "element root_corner %lld\n"
                "property double x\nproperty double y\nproperty double z\n"
                "property int material\n%s"
                "element solution 1\n"
                "property double x\nproperty double y\nproperty double z\n"
                "property int exponent\n"
                "property uchar two_sided\nproperty uchar two_sided_lamps\n%s",
                (long long)scene->material_count,
                scene->has_panes ? "property double transmittance_r\n"
                                   "property double transmittance_g\n"
                                   "property double transmittance_b\n"
                                 : "",
                3 * (long long)scene->input_count,
                scene->normals ? "property double nx\nproperty double ny\n"
                                 "property double nz\n"
                               : "",
                known ? "property double lamp_least\nproperty double mean\n" : "");
    fprintf(output->file, "end_header\n");
}

void solution_write_scene(struct output *output, const struct scene *scene,
                          const struct solution_lamps *lamps)
{
    if (!scene)
        return;
    for (int32_t i = 0; i < scene->material_count; i++) {
        put_doubles(output, scene->materials[i].reflectance.band, BANDS);
        put_doubles(output, scene->materials[i].emission.band, BANDS);
        if (scene->has_panes)
            put_doubles(output, scene->materials[i].transmittance.band, BANDS);
    }
    for (int64_t i = 0; i < 3 * (int64_t)scene->input_count; i++) {
        put_point(output, scene->triangles[i / 3].corner[i % 3]);
        output_uint32(output, (uint32_t)scene->material_of[i / 3]);
        if (scene->normals)
            put_point(output, scene->normals[i]);
    }
    put_point(output, scene->place.centre);
    output_uint32(output, (uint32_t)scene->place.exponent);
    putc(scene->two_sided, output->file);
    putc(scene->two_sided_lamps, output->file);
    if (lamps->known)
        put_doubles(output, (const double[]){lamps->lamp_least, lamps->mean}, 2);
}
