/* viewfactors: form factors between the groups of a scene, with blockers, as CSV. A
 * program of its own, installed for users of heat balances.
 *
 * Scenes are read as by phr, and no light is computed.
 *
 * With --accuracy, pairs of groups not good enough are done again with a smaller epsilon,
 * at most ROUNDS times: each round costs several times the one before, so earlier rounds
 * cost little. */
#include <math.h>
#include <string.h>

#include "geom/stop.h"
#include "tools/input.h"
#include "tools/viewfactors/bodies.h"
#include "tools/viewfactors/pairs.h"
#include "tools/viewfactors/table.h"

static const char HELP[] =
    "usage: viewfactors [options] SCENE  or  mpiexec -n P viewfactors [options] SCENE\n"
    "Prints the form factors F between the groups (o, g) of a scene (OBJ PLY STL), with\n"
    "blockers, as CSV. Defaults in brackets.\n"
    "  --epsilon E    of the smaller group's area, in doubt between two patches (1e-2)\n"
    "  --accuracy A   smaller epsilons, until no F is off by more\n"
    "  --max-level N  of subdivision (10)\n"
    "  --dense        factors that are 0, too\n"
    "  --two-sided, --two-sided-lamps  faces have backs, those of lamps, too\n"
    "  --quiet  --verbose  --help  --version\n"
    "Exit status: 0 done; 1 failed or stopped; 2 bad usage or input.\n";

/* The options of phr valid here, too. */
static const char *const OPTIONS[] = {
    "--epsilon", "--accuracy", "--max-level", "--two-sided", "--two-sided-lamps",
    "--quiet", "--verbose", "--help", "--version", NULL};

/* A row that is off 1 by more, or by more than the error of F, is told. */
static const double ROW_SUM = 1e-3;

/* The default of --epsilon, with --accuracy and without. */
static const double EPSILON = 1e-2;

enum { ROUNDS = 12, STUCK_MOST = 2 };

/* An error not below this part of the last round's, in STUCK_MOST rounds one after
 * another, no longer falls. */
static const double STUCK = 0.95;

/* Adds all pairs, in rounds. Returns the largest error of F; stops at a signal. */
static double add_in_rounds(struct run *run, struct viewfactors *factors)
{
    double accuracy = run->options.criterion.accuracy, error = 0.0, last;
    int stuck = 0; /* rounds in a row */
    for (int round = 1;; round++) {
        last = error;
        progress_begin(&run->progress.progress, "form factors", -1, 0);
        pairs_add(&run->comm, factors, &run->progress.progress);
        progress_view_clear(&run->progress);
        if (!run_goes_on(run))
            return 0.0;
        error = viewfactors_error(factors);
        stuck = round > 1 && error > STUCK * last ? stuck + 1 : 0;
        if (!(accuracy > 0.0) || error <= accuracy || stuck == STUCK_MOST ||
            round == ROUNDS)
            return error;
        viewfactors_refine(factors, accuracy);
    }
}

/* Sets all pairs of groups by rays, four times as many in each round. Returns the largest
 * error of F; stops at a signal. */
static double fire_in_rounds(struct run *run, struct viewfactors *factors)
{
    double accuracy = run->options.criterion.accuracy, error = 0.0;
    for (int64_t rays = BODIES_RAYS;; rays *= 4) {
        bodies_set(&run->comm, factors, rays);
        if (!run_goes_on(run))
            return 0.0;
        error = viewfactors_error(factors);
        if (error <= accuracy || 4 * rays > BODIES_RAYS_MOST)
            return error;
    }
}

/* Returns the name of a group. */
static const char *name_of(const struct run *run, int32_t group)
{
    const char *name = run->scene->groups.names;
    while (group-- > 0)
        name += strlen(name) + 1;
    return name;
}

/* Tells of faces that look away from all others; and, where at least half of the rows sum
 * to 1, so that the scene is closed but for some mistake, of those that do not. */
