/* The mesh of a final gather.
 *
 * The links have split patches where they exchange much light, whether light varies there
 * or not. Before rows are made, a few rays look at the quarters of each leaf. Where their
 * light differs by more than chance explains, the leaf is split and its children are
 * looked at, and so on. The goal is an even squared error, by area: a leaf is split if
 *
 *     area * variance of rho H over it  >  MESH * epsilon * sum of area * (rho H)^2,
 *
 * so all leaves have about the same share of the error. Where a thing stands on a leaf,
 * chance counts as well: below a house the light of a lawn is another one. If all of its
 * light falls on one quarter, a leaf has a variance of 3 times the square of its light,
 * at most: leaves too dark, by the light of the links, to be split even then are not
 * looked at. In a scene of many small triangles few are looked at.
 *
 * Leaves with exact rows are not looked at: links without blockers tell where B varies,
 * over a leaf B is linear, and a leaf where B bends (rad/beyond/gather/bends.c) is split.
 * But an undivided root has no parent: where a surface is many small roots, each link to
 * one tells too little to divide the root, and B would be constant over each. So these
 * are looked at, too.
 *
 * Looks also tell how noisy the light of a leaf is: rows get rays in proportion to the
 * square root of area times variance, which makes the noise, by area, least for a given
 * number of all rays (Neyman, 1934). A leaf under a lamp housing gets many, a leaf of a
 * plain wall few. So do segments to lamps, which are many in a half-shade where rays may
 * be few.
 *
 * Looks also measure the work of a ray. Further looks and rows are dealt by the work
 * predicted so. */
#include "mpi/beyond/gather_mesh.h"

#include <math.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/stop.h"
#include "mpi/beyond/stages.h"
#include "mpi/memory.h"
#include "rad/beyond/gather/bends.h"
#include "rad/oracle.h"

static const double MESH = 0.005;

/* The variance of the light over a leaf is at most this times its square, which the links
 * tell with an error of this part of the mean square. */
static const double SPREAD_MOST = 3.0, UNSURE = 0.1;

/* Where a thing stands on a leaf, its light has a variance of at least this part of its
 * square: few rays of a look may miss a strip of sunlit floor reaching below a wall, of
 * which a dark room would have the mean. */
static const double SPREAD_CUT = 0.0625;

/* Light of the mean radiosity of all surfaces, lamps included, has about this variance by
 * one ray, relative to its square. */
static const double VARIANCE_OF_MEAN = 3.0;

/* A look takes this part of the rays of a row for each quarter of the leaf. If these are
 * fewer than FEWEST_LOOKED, there are no looks. */
enum { ROWS_PER_LOOK = 16, FEWEST_LOOKED = 4 };

enum { ROUNDS = 6 };

/* Fewest rays of a black leaf. */
enum { FEWEST = 4 };

/* Few rays of a look may miss what is bright: the mean noise of all leaves, relative to
 * their light, counts as so many more. */
static const double UNSURE_RAYS = 32.0;

/* Marks in place of a variance: the row will be exact; too dark to be looked at. */
static const double IS_EXACT = -1.0, IS_UNSEEN = -2.0;

/* Estimates for a leaf, by its look or its parent's. */
struct known {
    double by_ray;     /* variance of rho H by one ray, (W/m^2)^2; IS_EXACT, IS_UNSEEN */
    double by_segment; /* the same by one segment */
    float fixed;       /* tests of its row, without its rays */
    float work;        /* tests of each ray */
};

/* Sums over the leaves of a space, these by area. */
struct space_sums {
    double square;     /* of (rho H)^2, W/m^2 squared */
    double unseen;     /* the part of leaves not looked at */
    double threshold;  /* of splitting; below 0: not known yet */
    double by_ray, by_segment; /* variances */
    double fixed, work; /* of leaves looked at, each counting 1 */
    int64_t seen;       /* leaves looked at */
};

struct looking {
    struct solver *solver;
    struct final_gather *gather;
    struct gather_mesh *mesh;
    uint8_t *open;   /* [roots] 1: leaves of the root have exact rows */
    struct known *known; /* [forest->count] of leaves */
    int64_t known_capacity;
    struct space_sums *sums; /* [lit_count()] */
    int rays;        /* of a look at a quarter */
    int64_t links;   /* of all ranks */
    const int32_t *leaves;     /* [count] looked at */
    struct gather_look *looks; /* [looked] of this rank */
    int64_t looked;
};

