/* Spot checks.
 *
 * An estimate of an error rests on assumptions, and fails where these do: errors of
 * different leaves are independent, light varies within a leaf as from leaf to leaf, no
 * leaf has a dark part out of sight. So the claim of --accuracy is measured. For leaves
 * drawn at random, paths (rad/beyond/paths.c) estimate the reflected radiosity twice, r
 * and s, independently:
 *
 *     (B - r) (B - s)   has the expectation   (error of B)^2,
 *
 * whatever the noise of r and s. Leaf i is drawn with a probability q_i, and
 *
 *     E^2 = mean over draws of  A_i (B_i - r)(B_i - s) / q_i  /  sum of A B^2
 *
 * is the mean square error (each space counts by its leaves, relative to its own light);
 * its scatter from draw to draw tells the deviation of the mean. A fixed number of draws
 * has no bias. Ending when draws scatter little has some, if few leaves have most of the
 * error: in trials, E^2 is a quarter too small if one draw in 200 has half of it. A third
 * of q goes by area, one by area times the square of the reflected radiosity, one by area
 * times the square of the error estimated by the gather itself: large, bright or
 * seemingly bad leaves are drawn often, and errors of the estimate are found. Draws are
 * spread evenly over the leaves in the order of forest_order(), so over the scene; BATCH
 * at a time, each batch between those before (multiples of the golden ratio).
 *
 * The same draws tell whether errors of leaves relative to their own light are as
 * claimed. The sum of (B - r)(B - s) is held against the sum of the claimed squares, each
 * over q and the square of the leaf's light. A leaf that claims more than all of its
 * light counts as much less.
 *
 * Paths have the answer for their guess: their mean is the truth all the same, and in
 * bright rooms, where paths are long, nearly all noise is gone. (A cube of rho .999 took
 * a hundred times as long.)
 *
 * Many leaves by few paths or few leaves by many? With n^2 the variance of r, the product
 * scatters by E^4 kappa + 2 n^2 E^2 + n^4; trials say that n^2 between E^2 and 2 E^2
 * takes fewest rays. n is measured by a few paths for each leaf of a batch not counted.
 *
 * Rejected: the difference of two solutions, of which the finer is taken for the truth.
 * Both lack much of the same light, all the more where --max-level is in the way. */
#include "mpi/beyond/spotcheck.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/hash.h"
#include "geom/stop.h"
#include "mpi/beyond/beyond.h"
#include "rad/beyond/gather/claim.h"
#include "rad/beyond/paths.h"

/* Draws in a batch, batches at least and at most; paths for each half. */
enum { BATCH = 32, BATCHES_LEAST = 3, BATCHES_MOST = 128, PATHS_LEAST = 16,
       PATHS_MOST = 32768 };

/* Rays that a check may take, besides as many as the gather took. */
static const int64_t RAYS_FREE = 2000000;

/* The largest good variance of one half, in squares of the error. */
static const double NOISE = 2.0;

/* A doubt small enough, in parts of the square. */
static const double DOUBT = 0.35;

/* A surplus of more deviations than this is not by chance. */
static const double SURE = 2.0;

/* Two estimates of a leaf's reflected radiosity, W/m^2; no padding. */
struct finding {
    struct rgb half[2];
};

struct checking {
    struct solver *solver;
    struct pathtracer *pathtracer; /* borrowed */
    int32_t *leaves;  /* [count] reflecting ones, in forest_order() */
    double *upto;     /* [count] sum of the probabilities of these leaves */
    int64_t count;
    double *weight;   /* [lit_count()] of the leaves of a space */
    double light;     /* area times the square of the reflected radiosity of all leaves,
                         each times its weight */
    int64_t rays_most;
    int paths;        /* for each half */
    int32_t drawn[BATCH];          /* numbers of the leaves of a batch */
    struct finding found[BATCH];   /* estimates of these leaves by paths */
    struct spotcheck result;
};

/* Sums over draws. */
struct draws {
    double sum, squares;     /* of terms of E^2, see above, and of their squares */
    double own, own_squares; /* the same relative to the leaves' own light */
    double claimed;          /* of the terms claimed, relative to this */
    double noise;            /* of the variances of paths, as terms of E^2 */
};

static struct rgb reflected(const struct forest *forest, int32_t leaf)
{
    return rgb_sub(forest->radiosity[leaf], forest_material(forest, leaf)->emission);
}

/* The parts of a leaf in the three sums behind its probability. */
struct merit {
    double area;
    double light; /* area times the square of the reflected radiosity */
    double error; /* area times the square of the estimated error */
};

static struct merit merit_of(const struct checking *c, int32_t leaf)
{
    double area = forest_area(c->solver->model.forest, leaf);
    double error = (double)c->solver->beyond->answer->error[leaf];
    struct rgb b = reflected(c->solver->model.forest, leaf);
    double weight = c->weight[node_space(&c->solver->model, leaf)];
    return (struct merit){area, weight * (area * rgb_dot(b, b)),
                          weight * (area * error * error)};
}

static double over(double part, double sum)
{
    return sum > 0.0 ? part / sum : 0.0;
}

