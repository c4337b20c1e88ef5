/* Tests of rad/link.h: which links are made and with what cost, which patch of a link is split,
 * what its children are, and that light goes both ways to the last integer. */
#include "rad/link.h"

#include "tests/scenes.h"
#include "tests/tap.h"

static struct vec3 point(double x, double y, double z)
{
    return (struct vec3){x, y, z};
}

/* A right triangle in the plane z, its right angle at x, facing up or down. */
static struct triangle tile(double x, double z, double size, bool up)
{
    struct vec3 a = {x, 0, z}, b = {x + size, 0, z}, c = {x, size, z};
    return up ? (struct triangle){{a, b, c}} : (struct triangle){{a, c, b}};
}

/* The link between two patches as an initial link. */
static bool make(struct world *world, int32_t p, int32_t q, struct link *link)
{
    struct facet facet_p = facet_make(world->method.forest, p);
    struct facet facet_q = facet_make(world->method.forest, q);
    int32_t guess = -1;
    return link_make(&world->method, p, &facet_p, q, &facet_q, 0, &guess, link);
}

/* Floor 0 (material 0) and ceiling `size` times as large (material 1), then `more`. */
static struct world make_pair(double size, struct material floor, struct material ceiling,
                              const struct soup *more)
{
    struct soup soup = {0};
    soup_add(&soup, tile(0, 0, 1, true));
    soup_add(&soup, tile(0, 1, size, false));
    for (int64_t i = 0; more && i < more->count; i++)
        soup_add(&soup, more->items[i]);
    struct scene *scene = scene_of_soup(&soup, 3);
    scene->material_of[1] = 1;
    for (int64_t i = 2; i < soup.count; i++)
        scene->material_of[i] = 2;
    scene->materials[0] = floor;
    scene->materials[1] = ceiling;
    soup_free(&soup);
    return world_make(scene);
}

static int64_t tests_done(const struct world *world)
{
    return world->method.counts.node_tests + world->method.counts.triangle_tests;
}

/* A triangle beside the pair, so that there is something to test: floor and ceiling alone are the
 * hull of their scene and block nothing. */
static struct soup bystander(void)
{
    struct soup more = {0};
    soup_add(&more, (struct triangle){{{0.5, 0.3, 0.5}, {0.5, 0.4, 0.5}, {0.5, 0.4, 0.6}}});
    return more;
}

/* --- which links are made --- */

static void test_making(void)
{
    tap_ok(sizeof(struct link) <= 24, "a link takes %d bytes", (int)sizeof(struct link));
    struct soup more = bystander();
    struct world world = make_pair(1.0, material_grey(0.5, 0), material_grey(0, 1), &more);
    struct facet p = facet_make(world.method.forest, 0), q = facet_make(world.method.forest, 1);
    struct octree_counts counts = {0};
    int32_t guess = -1;
    struct exchange exchange = exchange_by_disks(&p, &q, world.octree, &guess, &counts);
    struct link link;
    tap_ok(make(&world, 0, 1, &link) && link.p == 0 && link.q == 1 && link.area == exchange.area &&
               link.unoccluded == (float)exchange.unoccluded,
           "a link carries the exchange of its patches");
    tap_ok(world.method.counts.rays == 16 && counts.rays == 16 &&
               tests_done(&world) == counts.node_tests + counts.triangle_tests,
           "its work is added to the counts");
    tap_ok(tests_done(&world) > 0 && link.cost == (uint32_t)tests_done(&world), "and is its cost");
    world_free(&world);
    soup_free(&more);
}

