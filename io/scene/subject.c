/* What is looked at, by the shapes alone.
 *
 * OBJ does not define the axis that is up. Lamps shine mostly down, skies, too: if along
 * -y, y is up, if along -z, z. Twins do not count, with which all lamps would shine both
 * ways. Else (tubes, windows, globes, no lamps) z is up if there is a floor across z, and
 * either none across y, or the scene is lowest along z, as rooms are. Without a floor on
 * either axis the sum of all faces as vectors counts: solids, and leaves facing
 * anywhere, add nothing to it, and ground, streets and roofs of a city point up. Then
 * lamps near the top along one axis hang below ceilings; then the program that wrote the
 * file, if it is one in which z is up. In all other cases y is up, as in most files.
 *
 * Things are all faces but lamps and ground, the level faces at the bottom: a plain may
 * be much larger than the things on it. Of the ground a strip around the things is looked
 * at, half as wide as the things are high, for their shadows. Lamps are looked at, too,
 * unless enclosing the things, on all sides but the bottom: then lamps are the sky. */
#include "io/scene/subject.h"

#include <math.h>
#include <string.h>

static const double DOWN = 0.3;   /* share of a light going straight down; of a hemisphere
                                   * 1/2 */
static const double LEVEL = 0.99; /* cosine of the slope of ground */
static const double FLAT = 0.01;  /* height of ground, relative to the scene's */
static const double COVER = 0.5;  /* share of a box covered by a floor */
static const double NET = 0.1; /* sum of faces as vectors, relative to a floor's */
static const double NET_ALONG = 0.9; /* cosine of it to an axis */
static const double TOP = 0.7; /* height of lamps below ceilings, relative to the box */
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
                     int32_t up)
{
    const struct triangle *t = &scene->triangles[i];
    double facing = up_height(up, triangle_plane(t).normal);
    double low = up_height(up, box->low), high = up_height(up, box->high);
    double bottom = low < high ? low : high, top = -HUGE_VAL;
    for (int k = 0; k < 3; k++)
        top = real_max(top, up_height(up, t->corner[k]));
    return (facing > LEVEL || (facing < -LEVEL && scene_has_twin(scene, i))) &&
           top <= bottom + FLAT * fabs(high - low);
}

enum kind { LAMPS, THINGS, REST }; /* REST: things and ground */

/* Returns the box of the triangles of a kind. `rest`: the box of REST, for THINGS. */
static struct extent box_of(const struct scene *scene, enum kind kind,
                            const struct extent *rest, int32_t up)
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

/* The area of the box across an axis. */
static double across(const struct extent *box, int32_t up)
{
    struct vec3 side = vec3_sub(box->high, box->low);
    return vec3_axis(side, up % 3) * vec3_axis(side, (up + 1) % 3);
}

static bool has_floor(const struct scene *scene, const struct extent *box, int32_t up)
{
    double area = 0.0;
    for (int32_t i = 0; i < scene->sky_first; i++)
        if (is_floor(scene, i, box, up))
            area += triangle_area(&scene->triangles[i]);
    return area > COVER * across(box, up);
}

/* Sums over all faces. */
struct sums {
    struct vec3 faces; /* normal times area */
    struct vec3 shine; /* the same times emission */
    struct vec3 lamps; /* centroid times area times emission */
    double power;      /* area times emission */
};

static struct sums sum_up(const struct scene *scene)
{
    struct sums sums = {.power = 0.0};
    for (int32_t i = 0; i < scene->sky_first; i++) {
        const struct triangle *t = &scene->triangles[i];
        if (triangle_is_degenerate(t))
            continue;
        double area = triangle_area(t);
        double emitted = area * rgb_sum(scene_root_material(scene, i)->emission);
        struct vec3 normal = triangle_plane(t).normal;
        sums.faces = vec3_add(sums.faces, vec3_scale(normal, area));
        sums.shine = vec3_add(sums.shine, vec3_scale(normal, emitted));
        sums.lamps = vec3_add(sums.lamps, vec3_scale(triangle_centroid(t), emitted));
        sums.power += emitted;
    }
    return sums;
}

