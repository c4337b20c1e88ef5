/* Tests of io/run/store.h, rad/beyond/snapshot.h and mpi/beyond/keep.h on one rank.
 * Proved are: a state restored from a file makes the same file again; a file of another
 * kind, version, scene or setting is refused with the reason; so is one that is cut off
 * or changed at any byte; and numbers that no run could have are refused though the
 * checksum is right. Several ranks: tests/67-restart.sh. */
#include "mpi/beyond/create.h"
#include "tests/fuzz/store.h"

#include "tests/load.h"
#include "tests/memory.h"
#include "tests/tap.h"

#define PATH "build/store_test.bin"
#define AGAIN "build/store_again.bin"

enum { ROOM = 100000 };

static struct comm comm;
static struct scene *scene;
static struct octree *octree;

/* --- a file --- */

static void put(void *writer, const struct link *links, const int *owners, int64_t count)
{
    (void)owners;
    store_put_links(writer, links, count);
}

static bool save(struct solver *solver, const struct vote *vote, const char *path)
{
    struct error error = {0};
    struct store_terms terms = {STORE_CHECKPOINT, STORE_SETTINGS, solver->model.scene,
                                solver->beyond->tree};
    struct snapshot snapshot;
    struct store_writer writer;
    snapshot_collect(solver, vote, &snapshot);
    bool good = store_create(&writer, path, &terms, &snapshot, &error);
    snapshot_free(&snapshot);
    links_collect(solver, put, &writer);
    return good && store_finish(&writer, &error);
}

/* A run that has two passes behind it. State that only other methods change, --accuracy
 * among them, is given values, so that none is its first one. */
static struct solver *run_two_passes(struct vote *vote)
{
    struct criterion criterion = STORE_CRITERION;
    criterion.epsilon = 0.04;
    criterion.max_iterations = 100;
    struct solver *solver = beyond_create(&comm, scene, octree, &criterion);
    solver_link_roots(solver);
    solver_assign_roots(solver);
    for (int pass = 0; pass < 2; pass++) {
        solver_refine(solver);
        *vote = solve_links(solver);
        if (pass == 0) {
            solver->model.criterion.epsilon /= 4.0;
            solver->model.link_threshold /= 4.0;
        }
    }
    solver->model.criterion.accuracy = 0.01;
    solver->model.criterion.final_gather = 128;
    solver->beyond->accuracy =
        (struct accuracy){.rounds = 3, .coarse = 0.5, .coarse_epsilon = 0.25};
    solver->model.walled_off = 56;
    solver->memory.limit = solver->memory.reached = 78;
    return solver;
}

static void test_round_trip(void)
{
    static uint8_t bytes[ROOM], again[ROOM];
    struct vote vote;
    struct error error = {0};
    struct solver *solver = run_two_passes(&vote);
    bool written = save(solver, &vote, PATH);
    struct store_terms terms = {STORE_CHECKPOINT, STORE_SETTINGS, scene, NULL};
    struct store_reader reader;
    struct criterion criterion = solver->model.criterion;
    criterion.final_gather = 64; /* as the run began */
    struct solver *other = beyond_create(&comm, scene, octree, &criterion);
    struct link *links = alloc_array(ROOM, sizeof *links);
    other->memory.limit = solver->memory.limit;
    tap_ok(written && store_open(&reader, PATH, &terms, &error) &&
               reader.snapshot.patch_count > reader.snapshot.root_count,
           "a checkpoint with split patches is written, and read");
    int32_t *order = snapshot_restore(other, &vote, &reader.snapshot);
    int64_t count = store_get_links(&reader, links, ROOM, &error);
    links_deal(other, order, links, count);
    solver_assign_roots(other);
    tap_ok(count == solver->links.count &&
               store_get_links(&reader, links, ROOM, &error) == 0 &&
               error.code == EXIT_DONE,
           "with all links");
    tap_ok(other->turn.pass == 2 && other->turn.iteration == solver->turn.iteration &&
               other->model.criterion.epsilon == criterion.epsilon &&
               other->model.criterion.final_gather == 128 && other->memory.rays == 128 &&
               other->beyond->accuracy.rounds == 3 &&
               other->beyond->accuracy.coarse == 0.5 &&
               other->beyond->accuracy.coarse_epsilon == 0.25 &&
               forest_count(other->model.forest).patches ==
                   forest_count(solver->model.forest).patches,
           "the restored state is the same");
    written = save(other, &vote, AGAIN);
    size_t size = load(PATH, bytes, ROOM);
    tap_ok(written && size > 0 && size == load(AGAIN, again, ROOM) &&
               memcmp(bytes, again, size) == 0,
           "written again it is the same file");
    alloc_free(order);
    alloc_free(links);
    store_close(&reader);
    solver_destroy(other);
    solver_destroy(solver);
    remove(AGAIN);
}

