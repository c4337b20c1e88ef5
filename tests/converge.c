/* The Cornell box against a converged run of itself: how far the leaves of a run are from one
 * with an epsilon 64 times smaller. To be run with mpiexec on as many ranks as there are cores;
 * rank 0 reports.
 *
 * The reference has the same faults in its limit (false occlusion at coarse levels, rows of
 * mixed levels), so this is the error of stopping early, not all of the error. */
#include <math.h>
#include <stdlib.h>

#include "io/obj.h"
#include "mpi/broadcast.h"

#include "tests/solve.h"
#include "tests/tap.h"

static const double EPSILON = 1e-4;

struct deviation {
    double square, absolute; /* relative RMS and L1 */
    double median;           /* of |B - reference| over the mean of the reference, by area */
};

struct leaf_error {
    double relative, area;
};

static struct scene *read_cornell(const struct comm *comm)
{
    struct scene *scene = NULL;
    struct error error = {0};
    struct obj_repairs read = {0};
    struct scene_repairs prepared;
    if (comm->rank == 0) {
        scene = obj_read("scenes/cornell.obj", &read, &error);
        if (scene)
            scene_prepare(scene, &prepared, &error);
    }
    if (!comm_agree(comm, &error))
        return NULL;
    return scene_broadcast(comm, scene);
}

/* Mean radiosity of the reference over a leaf of the other run: that of the patch with its ID,
 * or of the leaf above it where the reference is coarser. */
static double reference_at(const struct forest *reference, struct patch_id id)
{
    int32_t p = (int32_t)id.root;
    for (int step = 0; step < id_level(id) && !patch_is_leaf(&reference->patches[p]); step++)
        p = reference->patches[p].children + id_step(id, step);
    return rgb_sum(reference->patches[p].radiosity);
}

static int compare_errors(const void *left, const void *right)
{
    const struct leaf_error *a = left, *b = right;
    return (a->relative > b->relative) - (a->relative < b->relative);
}

/* Area-weighted, over the leaves of `forest` that reflect more than they emit. */
static struct deviation compare(const struct forest *forest, const struct forest *reference)
{
    struct leaf_error *errors = alloc_array((size_t)forest->count, sizeof *errors);
    double square = 0.0, square_sum = 0.0, absolute = 0.0, sum = 0.0, area_sum = 0.0;
    size_t count = 0;
    for (int64_t p = 0; p < forest->count; p++) {
        const struct patch *patch = &forest->patches[p];
        if (!patch_is_leaf(patch) || rgb_sum(forest_material(forest, (int32_t)p)->emission) > 0.0)
            continue;
        double area = forest_area(forest, (int32_t)p), exact = reference_at(reference, patch->id);
        double error = fabs(rgb_sum(patch->radiosity) - exact);
        square += area * error * error;
        square_sum += area * exact * exact;
        absolute += area * error;
        sum += area * exact;
        area_sum += area;
        errors[count++] = (struct leaf_error){error, area};
    }
    qsort(errors, count, sizeof *errors, compare_errors);
    double passed = 0.0;
    size_t middle = 0;
    while (middle + 1 < count && (passed += errors[middle].area) < 0.5 * area_sum)
        middle++;
    struct deviation d = {sqrt(square / square_sum), absolute / sum,
                          errors[middle].relative / (sum / area_sum)};
    alloc_free(errors);
    return d;
}

int main(int argc, char **argv)
{
    struct comm comm;
    comm_start(&comm, &argc, &argv);
    struct scene *scene = read_cornell(&comm);
    if (scene) {
        struct criterion rough = criterion_of(EPSILON, 10, 1e-4), fine = rough;
        fine.epsilon = EPSILON / 64.0;
        struct solution a = solve(&comm, scene, rough);
        struct solution b = solve(&comm, read_cornell(&comm), fine);
        struct deviation d = compare(a.solver->method.forest, b.solver->method.forest);
        if (comm.rank == 0) {
            printf("# cornell, epsilon %g against %g (%lld and %lld links): relative RMS %.2f %%, "
                   "L1 %.2f %%, median %.2f %%\n", rough.epsilon, fine.epsilon,
                   (long long)a.stats.links, (long long)b.stats.links, 100.0 * d.square,
                   100.0 * d.absolute, 100.0 * d.median);
            tap_ok(a.vote.converged && b.vote.converged, "both runs converge");
            tap_ok(d.square <= 0.06, "relative RMS over the leaves at most 6 %%");
            tap_ok(d.absolute <= 0.06, "relative L1 over the leaves at most 6 %%");
            tap_ok(d.median <= 0.045, "median over the leaves at most 4.5 %%");
        }
        solution_free(&a);
        solution_free(&b);
    } else if (comm.rank == 0) {
        tap_ok(false, "scenes/cornell.obj can be read");
    }
    comm_stop(&comm);
    return comm.rank == 0 ? tap_done() : alloc_balance() != 0;
}
