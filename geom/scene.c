/* Preparation of the scene.
 *
 * Scaling by a power of two is exact, so a scene scaled by 2^k gives the same bits in
 * scene units, and no threshold of the program has to know how large the scene is. Moving
 * the centre to the origin costs one rounding per coordinate and saves the digits eaten
 * by a large offset. Shared vertices stay shared: equal inputs give equal outputs. */
#include "geom/scene.h"

#include <string.h>

#include "geom/alloc.h"
#include "geom/doubles.h"
#include "geom/hash.h"
#include "geom/lambert.h"

static const double CLAMPED_REFLECTANCE = 0.999;

static const char DEFAULT_GROUP[] = "default";

void scene_set_groups(struct scene *scene, int32_t count, int64_t bytes)
{
    alloc_free(scene->groups.names);
    scene->groups.count = count;
    scene->groups.bytes = bytes;
    scene->groups.names = alloc_array((size_t)bytes, 1);
}

struct scene *scene_create(int32_t input_count, int32_t material_count)
{
    struct scene *scene = alloc_array(1, sizeof *scene);
    scene->input_count = scene->sky_first = input_count;
    scene->material_count = material_count;
    scene->triangles = alloc_array((size_t)input_count, sizeof *scene->triangles);
    scene->planes = alloc_array((size_t)input_count, sizeof *scene->planes);
    scene->areas = alloc_array((size_t)input_count, sizeof *scene->areas);
    scene->material_of = alloc_array((size_t)input_count, sizeof *scene->material_of);
    scene->groups.goes_on = alloc_array((size_t)input_count, sizeof(bool));
    scene->opposed = alloc_array((size_t)input_count, sizeof *scene->opposed);
    scene->materials = alloc_array((size_t)material_count, sizeof *scene->materials);
    scene->groups.of = alloc_array((size_t)input_count, sizeof *scene->groups.of);
    scene_set_groups(scene, 1, sizeof DEFAULT_GROUP);
    memcpy(scene->groups.names, DEFAULT_GROUP, sizeof DEFAULT_GROUP);
    return scene;
}

void scene_add_normals(struct scene *scene)
{
    alloc_free(scene->normals);
    scene->normals = alloc_array(3 * (size_t)scene->input_count, sizeof *scene->normals);
}

/* Makes an array longer by `more` items, which are 0. */
#define EXTEND(array, count, more) \
    ((array) = alloc_resize(array, (size_t)(count) + (size_t)(more), sizeof *(array)), \
     memset((array) + (count), 0, (size_t)(more) * sizeof *(array)))

void scene_add_sky(struct scene *scene, int32_t count, const struct triangle *triangles,
                   const struct rgb *radiosities)
{
    int64_t before = scene->input_count;
    EXTEND(scene->triangles, before, count);
    EXTEND(scene->planes, before, count);
    EXTEND(scene->areas, before, count);
    EXTEND(scene->material_of, before, count);
    EXTEND(scene->groups.goes_on, before, count);
    EXTEND(scene->opposed, before, count);
    EXTEND(scene->groups.of, before, count);
    if (scene->normals)
        EXTEND(scene->normals, 3 * before, 3 * count);
    EXTEND(scene->materials, scene->material_count, count);
    for (int32_t i = 0; i < count; i++) {
        struct material material = {.emission = radiosities[i]};
        if (i == 0 ||
            !material_is_same(&material, &scene->materials[scene->material_count - 1]))
            scene->materials[scene->material_count++] = material;
        scene->triangles[before + i] = triangles[i];
        scene->material_of[before + i] = scene->material_count - 1;
    }
    scene->input_count += count;
}

void scene_destroy(struct scene *scene)
{
    if (scene && !scene->is_view) {
        alloc_free(scene->triangles);
        alloc_free(scene->planes);
        alloc_free(scene->opaque);
        alloc_free(scene->areas);
        alloc_free(scene->material_of);
        alloc_free(scene->groups.goes_on);
        alloc_free(scene->opposed);
        alloc_free(scene->materials);
        alloc_free(scene->normals);
        alloc_free(scene->groups.of);
        alloc_free(scene->groups.names);
    }
    alloc_free(scene);
}

