/* The tree above the roots (rad/beyond/cluster.h): its invariants, held cluster by
 * cluster against its roots, in scenes that are hard on it; its bytes; its cuts. */
#include "rad/beyond/cluster.h"

#include <string.h>

#include "geom/hash.h"
#include "tests/scenes.h"
#include "tests/tap.h"
#include "tests/trees.h"

enum { MANY = 100000 };

/* --- scenes --- */

static struct scene *painted_in_turn(struct soup *soup, int materials)
{
    for (int m = 0; m < materials; m++)
        paint(soup, 0.1 * m, m == materials - 1 ? 1.0 : 0.0);
    struct scene *scene = scene_of_soup(soup);
    for (int32_t i = 0; i < scene->input_count; i++)
        scene->material_of[i] = i % materials;
    return prepared(scene);
}

static struct scene *coincident(int count)
{
    struct soup soup = {0};
    for (int i = 0; i < count; i++)
        soup_add(&soup, (struct triangle){{{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5}}});
    struct scene *scene = painted_in_turn(&soup, 1);
    for (int32_t i = 1; i < count; i++) { /* doubles, which are dropped, come back */
        scene->areas[i] = scene->areas[0];
        scene->planes[i] = scene->planes[0];
    }
    return scene;
}

/* The tiny ones lie so close to each other that they fall into one of 64 bins. */
static struct scene *huge_and_tiny(int count)
{
    struct soup soup = {0};
    struct random random = random_seed(3);
    soup_add(&soup, (struct triangle){{{0, 0, 0}, {1e3, 0, 0}, {0, 1e3, 0}}});
    for (int i = 0; i < count; i++)
        soup_add(&soup, random_triangle(&random, 1e-3, 1e-4));
    return painted_in_turn(&soup, 1);
}

/* Some have no area. */
static struct scene *mixture(int count)
{
    struct soup soup = {0};
    struct random random = random_seed(4);
    for (int i = 0; i < count; i++) {
        double size = i % 3 == 0 ? 0.3 : 0.02;
        soup_add(&soup, random_triangle(&random, 1.0, size));
        if (i % 10 == 4)
            soup.items[i].corner[1] = soup.items[i].corner[0];
    }
    return painted_in_turn(&soup, 5);
}

static struct scene *twins(int count)
{
    struct soup soup = {0};
    struct random random = random_seed(5);
    soup_add_random(&soup, &random, count, 1.0, 0.2);
    paint(&soup, 0.5, 0.0);
    paint(&soup, 0.0, 2.0);
    struct scene *scene = scene_of_soup(&soup);
    scene->material_of[0] = 1;
    scene->two_sided = true;
    return prepared(scene);
}

/* --- invariants --- */

/* A cluster has the sums of its roots. Sums may be off by their rounding, 1e-16 a
 * root. */
static bool is_true(const struct cluster_tree *tree, const struct scene *scene,
                    int32_t number)
{
    const struct cluster *cluster = &tree->clusters[number];
    const struct vec3 far = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, near = vec3_scale(far, -1.0);
    struct vec3 low = far, high = near, normal_low = far, normal_high = near;
    double area = 0.0, reflecting = 0.0, reflected = 0.0;
    bool dark = true;
    for (int32_t i = cluster->first; i < cluster->end; i++) {
        int32_t root = tree->roots[i];
        struct triangle t = scene_root_triangle(scene, root);
        const struct material *material = scene_root_material(scene, root);
        for (int k = 0; k < 3; k++) {
            low = vec3_least(low, t.corner[k]);
            high = vec3_most(high, t.corner[k]);
        }
        normal_low = vec3_least(normal_low, scene_root_plane(scene, root).normal);
        normal_high = vec3_most(normal_high, scene_root_plane(scene, root).normal);
        area += scene_root_area(scene, root);
        if (rgb_sum(material->reflectance) > 0.0)
            reflecting += scene_root_area(scene, root);
        reflected += scene_root_area(scene, root) * material->reflectance.band[1];
        dark = dark && material_is_dark(material);
    }
    const double rounding = 1e-10;
    return vec3_is_equal(low, cluster->low) && vec3_is_equal(high, cluster->high) &&
           vec3_is_equal(normal_low, cluster->normal_low) &&
           vec3_is_equal(normal_high, cluster->normal_high) &&
           fabs(cluster->area / area - 1.0) < rounding && dark == cluster->is_dark &&
           fabs(cluster->reflecting - reflecting) <= rounding * reflecting &&
           fabs(cluster->reflectance.band[1] * reflecting - reflected) <=
               rounding * reflecting;
}