/* Weighs spaces so that the light of each is its part of all leaves. */
static void weigh_spaces(struct checking *c)
{
    const struct model *model = &c->solver->model;
    int32_t spaces = lit_count(model);
    double *light = alloc_array((size_t)spaces, sizeof *light), most = 0.0;
    int64_t *leaves = alloc_array((size_t)spaces, sizeof *leaves);
    c->weight = alloc_array((size_t)spaces, sizeof *c->weight);
    for (int64_t i = 0; i < c->count; i++) {
        struct rgb b = reflected(model->forest, c->leaves[i]);
        int32_t s = node_space(model, c->leaves[i]);
        light[s] += forest_area(model->forest, c->leaves[i]) * rgb_dot(b, b);
        leaves[s]++;
        most = fmax(most, light[s]);
    }
    for (int32_t s = 0; s < spaces; s++)
        if (light[s] > 0.0)
            c->weight[s] = (double)leaves[s] / (double)c->count * (most / light[s]);
    alloc_free(leaves);
    alloc_free(light);
}

/* Lists the leaves to draw from, and their probabilities. */
static void list_leaves(struct checking *c)
{
    const struct forest *forest = c->solver->model.forest;
    struct merit sum = {0.0, 0.0, 0.0};
    double upto = 0.0;
    c->leaves = alloc_array((size_t)forest->count, sizeof *c->leaves);
    c->upto = alloc_array((size_t)forest->count, sizeof *c->upto);
    int32_t leaf = forest_next_leaf(forest, -1);
    for (; leaf >= 0; leaf = forest_next_leaf(forest, leaf)) {
        if (!(rgb_sum(forest_material(forest, leaf)->reflectance) > 0.0))
            continue;
        c->leaves[c->count++] = leaf;
    }
    weigh_spaces(c);
    for (int64_t i = 0; i < c->count; i++) {
        struct merit merit = merit_of(c, c->leaves[i]);
        sum.area += merit.area;
        sum.light += merit.light;
        sum.error += merit.error;
    }
    for (int64_t i = 0; i < c->count; i++) {
        struct merit merit = merit_of(c, c->leaves[i]);
        c->upto[i] = upto += over(merit.area, sum.area) + over(merit.light, sum.light) +
                             over(merit.error, sum.error);
    }
    for (int64_t i = 0; i < c->count; i++)
        c->upto[i] /= upto;
    c->light = sum.light;
}

/* Lights of dim spaces are chosen as often as those of the brightest. */
static double *favour_spaces(const struct model *model)
{
    int32_t roots = model->forest->root_count;
    double *favour = alloc_array((size_t)roots, sizeof *favour);
    for (int32_t root = 0; root < roots; root++)
        favour[root] = space_dimness(model->spaces, (uint32_t)root);
    return favour;
}

static void draw_leaves(struct checking *c, int batch)
{
    double moved = (batch + 0.5) * 0.6180339887498949;
    moved -= floor(moved);
    for (int k = 0; k < BATCH; k++)
        c->drawn[k] = (int32_t)sum_place(c->upto, c->count, (k + moved) / BATCH);
}

static struct finding trace_leaf(const struct checking *c, int32_t leaf, uint64_t draw)
{
    struct patch_id id = c->solver->model.forest->patches[leaf].id;
    struct triangle part = pathtracer_part(id);
    uint64_t seed = hash_mix(hash_mix(id_number(id)) + draw);
    struct finding found;
    for (uint64_t half = 0; half < 2; half++)
        found.half[half] = pathtracer_reflected(c->pathtracer, (int32_t)id.root, &part,
                                                c->paths, seed + half);
    return found;
}

/* Collective. Each rank traces its share of the leaves drawn. */
static void trace_batch(struct checking *c, int batch)
{
    const struct comm *comm = c->solver->comm;
    int most = (BATCH - 1) / comm->size + 1; /* leaves of a rank */
    int64_t before = c->pathtracer->counts->rays;
    struct finding own[BATCH] = {{.half = {{{0.0, 0.0, 0.0}}}}};
    for (int k = comm->rank; k < BATCH && !stop_is_asked(); k += comm->size)
        own[k / comm->size] =
            trace_leaf(c, c->leaves[c->drawn[k]], (uint64_t)(BATCH * batch + k));
    struct finding *all = comm_gather_each(comm, own, (size_t)most * sizeof *own);
    for (int k = 0; k < BATCH; k++)
        c->found[k] = all[k % comm->size * most + k / comm->size];
    int64_t sums[] = {c->pathtracer->counts->rays - before, stop_is_asked()};
    comm_add(comm, sums, 2);
    c->result.rays += sums[0];
    c->result.done = c->result.done && sums[1] == 0;
    alloc_free(all);
}

/* The square of a leaf's deviation, relative to its reflected light `b`. */
static double claim_of(const struct checking *c, int32_t leaf, struct rgb b)
{
    double most = rgb_most(b);
    double error = (double)c->solver->beyond->answer->error[leaf];
    double claim = claim_deviation(error) / most;
    return most > 0.0 ? claim * claim : 0.0;
}

