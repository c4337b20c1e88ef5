/* Tests of rad/pushpull.h: a leaf gets the light of its ancestors, inner patches are
 * means, the sums of a push-pull, the change of energy, and row sums. */
#include "rad/pushpull.h"

#include <string.h>

#include "tests/scenes.h"
#include "tests/tap.h"

enum { SPLITS = 200, ROOTS = 12, NO_AREA = 5, BLACK = 7 };

/* Random triangles, one without an area. Materials: two that reflect, the first emits,
 * and a black one. */
static struct world make_world(void)
{
    struct soup soup = {0};
    struct random random = random_seed(1);
    soup_add_random(&soup, &random, ROOTS, 0.5, 0.3);
    soup.items[NO_AREA].corner[2] = soup.items[NO_AREA].corner[0];
    paint_with(&soup, (struct material){.reflectance = {{0.5, 0.25, 0.75}},
                                         .emission = {{1.0, 2.0, 0.5}}});
    paint_with(&soup, (struct material){.reflectance = {{0.98, 0.0, 0.1}}});
    paint(&soup, 0, 0);
    struct scene *scene = scene_of_soup(&soup);
    for (int32_t i = 0; i < ROOTS; i++)
        scene->material_of[i] = i == BLACK ? 2 : i % 2;
    return world_make(scene);
}

/* Splits random patches below level 9; roots 0 and 1 stay whole. */
static void grow(struct forest *forest, uint64_t seed)
{
    struct random random = random_seed(seed);
    for (int i = 0; i < SPLITS; i++) {
        int32_t p = 2 + random_below(&random, (int32_t)forest->count - 2);
        if (id_level(forest->patches[p].id) < 9)
            forest_split(forest, p);
    }
}

/* Flux at all levels, less on smaller patches. */
static void pour(struct world *world, uint64_t seed)
{
    struct forest *forest = world->model.forest;
    struct random random = random_seed(seed);
    for (int32_t p = 0; p < forest->count; p++) {
        for (int c = 0; c < BANDS; c++) {
            double watts = 3.0 * random_unit(&random) * forest_area(forest, p);
            forest->patches[p].flux[c] = flux_from_watts(world->model.flux_unit, watts);
        }
    }
}

static const bool ALL[ROOTS] = {true, true, true, true, true, true,
                                true, true, true, true, true, true};

/* push_pull() of the roots with own[root] set. */
static struct push_pull_sums push_pull_own(struct world *world, struct flux_unit unit,
                                           const bool *own)
{
    const struct forest *forest = world->model.forest;
    int32_t *patches = alloc_array((size_t)forest->count, sizeof *patches);
    int64_t count = 0;
    for (int32_t p = 0; p < forest->count; p++)
        if (own[forest->patches[p].id.root])
            patches[count++] = p;
    struct push_pull_sums sums = push_pull(&world->model, unit, patches, count);
    alloc_free(patches);
    return sums;
}

/* The same, of flux in the unit of the model. */
static struct push_pull_sums pushed(struct world *world, const bool *own)
{
    return push_pull_own(world, world->model.flux_unit, own);
}

/* --- push --- */

/* Fluxes for exact sums: those down the line are 1, 1 + 4 x 2, ... */
static void test_line(void)
{
    struct world world = make_world();
    struct forest *forest = world.model.forest;
    struct flux_unit unit = world.model.flux_unit;
    int32_t leaf = forest_reach(forest, id_child(id_child(id_of_root(2), 3), 0));
    int32_t middle = forest->patches[leaf].parent,
            other = forest->patches[middle].children + 1;
    double area = forest_area(forest, 2);
    forest->patches[2].flux[0] = flux_from_watts(unit, area);
    forest->patches[middle].flux[0] = flux_from_watts(unit, 2.0 * area);
    forest->patches[leaf].flux[0] = flux_from_watts(unit, 0.5 * area);
    forest->patches[leaf].flux[2] = flux_from_watts(unit, area);
    struct rgb at_leaf = leaf_irradiance(forest, leaf, unit);
    struct rgb at_other = leaf_irradiance(forest, other, unit);
    /* Fluxes are rounded to 2^-62 of 16 times the light and more. */
    tap_ok(fabs(at_leaf.band[0] - (1.0 + 8.0 + 8.0)) < 1e-12 && at_leaf.band[1] == 0.0 &&
               fabs(at_leaf.band[2] - 16.0) < 1e-12 &&
               fabs(at_other.band[0] - 9.0) < 1e-12 && at_other.band[2] == 0.0,
           "a leaf gets the flux of its own line of ancestors, each over its area");
    world_free(&world);
}

/* --- pull --- */

static double mean_of_leaves(const struct forest *forest, int32_t patch, int band)
{
    if (patch_is_leaf(&forest->patches[patch]))
        return forest->radiosity[patch].band[band];
    double sum = 0.0;
    for (int k = 0; k < 4; k++)
        sum += mean_of_leaves(forest, forest->patches[patch].children + k, band);
    return sum / 4.0;
}

