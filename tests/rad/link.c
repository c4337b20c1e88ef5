/* Tests of rad/link.h: which links are made and with which cost, the children of a link
 * are, and that light goes both ways to the last integer. */
#include "rad/link.h"

#include <string.h>

#include "tests/tap.h"
#include "tests/transfers.h"

/* --- which links are made --- */

static void test_making(void)
{
    tap_ok(sizeof(struct link) <= 24, "a link takes %d bytes", (int)sizeof(struct link));
    struct soup more = bystander();
    struct world world = make_pair(1.0, material_grey(0.5, 0), material_grey(0, 1),
                                   &more);
    struct facet p = facet_make(world.model.forest, 0), q = facet_make(world.model.forest,
                                                                       1);
    struct octree_counts counts = {0};
    int32_t blocker = -1;
    double seen, area = exchange_area(&p, &q, world.octree, &blocker, &seen, &counts);
    struct link link;
    tap_ok(make(&world, 0, 1, &link) && link.p == 0 && link.q == 1 && area > 0.0 &&
               link.area == float_below(area) && seen == 1.0 &&
               link.seen == LINK_ALL_SEEN,
           "a link carries the exchange of its patches");
    tap_ok(world.model.counts.rays == 16 && counts.rays == 16 &&
               tests_done(&world) == counts.node_tests + counts.triangle_tests,
           "its work is added to the counts");
    tap_ok(tests_done(&world) > 0 && link.cost == compact8((double)tests_done(&world)) &&
               model_work(&world.model) == tests_done(&world) + TESTS_PER_FORM_FACTOR,
           "and is its cost, next to a constant");
    world_free(&world);
}

static void test_dropping(void)
{
    struct link link;
    struct material white = material_grey(0.5, 0);
    struct soup more = {0};
    soup_add(&more, tile(2, 0, 1, true));   /* 2: in the plane of the floor */
    soup_add(&more, tile(0, -1, 1, true));  /* 3: below it */
    soup_add(&more, tile(0, -2, 1, false)); /* 4: has its back to all */
    struct world world = make_pair(1.0, white, white, &more);
    bool dropped = !make(&world, 0, 2, &link) && !make(&world, 0, 3, &link) &&
                   !make(&world, 0, 4, &link) && !make(&world, 3, 4, &link) &&
                   !make(&world, 0, 0, &link);
    tap_ok(dropped && world.model.counts.rays == 0,
           "patches that do not face are not linked");
    world_free(&world);
    soup_add_quad(&more, point(-1, -1, 0.5), point(3, 0, 0), point(0, 3, 0), 1);
    struct world covered = make_pair(1.0, white, white, &more);
    tap_ok(!make(&covered, 0, 1,
                 &link) && covered.model.counts.rays == 16 && link.blocker >= 2 &&
               link.blocker <= 3,
           "nor are two between which no ray passes; their blocker is known");
    world_free(&covered);
}

/* --- cost --- */

static void test_cost(void)
{
    struct soup more = bystander();
    struct world world = make_pair(1.0, material_grey(0.5, 0), material_grey(0, 1),
                                   &more);
    world.model.criterion.alpha = 0.25;
    struct facet p = facet_make(world.model.forest, 0), q = facet_make(world.model.forest,
                                                                       1);
    struct link link;
    struct link parent = {.blocker = -1, .cost = compact8(1024.0)};
    bool made = link_make(&world.model, 0, &p, 1, &q, &parent, &link);
    int64_t own = tests_done(&world);
    tap_ok(made && own > 0 && link.cost == compact8((double)own + 256.0),
           "a link inherits alpha of a cost");
    struct link children[4];
    double inherited = 0.25 * expand8(link.cost), sum = 0.0;
    int64_t before = tests_done(&world);
    int count = link_split(&world.model, &link, 0, children);
    for (int k = 0; k < count; k++)
        sum += expand8(children[k].cost);
    double expected = 4.0 * inherited + (double)(tests_done(&world) - before);
    /* The short form rounds up, by at most an eighth. */
    tap_ok(count == 4 && sum >= expected && sum <= 1.125 * expected,
           "children inherit from the link that is split");
    link.cost = 255;
    world.model.criterion.alpha = 1.0;
    link_split(&world.model, &link, 0, children);
    tap_ok(children[0].cost == 255, "costs end at four thousand million");
    world_free(&world);
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
        right = right && children[k].p == 0 &&
                children[k].q == forest->patches[1].children + k;
        sum += link_area(&children[k]);
    }
    tap_ok(right, "the children of q take its place");
    count = link_split(&world.model, &link, 1, again);
    right = count == 4 && forest->count == 6;
    for (int k = 0; k < count; k++)
        right = right && memcmp(&again[k].parts_p, &children[k].parts_p, 3) == 0 &&
                again[k].area == children[k].area && again[k].q == children[k].q;
    tap_ok(right,
           "a patch that is split already stays as it is, and the links are the same");
    /* 16 rays against 64 over the same pair: their difference is the error of either. */
    tap_ok(fabs(sum / link_area(&link) - 1.0) < 0.03,
           "together they exchange as much as the link did");
    count = link_split(&world.model, &link, 0, children);
    right = count == 4 && forest->count == 10;
    for (int k = 0; k < count; k++)
        right = right && children[k].q == 1 &&
                children[k].p == forest->patches[0].children + k;
    tap_ok(right, "or those of p its");
    world_free(&world);
}

/* A wall from one below the floor to one above it: only its child at the tip is above. */
static void test_dropped_children(void)
{
    struct soup soup = {0};
    soup_add(&soup, (struct triangle){{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
    soup_add(&soup, (struct triangle){{{1, 0, -1}, {1, 0, 1}, {1, 1, -1}}});
    paint(&soup, 0.5, 1);
    struct world world = world_make(scene_of_soup(&soup));
    struct link link, children[4];
    bool made = make(&world, 0, 1, &link);
    int count = made ? link_split(&world.model, &link, 1, children) : 0;
    /* child 1, at corner b */
    int32_t upper = world.model.forest->patches[1].children + 1;
    tap_ok(count == 1 && children[0].q == upper,
           "children below the horizon are dropped");
    world_free(&world);
}

/* --- transfer --- */

static void test_one_transfer(void)
{
    struct world world = make_many();
    struct forest *forest = world.model.forest;
    struct flux_unit unit = {1024.0, 1.0 / 1024.0};
    forest->radiosity[3] = (struct rgb){{1.0, 2.0, 0.0}};
    forest->radiosity[7] = (struct rgb){{0.0, 16.0, -4.0}};
    forest->patches[3].flux[0] = 5;
    struct link_list list = {0};
    link_list_append(&list, PLAIN);
    links_transfer(&list, &world.model, forest->radiosity, unit);
    const int64_t *p = forest->patches[3].flux, *q = forest->patches[7].flux;
    tap_ok(p[0] == 5 && p[1] == 4096 && p[2] == -1024 && q[0] == 256 && q[1] == 512 &&
               q[2] == 0,
           "G B of either side is added to the flux of the other, whatever its sign");
    link_list_free(&list);
    tap_ok(!list.items && list.count == 0, "a list is freed");
    world_free(&world);
}

int main(void)
{
    test_making();
    test_dropping();
    test_cost();
    test_split();
    test_dropped_children();
    test_one_transfer();
    return tap_done();
}
