/* The difference of two pictures, or of two solutions. */
#ifndef TOOLS_COMPARE_H
#define TOOLS_COMPARE_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/error.h"
#include "io/picture/image.h"
#include "io/picture/solution.h"

/* Sums over all bands of all pixels or blocks of pixels, or of all leaves weighted by
 * area. Samples not finite on either side are counted and left out of the sums. */
struct difference {
    int64_t samples;         /* all of them */
    int64_t broken;          /* not finite on one side or both */
    double weight;           /* sum over the finite samples */
    double largest;          /* largest |a - b|, in units of the samples */
    double sum, squares;     /* sums of |a - b| and (a - b)^2, weighted */
    double expected_squares; /* sum of b^2, weighted */
    double peak;             /* largest |b| */
};

double difference_mean(const struct difference *difference);
double difference_rms(const struct difference *difference);

/* Returns x over the root mean square of b: 0 if x is 0, infinite if only b is 0. */
double difference_relative(const struct difference *difference, double x);

/* Returns 20 log10(peak / RMS), dB; infinite if there is no difference. */
double difference_psnr(const struct difference *difference, double peak);

/* Compares picture a with b, the expected one, of the same size: the means over blocks of
 * `side` by `side` pixels, cut at the right and lower edges. Blocks with a sample of b
 * above `most` are left out. `map`, of the same size, receives |a - b| of each block in
 * all its pixels; the largest float if the difference is not finite, 0 if the block is
 * left out. */
struct difference compare_images(const struct image *a, const struct image *b, int side,
                                 double most, struct image *map);

/* How far blocks of pixels are off, in standard errors. */
struct deviations {
    int64_t blocks; /* all of them */
    int64_t unlike; /* with a band whose mean is off by more than `limit` */
    int64_t beyond; /* these, and others that are moved by more */
    double worst;   /* the largest of a band; below 0 where a is darker */
    bool moved;     /* the worst is moved, and no mean */
    int x, y;       /* first pixel of the worst block */
};

/* Compares blocks of `side` by `side` pixels, the last of a row or column with the pixels
 * left over: the means of a and b, and whether a is moved to a side. `error`: one
 * standard error of each pixel of b: that of a block is at most their mean. Noise, of a
 * in the main, is known by how the differences scatter in a block. Blocks with a sample
 * of b above `most` are left out. `map`, of the same size, receives in all bands the
 * deviation of the block's worst mean; or NULL. A sample that is not finite is beyond all
 * limits. */
struct deviations compare_errors(const struct image *a, const struct image *b,
                                 const struct image *error, int side, double most,
                                 double limit, struct image *map);

/* Compares solution a with b, the expected one, by area and band. Where one is divided
 * more finely, the leaf of the other is compared with each of the leaves in it. `map`,
 * [a->count], receives the mean of |a - b| over each leaf of a.
 * Errors: their roots differ (EXIT_USAGE). */
bool compare_solutions(const struct solution_mesh *a, const struct solution_mesh *b,
                       struct difference *difference, struct rgb *map,
                       struct error *error);

/* Writes the leaves of a solution with the values of `map` in place of their radiosities,
 * as a mesh of the same format, flat; the value `white` becomes full white in its
 * colours.
 * Errors: as output_close(). */
bool solution_write(const struct solution_mesh *solution, const struct rgb *map,
                    double white, const char *path, struct error *error);

#endif
