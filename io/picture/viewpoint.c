/* The camera of a scene without a view file.
 *
 * Room or object? From a grid of points in the bounding box rays go out in 26 directions.
 * Points that see backs are inside an object or behind the walls; points that see fronts
 * are free. If fewer than a tenth of the rays of free points leave the scene, it is a
 * room, else it is open: a box without its front, like Cornell's, loses one ray in six.
 *
 * In a room, each free point is moved to eye height between the surfaces below and above
 * it, and rates the views around. The best view is deep, by the sum of square roots of
 * distances, and rich: the material changes often from ray to ray. The roots keep a view
 * through a gap from beating one of the whole room, the materials an empty wall. Such an
 * eye is never behind a wall or in a cupboard, as it sees fronts, and deep views begin at
 * corners by themselves. Unlit surfaces do not count, so that of several rooms a lit one
 * is chosen.
 *
 * An open scene is seen whole, from the direction with the fewest backs in the picture;
 * the front, a little aside and above, is taken unless another direction is clearly
 * better.
 *
 * OBJ does not define the axis that is up. Lamps shine mostly down: if they shine along
 * -y, y is up, along -z, z. Twins do not count, with which all of them would shine both
 * ways. Else (tubes, windows, globes) a room is assumed wider than high: z is up if it is
 * the shortest side of the box. In all other cases y is up, as in most files.
 *
 * Rejected: a fixed corner of the bounding box, which is in a wall or a cupboard as often
 * as not; the brightest picture, which has to wait for the light and changes with
 * epsilon. */
#include "io/picture/viewpoint.h"

#include "geom/elementary.h"
#include "geom/stop.h"

enum {
    GRID = 6,      /* points along a side of the bounding box */
    AZIMUTHS = 32, /* level directions from an eye */
    HALF = 3,      /* azimuths to either side of a view: 70 degrees in all */
    SLOPES = 5,    /* rays above and below each azimuth */
    SAMPLES = 16   /* rays along a side of a picture from outside */
};

static const double EYE_HEIGHT = 0.6;   /* between floor and ceiling */
static const double DOWN = 0.2;         /* slope of a view into a room */
static const double SLOPE[SLOPES] = {-0.8, -0.5, -0.2, 0.1, 0.4};
static const double VARIETY = 0.1;      /* added to the rating by a change of material */
static const double WIDE = 0.7;         /* tangent of half the wider angle in a room */
static const double OUTSIDE_FOV = 40.0; /* degrees */

/* The scene in which the choice is made. */
struct site {
    const struct scene *scene;
    const struct octree *octree;
    const struct forest *forest; /* or NULL */
    bool z_up;
};

/* Results of a ray: the distance of a front (> 0), or one of these. */
enum { BACK = 0, NOTHING = -1 };

/* Casts a ray. Sets `*triangle` to the triangle that it meets, if any. */
static double look_at(const struct site *site, struct vec3 from, struct vec3 direction,
                      int32_t *triangle)
{
    struct octree_hit hit;
    struct octree_counts counts = {0};
    if (stop_is_asked() ||
        !octree_first_hit(site->octree, from, direction, false, &hit, &counts))
        return NOTHING;
    *triangle = hit.triangle;
    if (scene_root_on(site->scene, hit.triangle, hit.front) < 0)
        return BACK;
    octree_hit_weights(site->octree, from, direction, &hit);
    const struct triangle *t = &site->scene->triangles[hit.triangle];
    struct vec3 weight = {hit.weight[0], hit.weight[1], hit.weight[2]};
    return vec3_length(vec3_sub(corners_mean(t->corner, weight), from));
}

static double look(const struct site *site, struct vec3 from, struct vec3 direction)
{
    int32_t triangle;
    return look_at(site, from, direction, &triangle);
}

/* Returns a direction from its parts along two level axes and up. */
static struct vec3 lift(const struct site *site, double right, double front, double up)
{
    return site->z_up ? (struct vec3){right, -front, up}
                      : (struct vec3){right, up, front};
}

/* Returns one of AZIMUTHS level directions, with a slope. They are even within 2 degrees;
 * made without sine and cosine. */