static void pack_arrays(struct scene *scene, struct pack *pack)
{
    int64_t count = scene->input_count;
    PACK(pack, scene->triangles, count);
    PACK(pack, scene->planes, count);
    if (scene->opaque)
        PACK(pack, scene->opaque, count);
    PACK(pack, scene->areas, count);
    PACK(pack, scene->material_of, count);
    PACK(pack, scene->opposed, count);
    PACK(pack, scene->materials, scene->material_count);
    PACK(pack, scene->groups.of, count);
    PACK(pack, scene->groups.names, scene->groups.bytes);
    if (scene->normals)
        PACK(pack, scene->normals, 3 * count);
}

void scene_pack(const struct scene *scene, struct pack *pack)
{
    struct scene view = *scene;
    view.is_view = true;
    pack_array(pack, &view, sizeof view);
    pack_arrays(&view, pack);
}

struct scene *scene_view(struct pack *pack)
{
    struct scene *scene = alloc_array(1, sizeof *scene);
    memcpy(scene, pack_array(pack, NULL, sizeof *scene), sizeof *scene);
    pack_arrays(scene, pack);
    return scene;
}

static void find_bounds(struct scene *scene)
{
    scene->low = scene->high = scene->triangles[0].corner[0];
    for (int32_t i = 0; i < scene->input_count; i++)
        for (int k = 0; k < 3; k++) {
            scene->low = vec3_least(scene->low, scene->triangles[i].corner[k]);
            scene->high = vec3_most(scene->high, scene->triangles[i].corner[k]);
        }
}

/* Largest coordinate of the input, far from where squares of lengths would overflow. */
static const double COORDINATE_MAX = 1e150;

static bool coordinates_are_sane(const struct scene *scene)
{
    for (int32_t i = 0; i < scene->input_count; i++)
        for (int k = 0; k < 3; k++)
            for (int axis = 0; axis < 3; axis++)
                if (!(fabs(vec3_axis(scene->triangles[i].corner[k], axis)) <=
                      COORDINATE_MAX))
                    return false;
    return true;
}

static bool normalise(struct scene *scene, struct error *error)
{
    if (!coordinates_are_sane(scene))
        return error_set(error, EXIT_USAGE, "a coordinate is out of range");
    find_bounds(scene);
    struct vec3 size = vec3_sub(scene->high, scene->low);
    double extent = real_max(size.x, real_max(size.y, size.z));
    int exponent;
    frexp(extent, &exponent);
    if (!(extent > 0.0))
        return error_set(error, EXIT_USAGE, "the scene is a single point");
    if (exponent < -500)
        return error_set(error, EXIT_USAGE, "the scene's extent %g is out of range",
                         extent);
    scene->place.exponent = exponent;
    scene->place.centre = vec3_add(scene->low, vec3_scale(size, 0.5));
    for (int32_t i = 0; i < scene->input_count; i++)
        for (int k = 0; k < 3; k++)
            scene->triangles[i].corner[k] =
                scene_from_input(scene, scene->triangles[i].corner[k]);
    find_bounds(scene);
    return true;
}

static int64_t clamp_reflectances(struct scene *scene)
{
    int64_t clamped = 0;
    for (int32_t m = 0; m < scene->material_count; m++) {
        bool changed = false;
        for (int c = 0; c < BANDS; c++) {
            double *rho = &scene->materials[m].reflectance.band[c];
            changed = changed || *rho >= 1.0;
            *rho = *rho >= 1.0 ? CLAMPED_REFLECTANCE : *rho;
        }
        clamped += changed;
    }
    return clamped;
}

