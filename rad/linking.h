/* Initial linking of roots in groups. */
#ifndef RAD_LINKING_H
#define RAD_LINKING_H

#include "rad/boxtree.h"
#include "rad/link.h"

struct linking {
    struct method *method;      /* borrowed; its counters count */
    struct boxtree *tree;       /* owned */
    struct facet *facets;       /* [tree->root_count] in the order of tree->roots; owned */
    struct link_list *links;    /* borrowed: where links go */
    int64_t touched;            /* pairs of roots that were looked at one by one */

};

/* Borrows method and list. */
struct linking linking_start(struct method *method, struct link_list *links);
void linking_end(struct linking *linking);

/* Links the root at this place of the tree's order with all roots of its row that it can exchange light
 * with and is not proved to be walled off from. */
void linking_add_row(struct linking *linking, int32_t place);

#endif