static struct vec3 azimuth(const struct site *site, int k, double slope)
{
    static const double QUARTER[AZIMUTHS / 4][2] = {{5, 0}, {5, 1}, {5, 2}, {3, 2},
                                                    {1, 1}, {2, 3}, {2, 5}, {1, 5}};
    const double *part = QUARTER[k % (AZIMUTHS / 4)];
    double x = part[0], y = part[1], length = sqrt(x * x + y * y);
    for (int turn = k / (AZIMUTHS / 4); turn > 0; turn--) {
        double kept = x;
        x = -y;
        y = kept;
    }
    return lift(site, x / length, y / length, slope);
}

/* --- room or object --- */

static struct vec3 grid_point(const struct scene *scene, int cell)
{
    struct vec3 side = vec3_scale(vec3_sub(scene->high, scene->low), 1.0 / GRID);
    return vec3_add(scene->low, (struct vec3){(cell % GRID + 0.5) * side.x,
                                              (cell / GRID % GRID + 0.5) * side.y,
                                              (cell / (GRID * GRID) + 0.5) * side.z});
}

/* True if the point is free. Adds the rays from a free point to `*rays`, and those that
 * leave the scene to `*lost`. */
static bool is_free(const struct site *site, struct vec3 point, int *rays, int *lost)
{
    int fronts = 0, backs = 0, nothing = 0;
    for (int k = 0; k < 27; k++) {
        if (k == 13)
            continue;
        double met =
            look(site, point, (struct vec3){k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1});
        fronts += met > 0.0;
        backs += met == BACK;
        nothing += met == NOTHING;
    }
    if (fronts < 4 * backs || fronts == 0)
        return false;
    *rays += fronts + backs + nothing;
    *lost += nothing;
    return true;
}

static bool find_room(const struct site *site, bool free[GRID * GRID * GRID])
{
    int rays = 0, lost = 0;
    for (int cell = 0; cell < GRID * GRID * GRID; cell++)
        free[cell] = is_free(site, grid_point(site->scene, cell), &rays, &lost);
    return lost < rays / 10;
}

static bool find_up(const struct scene *scene, bool is_room)
{
    struct vec3 side = vec3_sub(scene->high, scene->low), shine = {0.0, 0.0, 0.0};
    double power = 0.0;
    for (int32_t i = 0; i < scene->input_count; i++) {
        double emitted =
            scene->areas[i] * rgb_sum(scene_root_material(scene, i)->emission);
        shine = vec3_add(shine, vec3_scale(scene->planes[i].normal, emitted));
        power += emitted;
    }
    if (-shine.y > 0.5 * power)
        return false;
    return -shine.z > 0.5 * power || (is_room && side.z < side.x && side.z < side.y);
}

/* --- inside --- */

/* Moves a point to eye height between the surfaces straight below and above it. */
static struct vec3 stand(const struct site *site, struct vec3 point)
{
    double below = look(site, point, lift(site, 0.0, 0.0, -1.0));
    double above = look(site, point, lift(site, 0.0, 0.0, 1.0));
    if (!(below > 0.0 && above > 0.0))
        return point;
    double rise = EYE_HEIGHT * (below + above) - below;
    return vec3_add(point, lift(site, 0.0, 0.0, rise));
}

static bool is_lit(const struct site *site, int32_t triangle)
{
    const struct forest *forest = site->forest;
    int32_t twin = scene_root_on(site->scene, triangle, false);
    return !forest || rgb_sum(forest->radiosity[triangle]) > 0.0 ||
           (twin >= 0 && rgb_sum(forest->radiosity[twin]) > 0.0);
}

/* Rates the rays above and below one azimuth by depth and variety. */
static double rate_azimuth(const struct site *site, struct vec3 eye, int k)
{
    double depth = 0.0;
    int32_t triangle = 0, before = 0;
    int changes = 0;
    for (int s = 0; s < SLOPES; s++) {
        double met = look_at(site, eye, azimuth(site, k, SLOPE[s]), &triangle);
        int32_t material = site->scene->material_of[triangle];
        depth += met > 0.0 && is_lit(site, triangle) ? sqrt(met) : 0.0;
        changes += s > 0 && material != before;
        before = material;
    }
    return depth * (1.0 + VARIETY * changes);
}

