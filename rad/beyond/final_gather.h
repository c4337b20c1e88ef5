/* The final gather: what each leaf really sees, from the finished solution.
 *
 * (The paper's gather, step 5, brings flux of proxies home; this one is phr's own.) The
 * irradiance of a leaf is H = source + sum of weight B over its terms, band by band: the
 * row of the leaf. Rows are made once, by rays; then they can be applied to any
 * radiosities. A row depends on the scene, on the trees and on the radiosities of the
 * solution, and on nothing else: it is the same on any rank. */
#ifndef RAD_BEYOND_FINAL_GATHER_H
#define RAD_BEYOND_FINAL_GATHER_H

#include "rad/beyond/lamps.h"

/* What a leaf gets of the radiosity of a patch, 1. Local numbers of patches differ from
 * rank to rank; terms have the place of the patch in forest_order(), and so has all that
 * has a value for each patch here. */
struct gather_term {
    int32_t place;
    float weight[BANDS];
};

struct gather_row {
    int32_t leaf;
    int64_t end;       /* of its terms, which begin where those of the row before end */
    struct rgb source; /* irradiance that comes from lamps, W/m^2 */
    struct rgb lamps;  /* what lamps bring straight by what they emit, W/m^2 */
    double chance[BANDS]; /* variance of H by the choice of rays and segments, if that
                             is by chance, (W/m^2)^2, for the solution's radiosities */
    double halves[BANDS]; /* square of what the first and second half of the rays
                             differ by: the variance as the sequence has it, but of
                             this leaf alone */
    float bare;        /* share of the leaf that no other thing lies or stands on, 1 */
};

/* Work of this rank. */
struct gather_counts {
    int64_t rays, segments; /* fired for first hits; asked whether they are blocked */
    int64_t escaped;        /* rays out of the scene or to backs, from leaves that see any
                               front, and exact rows that do not sum to 1 */
    int64_t exact;          /* rows made without rays */
};

/* A root and the roots that it faces, if it is proved that nothing stands between them.
 */
struct gather_view {
    int32_t root;      /* -1: none yet */
    bool open;
    int32_t *faced;    /* [count], roots */
    int64_t count, capacity;
    struct octree_counts counts; /* of all proofs: each rank that has a leaf of the root
                                    makes them again */
};

struct final_gather {
    struct model *model; /* borrowed; rays are counted there */
    int rays;              /* from a leaf, in the mean */
    double mean;           /* radiosity, over bands and all surface, W/m^2 */
    struct lamps lamps;
    struct lamp_groups groups; /* of the leaf at hand, */
    struct gather_view view;   /* and of its root */
    int32_t *order; /* [forest->count] patches as in forest_order(), */
    int32_t *place; /* and the place of each */
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
    struct plane plane; /* there */
    int32_t input;      /* triangle that they are on, */
    bool above;         /* or a little above, so that it may hide lamps from them */
};

/* What arrives at such points in the mean, W/m^2. */
struct gather_light {
    struct rgb lamps; /* straight from lamps, by what they emit, */
    struct rgb rest;  /* and all else; 0 if it is not asked for */
    double variance;  /* of the first, by the choice of segments, over bands, (W/m^2)^2 */
};

/* A look at a leaf: its quarters, and chance. */
struct gather_look {
    float reflected[4][BANDS]; /* rho H of each quarter, W/m^2 */
    double noise;              /* variance of that of a quarter, by chance */
    double variance;           /* of rho H of a ray, over bands, (W/m^2)^2 */
    float fixed, work;         /* tests that a row will take, and each of its rays */
};

/* How B varies over a patch: see final_gather.c. */
struct gather_slope {
    int32_t first; /* child 0 of the patch, or of its parent */
    double rise;   /* s, times the part that is taken; 0: B is taken as constant */
    double range;  /* most that B differs by from that of the centre, over all bands,
                      W/m^2 */
};

/* Borrows the model, which has clusters and a solution. `rays`: at least 1. */
struct final_gather final_gather_create(struct model *model, int rays);
void final_gather_free(struct final_gather *gather);

/* True if it is proved that nothing stands between a root and all that it faces: then its
 * leaves may have exact rows. */
bool final_gather_root_is_open(struct final_gather *gather, int32_t root);

/* Looks at the quarters of a leaf by so many rays each. */
struct gather_look final_gather_look(struct final_gather *gather, int32_t leaf, int rays);

/* Makes the row of a leaf, as the last one, by so many rays; or, if it may be exact and
 * its root is open, by exact factors. */
void final_gather_add(struct final_gather *gather, int32_t leaf, int rays, bool exact);

/* For the radiosities that the forest has: by so many segments to lamps, and as many rays
 * if all light is asked for. */
struct gather_light final_gather_at(struct final_gather *gather,
                                    const struct gather_points *points, uint64_t seed,
                                    int count, bool all);

/* Forgets all rows. */
void final_gather_drop_rows(struct final_gather *gather);

struct gather_slope gather_slope(const struct final_gather *gather, int32_t patch);

/* The radiosities of the leaves by place, made those of all patches: inner ones get the
 * mean of their leaves. */
void final_gather_pull(const struct final_gather *gather, struct rgb *radiosity);

/* H of a row, W/m^2, for the radiosities of all patches by place, with what lamps bring
 * besides, or without. */
struct rgb final_gather_irradiance(const struct final_gather *gather, int64_t row,
                                   const struct rgb *radiosity, bool lamps);

#endif
