/* The exchanges of the distributed algorithm, on any number of ranks: links that migrate
 * arrive once and mean the same, collectives give the sums and bytes of their contracts,
 * and a cube is refined and lit as on one rank alone, by a solver on MPI_COMM_SELF. To be
 * run with mpiexec; rank 0 reports. */
#define _POSIX_C_SOURCE 200112L
#include <limits.h>
#include <stdio.h>
#include <sys/mman.h>

#include "mpi/beyond/create.h"
#include "mpi/broadcast.h"
#include "mpi/migrate.h"

#include <string.h>

#include "tests/ranks.h"
#include "tests/scenes.h"
#include "tests/solve.h"
#include "tests/tap.h"

enum { ROOTS = 23, LINKS = 4000 };

/* Links between random patches of roots without a place; each rank has its share. */
static struct solver *make_solver(const struct comm *comm, const struct scene *scene)
{
    static const struct criterion criterion = {.epsilon = 1.0, .max_level = 15};
    struct solver *solver = beyond_create(comm, scene, NULL, &criterion);
    struct random random = random_seed(99);
    for (int i = 0; i < LINKS; i++) {
        struct patch_id p = random_id(&random, ROOTS, 4);
        struct patch_id q = random_id(&random, ROOTS, 4);
        double area = 1e-5 * random_unit(&random);
        if (random_bits(&random) % (uint64_t)comm->size != (uint64_t)comm->rank)
            continue;
        int32_t a = forest_reach(solver->model.forest, p);
        int32_t b = forest_reach(solver->model.forest, q);
        link_list_append(&solver->links, (struct link){
            .p = a, .q = b, .area = float_below(area), .blocker = i,
            .parts_p = {(uint8_t)(i % 80), 64, 20}, .parts_q = {1, (uint8_t)(i % 100), 0},
            .seen = (uint8_t)(i % 256), .cost = (uint8_t)(i / 256)});
    }
    return solver;
}

static int64_t total_of(const struct comm *comm, int64_t own)
{
    comm_add(comm, &own, 1);
    return own;
}

/* Sum over links of a number that depends on all that a link says. */
static int64_t fingerprint(const struct solver *solver)
{
    uint64_t sum = 0;
    for (int64_t i = 0; i < solver->links.count; i++) {
        const struct link *link = &solver->links.items[i];
        struct patch_id p = solver->model.forest->patches[link->p].id;
        struct patch_id q = solver->model.forest->patches[link->q].id;
        uint64_t word = p.root + 31u * (uint64_t)p.hierarchy + 1009u * (uint64_t)q.root +
                        99991u * (uint64_t)q.hierarchy + 7u * (uint64_t)link->cost;
        for (int k = 0; k < 3; k++)
            word = 257u * word + 65537u * (uint64_t)link->parts_p[k] +
                   (uint64_t)link->parts_q[k];
        word =
            259u * word + 17u * (uint64_t)(uint32_t)link->blocker + (uint64_t)link->seen;
        sum += (word * UINT64_C(0x9E3779B97F4A7C15) >> 16) +
               (uint64_t)((double)link->area * 1e15);
    }
    return (int64_t)(sum & UINT64_C(0xffffffffffff));
}

static void test_migration(const struct comm *comm)
{
    struct scene *scene = scene_create(ROOTS, 1);
    for (int32_t i = 0; i < ROOTS; i++)
        scene->areas[i] = 1.0;
    struct solver *solver = make_solver(comm, scene);
    int64_t before = total_of(comm, fingerprint(solver)) & INT64_C(0xffffffffffff);
    int64_t count = total_of(comm, solver->links.count);
    bool right_place = true;
    for (int turn = 1; turn <= 3; turn++) {
        size_t own = (size_t)solver->links.count;
        int *destination = alloc_array(own, sizeof *destination);
        for (int64_t i = 0; i < solver->links.count; i++)
            destination[i] = solver->links.items[i].blocker / turn % comm->size;
        links_migrate(solver, &solver->links, destination);
        alloc_free(destination);
        for (int64_t i = 0; i < solver->links.count; i++)
            right_place = right_place && solver->links.items[i].blocker / turn %
                                             comm->size == comm->rank;
    }
    int64_t after = total_of(comm, fingerprint(solver)) & INT64_C(0xffffffffffff);
    report(comm, right_place, "each link is where it was sent");
    report(comm, count == total_of(comm, solver->links.count) && before == after,
           "links that migrate arrive once and unchanged");
    solver_destroy(solver);
    scene_destroy(scene);
}

