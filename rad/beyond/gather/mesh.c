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
 * chance counts as well: below a house the light of a lawn is another one. A leaf is
 * looked at only if a split is possible: if area * (rho H)^2 is above this limit, for the
 * leaf's own light by the links and the mean light of its space together. In a scene of
 * many small triangles few are looked at.
 *
 * Leaves with exact rows are not looked at. Links without blockers tell where B varies; B
 * is linear over a leaf, and a leaf over which B bends (slope.c) is split. Undivided
 * roots are looked at all the same. They have no parent, so B is constant over each.
 * Where a surface is made of many small roots, links tell too little to divide them.
 *
 * Looks also tell how noisy the light of a leaf is: rows get rays in proportion to the
 * square root of area times variance, which makes the noise, by area, least for a given
 * number of all rays (Neyman, 1934). A leaf under a lamp housing gets many, a leaf of a
 * plain wall few. So do segments to lamps, which are many in a half-shade where rays may
 * be few.
 *
 * Looks also measure the work of a ray. Further looks and rows are dealt by the work
 * predicted so. */
#include "rad/beyond/gather/mesh.h"

#include <math.h>

#include "geom/alloc.h"
#include "rad/beyond/gather/shots.h"
#include "rad/oracle.h"
#include "rad/pushpull.h"

static const double MESH = 0.005;

/* Where a thing stands on a leaf, its light has a variance of at least this part of its
 * square. A strip of sunlit floor may reach below the wall of a dark room: few rays miss
 * it, and the room would have the mean of both. */
static const double SPREAD_CUT = 0.0625;

/* A look takes this part of the rays of a row for each quarter of the leaf. If these are
 * fewer than FEWEST_LOOKED, there are no looks. */
enum { ROWS_PER_LOOK = 16, FEWEST_LOOKED = 4 };

/* The few rays of a look may miss what is bright, and find too little noise. So the mean
 * noise of all leaves, relative to their light, counts as this number of rays more. */
static const double UNSURE_RAYS = 32.0;

/* Marks in place of a variance: the row will be exact; too dark to be looked at. */
static const double IS_EXACT = -1.0, IS_UNSEEN = -2.0;

/* --- splitting --- */

static void list_leaves(struct gather_mesh *mesh, const struct forest *forest)
{
    alloc_free(mesh->leaves);
    mesh->leaves = alloc_array((size_t)forest->count, sizeof *mesh->leaves);
    mesh->count = 0;
    int32_t leaf = forest_next_leaf(forest, -1);
    for (; leaf >= 0; leaf = forest_next_leaf(forest, leaf))
        mesh->leaves[mesh->count++] = leaf;
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

static void keep_known(struct meshing *m, int32_t leaf, const struct gather_look *look)
{
    RESERVE(m->known, &m->known_capacity, m->model->forest->count);
    RESERVE(m->mesh->cut, &m->mesh->cut_capacity, m->model->forest->count);
    m->mesh->cut[leaf] = look->cut;
    m->known[leaf] =
        (struct known){look->variance + spread_of(look) - look->of_segment,
                       look->of_segment, look->fixed, look->work};
}

/* (rho H)^2 of a leaf, from links or looks. */
static struct rgb squares_of_light(const struct forest *forest, int32_t leaf)
{
    struct rgb light =
        rgb_sub(forest->radiosity[leaf], forest_material(forest, leaf)->emission);
    return rgb_times(light, light);
}

/* The same, over all bands. */
static double square_of_light(const struct forest *forest, int32_t leaf)
{
    return rgb_sum(squares_of_light(forest, leaf));
}

static bool may_split(struct meshing *m, int32_t leaf)
{
    if (!patch_may_split(m->model, leaf))
        return false;
    bool room = m->model->forest->count < m->patches_most;
    m->mesh->limited = m->mesh->limited || !room;
    return room;
}

static struct space_sums *sums_of(const struct meshing *m, int32_t leaf)
{
    return &m->sums[node_space(m->model, leaf)];
}

/* Splits a leaf into parts on which B is linear, so many levels deep. */
static void split_bent_leaf(struct meshing *m, int32_t leaf, int levels)
{
    struct forest *forest = m->model->forest;
    if (levels == 0 || !may_split(m, leaf))
        return;
    forest_split(forest, leaf);
    m->mesh->split++;
    int32_t first = forest->patches[leaf].children;
    for (int32_t child = first; child < first + 4; child++)
        forest->radiosity[child] = light_by_parent(forest, child);
    for (int32_t child = first; child < first + 4; child++)
        split_bent_leaf(m, child, levels - 1);
}

/* Splits leaves with exact rows where light bends. */
static void split_bent(struct meshing *m)
{
    struct gather_mesh *mesh = m->mesh;
    struct forest *forest = m->model->forest;
    const struct model *model = m->model;
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
        if (m->open[forest->patches[leaf].id.root])
            split_bent_leaf(
                m, leaf, slope_splits(model, leaf, &sums[node_space(model, leaf)]));
    }
    alloc_free(sums);
    list_leaves(mesh, forest);
}

