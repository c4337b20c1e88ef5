/* phr as a library: a run whose scene is in memory, and whose light goes there.
 *
 * It is the run of the program (compute.h) without files: rank 0 makes the scene from
 * arrays where the program reads one, and all ranks copy the leaves from the forest,
 * which each has. `make install-lib` leaves no global names but those of lib/phr.h. */
#include "lib/phr.h"

#include <math.h>
#include <string.h>

#include "compute.h"
#include "geom/alloc.h"
#include "io/picture/mesh.h"
#include "tools/balance.h"
#include "tools/results.h"

static struct comm ranks;
static struct error error;

int phr_start(void)
{
    comm_start(&ranks, NULL, NULL);
    return ranks.rank;
}

void phr_stop(void)
{
    comm_stop(&ranks);
}

const char *phr_error(void)
{
    return error.text;
}

const char *phr_version(void)
{
    return PHR_VERSION;
}

/* Reads "--quiet scene OPTION..." as the command line. */
static bool read_options(struct run *run, const char *const *options)
{
    static const char *const FILES[] = {
        "-o", "--view", "--stats", "--save-links", "--load-links",
        "--checkpoint", "--resume", "--dump", "--help", "--version", NULL};
    int count = 0;
    while (options && options[count])
        count++;
    const char **words = alloc_array((size_t)count + 3, sizeof *words);
    words[1] = "--quiet";
    words[2] = "scene";
    for (int i = 0; i < count; i++)
        words[i + 3] = options[i];
    bool good = options_parse(&run->options, count + 3, (char **)words, &run->error);
    alloc_free(words);
    const char *given = good ? options_given(&run->options, FILES) : "";
    if (*given)
        error_set(&run->error, EXIT_USAGE, "phr_solve() takes no %s", given);
    return comm_agree(&run->comm, &run->error);
}

static bool take_material(struct material *material, const struct phr_material *given)
{
    bool good = true;
    for (int c = 0; c < BANDS; c++) {
        material->reflectance.band[c] = given->reflectance[c];
        material->emission.band[c] = given->emission[c];
        good = good && given->reflectance[c] >= 0.0 && given->emission[c] >= 0.0;
    }
    return good && isfinite(rgb_sum(material->reflectance)) &&
           isfinite(rgb_sum(material->emission));
}

/* Makes a scene of arrays, which is not prepared yet. */
static void take_scene(struct run *run, const struct phr_scene *given)
{
    if (!given || given->triangle_count < 1 || given->material_count < 1) {
        error_set(&run->error, EXIT_USAGE, "the scene has no triangles or no materials");
        return;
    }
    struct scene *scene = scene_create(given->triangle_count, given->material_count);
    run->scene = scene;
    for (int i = 0; i < given->material_count; i++)
        if (!take_material(&scene->materials[i], &given->materials[i]))
            error_set(&run->error, EXIT_USAGE,
                      "material %d: a number is negative, or none", i);
    for (int i = 0; i < given->triangle_count; i++) {
        const double *x = given->corners + 9 * (size_t)i;
        for (int k = 0; k < 3; k++, x += 3)
            scene->triangles[i].corner[k] = (struct vec3){x[0], x[1], x[2]};
        scene->material_of[i] = given->material_of[i];
        if (given->material_of[i] < 0 || given->material_of[i] >= given->material_count)
            error_set(&run->error, EXIT_USAGE, "triangle %d: there is no material %d", i,
                      given->material_of[i]);
    }
}

static struct phr_leaf leaf_of(const struct run *run, int32_t patch)
{
    const struct forest *forest = run->solver->model.forest;
    const float *errors = beyond_answer(run->solver)->error;
    int32_t root = (int32_t)forest->patches[patch].id.root;
    struct triangle triangle = forest_triangle(forest, patch);
    struct phr_leaf leaf = {
        .triangle = scene_input_of(run->scene, root),
        .on_back = root >= run->scene->input_count,
        .area = forest_area(forest, patch) * scene_area_unit(run->scene),
        .error = errors ? (double)errors[patch] : 0.0};
    for (int k = 0; k < 3; k++) {
        struct vec3 x = scene_to_input(run->scene, triangle.corner[k]);
        memcpy(leaf.corners[k], (double[3]){x.x, x.y, x.z}, sizeof leaf.corners[k]);
        leaf.radiosity[k] = forest->radiosity[patch].band[k];
    }
    return leaf;
}

static struct phr_solution *solution_of(const struct run *run)
{
    const struct forest *forest = run->solver->model.forest;
    struct phr_solution *solution = alloc_array(1, sizeof *solution);
    solution->converged = run->vote.converged;
    solution->leaves =
        alloc_array((size_t)mesh_count(forest), sizeof *solution->leaves);
    for (int32_t i = mesh_next_leaf(forest, -1); i >= 0; i = mesh_next_leaf(forest, i))
        solution->leaves[solution->leaf_count++] = leaf_of(run, i);
    return solution;
}

struct phr_solution *phr_solve(const struct phr_scene *scene, const char *const *options)
{
    struct run run = {.comm = ranks};
    struct phr_solution *solution = NULL;
    if (read_options(&run, options)) {
        if (ranks.rank == 0)
            take_scene(&run, scene);
        if (run_agree(&run) && compute_light(&run)) {
            results_show(&run); /* there are no outputs, but B is above 0 then */
            if (balance_is_absurd(&run))
                error_set(&run.error, EXIT_FAILED,
                          "more light is absorbed than emitted: faces may lie on each "
                          "other, or --epsilon is too large");
            else
                solution = solution_of(&run);
        }
    }
    error = run.error;
    run_free(&run);
    return solution;
}

void phr_free(struct phr_solution *solution)
{
    if (solution)
        alloc_free(solution->leaves);
    alloc_free(solution);
}
