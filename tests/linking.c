/* Tests of rad/boxtree.h and rad/linking.h against all pairs one by one. */
#include "rad/linking.h"

#include "tests/pairs.h"
#include "tests/tap.h"

/* A room with boxes in it and a few loose triangles: `more` of them. */
static struct world furnished(int more, bool two_sided)
{
    struct random random = random_seed(77);
    struct soup soup = {0};
    soup_add_box(&soup, point(-0.5, -0.5, -0.5), point(0.5, 0.5, 0.5), 3, true);
    for (int k = 0; k < 6; k++) {
        struct vec3 low = {-0.4 + 0.13 * k, k % 2 ? -0.3 : 0.05, -0.49};
        soup_add_box(&soup, low, vec3_add(low, point(0.1, 0.2, 0.3)), 2, false);
    }
    soup_add_sphere(&soup, 0.1, 1);
    for (int k = 0; k < more; k++)
        soup_add(&soup, random_triangle(&random, 0.4, 0.1));
    struct scene *scene = scene_of_soup(&soup, 1);
    scene->two_sided = two_sided;
    scene->materials[0] = material_grey(0.5, 1.0);
    soup_free(&soup);
    struct world world = world_make(scene);
    world.method.criterion.form_factor = FORM_FACTOR_POLYGON;
    world.method.criterion.oracle = ORACLE_ERROR;
    world.method.criterion.epsilon = 1e-3;
    return world;
}

/* --- the tree --- */

/* True if all roots lie in the node's boxes. */
static bool node_is_right(const struct world *world, const struct boxtree *tree,
                          const struct boxnode *node)
{
    bool right = node->count >= 1 && (node->children > 0 || node->count <= BOX_ROOTS);
    for (int32_t i = node->first; i < node->first + node->count; i++) {
        struct boxnode root = boxnode_of_root(world->scene, tree->roots[i]);
        for (int axis = 0; axis < 3; axis++)
            right = right && vec3_axis(node->low, axis) <= vec3_axis(root.low, axis) &&
                    vec3_axis(node->high, axis) >= vec3_axis(root.high, axis) &&
                    vec3_axis(node->normal_low, axis) <= vec3_axis(root.normal_low, axis) &&
                    vec3_axis(node->normal_high, axis) >= vec3_axis(root.normal_high, axis);
    }
    return right;
}

/* Pairs of roots between the nodes that face each other. */
static int facing_pairs(const struct world *world, const struct boxtree *tree,
                        const struct boxnode *p, const struct boxnode *q)
{
    int count = 0;
    for (int32_t i = p->first; i < p->first + p->count; i++)
        for (int32_t j = q->first; j < q->first + q->count; j++) {
            struct facet a = facet_make(world->method.forest, tree->roots[i]);
            struct facet b = facet_make(world->method.forest, tree->roots[j]);
            count += facets_face(&a, &b);
        }
    return count;
}

static void test_tree(void)
{
    struct world world = furnished(40, true);
    struct boxtree *tree = boxtree_create(world.scene);
    int wrong = 0, twice = 0, never = 0, lost = 0;
    bool *seen = alloc_array((size_t)scene_root_count(world.scene), sizeof *seen);
    for (int32_t i = 0; i < tree->root_count; i++) {
        twice += seen[tree->roots[i]];
        seen[tree->roots[i]] = true;
    }
    for (int32_t n = 0; n < tree->node_count; n++)
        wrong += !node_is_right(&world, tree, &tree->nodes[n]);
    tap_ok(wrong == 0 && twice == 0 && tree->root_count == scene_root_count(world.scene),
           "%d nodes hold %d roots", tree->node_count, tree->root_count);
    for (int32_t p = 0; p < tree->node_count; p += 3)
        for (int32_t q = p % 7; q < tree->node_count; q += 7) {
            if (p == q || boxnodes_may_face(&tree->nodes[p], &tree->nodes[q]))
                continue;
            never++;
            lost += facing_pairs(&world, tree, &tree->nodes[p], &tree->nodes[q]) > 0;
        }
    tap_ok(never > 1000 && lost == 0,
           "%d pairs of nodes cannot face each other: in none does any root face another", never);
    alloc_free(seen);
    boxtree_destroy(tree);
    world_free(&world);
}

/* --- linking --- */

static int32_t other_of_pair(int32_t p, int32_t q, int32_t roots)
{
    return p < q ? p * roots + q : q * roots + p;
}

