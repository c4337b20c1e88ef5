/* Paths from near surfaces: what happens where a ray of the final gather has met a
 * leaf. For the files of the final gather alone. */
#ifndef RAD_BEYOND_GATHER_PATH_H
#define RAD_BEYOND_GATHER_PATH_H

#include "rad/beyond/gather/met.h"

/* Adds the mesh's light at a point; `aimed`: without emission. */
static inline void path_add_mesh(struct receiver *r, const struct point *point,
                                 bool aimed, const struct rgb *weight)
{
    const struct forest *forest = r->gather->model->forest;
    struct rgb emission = forest_material(forest, point->patch)->emission;
    receiver_add_point(r, point->patch, &r->gather->near->leaves[point->patch].slope,
                       point->weight, weight);
    if (aimed)
        receiver_add_source(r, weight, emission, -1.0);
}

/* True if a ray from x takes the mesh's light at the point met. The leaf there is too
 * near for its mean to hold if less than a third of its area is within the ray's length
 * of the point: a thing so near, the receiver itself above all, shades or lights this
 * part of the leaf and not the rest. A leaf with a thing across is too near from
 * anywhere: the light before a wall differs from the light behind. */
static inline bool path_ends(const struct receiver *r, const struct point *met,
                             struct vec3 x)
{
    struct vec3 ray = vec3_sub(met->at, x);
    return vec3_dot(ray, ray) >= r->gather->near->leaves[met->patch].reach2;
}

/* True if segments from x bring the light of the bright patch around the point met, and a
 * ray that meets it is put aside. In a row they do where a ray ends there, in a pixel
 * also where a path goes on: light of the bulb on its holder, found by chance, is a
 * bright speck. */
bool path_is_aimed_at(const struct receiver *r, const struct point *met, struct vec3 x);

/* Adds the light, times `weight`, of a path at a point met by a ray from x: the path ends
 * there or goes on. `aimed`: the point is of a lamp aimed at. `aims`: the path aims from
 * all of its points at panes and bright patches. */
void path_go_on(struct receiver *r, struct point point, struct vec3 x, bool aimed,
                struct rgb weight, uint64_t seed, bool aims);

/* Adds the light of a sender at its point y, visible from x but for panes, with this form
 * factor; or nothing, if a pane on the way brings that light, or of a bright patch, if
 * rays from x are not aimed at it. */
void receiver_see(struct receiver *r, const struct senders *senders, struct vec3 x,
                  struct vec3 y, int32_t patch, double factor, uint64_t seed);

#endif
