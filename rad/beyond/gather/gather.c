/* The scene of a final gather: what is the same for all rows. */
#include "rad/beyond/gather/gather.h"

#include <math.h>

#include "geom/alloc.h"
#include "rad/beyond/range.h"

/* A leaf is too near if the square of the length of a ray to it is less than this times
 * the leaf's area. (pi .1 = 1/3: see path_ends().) */
static const double NEAR = 0.1;

/* A root has exact rows only if it faces at most this many roots for each ray, and light
 * crosses no panes. */
enum { FACED_PER_RAY = 4 };

/* Rays of a leaf halve at 2, 8, 32, ... times MANY leaves; fewest rays of a leaf. */
enum { MANY = 25000, FEWEST = 4 };

/* --- the whole --- */

double forest_mean_reflected(const struct forest *forest)
{
    double sum = 0.0;
    for (int32_t root = 0; root < forest->root_count; root++)
        sum += scene_root_area(forest->scene, root) *
               (rgb_sum(forest->radiosity[root]) -
                rgb_sum(forest_material(forest, root)->emission));
    return sum / scene_own_area(forest->scene);
}

/* Halves the rays for each fourfold of MANY leaves: a picture of the leaves is as smooth
 * as before, and the time grows only with the root of their number. */
static int rays_for(int rays, int64_t leaves)
{
    for (; leaves >= 2 * MANY && rays >= 2 * FEWEST; leaves /= 4)
        rays /= 2;
    return rays;
}

static bool is_cut(const struct final_gather *gather, int32_t patch)
{
    return gather->cut && gather->cut[patch];
}

/* Leaves too near, of none yet. */
static struct gather_nears *nears_create(const struct model *model,
                                         const struct lit *lit)
{
    double power = 0.0;
    for (int32_t s = 0; s < lit_count(model); s++)
        power += lit[s].area * lit[s].mean;
    size_t count = (size_t)model->forest->count;
    struct gather_nears *near = alloc_array(1, sizeof *near);
    near->unit_area = 0x1p-50 * model->area;
    near->unit_watts = 0x1p-52 * power;
    near->items = alloc_array(count, sizeof *near->items);
    return near;
}

static struct gather_sums *sums_create(const struct model *model, const struct lit *lit)
{
    const struct forest *forest = model->forest;
    struct gather_sums *sums = alloc_array(1, sizeof *sums);
    double *scale = alloc_array((size_t)forest->root_count, sizeof *scale);
    sums->latest = alloc_array((size_t)forest->count, sizeof *sums->latest);
    sums->ranges = alloc_array((size_t)forest->count, sizeof *sums->ranges);
    for (int c = 0; c < BANDS; c++) {
        for (int32_t root = 0; root < forest->root_count; root++)
            scale[root] = lit[node_space(model, root)].scale.band[c];
        forest_raise_ranges(forest, c, scale, sums->ranges);
    }
    alloc_free(scale);
    return sums;
}

struct final_gather *final_gather_create(struct model *model, int rays,
                                         const uint8_t *cut, struct lit *lit)
{
    const struct forest *forest = model->forest;
    struct final_gather *gather = alloc_array(1, sizeof *gather);
    gather->model = model;
    gather->cut = cut;
    gather->rays_asked = rays;
    gather->rays = rays_for(rays, forest_count(forest).leaves);
    gather->lit = lit;
    gather->aims = alloc_array(1, sizeof *gather->aims);
    gather->aims->panes = panes_create(model->scene);
    gather->view =
        view_create(model, gather->aims->panes ? -1 : FACED_PER_RAY * gather->rays);
    final_gather_renew(gather);
    return gather;
}

static void drop_rows(struct final_gather *gather)
{
    alloc_free(gather->rows);
    alloc_free(gather->terms);
    alloc_free(gather->near->items);
    gather->rows = NULL;
    gather->terms = NULL;
    gather->near->items = NULL;
    gather->count = gather->row_capacity = 0;
    gather->term_capacity = 0;
}

/* Drops rows and what is kept for each patch of the forest as it was. */
static void drop_patches(struct final_gather *gather)
{
    if (!gather->order)
        return;
    drop_rows(gather);
    alloc_free(gather->near->paths);
    alloc_free(gather->near->leaves);
    alloc_free(gather->near);
    alloc_free(gather->sums->items);
    alloc_free(gather->sums->latest);
    alloc_free(gather->sums->ranges);
    alloc_free(gather->sums);
    alloc_free(gather->order);
    alloc_free(gather->place);
}

