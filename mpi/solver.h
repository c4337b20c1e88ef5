/* The distributed algorithm: the state of one rank, and the steps of the paper's Sec. 3.2
 * on this state. Every step is collective. */
#ifndef MPI_SOLVER_H
#define MPI_SOLVER_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/progress.h"
#include "mpi/account.h"
#include "mpi/comm.h"
#include "mpi/memory.h"
#include "mpi/node.h"
#include "rad/link.h"
#include "rad/model.h"
#include "rad/pushpull.h"
#include "rad/stats.h"

/* The report of a rank on an iteration, its part of the vote; 64 bytes, no padding. */
struct ballot {
    int64_t light, absorbed, change, arriving; /* flux units */
    int64_t split, links;
    int64_t divided;                           /* own new patches */
    int64_t stop;                              /* the signal of the rank */
};

/* Adds a ballot to a sum of ballots, in any order. */
void ballot_add(struct ballot *sum, const struct ballot *ballot);

/* The home of each root, the same on all ranks. */
struct homes {
    int *owner; /* [roots] its rank */
    bool *own;  /* [roots] owner[root] == rank */
    int32_t *patches; /* [count] at home here, in the order of creation */
    int64_t count, capacity;
    int64_t listed;   /* patches of the forest gone through so far */
};

/* The clusters above the roots, nodes below 0 (rad/patch.h), with the homes that their
 * roots have; borrowed. All NULL: there are none. */
struct clusters {
    int *owner;            /* of each cluster; of one with roots of several homes this
                              rank, on all ranks */
    struct rgb *radiosity; /* W/m^2 */
    int64_t *flux;         /* BANDS for each */
};

/* Nodes of this rank and others alike, rank by rank: patches, and clusters. */
struct route {
    int32_t *nodes; /* [count] local numbers */
    int *counts;    /* [ranks] nodes of each rank */
    int64_t count;
};

/* The proxies: flux goes from proxies to originals, radiosities come back. */
struct routes {
    struct route proxies;   /* of this rank, by their homes */
    struct route originals; /* nodes at home here, by the ranks with proxies of them, in
                               the order there */
    int32_t *known;         /* [capacity] of clusters, last one first, and patches: the
                               last pass whose radiosity is known here */
    int64_t capacity;
};

struct solver;

/* What travels of each node of a route: `bytes` bytes, without padding. */
struct record_kind {
    enum cargo cargo;
    size_t bytes;
    void (*pack)(struct solver *solver, int32_t node, void *record);
    void (*unpack)(struct solver *solver, int32_t node, void *record);
};

/* Where the run is. */
struct turn {
    int64_t pass;       /* refinements so far */
    int64_t iteration;  /* transfers of light so far */
    int64_t first_new;  /* patches from here on were created in this pass */
    int64_t shared;     /* patches up to here are the same on all ranks */
    int64_t split_here; /* links split by this rank in this pass */
    int64_t settled;    /* links before this number have settled */
    bool complete;      /* all ranks know the radiosities of all patches */
    bool fresh;         /* links have changed since the last transfer */
    int stop;           /* signal of some rank, 0: none; the same on all */
};

struct beyond; /* mpi/beyond/beyond.h */
struct vote;

/* After step 9: the light is there; a signal has come; or links want another pass. */
enum finish { FINISH_DONE, FINISH_STOPPED, FINISH_AGAIN };

/* The variable parts of steps: the paper's, and phr's own. NULL: an empty part. */
struct steps {
    void (*deal)(struct solver *solver, int *owner); /* 3: a home for each root */
    void (*prepare)(struct solver *solver);     /* 4: bounds on light, before a pass */
    /* 4: proxies at new ends learn these bounds */
    void (*learn)(struct solver *solver, const struct route *originals,
                  const struct route *proxies);
    void (*begin)(struct solver *solver);       /* 5: before new links carry light */
    /* 5: adds flux over the links living here */
    void (*transfer)(struct solver *solver, const struct rgb *vector);
    void (*collect)(struct solver *solver);     /* 5: flux of all ranks above the roots */
    void (*push_pull)(struct solver *solver);   /* 6: own leaves, and the ballot */
    void (*scatter)(struct solver *solver);     /* 7: radiosities to those in need */
    struct vote (*vote)(struct solver *solver, const struct ballot *sum); /* 8 */
    enum finish (*finish)(struct solver *solver, struct vote *vote);      /* 9 */
    void (*report)(const struct solver *solver, struct stats *stats);
    void (*end)(struct solver *solver);         /* releases solver->beyond */
};

/* The paper's. */
extern const struct steps STEPS_PAPER;

struct solver {
    const struct comm *comm;   /* borrowed */
    struct progress *progress; /* borrowed; NULL: nobody looks */
    struct model model;        /* scene, octree, forest, criterion; the forest is owned */
    struct link_list links;    /* the links living here ("allInteractions") */
    struct homes homes;
    struct clusters above;
    struct routes routes;      /* of flux to the homes, and of radiosities back */
    struct turn turn;
    struct memory memory;
    struct flux_unit flux;     /* unit of the flux of the last transfer */
    struct ballot ballot;      /* of this rank after push-pull, of all after the vote */
    struct account account;
    struct steps steps;
    struct beyond *beyond;     /* owned; NULL: the paper's method alone */
};

