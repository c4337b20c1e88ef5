/* The part of a scene to picture. */
#ifndef IO_SCENE_SUBJECT_H
#define IO_SCENE_SUBJECT_H

#include <stdbool.h>

#include "geom/scene.h"

struct subject {
    bool z_up;             /* else y is up */
    bool below_sky;        /* lamps enclose the things, and are no part of it */
    struct vec3 low, high; /* box of the things, with some ground around them */
};

/* Finds the subject of a scene, prepared or not; if not, in input units. */
struct subject subject_find(const struct scene *scene);

/* True if an input triangle is a part of the sky. */
bool subject_has_as_sky(const struct subject *subject, const struct scene *scene,
                        int32_t triangle);

#endif
