/* The camera of a scene without a view file.
 *
 * Room or object? From a grid of points in the box of the subject rays go out in 26
 * directions. Points seeing backs, or the dark, are inside an object or behind the walls;
 * points seeing lit fronts are free. If fewer than a tenth of the rays of free points
 * leave the scene, the scene is a room, else open: a box without its front, like
 * Cornell's, loses one ray in six. Skies are nothing.
 *
 * In a room, each free point is moved to eye height between the surfaces below and above,
 * and rates the views around. The best view is deep, by the sum of square roots of
 * distances, and rich: the material changes often from ray to ray. The roots keep a view
 * through a gap from beating one of the whole room, the materials an empty wall. Such an
 * eye is never behind a wall or in a cupboard, as fronts are seen from there, and deep
 * views begin at corners by themselves. Unlit surfaces do not count, so of several rooms
 * a lit one is chosen.
 *
 * Any other scene is seen whole, from the direction whose picture has the most lit fronts
 * without a back or twin before, and the most materials: of a street its road, of a box
 * its lamp. The front, a little aside and above, is taken unless another direction is
 * better; from further above where the subject is low, as a plan or a city; level where
 * the subject is a box, also a closed one hardly longer than high, too near to see from
 * within. Black backs are looked through.
 *
 * Rejected: a fixed corner of the bounding box, which is in a wall or a cupboard as often
 * as not; the brightest picture, which has to wait for the light and changes with
 * epsilon. */
#include "io/picture/viewpoint.h"

#include "geom/alloc.h"
#include "geom/elementary.h"
#include "geom/stop.h"

enum {
    GRID = 6,      /* points along a side of the bounding box */
    AZIMUTHS = 32, /* level directions from an eye */
    SIDES = 5,     /* that surfaces face */
    HALF = 3,      /* azimuths to either side of a view: 70 degrees in all */
    SLOPES = 5,    /* rays above and below each azimuth */
    SAMPLES = 16   /* rays along a side of a picture from outside */
};

static const double EYE_HEIGHT = 0.6;   /* between floor and ceiling */
static const double DOWN = 0.2;         /* slope of a view into a room */
static const double SLOPE[SLOPES] = {-0.8, -0.5, -0.2, 0.1, 0.4};
static const double VARIETY = 0.1;      /* added to the rating by a change of material */
static const double WIDE = 0.7;         /* tangent of half the wider angle in a room */
static const double OPEN_ROOM = 0.1, OPEN_BOX = 0.25; /* shares of lost rays */
static const double OUTSIDE_FOV = 40.0; /* degrees */
static const double SMALL = 1.25; /* length of a small box, relative to its height */
static const double FLAT = 0.5; /* height of a plan, relative to its shorter side */

/* The scene in which the choice is made. */
struct site {
    const struct scene *scene;
    const struct octree *octree;
    const struct forest *forest; /* or NULL */
    struct subject subject;
    bool has_materials; /* that differ */
};

/* Results of a ray: the distance of a front (> 0), or one of these. */
enum { BACK = 0, NOTHING = -1 };

/* Casts a ray; skies are nothing. Sets `*root` to the root whose front is met, or -1. */
static double look_at(const struct site *site, struct vec3 from, struct vec3 direction,
                      bool fronts_only, int32_t *root)
{
    struct octree_hit hit;
    struct octree_counts counts = {0};
    *root = -1;
    if (stop_is_asked() ||
        !octree_first_hit(site->octree, from, direction, fronts_only, &hit, &counts) ||
        subject_has_as_sky(&site->subject, site->scene, hit.triangle))
        return NOTHING;
    *root = scene_root_on(site->scene, hit.triangle, hit.front);
    if (*root < 0)
        return BACK;
    octree_hit_weights(site->octree, from, direction, &hit);
    const struct triangle *t = &site->scene->triangles[hit.triangle];
    struct vec3 weight = {hit.weight[0], hit.weight[1], hit.weight[2]};
    return vec3_length(vec3_sub(corners_mean(t->corner, weight), from));
}

static double look(const struct site *site, struct vec3 from, struct vec3 direction)
{
    int32_t root;
    return look_at(site, from, direction, false, &root);
}

/* False for a dark root, and for none. */
static bool is_lit(const struct site *site, int32_t root)
{
    return root >= 0 && (!site->forest || rgb_sum(site->forest->radiosity[root]) > 0.0);
}

/* Returns a direction from its parts along two level axes and up. */
static struct vec3 lift(const struct site *site, double right, double front, double up)
{
    return up_frame(site->subject.up, right, front, up);
}