/* --- work --- */

/* The predicted work of leaves, in tests, [count], to be freed: of their rows in `mesh`;
 * or, with NULL, of looks. */
static int64_t *predict_work(const struct looking *l, const int32_t *leaves,
                             const struct gather_mesh *mesh, int64_t count)
{
    int64_t *work = alloc_array((size_t)count, sizeof *work);
    for (int64_t i = 0; i < count; i++) {
        const struct known *known = &l->known[leaves[i]];
        double rays = mesh ? 0.5 * (mesh->rays[i] + mesh->segments[i]) : l->rays;
        work[i] = 1 + (int64_t)((double)known->fixed + rays * (double)known->work);
    }
    return work;
}

/* --- looks --- */

static void list_leaves(struct gather_mesh *mesh, const struct forest *forest)
{
    alloc_free(mesh->leaves);
    mesh->leaves = alloc_array((size_t)forest->count, sizeof *mesh->leaves);
    mesh->count = 0;
    int32_t leaf = forest_next_leaf(forest, -1);
    for (; leaf >= 0; leaf = forest_next_leaf(forest, leaf))
        mesh->leaves[mesh->count++] = leaf;
}

static void look_at(void *context, int64_t item)
{
    struct looking *l = context;
    l->looks[l->looked++] = final_gather_look(l->gather, l->leaves[item], l->rays);
}

/* Collective. Looks at `count` leaves; [count], on all ranks. */
static struct gather_look *look(struct looking *l, const int32_t *leaves, int64_t count)
{
    const struct comm *comm = l->solver->comm;
    int64_t *work = predict_work(l, leaves, NULL, count);
    struct gather_look *looks = alloc_array((size_t)count, sizeof *looks);
    struct stages stages = {.solver = l->solver, .gather = l->gather, .act = look_at,
                            .context = l, .work = work, .count = count};
    final_gather_renew(l->gather);
    stages_make_cuts(l->solver, l->gather, leaves, NULL, count);
    l->leaves = leaves;
    l->looks = alloc_array((size_t)count, sizeof *looks);
    l->looked = 0;
    stages_run(&stages);
    memmove(l->looks + stages.at[comm->rank], l->looks,
            (size_t)l->looked * sizeof *looks);
    comm_share(comm, l->looks, stages.counts, stages.at, sizeof *looks);
    for (int64_t i = 0; i < count; i++)
        looks[i] = l->looks[stages.place[i]];
    stages_free(&stages);
    alloc_free(l->looks);
    alloc_free(work);
    return looks;
}

/* Variance of rho H over the leaf and by chance, summed over bands. */
static double variance_of(const struct gather_look *look)
{
    double spread = 0.0;
    for (int c = 0; c < BANDS; c++) {
        double sum = 0.0, squares = 0.0;
        for (int k = 0; k < 4; k++) {
            double b = (double)look->reflected[k][c];
            sum += b;
            squares += b * b;
        }
        spread += 0.25 * squares - 0.0625 * sum * sum;
    }
    return spread;
}

/* The same, less the variance by chance. */
static double spread_of(const struct gather_look *look)
{
    return fmax(0.0, variance_of(look) - look->noise);
}

static double square_of(const struct gather_look *look)
{
    double square = 0.0;
    for (int k = 0; k < 4; k++)
        for (int c = 0; c < BANDS; c++)
            square +=
                0.25 * (double)look->reflected[k][c] * (double)look->reflected[k][c];
    return square;
}

/* Splits a leaf; its children get the reflected light of its quarters. */
static void split_leaf(struct forest *forest, int32_t leaf,
                       const struct gather_look *look)
{
    forest_split(forest, leaf);
    int32_t first = forest->patches[leaf].children;
    const struct rgb *emission = &forest_material(forest, leaf)->emission;
    for (int k = 0; k < 4; k++)
        for (int c = 0; c < BANDS; c++)
            forest->radiosity[first + k].band[c] =
                emission->band[c] + (double)look->reflected[k][c];
}

static void keep_known(struct looking *l, int32_t leaf, const struct gather_look *look)
{
    RESERVE(l->known, &l->known_capacity, l->solver->model.forest->count);
    RESERVE(l->mesh->cut, &l->mesh->cut_capacity, l->solver->model.forest->count);
    l->mesh->cut[leaf] = look->cut;
    l->known[leaf] =
        (struct known){look->variance + spread_of(look) - look->of_segment,
                       look->of_segment, look->fixed, look->work};
}

