/* The exchanges of the distributed algorithm on a made-up forest, on any number of ranks: gather,
 * push-pull and scatter end with the same forest as one rank alone, links that migrate arrive
 * once and mean the same, and the vote adds up to the same sums. Collectives give what they say,
 * and a cube is refined alike on all ranks.
 *
 * Every rank knows all of the made-up links and holds those that a hash deals to it; beside the
 * parallel solver runs one on MPI_COMM_SELF that holds them all. To be run with mpiexec; rank 0
 * reports. */
#include "mpi/assign.h"
#include "mpi/broadcast.h"
#include "mpi/migrate.h"
#include "mpi/picture.h"
#include "rad/treecode.h"

#include <string.h>

#include "tests/random.h"
#include "tests/solve.h"
#include "tests/tap.h"

enum { ROOTS = 23, LINKS = 4000 };

/* A scene of triangles with all the material that the exchanges need: areas and reflectances. */
static struct scene *make_scene(void)
{
    struct scene *scene = scene_create(ROOTS, 2);
    struct random random = random_seed(3);
    for (int32_t i = 0; i < ROOTS; i++) {
        scene->areas[i] = 0.01 + 0.1 * random_unit(&random);
        scene->material_of[i] = i % 5 == 0;
    }
    scene->materials[0].reflectance = (struct rgb){{0.5, 0.7, 0.2}};
    scene->materials[1].reflectance = (struct rgb){{0.9, 0.1, 0.4}};
    scene->materials[1].emission = (struct rgb){{3.0, 2.0, 1.0}};
    return scene;
}

static struct patch_id random_id(struct random *random)
{
    struct patch_id id = id_of_root((uint32_t)(random_bits(random) % ROOTS));
    int level = (int)(random_bits(random) % 5);
    for (int k = 0; k < level; k++)
        id = id_child(id, (int)(random_bits(random) % 4));
    return id;
}

/* A fifth of the links are dealt to nobody in the first round: their patches appear later. */
static void add_links(struct solver *solver, int round)
{
    struct random random = random_seed(99);
    for (int i = 0; i < LINKS; i++) {
        struct patch_id p = random_id(&random), q = random_id(&random);
        double area = 1e-5 * random_unit(&random);
        uint64_t dealt = random_bits(&random);
        if ((i % 5 == 0) != (round == 1) || dealt % (uint64_t)solver->comm->size !=
                                                (uint64_t)solver->comm->rank)
            continue;
        int32_t a = forest_reach(solver->method.forest, p);
        int32_t b = forest_reach(solver->method.forest, q);
        link_list_append(&solver->links, (struct link){
            .p = a, .q = b, .area = float_below(area), .blocker = i,
            .parts_p = {(uint8_t)(i % 80), 64, 20}, .parts_q = {1, (uint8_t)(i % 100), 0},
            .seen = (uint8_t)(i % 256), .cost = (uint8_t)(i / 256)});
    }
}

static struct solver *make_solver(const struct comm *comm, const struct scene *scene)
{
    const struct criterion criterion = {.epsilon = 1.0, .tolerance = 1e-3, .max_level = 15};
    struct solver *solver = solver_create(comm, scene, NULL, &criterion);
    roots_assign(scene, comm->size, solver->owner);
    for (int32_t root = 0; root < ROOTS; root++)
        solver->own[root] = solver->owner[root] == comm->rank;
    return solver;
}

/* Makes the trees of all ranks equal, as a refinement does at its end. */
static void share_patches(struct solver *solver)
{
    struct bytes own = {0};
    struct forest *forest = solver->method.forest;
    for (int64_t p = 0; p < forest->count; p++) {
        const uint8_t *id = (const uint8_t *)&forest->patches[p].id;
        for (size_t k = 0; k < sizeof forest->patches[p].id; k++)
            bytes_append(&own, id[k]);
    }
    int *at = alloc_array((size_t)solver->comm->size + 1, sizeof *at);
    uint8_t *all = comm_gather_all(solver->comm, own.data, own.count, at);
    for (int i = 0; i < at[solver->comm->size]; i += (int)sizeof(struct patch_id)) {
        struct patch_id id;
        memcpy(&id, all + i, sizeof id);
        forest_reach(forest, id);
    }
    alloc_free(all);
    alloc_free(at);
    bytes_free(&own);
}

