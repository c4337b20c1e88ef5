/* pathtracer: pictures and solution meshes by path tracing alone, as references for
 * phr's.
 *
 *   make pathtracer
 *   build/pathtracer room.obj --view room.view --samples 256 -o truth.pfm
 *   build/pathtracer room.obj --leaves room.ply --samples 256 -o truth.ply
 *   imgdiff room.ply truth.ply -o error.ply
 *
 * Options of scene, camera and files are phr's; --samples is the number of paths a pixel,
 * or a leaf. With --leaves the output is a mesh with the leaves of that solution, each
 * with the mean of E + rho H over it, and the norms of the solution's error are printed,
 * as in tests/deviation.h: of the reflected light rho H alone, since E is given and would
 * hide any error; so black lamps are left out.
 *
 * The paths of a leaf make two independent estimates. The product of the deviations from
 * both has the square of the error as its expectation, whatever the noise; L1 and median
 * use the mean of both, and cannot show errors much below `noise`.
 *
 * Seeds are the numbers of pixels and leaves, which are dealt to the ranks in turn: files
 * do not depend on the number of ranks. Each rank reads the input for itself. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "geom/alloc.h"
#include "io/picture/imagefile.h"
#include "io/picture/texture.h"
#include "io/picture/viewpoint.h"
#include "io/run/options.h"
#include "io/run/files.h"
#include "io/scene/obj.h"
#include "io/scene/ply.h"
#include "io/scene/text.h"
#include "mpi/picture.h"
#include "tools/compare.h"
#include "tools/pixel.h"

enum { SAMPLES = 64, SAMPLES_MAX = 1 << 24, HALVES = 2 };

static const char USAGE[] = "usage: pathtracer SCENE [--leaves SOLUTION.ply] "
                            "[--samples N] [options of phr] -o FILE...";

struct tracing {
    struct comm comm;
    struct options options;
    const char *leaves; /* path of a solution, or NULL */
    int samples;        /* paths a pixel, or a leaf */
    struct scene *scene;
    struct octree *octree;
    struct camera camera;
    struct solution_mesh solution; /* of --leaves */
    struct pathtracer pathtracer;
    struct error error;
};

/* --- input --- */

/* Takes --leaves and --samples out of the arguments. Returns the number of the others. */
static int take_own(struct tracing *run, int argc, char **argv)
{
    double samples = SAMPLES;
    int kept = 1;
    for (int i = 1; i < argc; i++) {
        bool leaves = strcmp(argv[i], "--leaves") == 0;
        if (!leaves && strcmp(argv[i], "--samples") != 0)
            argv[kept++] = argv[i];
        else if (++i >= argc)
            error_set(&run->error, EXIT_USAGE, "%s needs a value", argv[i - 1]);
        else if (leaves)
            run->leaves = argv[i];
        else if (!text_is_number(argv[i], &samples) || !(samples >= HALVES) ||
                 samples > SAMPLES_MAX)
            error_set(&run->error, EXIT_USAGE, "--samples: %s is not between %d and %d",
                      argv[i], HALVES, SAMPLES_MAX);
    }
    run->samples = run->error.code == EXIT_DONE ? (int)samples : 0;
    return kept;
}

/* Checks the outputs: there has to be one, and meshes need --leaves and it needs a
 * mesh. */
static bool check_outputs(struct tracing *run)
{
    bool meshes = false;
    for (int i = 0; i < run->options.output_count; i++) {
        const struct target *target = &run->options.outputs[i];
        meshes = meshes || format_is_mesh(target->format);
        if (target->format == FORMAT_VTK)
            return error_set(&run->error, EXIT_USAGE, "%s: meshes are PLY here",
                             target->path);
    }
    if (run->options.output_count == 0 || !run->options.scene)
        return error_set(&run->error, EXIT_USAGE, "%s", USAGE);
    if (run->options.view_count > 1)
        return error_set(&run->error, EXIT_USAGE, "one view at a time");
    if (meshes != (run->leaves != NULL))
        return error_set(&run->error, EXIT_USAGE, "-o FILE.ply and --leaves go together");
    return true;
}