/* Collective. Adds the draws of a batch to the tally. */
static void check_batch(struct checking *c, int batch, struct draws *tally)
{
    const struct forest *forest = c->solver->model.forest;
    draw_leaves(c, batch);
    trace_batch(c, batch);
    for (int k = 0; k < BATCH; k++) {
        int32_t i = c->drawn[k], leaf = c->leaves[i];
        double likely = c->upto[i] - (i > 0 ? c->upto[i - 1] : 0.0);
        double weight = c->weight[node_space(&c->solver->model, leaf)];
        double scale = weight * forest_area(forest, leaf) / (likely * c->light);
        struct rgb b = reflected(forest, leaf), off[2], apart;
        for (int band = 0; band < BANDS; band++) {
            for (int half = 0; half < 2; half++)
                off[half].band[band] = b.band[band] - c->found[k].half[half].band[band];
            apart.band[band] = off[0].band[band] - off[1].band[band];
        }
        double product = rgb_dot(off[0], off[1]), value = scale * product;
        double light = rgb_dot(b, b), claim = claim_of(c, leaf, b);
        double share = light > 0.0 ? 1.0 / (fmax(1.0, claim) * likely) : 0.0;
        double own = light > 0.0 ? share * product / light : 0.0;
        tally->sum += value;
        tally->squares += value * value;
        tally->own += own;
        tally->own_squares += own * own;
        tally->claimed += share * claim;
        tally->noise += scale * 0.5 * rgb_dot(apart, apart);
    }
}

/* Collective. Chooses the best number of paths for an error of this square. */
static void choose_paths(struct checking *c, double square)
{
    struct draws tally = {.sum = 0.0};
    c->paths = PATHS_LEAST;
    check_batch(c, BATCHES_MOST, &tally);
    double noise = tally.noise / BATCH;
    int64_t rays = 2 * BATCHES_LEAST * c->result.rays; /* fewest batches, doubled */
    for (; c->paths < PATHS_MOST && noise > NOISE * square && rays <= c->rays_most;
         c->paths *= 2, noise *= 0.5, rays *= 2) {
    }
}

/* Collective. */
static void check_leaves(struct checking *c, double goal)
{
    struct spotcheck *result = &c->result;
    struct draws tally = {.sum = 0.0};
    bool goes_on = true;
    for (int batch = 0; goes_on && result->done; batch++) {
        check_batch(c, batch, &tally);
        result->leaves += BATCH;
        result->paths += 2 * BATCH * c->paths;
        double count = (double)result->leaves, mean = tally.sum / count;
        result->square = mean;
        result->doubt = sqrt(fmax(0.0, tally.squares / count - mean * mean) / count);
        double enough = DOUBT * fmax(mean, 0.25 * goal * goal);
        double doubt = sqrt(fmax(0.0, tally.own_squares - tally.own * tally.own / count));
        result->own = tally.claimed > 0.0
                          ? (fmax(0.0, tally.own) + doubt) / tally.claimed : 1.0;
        bool most = batch + 1 == BATCHES_MOST || result->rays > c->rays_most;
        goes_on = batch + 1 < BATCHES_LEAST || (result->doubt > enough && !most);
    }
}

struct spotcheck spotcheck_run(struct solver *solver, double goal)
{
    const struct gathered *gathered = &solver->beyond->answer->counts;
    double expected = fmax(0.5 * goal, gathered->error);
    account_begin(&solver->account, PHASE_SPOT_CHECKS);
    struct pathtracer pathtracer =
        pathtracer_make(solver->model.scene, solver->model.octree);
    struct checking c = {
        .solver = solver, .pathtracer = &pathtracer, .result = {.done = true}};
    c.rays_most = RAYS_FREE + gathered->rays + gathered->segments;
    double *favour = favour_spaces(&solver->model);
    pathtracer.guess = solver->model.forest;
    pathtracer_favour(&pathtracer, favour);
    list_leaves(&c);
    progress_begin(solver->progress, "checking", -1, 0);
    if (c.light > 0.0) {
        choose_paths(&c, expected * expected);
        check_leaves(&c, goal);
    }
    const struct octree_counts *counts = pathtracer.counts;
    account_work(&solver->account, WORK_FINAL_GATHER,
                 counts->node_tests + counts->triangle_tests, 0);
    alloc_free(c.leaves);
    alloc_free(c.upto);
    alloc_free(c.weight);
    alloc_free(favour);
    pathtracer_free(&pathtracer);
    account_end(&solver->account, PHASE_SPOT_CHECKS);
    return c.result;
}

bool spotcheck_settle(const struct spotcheck *check, struct gathered *gathered)
{
    double square = fmax(0.0, check->square), estimate = gathered->error;
    bool clear = square - estimate * estimate > SURE * check->doubt;
    if (clear) {
        gathered->by_mesh = sqrt(square - gathered->by_rays * gathered->by_rays);
    } else if (estimate > 0.0) {
        double factor = sqrt(fmax(square, check->doubt)) / estimate;
        gathered->by_rays *= factor;
        gathered->by_mesh *= factor;
    }
    gathered->error = sqrt(square + check->doubt);
    gathered->checked = check->leaves;
    gathered->paths = check->paths;
    return clear;
}
