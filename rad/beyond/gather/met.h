/* The points of surfaces met by rays of the final gather. For the files of the final
 * gather alone. */
#ifndef RAD_BEYOND_GATHER_MET_H
#define RAD_BEYOND_GATHER_MET_H

#include "rad/beyond/gather/receiver.h"
#include "rad/beyond/sample.h"

struct point {
    int32_t root;
    int32_t patch;     /* leaf of the forest */
    double weight[3];  /* barycentric coordinates in the leaf, 1 */
    struct vec3 at, normal;
};

/* Finds the leaf of its root that the point lies on. */
static inline void find_leaf(const struct forest *forest, struct point *point)
{
    point->patch = leaf_under(forest, point->root, point->at, point->weight);
}

enum met { MET_NOTHING, MET_BACK, MET_FRONT };

/* What a ray has met; fills in the point of a front, but for its leaf. */
static inline enum met meet(struct receiver *r, struct vec3 origin, struct vec3 direction,
                            const struct octree_hit *hit, struct point *point)
{
    const struct scene *scene = r->gather->model->scene;
    r->gather->counts.rays++;
    if (hit->triangle < 0)
        return MET_NOTHING;
    int32_t root = scene_root_on(scene, hit->triangle, hit->front);
    if (root < 0 || !(scene_root_area(scene, root) > 0.0))
        return MET_BACK;
    struct plane plane = scene_root_plane(scene, root);
    double along = plane_ahead(&plane, origin, direction);
    point->at = vec3_add(origin, vec3_scale(direction, along));
    point->root = root;
    point->normal = plane.normal;
    return MET_FRONT;
}

/* Finds the first surface on the ray, but no leaf. */
static inline enum met probe(struct receiver *r, struct vec3 origin,
                             struct vec3 direction, struct point *point)
{
    struct model *model = r->gather->model;
    struct octree_hit hit;
    octree_first_hit(model->octree, origin, direction, false, &hit, &model->counts);
    return meet(r, origin, direction, &hit, point);
}

/* Finds the first surface on the ray. */
static inline enum met trace(struct receiver *r, struct vec3 origin,
                             struct vec3 direction, struct point *point)
{
    enum met met = probe(r, origin, direction, point);
    if (met == MET_FRONT)
        find_leaf(r->gather->model->forest, point);
    return met;
}

#endif
