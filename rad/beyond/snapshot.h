/* The state of a run between two passes, without its links: all that later passes depend
 * on. Patches have no local numbers here, but are counted roots in order, each tree depth
 * first (forest_order()), so a snapshot is the same on any number of ranks.
 *
 * The state before the first pass, when all pairs of roots are linked, is one, too. */
#ifndef RAD_BEYOND_SNAPSHOT_H
#define RAD_BEYOND_SNAPSHOT_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/error.h"
#include "rad/beyond/cluster.h"
#include "rad/link.h"
#include "rad/patch.h"

/* Whole numbers, none below 0. */
enum snapshot_number {
    SNAPSHOT_PASSES,         /* refinements */
    SNAPSHOT_ITERATIONS,     /* transfers of light */
    SNAPSHOT_SETTLED,        /* 1: the last pass split nothing */
    SNAPSHOT_LIMITED,        /* memory limit met by refinement, bytes; 0: none */
    /* work of all ranks so far */
    SNAPSHOT_RAYS, SNAPSHOT_NODE_TESTS, SNAPSHOT_TRIANGLE_TESTS,
    SNAPSHOT_WALLED_OFF, SNAPSHOT_RAYS_SPARED,
    SNAPSHOT_ROUNDS,         /* of --accuracy */
    SNAPSHOT_GATHER,         /* rays from a leaf, as raised by --accuracy */
    SNAPSHOT_NUMBERS
};

enum snapshot_value {
    SNAPSHOT_REMAINING,      /* bound on the remaining error, relative to all light;
                                HUGE_VAL: none */
    SNAPSHOT_ABSORBED, SNAPSHOT_ESCAPED, /* W, areas in square scene units */
    SNAPSHOT_EPSILON,        /* as lowered by --accuracy */
    SNAPSHOT_COARSE, SNAPSHOT_COARSE_EPSILON, /* see struct accuracy */
    SNAPSHOT_VALUES
};

struct snapshot {
    int64_t number[SNAPSHOT_NUMBERS];
    double value[SNAPSHOT_VALUES];
    int64_t root_count, patch_count, link_count;
    uint8_t *split;     /* [patch_count] 1: has children, else 0 */
    struct rgb *leaves; /* [snapshot_leaf_count()] their radiosities, W/m^2 */
};

/* Allocates the arrays of a snapshot whose three counts are set, all zero. */
void snapshot_allocate(struct snapshot *snapshot);
void snapshot_free(struct snapshot *snapshot);

/* Number of leaves: every split turns a leaf into an inner patch with four children. */
static inline int64_t snapshot_leaf_count(const struct snapshot *snapshot)
{
    return snapshot->patch_count - (snapshot->patch_count - snapshot->root_count) / 4;
}

/* True if the splits make `root_count` whole trees, no deeper than IDs reach, and every
 * number and value is possible in a run. Pre: the counts fit each other. Errors: the
 * fault, without a file's name, EXIT_USAGE. */
bool snapshot_check(const struct snapshot *snapshot, struct error *error);

/* The check of a snapshot's links, one after the other; their p and q are its patch
 * numbers, or below 0: clusters. */
struct link_check {
    const struct scene *scene; /* borrowed */
    int64_t patch_count, cluster_count;
    int32_t *root;             /* [patch_count] */
    double *area;              /* [cluster_count + patch_count] square scene units; a
                                  node's at its number + cluster_count */
    double *load;              /* [as area] sum of the exchange areas so far */
    double most;               /* limit of a load */
    struct link last;
    bool begun;
};

/* Pre: snapshot_check() has said yes, and root_count is the scene's. Borrows the scene.
 * `tree`: NULL if there are no clusters. */
struct link_check link_check_start(const struct snapshot *snapshot,
                                   const struct scene *scene,
                                   const struct cluster_tree *tree);
void link_check_free(struct link_check *check);

/* True if the next link is possible in a run: numbers in their ranges, no pair of nodes
 * twice, no node receiving from more than there is, ascending order. */
bool link_check_next(struct link_check *check, const struct link *link);

#endif
