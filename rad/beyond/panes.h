/* Panes: faces that light crosses, as windows and openings are.
 *
 * Panes are in no octree of blockers. An octree of their own tells the panes on a
 * segment. */
#ifndef RAD_BEYOND_PANES_H
#define RAD_BEYOND_PANES_H

#include "octree/octree.h"
#include "rad/patch.h"

struct panes {
    const struct scene *scene;  /* borrowed, prepared */
    int32_t *inputs;            /* [count] the input triangles that are panes */
    struct triangle *triangles; /* [count] */
    struct plane *planes;       /* [count] */
    int32_t count;
    struct octree *octree;      /* of these */
    struct rgb *sent; /* [roots] of a pane the mean radiosity seen from both of its sides,
                         times its transmittance, W/m^2; NULL: not known */
};

/* Returns NULL if the scene has no panes. */
struct panes *panes_create(const struct scene *scene);
void panes_destroy(struct panes *panes); /* NULL: none */

/* Finds the light sent by panes, by the octree of blockers and the radiosities of a
 * forest: the same on every rank. Segments are dealt by it. Both sides count alike: a
 * pane to a dark room is aimed at, as this room's light is not there. */
void panes_look(struct panes *panes, const struct octree *octree,
                const struct forest *forest);

/* A segment on its way across panes. */
struct pane_walk {
    struct vec3 at, direction; /* of length 1 */
    double left;               /* of its length, scene units */
    int32_t root;              /* side met of the pane crossed last; -1: none yet */
};

/* A walk from one point to another, both just above their surfaces. */
struct pane_walk pane_walk_to(struct vec3 from, struct vec3 to);

/* Finds the next pane crossed, and goes on to just behind it. False if there is none. */
bool panes_next(const struct panes *panes, struct pane_walk *walk,
                struct octree_counts *counts);

/* Multiplies light by the transmittance of a root's pane. */
void pane_filter(const struct scene *scene, int32_t root, struct rgb *light);

/* Does so for all panes on a way. `panes` NULL: none. */
void panes_filter(const struct panes *panes, struct pane_walk walk, struct rgb *light,
                  struct octree_counts *counts);

/* Does so with `share`, of the light behind, and adds to `light` the radiosity of each
 * pane itself, times the share of light that has come so far. */
void panes_cross(const struct panes *panes, struct pane_walk walk,
                 const struct forest *forest, struct rgb *share, struct rgb *light,
                 struct octree_counts *counts);

/* True if the walk crosses a pane aimed at, other than the root `but`, which may be -1.
 * All panes that send light are aimed at. */
bool panes_put_aside(const struct panes *panes, struct pane_walk walk, int32_t but,
                     struct octree_counts *counts);

#endif
