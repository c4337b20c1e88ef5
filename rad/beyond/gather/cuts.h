/* Cuts: the senders as seen from a region of leaves.
 *
 * A region is the largest node with at most REGION_LEAVES leaves: a part of a wall, or a
 * cluster of small things. Its cut is a list of nodes of the tree of senders, with every
 * sender below exactly one of these, but for senders facing away. The segments of looks
 * at its leaves tell how much of each node is seen from there. */
#ifndef RAD_BEYOND_GATHER_CUTS_H
#define RAD_BEYOND_GATHER_CUTS_H

#include "rad/beyond/gather/senders.h"

/* The regions of a forest, numbered in the order of its tree: the same on all ranks. */
struct regions {
    int32_t *nodes;  /* [count] */
    int32_t *of;     /* [known] region of a leaf with an area; -1: of other patches, or
                        none */
    int64_t count, capacity;
    int64_t known, known_capacity; /* patches of the forest */
};

struct regions *regions_create(const struct model *model);

/* Gives leaves made since then the regions of those that were split. */
void regions_follow(struct regions *regions, const struct forest *forest);
void regions_destroy(struct regions *regions);

/* A node of a cut. */
struct cut_node {
    int32_t node;    /* of the tree of senders */
    int32_t region;  /* whose cut it is */
    int32_t asked;   /* segments of looks from the region to the node */
    int32_t arrived; /* those of them that nothing blocks */
    double worth;    /* light reaching the region, about, with nothing in the way, over
                        all bands, W/m^2 */
    double upto;     /* light by which one of the nodes is chosen, of those up to this
                        one, W/m^2 */
};

struct cut {
    int64_t first; /* of its nodes; -1: not made yet */
    int64_t count;
    double mean;   /* share of segments that arrive, of all its nodes, 1: above 0;
                      0: shares are not found yet */
};

struct cuts {
    const struct senders *senders; /* borrowed */
    const struct regions *regions; /* borrowed */
    int segments;                  /* for which cuts are made */
    struct cut *cuts;              /* [regions->count] */
    struct cut_node *nodes;        /* of all cuts made so far */
    int64_t count, capacity;
    int64_t *tally; /* [2 * count] segments of looks on this rank at each node since the
                       last cuts_learn(), and those that arrive; NULL: not counted */
};

/* The part of a node's light that counts in a region of this space as long as no segment
 * has arrived, 1. A brighter space counts as no brighter than this one: rays of all roots
 * have found no way from there, so hardly any segment will. */
double cuts_blind_part(const struct senders *senders, const struct sender_node *node,
                       int32_t space);

struct cuts *cuts_create(const struct senders *senders, const struct regions *regions,
                         int segments);
void cuts_destroy(struct cuts *cuts); /* NULL: none */

/* Makes the cuts of regions first .. end - 1 that are not made yet. */
void cuts_make(struct cuts *cuts, int64_t first, int64_t end);

/* Takes the nodes of the cuts of all regions, [count], in the order of the regions, in
 * place of its own. Owns `nodes`. */
void cuts_take(struct cuts *cuts, struct cut_node *nodes, int64_t count);

/* Makes the cuts of all regions, the same on all ranks, and begins to count. */
void cuts_count(struct cuts *cuts);

/* Finds visible shares by the tally, which is the sum over all ranks, and clears it. Pre:
 * cuts_count(). */
void cuts_learn(struct cuts *cuts);

/* Forgets all cuts, if they have many nodes: they are made again, and the same, when
 * asked for. Pre: they are not counted, and no cut is in use. */
void cuts_limit(struct cuts *cuts);

/* Returns the cut of the region of a leaf, made when first asked for: a pure function of
 * the region and of what has been learnt, so the same on any rank. */
struct cut cuts_at(struct cuts *cuts, int32_t leaf);

/* The visible share of a node, 1: arrived / asked, with the cut's mean for one segment
 * more. Above 0. */
double cut_seen(const struct cut *cut, const struct cut_node *node);

/* The share by which segments are dealt, 1: arrived / asked. Not asked: the visible
 * share, or 0 if `blind`, the node's cuts_blind_part(), is below 1. */
double cut_found(const struct cut *cut, const struct cut_node *node, double blind);

/* Chooses a sender of a cut for a point of its region by the light known to arrive there;
 * `u` in [0, 1). patch -1: none. */
struct choice cuts_choose(const struct cuts *cuts, struct cut cut, double u);

#endif
