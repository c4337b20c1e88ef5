/* What panes on the way of a ray or a segment do to its light: see rad/beyond/panes.c. */
#include "rad/beyond/gather/pane.h"

#include <math.h>

#include "rad/beyond/sample.h"

struct pane_walk receiver_walk_to(const struct receiver *r, struct vec3 from,
                                  struct vec3 to)
{
    return r->gather->aims->panes ? pane_walk_to(from, to)
                                  : (struct pane_walk){.left = 0.0};
}

struct pane_walk receiver_walk(struct receiver *r, struct vec3 origin,
                               struct vec3 direction, enum met met,
                               const struct point *point)
{
    struct model *model = r->gather->model;
    struct pane_walk walk = {origin, direction, HUGE_VAL, -1};
    struct octree_hit hit;
    if (met == MET_FRONT)
        return receiver_walk_to(r, origin, point->at);
    if (met == MET_BACK && r->gather->aims->panes &&
        octree_first_hit(model->octree, origin, direction, false, &hit, &model->counts))
        walk.left = plane_ahead(&model->scene->planes[hit.triangle], origin, direction);
    return walk;
}

bool receiver_puts_aside(struct receiver *r, struct pane_walk walk, int32_t but)
{
    struct final_gather *g = r->gather;
    return g->aims->panes &&
           panes_put_aside(g->aims->panes, walk, but, &g->model->counts);
}

void receiver_filter(struct receiver *r, struct pane_walk walk, struct rgb *weight)
{
    panes_filter(r->gather->aims->panes, walk, weight, &r->gather->model->counts);
}

void receiver_cross(struct receiver *r, struct pane_walk walk, struct rgb *weight)
{
    struct final_gather *g = r->gather;
    while (g->aims->panes && panes_next(g->aims->panes, &walk, &g->model->counts)) {
        double at[3];
        int32_t leaf = leaf_under(g->model->forest, walk.root, walk.at, at);
        if (rgb_sum(forest_material(g->model->forest, leaf)->reflectance) > 0.0)
            receiver_add_point(r, leaf, &g->near->leaves[leaf].slope, at, weight);
        pane_filter(g->model->scene, walk.root, weight);
    }
}
