/* What a run reports: filled by the layers that know, written by io/run/stats.c. */
#ifndef RAD_STATS_H
#define RAD_STATS_H

#include <stdbool.h>
#include <stdint.h>

/* Where time goes, as in the paper's Table 2 and beyond. */
enum phase {
    PHASE_TOTAL, PHASE_READ, PHASE_LINKING, PHASE_REFINEMENT, PHASE_IDLE, PHASE_MIGRATION,
    PHASE_GATHER, PHASE_PUSH_PULL, PHASE_SCATTER, PHASE_SOLVE, PHASE_RENDER, PHASE_WRITE,
    PHASE_OCTREE,    /* part of READ: rank 0 builds the octree */
    PHASE_SPACES,    /* part of READ: rays by which the tree tells spaces apart */
    PHASE_TREE,      /* part of READ: rank 0 builds the tree above the roots */
    PHASE_PREPARE,   /* part of REFINEMENT: bounds on the light so far, on all ranks */
    PHASE_LOOKS,     /* part of REFINEMENT: which links are to be split? */
    PHASE_SUMS,      /* sums through clusters and over all patches, on all ranks */
    PHASE_ROUTES,    /* the routes and what belongs to each patch, on all ranks */
    PHASE_FINAL_GATHER, /* rows of the final gather, and their solution */
    PHASE_ROWS,      /* part of FINAL_GATHER: the mesh and the rows */
    PHASE_PRODUCTS,  /* part of FINAL_GATHER: a rank's rows times radiosities */
    PHASE_SPOT_CHECKS, /* the error of leaves, measured by paths */
    PHASE_ROW_SUMS,  /* the row sums reported by a run */
    PHASE_SHADING,   /* part of RENDER: the blend of all leaves, on all ranks */
    PHASE_VIEWPOINT, /* part of RENDER: a place for the camera, on all ranks */
    PHASE_COUNT
};

/* Seconds over ranks. */
struct spread {
    double min, mean, max;
};

/* A level of refinement on one rank. Work is counted in box and triangle tests; a form
 * factor counts as 12, an exchange of phr's own as 50 or 150. */
struct level_share {
    int64_t links;     /* split by the rank */
    int64_t load;      /* predicted work before links moved */
    int64_t predicted; /* predicted work of the split links */
    int64_t done;      /* work of splitting these */
    int64_t sent;      /* links that left before the level */
    int64_t received;  /* links received */
};

/* A level of refinement, on all ranks. Linking of all pairs, of which nothing is
 * predicted, is level 0 of pass 0. */
struct level_balance {
    int64_t pass, level;
    int64_t links; /* split; of all pairs, made */
    double predicted_max, predicted_mean; /* over ranks */
    double work_max, work_mean;           /* over ranks */
    struct level_share *shares;           /* [ranks] */
};

/* Kinds of work of ranks, each with the unit of its count. */
enum work {
    WORK_LINKING,   /* linking, as above: tests */
    WORK_LOOKS,     /* links looked at between passes */
    WORK_SPLITTING, /* refinement: tests */
    WORK_TRANSFER,  /* links over which light was transferred */
    WORK_OWN,       /* own leaves in push-pull */
    WORK_PATCHES,   /* patch records packed or unpacked */
    WORK_FINAL_GATHER, /* rows of the final gather: tests */
    WORK_COUNT
};

/* What a rank holds. */
struct holdings {
    int64_t patches; /* at home there */
    int64_t proxies; /* patches and clusters of other homes between which its links carry
                        light, or did */
    int64_t memory;  /* most bytes ever held, with what ranks share; 0: unknown */
};

/* What travels between ranks. */
enum cargo {
    CARGO_LINKS, /* moving, in steps 3 and 4 */
    CARGO_FLUX,  /* sent in step 5 */
    CARGO_LIGHT, /* got in step 7 and before levels; new patches, at the end of step 4 */
    CARGO_WHOLE, /* the light of all leaves to all ranks, at the end */
    CARGO_COUNT
};

/* Of all phases of one kind. */
struct work_sums {
    int64_t phases;  /* their number */
    int64_t all;     /* work of all ranks */
    int64_t slowest; /* work of the busiest rank, summed over phases */
    int64_t bytes;   /* bytes of the busiest sender, summed over phases */
};