static void warn_rows(struct run *run, const struct viewfactors *factors, double error)
{
    double within = fmax(ROW_SUM, error), first_sum = 0.0;
    int32_t ones = 0, others = 0, first = 0;
    for (int32_t i = factors->count - 1; i >= 0; i--) {
        double sum = factors->areas[i] > 0.0 ? viewfactors_row(factors, i) : 1.0;
        bool is_one = fabs(sum - 1.0) <= within;
        ones += is_one;
        others += !is_one;
        if (!is_one) {
            first = i;
            first_sum = sum;
        }
    }
    if (factors->away > 0 && !run->scene->two_sided)
        run_say(run, "warning: %ld of the triangles look away from all others (first in "
                     "%s): corners are counter-clockwise as seen from the front",
                (long)factors->away,
                name_of(run, run->scene->groups.of[scene_input_of(
                                 run->scene, factors->first_away)]));
    if (others > 0 && ones >= others)
        run_say(run, "warning: %ld rows do not sum to 1, as the others do (first: %s, "
                     "%.4g): a hole, faces that look away, or are covered",
                (long)others, name_of(run, first), first_sum);
}

static void report(struct run *run, double error)
{
    double accuracy = run->options.criterion.accuracy;
    if (accuracy > 0.0 && error > accuracy)
        run_say(run,
                "warning: the largest error of F is %.2g, not the %.3g of --accuracy: "
                "a smaller epsilon no longer helps, or --max-level is in the way",
                error, accuracy);
    run_say(run, "%.1f s; largest error of F: %.2g", comm_seconds() - run->start, error);
}

/* Collective. Prints the form factors between the groups of the scene. */
static void tabulate(struct run *run, bool dense)
{
    const struct criterion *criterion = &run->options.criterion;
    if (run->scene->groups.count > VIEWFACTOR_GROUPS_MAX) {
        error_set(&run->error, EXIT_USAGE, "%s: %lld groups are more than %d",
                  run->options.scene, (long long)run->scene->groups.count,
                  VIEWFACTOR_GROUPS_MAX);
        return;
    }
    run_say(run, "%s: %lld triangles in %lld groups", run->options.scene,
            (long long)run->scene->input_count, (long long)run->scene->groups.count);
    struct viewfactors *factors = viewfactors_create(
        run->scene, run->octree, criterion->epsilon, criterion->max_level);
    bool by_rays = criterion->accuracy > 0.0 && bodies_are_meant(factors);
    double error = by_rays ? fire_in_rounds(run, factors) : add_in_rounds(run, factors);
    if (run->error.code == EXIT_DONE && run->comm.rank == 0) {
        table_print(factors, dense, stdout);
        stop_check(&run->error);
    }
    if (run_agree(run)) {
        warn_rows(run, factors, error);
        report(run, error);
    }
    viewfactors_destroy(factors);
}

/* Collective. Reads the options. False on one of phr's that is none here. */
static bool parse(struct run *run, int argc, char **argv)
{
    static const char *const FINENESS[] = {"--epsilon", NULL};
    if (!run_parse(run, argc, argv))
        return false;
    const char *other = options_other(&run->options, OPTIONS);
    if (other)
        return error_set(&run->error, EXIT_USAGE, "unknown option %s; see --help", other);
    run->options.unlit = true;
    if (!*options_given(&run->options, FINENESS))
        run->options.criterion.epsilon = EPSILON;
    return true;
}

static void print_words(const struct options *options)
{
    if (options->help)
        fputs(HELP, stdout);
    else
        printf("viewfactors %s (%s build), MIT licence\n", PHR_VERSION, comm_build());
}

/* Takes --dense out of the arguments. True if it was there. */
static bool take_dense(int *argc, char **argv)
{
    int left = 0, all = *argc;
    for (int i = 0; i < all; i++)
        if (i == 0 || strcmp(argv[i], "--dense") != 0)
            argv[left++] = argv[i];
    *argc = left;
    argv[left] = NULL;
    return left < all;
}

int main(int argc, char **argv)
{
    error_program = "viewfactors";
    struct run run = {0};
    bool dense = take_dense(&argc, argv);
    bool started = run_start(&run, &argc, &argv), first = run.comm.rank == 0;
    if (started && parse(&run, argc, argv)) {
        bool words = run.options.help || run.options.version;
        if (words && first)
            print_words(&run.options);
        if (!words && input_broadcast(&run))
            tabulate(&run, dense);
    }
    return run_end(&run);
}