/* Random segments between two roots that nothing blocks. */
static int free_segments(struct random *random, const struct world *world, int32_t p, int32_t q)
{
    const struct scene *scene = world->scene;
    const int32_t own[2] = {scene_input_of(scene, p), scene_input_of(scene, q)};
    struct triangle a = scene_root_triangle(scene, p), b = scene_root_triangle(scene, q);
    struct plane plane_a = scene_root_plane(scene, p), plane_b = scene_root_plane(scene, q);
    int count = 0;
    for (int k = 0; k < 100; k++) {
        struct vec3 x = random_point_on(random, &a), y = random_point_on(random, &b);
        count += plane_distance(&plane_a, y) > 0.0 && plane_distance(&plane_b, x) > 0.0 &&
                 brute_blocker(scene->triangles, scene->planes, scene->input_count, x, y, own) < 0;
    }
    return count;
}

/* A sample, and the rest in one to three parts, last one first. */
static void add_row(struct linking *linking, int32_t place)
{
    int parts = 1 + place % 3;
    for (int part = parts - 1; part >= 0; part--)
        linking_add_part(linking, place, part, parts);
    linking_add_sample(linking, place);
}

/* Links by rows against links one by one: the same where there is one, and what is left out sees
 * nothing. */
static void compare(int more, bool two_sided)
{
    struct world world = furnished(more, two_sided);
    struct random random = random_seed(5);
    int32_t roots = scene_root_count(world.scene);
    struct link_list links = {0};
    struct linking linking = linking_start(&world.method, &links);
    for (int32_t i = linking.tree->root_count - 1; i >= 0; i--)
        add_row(&linking, i);
    int64_t touched = linking.touched;
    linking_end(&linking);
    int64_t *at = alloc_array((size_t)roots * (size_t)roots, sizeof *at);
    int64_t twice = 0, different = 0, possible = 0, left_out = 0, leaks = 0, extra = 0;
    for (int64_t i = 0; i < links.count; i++) {
        int32_t pair = other_of_pair(links.items[i].p, links.items[i].q, roots);
        twice += at[pair] != 0;
        extra += links.items[i].p >= links.items[i].q;
        at[pair] = i + 1;
    }
    for (int32_t p = 0; p < roots; p++)
        for (int32_t q = p + 1; q < roots; q++) {
            struct link one;
            int64_t i = at[other_of_pair(p, q, roots)] - 1;
            if (!make(&world, p, q, &one)) {
                extra += i >= 0;
                continue;
            }
            possible++;
            if (i >= 0) {
                different += links.items[i].area != one.area || links.items[i].seen != one.seen;
            } else {
                left_out++;
                leaks += one.seen > 0 || (left_out % 10 == 0 && free_segments(&random, &world, p, q));
            }
        }
    tap_ok(twice == 0 && extra == 0 && different == 0 && links.count + left_out == possible,
           "%d roots%s: %lld links are those made one by one", roots,
           two_sided ? ", two-sided" : "", (long long)links.count);
    tap_ok(left_out > 100 && leaks == 0,
           "%lld of %lld pairs are left out; none sees anything", (long long)left_out,
           (long long)possible);
    tap_ok(4 * touched < (int64_t)roots * (roots - 1), "%lld pairs of %lld were touched",
           (long long)touched, (long long)roots * (roots - 1) / 2);
    alloc_free(at);
    link_list_free(&links);
    world_free(&world);
}

/* One, two and three roots. */
static void test_few(void)
{
    for (int n = 1; n <= 3; n++) {
        struct soup soup = {0};
        for (int k = 0; k < n; k++) {
            struct vec3 a = point(k, 0, 0), b = point(k + 0.5, k * k, 0), c = point(0.3, 0.2, 1 + k);
            soup_add(&soup, (struct triangle){{a, b, c}});
        }
        struct scene *scene = scene_of_soup(&soup, 1);
        scene->two_sided = true;
        scene->materials[0] = material_grey(0.5, 1.0);
        struct world world = world_make(scene);
        struct link_list links = {0};
        struct linking linking = linking_start(&world.method, &links);
        int expected = 0, roots = scene_root_count(world.scene);
        for (int32_t i = 0; i < linking.tree->root_count; i++)
            add_row(&linking, i);
        for (int32_t p = 0; p < roots; p++)
            for (int32_t q = p + 1; q < roots; q++) {
                struct link one;
                expected += make(&world, p, q, &one) && one.seen > 0;
            }
        int made = 0;
        for (int64_t i = 0; i < links.count; i++)
            made += links.items[i].seen > 0;
        tap_ok(made == expected, "%d triangles: %d links", n, made);
        linking_end(&linking);
        link_list_free(&links);
        world_free(&world);
        soup_free(&soup);
    }
}

int main(void)
{
    test_tree();
    compare(0, false);
    compare(41, false);
    compare(20, true);
    test_few();
    return tap_done();
}