static bool read_scene(struct tracing *run)
{
    struct obj_repairs read = {.mean_of = texture_mean};
    struct scene_repairs prepared = {0};
    const char *path = run->options.scene;
    struct source source;
    if (source_open(&source, path, &run->error))
        run->scene = ply_is_meant(&source) ? ply_read(&source, &run->error)
                                           : obj_of_source(&source, &read, &run->error);
    source_close(&source);
    if (!run->scene)
        return false;
    if (run->options.ke == KE_RADIANCE)
        scene_take_radiances(run->scene);
    run->scene->two_sided = run->options.two_sided;
    run->scene->two_sided_lamps = run->options.two_sided_lamps;
    if (!scene_prepare(run->scene, &prepared, &run->error))
        return false;
    return scene_emitted_power(run->scene) > 0.0 ||
           error_set(&run->error, EXIT_USAGE, "%s: nothing emits light", path);
}

/* Reads the solution of --leaves. */
static bool read_leaves(struct tracing *run)
{
    if (!run->leaves)
        return true;
    struct source source;
    bool good = source_open(&source, run->leaves, &run->error) &&
                solution_mesh_read(&run->solution, &source, &run->error);
    source_close(&source);
    if (!good)
        return false;
    for (int64_t i = 0; i < run->solution.count; i++) {
        uint32_t root = run->solution.leaves[i].id.root;
        if (root >= (uint32_t)scene_root_count(run->scene) ||
            !(scene_root_area(run->scene, (int32_t)root) > 0.0))
            return error_set(&run->error, EXIT_USAGE, "%s: not a solution of %s",
                             run->leaves, run->options.scene);
    }
    return true;
}

static bool read_camera(struct tracing *run)
{
    const struct options *options = &run->options;
    int width = options->width > 0 ? options->width : CAMERA_SIZE;
    int height = options->width > 0 ? options->height : CAMERA_SIZE;
    if (options->view_count == 0)
        run->camera = viewpoint_choose(run->scene, run->octree, NULL, width, height);
    else if (!camera_read(options->views[0], &run->camera, &run->error))
        return false;
    if (options->width > 0) {
        run->camera.width = width;
        run->camera.height = height;
    }
    return true;
}

/* Collective. */
static bool read_all(struct tracing *run)
{
    if (read_scene(run) && read_leaves(run)) {
        run->octree = octree_create(run->scene->triangles, run->scene->planes,
                                    run->scene->input_count);
        read_camera(run);
    }
    if (run->comm.rank == 0 && run->error.code == EXIT_DONE &&
        files_check(&run->options, &run->error))
        files_probe(&run->options, &run->error);
    return comm_agree(&run->comm, &run->error);
}

/* --- tracing --- */

/* Collective. Returns the picture on rank 0, top scanline first. */
static float *trace_picture(const struct tracing *run)
{
    int width = run->camera.width, height = run->camera.height;
    size_t length = (size_t)width * BANDS;
    int scanlines = (height + run->comm.size - 1) / run->comm.size;
    float *own = alloc_array((size_t)scanlines * length, sizeof *own), *at = own;
    for (int y = run->comm.rank; y < height; y += run->comm.size)
        for (int x = 0; x < width; x++) {
            uint64_t seed = (uint64_t)y * IMAGE_SIZE_MAX + (uint64_t)x;
            struct rgb b = pathtracer_pixel(&run->pathtracer, &run->camera, x, y,
                                            run->samples, seed);
            for (int c = 0; c < BANDS; c++)
                *at++ = (float)b.band[c];
        }
    return picture_gather(&run->comm, own, length, height);
}

/* Collective. Returns two estimates of rho H for each leaf, HALVES * BANDS floats, on
 * rank 0. */