/* Returns one of AZIMUTHS level directions, with a slope. Directions are even within 2
 * degrees; made without sine and cosine. */
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

static struct vec3 grid_point(const struct subject *subject, int cell)
{
    struct vec3 side = vec3_scale(vec3_sub(subject->high, subject->low), 1.0 / GRID);
    return vec3_add(subject->low, (struct vec3){(cell % GRID + 0.5) * side.x,
                                                (cell / GRID % GRID + 0.5) * side.y,
                                                (cell / (GRID * GRID) + 0.5) * side.z});
}

/* True if the point is free. Adds the rays from a free point to `*rays`, and the rays
 * leaving the scene to `*lost`. */
static bool is_free(const struct site *site, struct vec3 point, int *rays, int *lost)
{
    int fronts = 0, backs = 0, nothing = 0;
    for (int k = 0; k < 27; k++) {
        if (k == 13)
            continue;
        int32_t root;
        struct vec3 direction = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
        double met = look_at(site, point, direction, false, &root);
        fronts += is_lit(site, root);
        backs += met != NOTHING && !is_lit(site, root);
        nothing += met == NOTHING;
    }
    if (fronts < 4 * backs || fronts == 0)
        return false;
    *rays += fronts + backs + nothing;
    *lost += nothing;
    return true;
}

/* Returns the share of the rays from free points leaving the scene, 1 without any. */
static double find_openings(const struct site *site, bool free[GRID * GRID * GRID])
{
    int rays = 0, lost = 0;
    for (int cell = 0; cell < GRID * GRID * GRID; cell++)
        free[cell] = is_free(site, grid_point(&site->subject, cell), &rays, &lost);
    return rays > 0 ? (double)lost / rays : 1.0;
}

/* --- inside --- */

/* Moves a point to eye height between the surfaces straight below and above. */
static struct vec3 stand(const struct site *site, struct vec3 point)
{
    double below = look(site, point, lift(site, 0.0, 0.0, -1.0));
    double above = look(site, point, lift(site, 0.0, 0.0, 1.0));
    if (!(below > 0.0 && above > 0.0))
        return point;
    double rise = EYE_HEIGHT * (below + above) - below;
    return vec3_add(point, lift(site, 0.0, 0.0, rise));
}

