/* Initial linking: the pairs of roots, row by row. */
#ifndef RAD_LINKING_H
#define RAD_LINKING_H

#include "rad/boxtree.h"
#include "rad/link.h"

/* The largest radiosity and reflectance in a node, band by band. */
struct brightness {
    struct rgb radiosity, reflectance;
};

/* A root as it is seen from afar. */
struct spot {
    struct vec3 centre, normal;
    double area, radius;
    struct vec3 points[BUNDLE_ENDS]; /* centroids of its four children */
    bool is_dark; /* neither emits nor reflects */
};

struct linking {
    struct method *method;      /* borrowed; its counters count */
    struct boxtree *tree;       /* owned */
    struct facet *facets;       /* [tree->root_count] in the order of tree->roots; owned */
    struct spot *spots;         /* [tree->root_count] in the same order; owned */
    struct brightness *brightest; /* [tree->node_count]; owned */
    struct link_list *links;    /* borrowed: where links go */
    int64_t touched;            /* pairs of roots of which the exchange was estimated */
};

/* Borrows method and list. */
struct linking linking_start(struct method *method, struct link_list *links);
void linking_end(struct linking *linking);

/* Of a row, one block of the tree in so many is its sample. */
enum { LINKING_SAMPLE = 16 };

/* Roots in the row of a place, of `roots` in all. */
static inline int32_t linking_row_length(int32_t roots, int32_t place)
{
    return roots % 2 == 1 || place < roots / 2 ? roots / 2 : roots / 2 - 1;
}

/* About what the sample of a row takes, before anything is known but the root's size. */
int64_t linking_sample_cost(const struct linking *linking, int32_t place);

/* Links the root at this place of the tree's order with those roots of its row that it can
 * exchange light with and is not proved to be walled off from: with those of the sample of the row, or
 * with those of the rest, that are roots number `from` to before number `to` of the row. Both stop when
 * they have taken `limit` of work (below 2^62), and return where: what is left is from there to `to`.
 * What is found depends on where a row is cut (what is seen does not), but not on what was linked before.
 * *rest, unless NULL, receives what work the rest of the row is expected to take, by its sample as far as
 * that was linked; pre: from is 0. */
int32_t linking_add_sample(struct linking *linking, int32_t place, int32_t from, int32_t to,
                           int64_t limit, int64_t *rest);
int32_t linking_add_part(struct linking *linking, int32_t place, int32_t from, int32_t to,
                         int64_t limit);

#endif