static void test_dropping(void)
{
    struct link link;
    struct material black = material_grey(0, 0), white = material_grey(0.5, 0);
    struct world dark = make_pair(1.0, black, black, NULL);
    tap_ok(!make(&dark, 0, 1, &link) && dark.method.counts.rays == 0,
           "two dark patches are not linked, and get no rays");
    world_free(&dark);
    struct world half = make_pair(1.0, black, white, NULL);
    tap_ok(make(&half, 0, 1, &link) && make(&half, 1, 0, &link), "one dark patch is linked");
    world_free(&half);
    struct soup more = {0};
    soup_add(&more, tile(2, 0, 1, true));   /* 2: in the plane of the floor */
    soup_add(&more, tile(0, -1, 1, true));  /* 3: below it */
    soup_add(&more, tile(0, -2, 1, false)); /* 4: has its back to all */
    struct world world = make_pair(1.0, white, white, &more);
    world.scene->materials[2] = white;
    bool dropped = !make(&world, 0, 2, &link) && !make(&world, 0, 3, &link) &&
                   !make(&world, 0, 4, &link) && !make(&world, 3, 4, &link) &&
                   !make(&world, 0, 0, &link);
    tap_ok(dropped && world.method.counts.rays == 0, "patches that do not face are not linked");
    world_free(&world);
    more.count = 0;
    soup_add(&more, tile(-0.1, 0.5, 1.5, true));
    struct triangle *cover = &more.items[0];
    for (int k = 0; k < 3; k++)
        cover->corner[k].y -= 0.1;
    struct world covered = make_pair(1.0, white, white, &more);
    struct link children[4];
    tap_ok(make(&covered, 0, 1, &link) && link.area == 0.0 && covered.method.counts.rays == 16 &&
               link_split(&covered.method, &link, 0, children) == 0 &&
               patch_is_leaf(&covered.method.forest->patches[0]),
           "a link that is proved blocked ends when it is to be split");
    world_free(&covered);
    soup_free(&more);
}

/* A cover of two parts stops all rays and proves nothing. */
static void test_doubt(void)
{
    struct soup more = {0};
    soup_add_quad(&more, point(-1, -1, 0.5), point(3, 0, 0), point(0, 3, 0), 1);
    struct world world = make_pair(1.0, material_grey(0.5, 0), material_grey(0, 1), &more);
    struct link link;
    if (!tap_ok(make(&world, 0, 1, &link) && link.area == 0.0 && link.unoccluded > 0.0f,
                "a link that no ray passes but that is not proved blocked is kept"))
        return;
    world.method.link_threshold = 2.9 * (double)link.unoccluded; /* the ceiling's B: 3 x 1 */
    tap_ok(link_patch_to_split(&world.method, &link) == 0,
           "and is split while it may carry energy");
    world.method.link_threshold = 3.1 * (double)link.unoccluded;
    tap_ok(link_patch_to_split(&world.method, &link) == -1, "and not beyond");
    world_free(&world);
    soup_free(&more);
}

/* --- cost --- */

