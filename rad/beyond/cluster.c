/* Building the tree above the roots.
 *
 * A node is cut twice in two. Each cut is across the coordinate in which its roots differ
 * most: three of place, three of direction, and size, so the roots of a group lie
 * together, look the same way, and are alike in size. The cut is at the mean. Spaces with
 * a light of their own are parted first. Where lamps and other surfaces are mixed, the
 * cut is between these: a mean over both describes neither. Then it is between other
 * parts not connected by a few rays from each root: a cluster of both would carry light
 * through the wall in between.
 *
 * Roots are weighed by their area plus the mean area: by area alone, a large wall decides
 * where the furniture before the wall is cut; by number alone, the furniture decides
 * where walls are.
 *
 * Each level costs O(k), since roots are parted and not sorted. Roots that differ in
 * nothing, and halves too large for the levels left in IDs, are cut by number.
 *
 * Rejected: one tree for each class of orientation (a tenth more links at the same
 * error); places alone (half more error: the other side of a thing receives other
 * light); cuts where the squares about the means of both halves are least (links differ
 * by 6 % either way, errors by 7 %); harmonics of order 2 in place of one mean B (no less
 * error for 27 numbers a cluster). */
#include "rad/beyond/cluster.h"

#include <string.h>

#include "geom/alloc.h"
#include "geom/stop.h"

/* Keys compared by scatter: place, direction, size; the number of a space; and two of 0
 * and 1. */
enum { KEYS = 7, SPACE = KEYS, NO_LAMP, OTHER_PART, ALL_KEYS };

/* Scene units of place worth a unit of direction, and one of the root of area. The square
 * of the former is at most so many times the variance of place: a small thing in a wide
 * scene would be cut by direction alone, into groups all as wide as the scene. */
static const double DIRECTION_WEIGHT = 0.3, SIZE_WEIGHT = 3.0, DIRECTION_MOST = 8.0;

/* A root on its way into the tree. */
struct member {
    double key[ALL_KEYS], weight;
    int32_t root;
    int32_t space; /* the same for roots seeing each other, by way of others too */
};

struct cutter {
    struct cluster_tree *tree;
    const struct scene *scene;
    const struct spaces *spaces;
    double *share;      /* [all roots + 1] area of the items in each space; else 0 */
    struct member *items; /* [tree->root_count] in the tree's order */
    struct member *spare; /* [tree->root_count] room for a cut */
};

static struct member member_of(const struct cutter *cutter, int32_t root,
                               double mean_area)
{
    const struct scene *scene = cutter->scene;
    struct triangle t = scene_root_triangle(scene, root);
    struct vec3 centre = triangle_centroid(&t),
                normal = scene_root_plane(scene, root).normal;
    double area = scene_root_area(scene, root);
    struct member item = {.weight = area + mean_area, .root = root};
    for (int axis = 0; axis < 3; axis++) {
        item.key[axis] = vec3_axis(centre, axis);
        item.key[3 + axis] = vec3_axis(normal, axis);
    }
    item.key[6] = SIZE_WEIGHT * sqrt(area);
    item.key[SPACE] = cutter->spaces->of[root];
    item.space = cutter->spaces->part[root];
    item.key[NO_LAMP] = !material_emits(scene_root_material(scene, root));
    return item;
}

/* Brings the items whose key is below the limit to the front, each half in its order.
 * Returns their number. */
static int32_t part_items(struct cutter *cutter, int32_t from, int32_t to, int key,
                          double limit)
{
    int32_t front = from, back = 0, below = 0;
    for (int32_t i = from; i < to; i++)
        below += cutter->items[i].key[key] < limit;
    if (below == 0 || below == to - from) /* as mostly: nothing moves */
        return below;
    for (int32_t i = from; i < to; i++) {
        if (cutter->items[i].key[key] < limit)
            cutter->items[front++] = cutter->items[i];
        else
            cutter->spare[back++] = cutter->items[i];
    }
    memcpy(cutter->items + front, cutter->spare, (size_t)back * sizeof *cutter->spare);
    return front - from;
}

