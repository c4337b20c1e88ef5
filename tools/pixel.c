/* Rays through points of a pixel begin at the eye, in the units of the scene. */
#include "tools/pixel.h"

struct pixel {
    const struct camera *camera;
    struct vec3 eye; /* scene units */
    int x, y;
};

static struct half_line ray_of(const void *pixel, double u, double v)
{
    const struct pixel *p = pixel;
    return (struct half_line){p->eye, camera_ray(p->camera, p->x + u, p->y + v)};
}

struct rgb pathtracer_pixel(const struct pathtracer *pathtracer,
                            const struct camera *camera, int x, int y, int samples,
                            uint64_t seed)
{
    struct pixel pixel = {camera, scene_from_input(pathtracer->scene, camera->eye), x, y};
    return pathtracer_seen(pathtracer, ray_of, &pixel, camera->fronts_only, samples,
                           seed);
}