/* --- collectives --- */

static void test_sums(const struct comm *comm)
{
    int size = comm->size;
    double values[4] = {comm->rank == size / 2 ? 1e300 : -1.0, -1.0 - comm->rank,
                        comm->rank - 0.5 * size, comm->rank == size - 1 ? HUGE_VAL : 0.0};
    bool right = comm_largest(comm, values[0]) == 1e300 &&
                 comm_largest(comm, values[1]) == -1.0 &&
                 comm_largest(comm, values[2]) == size - 1 - 0.5 * size &&
                 comm_largest(comm, values[3]) == HUGE_VAL;
    report(comm, right, "the largest value of all ranks, whatever its sign");
    int64_t numbers[3] = {comm->rank, comm->rank == 0 ? INT64_MAX : 0, 9};
    comm_add(comm, numbers, 2);
    right = numbers[0] == size * (size - 1) / 2 && numbers[1] == INT64_MAX &&
            numbers[2] == 9;
    report(comm, right, "numbers are added over all ranks, and no others");
}

/* --- the scene, once per node --- */

/* How windows of shared memory are made here, in place of MPI's own. */
enum windows { WINDOWS_WORK, WINDOWS_REFUSED, WINDOWS_EMPTY };
static enum windows windows;

#ifndef MPI_SERIAL_MPI_H
int MPI_Win_allocate_shared(MPI_Aint size, int unit, MPI_Info info, MPI_Comm comm,
                            void *base, MPI_Win *window)
{
    return windows == WINDOWS_REFUSED
               ? MPI_ERR_OTHER
               : PMPI_Win_allocate_shared(size, unit, info, comm, base, window);
}

/* An empty window lies in a file of no bytes: to touch it is a bus error. */
int MPI_Win_shared_query(MPI_Win window, int rank, MPI_Aint *size, int *unit, void *base)
{
    int code = PMPI_Win_shared_query(window, rank, size, unit, base);
    if (windows == WINDOWS_EMPTY) {
        FILE *file = tmpfile();
        void *nothing = mmap(NULL, (size_t)*size, PROT_READ | PROT_WRITE, MAP_SHARED,
                             fileno(file), 0);
        memcpy(base, &nothing, sizeof nothing);
        fclose(file);
    }
    return code;
}
#endif

/* The cube on rank 0, with all that a scene can have. */
static struct scene *full_scene(const struct comm *comm, bool normals)
{
    struct scene *scene = comm->rank == 0 ? cube_create() : NULL;
    if (scene && normals) {
        scene_add_normals(scene);
        for (int i = 0; i < 3 * scene->input_count; i++)
            scene->normals[i] = point(i, 0.5, -i);
    }
    if (scene) {
        scene->two_sided = scene->two_sided_lamps = true;
        scene->materials[5].emission.band[1] = 2.0;
    }
    return scene;
}

