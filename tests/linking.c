/* Tests of rad/boxtree.h and rad/linking.h against all pairs one by one. */
#include "rad/linking.h"

#include "tests/pairs.h"
#include "tests/tap.h"

/* A room with boxes in it and a few loose triangles: `more` of them. If it is fine, boxes stand on
 * the floor and touch, and there is a row of thin ones, like books. Sides of the room are cut
 * in 3 times `fine`, those of boxes in 2 times `fine`, along each edge. */
static struct world furnished(int more, bool two_sided, double epsilon, int fine)
{
    struct random random = random_seed(77);
    struct soup soup = {0};
    soup_add_box(&soup, point(-0.5, -0.5, -0.5), point(0.5, 0.5, 0.5), 3 * fine, true);
    for (int k = 0; k < 6; k++) {
        bool stands = fine > 1;
        struct vec3 low = {-0.4 + (stands ? 0.1 : 0.13) * k, k % 2 ? -0.3 : stands ? -0.1 : 0.05,
                           stands ? -0.5 : -0.49};
        soup_add_box(&soup, low, vec3_add(low, point(0.1, 0.2, 0.3)), 2 * fine, false);
    }
    for (int k = 0; k < 30 && fine > 1; k++) {
        struct vec3 low = {-0.2 + 0.012 * k, 0.2, -0.5 + 0.02 * (k % 3)};
        soup_add_box(&soup, low, vec3_add(low, point(0.01, 0.1, 0.1)), 1, false);
    }
    soup_add_sphere(&soup, 0.1, 1);
    for (int k = 0; k < more; k++)
        soup_add(&soup, random_triangle(&random, 0.4, 0.1));
    struct scene *scene = scene_of_soup(&soup, 1);
    scene->two_sided = scene->two_sided_lamps = two_sided;
    scene->materials[0] = material_grey(0.5, 1.0);
    soup_free(&soup);
    struct world world = world_make(scene);
    world.method.criterion.form_factor = FORM_FACTOR_POLYGON;
    world.method.criterion.oracle = ORACLE_ERROR;
    world.method.link_threshold = epsilon * scene_emitted_power(scene);
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
    struct world world = furnished(40, true, 1e-3, 1);
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

/* A row in `parts` equal parts, last one first, and its sample; each goes on after it was stopped. */
static void link_row(struct linking *linking, int32_t place, int parts, int64_t limit)
{
    int32_t length = linking_row_length(linking->tree->root_count, place);
    for (int part = parts - 1; part >= 0; part--)
        for (int32_t at = length * part / parts, to = length * (part + 1) / parts; at < to;)
            at = linking_add_part(linking, place, at, to, limit);
    for (int32_t at = 0; at < length;)
        at = linking_add_sample(linking, place, at, length, limit, NULL);
}

enum { NO_LIMIT = 1 << 30 };

/* In one to three parts. */
static void add_row(struct linking *linking, int32_t place)
{
    link_row(linking, place, 1 + place % 3, place % 2 == 0 ? NO_LIMIT : 500);
}

/* Where there is too much at stake for groups, links by rows against links one by one: the same
 * where there is one, and what is left out sees nothing. */
static void compare(int more, bool two_sided)
{
    struct world world = furnished(more, two_sided, 1e-15, 1);
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

/* [roots * roots] the link of each pair of roots, the smaller first; area < 0: none. */
static struct link *links_by_pair(struct world *world, int parts, int64_t limit, int *twice)
{
    int32_t roots = scene_root_count(world->scene);
    struct link_list links = {0};
    struct linking linking = linking_start(&world->method, &links);
    struct link *table = alloc_array((size_t)roots * (size_t)roots, sizeof *table);
    for (int32_t place = 0; place < linking.tree->root_count; place++)
        link_row(&linking, place, parts, limit);
    for (int32_t i = 0; i < roots * roots; i++)
        table[i].area = -1.0f;
    *twice = 0;
    for (int64_t i = 0; i < links.count; i++) {
        struct link *entry = &table[links.items[i].p * roots + links.items[i].q];
        *twice += entry->area >= 0.0f;
        *entry = links.items[i];
    }
    linking_end(&linking);
    link_list_free(&links);
    return table;
}

/* In how many parts a row is linked, and where it is stopped, changes nothing of what is seen. */
static void test_parts(double epsilon)
{
    struct world world = furnished(41, false, epsilon, 1);
    int32_t roots = scene_root_count(world.scene), different = 0, seen = 0;
    int twice, again;
    struct link *whole = links_by_pair(&world, 1, NO_LIMIT, &twice);
    struct link *cut = links_by_pair(&world, 5, 100, &again);
    for (int32_t i = 0; i < roots * roots; i++) {
        bool carries = whole[i].area > 0.0f && whole[i].seen > 0;
        seen += carries;
        different += carries ? cut[i].area != whole[i].area || cut[i].seen != whole[i].seen
                             : cut[i].area > 0.0f && cut[i].seen > 0;
    }
    tap_ok(seen > 1000 && different == 0 && twice == 0 && again == 0,
           "epsilon %g: %d links carry light, and the same in five parts that are stopped", epsilon, seen);
    alloc_free(whole);
    alloc_free(cut);
    world_free(&world);
}

/* What is wrong with links, relative root of the mean square: pair by pair, and with what each
 * root receives of all; and the sum of it, relative. */
struct deviation {
    double pairs, roots, sum;
};

static double area_of(const struct link *link)
{
    return link->area > 0.0f ? link_area(link) : 0.0;
}

static struct deviation deviation_of(const struct link *table, const struct link *truth,
                                     int32_t roots)
{
    struct deviation square = {0.0, 0.0, 0.0}, all = {0.0, 0.0, 0.0};
    for (int32_t i = 0; i < roots; i++) {
        double received = 0.0, right = 0.0;
        for (int32_t j = 0; j < roots; j++) {
            int32_t pair = i < j ? i * roots + j : j * roots + i;
            double a = area_of(&table[pair]), b = area_of(&truth[pair]);
            square.pairs += (a - b) * (a - b);
            all.pairs += b * b;
            received += a;
            right += b;
        }
        square.roots += (received - right) * (received - right);
        all.roots += right * right;
        square.sum += received - right;
        all.sum += right;
    }
    return (struct deviation){sqrt(square.pairs / all.pairs), sqrt(square.roots / all.roots),
                              square.sum / all.sum};
}

/* [roots * roots] links made one by one. */
static struct link *links_one_by_one(struct world *world)
{
    int32_t roots = scene_root_count(world->scene);
    struct link *table = alloc_array((size_t)roots * (size_t)roots, sizeof *table);
    for (int32_t p = 0; p < roots; p++)
        for (int32_t q = p + 1; q < roots; q++)
            if (!make(world, p, q, &table[p * roots + q]))
                table[p * roots + q].area = -1.0f;
    return table;
}

/* Groups against links one by one: with 16 segments for each pair (the truth), and looked at as
 * closely as what is at stake asks for. One segment, or the quarter of a group, says all or
 * nothing where 16 see a share: the error of a pair is up to four times as large, as that of one
 * sample to that of 16. It averages out in what a root receives, of hundreds, and there is no
 * bias. */
static void test_groups(double epsilon)
{
    struct world world = furnished(41, false, epsilon, 2), exact = furnished(41, false, 1e-15, 2);
    int32_t roots = scene_root_count(world.scene);
    int twice;
    struct link *groups = links_by_pair(&world, 1, NO_LIMIT, &twice);
    int64_t rays = world.method.counts.rays;
    struct link *single = links_one_by_one(&world), *truth = links_one_by_one(&exact);
    struct deviation ours = deviation_of(groups, truth, roots);
    struct deviation theirs = deviation_of(single, truth, roots);
    tap_ok(ours.pairs < 5.0 * theirs.pairs && ours.roots < 2.0 * theirs.roots,
           "epsilon %g, groups: pairs are off by %.2f %%, what roots receive by %.2f %%; "
           "one by one %.2f and %.2f %%", epsilon, 100.0 * ours.pairs, 100.0 * ours.roots,
           100.0 * theirs.pairs, 100.0 * theirs.roots);
    tap_ok(twice == 0 && fabs(ours.sum - theirs.sum) < 0.01,
           "all together by %.2f %% (one by one %.2f %%); %d %% of the rays", 100.0 * ours.sum,
           100.0 * theirs.sum, (int)(100 * rays / (world.method.counts.rays - rays)));
    alloc_free(groups);
    alloc_free(single);
    alloc_free(truth);
    world_free(&world);
    world_free(&exact);
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
        scene->two_sided = scene->two_sided_lamps = true;
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

/* A closed two-sided room of which every other triangle is a lamp. */
static void test_absent_twins(void)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(-0.5, -0.5, -0.5), point(0.5, 0.5, 0.5), 2, true);
    soup_add_sphere(&soup, 0.1, 1);
    struct scene *scene = scene_of_soup(&soup, 2);
    soup_free(&soup);
    scene->two_sided = true;
    scene->materials[0] = material_grey(0.5, 0.0);
    scene->materials[1] = material_grey(0.5, 1.0);
    for (int32_t i = 0; i < scene->input_count; i++)
        scene->material_of[i] = i % 2;
    struct world world = world_make(scene);
    struct link_list links = {0};
    struct linking linking = linking_start(&world.method, &links);
    int32_t count = scene->input_count, absent = 0;
    bool right = linking.tree->root_count == count + count / 2;
    for (int32_t i = 0; i < linking.tree->root_count; i++) {
        int32_t root = linking.tree->roots[i];
        right = right && (root < count || root % 2 == 0);
        add_row(&linking, i);
    }
    for (int64_t i = 0; i < links.count; i++) {
        const int32_t ends[2] = {links.items[i].p, links.items[i].q};
        for (int k = 0; k < 2; k++)
            absent += ends[k] >= count && ends[k] % 2 == 1;
    }
    for (int32_t p = count + 1, q = 0; q < count; q++) {
        struct link one;
        absent += make(&world, p, q, &one);
    }
    tap_ok(right && links.count > 0 && absent == 0, "a lamp's back: none of %lld links",
           (long long)links.count);
    linking_end(&linking);
    link_list_free(&links);
    world_free(&world);
}

int main(void)
{
    test_tree();
    compare(0, false);
    compare(41, false);
    compare(20, true);
    test_parts(1e-2);
    test_parts(1e-1);
    test_groups(1e-2);
    test_groups(1.0);
    test_few();
    test_absent_twins();
    return tap_done();
}
