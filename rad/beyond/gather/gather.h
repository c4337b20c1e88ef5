/* The final gather: the irradiance of each leaf by rays and exact factors, from the
 * finished solution.
 *
 * (The paper's gather, step 5, brings flux of proxies home; this one is phr's own.) Rows
 * are made once, then applied to any radiosities. A row depends on the scene, on the
 * trees and on the radiosities of the solution, and on nothing else: each rank would make
 * the same row. */
#ifndef RAD_BEYOND_GATHER_GATHER_H
#define RAD_BEYOND_GATHER_GATHER_H

#include "rad/beyond/gather/rows.h"

/* The mean irradiance of points, W/m^2. */
struct gather_light {
    struct rgb lamps; /* emission straight from lamps */
    struct rgb rest;  /* all other light; 0 unless asked for */
    struct rgb variance; /* of both, if segments and rays were chosen by chance,
                            (W/m^2)^2 */
    struct rgb halves;   /* a sample of the variance by the sequence: see struct
                            gather_row */
    bool by_chance;   /* few segments may agree by chance */
};

/* A look at a leaf: the light of its quarters by a few rays, in the same directions. */
struct gather_look {
    float reflected[4][BANDS]; /* rho H of each quarter, W/m^2 */
    double noise;              /* variance of rho H of a quarter, by chance, from the mean
                                  of all */
    double variance;           /* of rho H of a ray with its segment, over bands,
                                  (W/m^2)^2 */
    double of_segment;         /* the segment's part of `variance` */
    float fixed;               /* tests of a quarter, without its rays */
    float work;                /* tests of each ray */
    bool cut;                  /* a thing stands on the leaf */
};

/* The light reflected, in the mean over all surface, summed over bands, W/m^2. */
double forest_mean_reflected(const struct forest *forest);

/* The lamps of a scene, by how bright its spaces are. */
struct senders *lamps_create(const struct model *model, const struct lit *lit);

/* Borrows the model, which has clusters and a solution, and `cut`: see struct
 * final_gather. `rays`: at least 1. */
struct final_gather *final_gather_create(struct model *model, int rays,
                                         const uint8_t *cut);
void final_gather_destroy(struct final_gather *gather); /* NULL: none */

/* Finds the bright patches anew, and the patches as met by rays, by the radiosities of
 * the forest and its leaves. To be called when these have changed. */
void final_gather_renew(struct final_gather *gather);

/* True if proofs show that nothing stands between a root and the roots that it faces:
 * then its leaves may have exact rows. Without `proof`: if no segment finds a blocker. */
bool final_gather_root_is_open(struct final_gather *gather, int32_t root, bool proof);

/* Looks at the quarters of a leaf, by `rays` rays each. */
struct gather_look final_gather_look(struct final_gather *gather, int32_t leaf, int rays);

/* Appends the row of a leaf, made by `rays` rays, and `segments` to lamps; or, if `exact`
 * and its root is open, by exact factors. */
void final_gather_add_row(struct final_gather *gather, int32_t leaf, int rays,
                          int segments, bool exact);

/* Returns the light at points, for the radiosities of the forest: by `count` segments to
 * lamps, and, if `all`, `count` rays for the rest. */
struct gather_light final_gather_at(struct final_gather *gather,
                                    const struct gather_points *points, uint64_t seed,
                                    int count, bool all);

/* The work of this rank so far, proofs included, in tests. */
int64_t final_gather_work(const struct final_gather *gather);

/* The number of terms of all rows. */
int64_t final_gather_terms(const struct final_gather *gather);

/* Forgets all rows, and leaves too near. */
void final_gather_drop_rows(struct final_gather *gather);

/* The integer of a value in units, bounded. */
int64_t gather_units(double value, double unit);

/* Adds the light of a row by way of leaves too near, W in square scene units, to `watts`,
 * by `near` of the terms and by band, in gather->near->unit_watts. */
void final_gather_add_near(const struct final_gather *gather, int64_t row,
                           const struct rgb *radiosity, int64_t *watts);

/* The pull: inner patches get the mean of their leaves, by the visible shares of these,
 * and patches without a visible share get B of their parents, unless a thing is across
 * these: slopes between neighbours do not know of others. By place. */
void final_gather_pull(const struct final_gather *gather, struct rgb *radiosity);

/* Returns H of a row, W/m^2, for the radiosities of all patches by place, with its source
 * if `lamps`. */
struct rgb final_gather_irradiance(const struct final_gather *gather, int64_t row,
                                   const struct rgb *radiosity, bool lamps);

#endif
