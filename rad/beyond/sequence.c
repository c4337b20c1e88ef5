/* Sobol's sequence with Owen's scrambling, and maps of the square.
 *
 * Sobol's points are built bit by bit, all four coordinates at once. Owen's scrambling
 * permutes the halves of the unit interval, the halves of each half and so on, each time
 * by a coin that depends on all bits before; a multiplication carries upwards only, so on
 * reversed bits it does that (Laine and Karras, "Stratified sampling for stochastic
 * transparency", 2011). The same permutation of the indices makes sequences of different
 * seeds independent.
 *
 * Squares go to triangles by (1 - sqrt u, v), and to the disk by concentric squares
 * (Shirley and Chiu, 1997), which keep near points near; a point of the disk is the foot
 * of a direction that is distributed as its cosine (Malley). */
#include "rad/beyond/sequence.h"

#include <math.h>

#include "geom/hash.h"

static uint32_t reverse_bits(uint32_t x)
{
    x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
    x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
    x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
    x = (x >> 8 & 0x00ff00ffu) | (x & 0x00ff00ffu) << 8;
    return x >> 16 | x << 16;
}

/* Permutes by multiplications that carry upwards. */
static uint32_t permute(uint32_t x, uint32_t seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= seed >> 16 | 1u;
    x ^= x * 0x05526c56u;
    return x ^ x * 0x53a22864u;
}

struct sequence sequence_start(uint64_t seed)
{
    struct sequence sequence;
    for (int k = 0; k < 1 + SEQUENCE_DIMENSIONS; k++)
        sequence.scramble[k] = (uint32_t)hash_mix(seed + (uint64_t)k);
    return sequence;
}

/* Bit b of the index changes these bits of the coordinates: Sobol's direction numbers of
 * the first four dimensions, the upper 16 bits of each, reversed; the first dimension in
 * the lowest bits. */
static const uint64_t SOBOL[16] = {
    UINT64_C(0x0001000100010001), UINT64_C(0x0003000300030002),
    UINT64_C(0x0004000600050004), UINT64_C(0x000a0009000f0008),
    UINT64_C(0x001f001700110010), UINT64_C(0x002e003a00330020),
    UINT64_C(0x0045007100550040), UINT64_C(0x00c900a300ff0080),
    UINT64_C(0x011b011601010100), UINT64_C(0x02a4033903030200),
    UINT64_C(0x079a067705050400), UINT64_C(0x0b6709aa0f0f0800),
    UINT64_C(0x101e160111111000), UINT64_C(0x302d390333332000),
    UINT64_C(0x4041770655554000), UINT64_C(0xa0c3aa09ffff8000)};

void sequence_point(const struct sequence *sequence, uint32_t index,
                    double u[SEQUENCE_DIMENSIONS])
{
    uint32_t place = reverse_bits(permute(reverse_bits(index), sequence->scramble[0]));
    uint64_t bits = 0;
    for (int b = 0; b < 16; b++)
        bits ^= SOBOL[b] & (UINT64_C(0) - (place >> b & 1u));
    for (int d = 0; d < SEQUENCE_DIMENSIONS; d++) {
        uint32_t reversed = (uint32_t)(bits >> 16 * d) & 0xffffu;
        u[d] = 0x1p-32 *
               (double)reverse_bits(permute(reversed, sequence->scramble[1 + d]));
    }
}

/* --- from the square --- */

struct vec3 triangle_of_square(const struct triangle *t, double u, double v)
{
    double root = sqrt(u), c = root * v, b = root - c;
    return vec3_add(vec3_scale(t->corner[0], 1.0 - root),
                    vec3_add(vec3_scale(t->corner[1], b), vec3_scale(t->corner[2], c)));
}

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
