/* Tests of geom/stop.h and of the loops that ask it. Proved of each are: it asks as
 * often as there are steps; when it is asked to stop at once it makes less than all;
 * wherever it is asked to stop it comes back, and all memory is freed; readers give an
 * error and no scene, writers an error and the old file. A signal at any ask before a
 * picture with outlines is written leaves the picture as it is without one. */
#include "geom/stop.h"
#include "geom/wall.h"

#include <signal.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "geom/signals.h"
#include "io/picture/hdr.h"
#include "io/picture/png.h"
#include "io/picture/pnm.h"
#include "io/picture/vtk.h"
#include "io/picture/mesh.h"
#include "io/picture/render.h"
#include "io/picture/viewpoint.h"
#include "tests/load.h"
#include "tests/reading.h"
#include "tests/scenes.h"
#include "tests/tap.h"
#include "tools/results.h"
#include "tools/stored.h"
#include "tools/viewfactors/pairs.h"
#include "tools/viewfactors/table.h"

#define OBJ "build/stop_test.obj"
#define TEXT_PLY "build/stop_test.text.ply"
#define MESH_PLY "build/stop_test.mesh.ply"
#define WRITTEN "build/stop_test.out"

enum { SIZE = 16, STOPS = 20 };

/* How often was asked, and from when on the answer is yes. */
static int64_t asks, first_yes;

static bool is_time(void)
{
    return asks++ >= first_yes;
}

static struct error error;
static struct comm comm;
static struct world world; /* that the phases look at */
static struct shading *shading;
static float picture[3 * SIZE * SIZE];

static const struct camera CAMERA = {.eye = {0.1, 0.2, 0.3}, .at = {0.9, 0.8, 0.7},
                                     .up = {0, 0, 1}, .fov = 70.0, .width = SIZE,
                                     .height = SIZE};

/* --- phases that stop; each returns the number of items made --- */

static int64_t count_triangles(struct scene *scene)
{
    int64_t count = scene ? scene->input_count : 0;
    scene_destroy(scene);
    return count;
}

static int64_t read_obj(void)
{
    struct obj_repairs repairs = {0};
    return count_triangles(obj_read(OBJ, &repairs, &error));
}

static int64_t read_ply(const char *path)
{
    struct source source;
    struct scene *scene = source_open(&source, path, &error) ? ply_read(&source, &error)
                                                             : NULL;
    source_close(&source);
    return count_triangles(scene);
}

static int64_t read_text_ply(void)
{
    return read_ply(TEXT_PLY);
}

static int64_t read_mesh_ply(void)
{
    return read_ply(MESH_PLY);
}

static int64_t find_neighbours(void)
{
    const struct scene *s = world.scene;
    int64_t found = 0;
    int32_t *neighbours = walls_find_neighbours(s->triangles, s->planes, s->input_count);
    for (int32_t side = 0; side < 3 * s->input_count; side++)
        found += neighbours[side] >= 0;
    alloc_free(neighbours);
    return found;
}

static int64_t build_octree(void)
{
    const struct scene *s = world.scene;
    struct octree *octree = octree_of(s);
    struct pack pack = {0};
    octree_pack(octree, &pack);
    octree_destroy(octree);
    return (int64_t)pack.bytes;
}

static struct viewfactors *make_factors(void)
{
    struct viewfactors *factors = viewfactors_create(world.scene, world.octree, 1e-3, 4);
    pairs_add(&comm, factors, NULL);
    return factors;
}

static int64_t add_pairs(void)
{
    struct viewfactors *factors = make_factors();
    int64_t parts = factors->links;
    viewfactors_destroy(factors);
    return parts;
}

static int64_t print_table(void)
{
    int64_t bytes;
    struct viewfactors *factors = viewfactors_create(world.scene, world.octree, 1e-3, 4);
    FILE *file = tmpfile();
    table_print(factors, false, file);
    bytes = ftell(file);
    fclose(file);
    viewfactors_destroy(factors);
    return bytes;
}

/* 1 for the right camera, as the first call chooses it. */
static int64_t choose_camera(void)
{
    static struct vec3 right;
    struct camera camera = viewpoint_choose(world.scene, world.octree, NULL, SIZE, SIZE);
    if (first_yes == INT64_MAX)
        right = camera.eye;
    return vec3_length(vec3_sub(camera.eye, right)) == 0.0;
}

static int64_t count_vertices(struct shading *made)
{
    int64_t count = made->vertex_count;
    shading_destroy(made);
    return count;
}

static int64_t shade_flat(void)
{
    return count_vertices(shading_create_flat(world.model.forest));
}

static int64_t shade_smooth(void)
{
    return count_vertices(
        shading_create(world.model.forest, world.octree, NULL, NULL, NULL));
}

