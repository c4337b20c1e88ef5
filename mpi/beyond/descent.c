/* Steps 6 and 8 by conjugate gradients (rad/beyond/conjugate.c): one step of theirs takes
 * the place of push-pull, until the bound on the remaining error is small enough. */
#include "mpi/beyond/beyond.h"

#include <math.h>

/* --- step 6 --- */

static void start_conjugate(struct solver *solver)
{
    struct descent *descent = &solver->beyond->descent;
    struct conjugate *cg = &descent->vectors;
    const struct caps *caps = &solver->beyond->caps;
    struct flux_unit any = flux_unit_for(1.0);
    conjugate_start(cg, &solver->model, caps, solver->flux);
    double own = conjugate_sum(cg, &solver->model, caps, any).largest;
    descent->bound_residual = comm_largest(solver->comm, own);
    descent->bound_image = 0.0;
    for (int c = 0; c < BANDS; c++)
        descent->step_before[c] = 0.0;
}

/* <K z, z> over all ranks, W^2 m^-2. */
static void multiply(struct solver *solver, double bound, double product[BANDS])
{
    struct descent *descent = &solver->beyond->descent;
    struct flux_unit unit = conjugate_unit(&solver->model, bound, descent->bound_residual,
                                           descent->weight);
    int64_t own[BANDS] = {0, 0, 0}, all[BANDS];
    conjugate_apply(&descent->vectors, &solver->model, &solver->beyond->caps,
                    solver->flux, unit, own);
    MPI_Request request;
    MPI_Iallreduce(own, all, BANDS, MPI_INT64_T, MPI_SUM, solver->comm->handle, &request);
    comm_wait(&request);
    for (int c = 0; c < BANDS; c++)
        product[c] = flux_to_watts(unit, all[c]);
}

static void step_conjugate(struct solver *solver)
{
    struct descent *descent = &solver->beyond->descent;
    double image = descent->bound_residual * (1.0 + descent->gain);
    double delta[BANDS], turn[BANDS] = {0.0}, step[BANDS] = {0.0};
    double longest_turn = 0.0, longest_step = 0.0;
    multiply(solver, image, delta);
    for (int c = 0; c < BANDS; c++) {
        double gamma = descent->gamma[c], before = descent->step_before[c];
        if (!(gamma > 0.0))
            continue;
        turn[c] = before > 0.0 ? gamma / descent->gamma_before[c] : 0.0;
        double bend = delta[c] - (before > 0.0 ? turn[c] * gamma / before : 0.0);
        if (!(bend > 0.0)) { /* rounding, since K is positive: start afresh */
            turn[c] = 0.0;
            bend = delta[c];
        }
        descent->diverged = descent->diverged || !(bend > 0.0);
        step[c] = bend > 0.0 ? gamma / bend : 0.0;
        longest_turn = fmax(longest_turn, turn[c]);
        longest_step = fmax(longest_step, step[c]);
        descent->gamma_before[c] = gamma;
        descent->step_before[c] = step[c];
    }
    conjugate_advance(&descent->vectors, &solver->model, turn, step);
    descent->bound_image = image + longest_turn * descent->bound_image;
    descent->bound_residual += longest_step * descent->bound_image;
}

static void iterate(struct solver *solver)
{
    if (solver->beyond->descent.fresh)
        start_conjugate(solver);
    else
        step_conjugate(solver);
    solver->beyond->descent.fresh = false;
    conjugate_send(&solver->beyond->descent.vectors, &solver->model);
}

/* The unit of <z, z>. */
static struct flux_unit square_unit(const struct solver *solver)
{
    const struct descent *descent = &solver->beyond->descent;
    double bound = descent->bound_residual;
    return conjugate_unit(&solver->model, bound, bound, descent->weight);
}

/* The largest value that an own leaf sends. */
static double brightest_own(const struct solver *solver)
{
    const struct conjugate *cg = &solver->beyond->descent.vectors;
    double brightest = 0.0;
    for (int64_t i = 0; i < cg->leaf_count; i++) {
        struct rgb sent = cg->sent[cg->leaves[i]];
        for (int c = 0; c < BANDS; c++)
            brightest = fmax(brightest, fabs(sent.band[c]));
    }
    return brightest;
}

