/* The algorithm, for the program, the library and the tests. */
#ifndef COMPUTE_H
#define COMPUTE_H

#include "tools/run.h"

/* Collective. Computes the light of a run with options, and, where a scene and an octree
 * are there on all ranks, of these. Makes run->solver, which has the light, and
 * run->vote. False on an error or a signal, on all ranks. */
bool compute_light(struct run *run);

#endif