/* One iteration without refinement; in rounds 0 and 1 new links come with new patches. */
static struct vote iterate(struct solver *solver, int round)
{
    solver->first_new = solver->method.forest->count;
    if (round < 2)
        add_links(solver, round);
    share_patches(solver);
    solver_close(solver);
    solver_transfer(solver);
    solver_gather(solver);
    solver_push_pull(solver);
    solver_scatter(solver);
    return solver_vote(solver);
}

/* True on all ranks if it is on all of them. */
static bool on_all(const struct comm *comm, bool here)
{
    struct error error = {0};
    if (!here)
        error_set(&error, EXIT_FAILED, "rank %d", comm->rank);
    return comm_agree(comm, &error);
}

static void report(const struct comm *comm, bool here, const char *name)
{
    bool all = on_all(comm, here);
    if (comm->rank == 0)
        tap_ok(all, "%s", name);
}

static void test_rounds(struct solver *parallel, struct solver *alone)
{
    const struct comm *comm = parallel->comm;
    bool same_forest = true, same_vote = true, same_size = true;
    for (int round = 0; round < 4; round++) {
        struct vote a = iterate(parallel, round), b = iterate(alone, round);
        same_forest = same_forest && forest_checksum(parallel->method.forest) ==
                                         forest_checksum(alone->method.forest);
        same_size = same_size && parallel->method.forest->count == alone->method.forest->count;
        same_vote = same_vote && a.links == b.links && a.absorbed == b.absorbed &&
                    a.escaped == b.escaped && a.remaining == b.remaining;
    }
    report(comm, same_forest, "four iterations: the same trees as on one rank, to the bit");
    report(comm, same_size, "no rank has a patch that another lacks");
    report(comm, same_vote, "the votes agree with one rank's, to the bit");
}

static int64_t total_of(const struct comm *comm, int64_t own)
{
    int64_t sum;
    MPI_Request request;
    MPI_Iallreduce(&own, &sum, 1, MPI_INT64_T, MPI_SUM, comm->handle, &request);
    comm_wait(&request);
    return sum;
}

/* Sum over links of a number that depends on all that a link says. */
static int64_t fingerprint(const struct solver *solver)
{
    uint64_t sum = 0;
    for (int64_t i = 0; i < solver->links.count; i++) {
        const struct link *link = &solver->links.items[i];
        struct patch_id p = solver->method.forest->patches[link->p].id;
        struct patch_id q = solver->method.forest->patches[link->q].id;
        uint64_t word = p.root + 31u * (uint64_t)p.hierarchy + 1009u * (uint64_t)q.root +
                        99991u * (uint64_t)q.hierarchy + 7u * (uint64_t)link->cost;
        for (int k = 0; k < 3; k++)
            word = 257u * word + 65537u * (uint64_t)link->parts_p[k] + (uint64_t)link->parts_q[k];
        word = 259u * word + 17u * (uint64_t)(uint32_t)link->blocker + (uint64_t)link->seen;
        sum += (word * UINT64_C(0x9E3779B97F4A7C15) >> 16) + (uint64_t)((double)link->area * 1e15);
    }
    return (int64_t)(sum & UINT64_C(0xffffffffffff));
}

static void test_migration(struct solver *parallel, struct solver *alone)
{
    const struct comm *comm = parallel->comm;
    int64_t before = total_of(comm, fingerprint(parallel)) & INT64_C(0xffffffffffff);
    int64_t count = total_of(comm, parallel->links.count);
    bool right_place = true;
    for (int turn = 1; turn <= 3; turn++) {
        int *destination = alloc_array((size_t)parallel->links.count, sizeof *destination);
        for (int64_t i = 0; i < parallel->links.count; i++)
            destination[i] = parallel->links.items[i].blocker / turn % comm->size;
        links_migrate(parallel, &parallel->links, destination);
        alloc_free(destination);
        for (int64_t i = 0; i < parallel->links.count; i++)
            right_place = right_place && parallel->links.items[i].blocker / turn % comm->size ==
                                             comm->rank;
    }
    int64_t after = total_of(comm, fingerprint(parallel)) & INT64_C(0xffffffffffff);
    report(comm, right_place, "each link is where it was sent");
    report(comm, count == total_of(comm, parallel->links.count) && before == after,
           "links that migrate arrive once and unchanged");
    iterate(parallel, 2);
    iterate(alone, 2);
    report(comm, forest_checksum(parallel->method.forest) == forest_checksum(alone->method.forest),
           "and carry the same light from their new ranks");
}

