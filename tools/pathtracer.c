/* pathtracer: pictures and solution meshes by path tracing alone, as references for
 * phr's.
 *
 *   make pathtracer
 *   build/pathtracer room.obj --view room.view --samples 256 -o truth.pfm
 *   build/pathtracer room.obj --leaves room.ply --samples 256 -o truth.ply
 *   imgdiff room.ply truth.ply -o error.ply
 *
 * Options of scene, camera and files are phr's; --samples is the number of paths a pixel,
 * or a leaf. With --leaves the output is a mesh with the leaves of this solution, each
 * with the mean of E + rho H over it, and the norms of the solution's error are printed,
 * as in tests/deviation.h: of the reflected light rho H alone, since E is given and would
 * hide any error; so black lamps are left out.
 *
 * The paths of a leaf make two independent estimates. The product of the deviations from
 * both has the square of the error as its expectation, whatever the noise; L1 and median
 * use the mean of both, and cannot show errors much below `noise`.
 *
 * Seeds are the numbers of pixels and leaves, which are dealt to the ranks in turn: files
 * do not depend on the number of ranks. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/stop.h"
#include "io/picture/imagefile.h"
#include "io/picture/viewpoint.h"
#include "io/scene/text.h"
#include "mpi/picture.h"
#include "tools/compare.h"
#include "tools/input.h"
#include "tools/pixel.h"

enum { SAMPLES = 64, SAMPLES_MAX = 1 << 24, HALVES = 2 };

static const char USAGE[] = "usage: pathtracer SCENE [--leaves SOLUTION.ply] "
                            "[--samples N] [options of phr] -o FILE...";

struct tracing {
    struct run *run;    /* borrowed */
    const char *leaves; /* path of a solution, or NULL */
    int samples;        /* paths a pixel, or a leaf */
    struct solution_mesh solution; /* of --leaves */
    struct pathtracer pathtracer;
};

/* --- input --- */

/* Takes --leaves and --samples out of the arguments. */
static bool take_own(struct tracing *tracing, int *argc, char **argv)
{
    struct run *run = tracing->run;
    double samples = SAMPLES;
    int kept = 1;
    for (int i = 1; i < *argc; i++) {
        bool leaves = strcmp(argv[i], "--leaves") == 0;
        if (!leaves && strcmp(argv[i], "--samples") != 0)
            argv[kept++] = argv[i];
        else if (++i >= *argc)
            error_set(&run->error, EXIT_USAGE, "%s needs a value", argv[i - 1]);
        else if (leaves)
            tracing->leaves = argv[i];
        else if (!text_is_number(argv[i], &samples) || !(samples >= HALVES) ||
                 samples > SAMPLES_MAX)
            error_set(&run->error, EXIT_USAGE, "--samples: %s is not between %d and %d",
                      argv[i], HALVES, SAMPLES_MAX);
    }
    *argc = kept;
    tracing->samples = run->error.code == EXIT_DONE ? (int)samples : 0;
    return run->error.code == EXIT_DONE;
}

/* Checks the outputs: there has to be one; meshes need --leaves, and --leaves a mesh. */
static bool check_outputs(struct tracing *tracing)
{
    struct run *run = tracing->run;
    bool meshes = false;
    for (int i = 0; i < run->options.output_count; i++) {
        const struct target *target = &run->options.outputs[i];
        meshes = meshes || format_is_mesh(target->format);
        if (target->format == FORMAT_VTK || target->format == FORMAT_ERROR)
            return error_set(&run->error, EXIT_USAGE, "%s: %s here", target->path,
                             format_is_mesh(target->format) ? "meshes are PLY"
                                                            : "errors are not known");
    }
    if (run->options.output_count == 0 || !run->options.scene)
        return error_set(&run->error, EXIT_USAGE, "%s", USAGE);
    if (run->options.view_count > 1)
        return error_set(&run->error, EXIT_USAGE, "one view at a time");
    if (meshes != (tracing->leaves != NULL))
        return error_set(&run->error, EXIT_USAGE, "-o FILE.ply and --leaves go together");
    return true;
}

/* Reads the solution of --leaves. */
static bool read_leaves(struct tracing *tracing)
{
    struct run *run = tracing->run;
    if (!tracing->leaves)
        return true;
    struct source source;
    bool good = source_open(&source, tracing->leaves, &run->error) &&
                solution_mesh_read(&tracing->solution, &source, &run->error);
    source_close(&source);
    if (!good)
        return false;
    for (int64_t i = 0; i < tracing->solution.count; i++) {
        uint32_t root = tracing->solution.leaves[i].id.root;
        if (root >= (uint32_t)scene_root_count(run->scene) ||
            !(scene_root_area(run->scene, (int32_t)root) > 0.0))
            return error_set(&run->error, EXIT_USAGE, "%s: not a solution of %s",
                             tracing->leaves, run->options.scene);
    }
    return true;
}

