/* The camera.
 *
 * The tangent of half the field of view comes from its Taylor series and the double-angle
 * formula, not from the C library, whose last bit differs from system to system. */
#include "io/scene/camera.h"

#include <math.h>
#include <string.h>

static const double ALONG = 0.96;  /* cosine to an axis of a direction along it */
static const double MARGIN = 1.04; /* around a framed scene */

/* Pre: 0 < x < pi / 2. */
static double tangent(double x)
{
    enum { HALVINGS = 6 };
    double h = x / (double)(1 << HALVINGS), h2 = h * h; /* h < 0.025: the rest is 1e-19 */
    double t =
        h *
        (1.0 + h2 * (1.0 / 3 + h2 * (2.0 / 15 + h2 * (17.0 / 315 + h2 * 62.0 / 2835))));
    for (int k = 0; k < HALVINGS; k++)
        t = 2.0 * t / (1.0 - t * t);
    return t;
}

/* True also if one vector is 0. */
static bool are_parallel(struct vec3 a, struct vec3 b)
{
    return !(vec3_length(vec3_cross(vec3_unit(a), vec3_unit(b))) > 1e-9);
}

/* Reads exactly `count` numbers from the rest of a line. */
static bool read_numbers(const struct text *text, char *rest, int count, double *values,
                         struct error *error)
{
    for (int i = 0; i < count; i++) {
        const char *word = text_word(&rest);
        if (!word)
            return error_set(error, EXIT_USAGE, "%s:%ld: %d number%s needed", text->path,
                             text->line, count, count == 1 ? " is" : "s are");
        if (!text_number(text, word, &values[i], error))
            return false;
    }
    const char *more = text_word(&rest);
    if (more)
        return error_set(error, EXIT_USAGE, "%s:%ld: unexpected '%s'", text->path,
                         text->line, more);
    return true;
}

static bool read_size(const struct text *text, char *rest, struct camera *camera,
                      struct error *error)
{
    double size[2];
    if (!read_numbers(text, rest, 2, size, error))
        return false;
    for (int i = 0; i < 2; i++)
        if (!(size[i] >= 1.0 && size[i] <= IMAGE_SIZE_MAX) || size[i] != floor(size[i]))
            return error_set(error, EXIT_USAGE,
                             "%s:%ld: a size is a whole number from 1 to %d", text->path,
                             text->line, (int)IMAGE_SIZE_MAX);
    camera->width = (int)size[0];
    camera->height = (int)size[1];
    return true;
}

/* The required keywords read so far. */
struct view_seen {
    bool eye, at, up;
};

static bool read_view_line(const struct text *text, char *line, struct camera *camera,
                           struct view_seen *seen, struct error *error)
{
    const char *keyword = text_word(&line);
    double v[3];
    if (!keyword)
        return true;
    if (strcmp(keyword, "size") == 0)
        return read_size(text, line, camera, error);
    if (strcmp(keyword, "fov") == 0) {
        if (!read_numbers(text, line, 1, &camera->fov, error))
            return false;
        if (!(camera->fov > 0.0 && camera->fov < 180.0))
            return error_set(error, EXIT_USAGE,
                             "%s:%ld: fov must lie between 0 and 180 degrees", text->path,
                             text->line);
        return true;
    }
    bool eye = strcmp(keyword, "eye") == 0, at = strcmp(keyword, "at") == 0;
    bool up = strcmp(keyword, "up") == 0;
    if (!eye && !at && !up)
        return error_set(error, EXIT_USAGE, "%s:%ld: unknown keyword '%s'", text->path,
                         text->line, keyword);
    if (!read_numbers(text, line, 3, v, error))
        return false;
    struct vec3 *field = eye ? &camera->eye : at ? &camera->at : &camera->up;
    *field = (struct vec3){v[0], v[1], v[2]};
    seen->eye = seen->eye || eye;
    seen->at = seen->at || at;
    seen->up = seen->up || up;
    return true;
}

