/* Links, the paper's interactions: pairs of patches that exchange light. (Of links with a
 * cluster in them, which have the same fields, see rad/beyond/node_link.h.)
 *
 * Where a link lives can change no result: it reads the radiosities of the last iteration,
 * which are the same on all ranks, and adds integers. */
#ifndef RAD_LINK_H
#define RAD_LINK_H

#include <stdbool.h>
#include <stdint.h>

#include "rad/compact.h"
#include "rad/formfactor.h"
#include "rad/model.h"

/* 24 bytes. `parts` say which parts of G go to (and come from) the children 0, 1 and 2 of p and
 * those of q, in 256ths; child 3 has the rest. So a link tells the four children of a patch apart
 * without being split itself.
 *
 *     area      p's children        q's children
 *     G  x  (k0 k1 k2 k3)/256  x  (k0 k1 k2 k3)/256      both sum to 1
 */
struct link {
    int32_t p, q;        /* local numbers of the two patches; below 0: a cluster */
    float area;          /* exchange area, square scene units: G, visibility included, or, if
                            nothing is seen (seen = 0), what it would be without blockers */
    int32_t blocker;     /* triangle that blocked last on the way here, -1: none; with a
                            cluster: see rad/beyond/node_link.c */
    uint8_t parts_p[3], parts_q[3];
    uint8_t seen;        /* share of the segments' weight that arrives, in 252nds; 0 only if none
                            does; or one of the two below */
    uint8_t cost;        /* predicted cost of splitting it, in box and triangle tests, >= 1; short
                            form of rad/compact.h */
};

/* It is proved that nothing can stand between p and q: and they are far enough apart for their
 * size to trust the form factor from points, or not. */
enum { LINK_ALL_SEEN = 252, LINK_OPEN_NEAR = 253, LINK_OPEN = 254 };

static inline bool link_is_open(const struct link *link)
{
    return link->seen >= LINK_OPEN_NEAR;
}

/* Something stands between p and q, but does not hide all. */
static inline bool link_is_partly_seen(const struct link *link)
{
    return link->seen > 0 && link->seen < LINK_ALL_SEEN;
}

/* Exchange area G. */
static inline double link_area(const struct link *link)
{
    return link->seen ? (double)link->area : 0.0;
}

/* What G would be without blockers, within 1/500 of G or so. */
static inline double link_unoccluded(const struct link *link)
{
    return link_is_partly_seen(link) ? (double)link->area * LINK_ALL_SEEN / link->seen
                                     : (double)link->area;
}

static inline double link_cost(const struct link *link)
{
    return expand8(link->cost);
}

/* The part of child k, 1. */
static inline double link_part(const uint8_t parts[3], int k)
{
    return k < 3 ? parts[k] * (1.0 / 256.0)
                 : (256 - parts[0] - parts[1] - parts[2]) * (1.0 / 256.0);
}

static inline bool parts_are_even(const uint8_t parts[3])
{
    return parts[0] == 64 && parts[1] == 64 && parts[2] == 64;
}

/* True if light to and from a patch is that of its children, by the parts, and not of the patch
 * itself. */
static inline bool link_is_divided(const struct forest *forest, int32_t patch, const uint8_t parts[3])
{
    return !patch_is_leaf(&forest->patches[patch]) && !parts_are_even(parts);
}

/* Parts in 256ths, rounded from the first to the last so that none is off by more than one. */
void link_set_parts(uint8_t parts[3], const double exact[4]);

/* A share of what arrives, 0..1, as the field `seen` has it. */
uint8_t link_seen(double share);

struct link_list {
    struct link *items; /* [count] */
    int64_t count, capacity;
    int64_t seen; /* as of the last link_list_sort(): only the first ones carry light */
};

/* Brings those of which something is seen to the front. */
void link_list_sort(struct link_list *list);

void link_list_append(struct link_list *list, struct link link);
void link_list_free(struct link_list *list);

/* Makes the link between two patches, given as facets too, with its form factor and its
 * cost. `inherited` is the cost of the link of patches that it comes from, 0: of none;
 * `*sight` is what is known of its visibility, and receives the last blocker. False if no
 * light can ever pass: both patches black and dark, or not facing each other. That no ray
 * arrived is no reason: such a link lives on with area 0. */
bool link_make(struct model *model, int32_t p, const struct facet *facet_p, int32_t q,
               const struct facet *facet_q, double inherited, struct sight *sight,
               struct link *link);

/* Splits `patch` (p or q of the link) unless it is split already and makes the links of its
 * children with the other side. Returns how many there are, 0..4; none, and nothing is split, if
 * no ray had arrived and the two patches are proved to be walled off. */
int link_split(struct model *model, const struct link *link, int32_t patch,
               struct link children[4]);

/* What a link takes from a patch: its B, or that of its children weighted by the parts, which
 * is summed in `*sum`. (A transfer with copies of colours took half as long again.) */
const struct rgb *link_take(const struct forest *forest, int32_t patch,
                            const uint8_t parts[3], struct rgb *sum);

/* Adds light, G B, to the flux of a patch, or of its children by the parts. */
void link_give(struct forest *forest, int32_t patch, const uint8_t parts[3], double area,
               const struct rgb *radiosity, struct flux_unit unit);

/* Transfers light over all links that are seen: adds G B of either side to the flux of the
 * other. B may have any sign. Pre: the list is sorted, and the largest |B| times the area of the
 * scene is below FLUX_LIMIT units; then no flux can overflow, since the links of a patch lead to
 * patches that do not overlap, and G is at most the area of each. */
void links_transfer(const struct link_list *list, struct forest *forest, struct flux_unit unit);

#endif
