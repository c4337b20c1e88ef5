/* Links between any two nodes of the tree: patches, clusters, or one of each; and of a
 * cluster with itself, for the light exchanged by its own parts. Links of two patches are
 * left to rad/beyond/patch_link.h.
 *
 * A link of a cluster with itself has half of its G, since transfer takes it both
 * ways. */
#ifndef RAD_BEYOND_NODE_LINK_H
#define RAD_BEYOND_NODE_LINK_H

#include "rad/beyond/cluster_light.h"
#include "rad/link.h"

/* Entries of struct method. A cluster is split into up to four children with themselves
 * and six pairs: ten links. */

/* The link of the whole scene with itself, not looked at. */
struct link node_link_top(void);

int node_link_split(struct model *model, const struct link *link, int32_t node,
                    struct link *children);

/* Estimates G of clusters, of a new link, again, at other points, without the bias of the
 * decision to accept the link. */
void node_link_keep(struct model *model, struct link *link);

/* The nodes between which a link carries light: see struct method. */
int node_link_ends(const struct model *model, const struct link *link,
                   int32_t nodes[METHOD_ENDS_MAX]);

/* As links_transfer(); of clusters goes model->clusters->sent. */
void node_links_transfer(const struct link_list *list, const struct model *model,
                         const struct rgb *vector, struct flux_unit unit);

#endif