/* --- refusals --- */

/* Opens the bytes as a file and reads all; the message is in `error`. */
static bool takes(const uint8_t *bytes, size_t size, const struct store_terms *terms,
                  struct error *error)
{
    struct link links[100];
    struct store_reader reader;
    *error = (struct error){0};
    bool good = store_open_file(&reader, file_of_bytes(bytes, size), "F", terms, error);
    while (good && store_get_links(&reader, links, 100, error) > 0) {
    }
    store_close(&reader);
    return good && error->code == EXIT_DONE;
}

static bool refuses(const uint8_t *bytes, size_t size, const struct store_terms *terms,
                    const char *text)
{
    struct error error;
    bool refused = !takes(bytes, size, terms, &error) && error.code == EXIT_USAGE &&
                   strncmp(error.text, text, strlen(text)) == 0;
    if (!refused)
        printf("# expected '%s', got '%s'\n", text, error.text);
    return refused;
}

static void test_refusals(const uint8_t *bytes, size_t size)
{
    /* Of two others the last is named, but not one that this run does not have. */
    static const char *const SETTINGS[][2] = {
        {"--oracle bf\n--epsilon 0.02\n",
         "F: made with --epsilon 0.01, this run has --epsilon 0.02"},
        {"--oracle bf\n", "F: made with --oracle error, this run has --oracle bf"}};
    static uint8_t changed[ROOM];
    struct store_terms right = {STORE_CHECKPOINT, STORE_SETTINGS, scene, NULL},
                       wrong = right;
    struct error error;
    tap_ok(takes(bytes, size, &right, &error), "the file is taken");
    wrong.kind = STORE_LINKS;
    tap_ok(refuses(bytes, size, &wrong, "F: not a link cache but a checkpoint"),
           "another kind");
    wrong = right;
    for (size_t i = 0; i < sizeof SETTINGS / sizeof SETTINGS[0]; i++) {
        wrong.settings = SETTINGS[i][0];
        tap_ok(refuses(bytes, size, &wrong, SETTINGS[i][1]), "%s", SETTINGS[i][1]);
    }
    struct scene *other = store_scene();
    wrong = (struct store_terms){STORE_CHECKPOINT, STORE_SETTINGS, other, NULL};
    tap_ok(takes(bytes, size, &wrong, &error), "the same scene again is the same scene");
    other->materials[1].reflectance.band[2] = 0.25;
    tap_ok(refuses(bytes, size, &wrong, "F: made from another scene"),
           "another material");
    scene_destroy(other);
    memcpy(changed, bytes, size);
    changed[7] = '1';
    tap_ok(refuses(changed, size, &right, "F: a checkpoint of version 1"),
           "another version");
    tap_ok(refuses((const uint8_t *)"solid things", 12, &right, "F: not a checkpoint"),
           "another format");
    struct store_reader reader;
    error = (struct error){0};
    tap_ok(!store_open(&reader, "build/absent.bin", &right, &error) &&
               strstr(error.text, "build/absent.bin: cannot read: ") == error.text,
           "no file");
    store_close(&reader);
}

static void test_damage(const uint8_t *bytes, size_t size)
{
    static uint8_t changed[ROOM];
    struct store_terms terms = {STORE_CHECKPOINT, STORE_SETTINGS, scene, NULL};
    struct error error;
    size_t taken = 0;
    for (size_t cut = 0; cut < size; cut++)
        taken += takes(bytes, cut, &terms, &error);
    tap_ok(taken == 0, "cut off anywhere it is refused");
    memcpy(changed, bytes, size);
    for (size_t at = 0; at < size; at++)
        for (int bit = 0; bit < 8; bit++) {
            changed[at] ^= (uint8_t)(1 << bit);
            taken += takes(changed, size, &terms, &error);
            changed[at] ^= (uint8_t)(1 << bit);
        }
    tap_ok(taken == 0, "with any bit changed it is refused");
    memcpy(changed, bytes, size);
    memcpy(changed + size, "x", 1);
    tap_ok(!takes(changed, size + 1, &terms, &error), "with a byte more it is refused");
}

