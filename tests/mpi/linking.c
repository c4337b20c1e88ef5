/* Tests of step 2 by pairs, on any number of ranks: all roots that see each other are
 * linked, as one by one, and no other; pair number k is linked by rank k mod P. To be run
 * with mpiexec; rank 0 reports. */
#include "mpi/beyond/create.h"

#include <string.h>

#include "tests/pairs.h"
#include "tests/ranks.h"
#include "tests/tap.h"

/* Two-sided; frees the triangles. Every third is black, the others are lamps. */
static struct world world_of(struct soup *soup, enum oracle oracle)
{
    paint(soup, 0.5, 1.0);
    paint(soup, 0.0, 0.0);
    struct scene *scene = scene_of_soup(soup);
    for (int32_t i = 0; i < scene->input_count; i += 3)
        scene->material_of[i] = 1;
    scene->two_sided = scene->two_sided_lamps = true;
    struct world world = world_make(scene);
    struct criterion criterion = world.model.criterion;
    criterion.oracle = oracle;
    criterion.form_factor = oracle == ORACLE_BF ? FORM_FACTOR_DISK : FORM_FACTOR_POLYGON;
    world.model = model_make(scene, world.octree, world.model.forest, &criterion,
                             method_of(&criterion));
    return world;
}

/* A room with two boxes, three loose triangles, and one without an area among them. */
static struct world furnished(enum oracle oracle)
{
    struct random random = random_seed(77);
    struct soup soup = {0};
    struct vec3 x = point(0.1, 0.1, 0.1);
    soup_add_box(&soup, point(-0.5, -0.5, -0.5), point(0.5, 0.5, 0.5), 2, true);
    soup_add_box(&soup, point(-0.4, -0.3, -0.5), point(-0.1, 0.2, -0.1), 1, false);
    soup_add(&soup, (struct triangle){{x, x, x}});
    soup_add_box(&soup, point(0.1, -0.4, -0.5), point(0.2, 0.4, 0.1), 1, false);
    soup_add_random(&soup, &random, 3, 0.4, 0.1);
    return world_of(&soup, oracle);
}

/* The links that the ranks make of the pairs of this world against pairs one by one.
 * Returns the pairs of all ranks. Frees the world. */
static int64_t test_pairs(const struct comm *comm, struct world world, const char *name)
{
    const struct scene *scene = world.scene;
    struct solver *solver =
        beyond_create(comm, scene, world.octree, &world.model.criterion);
    bool done = solver_link_roots(solver);
    int64_t number = 0, next = 0, different = 0;
    for (int32_t p = 0; p < scene_root_count(scene); p++)
        for (int32_t q = p + 1; q < scene_root_count(scene); q++) {
            struct link one;
            if (scene_root_area(scene, p) == 0.0 || scene_root_area(scene, q) == 0.0 ||
                number++ % comm->size != comm->rank || !make(&world, p, q, &one))
                continue;
            different += next == solver->links.count ||
                         memcmp(&solver->links.items[next++], &one, sizeof one) != 0;
        }
    report(comm, done && different == 0 && next == solver->links.count, name);
    report(comm, solver->model.counts.rays == world.model.counts.rays,
           "nothing but these is looked at");
    solver_destroy(solver);
    world_free(&world);
    return number;
}

static void test_furnished(const struct comm *comm)
{
    struct world world = furnished(ORACLE_BF);
    int64_t with_area = 0;
    for (int32_t root = 0; root < scene_root_count(world.scene); root++)
        with_area += scene_root_area(world.scene, root) > 0.0;
    report(comm, with_area == scene_root_count(world.scene) - 2,
           "one triangle, and so its twin, has no area");
    report(comm, test_pairs(comm, world, "disks: the links made one by one") ==
                     with_area * (with_area - 1) / 2,
           "a root without an area is in no pair");
    test_pairs(comm, furnished(ORACLE_ERROR), "polygons: the links made one by one");
}

/* A floor and up to two ceilings: fewer pairs than ranks. */
static void test_few(const struct comm *comm)
{
    for (int n = 1; n <= 3; n++) {
        struct soup soup = {0};
        for (int k = 0; k < n; k++)
            soup_add(&soup, tile(1.2 * k, k > 0, 1.0, k == 0));
        paint(&soup, 0.5, 1.0);
        struct scene *scene = scene_of_soup(&soup);
        int64_t pairs = test_pairs(comm, world_make(scene), "hardly any roots");
        report(comm, pairs == n * (n - 1) / 2, "and no pair too many");
    }
}

int main(int argc, char **argv)
{
    struct comm comm;
    comm_start(&comm, &argc, &argv);
    test_furnished(&comm);
    test_few(&comm);
    comm_stop(&comm);
    return comm.rank == 0 ? tap_done() : alloc_balance() != 0;
}
