/* Why a picture is dark.
 *
 * A grid of pixels is looked through again: a ray through the middle of each pixel meets
 * nothing, a sky, a back, a surface reflecting nothing, or one without light.
 * The most frequent of these is the reason; but nothing and sky, which are around any
 * thing, only where there is hardly a surface. Of surfaces without light the reason is in
 * the lamps: there are none but a sky, which does not get in, or their fronts look away,
 * or all their light stays elsewhere. */
#include "tools/dark.h"

#include "geom/hash.h"
#include "rad/beyond/sample.h"

enum {
    GRID = 32,      /* pixels along a side of the picture */
    LAMP_RAYS = 64, /* from each lamp */
    OUTSIDE = -2    /* for root_met() */
};

static const double DARK = 0.9;   /* share of a picture to warn of */
static const double THINGS = 0.1; /* share of this with surfaces, at least, unless the
                                   * camera looks past the scene */

/* What a ray of the camera meets. */
enum sight { SIGHT_LIGHT, SIGHT_BACK, SIGHT_BLACK, SIGHT_UNLIT, SIGHT_NOTHING, SIGHT_SKY,
             SIGHTS };

static enum sight look(const struct run *run, const struct camera *camera, int x, int y,
                       const float *pixel)
{
    const struct scene *scene = run->scene;
    struct octree_counts counts = {0};
    struct octree_hit hit;
    struct vec3 eye = scene_from_input(scene, camera->eye);
    struct vec3 direction = vec3_unit(camera_ray(camera, x + 0.5, y + 0.5));
    bool met = octree_first_hit(run->octree, eye, direction, camera->fronts_only, &hit,
                                &counts);
    if (met && scene_is_sky(scene, hit.triangle))
        return SIGHT_SKY;
    if (pixel[0] > 0.0f || pixel[1] > 0.0f || pixel[2] > 0.0f)
        return SIGHT_LIGHT;
    int32_t root = met ? scene_root_on(scene, hit.triangle, hit.front) : -1;
    if (root < 0)
        return met ? SIGHT_BACK : SIGHT_NOTHING;
    return material_is_dark(scene_root_material(scene, root)) ? SIGHT_BLACK : SIGHT_UNLIT;
}

/* Writes the box of the roots but for a sky, or of those with light. */
static void put_box(const struct run *run, bool lit, char *text, size_t size)
{
    const struct scene *scene = run->scene;
    struct vec3 low = {0.0, 0.0, 0.0}, high = low;
    bool none = true;
    for (int32_t root = 0; root < scene_root_count(scene); root++) {
        if (!(scene_root_own_area(scene, root) > 0.0) ||
            (lit && !(rgb_sum(run->solver->model.forest->radiosity[root]) > 0.0)))
            continue;
        struct triangle t = scene_root_triangle(scene, root);
        low = none ? triangle_low(&t) : vec3_least(low, triangle_low(&t));
        high = none ? triangle_high(&t) : vec3_most(high, triangle_high(&t));
        none = false;
    }
    low = scene_to_input(scene, low);
    high = scene_to_input(scene, high);
    snprintf(text, size, "x %.4g to %.4g, y %.4g to %.4g, z %.4g to %.4g", low.x, high.x,
             low.y, high.y, low.z, high.z);
}

/* True if no ray from a lamp meets the front of anything. */
static bool lamps_look_away(const struct run *run)
{
    const struct scene *scene = run->scene;
    struct octree_counts counts = {0};
    for (int32_t root = 0; root < scene_root_count(scene); root++) {
        if (!(scene_root_own_area(scene, root) > 0.0) ||
            !material_emits(scene_root_material(scene, root)))
            continue;
        struct triangle t = scene_root_triangle(scene, root);
        struct vec3 normal = scene_root_plane(scene, root).normal;
        for (int i = 0; i < LAMP_RAYS; i++) {
            struct half_line ray = ray_sample(&t, normal, hash_mix((uint64_t)i), 0, 1);
            if (root_met(scene, run->octree, &ray, OUTSIDE, &counts) >= 0)
                return false;
        }
    }
    return true;
}

/* Writes why no light comes to the surfaces in view. */
static void explain_unlit(const struct run *run, char *text, size_t size)
{
    const struct scene *scene = run->scene;
    bool lamps = false;
    char box[160];
    for (int32_t i = 0; i < scene->sky_first; i++)
        lamps = lamps ||
                (scene->areas[i] > 0.0 && material_emits(scene_root_material(scene, i)));
    if (!lamps && scene->sky_first == scene->input_count) {
        snprintf(text, size, "no light comes to what it shows");
    } else if (!lamps) {
        snprintf(text, size, "there is no lamp, and the sky of --sky does not get in%s%s",
                 *run->missing ? "; lamps may be in " : "", run->missing);
    } else if (lamps_look_away(run)) {
        snprintf(text, size, "the fronts of the lamps look away from all else: turn them "
                             "around, or try --two-sided-lamps");
    } else {
        put_box(run, true, box, sizeof box);
        snprintf(text, size, "no light comes to what it shows; lit are faces within %s",
                 box);
    }
}

/* Writes the reason for the most frequent sight. */
static void explain(const struct run *run, enum sight sight, char *text, size_t size)
{
    char box[160];
    put_box(run, false, box, sizeof box);
    switch (sight) {
    case SIGHT_NOTHING:
    case SIGHT_SKY:
        snprintf(text, size, "%s the scene, which lies within %s",
                 run->options.view_count > 0 ? "the camera looks past"
                                             : "a --view would show more of", box);
        break;
    case SIGHT_BACK:
        snprintf(text, size, "the camera sees the backs of faces, as from inside of a "
                             "thing or from behind a wall (see --two-sided); the scene "
                             "lies within %s", box);
        break;
    case SIGHT_BLACK:
        snprintf(text, size, "what it shows reflects nothing (Kd 0)");
        break;
    default: explain_unlit(run, text, size);
    }
}

void dark_warn(struct run *run, int view, const float *picture)
{
    const struct camera *camera = &run->cameras[view];
    enum show show = run->options.show;
    int counts[SIGHTS] = {0}, things = 0;
    char reason[400];
    if (show > SHOW_MESH)
        return;
    for (int i = 0; i < GRID * GRID; i++) {
        int x = (int)((i % GRID + 0.5) / GRID * camera->width);
        int y = (int)((i / GRID + 0.5) / GRID * camera->height);
        size_t at = (size_t)y * (size_t)camera->width + (size_t)x;
        counts[look(run, camera, x, y, picture + 3 * at)]++;
    }
    int dark = GRID * GRID - counts[SIGHT_LIGHT];
    if (dark < DARK * GRID * GRID)
        return;
    for (int sight = SIGHT_BACK; sight <= SIGHT_UNLIT; sight++)
        things += counts[sight];
    bool past = things < THINGS * dark;
    int most = past ? SIGHT_NOTHING : SIGHT_BACK;
    for (int sight = most; sight <= (past ? SIGHT_SKY : SIGHT_UNLIT); sight++)
        most = counts[sight] > counts[most] ? sight : most;
    explain(run, (enum sight)most, reason, sizeof reason);
    run_say(run, "warning: %s: %d %% of the picture is %s: %s",
            run->options.view_count > 0 ? run->options.views[view] : run->options.scene,
            100 * dark / (GRID * GRID), counts[SIGHT_SKY] > 0 ? "black or sky" : "black",
            reason);
}
