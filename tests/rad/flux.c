/* Tests of rad/flux.h: the unit is a power of two that fits its purpose, watts go to
 * integers and back, sums saturate (so in any order), and the limit shows
 * divergence. */
#include "rad/flux.h"

#include <math.h>

#include "tests/scenes.h"
#include "tests/tap.h"

enum { TRIES = 100000 };

static bool is_power_of_two(double x)
{
    int exponent;
    return frexp(x, &exponent) == 0.5;
}

static void test_unit(void)
{
    struct random random = random_seed(1);
    bool powers = true, fits = true, fine = true;
    for (int k = -900; k <= 900; k++) {
        double largest = ldexp(random_between(&random, 0.5, 1.0), k);
        struct flux_unit unit = flux_unit_for(largest);
        powers =
            powers && is_power_of_two(unit.per_watt) && unit.per_watt * unit.watt == 1.0;
        fits = fits && flux_from_watts(unit, largest) < FLUX_LIMIT;
        fine = fine && flux_from_watts(unit, 2.0 * largest) == FLUX_LIMIT;
    }
    tap_ok(powers, "units are powers of two");
    tap_ok(fits, "the largest sum stays below the limit");
    tap_ok(fine, "and twice as much does not, so that no bit is wasted");
    struct flux_unit unit = flux_unit_for(1.0);
    tap_ok(flux_from_watts(unit, 1.0) < FLUX_LIMIT &&
               flux_from_watts(unit, nextafter(2.0, 0.0)) < FLUX_LIMIT &&
               flux_from_watts(unit, 2.0) == FLUX_LIMIT,
           "a power of two fits too");
}

static void test_round_trips(void)
{
    struct random random = random_seed(2);
    bool exact = true, near = true;
    for (int i = 0; i < TRIES; i++) {
        struct flux_unit unit = flux_unit_for(ldexp(1.0,
                                                    random_below(&random, 200) - 100));
        int64_t flux = (int64_t)(random_bits(&random) >> random_below(&random, 53));
        flux &= (INT64_C(1) << 53) - 1; /* the bits that a double holds */
        exact = exact && flux_from_watts(unit, flux_to_watts(unit, flux)) == flux;
        double watts = 0.5 * random_unit(&random) / unit.per_watt * 4611686018427387904.0;
        double error = flux_to_watts(unit, flux_from_watts(unit, watts)) - watts;
        /* Half a unit of rounding to integers, and above 2^53 of them none at all. */
        near = near && fabs(error) <= 0.5 * unit.watt;
    }
    tap_ok(exact, "integers of 53 bits go to watts and back");
    tap_ok(near, "watts come back to within half a unit");
    struct flux_unit unit = {1.0, 1.0};
    tap_ok(flux_from_watts(unit, 0.0) == 0 && flux_from_watts(unit, 2.5) == 2 &&
               flux_from_watts(unit, 3.5) == 4 && flux_from_watts(unit, 0.75) == 1,
           "rounding is to the nearest, halves to even");
}

static void test_limit(void)
{
    struct flux_unit unit = {1.0, 1.0};
    const double limit = 4611686018427387904.0; /* 2^62 */
    tap_ok(FLUX_LIMIT == INT64_C(4611686018427387904), "the limit is 2^62");
    tap_ok(flux_from_watts(unit, nextafter(limit, 0.0)) == FLUX_LIMIT - 512 &&
               flux_from_watts(unit, limit) == FLUX_LIMIT &&
               flux_from_watts(unit, 2.0 * limit) == FLUX_LIMIT &&
               flux_from_watts(unit, HUGE_VAL) == FLUX_LIMIT &&
               flux_from_watts(unit, HUGE_VAL - HUGE_VAL) == FLUX_LIMIT,
           "a flux too large, infinite or not a number is the limit");
}