/* (rho H)^2 of a leaf, from links or looks. */
static struct rgb squares_of_light(const struct forest *forest, int32_t leaf)
{
    struct rgb light =
        rgb_sub(forest->radiosity[leaf], forest_material(forest, leaf)->emission);
    for (int c = 0; c < BANDS; c++)
        light.band[c] *= light.band[c];
    return light;
}

/* The same, over all bands. */
static double square_of_light(const struct forest *forest, int32_t leaf)
{
    return rgb_sum(squares_of_light(forest, leaf));
}

static bool may_split(struct looking *l, int32_t leaf)
{
    const struct solver *solver = l->solver;
    if (!patch_may_split(&solver->model, leaf))
        return false;
    bool room =
        memory_has_room(&solver->memory, l->links, 1, solver->model.forest->count);
    l->mesh->limited = l->mesh->limited || !room;
    return room;
}

static struct space_sums *sums_of(const struct looking *l, int32_t leaf)
{
    return &l->sums[node_space(&l->solver->model, leaf)];
}

/* Looks at `leaves` and splits those over which light varies; the children of these take
 * the place of all. Returns their number. */
static int64_t split_leaves(struct looking *l, int32_t **leaves, int64_t count)
{
    struct solver *solver = l->solver;
    struct forest *forest = solver->model.forest;
    struct gather_look *looks = look(l, *leaves, count);
    int32_t spaces = lit_count(&solver->model);
    for (int32_t s = 0; s < spaces; s++)
        l->sums[s].square = l->sums[s].unseen;
    for (int64_t i = 0; i < count; i++)
        sums_of(l, (*leaves)[i])->square +=
            forest_area(forest, (*leaves)[i]) * square_of(&looks[i]);
    for (int32_t s = 0; s < spaces; s++)
        if (l->sums[s].threshold < 0.0)
            l->sums[s].threshold =
                MESH * solver->model.criterion.epsilon * l->sums[s].square;
    int32_t *next = alloc_array(4 * (size_t)count, sizeof *next);
    int64_t made = 0;
    for (int64_t i = 0; i < count; i++) {
        int32_t leaf = (*leaves)[i];
        double spread = spread_of(&looks[i]);
        if (looks[i].cut)
            spread =
                fmax(variance_of(&looks[i]), SPREAD_CUT * square_of_light(forest, leaf));
        keep_known(l, leaf, &looks[i]);
        if (forest_area(forest, leaf) * spread <= sums_of(l, leaf)->threshold ||
            !may_split(l, leaf))
            continue;
        split_leaf(forest, leaf, &looks[i]);
        for (int k = 0; k < 4; k++) {
            next[made++] = forest->patches[leaf].children + k;
            keep_known(l, forest->patches[leaf].children + k, &looks[i]);
        }
    }
    alloc_free(looks);
    alloc_free(*leaves);
    *leaves = next;
    return made;
}

/* Splits a leaf into parts on which B is linear, so many levels deep. */
static void split_bent_leaf(struct looking *l, int32_t leaf, int levels)
{
    struct forest *forest = l->solver->model.forest;
    if (levels == 0 || !may_split(l, leaf))
        return;
    forest_split(forest, leaf);
    l->mesh->split++;
    int32_t first = forest->patches[leaf].children;
    for (int32_t child = first; child < first + 4; child++)
        forest->radiosity[child] = light_by_parent(forest, child);
    for (int32_t child = first; child < first + 4; child++)
        split_bent_leaf(l, child, levels - 1);
}

/* Splits leaves with exact rows where light bends. */
static void split_bent(struct looking *l)
{
    struct gather_mesh *mesh = l->mesh;
    struct forest *forest = l->solver->model.forest;
    const struct model *model = &l->solver->model;
    struct rgb *sums = alloc_array((size_t)lit_count(model), sizeof *sums);
    for (int64_t i = 0; i < mesh->count; i++)
        rgb_add(&sums[node_space(model, mesh->leaves[i])],
                forest_area(forest, mesh->leaves[i]),
                squares_of_light(forest, mesh->leaves[i]));
    for (int32_t s = 0; s < lit_count(model); s++) {
        double dim = GATHER_DIM * GATHER_DIM * rgb_sum(sums[s]);
        for (int c = 0; c < BANDS; c++)
            sums[s].band[c] = fmax(sums[s].band[c], dim);
    }
    for (int64_t i = 0; i < mesh->count; i++) {
        int32_t leaf = mesh->leaves[i];
        if (l->open[forest->patches[leaf].id.root])
            split_bent_leaf(
                l, leaf, gather_splits_of(model, leaf, &sums[node_space(model, leaf)]));
    }
    alloc_free(sums);
    list_leaves(mesh, forest);
}