/* Places in the file of a checkpoint with these settings; see io/run/store.h. */
enum { NUMBERS_AT = 40 + sizeof STORE_SETTINGS - 1,
       VALUES_AT = NUMBERS_AT + 8 * SNAPSHOT_NUMBERS,
       SPLITS_AT = VALUES_AT + 8 * SNAPSHOT_VALUES };

/* With the bytes in place of those at `at`, and a checksum that is right. */
static bool refuses_forged(const uint8_t *bytes, size_t size,
                           const struct store_terms *terms, size_t at,
                           const void *others, size_t count, const char *text)
{
    static uint8_t changed[ROOM];
    memcpy(changed, bytes, size);
    memcpy(changed + at, others, count);
    little_put64(changed + size - 8, hash_bytes(HASH_START, changed, size - 8));
    return refuses(changed, size, terms, text);
}

static bool refuses_with(const uint8_t *bytes, size_t size, size_t at, const void *others,
                         size_t count, const char *text)
{
    struct store_terms terms = {STORE_CHECKPOINT, STORE_SETTINGS, scene, NULL};
    return refuses_forged(bytes, size, &terms, at, others, count, text);
}

static void test_lies(const uint8_t *bytes, size_t size)
{
    static const char *const RANGE = "F: damaged: a number in it is out of range";
    static const char *const LINK = "F: damaged: a link in it cannot be";
    size_t links = (size_t)little_get64(bytes + 32), last = size - 8 - 24;
    size_t patches = (size_t)little_get64(bytes + 24), leaves_at = SPLITS_AT + patches;
    uint8_t nan[8], huge[8], minus[8], many[8], rays[8];
    little_put_double(nan, NAN);
    little_put_double(huge, 1e38);
    little_put64(minus, UINT64_MAX);
    little_put64(many, UINT64_C(1) << 62);
    little_put64(rays, GATHER_RAYS_MOST + 1);
    tap_ok(links >= 2, "there are links to change");
    for (size_t at = 20; at <= 32; at += at == 20 ? 4 : 8)
        tap_ok(refuses_with(bytes, size, at,
                            at == 20 ? "\xff\xff\xff\x7f" : (const char *)many,
                            at == 20 ? 4 : 8, "F: damaged: its size"),
               "a count at byte %d that lies", (int)at);
    tap_ok(refuses_with(bytes, size, NUMBERS_AT, minus, 8, RANGE), "-1 passes");
    tap_ok(refuses_with(bytes, size, NUMBERS_AT + 8 * SNAPSHOT_GATHER, rays, 8, RANGE),
           "more rays than a leaf can have");
    tap_ok(refuses_with(bytes, size, VALUES_AT, nan, 8, RANGE),
           "a bound that is no number");
    tap_ok(refuses_with(bytes, size, SPLITS_AT, "\0", 1,
                        "F: damaged: its patches are no trees"),
           "a split root that is a leaf");
    tap_ok(refuses_with(bytes, size, SPLITS_AT, "\2", 1,
                        "F: damaged: its patches are no trees"),
           "a split that is none");
    tap_ok(refuses_with(bytes, size, leaves_at, nan, 8, RANGE) &&
               refuses_with(bytes, size, leaves_at, huge, 8, RANGE) &&
               refuses_with(bytes, size, leaves_at + 24, nan, 8, RANGE),
           "light that is no number or too much");
    tap_ok(refuses_with(bytes, size, last, "\xff\xff\xff\x7f", 4, LINK) &&
               refuses_with(bytes, size, last, "\xff\xff\xff\xff", 4, LINK),
           "a link of a patch that does not exist");
    tap_ok(refuses_with(bytes, size, last, bytes + last + 4, 4, LINK), "with itself");
    tap_ok(refuses_with(bytes, size, last, bytes + last - 24, 24, LINK),
           "twice the same");
    tap_ok(refuses_with(bytes, size, last - 24, bytes + last, 24, LINK), "out of order");
    tap_ok(refuses_with(bytes, size, last + 8, "\0\0\xc0\x7f", 4, LINK) &&
               refuses_with(bytes, size, last + 8, "\0\0\x80\x3f", 4, LINK) &&
               refuses_with(bytes, size, last + 8, "\0\0\x80\xbf", 4, LINK),
           "an exchange area that is no number, too large, negative");
    tap_ok(refuses_with(bytes, size, last + 12, "\x02\0\0\0", 4, LINK),
           "an absent blocker");
    tap_ok(refuses_with(bytes, size, last + 16, "\xff\x02\0", 3, LINK),
           "parts of more than all");
    tap_ok(refuses_with(bytes, size, last + 22, "\xff", 1, LINK),
           "a visibility that is none");
}