static int64_t render(void)
{
    struct renderer renderer = renderer_make(world.octree, shading, NULL);
    float *rows = render_scanlines(&renderer, &CAMERA, 1, 0, 1, NULL);
    int64_t lit = 0;
    for (int i = 0; i < 3 * SIZE * SIZE; i++)
        lit += rows[i] > 0.0f;
    alloc_free(rows);
    return lit;
}

/* 0 if the old file is there, as it was, and nothing beside it. */
static int64_t look_at_output(bool good)
{
    char bytes[2];
    FILE *beside = fopen(WRITTEN ".0.tmp", "rb");
    bool old = load(WRITTEN, bytes, sizeof bytes) == 1 && bytes[0] == 'o';
    if (beside)
        fclose(beside);
    return !old || beside || good;
}

static const struct image IMAGE = {SIZE, SIZE, picture};

static int64_t write_ppm(void)
{
    struct tone tone = tone_make(1.0);
    return look_at_output(ppm_write(&IMAGE, &tone, WRITTEN, &error));
}

static int64_t write_pfm(void)
{
    return look_at_output(pfm_write(&IMAGE, WRITTEN, &error));
}

static int64_t write_png(void)
{
    struct tone tone = tone_make(1.0);
    return look_at_output(png_write(&IMAGE, &tone, WRITTEN, &error));
}

static int64_t write_hdr(void)
{
    return look_at_output(hdr_write(&IMAGE, WRITTEN, &error));
}

static int64_t write_mesh(void)
{
    struct tone tone = tone_make(1.0);
    struct mesh_answer none = {.error = NULL};
    return look_at_output(mesh_write(shading, &tone, &none, WRITTEN, &error));
}

static int64_t write_vtk(void)
{
    struct mesh_answer none = {.error = NULL};
    return look_at_output(vtk_write(shading, &none, WRITTEN, &error));
}

static const struct loop {
    const char *name;
    int64_t (*run)(void);
    bool fails; /* being stopped is an error, and nothing is made */
    int each, more; /* asks at least: for each triangle, and besides */
} PHASES[] = {
    {"reading OBJ", read_obj, true, 4, 1},
    {"reading PLY as text", read_text_ply, true, 5, 1},
    {"reading binary PLY", read_mesh_ply, true, 5, 1},
    {"neighbours in walls", find_neighbours, false, 3, 0},
    {"the octree", build_octree, false, 1, 120},
    {"form factors between groups", add_pairs, false, 9, 0},
    {"their table", print_table, false, 0, 1},
    {"choosing a camera", choose_camera, false, 0, 5000},
    {"flat shading", shade_flat, false, 1, 0},
    {"smooth shading", shade_smooth, false, 4, 0},
    {"rendering", render, false, 0, 256},
    {"writing PPM", write_ppm, true, 0, 768},
    {"writing PFM", write_pfm, true, 0, 16},
    {"writing PNG", write_png, true, 0, 16},
    {"writing HDR", write_hdr, true, 0, 16},
    {"writing a mesh", write_mesh, true, 4, 0},
    {"writing VTK", write_vtk, true, 4, 0},
};

/* --- stopping them --- */

/* How much a phase makes that is asked to stop from the ask `yes` on. */
static int64_t run_until(const struct loop *phase, int64_t yes)
{
    error = (struct error){EXIT_DONE, ""};
    write_text(WRITTEN, "o");
    asks = 0;
    first_yes = yes;
    return phase->run();
}

static void test_phase(const struct loop *phase)
{
    int64_t whole = run_until(phase, INT64_MAX), all = asks, wrong = 0;
    int64_t step = all / STOPS + 1, balance = alloc_balance();
    int64_t least = (int64_t)phase->each * world.scene->input_count + phase->more;
    tap_ok(whole > 0 && error.code == EXIT_DONE && all >= least,
           "%s: asks %lld times, at least %lld", phase->name, (long long)all,
           (long long)least);
    int64_t at_once = run_until(phase, 0);
    tap_ok(at_once < (phase->fails ? 1 : whole), "stopped at once: makes less");
    for (int64_t yes = 0; yes < all; yes += step) {
        int64_t made = run_until(phase, yes);
        wrong += made > (phase->fails ? 0 : whole) || alloc_balance() != balance;
        wrong += (error.code != EXIT_DONE) != phase->fails;
    }
    tap_ok(wrong == 0, "stopped anywhere: comes back%s",
           phase->fails ? ", with an error" : "");
}

/* --- a signal while a picture is made --- */

enum ending { SHOWN, LOST, WRONG };

/* A picture with outlines of the stored solution, when a signal comes at the ask `yes`:
 * shown, as without one; or, as it was being written, lost with an error. */