static struct ballot ballot_conjugate(const struct solver *solver)
{
    struct conjugate_sums sums =
        conjugate_sum(&solver->beyond->descent.vectors, &solver->model,
                      &solver->beyond->caps, square_unit(solver));
    struct ballot own = {.light = sums.light, .absorbed = sums.absorbed,
                         .arriving = sums.arriving, .negative = sums.negative,
                         .bulk = sums.bulk, .missing = sums.missing,
                         .largest = sums.largest};
    for (int c = 0; c < BANDS; c++)
        own.square[c] = sums.square[c];
    return own;
}

struct rgb *descent_vector(const struct solver *solver)
{
    const struct descent *descent = &solver->beyond->descent;
    return descent->fresh ? solver->model.forest->radiosity : descent->vectors.sent;
}

void descent_push_pull(struct solver *solver)
{
    iterate(solver);
    solver->ballot = ballot_conjugate(solver);
    solver->ballot.brightest = brightest_own(solver);
}

/* --- step 8 --- */

/* A solution has diverged if its negative light is more than the remaining error can make
 * and 1 / NEGATIVE of all light: where row sums are so large that there is no solution,
 * the equation may still have one with negative light. */
enum { NEGATIVE = 100 };

/* The tolerance while links are still being split, in parts of the reflected light (not
 * of all light: lamps may emit nearly all of theirs into the void). With 3 % a tenth of
 * the iterations is saved that 1 % takes, and a corridor that gets dimmer and dimmer has
 * 0.2 % fewer patches; with 6 % it has 0.4 % fewer. */
static const double WHILE_SPLITTING = 0.03;

/* Returns a bound on the remaining error relative to all light. The error e of H solves K
 * e = z, so it is z + F' rho z + (F' rho)^2 z + ... Let |x| be the sum of A / d |x| over
 * leaves and bands. A F being symmetric, |F' rho x| is at most q |x|; q, the largest row
 * sum times rho, is the factor that light grows by from one bounce to the next, at most.
 * Caps keep q below 1. So |e| is at most |z| / (1 - q), and the light that B lacks, the
 * sum of A rho |e|, at most |e| times the largest rho d.
 *
 * Rejected: |z| as the norm of <x, y>, from which Schwarz leads to the sum of A rho |e|.
 * Where the missing light is on a few bright leaves, as after a refinement, that bound is
 * many times too large; it took a seventh more iterations in the rooms. */
static double remaining_by_residual(const struct solver *solver, const struct ballot *sum)
{
    const struct descent *descent = &solver->beyond->descent;
    if (sum->light <= 0)
        return 0.0;
    return descent->share / (1.0 - descent->shrink) *
           ((double)sum->missing / (double)sum->light);
}

/* The remaining error, relative to all light, at which iteration over the links ends. */
static double wanted_of(const struct solver *solver, const struct ballot *sum)
{
    double tolerance = solver->model.criterion.tolerance;
    if (sum->split == 0 && sum->divided == 0)
        return tolerance;
    double light = flux_to_watts(solver->model.flux_unit, sum->light);
    double reflected = light - solver->model.emitted_power;
    return reflected > 0.0 ? fmax(tolerance, WHILE_SPLITTING * reflected / light)
                           : tolerance;
}

/* All ranks learn B: step 7 with an empty ballot. */
static void finish_conjugate(struct solver *solver)
{
    conjugate_finish(&solver->beyond->descent.vectors, &solver->model);
    solver->beyond->descent.fresh = true;
    solver->ballot = (struct ballot){0};
    solver_scatter(solver);
}

struct vote descent_vote(struct solver *solver, const struct ballot *sum)
{
    const struct criterion *criterion = &solver->model.criterion;
    struct descent *descent = &solver->beyond->descent;
    struct flux_unit unit = square_unit(solver);
    for (int c = 0; c < BANDS; c++)
        descent->gamma[c] = flux_to_watts(unit, sum->square[c]);
    descent->bound_residual = sum->largest;
    double remaining = remaining_by_residual(solver, sum);
    double wanted = wanted_of(solver, sum);
    struct vote vote = vote_make(solver, sum, remaining);
    vote.diverged = vote.diverged || descent->diverged;
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