/* Leaves of open roots will have exact rows: of divided ones, or of `all`. */
static void know_exact(struct looking *l, bool all)
{
    const struct forest *forest = l->solver->model.forest;
    for (int64_t i = 0; i < l->mesh->count; i++) {
        int32_t leaf = l->mesh->leaves[i];
        const struct patch *patch = &forest->patches[leaf];
        if (l->open[patch->id.root] && (all || patch->parent >= 0))
            l->known[leaf] = (struct known){IS_EXACT, 0.0, 0.0f, 1.0f};
    }
}

/* What is known of a leaf in need of rays before the look: a guess at the variance of rho
 * H by one ray, by the light of the leaf, from the links, and by light of the mean
 * radiosity, which may arrive, too. */
static struct known guess_of(const struct looking *l, int32_t leaf)
{
    const struct forest *forest = l->solver->model.forest;
    double rho = rgb_sum(forest_material(forest, leaf)->reflectance) / BANDS;
    const struct lit *lit = &l->gather->lit[node_space(&l->solver->model, leaf)];
    double mean = rho * lit->mean / BANDS; /* of a band */
    double guess = square_of_light(forest, leaf) + VARIANCE_OF_MEAN * BANDS * mean * mean;
    return (struct known){guess, guess, 0.0f, 1.0f};
}

/* Before there are looks: guesses for all leaves in need of rays. */
static void know_nothing(struct looking *l)
{
    RESERVE(l->known, &l->known_capacity, l->solver->model.forest->count);
    for (int64_t i = 0; i < l->mesh->count; i++)
        l->known[l->mesh->leaves[i]] = guess_of(l, l->mesh->leaves[i]);
    know_exact(l, l->rays < FEWEST_LOOKED);
}

/* The leaves to be looked at, [*count]; black ones have a guess of 0. */
static int32_t *choose_leaves(struct looking *l, int64_t *count)
{
    const struct gather_mesh *mesh = l->mesh;
    const struct model *model = &l->solver->model;
    for (int64_t i = 0; i < mesh->count; i++)
        sums_of(l, mesh->leaves[i])->square +=
            forest_area(model->forest, mesh->leaves[i]) *
            square_of_light(model->forest, mesh->leaves[i]);
    int32_t *leaves = alloc_array((size_t)mesh->count, sizeof *leaves);
    *count = 0;
    for (int64_t i = 0; i < mesh->count; i++) {
        struct known *known = &l->known[mesh->leaves[i]];
        double area = forest_area(model->forest, mesh->leaves[i]);
        double light = area * square_of_light(model->forest, mesh->leaves[i]);
        int32_t space = node_space(model, mesh->leaves[i]);
        double sum = l->sums[space].square, mean = sum / l->gather->lit[space].area;
        double most = SPREAD_MOST * (light + UNSURE * area * mean);
        if (known->by_ray > 0.0 && most >= MESH * model->criterion.epsilon * sum) {
            leaves[(*count)++] = mesh->leaves[i];
            continue;
        }
        if (known->by_ray != IS_EXACT)
            known->by_ray = IS_UNSEEN;
        l->sums[space].unseen += light;
    }
    return leaves;
}

/* Gives leaves not looked at the mean noise, relative to their light, and the mean work
 * of the others in their space, or a guess if there are none. The noise of the others,
 * too, is made more like the mean. */
