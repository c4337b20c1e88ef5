/* Tests of io/picture/mesh.h and vtk.h: a cube of 12 roots, some divided, some of them
 * twice, with random light, written and taken apart byte by byte. Leaves are found by
 * going down each root. */
#include "io/picture/mesh.h"

#include <string.h>

#include "io/picture/vtk.h"
#include "tests/load.h"
#include "tests/random.h"
#include "tests/reading.h"
#include "tests/scenes.h"
#include "tests/shaded.h"
#include "tests/tap.h"

#define PATH "build/mesh_test.out"

enum { LEAVES_MOST = 1000, SIZE_MOST = 1 << 20 };

static struct world world;
static struct forest *forest;
static struct shading *shading;
static float *errors, *shares;
static int32_t leaves[LEAVES_MOST];
static int leaf_count;
static unsigned char file[SIZE_MOST];
static size_t size, at;

static void find_leaves(int32_t patch)
{
    if (patch_is_leaf(&forest->patches[patch]))
        leaves[leaf_count++] = patch;
    else
        for (int k = 0; k < 4; k++)
            find_leaves(forest->patches[patch].children + k);
}

static void make_world(void)
{
    struct soup soup = {0};
    struct random random = random_seed(1);
    soup_add_box(&soup, point(1, 2, 3), point(2, 4, 7), 1, true);
    paint(&soup, 0.5, 0.0);
    struct scene *scene = scene_of_soup(&soup);
    world = world_make(scene);
    forest = world.model.forest;
    for (int32_t root = 0; root < scene->input_count; root += 3)
        forest_split(forest, root);
    forest_split(forest, forest->patches[3].children + 2);
    errors = alloc_array((size_t)forest->count, sizeof *errors);
    shares = alloc_array((size_t)forest->count, sizeof *shares);
    for (int64_t p = 0; p < forest->count; p++) {
        errors[p] = (float)random_unit(&random);
        shares[p] = (float)random_unit(&random);
        for (int c = 0; c < BANDS; c++)
            forest->radiosity[p].band[c] = 100.0 * random_unit(&random);
    }
    shading = shading_create(forest, world.octree, NULL, NULL, NULL);
    for (int32_t root = 0; root < scene->input_count; root++)
        find_leaves(root);
}

/* True if this text comes next, which is passed. */
static bool text_is(const char *format, int number, int other)
{
    char text[200];
    snprintf(text, sizeof text, format, number, other);
    bool same = strncmp((const char *)file + at, text, strlen(text)) == 0;
    at += strlen(text);
    return same;
}

/* Passes a number of four bytes. */
static uint32_t next_number(bool big)
{
    const unsigned char *b = file + at;
    at += 4;
    return big ? (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3]
               : (uint32_t)b[3] << 24 | (uint32_t)b[2] << 16 | (uint32_t)b[1] << 8 | b[0];
}

static bool floats_are(const double *expected, int count, bool big)
{
    bool same = true;
    for (int i = 0; i < count; i++) {
        float value = (float)expected[i];
        uint32_t bits, found = next_number(big);
        memcpy(&bits, &value, sizeof bits);
        same = same && found == bits;
    }
    return same;
}

static bool point_is(int v, bool big)
{
    struct vec3 x = scene_to_input(world.scene, shading->positions[v]);
    return floats_are((double[]){x.x, x.y, x.z}, 3, big);
}

static bool corners_are(int32_t leaf, bool big)
{
    bool same = true;
    for (int k = 0; k < 3; k++)
        same = next_number(big) == (uint32_t)shading->corners[3 * leaf + k] && same;
    return same;
}

