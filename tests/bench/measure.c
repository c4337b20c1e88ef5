/* Solves a scene with any options of phr and compares it with the truth that
 * tests/bench/reference.c has made: one line of CSV.
 *
 *   build/mpi/measure [--header] [--trace] SCENE.obj REF [options of phr]
 *
 * With --trace a second line tells of a path tracer (rad/beyond/paths.c, with next event
 * estimation) that finds the same leaves in about the same time: as many paths for each
 * leaf as the seconds allow, and as many for each point where `shown` is measured. Its
 * seconds are those of the leaves, with an octree of its own, on one rank. Its error
 * falls as one over their square root, which tells its seconds for as small an error.
 *
 * The scene and the reference come first; --two-sided or --two-sided-lamps has to be
 * given where the reference was made with it. Outputs that are asked for are not written.
 *
 * The norms are those of tests/deviation.h, for three answers. `leaf`: the constant of a
 * leaf, with the mean of the truth over that leaf; where leaves are smaller than an
 * element of the truth, their mean over the element. The errors of small leaves cancel in
 * that mean, so only numbers that one reference gives can be compared. `shown`: the
 * radiosity that pictures show, with the truth at one point of each element; points that
 * no light reaches at all, such as those that a box covers, are left out. `root`: the
 * mean of a root triangle, with the mean of the truth over it; it judges the light that
 * roots exchange, not the mesh. The seconds are those of linking, iterating and the final
 * gather, with the octree: of the processor, on several ranks those until the last is
 * done; a short run is made twice, and the second counts, as the path tracer's last one
 * finds its code and memory warm. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mpi/beyond/beyond.h"
#include "geom/alloc.h"
#include "io/picture/render.h"
#include "io/run/options.h"
#include "tests/deviation.h"
#include "tests/reading.h"
#include "tests/solve.h"

static const char *const HEADER =
    "scene,options,seconds,links,rays,node_tests,triangle_tests,iterations,patches,"
    "leaf_rms,leaf_l1,leaf_median,shown_rms,shown_l1,shown_median,noise,shown_noise,"
    "leaf_bias,shown_bias,root_rms,root_l1,root_median,root_bias,root_noise,leaves,work";

/* Seconds, below which first touches of code and memory show. */
static const double SHORT = 0.1;

/* Beyond all seeds of tests/truth.c. */
static const uint64_t SEEDS = UINT64_C(1) << 40;

struct measure {
    struct comm comm;
    struct node_block block; /* the memory of the scene */
    struct options options;
    const char *reference;
    bool header, trace;
    struct truth truth;
    struct error error;
};

/* As tools/results.c does. */
static struct shading *shade(const struct measure *measure, const struct solution *s)
{
    const struct forest *forest = s->solver->model.forest;
    const struct answer *answer = beyond_answer(s->solver);
    if (measure->options.flat)
        return shading_create_flat(forest);
    if (measure->options.pixels)
        return NULL;
    return shading_create(forest, s->octree, answer->straight, answer->error,
                          answer->open);
}

/* --- the line --- */

/* An answer, by phr or by the path tracer. */
struct measured {
    struct stats stats; /* 0 where one does not apply */
    double seconds;
    int64_t leaves; /* those that reflect */
    int64_t work;   /* in tests of the octree */
    struct deviation leaf, root, shown;
};

static void print_options(const struct measure *measure, int argc, char **argv)
{
    printf("%s,", measure->options.scene);
    for (int i = 1, first = 1; i < argc; i++)
        if (argv[i] != measure->options.scene) {
            printf("%s%s", first ? "" : " ", argv[i]);
            first = 0;
        }
}

static void print_line(const struct measured *answer)
{
    const struct stats *stats = &answer->stats;
    const struct deviation *leaf = &answer->leaf, *shown = &answer->shown;
    const struct deviation *root = &answer->root;
    printf(",%.5f,%lld,%lld,%lld,%lld,%lld,%lld", answer->seconds,
           (long long)stats->links, (long long)stats->rays,
           (long long)stats->node_tests, (long long)stats->triangle_tests,
           (long long)stats->iterations, (long long)stats->patches);
    printf(",%.5f,%.5f,%.5f,%.5f,%.5f,%.5f,%.5f,%.5f", leaf->rms, leaf->l1, leaf->median,
           shown->rms, shown->l1, shown->median, leaf->noise, shown->noise);
    printf(",%.5f,%.5f,%.5f,%.5f,%.5f,%.5f,%.5f,%lld,%lld\n", leaf->bias, shown->bias,
           root->rms, root->l1, root->median, root->bias, root->noise,
           (long long)answer->leaves, (long long)answer->work);
}