/* The ID of child k of a cluster leads to `node`. Pre: IDs reach that far. */
static bool is_reached(const struct cluster_tree *tree, const struct cluster *cluster,
                       int k, int32_t node)
{
    struct patch_id id = {CLUSTER_ROOT, cluster->hierarchy};
    return id_level(id) == ID_MAX_LEVEL ||
           cluster_reach(tree, id_child(id, k).hierarchy) == node;
}

/* Child k of a cluster begins at this place. Returns where it ends; -1 if it is wrong. */
static int32_t end_of_child(const struct cluster_tree *tree, int32_t number, int k,
                            int32_t place)
{
    const struct cluster *cluster = &tree->clusters[number];
    int32_t node = cluster->child[k];
    if (!node_is_cluster(node))
        return tree->roots[place] == node && is_reached(tree, cluster, k, NODE_NONE)
                   ? place + 1 : -1;
    const struct cluster *child = &tree->clusters[~node];
    bool right = ~node > number && child->first == place && child->end - place >= 2 &&
                 is_reached(tree, cluster, k, node);
    return right ? child->end : -1;
}

/* Children come after their parent and share its roots out among them. */
static bool is_shared_out(const struct cluster_tree *tree, int32_t number)
{
    const struct cluster *cluster = &tree->clusters[number];
    int32_t place = cluster->first;
    int k = 0;
    for (; k < 4 && cluster->child[k] != NODE_NONE && place >= 0; k++)
        place = end_of_child(tree, number, k, place);
    bool right = place == cluster->end && k > 0;
    for (; k < 4; k++)
        right = right && cluster->child[k] == NODE_NONE &&
                is_reached(tree, cluster, k, NODE_NONE);
    return right;
}

/* Each root with an area is in one place, no other root is in any. */
static bool has_all_roots(const struct cluster_tree *tree, const struct scene *scene)
{
    int32_t count = 0;
    double area = 0.0;
    for (int32_t root = 0; root < scene_root_count(scene); root++) {
        int32_t place = tree->place[root];
        bool wanted = scene_root_area(scene, root) > 0.0;
        count += wanted;
        if (wanted ? place < 0 || place >= tree->root_count || tree->roots[place] != root
                   : place != -1)
            return false;
    }
    for (int32_t i = 0; i < tree->root_count; i++) {
        if (tree->area_before[i] != area)
            return false;
        area += scene_root_area(scene, tree->roots[i]);
    }
    return count == tree->root_count && tree->area_before[count] == area &&
           tree->all_roots == scene_root_count(scene);
}

/* Everything. `depth` receives the level of the deepest cluster. */
static bool check_tree(const struct cluster_tree *tree, const struct scene *scene,
                       int *depth)
{
    const struct cluster *top = &tree->clusters[0];
    bool right = has_all_roots(tree, scene) && top->first == 0 &&
                 top->end == tree->root_count && top->hierarchy == 1;
    *depth = 0;
    for (int32_t i = 0; i < tree->count && right; i++) {
        struct patch_id id = {CLUSTER_ROOT, tree->clusters[i].hierarchy};
        right = is_true(tree, scene, i) && is_shared_out(tree, i) && id_is_valid(id) &&
                cluster_reach(tree, id.hierarchy) == ~i;
        *depth = id_level(id) > *depth ? id_level(id) : *depth;
    }
    return right;
}

/* Twice as deep as a tree of four children each, at most. */
static void test_scene(struct scene *scene, const char *name, int most)
{
    struct octree *octree = NULL;
    if (scene->input_count < MANY) /* of as many in one place it takes too long */
        octree = octree_of(scene);
    struct cluster_tree *tree = tree_create(scene, octree);
    int depth;
    bool right = check_tree(tree, scene, &depth);
    tap_ok(right && depth <= most, "%s: %d roots, %d clusters, %d levels (at most %d)",
           name, (int)tree->root_count, (int)tree->count, depth, most);
    cluster_tree_destroy(tree);
    octree_destroy(octree);
    scene_destroy(scene);
}

