/* Eight floats at once.
 *
 * The operations are defined by the plain C99 loops at the end. Where the compiler has
 * vector types (gcc, clang and their kin) vectors say the same, for processors with eight
 * floats in a register (AVX2) and for all others with twice four. Every lane is rounded
 * as in the loops, so all three give the same bits. The first uses macros where a
 * function would take or return a vector, since that has another calling convention with
 * every set of processor flags.
 *
 * PHR_PLAIN_LANES chooses the loops, for compilers without vectors and for the tests. */
#ifndef OCTREE_LANES_H
#define OCTREE_LANES_H

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { LANES = 8 };

#if defined(__has_builtin)
#if __has_builtin(__builtin_shufflevector)
#define HAVE_SHUFFLE 1
#endif
#endif

#if defined(__GNUC__) && !defined(PHR_PLAIN_LANES) && defined(__AVX2__) && \
    defined(HAVE_SHUFFLE)

typedef float lanes __attribute__((vector_size(32)));
typedef int32_t lanes_mask __attribute__((vector_size(32))); /* -1: true, 0: false */

#define lanes_all(x) ((lanes){(x), (x), (x), (x), (x), (x), (x), (x)})
#define lanes_add(a, b) ((a) + (b))
#define lanes_sub(a, b) ((a) - (b))
#define lanes_mul(a, b) ((a) * (b))
#define lanes_abs(a) ((lanes)((lanes_mask)(a) & INT32_C(0x7fffffff)))
#define lanes_above(a, b) ((lanes_mask)((a) > (b)))
#define lanes_upto(a, b) ((lanes_mask)((a) <= (b)))
/* The greater of a and b; b where one is not a number. A loop over the lanes becomes this
 * one instruction at -O2, but 48 at -O3, and masks wait where AVX-512 keeps masks apart
 * (gcc 12). */
#define lanes_max(a, b) __builtin_ia32_maxps256((a), (b))
#define lanes_min(a, b) __builtin_ia32_minps256((a), (b))
#define mask_and(a, b) ((a) & (b))
#define mask_or(a, b) ((a) | (b))
#define mask_all(x) ((lanes_mask){(x), (x), (x), (x), (x), (x), (x), (x)})
/* a where the mask is true, else b */
#define mask_choose(mask, a, b) (((mask) & (a)) | (~(mask) & (b)))
/* a where the mask is false, else 0 */
#define lanes_unless(mask, a) ((lanes)(~(mask) & (lanes_mask)(a)))

/* Eight floats at any address, read as one vector (reading by parts would wait for the
 * store). */
typedef float lanes_in_memory __attribute__((vector_size(32), aligned(4), may_alias));
#define lanes_at(p) ((lanes)*(const lanes_in_memory *)(p))

/* (a0 a0 a0 a0 a1 a1 a1 a1), (a2 a2 a2 a2 a3 a3 a3 a3) and (a4 a5 a6 a7 a4 a5 a6 a7) */
#define lanes_spread_01(a) __builtin_shufflevector((a), (a), 0, 0, 0, 0, 1, 1, 1, 1)
#define lanes_spread_23(a) __builtin_shufflevector((a), (a), 2, 2, 2, 2, 3, 3, 3, 3)
#define lanes_twice_high(a) __builtin_shufflevector((a), (a), 4, 5, 6, 7, 4, 5, 6, 7)

typedef int32_t four_mask __attribute__((vector_size(16)));

#define MASK_LOW(mask) __builtin_shufflevector((mask), (mask), 0, 1, 2, 3)
#define MASK_HIGH(mask) __builtin_shufflevector((mask), (mask), 4, 5, 6, 7)

/* The bits of those lanes of `bit` in which the mask is true. */
static inline unsigned mask_select(const lanes_mask *mask, const lanes_mask *bit)
{
    lanes_mask selected = *mask & *bit;
    four_mask half = MASK_LOW(selected) | MASK_HIGH(selected);
    uint64_t word[2];
    memcpy(word, &half, sizeof word);
    uint64_t all = word[0] | word[1];
    return (unsigned)(all | all >> 32);
}

/* True if all lanes are. */
static inline int mask_is_full(const lanes_mask *mask)
{
    four_mask half = MASK_LOW(*mask) & MASK_HIGH(*mask);
    uint64_t word[2];
    memcpy(word, &half, sizeof word);
    return (word[0] & word[1]) == UINT64_MAX;
}

#elif defined(__GNUC__) && !defined(PHR_PLAIN_LANES)

/* Twice four. */
typedef float four __attribute__((vector_size(16)));
typedef int32_t four_mask __attribute__((vector_size(16)));

typedef struct {
    four low, high;
} lanes;

typedef struct {
    four_mask low, high;
} lanes_mask;

#define FOUR_INLINE static inline __attribute__((always_inline))

FOUR_INLINE lanes lanes_all(float x)
{
    four v = {x, x, x, x};
    return (lanes){v, v};
}

FOUR_INLINE lanes lanes_add(lanes a, lanes b)
{
    return (lanes){a.low + b.low, a.high + b.high};
}

