/* Links, the paper's interactions: pairs of patches that exchange light.
 *
 * Where a link lives can change no result: it reads the radiosities of the last iteration,
 * which are the same on all ranks, and adds integers. */
#ifndef RAD_LINK_H
#define RAD_LINK_H

#include <stdbool.h>
#include <stdint.h>

#include "rad/formfactor.h"
#include "rad/method.h"

struct link {
    int32_t p, q;     /* local numbers of the two patches */
    double area;      /* exchange area G, visibility included, square scene units */
    float unoccluded; /* what G would be without blockers; G's doubt is the difference */
    uint32_t cost;    /* predicted cost of splitting it, in box and triangle tests, >= 1 */
};

struct link_list {
    struct link *items; /* [count] */
    int64_t count, capacity;
};

void link_list_append(struct link_list *list, struct link link);
void link_list_free(struct link_list *list);

/* Makes the link between two patches, given as facets too, with its form factor and its cost.
 * `inherited` is the cost of the link that it comes from, 0 for an initial link; `*guess` is as
 * in octree_block().
 * False if no light can ever pass: both patches black and dark, or not facing each other. That no
 * ray arrived is no reason: such a link lives on with area 0. */
bool link_make(struct method *method, int32_t p, const struct facet *facet_p, int32_t q,
               const struct facet *facet_q, uint32_t inherited, int32_t *guess,
               struct link *link);

/* The patch of the link that the criterion wants to split, or -1 if the link is fine or neither
 * patch may be split. Reads the radiosities of the last iteration. */
int32_t link_patch_to_split(const struct method *method, const struct link *link);

/* Splits `patch` (p or q of the link) unless it is split already and makes the links of its
 * children with the other side. Returns how many there are, 0..4; none, and nothing is split, if
 * no ray had arrived and the two patches are proved to be walled off. */
int link_split(struct method *method, const struct link *link, int32_t patch,
               struct link children[4]);

/* Transfers light over all links: adds G B of either side to the flux of the other. Returns the
 * flux moved. */
int64_t links_transfer(const struct link_list *list, struct forest *forest, struct flux_unit unit);

/* The same with B = 1 everywhere, in band 0 only: what arrives per area is the row sum of the
 * form factors. */
void links_transfer_ones(const struct link_list *list, struct forest *forest,
                         struct flux_unit unit);

#endif
