/* Steps 6 and 8 by conjugate gradients (rad/beyond/conjugate.c): a step of theirs in the
 * place of push-pull, until the bound on the error that remains is small enough. */
#include "mpi/beyond/beyond.h"

#include <math.h>

/* --- step 6 --- */

static void start_conjugate(struct solver *solver)
{
    struct conjugate *cg = &solver->beyond->descent.vectors;
    conjugate_start(cg, &solver->model, &solver->beyond->caps, solver->flux);
    struct flux_unit any = flux_unit_for(1.0);
    double own = conjugate_sum(cg, &solver->model, &solver->beyond->caps, any).largest;
    solver->beyond->descent.bound_residual = comm_largest(solver->comm, own);
    solver->beyond->descent.bound_image = 0.0;
    for (int c = 0; c < BANDS; c++)
        solver->beyond->descent.step_before[c] = 0.0;
}

/* <K z, z> over all ranks, W^2 m^-2. */
static void multiply(struct solver *solver, double bound, double product[BANDS])
{
    struct flux_unit unit = conjugate_unit(&solver->model, bound, solver->beyond->descent.bound_residual,
                                           solver->beyond->descent.weight);
    int64_t own[BANDS] = {0, 0, 0}, all[BANDS];
    conjugate_apply(&solver->beyond->descent.vectors, &solver->model, &solver->beyond->caps,
                    solver->flux, unit, own);
    MPI_Request request;
    MPI_Iallreduce(own, all, BANDS, MPI_INT64_T, MPI_SUM, solver->comm->handle, &request);
    comm_wait(&request);
    for (int c = 0; c < BANDS; c++)
        product[c] = flux_to_watts(unit, all[c]);
}

static void step_conjugate(struct solver *solver)
{
    double image = solver->beyond->descent.bound_residual * (1.0 + solver->beyond->descent.gain);
    double delta[BANDS], turn[BANDS] = {0.0}, step[BANDS] = {0.0};
    double longest_turn = 0.0, longest_step = 0.0;
    multiply(solver, image, delta);
    for (int c = 0; c < BANDS; c++) {
        double gamma = solver->beyond->descent.gamma[c], before = solver->beyond->descent.step_before[c];
        if (!(gamma > 0.0))
            continue;
        turn[c] = before > 0.0 ? gamma / solver->beyond->descent.gamma_before[c] : 0.0;
        double bend = delta[c] - (before > 0.0 ? turn[c] * gamma / before : 0.0);
        if (!(bend > 0.0) && solver->beyond->descent.shrink < 1.0) { /* rounding, since K is positive: start afresh */
            turn[c] = 0.0;
            bend = delta[c];
        }
        solver->beyond->descent.diverged = solver->beyond->descent.diverged || !(bend > 0.0);
        step[c] = bend > 0.0 ? gamma / bend : 0.0;
        solver->beyond->descent.least_bend = fmin(solver->beyond->descent.least_bend, delta[c] / gamma);
        longest_turn = fmax(longest_turn, turn[c]);
        longest_step = fmax(longest_step, step[c]);
        solver->beyond->descent.gamma_before[c] = gamma;
        solver->beyond->descent.step_before[c] = step[c];
    }
    conjugate_advance(&solver->beyond->descent.vectors, &solver->model, turn, step);
    solver->beyond->descent.bound_image = image + longest_turn * solver->beyond->descent.bound_image;
    solver->beyond->descent.bound_residual += longest_step * solver->beyond->descent.bound_image;
}

static void iterate(struct solver *solver)
{
    if (solver->beyond->descent.fresh)
        start_conjugate(solver);
    else
        step_conjugate(solver);
    solver->beyond->descent.fresh = false;
    conjugate_publish(&solver->beyond->descent.vectors, &solver->model, false);
}

/* The unit of <z, z>. */
static struct flux_unit square_unit(const struct solver *solver)
{
    return conjugate_unit(&solver->model, solver->beyond->descent.bound_residual, solver->beyond->descent.bound_residual,
                          solver->beyond->descent.weight);
}

/* The largest that an own leaf sends. */
static double brightest_own(const struct solver *solver)
{
    double brightest = 0.0;
    for (int64_t i = 0; i < solver->beyond->descent.vectors.leaf_count; i++) {
        int32_t leaf = solver->beyond->descent.vectors.leaves[i];
        for (int c = 0; c < BANDS; c++)
            brightest = fmax(brightest, fabs(solver->model.forest->patches[leaf].radiosity.band[c]));
    }
    return brightest;
}