void scene_take_radiances(struct scene *scene)
{
    for (int32_t m = 0; m < scene->material_count; m++)
        for (int c = 0; c < BANDS; c++)
            scene->materials[m].emission.band[c] *= PI;
}

/* Computes area and plane, unless 0. True if not 0. */
static bool measure_triangle(struct scene *scene, int32_t i)
{
    if (triangle_is_degenerate(&scene->triangles[i]))
        return false;
    scene->areas[i] = triangle_area(&scene->triangles[i]);
    scene->planes[i] = triangle_plane(&scene->triangles[i]);
    return true;
}

/* Returns the number of triangles without area. */
static int64_t measure_triangles(struct scene *scene)
{
    int64_t degenerate = 0;
    for (int32_t i = 0; i < scene->input_count; i++)
        degenerate += !measure_triangle(scene, i);
    return degenerate;
}

/* Returns the normal of one of a face's triangles at a corner in this place. */
static struct vec3 normal_at(const struct triangle *face, const struct vec3 *normals,
                             int32_t count, struct vec3 place)
{
    for (int32_t i = 0; i < 3 * count; i++) {
        struct vec3 apart = vec3_sub(face[i / 3].corner[i % 3], place);
        if (vec3_dot(apart, apart) == 0.0)
            return normals[i];
    }
    return (struct vec3){0.0, 0.0, 0.0};
}

/* Cuts a polygon like the one at its back, whose first triangle is `other`: were a bent
 * quad cut along the other diagonal, its black back would stick out. */
static void cut_alike(struct scene *scene, int32_t begin, int32_t count, int32_t other)
{
    struct triangle *before = alloc_array((size_t)count, sizeof *before);
    struct vec3 *normals = alloc_array(3 * (size_t)count, sizeof *normals);
    memcpy(before, &scene->triangles[begin], (size_t)count * sizeof *before);
    if (scene->normals)
        memcpy(normals, &scene->normals[3 * (int64_t)begin],
               3 * (size_t)count * sizeof *normals);
    for (int32_t i = begin; i < begin + count; i++) {
        struct triangle *t = &scene->triangles[i];
        *t = triangle_turned(&scene->triangles[other + i - begin]);
        for (int k = 0; k < 3 && scene->normals; k++)
            scene->normals[3 * (int64_t)i + k] =
                normal_at(before, normals, count, t->corner[k]);
        scene_drop(scene, i);
        measure_triangle(scene, i);
    }
    alloc_free(normals);
    alloc_free(before);
}

static struct faces faces_of(const struct scene *scene)
{
    return (struct faces){scene->triangles, scene->areas, scene->groups.goes_on,
                          scene->input_count};
}

/* Returns the first triangle of an earlier polygon whose back the polygon from `begin` on
 * is, or -1. */
static int32_t front_of(const struct faces *faces, int32_t begin, int32_t end,
                        const int32_t *opposite)
{
    int32_t other = opposite[begin], count = end - begin;
    if (other < 0 || other > begin || faces->goes_on[other] ||
        face_end(faces, other) != other + count)
        return -1;
    for (int32_t k = 1; k < count; k++)
        if (opposite[begin + k] != other + k)
            return -1;
    return other;
}

/* Finds doubles and backs, with arrays as doubles_find() has them. */
static void find_doubles(struct scene *scene, int32_t **first, int32_t **opposite)
{
    struct faces faces = faces_of(scene);
    *first = alloc_array((size_t)scene->input_count, sizeof **first);
    *opposite = alloc_array((size_t)scene->input_count, sizeof **opposite);
    doubles_find(&faces, *first, *opposite);
    for (int32_t i = 0; i < scene->input_count; i++)
        scene->opposed[i] = (*opposite)[i] >= 0;
}

