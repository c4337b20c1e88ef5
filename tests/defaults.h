/* Whole runs as phr makes them, with its default options, and radiosity at a point as
 * pictures show it. For tests on one rank. */
#ifndef TESTS_DEFAULTS_H
#define TESTS_DEFAULTS_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/run/options.h"
#include "tests/scenes.h"
#include "tests/shaded.h"
#include "tests/solve.h"

/* Runs phr with these options, separated by single spaces, behind the scene. */
static inline struct criterion criterion_parse(const char *words)
{
    enum { WORDS_MAX = 32, TEXT_MAX = 256 };
    char text[TEXT_MAX];
    char *argv[WORDS_MAX] = {(char[]){"phr"}, (char[]){"scene.obj"}};
    int argc = 2;
    snprintf(text, sizeof text, "%s", words);
    for (char *word = strtok(text, " "); word && argc < WORDS_MAX;
         word = strtok(NULL, " "))
        argv[argc++] = word;
    struct options options;
    struct error error = {0};
    if (!options_parse(&options, argc, argv, &error)) {
        printf("Bail out! %s\n", error.text);
        exit(1);
    }
    struct criterion criterion = options.criterion;
    options_free(&options);
    return criterion;
}

static struct comm world_comm; /* that main() starts; of the only rank */

/* Prepares and solves a scene, and takes it over. */
static inline struct solution solve_scene(struct scene *scene, const char *words)
{
    return solve(&world_comm, prepared(scene), criterion_parse(words));
}

/* The same for a list of triangles, which is emptied. */
static inline struct solution solve_soup(struct soup *soup, const char *words)
{
    return solve_scene(scene_of_soup(soup), words);
}

/* --- answers --- */

/* Smooth shading of the light of the links. */
static inline struct shading *shade(const struct solution *s)
{
    return shading_create(s->solver->model.forest, NULL, NULL,
                          beyond_answer(s->solver)->outside);
}

/* Radiosity at a point in input units of one of the roots first .. first + count - 1, the
 * one that the point is on (or is least outside of). W/m^2, first band. */
static inline double shown_at(const struct solution *s, const struct shading *shading,
                              int32_t first, int32_t count, struct vec3 point)
{
    struct vec3 x = scene_from_input(s->scene, point);
    double best[3] = {0, 0, 0}, least = -HUGE_VAL;
    int32_t root = first;
    for (int32_t r = first; r < first + count; r++) {
        double weight[3];
        struct triangle t = scene_root_triangle(s->scene, r);
        triangle_weights(&t, x, weight);
        double lowest = fmin(weight[0], fmin(weight[1], weight[2]));
        if (lowest > least) {
            least = lowest;
            root = r;
            memcpy(best, weight, sizeof best);
        }
    }
    for (int k = 0; k < 3; k++)
        best[k] = fmax(best[k], 0.0);
    return shading_at(shading, shading->values, root, best).band[0];
}

#endif
