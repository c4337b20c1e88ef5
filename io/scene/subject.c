/* What is looked at, by the shapes alone.
 *
 * OBJ does not define the axis that is up. Lamps shine mostly down, skies, too: if along
 * -y, y is up, if along -z, z. Twins do not count, with which all lamps would shine both
 * ways. Else (tubes, windows, globes, no lamps) z is up if there is a floor across z, and
 * either none across y, or the scene is lowest along z, as rooms are. In all other cases
 * y is up, as in most files.
 *
 * Things are all faces but lamps and ground, the level faces at the bottom: a plain may
 * be much larger than the things on it. Of the ground a strip around the things is looked
 * at, half as wide as the things are high, for their shadows. Lamps are looked at, too,
 * unless enclosing the things, on all sides but the bottom: then lamps are the sky. */
#include "io/scene/subject.h"

static const double DOWN = 0.3;   /* share of a light going straight down; of a hemisphere
                                   * 1/2 */
static const double LEVEL = 0.99; /* cosine of the slope of ground */
static const double FLAT = 0.01;  /* height of ground, relative to the scene's */
static const double COVER = 0.5;  /* share of a box covered by a floor */
static const double STRIP = 0.5;  /* width of the strip of ground, relative to the height
                                   * of the things */

struct extent {
    struct vec3 low, high;
    bool is_empty;
};

static void box_add(struct extent *box, struct vec3 low, struct vec3 high)
{
    box->low = box->is_empty ? low : vec3_least(box->low, low);
    box->high = box->is_empty ? high : vec3_most(box->high, high);
    box->is_empty = false;
}

static double *axis_of(struct vec3 *v, int axis)
{
    return axis == 0 ? &v->x : axis == 1 ? &v->y : &v->z;
}

/* True if the face is a part of a floor at the bottom of the box. */
static bool is_floor(const struct scene *scene, int32_t i, const struct extent *box,
                     int up)
{
    const struct triangle *t = &scene->triangles[i];
    double facing = vec3_axis(triangle_plane(t).normal, up);
    double bottom = vec3_axis(box->low, up), height = vec3_axis(box->high, up) - bottom;
    return (facing > LEVEL || (facing < -LEVEL && scene_has_twin(scene, i))) &&
           vec3_axis(triangle_high(t), up) <= bottom + FLAT * height;
}

enum kind { LAMPS, THINGS, REST }; /* REST: things and ground */

/* Returns the box of the triangles of a kind. `rest`: the box of REST, for THINGS. */
static struct extent box_of(const struct scene *scene, enum kind kind,
                            const struct extent *rest, int up)
{
    struct extent box = {.is_empty = true};
    for (int32_t i = 0; i < scene->sky_first; i++) {
        bool emits = material_emits(scene_root_material(scene, i));
        if (triangle_is_degenerate(&scene->triangles[i]) || emits != (kind == LAMPS) ||
            (kind == THINGS && is_floor(scene, i, rest, up)))
            continue;
        const struct triangle *t = &scene->triangles[i];
        box_add(&box, triangle_low(t), triangle_high(t));
    }
    return box;
}

/* --- up --- */

static bool has_floor(const struct scene *scene, const struct extent *box, int up)
{
    struct vec3 side = vec3_sub(box->high, box->low);
    double area = 0.0;
    for (int32_t i = 0; i < scene->sky_first; i++)
        if (is_floor(scene, i, box, up))
            area += triangle_area(&scene->triangles[i]);
    return area > COVER * vec3_axis(side, (up + 1) % 3) * vec3_axis(side, (up + 2) % 3);
}

static bool find_up(const struct scene *scene, const struct extent *rest)
{
    struct vec3 side = vec3_sub(rest->high, rest->low), shine = {0.0, 0.0, 0.0};
    double power = 0.0;
    for (int32_t i = 0; i < scene->sky_first; i++) {
        const struct triangle *t = &scene->triangles[i];
        double emitted = rgb_sum(scene_root_material(scene, i)->emission);
        emitted *= triangle_area(t);
        if (!(emitted > 0.0) || triangle_is_degenerate(t))
            continue;
        shine = vec3_add(shine, vec3_scale(triangle_plane(t).normal, emitted));
        power += emitted;
    }
    if (-shine.y > DOWN * power || -shine.z > DOWN * power)
        return -shine.z > -shine.y;
    return has_floor(scene, rest, 2) &&
           (!has_floor(scene, rest, 1) || (side.z < side.x && side.z < side.y));
}

/* --- the sky, and the things --- */

/* True if the lamps reach beyond the box on all sides but the bottom. */
static bool encloses(const struct extent *lamps, const struct extent *box, int up)
{
    bool beyond = !lamps->is_empty;
    for (int axis = 0; axis < 3; axis++)
        beyond = beyond && vec3_axis(lamps->high, axis) > vec3_axis(box->high, axis) &&
                 (axis == up || vec3_axis(lamps->low, axis) < vec3_axis(box->low, axis));
    return beyond;
}

/* Adds the ground around a box of things. */
static void add_ground(struct extent *box, const struct extent *rest, int up)
{
    struct vec3 strip;
    double height = vec3_axis(box->high, up) - vec3_axis(rest->low, up);
    strip.x = strip.y = strip.z = STRIP * height;
    struct vec3 low = vec3_sub(box->low, strip), high = vec3_add(box->high, strip);
    low = vec3_most(low, rest->low);
    high = vec3_least(high, rest->high);
    *axis_of(&low, up) = *axis_of(&high, up) = vec3_axis(rest->low, up);
    box_add(box, low, high);
}

struct subject subject_find(const struct scene *scene)
{
    struct extent lamps = box_of(scene, LAMPS, NULL, 0), rest;
    rest = box_of(scene, REST, NULL, 0);
    if (rest.is_empty)
        rest = lamps;
    struct subject subject = {.z_up = find_up(scene, &rest)};
    int up = subject.z_up ? 2 : 1;
    struct extent things = box_of(scene, THINGS, &rest, up);
    if (things.is_empty)
        things = rest;
    subject.below_sky = encloses(&lamps, &things, up);
    if (!subject.below_sky && !lamps.is_empty)
        box_add(&things, lamps.low, lamps.high);
    add_ground(&things, &rest, up);
    subject.low = things.low;
    subject.high = things.high;
    return subject;
}

bool subject_has_as_sky(const struct subject *subject, const struct scene *scene,
                        int32_t triangle)
{
    const struct triangle *t = &scene->triangles[triangle];
    struct vec3 low = vec3_least(triangle_low(t), subject->low),
                high = vec3_most(triangle_high(t), subject->high);
    if (scene_is_sky(scene, triangle))
        return true;
    return subject->below_sky && material_emits(scene_root_material(scene, triangle)) &&
           !(vec3_is_equal(low, subject->low) && vec3_is_equal(high, subject->high));
}