static void guess_unseen(struct looking *l)
{
    const struct gather_mesh *mesh = l->mesh;
    const struct forest *forest = l->solver->model.forest;
    double unsure = UNSURE_RAYS / (UNSURE_RAYS + 4.0 * l->rays);
    for (int32_t s = 0; s < lit_count(&l->solver->model); s++)
        l->sums[s] = (struct space_sums){.square = 0.0};
    for (int64_t i = 0; i < mesh->count; i++) {
        const struct known *known = &l->known[mesh->leaves[i]];
        struct space_sums *sums = sums_of(l, mesh->leaves[i]);
        double area = forest_area(forest, mesh->leaves[i]);
        if (known->by_ray < 0.0)
            continue;
        sums->by_ray += area * known->by_ray;
        sums->by_segment += area * known->by_segment;
        sums->square += area * square_of_light(forest, mesh->leaves[i]);
        sums->fixed += (double)known->fixed;
        sums->work += (double)known->work;
        sums->seen++;
    }
    for (int64_t i = 0; i < mesh->count; i++) {
        struct known *known = &l->known[mesh->leaves[i]];
        const struct space_sums *sums = sums_of(l, mesh->leaves[i]);
        double all = square_of_light(forest, mesh->leaves[i]);
        double part = sums->square > 0.0 ? all / sums->square : 0.0;
        if (known->by_ray == IS_UNSEEN && sums->seen == 0)
            *known = guess_of(l, mesh->leaves[i]);
        else if (known->by_ray == IS_UNSEEN)
            *known = (struct known){part * sums->by_ray, part * sums->by_segment,
                                    (float)(sums->fixed / (double)sums->seen),
                                    (float)(sums->work / (double)sums->seen)};
        else if (known->by_ray >= 0.0) {
            known->by_ray += unsure * (part * sums->by_ray - known->by_ray);
            known->by_segment += unsure * (part * sums->by_segment - known->by_segment);
        }
    }
}

/* Collective. Looks and splits, round by round. */
static void refine(struct looking *l)
{
    struct gather_mesh *mesh = l->mesh;
    int64_t count;
    for (int32_t s = 0; s < lit_count(&l->solver->model); s++)
        l->sums[s].threshold = -1.0;
    int32_t *leaves = choose_leaves(l, &count);
    for (int round = 0; round < ROUNDS && count > 0; round++) {
        progress_begin(l->solver->progress, "looking", round, 0);
        count = split_leaves(l, &leaves, count);
        mesh->split += count / 4;
    }
    alloc_free(leaves);
    forest_average(l->solver->model.forest);
    list_leaves(mesh, l->solver->model.forest);
    know_exact(l, true);
    guess_unseen(l);
}

/* Inner patches are cut where a child is. Patches made by looks are all known. */
static void raise_cuts(struct gather_mesh *mesh, const struct forest *forest)
{
    RESERVE(mesh->cut, &mesh->cut_capacity, forest->count);
    for (int64_t i = forest->count - 1; i >= 0; i--)
        if (mesh->cut[i] && forest->patches[i].parent >= 0)
            mesh->cut[forest->patches[i].parent] = 1;
}

/* --- rays --- */

static bool is_black(const struct forest *forest, int32_t leaf)
{
    return !(rgb_sum(forest_material(forest, leaf)->reflectance) > 0.0);
}

/* Rays of a black leaf, for the balance of power alone, whose noise most comes from rows
 * of large leaves: the mean number for a leaf of the mean area or more where all light is
 * reflected, and in proportion fewer for small leaves, or where most surface is black, as
 * below a sky. `reflectance` and `area`: means of all leaves. */
static int rays_of_black(const struct looking *l, int32_t leaf, double reflectance,
                         double area)
{
    double part = reflectance * forest_area(l->solver->model.forest, leaf) / area;
    int rays = (int)(fmin(1.0, part) * l->gather->rays);
    return rays > FEWEST ? rays : FEWEST;
}

/* Shares shots among the leaves of each space apart, as gather_share_shots() does:
 * `worth` and `shots`, [2 * mesh->count], of rays and segments. */
static void share_by_space(const struct looking *l, const double *worth, int *shots)
{
    const struct gather_mesh *mesh = l->mesh;
    const struct model *model = &l->solver->model;
    int32_t spaces = lit_count(model);
    int64_t *at = alloc_array((size_t)spaces + 1, sizeof *at);
    double *sorted = alloc_array(2 * (size_t)mesh->count, sizeof *sorted);
    int *dealt = alloc_array(2 * (size_t)mesh->count, sizeof *dealt);
    for (int64_t k = 0; k < 2 * mesh->count; k++)
        at[node_space(model, mesh->leaves[k / 2]) + 1]++;
    for (int32_t s = 0; s < spaces; s++)
        at[s + 1] += at[s];
    for (int64_t k = 0; k < 2 * mesh->count; k++)
        sorted[at[node_space(model, mesh->leaves[k / 2])]++] = worth[k];
    for (int32_t s = spaces; s > 0; s--) /* back to where each begins */
        at[s] = at[s - 1];
    at[0] = 0;
    for (int32_t s = 0; s < spaces; s++)
        gather_share_shots(sorted + at[s], at[s + 1] - at[s], l->gather->rays,
                           dealt + at[s]);
    for (int64_t k = 0; k < 2 * mesh->count; k++)
        shots[k] = dealt[at[node_space(model, mesh->leaves[k / 2])]++];
    alloc_free(dealt);
    alloc_free(sorted);
    alloc_free(at);
}

