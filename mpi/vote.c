/* Steps 6 and 8: push-pull, and the vote on another iteration.
 *
 * Each rank casts a ballot of integers and one maximum; all ranks add all ballots, so the
 * outcome is the same on any number of them. The iterations end when nothing was split and the
 * bound on what further ones could add, q / (1 - q) of the last change (rad/pushpull.c), is
 * small enough.
 *
 * The power that escapes is what leaves the surfaces, emitted or reflected, less what the links
 * delivered: an open scene's real loss plus whatever the form factors lack or have too much. */
#include "mpi/solver.h"

#include <math.h>

#include "geom/alloc.h"
#include "mpi/signals.h"

/* What a rank says; 120 bytes, no padding. */
struct ballot {
    int64_t light, absorbed, change, arriving; /* flux units */
    int64_t split, links;
    int64_t divided;                           /* own patches that are new */
    int64_t stop;                              /* the signal that it has got */
    int64_t square[BANDS];                     /* --solver cg: <z, z>, */
    int64_t negative, bulk;                    /* and see conjugate_sum(), flux units */
    double shrink;                             /* --solver jacobi: see push_pull() */
    double largest;                            /* --solver cg: |z| */
};

static void add_ballot(struct ballot *sum, const struct ballot *ballot)
{
    sum->light = flux_add(sum->light, ballot->light);
    sum->absorbed = flux_add(sum->absorbed, ballot->absorbed);
    sum->change = flux_add(sum->change, ballot->change);
    sum->arriving = flux_add(sum->arriving, ballot->arriving);
    sum->split += ballot->split;
    sum->links += ballot->links;
    sum->divided += ballot->divided;
    sum->stop = sum->stop > ballot->stop ? sum->stop : ballot->stop;
    for (int c = 0; c < BANDS; c++)
        sum->square[c] += ballot->square[c];
    sum->negative = flux_add(sum->negative, ballot->negative);
    sum->bulk = flux_add(sum->bulk, ballot->bulk);
    sum->shrink = fmax(sum->shrink, ballot->shrink);
    sum->largest = fmax(sum->largest, ballot->largest);
}

/* The sums of all ranks. */
static struct ballot count_votes(struct solver *solver, struct ballot own)
{
    const struct comm *comm = solver->comm;
    struct ballot *all = alloc_array((size_t)comm->size, sizeof *all), sum = {0};
    MPI_Request request;
    double start = comm_seconds();
    own.stop = signals_seen();
    MPI_Iallgather(&own, (int)sizeof own, MPI_BYTE, all, (int)sizeof own, MPI_BYTE, comm->handle,
                   &request);
    comm_wait(&request);
    solver->seconds[PHASE_IDLE] += comm_seconds() - start;
    for (int r = 0; r < comm->size; r++)
        add_ballot(&sum, &all[r]);
    solver->stop = (int)sum.stop;
    alloc_free(all);
    return sum;
}

static int64_t own_new_patches(const struct solver *solver)
{
    const struct forest *forest = solver->method.forest;
    int64_t count = 0;
    for (int64_t p = solver->first_new; p < forest->count; p++)
        count += solver->own[forest->patches[p].id.root];
    return count;
}

/* What both solvers say. */
static struct vote vote_of(const struct solver *solver, const struct ballot *sum, double remaining)
{
    struct flux_unit unit = solver->method.flux_unit;
    struct vote vote = {
        .diverged = solver->diverged || sum->light >= FLUX_LIMIT || sum->bulk >= FLUX_LIMIT,
        .settled = sum->split == 0 && sum->divided == 0,
        .split = sum->split,
        .links = sum->links,
        .remaining = remaining,
        .absorbed = flux_to_watts(unit, sum->absorbed),
        .escaped = flux_to_watts(unit, flux_add(sum->light, -sum->arriving)),
    };
    vote.converged = vote.settled && remaining <= solver->method.criterion.tolerance;
    return vote;
}

/* --- Jacobi --- */

/* Bound on the remaining error relative to all light; `before` is the change of the iteration
 * before. */
static double remaining_by_change(const struct ballot *sum, int64_t before)
{
    if (sum->change == 0)
        return 0.0;
    double shrink = before > 0 ? (double)sum->change / (double)before : HUGE_VAL;
    shrink = fmax(shrink, sum->shrink);
    if (!(shrink < 1.0))
        return HUGE_VAL;
    return shrink / (1.0 - shrink) * ((double)sum->change / (double)sum->light);
}

