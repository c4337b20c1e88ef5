/* The camera of a scene that has no view file: chosen by what rays meet. */
#ifndef IO_PICTURE_VIEWPOINT_H
#define IO_PICTURE_VIEWPOINT_H

#include "io/scene/camera.h"
#include "octree/octree.h"
#include "rad/patch.h"

/* A camera for a picture of this size. A room is seen from within, from eye height near one of its
 * corners; anything else from outside, whole, looking through backs. Up is y or z.
 * `forest` holds the light, which rooms without any do not; NULL: all is lit.
 * The same for everyone: nothing but + - * / and sqrt takes part in the choice. */
struct camera viewpoint_choose(const struct scene *scene, const struct octree *octree,
                               const struct forest *forest, int width, int height);

#endif
