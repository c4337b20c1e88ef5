/* The part of a scene to picture. */
#ifndef IO_SCENE_SUBJECT_H
#define IO_SCENE_SUBJECT_H

#include <stdbool.h>

#include "geom/scene.h"

struct subject {
    int32_t up;            /* as in struct scene */
    bool below_sky;        /* lamps enclose the things, and are no part of it */
    struct vec3 low, high; /* box of the things, with some ground around them */
};

/* Guesses the upward axis, y or z: see struct scene. Sets `*reason` to the reason, in
 * words behind "y is up: ". `words`: the first line of the file, of its exporter, or "".
 * The scene is prepared or not. */
int32_t subject_guess_up(const struct scene *scene, const char *words,
                         const char **reason);

/* Returns the coordinate of a vector along the upward axis. */
static inline double up_height(int32_t up, struct vec3 v)
{
    return up < 0 ? -vec3_axis(v, -up - 1) : vec3_axis(v, up - 1);
}

/* Returns the vector of these parts along two level axes and up: to the right, to the
 * front, up. */
static inline struct vec3 up_frame(int32_t up, double right, double front, double above)
{
    double sign = up < 0 ? -1.0 : 1.0;
    switch (up < 0 ? -up : up) {
    case 1: return (struct vec3){sign * above, right, -sign * front};
    case 3: return (struct vec3){right, -sign * front, sign * above};
    default: return (struct vec3){right, sign * above, sign * front};
    }
}

/* Finds the subject of a scene, prepared or not; if not, in input units. Without
 * scene->up, up is guessed. */
struct subject subject_find(const struct scene *scene);

/* True if an input triangle is a part of the sky. */
bool subject_has_as_sky(const struct subject *subject, const struct scene *scene,
                        int32_t triangle);

#endif