/* The key that scatters most, and its mean. Keys are taken from the first item's, so like
 * items have no rounding. */
static int widest_key(const struct member *items, int32_t count, double *mean)
{
    int widest = 0;
    double most = -1.0, place = 0.0;
    for (int key = 0; key < KEYS; key++) {
        double weight = 0.0, sum = 0.0, square = 0.0, first = items[0].key[key];
        for (int32_t i = 0; i < count; i++) {
            double off = items[i].key[key] - first;
            weight += items[i].weight;
            sum += items[i].weight * off;
            square += items[i].weight * off * off;
        }
        double scatter = square - sum * sum / weight;
        if (key < 3)
            place += scatter / weight;
        else if (key < 6)
            scatter *= real_min(DIRECTION_WEIGHT * DIRECTION_WEIGHT,
                                DIRECTION_MOST * place);
        if (scatter > most) {
            most = scatter;
            widest = key;
            *mean = first + sum / weight;
        }
    }
    return widest;
}

/* --- spaces --- */

/* Finds the space with the largest part of the items' area, and sets the items' key
 * OTHER_PART. True if there are others. */
static bool find_largest_space(struct cutter *cutter, struct member *items, int32_t count)
{
    int32_t largest = items[0].space;
    for (int32_t i = 0; i < count; i++)
        cutter->share[items[i].space] += scene_root_area(cutter->scene, items[i].root);
    for (int32_t i = 0; i < count; i++)
        if (cutter->share[items[i].space] > cutter->share[largest])
            largest = items[i].space;
    bool has_others = false;
    for (int32_t i = 0; i < count; i++) {
        items[i].key[OTHER_PART] = items[i].space != largest;
        has_others = has_others || items[i].space != largest;
        cutter->share[items[i].space] = 0.0;
    }
    return has_others;
}

static double mean_space(const struct member *items, int32_t count)
{
    double sum = 0.0;
    for (int32_t i = 0; i < count; i++)
        sum += items[i].key[SPACE];
    return sum / count;
}

/* Cuts items in two, neither half larger than `most`. Returns the size of the first. */
static int32_t cut(struct cutter *cutter, int32_t from, int32_t to, int64_t most)
{
    int32_t count = to - from;
    if (count < 2 ||
        stop_is_asked()) /* then any tree will do: none will be used */
        return (count + 1) / 2;
    struct member *items = cutter->items + from;
    int32_t first = part_items(cutter, from, to, SPACE, mean_space(items, count));
    if (first == 0 || first == count)
        first = part_items(cutter, from, to, NO_LAMP, 1.0);
    if (first == 0 || first == count)
        first = find_largest_space(cutter, items, count)
                    ? part_items(cutter, from, to, OTHER_PART, 1.0) : 0;
    if (first == 0 || first == count) {
        double mean = 0.0;
        int key = widest_key(items, count, &mean);
        first = part_items(cutter, from, to, key, mean);
    }
    bool fits = first > 0 && first < count && first <= most && count - first <= most;
    return fits ? first : count / 2;
}

/* A root in the form of a cluster. */
static struct cluster cluster_of_root(const struct cutter *cutter, int32_t root)
{
    const struct scene *scene = cutter->scene;
    struct triangle t = scene_root_triangle(scene, root);
    struct vec3 normal = scene_root_plane(scene, root).normal;
    const struct material *material = scene_root_material(scene, root);
    double area = scene_root_area(scene, root);
    return (struct cluster){
        .low = triangle_low(&t),
        .high = triangle_high(&t),
        .normal_low = normal,
        .normal_high = normal,
        .area = area,
        .reflecting = rgb_sum(material->reflectance) > 0.0 ? area : 0.0,
        .reflectance = material->reflectance,
        .is_dark = material_is_dark(material),
        .space = cutter->spaces->of[root],
    };
}

