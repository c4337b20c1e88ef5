/* Fuzzing stored snapshots: the common part of both harnesses.
 *
 * A checksum would stop a fuzzer at the door, so the right one is put at the end of every
 * input first. A snapshot that the reader takes is restored, refined and solved for one
 * iteration: it promises to let nothing in that the method cannot live with. The scene is
 * two triangles that face each other, a lamp and a wall; with a tree above the roots, a
 * box with a lamp in it. */
#ifndef TESTS_FUZZ_STORE_H
#define TESTS_FUZZ_STORE_H

#include "mpi/beyond/create.h"
#include "geom/hash.h"
#include "geom/little.h"
#include "io/run/store.h"
#include "mpi/beyond/keep.h"
#include "tests/fuzz/fuzz.h"
#include "tests/scenes.h"
#include "tests/memory.h"
#include "tests/solve.h"

#define STORE_SETTINGS "--oracle error\n--epsilon 0.01\n"

static const struct criterion STORE_CRITERION = {
    .oracle = ORACLE_ERROR, .form_factor = FORM_FACTOR_POLYGON, .solver = SOLVER_CG,
    .epsilon = 0.01, .max_level = 2, .tolerance = 1e-3, .max_iterations = 3};

static inline struct scene *store_scene(void)
{
    struct scene *scene = scene_create(2, 2);
    scene->triangles[0] = (struct triangle){{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    scene->triangles[1] = (struct triangle){{{0, 0, 1}, {0, 1, 1}, {1, 0, 1}}};
    scene->material_of[1] = 1;
    scene->materials[0] = material_grey(0.0, 1.0);
    scene->materials[1] = material_grey(0.5, 0.0);
    return prepared(scene);
}

static inline struct scene *store_box(void)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), 1, true);
    paint(&soup, 0.5, 0.0);
    paint(&soup, 0.0, 10.0);
    struct scene *scene = scene_of_soup(&soup);
    scene->material_of[0] = scene->material_of[1] = 1;
    return prepared(scene);
}

/* The same for runs with links of clusters. */
static inline struct criterion store_criterion_tree(void)
{
    struct criterion criterion = STORE_CRITERION;
    criterion.linking = LINKING_TREE;
    criterion.epsilon = 1.0;
    criterion.max_level = 0;
    return criterion;
}

/* All links of an open file, then a pass. Returns false if a link is refused. */
static inline bool store_continue(struct store_reader *reader, struct solver *solver,
                                  struct error *error)
{
    enum { BLOCK = 100 };
    struct link block[BLOCK];
    struct vote vote;
    int32_t *order = snapshot_restore(solver, &vote, &reader->snapshot);
    for (int64_t count = BLOCK; count > 0;) {
        count = store_get_links(reader, block, BLOCK, error);
        links_deal(solver, order, block, count);
    }
    alloc_free(order);
    if (error->code == EXIT_DONE) {
        FUZZ_PROMISE(solver->links.count == reader->snapshot.link_count);
        solver_assign_roots(solver);
        solver_refine(solver);
        solve_links(solver);
    }
    return error->code == EXIT_DONE;
}

static inline void store_try(enum store_kind kind, enum linking_kind linking,
                             const uint8_t *data, size_t size)
{
    struct error error = {0};
    uint8_t *copy = malloc(size + !size);
    memcpy(copy, data, size);
    if (size >= 8)
        little_put64(copy + size - 8, hash_bytes(HASH_START, copy, size - 8));
    bool pairs = linking == LINKING_PAIRS;
    struct criterion criterion = pairs ? STORE_CRITERION : store_criterion_tree();
    struct scene *scene = pairs ? store_scene() : store_box();
    struct octree *octree = octree_of(scene);
    struct solver *solver = beyond_create(fuzz_alone(), scene, octree, &criterion);
    struct store_terms terms = {kind, STORE_SETTINGS, scene, solver->beyond->tree};
    struct store_reader reader;
    bool good = store_open_file(&reader, file_of_bytes(copy, size), "fuzz", &terms,
                                &error) &&
                store_continue(&reader, solver, &error);
    store_close(&reader);
    solver_destroy(solver);
    octree_destroy(octree);
    scene_destroy(scene);
    free(copy);
    fuzz_verdict(good, &error);
}

#endif
