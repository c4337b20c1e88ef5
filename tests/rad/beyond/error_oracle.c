/* Tests of rad/beyond/error_oracle.h: which patch of a link is split by error; and which
 * patches get children without it. */
#include "rad/beyond/error_oracle.h"

#include "rad/beyond/patch_link.h"
#include "rad/beyond/range.h"
#include "rad/pushpull.h"

#include "tests/pairs.h"
#include "tests/tap.h"

/* --- by error --- */

static int32_t at_threshold(struct world *world, const struct link *link,
                            double threshold)
{
    world->model.link_threshold = threshold;
    return error_oracle_side_to_split(&world->model, link);
}

/* Whether the error of the link is this number, to the bit or to 1e-6, and split for is
 * `side`. */
static bool error_is(struct world *world, const struct link *link, double error,
                     int32_t side)
{
    return at_threshold(world, link, error * (1.0 + 1e-6)) == NODE_NONE &&
           at_threshold(world, link, error * (1.0 - 1e-6)) == side;
}

/* Floor 0 and ceiling 1, `size` times as large, both rho = 1/2 and B = 1 in each of
 * three bands. */
static struct world make_grey(double size)
{
    struct material grey = material_grey(0.5, 1);
    struct world world = make_pair(size, grey, grey, NULL);
    return world;
}

static void test_nothing_wrong(void)
{
    struct world world = make_grey(1.0);
    struct link link = link_of(0, 1);
    tap_ok(at_threshold(&world, &link, 0.0) == NODE_NONE,
           "an open link with even parts and no range is never split");
    world.model.forest->radiosity[1] = (struct rgb){{1e6, 1e6, 1e6}};
    tap_ok(at_threshold(&world, &link, 0.0) == NODE_NONE, "however bright it is");
    world_free(&world);
}

/* Light that is reflected on arrival: rho B = 3/2 each way. The error of a spread is
 * 1/2 x 4 (most - least) G x 3/2. */
static void test_spread(void)
{
    struct world world = make_grey(2.0);
    struct link link = link_of(0, 1);
    link.parts_p[0] = 96; /* 96 64 64 32: spread 1/4 */
    tap_ok(error_is(&world, &link, 0.5 * 4.0 * 0.25 * 0.125 * 1.5, 0),
           "spread over p splits p, though q is larger");
    link.parts_p[0] = 128; /* 128 64 64 0: spread 1/2 */
    tap_ok(error_is(&world, &link, 0.5 * 4.0 * 0.5 * 0.125 * 1.5, 0),
           "twice as much, twice the error");
    link = link_of(0, 1);
    link.parts_q[2] = 128;
    tap_ok(error_is(&world, &link, 0.5 * 4.0 * 0.5 * 0.125 * 1.5, 1),
           "spread over q splits q");
    link.parts_p[1] = 0; /* 64 0 64 128 */
    link.parts_q[2] = 96;
    tap_ok(error_is(&world, &link, 0.5 * 4.0 * (0.5 + 0.25) * 0.125 * 1.5, 0),
           "errors of both sides add up, and the side that causes more is split");
    link.seen = 0;
    link.parts_p[1] = link.parts_q[2] = 64;
    world.scene->materials[1].reflectance = (struct rgb){{0.0, 0.0, 0.0}};
    link.seen = LINK_OPEN;
    link.parts_q[0] = 128;
    tap_ok(at_threshold(&world, &link, 0.0) == NODE_NONE,
           "spread over a black receiver does not matter");
    world.scene->materials[1].reflectance = (struct rgb){{0.0, 0.25, 0.0}};
    tap_ok(error_is(&world, &link, 0.5 * 4.0 * 0.5 * 0.125 * 0.25, 1),
           "light counts as far as its colour is reflected");
    world_free(&world);
}

/* Child 2 of patch `patch` gets four children of its own with radiosities from 1 to 1 +
 * range in band 1; child 0 is brighter all over. */
static void make_range(struct forest *forest, int32_t patch, double range)
{
    forest_split(forest, patch);
    int32_t child = forest->patches[patch].children;
    forest_split(forest, child + 2);
    int32_t grandchild = forest->patches[child + 2].children;
    forest->radiosity[child] = (struct rgb){{50.0, 1.0, 1.0}};
    forest->radiosity[grandchild + 1].band[1] = 1.0 + range;
    forest_average(forest);
    forest_bound(forest, NULL, forest->count);
}

/* The error of a range is G x rho of the receiver x the range. */
static void test_range(void)
{
    struct world world = make_grey(2.0);
    struct link link = link_of(0, 1);
    make_range(world.model.forest, 0, 0.75);
    tap_ok(error_is(&world, &link, 0.125 * 0.5 * 0.75, 0),
           "a range of radiosity within a child splits its patch, though the other is "
           "larger; "
           "children that differ do not count");
    world.scene->materials[1].reflectance = (struct rgb){{0.0, 0.0, 0.0}};
    tap_ok(at_threshold(&world, &link, 0.0) == NODE_NONE, "unless the receiver is black");
    world_free(&world);
    world = make_grey(2.0);
    make_range(world.model.forest, 1, 0.75);
    tap_ok(error_is(&world, &link, 0.125 * 0.5 * 0.75, 1), "the same on the other side");
    link.seen = 0;
    /* Doubt alone is left: 1/8 of G x rho B both ways. */
    double to_p = 0.5 * rgb_sum(world.model.forest->radiosity[1]), to_q = 1.5;
    tap_ok(error_is(&world, &link, 0.125 * 0.125 * (to_p + to_q), 1),
           "the light that a blocked link might carry is only in doubt");
    world_free(&world);
}