/* Means of four of numbers that are rounded, over 9 levels at most. */
static bool inner_are_means(const struct forest *forest)
{
    for (int32_t p = 0; p < forest->count; p++)
        for (int c = 0; c < BANDS; c++)
            if (fabs(forest->radiosity[p].band[c] -
                     mean_of_leaves(forest, p, c)) > 1e-14)
                return false;
    return true;
}

/* --- push-pull --- */

static void test_radiosity(void)
{
    struct world world = make_world();
    struct forest *forest = world.model.forest;
    grow(forest, 4);
    pour(&world, 4);
    pushed(&world, ALL);
    bool right = true;
    for (int32_t p = 0; p < forest->count; p++) {
        const struct patch *patch = &forest->patches[p];
        if (!patch_is_leaf(patch) || patch->id.root == NO_AREA)
            continue;
        struct rgb h = leaf_irradiance(forest, p, world.model.flux_unit);
        const struct material *material = forest_material(forest, p);
        for (int c = 0; c < BANDS; c++) {
            double reflected = material->reflectance.band[c] * h.band[c];
            right = right && forest->radiosity[p].band[c] ==
                                 material->emission.band[c] + reflected;
        }
    }
    tap_ok(right, "leaves get B = E + rho H");
    tap_ok(inner_are_means(forest), "and inner patches the means");
    struct random random = random_seed(3);
    set_randomly(forest, &random);
    forest_average(forest);
    tap_ok(inner_are_means(forest), "which forest_average() makes, too");
    pushed(&world, ALL);
    tap_ok(pushed(&world, ALL).change == 0, "the same flux again changes nothing");
    world_free(&world);
}

static bool own_of(int32_t root)
{
    return root % 3 != 0;
}

/* Sums in double beside those in integers: half a unit for each of the leaves, nothing
 * beside the rounding of the double sums. */
static void test_sums(void)
{
    struct world world = make_world();
    struct forest *forest = world.model.forest;
    struct flux_unit unit = world.model.flux_unit;
    bool own[ROOTS];
    for (int32_t r = 0; r < ROOTS; r++)
        own[r] = own_of(r);
    grow(forest, 5);
    pour(&world, 5);
    for (int32_t r = 0; r < ROOTS; r++) /* no mean of any leaves */
        if (!own[r])
            forest->radiosity[r].band[0] = 42.0;
    double light = 0.0, absorbed = 0.0, arriving = 0.0, changed = 0.0;
    for (int32_t p = 0; p < forest->count; p++) {
        const struct patch *patch = &forest->patches[p];
        if (!patch_is_leaf(patch) || patch->id.root == NO_AREA || !own[patch->id.root])
            continue;
        struct rgb h = leaf_irradiance(forest, p, unit);
        const struct material *m = forest_material(forest, p);
        for (int c = 0; c < BANDS; c++) {
            double rho = m->reflectance.band[c],
                   b = m->emission.band[c] + rho * h.band[c];
            light += forest_area(forest, p) * b;
            absorbed += forest_area(forest, p) * (1.0 - rho) * h.band[c];
            arriving += forest_area(forest, p) * h.band[c];
            changed += forest_area(forest, p) * fabs(b - forest->radiosity[p].band[c]);
        }
    }
    struct push_pull_sums sums = pushed(&world, own);
    tap_ok(fabs(flux_to_watts(unit, sums.light) / light - 1.0) < 1e-12,
           "light is A B of leaves");
    tap_ok(fabs(flux_to_watts(unit, sums.absorbed) / absorbed - 1.0) < 1e-12,
           "absorbed is A (1 - rho) H of leaves");
    tap_ok(fabs(flux_to_watts(unit, sums.arriving) / arriving - 1.0) < 1e-12,
           "arriving is A H of leaves");
    tap_ok(fabs(flux_to_watts(unit, sums.change) / changed - 1.0) < 1e-12,
           "change is A |B - B before| of leaves");
    bool others = true;
    for (int32_t r = 0; r < ROOTS; r++)
        others = others && (own[r] || forest->radiosity[r].band[0] == 42.0);
    tap_ok(others, "roots of others stay as they are");
    world_free(&world);
}

/* A sum at the limit of the unit is light without end: the vote stops. */
static void test_divergence(void)
{
    struct world world = make_world();
    bool own[ROOTS] = {false};
    forest_split(world.model.forest,
                 2); /* rho 0.5 in band 0: half the limit for itself */
    world.model.forest->patches[2].flux[0] = FLUX_LIMIT; /* an inner patch counts too */
    forest_split(world.model.forest, 4);
    world.model.forest->patches[4].flux[0] = FLUX_LIMIT;
    own[0] = true;
    struct push_pull_sums sums = pushed(&world, own);
    tap_ok(sums.light < FLUX_LIMIT && sums.arriving < FLUX_LIMIT,
           "others' fluxes do not count");
    own[2] = own[4] = true;
    sums = pushed(&world, own);
    tap_ok(sums.light == FLUX_LIMIT && sums.arriving == FLUX_LIMIT,
           "sums of light stay at the limit");
    world_free(&world);
}

