/* Ends of links.
 *
 * Whether two ends can face each other is told from boxes around their points and around
 * their normals: for a root with normal n and a point x of the other end, n . (x - y) > 0
 * for some point y of the root; the largest value of this product, with n, x and y
 * anywhere in their boxes, is found axis by axis. Of a patch the plane is known, and of
 * two patches all corners. */
#include "rad/beyond/node.h"

#include <math.h>

static struct end end_of_cluster(const struct model *model, int32_t node)
{
    const struct cluster_light *light = model->clusters;
    const struct cluster *cluster = &light->tree->clusters[~node];
    return (struct end){
        .node = node,
        .cluster = cluster,
        .id = {CLUSTER_ROOT, cluster->hierarchy},
        .low = cluster->low,
        .high = cluster->high,
        .normal_low = cluster->normal_low,
        .normal_high = cluster->normal_high,
        .area = cluster->area,
        .radius = 0.5 * vec3_length(vec3_sub(cluster->high, cluster->low)),
        .reflectance = cluster->reflectance,
        .radiosity = light->radiosity[~node],
        .is_dark = cluster->is_dark,
    };
}

struct end end_of(const struct model *model, int32_t node)
{
    if (node_is_cluster(node))
        return end_of_cluster(model, node);
    const struct material *material = forest_material(model->forest, node);
    struct end end = {.node = node, .facet = facet_make(model->forest, node),
                      .id = model->forest->patches[node].id,
                      .reflectance = material->reflectance,
                      .radiosity = model->forest->radiosity[node],
                      .is_dark = material_is_dark(material),
                      .emits = material_emits(material)};
    end.low = triangle_low(&end.facet.triangle);
    end.high = triangle_high(&end.facet.triangle);
    end.normal_low = end.normal_high = end.facet.plane.normal;
    end.area = end.facet.area;
    end.radius = triangle_radius(&end.facet.triangle);
    return end;
}

double end_child_area(const struct model *model, const struct end *end, int k)
{
    if (!end->cluster)
        return 0.25 * end->area;
    int32_t node = end->cluster->child[k];
    if (node == NODE_NONE)
        return 0.0;
    return cluster_node_area(model->clusters->tree, model->scene, node);
}

/* The largest product of a number in [a, b] and one in [c, d]. */
static double largest_product(double a, double b, double c, double d)
{
    return real_max(real_max(a * c, a * d), real_max(b * c, b * d));
}

/* No point of b is further in front of a plane of a than this. */
static double reach_above(const struct end *a, const struct end *b)
{
    double reach = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        double from = a->cluster ? vec3_axis(a->high, axis) : 0.0;
        double to = a->cluster ? vec3_axis(a->low, axis) : 0.0;
        reach += largest_product(vec3_axis(a->normal_low, axis),
                                 vec3_axis(a->normal_high, axis),
                                 vec3_axis(b->low, axis) - from,
                                 vec3_axis(b->high, axis) - to);
    }
    return a->cluster ? reach : reach - a->facet.plane.offset;
}

/* Roots of exactly one normal never face each other: of two parallel planes one lies
 * behind the other. */
static bool look_the_same_way(const struct end *a, const struct end *b)
{
    return vec3_is_equal(a->normal_low, a->normal_high) &&
           vec3_is_equal(a->normal_low, b->normal_low) &&
           vec3_is_equal(a->normal_low, b->normal_high);
}

bool ends_may_face(const struct end *a, const struct end *b)
{
    if (!a->cluster && !b->cluster)
        return facets_face(&a->facet, &b->facet);
    /* Beyond rounding: facets_face() is stricter. */
    const double margin = 0.5 * GEOM_ROUNDING;
    return !look_the_same_way(a, b) && reach_above(a, b) > margin &&
           reach_above(b, a) > margin;
}

/* The corners of a patch, or of the box around a cluster. Returns their number. */
static int corners_of(const struct end *end, struct vec3 corners[8])
{
    for (int k = 0; k < 3 && !end->cluster; k++)
        corners[k] = end->facet.triangle.corner[k];
    for (int k = 0; k < 8 && end->cluster; k++)
        corners[k] = (struct vec3){(k & 1 ? end->high : end->low).x,
                                   (k & 2 ? end->high : end->low).y,
                                   (k & 4 ? end->high : end->low).z};
    return end->cluster ? 8 : 3;
}

bool ends_are_walled_off(const struct end *a, const struct end *b,
                         const struct octree *octree, struct octree_counts *counts)
{
    struct vec3 corners_a[8], corners_b[8];
    int count_a = corners_of(a, corners_a), count_b = corners_of(b, corners_b);
    return octree_has_wall(octree, corners_a, count_a, corners_b, count_b, counts);
}

static double gap_between(const struct end *a, const struct end *b)
{
    double square = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        double above = vec3_axis(b->low, axis) - vec3_axis(a->high, axis);
        double below = vec3_axis(a->low, axis) - vec3_axis(b->high, axis);
        double gap = real_max(0.0, real_max(above, below));
        square += gap * gap;
    }
    return sqrt(square);
}

struct meeting ends_meet(const struct end *p, const struct end *q)
{
    struct meeting m = {.p = p, .q = q};
    double gap = gap_between(p, q), limit = real_min(p->area, q->area);
    m.near = gap < 0.5 * (p->radius + q->radius);
    m.most = real_min(limit, p->area * q->area / (PI * gap * gap + 1e-300));
    m.light = light_to(p, q) + light_to(q, p);
    return m;
}
