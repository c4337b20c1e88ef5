/* How far a solution is from the truth: the error norms.
 *
 * Over all surface that reflects, with areas a, radiosity B of the solution less its
 * emission, and truth T = rho H, summed over the three bands:
 *
 *     rms    = sqrt(sum a |B - T|^2 / sum a |T|^2)
 *     l1     = sum a |B - T| / sum a T
 *     median = median by area of |B - T|, over the mean by area of T
 *     bias   = sum a (B - T) / sum a T
 *
 * The first three are 1 for a solution that is black, the last, which tells whether light
 * is lost or won as a whole, is -1. Emission is taken away on both sides, since it is
 * given and not found: the light of a lamp, many times brighter than all it lights, would
 * hide any error in a relative number.
 *
 * The truth is two independent estimates r and s. The rms uses (B - r)(B - s) for the
 * square of the error, and r s for that of the truth: both are right in the mean, so
 * noise does not bias it. A sum below 0, which noise can make of an error near 0, counts
 * as 0. The bias is linear in the truth, so the same holds for it. The l1 and the median
 * use (r + s) / 2 and carry its noise: errors well below `noise` cannot be seen by
 * them. */
#ifndef TESTS_DEVIATION_H
#define TESTS_DEVIATION_H

#include "io/picture/render.h"
#include "tests/truth.h"

/* A piece of surface on which a solution is compared with the truth. */
struct sample {
    double area;                      /* square scene units */
    struct rgb value;                 /* B - E of the solution, W/m^2 */
    struct rgb truth[TRUTH_HALVES];   /* rho H, W/m^2, two independent estimates */
};

struct deviation {
    double rms, l1, median, bias; /* relative, 1 */
    double noise;  /* RMS of (r - s) / 2, relative as rms: the deviation of (r + s) / 2 */
    double square; /* mean by area of |T|^2, (W/m^2)^2 */
};

/* All are 0 without samples, or where the truth is black. */
struct deviation deviation_of(const struct sample *samples, int64_t count);

/* Noise of the truth alone: of the elements' means, or of their points. */
double truth_noise(const struct truth *truth, const struct scene *scene, bool points);

/* `leaf`: the constant of a leaf, with the mean of the truth over that leaf; where leaves
 * are smaller than an element of the truth, their mean over the element. */
struct deviation deviation_of_leaves(const struct forest *forest,
                                     const struct truth *truth);

/* `root`: the mean radiosity of a root, with the mean of the truth over that root. Errors
 * inside a root cancel, so solutions on any meshes can be compared, with truths in
 * elements of any size. */
struct deviation deviation_of_roots(const struct forest *forest,
                                    const struct truth *truth);

/* No light at all reaches its point. */
bool element_is_black(const struct element *element);

/* `shown`: the radiosity that pictures show, with the truth at the points of the
 * elements. Points that no light reaches at all, such as those that a box covers, are
 * left out. */
struct deviation deviation_of_points(const struct renderer *renderer,
                                     const struct scene *scene,
                                     const struct truth *truth);

#endif
