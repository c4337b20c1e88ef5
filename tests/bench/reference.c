/* Makes the truth about a scene: a file that tests/bench/measure.c compares solutions
 * with.
 *
 *   make errors
 *   mpiexec -n 2 build/mpi/reference scenes/cornell.obj cornell.ref
 *   build/mpi/measure scenes/cornell.obj cornell.ref --epsilon 1e-4
 *
 * ELEMENTS (20000) sets their size: each has at most that share of all area that
 * reflects.
 * SAMPLES (1000) is the number of light paths, for each element, of each of the two
 * estimates of their means, and a quarter of that the number of paths from its point
 * (tests/truth.c).
 *
 * The file is the same bytes on any number of ranks. The noise falls as one over the
 * square root of SAMPLES, and the time grows with the elements times SAMPLES. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/deviation.h"
#include "tests/reading.h"

enum { ELEMENTS = 20000, SAMPLES = 1000, MOST = 1000000000 };

struct arguments {
    struct reading scene;
    const char *out;
    long long numbers[2]; /* elements, samples */
    bool no_points;       /* means alone */
};

static bool is_count(const char *text, long long *count)
{
    char *end;
    *count = strtoll(text, &end, 10);
    return *end == '\0' && *count >= 1 && *count <= MOST;
}

static bool parse(struct arguments *arguments, int argc, char **argv, struct error *error)
{
    int paths = 0, numbers = 0;
    *arguments = (struct arguments){.numbers = {ELEMENTS, SAMPLES}};
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--two-sided") == 0)
            arguments->scene.two_sided = true;
        else if (strcmp(argv[i], "--two-sided-lamps") == 0)
            arguments->scene.two_sided = arguments->scene.two_sided_lamps = true;
        else if (strcmp(argv[i], "--no-points") == 0)
            arguments->no_points = true;
        else if (strcmp(argv[i], "--sky") == 0 && i + 1 < argc)
            arguments->scene.sky = strtod(argv[++i], NULL);
        else if (paths < 2)
            *(paths++ == 0 ? &arguments->scene.path : &arguments->out) = argv[i];
        else if (numbers == 2 || !is_count(argv[i], &arguments->numbers[numbers++]))
            return error_set(error, EXIT_USAGE, "what is %s?", argv[i]);
    }
    return paths == 2 ||
           error_set(error, EXIT_USAGE,
                     "usage: reference SCENE.obj OUT.ref [--two-sided[-lamps]] [--sky W] "
                     "[--no-points] [ELEMENTS [SAMPLES]]");
}

static void make_reference(const struct comm *comm, const struct arguments *arguments,
                           const struct scene *scene, struct error *error)
{
    double start = comm_seconds();
    struct octree *octree =
        octree_create(scene->triangles, scene_blocking_planes(scene),
                      scene->input_count);
    int samples = (int)arguments->numbers[1];
    struct truth_paths paths = {samples, arguments->no_points ? 0 : (samples + 3) / 4};
    struct truth truth =
        truth_trace(comm, scene, octree, arguments->numbers[0], paths);
    if (comm->rank == 0 && truth_write(&truth, arguments->out, error))
        printf("%s: %lld elements, %lld light paths each twice, %.1f s on %d rank(s); "
               "noise of elements %.2f %%, of points %.2f %%\n",
               arguments->out, (long long)truth.count, arguments->numbers[1],
               comm_seconds() - start, comm->size,
               100.0 * truth_noise(&truth, scene, false),
               100.0 * truth_noise(&truth, scene, true));
    truth_free(&truth);
    octree_destroy(octree);
}

int main(int argc, char **argv)
{
    struct comm comm;
    struct error error = {0};
    struct arguments arguments;
    comm_start(&comm, &argc, &argv);
    struct scene *scene = NULL;
    struct node_block block = {.data = NULL};
    if (parse(&arguments, argc, argv, &error))
        scene = scene_read_by_all(&comm, arguments.scene, &block, &error);
    if (scene && !(scene_emitted_power(scene) > 0.0))
        error_set(&error, EXIT_USAGE, "%s: nothing emits light", arguments.scene.path);
    else if (scene)
        make_reference(&comm, &arguments, scene, &error);
    comm_agree(&comm, &error);
    if (error.code != EXIT_DONE && comm.rank == 0)
        fprintf(stderr, "reference: %s\n", error.text);
    scene_destroy(scene);
    node_block_destroy(&block);
    comm_stop(&comm);
    return error.code;
}