/* --- clusters --- */

/* A box with a lamp in it, coarsely linked. */
static struct solver *run_with_clusters(struct scene *box, struct octree *over,
                                        struct vote *vote)
{
    struct criterion criterion = store_criterion_tree();
    struct solver *solver = beyond_create(&comm, box, over, &criterion);
    solver_link_roots(solver);
    solver_assign_roots(solver);
    solver_refine(solver);
    *vote = solve_links(solver);
    return solver;
}

/* The first link has a cluster for p, and is forged. */
static void test_forged_clusters(const uint8_t *bytes, size_t size,
                                 const struct store_terms *terms)
{
    static const struct {
        size_t at;
        const char *bytes; /* 4 of them */
        const char *name;
    } LIES[] = {{0, "\0\0\0\x80", "the lowest number there is"},
                {0, "\x9c\xff\xff\xff", "cluster 99"},
                {8, "\0\0\xc0\x7f", "an area that is no number"},
                {12, "\xff\xff\xff\xff", "a blocker"},
                {12, "\0\0\x80\x7f", "a judgement that is infinite"},
                {20, "\x40\x40\xfd\1", "a way that is proved to be open"}};
    size_t first = size - 8 - 24 * (size_t)little_get64(bytes + 32);
    for (size_t i = 0; i < sizeof LIES / sizeof LIES[0]; i++)
        tap_ok(refuses_forged(bytes, size, terms, first + LIES[i].at, LIES[i].bytes, 4,
                              "F: damaged: a link in it cannot be"),
               "a link of a cluster: %s", LIES[i].name);
}

static void test_clusters(void)
{
    static uint8_t bytes[ROOM];
    struct scene *box = store_box();
    struct octree *over = octree_of(box);
    struct vote vote;
    struct solver *solver = run_with_clusters(box, over, &vote);
    struct store_terms terms = {STORE_CHECKPOINT, STORE_SETTINGS, box,
                                solver->beyond->tree};
    struct error error;
    int64_t clusters = 0;
    for (int64_t i = 0; i < solver->links.count; i++)
        clusters += node_is_cluster(solver->links.items[i].p);
    bool saved = save(solver, &vote, PATH);
    size_t size = load(PATH, bytes, ROOM);
    tap_ok(saved && solver->beyond->tree->count < 99 && clusters > 0 &&
               takes(bytes, size, &terms, &error),
           "a checkpoint with links of clusters: %lld of %lld", (long long)clusters,
           (long long)solver->links.count);
    test_forged_clusters(bytes, size, &terms);
    terms.tree = NULL;
    tap_ok(refuses(bytes, size, &terms, "F: damaged: a link in it cannot be"),
           "where there are no clusters there are no links of them");
    solver_destroy(solver);
    octree_destroy(over);
    scene_destroy(box);
}

int main(int argc, char **argv)
{
    static uint8_t bytes[ROOM];
    comm_start(&comm, &argc, &argv);
    scene = store_scene();
    octree = octree_of(scene);
    test_round_trip();
    size_t size = load(PATH, bytes, ROOM);
    test_refusals(bytes, size);
    test_damage(bytes, size);
    test_lies(bytes, size);
    test_clusters();
    remove(PATH);
    octree_destroy(octree);
    scene_destroy(scene);
    comm_stop(&comm);
    return tap_done();
}
