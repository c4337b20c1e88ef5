/* Random numbers: xorshift64*, seeded by the test, the same on every machine. */
#ifndef TESTS_RANDOM_H
#define TESTS_RANDOM_H

#include <stdint.h>

struct random {
    uint64_t state; /* never 0 */
};

static inline struct random random_seed(uint64_t seed)
{
    return (struct random){seed * UINT64_C(0x9E3779B97F4A7C15) | 1u};
}

static inline uint64_t random_bits(struct random *random)
{
    random->state ^= random->state >> 12;
    random->state ^= random->state << 25;
    random->state ^= random->state >> 27;
    return (random->state * UINT64_C(2685821657736338717)) >> 8;
}

/* In [0, 1). */
static inline double random_unit(struct random *random)
{
    return (double)(random_bits(random) >> 3) / 9007199254740992.0;
}

#endif
