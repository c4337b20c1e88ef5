/* Sobol's sequence with Owen's scrambling, and maps of the square.
 *
 * Sobol's points are built bit by bit, all four coordinates at once. Owen's scrambling
 * permutes the halves of the unit interval, the halves of each half and so on, each time
 * by a coin that depends on all bits before; a multiplication carries upwards only, so on
 * reversed bits it is such a permutation (Laine and Karras, "Stratified sampling for
 * stochastic transparency", 2011). The same permutation of the indices makes sequences of
 * different seeds independent.
 *
 * Squares go to triangles by (1 - sqrt u, v), and to the disk by concentric squares
 * (Shirley and Chiu, 1997), which keep near points near; a point of the disk is the foot
 * of a direction distributed as its cosine (Malley). */
#include "rad/beyond/sequence.h"

#include <math.h>

#include "geom/hash.h"

/* Of two numbers side by side, which change places. */
static inline uint64_t reverse_bits(uint64_t x)
{
    x = (x >> 1 & UINT64_C(0x5555555555555555)) | (x & UINT64_C(0x5555555555555555)) << 1;
    x = (x >> 2 & UINT64_C(0x3333333333333333)) | (x & UINT64_C(0x3333333333333333)) << 2;
    x = (x >> 4 & UINT64_C(0x0f0f0f0f0f0f0f0f)) | (x & UINT64_C(0x0f0f0f0f0f0f0f0f)) << 4;
    x = (x >> 8 & UINT64_C(0x00ff00ff00ff00ff)) | (x & UINT64_C(0x00ff00ff00ff00ff)) << 8;
    x = (x >> 16 & UINT64_C(0xffff0000ffff)) | (x & UINT64_C(0xffff0000ffff)) << 16;
    return x >> 32 | x << 32;
}

/* Permutes by multiplications, which carry upwards. */
static uint32_t permute(const struct sequence *sequence, int k, uint32_t x)
{
    x ^= x * 0x3d20adeau;
    x += sequence->scramble[k];
    x *= sequence->odd[k];
    x ^= x * 0x05526c56u;
    return x ^ x * 0x53a22864u;
}

struct sequence sequence_start(uint64_t seed)
{
    struct sequence sequence;
    for (int k = 0; k < 1 + SEQUENCE_DIMENSIONS; k++) {
        sequence.scramble[k] = (uint32_t)hash_mix(seed + (uint64_t)k);
        sequence.odd[k] = sequence.scramble[k] >> 16 | 1u;
    }
    return sequence;
}

/* The sums without carry of some of a, b, c and d, by the bits of their number. */
#define SUMS_OF_TWO(x, a, b) x, (x) ^ (a), (x) ^ (b), (x) ^ (a) ^ (b)
#define SUMS(a, b, c, d) {SUMS_OF_TWO(0, a, b), SUMS_OF_TWO(c, a, b), \
                          SUMS_OF_TWO(d, a, b), SUMS_OF_TWO((c) ^ (d), a, b)}

/* Four bits of the index at a time, the last bit first, change these bits of the
 * coordinates: Sobol's direction numbers of the first four dimensions, the upper 16 bits
 * of each, reversed; the first dimension in the lowest bits. */
static const uint64_t SOBOL[4][16] = {
    SUMS(UINT64_C(0xa0c3aa09ffff8000), UINT64_C(0x4041770655554000),
         UINT64_C(0x302d390333332000), UINT64_C(0x101e160111111000)),
    SUMS(UINT64_C(0x0b6709aa0f0f0800), UINT64_C(0x079a067705050400),
         UINT64_C(0x02a4033903030200), UINT64_C(0x011b011601010100)),
    SUMS(UINT64_C(0x00c900a300ff0080), UINT64_C(0x0045007100550040),
         UINT64_C(0x002e003a00330020), UINT64_C(0x001f001700110010)),
    SUMS(UINT64_C(0x000a0009000f0008), UINT64_C(0x0004000600050004),
         UINT64_C(0x0003000300030002), UINT64_C(0x0001000100010001))};

void sequence_point(const struct sequence *sequence, uint32_t index,
                    double u[SEQUENCE_DIMENSIONS])
{
    uint32_t turned = (uint32_t)(reverse_bits(index) >> 32); /* bits of the index */
    uint32_t place = permute(sequence, 0, turned);
    uint64_t sobol = SOBOL[0][place >> 16 & 15] ^ SOBOL[1][place >> 20 & 15] ^
                     SOBOL[2][place >> 24 & 15] ^ SOBOL[3][place >> 28];
    for (int d = 0; d < SEQUENCE_DIMENSIONS; d += 2, sobol >>= 32) {
        uint64_t first = permute(sequence, 1 + d, (uint32_t)sobol & 0xffffu);
        uint64_t second = permute(sequence, 2 + d, (uint32_t)sobol >> 16);
        uint64_t both = reverse_bits(first << 32 | second);
        u[d] = 0x1p-32 * (double)(uint32_t)both;
        u[d + 1] = 0x1p-32 * (double)(uint32_t)(both >> 32);
    }
}

/* --- from the square --- */

/* Sine and cosine of an angle of at most pi / 4, within 2e-9 (the next term of the
 * series). */
static void turn(double angle, double *sine, double *cosine)
{
    double a2 = angle * angle;
    *sine = angle * (1.0 - a2 / 6.0 * (1.0 - a2 / 20.0 * (1.0 - a2 / 42.0 *
                                                          (1.0 - a2 / 72.0))));
    *cosine = sqrt(1.0 - *sine * *sine);
}

struct vec3 cosine_direction(struct vec3 normal, struct vec3 along, double u, double v)
{
    static const double QUARTER = 0.78539816339744830962; /* pi / 4 */
    double a = 2.0 * u - 1.0, b = 2.0 * v - 1.0, x = 0.0, y = 0.0, sine, cosine;
    if (a * a > b * b) {
        turn(QUARTER * (b / a), &sine, &cosine);
        x = a * cosine;
        y = a * sine;
    } else if (b != 0.0) {
        turn(QUARTER * (a / b), &sine, &cosine);
        x = b * sine;
        y = b * cosine;
    }
    double up = sqrt(real_max(0.0, 1.0 - x * x - y * y));
    struct vec3 across = vec3_cross(normal, along);
    return vec3_add(vec3_scale(normal, up),
                    vec3_add(vec3_scale(along, x), vec3_scale(across, y)));
}

struct vec3 direction_along(struct vec3 normal)
{
    struct vec3 axis = {0.0, 0.0, 0.0};
    if (fabs(normal.x) < 0.6)
        axis.x = 1.0;
    else
        axis.y = 1.0;
    struct vec3 along = vec3_cross(normal, axis);
    return vec3_unit(along);
}