/* --- collectives --- */

/* Rank r gives r % 3 * 5 bytes: some give none. */
static void test_gather_all(const struct comm *comm)
{
    uint8_t own[10];
    int bytes = comm->rank % 3 * 5, expected = 0;
    for (int i = 0; i < bytes; i++)
        own[i] = (uint8_t)(20 * comm->rank + i);
    int *at = alloc_array((size_t)comm->size + 1, sizeof *at);
    uint8_t *all = comm_gather_all(comm, own, bytes, at);
    bool right = true;
    for (int r = 0; r < comm->size; r++) {
        right = right && at[r] == expected;
        for (int i = 0; i < r % 3 * 5; i++)
            right = right && all[expected + i] == (uint8_t)(20 * r + i);
        expected += r % 3 * 5;
    }
    right = right && at[comm->size] == expected;
    alloc_free(all);
    all = comm_gather_all(comm, own, 0, at);
    right = right && at[comm->size] == 0;
    report(comm, right, "the bytes of all ranks in their order, also none at all");
    alloc_free(all);
    alloc_free(at);
}

static void test_sums(const struct comm *comm)
{
    int size = comm->size;
    double values[4] = {comm->rank == size / 2 ? 1e300 : -1.0, -1.0 - comm->rank,
                        comm->rank - 0.5 * size, comm->rank == size - 1 ? HUGE_VAL : 0.0};
    bool right = comm_largest(comm, values[0]) == 1e300 && comm_largest(comm, values[1]) == -1.0 &&
                 comm_largest(comm, values[2]) == size - 1 - 0.5 * size &&
                 comm_largest(comm, values[3]) == HUGE_VAL;
    report(comm, right, "the largest value of all ranks, whatever its sign");
    uint8_t bytes[6] = {1, (uint8_t)comm->rank, 0, comm->rank == 0 ? 255 : 0,
                        (uint8_t)(comm->rank == size - 1), 9};
    comm_add_bytes(comm, bytes, 5);
    right = bytes[0] == size && bytes[1] == size * (size - 1) / 2 && bytes[2] == 0 &&
            bytes[3] == 255 && bytes[4] == 1 && bytes[5] == 9;
    report(comm, right, "bytes are added over all ranks, and no others");
}

/* The scene of rank 0 comes to all, with normals if it has some. */
static void test_broadcast(const struct comm *comm, bool normals)
{
    struct scene *scene = NULL;
    if (comm->rank == 0) {
        scene = make_scene();
        scene->two_sided = true;
        scene->exponent = 7;
        if (normals)
            scene_add_normals(scene);
        for (int i = 0; i < 3 * ROOTS && normals; i++)
            scene->normals[i] = (struct vec3){i, 0.5, -i};
    }
    scene = scene_broadcast(comm, scene);
    bool right = scene->input_count == ROOTS && scene->two_sided && scene->exponent == 7 &&
                 scene->materials[1].emission.band[1] == 2.0 && scene->areas[ROOTS - 1] > 0.0 &&
                 strcmp(scene->group_names, "default") == 0 && !scene->normals == !normals;
    for (int i = 0; i < 3 * ROOTS && right && normals; i++)
        right = scene->normals[i].x == i && scene->normals[i].z == -i;
    report(comm, right, normals ? "a scene comes to all ranks" : "also one without normals");
    scene_destroy(scene);
}

/* --- refinement --- */

/* Whether all ranks have the trees of rank 0. */
static bool trees_agree(const struct solver *solver)
{
    uint64_t own = forest_checksum(solver->method.forest), first = own;
    comm_broadcast(solver->comm, &first, sizeof first);
    return on_all(solver->comm, own == first);
}

