/* The state of one rank, and its report at the end. */
#if defined(__unix__) || defined(__APPLE__)
#define _XOPEN_SOURCE 600
#include <sys/resource.h>
#define HAVE_RUSAGE 1
#endif

#include "mpi/solver.h"

#include <math.h>
#include <string.h>

#include "geom/alloc.h"

const struct steps STEPS_PAPER = {
    .deal = solver_deal_roots,
    .transfer = solver_transfer,
    .push_pull = solver_push_pull_jacobi,
    .scatter = solver_renew_proxies,
    .vote = solver_vote_jacobi,
};

struct solver *solver_create(const struct comm *comm, const struct scene *scene,
                             const struct octree *octree,
                             const struct criterion *criterion, struct method method)
{
    struct solver *solver = alloc_array(1, sizeof *solver);
    size_t roots = (size_t)scene_root_count(scene);
    solver->comm = comm;
    solver->model = model_make(scene, octree, forest_create(scene), criterion, method);
    solver->steps = STEPS_PAPER;
    solver->memory.rays = criterion->final_gather;
    solver->turn.fresh = solver->turn.complete = true;
    solver->homes.owner = alloc_array(roots, sizeof *solver->homes.owner);
    solver->homes.own = alloc_array(roots, sizeof *solver->homes.own);
    return solver;
}

void solver_destroy(struct solver *solver)
{
    if (!solver)
        return;
    if (solver->steps.end)
        solver->steps.end(solver);
    forest_destroy(solver->model.forest);
    link_list_free(&solver->links);
    alloc_free(solver->homes.owner);
    alloc_free(solver->homes.own);
    alloc_free(solver->homes.patches);
    routes_free(&solver->routes);
    routes_free(&solver->whole);
    ledger_free(&solver->account.ledger);
    alloc_free(solver->account.proxies);
    alloc_free(solver);
}

/* Most bytes ever held by this process, 0 where the system does not tell. */
static int64_t peak_memory(void)
{
#ifdef HAVE_RUSAGE
    struct rusage usage;
    if (getrusage(RUSAGE_SELF, &usage) == 0)
#ifdef __APPLE__
        return usage.ru_maxrss;
#else
        return (int64_t)usage.ru_maxrss * 1024;
#endif
#endif
    return 0;
}

static void report_seconds(const struct solver *solver, struct stats *stats)
{
    const struct comm *comm = solver->comm;
    double *all =
        comm_gather_each(comm, solver->account.seconds, sizeof solver->account.seconds);
    for (int phase = 0; phase < PHASE_COUNT; phase++) {
        struct spread spread = {all[phase], 0.0, all[phase]};
        for (int r = 0; r < comm->size; r++) {
            double seconds = all[r * PHASE_COUNT + phase];
            spread.min = fmin(spread.min, seconds);
            spread.mean += seconds / comm->size;
            spread.max = fmax(spread.max, seconds);
        }
        stats->seconds[phase] = spread;
    }
    alloc_free(all);
}

enum { COUNT_SUMS = 10 + 4 };

/* 0: open, 1: seen, 2: partly, 3: unseen. */
static int kind_of(const struct link *link)
{
    return link_is_open(link)            ? 0
           : link->seen == LINK_ALL_SEEN ? 1
           : link->seen > 0              ? 2
                                         : 3;
}

static void report_counts(const struct solver *solver, struct stats *stats)
{
    const struct octree_counts *counts = &solver->model.counts;
    int64_t own[COUNT_SUMS] = {counts->rays,
                               counts->node_tests,
                               counts->triangle_tests,
                               solver->account.bytes[CARGO_LINKS],
                               solver->account.bytes[CARGO_FLUX],
                               solver->account.bytes[CARGO_LIGHT],
                               solver->account.bytes[CARGO_WHOLE],
                               solver->model.walled_off,
                               solver->model.rays_spared,
                               peak_memory()};
    const int64_t *messages = solver->account.messages;
    int64_t sum[COUNT_SUMS], largest[2 + CARGO_COUNT] = {own[9], comm_counts().messages};
    memcpy(largest + 2, messages, CARGO_COUNT * sizeof *messages);
    for (int64_t i = 0; i < solver->links.count; i++)
        own[10 + kind_of(&solver->links.items[i])]++;
    MPI_Request request;
    MPI_Iallreduce(own, sum, COUNT_SUMS, MPI_INT64_T, MPI_SUM, solver->comm->handle,
                   &request);
    comm_wait(&request);
    stats->rays = sum[0];
    stats->node_tests = sum[1];
    stats->triangle_tests = sum[2];
    memcpy(stats->bytes_of, sum + 3, sizeof stats->bytes_of);
    stats->walled_off = sum[7];
    stats->rays_spared = sum[8];
    stats->peak_rss_bytes_sum = sum[9];
    stats->links_open = sum[10];
    stats->links_seen = sum[11];
    stats->links_partly = sum[12];
    stats->links_unseen = sum[13];
    MPI_Iallreduce(MPI_IN_PLACE, largest, 2 + CARGO_COUNT, MPI_INT64_T, MPI_MAX,
                   solver->comm->handle, &request);
    comm_wait(&request);
    stats->peak_rss_bytes = largest[0];
    stats->messages = largest[1];
    memcpy(stats->messages_with, largest + 2, sizeof stats->messages_with);
}

