/* Senders, which the final gather aims at: lamps; bright patches, whose light rays in all
 * directions would find too seldom; and panes, which send the light behind them.
 *
 * Senders are the leaves of a tree: the part of the tree of clusters and patches with
 * senders below. The senders of a node lie side by side in an array of sums, and a search
 * there chooses one by its power. Lamps, bright patches and panes have a tree each: a
 * picture gathers the light of lamps alone. */
#ifndef RAD_BEYOND_GATHER_SENDERS_H
#define RAD_BEYOND_GATHER_SENDERS_H

#include "rad/beyond/gather/lit.h"

/* A ball around all points of a node, and a box around their unit normals. */
struct bounds {
    struct vec3 middle, normal_low, normal_high;
    double radius;
};

struct bounds facet_bounds(const struct facet *facet);

/* The bounds of a patch or a cluster. */
struct bounds bounds_of(const struct model *model, int32_t node);

struct sender_node {
    struct bounds bounds;
    int32_t child[4];   /* numbers of nodes; -1 where there are fewer */
    int32_t first, end; /* its senders */
    int32_t space;      /* of these; -1: of several */
};

/* Roots that emit; the largest patches that reflect much light, and evenly; panes, which
 * are roots and send the light behind. */
enum sender_kind { LAMPS, BRIGHT_PATCHES, WINDOWS, SENDER_KINDS };

struct senders {
    const struct model *model; /* borrowed */
    enum sender_kind kind;
    const struct rgb *sent;    /* borrowed, [roots] light of panes */
    struct sender_node *nodes; /* [count] parents first; node 0 is the top */
    int32_t *patches;          /* [sender_count] the senders, in the tree's order */
    double *before;            /* [sender_count + 1] power of those before, over all
                                  bands, W in square scene units */
    int32_t *part_of;          /* [forest->count] the sender of which a patch is all or
                                  part; -1: none; of lamps known of roots alone */
    int64_t count, capacity, sender_count, sender_capacity, before_capacity;
};

/* The senders of a kind, as bright as `lit` asks for. Borrows the model, which has
 * clusters and a solution, and of windows `sent`: see struct panes. */
struct senders *senders_create(const struct model *model, enum sender_kind kind,
                               const struct lit *lit, const struct rgb *sent);
void senders_destroy(struct senders *senders); /* NULL: none */

/* The power of all senders, over all bands, W in square scene units. */
static inline double senders_power(const struct senders *senders)
{
    return senders->before[senders->sender_count];
}

/* The light of a sender, W/m^2. */
struct rgb sender_light(const struct senders *senders, int32_t patch);

/* An estimate of the irradiance, over all bands, within the bounds `to` by a node's
 * senders, if nothing is in the way, W/m^2. 0 only if no light arrives. */
double sender_node_worth(const struct senders *senders, const struct sender_node *node,
                         const struct bounds *to);

/* A choice by chance. */
struct choice {
    int32_t patch; /* the chosen one */
    double share;  /* inverse of its probability, 1 */
};

/* Chooses a sender of a node by its power; `u` in [0, 1). */
struct choice sender_choose(const struct senders *senders, const struct sender_node *node,
                            double u);

#endif
