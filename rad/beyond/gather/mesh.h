/* The mesh of a final gather, and the rays that each leaf is worth. */
#ifndef RAD_BEYOND_GATHER_MESH_H
#define RAD_BEYOND_GATHER_MESH_H

#include "rad/beyond/gather/look.h"

/* The leaves with an area, in the order of forest_order(). */
struct gather_mesh {
    int32_t *leaves; /* [count] local numbers */
    int *rays;       /* [count] to be fired for the row */
    int *segments;   /* [count] to be fired at lamps */
    bool *exact;     /* [count] the row may be exact */
    int64_t *work;   /* [count] predicted for the row, in tests */
    int64_t count;
    uint8_t *cut;    /* [forest->count] 1: a thing stands on the patch, or across it */
    int64_t cut_capacity;
    int64_t split;   /* leaves split */
    bool limited;    /* the memory limit has kept others from being split */
    struct final_gather *gather; /* of looks; rows go on with it */
    int64_t traced;  /* rays and segments of looks on this rank */
};

void gather_mesh_free(struct gather_mesh *mesh);

/* Estimates for a leaf, by its look or its parent's. */
struct known {
    double by_ray;     /* variance of rho H by one ray, (W/m^2)^2; or a mark of mesh.c */
    double by_segment; /* the same by one segment */
    float fixed;       /* tests of its row, without its rays */
    float work;        /* tests of each ray */
};

/* Sums over the leaves of a space, these by area. */
struct space_sums {
    double square;     /* of (rho H)^2, W/m^2 squared */
    double unseen;     /* the part of leaves not looked at */
    double threshold;  /* of splitting; below 0: not known yet */
    double by_ray, by_segment; /* variances */
    double fixed, work; /* of leaves looked at, each counting 1 */
    int64_t seen;       /* leaves looked at */
};

/* A mesh being made. The fields up to `patches_most` are set before. */
struct meshing {
    struct model *model;
    struct final_gather *gather; /* of looks */
    struct gather_mesh *mesh;
    const uint8_t *open;  /* [roots] 1: leaves of the root have exact rows */
    int64_t patches_most; /* no leaf is split once there are so many patches */
    struct known *known;  /* [forest->count] of leaves */
    int64_t known_capacity;
    struct space_sums *sums; /* [lit_count()] */
    int rays;             /* of a look at a quarter */
};

/* Lists the leaves, and splits those with exact rows where light bends. */
void meshing_begin(struct meshing *meshing);

/* True if there are rays enough for looks. */
bool meshing_looks(const struct meshing *meshing);

/* Returns the leaves to be looked at, [*count], to be freed. */
int32_t *meshing_choose(struct meshing *meshing, int64_t *count);

/* Returns the predicted work of leaves, in tests, [count], to be freed: of their rows in
 * `mesh`; or, with NULL, of looks. */
int64_t *meshing_work(const struct meshing *meshing, const int32_t *leaves, int64_t count,
                      const struct gather_mesh *mesh);

/* Splits the leaves, [count], over which light varies by their looks; their children,
 * which are to be looked at next, take the place of all. Returns the number of these. */
int64_t meshing_split(struct meshing *meshing, const struct gather_look *looks,
                      int32_t **leaves, int64_t count);

/* Gives each leaf rays and segments, and frees the state of the work. */
void meshing_end(struct meshing *meshing);

#endif