/* Finds the best azimuth from `eye`. The middle of a view counts most. Returns the
 * rating. */
static double look_around(const struct site *site, struct vec3 eye, int *best)
{
    double rating[AZIMUTHS], highest = -1.0;
    for (int k = 0; k < AZIMUTHS; k++)
        rating[k] = rate_azimuth(site, eye, k);
    for (int k = 0; k < AZIMUTHS; k++) {
        double sum = 0.0;
        for (int i = -HALF; i <= HALF; i++)
            sum += (HALF + 1 - (i < 0 ? -i : i)) * rating[(k + i + AZIMUTHS) % AZIMUTHS];
        if (sum > highest) {
            highest = sum;
            *best = k;
        }
    }
    return highest;
}

static void enter_room(const struct site *site, const bool free[GRID * GRID * GRID],
                       struct camera *camera)
{
    struct vec3 eye = {0.0, 0.0, 0.0};
    double best = -1.0;
    int towards = 0;
    for (int cell = 0; cell < GRID * GRID * GRID; cell++) {
        if (!free[cell])
            continue;
        struct vec3 point = stand(site, grid_point(site->scene, cell));
        int k = 0;
        double rating = look_around(site, point, &k);
        if (rating > best) {
            best = rating;
            eye = point;
            towards = k;
        }
    }
    double narrow =
        camera->width > camera->height ? (double)camera->height / camera->width : 1.0;
    camera->eye = scene_to_input(site->scene, eye);
    camera->at =
        scene_to_input(site->scene, vec3_add(eye, azimuth(site, towards, -DOWN)));
    camera->fov = 360.0 / PI * arctangent(WIDE * narrow, 1.0);
}

/* --- outside --- */

/* Returns the rays that meet a front less those that meet a back, over the number of
 * both. */
static double rate(const struct site *site, const struct camera *camera)
{
    struct vec3 eye = scene_from_input(site->scene, camera->eye);
    int fronts = 0, backs = 0;
    for (int i = 0; i < SAMPLES * SAMPLES; i++) {
        double x = (i % SAMPLES + 0.5) / SAMPLES * camera->width;
        double y = (i / SAMPLES + 0.5) / SAMPLES * camera->height;
        double met = look(site, eye, camera_ray(camera, x, y));
        fronts += met > 0.0;
        backs += met == BACK;
    }
    return fronts + backs > 0 ? (double)(fronts - backs) / (fronts + backs) : -1.0;
}

static void stand_outside(const struct site *site, struct camera *camera)
{
    enum { ELEVATIONS = 4, ASIDE = 6, CLEARLY = 20 };
    static const double ELEVATION[ELEVATIONS] = {0.35, 0.0, 0.9, -0.35};
    struct camera chosen = *camera;
    double best = -2.0;
    for (int i = 0; i < AZIMUTHS / 2 * ELEVATIONS; i++) {
        int k = (ASIDE + 2 * (i / ELEVATIONS)) % AZIMUTHS;
        camera_frame(camera, site->scene, azimuth(site, k, ELEVATION[i % ELEVATIONS]));
        double rating = rate(site, camera) + (i == 0 ? 1.0 / CLEARLY : 0.0);
        if (rating > best) {
            best = rating;
            chosen = *camera;
        }
    }
    *camera = chosen;
}

struct camera viewpoint_choose(const struct scene *scene, const struct octree *octree,
                               const struct forest *forest, int width, int height)
{
    struct site site = {.scene = scene, .octree = octree, .forest = forest};
    bool free[GRID * GRID * GRID];
    bool is_room = find_room(&site, free);
    site.z_up = find_up(scene, is_room);
    struct camera camera = {.up = lift(&site, 0.0, 0.0, 1.0),
                            .fov = OUTSIDE_FOV,
                            .width = width,
                            .height = height,
                            .fronts_only = !is_room};
    if (is_room)
        enter_room(&site, free, &camera);
    else
        stand_outside(&site, &camera);
    return camera;
}
