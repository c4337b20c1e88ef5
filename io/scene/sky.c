/* The sky is the upper half of an octahedron whose faces are cut in four some times, its
 * corners moved to a ball: all facets look about as large. As facets hide each other
 * nowhere, only the edge of the sky matters. At the height of the edge this is the
 * horizon; from a height h the sky begins h / radius below the horizon, and an upright
 * face gets too much by at most 1.3 of this.
 *
 * A facet has the mean radiance of its part of the sky, weighted by the cosine to the
 * zenith: so a level face receives what it would receive from the sky itself. The mean is
 * found over triangles small beside the patches of a table. Skies (CIE S
 * 011/E:2003, types 1 and 12 in their traditional forms):
 *
 *     overcast  L = Lz (1 + 2 cos z) / 3
 *     clear     L = Lz (.91 + 10 exp(-3 s) + .45 cos^2 s) (1 - exp(-.32 / cos z)) / the
 *               same at the zenith
 *
 * with z the angle to the zenith and s that to the sun; and tables (io/scene/skytable.h).
 *
 * The sun is a square of half a degree before the sky. Its radiosity is such that a
 * surface that faces it receives the irradiance asked for. */
#include "io/scene/sky.h"

#include "geom/alloc.h"
#include "geom/elementary.h"
#include "geom/lambert.h"
#include "io/scene/skytable.h"
#include "io/scene/subject.h"

enum {
    UNIFORM_LEVELS = 2,  /* of cutting faces of the octahedron */
    LEVELS = 3,          /* the same for skies that vary */
    MEAN_LEVELS = 6,     /* of cutting a facet for its mean */
    FACETS_MOST = (4 << 2 * LEVELS) + 2 /* with the sun */
};

static const double DISTANCE = 1024.0;  /* relative to half the diagonal of the scene */
static const double SUN_DISTANCE = 0.9; /* relative to that of the sky */
static const double SUN_SLOPE = 0.0043633508; /* tangent of a quarter of a degree */

static const double WHOLE = 1e-3; /* what a dome may lack of all directions */

/* The sky as it is made. */
struct dome {
    const struct sky *sky;
    const struct sky_table *table;
    struct vec3 up, east, north; /* of length 1 */
    struct vec3 sun;             /* towards it, of length 1 */
    struct vec3 centre;          /* of the bottom of the scene */
    double radius;
    struct triangle *facets;     /* [count] */
    struct rgb *radiosities;     /* [count], W/m^2 */
    int32_t count;
};

/* Returns the brightness of the clear sky relative to the one at the zenith, but for a
 * factor. */
static double clear_sky(double cos_zenith, double cos_sun)
{
    double sine = sqrt(real_max(0.0, 1.0 - cos_sun * cos_sun));
    double angle = arctangent(sine, cos_sun);
    double gradation = cos_zenith > 0.0 ? 1.0 - exponential(-0.32 / cos_zenith) : 1.0;
    return (0.91 + 10.0 * exponential(-3.0 * angle) + 0.45 * cos_sun * cos_sun) *
           gradation;
}

/* Returns the radiance of a direction of length 1, W/m^2/sr. */
static struct rgb radiance(const struct dome *dome, struct vec3 towards)
{
    struct rgb light = {{0.0, 0.0, 0.0}};
    double height = vec3_dot(towards, dome->up), factor = 1.0;
    if (dome->table)
        return sky_table_radiance(dome->table, vec3_dot(towards, dome->east),
                                  vec3_dot(towards, dome->north), height);
    if (dome->sky->kind == SKY_OVERCAST)
        factor = (1.0 + 2.0 * height) / 3.0;
    if (dome->sky->kind == SKY_CLEAR)
        factor = clear_sky(height, vec3_dot(towards, dome->sun)) /
                 clear_sky(1.0, vec3_dot(dome->up, dome->sun));
    rgb_add(&light, factor, dome->sky->level);
    return light;
}

static void move_out(struct triangle *part)
{
    for (int k = 0; k < 3; k++)
        part->corner[k] = vec3_unit(part->corner[k]);
}

/* Adds the radiance of a triangle of directions, by weight, and the weights. */
static void add_mean(const struct dome *dome, struct triangle part, int levels,
                     struct rgb *sum, double *weights)
{
    move_out(&part);
    if (levels > 0) {
        for (int k = 0; k < 4; k++)
            add_mean(dome, triangle_child(&part, k), levels - 1, sum, weights);
        return;
    }
    struct vec3 towards = vec3_unit(triangle_centroid(&part));
    double weight = triangle_area(&part) * vec3_dot(towards, dome->up);
    rgb_add(sum, weight, radiance(dome, towards));
    *weights += weight;
}

/* Adds the facets of a triangle of directions, which is seen from within. */
static void add_part(struct dome *dome, struct triangle part, int levels)
{
    move_out(&part);
    if (levels > 0) {
        for (int k = 0; k < 4; k++)
            add_part(dome, triangle_child(&part, k), levels - 1);
        return;
    }
    struct rgb *light = &dome->radiosities[dome->count];
    struct triangle *facet = &dome->facets[dome->count++];
    for (int k = 0; k < 3; k++)
        facet->corner[k] = vec3_add(dome->centre,
                                    vec3_scale(part.corner[k], dome->radius));
    if (dome->sky->kind == SKY_UNIFORM) {
        *light = dome->sky->level;
        return;
    }
    double weights = 0.0;
    struct rgb sum = {{0.0, 0.0, 0.0}};
    add_mean(dome, part, MEAN_LEVELS, &sum, &weights);
    *light = (struct rgb){{0.0, 0.0, 0.0}};
    rgb_add(light, PI / weights, sum);
}