static enum ending show_until(int64_t yes, const char *whole, size_t bytes)
{
    char *arguments[] = {"phr", MESH_PLY, "--quiet", "--show", "mesh", "--samples", "1",
                         "--view", "none", "-o", "ppm:" WRITTEN};
    static char found[1000];
    struct source source;
    struct run run = {.comm = comm};
    stop_when(NULL);
    write_text(WRITTEN, "o");
    options_parse(&run.options, sizeof arguments / sizeof *arguments, arguments,
                  &run.error);
    run.stored = alloc_array(1, sizeof *run.stored);
    if (!source_open(&source, MESH_PLY, &run.error) ||
        !solution_mesh_read(run.stored, &source, &run.error))
        exit(1);
    source_close(&source);
    run.scene = run.stored->scene;
    run.stored->scene = NULL;
    run.cameras = alloc_array(1, sizeof *run.cameras);
    *run.cameras = CAMERA;
    run.octree = octree_of(run.scene);
    stored_light(&run);
    asks = 0;
    first_yes = yes;
    stop_when(is_time);
    bool good = results_show(&run);
    size_t size = load(WRITTEN, found, sizeof found);
    bool shown = good && size == bytes && memcmp(found, whole, bytes) == 0;
    bool lost = !good && run.error.code == EXIT_FAILED && size == 1 && !run.haste;
    run_free(&run);
    return shown ? SHOWN : lost ? LOST : WRONG;
}

/* Only while it is written a picture can be lost. */
static void test_outlines(void)
{
    enum { STEP = 7 };
    static char whole[1000];
    int64_t counts[WRONG + 1] = {0}, balance = alloc_balance();
    asks = 0;
    write_ppm();
    int64_t writing = asks;
    signals_catch();
    raise(SIGTERM);
    show_until(INT64_MAX, whole, 0);
    size_t bytes = load(WRITTEN, whole, sizeof whole);
    int64_t all = asks;
    for (int64_t yes = 0; yes < all; yes += STEP)
        counts[show_until(yes, whole, bytes)]++;
    tap_ok(counts[WRONG] == 0 && STEP * (counts[LOST] - 1) <= writing &&
               STEP * counts[SHOWN] > 2 * SIZE * SIZE && alloc_balance() == balance,
           "outlines: %lld signals leave the whole picture, %lld, as it is written, the "
           "old one", (long long)counts[SHOWN], (long long)counts[LOST]);
}

static void test_questions(void)
{
    error = (struct error){EXIT_DONE, ""};
    stop_when(NULL);
    tap_ok(!stop_is_asked() && stop_check(&error) && error.code == EXIT_DONE,
           "nobody asks");
    stop_when(is_time);
    first_yes = 1;
    asks = 0;
    tap_ok(!stop_is_asked() && stop_is_asked(), "somebody does");
    tap_ok(!stop_check(&error) && error.code == EXIT_FAILED, "which is an error");
}

/* --- the scene they work on --- */

/* A lit room with a box in it, each side of n x n cells. */
static struct scene *make_room(int n)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), n, true);
    struct vec3 low = {0.4, 0.4, 0}, high = {0.6, 0.6, 0.5};
    soup_add_box(&soup, low, high, n, false);
    paint(&soup, 0.5, 1.0);
    return scene_of_soup(&soup);
}

static void write_scenes(void)
{
    struct tone tone = tone_make(1.0);
    FILE *obj = fopen(OBJ, "wb"), *ply = fopen(TEXT_PLY, "wb");
    if (!obj || !ply)
        exit(1);
    int32_t count = world.scene->input_count;
    fprintf(ply, "ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\n"
                 "property float y\nproperty float z\nelement face %d\n"
                 "property list uchar int vertex_indices\nend_header\n",
            3 * (int)count, (int)count);
    for (int32_t i = 0; i < 3 * count; i++) {
        struct vec3 x = world.scene->triangles[i / 3].corner[i % 3];
        fprintf(obj, "v %.9g %.9g %.9g\n", x.x, x.y, x.z);
        fprintf(ply, "%.9g %.9g %.9g\n", x.x, x.y, x.z);
    }
    for (int32_t i = 0; i < count; i++) {
        fprintf(obj, "f %d %d %d\n", 3 * (int)i + 1, 3 * (int)i + 2, 3 * (int)i + 3);
        fprintf(ply, "3 %d %d %d\n", 3 * (int)i, 3 * (int)i + 1, 3 * (int)i + 2);
    }
    fclose(obj);
    fclose(ply);
    mesh_write(shading, &tone, &(struct mesh_answer){.error = NULL}, MESH_PLY, &error);
}

int main(int argc, char **argv)
{
    comm_start(&comm, &argc, &argv);
    world = world_make(make_room(2));
    struct forest *forest = world.model.forest;
    for (int64_t p = 0; p < forest->count; p++)
        forest->radiosity[p] = (struct rgb){{1.0, 1.0, 1.0}};
    shading = shading_create_flat(forest);
    write_scenes();
    test_questions();
    for (size_t i = 0; i < sizeof PHASES / sizeof PHASES[0]; i++)
        test_phase(&PHASES[i]);
    test_outlines();
    stop_when(NULL);
    shading_destroy(shading);
    world_free(&world);
    comm_stop(&comm);
    return tap_done();
}
