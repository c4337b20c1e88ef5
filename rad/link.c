/* Links: making, splitting, transferring.
 *
 * A child inherits what is known of its parent's visibility: that it is open, if that is proved,
 * and the last blocker, which is tested first. (A quarter of its segments, those that begin or end
 * at its centroid, were already fired for its parent; their answers would take two bytes a link,
 * and a bundle of 12 goes down the octree as one of 16 does.)
 *
 * Light that a link brings to a patch with children is dealt to them by the link's parts, and what
 * they send is weighted by them: that costs no ray, since the parts come from the very segments
 * that gave G. Where the parts are even it is the same as light to the patch itself. */
#include "rad/link.h"

#include <math.h>

#include "geom/alloc.h"
#include "rad/oracle.h"

void link_list_append(struct link_list *list, struct link link)
{
    list->items = alloc_reserve(list->items, &list->capacity, list->count + 1,
                                sizeof *list->items);
    list->items[list->count++] = link;
}

void link_list_sort(struct link_list *list)
{
    int64_t first = 0, end = list->count;
    while (first < end) {
        struct link link = list->items[first];
        if (link.seen > 0) {
            first++;
        } else {
            list->items[first] = list->items[--end];
            list->items[end] = link;
        }
    }
    list->seen = first;
}

void link_list_free(struct link_list *list)
{
    alloc_free(list->items);
    *list = (struct link_list){0};
}

/* The tests that its form factor took, plus a share of its parent's cost (Sec. 3.3.1). */
static double predict_cost(double tests, double alpha, double inherited)
{
    return fmax(1.0, tests + alpha * inherited);
}

uint8_t link_seen(double share)
{
    if (!(share > 0.0))
        return 0;
    return (uint8_t)fmin(LINK_ALL_SEEN, fmax(1.0, rint(LINK_ALL_SEEN * share)));
}

/* The field `seen` of a link. */
static uint8_t compact_share(const struct exchange *exchange, bool open)
{
    if (exchange->seen > 0.0 && open)
        return exchange->apart ? LINK_OPEN : LINK_OPEN_NEAR;
    return link_seen(exchange->seen);
}

void link_set_parts(uint8_t parts[3], const double exact[4])
{
    double sum = 0.0;
    int before = 0;
    for (int k = 0; k < 3; k++) {
        sum += exact[k];
        int now = (int)fmin(256.0, rint(256.0 * sum));
        parts[k] = (uint8_t)(now - before < 255 ? now - before : 255);
        before += parts[k];
    }
}

/* With even parts. */
static struct link link_of(int32_t p, int32_t q, const struct exchange *exchange,
                           const struct sight *sight, double cost)
{
    return (struct link){
        .p = p,
        .q = q,
        .area = float_below(exchange->seen > 0.0 ? exchange->area : exchange->unoccluded),
        .blocker = sight->blocker,
        .parts_p = {64, 64, 64},
        .parts_q = {64, 64, 64},
        .seen = compact_share(exchange, sight->open),
        .cost = compact8(cost),
    };
}

bool link_make(struct model *model, int32_t p, const struct facet *facet_p, int32_t q,
               const struct facet *facet_q, double inherited, struct sight *sight,
               struct link *link)
{
    if (!facets_face(facet_p, facet_q))
        return false;
    if (material_is_dark(forest_material(model->forest, p)) &&
        material_is_dark(forest_material(model->forest, q)))
        return false;
    struct octree_counts work = {0};
    enum look look = oracle_look(model, p, q, exchange_guess(facet_p, facet_q));
    struct exchange exchange = exchange_estimate(facet_p, facet_q, model->criterion.form_factor,
                                                 look, model->octree, sight, &work);
    octree_counts_add(&model->counts, &work);
    model->rays_spared += BUNDLE_RAYS - work.rays;
    model->estimating += TESTS_PER_FORM_FACTOR;
    double cost = predict_cost((double)(work.node_tests + work.triangle_tests),
                               model->criterion.alpha, inherited);
    *link = link_of(p, q, &exchange, sight, cost);
    if (model->criterion.oracle != ORACLE_BF) {
        link_set_parts(link->parts_p, exchange.parts_p);
        link_set_parts(link->parts_q, exchange.parts_q);
    }
    return true;
}

int link_split(struct model *model, const struct link *link, int32_t patch,
               struct link children[4])
{
    bool of_p = patch == link->p, open = link_is_open(link);
    int32_t other = of_p ? link->q : link->p, blocker = link->blocker;
    struct facet facet_own = facet_make(model->forest, patch);
    struct facet facet_other = facet_make(model->forest, other);
    if (link->seen == 0 &&
        facets_are_walled_off(&facet_own, &facet_other, model->octree, &model->counts)) {
        model->walled_off++;
        return 0;
    }
    if (link->seen == LINK_ALL_SEEN && model->criterion.oracle == ORACLE_ERROR)
        open = facets_are_open(&facet_own, &facet_other, model->octree, &model->counts);
    forest_split(model->forest, patch);
    double cost = link_cost(link);
    int count = 0;
    for (int k = 0; k < 4; k++) {
        int32_t child = model->forest->patches[patch].children + k;
        struct facet facet = facet_make(model->forest, child);
        struct sight sight = {.open = open, .blocker = blocker};
        struct link *made = &children[count];
        count += of_p ? link_make(model, child, &facet, other, &facet_other, cost, &sight, made)
                      : link_make(model, other, &facet_other, child, &facet, cost, &sight, made);
        blocker = sight.blocker; /* what blocks one child is likely to block the next */
    }
    return count;
}

const struct rgb *link_take(const struct forest *forest, int32_t patch,
                            const uint8_t parts[3], struct rgb *sum)
{
    const struct patch *at = &forest->patches[patch];
    if (!link_is_divided(forest, patch, parts))
        return &at->radiosity;
    const struct patch *child = &forest->patches[at->children];
    *sum = (struct rgb){{0.0, 0.0, 0.0}};
    for (int k = 0; k < 4; k++) {
        double part = link_part(parts, k);
        for (int c = 0; c < BANDS; c++)
            sum->band[c] += part * child[k].radiosity.band[c];
    }
    return sum;
}

void link_give(struct forest *forest, int32_t patch, const uint8_t parts[3], double area,
               const struct rgb *radiosity, struct flux_unit unit)
{
    struct patch *at = &forest->patches[patch];
    if (!link_is_divided(forest, patch, parts)) {
        for (int c = 0; c < BANDS; c++)
            at->flux[c] += flux_from_watts(unit, area * radiosity->band[c]);
        return;
    }
    struct patch *child = &forest->patches[at->children];
    for (int k = 0; k < 4; k++) {
        double part = link_part(parts, k);
        for (int c = 0; c < BANDS; c++)
            child[k].flux[c] += flux_from_watts(unit, part * (area * radiosity->band[c]));
    }
}

void links_transfer(const struct link_list *list, struct forest *forest, struct flux_unit unit)
{
    for (int64_t i = 0; i < list->seen; i++) {
        const struct link *link = &list->items[i];
        struct rgb sum_p, sum_q;
        const struct rgb *from_p = link_take(forest, link->p, link->parts_p, &sum_p);
        const struct rgb *from_q = link_take(forest, link->q, link->parts_q, &sum_q);
        link_give(forest, link->p, link->parts_p, (double)link->area, from_q, unit);
        link_give(forest, link->q, link->parts_q, (double)link->area, from_p, unit);
    }
}