/* Collective. */
static bool read_all(struct tracing *tracing)
{
    struct run *run = tracing->run;
    if (!input_broadcast(run))
        return false;
    if (run->stored)
        error_set(&run->error, EXIT_USAGE, "%s: a solution, and no scene",
                  run->options.scene);
    else if (read_leaves(tracing) && run->options.view_count == 0)
        *run->cameras = viewpoint_choose(run->scene, run->octree, NULL,
                                         run->cameras->width, run->cameras->height);
    return run_agree(run);
}

/* --- tracing --- */

/* Collective. Returns the picture on rank 0, top scanline first. */
static float *trace_picture(const struct tracing *tracing)
{
    const struct run *run = tracing->run;
    int width = run->cameras->width, height = run->cameras->height;
    size_t length = (size_t)width * BANDS;
    int scanlines = (height + run->comm.size - 1) / run->comm.size;
    float *own = alloc_array((size_t)scanlines * length, sizeof *own), *at = own;
    for (int y = run->comm.rank; y < height; y += run->comm.size)
        for (int x = 0; x < width && !stop_is_asked(); x++) {
            uint64_t seed = (uint64_t)y * IMAGE_SIZE_MAX + (uint64_t)x;
            struct rgb b = pathtracer_pixel(&tracing->pathtracer, run->cameras, x, y,
                                            tracing->samples, seed);
            for (int c = 0; c < BANDS; c++)
                *at++ = (float)b.band[c];
        }
    return picture_gather(&run->comm, own, length, height);
}

/* Collective. Returns two estimates of rho H for each leaf, HALVES * BANDS floats, on
 * rank 0. */
static float *trace_leaves(const struct tracing *tracing)
{
    const struct run *run = tracing->run;
    int64_t count = tracing->solution.count, size = run->comm.size;
    size_t length = HALVES * BANDS;
    float *own = alloc_array((size_t)(count / size + 1) * length, sizeof *own), *at = own;
    for (int64_t i = run->comm.rank; i < count && !stop_is_asked(); i += size) {
        struct patch_id id = tracing->solution.leaves[i].id;
        struct triangle part = pathtracer_part(id);
        uint64_t seed = id_number(id) << 1;
        for (uint64_t half = 0; half < HALVES; half++) {
            struct rgb h =
                pathtracer_reflected(&tracing->pathtracer, (int32_t)id.root, &part,
                                     tracing->samples / HALVES, seed + half);
            for (int c = 0; c < BANDS; c++)
                *at++ = (float)h.band[c];
        }
    }
    return picture_gather(&run->comm, own, length, comm_count(&run->comm, count));
}

/* --- norms --- */

/* A leaf's |B - T|, summed over the bands, and its area. */
struct off {
    double error, area;
};

struct norms {
    double area, squares, light_squares, light, errors, noise; /* sums by area */
    struct off *offs; /* [count] */
    int64_t count;
};

static int compare_offs(const void *a, const void *b)
{
    const struct off *p = a, *q = b;
    return (p->error > q->error) - (p->error < q->error);
}

static void add_leaf(struct norms *norms, const struct solution_leaf *leaf,
                     const struct material *material, const float *half)
{
    struct off off = {0.0, leaf->area};
    for (int c = 0; c < BANDS; c++) {
        double b = leaf->radiosity.band[c] - material->emission.band[c];
        double r = (double)half[c], s = (double)half[c + BANDS];
        norms->squares += leaf->area * (b - r) * (b - s);
        norms->light_squares += leaf->area * r * s;
        norms->light += leaf->area * 0.5 * (r + s);
        norms->noise += leaf->area * 0.25 * (r - s) * (r - s);
        off.error += fabs(b - 0.5 * (r + s));
    }
    norms->area += off.area;
    norms->errors += off.area * off.error;
    norms->offs[norms->count++] = off;
}

/* Returns the median by area of the leaves' errors. */
static double median_of(struct norms *norms)
{
    double below = 0.0;
    int64_t i = 0;
    qsort(norms->offs, (size_t)norms->count, sizeof *norms->offs, compare_offs);
    while (i < norms->count - 1 && below + norms->offs[i].area < 0.5 * norms->area)
        below += norms->offs[i++].area;
    return norms->count > 0 ? norms->offs[i].error : 0.0;
}

static double over(double a, double b)
{
    return b > 0.0 ? a / b : 0.0;
}

