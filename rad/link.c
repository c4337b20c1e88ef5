/* Links: making, splitting, transferring.
 *
 * A form factor takes as long as 11 to 14 tests of 26 to 34 ns (build/mpi/prices, three
 * rooms) and counts as 12: with these, tests predict the seconds of a level within 10 %,
 * RMS; alone, within 30 %. A link inherits half of its parent's cost, a quarter of its
 * grandparent's, and so on: of two form factors in all, which link_cost() adds.
 *
 * A form factor tests the last blocker first: of the parent, or of the sister linked
 * before. A pair of which no ray arrives gets no link: without energy it would never be
 * split, nor carry light. */
#include "rad/link.h"

#include "geom/alloc.h"

void link_list_append(struct link_list *list, struct link link)
{
    RESERVE(list->items, &list->capacity, list->count + 1);
    list->items[list->count++] = link;
}

void link_list_sort(struct link_list *list)
{
    list->seen = 0;
    for (int64_t i = 0; i < list->count; i++) {
        struct link link = list->items[i];
        if (link.seen == 0)
            continue;
        list->items[i] = list->items[list->seen];
        list->items[list->seen++] = link;
    }
}

void link_list_free(struct link_list *list)
{
    alloc_free(list->items);
    *list = (struct link_list){0};
}

double link_predict_cost(const struct model *model, const struct octree_counts *work,
                         const struct link *parent)
{
    double inherited = parent ? model->criterion.alpha * expand8(parent->cost) : 0.0;
    return real_max(1.0, inherited + (double)(work->node_tests + work->triangle_tests));
}

bool link_make(struct model *model, int32_t p, const struct facet *facet_p, int32_t q,
               const struct facet *facet_q, const struct link *parent, struct link *link)
{
    struct octree_counts work = {0};
    int32_t blocker = parent ? parent->blocker : -1;
    double seen, area = exchange_area(facet_p, facet_q, model->octree, &blocker, &seen,
                                      &work);
    octree_counts_add(&model->counts, &work);
    model->estimating += TESTS_PER_FORM_FACTOR;
    *link = (struct link){
        .p = p, .q = q,
        .area = float_below(area),
        .blocker = blocker,
        .parts_p = {64, 64, 64}, .parts_q = {64, 64, 64},
        .seen = (uint8_t)(LINK_ALL_SEEN * seen),
        .cost = compact8(link_predict_cost(model, &work, parent)),
    };
    return link->area > 0.0f;
}

int link_split(struct model *model, const struct link *link, int32_t patch,
               struct link *children)
{
    forest_split(model->forest, patch);
    bool of_p = patch == link->p;
    int32_t other = of_p ? link->q : link->p;
    struct facet facet_other = facet_make(model->forest, other);
    struct link parent = *link;
    int count = 0;
    for (int k = 0; k < 4; k++) {
        int32_t child = model->forest->patches[patch].children + k;
        struct facet facet = facet_make(model->forest, child);
        struct link *made = &children[count];
        if (of_p ? !model->method.make_link(model, child, &facet, other, &facet_other,
                                            &parent, made)
                 : !model->method.make_link(model, other, &facet_other, child, &facet,
                                            &parent, made))
            continue;
        parent.blocker = made->blocker; /* likely to block the next child, too */
        count++;
    }
    return count;
}

/* Adds G B to the flux of a patch. */
static void receive(struct patch *patch, double area, const struct rgb *radiosity,
                    struct flux_unit unit)
{
    for (int c = 0; c < BANDS; c++)
        patch->flux[c] += flux_from_watts(unit, area * radiosity->band[c]);
}

void links_transfer(const struct link_list *list, const struct model *model,
                    const struct rgb *vector, struct flux_unit unit)
{
    for (int64_t i = 0; i < list->count; i++) {
        const struct link *link = &list->items[i];
        struct patch *patches = model->forest->patches;
        receive(&patches[link->p], (double)link->area, &vector[link->q], unit);
        receive(&patches[link->q], (double)link->area, &vector[link->p], unit);
    }
}
