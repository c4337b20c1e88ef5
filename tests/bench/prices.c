/* prices SCENE [OPTIONS of phr]: what a test and a form factor take.
 *
 * A level of refinement on one rank has counts, of tests and of form factors, and seconds
 * of the processor, the least of TURNS runs. The two prices are those that predict the
 * levels of SHORTEST seconds and more with the least relative error, RMS. One line: these
 * levels; nanoseconds a test; the price of form factors over that of the tests that they
 * count as; and the error of prediction, RMS and largest, in per cent: by both prices, by
 * counted work alone, and by tests alone. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/run/options.h"
#include "tests/reading.h"
#include "tests/solve.h"

enum { TURNS = 7, LEVELS_MAX = 1000 };

static const double SHORTEST = 4e-3;

/* Work: tests, and form factors, counted as tests. */
struct level {
    double work[2], seconds;
    int64_t pass;
};

static struct level levels[LEVELS_MAX], begun;
static int count; /* of levels */
static struct run *running;

static struct level now(void)
{
    const struct solver *solver = running->solver;
    double all = (double)model_work(&solver->model);
    double factors = (double)solver->model.estimating;
    return (struct level){{all - factors, factors}, (double)clock() / CLOCKS_PER_SEC,
                          solver->turn.pass};
}

/* Called before the first link of a level: the end of the one before in its pass. */
static void end_level(struct progress *progress)
{
    if (progress->share > 0.0 || strcmp(progress->phase, "refining") != 0)
        return;
    struct level end = now();
    if (end.pass == begun.pass && count < LEVELS_MAX) {
        struct level *level = &levels[count++];
        double seconds = end.seconds - begun.seconds;
        for (int k = 0; k < 2; k++)
            level->work[k] = end.work[k] - begun.work[k];
        if (level->seconds == 0.0 || seconds < level->seconds)
            level->seconds = seconds;
    }
    begun = now();
}

static void run_once(const struct comm *comm, struct scene *scene,
                     const struct options *options)
{
    struct run run = {.comm = *comm, .scene = scene, .options = *options};
    run.options.quiet = true;
    run.octree = octree_of(scene);
    run.progress.progress.show = end_level;
    running = &run;
    count = 0;
    begun.pass = -1;
    compute_light(&run);
    solver_destroy(run.solver);
    octree_destroy(run.octree);
}

/* Prints the errors of a prediction by these prices of the two kinds of work. */
static void print_errors(const double price[2])
{
    double squares = 0.0, largest = 0.0;
    int used = 0;
    for (int i = 0; i < count; i++) {
        const struct level *level = &levels[i];
        if (level->seconds < SHORTEST)
            continue;
        double error = (level->work[0] * price[0] + level->work[1] * price[1]) /
                           level->seconds - 1.0;
        squares += error * error;
        largest = fmax(largest, fabs(error));
        used++;
    }
    printf("  %.1f %.1f", 100.0 * sqrt(squares / used), 100.0 * largest);
}

/* Least squares of work * price / seconds - 1, by the normal equations. */
static void fit(void)
{
    double aa = 0.0, ab = 0.0, bb = 0.0, a = 0.0, b = 0.0;
    int used = 0;
    for (int i = 0; i < count; i++) {
        const struct level *level = &levels[i];
        double x = level->work[0] / level->seconds, y = level->work[1] / level->seconds;
        if (level->seconds < SHORTEST)
            continue;
        aa += x * x, ab += x * y, bb += y * y, a += x, b += y;
        used++;
    }
    double both[2] = {(a * bb - b * ab) / (aa * bb - ab * ab),
                      (b * aa - a * ab) / (aa * bb - ab * ab)};
    double counted = (a + b) / (aa + 2.0 * ab + bb);
    printf("%d  %.1f %.2f", used, 1e9 * both[0], both[1] / both[0]);
    print_errors(both);
    print_errors((double[2]){counted, counted});
    print_errors((double[2]){a / aa, 0.0});
    printf("\n");
}

int main(int argc, char **argv)
{
    struct comm comm;
    struct options options = {0};
    struct error error = {0};
    comm_start(&comm, &argc, &argv);
    struct scene *scene = NULL;
    if (!options_parse(&options, argc, argv, &error) ||
        !(scene = scene_read((struct reading){.path = options.scene}, &error))) {
        fprintf(stderr, "prices SCENE [OPTIONS of phr] %s\n", error.text);
        return EXIT_FAILURE;
    }
    for (int turn = 0; turn < TURNS; turn++)
        run_once(&comm, scene, &options);
    fit();
    scene_destroy(scene);
    options_free(&options);
    comm_stop(&comm);
    return EXIT_SUCCESS;
}
