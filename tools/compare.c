/* Comparing.
 *
 * Pictures are compared pixel by pixel or block by block: in a path tracer's picture only
 * means over many pixels have little noise. Solutions are compared on the common
 * refinement of both divisions: a child has a quarter of its parent's area, so with a
 * root as an interval of 4^15 units, depth first, each leaf is an interval, and two
 * divisions are walked side by side. A leaf's value is a mean, so the comparison is exact
 * at any depths.
 *
 * Errors are relative to the root mean square of the expected side and not to each
 * sample: in a dark pixel a rounding can have any relative size. */
#include "tools/compare.h"

#include <float.h>
#include <math.h>

#include "geom/alloc.h"
#include "io/picture/mesh.h"
#include "io/scene/plyfile.h"

static double ratio(double a, double b)
{
    return a == 0.0 ? 0.0 : a / b;
}

double difference_mean(const struct difference *difference)
{
    return ratio(difference->sum, difference->weight);
}

double difference_rms(const struct difference *difference)
{
    return sqrt(ratio(difference->squares, difference->weight));
}

double difference_relative(const struct difference *difference, double x)
{
    double unit = sqrt(ratio(difference->expected_squares, difference->weight));
    return unit > 0.0 ? x / unit : x > 0.0 ? HUGE_VAL : 0.0;
}

double difference_psnr(const struct difference *difference, double peak)
{
    double rms = difference_rms(difference);
    return rms > 0.0 ? 20.0 * log10(peak / rms) : HUGE_VAL;
}

/* Adds a sample. Returns |a - b|. */
static double add_sample(struct difference *difference, double a, double b, double weight)
{
    double off = fabs(a - b);
    difference->samples++;
    if (!isfinite(a) || !isfinite(b)) {
        difference->broken++;
        return FLT_MAX;
    }
    difference->weight += weight;
    difference->sum += weight * off;
    difference->squares += weight * off * off;
    difference->expected_squares += weight * b * b;
    difference->largest = fmax(difference->largest, off);
    difference->peak = fmax(difference->peak, fabs(b));
    return off;
}

/* --- pictures --- */

/* The pixels first_x .. end_x - 1 of the rows first_y .. end_y - 1. */
struct block {
    int first_x, end_x, first_y, end_y;
};

static const float *pixel_at(const struct image *image, int x, int y)
{
    return &image->rgb[3 * ((size_t)y * (size_t)image->width + (size_t)x)];
}

/* Returns the mean of one band. */
static double block_mean(const struct block *block, const struct image *image, int band)
{
    double sum = 0.0;
    for (int y = block->first_y; y < block->end_y; y++)
        for (int x = block->first_x; x < block->end_x; x++)
            sum += (double)pixel_at(image, x, y)[band];
    return sum / (block->end_x - block->first_x) / (block->end_y - block->first_y);
}

static bool block_is_brighter(const struct block *block, const struct image *image,
                               double most)
{
    for (int y = block->first_y; y < block->end_y; y++)
        for (int x = block->first_x; x < block->end_x; x++)
            for (int c = 0; c < 3; c++)
                if ((double)pixel_at(image, x, y)[c] > most)
                    return true;
    return false;
}

static void block_fill(const struct block *block, const struct image *map, int band,
                        float value)
{
    for (int y = block->first_y; y < block->end_y; y++)
        for (int x = block->first_x; x < block->end_x; x++)
            map->rgb[pixel_at(map, x, y) - map->rgb + band] = value;
}

struct difference compare_images(const struct image *a, const struct image *b, int side,
                                 double most, struct image *map)
{
    struct difference difference = {0};
    for (int y = 0; y < b->height; y += side)
        for (int x = 0; x < b->width; x += side) {
            struct block at = {x, x + side < b->width ? x + side : b->width,
                                y, y + side < b->height ? y + side : b->height};
            double weight = (double)(at.end_x - x) * (at.end_y - y);
            bool left_out = block_is_brighter(&at, b, most);
            for (int c = 0; c < 3; c++) {
                double off = left_out ? 0.0
                                      : add_sample(&difference, block_mean(&at, a, c),
                                                   block_mean(&at, b, c), weight);
                block_fill(&at, map, c, off < (double)FLT_MAX ? (float)off : FLT_MAX);
            }
        }
    return difference;
}

/* --- solutions --- */

static const int64_t ROOT_UNITS = (int64_t)1 << 2 * ID_MAX_LEVEL;

struct solution_reader {
    struct ply_file file;
    struct vec3 *vertices;
    int64_t vertex_count;
    struct error *error;
};

static bool read_vertices(struct solution_reader *reader,
                          const struct ply_element *element)
{
    const double *value = reader->file.value;
    reader->vertices = alloc_array((size_t)element->count, sizeof *reader->vertices);
    for (int64_t i = 0; i < element->count; i++) {
        if (!ply_file_record(&reader->file, element, i, reader->error))
            return false;
        reader->vertices[i] = (struct vec3){value[PLY_X], value[PLY_Y], value[PLY_Z]};
    }
    reader->vertex_count = element->count;
    return true;
}

