/* A final gather made, solved and read on one rank, without MPI: rad/beyond/gather/. */
#include "rad/beyond/gather/balance.h"
#include "tests/scenes.h"
#include "tests/tap.h"
#include "tests/trees.h"

enum { RAYS = 256, REFLECTIONS = 60 };

/* Solves for the light of a closed room, one reflection after the other; no leaf is
 * split, no row is exact. `first`: B, about. Returns the absorbed part of the power
 * emitted; `off`: the largest difference of B from 1. */
static double absorbed_part(struct scene *scene, double first, double *off)
{
    struct world world = world_make(scene);
    struct model *model = &world.model;
    struct cluster_tree *tree = tree_create(scene, world.octree);
    model->clusters = cluster_light_create(tree);
    for (int64_t p = 0; p < model->forest->count; p++)
        model->forest->radiosity[p] = (struct rgb){{first, first, first}};
    uint8_t *open = alloc_array((size_t)model->forest->root_count, sizeof *open);
    struct gather_mesh mesh = {.count = 0};
    struct final_gather *gather =
        final_gather_create(model, RAYS, NULL, lit_find(model));
    struct meshing meshing = {model, gather, &mesh, open, .patches_most = 0};
    meshing_begin(&meshing);
    meshing_end(&meshing);
    struct totals alone = {.terms = BANDS * mesh.count};
    struct equation e = equation_start(gather, &mesh, alone);
    int32_t *place = alloc_array((size_t)mesh.count, sizeof *place);
    struct rgb *b = alloc_array(2 * (size_t)mesh.count, sizeof *b), *h = b + mesh.count;
    for (int64_t i = 0; i < mesh.count; i++) {
        equation_make_row(&e, i);
        place[i] = equation_place(&e, i);
        h[i].band[0] = (double)equation_cover(&e, i)->outside;
    }
    equation_find_outside(&e, place, h);
    struct light_balance balance = balance_start(&e, gather->counts.crossed);
    for (int k = 0; k < REFLECTIONS; k++) {
        equation_show(&e, b, true, h);
        equation_set(&e, place, h);
        equation_multiply(&e, true, h);
        balance_close(&balance, b, true, h);
        balance_spread(&balance, h);
        equation_reflect(&e, h, b);
    }
    double absorbed, escaped;
    equation_powers(&e, h, b, &absorbed, &escaped);
    *off = 0.0;
    for (int64_t i = 0; i < e.count; i++)
        *off = real_max(*off, real_max(b[i].band[1] - 1.0, 1.0 - b[i].band[1]));
    alloc_free(b);
    alloc_free(place);
    balance_free(&balance);
    equation_free(&e);
    final_gather_destroy(gather);
    gather_mesh_free(&mesh);
    alloc_free(open);
    cluster_light_destroy(model->clusters);
    cluster_tree_destroy(tree);
    absorbed /= scene_emitted_power(scene);
    world_free(&world);
    return absorbed;
}

int main(void)
{
    double off;
    struct soup furnace = {0}, lit = {0};
    soup_add_box(&furnace, point(0, 0, 0), point(1, 1, 1), 1, true);
    paint(&furnace, 0.5, 0.5);
    soup_add_box(&furnace, point(0.4, 0.4, 0.4), point(0.6, 0.7, 0.5), 1, false);
    paint(&furnace, 0.2, 0.8);
    double part = absorbed_part(scene_of_soup(&furnace), 1.0, &off);
    tap_ok(off < 1e-6, "in a furnace B is 1, but for %.1e", off);
    tap_ok(real_max(part - 1.0, 1.0 - part) < 1e-6, "which absorbs %.9f of all", part);
    soup_add_box(&lit, point(0, 0, 0), point(1, 1, 1), 1, true);
    paint(&lit, 0.5, 0.0);
    soup_add_box(&lit, point(0.4, 0.4, 0.4), point(0.6, 0.7, 0.5), 1, false);
    paint(&lit, 0.2, 1.0);
    part = absorbed_part(scene_of_soup(&lit), 0.1, &off);
    tap_ok(real_max(part - 1.0, 1.0 - part) < 1e-6, "a room with a lamp %.9f", part);
    return tap_done();
}
