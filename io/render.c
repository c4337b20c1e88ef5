/* Rendering. A pixel depends on nothing but its place, so rows can be dealt to ranks in any
 * way. A triangle shows its twin, if it has one, where its back is met. */
#include "io/render.h"

#include "geom/alloc.h"
#include "geom/stop.h"

static struct rgb trace(const struct shading *shading, const struct octree *octree,
                        const struct camera *camera, double x, double y)
{
    const struct scene *scene = shading->forest->scene;
    struct octree_counts counts = {0};
    struct octree_hit hit;
    struct rgb black = {{0.0, 0.0, 0.0}};
    if (!octree_first_hit(octree, scene_from_input(scene, camera->eye), camera_ray(camera, x, y),
                          camera->fronts_only, &hit, &counts))
        return black;
    int32_t root = scene_root_on(scene, hit.triangle, hit.front);
    if (root < 0)
        return black;
    double twin_weight[3] = {hit.weight[0], hit.weight[2], hit.weight[1]}; /* (a, c, b) */
    return shading_at(shading, root, hit.front ? hit.weight : twin_weight);
}

static void render_pixel(const struct shading *shading, const struct octree *octree,
                         const struct camera *camera, int samples, int px, int py, float *pixel)
{
    struct rgb sum = {{0.0, 0.0, 0.0}};
    for (int i = 0; i < samples * samples; i++) {
        double x = px + (i % samples + 0.5) / samples, y = py + (i / samples + 0.5) / samples;
        struct rgb sample = trace(shading, octree, camera, x, y);
        for (int c = 0; c < BANDS; c++)
            sum.band[c] += sample.band[c];
    }
    for (int c = 0; c < BANDS; c++)
        pixel[c] = (float)(sum.band[c] / (samples * samples));
}

float *render_rows(const struct shading *shading, const struct octree *octree,
                   const struct camera *camera, int samples, int first, int step,
                   struct progress *progress)
{
    size_t row = 3 * (size_t)camera->width;
    int rows = first < camera->height ? (camera->height - first - 1) / step + 1 : 0;
    float *rgb = alloc_array((size_t)rows * row, sizeof *rgb);
    for (int i = 0; i < rows; i++) {
        progress_tick(progress, (double)i / rows);
        for (int x = 0; x < camera->width && !stop_is_asked(); x++)
            render_pixel(shading, octree, camera, samples, x, first + i * step,
                         rgb + (size_t)i * row + 3 * (size_t)x);
    }
    return rgb;
}
