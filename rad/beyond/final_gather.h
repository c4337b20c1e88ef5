/* The final gather: the irradiance of each leaf by rays and exact factors, from the
 * finished solution.
 *
 * (The paper's gather, step 5, brings flux of proxies home; this one is phr's own.) The
 * irradiance of a leaf is H = source + sum of weight B over its terms, band by band: the
 * row of the leaf. Rows are made once, by rays; then they can be applied to any
 * radiosities. A row depends on the scene, on the trees and on the radiosities of the
 * solution, and on nothing else: it is the same on any rank. */
#ifndef RAD_BEYOND_FINAL_GATHER_H
#define RAD_BEYOND_FINAL_GATHER_H

#include "rad/beyond/lamps.h"

/* The form factor from a leaf to a patch, 1, band by band. Local numbers of patches
 * differ from rank to rank, so a patch is named by its place in forest_order(), here as
 * in all arrays of the final gather. */
struct gather_term {
    int32_t place; /* of the patch */
    float weight[BANDS];
};

struct gather_row {
    int32_t leaf;
    int64_t end;       /* of its terms; they begin at the end of the row before */
    struct rgb source; /* irradiance that comes from lamps, W/m^2 */
    struct rgb lamps;  /* irradiance straight from lamps, W/m^2 */
    double chance[BANDS]; /* variance of H if rays and segments were chosen by chance,
                             (W/m^2)^2, for the solution's radiosities */
    double halves[BANDS]; /* squared difference of the first and second half of the
                             rays: a sample of the variance by the sequence */
    float bare;        /* share of the leaf's area that nothing lies or stands on, 1 */
};

/* Work of this rank. */
struct gather_counts {
    int64_t rays;           /* fired for first hits */
    int64_t segments;       /* tested for blockers */
    int64_t escaped;        /* rays out of the scene or to backs, from leaves that see any
                               front, and exact rows that do not sum to 1 */
    int64_t exact;          /* rows made without rays */
};

/* A root and the roots that it faces. */
struct gather_view {
    int32_t root;      /* -1: none yet */
    bool open;         /* proved: nothing stands between the root and any of `faced` */
    int32_t *faced;    /* [count], roots */
    int64_t count, capacity;
    struct octree_counts counts; /* of all proofs, which each rank makes that has a leaf
                                    of the root */
};

struct final_gather {
    struct model *model; /* borrowed; rays are counted there */
    int rays;              /* from a leaf, in the mean */
    double mean;           /* radiosity, over bands and all surface, W/m^2 */
    struct lamps lamps;
    struct lamp_groups groups; /* of the leaf at hand */
    struct gather_view view;   /* of the root of the leaf at hand */
    int32_t *order; /* [forest->count] patches as in forest_order() */
    int32_t *place; /* [forest->count] the place of each patch in `order` */
    struct gather_row *rows;   /* [count] */
    struct gather_term *terms; /* [term_count] */
    int64_t count, term_count, row_capacity, term_capacity;
    struct gather_counts counts;
};

/* Points of one surface, near each other, as in a pixel. */
struct gather_points {
    const struct vec3 *at; /* [count] */
    int count;
    struct vec3 middle;
    struct plane plane; /* of the surface, at the middle */
    int32_t input;      /* triangle of the points */
    bool above;         /* they lie a little above it, so that it may hide lamps */
};

/* The mean irradiance of such points, W/m^2. */
struct gather_light {
    struct rgb lamps; /* emission that comes straight from lamps */
    struct rgb rest;  /* all other light; 0 unless asked for */
    double variance;  /* of `lamps`, by the choice of segments, over bands, (W/m^2)^2 */
};

/* A look at a leaf: the light of its quarters by a few rays. */
struct gather_look {
    float reflected[4][BANDS]; /* rho H of each quarter, W/m^2 */
    double noise;              /* variance of rho H of a quarter, by chance */
    double variance;           /* of rho H of a ray, over bands, (W/m^2)^2 */
    float fixed;               /* predicted tests of a row, without its rays */
    float work;                /* predicted tests of each ray of a row */
};

/* B as a linear function over a patch: see final_gather.c. */
struct gather_slope {
    int32_t first; /* child 0 of the patch, or of its parent */
    double rise;   /* s, made less where B would be below 0; 0: B is constant */
    double range;  /* largest difference of B from its value at the centre, over all
                      bands, W/m^2 */
};

/* Borrows the model, which has clusters and a solution. `rays`: at least 1. */
struct final_gather final_gather_create(struct model *model, int rays);
void final_gather_free(struct final_gather *gather);

/* True if it is proved that nothing stands between a root and the roots that it faces:
 * then its leaves may have exact rows. */
bool final_gather_root_is_open(struct final_gather *gather, int32_t root);

/* Looks at the quarters of a leaf, by `rays` rays each. */
struct gather_look final_gather_look(struct final_gather *gather, int32_t leaf, int rays);

/* Appends the row of a leaf, made by `rays` rays; or, if `exact` and its root is open, by
 * exact factors. */
void final_gather_add(struct final_gather *gather, int32_t leaf, int rays, bool exact);

/* Returns the light at points, for the radiosities of the forest: by `count` segments to
 * lamps, and, if `all`, `count` rays for the rest. */
struct gather_light final_gather_at(struct final_gather *gather,
                                    const struct gather_points *points, uint64_t seed,
                                    int count, bool all);

/* Forgets all rows. */
void final_gather_drop_rows(struct final_gather *gather);

struct gather_slope gather_slope(const struct final_gather *gather, int32_t patch);

/* The pull: inner patches get the mean of their leaves. `radiosity`: by place. */
void final_gather_pull(const struct final_gather *gather, struct rgb *radiosity);

/* Returns H of a row, W/m^2, for the radiosities of all patches by place, with its source
 * if `lamps`. */
struct rgb final_gather_irradiance(const struct final_gather *gather, int64_t row,
                                   const struct rgb *radiosity, bool lamps);

#endif
