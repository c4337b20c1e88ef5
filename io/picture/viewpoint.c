/* The camera of a scene without a view file.
 *
 * Inside or outside? From a grid of points in the box of the subject rays go out in 26
 * directions. A point with lit fronts all around is free; one seeing backs, or the dark,
 * is inside an object or behind a wall. If fewer than a tenth of the rays of free points
 * leave the scene, the scene is a room, and its views are those from the free points, at
 * eye height. The views of any other scene are frames of the whole subject, from outside,
 * through black backs; a scene dark from everywhere outside is a room, too. Cornell's
 * box, open in front, loses one ray in six. Skies are nothing.
 *
 * Of all views the best has most light, depth and variety: for each kind of surface (one
 * material, facing one way) the distances of the lit fronts of that kind are summed over
 * a few rays, and the square roots of these sums added up. So a box is seen through its
 * open side, a street along its road, a plan from above, a room from a corner, and a lamp
 * from its front. Lit fronts behind a back do not count.
 *
 * Rejected: a fixed corner of the bounding box, which is in a wall or a cupboard as often
 * as not; the brightest picture, which has to wait for the light and changes with
 * epsilon. */
#include "io/picture/viewpoint.h"

#include "geom/alloc.h"
#include "geom/stop.h"

enum {
    GRID = 6,      /* points along a side of the box of the subject */
    AZIMUTHS = 16, /* level directions of views */
    SAMPLES = 8,   /* rays along a side of a picture */
    SIDES = 6      /* that a surface of one material may face */
};

static const double DARK = 1e-3;      /* relative to the mean radiosity */
static const double OPEN = 0.1;       /* share of rays lost by an open scene */
static const double EYE_HEIGHT = 0.6; /* between floor and ceiling */
static const double DOWN = 0.2;       /* slope of a view into a room */
static const double WIDE = 65.0;      /* fov in a room, degrees */
static const double NARROW = 40.0;    /* fov from outside, degrees */
/* Slopes to the eye outside. By 0.4 the horizon of a sky is above the picture. */
static const double SLOPE[] = {0.6, 0.0, -0.6};
static const double BETTER = 1.25;    /* than a view earlier on the list */

/* The scene in which the choice is made. */
struct site {
    const struct scene *scene;
    const struct octree *octree;
    const struct forest *forest; /* or NULL */
    struct subject subject;
    double dark;                 /* radiosity of surfaces without light, W/m^2 */
};

/* Returns the mean radiosity of all but a sky, over all bands, W/m^2. */
static double mean_light(const struct scene *scene, const struct forest *forest)
{
    double light = 0.0;
    for (int32_t i = 0; i < scene_root_count(scene); i++)
        light += scene_root_own_area(scene, i) * rgb_sum(forest->radiosity[i]);
    return light / scene_own_area(scene);
}

/* A ray's first surface. */
struct glance {
    bool met;        /* anything but a sky */
    int32_t root;    /* whose lit front it is, or -1 */
    double distance; /* of a front, scene units */
};

static struct glance look(const struct site *site, struct vec3 from,
                          struct vec3 direction)
{
    struct octree_hit hit;
    struct octree_counts counts = {0};
    struct glance glance = {.root = -1};
    const struct scene *scene = site->scene;
    if (stop_is_asked() ||
        !octree_first_hit(site->octree, from, direction, false, &hit, &counts) ||
        subject_has_as_sky(&site->subject, scene, hit.triangle))
        return glance;
    glance.met = true;
    int32_t root = scene_root_on(scene, hit.triangle, hit.front);
    if (root < 0 ||
        (site->forest && !(rgb_sum(site->forest->radiosity[root]) > site->dark)))
        return glance;
    octree_hit_weights(site->octree, from, direction, &hit);
    struct vec3 weight = {hit.weight[0], hit.weight[1], hit.weight[2]};
    struct vec3 point = corners_mean(scene->triangles[hit.triangle].corner, weight);
    glance.root = root;
    glance.distance = vec3_length(vec3_sub(point, from));
    return glance;
}

/* Returns a direction from its parts along two level axes and up. */
static struct vec3 lift(const struct site *site, double right, double front, double up)
{
    return up_frame(site->subject.up, right, front, up);
}

/* Returns one of AZIMUTHS level directions, with a slope; the first is a little beside
 * the front. They are even within 5 degrees; made without sine and cosine. */
static struct vec3 azimuth(const struct site *site, int k, double slope)
{
    static const double QUARTER[AZIMUTHS / 4][2] = {{1, 2}, {1, 1}, {2, 1}, {1, 0}};
    double x = QUARTER[k % (AZIMUTHS / 4)][0], y = QUARTER[k % (AZIMUTHS / 4)][1];
    double length = sqrt(x * x + y * y);
    for (int turn = k / (AZIMUTHS / 4); turn > 0; turn--) {
        double kept = x;
        x = y;
        y = -kept;
    }
    return lift(site, x / length, y / length, slope);
}

