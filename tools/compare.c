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

#include "io/picture/mesh.h"

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

/* --- pictures, by their errors --- */

/* Samples are floats, made by a few operations: they may be off by this part. */
static const double ROUNDING = 0x1p-20;

/* The mean of a - b in a band over its standard error. */
static double deviation(const struct block *block, const struct image *a,
                        const struct image *b, const struct image *error, int band)
{
    double sum = 0.0, squares = 0.0, errors = 0.0, light = 0.0, n = 0.0;
    for (int y = block->first_y; y < block->end_y; y++)
        for (int x = block->first_x; x < block->end_x; x++, n++) {
            double expected = (double)pixel_at(b, x, y)[band];
            double off = (double)pixel_at(a, x, y)[band] - expected;
            sum += off;
            squares += off * off;
            errors += (double)pixel_at(error, x, y)[band];
            light += fabs(expected);
        }
    double mean = sum / n, claim = errors / n, rounding = ROUNDING * light / n;
    double scatter = n > 1.0 ? fmax(0.0, squares / n - mean * mean) / (n - 1.0) : 0.0;
    double variance = claim * claim + rounding * rounding + scatter;
    if (!isfinite(mean) || !isfinite(variance))
        return HUGE_VAL;
    return mean == 0.0 ? 0.0 : mean / sqrt(variance);
}

/* How much b changes from pixel to pixel, to the right or down. */
static double slope(const struct image *b, int x, int y, int band, bool down)
{
    int x1 = down || x + 1 == b->width ? x : x + 1, x0 = down || x == 0 ? x : x - 1;
    int y1 = !down || y + 1 == b->height ? y : y + 1, y0 = !down || y == 0 ? y : y - 1;
    return (double)pixel_at(b, x1, y1)[band] - (double)pixel_at(b, x0, y0)[band];
}

/* How far a is moved to the right, or down, over the standard error of that: a - b as a
 * multiple of the slope of b. (What a move makes at edges is noise to deviation().) */
static double movement(const struct block *block, const struct image *a,
                       const struct image *b, const struct image *error, int band,
                       bool down)
{
    double sum = 0.0, squares = 0.0, alike = 0.0;
    for (int y = block->first_y; y < block->end_y; y++)
        for (int x = block->first_x; x < block->end_x; x++) {
            double g = slope(b, x, y, band, down);
            double expected = (double)pixel_at(b, x, y)[band];
            double off = (double)pixel_at(a, x, y)[band] - expected;
            double claim = (double)pixel_at(error, x, y)[band];
            sum += g * off;
            squares += g * g * (off * off + claim * claim);
            alike += g * claim;
        }
    double variance = squares + alike * alike;
    return variance > 0.0 && isfinite(variance) ? sum / sqrt(variance) : 0.0;
}

struct deviations compare_errors(const struct image *a, const struct image *b,
                                 const struct image *error, int side, double most,
                                 double limit, struct image *map)
{
    struct deviations found = {.worst = 0.0};
    for (int y = 0; y == 0 || y + side <= b->height; y += side)
        for (int x = 0; x == 0 || x + side <= b->width; x += side) {
            struct block at = {x, x + 2 * side <= b->width ? x + side : b->width,
                               y, y + 2 * side <= b->height ? y + side : b->height};
            double worst = 0.0;
            if (block_is_brighter(&at, b, most))
                continue;
            for (int c = 0; c < 3; c++) {
                double off = deviation(&at, a, b, error, c);
                worst = fabs(off) > fabs(worst) ? off : worst;
            }
            double moved = 0.0;
            for (int c = 0; c < 3; c++)
                moved = fmax(moved, fmax(fabs(movement(&at, a, b, error, c, false)),
                                         fabs(movement(&at, a, b, error, c, true))));
            for (int c = 0; c < 3 && map; c++)
                block_fill(&at, map, c, (float)fmax(-FLT_MAX, fmin(FLT_MAX, worst)));
            found.blocks++;
            found.unlike += fabs(worst) > limit;
            found.beyond += fabs(worst) > limit || moved > limit;
            if (fmax(fabs(worst), moved) > fabs(found.worst)) {
                found.moved = moved > fabs(worst);
                found.worst = found.moved ? moved : worst;
                found.x = x;
                found.y = y;
            }
        }
    return found;
}

/* --- solutions --- */

bool compare_solutions(const struct solution_mesh *a, const struct solution_mesh *b,
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

bool solution_write(const struct solution_mesh *solution, const struct rgb *map,
                    double white, const char *path, struct error *error)
{
    struct tone tone = tone_make(white > 0.0 ? 1.0 / white : 1.0);
    struct output output;
    if (!output_open(&output, path, error))
        return false;
    mesh_write_header(&output, 3 * solution->count, solution->count, false);
    solution_write_header(&output, solution->scene, false);
    for (int64_t i = 0; i < 3 * solution->count; i++) {
        struct vec3 x = solution->leaves[i / 3].triangle.corner[i % 3];
        for (int axis = 0; axis < 3; axis++)
            output_float(&output, (float)vec3_axis(x, axis));
        for (int c = 0; c < BANDS; c++)
            putc(tone_encode(&tone, map[i / 3].band[c]), output.file);
        for (int c = 0; c < BANDS; c++)
            output_float(&output, as_float(map[i / 3].band[c]));
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
    solution_write_scene(&output, solution->scene,
                         &(struct solution_lamps){.known = false});
    return output_close(&output, error);
}