/* Shares rays and segments in proportion to the square root of area times variance. Exact
 * rows, which make no use of theirs, have the mean number. */
static void share_rays(struct looking *l)
{
    struct gather_mesh *mesh = l->mesh;
    const struct forest *forest = l->solver->model.forest;
    double *worth = alloc_array(2 * (size_t)mesh->count, sizeof *worth);
    int *shots = alloc_array(2 * (size_t)mesh->count, sizeof *shots);
    double reflectance = 0.0, area = 0.0;
    for (int64_t i = 0; i < mesh->count; i++) {
        double own = forest_area(forest, mesh->leaves[i]);
        area += own;
        reflectance +=
            own / BANDS * rgb_sum(forest_material(forest, mesh->leaves[i])->reflectance);
    }
    for (int64_t k = 0; k < 2 * mesh->count; k++) {
        int32_t leaf = mesh->leaves[k / 2];
        const struct known *known = &l->known[leaf];
        bool black = is_black(forest, leaf);
        double variance = k % 2 ? known->by_segment : known->by_ray;
        worth[k] = black || known->by_ray == IS_EXACT
                       ? -1.0
                       : sqrt(forest_area(forest, leaf) * variance);
    }
    share_by_space(l, worth, shots);
    mesh->rays = alloc_array((size_t)mesh->count, sizeof *mesh->rays);
    mesh->segments = alloc_array((size_t)mesh->count, sizeof *mesh->segments);
    mesh->exact = alloc_array((size_t)mesh->count, sizeof *mesh->exact);
    for (int64_t i = 0; i < mesh->count; i++) {
        mesh->exact[i] = l->known[mesh->leaves[i]].by_ray == IS_EXACT;
        mesh->rays[i] = mesh->exact[i] ? l->gather->rays : shots[2 * i];
        mesh->segments[i] = mesh->exact[i] ? l->gather->rays : shots[2 * i + 1];
        if (!mesh->exact[i] && is_black(forest, mesh->leaves[i]))
            mesh->rays[i] = mesh->segments[i] = rays_of_black(
                l, mesh->leaves[i], reflectance / area, area / (double)mesh->count);
    }
    alloc_free(shots);
    alloc_free(worth);
}

bool gather_mesh_make(struct solver *solver, int64_t links, struct gather_mesh *mesh)
{
    struct model *model = &solver->model;
    struct looking l = {.solver = solver, .mesh = mesh, .links = links};
    l.gather = final_gather_create(model, model->criterion.final_gather, NULL);
    l.rays = l.gather->rays / ROWS_PER_LOOK;
    l.sums = alloc_array((size_t)lit_count(model), sizeof *l.sums);
    list_leaves(mesh, model->forest);
    l.open = gather_find_open_roots(solver, l.gather);
    if (l.rays >= FEWEST_LOOKED)
        split_bent(&l);
    know_nothing(&l);
    if (l.rays >= FEWEST_LOOKED)
        refine(&l);
    raise_cuts(mesh, model->forest);
    share_rays(&l);
    mesh->work = predict_work(&l, mesh->leaves, mesh, mesh->count);
    mesh->traced = l.gather->counts.rays + l.gather->counts.segments;
    int64_t stopped = stop_is_asked();
    comm_add(solver->comm, &stopped, 1);
    final_gather_destroy(l.gather);
    alloc_free(l.known);
    alloc_free(l.open);
    alloc_free(l.sums);
    return stopped == 0;
}

void gather_mesh_free(struct gather_mesh *mesh)
{
    alloc_free(mesh->leaves);
    alloc_free(mesh->rays);
    alloc_free(mesh->segments);
    alloc_free(mesh->exact);
    alloc_free(mesh->work);
    alloc_free(mesh->cut);
    *mesh = (struct gather_mesh){0};
}
