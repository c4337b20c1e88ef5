/* Preparation of the scene.
 *
 * Scaling by a power of two is exact, so a scene scaled by 2^k gives the same bits in
 * scene units, and no threshold of the program has to know how large the scene is. Moving
 * the centre to the origin costs one rounding per coordinate and takes away the digits
 * that a large offset would eat. Shared vertices stay shared: equal inputs give equal
 * outputs. */
#include "geom/scene.h"

#include <string.h>

#include "geom/alloc.h"
#include "geom/hash.h"
#include "geom/little.h"

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
    scene->input_count = input_count;
    scene->material_count = material_count;
    scene->triangles = alloc_array((size_t)input_count, sizeof *scene->triangles);
    scene->planes = alloc_array((size_t)input_count, sizeof *scene->planes);
    scene->areas = alloc_array((size_t)input_count, sizeof *scene->areas);
    scene->material_of = alloc_array((size_t)input_count, sizeof *scene->material_of);
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

void scene_destroy(struct scene *scene)
{
    if (scene && !scene->is_view) {
        alloc_free(scene->triangles);
        alloc_free(scene->planes);
        alloc_free(scene->areas);
        alloc_free(scene->material_of);
        alloc_free(scene->materials);
        alloc_free(scene->normals);
        alloc_free(scene->groups.of);
        alloc_free(scene->groups.names);
    }
    alloc_free(scene);
}

static void pack_arrays(struct scene *scene, struct pack *pack)
{
    size_t count = (size_t)scene->input_count, materials = (size_t)scene->material_count;
    scene->triangles =
        pack_array(pack, scene->triangles, count * sizeof *scene->triangles);
    scene->planes = pack_array(pack, scene->planes, count * sizeof *scene->planes);
    scene->areas = pack_array(pack, scene->areas, count * sizeof *scene->areas);
    scene->material_of =
        pack_array(pack, scene->material_of, count * sizeof *scene->material_of);
    scene->materials =
        pack_array(pack, scene->materials, materials * sizeof *scene->materials);
    struct scene_groups *groups = &scene->groups;
    groups->of = pack_array(pack, groups->of, count * sizeof *groups->of);
    groups->names = pack_array(pack, groups->names, (size_t)groups->bytes);
    if (scene->normals)
        scene->normals =
            pack_array(pack, scene->normals, 3 * count * sizeof *scene->normals);
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
    for (int32_t i = 0; i < scene->input_count; i++) {
        for (int k = 0; k < 3; k++) {
            struct vec3 x = scene->triangles[i].corner[k];
            scene->low =
                (struct vec3){real_min(scene->low.x, x.x), real_min(scene->low.y, x.y),
                              real_min(scene->low.z, x.z)};
            scene->high =
                (struct vec3){real_max(scene->high.x, x.x), real_max(scene->high.y, x.y),
                              real_max(scene->high.z, x.z)};
        }
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
    scene->exponent = exponent;
    scene->centre = vec3_add(scene->low, vec3_scale(size, 0.5));
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

/* Computes areas and planes. Returns the number of triangles without area. */
static int64_t measure_triangles(struct scene *scene)
{
    int64_t degenerate = 0;
    for (int32_t i = 0; i < scene->input_count; i++) {
        if (triangle_is_degenerate(&scene->triangles[i])) {
            degenerate++;
            continue;
        }
        scene->areas[i] = triangle_area(&scene->triangles[i]);
        scene->planes[i] = triangle_plane(&scene->triangles[i]);
    }
    return degenerate;
}

bool scene_prepare(struct scene *scene, struct scene_repairs *repairs,
                   struct error *error)
{
    if (scene->input_count == 0)
        return error_set(error, EXIT_USAGE, "the scene has no faces");
    if (!normalise(scene, error))
        return false;
    repairs->clamped = clamp_reflectances(scene);
    repairs->degenerate = measure_triangles(scene);
    if (repairs->degenerate == scene->input_count)
        return error_set(error, EXIT_USAGE, "all faces of the scene are degenerate");
    return true;
}

void scene_restore(struct scene *scene, struct vec3 centre, int32_t exponent)
{
    scene->centre = centre;
    scene->exponent = exponent;
    find_bounds(scene);
    measure_triangles(scene);
}

void scene_drop(struct scene *scene, int32_t input)
{
    scene->areas[input] = 0.0;
    scene->planes[input] = (struct plane){{0.0, 0.0, 0.0}, 0.0};
}

int32_t scene_root_count(const struct scene *scene)
{
    return scene->two_sided ? 2 * scene->input_count : scene->input_count;
}

bool scene_has_twin(const struct scene *scene, int32_t input)
{
    return scene->two_sided &&
           (scene->two_sided_lamps || !material_emits(scene_root_material(scene, input)));
}

int32_t scene_root_on(const struct scene *scene, int32_t input, bool front)
{
    if (front)
        return input;
    return scene_has_twin(scene, input) ? input + scene->input_count : -1;
}

struct triangle scene_root_triangle(const struct scene *scene, int32_t root)
{
    struct triangle t = scene->triangles[scene_input_of(scene, root)];
    if (root >= scene->input_count) {
        struct vec3 swap = t.corner[1];
        t.corner[1] = t.corner[2];
        t.corner[2] = swap;
    }
    return t;
}

struct plane scene_root_plane(const struct scene *scene, int32_t root)
{
    int32_t input = scene_input_of(scene, root);
    struct plane plane = scene->planes[input];
    if (root == input)
        return plane;
    if (!scene_has_twin(scene, input))
        return (struct plane){{0.0, 0.0, 0.0}, 0.0};
    return (struct plane){vec3_scale(plane.normal, -1.0), -plane.offset};
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

double scene_area_unit(const struct scene *scene)
{
    return ldexp(1.0, 2 * scene->exponent);
}

static uint64_t hash_doubles(uint64_t hash, const double *values, int count)
{
    uint8_t bytes[8];
    for (int i = 0; i < count; i++) {
        little_put_double(bytes, values[i]);
        hash = hash_bytes(hash, bytes, sizeof bytes);
    }
    return hash;
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
    }
    return hash;
}

struct vec3 scene_to_input(const struct scene *scene, struct vec3 x)
{
    return vec3_add(scene->centre, vec3_scale(x, ldexp(1.0, scene->exponent)));
}

struct vec3 scene_from_input(const struct scene *scene, struct vec3 x)
{
    return vec3_scale(vec3_sub(x, scene->centre), ldexp(1.0, -scene->exponent));
}
