/* The truth about a scene: the reflected radiosity of elements and of points, each
 * estimated twice by rad/beyond/paths.h.
 *
 * Elements are patches of a forest in which each root that reflects is divided evenly.
 * Each holds one point. It is rho H, the radiosity less the emission: that is the part
 * that a program has to find; E is given. */
#ifndef TESTS_TRUTH_H
#define TESTS_TRUTH_H

#include "geom/error.h"
#include "mpi/comm.h"
#include "rad/id.h"
#include "rad/beyond/paths.h"

enum { TRUTH_HALVES = 2, TRUTH_MAX_LEVEL = 10 };

/* 128 bytes without padding: it travels from rank to rank and to the file as it is. */
struct element {
    struct patch_id id;
    double weight[3]; /* barycentric coordinates of the point in its root */
    struct rgb mean[TRUTH_HALVES];    /* over the element, W/m^2; two estimates */
    struct rgb point[TRUTH_HALVES];   /* at the point, W/m^2; two independent estimates */
};

struct truth {
    struct element *items; /* [count], in the order of roots, then of IDs */
    int64_t count;
    int32_t root_count;    /* of the scene */
    double area;           /* of the scene, square scene units: tells scenes apart */
};

/* Elements without estimates for a prepared scene: at level 10, or each at most 1 /
 * `wanted` of the area that reflects. */
struct truth truth_make(const struct scene *scene, int64_t wanted);
void truth_free(struct truth *truth);

/* Square scene units. */
double element_area(const struct element *element, const struct scene *scene);

/* Gives element `number` its point and estimates the light there, with this many paths
 * for each half in an element of average size. The same whoever does it. */
void truth_find_point(struct truth *truth, int64_t number,
                      const struct pathtracer *pathtracer, int samples);

/* For each half. */
struct truth_paths {
    int element; /* light paths for each element; below a sky paths from it on */
    int point;   /* paths from each point on, on an element of average size; 0: none */
};

/* Collective. Elements with estimates, complete on rank 0. The same on any number of
 * ranks. */
struct truth truth_trace(const struct comm *comm, const struct scene *scene,
                         const struct octree *octree, int64_t wanted,
                         struct truth_paths paths);

/* Files are in the machine's own byte order. */
bool truth_write(const struct truth *truth, const char *path, struct error *error);

/* Errors: a file that cannot be read or is not that of the scene. */
bool truth_read(struct truth *truth, const char *path, const struct scene *scene,
                struct error *error);

#endif
