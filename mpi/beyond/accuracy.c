/* --accuracy: links and rays are tightened until the error of the answer is small enough.
 *
 * A round is: links converge for an epsilon, the final gather fires N rays from a leaf,
 * spot checks (mpi/beyond/spotcheck.c) measure the error of its answer. The claim is this
 * error with one deviation of its measurement,
 *
 *     claim^2 = E^2 + deviation,        E^2 = rays^2 + mesh^2.
 *
 * and the same is asked of the error relative to a leaf's own light, in the median of all
 * leaves: a lawn in the sun does not make the rooms of a house right.
 *
 * The gather estimates the two parts (rad/beyond/gather/claim.c). Where E^2 exceeds the
 * sum of their squares by more than chance, the mesh has the surplus. If the claim is
 * above the goal, the next round brings E to AIM goals, which leaves room for the
 * deviation. Both parts become alike, unless one is small already, as both cost about as
 * much: noise falls like N^-0.5 and costs N; the mesh's part falls like the third root of
 * epsilon, and leaves grow like the square root of 1 / epsilon. The links go on from
 * where they are, from their own solution: a run is the same whether it is resumed before
 * the gather or never interrupted. Leaves that the gather has split stay split.
 *
 * The mesh becomes no finer where memory, iterations, --max-level or --min-area keep it
 * so, or where a much lower epsilon had no effect. Rays become no more at their largest
 * number, or where rows do not fit into memory. Then the other part is brought down to
 * half of the one that stays, the answer is delivered, and the limit is named.
 *
 * Rejected: aiming by slopes measured between rounds. With two or three rounds slopes are
 * mostly noise. */
#include "mpi/beyond/accuracy.h"

#include <math.h>
#include <string.h>

#include "geom/alloc.h"
#include "mpi/beyond/beyond.h"
#include "mpi/beyond/spotcheck.h"
#include "mpi/beyond/step9.h"
#include "mpi/memory.h"
#include "rad/beyond/gather/slope.h"

enum { ROUNDS_MOST = 12 };

static const double AIM = 0.85, SMALLEST_EPSILON = 1e-10;

/* Rays are multiplied by at most this in a round: with few rays the mesh's part is found
 * cheaply. */
enum { RAYS_FACTOR_MOST = 8 };

/* Epsilon is multiplied in a round by at most this, and at least. */
static const double EPSILON_FACTOR_MOST = 0.5, EPSILON_FACTOR_LEAST = 0.125;

/* Epsilon does not help if it was lowered by EPSILON_FACTOR_LEAST and STUCK of the mesh's
 * error is left. */
static const double STUCK = 0.9;

/* Where limits keep this share of the leaves from being split: NEARLY_ALL_HELD, there is
 * no finer mesh; MANY_HELD, the limits are the reason why epsilon does not help or needs
 * too many rounds. */
static const double NEARLY_ALL_HELD = 0.97, MANY_HELD = 0.1;

/* --- the claim --- */

/* Puts measurements in the place of estimates. */
static void settle_claim(struct solver *solver, const struct spotcheck *check)
{
    struct beyond *beyond = solver->beyond;
    struct gathered *counts = &beyond->answer->counts;
    double estimate = counts->error;
    beyond->accuracy.clear = spotcheck_settle(check, counts);
    double larger = estimate > 0.0 ? fmax(1.0, counts->error / estimate) : 1.0;
    for (int64_t p = 0; p < solver->model.forest->count; p++)
        beyond->answer->error[p] *= (float)larger;
    double factor = fmax(1.0, sqrt(check->own));
    counts->median = fmin(1.0, factor * counts->median);
    counts->worst_tenth = fmin(1.0, factor * counts->worst_tenth);
    counts->median_by_rays = fmin(1.0, factor * counts->median_by_rays);
    counts->median_by_mesh = fmin(1.0, factor * counts->median_by_mesh);
}

/* The error to be brought down: of all light, or of a leaf's own in the median. */
static double error_of(const struct gathered *counts)
{
    return fmax(counts->error, counts->median);
}

static double part_by_rays(const struct gathered *counts)
{
    return fmax(counts->by_rays, counts->median_by_rays);
}