/* Rays through the cube meet the same as with an octree that this rank builds. */
static bool sees_alike(const struct octree *octree, const struct scene *scene)
{
    struct octree *own = octree_of(scene);
    struct random random = random_seed(5);
    bool alike = true;
    for (int i = 0; i < 200; i++) {
        struct octree_counts counts[2] = {{0}};
        struct octree_hit hits[2];
        struct vec3 from = {0.2 * random_unit(&random), 0.2 * random_unit(&random), 0.1};
        struct vec3 along = {random_unit(&random) - 0.5, random_unit(&random) - 0.5,
                             0.01 * i - 1.0};
        bool first = octree_first_hit(octree, from, along, false, &hits[0], &counts[0]);
        bool second = octree_first_hit(own, from, along, false, &hits[1], &counts[1]);
        alike = alike && first && second && hits[0].triangle == hits[1].triangle &&
                hits[0].front == hits[1].front &&
                counts[0].triangle_tests == counts[1].triangle_tests;
    }
    octree_destroy(own);
    return alike;
}

/* Number of ranks that look into this rank's copy if `ranks_max` may; all are on one
 * node. */
static int sharing(const struct comm *comm, int ranks_max)
{
    if (ranks_max >= comm->size)
        return comm->size;
    int left = comm->size - comm->rank / ranks_max * ranks_max;
    return left < ranks_max ? left : ranks_max;
}

/* The scene of rank 0 and an octree over it come to all, with normals if it has some.
 * `together`: so many ranks look into this rank's copy. */
static void test_broadcast(const struct comm *comm, struct node_policy policy,
                           bool normals, int together, const char *name)
{
    struct scene *scene = full_scene(comm, normals);
    struct octree *octree;
    struct node_block block = scene_broadcast(comm, policy, &scene, &octree);
    bool right = scene->input_count == 12 && scene->two_sided && scene->two_sided_lamps &&
                 scene->areas[11] > 0.0 && scene->materials[5].emission.band[1] == 2.0 &&
                 strcmp(scene->groups.names, "default") == 0 &&
                 !scene->normals == !normals;
    for (int i = 0; i < 3 * 12 && right && normals; i++)
        right = scene->normals[i].x == i && scene->normals[i].z == -i;
    right = right && sees_alike(octree, scene);
    right = right && block.shared == (together > 1) &&
            (!block.shared || block.node.size == together);
    report(comm, right, name);
    octree_destroy(octree);
    scene_destroy(scene);
    node_block_destroy(&block);
}

static void test_broadcasts(const struct comm *comm)
{
    struct node_policy policy = {0, INT_MAX};
    test_broadcast(comm, policy, true, comm->size,
                   "a scene comes to all ranks, one copy per node");
    test_broadcast(comm, policy, false, comm->size, "also one without normals");
    policy.ranks_max = 2;
    test_broadcast(comm, policy, true, sharing(comm, 2), "one copy for every two ranks");
    policy.ranks_max = 1;
    test_broadcast(comm, policy, true, 1, "one copy per rank");
    test_broadcast(comm, node_policy(), true, 1, "so by default a small scene");
    policy.ranks_max = INT_MAX;
    windows = WINDOWS_REFUSED;
    test_broadcast(comm, policy, true, 1, "and where windows are refused");
    windows = WINDOWS_EMPTY;
    test_broadcast(comm, policy, true, 1, "or have no memory");
    windows = WINDOWS_WORK;
}

/* --- refinement --- */

/* Whether all ranks have the trees of rank 0. */
static bool trees_agree(const struct solver *solver)
{
    uint64_t own = forest_checksum(solver->model.forest), first = own;
    comm_broadcast(solver->comm, &first, sizeof first);
    return on_all(solver->comm, own == first);
}

/* Whether both patches of each link here have the light of a solver with all light. */
static bool ends_are_lit(const struct solver *solver, const struct solver *whole)
{
    const struct forest *here = solver->model.forest;
    struct forest *there = whole->model.forest;
    bool lit = true;
    for (int64_t i = 0; i < 2 * solver->links.count; i++) {
        const struct link *link = &solver->links.items[i / 2];
        int32_t p = i % 2 ? link->p : link->q;
        int32_t same = forest_reach(there, here->patches[p].id);
        lit = lit && memcmp(&here->radiosity[p], &there->radiosity[same],
                            sizeof *here->radiosity) == 0;
    }
    return on_all(solver->comm, lit);
}

