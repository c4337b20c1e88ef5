/* The scene with its patches, the method and its thresholds: the one argument shared by
 * links, refinement and push-pull. Identical on all ranks but for the counters. */
#ifndef RAD_MODEL_H
#define RAD_MODEL_H

#include <stdint.h>

#include "geom/scene.h"
#include "octree/octree.h"
#include "rad/flux.h"
#include "rad/method.h"
#include "rad/patch.h"

/* Values of options. method_of() makes a method of the first three. */
enum oracle { ORACLE_BF, ORACLE_ERROR }; /* rad/oracle.h, rad/beyond/error_oracle.h */
/* rad/formfactor.h, rad/beyond/patch_exchange.h */
enum form_factor { FORM_FACTOR_DISK, FORM_FACTOR_POLYGON };
enum linking_kind { LINKING_PAIRS, LINKING_TREE };
enum solver_kind { SOLVER_JACOBI, SOLVER_CG };
enum balance { BALANCE_NONE, BALANCE_GREEDY, BALANCE_DEFAULT }; /* mpi/balance.h */

/* How links are evaluated, when and how far they are refined, and when the iterations
 * end. */
struct criterion {
    enum oracle oracle;
    enum linking_kind linking;
    enum form_factor form_factor;
    enum solver_kind solver;
    enum balance balance;
    double epsilon;         /* energy or error at which a link is split, relative to
                               light_power() of the method */
    double accuracy;        /* error of the leaves down to which epsilon is lowered and
                               rays are added, relative RMS; 0: these stay */
    double min_area;        /* smallest patch, relative to the scene's area */
    int max_level;          /* deepest subdivision, 0..ID_MAX_LEVEL */
    double alpha;           /* alpha_c, share of its parent's cost in the cost of a
                               link, 0..1 */
    double tolerance;       /* bound on the remaining iteration error, relative to all
                               light */
    int max_iterations;     /* at least 1 */
    int final_gather;       /* rays from a leaf of middling size; 0: none */
};

enum { GATHER_RAYS_MOST = 16384 };   /* of criterion.final_gather */
enum { TESTS_PER_FORM_FACTOR = 12 }; /* tests taking as long as one: rad/link.c */

struct cluster_light;
struct spaces;

struct model {
    const struct scene *scene;
    const struct octree *octree;
    struct forest *forest;
    struct cluster_light *clusters; /* above the roots; NULL: none */
    const struct spaces *spaces;    /* with a light of their own; NULL: one */
    struct criterion criterion;
    struct method method;
    struct flux_unit flux_unit; /* of powers added by ranks */
    double area, whole_area; /* of the scene without and with a sky, square scene units */
    double emitted_power;   /* scene_entering_power(), W */
    double absorptance;     /* 1 less the largest reflectance of any band, 1 */
    double link_threshold;  /* W, areas in square scene units: epsilon times the light */
    double patch_threshold; /* square scene units: no patch smaller than this is made */
    struct octree_counts counts; /* work of this rank so far */
    int64_t estimating;     /* work of this rank so far on form factors, in tests */
    int64_t rays_spared;    /* rays not fired, of 16 for each pair looked at by this
                               rank */
    int64_t walled_off;     /* links that ended on this rank by a proof of a wall */
};

/* Work of this rank so far, in tests of the octree. */
static inline int64_t model_work(const struct model *model)
{
    return model->counts.node_tests + model->counts.triangle_tests + model->estimating;
}

/* Fills a model; borrows scene, octree and forest. */
struct model model_make(const struct scene *scene, const struct octree *octree,
                        struct forest *forest, const struct criterion *criterion,
                        struct method method);

/* Changes epsilon of the criterion, and the threshold accordingly. */
void model_set_epsilon(struct model *model, double epsilon);

#endif
