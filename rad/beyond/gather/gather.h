/* The final gather: the irradiance of each leaf by rays and exact factors, from the
 * finished solution.
 *
 * (The paper's gather, step 5, brings flux of proxies home; this one is phr's own.) Rows
 * are made once, then applied to any radiosities. A row depends on the scene, on the
 * trees and on the radiosities of the solution, and on nothing else: each rank would make
 * the same row. */
#ifndef RAD_BEYOND_GATHER_GATHER_H
#define RAD_BEYOND_GATHER_GATHER_H

#include "rad/beyond/gather/cuts.h"
#include "rad/beyond/gather/slope.h"
#include "rad/beyond/gather/view.h"
#include "rad/beyond/panes.h"

/* A term of the row at hand, while it is summed. */
struct gather_sum {
    int32_t place, near;  /* as of a term */
    double weight[BANDS]; /* a float would lose the sixth digit over thousands of rays */
};

struct gather_sums {
    struct gather_sum *items; /* [count] */
    int64_t count, capacity;
    int64_t first;   /* of the sums open to additions */
    float *ranges;   /* [forest->count] how much B varies over a patch, from leaf to leaf,
                        in the band of the largest range, scaled, W/m^2 */
    int32_t *latest; /* [forest->count] by place: where the latest sum of the place is,
                        if there is one */
};

/* A leaf at points met by rays too near for its mean to hold: their paths went on from
 * there. */
struct gather_near {
    int64_t area;         /* sum over receivers: area, times the part of rays that meet
                             the leaf too near. By reciprocity this is the leaf's area,
                             times the part of its light for near receivers */
    int64_t watts[BANDS]; /* found there by the rays, emitted by lamps */
};

/* The path of a ray of the row at hand, from a leaf too near on. */
struct gather_path {
    int32_t place;    /* of the leaf */
    struct rgb light; /* brought by lamps, times the ray's share of the row, W/m^2 */
};

/* A patch as met by rays. */
struct gather_leaf {
    struct vec3 middle; /* its centroid */
    double reach2;      /* a ray shorter than the root of this meets the patch too near,
                           square scene units */
    struct gather_slope slope;
};

/* Light met at leaves too near, in integers, for sums over ranks; patches as met by
 * rays. */
struct gather_nears {
    struct gather_near *items; /* [forest->count] by place, for the rows of this rank; of
                                  all ranks, once these are added up */
    struct gather_path *paths; /* [path_count] of the row at hand */
    int64_t path_count, path_capacity;
    double unit_area;          /* square scene units */
    double unit_watts;         /* W in square scene units */
    struct gather_leaf *leaves; /* [forest->count] all patches, by their numbers */
};

/* Work of this rank. */
struct gather_counts {
    int64_t rays;           /* fired for first hits */
    int64_t segments;       /* tested for blockers */
    int64_t escaped;        /* rays out of the scene or to backs, from leaves with any
                               front in view, and exact rows not summing to 1 */
    int64_t exact;          /* rows made without rays */
    int64_t crossed;        /* terms, and segments seen, from one space to another */
};

/* A segment from a receiver to a sender. */
struct shot {
    struct vec3 x, y;
    double kernel; /* 1 per square scene unit; 0: an end is below the other's horizon */
};

/* The light of a node of a cut at a receiver, with nothing in the way. */
struct offer {
    double worth;  /* by which segments are dealt, over all bands, W/m^2 */
    double light;  /* of the node, nothing in the way, over all bands, W/m^2 */
    double factor; /* the exact form factor of a single near sender, 1; else -1 */
    double blind;  /* see cuts_blind_part() */
    double found;  /* see cut_found() */
};

/* Senders as targets of segments. */
struct gather_aims {
    struct panes *panes;       /* NULL: none */
    struct regions *regions;
    struct senders *senders[SENDER_KINDS]; /* NULL: no windows */
    struct cuts *cuts[SENDER_KINDS];       /* of these */
    struct offer *offers;      /* [offer_capacity] room for those of the nodes of a cut */
    struct shot *shots;        /* [shot_capacity] room for those at a sender */
    int64_t offer_capacity, shot_capacity;
};

/* The scene of a final gather, and the rows of this rank: rad/beyond/gather/rows.h. */
struct final_gather {
    struct model *model; /* borrowed; rays are counted there */
    int rays_asked;      /* from a leaf, in the mean, if there are few leaves */
    int rays;            /* from a leaf, in the mean */
    struct lit *lit;     /* [lit_count()] */
    const uint8_t *cut;  /* borrowed, [forest->count] 1: a thing stands on the patch or
                            across it; NULL: on none */
    int32_t *order;      /* [forest->count] patches as in forest_order() */
    int32_t *place;      /* [forest->count] the place of each patch in `order` */
    struct gather_aims *aims;
    struct gather_view *view; /* of the root of the leaf at hand */
    struct gather_nears *near;
    struct gather_sums *sums;
    struct gather_row *rows;   /* [count] */
    struct gather_term *terms; /* of all rows, one after the other */
    int64_t count, row_capacity, term_capacity;
    struct gather_counts counts;
};

/* Points of one surface, near each other, as in a pixel. */
struct gather_points {
    const struct vec3 *at; /* [count] */
    int count;
    struct vec3 middle;
    struct plane plane; /* of the surface, at the middle */
    int32_t root;       /* under the points */
    bool above;         /* the points lie a little above the root, which may hide lamps */
};

/* True if the root is a lamp that is aimed at. */
static inline bool root_is_lamp(const struct final_gather *gather, int32_t root)
{
    return gather->aims->senders[LAMPS]->part_of[root] == root;
}

/* The light reflected, in the mean over all surface, summed over bands, W/m^2. */
double forest_mean_reflected(const struct forest *forest);

/* Borrows the model, which has clusters and a solution, and `cut`: see struct
 * final_gather. Owns `lit`, of which lamps are chosen. `rays`: at least 1. */
struct final_gather *final_gather_create(struct model *model, int rays,
                                         const uint8_t *cut, struct lit *lit);
void final_gather_destroy(struct final_gather *gather); /* NULL: none */

/* Finds the bright patches anew, and the patches as met by rays, by the radiosities of
 * the forest and its leaves. To be called when these have changed. Drops all rows. */
void final_gather_renew(struct final_gather *gather);

/* Drops the cuts and what looks have told: no row, look or pixel can be made before
 * final_gather_forget(). */
void final_gather_drop_cuts(struct final_gather *gather);

/* Does as final_gather_renew(), and forgets all rows, leaves too near, and what looks
 * have told, also when lamps have changed: the gather is as a stored solution has it. */
void final_gather_forget(struct final_gather *gather);

/* The work of this rank so far, proofs included, in tests. */
int64_t final_gather_work(const struct final_gather *gather);

/* The integer of a value in units, bounded. */
int64_t gather_units(double value, double unit);


#endif