static double part_by_mesh(const struct gathered *counts)
{
    return fmax(counts->by_mesh, counts->median_by_mesh);
}

/* --- limits --- */

/* The limit keeping leaves from being split, and the share of leaves kept. */
static enum hold hold_of_leaves(const struct solver *solver, double *share)
{
    const struct forest *forest = solver->model.forest;
    int64_t leaves = 0, deep = 0, small = 0;
    for (int64_t p = 0; p < forest->count; p++) {
        double area = forest_area(forest, (int32_t)p);
        if (!patch_is_leaf(&forest->patches[p]) || !(area > 0.0))
            continue;
        leaves++;
        if (id_level(forest->patches[p].id) >= solver->model.criterion.max_level)
            deep++;
        else
            small += 0.25 * area < solver->model.patch_threshold;
    }
    *share = (double)(deep + small) / (double)leaves;
    return deep > small ? HOLD_LEVEL : HOLD_AREA;
}

/* The limit keeping the mesh from becoming finer, or a finer mesh from helping. */
static enum hold hold_of_mesh(const struct solver *solver, int64_t links)
{
    const struct accuracy *accuracy = &solver->beyond->accuracy;
    double epsilon = solver->model.criterion.epsilon, share;
    enum hold hold = hold_of_leaves(solver, &share);
    if (solver->memory.reached > 0 ||
        !memory_has_room(&solver->memory, links, 1, solver->model.forest->count))
        return HOLD_MEMORY;
    if (solver->turn.iteration >= solver->model.criterion.max_iterations)
        return HOLD_ITERATIONS;
    bool stuck = (epsilon <= EPSILON_FACTOR_LEAST * accuracy->coarse_epsilon &&
                  part_by_mesh(&solver->beyond->answer->counts) >
                      STUCK * accuracy->coarse) ||
                 epsilon * EPSILON_FACTOR_MOST < SMALLEST_EPSILON;
    if (share > NEARLY_ALL_HELD || (stuck && share > MANY_HELD))
        return hold;
    return stuck ? HOLD_EPSILON : HOLD_NONE;
}

/* The limit keeping rays from being doubled. */
static enum hold hold_of_rays(const struct solver *solver, int rays, int64_t links)
{
    struct memory memory = solver->memory;
    memory.rays = 2 * rays;
    if (memory.rays > GATHER_RAYS_MOST)
        return HOLD_RAYS;
    return memory_has_room(&memory, links, 0, solver->model.forest->count) ? HOLD_NONE
                                                                           : HOLD_MEMORY;
}

/* --- the next round --- */

/* How large one part may be beside the other, if that stays; if `free`, the other is to
 * be brought down, too. */
static double allowed_beside(double other, bool free, double aim)
{
    double even = sqrt(0.5) * aim;
    if (free && other > even)
        return even;
    return other < AIM * aim ? sqrt(aim * aim - other * other) : 0.5 * other;
}

/* True if rays have become more. */
static bool raise_rays(struct solver *solver, double allowed, int64_t links)
{
    struct criterion *criterion = &solver->model.criterion;
    int before = criterion->final_gather;
    for (double left = part_by_rays(&solver->beyond->answer->counts);
         left > allowed && criterion->final_gather < RAYS_FACTOR_MOST * before &&
         hold_of_rays(solver, criterion->final_gather, links) == HOLD_NONE;
         left *= sqrt(0.5)) /* as if by chance */
        criterion->final_gather *= 2;
    solver->memory.rays = criterion->final_gather;
    return criterion->final_gather > before;
}

static void lower_epsilon(struct solver *solver, double allowed)
{
    struct criterion *criterion = &solver->model.criterion;
    struct accuracy *accuracy = &solver->beyond->accuracy;
    double mesh = part_by_mesh(&solver->beyond->answer->counts), part = allowed / mesh;
    double lower = fmax(EPSILON_FACTOR_LEAST, part * part * part);
    lower = fmin(EPSILON_FACTOR_MOST, lower);
    bool much = criterion->epsilon <= EPSILON_FACTOR_LEAST * accuracy->coarse_epsilon;
    if (accuracy->clear && (much || accuracy->coarse == 0.0)) {
        accuracy->coarse = mesh;
        accuracy->coarse_epsilon = criterion->epsilon;
    }
    model_set_epsilon(&solver->model, criterion->epsilon * lower);
}

