/* Rows of leaves, by exact factors or by segments and rays, and the light at points. */
#include "rad/beyond/gather/row.h"

#include "geom/alloc.h"
#include "rad/beyond/gather/aim.h"
#include "rad/beyond/gather/covers.h"
#include "rad/beyond/gather/exact.h"
#include "rad/beyond/gather/met.h"
#include "rad/beyond/gather/rays.h"
#include "rad/beyond/sequence.h"

/* Makes the sums the terms of the row. */
static void keep_terms(struct receiver *r)
{
    struct final_gather *g = r->gather;
    int64_t first = final_gather_terms(g);
    int32_t space = node_space(g->model, r->row->leaf);
    bool several = lit_count(g->model) > 1;
    r->row->end = first + g->sums->count;
    RESERVE(g->terms, &g->term_capacity, r->row->end);
    for (int64_t i = 0; i < g->sums->count; i++) {
        const struct gather_sum *sum = &g->sums->items[i];
        struct gather_term term = {.place = sum->place, .near = sum->near};
        for (int c = 0; c < BANDS; c++)
            term.weight[c] = (float)sum->weight[c];
        g->terms[first + i] = term;
        g->counts.crossed +=
            several && node_space(g->model, g->order[term.place]) != space;
    }
}

/* The irradiance straight from lamps, by an exact row. */
static struct rgb light_of_lamps(const struct receiver *r)
{
    const struct final_gather *g = r->gather;
    const struct forest *forest = g->model->forest;
    struct rgb light = {{0.0, 0.0, 0.0}};
    for (int64_t i = 0; i < g->sums->count; i++) {
        int32_t patch = g->order[g->sums->items[i].place];
        const struct material *m = forest_material(forest, patch);
        if (!root_is_lamp(g, (int32_t)forest->patches[patch].id.root))
            continue;
        for (int c = 0; c < BANDS; c++)
            light.band[c] += g->sums->items[i].weight[c] * m->emission.band[c];
    }
    return light;
}

void final_gather_add_row(struct final_gather *gather, int32_t leaf, int rays,
                          int segments, bool exact)
{
    struct gather_row row = {.leaf = leaf};
    struct ray_sums sums = {.each = NULL};
    struct receiver r = receiver_of_leaf(gather, RECEIVER_ROW, rays, &row, &sums);
    r.segments = segments < SEQUENCE_POINTS ? segments : SEQUENCE_POINTS;
    gather->sums->count = gather->sums->first = 0;
    if (exact && receiver_add_exact(&r)) {
        row.straight = light_of_lamps(&r);
    } else {
        r.light = (struct rgb){{0.0, 0.0, 0.0}};
        gather->sums->count = gather->sums->first = 0; /* of this row alone */
        receiver_aim(&r);
        receiver_fire(&r);
    }
    keep_terms(&r);
    receiver_find_covers(&r);
    RESERVE(gather->rows, &gather->row_capacity, gather->count + 1);
    gather->rows[gather->count++] = row;
}

struct gather_light final_gather_at(struct final_gather *gather,
                                    const struct gather_points *points, uint64_t seed,
                                    int count, bool all)
{
    struct point point = {.root = points->root, .at = points->middle};
    find_leaf(gather->model->forest, &point);
    struct gather_row row = {.leaf = point.patch};
    struct ray_sums sums = {.each = NULL};
    struct receiver r = receiver_of_points(gather, points, seed, count, &row, &sums);
    r.lamps_alone = !all;
    receiver_aim(&r);
    if (all)
        receiver_fire(&r);
    return (struct gather_light){.straight = row.straight, .rest = sums.h,
                                 .variance = row.chance, .halves = row.halves};
}