/* Adds a child to its parent, whose reflectance is a sum over its area until all are
 * added. */
static void add_child(struct cluster *parent, const struct cluster *child)
{
    bool fresh = parent->area == 0.0;
    parent->low = fresh ? child->low : vec3_least(parent->low, child->low);
    parent->high = fresh ? child->high : vec3_most(parent->high, child->high);
    parent->normal_low =
        fresh ? child->normal_low : vec3_least(parent->normal_low, child->normal_low);
    parent->normal_high =
        fresh ? child->normal_high : vec3_most(parent->normal_high, child->normal_high);
    rgb_add(&parent->reflectance, child->reflecting, child->reflectance);
    parent->area += child->area;
    parent->reflecting += child->reflecting;
    parent->is_dark = (fresh || parent->is_dark) && child->is_dark;
    parent->space = fresh || parent->space == child->space ? child->space : -1;
}

/* Pre: the same is known of the clusters below. */
static void sum_up(struct cutter *cutter, struct cluster *cluster)
{
    const struct cluster_tree *tree = cutter->tree;
    for (int k = 0; k < 4 && cluster->child[k] != NODE_NONE; k++) {
        int32_t node = cluster->child[k];
        struct cluster child = node_is_cluster(node)
                                   ? tree->clusters[~node]
                                   : cluster_of_root(cutter, node);
        add_child(cluster, &child);
    }
    for (int c = 0; c < BANDS && cluster->reflecting > 0.0; c++)
        cluster->reflectance.band[c] /= cluster->reflecting;
}

static bool has_several_spaces(const struct cutter *cutter, int32_t from, int32_t to)
{
    for (int32_t i = from; i < to; i++)
        if (cutter->items[i].key[SPACE] != cutter->items[from].key[SPACE])
            return true;
    return false;
}

/* Where the four parts of a cluster end. `below`: most roots in a child. A space has the
 * tree that it has alone. */
static void cut_in_four(struct cutter *cutter, int32_t from, int32_t to, int64_t below,
                        int32_t ends[4])
{
    if (to - from <= 4) {
        for (int k = 0; k < 4; k++)
            ends[k] = from + k + 1 < to ? from + k + 1 : to;
        return;
    }
    int32_t middle = from + cut(cutter, from, to, 2 * below);
    bool spaces = has_several_spaces(cutter, from, to);
    bool whole = spaces && !has_several_spaces(cutter, from, middle);
    ends[0] = whole ? middle : from + cut(cutter, from, middle, below);
    ends[1] = middle;
    whole = spaces && !has_several_spaces(cutter, middle, to);
    ends[2] = whole ? to : middle + cut(cutter, middle, to, below);
    ends[3] = to;
}

/* Makes the cluster over the items from..to. Returns its node. */
static int32_t build(struct cutter *cutter, int32_t from, int32_t to,
                     uint32_t hierarchy, int level)
{
    struct cluster_tree *tree = cutter->tree;
    int32_t number = tree->count++, ends[4], begin = from;
    int children = 0;
    struct cluster cluster = {.first = from, .end = to, .hierarchy = hierarchy,
                              .child = {NODE_NONE, NODE_NONE, NODE_NONE, NODE_NONE}};
    cut_in_four(cutter, from, to, INT64_C(1) << 2 * (ID_MAX_LEVEL - level), ends);
    for (int k = 0; k < 4; k++) {
        if (ends[k] - begin == 1) {
            cluster.child[children++] = cutter->items[begin].root;
        } else if (ends[k] > begin) {
            cluster.child[children] = build(
                cutter, begin, ends[k], hierarchy << 2 | (uint32_t)children, level + 1);
            children++;
        }
        begin = ends[k];
    }
    sum_up(cutter, &cluster);
    tree->clusters[number] = cluster;
    return ~number;
}

