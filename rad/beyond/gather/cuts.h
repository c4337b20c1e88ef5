/* Cuts: the senders as seen from a region of leaves.
 *
 * A region is the largest node with at most REGION_LEAVES leaves: a part of a wall, or a
 * cluster of small things. Its cut is a list of nodes of the tree of senders, with every
 * sender below exactly one of these, but for senders facing away. A few segments, once
 * for the region, tell how much of each node is seen from there; the leaves of the region
 * and the pixels on them share the answers. */
#ifndef RAD_BEYOND_GATHER_CUTS_H
#define RAD_BEYOND_GATHER_CUTS_H

#include "rad/beyond/gather/senders.h"
#include "rad/beyond/panes.h"

/* The regions of a forest, numbered in the order of its tree: the same on all ranks. */
struct regions {
    int32_t *nodes;  /* [count] */
    int32_t *of;     /* [forest->count] region of a leaf with an area; -1: of other
                        patches, or none */
    int64_t count, capacity;
};

struct regions *regions_create(const struct model *model);
void regions_destroy(struct regions *regions);

/* A node of a cut. */
struct cut_node {
    int32_t node; /* of the tree of senders */
    int32_t asked; /* segments between the region and the node, ends facing each other */
    double found; /* visible share of these, 1 */
    double seen;  /* share of its light that may be seen from the region, 1; above 0 */
    double upto;  /* light reaching the region, about, from the nodes of the cut up to
                     this one, over all bands, W/m^2 */
};

struct cut {
    int64_t first; /* of its nodes; -1: not made yet */
    int64_t count;
};

struct cuts {
    const struct senders *senders; /* borrowed */
    const struct regions *regions; /* borrowed */
    const struct panes *panes;     /* borrowed, hide senders behind; NULL: none */
    int segments;                  /* for which cuts are made */
    struct cut *cuts;              /* [regions->count] */
    struct cut_node *nodes;        /* of all cuts made so far */
    int64_t count, capacity;
};

/* The part of a node's light by which a region of this space deals segments to the node
 * as long as none has seen it, 1: where no ray of any root has passed, hardly any will,
 * and a lamp in another room is as good as a thousand times as bright. */
double cuts_blind_part(const struct senders *senders, const struct sender_node *node,
                       int32_t space);

struct cuts *cuts_create(const struct senders *senders, const struct regions *regions,
                         const struct panes *panes, int segments);
void cuts_destroy(struct cuts *cuts); /* NULL: none */

/* Returns the cut of the region of a leaf, made when first asked for: a pure function of
 * the region, so the same on any rank. Adds the tests taken to `counts`. */
struct cut cuts_at(struct cuts *cuts, int32_t leaf, struct octree_counts *counts);

/* Chooses a sender of a cut for a point of its region by the light known to arrive there;
 * `u` in [0, 1). patch -1: none. */
struct choice cuts_choose(const struct cuts *cuts, struct cut cut, double u);

#endif