/* Returns the height of the lamps along an axis, 0 at the bottom of the box, 1 at the
 * top; 0 without lamps. */
static double lamps_at(const struct sums *sums, const struct extent *box, int32_t up)
{
    double low = up_height(up, box->low), high = up_height(up, box->high);
    return sums->power > 0.0 ? (up_height(up, sums->lamps) / sums->power - low) /
                                   (high - low) : 0.0;
}

int32_t subject_guess_up(const struct scene *scene, const char *words,
                         const char **reason)
{
    static const char *const Z_UP[] = {"FreeCAD", "OpenSCAD", "Rhino", "Revit",
                                       "CityGML"};
    enum { Y = 2, Z = 3 };
    struct extent box = box_of(scene, REST, NULL, 0);
    box = box.is_empty ? box_of(scene, LAMPS, NULL, 0) : box;
    struct vec3 side = vec3_sub(box.high, box.low);
    struct sums sums = sum_up(scene);
    *reason = "lamps shine down";
    if (-sums.shine.y > DOWN * sums.power || -sums.shine.z > DOWN * sums.power)
        return -sums.shine.z > -sums.shine.y ? Z : Y;
    bool y_floor = has_floor(scene, &box, Y), z_floor = has_floor(scene, &box, Z);
    *reason = "a floor lies across it";
    if (z_floor && (!y_floor || (side.z < side.x && side.z < side.y)))
        return Z;
    if (y_floor)
        return Y;
    *reason = "more faces look that way than any other";
    struct vec3 net = sums.faces;
    double y = net.y / across(&box, Y), z = net.z / across(&box, Z);
    double most = NET_ALONG * vec3_length(net);
    if ((y > NET && net.y > most) || (z > NET && net.z > most))
        return z > y ? Z : Y;
    *reason = "lamps hang near the top";
    y = lamps_at(&sums, &box, Y);
    z = lamps_at(&sums, &box, Z);
    if (y > TOP || z > TOP)
        return z > y ? Z : Y;
    *reason = "as in files of the program that made this one";
    for (size_t i = 0; i < sizeof Z_UP / sizeof Z_UP[0]; i++)
        if (strstr(words, Z_UP[i]))
            return Z;
    *reason = "as in most files, for nothing in this one says otherwise";
    return Y;
}

/* --- the sky, and the things --- */

/* True if the lamps reach beyond the box on all sides but the bottom. */
static bool encloses(const struct extent *lamps, const struct extent *box, int32_t up)
{
    bool beyond = !lamps->is_empty;
    for (int axis = 0; axis < 3; axis++) {
        bool high = vec3_axis(lamps->high, axis) > vec3_axis(box->high, axis);
        bool low = vec3_axis(lamps->low, axis) < vec3_axis(box->low, axis);
        beyond = beyond && (high || up == -axis - 1) && (low || up == axis + 1);
    }
    return beyond;
}

/* Adds the ground around a box of things. */
static void add_ground(struct extent *box, const struct extent *rest, int32_t up)
{
    struct vec3 strip;
    int axis = up < 0 ? -up - 1 : up - 1;
    double height = up < 0 ? vec3_axis(rest->high, axis) - vec3_axis(box->low, axis)
                           : vec3_axis(box->high, axis) - vec3_axis(rest->low, axis);
    strip.x = strip.y = strip.z = STRIP * height;
    struct vec3 low = vec3_sub(box->low, strip), high = vec3_add(box->high, strip);
    low = vec3_most(low, rest->low);
    high = vec3_least(high, rest->high);
    *axis_of(&low, axis) = *axis_of(&high, axis) =
        vec3_axis(up < 0 ? rest->high : rest->low, axis);
    box_add(box, low, high);
}

struct subject subject_find(const struct scene *scene)
{
    struct extent lamps = box_of(scene, LAMPS, NULL, 0), rest;
    const char *reason;
    int32_t up = scene->up ? scene->up : subject_guess_up(scene, "", &reason);
    struct subject subject = {.up = up};
    rest = box_of(scene, REST, NULL, 0);
    if (rest.is_empty)
        rest = lamps;
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
