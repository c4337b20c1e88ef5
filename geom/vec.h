/* Vectors of three doubles, colours of three bands, and pi.
 *
 * Only + - * / and sqrt: all of them are exactly rounded by IEEE 754, so every machine
 * computes the same bits (the build forbids fused multiply-add with
 * -ffp-contract=off). */
#ifndef GEOM_VEC_H
#define GEOM_VEC_H

#include <float.h>
#include <math.h>
#include <stdbool.h>

#if FLT_EVAL_METHOD == 2 || FLT_EVAL_METHOD < 0
#error "x87 rounds to other numbers than all other processors: add -msse2 -mfpmath=sse"
#endif

static const double PI = 3.14159265358979323846;

struct vec3 {
    double x, y, z;
};

/* Three bands: red, green, blue. */
struct rgb {
    double band[3];
};

enum { BANDS = 3 };

static inline struct vec3 vec3_add(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline struct vec3 vec3_sub(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline struct vec3 vec3_scale(struct vec3 a, double s)
{
    return (struct vec3){a.x * s, a.y * s, a.z * s};
}

static inline struct vec3 vec3_middle(struct vec3 a, struct vec3 b)
{
    return vec3_scale(vec3_add(a, b), 0.5);
}

static inline double vec3_dot(struct vec3 a, struct vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct vec3 vec3_cross(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z,
                         a.x * b.y - a.y * b.x};
}

static inline double vec3_length(struct vec3 a)
{
    return sqrt(vec3_dot(a, a));
}

/* Pre: a is not 0. */
static inline struct vec3 vec3_unit(struct vec3 a)
{
    return vec3_scale(a, 1.0 / vec3_length(a));
}

/* Component 0, 1 or 2. */
static inline double vec3_axis(struct vec3 a, int axis)
{
    return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}

static inline bool vec3_is_equal(struct vec3 a, struct vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* As fmin() and fmax() for numbers that are not NaN; compilers make each one
 * instruction. */
static inline double real_min(double a, double b)
{
    return a < b ? a : b;
}

static inline double real_max(double a, double b)
{
    return a > b ? a : b;
}

/* Axis by axis: the lower and the upper corner of the box around two points. */
static inline struct vec3 vec3_least(struct vec3 a, struct vec3 b)
{
    return (struct vec3){real_min(a.x, b.x), real_min(a.y, b.y), real_min(a.z, b.z)};
}

static inline struct vec3 vec3_most(struct vec3 a, struct vec3 b)
{
    return (struct vec3){real_max(a.x, b.x), real_max(a.y, b.y), real_max(a.z, b.z)};
}

/* Band by band: a - b, and sum += weight * colour. */
static inline struct rgb rgb_sub(struct rgb a, struct rgb b)
{
    for (int c = 0; c < BANDS; c++)
        a.band[c] -= b.band[c];
    return a;
}

static inline void rgb_add(struct rgb *sum, double weight, struct rgb colour)
{
    for (int c = 0; c < BANDS; c++)
        sum->band[c] += weight * colour.band[c];
}

/* Band by band: a b, and factor a. */
static inline struct rgb rgb_times(struct rgb a, struct rgb b)
{
    for (int c = 0; c < BANDS; c++)
        a.band[c] *= b.band[c];
    return a;
}

static inline struct rgb rgb_scale(struct rgb a, double factor)
{
    for (int c = 0; c < BANDS; c++)
        a.band[c] *= factor;
    return a;
}

/* The same in all bands. */
static inline struct rgb rgb_grey(double value)
{
    return (struct rgb){{value, value, value}};
}

static inline double rgb_sum(struct rgb c)
{
    return c.band[0] + c.band[1] + c.band[2];
}

static inline double rgb_mean(struct rgb c)
{
    return rgb_sum(c) / BANDS;
}

/* The largest band. */
static inline double rgb_most(struct rgb c)
{
    return real_max(c.band[0], real_max(c.band[1], c.band[2]));
}

/* Sum over bands of the products. */
static inline double rgb_dot(struct rgb a, struct rgb b)
{
    return a.band[0] * b.band[0] + a.band[1] * b.band[1] + a.band[2] * b.band[2];
}

#endif