/* Prints the norms over all reflecting leaves. */
static void print_norms(const struct tracing *tracing, const float *halves)
{
    const struct solution_mesh *solution = &tracing->solution;
    struct norms norms = {.count = 0};
    norms.offs = alloc_array((size_t)solution->count, sizeof *norms.offs);
    for (int64_t i = 0; i < solution->count; i++) {
        const struct solution_leaf *leaf = &solution->leaves[i];
        const struct material *material =
            scene_root_material(tracing->run->scene, (int32_t)leaf->id.root);
        if (rgb_sum(material->reflectance) > 0.0)
            add_leaf(&norms, leaf, material, halves + i * HALVES * BANDS);
    }
    printf("leaves  %lld, %lld of them reflect\n", (long long)solution->count,
           (long long)norms.count);
    printf("rms     %.6f\n", sqrt(over(fmax(norms.squares, 0.0), norms.light_squares)));
    printf("l1      %.6f\n", over(norms.errors, norms.light));
    printf("median  %.6f\n", over(median_of(&norms) * norms.area, norms.light));
    printf("noise   %.6f\n", sqrt(over(norms.noise, norms.light_squares)));
    alloc_free(norms.offs);
}

/* --- output --- */

/* Writes the leaves with E + rho H in place of their radiosities. */
static void write_leaves(struct tracing *tracing, const float *halves, const char *path)
{
    struct run *run = tracing->run;
    size_t count = (size_t)tracing->solution.count;
    struct rgb *map = alloc_array(count, sizeof *map);
    float *colours = alloc_array(count, BANDS * sizeof *colours);
    for (size_t i = 0; i < count; i++) {
        int32_t root = (int32_t)tracing->solution.leaves[i].id.root;
        const float *half = halves + i * HALVES * BANDS;
        map[i] = scene_root_material(run->scene, root)->emission;
        for (int c = 0; c < BANDS; c++) {
            map[i].band[c] += 0.5 * ((double)half[c] + (double)half[c + BANDS]);
            colours[i * BANDS + (size_t)c] = (float)map[i].band[c];
        }
    }
    struct tone tone = tone_choose(run->options.exposure, colours, (int64_t)count);
    solution_write(&tracing->solution, map, 1.0 / tone.exposure, path, &run->error);
    alloc_free(colours);
    alloc_free(map);
}

static void write_picture(struct tracing *tracing, float *picture,
                          const struct target *target)
{
    struct run *run = tracing->run;
    struct image image = {run->cameras->width, run->cameras->height, picture};
    struct tone tone = tone_choose(run->options.exposure, picture,
                                   (int64_t)image.width * image.height);
    image_write(&image, &tone, target, &run->error);
}

/* Collective. Prints the rays of all ranks, and the seconds of the slowest. */
static void report(const struct tracing *tracing, int64_t samples, double seconds)
{
    struct run *run = tracing->run;
    int64_t rays = tracing->pathtracer.counts->rays;
    comm_add(&run->comm, &rays, 1);
    seconds = comm_largest(&run->comm, seconds);
    run_say(run, "%lld paths, %lld rays, %.2f s, %.3f million/s", (long long)samples,
            (long long)rays, seconds, 1e-6 * (double)rays / seconds);
}

/* Collective. Traces once for all pictures, once for all meshes, and writes on rank 0. */
static void trace_and_write(struct tracing *tracing)
{
    struct run *run = tracing->run;
    double start = comm_seconds();
    int64_t pixels = 0, leaves = tracing->solution.count;
    float *picture = NULL, *halves = tracing->leaves ? trace_leaves(tracing) : NULL;
    for (int i = 0; i < run->options.output_count; i++)
        if (!format_is_mesh(run->options.outputs[i].format))
            pixels = (int64_t)run->cameras->width * run->cameras->height;
    if (pixels > 0)
        picture = trace_picture(tracing);
    report(tracing, (pixels + leaves) * tracing->samples, comm_seconds() - start);
    bool writes = run_goes_on(run) && run->comm.rank == 0;
    for (int i = 0; i < run->options.output_count && writes; i++) {
        const struct target *target = &run->options.outputs[i];
        if (format_is_mesh(target->format))
            write_leaves(tracing, halves, target->path);
        else
            write_picture(tracing, picture, target);
    }
    if (halves && writes && !run->options.quiet)
        print_norms(tracing, halves);
    alloc_free(halves);
    alloc_free(picture);
}

int main(int argc, char **argv)
{
    error_program = "pathtracer";
    struct run run = {0};
    struct tracing tracing = {.run = &run};
    bool parsed = run_start(&run, &argc, &argv) && take_own(&tracing, &argc, argv) &&
                  run_parse(&run, argc, argv) &&
                  (run.options.help || check_outputs(&tracing));
    if (parsed && run.options.help) {
        if (run.comm.rank == 0)
            puts(USAGE);
    } else if (parsed && read_all(&tracing)) {
        tracing.pathtracer = pathtracer_make(run.scene, run.octree);
        trace_and_write(&tracing);
    }
    pathtracer_free(&tracing.pathtracer);
    solution_mesh_free(&tracing.solution);
    return run_end(&run);
}