/* Returns the kind of a root: its material, and the side it faces most. */
static int32_t kind_of(const struct scene *scene, int32_t root)
{
    struct vec3 normal = scene_root_plane(scene, root).normal;
    int most = 0;
    for (int axis = 1; axis < 3; axis++)
        if (fabs(vec3_axis(normal, axis)) > fabs(vec3_axis(normal, most)))
            most = axis;
    int side = 2 * most + (vec3_axis(normal, most) < 0.0);
    return SIDES * scene->material_of[scene_input_of(scene, root)] + side;
}

/* Rates a picture; 0 if it shows no light. */
static double rate(const struct site *site, const struct camera *camera)
{
    int32_t kinds = SIDES * site->scene->material_count;
    double *depth = alloc_array((size_t)kinds, sizeof *depth), sum = 0.0;
    struct camera_basis basis = camera_basis_of(camera);
    struct vec3 eye = scene_from_input(site->scene, camera->eye);
    for (int i = 0; i < SAMPLES * SAMPLES; i++) {
        double x = (i % SAMPLES + 0.5) / SAMPLES * camera->width;
        double y = (i / SAMPLES + 0.5) / SAMPLES * camera->height;
        struct glance glance = look(site, eye, camera_basis_ray(&basis, x, y));
        if (glance.root >= 0)
            depth[kind_of(site->scene, glance.root)] += glance.distance;
    }
    for (int32_t k = 0; k < kinds; k++)
        sum += sqrt(depth[k]);
    alloc_free(depth);
    return sum;
}

/* --- inside or outside --- */

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
    int fronts = 0, nothing = 0;
    for (int k = 0; k < 27; k++) {
        if (k == 13)
            continue;
        struct vec3 direction = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
        struct glance glance = look(site, point, direction);
        fronts += glance.root >= 0;
        nothing += !glance.met;
    }
    if (fronts == 0 || fronts < 4 * (26 - fronts - nothing))
        return false;
    *rays += 26;
    *lost += nothing;
    return true;
}

/* Moves a free point to eye height between the surfaces straight below and above. False
 * if that is in another cell, whose point has it. */
static bool stand(const struct site *site, struct vec3 *point)
{
    struct glance below = look(site, *point, lift(site, 0.0, 0.0, -1.0));
    struct glance above = look(site, *point, lift(site, 0.0, 0.0, 1.0));
    if (below.root < 0 || above.root < 0)
        return true;
    double rise = EYE_HEIGHT * (below.distance + above.distance) - below.distance;
    *point = vec3_add(*point, lift(site, 0.0, 0.0, rise));
    double cell = up_height(site->subject.up,
                            vec3_sub(site->subject.high, site->subject.low)) / GRID;
    return 2.0 * fabs(rise) <= fabs(cell);
}

static void look_from_inside(const struct site *site, const bool *free,
                             struct camera *camera)
{
    double best = -1.0;
    struct camera view = *camera;
    view.fronts_only = false;
    view.fov = WIDE;
    for (int cell = 0; cell < GRID * GRID * GRID; cell++) {
        struct vec3 eye = grid_point(&site->subject, cell);
        if (!free[cell] || !stand(site, &eye))
            continue;
        view.eye = scene_to_input(site->scene, eye);
        for (int k = 0; k < AZIMUTHS; k++) {
            view.at = scene_to_input(site->scene, vec3_add(eye, azimuth(site, k, -DOWN)));
            double rating = rate(site, &view);
            if (rating > best) {
                best = rating;
                *camera = view;
            }
        }
    }
}

/* Takes the first view of all that are not clearly worse. False if all are dark. */
static bool look_from_outside(const struct site *site, struct camera *camera)
{
    double best = -1.0;
    struct camera view = *camera;
    for (size_t slope = 0; slope < sizeof SLOPE / sizeof SLOPE[0]; slope++)
        for (int k = 0; k < AZIMUTHS; k++) {
            camera_frame(&view, site->scene, &site->subject,
                         azimuth(site, k, SLOPE[slope]));
            double rating = rate(site, &view);
            if (rating > BETTER * best) {
                best = rating;
                *camera = view;
            }
        }
    return best > 0.0;
}

struct camera viewpoint_choose(const struct scene *scene, const struct octree *octree,
                               const struct forest *forest, int width, int height)
{
    struct site site = {.scene = scene, .octree = octree, .forest = forest,
                        .subject = subject_find(scene)};
    struct camera camera = {.up = lift(&site, 0.0, 0.0, 1.0), .fov = NARROW,
                            .width = width, .height = height,
                            .fronts_only = !scene->two_sided};
    bool free[GRID * GRID * GRID];
    site.dark = forest ? DARK * mean_light(scene, forest) : 0.0;
    int rays = 0, lost = 0;
    for (int cell = 0; cell < GRID * GRID * GRID; cell++)
        free[cell] = is_free(&site, grid_point(&site.subject, cell), &rays, &lost);
    if (lost < OPEN * rays || (!look_from_outside(&site, &camera) && rays > 0))
        look_from_inside(&site, free, &camera);
    return camera;
}
