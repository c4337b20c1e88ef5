/* --accuracy: how far the leaves are from the truth, as far as the program itself can tell.
 *
 * When everything is refined and solved for one epsilon, epsilon is divided by TIGHTER and the
 * passes go on over the same links. The answer before, leaf by leaf, is then compared with the
 * better one, averaged over the same patches: their relative RMS difference D is the error that was
 * mended. What is left is as large or a little larger, since the error falls slowly with epsilon and
 * much of it is new: in the Cornell box and in a furnished room the true error of the better answer
 * was 0.6 to 1.3 D for epsilons from 2.5e-4 to 1.5e-8 (tests/converge.c holds it to the promise: at
 * most twice the estimate). The estimate is LEFT times D.
 *
 * Rejected: the ratio of successive differences as the part of the error that each step leaves,
 * which is too noisy to be divided by (estimates three times too large); the sum of what the
 * oracle says of all links, which adds up errors of both signs; comparing the row sums with 1,
 * which says nothing about direct light. */
#include "mpi/solver.h"

#include <math.h>

#include "geom/alloc.h"

static const double TIGHTER = 4.0, SMALLEST_EPSILON = 1e-10;
static const double LEFT = 1.25;

void accuracy_free(struct accuracy *accuracy)
{
    alloc_free(accuracy->before);
    *accuracy = (struct accuracy){0};
}

/* Copies the radiosities; only those of leaves mean an answer. */
static void remember(struct accuracy *accuracy, const struct forest *forest)
{
    alloc_free(accuracy->before);
    accuracy->before = forest_keep(forest);
    accuracy->count = forest->count;
    for (int64_t p = 0; p < forest->count; p++)
        if (!patch_is_leaf(&forest->patches[p]))
            accuracy->before[p].band[0] = HUGE_VAL; /* no answer */
}

/* sum A |B - B before|^2 and sum A |B - E|^2 over own leaves of before. */
static void compare(const struct solver *solver, struct flux_unit unit, int64_t sums[2])
{
    const struct forest *forest = solver->method.forest;
    for (int64_t p = 0; p < solver->accuracy.count; p++) {
        const struct patch *patch = &forest->patches[p];
        struct rgb before = solver->accuracy.before[p];
        double area = forest_area(forest, (int32_t)p), change = 0.0, light = 0.0;
        if (!solver->own[patch->id.root] || before.band[0] == HUGE_VAL)
            continue;
        struct rgb emission = forest_material(forest, (int32_t)p)->emission;
        for (int c = 0; c < BANDS; c++) {
            double d = patch->radiosity.band[c] - before.band[c];
            double b = patch->radiosity.band[c] - emission.band[c];
            change += area * (d * d);
            light += area * (b * b);
        }
        sums[0] = flux_add(sums[0], flux_from_watts(unit, change));
        sums[1] = flux_add(sums[1], flux_from_watts(unit, light));
    }
}

/* The relative RMS difference to the answer before, the same on all ranks. */
static double difference(const struct solver *solver)
{
    const struct forest *forest = solver->method.forest;
    double largest = 1e-140;
    for (int64_t p = 0; p < forest->count; p++)
        for (int c = 0; c < BANDS; c++)
            largest = fmax(largest, fabs(forest->patches[p].radiosity.band[c]));
    struct flux_unit unit = flux_unit_for(4.0 * BANDS * largest * largest *
                                          solver->method.area);
    int64_t own[2] = {0, 0}, all[2];
    compare(solver, unit, own);
    MPI_Request request;
    MPI_Iallreduce(own, all, 2, MPI_INT64_T, MPI_SUM, solver->comm->handle, &request);
    comm_wait(&request);
    return all[1] > 0 ? sqrt((double)all[0] / (double)all[1]) : 0.0;
}

bool solver_is_accurate(struct solver *solver)
{
    struct accuracy *accuracy = &solver->accuracy;
    struct criterion *criterion = &solver->method.criterion;
    if (!(criterion->accuracy > 0.0))
        return true;
    if (accuracy->before) {
        accuracy->estimate = LEFT * difference(solver);
        if (accuracy->estimate <= criterion->accuracy)
            return true;
    }
    if (criterion->epsilon / TIGHTER < SMALLEST_EPSILON)
        return true;
    remember(accuracy, solver->method.forest);
    criterion->epsilon /= TIGHTER;
    solver->method.link_threshold /= TIGHTER;
    return false;
}