static void test_vtk(bool with_errors)
{
    struct error error = {EXIT_DONE, ""};
    int points = (int)shading->vertex_count, n = leaf_count;
    struct mesh_answer answer = {.error = with_errors ? errors : NULL};
    if (with_errors) { /* any numbers: those of others */
        answer.irradiance = forest->radiosity;
        answer.irradiance_error = shares;
        answer.irradiance_at = shading->values;
    }
    bool right[8] = {vtk_write(shading, &answer, PATH, &error), true, true, true, true,
                     true, true, true};
    size = load(PATH, file, SIZE_MOST);
    at = 0;
    bool texts = text_is("# vtk DataFile Version 3.0\nradiosity in W/m^2, made by phr\n"
                         "BINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS %d float\n", points,
                         0);
    for (int v = 0; v < points; v++)
        right[1] = point_is(v, true) && right[1];
    texts = text_is("\nCELLS %d %d\n", n, 4 * n) && texts;
    for (int i = 0; i < n; i++) {
        bool three = next_number(true) == 3;
        right[2] = corners_are(leaves[i], true) && three && right[2];
    }
    texts = text_is("\nCELL_TYPES %d\n", n, 0) && texts;
    for (int i = 0; i < n; i++)
        right[2] = next_number(true) == 5 && right[2];
    texts = text_is("\nCELL_DATA %d\nFIELD cells %d\n", n, with_errors ? 7 : 4) && texts;
    texts = text_is("radiosity 3 %d float\n", n, 0) && texts;
    for (int i = 0; i < n; i++)
        right[3] = floats_are(forest->radiosity[leaves[i]].band, 3, true) && right[3];
    texts = text_is("\nroot 1 %d unsigned_int\n", n, 0) && texts;
    for (int i = 0; i < n; i++)
        right[4] = next_number(true) == forest->patches[leaves[i]].id.root && right[4];
    texts = text_is("\nhierarchy 1 %d unsigned_int\n", n, 0) && texts;
    for (int i = 0; i < n; i++)
        right[5] =
            next_number(true) == forest->patches[leaves[i]].id.hierarchy && right[5];
    texts = text_is("\nlevel 1 %d unsigned_char\n", n, 0) && texts;
    for (int i = 0; i < n; i++)
        right[6] = file[at++] == id_level(forest->patches[leaves[i]].id) && right[6];
    if (with_errors)
        texts = text_is("\nerror 1 %d float\n", n, 0) && texts;
    for (int i = 0; i < n && with_errors; i++)
        right[7] = floats_are((double[]){(double)errors[leaves[i]]}, 1, true) && right[7];
    if (with_errors)
        texts = text_is("\nirradiance 3 %d float\n", n, 0) && texts;
    for (int i = 0; i < n && with_errors; i++)
        right[7] = floats_are(forest->radiosity[leaves[i]].band, 3, true) && right[7];
    if (with_errors)
        texts = text_is("\nirradiance_error 1 %d float\n", n, 0) && texts;
    for (int i = 0; i < n && with_errors; i++)
        right[7] = floats_are((double[]){(double)shares[leaves[i]]}, 1, true) && right[7];
    texts = text_is("\nPOINT_DATA %d\nFIELD points %d\n", points,
                    with_errors ? 2 : 1) && texts;
    texts = text_is("radiosity 3 %d float\n", points, 0) && texts;
    for (int v = 0; v < points; v++)
        right[1] = floats_are(shading->values[v].band, 3, true) && right[1];
    if (with_errors)
        texts = text_is("\nirradiance 3 %d float\n", points, 0) && texts;
    for (int v = 0; v < points && with_errors; v++)
        right[1] = floats_are(shading->values[v].band, 3, true) && right[1];
    texts = text_is("\n", 0, 0) && texts && at == size;
    tap_ok(right[0] && texts, "VTK, %s errors: the lines between arrays",
           with_errors ? "with" : "without");
    tap_ok(right[1] && right[2], "points, their radiosity, and corners");
    tap_ok(right[3] && right[4] && right[5] && right[6] && right[7],
           "the numbers of cells");
}

