/* Nodes as ends of links, patches and clusters alike, and the bounds on two of them
 * before a look. */
#ifndef RAD_BEYOND_NODE_H
#define RAD_BEYOND_NODE_H

#include "rad/beyond/cluster_light.h"
#include "rad/beyond/patch_exchange.h"

struct end {
    int32_t node;
    const struct cluster *cluster; /* NULL: a patch */
    struct facet facet;            /* of a patch */
    struct patch_id id;
    struct vec3 low, high;         /* box around its points */
    struct vec3 normal_low, normal_high; /* box around its unit normals */
    double area, radius;
    struct rgb reflectance, radiosity;
    bool is_dark; /* neither reflects nor emits */
    bool emits;   /* a patch of a lamp */
};

struct end end_of(const struct model *model, int32_t node);

/* Child k of a node, or NODE_NONE. */
static inline int32_t node_child(const struct model *model, int32_t node, int k)
{
    return node_is_cluster(node) ? model->clusters->tree->clusters[~node].child[k]
                                 : forest_child(model->forest, node, k);
}

/* The space of a patch or a cluster; -1: of several. */
static inline int32_t node_space(const struct model *model, int32_t node)
{
    if (node_is_cluster(node))
        return model->clusters->tree->clusters[~node].space;
    return model->spaces ? model->spaces->of[model->forest->patches[node].id.root] : 0;
}

/* The area of child k, 0 where there is none. */
double end_child_area(const struct model *model, const struct end *end, int k);

/* False if certainly nothing of one end faces anything of the other. */
bool ends_may_face(const struct end *a, const struct end *b);

/* Proves that nothing of one end sees anything of the other: true if one wall hides
 * all. */
bool ends_are_walled_off(const struct end *a, const struct end *b,
                         const struct octree *octree, struct octree_counts *counts);

/* Power reflected by a receiver of a sender's light, W per square scene unit of G. */
static inline double light_to(const struct end *to, const struct end *from)
{
    return rgb_dot(to->reflectance, from->radiosity);
}

/* Two ends, of which one at least is a cluster. */
struct meeting {
    const struct end *p, *q; /* borrowed */
    bool near;    /* their boxes are closer than half of the sum of their radii */
    double most;  /* bound on G */
    double light; /* light_to() both ways together */
};

struct meeting ends_meet(const struct end *p, const struct end *q);

#endif
