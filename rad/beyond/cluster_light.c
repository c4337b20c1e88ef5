/* Push-pull through the clusters, as rad/pushpull.c does in the patches. Children differ
 * in area here, so means are weighted. Children come after their parents, so a loop
 * downwards meets children first, and one upwards parents. */
#include "rad/beyond/cluster_light.h"

#include "geom/alloc.h"

struct cluster_light *cluster_light_create(const struct cluster_tree *tree)
{
    struct cluster_light *light = alloc_array(1, sizeof *light);
    size_t count = (size_t)tree->count;
    light->tree = tree;
    light->radiosity = alloc_array(count, sizeof *light->radiosity);
    light->sent = light->radiosity;
    light->flux = alloc_array(BANDS * count, sizeof *light->flux);
    light->irradiance = alloc_array(count, sizeof *light->irradiance);
    return light;
}

void cluster_light_free_vectors(struct cluster_light *light)
{
    alloc_free(light->flux);
    alloc_free(light->irradiance);
    light->irradiance = NULL;
    light->flux = NULL;
}

void cluster_light_destroy(struct cluster_light *light)
{
    if (!light)
        return;
    cluster_light_free_vectors(light);
    alloc_free(light->radiosity);
    alloc_free(light);
}

struct rgb cluster_light_mean(const struct cluster_light *light,
                              const struct forest *forest, int32_t i,
                              const struct rgb *of_patches,
                              const struct rgb *of_clusters)
{
    const struct cluster *cluster = &light->tree->clusters[i];
    struct rgb sum = {{0.0, 0.0, 0.0}};
    for (int k = 0; k < 4 && cluster->child[k] != NODE_NONE; k++) {
        int32_t node = cluster->child[k];
        double area = cluster_node_area(light->tree, forest->scene, node);
        rgb_add(&sum, area / cluster->area,
                node_is_cluster(node) ? of_clusters[~node] : of_patches[node]);
    }
    return sum;
}

void cluster_light_average(const struct cluster_light *light, const struct forest *forest,
                           const struct rgb *of_patches, struct rgb *of_clusters)
{
    for (int32_t i = light->tree->count - 1; i >= 0; i--)
        of_clusters[i] = cluster_light_mean(light, forest, i, of_patches, of_clusters);
}

void cluster_light_push(struct cluster_light *light, struct forest *forest,
                        struct flux_unit unit, int32_t i)
{
    const struct cluster *cluster = &light->tree->clusters[i];
    struct rgb *h = &light->irradiance[i]; /* so far the parent's */
    for (int c = 0; c < BANDS; c++) {
        double own = flux_to_watts(unit, light->flux[BANDS * i + c]) / cluster->area;
        h->band[c] = (i > 0 ? h->band[c] : 0.0) + own;
    }
    for (int k = 0; k < 4 && cluster->child[k] != NODE_NONE; k++) {
        int32_t node = cluster->child[k];
        *(node_is_cluster(node) ? &light->irradiance[~node] : &forest->above[node]) = *h;
    }
}