static float *trace_leaves(const struct tracing *run)
{
    int64_t count = run->solution.count, size = run->comm.size;
    size_t length = HALVES * BANDS;
    float *own = alloc_array((size_t)(count / size + 1) * length, sizeof *own), *at = own;
    for (int64_t i = run->comm.rank; i < count; i += size) {
        struct patch_id id = run->solution.leaves[i].id;
        struct triangle part = pathtracer_part(id);
        uint64_t seed = id_number(id) << 1;
        for (uint64_t half = 0; half < HALVES; half++) {
            struct rgb h = pathtracer_reflected(&run->pathtracer, (int32_t)id.root, &part,
                                                run->samples / HALVES, seed + half);
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

/* Prints the norms over all leaves that reflect. */
static void print_norms(const struct tracing *run, const float *halves)
{
    const struct solution_mesh *solution = &run->solution;
    struct norms norms = {.count = 0};
    norms.offs = alloc_array((size_t)solution->count, sizeof *norms.offs);
    for (int64_t i = 0; i < solution->count; i++) {
        const struct solution_leaf *leaf = &solution->leaves[i];
        const struct material *material =
            scene_root_material(run->scene, (int32_t)leaf->id.root);
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
static void write_leaves(struct tracing *run, const float *halves, const char *path)
{
    size_t count = (size_t)run->solution.count;
    struct rgb *map = alloc_array(count, sizeof *map);
    float *colours = alloc_array(count, BANDS * sizeof *colours);
    for (size_t i = 0; i < count; i++) {
        int32_t root = (int32_t)run->solution.leaves[i].id.root;
        const float *half = halves + i * HALVES * BANDS;
        map[i] = scene_root_material(run->scene, root)->emission;
        for (int c = 0; c < BANDS; c++) {
            map[i].band[c] += 0.5 * ((double)half[c] + (double)half[c + BANDS]);
            colours[i * BANDS + (size_t)c] = (float)map[i].band[c];
        }
    }
    double exposure = run->options.exposure;
    if (!(exposure > 0.0))
        exposure = tone_automatic(colours, (int64_t)count);
    solution_write(&run->solution, map, 1.0 / exposure, path, &run->error);
    alloc_free(colours);
    alloc_free(map);
}

static void write_picture(struct tracing *run, float *picture,
                          const struct target *target)
{
    struct image image = {run->camera.width, run->camera.height, picture};
    double exposure = run->options.exposure;
    if (!(exposure > 0.0))
        exposure = tone_automatic(picture, (int64_t)image.width * image.height);
    struct tone tone = tone_make(exposure);
    image_write(&image, &tone, target, &run->error);
}

/* Collective. Prints the rays of all ranks, and the seconds of the slowest. */
static void report(const struct tracing *run, int64_t samples, double seconds)
{
    int64_t rays = run->pathtracer.counts->rays;
    comm_add(&run->comm, &rays, 1);
    seconds = comm_largest(&run->comm, seconds);
    if (run->comm.rank == 0 && !run->options.quiet)
        fprintf(stderr, "pathtracer: %lld paths, %lld rays, %.2f s, %.3f million/s\n",
                (long long)samples, (long long)rays, seconds,
                1e-6 * (double)rays / seconds);
}

/* Collective. Traces once for all pictures, once for all meshes, and writes on rank 0. */
static void trace_and_write(struct tracing *run)
{
    double start = comm_seconds();
    int64_t pixels = 0, leaves = run->solution.count;
    float *picture = NULL, *halves = run->leaves ? trace_leaves(run) : NULL;
    for (int i = 0; i < run->options.output_count; i++)
        if (!format_is_mesh(run->options.outputs[i].format))
            pixels = (int64_t)run->camera.width * run->camera.height;
    if (pixels > 0)
        picture = trace_picture(run);
    report(run, (pixels + leaves) * run->samples, comm_seconds() - start);
    for (int i = 0; i < run->options.output_count && run->comm.rank == 0; i++) {
        const struct target *target = &run->options.outputs[i];
        if (format_is_mesh(target->format))
            write_leaves(run, halves, target->path);
        else
            write_picture(run, picture, target);
    }
    if (halves && run->comm.rank == 0 && !run->options.quiet)
        print_norms(run, halves);
    alloc_free(halves);
    alloc_free(picture);
}

static void release(struct tracing *run)
{
    pathtracer_free(&run->pathtracer);
    solution_mesh_free(&run->solution);
    octree_destroy(run->octree);
    scene_destroy(run->scene);
    options_free(&run->options);
}

int main(int argc, char **argv)
{
    struct tracing run = {.leaves = NULL};
    comm_start(&run.comm, &argc, &argv);
    argc = take_own(&run, argc, argv);
    bool parsed = run.error.code == EXIT_DONE &&
                  options_parse(&run.options, argc, argv, &run.error) &&
                  (run.options.help || check_outputs(&run));
    if (parsed && run.options.help) {
        if (run.comm.rank == 0)
            puts(USAGE);
    } else if (parsed && read_all(&run)) {
        run.pathtracer = pathtracer_make(run.scene, run.octree);
        trace_and_write(&run);
    }
    comm_agree(&run.comm, &run.error);
    if (run.error.code != EXIT_DONE && run.comm.rank == 0)
        fprintf(stderr, "pathtracer: %s\n", run.error.text);
    release(&run);
    comm_stop(&run.comm);
    if (alloc_balance() != 0) {
        fprintf(stderr, "pathtracer: BUG: %lld blocks of memory were not freed\n",
                (long long)alloc_balance());
        return EXIT_FAILED;
    }
    return run.error.code;
}