/* Sums over all ranks after an iteration; the same on all ranks. */
struct vote {
    bool again;        /* another transfer over the same links */
    bool settled;      /* nothing was split */
    bool converged;
    bool unfinished;   /* the limit of iterations is what ends the transfers */
    bool diverged;
    int64_t split;     /* links split in this pass */
    int64_t links;     /* links there are */
    double remaining;  /* change of energy, or bound on the remaining error, relative to
                          all light; HUGE_VAL: none */
    double absorbed;   /* W, areas in square scene units, like the next */
    double escaped;    /* light leaving surfaces, less light delivered by links */
};

/* The paper's steps, with links of this method. Borrows comm, scene and octree. */
struct solver *solver_create(const struct comm *comm, const struct scene *scene,
                             const struct octree *octree,
                             const struct criterion *criterion, struct method method);
void solver_destroy(struct solver *solver);

/* Step 2: initial linking, of all pairs of roots, or, with a tree above the roots, of its
 * top with itself. False if a signal (solver->turn.stop) or the memory limit
 * (memory.reached) has ended the step: then only the first pairs have links. */
bool solver_link_roots(struct solver *solver);

/* Step 3: re-assignment. Roots get homes with even sums of area, and links settle. */
void solver_assign_roots(struct solver *solver);

/* Local. Lists new patches at home here. */
void homes_renew(struct solver *solver);

/* The home of a patch or a cluster. */
int home_of(const struct solver *solver, int32_t node);

/* Collective. The links made since the last call go to the homes of their smaller nodes,
 * and from those with too many links to others. */
void solver_settle_links(struct solver *solver);

/* Step 4: Algorithm 1, level by level with load balancing; all ranks learn which patches
 * were split. Refinement ends at the memory limit, and does not begin again as long as
 * the limit is the same. False if a signal (solver->turn.stop) has ended the step: then
 * the pass is not counted, but light can be found over the links there are. */
bool solver_refine(struct solver *solver);

/* Collective. This rank learns the radiosities of the ends of links and, if `deep`,
 * before these are split, of the children of the ends. */
void solver_learn(struct solver *solver, const struct link_list *list, bool deep);

/* These nodes, home by home; to be freed with route_free(). */
struct route route_to_homes(const struct solver *solver, const int32_t *nodes,
                            int64_t count);
void route_free(struct route *route);

/* Collective. Records go from the nodes of a rank to the same of others. */
void routes_carry(struct solver *solver, const struct route *from, const struct route *to,
                  struct record_kind kind);

/* Collective. All ranks get the radiosities of nodes from their homes. Pre: the route is
 * the same on all ranks. */
void route_share(struct solver *solver, const struct route *route, enum cargo cargo);

/* Collective. Nodes of other homes at new ends of own links that carry light become
 * proxies. Pre: links are sorted, and all ranks have the same trees. */
void routes_renew(struct solver *solver);
void routes_free(struct routes *routes);

/* Step 5: light is transferred over the links there are, and proxies with new flux go
 * home. */
void solver_gather(struct solver *solver);

/* The transfer alone, of any vector [patches]. Pre: the links are sorted. */
void solver_carry(struct solver *solver, const struct rgb *vector);

/* The transfer of 1 from all patches in the first band: what arrives are row sums. */
void solver_carry_ones(struct solver *solver);

/* Collective. The largest magnitude of a vector [patches] over patches and bands. */
double solver_largest(const struct solver *solver, const struct rgb *vector);

/* Step 6: push-pull on the own roots, and this rank's ballot. */
void solver_push_pull(struct solver *solver);

/* Step 7: proxies get the radiosities of their patches. */
void solver_scatter(struct solver *solver);

/* Collective. All ranks get the radiosities of all patches, unless turn.complete. */
void solver_complete(struct solver *solver);

/* Step 8: the verdict on the sum of all ballots. */
struct vote solver_vote(struct solver *solver);

/* The parts of STEPS_PAPER. */
void solver_deal_roots(struct solver *solver, int *owner);
void solver_transfer(struct solver *solver, const struct rgb *vector);
void solver_push_pull_jacobi(struct solver *solver);
void solver_renew_proxies(struct solver *solver);
struct vote solver_vote_jacobi(struct solver *solver, const struct ballot *sum);

/* The vote on these sums, for a bound on the remaining error relative to all light. */
struct vote vote_make(const struct solver *solver, const struct ballot *sum,
                      double remaining);

/* Writes the row sums of the links into `stats`, after the last iteration. */
void solver_measure_row_sums(struct solver *solver, struct stats *stats);

/* Fills `stats` but for the row sums: counts and sums over all ranks, and the clocks of
 * all ranks as they stand. Borrows the levels of the solver. */
void solver_report(struct solver *solver, const struct vote *vote, struct stats *stats);

#endif