static void add_dome(struct dome *dome)
{
    struct vec3 side = dome->east, other = vec3_cross(dome->up, side);
    for (int k = 0; k < 4; k++) {
        add_part(dome, (struct triangle){{dome->up, other, side}},
                 dome->sky->kind == SKY_UNIFORM ? UNIFORM_LEVELS : LEVELS);
        struct vec3 before = side;
        side = other;
        other = vec3_scale(before, -1.0);
    }
}

static void add_sun(struct dome *dome)
{
    double distance = SUN_DISTANCE * dome->radius, factor = 0.0;
    struct vec3 across = vec3_cross(dome->sun, fabs(dome->sun.x) < 0.6
                                                   ? (struct vec3){1.0, 0.0, 0.0}
                                                   : (struct vec3){0.0, 1.0, 0.0});
    across = vec3_scale(vec3_unit(across), SUN_SLOPE * distance);
    struct vec3 along = vec3_cross(across, dome->sun);
    struct vec3 middle = vec3_add(dome->centre, vec3_scale(dome->sun, distance));
    struct vec3 a = vec3_add(across, along), b = vec3_sub(across, along);
    struct vec3 corner[4] = {vec3_add(middle, a), vec3_add(middle, b),
                             vec3_sub(middle, a), vec3_sub(middle, b)};
    for (int k = 0; k < 2; k++) {
        struct triangle *facet = &dome->facets[dome->count + k];
        *facet = (struct triangle){{corner[0], corner[2 + k], corner[1 + k]}};
        factor += point_triangle_factor(dome->centre, dome->sun, facet);
    }
    double b_sun = dome->sky->sun_irradiance / factor;
    for (int k = 0; k < 2; k++)
        dome->radiosities[dome->count++] = (struct rgb){{b_sun, b_sun, b_sun}};
}

/* Places the dome around the scene. */
static void place(struct dome *dome, const struct scene *scene)
{
    int32_t axis = subject_find(scene).up;
    struct vec3 low = triangle_low(&scene->triangles[0]), high = low;
    for (int32_t i = 0; i < scene->input_count; i++) {
        low = vec3_least(low, triangle_low(&scene->triangles[i]));
        high = vec3_most(high, triangle_high(&scene->triangles[i]));
    }
    dome->up = up_frame(axis, 0.0, 0.0, 1.0);
    dome->east = up_frame(axis, 1.0, 0.0, 0.0);
    dome->north = up_frame(axis, 0.0, -1.0, 0.0);
    dome->radius = 0.5 * DISTANCE * vec3_length(vec3_sub(high, low));
    struct vec3 middle = vec3_middle(low, high);
    double bottom = real_min(vec3_dot(dome->up, low), vec3_dot(dome->up, high));
    double rise = bottom - vec3_dot(dome->up, middle);
    dome->centre = vec3_add(middle, vec3_scale(dome->up, rise));
}

bool sky_add(struct scene *scene, const struct sky *sky, struct error *error)
{
    struct dome dome = {.sky = sky};
    struct sky_table table = {.count = 0};
    place(&dome, scene);
    bool has_sun = vec3_length(sky->sun) > 0.0;
    if (has_sun)
        dome.sun = vec3_unit(sky->sun);
    if (has_sun && !(vec3_dot(dome.sun, dome.up) > 0.0))
        return error_set(error, EXIT_USAGE, "--sun: this sun is below the horizon");
    if (sky->kind == SKY_CLEAR && !has_sun)
        return error_set(error, EXIT_USAGE,
                         "--sky clear needs --sun x,y,z,W, W may be 0");
    if (sky->kind == SKY_TABLE && !sky_table_read(&table, sky->path, error))
        return false;
    dome.table = table.count > 0 ? &table : NULL;
    dome.facets = alloc_array(FACETS_MOST, sizeof *dome.facets);
    dome.radiosities = alloc_array(FACETS_MOST, sizeof *dome.radiosities);
    if (sky->kind != SKY_NONE)
        add_dome(&dome);
    if (sky->sun_irradiance > 0.0)
        add_sun(&dome);
    scene_add_sky(scene, dome.count, dome.facets, dome.radiosities);
    alloc_free(dome.radiosities);
    alloc_free(dome.facets);
    sky_table_free(&table);
    return true;
}

int32_t sky_of_dome(struct scene *scene, struct sky *sky)
{
    struct subject subject = subject_find(scene);
    struct vec3 up = up_frame(subject.up, 0.0, 0.0, 1.0);
    struct vec3 from = vec3_middle(subject.low, subject.high), kept = subject.low;
    double bottom = real_min(vec3_dot(up, subject.low), vec3_dot(up, subject.high));
    double above = 0.0, below = 0.0;
    const struct material *lamp = NULL;
    int32_t count = 0;
    from = vec3_add(from, vec3_scale(up, bottom - vec3_dot(up, from)));
    for (int32_t i = 0; i < scene->input_count; i++) {
        const struct material *m = scene_root_material(scene, i);
        if (!material_emits(m))
            continue;
        if (rgb_sum(m->reflectance) > 0.0 || (lamp && !material_is_same(m, lamp)))
            return 0;
        lamp = m;
        above += point_triangle_factor(from, up, &scene->triangles[i]);
        below += point_triangle_factor(from, vec3_scale(up, -1.0), &scene->triangles[i]);
    }
    if (!subject.below_sky || fabs(above - 1.0) > WHOLE || below > WHOLE)
        return 0;
    *sky = (struct sky){.kind = SKY_UNIFORM, .level = lamp->emission, .sun = sky->sun,
                        .sun_irradiance = sky->sun_irradiance};
    for (int32_t i = 0; i < scene->input_count; i++)
        if (material_emits(scene_root_material(scene, i))) {
            scene->triangles[i] = (struct triangle){{kept, kept, kept}};
            count++;
        }
    return count;
}
