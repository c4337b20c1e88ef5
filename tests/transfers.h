/* Links over which light is transferred, for tests of both kinds of links. */
#ifndef TESTS_TRANSFERS_H
#define TESTS_TRANSFERS_H

#include "tests/pairs.h"
#include "tests/tap.h"

enum { LINKS = 5000, ROOTS = 20 };

static inline struct world make_many(void)
{
    struct soup soup = {0};
    struct random random = random_seed(1);
    soup_add_random(&soup, &random, ROOTS, 0.5, 0.2);
    paint(&soup, 0.5, 1);
    struct world world = world_make(scene_of_soup(&soup));
    for (int32_t r = 0; r < ROOTS; r += 2)
        forest_split(world.model.forest, r);
    set_randomly(world.model.forest, &random);
    return world;
}

/* A link between two of the patches, of which all is seen. */
static inline struct link random_link(struct random *random, const struct forest *forest)
{
    int32_t p = random_below(random, (int32_t)forest->count), q = p;
    while (q == p)
        q = random_below(random, (int32_t)forest->count);
    return (struct link){.p = p, .q = q, .area = float_below(1e-6 * random_unit(random)),
                         .seen = LINK_ALL_SEEN};
}

/* FNV-like mix of all fluxes: equal sums, bit by bit. */
static inline uint64_t flux_hash(const struct forest *forest)
{
    uint64_t hash = 1;
    for (int64_t p = 0; p < forest->count; p++)
        for (int c = 0; c < BANDS; c++)
            hash =
                (hash ^ (uint64_t)forest->patches[p].flux[c]) * UINT64_C(1099511628211);
    return hash;
}

/* `sent`, W: over LINKS links that round `numbers` times each. */
static inline void check_received(const struct forest *forest, struct flux_unit unit,
                                  int numbers, double sent)
{
    int64_t received = 0;
    for (int64_t p = 0; p < forest->count; p++)
        for (int c = 0; c < BANDS; c++)
            received += forest->patches[p].flux[c];
    /* Half a unit for each number, and a sum of 5,000 in double. */
    double slack = 0.5 * numbers * LINKS * unit.watt + 1e-12 * sent;
    tap_ok(received > 0 && fabs(flux_to_watts(unit, received) - sent) <= slack,
           "what is received is what is sent");
}

static const struct link PLAIN = {.p = 3, .q = 7, .area = 0.25f, .parts_p = {64, 64, 64},
                                  .parts_q = {64, 64,
                                              64}, .seen = LINK_ALL_SEEN, .cost = 1};

#endif
