/* Links of two patches, phr's.
 *
 * A child inherits its parent's visibility: the proof of an open way, if there is one,
 * and the last blocker, which is tested first. (A quarter of its segments, those with an
 * end at its centroid, were already fired for its parent; their answers would take two
 * bytes a link, and a bundle of 12 goes down the octree as one of 16 does.) */
#include "rad/beyond/patch_link.h"

#include <math.h>

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

bool patch_link_make(struct model *model, int32_t p, const struct facet *facet_p,
                     int32_t q, const struct facet *facet_q, const struct link *parent,
                     struct link *link)
{
    if (!facets_face(facet_p, facet_q))
        return false;
    if (material_is_dark(forest_material(model->forest, p)) &&
        material_is_dark(forest_material(model->forest, q)))
        return false;
    struct octree_counts work = {0};
    struct visibility visibility = {.open = parent && link_is_open(parent),
                          .blocker = parent ? parent->blocker : -1};
    struct exchange exchange =
        exchange_estimate(facet_p, facet_q, model->octree, &visibility, &work);
    octree_counts_add(&model->counts, &work);
    model->rays_spared += BUNDLE_RAYS - work.rays;
    model->estimating += (exchange.apart ? 1 : 3) * TESTS_PER_EXCHANGE;
    *link = (struct link){
        .p = p, .q = q,
        .area = float_below(exchange.seen > 0.0 ? exchange.area : exchange.unoccluded),
        .blocker = visibility.blocker,
        .seen = compact_share(&exchange, visibility.open),
        .cost = compact8(link_predict_cost(model, &work, parent)),
    };
    link_set_parts(link->parts_p, exchange.parts_p);
    link_set_parts(link->parts_q, exchange.parts_q);
    return true;
}

int patch_link_split(struct model *model, const struct link *link, int32_t patch,
                     struct link *children)
{
    struct facet facet_p = facet_make(model->forest, link->p);
    struct facet facet_q = facet_make(model->forest, link->q);
    struct link parent = *link;
    if (link->seen == 0 &&
        facets_are_walled_off(&facet_p, &facet_q, model->octree, &model->counts)) {
        model->walled_off++;
        return 0;
    }
    if (link->seen == LINK_ALL_SEEN &&
        facets_are_open(&facet_p, &facet_q, model->octree, &model->counts))
        parent.seen = LINK_OPEN;
    return link_split(model, &parent, patch, children);
}