/* Leaves of open roots will have exact rows: of divided ones, or of `all`. */
static void know_exact(struct meshing *m, bool all)
{
    const struct forest *forest = m->model->forest;
    for (int64_t i = 0; i < m->mesh->count; i++) {
        int32_t leaf = m->mesh->leaves[i];
        const struct patch *patch = &forest->patches[leaf];
        if (m->open[patch->id.root] && (all || patch->parent >= 0))
            m->known[leaf] = (struct known){IS_EXACT, 0.0, 0.0f, 1.0f};
    }
}

/* What is known of a leaf in need of rays before the look: a guess at the variance of rho
 * H by one ray, by the light of the leaf, from the links, and by light of the mean
 * radiosity, which may arrive, too. */
static struct known guess_of(const struct meshing *m, int32_t leaf)
{
    const struct forest *forest = m->model->forest;
    double rho = rgb_sum(forest_material(forest, leaf)->reflectance) / BANDS;
    const struct lit *lit = &m->gather->lit[node_space(m->model, leaf)];
    double mean = rho * lit->mean / BANDS; /* of a band */
    double guess = square_of_light(forest, leaf) + BANDS * mean * mean;
    return (struct known){guess, guess, 0.0f, 1.0f};
}

/* Gives leaves not looked at the mean noise, relative to their light, and the mean work
 * of the others in their space, or a guess if there are none. The noise of the others,
 * too, is made more like the mean. */