/* A cube, refined twice: right after a refinement all ranks have the same trees, which are those
 * that one rank makes, though the links that split them live on different ranks. */
static void test_refinement(const struct comm *comm, const struct comm *self,
                            const struct criterion *criterion, const char *name)
{
    const struct comm *comms[2] = {comm, self};
    struct solver *solvers[2];
    struct scene *cube = cube_create();
    for (int face = 0; face < 6; face++)
        cube->materials[face] = (struct material){{{0.3 + 0.1 * face, 0.5, 0.2}},
                                                  {{face == 1, face == 1, face == 2}}};
    struct octree *octree = octree_create(cube->triangles, cube->planes, cube->input_count);
    for (int k = 0; k < 2; k++) {
        solvers[k] = solver_create(comms[k], cube, octree, criterion);
        solver_link_roots(solvers[k]);
        solver_assign_roots(solvers[k]);
    }
    bool agree = true, alike = true, grows = true, apart = true, even = true;
    for (int pass = 0; pass < 3; pass++) {
        struct vote vote[2];
        int64_t before = solvers[0]->method.forest->count;
        for (int k = 0; k < 2; k++)
            solver_refine(solvers[k]);
        const struct forest *here = solvers[0]->method.forest, *there = solvers[1]->method.forest;
        int64_t split = total_of(comm, solvers[0]->split_here);
        apart = apart && (comm->size == 1 || pass > 0 || solvers[0]->split_here < split);
        agree = agree && trees_agree(solvers[0]);
        alike = alike && here->count == there->count &&
                forest_checksum(here) == forest_checksum(there);
        grows = grows && (pass > 0 || here->count > before);
        for (int k = 0; k < 2; k++)
            vote[k] = solve_links(solvers[k]);
        even = even && trees_agree(solvers[0]) && forest_checksum(here) == forest_checksum(there) &&
               vote[0].links == vote[1].links && vote[0].split == vote[1].split &&
               vote[0].remaining == vote[1].remaining && vote[0].absorbed == vote[1].absorbed &&
               vote[0].escaped == vote[1].escaped &&
               solvers[0]->iteration == solvers[1]->iteration;
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

/* With more ranks than roots some own nothing; the picture has fewer rows than ranks too. */
static void test_picture(const struct comm *comm)
{
    enum { HEIGHT = 5, ROW = 6 };
    float rows[HEIGHT * ROW] = {0};
    int mine = 0;
    for (int y = comm->rank; y < HEIGHT; y += comm->size)
        for (int x = 0; x < ROW; x++)
            rows[mine++] = (float)(100 * y + x);
    float *picture = picture_gather(comm, rows, ROW, HEIGHT);
    bool right = (picture != NULL) == (comm->rank == 0);
    for (int i = 0; i < HEIGHT * ROW && picture; i++)
        right = right && picture[i] == (float)(100 * (i / ROW) + i % ROW);
    report(comm, right, "rows of a picture find their places");
    alloc_free(picture);
}

int main(int argc, char **argv)
{
    struct comm comm, self = {MPI_COMM_SELF, 0, 1};
    comm_start(&comm, &argc, &argv);
    struct scene *scene = make_scene();
    struct solver *parallel = make_solver(&comm, scene), *alone = make_solver(&self, scene);
    test_rounds(parallel, alone);
    test_migration(parallel, alone);
    test_picture(&comm);
    test_gather_all(&comm);
    test_sums(&comm);
    test_broadcast(&comm, true);
    test_broadcast(&comm, false);
    struct criterion criterion = criterion_of(3e-4, 10, 1e-3);
    test_refinement(&comm, &self, &criterion, "the paper's method: several ranks split links");
    for (enum closure_kind kind = CLOSURE_NONE; kind <= CLOSURE_SYMMETRIC; kind++) {
        criterion = criterion_best(3e-4, 10, 1e-4, kind);
        test_refinement(&comm, &self, &criterion, "error oracle and cg: several ranks split links");
    }
    solver_destroy(parallel);
    solver_destroy(alone);
    scene_destroy(scene);
    comm_stop(&comm);
    return comm.rank == 0 ? tap_done() : alloc_balance() != 0;
}