/* Small numbers, numbers near the limit and the limit itself. */
static int64_t random_flux(struct random *random)
{
    int64_t flux = (int64_t)((random_bits(random) << 8 ^ random_bits(random)) >> 2);
    switch (random_below(random, 4)) {
    case 0: return flux >> random_below(random, 62);
    case 1: return FLUX_LIMIT - (flux >> random_below(random, 62)) / 2;
    case 2: return random_below(random, 3) == 0 ? FLUX_LIMIT : 0;
    default: return flux < FLUX_LIMIT ? flux : FLUX_LIMIT;
    }
}

static void test_sums(void)
{
    struct random random = random_seed(3);
    bool right = true;
    int saturated = 0;
    for (int i = 0; i < TRIES; i++) {
        int64_t a = random_flux(&random), b = random_flux(&random);
        uint64_t plain = (uint64_t)a + (uint64_t)b; /* at most 2^63 */
        bool full = plain >= (uint64_t)FLUX_LIMIT;
        right = right && flux_add(a, b) == (full ? FLUX_LIMIT : (int64_t)plain);
        saturated += full;
    }
    tap_ok(right && saturated > TRIES / 10 && saturated < TRIES - TRIES / 10,
           "sums are exact up to the limit (%d of %d saturate)", saturated, (int)TRIES);
    tap_ok(flux_add(FLUX_LIMIT, FLUX_LIMIT) == FLUX_LIMIT &&
               flux_add(FLUX_LIMIT, 0) == FLUX_LIMIT &&
               flux_add(FLUX_LIMIT - 1, 0) == FLUX_LIMIT - 1 &&
               flux_add(FLUX_LIMIT - 1, 1) == FLUX_LIMIT &&
               flux_add(-FLUX_LIMIT, -FLUX_LIMIT) == -FLUX_LIMIT &&
               flux_add(-FLUX_LIMIT, FLUX_LIMIT) == 0 && flux_add(3, -5) == -2,
           "the limit stays");
}

/* The unit of powers that the model of a scene has. */
static struct flux_unit unit_of(const struct scene *scene)
{
    struct criterion criterion = {.epsilon = 1.0};
    struct forest *forest = forest_create(scene);
    struct flux_unit unit = model_make(scene, NULL, forest, &criterion, PAPER).flux_unit;
    forest_destroy(forest);
    return unit;
}

/* Half a square that emits, and half that reflects, less in one band. */
static struct scene *make_square(double rho, double emission)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 1);
    paint(&soup, 0.0, emission);
    paint_with(&soup, (struct material){.reflectance = {{0.0, rho, 0.1 * rho}}});
    struct scene *scene = scene_of_soup(&soup);
    scene->material_of[1] = 1;
    return prepared(scene);
}

/* The room of a scene's unit: all light of a closed scene of the largest reflectance
 * fits 16 times over, and that 64 times over has diverged. */
static void test_choice(void)
{
    static const double rho[4] = {0.0, 0.5, 0.97, 0.999};
    bool fits = true, power_of_two = true;
    for (int k = 0; k < 4; k++) {
        struct scene *scene = make_square(rho[k], 7.3);
        struct flux_unit unit = unit_of(scene);
        double light = scene_emitted_power(scene) / (1.0 - rho[k]);
        fits = fits && flux_from_watts(unit, 16.0 * light) < FLUX_LIMIT &&
               flux_from_watts(unit, 64.0 * light) == FLUX_LIMIT;
        power_of_two = power_of_two && is_power_of_two(unit.per_watt);
        scene->two_sided = scene->two_sided_lamps = true;
        fits = fits && flux_from_watts(unit_of(scene), 32.0 * light) < FLUX_LIMIT;
        scene_destroy(scene);
    }
    tap_ok(fits, "the unit of a scene has room for its light, 16 times over");
    tap_ok(power_of_two, "and is a power of two");
    struct scene *dark = make_square(0.0, 0.0);
    struct flux_unit unit = unit_of(dark);
    tap_ok(is_power_of_two(unit.per_watt) && flux_from_watts(unit, 0.0) == 0,
           "a scene without light has a unit too");
    scene_destroy(dark);
}

int main(void)
{
    test_unit();
    test_round_trips();
    test_limit();
    test_sums();
    test_choice();
    return tap_done();
}
