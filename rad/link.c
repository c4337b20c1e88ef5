/* Links: making, judging, splitting, transferring.
 *
 * The criterion is the paper's BF oracle (Sec. 2.2 and 3.3): a link whose exchanged energy is
 * above a threshold has its larger patch split. Two refinements of the wording:
 *
 *  - The energy is that of the unobstructed exchange, G_u B. With visibility in it, a link none
 *    of whose 16 rays arrives would have no energy and never be looked at again; what passes
 *    the blocker's edge would be lost whatever the threshold.
 *  - A direction counts only if its receiver reflects. Splitting patches under light that a
 *    black surface swallows changes no picture.
 *
 * If the larger patch may not be split any further the smaller one is, as long as it may. */
#include "rad/link.h"

#include "geom/alloc.h"

void link_list_append(struct link_list *list, struct link link)
{
    list->items = alloc_reserve(list->items, &list->capacity, list->count + 1,
                                sizeof *list->items);
    list->items[list->count++] = link;
}

void link_list_free(struct link_list *list)
{
    alloc_free(list->items);
    *list = (struct link_list){0};
}

/* The tests that its form factor took, plus a share of its parent's cost (Sec. 3.3.1). */
static uint32_t predict_cost(int64_t tests, double alpha, uint32_t inherited)
{
    double cost = (double)tests + alpha * (double)inherited;
    return cost < 1.0 ? 1 : cost < 4e9 ? (uint32_t)cost : UINT32_C(4000000000);
}

bool link_make(struct method *method, int32_t p, const struct facet *facet_p, int32_t q,
               const struct facet *facet_q, uint32_t inherited, int32_t *guess,
               struct link *link)
{
    if (!facets_face(facet_p, facet_q))
        return false;
    if (material_is_dark(forest_material(method->forest, p)) &&
        material_is_dark(forest_material(method->forest, q)))
        return false;
    struct octree_counts work = {0};
    struct exchange exchange = exchange_by_disks(facet_p, facet_q, method->octree, guess, &work);
    method->counts.rays += work.rays;
    method->counts.node_tests += work.node_tests;
    method->counts.triangle_tests += work.triangle_tests;
    int64_t tests = work.node_tests + work.triangle_tests;
    *link = (struct link){p, q, exchange.area, (float)exchange.unoccluded,
                          predict_cost(tests, method->criterion.alpha, inherited)};
    return true;
}

static bool patch_may_split(const struct method *method, int32_t patch)
{
    const struct forest *forest = method->forest;
    return id_level(forest->patches[patch].id) < method->criterion.max_level &&
           0.25 * forest_area(forest, patch) >= method->patch_threshold;
}

/* The larger patch; of equal ones that with the lower ID. */
static bool p_goes_first(const struct forest *forest, const struct link *link)
{
    double area_p = forest_area(forest, link->p), area_q = forest_area(forest, link->q);
    if (area_p != area_q)
        return area_p > area_q;
    return id_compare(forest->patches[link->p].id, forest->patches[link->q].id) < 0;
}

static double energy_sent(const struct forest *forest, int32_t from, int32_t to, double area)
{
    if (rgb_sum(forest_material(forest, to)->reflectance) == 0.0)
        return 0.0;
    return area * rgb_sum(forest->patches[from].radiosity);
}

int32_t link_patch_to_split(const struct method *method, const struct link *link)
{
    const struct forest *forest = method->forest;
    double area = (double)link->unoccluded;
    if (energy_sent(forest, link->p, link->q, area) <= method->link_threshold &&
        energy_sent(forest, link->q, link->p, area) <= method->link_threshold)
        return -1;
    bool p_first = p_goes_first(forest, link);
    int32_t first = p_first ? link->p : link->q, second = p_first ? link->q : link->p;
    return patch_may_split(method, first) ? first : patch_may_split(method, second) ? second : -1;
}

static bool link_is_walled_off(struct method *method, const struct link *link)
{
    struct facet p = facet_make(method->forest, link->p), q = facet_make(method->forest, link->q);
    return facets_are_walled_off(&p, &q, method->octree, &method->counts);
}

int link_split(struct method *method, const struct link *link, int32_t patch,
               struct link children[4])
{
    if (link->area == 0.0 && link_is_walled_off(method, link))
        return 0;
    forest_split(method->forest, patch);
    bool splits_p = patch == link->p;
    int32_t other = splits_p ? link->q : link->p;
    struct facet facet_other = facet_make(method->forest, other);
    int32_t guess = -1; /* what blocks one child is likely to block the next */
    int count = 0;
    for (int k = 0; k < 4; k++) {
        int32_t child = method->forest->patches[patch].children + k;
        struct facet facet = facet_make(method->forest, child);
        struct link *made = &children[count];
        count += splits_p ? link_make(method, child, &facet, other, &facet_other, link->cost,
                                      &guess, made)
                          : link_make(method, other, &facet_other, child, &facet, link->cost,
                                      &guess, made);
    }
    return count;
}

int64_t links_transfer(const struct link_list *list, struct forest *forest, struct flux_unit unit)
{
    int64_t moved = 0;
    for (int64_t i = 0; i < list->count; i++) {
        const struct link *link = &list->items[i];
        struct patch *p = &forest->patches[link->p], *q = &forest->patches[link->q];
        for (int c = 0; c < BANDS; c++) {
            int64_t to_p = flux_from_watts(unit, link->area * q->radiosity.band[c]);
            int64_t to_q = flux_from_watts(unit, link->area * p->radiosity.band[c]);
            p->flux[c] = flux_add(p->flux[c], to_p);
            q->flux[c] = flux_add(q->flux[c], to_q);
            moved = flux_add(moved, flux_add(to_p, to_q));
        }
    }
    return moved;
}

void links_transfer_ones(const struct link_list *list, struct forest *forest,
                         struct flux_unit unit)
{
    for (int64_t i = 0; i < list->count; i++) {
        const struct link *link = &list->items[i];
        int64_t flux = flux_from_watts(unit, link->area);
        int64_t *p = &forest->patches[link->p].flux[0], *q = &forest->patches[link->q].flux[0];
        *p = flux_add(*p, flux);
        *q = flux_add(*q, flux);
    }
}