/* alpha 0.25 and counts below 2^32: the cost is exact but for the cut to an integer. */
static void test_cost(void)
{
    struct soup more = bystander();
    struct world world = make_pair(1.0, material_grey(0.5, 0), material_grey(0, 1), &more);
    world.method.criterion.alpha = 0.25;
    struct facet p = facet_make(world.method.forest, 0), q = facet_make(world.method.forest, 1);
    struct link link;
    int32_t guess = -1;
    bool made = link_make(&world.method, 0, &p, 1, &q, 1002, &guess, &link);
    int64_t own = tests_done(&world);
    tap_ok(made && own > 0 && link.cost == (uint32_t)own + 250, "a link inherits alpha of a cost");
    struct link children[4];
    uint32_t inherited = link.cost / 4;
    bool right = true;
    int64_t before = tests_done(&world), sum = 0;
    int count = link_split(&world.method, &link, 0, children);
    for (int k = 0; k < count; k++)
        sum += (int64_t)children[k].cost - (int64_t)inherited;
    right = count == 4 && sum == tests_done(&world) - before;
    tap_ok(right, "children inherit from the link that is split");
    link.cost = UINT32_MAX;
    world.method.criterion.alpha = 1.0;
    link_split(&world.method, &link, 0, children);
    tap_ok(children[0].cost == UINT32_C(4000000000), "costs end at four thousand million");
    world_free(&world);
    soup_free(&more);
    struct soup soup = {0};
    soup_add(&soup, (struct triangle){{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
    soup_add(&soup, (struct triangle){{{1, 0, -1}, {1, 0, 0.05}, {1, 1, -1}}});
    struct scene *scene = scene_of_soup(&soup, 1);
    scene->materials[0] = material_grey(0.5, 1);
    struct world horizon = world_make(scene);
    tap_ok(make(&horizon, 0, 1, &link) && tests_done(&horizon) == 0 && link.cost == 1,
           "a link without any test costs 1");
    world_free(&horizon);
    soup_free(&soup);
}

/* --- which patch is split --- */

static void test_energy(void)
{
    struct material lamp = {{{0.5, 0.5, 0.5}}, {{1.0, 2.0, 4.0}}};
    struct world world = make_pair(1.0, material_grey(0.5, 0), lamp, NULL);
    struct method *method = &world.method;
    struct link link = {0, 1, 0.0, 0.125f, 1}, swapped = {1, 0, 0.0, 0.125f, 1};
    method->link_threshold = 0.875; /* 0.125 x (1 + 2 + 4), exactly */
    tap_ok(link_patch_to_split(method, &link) == -1 &&
               link_patch_to_split(method, &swapped) == -1,
           "a link at the threshold is fine");
    method->link_threshold = nextafter(0.875, 0.0);
    tap_ok(link_patch_to_split(method, &link) == 0, "above it, in the sum of the bands, it is not");
    tap_ok(link_patch_to_split(method, &swapped) == 0, "also if it names the lamp first");
    world.scene->materials[0].reflectance = (struct rgb){{0, 0, 0}};
    tap_ok(link_patch_to_split(method, &link) == -1,
           "a receiver that does not reflect needs nothing");
    method->forest->patches[0].radiosity.band[1] = 8.0;
    tap_ok(link_patch_to_split(method, &link) == 0, "unless it sends light itself");
    world_free(&world);
}

static void test_choice(void)
{
    struct material grey = material_grey(0.5, 1);
    struct world world = make_pair(2.0, grey, grey, NULL);
    struct method *method = &world.method;
    method->link_threshold = 0.0;
    struct link link = {0, 1, 0.0, 0.125f, 1}, swapped = {1, 0, 0.0, 0.125f, 1};
    tap_ok(link_patch_to_split(method, &link) == 1 && link_patch_to_split(method, &swapped) == 1,
           "the larger patch is split");
    forest_split(method->forest, 1);
    int32_t child = method->forest->patches[1].children;
    struct link tie = {child, 0, 0.0, 0.125f, 1}, tie_swapped = {0, child, 0.0, 0.125f, 1};
    tap_ok(forest_area(method->forest, child) == forest_area(method->forest, 0) &&
               link_patch_to_split(method, &tie) == 0 &&
               link_patch_to_split(method, &tie_swapped) == 0,
           "of equal ones that with the lower ID");
    struct link siblings = {child + 2, child + 1, 0.0, 0.125f, 1};
    tap_ok(link_patch_to_split(method, &siblings) == child + 1, "also within a tree");
    method->criterion.max_level = 1;
    struct link mixed = {child, 0, 0.0, 0.125f, 1};
    forest_split(method->forest, 0);
    struct link deep = {method->forest->patches[0].children, child, 0.0, 0.125f, 1};
    tap_ok(link_patch_to_split(method, &mixed) == 0 && link_patch_to_split(method, &deep) == -1,
           "none is split beyond the deepest level");
    method->criterion.max_level = 0;
    tap_ok(link_patch_to_split(method, &link) == -1, "level 0 splits nothing");
    world_free(&world);
}

/* The ceiling at the deepest level leaves the smaller floor to be split. */
static void test_other_side(void)
{
    struct material grey = material_grey(0.5, 1);
    struct world world = make_pair(4.0, grey, grey, NULL);
    struct method *method = &world.method;
    method->link_threshold = 0.0;
    forest_split(method->forest, 1);
    struct link link = {0, method->forest->patches[1].children, 0.0, 0.125f, 1};
    tap_ok(link_patch_to_split(method, &link) == link.q, "the larger patch is a child here");
    method->criterion.max_level = 1;
    tap_ok(link_patch_to_split(method, &link) == 0,
           "at the deepest level it leaves it to the other");
    method->criterion.max_level = ID_MAX_LEVEL;
    double area = forest_area(method->forest, 0);
    struct link large = {0, 1, 0.0, 0.125f, 1};
    method->patch_threshold = 4.0 * area; /* a quarter of the ceiling, 16 times the floor */
    tap_ok(link_patch_to_split(method, &large) == 1, "parts as large as the smallest may be made");
    method->patch_threshold = nextafter(4.0 * area, HUGE_VAL);
    tap_ok(link_patch_to_split(method, &large) == -1, "smaller ones not");
    world_free(&world);
}

/* --- splitting --- */

static void test_split(void)
{
    struct material grey = material_grey(0.5, 1);
    struct world world = make_pair(2.0, grey, grey, NULL);
    struct forest *forest = world.method.forest;
    struct link link, children[4], again[4];
    make(&world, 0, 1, &link);
    int count = link_split(&world.method, &link, 1, children);
    bool right = count == 4 && forest->count == 6;
    double sum = 0.0;
    for (int k = 0; k < count; k++) {
        right = right && children[k].p == 0 && children[k].q == forest->patches[1].children + k;
        sum += children[k].area;
    }
    tap_ok(right, "the children of q take its place");
    count = link_split(&world.method, &link, 1, again);
    right = count == 4 && forest->count == 6;
    for (int k = 0; k < count; k++)
        right = right && again[k].area == children[k].area && again[k].q == children[k].q;
    tap_ok(right, "a patch that is split already stays as it is, and the links are the same");
    /* 16 rays against 64 over the same pair: their difference is the error of either. */
    tap_ok(fabs(sum / link.area - 1.0) < 0.03, "together they exchange what the link did");
    count = link_split(&world.method, &link, 0, children);
    right = count == 4 && forest->count == 10;
    for (int k = 0; k < count; k++)
        right = right && children[k].q == 1 && children[k].p == forest->patches[0].children + k;
    tap_ok(right, "or those of p its");
    world_free(&world);
}

/* A wall from one below the floor to one above it: only its child at the tip is above. */
static void test_dropped_children(void)
{
    struct soup soup = {0};
    soup_add(&soup, (struct triangle){{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
    soup_add(&soup, (struct triangle){{{1, 0, -1}, {1, 0, 1}, {1, 1, -1}}});
    struct scene *scene = scene_of_soup(&soup, 1);
    scene->materials[0] = material_grey(0.5, 1);
    struct world world = world_make(scene);
    struct link link, children[4];
    bool made = make(&world, 0, 1, &link);
    int count = made ? link_split(&world.method, &link, 1, children) : 0;
    int32_t upper = world.method.forest->patches[1].children + 1; /* child 1, at corner b */
    tap_ok(count == 1 && children[0].q == upper, "children below the horizon are dropped");
    world_free(&world);
    soup_free(&soup);
}

/* --- transfer --- */

enum { LINKS = 5000, ROOTS = 20 };

static struct world make_many(void)
{
    struct soup soup = {0};
    struct random random = random_seed(1);
    for (int i = 0; i < ROOTS; i++)
        soup_add(&soup, random_triangle(&random, 0.5, 0.2));
    struct scene *scene = scene_of_soup(&soup, 1);
    scene->materials[0] = material_grey(0.5, 1);
    soup_free(&soup);
    struct world world = world_make(scene);
    for (int32_t r = 0; r < ROOTS; r += 2)
        forest_split(world.method.forest, r);
    for (int64_t p = 0; p < world.method.forest->count; p++)
        for (int c = 0; c < BANDS; c++)
            world.method.forest->patches[p].radiosity.band[c] = random_unit(&random);
    return world;
}

static void make_links(const struct forest *forest, struct link_list *list)
{
    struct random random = random_seed(2);
    for (int i = 0; i < LINKS; i++) {
        int32_t p = random_below(&random, (int32_t)forest->count), q = p;
        while (q == p)
            q = random_below(&random, (int32_t)forest->count);
        double area = 1e-6 * random_unit(&random);
        link_list_append(list, (struct link){p, q, area, (float)area, 1});
    }
}

static void clear_flux(struct forest *forest)
{
    for (int64_t p = 0; p < forest->count; p++)
        for (int c = 0; c < BANDS; c++)
            forest->patches[p].flux[c] = 0;
}

/* FNV-like mix of all fluxes: equal sums, bit by bit. */
static uint64_t flux_hash(const struct forest *forest)
{
    uint64_t hash = 1;
    for (int64_t p = 0; p < forest->count; p++)
        for (int c = 0; c < BANDS; c++)
            hash = (hash ^ (uint64_t)forest->patches[p].flux[c]) * UINT64_C(1099511628211);
    return hash;
}

static void test_one_transfer(void)
{
    struct world world = make_many();
    struct forest *forest = world.method.forest;
    struct flux_unit unit = {1024.0, 1.0 / 1024.0};
    forest->patches[3].radiosity = (struct rgb){{1.0, 2.0, 0.0}};
    forest->patches[7].radiosity = (struct rgb){{0.0, 16.0, 4.0}};
    forest->patches[3].flux[0] = 5;
    struct link_list list = {0};
    link_list_append(&list, (struct link){3, 7, 0.25, 9.0f, 1});
    int64_t moved = links_transfer(&list, forest, unit);
    const int64_t *p = forest->patches[3].flux, *q = forest->patches[7].flux;
    tap_ok(p[0] == 5 && p[1] == 4096 && p[2] == 1024 && q[0] == 256 && q[1] == 512 && q[2] == 0,
           "G B of either side is added to the flux of the other");
    tap_ok(moved == 4096 + 1024 + 256 + 512, "and the sum is what moved");
    clear_flux(forest);
    links_transfer_ones(&list, forest, unit);
    tap_ok(p[0] == 256 && q[0] == 256 && p[1] == 0 && p[2] == 0 && q[1] == 0 && q[2] == 0,
           "with B = 1 both get G, in band 0");
    link_list_free(&list);
    tap_ok(!list.items && list.count == 0, "a list is freed");
    world_free(&world);
}

static void test_transfer(void)
{
    struct world world = make_many();
    struct forest *forest = world.method.forest;
    struct flux_unit unit = world.method.flux_unit;
    struct link_list list = {0}, turned = {0};
    make_links(forest, &list);
    int64_t moved = links_transfer(&list, forest, unit), received = 0;
    double sent = 0.0;
    for (int64_t i = 0; i < list.count; i++) {
        const struct link *link = &list.items[i];
        sent += link->area * (rgb_sum(forest->patches[link->p].radiosity) +
                              rgb_sum(forest->patches[link->q].radiosity));
        link_list_append(&turned, list.items[list.count - 1 - i]);
    }
    for (int64_t p = 0; p < forest->count; p++)
        for (int c = 0; c < BANDS; c++)
            received += forest->patches[p].flux[c];
    tap_ok(moved == received && moved > 0, "what moved is what is received");
    /* Half a unit for each of 6 numbers a link, and a sum of 5,000 in double. */
    double slack = 0.5 * 6 * LINKS * unit.watt + 1e-12 * sent;
    tap_ok(fabs(flux_to_watts(unit, received) - sent) <= slack, "and what is sent");
    uint64_t hash = flux_hash(forest);
    clear_flux(forest);
    for (int64_t i = 0; i < turned.count; i += 2) { /* and the sides of half of them swapped */
        struct link *link = &turned.items[i];
        *link = (struct link){link->q, link->p, link->area, link->unoccluded, link->cost};
    }
    links_transfer(&turned, forest, unit);
    tap_ok(flux_hash(forest) == hash, "bit by bit the same in another order of links");
    link_list_free(&list);
    link_list_free(&turned);
    world_free(&world);
}

int main(void)
{
    test_making();
    test_dropping();
    test_doubt();
    test_cost();
    test_energy();
    test_choice();
    test_other_side();
    test_split();
    test_dropped_children();
    test_one_transfer();
    test_transfer();
    return tap_done();
}
