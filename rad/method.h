/* The seam between the paper's method and phr's own: a table of functions. PAPER is the
 * paper's, of functions of rad/; DEFAULT is phr's, of functions of rad/beyond/; an
 * ablation is either with an entry exchanged (rad/beyond/default.c). */
#ifndef RAD_METHOD_H
#define RAD_METHOD_H

#include <stdbool.h>
#include <stdint.h>

#include "rad/flux.h"
#include "rad/id.h"

struct criterion;
struct facet;
struct link;
struct link_list;
struct model;

/* A split makes no more links than this. */
enum { METHOD_CHILDREN_MAX = 10 };

/* A link carries light between no more nodes than this. */
enum { METHOD_ENDS_MAX = 8 };

struct method {
    /* The ID of a node of the trees, and the node with an ID; a missing patch is made. */
    struct patch_id (*node_id)(const struct model *model, int32_t node);
    int32_t (*node_reach)(const struct model *model, struct patch_id id);

    /* Child k of a node, or NODE_NONE. */
    int32_t (*node_child)(const struct model *model, int32_t node, int k);

    /* The power of which epsilon is a part, W, areas in square scene units. NULL: the
     * emitted power. */
    double (*light_power)(struct model *model);

    /* The first link. NULL: all pairs of roots are linked. */
    struct link (*first_link)(void);

    /* The link kernel: makes the link between patches p and q, with its form factor and
     * its cost. `parent` is the split link, NULL: none. False if there is no link. */
    bool (*make_link)(struct model *model, int32_t p, const struct facet *facet_p,
                      int32_t q,
                      const struct facet *facet_q, const struct link *parent,
                      struct link *link);

    /* The side of the link to be split, or NODE_NONE. Reads the radiosities of the last
     * iteration. */
    int32_t (*side_to_split)(const struct model *model, const struct link *link);

    /* Splits this side of the link, unless split already, and makes the links of its
     * children with the other side. Returns their number, 0..METHOD_CHILDREN_MAX. */
    int (*split_link)(struct model *model, const struct link *link, int32_t side,
                      struct link *children);

    /* A new link stays unsplit. NULL: nothing is to be done. */
    void (*keep_link)(struct model *model, struct link *link);

    /* Gives patches of an unsplit link children to deal light to. NULL: none. */
    void (*divide)(struct model *model, const struct link *link);

    /* The nodes between which a link carries light. Returns their number. NULL: p and q
     * of the link. */
    int (*ends)(const struct model *model, const struct link *link,
                int32_t nodes[METHOD_ENDS_MAX]);

    /* Transfers light over all links: adds G x of either side to the flux of the other.
     * x is B, or a vector of a solver, [patches], W/m^2. */
    void (*transfer)(const struct link_list *list, const struct model *model,
                     const struct rgb *vector, struct flux_unit unit);
};

extern const struct method PAPER;   /* rad/paper.c */
extern const struct method DEFAULT; /* rad/beyond/default.c */

/* PAPER, DEFAULT or an ablation, as the criterion names them (rad/beyond/default.c). */
struct method method_of(const struct criterion *criterion);

#endif
