/* Spot checks: how far from the truth the leaves are, measured at some of them by the
 * path tracer. */
#ifndef MPI_SPOTCHECK_H
#define MPI_SPOTCHECK_H

#include "mpi/solver.h"

struct spotcheck {
    double square; /* of the error of leaves, mean by area, relative to that of the
                      reflected radiosity; unbiased, so it may fall below 0 */
    double doubt;  /* standard deviation of that */
    int64_t leaves, paths, rays; /* checked; traced for that */
    bool done;     /* no signal has ended it */
};

/* Collective, after a final gather: holds the radiosities of leaves against paths, until
 * `doubt` is a third of the square that was found, or of that of half of `goal` if that is
 * larger; or until it has taken as many rays as the gather and some more. The same on all
 * ranks. */
struct spotcheck spotcheck_run(struct solver *solver, double goal);

#endif
