/* How wrong the light of each leaf of a final gather may be. */
#ifndef MPI_BEYOND_GATHER_ERROR_H
#define MPI_BEYOND_GATHER_ERROR_H

#include "mpi/beyond/gathering.h"

/* Collective. A bound on the error of B of 95 % of leaves, W/m^2, by the deviation of the
 * band that has most, and the RMS of deviations by rays and by the mesh: both go into the
 * solver's answer. `remaining`: the part of B that the solution may lack, 1. Pre:
 * g->radiosity is the solution. */
void gathering_estimate_errors(struct gathering *g, double remaining);

#endif