/* --- the path tracer --- */

static bool reflects(const struct forest *forest, int64_t patch)
{
    int32_t root = (int32_t)forest->patches[patch].id.root;
    return scene_root_area(forest->scene, root) > 0.0 &&
           rgb_sum(scene_root_material(forest->scene, root)->reflectance) > 0.0;
}

/* Puts E + rho H by so many paths into each leaf that reflects, and the means of their
 * children into the others. Returns the number of leaves. */
static int64_t trace_leaves(struct forest *forest, const struct pathtracer *pathtracer,
                            int paths)
{
    int64_t leaves = 0;
    for (int64_t i = forest->count - 1; i >= 0; i--) {
        struct patch *patch = &forest->patches[i];
        int32_t root = (int32_t)patch->id.root;
        if (!reflects(forest, i))
            continue;
        if (!patch_is_leaf(patch)) {
            patch_average(forest, (int32_t)i, forest->radiosity);
            continue;
        }
        struct triangle part = pathtracer_part(patch->id);
        forest->radiosity[i] = pathtracer_reflected(pathtracer, root, &part, paths,
                                                    SEEDS + 2 * (uint64_t)i);
        for (int c = 0; c < BANDS; c++)
            forest->radiosity[i].band[c] +=
                scene_root_material(forest->scene, root)->emission.band[c];
        leaves++;
    }
    return leaves;
}

/* As deviation_of_points() has them, but at `most` points of the truth, evenly chosen. */
static struct deviation trace_points(const struct truth *truth, int64_t most,
                                     const struct pathtracer *pathtracer, int paths)
{
    struct sample *samples = alloc_array((size_t)truth->count, sizeof *samples);
    int64_t count = 0, step = 1 + (truth->count - 1) / most;
    for (int64_t i = 0; i < truth->count; i += step) {
        const struct element *element = &truth->items[i];
        if (element_is_black(element))
            continue;
        struct vec3 x = {element->weight[0], element->weight[1], element->weight[2]};
        struct triangle point = {{x, x, x}};
        samples[count++] = (struct sample){
            .area = element_area(element, pathtracer->scene),
            .value = pathtracer_reflected(pathtracer, (int32_t)element->id.root, &point,
                                          paths, SEEDS + 2 * (uint64_t)i + 1),
            .truth = {element->point[0], element->point[1]}};
    }
    struct deviation deviation = deviation_of(samples, count);
    alloc_free(samples);
    return deviation;
}

/* The solution's leaves by paths in about as many seconds; their radiosities are lost. */
static void trace(const struct measure *measure, struct solution *s, double seconds)
{
    enum { GROWTH = 8 };
    const struct scene *scene = s->scene;
    struct forest *forest = s->solver->model.forest;
    double start = seconds_of_work(&measure->comm), spent, paths = 1.0, growth;
    struct octree *octree = octree_of(scene);
    struct pathtracer pathtracer = pathtracer_make(scene, octree);
    double building = seconds_of_work(&measure->comm) - start;
    struct measured answer = {.stats.patches = s->stats.patches};
    for (;; paths = ceil(paths * growth)) {
        *pathtracer.counts = (struct octree_counts){.rays = 0};
        start = seconds_of_work(&measure->comm);
        answer.leaves = trace_leaves(forest, &pathtracer, (int)paths);
        spent = building + seconds_of_work(&measure->comm) - start;
        growth = fmin(seconds / spent, GROWTH);
        if (growth < 1.5)
            break;
    }
    answer.seconds = spent;
    answer.stats.rays = pathtracer.counts->rays;
    answer.stats.node_tests = pathtracer.counts->node_tests;
    answer.stats.triangle_tests = pathtracer.counts->triangle_tests;
    answer.leaf = deviation_of_leaves(forest, &measure->truth);
    answer.root = deviation_of_roots(forest, &measure->truth);
    answer.shown = trace_points(&measure->truth, answer.leaves, &pathtracer, (int)paths);
    printf("%s,%.0f paths a leaf", measure->options.scene, paths);
    print_line(&answer);
    pathtracer_free(&pathtracer);
    octree_destroy(octree);
}

