/* The light of clusters: mean radiosity, the flux brought by links, and the irradiance
 * handed down. All ranks know the radiosities of all clusters. */
#ifndef RAD_BEYOND_CLUSTER_LIGHT_H
#define RAD_BEYOND_CLUSTER_LIGHT_H

#include "rad/beyond/cluster.h"
#include "rad/flux.h"

struct cluster_light {
    const struct cluster_tree *tree; /* borrowed */
    struct rgb *radiosity;  /* [tree->count] B, W/m^2: the mean over the area */
    struct rgb *sent;       /* [tree->count] means of the transferred vector */
    int64_t *flux;          /* [BANDS * tree->count] Phi of the links of clusters */
    struct rgb *irradiance; /* [tree->count] H of a cluster and all above it, W/m^2 */
};

/* Borrows the tree. */
struct cluster_light *cluster_light_create(const struct cluster_tree *tree);
void cluster_light_destroy(struct cluster_light *light);

/* Frees all but tree and radiosity. */
void cluster_light_free_vectors(struct cluster_light *light);

/* The pull: means of the children, from the roots up, of a vector [patches]. */
void cluster_light_average(const struct cluster_light *light, const struct forest *forest,
                           const struct rgb *of_patches, struct rgb *of_clusters);

/* The push: forest->above of a root is the irradiance of all clusters above it. */
void cluster_light_push(struct cluster_light *light, struct forest *forest,
                        struct flux_unit unit);

#endif