static void list_items(struct cutter *cutter)
{
    const struct scene *scene = cutter->scene;
    int32_t count = 0, all = scene_root_count(scene);
    for (int32_t root = 0; root < all; root++)
        count += scene_root_area(scene, root) > 0.0;
    cutter->items = alloc_array((size_t)count, sizeof *cutter->items);
    cutter->spare = alloc_array((size_t)count, sizeof *cutter->spare);
    double mean_area = scene_area(scene) / count;
    for (int32_t root = 0; root < all; root++)
        if (scene_root_area(scene, root) > 0.0)
            cutter->items[cutter->tree->root_count++] =
                member_of(cutter, root, mean_area);
}

/* The arrays by place and by root. */
static void list_places(struct cutter *cutter)
{
    struct cluster_tree *tree = cutter->tree;
    for (int32_t i = 0; i < tree->root_count; i++) {
        int32_t root = cutter->items[i].root;
        tree->roots[i] = root;
        tree->place[root] = i;
        tree->area_before[i + 1] =
            tree->area_before[i] + scene_root_area(cutter->scene, root);
    }
}

struct cluster_tree *cluster_tree_build(const struct scene *scene,
                                        const struct spaces *spaces)
{
    struct cluster_tree *tree = alloc_array(1, sizeof *tree);
    struct cutter cutter = {.tree = tree, .scene = scene, .spaces = spaces};
    list_items(&cutter);
    cutter.share =
        alloc_array((size_t)scene_root_count(scene) + 1, sizeof *cutter.share);
    size_t count = (size_t)tree->root_count, all = (size_t)scene_root_count(scene);
    tree->all_roots = (int32_t)all;
    tree->clusters = alloc_array(count, sizeof *tree->clusters);
    tree->roots = alloc_array(count, sizeof *tree->roots);
    tree->area_before = alloc_array(count + 1, sizeof *tree->area_before);
    tree->place = alloc_array(all, sizeof *tree->place);
    for (size_t root = 0; root < all; root++)
        tree->place[root] = -1;
    build(&cutter, 0, tree->root_count, 1, 0);
    list_places(&cutter);
    tree->clusters =
        alloc_resize(tree->clusters, (size_t)tree->count, sizeof *tree->clusters);
    alloc_free(cutter.share);
    alloc_free(cutter.items);
    alloc_free(cutter.spare);
    return tree;
}

void cluster_tree_destroy(struct cluster_tree *tree)
{
    if (tree && !tree->is_view) {
        alloc_free(tree->clusters);
        alloc_free(tree->roots);
        alloc_free(tree->place);
        alloc_free(tree->area_before);
    }
    alloc_free(tree);
}

static void pack_arrays(struct cluster_tree *tree, struct pack *pack)
{
    PACK(pack, tree->clusters, tree->count);
    PACK(pack, tree->roots, tree->root_count);
    PACK(pack, tree->place, tree->all_roots);
    PACK(pack, tree->area_before, (int64_t)tree->root_count + 1);
}

void cluster_tree_pack(const struct cluster_tree *tree, struct pack *pack)
{
    struct cluster_tree view = *tree;
    view.is_view = true;
    pack_array(pack, &view, sizeof view);
    pack_arrays(&view, pack);
}

struct cluster_tree *cluster_tree_view(struct pack *pack)
{
    struct cluster_tree *tree = alloc_array(1, sizeof *tree);
    memcpy(tree, pack_array(pack, NULL, sizeof *tree), sizeof *tree);
    pack_arrays(tree, pack);
    return tree;
}

int32_t cluster_reach(const struct cluster_tree *tree, uint32_t hierarchy)
{
    struct patch_id id = {CLUSTER_ROOT, hierarchy};
    int32_t node = NODE_TOP;
    for (int step = 0; step < id_level(id) && node_is_cluster(node) && node != NODE_NONE;
         step++)
        node = tree->clusters[~node].child[id_step(id, step)];
    return node_is_cluster(node) ? node : NODE_NONE;
}
