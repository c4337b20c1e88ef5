/* Irradiance at points, by ever better rows: chapter 11 of the course.
 *
 *     rows SCENE.obj [options of phr]
 *
 * The light of phr's links is given: B, constant over each leaf. H is looked for at
 * points of the first two triangles, by n rays, or by n rays and n segments to lamps.
 * Printed are errors, the RMS over points and trials in percent of the RMS of H; then,
 * for three ways, the percentage of errors that are within 2.5 deviations, as the samples
 * tell these. */
#include "compute.h"
#include "geom/hash.h"
#include "geom/lambert.h"
#include "rad/beyond/gather/look.h"
#include "rad/beyond/gather/row.h"
#include "rad/beyond/gather/rows.h"
#include "rad/beyond/sample.h"
#include "rad/beyond/sequence.h"

enum { POINTS = 32, TRIALS = 8, MOST = 1024, TRUE_RAYS = 1 << 14, TRUE_SEGMENTS = 1024,
       LOOKED = 4 };

enum way { RAYS, SEQUENCE, LIGHT, SEEN, PHR, EXACT, WAYS };

/* A point whose H is looked for, and the samples of a trial. */
struct place {
    struct final_gather *gather;
    struct model *model;
    struct vec3 x, normal;
    int32_t root, leaf;
    uint64_t seed;
    bool by_chance; /* samples are random numbers; else points of a sequence */
};

static void draw(const struct place *at, int i, double u[SEQUENCE_DIMENSIONS])
{
    struct sequence sequence = sequence_start(at->seed);
    sequence_point(&sequence, (uint32_t)i, u);
    for (int k = 0; k < SEQUENCE_DIMENSIONS && at->by_chance; k++)
        u[k] = hash_unit(hash_mix(at->seed) + (uint64_t)(SEQUENCE_DIMENSIONS * i + k));
}

/* E of a patch, W/m^2. All is grey. */
static double emission(const struct place *at, int32_t patch)
{
    return forest_material(at->model->forest, patch)->emission.band[0];
}

/* H, W/m^2, and its variance; of samples first their sum, and that of their squares. */
struct estimate {
    double h, variance;
};

static void add_sample(struct estimate *sums, double h)
{
    sums->h += h;
    sums->variance += h * h;
}

static struct estimate mean_of(struct estimate sums, int n)
{
    double h = sums.h / n;
    return (struct estimate){h, (sums.variance / n - h * h) / n};
}

/* Step 1: H by n rays. Without `lamps` their emission does not count. */
static struct estimate by_rays(const struct place *at, int n, bool lamps)
{
    const struct octree *octree = at->model->octree;
    struct vec3 from = point_above(at->x, at->normal);
    struct vec3 along = direction_along(at->normal);
    struct estimate sums = {0.0, 0.0};
    for (int i = 0; i < n; i++) {
        double u[SEQUENCE_DIMENSIONS];
        struct octree_hit hit;
        draw(at, i, u);
        struct vec3 way = cosine_direction(at->normal, along, u[0], u[1]);
        if (!octree_first_hit(octree, from, way, false, &hit, &at->model->counts) ||
            !hit.front)
            continue;
        octree_hit_weights(octree, from, way, &hit);
        int32_t leaf = leaf_at(at->model->forest, hit.triangle, hit.weight);
        double b = at->model->forest->radiosity[leaf].band[0];
        add_sample(&sums, lamps ? b : b - emission(at, leaf));
    }
    return mean_of(sums, n);
}

/* H by a segment to a lamp, to the point of it that u and v stand for. */
static double by_segment(const struct place *at, struct choice lamp, double u, double v)
{
    struct facet to = facet_make(at->model->forest, lamp.patch);
    struct vec3 y = triangle_of_square(&to.triangle, u, v);
    double kernel = point_kernel(at->x, at->normal, y, to.plane.normal);
    int32_t own[2] = {at->root, to.input}, guess = -1;
    if (!(kernel > 0.0) || octree_blocks_segment(at->model->octree, at->x, y, own, &guess,
                                                 &at->model->counts))
        return 0.0;
    return lamp.share * to.area * kernel * emission(at, lamp.patch);
}

