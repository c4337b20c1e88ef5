/* The distributed algorithm: the state of one rank, and the steps of the paper's Sec. 3.2 that
 * work on it. Every step is collective. */
#ifndef MPI_SOLVER_H
#define MPI_SOLVER_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/progress.h"
#include "mpi/comm.h"
#include "mpi/ledger.h"
#include "mpi/node.h"
#include "mpi/routes.h"
#include "rad/beyond/node_link.h"
#include "rad/link.h"
#include "rad/model.h"
#include "rad/pushpull.h"
#include "rad/stats.h"

/* The memory limit; see mpi/memory.h. */
struct memory {
    int64_t limit;   /* bytes, 0: none */
    int64_t reached; /* the limit that has ended linking or refinement, 0: none has */
    int copies;      /* of patches and clusters, that count */
    int rays;        /* of the final gather */
};

/* What a rank says about an iteration; 136 bytes, no padding. */
struct ballot {
    int64_t light, absorbed, change, arriving; /* flux units */
    int64_t split, links;
    int64_t divided;                           /* own patches that are new */
    int64_t stop;                              /* the signal that it has got */
    int64_t square[BANDS];                     /* --solver cg: <z, z>, */
    int64_t negative, bulk, missing;           /* and see conjugate_sum(), flux units */
    double shrink;                             /* --solver jacobi: see push_pull() */
    double largest;                            /* --solver cg: |z| */
    double brightest;                          /* what leaves send, W/m^2 and band */
};

/* Adds a ballot to a sum of ballots, in any order. */
void ballot_add(struct ballot *sum, const struct ballot *ballot);

/* It travels with radiosities, in the place of so many. */
enum { BALLOT_RECORDS = (sizeof(struct ballot) + sizeof(struct rgb) - 1) / sizeof(struct rgb) };

/* The home of each root, the same on all ranks. */
struct homes {
    int *owner; /* [roots] its rank */
    bool *own;  /* [roots] owner[root] == rank */
};

/* Where the run is. */
struct turn {
    int64_t pass;       /* refinements so far */
    int64_t iteration;  /* transfers of light so far */
    int64_t first_new;  /* patches from here on were created in this pass */
    int64_t shared;     /* patches up to here are the same on all ranks */
    int64_t split_here; /* links that this rank split in this pass */
    int stop;           /* signal that some rank has got, 0: none; the same on all ranks */
};

/* What the last push-pull has changed, flux units. */
struct change {
    struct push_pull_sums sums;
    int64_t *of_root; /* [roots] see push_pull() */
    int64_t last;     /* of all ranks, in the iteration before */
};

/* What this rank has done, for the report. */
struct account {
    double seconds[PHASE_COUNT];
    int64_t bytes_migration; /* sent to other ranks */
    int64_t bytes_gather;    /* the same */
    int64_t bytes_scatter;   /* got from other ranks */
    int64_t copied;          /* patch records packed or unpacked */
    int64_t recorded[3];     /* of the last three, in the ledger */
    struct ledger ledger;
    int64_t *proxies;        /* [ranks] see struct stats */
    /* For benches: is told of each link split here the predicted and the done work, in
     * tests, and how many of its children are to be split too. NULL: nobody listens. */
    void (*watch)(void *watcher, int64_t load, int64_t work, int64_t children);
    void *watcher;
};

struct beyond; /* mpi/beyond/beyond.h */

struct solver {
    const struct comm *comm;   /* borrowed */
    struct progress *progress; /* borrowed; NULL: nobody looks */
    struct model model;        /* scene, octree, forest, criterion; the forest is owned */
    struct link_list links;    /* the links that live here ("allInteractions") */
    struct homes homes;
    struct routes routes;      /* of light between the ranks */
    struct turn turn;
    struct memory memory;
    struct flux_unit flux;     /* unit of the flux of the last transfer */
    struct change change;
    struct ballot ballot;      /* of this rank after push-pull, of all after scatter */
    struct account account;
    struct beyond *beyond;     /* owned: what the paper's method does not have */
};

/* Sums over all ranks after an iteration; the same on all ranks. */
struct vote {
    bool again;        /* another transfer over the same links */
    bool settled;      /* nothing was split */
    bool converged;
    bool unfinished;   /* there would be another transfer, but for the limit of iterations */
    bool diverged;
    int64_t split;     /* links split in this iteration */
    int64_t links;     /* links there are */
    double remaining;  /* bound on the remaining error, relative to all light; HUGE_VAL: none */
    double absorbed;   /* W, areas in square scene units */
    double escaped;    /* the same: what leaves the surfaces less what the links deliver */
};

/* Collective. Borrows comm, scene and octree. */
struct solver *solver_create(const struct comm *comm, const struct scene *scene,
                             const struct octree *octree, const struct criterion *criterion);
void solver_destroy(struct solver *solver);

/* Step 2: initial linking, of all pairs of roots, or, with a tree above the roots, of its
 * top with itself. False if a signal (solver->turn.stop) or the memory limit (memory.reached) has ended
 * it: then only the first pairs have links. */
bool solver_link_roots(struct solver *solver);

/* Step 3: re-assignment. Roots get homes so that the sums of their areas are even, and
 * their links go home. */
void solver_assign_roots(struct solver *solver);

/* Step 4: Algorithm 1, level by level with load balancing; all ranks learn which patches were
 * split. Refinement that meets the memory limit ends there, and does not begin again as long as the
 * limit is the same. False if a signal (solver->turn.stop) has ended it: then it counts as not begun, and
 * there is no light over the links there are. */
bool solver_refine(struct solver *solver);

/* Row sums of the links there are, and the closure. */
void solver_close(struct solver *solver);

/* Step 5: the transfer of light over the links there are, and flux of proxies goes home. */
void solver_transfer(struct solver *solver);
void solver_gather(struct solver *solver);

/* Steps 6 to 8: push-pull on the own roots; scatter of the own radiosities and of the
 * ballots, or of radiosities that nobody votes on; the vote. With --solver cg B takes the
 * place of rho z when there is no other iteration. */
void solver_push_pull(struct solver *solver);
void solver_scatter(struct solver *solver);
void solver_scatter_unvoted(struct solver *solver);
struct vote solver_vote(struct solver *solver);

/* This rank's ballot, when its roots are pushed and pulled: the end of solver_push_pull(). */
void solver_cast_ballot(struct solver *solver);

/* Step 9, phr's own, after the last vote: the final gather. What all leaves see is traced, and light
 * solved for by that; `vote` says of the light from then on. The same on all ranks. False
 * if a signal has ended it. Pre: there are clusters. */
bool solver_final_gather(struct solver *solver, struct vote *vote);

/* Step 9, if there is one, and with --accuracy the verdict on it: DONE; STOPPED by a signal; or AGAIN,
 * and then criterion and vote are those of the links, for more passes, or for this step with more
 * rays alone. */
enum finish { FINISH_DONE, FINISH_STOPPED, FINISH_AGAIN };
enum finish solver_finish(struct solver *solver, struct vote *vote);

/* Enters the work of the iteration into the ledger. */
void solver_record_iteration(struct solver *solver);

/* After the last iteration: the row sums over the links there are, into `stats`. */
void solver_measure_closure(struct solver *solver, struct stats *stats);

/* Fills `stats` but for the closure: counts and sums over all ranks, and the clocks of all ranks
 * as they stand. Borrows the levels of the solver. */
void solver_report(struct solver *solver, const struct vote *vote, struct stats *stats);

#endif
