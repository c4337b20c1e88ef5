/* The camera: the eye, direction and size of a picture. */
#ifndef IO_SCENE_CAMERA_H
#define IO_SCENE_CAMERA_H

#include <stdbool.h>

#include "geom/scene.h"
#include "io/scene/subject.h"
#include "io/scene/text.h"

enum {
    CAMERA_SIZE = 512,     /* pixels along a side by default */
    IMAGE_SIZE_MAX = 32768 /* pixels along a side at most */
};

struct camera {
    struct vec3 eye;         /* input units */
    struct vec3 at;          /* a point in the middle of the picture, input units */
    struct vec3 up;          /* direction, not along at - eye */
    double fov;              /* vertical, degrees, 0..180 exclusive */
    int width, height;       /* pixels */
    bool has_up;             /* the view says which way is up */
    bool fronts_only;        /* rays pass through the backs of input triangles */
};

/* Reads a view file: lines `eye x y z`, `at x y z`, `up x y z`, `fov degrees`, `size w h`
 * in any order, # comments. eye and at are required. Defaults: up 0 1 0 (0 0 1 if the
 * view is along y), fov 45, size 512 512.
 * Errors: "FILE:LINE: REASON", EXIT_USAGE. */
bool camera_read(const char *path, struct camera *camera, struct error *error);
bool camera_of_text(struct camera *camera, struct text *text, struct error *error);

/* Lets an axis (struct scene) be up in a view, unless the view looks along it. */
void camera_set_up(struct camera *camera, int32_t up);

/* Returns the upward axis as a view says (struct scene); 0: it does not say, or looks
 * along an axis, as in a plan, whose north is up in the picture. */
int32_t camera_up_axis(const struct camera *camera);

/* Puts the camera outside the box of the subject, in the direction `towards` from its
 * middle (of any length but 0, not along up), at the smallest distance that shows the
 * whole box. Reads up, fov and size; writes eye and at. */
void camera_frame(struct camera *camera, const struct scene *scene,
                  const struct subject *subject, struct vec3 towards);

/* The axes of a camera, for many rays. */
struct camera_basis {
    struct vec3 forward, right, above; /* of length 1 */
    double pixel;                      /* its side at distance 1 */
    double middle[2];                  /* of the picture, pixels from the top left */
};

struct camera_basis camera_basis_of(const struct camera *camera);

/* Returns the direction, not of length 1, of the ray through the point (x, y) of the
 * picture, in pixels from the top left corner. */
static inline struct vec3 camera_basis_ray(const struct camera_basis *basis, double x,
                                           double y)
{
    struct vec3 across = vec3_scale(basis->right, (x - basis->middle[0]) * basis->pixel);
    struct vec3 up = vec3_scale(basis->above, (basis->middle[1] - y) * basis->pixel);
    return vec3_add(basis->forward, vec3_add(across, up));
}

/* The same, for a few rays. */
struct vec3 camera_ray(const struct camera *camera, double x, double y);

#endif
