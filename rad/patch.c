/* The patch forest.
 *
 * A patch is 40 bytes, and 24 more for its radiosity, which is a vector of its own: a
 * transfer takes this or a vector of a solver. Its corners, normal and area follow from
 * its root and its ID, so none is stored. The four children of a patch lie side by side,
 * hence one number finds them all and 0 (always a root, never a child) means none. */
#include "rad/patch.h"

#include "geom/alloc.h"
#include "geom/hash.h"

struct forest *forest_create(const struct scene *scene)
{
    struct forest *forest = alloc_array(1, sizeof *forest);
    forest->scene = scene;
    forest->root_count = scene_root_count(scene);
    RESERVE(forest->patches, &forest->capacity, forest->root_count);
    forest->count = forest->root_count;
    RESERVE(forest->radiosity, &forest->radiosity_capacity, forest->count);
    for (int32_t root = 0; root < forest->root_count; root++) {
        forest->patches[root] =
            (struct patch){.id = id_of_root((uint32_t)root), .parent = -1};
        forest->radiosity[root] = scene_root_material(scene, root)->emission;
    }
    return forest;
}

void forest_destroy(struct forest *forest)
{
    if (!forest)
        return;
    alloc_free(forest->patches);
    alloc_free(forest->radiosity);
    alloc_free(forest->ranges);
    alloc_free(forest->above);
    alloc_free(forest->caps);
    alloc_free(forest);
}

void forest_split(struct forest *forest, int32_t patch)
{
    if (!patch_is_leaf(&forest->patches[patch]))
        return;
    if (forest->count > INT32_MAX - 4)
        alloc_fail(SIZE_MAX); /* local numbers end at 2^31 patches, 128 GiB */
    RESERVE(forest->patches, &forest->capacity, forest->count + 4);
    RESERVE(forest->radiosity, &forest->radiosity_capacity, forest->count + 4);
    struct patch *parent = &forest->patches[patch];
    parent->children = (int32_t)forest->count;
    for (int k = 0; k < 4; k++, forest->count++) {
        forest->patches[forest->count] =
            (struct patch){.id = id_child(parent->id, k), .parent = patch};
        forest->radiosity[forest->count] = forest->radiosity[patch];
    }
}

int32_t forest_reach(struct forest *forest, struct patch_id id)
{
    int32_t patch = (int32_t)id.root;
    int level = id_level(id);
    for (int step = 0; step < level; step++) {
        forest_split(forest, patch);
        patch = forest->patches[patch].children + id_step(id, step);
    }
    return patch;
}

struct triangle forest_triangle(const struct forest *forest, int32_t patch)
{
    struct patch_id id = forest->patches[patch].id;
    struct triangle t = scene_root_triangle(forest->scene, (int32_t)id.root);
    for (int below = 2 * id_level(id) - 2; below >= 0; below -= 2)
        t = triangle_child(&t, (int)(id.hierarchy >> below & 3u));
    return t;
}

struct forest_counts forest_count(const struct forest *forest)
{
    struct forest_counts counts = {0};
    for (int64_t p = 0; p < forest->count; p++) {
        const struct patch *patch = &forest->patches[p];
        bool has_area = scene_root_area(forest->scene, (int32_t)patch->id.root) > 0.0;
        counts.patches += has_area;
        counts.leaves += has_area && patch_is_leaf(patch);
    }
    return counts;
}

int32_t forest_next(const struct forest *forest, int32_t patch, bool descend)
{
    const struct patch *at = &forest->patches[patch];
    if (descend && !patch_is_leaf(at))
        return at->children;
    while (at->parent >= 0) {
        if ((at->id.hierarchy & 3u) != 3u)
            return patch + 1;
        patch = at->parent;
        at = &forest->patches[patch];
    }
    return -1;
}

int32_t forest_next_leaf(const struct forest *forest, int32_t leaf)
{
    int32_t p = leaf, root = p < 0 ? -1 : (int32_t)forest->patches[p].id.root;
    do {
        p = p < 0 ? -1 : forest_next(forest, p, true);
        while (p < 0 && ++root < forest->root_count)
            p = scene_root_area(forest->scene, root) > 0.0 ? root : -1;
    } while (p >= 0 && !patch_is_leaf(&forest->patches[p]));
    return p;
}

int32_t *forest_order(const struct forest *forest)
{
    int32_t *order = alloc_array((size_t)forest->count, sizeof *order);
    int64_t count = 0;
    for (int32_t root = 0; root < forest->root_count; root++)
        for (int32_t p = root; p >= 0; p = forest_next(forest, p, true))
            order[count++] = p;
    return order;
}

/* --- the checksum --- */

/* One bit for each patch, depth first, 1 = split; eight to a byte, the first in the
 * lowest place. */
static uint64_t hash_splits(uint64_t hash, const struct forest *forest, int32_t root)
{
    uint8_t byte = 0;
    int bits = 0;
    for (int32_t p = root; p >= 0; p = forest_next(forest, p, true)) {
        byte = (uint8_t)(byte | !patch_is_leaf(&forest->patches[p]) << bits % 8);
        if (++bits % 8 == 0) {
            hash = hash_bytes(hash, &byte, 1);
            byte = 0;
        }
    }
    return bits % 8 == 0 ? hash : hash_bytes(hash, &byte, 1);
}

uint64_t forest_checksum(const struct forest *forest)
{
    uint64_t hash = HASH_START;
    for (int32_t root = 0; root < forest->root_count; root++) {
        hash = hash_splits(hash, forest, root);
        for (int32_t p = root; p >= 0; p = forest_next(forest, p, true))
            if (patch_is_leaf(&forest->patches[p]))
                hash = hash_doubles(hash, forest->radiosity[p].band, BANDS);
    }
    return hash;
}