static void test_few(int count)
{
    struct scene *scene = coincident(count);
    struct cluster_tree *tree = tree_create(scene, NULL);
    int depth;
    bool right = check_tree(tree, scene, &depth) && tree->count == 1;
    for (int k = 0; k < 4; k++)
        right = right && tree->clusters[0].child[k] == (k < count ? k : NODE_NONE);
    tap_ok(right && cluster_reach(tree, 1) == NODE_TOP, "%d root(s): children of the top",
           count);
    cluster_tree_destroy(tree);
    scene_destroy(scene);
}

/* --- in memory --- */

static bool same_bytes(const void *a, const void *b, size_t count, size_t size)
{
    return memcmp(a, b, count * size) == 0;
}

static bool same_trees(const struct cluster_tree *a, const struct cluster_tree *b)
{
    size_t roots = (size_t)a->root_count, all = (size_t)a->all_roots;
    size_t count = (size_t)a->count;
    return a->count == b->count && a->root_count == b->root_count &&
           a->all_roots == b->all_roots &&
           same_bytes(a->clusters, b->clusters, count, sizeof *a->clusters) &&
           same_bytes(a->roots, b->roots, roots, sizeof *a->roots) &&
           same_bytes(a->place, b->place, all, sizeof *a->place) &&
           same_bytes(a->area_before, b->area_before, roots + 1, sizeof *a->area_before);
}

static void test_pack(void)
{
    struct scene *scene = mixture(1000);
    struct cluster_tree *tree = tree_create(scene, NULL);
    struct cluster_tree *again = tree_create(scene, NULL);
    struct pack count = {0};
    cluster_tree_pack(tree, &count);
    char *block = alloc_array(count.bytes, 1);
    cluster_tree_pack(tree, &(struct pack){.block = block, .writes = true});
    struct pack read = {.block = block};
    struct cluster_tree *view = cluster_tree_view(&read);
    tap_ok(same_trees(tree, again), "a tree built twice is the same, byte for byte");
    tap_ok(same_trees(tree, view) && read.bytes == count.bytes && view->is_view,
           "as is one that is packed and viewed");
    cluster_tree_destroy(view);
    cluster_tree_destroy(again);
    cluster_tree_destroy(tree);
    alloc_free(block);
    scene_destroy(scene);
}

/* --- where it is cut --- */

enum { MIXED = 700 };

/* Sum of a hash of each cluster's set of roots, root i being called (i step) % MIXED. */
static uint64_t sets_of(const struct cluster_tree *tree, int32_t step)
{
    uint64_t sum = 0;
    for (int32_t i = 0; i < tree->count; i++) {
        uint64_t set = 0;
        for (int32_t at = tree->clusters[i].first; at < tree->clusters[i].end; at++)
            set += hash_mix((uint64_t)((int64_t)tree->roots[at] * step % MIXED));
        sum += hash_mix(set);
    }
    return sum;
}

/* 7 x 100: neither step has a factor in common with that. */
static void test_order(void)
{
    struct scene *plain = mixture(MIXED);
    struct cluster_tree *tree = tree_create(plain, NULL);
    uint64_t expected = sets_of(tree, 1);
    static const int32_t steps[] = {699, 11, 333};
    int same = 0;
    for (int k = 0; k < 3; k++) {
        struct scene *mixed = mixture(MIXED);
        for (int32_t i = 0; i < MIXED; i++) { /* both are prepared already */
            int32_t from = (int32_t)((int64_t)i * steps[k] % MIXED);
            mixed->triangles[i] = plain->triangles[from];
            mixed->planes[i] = plain->planes[from];
            mixed->areas[i] = plain->areas[from];
            mixed->material_of[i] = plain->material_of[from];
        }
        struct cluster_tree *other = tree_create(mixed, NULL);
        same += sets_of(other, steps[k]) == expected && sets_of(other, 1) != expected;
        cluster_tree_destroy(other);
        scene_destroy(mixed);
    }
    tap_ok(same == 3, "faces in another order: the same %d clusters", (int)tree->count);
    cluster_tree_destroy(tree);
    scene_destroy(plain);
}

