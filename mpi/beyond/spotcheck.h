/* Spot checks: how far from the truth the leaves are, measured at some of them by the
 * path tracer. */
#ifndef MPI_BEYOND_SPOTCHECK_H
#define MPI_BEYOND_SPOTCHECK_H

#include "mpi/solver.h"

struct spotcheck {
    double square;  /* mean square error of leaves, by area, over the mean square of the
                       reflected radiosity, possibly below 0. Unbiased, but for the end: a
                       check may miss leaves too few to be drawn */
    double doubt;   /* standard deviation of `square` */
    double own;     /* mean square error of leaves, each relative to its own light, plus
                       one standard deviation, in parts of the one claimed */
    int64_t leaves; /* checked */
    int64_t paths;  /* traced */
    int64_t rays;   /* traced */
    bool done;      /* no signal has ended the check */
};

/* Collective, after a final gather. Compares the radiosities of leaves with paths, until
 * `doubt` is about a third of `square`, or of (goal / 2)^2 if larger; or until the check
 * has taken as many rays as the gather and some more. The same on all ranks. */
struct spotcheck spotcheck_run(struct solver *solver, double goal);

/* Puts the measurements in the place of estimates. True if the measurement is larger by
 * more than doubt: then the mesh has the surplus, for the estimate of the rays is good;
 * else both parts are off by the same factor. Neither becomes 0 where nothing was
 * found. */
bool spotcheck_settle(const struct spotcheck *check, struct gathered *gathered);

#endif
