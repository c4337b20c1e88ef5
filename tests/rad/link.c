/* Tests of rad/link.h: which links are made and with what cost, which patch of a link is split,
 * what its children are, and that light goes both ways to the last integer. */
#include "rad/link.h"

#include <string.h>

#include "rad/oracle.h"
#include "rad/pushpull.h"

#include "tests/pairs.h"
#include "tests/tap.h"

/* --- which links are made --- */

static void test_making(void)
{
    tap_ok(sizeof(struct link) <= 24, "a link takes %d bytes", (int)sizeof(struct link));
    struct soup more = bystander();
    struct world world = make_pair(1.0, material_grey(0.5, 0), material_grey(0, 1), &more);
    struct facet p = facet_make(world.model.forest, 0), q = facet_make(world.model.forest, 1);
    struct octree_counts counts = {0};
    struct sight sight = {.open = false, .blocker = -1};
    struct exchange exchange = exchange_estimate(&p, &q, FORM_FACTOR_DISK, LOOK_ALL, world.octree,
                                                 &sight, &counts);
    struct link link;
    tap_ok(make(&world, 0, 1, &link) && link.p == 0 && link.q == 1 && exchange.area > 0.0 &&
               link.area == float_below(exchange.area) && link.seen == LINK_ALL_SEEN,
           "a link carries the exchange of its patches");
    tap_ok(world.model.counts.rays == 16 && counts.rays == 16 &&
               tests_done(&world) == counts.node_tests + counts.triangle_tests,
           "its work is added to the counts");
    tap_ok(tests_done(&world) > 0 && link.cost == compact8((double)tests_done(&world)),
           "and is its cost");
    world_free(&world);
    soup_free(&more);
}

