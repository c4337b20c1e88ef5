/* Tests of rad/id.h: the layout of the paper's Fig. 1 by literal values, going down and
 * up again on random paths, the order as compared with its definition, and which numbers
 * are IDs. */
#include "rad/id.h"

#include "tests/random.h"
#include "tests/tap.h"

enum { PATHS = 100000 };

struct path {
    uint32_t root;
    int level;
    int child[ID_MAX_LEVEL];
};

static struct path random_path(struct random *random, int max_level)
{
    struct path path = {.root = (uint32_t)random_bits(random)};
    path.level = (int)(random_bits(random) % (uint64_t)(max_level + 1));
    for (int k = 0; k < path.level; k++)
        path.child[k] = (int)(random_bits(random) % 4);
    return path;
}

static struct patch_id id_of_path(const struct path *path)
{
    struct patch_id id = id_of_root(path->root);
    for (int k = 0; k < path->level; k++)
        id = id_child(id, path->child[k]);
    return id;
}

/* Sentinel 1, then the child numbers 2, 0, 3, 1 in two bits each: 1 10 00 11 01. */
static void test_layout(void)
{
    struct patch_id id = id_of_root(77);
    tap_ok(id.root == 77 && id.hierarchy == 1, "a root is 1");
    static const int children[4] = {2, 0, 3, 1};
    static const uint32_t expected[4] = {0x6, 0x18, 0x63, 0x18D};
    bool right = true;
    for (int k = 0; k < 4; k++) {
        id = id_child(id, children[k]);
        right = right && id.root == 77 && id.hierarchy == expected[k] &&
                id_level(id) == k + 1;
    }
    tap_ok(right, "children 2, 0, 3, 1 in turn are 6, 18, 63, 18D in hexadecimal");
    for (int k = 0; k < 4; k++)
        right = right && id_step(id, k) == children[k];
    tap_ok(right, "its steps are read from left to right");
    right = true;
    for (int k = 0; k < 4; k++)
        right = right && id_child(id_of_root(0), k).hierarchy == (uint32_t)(4 + k);
    tap_ok(right, "the children of a root are 4, 5, 6, 7");
}

static void test_depth(void)
{
    struct patch_id first = id_of_root(UINT32_MAX), last = first;
    for (int k = 0; k < ID_MAX_LEVEL; k++) {
        first = id_child(first, 0);
        last = id_child(last, 3);
    }
    tap_ok(first.hierarchy == 0x40000000 && last.hierarchy == 0x7FFFFFFF,
           "level 15 takes 31 bits, and no bit is lost");
    tap_ok(id_level(first) == 15 && id_level(last) == 15 && id_step(first, 14) == 0 &&
               id_step(last, 14) == 3 && id_step(last, 0) == 3,
           "level 15 is read back");
    tap_ok(id_is_valid(first) && id_is_valid(last) && first.root == UINT32_MAX,
           "level 15 is valid");
}

static void test_validity(void)
{
    bool right = !id_is_valid((struct patch_id){3, 0});
    for (int place = 0; place < 32; place++) {
        uint32_t low = UINT32_C(1) << place; /* the least and the greatest number ... */
        uint32_t high = low | (low - 1);     /* ... whose first bit is here */
        bool expected = place % 2 == 0 && place <= 30;
        right = right && id_is_valid((struct patch_id){3, low}) == expected &&
                id_is_valid((struct patch_id){3, high}) == expected;
    }
    tap_ok(right, "a sentinel is valid in the places 0, 2, ... 30 and in no other");
}

static void test_round_trips(void)
{
    struct random random = random_seed(1);
    bool down = true, valid = true;
    for (int i = 0; i < PATHS; i++) {
        struct path path = random_path(&random, ID_MAX_LEVEL);
        struct patch_id id = id_of_path(&path);
        valid = valid && id_is_valid(id) && id.root == path.root &&
                id_level(id) == path.level;
        for (int k = 0; k < path.level; k++)
            down = down && id_step(id, k) == path.child[k];
    }
    tap_ok(valid, "%d random paths are valid IDs of their level", (int)PATHS);
    tap_ok(down, "their steps are the children that were taken");
}

/* The order as the header words it. */
static int compare_paths(const struct path *a, const struct path *b)
{
    if (a->root != b->root)
        return a->root < b->root ? -1 : 1;
    if (a->level != b->level)
        return a->level < b->level ? -1 : 1;
    for (int k = 0; k < a->level; k++)
        if (a->child[k] != b->child[k])
            return a->child[k] < b->child[k] ? -1 : 1;
    return 0;
}

static int sign(int x)
{
    return (x > 0) - (x < 0);
}

static void test_order(void)
{
    struct random random = random_seed(2);
    bool right = true;
    int equal = 0;
    for (int i = 0; i < PATHS; i++) {
        struct path a = random_path(&random, i % 2 ? 3 : ID_MAX_LEVEL);
        struct path b = random_path(&random, i % 2 ? 3 : ID_MAX_LEVEL);
        if (i % 4 != 0)
            b.root = a.root; /* else roots are all that ever counts */
        struct patch_id ida = id_of_path(&a), idb = id_of_path(&b);
        int order = sign(id_compare(ida, idb));
        right = right && order == compare_paths(&a, &b) &&
                order == -sign(id_compare(idb, ida));
        equal += order == 0;
    }
    tap_ok(right && equal > 100,
           "the order is by root, then by level, then from left to right");
}

int main(void)
{
    test_layout();
    test_depth();
    test_validity();
    test_round_trips();
    test_order();
    return tap_done();
}