/* Takes the leaf of the current record. */
static bool take_leaf(const struct solution_reader *reader, struct solution_leaf *leaf)
{
    const struct ply_file *file = &reader->file;
    const double *value = file->value;
    bool good = file->corner_count == 3 && value[PLY_ROOT] >= 0.0 &&
                value[PLY_ROOT] <= UINT32_MAX && value[PLY_HIERARCHY] >= 1.0 &&
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
    for (int c = 0; c < BANDS; c++)
        leaf->radiosity.band[c] = value[PLY_RADIOSITY_R + c];
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

static bool read_leaves(struct solution_reader *reader, const struct ply_element *element,
                        struct solution *solution)
{
    solution->leaves = alloc_array((size_t)element->count, sizeof *solution->leaves);
    for (int64_t i = 0; i < element->count; i++) {
        if (!ply_file_record(&reader->file, element, i, reader->error) ||
            !take_leaf(reader, &solution->leaves[i]))
            return false;
        if (!is_in_order(i > 0 ? &solution->leaves[i - 1] : NULL, &solution->leaves[i]))
            return ply_fail(&reader->file, reader->error,
                            "the leaves are not those of whole roots");
    }
    solution->count = element->count;
    if (solution->leaves[solution->count - 1].end < ROOT_UNITS)
        return ply_fail(&reader->file, reader->error, "the last root is not whole");
    return true;
}

/* True if the file has vertices and, after them, the faces of a solution. */
static bool is_solution(const struct ply_file *file)
{
    const struct ply_element *vertex = ply_file_find(file, PLY_VERTEX);
    const struct ply_element *face = ply_file_find(file, PLY_FACE);
    if (!vertex || !face || vertex > face || face->count == 0)
        return false;
    for (int field = PLY_X; field <= PLY_Z; field++)
        if (vertex->type_of[field] == PLY_NONE)
            return false;
    for (int field = PLY_RADIOSITY_R; field <= PLY_CORNERS; field++)
        if (face->type_of[field] == PLY_NONE)
            return false;
    return true;
}

static bool read_solution(struct solution_reader *reader, struct solution *solution)
{
    struct ply_file *file = &reader->file;
    if (!is_solution(file))
        return error_set(reader->error, EXIT_USAGE,
                         "%s: a mesh, but not a solution of phr", file->binary.path);
    bool good = true;
    for (int64_t i = 0; good && i < file->header.element_count; i++) {
        const struct ply_element *element = &file->header.elements[i];
        switch (element->kind) {
        case PLY_VERTEX: good = read_vertices(reader, element); break;
        case PLY_FACE: good = read_leaves(reader, element, solution); break;
        case PLY_OTHER: good = ply_file_skip(file, element, reader->error); break;
        }
    }
    return good && ply_file_end(file, reader->error);
}

bool solution_of_binary(struct solution *solution, const struct binary *binary,
                        struct error *error)
{
    struct solution_reader reader = {.error = error};
    *solution = (struct solution){0};
    bool good =
        ply_file_open(&reader.file, binary, error) && read_solution(&reader, solution);
    ply_file_close(&reader.file);
    alloc_free(reader.vertices);
    if (!good)
        solution_free(solution);
    return good;
}

bool solution_read(struct solution *solution, const char *path, struct error *error)
{
    struct binary binary;
    *solution = (struct solution){0};
    return ply_file_load(&binary, path, error) &&
           solution_of_binary(solution, &binary, error);
}

void solution_free(struct solution *solution)
{
    alloc_free(solution->leaves);
    *solution = (struct solution){0};
}

bool compare_solutions(const struct solution *a, const struct solution *b,
                       struct difference *difference, struct rgb *map,
                       struct error *error)
{
    *difference = (struct difference){0};
    int64_t i = 0, j = 0;
    while (i < a->count && j < b->count) {
        const struct solution_leaf *left = &a->leaves[i], *right = &b->leaves[j];
        if (left->id.root != right->id.root)
            break;
        int64_t start = left->start > right->start ? left->start : right->start;
        int64_t end = left->end < right->end ? left->end : right->end;
        double area =
            right->area * (double)(end - start) / (double)(right->end - right->start);
        double fraction = (double)(end - start) / (double)(left->end - left->start);
        for (int c = 0; c < BANDS; c++)
            map[i].band[c] += fraction * add_sample(difference, left->radiosity.band[c],
                                                 right->radiosity.band[c], area);
        i += left->end == end;
        j += right->end == end;
    }
    if (i < a->count || j < b->count)
        return error_set(error, EXIT_USAGE, "the solutions are not of the same scene");
    return true;
}

/* Returns a value cut to the range of floats. */
static float as_float(double x)
{
    return x < (double)FLT_MAX ? (float)x : FLT_MAX;
}

bool solution_write(const struct solution *solution, const struct rgb *map, double white,
                    const char *path, struct error *error)
{
    struct tone tone = tone_make(white > 0.0 ? 1.0 / white : 1.0);
    struct output output;
    if (!output_open(&output, path, error))
        return false;
    mesh_write_header(&output, 3 * solution->count, solution->count, false);
    for (int64_t i = 0; i < 3 * solution->count; i++) {
        struct vec3 x = solution->leaves[i / 3].triangle.corner[i % 3];
        for (int axis = 0; axis < 3; axis++)
            output_float(&output, (float)vec3_axis(x, axis));
        for (int c = 0; c < BANDS; c++)
            putc(tone_encode(&tone, map[i / 3].band[c]), output.file);
    }
    for (int64_t i = 0; i < solution->count; i++) {
        putc(3, output.file);
        for (int k = 0; k < 3; k++)
            output_uint32(&output, (uint32_t)(3 * i + k));
        for (int c = 0; c < BANDS; c++)
            output_float(&output, as_float(map[i].band[c]));
        output_uint32(&output, solution->leaves[i].id.root);
        output_uint32(&output, solution->leaves[i].id.hierarchy);
    }
    return output_close(&output, error);
}