FOUR_INLINE lanes lanes_sub(lanes a, lanes b)
{
    return (lanes){a.low - b.low, a.high - b.high};
}

FOUR_INLINE lanes lanes_mul(lanes a, lanes b)
{
    return (lanes){a.low * b.low, a.high * b.high};
}

FOUR_INLINE lanes lanes_abs(lanes a)
{
    const int32_t rest = INT32_C(0x7fffffff);
    return (lanes){(four)((four_mask)a.low & rest), (four)((four_mask)a.high & rest)};
}

FOUR_INLINE lanes_mask lanes_above(lanes a, lanes b)
{
    return (lanes_mask){(four_mask)(a.low > b.low), (four_mask)(a.high > b.high)};
}

FOUR_INLINE lanes_mask lanes_upto(lanes a, lanes b)
{
    return (lanes_mask){(four_mask)(a.low <= b.low), (four_mask)(a.high <= b.high)};
}

/* The one instruction for this, where it has a name; compilers find it for neither. */
#ifdef __SSE__
#define four_max(a, b) __builtin_ia32_maxps((a), (b))
#define four_min(a, b) __builtin_ia32_minps((a), (b))
#else
FOUR_INLINE four four_max(four a, four b)
{
    four_mask above = a > b;
    return (four)((above & (four_mask)a) | (~above & (four_mask)b));
}

FOUR_INLINE four four_min(four a, four b)
{
    four_mask below = a < b;
    return (four)((below & (four_mask)a) | (~below & (four_mask)b));
}
#endif

FOUR_INLINE lanes lanes_max(lanes a, lanes b)
{
    return (lanes){four_max(a.low, b.low), four_max(a.high, b.high)};
}

FOUR_INLINE lanes lanes_min(lanes a, lanes b)
{
    return (lanes){four_min(a.low, b.low), four_min(a.high, b.high)};
}

FOUR_INLINE lanes_mask mask_and(lanes_mask a, lanes_mask b)
{
    return (lanes_mask){a.low & b.low, a.high & b.high};
}

FOUR_INLINE lanes_mask mask_or(lanes_mask a, lanes_mask b)
{
    return (lanes_mask){a.low | b.low, a.high | b.high};
}

FOUR_INLINE lanes_mask mask_all(int32_t x)
{
    four_mask v = {x, x, x, x};
    return (lanes_mask){v, v};
}

FOUR_INLINE lanes_mask mask_choose(lanes_mask mask, lanes_mask a, lanes_mask b)
{
    return (lanes_mask){(mask.low & a.low) | (~mask.low & b.low),
                        (mask.high & a.high) | (~mask.high & b.high)};
}

FOUR_INLINE lanes lanes_unless(lanes_mask mask, lanes a)
{
    return (lanes){(four)(~mask.low & (four_mask)a.low),
                   (four)(~mask.high & (four_mask)a.high)};
}

typedef float four_in_memory __attribute__((vector_size(16), aligned(4), may_alias));

FOUR_INLINE lanes lanes_at(const float *p)
{
    return (lanes){*(const four_in_memory *)p, *(const four_in_memory *)(p + 4)};
}

FOUR_INLINE four four_all(float x)
{
    return (four){x, x, x, x};
}

FOUR_INLINE lanes lanes_spread_01(lanes a)
{
    return (lanes){four_all(a.low[0]), four_all(a.low[1])};
}

FOUR_INLINE lanes lanes_spread_23(lanes a)
{
    return (lanes){four_all(a.low[2]), four_all(a.low[3])};
}

FOUR_INLINE lanes lanes_twice_high(lanes a)
{
    return (lanes){a.high, a.high};
}

FOUR_INLINE unsigned mask_select(const lanes_mask *mask, const lanes_mask *bit)
{
    four_mask selected = (mask->low & bit->low) | (mask->high & bit->high);
    uint64_t word[2];
    memcpy(word, &selected, sizeof word);
    uint64_t all = word[0] | word[1];
    return (unsigned)(all | all >> 32);
}

FOUR_INLINE int mask_is_full(const lanes_mask *mask)
{
    four_mask both = mask->low & mask->high;
    uint64_t word[2];
    memcpy(word, &both, sizeof word);
    return (word[0] & word[1]) == UINT64_MAX;
}

#else

typedef struct {
    float lane[LANES];
} lanes;

typedef struct {
    int32_t lane[LANES];
} lanes_mask;

static inline lanes lanes_all(float x)
{
    lanes r;
    for (int k = 0; k < LANES; k++)
        r.lane[k] = x;
    return r;
}

static inline lanes lanes_add(lanes a, lanes b)
{
    for (int k = 0; k < LANES; k++)
        a.lane[k] = a.lane[k] + b.lane[k];
    return a;
}

static inline lanes lanes_sub(lanes a, lanes b)
{
    for (int k = 0; k < LANES; k++)
        a.lane[k] = a.lane[k] - b.lane[k];
    return a;
}