static void test_error_doubt(void)
{
    struct world world = make_grey(2.0);
    struct link link = link_of(0, 1);
    link.seen = LINK_ALL_SEEN;
    double agreed = 0.125 * 0.125 * 3.0; /* an eighth of G, 3/2 each way */
    tap_ok(error_is(&world, &link, agreed, 1),
           "all segments arrive: in doubt, and the larger is split");
    link.seen = 0;
    tap_ok(error_is(&world, &link, agreed, 1), "none arrives: the same");
    link.seen = LINK_OPEN_NEAR;
    tap_ok(error_is(&world, &link, agreed, 1), "open but near: the same");
    link.seen = LINK_OPEN;
    tap_ok(at_threshold(&world, &link, 1e-9) == NODE_NONE, "open and far: none");
    link.seen = LINK_ALL_SEEN / 2;
    tap_ok(error_is(&world, &link, 4.0 * agreed, 1),
           "half of them: twice the doubt about twice the area");
    link.parts_p[0] = 72; /* 72 64 64 56: spread 1/16 */
    tap_ok(error_is(&world, &link, 4.0 * agreed + 0.5 * 4.0 * 0.0625 * 0.125 * 1.5, 1),
           "of which the larger counts as the cause");
    link.parts_p[0] = 64;
    struct link swapped = link;
    swapped.p = 1;
    swapped.q = 0;
    tap_ok(error_is(&world, &swapped, 4.0 * agreed, 1), "whichever is named first");
    world_free(&world);
}

/* A side that may not be split leaves it to the other, if that causes enough of the
 * error. */
static void test_error_limits(void)
{
    struct world world = make_grey(2.0);
    struct model *model = &world.model;
    struct link link = link_of(0, 1);
    link.parts_p[0] = 128; /* error 3/16 on p, 3/32 on q: 9/32 */
    link.parts_q[0] = 96;
    model->patch_threshold = nextafter(0.25 * forest_area(model->forest, 0), HUGE_VAL);
    tap_ok(at_threshold(&world, &link, 0.185) == 1,
           "a patch that is too small leaves it to the other, which causes half a "
           "threshold");
    tap_ok(at_threshold(&world, &link, 0.19) == NODE_NONE,
           "if it causes less nothing is split");
    model->patch_threshold = nextafter(0.25 * forest_area(model->forest, 1), HUGE_VAL);
    tap_ok(at_threshold(&world, &link, 0.1) == NODE_NONE, "nor if both are too small");
    model->patch_threshold = 0.25 * forest_area(model->forest, 0);
    tap_ok(at_threshold(&world, &link, 0.1) == 0,
           "one that is just large enough is split");
    model->criterion.max_level = 0;
    tap_ok(at_threshold(&world, &link, 0.0) == NODE_NONE, "level 0 splits nothing");
    world_free(&world);
}

/* --- dividing --- */

static bool divides(struct world *world, const struct link *link, double threshold,
                    int32_t patch)
{
    struct forest *forest = world->model.forest;
    int64_t before = forest->count;
    world->model.link_threshold = threshold;
    error_oracle_divide(&world->model, link);
    bool only = patch < 0 ? forest->count == before
                          : forest->count == before + 4 &&
                                !patch_is_leaf(&forest->patches[patch]);
    for (int32_t root = 0; root < forest->root_count; root++) /* as it was */
        forest->patches[root].children = 0;
    forest->count = before;
    return only;
}

static void test_dividing(void)
{
    struct world world = make_grey(2.0);
    struct model *model = &world.model;
    struct link link = link_of(0, 1);
    const double spread = 4.0 * 0.25 * 0.125 * 1.5; /* all of it: half is left when
                                                       divided */
    tap_ok(divides(&world, &link, 0.0, -1), "even parts divide nothing");
    link.parts_p[0] = 96;
    tap_ok(divides(&world, &link, spread, -1) && divides(&world, &link, 0.999 * spread,
                                                         0),
           "a spread above the threshold divides the receiver");
    link = link_of(0, 1);
    link.parts_q[2] = 96;
    tap_ok(divides(&world, &link, spread, -1) && divides(&world, &link, 0.999 * spread,
                                                         1),
           "on either side");
    link.seen = 0;
    tap_ok(divides(&world, &link, 0.0, -1), "a blocked link divides nothing");
    link.seen = LINK_ALL_SEEN / 2;
    model->patch_threshold = 0.25 * forest_area(model->forest, 1);
    bool at = divides(&world, &link, 0.5 * spread, 1);
    model->patch_threshold = nextafter(model->patch_threshold, HUGE_VAL);
    tap_ok(at && divides(&world, &link, 0.5 * spread, -1),
           "no patch below the least area is made");
    model->patch_threshold = 0.0;
    model->criterion.max_level = 0;
    tap_ok(divides(&world, &link, 0.5 * spread, -1), "nor one beyond the deepest level");
    model->criterion.max_level = ID_MAX_LEVEL;
    world.scene->materials[1].reflectance = (struct rgb){{0.0, 0.0, 0.0}};
    tap_ok(divides(&world, &link, 0.0, -1),
           "light arriving at a black receiver does not matter");
    world.scene->materials[1].reflectance = (struct rgb){{0.5, 0.5, 0.5}};
    world_free(&world);
}

/* --- scale --- */

int main(void)
{
    test_nothing_wrong();
    test_spread();
    test_range();
    test_error_doubt();
    test_error_limits();
    test_dividing();
    return tap_done();
}
