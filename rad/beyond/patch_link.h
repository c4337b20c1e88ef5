/* Links of two patches, telling children apart and keeping proofs of visibility.
 *
 * `parts` say which parts of G go to (and come from) the children 0, 1 and 2 of p and
 * those of q, in 256ths; child 3 has the rest. So a link tells the four children of a
 * patch apart without being split itself.
 *
 *     area      p's children        q's children
 *     G  x  (k0 k1 k2 k3)/256  x  (k0 k1 k2 k3)/256      both sum to 1 */
#ifndef RAD_BEYOND_PATCH_LINK_H
#define RAD_BEYOND_PATCH_LINK_H

#include "rad/beyond/patch_exchange.h"
#include "rad/link.h"

static inline bool link_has_cluster(const struct link *link)
{
    return node_is_cluster(link->p) || node_is_cluster(link->q);
}

/* G without blockers, within 1/500 of G or so. */
static inline double link_unoccluded(const struct link *link)
{
    bool partly = link->seen > 0 && link->seen < LINK_ALL_SEEN;
    return partly ? (double)link->area * LINK_ALL_SEEN / link->seen : (double)link->area;
}

/* The part of child k, 1. */
static inline double link_part(const uint8_t parts[3], int k)
{
    return k < 3 ? parts[k] * (1.0 / 256.0)
                 : (256 - parts[0] - parts[1] - parts[2]) * (1.0 / 256.0);
}

/* Parts in 256ths, rounded from the first to the last, none off by more than one. */
void link_set_parts(uint8_t parts[3], const double exact[4]);

/* The share of arriving light, 0..1, in the form of the field `seen`. */
uint8_t link_seen(double share);

/* Entries of struct method: make_link, with form factors from points, and split_link,
 * which ends links of two patches proved to be walled off. */
bool patch_link_make(struct model *model, int32_t p, const struct facet *facet_p,
                     int32_t q, const struct facet *facet_q, const struct link *parent,
                     struct link *link);
int patch_link_split(struct model *model, const struct link *link, int32_t patch,
                     struct link *children);

#endif