static struct vote vote_jacobi(struct solver *solver)
{
    const struct push_pull_sums *sums = &solver->sums;
    struct ballot own = {.light = sums->light, .absorbed = sums->absorbed, .change = sums->change,
                         .arriving = sums->arriving, .split = solver->split_here,
                         .links = solver->links.count, .divided = own_new_patches(solver),
                         .shrink = sums->shrink};
    struct ballot sum = count_votes(solver, own);
    double remaining = remaining_by_change(&sum, solver->last_change);
    solver->last_change = sum.change;
    return vote_of(solver, &sum, remaining);
}

/* --- conjugate gradients --- */

/* Light is not negative. Where rows sum to so much that there is no solution, the equation may have
 * one all the same, with more negative light than the remaining error can make and one part in so many. */
enum { NEGATIVE = 100 };

/* While links are still being split the light is wanted only this well. With 3 % links and errors grow
 * by at most 0.3 % of what they are with 1 %, and a tenth of the iterations is saved; from 4 % on, dim ends
 * of scenes are left undivided, in which there is next to nothing of all light. */
static const double WHILE_SPLITTING = 0.03;

/* Bound on the remaining error relative to all light. The error e of H solves K e = z, and K is at
 * least 1 - q in the norm of the scalar product, q being the largest row sum times rho: so
 * |e| <= |z| / (1 - q); by Schwarz the sum of A rho |e| is at most sqrt(A rho) |e|. Where q is not
 * below 1, half of the least K seen takes the place of 1 - q: an estimate. */
static double remaining_by_residual(const struct solver *solver, const struct ballot *sum)
{
    const struct scene *scene = solver->method.scene;
    double least = solver->shrink < 1.0 ? 1.0 - solver->shrink : 0.5 * solver->least_bend;
    double missing = 0.0;
    for (int c = 0; c < BANDS; c++)
        missing += sqrt(scene_area(scene) * solver->gamma[c]);
    double light = flux_to_watts(solver->method.flux_unit, sum->light);
    return light > 0.0 ? missing / least / light : 0.0;
}

/* B takes the place of rho z, on all ranks. */
static void finish_conjugate(struct solver *solver)
{
    conjugate_publish(&solver->conjugate, &solver->method, true);
    solver_scatter(solver);
    solver->fresh = true;
}

static struct vote vote_conjugate(struct solver *solver)
{
    const struct criterion *criterion = &solver->method.criterion;
    struct flux_unit unit = conjugate_unit(solver->method.scene, solver->bound_residual,
                                           solver->bound_residual, solver->weight);
    struct conjugate_sums sums = conjugate_sum(&solver->conjugate, &solver->method,
                                               &solver->closure, unit);
    struct ballot own = {.light = sums.light, .absorbed = sums.absorbed,
                         .arriving = sums.arriving, .split = solver->split_here,
                         .links = solver->links.count, .divided = own_new_patches(solver),
                         .negative = sums.negative, .bulk = sums.bulk, .largest = sums.largest};
    for (int c = 0; c < BANDS; c++)
        own.square[c] = sums.square[c];
    struct ballot sum = count_votes(solver, own);
    for (int c = 0; c < BANDS; c++)
        solver->gamma[c] = flux_to_watts(unit, sum.square[c]);
    solver->bound_residual = sum.largest;
    double remaining = remaining_by_residual(solver, &sum);
    bool splitting = sum.split > 0 || sum.divided > 0;
    double wanted = splitting ? fmax(criterion->tolerance, WHILE_SPLITTING) : criterion->tolerance;
    struct vote vote = vote_of(solver, &sum, remaining);
    bool more = !(remaining <= wanted) && !vote.diverged;
    vote.unfinished = more && solver->iteration >= criterion->max_iterations;
    vote.again = more && !vote.unfinished;
    double negative = (remaining + 1.0 / NEGATIVE) * (double)sum.light;
    if (remaining <= wanted && (double)sum.negative > negative)
        vote.diverged = true;
    if (!vote.again)
        finish_conjugate(solver);
    return vote;
}

struct vote solver_vote(struct solver *solver)
{
    struct vote vote = solver->method.criterion.solver == SOLVER_CG ? vote_conjugate(solver)
                                                                    : vote_jacobi(solver);
    solver_record_iteration(solver);
    return vote;
}
