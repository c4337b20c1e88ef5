/* Arctangent, logarithm and exponential, with the same bits on every machine.
 *
 * C leaves the last bit of atan2(), log() and exp() to the library, and libraries differ.
 * These use + - * / and exact scaling only, so their results are as reproducible as those
 * of geom/vec.h. They are right within 4.5e-16 of the result, relative: two units in the
 * last place. */
#ifndef GEOM_ELEMENTARY_H
#define GEOM_ELEMENTARY_H

/* Angle from the first axis to the point (x, y), in radians, -pi to pi, as atan2(y, x).
 * 0 for the origin. Pre: both are finite. */
double arctangent(double y, double x);

/* Natural logarithm. Pre: x is finite and above 0 (subnormal numbers included). */
double logarithm(double x);

/* e to the power x. Pre: -700 <= x <= 700. */
double exponential(double x);

#endif