static inline lanes lanes_mul(lanes a, lanes b)
{
    for (int k = 0; k < LANES; k++)
        a.lane[k] = a.lane[k] * b.lane[k];
    return a;
}

static inline lanes lanes_abs(lanes a)
{
    for (int k = 0; k < LANES; k++)
        a.lane[k] = fabsf(a.lane[k]);
    return a;
}

static inline lanes_mask lanes_above(lanes a, lanes b)
{
    lanes_mask r;
    for (int k = 0; k < LANES; k++)
        r.lane[k] = a.lane[k] > b.lane[k] ? -1 : 0;
    return r;
}

static inline lanes_mask lanes_upto(lanes a, lanes b)
{
    lanes_mask r;
    for (int k = 0; k < LANES; k++)
        r.lane[k] = a.lane[k] <= b.lane[k] ? -1 : 0;
    return r;
}

static inline lanes lanes_max(lanes a, lanes b)
{
    for (int k = 0; k < LANES; k++)
        a.lane[k] = a.lane[k] > b.lane[k] ? a.lane[k] : b.lane[k];
    return a;
}

static inline lanes lanes_min(lanes a, lanes b)
{
    for (int k = 0; k < LANES; k++)
        a.lane[k] = a.lane[k] < b.lane[k] ? a.lane[k] : b.lane[k];
    return a;
}

static inline lanes_mask mask_and(lanes_mask a, lanes_mask b)
{
    for (int k = 0; k < LANES; k++)
        a.lane[k] &= b.lane[k];
    return a;
}

static inline lanes_mask mask_or(lanes_mask a, lanes_mask b)
{
    for (int k = 0; k < LANES; k++)
        a.lane[k] |= b.lane[k];
    return a;
}

static inline lanes_mask mask_all(int32_t x)
{
    lanes_mask r;
    for (int k = 0; k < LANES; k++)
        r.lane[k] = x;
    return r;
}

static inline lanes_mask mask_choose(lanes_mask mask, lanes_mask a, lanes_mask b)
{
    for (int k = 0; k < LANES; k++)
        a.lane[k] = mask.lane[k] ? a.lane[k] : b.lane[k];
    return a;
}

static inline lanes lanes_unless(lanes_mask mask, lanes a)
{
    for (int k = 0; k < LANES; k++)
        a.lane[k] = mask.lane[k] ? 0.0f : a.lane[k];
    return a;
}

static inline lanes lanes_at(const float *p)
{
    lanes r;
    for (int k = 0; k < LANES; k++)
        r.lane[k] = p[k];
    return r;
}

static inline lanes lanes_spread_01(lanes a)
{
    lanes r;
    for (int k = 0; k < LANES; k++)
        r.lane[k] = a.lane[k / 4];
    return r;
}

static inline lanes lanes_spread_23(lanes a)
{
    lanes r;
    for (int k = 0; k < LANES; k++)
        r.lane[k] = a.lane[2 + k / 4];
    return r;
}

static inline lanes lanes_twice_high(lanes a)
{
    lanes r;
    for (int k = 0; k < LANES; k++)
        r.lane[k] = a.lane[4 + k % 4];
    return r;
}

static inline unsigned mask_select(const lanes_mask *mask, const lanes_mask *bit)
{
    unsigned bits = 0;
    for (int k = 0; k < LANES; k++)
        bits |= (unsigned)(mask->lane[k] & bit->lane[k]);
    return bits;
}

static inline int mask_is_full(const lanes_mask *mask)
{
    int32_t all = -1;
    for (int k = 0; k < LANES; k++)
        all &= mask->lane[k];
    return all == -1;
}

#endif

/* Lane k becomes 1 << (k ^ flip), for mask_select(); flip < LANES. */
static inline void mask_set_weights(lanes_mask *weights, int flip)
{
    static const int32_t weight[LANES][LANES] = {
        {1, 2, 4, 8, 16, 32, 64, 128}, {2, 1, 8, 4, 32, 16, 128, 64},
        {4, 8, 1, 2, 64, 128, 16, 32}, {8, 4, 2, 1, 128, 64, 32, 16},
        {16, 32, 64, 128, 1, 2, 4, 8}, {32, 16, 128, 64, 2, 1, 8, 4},
        {64, 128, 16, 32, 4, 8, 1, 2}, {128, 64, 32, 16, 8, 4, 2, 1}};
    memcpy(weights, weight[flip], sizeof *weights);
}

/* Number of bits set in the lowest 16. */
static inline int bit_count(unsigned bits)
{
    bits = (bits & 0x5555u) + (bits >> 1 & 0x5555u);
    bits = (bits & 0x3333u) + (bits >> 2 & 0x3333u);
    bits = (bits & 0x0f0fu) + (bits >> 4 & 0x0f0fu);
    return (int)((bits & 0xffu) + (bits >> 8));
}

/* Number of the lowest bit set. Pre: there is one. */
static inline int lowest_bit(unsigned bits)
{
#ifdef __GNUC__
    return __builtin_ctz(bits);
#else
    int k = 0;
    while (!(bits >> k & 1u))
        k++;
    return k;
#endif
}

#endif