static void test_ply(void)
{
    struct error error = {EXIT_DONE, ""};
    struct tone tone = tone_make(0.01);
    int points = (int)shading->vertex_count;
    struct mesh_answer answer = {.error = errors, .outside = shares,
                                 .irradiance = forest->radiosity,
                                 .irradiance_error = errors,
                                 .irradiance_at = shading->values};
    bool written = mesh_write(shading, &tone, &answer, PATH, &error);
    size = load(PATH, file, SIZE_MOST);
    at = 0;
    bool head = text_is("ply\nformat binary_little_endian 1.0\n"
                        "comment radiosity in W/m^2, made by phr\nelement vertex %d\n",
                        points, 0);
    head = text_is("property float x\nproperty float y\nproperty float z\n"
                   "property uchar red\nproperty uchar green\nproperty uchar blue\n",
                   0, 0) && head;
    head = text_is("property float radiosity_r\nproperty float radiosity_g\n"
                   "property float radiosity_b\nproperty float irradiance_r\n"
                   "property float irradiance_g\nproperty float irradiance_b\n"
                   "element face %d\n",
                   leaf_count, 0) && head;
    tap_ok(written && head, "PLY: the lines about vertices");
    while (at < size && !text_is("end_header\n", 0, 0))
        at -= strlen("end_header\n") - 1;
    bool same = true, light = true, faces = true;
    for (int v = 0; v < points; v++) {
        same = point_is(v, false) && same;
        for (int c = 0; c < BANDS; c++)
            same = file[at++] == tone_encode(&tone, shading->values[v].band[c]) && same;
        for (int twice = 0; twice < 2; twice++)
            light = floats_are(shading->values[v].band, 3, false) && light;
    }
    tap_ok(same, "vertices and their colours");
    tap_ok(light, "radiosity and irradiance of vertices");
    for (int i = 0; i < leaf_count; i++) {
        struct patch_id id = forest->patches[leaves[i]].id;
        faces = file[at++] == 3 && faces;
        faces = corners_are(leaves[i], false) && faces;
        faces = floats_are(forest->radiosity[leaves[i]].band, 3, false) && faces;
        faces = next_number(false) == id.root && faces;
        faces = next_number(false) == id.hierarchy && faces;
        faces = floats_are((double[]){(double)errors[leaves[i]]}, 1, false) && faces;
        faces = floats_are((double[]){(double)shares[leaves[i]]}, 1, false) && faces;
        faces = floats_are(forest->radiosity[leaves[i]].band, 3, false) && faces;
        faces = floats_are((double[]){(double)errors[leaves[i]]}, 1, false) && faces;
    }
    tap_ok(faces && at < size, "faces; more follows");
}

/* Meshes have the leaves and vertices of the scene alone, none of the sky. */
static void test_sky(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(2, 0, 0), point(0, 1, 0), 1);
    struct scene *scene = scene_of_soup(&soup);
    add_uniform_sky(scene, 1.0);
    struct world below = world_make(scene);
    struct shading *all = shading_create_flat(below.model.forest);
    tap_ok(mesh_count(below.model.forest) == 2 && all->own_count == 3 * 2 &&
               all->vertex_count > all->own_count,
           "the mesh of two triangles below a sky has none of the sky");
    shading_destroy(all);
    world_free(&below);
}

int main(void)
{
    make_world();
    tap_ok(leaf_count == 12 + 4 * 3 + 3, "%d leaves", leaf_count);
    test_vtk(false);
    test_vtk(true);
    test_ply();
    test_sky();
    struct error error = {EXIT_DONE, ""};
    struct mesh_answer none = {.error = NULL};
    tap_ok(!vtk_write(shading, &none, "build/mesh_test_absent/a.vtk", &error) &&
               error.code == EXIT_FAILED,
           "VTK into a missing folder");
    remove(PATH);
    shading_destroy(shading);
    alloc_free(errors);
    alloc_free(shares);
    world_free(&world);
    return tap_done();
}
