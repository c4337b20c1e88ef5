/* phr: parallel hierarchical radiosity.
 *
 * compute_light() is the algorithm: the eight steps of the paper's Sec. 3.2, and step 9,
 * which is phr's own. Each is in the file of its name under mpi/. Before it stand the
 * parts of steps that are about files and signals; what a run reads, says and shows is in
 * tools/. */
#include "compute.h"

#include <math.h>
#include <stdio.h>

#include "io/run/machine.h"
#include "mpi/memory.h"
#include "tools/balance.h"
#include "tools/dump.h"
#include "tools/idle.h"
#include "tools/input.h"
#include "tools/report.h"
#include "tools/results.h"
#include "tools/stored.h"

/* --- parts of the steps --- */

/* True if the paper's method alone is asked for: nothing of beyond/ is called. */
static bool is_paper(const struct criterion *criterion)
{
    return criterion->oracle == ORACLE_BF && criterion->form_factor == FORM_FACTOR_DISK &&
           criterion->linking == LINKING_PAIRS && criterion->solver == SOLVER_JACOBI;
}

static void create_solver(struct run *run)
{
    const struct criterion *criterion = &run->options.criterion;
    struct solver *solver =
        is_paper(criterion)
            ? solver_create(&run->comm, run->scene, run->octree, criterion, PAPER)
            : beyond_create(&run->comm, run->scene, run->octree, criterion);
    run->solver = solver;
    memory_watch(&solver->memory, &run->comm, solver->model.forest->root_count,
                 run->options.memory, machine_memory(), machine_room());
    report_memory(run);
    solver->account.seconds[PHASE_READ] = comm_seconds() - run->start;
    solver->account.seconds[PHASE_OCTREE] = run->block.seconds;
    solver->progress = &run->progress.progress;
}

/* Step 2: initial linking, or the links of a file in its place. */
static bool link_roots(struct run *run)
{
    const struct options *options = &run->options;
    struct solver *solver = run->solver;
    if (options->resume)
        return stored_load(run, STORE_CHECKPOINT, options->resume);
    if (options->load_links)
        return stored_load(run, STORE_LINKS, options->load_links);
    progress_begin(solver->progress, "linking", -1, 0);
    run_say(run, "%s: %lld triangles; linking", options->scene,
            (long long)run->scene->sky_first);
    run->half_linked = !solver_link_roots(solver);
    if (solver->turn.stop)
        return run_stopped(run, solver->turn.stop);
    if (options->criterion.linking == LINKING_PAIRS)
        run_say(run, "roots are linked, %.1f s", comm_seconds() - run->start);
    return true;
}

/* Between steps 3 and 4: the links of the roots can be kept. */
static bool save_links(struct run *run)
{
    const char *path = run->options.save_links;
    return !path || stored_save(run, STORE_LINKS, path);
}

/* True if there is a pass more. */
static bool is_unfinished(const struct run *run)
{
    const struct vote *vote = &run->vote;
    if (run->solver->turn.stop || run->haste || vote->diverged)
        return false;
    return !vote->converged &&
           run->solver->turn.iteration < run->options.criterion.max_iterations;
}

/* True if there is another iteration over the same links. A signal ends them, unless
 * there is to be a checkpoint: that is of a whole pass. */
static bool iterates(struct run *run)
{
    report_solving(run);
    return run->vote.again && (!run->solver->turn.stop || run->options.checkpoint);
}

/* True if the state of a whole pass is worth a checkpoint. */
static bool is_due(const struct run *run)
{
    const struct options *options = &run->options;
    const struct vote *vote = &run->vote;
    const struct turn *turn = &run->solver->turn;
    if (!options->checkpoint || run->half_linked || run->haste || vote->unfinished ||
        vote->diverged)
        return false;
    return turn->pass % options->every == 0 || turn->stop || vote->converged ||
           turn->iteration >= options->criterion.max_iterations;
}

/* The end of a pass. False on an error. */
static bool end_pass(struct run *run, int64_t first_level)
{
    report_levels(run, first_level);
    report_iteration(run);
    if (run->vote.diverged)
        return error_set(&run->error, EXIT_FAILED,
                         "the solution diverges: surfaces reflect more light than they "
                         "receive");
    return !is_due(run) || stored_save(run, STORE_CHECKPOINT, run->options.checkpoint);
}

/* For a line at the end. */
static const char OF_LINKS[] = "the light is that of the links there were";

/* Step 9: what leaves really see. A run that was asked to stop ends with the light of the
 * links. */
static enum finish finish_light(struct run *run)
{
    if (run->haste || run_hastens(run, OF_LINKS))
        return FINISH_DONE;
    if (!stored_complete(run))
        return FINISH_STOPPED;
    if (!run->solver->steps.finish)
        return FINISH_DONE;
    enum finish finish = run->solver->steps.finish(run->solver, &run->vote);
    report_round(run);
    if (finish == FINISH_STOPPED && run_hastens(run, OF_LINKS))
        return FINISH_DONE;
    return finish;
}

/* --- the algorithm --- */

bool compute_light(struct run *run)
{
    enum finish finish;
    if (!run->octree && !input_broadcast(run))   /* 1: all get the scene */
        return false;
    if (stored_light(run))                       /* the scene has its light with it */
        return true;
    create_solver(run);
    struct solver *solver = run->solver;
    if (!link_roots(run))                        /* 2: initial linking */
        return false;
    solver_assign_roots(solver);                 /* 3: re-assignment of roots */
    if (!save_links(run))
        return false;
    do {
        while (is_unfinished(run)) {
            int64_t first_level = solver->account.ledger.level_count;
            if (!solver_refine(solver))          /* 4: Algorithm 1 */
                run_hastens(run, OF_LINKS);
            progress_begin(solver->progress, "solving", -1, 0);
            run->first_bound = HUGE_VAL;
            do {
                solver_gather(solver);           /* 5: light; proxies send flux home */
                solver_push_pull(solver);        /* 6: on the own roots */
                solver_scatter(solver);          /* 7: proxies are renewed */
                run->vote = solver_vote(solver); /* 8: is there another iteration? */
            } while (iterates(run));
            if (!end_pass(run, first_level))
                return false;
        }
        solver_complete(solver);
        finish = finish_light(run);              /* 9: the final gather */
    } while (finish == FINISH_AGAIN);
    return finish == FINISH_DONE;
}

/* --- the program --- */

static void print_words(const struct options *options)
{
    if (options->help)
        options_print_help(options->help_on, stdout);
    else
        printf("phr %s (%s build), MIT licence\n", PHR_VERSION, comm_build());
}

int main(int argc, char **argv)
{
    struct run run = {0};
    bool parsed = run_start(&run, &argc, &argv) && run_parse(&run, argc, argv);
    if (parsed && (run.options.help || run.options.version)) {
        if (run.comm.rank == 0)
            print_words(&run.options);
    } else if (parsed) {
        idle_warn(&run);
        if (compute_light(&run)) {
            if (!run.stored && (!run.options.quiet || run.options.stats))
                solver_measure_row_sums(run.solver, &run.stats);
            if (balance_is_absurd(&run) || (results_show(&run) && dump_print(&run)))
                report_summary(&run);
        }
    }
    return run_end(&run);
}
