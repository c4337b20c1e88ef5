/* The camera: where a picture is taken from. */
#ifndef IO_SCENE_CAMERA_H
#define IO_SCENE_CAMERA_H

#include <stdbool.h>

#include "geom/scene.h"
#include "io/scene/text.h"

enum {
    CAMERA_SIZE = 512,     /* pixels along a side, unless said */
    IMAGE_SIZE_MAX = 32768 /* the most that may be said */
};

struct camera {
    struct vec3 eye, at, up; /* input units */
    double fov;              /* vertical, degrees, 0..180 exclusive */
    int width, height;       /* pixels */
    bool fronts_only;        /* look through the backs of the input triangles */
};

/* Reads a view file: lines `eye x y z`, `at x y z`, `up x y z`, `fov degrees`, `size w h` in any
 * order, # comments. eye and at must be there; up is 0 1 0 (or 0 0 1 where that is the viewing
 * direction), fov 45 and the size 512 512 unless said.
 * Errors: "FILE:LINE: what is wrong", EXIT_USAGE. */
bool camera_read(const char *path, struct camera *camera, struct error *error);
bool camera_of_text(struct camera *camera, struct text *text, struct error *error);

/* Puts the camera outside the bounding box of the scene, in the direction `towards` from its middle
 * (of any length but 0, not along up), as near as all of the box is in the picture. Reads up, fov and size;
 * writes eye and at. */
void camera_frame(struct camera *camera, const struct scene *scene, struct vec3 towards);

/* Direction, of no certain length, of the ray through the point (x, y) of the picture, in
 * pixels from the top left corner. */
struct vec3 camera_ray(const struct camera *camera, double x, double y);

#endif
