/* The tree over the roots.
 *
 * A node is halved along the longest side of its six-dimensional box, three of place and three
 * of direction: so groups come out that lie together, or that look the same way, and a pair of
 * groups can be told as a whole that nothing in it faces anything. For a root p with normal n
 * and a point x of q, p sees x only if n . (x - y) > 0 for the points y of p; the largest value
 * that can have, with n, x and y anywhere in their boxes, is found axis by axis. Roots that look
 * exactly the same way never face each other, wherever they are: of two parallel planes one lies
 * behind the other.
 *
 * Numbers decide where keys are equal, so the tree is the same everywhere. */
#include "rad/boxtree.h"

#include <stdlib.h>

#include "geom/alloc.h"

/* How much one unit of direction (from 0 to 1) counts, in scene units: so little that a room is cut by
 * place until only what lies together is told apart by where it looks. With ten times as much,
 * groups see less alike: a third more triangle tests (furnished rooms). */
static const double DIRECTION_WEIGHT = 0.05;

enum { KEYS = 6 };

/* Blocks are smaller in a small scene, so that there are enough of them. */
enum { BLOCKS_LEAST = 64 };

struct entry {
    double key;
    int32_t root;
};

static int compare_entries(const void *a, const void *b)
{
    const struct entry *x = a, *y = b;
    if (x->key != y->key)
        return x->key < y->key ? -1 : 1;
    return x->root < y->root ? -1 : 1;
}

static double key_of(const struct scene *scene, int32_t root, int key)
{
    if (key >= 3)
        return DIRECTION_WEIGHT * vec3_axis(scene_root_plane(scene, root).normal, key - 3);
    struct triangle t = scene_root_triangle(scene, root);
    return vec3_axis(triangle_centroid(&t), key);
}

static struct vec3 least(struct vec3 a, struct vec3 b)
{
    return (struct vec3){fmin(a.x, b.x), fmin(a.y, b.y), fmin(a.z, b.z)};
}

static struct vec3 most(struct vec3 a, struct vec3 b)
{
    return (struct vec3){fmax(a.x, b.x), fmax(a.y, b.y), fmax(a.z, b.z)};
}

struct boxnode boxnode_of_root(const struct scene *scene, int32_t root)
{
    struct triangle t = scene_root_triangle(scene, root);
    struct vec3 normal = scene_root_plane(scene, root).normal;
    return (struct boxnode){.low = least(t.corner[0], least(t.corner[1], t.corner[2])),
                            .high = most(t.corner[0], most(t.corner[1], t.corner[2])),
                            .normal_low = normal, .normal_high = normal,
                            .count = 1, .block = -1};
}

static void bound(const struct boxtree *tree, const struct scene *scene, struct boxnode *node)
{
    for (int32_t i = node->first; i < node->first + node->count; i++) {
        struct boxnode one = boxnode_of_root(scene, tree->roots[i]);
        bool fresh = i == node->first;
        node->low = fresh ? one.low : least(node->low, one.low);
        node->high = fresh ? one.high : most(node->high, one.high);
        node->normal_low = fresh ? one.normal_low : least(node->normal_low, one.normal_low);
        node->normal_high = fresh ? one.normal_high : most(node->normal_high, one.normal_high);
    }
}

/* The key along which the roots of the node are spread most. */
static int longest_key(const struct boxnode *node)
{
    int longest = 0;
    double length = -1.0;
    for (int key = 0; key < KEYS; key++) {
        double extent = key < 3 ? vec3_axis(node->high, key) - vec3_axis(node->low, key)
                                : DIRECTION_WEIGHT * (vec3_axis(node->normal_high, key - 3) -
                                                      vec3_axis(node->normal_low, key - 3));
        if (extent > length) {
            longest = key;
            length = extent;
        }
    }
    return longest;
}

/* Orders the roots of the node by their key, lower half first. */
static void order_roots(struct boxtree *tree, const struct scene *scene,
                        const struct boxnode *node, struct entry *entries)
{
    int key = longest_key(node);
    for (int32_t i = 0; i < node->count; i++) {
        int32_t root = tree->roots[node->first + i];
        entries[i] = (struct entry){key_of(scene, root, key), root};
    }
    qsort(entries, (size_t)node->count, sizeof *entries, compare_entries);
    for (int32_t i = 0; i < node->count; i++)
        tree->roots[node->first + i] = entries[i].root;
}