/* Rates the rays above and below one azimuth by depth and variety. */
static double rate_azimuth(const struct site *site, struct vec3 eye, int k)
{
    double depth = 0.0;
    int32_t root, material = -1, before = -1;
    int changes = 0;
    for (int s = 0; s < SLOPES; s++) {
        double met = look_at(site, eye, azimuth(site, k, SLOPE[s]), false, &root);
        if (root >= 0)
            material = site->scene->material_of[scene_input_of(site->scene, root)];
        depth += is_lit(site, root) ? sqrt(met) : 0.0;
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
        struct vec3 point = stand(site, grid_point(&site->subject, cell));
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
    camera->fronts_only = false;
    camera->fov = 360.0 / PI * arctangent(WIDE * narrow, 1.0);
}

/* --- outside --- */

/* Returns the kind of a surface: its material, or where there is one only the side it
 * faces most, one of four or level. */
static int32_t kind_of(const struct site *site, int32_t root)
{
    struct vec3 normal = scene_root_plane(site->scene, root).normal;
    int up = (site->subject.up < 0 ? -site->subject.up : site->subject.up) - 1;
    int most = up;
    for (int axis = 0; axis < 3; axis++)
        if (fabs(vec3_axis(normal, axis)) > fabs(vec3_axis(normal, most)))
            most = axis;
    if (site->has_materials)
        return site->scene->material_of[scene_input_of(site->scene, root)];
    return most == up ? 4 : 2 * (most == (up == 0)) + (vec3_axis(normal, most) < 0.0);
}

/* True if there are several, but for those of skies. */
static bool has_materials(const struct site *site)
{
    const struct scene *scene = site->scene;
    int32_t first = -1;
    for (int32_t i = 0; i < scene->input_count; i++) {
        if (scene->areas[i] <= 0.0 || subject_has_as_sky(&site->subject, scene, i))
            continue;
        if (first >= 0 && scene->material_of[i] != first)
            return true;
        first = scene->material_of[i];
    }
    return false;
}

/* Returns the share of the kinds of surfaces, but for kinds of skies alone, met by `rays`
 * rays of a picture, each in full if it has a quarter of an equal part. */
static double rate_variety(const struct site *site, const int *met, int rays)
{
    const struct scene *scene = site->scene;
    int32_t kinds = scene->material_count + SIDES;
    bool *there = alloc_array((size_t)kinds, sizeof *there);
    double all = 0.0, some = 0.0;
    for (int32_t i = 0; i < scene->input_count; i++)
        if (scene->areas[i] > 0.0 && !subject_has_as_sky(&site->subject, scene, i))
            there[kind_of(site, i)] = true;
    for (int32_t k = 0; k < kinds; k++)
        all += there[k];
    for (int32_t k = 0; k < kinds; k++)
        some += real_min(1.0, 4.0 * all * met[k] / (rays > 0 ? rays : 1));
    alloc_free(there);
    return some / all;
}

/* Rates a picture by the rays that show a lit front, with nothing passed before; and by
 * its variety. */
static double rate(const struct site *site, const struct camera *camera)
{
    const struct scene *scene = site->scene;
    struct vec3 eye = scene_from_input(scene, camera->eye);
    int *met = alloc_array((size_t)scene->material_count + SIDES, sizeof *met);
    int rays = 0, lit = 0;
    for (int i = 0; i < SAMPLES * SAMPLES; i++) {
        double x = (i % SAMPLES + 0.5) / SAMPLES * camera->width;
        double y = (i / SAMPLES + 0.5) / SAMPLES * camera->height;
        struct vec3 direction = camera_ray(camera, x, y);
        int32_t first, shown;
        bool passes = look_at(site, eye, direction, false, &first) != NOTHING;
        bool shows =
            look_at(site, eye, direction, camera->fronts_only, &shown) != NOTHING;
        rays += passes || shows;
        if (!is_lit(site, shown))
            continue;
        met[kind_of(site, shown)]++;
        lit += !passes || first == shown;
    }
    double variety = rate_variety(site, met, rays);
    alloc_free(met);
    return rays > 0 ? (double)lit / rays + variety : 0.0;
}

enum shape { THING, PLAIN, BOX, SHAPES };

/* Finds the best of the views on the list for a shape. False if all are black. */
static bool stand_outside(const struct site *site, enum shape shape,
                          struct camera *camera)
{
    enum { SLOPED = 4, ASIDE = 6 };
    /* Looking down by 0.4 the horizon, where a sky ends, is out of the picture. */
    static const double FROM_ABOVE[SHAPES][SLOPED] = {
        {0.4, 0.0, 0.7, -0.4}, {0.7, 0.4, 0.0, -0.4}, {0.0, 0.4, 0.7, -0.4}};
    static const double LIKING[SLOPED] = {0.1, 0.0, 0.0, -0.5};
    struct camera chosen = *camera;
    double best = -1.0;
    bool lit = false;
    for (int i = 0; i < AZIMUTHS * SLOPED; i++) {
        int k = ASIDE + i / (2 * SLOPED) * 2, slope = i / 2 % SLOPED;
        camera->fronts_only = i % 2 == 0;
        camera_frame(camera, site->scene, &site->subject,
                     azimuth(site, k % AZIMUTHS, FROM_ABOVE[shape][slope]));
        double rating = rate(site, camera);
        lit = lit || rating > 0.0;
        rating += LIKING[slope] + (i < 2 ? 0.05 : 0.0);
        if (rating > best) {
            best = rating;
            chosen = *camera;
        }
    }
    *camera = chosen;
    return lit;
}

struct camera viewpoint_choose(const struct scene *scene, const struct octree *octree,
                               const struct forest *forest, int width, int height)
{
    struct site site = {.scene = scene, .octree = octree, .forest = forest,
                        .subject = subject_find(scene)};
    site.has_materials = has_materials(&site);
    struct vec3 side = vec3_sub(site.subject.high, site.subject.low);
    int up = (site.subject.up < 0 ? -site.subject.up : site.subject.up) - 1;
    double tall = vec3_axis(side, up), wide = vec3_axis(side, (up + 1) % 3),
           deep = vec3_axis(side, (up + 2) % 3);
    bool free[GRID * GRID * GRID];
    double open = find_openings(&site, free);
    bool is_small = !scene->two_sided && real_max(wide, deep) < SMALL * tall;
    bool is_flat = tall < FLAT * real_min(wide, deep);
    struct camera camera = {.up = lift(&site, 0.0, 0.0, 1.0),
                            .fov = OUTSIDE_FOV,
                            .width = width,
                            .height = height};
    bool inside = open < OPEN_ROOM && !is_small;
    enum shape shape = is_flat ? PLAIN : open < OPEN_BOX ? BOX : THING;
    if (inside || (!stand_outside(&site, shape, &camera) && open < 1.0))
        enter_room(&site, free, &camera);
    return camera;
}
