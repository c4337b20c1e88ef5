/* The light in a scene of diffuse triangles, by parallel hierarchical radiosity.
 *
 * Collective: a function is called by all ranks of MPI_COMM_WORLD, or by the only one of
 * a serial build. Out of memory ends all ranks with exit code 1. Of threads, one at a
 * time calls any of them. */
#ifndef PHR_H
#define PHR_H

#ifdef __cplusplus
extern "C" {
#endif

/* Red, green, blue. */
struct phr_material {
    double reflectance[3]; /* rho, 1, in [0, 1) */
    double emission[3];    /* emitted radiosity, W/m^2: pi times the radiance */
};

/* A scene; its arrays are read by phr_solve() alone. A triangle reflects and emits on the
 * side from which its corners are counter-clockwise. */
struct phr_scene {
    int triangle_count;
    const double *corners;  /* [9 * triangle_count], x y z of three corners each, m */
    const int *material_of; /* [triangle_count], index into materials */
    int material_count;
    const struct phr_material *materials; /* [material_count] */
};

/* A leaf of the solution: a part of a triangle. */
struct phr_leaf {
    int triangle;         /* number of the triangle in the scene */
    int on_back;          /* 1: on its back, with --two-sided; else 0 */
    double corners[3][3]; /* counter-clockwise, m */
    double area;          /* m^2 */
    double radiosity[3];  /* B, W/m^2 */
    double error;         /* bound on the error of B, for 95 % of leaves, W/m^2; 0: none
                             is known, without a final gather */
};

struct phr_solution {
    long leaf_count;
    struct phr_leaf *leaves; /* [leaf_count] fronts by triangle, then backs; a triangle
                                without an area, or there twice, has none */
    int converged;           /* 0: there were too few iterations */
};

/* Initialises MPI, unless it is. Returns the rank of this process. To be called once,
 * before phr_solve(). */
int phr_start(void);

/* Finalises MPI, if phr_start() has initialised it. */
void phr_stop(void);

/* Computes the light of the scene of rank 0; other ranks may pass NULL. The options are
 * those of phr's command line that name no file, with a NULL behind the last, and the
 * same on all ranks. Returns the solution, which all ranks get whole, to be freed with
 * phr_free(); NULL on an error, with its text in phr_error(). */
struct phr_solution *phr_solve(const struct phr_scene *scene, const char *const *options);
void phr_free(struct phr_solution *solution);

/* The error of the last phr_solve(), one line; empty if there was none. Local. */
const char *phr_error(void);

/* Version of the library, as "0.3". Local. */
const char *phr_version(void);

#ifdef __cplusplus
}
#endif

#endif