/* Returns false if nothing can be tightened, and says why. `lowered`: epsilon was. */
static bool tighten(struct solver *solver, int64_t links, bool *lowered)
{
    double by_rays = part_by_rays(&solver->beyond->answer->counts);
    double by_mesh = part_by_mesh(&solver->beyond->answer->counts);
    double aim = AIM * solver->model.criterion.accuracy;
    enum hold mesh = hold_of_mesh(solver, links);
    enum hold rays = hold_of_rays(solver, solver->model.criterion.final_gather, links);
    double rays_allowed = allowed_beside(by_mesh, mesh == HOLD_NONE, aim);
    double mesh_allowed = allowed_beside(by_rays, rays == HOLD_NONE, aim);
    if (by_rays <= rays_allowed && by_mesh <= mesh_allowed) { /* doubt is in the way */
        if (rays != HOLD_NONE || (mesh == HOLD_NONE && by_mesh > by_rays))
            mesh_allowed = AIM * by_mesh;
        else
            rays_allowed = AIM * by_rays;
    }
    *lowered = mesh == HOLD_NONE && by_mesh > mesh_allowed;
    bool raised = raise_rays(solver, rays_allowed, links);
    if (*lowered)
        lower_epsilon(solver, mesh_allowed);
    if (*lowered || raised)
        return true;
    enum hold hold = by_mesh > mesh_allowed ? mesh : rays;
    solver->beyond->accuracy.hold = hold == HOLD_NONE ? HOLD_DOUBT : hold;
    return false;
}

/* Collective. True if another round is to follow. */
static bool wants_more(struct solver *solver, int64_t links, bool *lowered)
{
    struct accuracy *accuracy = &solver->beyond->accuracy;
    accuracy->rounds++;
    if (solver->beyond->answer->counts.checked == 0) {
        accuracy->hold = HOLD_NOTHING;
        return false;
    }
    if (error_of(&solver->beyond->answer->counts) <= solver->model.criterion.accuracy)
        return false;
    if (accuracy->rounds >= ROUNDS_MOST) {
        double share;
        enum hold hold = hold_of_leaves(solver, &share);
        accuracy->hold = share > MANY_HELD ? hold : HOLD_ROUNDS;
        return false;
    }
    return tighten(solver, links, lowered);
}

/* --- rounds --- */

/* The solution of the links. */
struct linked {
    struct vote vote;
    struct rgb *radiosity; /* [count] of the patches there were then */
    int64_t count;
};

/* Puts the light of the links back. Leaves split by the gather stay split, and B is
 * linear over them. */
static void restore_light(struct forest *forest, const struct linked *linked)
{
    for (int64_t p = 0; p < forest->count; p++)
        forest->radiosity[p] = p < linked->count ? linked->radiosity[p]
                                                 : light_by_parent(forest, (int32_t)p);
}

/* Collective. The verdict on a gather. */
static enum finish judge(struct solver *solver, struct vote *vote,
                         const struct linked *linked)
{
    struct spotcheck check = spotcheck_run(solver, solver->model.criterion.accuracy);
    bool lowered = false;
    if (!check.done)
        return FINISH_STOPPED;
    settle_claim(solver, &check);
    if (!wants_more(solver, vote->links, &lowered))
        return FINISH_DONE;
    restore_light(solver->model.forest, linked);
    *vote = linked->vote;
    vote->converged = vote->converged && !lowered;
    return FINISH_AGAIN;
}

enum finish accuracy_finish(struct solver *solver, struct vote *vote)
{
    const struct forest *forest = solver->model.forest;
    struct linked linked = {.vote = *vote, .count = forest->count};
    size_t bytes = (size_t)linked.count * sizeof *linked.radiosity;
    linked.radiosity = alloc_array((size_t)linked.count, sizeof *linked.radiosity);
    memcpy(linked.radiosity, forest->radiosity, bytes);
    enum finish finish = solver_finish(solver, vote);
    if (finish == FINISH_DONE)
        finish = judge(solver, vote, &linked);
    alloc_free(linked.radiosity);
    return finish;
}
