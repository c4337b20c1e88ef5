/* The light of clusters: mean radiosity, the flux brought by links, and the irradiance
 * handed down. */
#ifndef RAD_BEYOND_CLUSTER_LIGHT_H
#define RAD_BEYOND_CLUSTER_LIGHT_H

#include "rad/beyond/cluster.h"
#include "rad/flux.h"

struct cluster_light {
    const struct cluster_tree *tree; /* borrowed */
    struct rgb *radiosity;  /* [tree->count] B, W/m^2: the mean over the area */
    const struct rgb *sent; /* [tree->count] borrowed: means of the transferred vector;
                               `radiosity`, unless another is set */
    int64_t *flux;          /* [BANDS * tree->count] Phi of the links of clusters */
    struct rgb *irradiance; /* [tree->count] H of a cluster and all above it, W/m^2 */
};

/* Borrows the tree. */
struct cluster_light *cluster_light_create(const struct cluster_tree *tree);
void cluster_light_destroy(struct cluster_light *light);

/* Frees all but tree and radiosity. */
void cluster_light_free_vectors(struct cluster_light *light);

/* The pull of cluster i: the mean of its children, in vectors over patches and over
 * clusters. */
struct rgb cluster_light_mean(const struct cluster_light *light,
                              const struct forest *forest, int32_t i,
                              const struct rgb *of_patches,
                              const struct rgb *of_clusters);

/* The pull of all clusters, from the roots up. */
void cluster_light_average(const struct cluster_light *light, const struct forest *forest,
                           const struct rgb *of_patches, struct rgb *of_clusters);

/* The push of cluster i, after its parent's: forest->above of a root is the irradiance of
 * all clusters above. */
void cluster_light_push(struct cluster_light *light, struct forest *forest,
                        struct flux_unit unit, int32_t i);

#endif