static void handle_doubles(struct scene *scene, struct scene_repairs *repairs)
{
    struct faces faces = faces_of(scene);
    int32_t *first, *opposite;
    find_doubles(scene, &first, &opposite);
    for (int32_t i = 0, end; i < scene->input_count; i = end) {
        end = face_end(&faces, i);
        int32_t front = end > i + 1 ? front_of(&faces, i, end, opposite) : -1;
        if (front >= 0)
            cut_alike(scene, i, end - i, front);
    }
    for (int32_t i = 0; i < scene->input_count; i++) {
        if (first[i] == i || !(scene->areas[i] > 0.0) || !(scene->areas[first[i]] > 0.0))
            continue;
        repairs->doubles++;
        repairs->unlike += !material_is_same(scene_root_material(scene, i),
                                             scene_root_material(scene, first[i]));
        scene_drop(scene, i);
    }
    alloc_free(opposite);
    alloc_free(first);
    alloc_free(scene->groups.goes_on);
    scene->groups.goes_on = NULL;
}

/* Panes have planes, and are in no octree of blockers. */
static void find_panes(struct scene *scene)
{
    size_t count = (size_t)scene->input_count;
    for (int32_t i = 0; i < scene->input_count; i++) {
        if (!material_is_pane(scene_root_material(scene, i)))
            continue;
        if (!scene->opaque) {
            scene->opaque = alloc_array(count, sizeof *scene->opaque);
            memcpy(scene->opaque, scene->planes, count * sizeof *scene->opaque);
        }
        scene->has_panes = true;
        scene->opaque[i] = (struct plane){{0.0, 0.0, 0.0}, 0.0};
    }
}

bool scene_prepare(struct scene *scene, struct scene_repairs *repairs,
                   struct error *error)
{
    if (scene->input_count == 0)
        return error_set(error, EXIT_USAGE, "the scene has no faces");
    if (!normalise(scene, error))
        return false;
    *repairs = (struct scene_repairs){.clamped = clamp_reflectances(scene)};
    repairs->degenerate = measure_triangles(scene);
    if (repairs->degenerate == scene->sky_first)
        return error_set(error, EXIT_USAGE, "all faces of the scene are degenerate");
    handle_doubles(scene, repairs);
    find_panes(scene);
    return true;
}

void scene_restore(struct scene *scene, struct vec3 centre, int32_t exponent)
{
    scene->place = (struct scene_place){centre, exponent};
    find_bounds(scene);
    measure_triangles(scene);
    find_panes(scene);
}

void scene_find_backs(struct scene *scene)
{
    int32_t *first, *opposite;
    find_doubles(scene, &first, &opposite);
    alloc_free(opposite);
    alloc_free(first);
}

void scene_drop(struct scene *scene, int32_t input)
{
    scene->areas[input] = 0.0;
    scene->planes[input] = (struct plane){{0.0, 0.0, 0.0}, 0.0};
    if (scene->opaque)
        scene->opaque[input] = scene->planes[input];
}

void scene_drop_panes(struct scene *scene)
{
    for (int32_t i = 0; i < scene->input_count && scene->has_panes; i++)
        if (material_is_pane(scene_root_material(scene, i)))
            scene_drop(scene, i);
    scene->has_panes = false;
}

int32_t scene_root_count(const struct scene *scene)
{
    bool twins = scene->two_sided || scene->has_panes;
    return twins ? 2 * scene->input_count : scene->input_count;
}

bool scene_has_twin(const struct scene *scene, int32_t input)
{
    if ((!scene->two_sided && !scene->has_panes) || scene->opposed[input] ||
        input >= scene->sky_first)
        return false;
    const struct material *material = scene_root_material(scene, input);
    return material_is_pane(material) ||
           (scene->two_sided && (scene->two_sided_lamps || !material_emits(material)));
}

struct vec3 scene_root_normal(const struct scene *scene, int32_t root, int corner)
{
    if (!scene->normals)
        return (struct vec3){0.0, 0.0, 0.0};
    bool is_twin = root >= scene->input_count;
    int input_corner = is_twin && corner > 0 ? 3 - corner : corner;
    struct vec3 normal =
        scene->normals[3 * (int64_t)scene_input_of(scene, root) + input_corner];
    bool is_front = vec3_dot(normal, scene_root_plane(scene, root).normal) >= 0.0;
    return is_front ? normal : vec3_scale(normal, -1.0);
}

