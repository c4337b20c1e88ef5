/* The camera of a scene without a view file, chosen by casting rays. */
#ifndef IO_PICTURE_VIEWPOINT_H
#define IO_PICTURE_VIEWPOINT_H

#include "io/scene/camera.h"
#include "octree/octree.h"
#include "rad/patch.h"

/* Returns a camera for a picture of this size. A room is seen from within, from eye
 * height near one of its corners; the subject of any other scene from outside, whole,
 * looking through black backs. Up is y or z. `forest` has the light, to avoid the dark;
 * NULL: every surface counts as lit. The choice takes only + - * / and sqrt: the same on
 * every rank and machine. */
struct camera viewpoint_choose(const struct scene *scene, const struct octree *octree,
                               const struct forest *forest, int width, int height);

#endif