static void test_dropping(void)
{
    struct link link;
    struct material black = material_grey(0, 0), white = material_grey(0.5, 0);
    struct world dark = make_pair(1.0, black, black, NULL);
    tap_ok(!make(&dark, 0, 1, &link) && dark.model.counts.rays == 0,
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
    tap_ok(dropped && world.model.counts.rays == 0, "patches that do not face are not linked");
    world_free(&world);
    more.count = 0;
    soup_add(&more, tile(-0.1, 0.5, 1.5, true));
    struct triangle *cover = &more.items[0];
    for (int k = 0; k < 3; k++)
        cover->corner[k].y -= 0.1;
    struct world covered = make_pair(1.0, white, white, &more);
    struct link children[4];
    tap_ok(make(&covered, 0, 1, &link) && link_area(&link) == 0.0 && covered.model.counts.rays == 16 &&
               link_split(&covered.model, &link, 0, children) == 0 &&
               patch_is_leaf(&covered.model.forest->patches[0]),
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
    if (!tap_ok(make(&world, 0, 1, &link) && link_area(&link) == 0.0 &&
                    link_unoccluded(&link) > 0.0,
                "a link that no ray passes but that is not proved blocked is kept"))
        return;
    world.model.link_threshold = 2.9 * link_unoccluded(&link); /* the ceiling's B: 3 x 1 */
    tap_ok(oracle_patch_to_split(&world.model, &link) == 0,
           "and is split while it may carry energy");
    world.model.link_threshold = 3.1 * link_unoccluded(&link);
    tap_ok(oracle_patch_to_split(&world.model, &link) == -1, "and not beyond");
    world_free(&world);
    soup_free(&more);
}

/* --- cost --- */

static void test_cost(void)
{
    struct soup more = bystander();
    struct world world = make_pair(1.0, material_grey(0.5, 0), material_grey(0, 1), &more);
    world.model.criterion.alpha = 0.25;
    struct facet p = facet_make(world.model.forest, 0), q = facet_make(world.model.forest, 1);
    struct link link;
    struct sight sight = {.open = false, .blocker = -1};
    bool made = link_make(&world.model, 0, &p, 1, &q, 1002.0, &sight, &link);
    int64_t own = tests_done(&world);
    tap_ok(made && own > 0 && link.cost == compact8((double)own + 250.5),
           "a link inherits alpha of a cost");
    struct link children[4];
    double inherited = 0.25 * link_cost(&link), sum = 0.0;
    int64_t before = tests_done(&world);
    int count = link_split(&world.model, &link, 0, children);
    for (int k = 0; k < count; k++)
        sum += link_cost(&children[k]);
    double expected = 4.0 * inherited + (double)(tests_done(&world) - before);
    /* The short form rounds up, by at most an eighth. */
    tap_ok(count == 4 && sum >= expected && sum <= 1.125 * expected,
           "children inherit from the link that is split");
    link.cost = 255;
    world.model.criterion.alpha = 1.0;
    link_split(&world.model, &link, 0, children);
    tap_ok(children[0].cost == 255, "costs end at four thousand million");
    world_free(&world);
    soup_free(&more);
    struct soup soup = {0};
    soup_add(&soup, (struct triangle){{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
    soup_add(&soup, (struct triangle){{{1, 0, -1}, {1, 0, 0.05}, {1, 1, -1}}});
    struct scene *scene = scene_of_soup(&soup, 1);
    scene->materials[0] = material_grey(0.5, 1);
    struct world horizon = world_make(scene);
    tap_ok(make(&horizon, 0, 1, &link) && tests_done(&horizon) == 0 && link_cost(&link) == 1.0,
           "a link without any test costs 1");
    world_free(&horizon);
    soup_free(&soup);
}

/* --- splitting --- */

static void test_split(void)
{
    struct material grey = material_grey(0.5, 1);
    struct world world = make_pair(2.0, grey, grey, NULL);
    struct forest *forest = world.model.forest;
    struct link link, children[4], again[4];
    make(&world, 0, 1, &link);
    int count = link_split(&world.model, &link, 1, children);
    bool right = count == 4 && forest->count == 6;
    double sum = 0.0;
    for (int k = 0; k < count; k++) {
        right = right && children[k].p == 0 && children[k].q == forest->patches[1].children + k;
        sum += link_area(&children[k]);
    }
    tap_ok(right, "the children of q take its place");
    count = link_split(&world.model, &link, 1, again);
    right = count == 4 && forest->count == 6;
    for (int k = 0; k < count; k++)
        right = right && memcmp(&again[k].parts_p, &children[k].parts_p, 3) == 0 &&
                again[k].area == children[k].area && again[k].q == children[k].q;
    tap_ok(right, "a patch that is split already stays as it is, and the links are the same");
    /* 16 rays against 64 over the same pair: their difference is the error of either. */
    tap_ok(fabs(sum / link_area(&link) - 1.0) < 0.03, "together they exchange what the link did");
    count = link_split(&world.model, &link, 0, children);
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
    int count = made ? link_split(&world.model, &link, 1, children) : 0;
    int32_t upper = world.model.forest->patches[1].children + 1; /* child 1, at corner b */
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
        forest_split(world.model.forest, r);
    for (int64_t p = 0; p < world.model.forest->count; p++)
        for (int c = 0; c < BANDS; c++)
            world.model.forest->patches[p].radiosity.band[c] = random_unit(&random);
    return world;
}

/* Parts that add up to 256, some of them 0; a quarter of all are even. */
static void random_parts(struct random *random, uint8_t parts[3])
{
    int left = 256;
    bool even = random_below(random, 4) == 0;
    for (int k = 0; k < 3; k++) {
        int most = left < 255 ? left : 255;
        parts[k] = (uint8_t)(even ? 64 : random_below(random, 3) == 0 ? 0
                                  : random_below(random, most + 1));
        left -= parts[k];
    }
}

/* Every tenth link is blocked. */
static void make_links(const struct forest *forest, struct link_list *list)
{
    struct random random = random_seed(2);
    for (int i = 0; i < LINKS; i++) {
        int32_t p = random_below(&random, (int32_t)forest->count), q = p;
        while (q == p)
            q = random_below(&random, (int32_t)forest->count);
        struct link link = {.p = p, .q = q, .area = float_below(1e-6 * random_unit(&random)),
                            .seen = (uint8_t)(i % 10 == 0 ? 0 : 1 + random_below(&random, 255))};
        random_parts(&random, link.parts_p);
        random_parts(&random, link.parts_q);
        link_list_append(list, link);
    }
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

static const struct link PLAIN = {.p = 3, .q = 7, .area = 0.25f, .parts_p = {64, 64, 64},
                                  .parts_q = {64, 64, 64}, .seen = LINK_ALL_SEEN, .cost = 1};

static void test_one_transfer(void)
{
    struct world world = make_many();
    struct forest *forest = world.model.forest;
    struct flux_unit unit = {1024.0, 1.0 / 1024.0};
    forest->patches[3].radiosity = (struct rgb){{1.0, 2.0, 0.0}};
    forest->patches[7].radiosity = (struct rgb){{0.0, 16.0, -4.0}};
    forest->patches[3].flux[0] = 5;
    struct link_list list = {0};
    link_list_append(&list, PLAIN);
    link_list_sort(&list);
    links_transfer(&list, forest, unit);
    const int64_t *p = forest->patches[3].flux, *q = forest->patches[7].flux;
    tap_ok(p[0] == 5 && p[1] == 4096 && p[2] == -1024 && q[0] == 256 && q[1] == 512 && q[2] == 0,
           "G B of either side is added to the flux of the other, whatever its sign");
    clear_flux(forest);
    list.items[0].seen = 0;
    link_list_sort(&list);
    links_transfer(&list, forest, unit);
    tap_ok(p[1] == 0 && p[2] == 0 && q[0] == 0 && q[1] == 0, "a blocked link carries nothing");
    list.items[0].seen = 1;
    link_list_sort(&list);
    links_transfer(&list, forest, unit);
    tap_ok(p[1] == 4096 && q[1] == 512, "one that is seen at all carries its area");
    link_list_free(&list);
    tap_ok(!list.items && list.count == 0, "a list is freed");
    world_free(&world);
}

static void test_areas(void)
{
    struct link link = PLAIN;
    link.seen = 0;
    tap_ok(link_area(&link) == 0.0 && link_unoccluded(&link) == 0.25,
           "a blocked link has no area, but remembers what it would have");
    link.seen = LINK_ALL_SEEN / 2;
    tap_ok(link_area(&link) == 0.25 && link_unoccluded(&link) == 0.5,
           "one that is half seen would have twice as much");
    link.seen = LINK_ALL_SEEN;
    bool right = link_area(&link) == 0.25 && link_unoccluded(&link) == 0.25;
    link.seen = LINK_OPEN;
    tap_ok(right && link_area(&link) == 0.25 && link_unoccluded(&link) == 0.25,
           "one that is seen or open has what it would have");
    link.cost = compact8(1000.0);
    tap_ok(link_cost(&link) == 1024.0, "a cost is rounded up: 1000 to 1024");
    const uint8_t parts[3] = {128, 64, 0};
    tap_ok(link_part(parts, 0) == 0.5 && link_part(parts, 1) == 0.25 && link_part(parts, 2) == 0.0 &&
               link_part(parts, 3) == 0.25,
           "the last part is the rest");
}

/* --- parts --- */

/* Children of patches 2 and 4 of the made-up forest (which has them). Numbers are such that all
 * products are exact. */
static void test_dealing(void)
{
    struct world world = make_many();
    struct forest *forest = world.model.forest;
    struct flux_unit unit = {1024.0, 1.0 / 1024.0};
    struct patch *p = &forest->patches[forest->patches[2].children];
    struct patch *q = &forest->patches[forest->patches[4].children];
    for (int k = 0; k < 4; k++) {
        p[k].radiosity = (struct rgb){{k + 1.0, 0.0, 0.0}};
        q[k].radiosity = (struct rgb){{8.0 * (k + 1), 0.0, 4.0}};
    }
    forest_average(forest);
    forest_bound(forest);
    struct link link = {.p = 2, .q = 4, .area = 0.5f, .parts_p = {128, 0, 96},
                        .parts_q = {0, 0, 64}, .seen = LINK_ALL_SEEN};
    struct link_list list = {0};
    link_list_append(&list, link);
    link_list_sort(&list);
    links_transfer(&list, forest, unit);
    /* From q: 8 (3/4 + 4 x 3/4) = 30 and 4, times G = 1/2: 15 and 2 W to the children of p. From
     * p: 1/2 + 9/8 + 4/8 = 17/8, times 1/2: 17/16 W. */
    tap_ok(p[0].flux[0] == 7680 && p[1].flux[0] == 0 && p[2].flux[0] == 5760 &&
               p[3].flux[0] == 1920 && p[0].flux[2] == 1024 && p[1].flux[2] == 0 &&
               p[2].flux[2] == 768 && p[3].flux[2] == 256 && p[0].flux[1] == 0,
           "what p receives is dealt to its children by the parts of p; none for part 0");
    tap_ok(q[0].flux[0] == 0 && q[1].flux[0] == 0 && q[2].flux[0] == 272 && q[3].flux[0] == 816,
           "and what q receives by those of q");
    tap_ok(forest->patches[2].flux[0] == 0 && forest->patches[4].flux[0] == 0,
           "and nothing to the patches themselves");
    /* The same with even parts: 20 x 1/2 W to p, and 2.5 x 1/2 to q. */
    clear_flux(forest);
    list.items[0] = PLAIN;
    list.items[0].p = 2;
    list.items[0].q = 4;
    list.items[0].area = 0.5f;
    link_list_sort(&list);
    links_transfer(&list, forest, unit);
    double due = 10.0 / forest_area(forest, 2);
    bool same = forest->patches[2].flux[0] == 10240 && forest->patches[4].flux[0] == 1280;
    for (int k = 0; k < 4; k++) {
        int32_t child = forest->patches[2].children + k;
        double found = leaf_irradiance(forest, child, unit).band[0];
        same = same && fabs(found / due - 1.0) < 1e-15; /* one division */
    }
    tap_ok(same, "with even parts it is light of the patch and to the patch");
    /* Parts that are even but for 1 in 256 are dealt, and come to nearly the same. */
    clear_flux(forest);
    list.items[0].parts_p[0] = 65;
    list.items[0].parts_q[2] = 63;
    link_list_sort(&list);
    links_transfer(&list, forest, unit);
    bool dealt = forest->patches[2].flux[0] == 0 && forest->patches[4].flux[0] == 0;
    for (int k = 0; k < 4; k++) {
        int32_t child = forest->patches[2].children + k;
        double found = leaf_irradiance(forest, child, unit).band[0];
        dealt = dealt && fabs(found / due - 1.0) < 0.03; /* 1/64 of the part, and of what is sent */
    }
    tap_ok(dealt, "parts that are nearly even come to nearly the same at the leaves");
    link_list_free(&list);
    world_free(&world);
}

/* What a patch sends: B of a leaf, the children weighted by the parts of another. */
static struct rgb sent_by(const struct forest *forest, int32_t patch, const uint8_t parts[3])
{
    const struct patch *at = &forest->patches[patch];
    if (patch_is_leaf(at))
        return at->radiosity;
    struct rgb sum = {{0.0, 0.0, 0.0}};
    for (int k = 0; k < 4; k++)
        for (int c = 0; c < BANDS; c++)
            sum.band[c] += link_part(parts, k) *
                           forest->patches[at->children + k].radiosity.band[c];
    return sum;
}

static void test_transfer(void)
{
    struct world world = make_many();
    struct forest *forest = world.model.forest;
    struct flux_unit unit = world.model.flux_unit;
    struct link_list list = {0}, turned = {0};
    forest_average(forest);
    forest_bound(forest);
    make_links(forest, &list);
    link_list_sort(&list);
    links_transfer(&list, forest, unit);
    int64_t received = 0;
    double sent = 0.0;
    for (int64_t i = 0; i < list.count; i++) {
        const struct link *link = &list.items[i];
        sent += link_area(link) * (rgb_sum(sent_by(forest, link->p, link->parts_p)) +
                                   rgb_sum(sent_by(forest, link->q, link->parts_q)));
        link_list_append(&turned, list.items[list.count - 1 - i]);
    }
    for (int64_t p = 0; p < forest->count; p++)
        for (int c = 0; c < BANDS; c++)
            received += forest->patches[p].flux[c];
    /* Half a unit for each of up to 24 numbers a link, and a sum of 5,000 in double. */
    double slack = 0.5 * 24 * LINKS * unit.watt + 1e-12 * sent;
    tap_ok(received > 0 && fabs(flux_to_watts(unit, received) - sent) <= slack,
           "what is received is what is sent");
    uint64_t hash = flux_hash(forest);
    clear_flux(forest);
    for (int64_t i = 0; i < turned.count; i += 2) { /* and the sides of half of them swapped */
        struct link old = turned.items[i], *link = &turned.items[i];
        link->p = old.q;
        link->q = old.p;
        memcpy(link->parts_p, old.parts_q, sizeof link->parts_p);
        memcpy(link->parts_q, old.parts_p, sizeof link->parts_q);
    }
    link_list_sort(&turned);
    links_transfer(&turned, forest, unit);
    tap_ok(flux_hash(forest) == hash, "bit by bit the same in another order of links");
    for (int64_t p = 0; p < forest->count; p++)
        for (int c = 0; c < BANDS; c++)
            forest->patches[p].radiosity.band[c] = -forest->patches[p].radiosity.band[c];
    int64_t darkness = 0, nonzero = 0;
    link_list_sort(&list);
    links_transfer(&list, forest, unit);
    for (int64_t p = 0; p < forest->count; p++)
        for (int c = 0; c < BANDS; c++)
            darkness += forest->patches[p].flux[c] != 0;
    clear_flux(forest);
    link_list_sort(&list);
    links_transfer(&list, forest, unit);
    for (int64_t p = 0; p < forest->count; p++)
        for (int c = 0; c < BANDS; c++) {
            nonzero += forest->patches[p].flux[c] < 0;
            forest->patches[p].flux[c] = -forest->patches[p].flux[c];
        }
    tap_ok(darkness == 0, "-B takes away exactly what B brought");
    tap_ok(nonzero > 0 && flux_hash(forest) == hash, "alone it is exactly the opposite");
    link_list_free(&list);
    link_list_free(&turned);
    world_free(&world);
}

/* Made by the error oracle, a link has the parts of its exchange; by the paper's, even ones. */
static void test_parts(void)
{
    struct random random = random_seed(5);
    int made = 0, uneven = 0, off = 0, odd = 0, blocked = 0;
    for (int i = 0; i < 300; i++) {
        struct soup soup = {0};
        for (int k = 0; k < 6; k++)
            soup_add(&soup, random_triangle(&random, 0.4, 0.4));
        struct scene *scene = scene_of_soup(&soup, 1);
        scene->materials[0] = material_grey(0.5, 1);
        soup_free(&soup);
        struct world world = world_make(scene);
        struct facet p = facet_make(world.model.forest, 0);
        struct facet q = facet_make(world.model.forest, 1);
        struct link link, paper;
        world.model.criterion.form_factor = i % 2 ? FORM_FACTOR_POLYGON : FORM_FACTOR_DISK;
        world.model.link_threshold = 0.0; /* so that all is looked at */
        bool there = make(&world, 0, 1, &paper);
        world.model.criterion.oracle = ORACLE_ERROR;
        if (there && make(&world, 0, 1, &link)) {
            struct octree_counts counts = {0};
            struct sight sight = {.open = false, .blocker = -1};
            struct exchange exchange = exchange_estimate(&p, &q, world.model.criterion.form_factor,
                                                         LOOK_ALL, world.octree, &sight, &counts);
            made++;
            for (int k = 0; k < 4; k++) {
                /* Within one in 256, and what rounds the exact parts. */
                off += fabs(link_part(link.parts_p, k) - exchange.parts_p[k]) > 1.0001 / 256.0 ||
                       fabs(link_part(link.parts_q, k) - exchange.parts_q[k]) > 1.0001 / 256.0;
                off += link_part(link.parts_p, k) < 0.0 || link_part(link.parts_q, k) < 0.0;
                odd += link_part(paper.parts_p, k) != 0.25 || link_part(paper.parts_q, k) != 0.25;
            }
            uneven += link.parts_p[0] != 64 || link.parts_q[1] != 64;
            blocked += link.seen == 0;
            off += link.area != paper.area || link.seen != paper.seen;
        }
        world_free(&world);
    }
    tap_ok(made > 40 && uneven > made / 2 && blocked > 5 && off == 0,
           "%d links, %d of them blocked: their parts are those of the exchange, in 256ths", made,
           blocked);
    tap_ok(odd == 0, "the paper's are even");
}

/* A child of an open link is open, and fires no ray. */
static void test_inheriting(void)
{
    struct soup more = bystander();
    struct world world = make_pair(1.0, material_grey(0.5, 0), material_grey(0, 1), &more);
    struct link link, children[4];
    make(&world, 0, 1, &link);
    link.seen = LINK_OPEN;
    int64_t rays = world.model.counts.rays;
    int count = link_split(&world.model, &link, 0, children);
    bool open = count == 4 && world.model.counts.rays == rays;
    for (int k = 0; k < count; k++)
        open = open && link_is_open(&children[k]);
    tap_ok(open, "children of an open link are open and cost no ray");
    world_free(&world);
    soup_free(&more);
    soup_add_quad(&more, point(-1, -1, 0.5), point(3, 0, 0), point(0, 3, 0), 1);
    world = make_pair(1.0, material_grey(0.5, 0), material_grey(0, 1), &more);
    bool made = make(&world, 0, 1, &link);
    tap_ok(made && link.seen == 0 && link.blocker >= 2 && link.blocker <= 3,
           "a link knows what blocked it");
    world_free(&world);
    soup_free(&more);
}

int main(void)
{
    test_making();
    test_dropping();
    test_doubt();
    test_cost();
    test_split();
    test_dropped_children();
    test_one_transfer();
    test_areas();
    test_dealing();
    test_transfer();
    test_parts();
    test_inheriting();
    return tap_done();
}