/* Transfers 1 and leaves no trace in the accounts: not a part of the method. */
static void carry_ones_unseen(struct solver *solver)
{
    struct account before = solver->account;
    link_list_sort(&solver->links); /* those of a finished, resumed run are not */
    routes_renew(solver);
    solver_carry_ones(solver);
    solver->account = before;
}

void solver_measure_row_sums(struct solver *solver, struct stats *stats)
{
    const struct comm *comm = solver->comm;
    double start = comm_seconds();
    carry_ones_unseen(solver);
    struct row_sums own =
        row_sums_measure(solver->model.forest, solver->homes.own, solver->flux);
    struct row_sums *all = comm_gather_each(comm, &own, sizeof own);
    struct row_sums sum = {.min = HUGE_VAL, .max = -HUGE_VAL};
    for (int r = 0; r < comm->size; r++) {
        sum.min = fmin(sum.min, all[r].min);
        sum.max = fmax(sum.max, all[r].max);
        sum.area = flux_add(sum.area, all[r].area);
        sum.rows = flux_add(sum.rows, all[r].rows);
        sum.squares = flux_add(sum.squares, all[r].squares);
    }
    alloc_free(all);
    double area = sum.area > 0 ? (double)sum.area : 1.0; /* 0: too small to count */
    bool any = sum.min <= sum.max;
    stats->row_sum_min = any ? sum.min : 0.0;
    stats->row_sum_max = any ? sum.max : 0.0;
    stats->row_sum_mean = (double)sum.rows / area;
    stats->row_sum_rms = sqrt((double)sum.squares / area);
    solver->account.seconds[PHASE_ROW_SUMS] += comm_seconds() - start;
}

void solver_report(struct solver *solver, const struct vote *vote, struct stats *stats)
{
    const struct scene *scene = solver->model.scene;
    double unit = scene_area_unit(scene);
    stats->ranks = solver->comm->size;
    stats->triangles = scene->sky_first;
    stats->roots = 0;
    for (int32_t root = 0; root < scene_root_count(scene); root++)
        stats->roots += scene_root_area(scene, root) > 0.0;
    struct forest_counts counts = forest_count(solver->model.forest);
    stats->patches = counts.patches;
    stats->leaves = counts.leaves;
    stats->links = vote->links;
    stats->passes = solver->turn.pass;
    stats->iterations = solver->turn.iteration;
    stats->clusters = solver->memory.clusters;
    stats->counted_bytes = memory_needed(&solver->memory, 1, stats->links,
                                         solver->model.forest->count);
    stats->memory_limit = solver->memory.limit;
    stats->memory_limited = solver->memory.reached > 0;
    stats->converged = vote->converged && !stats->memory_limited;
    stats->epsilon = solver->model.criterion.epsilon;
    stats->emitted_power = unit * scene_entering_power(scene);
    stats->absorbed_power = unit * vote->absorbed;
    stats->escaped_power = unit * vote->escaped;
    if (scene->sky_first < scene->input_count)
        stats->escaped_power = stats->emitted_power - stats->absorbed_power;
    stats->checksum = forest_checksum(solver->model.forest);
    ledger_share(&solver->account.ledger, solver->comm);
    stats->levels = solver->account.ledger.levels;
    stats->level_count = solver->account.ledger.level_count;
    memcpy(stats->work, solver->account.ledger.sums, sizeof stats->work);
    stats->exchanges = comm_counts().collectives;
    alloc_free(solver->account.proxies);
    solver->account.proxies = comm_gather_each(
        solver->comm, &solver->account.held, sizeof *solver->account.proxies);
    stats->proxies = solver->account.proxies;
    report_counts(solver, stats);
    report_seconds(solver, stats);
    if (solver->steps.report)
        solver->steps.report(solver, stats);
}
