/* Links, the paper's interactions: pairs of patches exchanging light. (Of links with a
 * cluster, which have the same fields, see rad/beyond/node_link.h.)
 *
 * Where a link lives can change no result: it reads the radiosities of the last
 * iteration, which are the same on all ranks, and adds integers. */
#ifndef RAD_LINK_H
#define RAD_LINK_H

#include <stdbool.h>
#include <stdint.h>

#include "rad/compact.h"
#include "rad/formfactor.h"
#include "rad/model.h"

/* 24 bytes. The paper's method has no use for parts, which are even, nor for `seen`. */
struct link {
    int32_t p, q;        /* local numbers of the two patches; below 0: a cluster */
    float area;          /* exchange area, square scene units: G, visibility included, or,
                            if nothing is seen (seen = 0), G without blockers */
    int32_t blocker;     /* triangle that blocked last on the way here, -1: none; with a
                            cluster: see rad/beyond/node_link.c */
    uint8_t parts_p[3], parts_q[3]; /* see rad/beyond/patch_link.h */
    uint8_t seen;        /* arriving share of the segments' weight, in 252nds; 0 only if
                            none arrives; or LINK_OPEN, LINK_OPEN_NEAR: proved */
    uint8_t cost;        /* box and triangle tests of its form factor, and alpha of its
                            parent's, >= 1; short form of rad/compact.h */
};

/* Values of `seen`: all segments arrive; they are proved to, p and q being too near for
 * their size to trust the form factor from points; the same, far enough apart. */
enum { LINK_ALL_SEEN = 252, LINK_OPEN_NEAR = 253, LINK_OPEN = 254 };

static inline bool link_is_open(const struct link *link)
{
    return link->seen >= LINK_OPEN_NEAR;
}

/* Exchange area G. */
static inline double link_area(const struct link *link)
{
    return link->seen ? (double)link->area : 0.0;
}

/* Predicted cost of splitting a link, in tests, form factors included. */
static inline double link_cost(const struct link *link)
{
    return expand8(link->cost) + 2 * TESTS_PER_FORM_FACTOR;
}

struct link_list {
    struct link *items; /* [count] */
    int64_t count, capacity;
    int64_t seen; /* links at the front that carry light, by the last link_list_sort() */
};

/* Moves the links that carry light to the front, and counts these. */
void link_list_sort(struct link_list *list);

void link_list_append(struct link_list *list, struct link link);
void link_list_free(struct link_list *list);

/* The link kernel of the paper: see struct method, in rad/method.h. */
bool link_make(struct model *model, int32_t p, const struct facet *facet_p, int32_t q,
               const struct facet *facet_q, const struct link *parent, struct link *link);

/* Returns the field `cost` of a link (Sec. 3.3.1). `parent`: the split link, or NULL. */
double link_predict_cost(const struct model *model, const struct octree_counts *work,
                         const struct link *parent);

/* Splits `patch` (p or q of the link) unless split already and makes the links of its
 * children with the other side, by the kernel of the method. Returns their number,
 * 0..4. */
int link_split(struct model *model, const struct link *link, int32_t patch,
               struct link *children);

/* Adds G x of either side of each link to the flux of the other, x a vector over patches,
 * W/m^2, of any sign. Pre: the largest |x| times the area of the scene is below
 * FLUX_LIMIT units; then no flux can overflow, since the links of a patch lead to patches
 * without overlap, and G is at most the area of each. */
void links_transfer(const struct link_list *list, const struct model *model,
                    const struct rgb *vector, struct flux_unit unit);

#endif
