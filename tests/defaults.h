/* Whole runs as phr makes them, with its default options. For tests on one rank. */
#ifndef TESTS_DEFAULTS_H
#define TESTS_DEFAULTS_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/run/options.h"
#include "tests/scenes.h"
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

#endif
