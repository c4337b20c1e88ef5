/* Tests of forest_checksum() of rad/patch.h: small trees by their literal bytes; it is
 * blind to the order of creation and to nothing else. */
#include <string.h>

#include "tests/scenes.h"
#include "tests/tap.h"

enum { ROOTS = 7, PATHS = 120 };

static struct scene *make_scene(void)
{
    struct soup soup = {0};
    struct random random = random_seed(1);
    soup_add_random(&soup, &random, ROOTS, 0.5, 0.3);
    soup.items[3].corner[0] = soup.items[3].corner[1]; /* dropped; it has a tree all
                                                          the same */
    return prepared(scene_of_soup(&soup));
}

static void random_ids(uint64_t seed, struct patch_id ids[PATHS])
{
    struct random random = random_seed(seed);
    for (int i = 0; i < PATHS; i++)
        ids[i] = random_id(&random, ROOTS, i == 0 ? ID_MAX_LEVEL : 5);
}

/* Values that depend on the ID alone, whatever the local number. */
static void set_values(struct forest *forest)
{
    for (int64_t p = 0; p < forest->count; p++) {
        struct patch_id id = forest->patches[p].id;
        struct random random = random_seed(id_number(id));
        for (int c = 0; c < BANDS; c++)
            forest->radiosity[p].band[c] = random_unit(&random);
    }
}

static struct forest *make_forest(const struct scene *scene, const struct patch_id *ids,
                                  bool backwards)
{
    struct forest *forest = forest_create(scene);
    for (int i = 0; i < PATHS; i++)
        forest_reach(forest, ids[backwards ? PATHS - 1 - i : i]);
    set_values(forest);
    return forest;
}

/* --- the bytes --- */

/* FNV-1a, from the definition. */
static uint64_t hash_of(const uint8_t *bytes, size_t count)
{
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    for (size_t i = 0; i < count; i++)
        hash = (hash ^ bytes[i]) * UINT64_C(0x100000001b3);
    return hash;
}

/* Root 1 split, its child 2 split: depth first 1 00 1 0000 0, so the bytes 09 and 00;
 * then 7 leaves. Of the other roots, which are leaves without light, a byte and three
 * numbers each. */
static void test_format(const struct scene *scene)
{
    uint8_t bytes[ROOTS * 25 + 1 + 6 * 24] = {0};
    static const uint8_t leaf_bytes[24] = {0, 0, 0, 0, 0, 0, 0xF0, 0x3F, 0, 0, 0, 0,
                                           0, 0, 0, 0xC0, 1, 0, 0, 0,    0, 0, 0, 0};
    struct forest *forest = forest_create(scene);
    int32_t leaf = forest_reach(forest, id_child(id_child(id_of_root(1), 2), 1));
    forest->radiosity[leaf] = (struct rgb){{1.0, -2.0, 0x1p-1074}};
    bytes[25] = 0x09;
    /* after leaves 0, 1, 20 */
    memcpy(bytes + 25 + 2 + 3 * 24, leaf_bytes, sizeof leaf_bytes);
    tap_ok(
        forest_checksum(forest) == hash_of(bytes, sizeof bytes),
        "structure bits, the first in the lowest place, then the leaves' numbers, least "
        "significant byte first");
    forest_destroy(forest);
}

/* --- checksum --- */

static void test_order(const struct scene *scene)
{
    struct patch_id ids[PATHS];
    random_ids(30, ids);
    struct forest *a = make_forest(scene, ids, false), *b = make_forest(scene, ids, true);
    bool numbers_differ = false;
    for (int64_t p = 0; p < a->count; p++)
        numbers_differ =
            numbers_differ || a->patches[p].id.hierarchy != b->patches[p].id.hierarchy;
    tap_ok(numbers_differ && forest_checksum(a) == forest_checksum(b),
           "the checksum does not depend on the order of creation");
    forest_destroy(a);
    forest_destroy(b);
}

/* One bit of one band of one leaf at a time, spread over all 64 places. */
static void test_bits(const struct scene *scene)
{
    struct patch_id ids[PATHS];
    random_ids(31, ids);
    struct forest *forest = make_forest(scene, ids, false);
    uint64_t plain = forest_checksum(forest);
    bool seen = true, restored = true;
    for (int32_t p = 0; p < forest->count; p++) {
        if (!patch_is_leaf(&forest->patches[p]))
            continue;
        double *value = &forest->radiosity[p].band[p % 3];
        double before = *value;
        uint64_t bits;
        memcpy(&bits, value, sizeof bits);
        bits ^= UINT64_C(1) << (p % 64);
        memcpy(value, &bits, sizeof bits);
        seen = seen && forest_checksum(forest) != plain;
        *value = before;
        restored = restored && forest_checksum(forest) == plain;
    }
    tap_ok(seen && restored, "any bit of a leaf changes it, and back");
    forest->patches[0].flux[0]++;
    tap_ok(patch_is_leaf(&forest->patches[0]) || forest_checksum(forest) == plain,
           "fluxes do not");
    forest_split(forest, forest_next_leaf(forest, -1));
    tap_ok(forest_checksum(forest) != plain,
           "a split changes it, with the same radiosities too");
    forest_destroy(forest);
}

int main(void)
{
    struct scene *scene = make_scene();
    test_format(scene);
    test_order(scene);
    test_bits(scene);
    scene_destroy(scene);
    return tap_done();
}