/* The light of node k of a cut by which it is chosen. `upto` has shares that are seen in
 * it, by their root: the share of few segments is a guess. */
static double light_of(const struct cuts *cuts, struct cut cut, int64_t k, bool seen)
{
    const struct cut_node *node = &cuts->nodes[cut.first + k];
    double light = node->upto - (k > 0 ? node[-1].upto : 0.0);
    return seen ? light : light / sqrt(cut_seen(&cut, node));
}

/* Chooses a node of a cut, and a lamp of it by power; u in [0, 1). */
static struct choice choose(const struct cuts *cuts, struct cut cut, double u, bool seen)
{
    double all = 0.0;
    int64_t k = 0;
    for (; k < cut.count; k++)
        all += light_of(cuts, cut, k, seen);
    double left = u * all;
    for (k = 0; k < cut.count - 1 && left >= light_of(cuts, cut, k, seen); k++)
        left -= light_of(cuts, cut, k, seen);
    double light = light_of(cuts, cut, k, seen);
    int32_t number = cuts->nodes[cut.first + k].node;
    const struct sender_node *node = &cuts->senders->nodes[number];
    struct choice lamp = sender_choose(cuts->senders, node, left / light);
    lamp.share *= all / light;
    return lamp;
}

/* Step 2: the light of lamps by n segments; they are chosen by what each would bring with
 * nothing in the way, or, `seen`, by the part of that which is seen from around. */
static struct estimate by_segments(const struct place *at, int n, bool seen)
{
    struct cuts *cuts = at->gather->aims->cuts[LAMPS];
    struct cut cut = cuts_at(cuts, at->leaf);
    struct estimate sums = {0.0, 0.0};
    for (int i = 0; i < n; i++) {
        double u[SEQUENCE_DIMENSIONS];
        draw(at, i, u);
        struct choice lamp = choose(cuts, cut, u[2], seen);
        add_sample(&sums, by_segment(at, lamp, u[0], u[1]));
    }
    return mean_of(sums, n);
}

/* The same, by phr. */
static struct estimate by_segments_of_phr(const struct place *at, int n)
{
    struct gather_points points = {.at = &at->x, .count = 1, .middle = at->x,
                                   .plane = at->model->scene->planes[at->root],
                                   .root = at->root};
    struct gather_light light = final_gather_at(at->gather, &points, at->seed, n, false);
    return (struct estimate){light.straight.band[0], rgb_sum(light.variance) / BANDS};
}

/* Step 3: the sum over all leaves, if nothing stands in the way. */
static double by_factors(const struct place *at)
{
    const struct forest *forest = at->model->forest;
    double h = 0.0;
    int32_t leaf = forest_next_leaf(forest, -1);
    for (; leaf >= 0; leaf = forest_next_leaf(forest, leaf)) {
        struct triangle t = forest_triangle(forest, leaf);
        double factor = point_triangle_factor(at->x, at->normal, &t);
        h += factor * forest->radiosity[leaf].band[0];
    }
    return h;
}

/* H by many rays, and by many segments to each lamp. */
static double truth_at(const struct place *at)
{
    const struct senders *lamps = at->gather->aims->senders[LAMPS];
    double u[SEQUENCE_DIMENSIONS], h = by_rays(at, TRUE_RAYS, false).h;
    for (int64_t k = 0; k < lamps->sender_count; k++)
        for (int i = 0; i < TRUE_SEGMENTS; i++) {
            struct choice lamp = {lamps->patches[k], 1.0 / TRUE_SEGMENTS};
            draw(at, i, u);
            h += by_segment(at, lamp, u[0], u[1]);
        }
    return h;
}

