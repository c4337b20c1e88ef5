/* Tests of rad/linking.h against pairs one by one: all that see each other are linked,
 * and no other; any number of ranks makes the same links together. */
#include "rad/linking.h"

#include <string.h>

#include "tests/pairs.h"
#include "tests/tap.h"

/* Two-sided; frees the triangles. Every third is black, the others are lamps. */
static struct world world_of(struct soup *soup, enum oracle oracle)
{
    struct scene *scene = scene_of_soup(soup, 2);
    for (int64_t i = 0; i < soup->count; i += 3)
        scene->material_of[i] = 1;
    scene->materials[0] = material_grey(0.5, 1.0);
    scene->materials[1] = material_grey(0.0, 0.0);
    scene->two_sided = scene->two_sided_lamps = true;
    soup_free(soup);
    struct world world = world_make(scene);
    struct criterion criterion = world.model.criterion;
    criterion.oracle = oracle;
    criterion.form_factor = oracle == ORACLE_BF ? FORM_FACTOR_DISK : FORM_FACTOR_POLYGON;
    world.model = model_make(scene, world.octree, world.model.forest, &criterion);
    world.model.link_threshold = 1e-2 * scene_emitted_power(scene);
    return world;
}

/* A room with two boxes, three loose triangles, and one without an area among them. */
static struct world furnished(enum oracle oracle)
{
    struct random random = random_seed(77);
    struct soup soup = {0};
    struct vec3 x = point(0.1, 0.1, 0.1);
    soup_add_box(&soup, point(-0.5, -0.5, -0.5), point(0.5, 0.5, 0.5), 2, true);
    soup_add_box(&soup, point(-0.4, -0.3, -0.5), point(-0.1, 0.2, -0.1), 1, false);
    soup_add(&soup, (struct triangle){{x, x, x}});
    soup_add_box(&soup, point(0.1, -0.4, -0.5), point(0.2, 0.4, 0.1), 1, false);
    for (int k = 0; k < 3; k++)
        soup_add(&soup, random_triangle(&random, 0.4, 0.1));
    return world_of(&soup, oracle);
}

/* Appends the links that one of so many ranks makes. Returns its number of pairs. */
static int64_t link_as(struct world *world, int rank, int ranks, struct link_list *links)
{
    struct linking linking = linking_start(&world->model, links, rank, ranks);
    int64_t pairs = 0;
    for (; linking.number < linking_pairs(&linking); pairs++)
        linking_add(&linking);
    linking_end(&linking);
    return pairs;
}

static bool is_same(const struct link *a, const struct link *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

/* --- one rank --- */

static void test_pairs(enum oracle oracle, const char *name)
{
    struct world world = furnished(oracle);
    const struct scene *scene = world.scene;
    struct link_list links = {0};
    int32_t roots = scene_root_count(scene), without_area = 0;
    int64_t next = 0, unseen = 0, different = 0;
    int64_t pairs = link_as(&world, 0, 1, &links), rays = world.model.counts.rays;
    for (int32_t p = 0; p < roots; p++) {
        without_area += scene_root_area(scene, p) == 0.0;
        for (int32_t q = p + 1; q < roots; q++) {
            struct link one;
            if (scene_root_area(scene, p) == 0.0 || scene_root_area(scene, q) == 0.0 ||
                !make(&world, p, q, &one))
                continue;
            different += next == links.count || !is_same(&links.items[next++], &one);
            unseen += one.seen == 0;
        }
    }
    tap_ok(different == 0 && next == links.count &&
               (oracle == ORACLE_BF ? unseen == 0 : unseen > 100),
           "%s: %d roots, %lld links, those made one by one; %lld see nothing", name,
           (int)roots, (long long)links.count, (long long)unseen);
    int64_t with_area = roots - without_area;
    tap_ok(without_area == 2 && pairs == with_area * (with_area - 1) / 2,
           "a root without an area is in none of the %lld pairs", (long long)pairs);
    tap_ok(2 * rays == world.model.counts.rays, "nothing but these is looked at");
    link_list_free(&links);
    world_free(&world);
}

/* In an empty room all segments between two walls face each other. */
static void test_rays(void)
{
    double rays[2];
    for (int oracle = ORACLE_BF; oracle <= ORACLE_ERROR; oracle++) {
        struct soup soup = {0};
        soup_add_box(&soup, point(-0.5, -0.5, -0.5), point(0.5, 0.5, 0.5), 2, true);
        struct world world = world_of(&soup, (enum oracle)oracle);
        struct link_list links = {0};
        link_as(&world, 0, 1, &links);
        rays[oracle] = (double)world.model.counts.rays / (double)links.count;
        link_list_free(&links);
        world_free(&world);
    }
    tap_ok(rays[ORACLE_BF] == 16.0, "the paper's oracle looks at each pair by 16 rays");
    tap_ok(rays[ORACLE_ERROR] < 14.0, "the error oracle by %.1f", rays[ORACLE_ERROR]);
}

/* --- several ranks --- */

static int compare_links(const void *left, const void *right)
{
    const struct link *a = left, *b = right;
    return a->p != b->p ? (a->p < b->p ? -1 : 1) : (a->q > b->q) - (a->q < b->q);
}

static void test_ranks(int ranks)
{
    struct world world = furnished(ORACLE_BF);
    struct link_list whole = {0}, parts = {0};
    int64_t pairs = link_as(&world, 0, 1, &whole), sum = 0, least = pairs, most = 0;
    for (int rank = 0; rank < ranks; rank++) {
        int64_t own = link_as(&world, rank, ranks, &parts);
        sum += own;
        least = own < least ? own : least;
        most = own > most ? own : most;
    }
    qsort(parts.items, (size_t)parts.count, sizeof *parts.items, compare_links);
    bool same = whole.count == parts.count;
    for (int64_t i = 0; same && i < whole.count; i++)
        same = is_same(&whole.items[i], &parts.items[i]);
    tap_ok(same && sum == pairs && most - least <= 1,
           "%d ranks make the same links together, of %lld to %lld pairs each", ranks,
           (long long)least, (long long)most);
    link_list_free(&whole);
    link_list_free(&parts);
    world_free(&world);
}

/* --- hardly any roots --- */

static void test_few(void)
{
    for (int n = 1; n <= 3; n++) {
        struct soup soup = {0};
        for (int k = 0; k < n; k++)
            soup_add(&soup, tile(1.2 * k, k > 0, 1.0, k == 0));
        struct scene *scene = scene_of_soup(&soup, 1);
        scene->materials[0] = material_grey(0.5, 1.0);
        struct world world = world_make(scene);
        struct link_list links = {0};
        int64_t pairs = 0;
        for (int rank = 0; rank < 5; rank++)
            pairs += link_as(&world, rank, 5, &links);
        tap_ok(pairs == n * (n - 1) / 2 && links.count == n - 1,
               "floor and %d ceilings on 5 ranks: %lld pairs, %lld links", n - 1,
               (long long)pairs, (long long)links.count);
        link_list_free(&links);
        world_free(&world);
        soup_free(&soup);
    }
}

int main(void)
{
    test_pairs(ORACLE_BF, "bf");
    test_pairs(ORACLE_ERROR, "error");
    test_rays();
    const int ranks[] = {2, 3, 7, 64, 100000};
    for (size_t i = 0; i < sizeof ranks / sizeof ranks[0]; i++)
        test_ranks(ranks[i]);
    test_few();
    return tap_done();
}
