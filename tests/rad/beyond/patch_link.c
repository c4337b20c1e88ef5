/* Tests of rad/beyond/patch_link.h: links of two patches that are in doubt, proved to be
 * blocked or open, and the parts by which they deal light to children. */
#include "rad/beyond/patch_link.h"

#include <string.h>

#include "rad/beyond/node_link.h"
#include "rad/beyond/patch_exchange.h"
#include "rad/beyond/range.h"
#include "rad/pushpull.h"

#include "tests/tap.h"
#include "tests/transfers.h"

static struct world make_default_pair(struct material floor, struct material ceiling,
                                      struct soup *more)
{
    struct world world = make_pair(1.0, floor, ceiling, more);
    world.model.method = DEFAULT;
    return world;
}

/* --- which links are made --- */

static void test_dropping(void)
{
    struct link link;
    struct material black = material_grey(0, 0), white = material_grey(0.5, 0);
    struct world dark = make_default_pair(black, black, NULL);
    tap_ok(!make(&dark, 0, 1, &link) && dark.model.counts.rays == 0,
           "two dark patches are not linked, and get no rays");
    world_free(&dark);
    struct world half = make_default_pair(black, white, NULL);
    tap_ok(make(&half, 0, 1, &link) && make(&half, 1, 0, &link),
           "one dark patch is linked");
    world_free(&half);
    struct soup more = {0};
    soup_add(&more, tile(-0.1, 0.5, 1.5, true));
    struct triangle *cover = &more.items[0];
    for (int k = 0; k < 3; k++)
        cover->corner[k].y -= 0.1;
    struct world covered = make_default_pair(white, white, &more);
    struct link children[4];
    tap_ok(make(&covered, 0, 1,
                &link) && link_area(&link) == 0.0 && covered.model.counts.rays == 16 &&
               patch_link_split(&covered.model, &link, 0, children) == 0 &&
               patch_is_leaf(&covered.model.forest->patches[0]),
           "a link that is proved blocked ends when it is to be split");
    world_free(&covered);
}

/* A cover of two parts stops all rays and proves nothing. */
static void test_doubt(void)
{
    struct soup more = {0};
    soup_add_quad(&more, point(-1, -1, 0.5), point(3, 0, 0), point(0, 3, 0), 1);
    struct world world = make_default_pair(material_grey(0.5, 0), material_grey(0, 1),
                                           &more);
    struct link link;
    tap_ok(make(&world, 0, 1, &link) && link_area(&link) == 0.0 && link.seen == 0 &&
               link_unoccluded(&link) > 0.0,
           "a link that no ray passes but that is not proved blocked is kept");
    tap_ok(link.blocker >= 2 && link.blocker <= 3, "and knows its blocker");
    world_free(&world);
}