/* With another unit of the flux all is the same. */
static void test_units(void)
{
    struct push_pull_sums sums[2];
    for (int k = 0; k < 2; k++) {
        struct world world = make_world();
        grow(world.model.forest, 7);
        pour(&world, 7);
        struct flux_unit unit = world.model.flux_unit;
        for (int64_t p = 0; k && p < world.model.forest->count; p++)
            for (int c = 0; c < BANDS; c++)
                world.model.forest->patches[p].flux[c] *= 2;
        if (k) { /* twice the numbers in a unit half as large */
            unit.watt *= 0.5;
            unit.per_watt *= 2.0;
        }
        sums[k] = push_pull_own(&world, unit, ALL);
        world_free(&world);
    }
    tap_ok(sums[0].arriving > 0 && memcmp(&sums[0], &sums[1], sizeof sums[0]) == 0,
           "the same flux in another unit is the same light, to the bit");
}

/* --- row sums --- */

/* Root 0 gets 1.25 of its area, root 1 half of it, in two of its children 0.4 more; the
 * black one does not count, and root 3 is another's. */
static void test_rows(void)
{
    struct world world = make_world();
    struct forest *forest = world.model.forest;
    struct flux_unit unit = flux_unit_for(2.0 * scene_area(world.scene));
    bool own[ROOTS] = {true, true};
    own[BLACK] = own[NO_AREA] = true;
    forest_split(forest, 1);
    double a = forest_area(forest, 0), b = forest_area(forest, 1);
    int32_t child = forest->patches[1].children;
    forest->patches[0].flux[0] = flux_from_watts(unit, 1.25 * a);
    forest->patches[0].flux[1] =
        flux_from_watts(unit, 7.0 * a); /* another band: no matter */
    forest->patches[1].flux[0] = flux_from_watts(unit, 0.5 * b);
    forest->patches[child].flux[0] = flux_from_watts(unit, 0.4 * b / 4.0);
    forest->patches[child + 3].flux[0] = flux_from_watts(unit, 0.4 * b / 4.0);
    forest->patches[3].flux[0] = flux_from_watts(unit, 9.0);
    forest->patches[BLACK].flux[0] = flux_from_watts(unit, 9.0);
    struct row_sums sums = row_sums_measure(forest, own, unit);
    /* All numbers are of size 1 and rounded a few times. */
    tap_ok(fabs(sums.min - 0.5) < 1e-13 && fabs(sums.max - 1.25) < 1e-13,
           "least and greatest row sum");
    struct flux_unit coarse = {unit.per_watt / ROW_SUMS_ROOM, unit.watt * ROW_SUMS_ROOM};
    tap_ok(fabs(flux_to_watts(coarse, sums.area) - (a + b)) < 1e-13,
           "the area counted is that of own leaves that are not dark");
    tap_ok(fabs(flux_to_watts(coarse, sums.rows) - (1.25 * a + 0.7 * b)) < 1e-13, "rows");
    double squares = 0.0625 * a + 0.5 * b * 0.25 + 0.5 * b * 0.01;
    tap_ok(fabs(flux_to_watts(coarse, sums.squares) - squares) < 1e-13, "squares");
    bool none[ROOTS] = {false};
    sums = row_sums_measure(forest, none, unit);
    tap_ok(sums.min == HUGE_VAL && sums.max == -HUGE_VAL && sums.area == 0 &&
               sums.rows == 0 && sums.squares == 0,
           "no leaf at all");
    /* The unit of a transfer of B = 1 is chosen for a flux as large as the area. */
    double area = forest_area(forest, 2);
    unit = flux_unit_for(area);
    none[2] = true;
    clear_flux(forest);
    forest_split(forest, 2);
    for (int k = 0; k < 4; k++)
        forest->patches[forest->patches[2].children + k].flux[0] =
            flux_from_watts(unit, 0.25 * 1.5 * area);
    forest->patches[2].flux[0] = flux_from_watts(unit, 0.9375 * area);
    sums = row_sums_measure(forest, none, unit);
    tap_ok(fabs((double)sums.rows / (double)sums.area - 2.4375) < 1e-12 &&
               fabs((double)sums.squares / (double)sums.area - 1.4375 * 1.4375) < 1e-12,
           "rows may sum to more than 2 all over a scene");
    world_free(&world);
}

int main(void)
{
    test_line();
    test_radiosity();
    test_sums();
    test_divergence();
    test_units();
    test_rows();
    return tap_done();
}
