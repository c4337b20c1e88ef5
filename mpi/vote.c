/* Step 8: the vote on another iteration.
 *
 * Each rank casts a ballot of integers and maxima, which travels with the radiosities of its leaves, and
 * all add them up, so the outcome is the same on any number of ranks. The iterations end
 * when nothing was split and the bound on what further ones could add, q / (1 - q) of the last change
 * (rad/pushpull.c), is small enough.
 *
 * The power that escapes is what leaves the surfaces, emitted or reflected, less what the links
 * delivered: an open scene's real loss plus whatever the form factors lack or have too much. */
#include "mpi/beyond/beyond.h"

#include <math.h>

#include "mpi/signals.h"

void ballot_add(struct ballot *sum, const struct ballot *ballot)
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
    sum->missing = flux_add(sum->missing, ballot->missing);
    sum->shrink = fmax(sum->shrink, ballot->shrink);
    sum->largest = fmax(sum->largest, ballot->largest);
    sum->brightest = fmax(sum->brightest, ballot->brightest);
}

static int64_t own_new_patches(const struct solver *solver)
{
    const struct forest *forest = solver->model.forest;
    int64_t count = 0;
    for (int64_t p = solver->turn.first_new; p < forest->count; p++)
        count += solver->homes.own[forest->patches[p].id.root];
    return count;
}

/* What both solvers say. */
static struct vote vote_of(const struct solver *solver, const struct ballot *sum, double remaining)
{
    struct flux_unit unit = solver->model.flux_unit;
    struct vote vote = {
        .diverged = solver->beyond->descent.diverged || sum->light >= FLUX_LIMIT || sum->bulk >= FLUX_LIMIT,
        .settled = sum->split == 0 && sum->divided == 0,
        .split = sum->split,
        .links = sum->links,
        .remaining = remaining,
        .absorbed = flux_to_watts(unit, sum->absorbed),
        .escaped = flux_to_watts(unit, flux_add(sum->light, -sum->arriving)),
    };
    vote.converged = vote.settled && remaining <= solver->model.criterion.tolerance;
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

static struct ballot ballot_jacobi(const struct solver *solver)
{
    const struct push_pull_sums *sums = &solver->change.sums;
    return (struct ballot){.light = sums->light, .absorbed = sums->absorbed, .change = sums->change,
                           .arriving = sums->arriving, .shrink = sums->shrink};
}

static struct vote vote_jacobi(struct solver *solver, const struct ballot *sum)
{
    double remaining = remaining_by_change(sum, solver->change.last);
    solver->change.last = sum->change;
    return vote_of(solver, sum, remaining);
}

/* --- conjugate gradients --- */

/* Light is not negative. Where rows sum to so much that there is no solution, the equation may have
 * one all the same, with more negative light than the remaining error can make and one part in so many. */
enum { NEGATIVE = 100 };

/* While links are still being split the light is wanted only this well, in parts of what is reflected:
 * next to what lamps emit into the void, all that there is to find might be small. With 3 % a tenth of the
 * iterations is saved that 1 % takes, and a corridor that gets dimmer and dimmer has 0.2 % fewer patches; with
 * 6 % it has 0.4 % fewer. */
static const double WHILE_SPLITTING = 0.03;

/* Bound on the remaining error relative to all light. The error e of H solves K e = z, so it is z + F' rho z +
 * (F' rho)^2 z + ... Let |x| be the sum of A d' / d |x| over leaves and bands. A F being symmetric, |F' rho x| is at
 * most q |x|, q being the largest row sum times rho: what light is multiplied by from one bounce to the next,
 * at most. So |e| is at most |z| / (1 - q), and what B lacks, the sum of A rho |e|, at most |e| times the largest
 * rho d / d'. Where q is not below 1, half of the least K seen, in the norm of <x, y>, takes the place
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

/* B takes the place of rho z, on all ranks. */
static void finish_conjugate(struct solver *solver)
{
    conjugate_publish(&solver->beyond->descent.vectors, &solver->model, true);
    solver_scatter_unvoted(solver);
    solver->beyond->descent.fresh = true;
}

/* The unit of <z, z>. */
static struct flux_unit square_unit(const struct solver *solver)
{
    return conjugate_unit(&solver->model, solver->beyond->descent.bound_residual, solver->beyond->descent.bound_residual,
                          solver->beyond->descent.weight);
}

static struct ballot ballot_conjugate(const struct solver *solver)
{
    struct conjugate_sums sums = conjugate_sum(&solver->beyond->descent.vectors, &solver->model, &solver->beyond->closure,
                                               square_unit(solver));
    struct ballot own = {.light = sums.light, .absorbed = sums.absorbed, .arriving = sums.arriving,
                         .negative = sums.negative, .bulk = sums.bulk, .missing = sums.missing,
                         .largest = sums.largest};
    for (int c = 0; c < BANDS; c++)
        own.square[c] = sums.square[c];
    return own;
}

static struct vote vote_conjugate(struct solver *solver, const struct ballot *sum)
{
    const struct criterion *criterion = &solver->model.criterion;
    struct flux_unit unit = square_unit(solver);
    for (int c = 0; c < BANDS; c++)
        solver->beyond->descent.gamma[c] = flux_to_watts(unit, sum->square[c]);
    solver->beyond->descent.bound_residual = sum->largest;
    double remaining = remaining_by_residual(solver, sum), wanted = wanted_of(solver, sum);
    struct vote vote = vote_of(solver, sum, remaining);
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

/* --- both --- */

/* The largest that an own leaf sends. */
static double brightest_own(const struct solver *solver)
{
    double brightest = 0.0;
    for (int64_t i = 0; i < solver->beyond->descent.vectors.leaf_count; i++) {
        int32_t leaf = solver->beyond->descent.vectors.leaves[i];
        for (int c = 0; c < BANDS; c++)
            brightest = fmax(brightest,
                             fabs(solver->model.forest->patches[leaf].radiosity.band[c]));
    }
    return brightest;
}

void solver_cast_ballot(struct solver *solver)
{
    struct ballot *own = &solver->ballot;
    *own = solver->model.criterion.solver == SOLVER_CG ? ballot_conjugate(solver)
                                                        : ballot_jacobi(solver);
    own->split = solver->turn.split_here;
    own->links = solver->links.count;
    own->divided = own_new_patches(solver);
    own->stop = signals_seen();
    own->brightest = brightest_own(solver);
}

struct vote solver_vote(struct solver *solver)
{
    struct ballot sum = solver->ballot;
    solver->turn.stop = (int)sum.stop;
    struct vote vote = solver->model.criterion.solver == SOLVER_CG ? vote_conjugate(solver, &sum)
                                                                    : vote_jacobi(solver, &sum);
    solver_record_iteration(solver);
    return vote;
}