static bool check_view(const char *path, struct camera *camera,
                       const struct view_seen *seen, struct error *error)
{
    struct vec3 forward = vec3_sub(camera->at, camera->eye);
    if (!seen->eye || !seen->at)
        return error_set(error, EXIT_USAGE, "%s: no '%s' line", path,
                         seen->eye ? "at" : "eye");
    if (!(vec3_length(forward) > 0.0))
        return error_set(error, EXIT_USAGE, "%s: eye and at are the same point", path);
    if (!seen->up && are_parallel(forward, camera->up))
        camera->up = (struct vec3){0.0, 0.0, 1.0};
    if (are_parallel(forward, camera->up))
        return error_set(error, EXIT_USAGE, "%s: up points along the viewing direction",
                         path);
    return true;
}

bool camera_of_text(struct camera *camera, struct text *text, struct error *error)
{
    *camera = (struct camera){.up = {0.0, 1.0, 0.0}, .fov = 45.0, .width = CAMERA_SIZE,
                              .height = CAMERA_SIZE};
    struct view_seen seen = {false, false, false};
    char *line;
    while ((line = text_line(text)) != NULL)
        if (!read_view_line(text, line, camera, &seen, error))
            return false;
    camera->has_up = seen.up;
    return check_view(text->path, camera, &seen, error);
}

void camera_set_up(struct camera *camera, int32_t up)
{
    struct vec3 axis = up_frame(up, 0.0, 0.0, 1.0);
    if (!are_parallel(vec3_sub(camera->at, camera->eye), axis))
        camera->up = axis;
}

int32_t camera_up_axis(const struct camera *camera)
{
    struct vec3 up = vec3_unit(camera->up);
    struct vec3 forward = vec3_unit(vec3_sub(camera->at, camera->eye));
    int32_t found = 0;
    for (int axis = 0; axis < 3; axis++) {
        double along = vec3_axis(up, axis);
        if (!camera->has_up || fabs(vec3_axis(forward, axis)) > ALONG)
            return 0;
        if (fabs(along) > ALONG)
            found = along > 0.0 ? axis + 1 : -axis - 1;
    }
    return found;
}

bool camera_read(const char *path, struct camera *camera, struct error *error)
{
    struct text text;
    if (!text_read(&text, path, error))
        return false;
    bool good = camera_of_text(camera, &text, error);
    text_free(&text);
    return good;
}

void camera_frame(struct camera *camera, const struct scene *scene,
                  const struct subject *subject, struct vec3 towards)
{
    struct vec3 back = vec3_unit(towards);
    struct vec3 right = vec3_unit(vec3_cross(camera->up, back));
    struct vec3 above = vec3_cross(back, right),
                middle = vec3_middle(subject->low, subject->high);
    double slope = tangent(camera->fov * PI / 360.0), distance = 0.0;
    double aspect = (double)camera->width / camera->height;
    for (int k = 0; k < 8; k++) {
        struct vec3 corner = {k & 1 ? subject->high.x : subject->low.x,
                              k & 2 ? subject->high.y : subject->low.y,
                              k & 4 ? subject->high.z : subject->low.z};
        struct vec3 arm = vec3_sub(corner, middle);
        double across = fabs(vec3_dot(arm, right)) / (slope * aspect);
        double up = fabs(vec3_dot(arm, above)) / slope;
        distance =
            real_max(distance, MARGIN * real_max(across, up) + vec3_dot(arm, back));
    }
    camera->at = scene_to_input(scene, middle);
    camera->eye = scene_to_input(scene, vec3_add(middle, vec3_scale(back, distance)));
}

struct camera_basis camera_basis_of(const struct camera *camera)
{
    struct camera_basis basis = {.forward = vec3_unit(vec3_sub(camera->at, camera->eye)),
                                 .middle = {0.5 * camera->width, 0.5 * camera->height}};
    basis.right = vec3_unit(vec3_cross(basis.forward, vec3_unit(camera->up)));
    basis.above = vec3_cross(basis.right, basis.forward);
    basis.pixel = 2.0 * tangent(camera->fov * PI / 360.0) / camera->height;
    return basis;
}

struct vec3 camera_ray(const struct camera *camera, double x, double y)
{
    struct camera_basis basis = camera_basis_of(camera);
    return camera_basis_ray(&basis, x, y);
}
