/* Solving a scene inside a test, by the loop of phr.c. */
#ifndef TESTS_SOLVE_H
#define TESTS_SOLVE_H

#include <time.h>

#include "mpi/beyond/beyond.h"
#include "compute.h"

#include "tests/scenes.h"

struct solution {
    struct scene *scene; /* owned */
    struct octree *octree;
    struct solver *solver;
    struct vote vote;
    struct stats stats; /* row sums and the fields of solver_report() */
    double seconds;     /* for the octree and the loop; see seconds_of_work() */
};

/* Seconds that the processor has worked, which others do not disturb; on several ranks,
 * where waiting counts, those that have passed. */
static inline double seconds_of_work(const struct comm *comm)
{
    return comm->size == 1 ? (double)clock() / CLOCKS_PER_SEC : comm_seconds();
}

/* The paper's variant. */
static inline struct criterion criterion_of(double epsilon, int max_level,
                                            double tolerance)
{
    return (struct criterion){.epsilon = epsilon,
                              .min_area = 0.0,
                              .max_level = max_level,
                              .alpha = 0.5,
                              .tolerance = tolerance,
                              .max_iterations = 100000,
                              .balance = BALANCE_GREEDY};
}

/* The error oracle, form factors of polygons, and conjugate residuals. */
static inline struct criterion criterion_best(double epsilon, int max_level,
                                              double tolerance)
{
    struct criterion criterion = criterion_of(epsilon, max_level, tolerance);
    criterion.oracle = ORACLE_ERROR;
    criterion.linking = LINKING_TREE;
    criterion.form_factor = FORM_FACTOR_POLYGON;
    criterion.solver = SOLVER_CG;
    return criterion;
}

/* Collective. Solves over the links there are, without refinement. */
static inline struct vote iterate_links(struct solver *solver)
{
    struct vote vote;
    do {
        solver_gather(solver);
        solver_push_pull(solver);
        solver_scatter(solver);
        vote = solver_vote(solver);
    } while (vote.again);
    return vote;
}

/* Collective. The same, and all ranks get all light. */
static inline struct vote solve_links(struct solver *solver)
{
    struct vote vote = iterate_links(solver);
    solver_complete(solver);
    return vote;
}

/* Collective. Solves a prepared scene and takes it over. */
static inline struct solution solve(const struct comm *comm, struct scene *scene,
                                    struct criterion criterion)
{
    struct solution s = {.scene = scene};
    double start = seconds_of_work(comm);
    struct run run = {.comm = *comm, .scene = scene};
    run.options.quiet = true;
    run.options.criterion = criterion;
    run.octree = octree_of(scene);
    compute_light(&run);
    s.octree = run.octree;
    s.solver = run.solver;
    s.vote = run.vote;
    s.solver->comm = comm;
    s.solver->progress = NULL;
    beyond_attach(s.solver); /* tests look for an answer of the paper's method, too */
    s.seconds = seconds_of_work(comm) - start;
    solver_measure_row_sums(s.solver, &s.stats);
    solver_report(s.solver, &s.vote, &s.stats);
    return s;
}

static inline void solution_free(struct solution *s)
{
    solver_destroy(s->solver);
    octree_destroy(s->octree);
    scene_destroy(s->scene);
}

/* The cube [0, 1]^3 seen from inside, faces in the order bottom, top (y), then the sides,
 * two triangles each; every face has material `face`, of which there are six, all zero.
 * Prepared. */
static inline struct scene *cube_create(void)
{
    static const int quads[6][4] = {{0, 4, 5, 1}, {2, 3, 7, 6}, {0, 1, 3, 2},
                                    {4, 6, 7, 5}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    struct scene *scene = scene_create(12, 6);
    for (int face = 0; face < 6; face++) {
        struct vec3 v[4];
        for (int k = 0; k < 4; k++) {
            int bits = quads[face][k]; /* x = bit 0, y = bit 1, z = bit 2 */
            v[k] = point(bits & 1, bits >> 1 & 1, bits >> 2);
        }
        scene->triangles[2 * face] = (struct triangle){{v[0], v[1], v[2]}};
        scene->triangles[2 * face + 1] = (struct triangle){{v[0], v[2], v[3]}};
        scene->material_of[2 * face] = scene->material_of[2 * face + 1] = face;
    }
    return prepared(scene);
}

#endif