/* What keeps --accuracy from being reached. */
enum hold {
    HOLD_NONE, HOLD_LEVEL, HOLD_AREA, HOLD_MEMORY, HOLD_ITERATIONS,
    HOLD_RAYS,    /* no leaf can have more */
    HOLD_EPSILON, /* epsilon is as small as can be, or helps no more */
    HOLD_ROUNDS,  /* the most rounds allowed were made */
    HOLD_DOUBT,   /* paths do not tell the error well enough */
    HOLD_NOTHING  /* no surface reflects light: there is nothing to measure */
};

/* The last final gather of all ranks. */
struct gathered {
    int64_t rays, segments; /* fired; tested for blockers */
    int64_t exact;          /* rows made without rays */
    int64_t terms;          /* of all rows, as kept */
    int64_t looks;          /* rays and segments fired before there were rows */
    int64_t split;          /* leaves over which the gathered light was seen to vary */
    bool limited;           /* no memory left to split others */
    int64_t pixels;         /* rays and segments fired for the picture */
    double closing; /* largest part, of a band, of the light leaving surfaces of a closed
                       scene, lost or made; 0: an open scene */
    double error;   /* of the leaves, relative RMS of reflected radiosity */
    double median, worst_tenth; /* errors relative to a leaf's own light that half and a
                                   tenth of the leaves exceed, 1 at most */
    double median_by_rays, median_by_mesh; /* the same of each part alone */
    double by_rays; /* part of the error from the choice of rays */
    double by_mesh; /* part from B varying within leaves; the squares of both parts sum to
                       the error's, less the doubt in a measurement */
    int64_t checked; /* leaves to measure the error by, 0: it was estimated */
    int64_t paths;   /* fired for the measurement */
};

struct stats {
    const char *scene;       /* name of its file; borrowed */
    uint64_t scene_checksum; /* scene_hash() */
    const char *options;     /* lines "--option value", not the defaults; borrowed */
    const double *exposures; /* [views] of pictures of bytes, 0: of none; borrowed */
    int64_t views, ranks, triangles, roots, patches, leaves, links, passes, iterations;
    bool converged;
    int64_t clusters;      /* of the tree above the roots, 0: there is none */
    int64_t counted_bytes; /* of links, patches and clusters, as counted by --memory */
    int64_t memory_limit;      /* bytes of links, patches and clusters; 0: none */
    bool memory_limited;       /* linking, refinement or the gather's mesh ended there */
    double epsilon;            /* relative to the emitted power */
    double error_estimate;     /* of the leaves, relative RMS; 0: there is none */
    double accuracy;           /* asked for, 0: none was */
    enum hold hold;            /* the limit in the way of the goal */
    int64_t rounds;            /* of --accuracy */
    double emitted_power;  /* W, input units, sum over bands, like the next two */
    double absorbed_power;
    double escaped_power;
    double touching_power; /* emitted and absorbed between touching faces */
    uint64_t checksum;
    int64_t rays, node_tests, triangle_tests;                      /* of form factors */
    int64_t links_of[4];   /* links proved to be open; of the others, those all, some and
                              none of whose segments arrived */
    int64_t walled_off;    /* links that ended by a proof of a wall */
    struct gathered gathered;
    int64_t rays_spared;   /* rays not fired, of 16 for each link ever made */
    double row_sum_min, row_sum_mean, row_sum_max; /* row sums R */
    double row_sum_rms;                            /* of R - 1 */
    struct spread seconds[PHASE_COUNT];
    struct level_balance *levels; /* [level_count], borrowed from the solver */
    int64_t level_count;
    struct holdings *holdings;    /* [ranks] borrowed */
    int64_t bytes_of[CARGO_COUNT]; /* of all ranks */
    struct work_sums work[WORK_COUNT];
    int64_t exchanges; /* collective operations */
    int64_t messages;  /* log P an exchange, and those from rank to rank; the most of any
                          rank */
    int64_t messages_with[CARGO_COUNT]; /* of these */
    int64_t bytes_broadcast;    /* scene, octree and tree, one copy */
};

#endif