/* --- running --- */

/* Takes --header, --trace and the reference, which follows the scene, out of the
 * arguments; the rest is for phr. Returns the number of arguments left. */
static int take_own(struct measure *measure, int argc, char **argv)
{
    int kept = 1;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--header") == 0)
            measure->header = true;
        else if (strcmp(argv[i], "--trace") == 0)
            measure->trace = true;
        else if (kept == 2 && !measure->reference)
            measure->reference = argv[i];
        else
            argv[kept++] = argv[i];
    }
    return kept;
}

/* Collective. The prepared scene on all ranks, the truth on rank 0; NULL after an
 * error. */
static struct scene *read_all(struct measure *measure)
{
    const struct options *options = &measure->options;
    struct reading reading = {.path = options->scene,
                              .two_sided = options->two_sided,
                              .two_sided_lamps = options->two_sided_lamps,
                              .radiances = options->ke == KE_RADIANCE};
    struct scene *scene =
        scene_read_by_all(&measure->comm, reading, &measure->block, &measure->error);
    if (scene && measure->comm.rank == 0)
        truth_read(&measure->truth, measure->reference, scene, &measure->error);
    if (comm_agree(&measure->comm, &measure->error))
        return scene;
    scene_destroy(scene);
    node_block_destroy(&measure->block);
    return NULL;
}

static void report(const struct measure *measure, struct solution *s,
                   const struct shading *shading, int argc, char **argv)
{
    const struct forest *forest = s->solver->model.forest;
    bool gathers = s->solver->beyond->answer->straight && !measure->options.flat;
    struct renderer renderer =
        renderer_make(s->octree, shading,
                      gathers ? s->solver->beyond->answer->gather : NULL);
    struct measured answer = {
        .stats = s->stats,
        .seconds = s->seconds,
        .work = model_work(&s->solver->model),
        .leaf = deviation_of_leaves(forest, &measure->truth),
        .root = deviation_of_roots(forest, &measure->truth),
        .shown = deviation_of_points(&renderer, s->scene, &measure->truth)};
    for (int64_t i = 0; i < forest->count; i++)
        answer.leaves += reflects(forest, i) && patch_is_leaf(&forest->patches[i]);
    if (measure->header)
        printf("%s\n", HEADER);
    print_options(measure, argc, argv);
    print_line(&answer);
    if (measure->trace)
        trace(measure, s, s->seconds);
}

static void run(struct measure *measure, int argc, char **argv)
{
    struct scene *scene = read_all(measure);
    if (!scene)
        return;
    struct solution s = solve(&measure->comm, scene, measure->options.criterion);
    if (comm_largest(&measure->comm, s.seconds) < SHORT) {
        solver_destroy(s.solver);
        octree_destroy(s.octree);
        s = solve(&measure->comm, scene, measure->options.criterion);
    }
    struct shading *shading = shade(measure, &s);
    if (s.vote.diverged)
        error_set(&measure->error, EXIT_FAILED, "the solution diverges");
    if (measure->comm.rank == 0 && !s.vote.diverged)
        report(measure, &s, shading, argc, argv);
    shading_destroy(shading);
    solution_free(&s);
    node_block_destroy(&measure->block);
}

int main(int argc, char **argv)
{
    struct measure measure = {.reference = NULL};
    comm_start(&measure.comm, &argc, &argv);
    argc = take_own(&measure, argc, argv);
    if (!measure.reference)
        error_set(&measure.error, EXIT_USAGE,
                  "usage: measure [--header] [--trace] SCENE.obj REF [options of phr]");
    else if (options_parse(&measure.options, argc, argv, &measure.error))
        run(&measure, argc, argv);
    comm_agree(&measure.comm, &measure.error);
    if (measure.error.code != EXIT_DONE && measure.comm.rank == 0)
        fprintf(stderr, "measure: %s\n", measure.error.text);
    truth_free(&measure.truth);
    options_free(&measure.options);
    comm_stop(&measure.comm);
    return measure.error.code;
}
