/* Fuzzing PLY: reading and preparing a scene; reading a solution, and showing it as phr
 * does. */
#include "io/scene/ply.h"

#include "tests/fuzz/fuzz.h"
#include "tests/memory.h"
#include "tests/reading.h"
#include "tools/compare.h"
#include "tools/results.h"
#include "tools/stored.h"

static void read_scene(const uint8_t *data, size_t size)
{
    struct error error = {0};
    struct scene_repairs prepared;
    struct source source;
    struct scene *scene = NULL;
    if (source_of_bytes(&source, "fuzz.ply", data, size, &error))
        scene = ply_read(&source, &error);
    source_close(&source);
    FUZZ_PROMISE(!scene == (error.code != EXIT_DONE));
    bool good = scene && scene_prepare(scene, &prepared, &error);
    for (int32_t i = 0; scene && i < scene->input_count; i++)
        FUZZ_PROMISE(scene->material_of[i] >= 0 &&
                     scene->material_of[i] < scene->material_count);
    for (int32_t i = 0; scene && i < scene->material_count; i++)
        FUZZ_PROMISE(rgb_sum(scene->materials[i].reflectance) >= 0.0 &&
                     rgb_sum(scene->materials[i].emission) >= 0.0);
    scene_destroy(scene);
    fuzz_verdict(good, &error);
}

/* A solution that is read is one that pictures and meshes can be made of. */
static void show_solution(struct solution_mesh *solution)
{
    char *arguments[] = {"phr", "fuzz.ply", "-o", "pfm:/dev/null", "-o", "ply:/dev/null"};
    struct run run = {
        .comm = *fuzz_alone(), .scene = solution->scene, .stored = solution};
    struct camera camera = {.width = 3, .height = 2};
    run.cameras = &camera;
    options_parse(&run.options, sizeof arguments / sizeof *arguments, arguments,
                  &run.error);
    run.octree = octree_create(run.scene->triangles, run.scene->planes,
                               run.scene->input_count);
    FUZZ_PROMISE(run.error.code == EXIT_DONE && stored_light(&run) && results_show(&run));
    alloc_free(run.exposures);
    solver_destroy(run.solver);
    octree_destroy(run.octree);
    options_free(&run.options);
}

static void read_solution(const uint8_t *data, size_t size)
{
    struct error error = {0}, different = {0};
    struct source source;
    struct solution_mesh solution = {0};
    struct difference difference = {0};
    struct rgb *map = NULL;
    bool good = source_of_bytes(&source, "fuzz.ply", data, size, &error) &&
                solution_mesh_read(&solution, &source, &error);
    source_close(&source);
    map = alloc_array((size_t)solution.count, sizeof *map);
    FUZZ_PROMISE(!good ||
                 compare_solutions(&solution, &solution, &difference, map, &different));
    FUZZ_PROMISE(difference.largest == 0.0 && difference.broken == 0);
    if (solution.scene) {
        struct forest *forest = forest_create(solution.scene);
        solution_mesh_restore(&solution, forest);
        FUZZ_PROMISE(forest_count(forest).leaves == solution.count);
        forest_destroy(forest);
        show_solution(&solution);
    }
    alloc_free(map);
    solution_mesh_free(&solution);
    fuzz_verdict(good, &error);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    read_scene(data, size);
    read_solution(data, size);
    return 0;
}