/* Half of the roots, in whole leaves: all leaves but the last are full. */
static int32_t half_of(int32_t count)
{
    return (count / 2 + BOX_ROOTS - 1) / BOX_ROOTS * BOX_ROOTS;
}

/* `above`: no node above it is a block. */
static void divide(struct boxtree *tree, const struct scene *scene, int32_t at, bool above,
                   struct entry *entries)
{
    struct boxnode *node = &tree->nodes[at];
    bool is_block = above && node->count <= tree->block_roots;
    bound(tree, scene, node);
    node->block = is_block ? tree->block_count++ : -1;
    if (node->count <= BOX_ROOTS)
        return;
    order_roots(tree, scene, node, entries);
    int32_t half = half_of(node->count), left = tree->node_count;
    tree->node_count += 2;
    node->children = left;
    tree->nodes[left] = (struct boxnode){.first = node->first, .count = half};
    tree->nodes[left + 1] = (struct boxnode){.first = node->first + half,
                                             .count = node->count - half};
    divide(tree, scene, left, above && !is_block, entries);
    divide(tree, scene, left + 1, above && !is_block, entries);
}

struct boxtree *boxtree_create(const struct scene *scene)
{
    struct boxtree *tree = alloc_array(1, sizeof *tree);
    int32_t roots = scene_root_count(scene);
    tree->roots = alloc_array((size_t)roots, sizeof *tree->roots);
    for (int32_t root = 0; root < roots; root++)
        if (scene_root_area(scene, root) > 0.0)
            tree->roots[tree->root_count++] = root;
    tree->block_roots = tree->root_count / BLOCKS_LEAST;
    if (tree->block_roots < BOX_ROOTS)
        tree->block_roots = BOX_ROOTS;
    if (tree->block_roots > BLOCK_MAX)
        tree->block_roots = BLOCK_MAX;
    size_t leaves = (size_t)tree->root_count / BOX_ROOTS + 1;
    tree->nodes = alloc_array(2 * leaves, sizeof *tree->nodes);
    struct entry *entries = alloc_array((size_t)roots, sizeof *entries);
    tree->nodes[0] = (struct boxnode){.count = tree->root_count};
    tree->node_count = 1;
    divide(tree, scene, 0, true, entries);
    alloc_free(entries);
    return tree;
}

void boxtree_destroy(struct boxtree *tree)
{
    if (!tree)
        return;
    alloc_free(tree->nodes);
    alloc_free(tree->roots);
    alloc_free(tree);
}

/* The largest product of a number in [a, b] and one in [c, d]. */
static double largest_product(double a, double b, double c, double d)
{
    return real_max(real_max(a * c, a * d), real_max(b * c, b * d));
}

/* No corner of q is further in front of a plane of p than this. */
static double reach_above(const struct boxnode *p, const struct boxnode *q)
{
    double reach = 0.0;
    for (int axis = 0; axis < 3; axis++)
        reach += largest_product(vec3_axis(p->normal_low, axis), vec3_axis(p->normal_high, axis),
                                 vec3_axis(q->low, axis) - vec3_axis(p->high, axis),
                                 vec3_axis(q->high, axis) - vec3_axis(p->low, axis));
    return reach;
}

static bool vec3_is_equal(struct vec3 a, struct vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static bool look_the_same_way(const struct boxnode *p, const struct boxnode *q)
{
    return vec3_is_equal(p->normal_low, p->normal_high) &&
           vec3_is_equal(q->normal_low, q->normal_high) &&
           vec3_is_equal(p->normal_low, q->normal_low);
}

bool boxnodes_may_face(const struct boxnode *p, const struct boxnode *q)
{
    const double margin = 0.5 * GEOM_ROUNDING; /* beyond rounding, facets_face() is stricter */
    return !look_the_same_way(p, q) && reach_above(p, q) > margin && reach_above(q, p) > margin;
}