double scene_area(const struct scene *scene)
{
    double sum = 0.0;
    for (int32_t root = 0; root < scene_root_count(scene); root++)
        sum += scene_root_area(scene, root);
    return sum;
}

double scene_emitted_power(const struct scene *scene)
{
    double sum = 0.0;
    for (int32_t root = 0; root < scene_root_count(scene); root++)
        sum += scene_root_area(scene, root) *
               rgb_sum(scene_root_material(scene, root)->emission);
    return sum;
}

double scene_own_area(const struct scene *scene)
{
    double sum = 0.0;
    for (int32_t root = 0; root < scene_root_count(scene); root++)
        sum += scene_root_own_area(scene, root);
    return sum;
}

/* Light of a sky enters by the front of the sides of the box: what the middle of the box
 * receives on a face towards each of them is what all of the side does. */
double scene_entering_power(const struct scene *scene)
{
    double power = 0.0;
    struct vec3 low = scene->triangles[0].corner[0], high = low;
    for (int32_t root = 0; root < scene_root_count(scene); root++)
        power += scene_root_own_area(scene, root) *
                 rgb_sum(scene_root_material(scene, root)->emission);
    for (int32_t i = 0; i < scene->sky_first; i++) {
        low = vec3_least(low, triangle_low(&scene->triangles[i]));
        high = vec3_most(high, triangle_high(&scene->triangles[i]));
    }
    struct vec3 middle = vec3_middle(low, high), side = vec3_sub(high, low);
    for (int32_t i = scene->sky_first; i < scene->input_count; i++) {
        double light = rgb_sum(scene_root_material(scene, i)->emission);
        for (int face = 0; face < 6; face++) {
            double sign = face % 2 ? -1.0 : 1.0;
            struct vec3 out = {face / 2 == 0 ? sign : 0.0, face / 2 == 1 ? sign : 0.0,
                               face / 2 == 2 ? sign : 0.0};
            double area = vec3_axis(side, (face / 2 + 1) % 3) *
                          vec3_axis(side, (face / 2 + 2) % 3);
            power += light * area *
                     point_triangle_factor(middle, out, &scene->triangles[i]);
        }
    }
    return power;
}

double scene_area_unit(const struct scene *scene)
{
    return ldexp(1.0, 2 * scene->place.exponent);
}

uint64_t scene_hash(const struct scene *scene)
{
    uint64_t hash = HASH_START;
    for (int32_t i = 0; i < scene->input_count; i++) {
        const struct material *material = scene_root_material(scene, i);
        for (int k = 0; k < 3; k++) {
            struct vec3 v = scene->triangles[i].corner[k];
            hash = hash_doubles(hash, (const double[]){v.x, v.y, v.z}, 3);
        }
        hash = hash_doubles(hash, material->reflectance.band, BANDS);
        hash = hash_doubles(hash, material->emission.band, BANDS);
        if (material_is_pane(material))
            hash = hash_doubles(hash, material->transmittance.band, BANDS);
        if (scene->opposed[i] || !(scene->areas[i] > 0.0)) /* roots may be missing */
            hash = hash_doubles(hash, &scene->areas[i], 1);
    }
    return hash;
}

struct vec3 scene_to_input(const struct scene *scene, struct vec3 x)
{
    const struct scene_place *place = &scene->place;
    return vec3_add(place->centre, vec3_scale(x, ldexp(1.0, place->exponent)));
}

struct vec3 scene_from_input(const struct scene *scene, struct vec3 x)
{
    const struct scene_place *place = &scene->place;
    return vec3_scale(vec3_sub(x, place->centre), ldexp(1.0, -place->exponent));
}
