/* How far two pictures, or two solutions, are from each other. */
#ifndef TOOLS_COMPARE_H
#define TOOLS_COMPARE_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/error.h"
#include "geom/triangle.h"
#include "io/picture/image.h"
#include "rad/id.h"

/* Of all bands of all pixels, or blocks of them, or of all leaves, weighted by area.
 * Where a sample of either side is not a finite number it is counted and left out of the rest. */
struct difference {
    int64_t samples, broken; /* broken: not finite on one side or both */
    double weight;           /* sum over the others */
    double largest;          /* largest |a - b|, in units of the samples */
    double sum, squares;     /* sums of |a - b| and (a - b)^2, weighted */
    double expected_squares; /* sum of b^2, weighted */
    double peak;             /* largest |b| */
};

double difference_mean(const struct difference *difference);
double difference_rms(const struct difference *difference);

/* x as a share of the root mean square of b: 0 if x is 0, infinite if only b is. */
double difference_relative(const struct difference *difference, double x);

/* 20 log10(peak / RMS), dB; infinite if there is no difference. */
double difference_psnr(const struct difference *difference, double peak);

/* Compares picture a with b, the expected one, of the same size: the means over blocks of `side`
 * by `side` pixels, which end at the right and lower edges. Blocks in which a sample of b is above
 * `most` are left out. `map`, of the same size, receives |a - b| of each block in all its pixels;
 * the largest float where that is not finite, 0 where the block is left out. */
struct difference compare_images(const struct image *a, const struct image *b, int side,
                                 double most, struct image *map);

struct solution_leaf {
    struct patch_id id;
    struct triangle triangle; /* input units */
    int64_t start, end;  /* what it covers of the root, in 4^15ths of its area */
    double area;         /* square input units */
    struct rgb radiosity; /* W/m^2 */
};

/* A solution mesh that phr wrote: its leaves, in their order. */
struct solution {
    struct solution_leaf *leaves; /* [count] */
    int64_t count;
};

/* Reads a mesh. To be freed with solution_free().
 * Errors: those of ply_read(); what io/picture/mesh.h describes is missing; the leaves of a root do not
 * follow each other without gaps from its begin to its end. EXIT_USAGE. */
bool solution_read(struct solution *solution, const char *path, struct error *error);

/* The same for a file in memory, which it takes over. */
bool solution_of_binary(struct solution *solution, const struct binary *binary,
                        struct error *error);

void solution_free(struct solution *solution);

/* Compares solution a with b, the expected one, by area and band. Where one is divided more
 * finely the leaf of the other is compared with each of the leaves that it covers. `map`, [a->count],
 * receives the mean of |a - b| over each leaf of a.
 * Errors: they do not have the same roots (EXIT_USAGE). */
bool compare_solutions(const struct solution *a, const struct solution *b,
                       struct difference *difference, struct rgb *map, struct error *error);

/* Writes the leaves of a solution with the values of `map` in place of their radiosities, as a
 * mesh of the same format, flat; in its colours `white` is full white. Errors: as output_close(). */
bool solution_write(const struct solution *solution, const struct rgb *map, double white,
                    const char *path, struct error *error);

#endif