static struct estimate estimate_by(enum way way, struct place at, int n)
{
    at.by_chance = way != SEQUENCE && way != PHR;
    if (way == EXACT)
        return (struct estimate){by_factors(&at), 0.0};
    struct estimate rays = by_rays(&at, n, way <= SEQUENCE), lamps = {0.0, 0.0};
    at.seed = hash_mix(at.seed);
    if (way == LIGHT || way == SEEN)
        lamps = by_segments(&at, n, way == SEEN);
    if (way == PHR)
        lamps = by_segments_of_phr(&at, n);
    return (struct estimate){rays.h + lamps.h, rays.variance + lamps.variance};
}

/* A point of the first two triangles, evenly spread over them. */
static struct place place_of(struct final_gather *gather, int number)
{
    struct model *model = gather->model;
    struct place at = {.gather = gather, .model = model, .root = number % 2};
    struct triangle t = scene_root_triangle(model->scene, at.root);
    double u[SEQUENCE_DIMENSIONS], weight[3];
    draw(&at, number, u);
    at.x = triangle_of_square(&t, u[0], u[1]);
    at.normal = model->scene->planes[at.root].normal;
    triangle_weights(&t, at.x, weight);
    at.leaf = leaf_at(model->forest, at.root, weight);
    return at;
}

static void print_errors(struct place *at, const double *truth, int n, bool open)
{
    double errors[WAYS] = {0.0}, covered[WAYS] = {0.0}, light = 0.0;
    for (int k = 0; k < WAYS * POINTS * TRIALS; k++) {
        int way = k % WAYS, p = k / WAYS % POINTS;
        at[p].seed = hash_mix((uint64_t)(k / WAYS));
        struct estimate e = estimate_by((enum way)way, at[p], n);
        double off = e.h - truth[p];
        errors[way] += off * off;
        covered[way] += off * off <= 6.25 * e.variance;
        light += truth[p] * truth[p] / WAYS;
    }
    printf("%5d", n);
    for (int way = 0; way < WAYS - !open; way++)
        printf(" %9.2f", 100.0 * sqrt(errors[way] / light));
    printf(open ? "  " : "         -  ");
    for (int way = LIGHT; way <= PHR; way++)
        printf(" %5.0f", 100.0 * covered[way] / (POINTS * TRIALS));
    printf("\n");
}

/* Looks at the leaves of the first two triangles, which tells how much of the lamps is
 * seen. */
static void look_around(struct final_gather *gather)
{
    const struct forest *forest = gather->model->forest;
    int32_t leaf = forest_next_leaf(forest, -1);
    cuts_count(gather->aims->cuts[LAMPS]);
    for (; leaf >= 0; leaf = forest_next_leaf(forest, leaf))
        if (forest->patches[leaf].id.root < 2)
            final_gather_look(gather, leaf, LOOKED);
    cuts_learn(gather->aims->cuts[LAMPS]);
}

int main(int argc, char **argv)
{
    struct run run = {0};
    if (run_start(&run, &argc, &argv) && run_parse(&run, argc, argv) &&
        compute_light(&run)) {
        struct final_gather *gather =
            final_gather_create(&run.solver->model, MOST, NULL,
                                lit_find(&run.solver->model));
        look_around(gather);
        bool open = view_is_open(gather->view, 0, true) &&
                    view_is_open(gather->view, 1, true);
        struct place at[POINTS];
        double truth[POINTS];
        for (int p = 0; p < POINTS; p++) {
            at[p] = place_of(gather, p);
            truth[p] = truth_at(&at[p]);
        }
        printf("%5s %9s %9s %9s %9s %9s %9s   claims %s\n", "n", "rays", "sequence",
               "light", "seen", "phr", "exact", "of the three");
        for (int n = 16; n <= MOST; n *= 4)
            print_errors(at, truth, n, open);
        final_gather_destroy(gather);
    }
    return run_end(&run);
}
