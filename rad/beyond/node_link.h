/* Links between any two nodes of the tree: patches, clusters, or one of each; and of a
 * cluster with itself, for what its own parts exchange. With two patches all of this is
 * rad/link.h and rad/oracle.h.
 *
 * A link of a cluster with itself has half of its G, since transfer takes it both ways.
 */
#ifndef RAD_BEYOND_NODE_LINK_H
#define RAD_BEYOND_NODE_LINK_H

#include "rad/beyond/cluster_light.h"
#include "rad/link.h"

/* A cluster with itself: four children with themselves, and six pairs. */
enum { NODE_CHILDREN_MAX = 10 };

/* The link of the whole scene with itself, not looked at. */
struct link node_link_top(void);

/* The side of the link that the criterion wants to split, or NODE_NONE if the link is
 * fine or splitting is not allowed. Reads the radiosities of the last iteration. */
int32_t node_to_split(const struct model *model, const struct link *link);

/* Splits this side of the link (a patch gets children unless it has them) and makes the
 * links of its children with the other side. Returns their number. */
int node_link_split(struct model *model, const struct link *link, int32_t node,
                    struct link children[NODE_CHILDREN_MAX]);

/* Gives the patches of a link that is not split children, where the link varies over them
 * more than the criterion allows. */
void node_divide_patches(struct model *model, const struct link *link);

/* A new link that stays: its patches are divided, and G of clusters is estimated again,
 * at other points, so that it is not biased by the decision that has accepted it. */
void node_link_settle(struct model *model, struct link *link);

/* As links_transfer(), between all nodes. */
void node_links_transfer(const struct link_list *list, const struct model *model,
                         struct flux_unit unit);

#endif
