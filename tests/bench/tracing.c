/* A plain path tracer beside phr: its error at the elements and points of a reference, and the
 * seconds it takes, one line of CSV for each number of paths.
 *
 *   make chart, or  build/mpi/tracing SCENE.obj REF SAMPLES...
 *
 * `leaf` is the mean over each element by SAMPLES paths, `shown` the value at each point by as
 * many; the norms are those of tests/deviation.h. Its seeds are not those of the reference. The
 * seconds are those of the means with the octree, on one rank; the points take about as long.
 * The columns: paths, seconds, then RMS, L1 and median of `leaf` and of `shown`. */
#include <stdio.h>
#include <stdlib.h>

#include "geom/alloc.h"
#include "io/obj.h"
#include "mpi/comm.h"
#include "tests/deviation.h"

/* Beyond all seeds of tests/truth.c. */
static const uint64_t SEEDS = UINT64_C(1) << 40;

/* The part of its root that an element is, or its point, in barycentric coordinates. */
static struct triangle part_of(const struct element *element, bool point)
{
    struct vec3 x = {element->weight[0], element->weight[1], element->weight[2]};
    struct triangle part = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (int step = 0; step < id_level(element->id); step++)
        part = triangle_child(&part, id_step(element->id, step));
    return point ? (struct triangle){{x, x, x}} : part;
}

static bool is_black(const struct element *element)
{
    return rgb_sum(element->point[0]) + rgb_sum(element->point[1]) == 0.0;
}

/* Points that no light reaches are left out, as tests/bench/measure.c does. */
static struct deviation compare(const struct truth *truth, const struct pathtracer *pathtracer,
                                int samples, bool points)
{
    struct sample *list = alloc_array((size_t)truth->count, sizeof *list);
    int64_t count = 0;
    for (int64_t i = 0; i < truth->count; i++) {
        const struct element *element = &truth->items[i];
        if (points && is_black(element))
            continue;
        struct triangle part = part_of(element, points);
        const struct rgb *halves = points ? element->point : element->mean;
        uint64_t seed = SEEDS + (uint64_t)(2 * i + points);
        list[count++] = (struct sample){
            .area = element_area(element, pathtracer->scene),
            .value = pathtracer_reflected(pathtracer, (int32_t)element->id.root, &part, samples,
                                          seed),
            .truth = {halves[0], halves[1]}};
    }
    struct deviation deviation = deviation_of(list, count);
    alloc_free(list);
    return deviation;
}

static void print_line(const struct scene *scene, const struct truth *truth, int samples)
{
    double start = comm_seconds();
    struct octree *octree = octree_create(scene->triangles, scene->planes, scene->input_count);
    struct pathtracer pathtracer = pathtracer_make(scene, octree);
    struct deviation leaf = compare(truth, &pathtracer, samples, false);
    double seconds = comm_seconds() - start;
    struct deviation shown = compare(truth, &pathtracer, samples, true);
    printf("%d,%.3f,%.5f,%.5f,%.5f,%.5f,%.5f,%.5f\n", samples, seconds, leaf.rms, leaf.l1,
           leaf.median, shown.rms, shown.l1, shown.median);
    pathtracer_free(&pathtracer);
    octree_destroy(octree);
}

int main(int argc, char **argv)
{
    struct comm comm;
    struct error error = {0};
    struct obj_repairs read = {0};
    struct scene_repairs prepared;
    struct truth truth = {.count = 0};
    comm_start(&comm, &argc, &argv);
    struct scene *scene = NULL;
    if (argc < 4)
        error_set(&error, EXIT_USAGE, "usage: tracing SCENE.obj REF SAMPLES...");
    else
        scene = obj_read(argv[1], &read, &error);
    if (scene && scene_prepare(scene, &prepared, &error) &&
        truth_read(&truth, argv[2], scene, &error))
        for (int i = 3; i < argc && atoi(argv[i]) > 0; i++)
            print_line(scene, &truth, atoi(argv[i]));
    if (error.code != EXIT_DONE)
        fprintf(stderr, "tracing: %s\n", error.text);
    truth_free(&truth);
    scene_destroy(scene);
    comm_stop(&comm);
    return error.code;
}