static void test_cost(void)
{
    struct link link;
    struct soup soup = {0};
    soup_add(&soup, (struct triangle){{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
    soup_add(&soup, (struct triangle){{{1, 0, -1}, {1, 0, 0.05}, {1, 1, -1}}});
    paint(&soup, 0.5, 1);
    struct world horizon = world_make(scene_of_soup(&soup));
    horizon.model.method = DEFAULT;
    tap_ok(make(&horizon, 0, 1,
                &link) && tests_done(&horizon) == 0 &&
               link_cost(&link) == 1.0 + 2.0 * TESTS_PER_FORM_FACTOR,
           "a link without any test costs 1, and form factors");
    world_free(&horizon);
}

/* --- transfer --- */

static void test_areas(void)
{
    struct link link = PLAIN;
    link.seen = 0;
    tap_ok(link_area(&link) == 0.0 && link_unoccluded(&link) == 0.25,
           "a blocked link has no area, but remembers its unoccluded one");
    link.seen = LINK_ALL_SEEN / 2;
    tap_ok(link_area(&link) == 0.25 && link_unoccluded(&link) == 0.5,
           "one that is half seen would have twice as much");
    link.seen = LINK_ALL_SEEN;
    bool right = link_area(&link) == 0.25 && link_unoccluded(&link) == 0.25;
    link.seen = LINK_OPEN;
    tap_ok(right && link_area(&link) == 0.25 && link_unoccluded(&link) == 0.25,
           "one that is seen or open has its unoccluded area");
    link.cost = compact8(1000.0);
    tap_ok(expand8(link.cost) == 1024.0, "a cost is rounded up: 1000 to 1024");
    const uint8_t parts[3] = {128, 64, 0};
    tap_ok(link_part(parts, 0) == 0.5 && link_part(parts, 1) == 0.25 &&
               link_part(parts, 2) == 0.0 && link_part(parts, 3) == 0.25,
           "the last part is the rest");
}

/* --- parts --- */

/* Children of patches 2 and 4 of the made-up forest (which has them). Numbers are such
 * that all products are exact. */
static void test_dealing(void)
{
    struct world world = make_many();
    struct forest *forest = world.model.forest;
    struct flux_unit unit = {1024.0, 1.0 / 1024.0};
    struct patch *p = &forest->patches[forest->patches[2].children];
    struct patch *q = &forest->patches[forest->patches[4].children];
    for (int k = 0; k < 4; k++) {
        int32_t first_p = forest->patches[2].children,
                first_q = forest->patches[4].children;
        forest->radiosity[first_p + k] = (struct rgb){{k + 1.0, 0.0, 0.0}};
        forest->radiosity[first_q + k] = (struct rgb){{8.0 * (k + 1), 0.0, 4.0}};
    }
    forest_average(forest);
    forest_bound(forest, NULL, forest->count);
    struct link link = {.p = 2, .q = 4, .area = 0.5f, .parts_p = {128, 0, 96},
                        .parts_q = {0, 0, 64}, .seen = LINK_ALL_SEEN};
    struct link_list list = {0};
    link_list_append(&list, link);
    link_list_sort(&list);
    node_links_transfer(&list, &world.model, forest->radiosity, unit);
    /* From q: 8 (3/4 + 4 x 3/4) = 30 and 4, times G = 1/2: 15 and 2 W to the children of
     * p. From p: 1/2 + 9/8 + 4/8 = 17/8, times 1/2: 17/16 W. */
    tap_ok(p[0].flux[0] == 7680 && p[1].flux[0] == 0 && p[2].flux[0] == 5760 &&
               p[3].flux[0] == 1920 && p[0].flux[2] == 1024 && p[1].flux[2] == 0 &&
               p[2].flux[2] == 768 && p[3].flux[2] == 256 && p[0].flux[1] == 0,
           "light of p is dealt to its children by the parts of p; none for part 0");
    tap_ok(q[0].flux[0] == 0 && q[1].flux[0] == 0 && q[2].flux[0] == 272 &&
               q[3].flux[0] == 816,
           "and light of q by those of q");
    tap_ok(forest->patches[2].flux[0] == 0 && forest->patches[4].flux[0] == 0,
           "and nothing to the patches themselves");
    /* The same with even parts: 20 x 1/2 W to p, and 2.5 x 1/2 to q. */
    clear_flux(forest);
    list.items[0] = PLAIN;
    list.items[0].p = 2;
    list.items[0].q = 4;
    list.items[0].area = 0.5f;
    link_list_sort(&list);
    node_links_transfer(&list, &world.model, forest->radiosity, unit);
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
    node_links_transfer(&list, &world.model, forest->radiosity, unit);
    bool dealt = forest->patches[2].flux[0] == 0 && forest->patches[4].flux[0] == 0;
    for (int k = 0; k < 4; k++) {
        int32_t child = forest->patches[2].children + k;
        double found = leaf_irradiance(forest, child, unit).band[0];
        dealt = dealt && fabs(found / due - 1.0) < 0.03; /* 1/64 of the part, and of
                                                            what is sent */
    }
    tap_ok(dealt, "parts that are nearly even come to nearly the same at the leaves");
    link_list_free(&list);
    world_free(&world);
}

/* A link has the parts of its exchange. */
static void test_parts(void)
{
    struct random random = random_seed(5);
    int made = 0, uneven = 0, off = 0, blocked = 0;
    for (int i = 0; i < 300; i++) {
        struct soup soup = {0};
        soup_add_random(&soup, &random, 6, 0.4, 0.4);
        paint(&soup, 0.5, 1);
        struct scene *scene = scene_of_soup(&soup);
        struct world world = world_make(scene);
        struct facet p = facet_make(world.model.forest, 0);
        struct facet q = facet_make(world.model.forest, 1);
        struct link link;
        world.model.method = DEFAULT;
        if (make(&world, 0, 1, &link)) {
            struct octree_counts counts = {0};
            struct visibility visibility = {.open = false, .blocker = -1};
            struct exchange exchange =
                exchange_estimate(&p, &q, world.octree, &visibility, &counts);
            made++;
            for (int k = 0; k < 4; k++) {
                /* Within one in 256, and the rounding of exact parts. */
                off += fabs(link_part(link.parts_p,
                                      k) - exchange.parts_p[k]) > 1.0001 / 256.0 ||
                       fabs(link_part(link.parts_q,
                                      k) - exchange.parts_q[k]) > 1.0001 / 256.0;
                off += link_part(link.parts_p, k) < 0.0 || link_part(link.parts_q,
                                                                     k) < 0.0;
            }
            uneven += link.parts_p[0] != 64 || link.parts_q[1] != 64;
            blocked += link.seen == 0;
        }
        world_free(&world);
    }
    tap_ok(
        made > 40 && uneven > made / 2 && blocked > 5 && off == 0,
        "%d links, %d of them blocked: their parts are those of the exchange, in 256ths",
        made, blocked);
}

/* A child of an open link is open, and fires no ray. */
static void test_inheriting(void)
{
    struct soup more = bystander();
    struct world world = make_default_pair(material_grey(0.5, 0), material_grey(0, 1),
                                           &more);
    struct link link, children[4];
    make(&world, 0, 1, &link);
    link.seen = LINK_OPEN;
    int64_t rays = world.model.counts.rays;
    int count = patch_link_split(&world.model, &link, 0, children);
    bool open = count == 4 && world.model.counts.rays == rays;
    for (int k = 0; k < count; k++)
        open = open && link_is_open(&children[k]);
    tap_ok(open, "children of an open link are open and cost no ray");
    world_free(&world);
}

int main(void)
{
    test_dropping();
    test_doubt();
    test_cost();
    test_areas();
    test_dealing();
    test_parts();
    test_inheriting();
    return tap_done();
}