/* Whether each link here is at home, with the smaller of its patches. */
static bool links_are_home(const struct solver *solver)
{
    const struct forest *forest = solver->model.forest;
    bool home = true;
    for (int64_t i = 0; i < solver->links.count; i++) {
        int32_t p = solver->links.items[i].p, q = solver->links.items[i].q;
        double area = forest_area(forest, p) - forest_area(forest, q);
        bool of_p = area != 0.0 ? area < 0.0
                                : id_compare(forest->patches[p].id,
                                             forest->patches[q].id) > 0;
        home = home && home_of(solver, of_p ? p : q) == solver->comm->rank;
    }
    return on_all(solver->comm, home);
}

/* A cube in the paper's way, in three passes: links settle, and step 7 brings light to
 * proxies alone. */
static void test_proxies(const struct comm *comm, const struct comm *self,
                         enum balance balance)
{
    struct criterion criterion = criterion_of(3e-4, 10, 1e-3);
    criterion.balance = balance;
    struct scene *cube = cube_create();
    for (int face = 0; face < 6; face++)
        cube->materials[face] = (struct material){
            .reflectance = {{0.5, 0.5, 0.2}}, .emission = {{face == 1, 0, face == 2}}};
    struct octree *octree = octree_of(cube);
    struct solver *solver = beyond_create(comm, cube, octree, &criterion);
    struct solver *whole = beyond_create(self, cube, octree, &criterion);
    bool lit = true, home = true, dark = comm->size == 1;
    solver_link_roots(solver);
    solver_assign_roots(solver);
    solver_link_roots(whole);
    solver_assign_roots(whole);
    for (int pass = 0; pass < 3; pass++) {
        solver_refine(solver);
        solver_refine(whole);
        home = home && links_are_home(solver);
        iterate_links(solver);
        iterate_links(whole);
        lit = lit && ends_are_lit(solver, whole);
        dark = dark || !trees_agree(solver);
    }
    solver_complete(solver);
    if (balance == BALANCE_NONE)
        report(comm, home, "links settle with their smaller patch");
    report(comm, lit, "ends of links have the light of one rank alone");
    report(comm, dark, "and not all other patches");
    report(comm, trees_agree(solver) && forest_checksum(solver->model.forest) ==
                     forest_checksum(whole->model.forest),
           "until the solution is made whole");
    solver_destroy(solver);
    solver_destroy(whole);
    octree_destroy(octree);
    scene_destroy(cube);
}

/* A cube, refined twice: right after a refinement all ranks have the same trees, which
 * are those that one rank makes, though the links that split them live on different
 * ranks. */
static void test_refinement(const struct comm *comm, const struct comm *self,
                            const struct criterion *criterion, const char *name)
{
    const struct comm *comms[2] = {comm, self};
    struct solver *solvers[2];
    struct scene *cube = cube_create();
    for (int face = 0; face < 6; face++)
        cube->materials[face] = (struct material){
            .reflectance = {{0.3 + 0.1 * face, 0.5, 0.2}},
            .emission = {{face == 1, face == 1, face == 2}}};
    struct octree *octree = octree_of(cube);
    for (int k = 0; k < 2; k++) {
        solvers[k] = beyond_create(comms[k], cube, octree, criterion);
        solver_link_roots(solvers[k]);
        solver_assign_roots(solvers[k]);
    }
    bool agree = true, alike = true, grows = true, apart = true, even = true;
    for (int pass = 0; pass < 3; pass++) {
        struct vote vote[2];
        int64_t before = solvers[0]->model.forest->count;
        for (int k = 0; k < 2; k++)
            solver_refine(solvers[k]);
        const struct forest *here = solvers[0]->model.forest,
                            *there = solvers[1]->model.forest;
        int64_t split = total_of(comm, solvers[0]->turn.split_here);
        apart =
            apart && (comm->size == 1 || pass > 0 || solvers[0]->turn.split_here < split);
        agree = agree && trees_agree(solvers[0]);
        alike = alike && here->count == there->count &&
                forest_checksum(here) == forest_checksum(there);
        grows = grows && (pass > 0 || here->count > before);
        for (int k = 0; k < 2; k++)
            vote[k] = solve_links(solvers[k]);
        even = even && trees_agree(solvers[0]) &&
               forest_checksum(here) == forest_checksum(there) &&
               vote[0].links == vote[1].links && vote[0].split == vote[1].split &&
               vote[0].remaining == vote[1].remaining &&
               vote[0].absorbed == vote[1].absorbed &&
               vote[0].escaped == vote[1].escaped &&
               solvers[0]->turn.iteration == solvers[1]->turn.iteration;
    }
    report(comm, grows && apart, name);
    report(comm, agree, "after a refinement all ranks have the same trees");
    report(comm, alike, "which are those of one rank alone");
    report(comm, even, "and so are the light and the votes, to the bit");
    for (int k = 0; k < 2; k++)
        solver_destroy(solvers[k]);
    octree_destroy(octree);
    scene_destroy(cube);
}

