/* Tests of rad/oracle.h: which patch of a link is split, by energy. */
#include "rad/oracle.h"

#include "tests/pairs.h"
#include "tests/tap.h"

/* --- by energy --- */

static void test_energy(void)
{
    struct material lamp = {{{0.5, 0.5, 0.5}}, {{1.0, 2.0, 4.0}}, {{0}}};
    struct world world = make_pair(1.0, material_grey(0.5, 0), lamp, NULL);
    struct model *model = &world.model;
    struct link link = link_of(0, 1), swapped = link_of(1, 0);
    model->link_threshold = 0.875; /* 0.125 x (1 + 2 + 4), exactly */
    tap_ok(oracle_side_to_split(model, &link) == NODE_NONE &&
               oracle_side_to_split(model, &swapped) == NODE_NONE,
           "a link at the threshold is fine");
    model->link_threshold = nextafter(0.875, 0.0);
    tap_ok(oracle_side_to_split(model, &link) == 0,
           "above it, in the sum of the bands, it is not");
    tap_ok(oracle_side_to_split(model, &swapped) == 0, "also if it names the lamp first");
    model->link_threshold = 1.75;
    model->forest->radiosity[0].band[1] = 7.0;
    tap_ok(oracle_side_to_split(model, &link) == NODE_NONE, "both ways count together");
    model->link_threshold = nextafter(1.75, 0.0);
    tap_ok(oracle_side_to_split(model, &link) == 0, "to the last bit");
    link.seen = 0;
    model->link_threshold = 0.0;
    tap_ok(oracle_side_to_split(model, &link) == NODE_NONE,
           "a link that nothing passes has no energy");
    world_free(&world);
}

static void test_choice(void)
{
    struct material grey = material_grey(0.5, 1);
    struct world world = make_pair(2.0, grey, grey, NULL);
    struct model *model = &world.model;
    model->link_threshold = 0.0;
    struct link link = link_of(0, 1), swapped = link_of(1, 0);
    tap_ok(oracle_side_to_split(model, &link) == 1 && oracle_side_to_split(model,
                                                                           &swapped) == 1,
           "the larger patch is split");
    forest_split(model->forest, 1);
    int32_t child = model->forest->patches[1].children;
    struct link tie = link_of(child, 0), tie_swapped = link_of(0, child);
    tap_ok(forest_area(model->forest, child) == forest_area(model->forest, 0) &&
               oracle_side_to_split(model, &tie) == 0 &&
               oracle_side_to_split(model, &tie_swapped) == 0,
           "of equal ones that with the lower ID");
    struct link siblings = link_of(child + 2, child + 1);
    tap_ok(oracle_side_to_split(model, &siblings) == child + 1, "also within a tree");
    model->criterion.max_level = 1;
    struct link mixed = link_of(child, 0);
    forest_split(model->forest, 0);
    struct link deep = link_of(model->forest->patches[0].children, child);
    tap_ok(oracle_side_to_split(model, &mixed) == 0 &&
               oracle_side_to_split(model, &deep) == NODE_NONE,
           "none is split beyond the deepest level");
    model->criterion.max_level = 0;
    tap_ok(oracle_side_to_split(model, &link) == NODE_NONE, "level 0 splits nothing");
    world_free(&world);
}

/* No patch is made that is smaller than the smallest. */
static void test_limits(void)
{
    struct material grey = material_grey(0.5, 1);
    struct world world = make_pair(4.0, grey, grey, NULL);
    struct model *model = &world.model;
    model->link_threshold = 0.0;
    double area = forest_area(model->forest, 1);
    struct link large = link_of(0, 1);
    model->patch_threshold = 0.25 * area;
    tap_ok(oracle_side_to_split(model, &large) == 1,
           "parts as large as the smallest may be made");
    model->patch_threshold = nextafter(0.25 * area, HUGE_VAL);
    tap_ok(oracle_side_to_split(model, &large) == NODE_NONE, "smaller ones not");
    world_free(&world);
}

int main(void)
{
    test_energy();
    test_choice();
    test_limits();
    return tap_done();
}