/* True if no child of the top has roots both below and from `first` on. */
static bool parts_at(const struct cluster_tree *tree, int32_t first)
{
    for (int k = 0; k < 4 && tree->clusters[0].child[k] != NODE_NONE; k++) {
        int32_t node = tree->clusters[0].child[k], below = 0;
        if (!node_is_cluster(node))
            continue;
        const struct cluster *cluster = &tree->clusters[~node];
        for (int32_t i = cluster->first; i < cluster->end; i++)
            below += tree->roots[i] < first;
        if (below != 0 && below != cluster->end - cluster->first)
            return false;
    }
    return true;
}

static void add_cube(struct soup *soup, double half, bool inwards)
{
    const struct vec3 corner = {half, half, half};
    soup_add_box(soup, vec3_scale(corner, -1.0), corner, 4, inwards);
}

/* A cupboard in the middle of a room: only visibility tells its inside from the rest. */
static void test_spaces(void)
{
    struct soup soup = {0};
    add_cube(&soup, 1.0, true);
    add_cube(&soup, 0.7, false);
    int32_t inside = (int32_t)soup.count;
    add_cube(&soup, 0.6, true);
    struct scene *scene = prepared(scene_of_soup(&soup));
    struct octree *octree = octree_of(scene);
    struct cluster_tree *blind = tree_create(scene, NULL);
    struct cluster_tree *tree = tree_create(scene, octree);
    int depth;
    tap_ok(parts_at(tree, inside) && check_tree(tree, scene, &depth),
           "a sealed space is cut off first");
    tap_ok(!parts_at(blind, inside), "but not where nothing is known of visibility");
    cluster_tree_destroy(tree);
    cluster_tree_destroy(blind);
    octree_destroy(octree);
    scene_destroy(scene);
}

/* Lamps are cut off before anything else. */
static void test_lamps(void)
{
    struct soup soup = {0};
    struct random random = random_seed(6);
    const int32_t others = 300;
    soup_add_random(&soup, &random, 320, 1.0, 0.1);
    paint(&soup, 0, 0);
    paint(&soup, 0.5, 1.0);
    struct scene *scene = scene_of_soup(&soup);
    for (int32_t i = others; i < scene->input_count; i++)
        scene->material_of[i] = 1;
    prepared(scene);
    struct cluster_tree *tree = tree_create(scene, NULL);
    tap_ok(parts_at(tree, others),
           "lamps are in other clusters than the surfaces they light");
    cluster_tree_destroy(tree);
    scene_destroy(scene);
}

/* The mean width of clusters of so many roots, 2 to 1 times, scene units. */
static double mean_width(const struct cluster_tree *tree, int32_t roots)
{
    double sum = 0.0;
    int count = 0;
    for (int32_t i = 0; i < tree->count; i++) {
        const struct cluster *c = &tree->clusters[i];
        if (c->end - c->first > roots || 2 * (c->end - c->first) < roots)
            continue;
        sum += vec3_length(vec3_sub(c->high, c->low));
        count++;
    }
    return sum / count;
}

/* Triangles in all directions, in a cube that is a millionth of the scene's width. Cut by
 * direction alone a hundredth of them is .94 as wide as all, .74 if places count, too. */
static void test_small(void)
{
    enum { COUNT = 6400 };
    struct scene *scene = huge_and_tiny(COUNT);
    struct cluster_tree *tree = tree_create(scene, NULL);
    double part = mean_width(tree, COUNT / 100) / mean_width(tree, COUNT);
    tap_ok(part < 0.85, "a hundredth of a small thing in a wide scene is %.2f as wide",
           part);
    cluster_tree_destroy(tree);
    scene_destroy(scene);
}

int main(void)
{
    for (int count = 1; count <= 4; count++)
        test_few(count);
    test_scene(mixture(20), "a few at random", 6);
    test_scene(mixture(5000), "many, of which a tenth has no area", 14);
    test_scene(twins(500), "with twins", 10);
    test_scene(coincident(MANY), "100,000 of the same", ID_MAX_LEVEL);
    test_scene(huge_and_tiny(MANY), "a huge one and 100,000 tiny ones", ID_MAX_LEVEL);
    test_pack();
    test_order();
    test_spaces();
    test_lamps();
    test_small();
    return tap_done();
}
