/* Solves a scene with any options of phr and compares it with the truth that
 * tests/bench/reference.c has made: one line of CSV.
 *
 *   build/mpi/measure [--header] SCENE.obj REF [options of phr]
 *
 * The scene and the reference come first; --two-sided or --two-sided-lamps has to be
 * given where the reference was made with it. Outputs that are asked for are not written.
 *
 * The norms are those of tests/deviation.h, for three answers. `leaf`: the constant of a leaf, with
 * the mean of the truth over that leaf; where leaves are smaller than an element of the truth,
 * their mean over the element. The errors of small leaves cancel in that mean, so only numbers
 * that one reference gives can be compared. `shown`: the radiosity that pictures show, with the
 * truth at one point of each element; points that no light reaches at all, such as those that a
 * box covers, are left out. `root`: the mean of a root triangle, with the mean of the truth over
 * it; it judges the light that roots exchange, not the mesh. The seconds are those of linking and
 * iterating, with the octree; on several ranks, until the last is done. `emitters` is what turns
 * the relative RMS, which is that of the reflected light, into one relative to all radiosity,
 * emission included: multiply by it. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "geom/alloc.h"
#include "io/obj.h"
#include "io/options.h"
#include "io/shading.h"
#include "mpi/broadcast.h"
#include "tests/deviation.h"
#include "tests/solve.h"

static const char *const HEADER =
    "scene,options,seconds,links,rays,node_tests,triangle_tests,iterations,patches,leaf_rms,"
    "leaf_l1,leaf_median,shown_rms,shown_l1,shown_median,noise,shown_noise,emitters,"
    "leaf_bias,shown_bias,root_rms,root_l1,root_median,root_bias,root_noise";

struct measure {
    struct comm comm;
    struct node_block block; /* what the scene looks into */
    struct options options;
    const char *reference;
    bool header;
    struct truth truth;
    struct error error;
};

/* Collective. As phr.c does. */
static struct shading *shade(const struct measure *measure, const struct solution *s)
{
    const struct forest *forest = s->solver->method.forest;
    if (measure->options.flat)
        return shading_create(forest, NULL);
    int64_t leaves;
    uint8_t *open = shading_open_quarters(forest, s->octree, measure->comm.rank,
                                          measure->comm.size, &leaves);
    comm_add_bytes(&measure->comm, open, leaves);
    struct shading *shading = shading_create(forest, open);
    alloc_free(open);
    return shading;
}

/* --- the line --- */

static void print_options(const struct measure *measure, int argc, char **argv)
{
    printf("%s,", measure->options.scene);
    for (int i = 1, first = 1; i < argc; i++)
        if (argv[i] != measure->options.scene) {
            printf("%s%s", first ? "" : " ", argv[i]);
            first = 0;
        }
}

/* RMS of the reflected radiosity over that of all radiosity, black emitters included. */
static double share_of_reflected(const struct truth *truth, const struct scene *scene,
                                 const struct deviation *leaf)
{
    double emitted = 0.0, crossed = 0.0, area = 0.0;
    for (int32_t root = 0; root < scene_root_count(scene); root++)
        for (int c = 0; c < BANDS; c++) {
            double e = scene_root_material(scene, root)->emission.band[c];
            emitted += scene_root_area(scene, root) * e * e;
        }
    for (int64_t i = 0; i < truth->count; i++) {
        const struct element *element = &truth->items[i];
        int32_t root = (int32_t)element->id.root;
        double a = element_area(element, scene);
        area += a;
        for (int c = 0; c < BANDS; c++)
            crossed += a * scene_root_material(scene, root)->emission.band[c] *
                       (element->mean[0].band[c] + element->mean[1].band[c]);
    }
    double reflected_square = area * leaf->square;
    return sqrt(reflected_square / (reflected_square + crossed + emitted));
}

static void print_line(const struct measure *measure, const struct solution *s,
                       const struct deviation *leaf, const struct deviation *root,
                       const struct deviation *shown)
{
    const struct stats *stats = &s->stats;
    printf(",%.3f,%lld,%lld,%lld,%lld,%lld,%lld", s->seconds, (long long)stats->links,
           (long long)stats->rays, (long long)stats->node_tests, (long long)stats->triangle_tests,
           (long long)stats->iterations, (long long)stats->patches);
    if (stats->error_estimate > 0.0)
        fprintf(stderr, "estimate %.5f at epsilon %g\n", stats->error_estimate, stats->epsilon);
    printf(",%.5f,%.5f,%.5f,%.5f,%.5f,%.5f,%.5f,%.5f", leaf->rms, leaf->l1, leaf->median,
           shown->rms, shown->l1, shown->median, leaf->noise, shown->noise);
    printf(",%.4f,%.5f,%.5f", share_of_reflected(&measure->truth, s->scene, leaf), leaf->bias,
           shown->bias);
    printf(",%.5f,%.5f,%.5f,%.5f,%.5f\n", root->rms, root->l1, root->median, root->bias,
           root->noise);
}

/* --- running --- */

/* Takes --header and the reference, which follows the scene, out of the arguments; the rest is for
 * phr. Returns the number of arguments left. */
static int take_own(struct measure *measure, int argc, char **argv)
{
    int kept = 1;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--header") == 0)
            measure->header = true;
        else if (kept == 2 && !measure->reference)
            measure->reference = argv[i];
        else
            argv[kept++] = argv[i];
    }
    return kept;
}

/* Collective. The prepared scene on all ranks, the truth on rank 0; NULL on all after an error. */
static struct scene *read_all(struct measure *measure)
{
    struct obj_repairs read = {0};
    struct scene_repairs prepared;
    struct error *error = &measure->error;
    struct scene *scene = NULL;
    if (measure->comm.rank == 0 && (scene = obj_read(measure->options.scene, &read, error))) {
        scene->two_sided = measure->options.two_sided;
        scene->two_sided_lamps = measure->options.two_sided_lamps;
        if (scene_prepare(scene, &prepared, error))
            truth_read(&measure->truth, measure->reference, scene, error);
    }
    if (comm_agree(&measure->comm, error)) {
        measure->block = scene_broadcast(&measure->comm, node_policy(), &scene, NULL);
        return scene;
    }
    scene_destroy(scene);
    return NULL;
}

static void run(struct measure *measure, int argc, char **argv)
{
    struct scene *scene = read_all(measure);
    if (!scene)
        return;
    struct solution s = solve(&measure->comm, scene, measure->options.criterion);
    struct shading *shading = shade(measure, &s);
    if (s.vote.diverged)
        error_set(&measure->error, EXIT_FAILED, "the solution diverges");
    if (measure->comm.rank == 0 && !s.vote.diverged) {
        const struct forest *forest = s.solver->method.forest;
        struct deviation leaf = deviation_of_leaves(forest, &measure->truth);
        struct deviation root = deviation_of_roots(forest, &measure->truth);
        struct deviation shown = deviation_of_points(shading, &measure->truth);
        if (measure->header)
            printf("%s\n", HEADER);
        print_options(measure, argc, argv);
        print_line(measure, &s, &leaf, &root, &shown);
    }
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
                  "usage: measure [--header] SCENE.obj REF [options of phr]");
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