void final_gather_drop_cuts(struct final_gather *gather)
{
    for (int kind = 0; kind < SENDER_KINDS; kind++) {
        cuts_destroy(gather->aims->cuts[kind]);
        gather->aims->cuts[kind] = NULL;
    }
    regions_destroy(gather->aims->regions);
    gather->aims->regions = NULL;
}

static void aims_destroy(struct gather_aims *aims)
{
    for (int kind = 0; kind < SENDER_KINDS; kind++)
        senders_destroy(aims->senders[kind]);
    panes_destroy(aims->panes);
    alloc_free(aims->offers);
    alloc_free(aims->shots);
    alloc_free(aims);
}

void final_gather_destroy(struct final_gather *gather)
{
    if (!gather)
        return;
    drop_patches(gather);
    final_gather_drop_cuts(gather);
    aims_destroy(gather->aims);
    view_destroy(gather->view);
    alloc_free(gather->lit);
    alloc_free(gather);
}

/* --- rows --- */

/* Makes the senders of a kind anew, and their cuts. */
static void renew_senders(struct final_gather *gather, enum sender_kind kind)
{
    struct gather_aims *aims = gather->aims;
    cuts_destroy(aims->cuts[kind]);
    senders_destroy(aims->senders[kind]);
    aims->senders[kind] = senders_create(gather->model, kind, gather->lit,
                                         aims->panes ? aims->panes->sent : NULL);
    aims->cuts[kind] = cuts_create(aims->senders[kind], aims->regions, gather->rays);
}

static void find_bright_parts(struct lit *lit, const struct senders *bright)
{
    const struct model *model = bright->model;
    for (int32_t s = 0; s < lit_count(model); s++)
        lit[s].bright_part = 0.0;
    for (int64_t i = 0; i < bright->sender_count; i++) {
        int32_t patch = bright->patches[i];
        lit[node_space(model, patch)].bright_part +=
            forest_area(model->forest, patch) * rgb_sum(sender_light(bright, patch));
    }
    for (int32_t s = 0; s < lit_count(model); s++)
        if (lit[s].reflected > 0.0)
            lit[s].bright_part /= lit[s].reflected * lit[s].area;
}

void final_gather_renew(struct final_gather *gather)
{
    const struct model *model = gather->model;
    const struct forest *forest = model->forest;
    struct gather_aims *aims = gather->aims;
    drop_patches(gather);
    gather->order = forest_order(forest);
    gather->place = alloc_array((size_t)forest->count, sizeof *gather->place);
    for (int64_t i = 0; i < forest->count; i++)
        gather->place[gather->order[i]] = (int32_t)i;
    gather->near = nears_create(model, gather->lit);
    gather->sums = sums_create(model, gather->lit);
    if (!aims->regions) {
        aims->regions = regions_create(model);
        renew_senders(gather, LAMPS); /* whose cuts keep what looks have told */
    }
    regions_follow(aims->regions, forest);
    lit_renew(gather->lit, model);
    renew_senders(gather, BRIGHT_PATCHES);
    find_bright_parts(gather->lit, aims->senders[BRIGHT_PATCHES]);
    if (aims->panes) {
        panes_look(aims->panes, model->octree, forest);
        renew_senders(gather, WINDOWS);
    }
    struct gather_leaf *leaves = alloc_array((size_t)forest->count, sizeof *leaves);
    gather->near->leaves = leaves;
    for (int32_t p = 0; p < forest->count; p++) {
        struct triangle t = forest_triangle(forest, p);
        double reach2 =
            is_cut(gather, p) ? HUGE_VAL : NEAR * forest_area(forest, p);
        leaves[p] = (struct gather_leaf){triangle_centroid(&t), reach2,
                                         slope_of(forest, gather->cut, p, NULL)};
    }
}

void final_gather_forget(struct final_gather *gather)
{
    final_gather_drop_cuts(gather);
    gather->cut = NULL;
    gather->rays =
        rays_for(gather->rays_asked, forest_count(gather->model->forest).leaves);
    final_gather_renew(gather);
    drop_rows(gather);
}

int64_t final_gather_work(const struct final_gather *gather)
{
    const struct octree_counts *proofs = &gather->view->counts;
    return model_work(gather->model) + proofs->node_tests + proofs->triangle_tests;
}

int64_t gather_units(double value, double unit)
{
    static const double MOST = 0x1p52;
    double units = unit > 0.0 ? real_max(-MOST, real_min(MOST, value / unit)) : 0.0;
    return (int64_t)(units < 0.0 ? units - 0.5 : units + 0.5);
}