static void guess_unseen(struct meshing *m)
{
    const struct gather_mesh *mesh = m->mesh;
    const struct forest *forest = m->model->forest;
    double unsure = UNSURE_RAYS / (UNSURE_RAYS + 4.0 * m->rays);
    for (int32_t s = 0; s < lit_count(m->model); s++)
        m->sums[s] = (struct space_sums){.square = 0.0};
    for (int64_t i = 0; i < mesh->count; i++) {
        const struct known *known = &m->known[mesh->leaves[i]];
        struct space_sums *sums = sums_of(m, mesh->leaves[i]);
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
        struct known *known = &m->known[mesh->leaves[i]];
        const struct space_sums *sums = sums_of(m, mesh->leaves[i]);
        double all = square_of_light(forest, mesh->leaves[i]);
        double part = sums->square > 0.0 ? all / sums->square : 0.0;
        if (known->by_ray == IS_UNSEEN && sums->seen == 0)
            *known = guess_of(m, mesh->leaves[i]);
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

/* Shares rays and segments in proportion to the square root of area times variance. Exact
 * rows, which make no use of theirs, have the mean number. A black leaf has the mean
 * number times two ratios, and at most the mean: its area over that of a mean leaf, and
 * the mean reflectance of all leaves, which is small below a sky. */
static void share_rays(struct meshing *m)
{
    struct gather_mesh *mesh = m->mesh;
    const struct forest *forest = m->model->forest;
    double *worth = alloc_array(2 * (size_t)mesh->count, sizeof *worth);
    int32_t *space = alloc_array(2 * (size_t)mesh->count, sizeof *space);
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
        const struct known *known = &m->known[leaf];
        bool black = is_black(forest, leaf);
        double variance = k % 2 ? known->by_segment : known->by_ray;
        space[k] = node_space(m->model, leaf);
        worth[k] = black || known->by_ray == IS_EXACT
                       ? -1.0
                       : sqrt(forest_area(forest, leaf) * variance);
    }
    shots_share(worth, space, 2 * mesh->count, lit_count(m->model), m->gather->rays,
                shots);
    mesh->rays = alloc_array((size_t)mesh->count, sizeof *mesh->rays);
    mesh->segments = alloc_array((size_t)mesh->count, sizeof *mesh->segments);
    mesh->exact = alloc_array((size_t)mesh->count, sizeof *mesh->exact);
    for (int64_t i = 0; i < mesh->count; i++) {
        mesh->exact[i] = m->known[mesh->leaves[i]].by_ray == IS_EXACT;
        mesh->rays[i] = mesh->exact[i] ? m->gather->rays : shots[2 * i];
        mesh->segments[i] = mesh->exact[i] ? m->gather->rays : shots[2 * i + 1];
        if (!mesh->exact[i] && is_black(forest, mesh->leaves[i]))
            mesh->rays[i] = mesh->segments[i] =
                shots_of_black(m->gather->rays, reflectance / area *
                                                    forest_area(forest, mesh->leaves[i]) /
                                                    (area / (double)mesh->count));
    }
    alloc_free(shots);
    alloc_free(space);
    alloc_free(worth);
}

/* --- public --- */

bool meshing_looks(const struct meshing *m)
{
    return m->rays >= FEWEST_LOOKED;
}

void meshing_begin(struct meshing *m)
{
    m->rays = m->gather->rays / ROWS_PER_LOOK;
    m->sums = alloc_array((size_t)lit_count(m->model), sizeof *m->sums);
    list_leaves(m->mesh, m->model->forest);
    if (meshing_looks(m))
        split_bent(m);
    RESERVE(m->known, &m->known_capacity, m->model->forest->count);
    for (int64_t i = 0; i < m->mesh->count; i++)
        m->known[m->mesh->leaves[i]] = guess_of(m, m->mesh->leaves[i]);
    know_exact(m, !meshing_looks(m));
}

int32_t *meshing_choose(struct meshing *m, int64_t *count)
{
    const struct gather_mesh *mesh = m->mesh;
    const struct model *model = m->model;
    for (int32_t s = 0; s < lit_count(model); s++)
        m->sums[s].threshold = -1.0;
    for (int64_t i = 0; i < mesh->count; i++)
        sums_of(m, mesh->leaves[i])->square +=
            forest_area(model->forest, mesh->leaves[i]) *
            square_of_light(model->forest, mesh->leaves[i]);
    int32_t *leaves = alloc_array((size_t)mesh->count, sizeof *leaves);
    *count = 0;
    for (int64_t i = 0; i < mesh->count; i++) {
        struct known *known = &m->known[mesh->leaves[i]];
        double area = forest_area(model->forest, mesh->leaves[i]);
        double light = area * square_of_light(model->forest, mesh->leaves[i]);
        int32_t space = node_space(model, mesh->leaves[i]);
        double sum = m->sums[space].square, mean = sum / m->gather->lit[space].area;
        if (known->by_ray > 0.0 &&
            light + area * mean >= MESH * model->criterion.epsilon * sum) {
            leaves[(*count)++] = mesh->leaves[i];
            continue;
        }
        if (known->by_ray != IS_EXACT)
            known->by_ray = IS_UNSEEN;
        m->sums[space].unseen += light;
    }
    return leaves;
}

int64_t *meshing_work(const struct meshing *m, const int32_t *leaves, int64_t count,
                      const struct gather_mesh *mesh)
{
    int64_t *work = alloc_array((size_t)count, sizeof *work);
    for (int64_t i = 0; i < count; i++) {
        const struct known *known = &m->known[leaves[i]];
        double rays = mesh ? 0.5 * (mesh->rays[i] + mesh->segments[i]) : m->rays;
        work[i] = 1 + (int64_t)((double)known->fixed + rays * (double)known->work);
    }
    return work;
}

int64_t meshing_split(struct meshing *m, const struct gather_look *looks,
                      int32_t **leaves, int64_t count)
{
    struct forest *forest = m->model->forest;
    int32_t spaces = lit_count(m->model);
    for (int32_t s = 0; s < spaces; s++)
        m->sums[s].square = m->sums[s].unseen;
    for (int64_t i = 0; i < count; i++)
        sums_of(m, (*leaves)[i])->square +=
            forest_area(forest, (*leaves)[i]) * square_of(&looks[i]);
    for (int32_t s = 0; s < spaces; s++)
        if (m->sums[s].threshold < 0.0)
            m->sums[s].threshold = MESH * m->model->criterion.epsilon * m->sums[s].square;
    int32_t *next = alloc_array(4 * (size_t)count, sizeof *next);
    int64_t made = 0;
    for (int64_t i = 0; i < count; i++) {
        int32_t leaf = (*leaves)[i];
        double spread = spread_of(&looks[i]);
        if (looks[i].cut)
            spread =
                fmax(variance_of(&looks[i]), SPREAD_CUT * square_of_light(forest, leaf));
        keep_known(m, leaf, &looks[i]);
        if (forest_area(forest, leaf) * spread <= sums_of(m, leaf)->threshold ||
            !may_split(m, leaf))
            continue;
        split_leaf(forest, leaf, &looks[i]);
        m->mesh->split++;
        for (int k = 0; k < 4; k++) {
            next[made++] = forest->patches[leaf].children + k;
            keep_known(m, forest->patches[leaf].children + k, &looks[i]);
        }
    }
    alloc_free(*leaves);
    *leaves = next;
    return made;
}

void meshing_end(struct meshing *m)
{
    struct gather_mesh *mesh = m->mesh;
    if (meshing_looks(m)) {
        forest_average(m->model->forest);
        list_leaves(mesh, m->model->forest);
        know_exact(m, true);
        guess_unseen(m);
    }
    raise_cuts(mesh, m->model->forest);
    share_rays(m);
    mesh->work = meshing_work(m, mesh->leaves, mesh->count, mesh);
    mesh->traced = m->gather->counts.rays + m->gather->counts.segments;
    m->gather->counts = (struct gather_counts){0};
    alloc_free(m->known);
    alloc_free(m->sums);
}

void gather_mesh_free(struct gather_mesh *mesh)
{
    alloc_free(mesh->leaves);
    alloc_free(mesh->rays);
    alloc_free(mesh->segments);
    alloc_free(mesh->exact);
    alloc_free(mesh->work);
    alloc_free(mesh->cut);
    final_gather_destroy(mesh->gather);
    *mesh = (struct gather_mesh){0};
}