/* Refinement by error in three passes reads light of other ranks, which is made whole at
 * the end only. */
static void test_bounds(const struct comm *comm, const struct comm *self,
                        const struct criterion *criterion)
{
    const struct comm *comms[2] = {comm, self};
    struct solver *solvers[2];
    struct vote vote[2];
    struct scene *cube = cube_create();
    for (int face = 0; face < 6; face++)
        cube->materials[face] =
            (struct material){.reflectance = {{0.5, 0.1 * face, 0.2}},
                              .emission = {{face == 1, 0.0, 0.0}}};
    struct octree *octree = octree_of(cube);
    for (int k = 0; k < 2; k++) {
        solvers[k] = beyond_create(comms[k], cube, octree, criterion);
        solver_link_roots(solvers[k]);
        solver_assign_roots(solvers[k]);
    }
    bool alike = true, dark = comm->size == 1;
    for (int pass = 0; pass < 3; pass++) {
        for (int k = 0; k < 2; k++) {
            solver_refine(solvers[k]);
            vote[k] = iterate_links(solvers[k]);
        }
        dark = dark || !trees_agree(solvers[0]);
        alike = alike && solvers[0]->model.forest->count ==
                             solvers[1]->model.forest->count &&
                vote[0].links == vote[1].links && vote[0].split == vote[1].split;
    }
    solver_complete(solvers[0]);
    report(comm, dark, "default: no rank has all light between passes");
    report(comm, alike && trees_agree(solvers[0]) &&
                     forest_checksum(solvers[0]->model.forest) ==
                         forest_checksum(solvers[1]->model.forest),
           "and links are split as on one rank");
    for (int k = 0; k < 2; k++)
        solver_destroy(solvers[k]);
    octree_destroy(octree);
    scene_destroy(cube);
}

int main(int argc, char **argv)
{
    struct comm comm, self = {.handle = MPI_COMM_SELF, .size = 1};
    comm_start(&comm, &argc, &argv);
    test_migration(&comm);
    test_sums(&comm);
    test_broadcasts(&comm);
    struct criterion criterion = criterion_of(3e-4, 10, 1e-3);
    for (enum balance balance = BALANCE_NONE; balance <= BALANCE_DEFAULT; balance++) {
        criterion.balance = balance;
        test_refinement(&comm, &self, &criterion,
                        "the paper's method: several ranks split links");
    }
    test_proxies(&comm, &self, BALANCE_NONE);
    test_proxies(&comm, &self, BALANCE_GREEDY);
    criterion = criterion_best(4e-5, 10, 1e-4);
    criterion.balance = BALANCE_DEFAULT;
    test_refinement(&comm, &self, &criterion,
                    "error oracle and cg: several ranks split links");
    test_bounds(&comm, &self, &criterion);
    comm_stop(&comm);
    return comm.rank == 0 ? tap_done() : alloc_balance() != 0;
}