static struct ballot ballot_conjugate(const struct solver *solver)
{
    struct conjugate_sums sums = conjugate_sum(&solver->beyond->descent.vectors, &solver->model, &solver->beyond->caps,
                                               square_unit(solver));
    struct ballot own = {.light = sums.light, .absorbed = sums.absorbed, .arriving = sums.arriving,
                         .negative = sums.negative, .bulk = sums.bulk, .missing = sums.missing,
                         .largest = sums.largest};
    for (int c = 0; c < BANDS; c++)
        own.square[c] = sums.square[c];
    return own;
}

void descent_push_pull(struct solver *solver)
{
    iterate(solver);
    solver->ballot = ballot_conjugate(solver);
    solver->ballot.brightest = brightest_own(solver);
}

/* --- step 8 --- */

/* Light is not negative. Where rows sum to so much that there is no solution, the equation may have
 * one all the same, with more negative light than the remaining error can make and one part in so many. */
enum { NEGATIVE = 100 };

/* While links are still being split the light is wanted only this well, in parts of what is reflected:
 * next to what lamps emit into the void, all that there is to find might be small. With 3 % a tenth of the
 * iterations is saved that 1 % takes, and a corridor that gets dimmer and dimmer has 0.2 % fewer patches; with
 * 6 % it has 0.4 % fewer. */
static const double WHILE_SPLITTING = 0.03;

/* Bound on the remaining error relative to all light. The error e of H solves K e = z, so it is z + F' rho z +
 * (F' rho)^2 z + ... Let |x| be the sum of A / d |x| over leaves and bands. A F being symmetric, |F' rho x| is at
 * most q |x|, q being the largest row sum times rho: what light is multiplied by from one bounce to the next,
 * at most. So |e| is at most |z| / (1 - q), and what B lacks, the sum of A rho |e|, at most |e| times the largest
 * rho d. Where q is not below 1, half of the least K seen, in the norm of <x, y>, takes the place
 * of 1 - q: an estimate.
 *
 * Rejected: |z| as the norm of <x, y>, from which Schwarz leads to the sum of A rho |e|. Where what is
 * missing is on a few bright leaves, as after a refinement, that is many times too large; it took a seventh
 * more iterations in the rooms. */
static double remaining_by_residual(const struct solver *solver, const struct ballot *sum)
{
    double least = solver->beyond->descent.shrink < 1.0 ? 1.0 - solver->beyond->descent.shrink : 0.5 * solver->beyond->descent.least_bend;
    return sum->light > 0 ? solver->beyond->descent.share / least * ((double)sum->missing / (double)sum->light) : 0.0;
}

/* The remaining error, relative to all light, at which the iterations over these links may end. */
static double wanted_of(const struct solver *solver, const struct ballot *sum)
{
    double tolerance = solver->model.criterion.tolerance;
    if (sum->split == 0 && sum->divided == 0)
        return tolerance;
    double light = flux_to_watts(solver->model.flux_unit, sum->light);
    double reflected = light - solver->model.emitted_power;
    return reflected > 0.0 ? fmax(tolerance, WHILE_SPLITTING * reflected / light) : tolerance;
}

/* Step 7 of radiosities that nobody votes on. */
static void scatter_unvoted(struct solver *solver)
{
    solver->ballot = (struct ballot){0};
    solver_scatter(solver);
}

/* B takes the place of rho z, on all ranks. */
static void finish_conjugate(struct solver *solver)
{
    conjugate_publish(&solver->beyond->descent.vectors, &solver->model, true);
    scatter_unvoted(solver);
    solver->beyond->descent.fresh = true;
}

struct vote descent_vote(struct solver *solver, const struct ballot *sum)
{
    const struct criterion *criterion = &solver->model.criterion;
    struct flux_unit unit = square_unit(solver);
    for (int c = 0; c < BANDS; c++)
        solver->beyond->descent.gamma[c] = flux_to_watts(unit, sum->square[c]);
    solver->beyond->descent.bound_residual = sum->largest;
    double remaining = remaining_by_residual(solver, sum), wanted = wanted_of(solver, sum);
    struct vote vote = vote_make(solver, sum, remaining);
    vote.diverged = vote.diverged || solver->beyond->descent.diverged;
    bool more = !(remaining <= wanted) && !vote.diverged;
    vote.unfinished = more && solver->turn.iteration >= criterion->max_iterations;
    vote.again = more && !vote.unfinished;
    double negative = (remaining + 1.0 / NEGATIVE) * (double)sum->light;
    if (remaining <= wanted && (double)sum->negative > negative)
        vote.diverged = true;
    if (!vote.again)
        finish_conjugate(solver);
    return vote;
}

