/* Step 4: Algorithm 1 of the paper.
 *
 * `prolific` holds the links of one level that will be split. Before each level the ranks
 * exchange their loads, the sums of predicted costs; each computes the same greedy plan
 * (mpi/plan.h); senders deal links to their receivers in turn until the planned load is gone.
 * Then each rank splits what it has: children that are to be split too form the next level, the
 * others join the links.
 *
 * With the loads travel two figures of the level before, the load after migration and the tests
 * that it really took, so that prediction and work can be compared without another exchange. */
#include "mpi/memory.h"
#include "mpi/migrate.h"
#include "mpi/plan.h"
#include "mpi/signals.h"

#include <string.h>

#include "geom/alloc.h"
#include "rad/oracle.h"

/* Links per rank from which a level is balanced: below, splitting takes less than an exchange. */
enum { WORTH_MOVING = 4 };

/* What ranks tell each other before a level. */
struct load_notice {
    int64_t links;           /* prolific links here */
    int64_t load;            /* their predicted cost */
    int64_t last_links;      /* of the level before: links that were split here, */
    int64_t last_load;       /* their predicted cost, */
    int64_t last_work;       /* and the tests that this took */
    int64_t kept;            /* links here that are not to be split */
    int64_t stop;            /* the signal that this rank has got, 0: none */
};

/* Links of all ranks before a level. */
struct level {
    int64_t prolific, kept;
};

static int64_t load_of(const struct link_list *list)
{
    int64_t load = 0;
    for (int64_t i = 0; i < list->count; i++)
        load += (int64_t)link_cost(&list->items[i]);
    return load;
}

static int64_t work_so_far(const struct solver *solver)
{
    return solver->method.counts.node_tests + solver->method.counts.triangle_tests;
}

/* Moves the links that are to be split from the rank's links to `prolific`. */
static void select_prolific(struct solver *solver, struct link_list *prolific)
{
    int64_t kept = 0;
    for (int64_t i = 0; i < solver->links.count; i++) {
        struct link link = solver->links.items[i];
        if (oracle_patch_to_split(&solver->method, &link) >= 0)
            link_list_append(prolific, link);
        else {
            oracle_divide_patches(&solver->method, &link);
            solver->links.items[kept++] = link;
        }
    }
    solver->links.count = kept;
}

/* Deals this rank's links in turn to the receivers of its transfers. A link goes to a receiver
 * as long as at least half of its cost still fits into what is planned for it. */
static void deal_links(const struct solver *solver, const struct link_list *list,
                       struct transfer *transfers, int count, int *destination)
{
    int mine = 0;
    for (int t = 0; t < count; t++)
        if (transfers[t].from == solver->comm->rank)
            transfers[mine++] = transfers[t];
    int turn = 0;
    for (int64_t i = 0; i < list->count; i++) {
        int64_t cost = (int64_t)link_cost(&list->items[i]);
        destination[i] = solver->comm->rank;
        for (int tried = 0; tried < mine; tried++) {
            struct transfer *t = &transfers[(turn + tried) % mine];
            if (2 * t->load < cost)
                continue;
            destination[i] = t->to;
            t->load -= cost;
            turn = (turn + tried + 1) % mine;
            break;
        }
    }
}

static void record_level(struct solver *solver, const struct load_notice *notices, int64_t level)
{
    struct level_balance balance = {.iteration = solver->pass, .level = level};
    int ranks = solver->comm->size;
    for (int r = 0; r < ranks; r++) {
        double load = (double)notices[r].last_load, work = (double)notices[r].last_work;
        balance.links += notices[r].last_links;
        balance.predicted_mean += load / ranks;
        balance.work_mean += work / ranks;
        balance.predicted_max = load > balance.predicted_max ? load : balance.predicted_max;
        balance.work_max = work > balance.work_max ? work : balance.work_max;
    }
    solver->levels = alloc_reserve(solver->levels, &solver->level_capacity,
                                   solver->level_count + 1, sizeof *solver->levels);
    solver->levels[solver->level_count++] = balance;
}

/* The total exchange of loads. Waiting here is idle time. */
static struct load_notice *exchange_loads(struct solver *solver, struct load_notice own)
{
    const struct comm *comm = solver->comm;
    struct load_notice *notices = alloc_array((size_t)comm->size, sizeof *notices);
    double start = comm_seconds();
    MPI_Request request;
    MPI_Iallgather(&own, (int)sizeof own, MPI_BYTE, notices, (int)sizeof own, MPI_BYTE,
                   comm->handle, &request);
    comm_wait(&request);
    solver->seconds[PHASE_IDLE] += comm_seconds() - start;
    return notices;
}

/* LoadBalance of Algorithm 1. `done` holds this rank's figures of the level before and receives
 * the load of this one. Returns the links of all ranks. */
static struct level balance_load(struct solver *solver, struct link_list *prolific, int64_t level,
                                 struct load_notice *done)
{
    int ranks = solver->comm->size;
    done->links = prolific->count;
    done->load = load_of(prolific);
    done->kept = solver->links.count;
    done->stop = signals_seen();
    struct load_notice *notices = exchange_loads(solver, *done);
    if (level > 0)
        record_level(solver, notices, level - 1);
    double start = comm_seconds();
    struct level sum = {0, 0};
    int64_t *loads = alloc_array((size_t)ranks, sizeof *loads);
    for (int r = 0; r < ranks; r++) {
        loads[r] = notices[r].load;
        sum.prolific += notices[r].links;
        sum.kept += notices[r].kept;
        solver->stop = (int)notices[r].stop > solver->stop ? (int)notices[r].stop : solver->stop;
    }
    struct transfer *transfers = alloc_array(2 * (size_t)ranks, sizeof *transfers);
    int count = plan_transfers(loads, ranks, transfers);
    bool pays = count > 0 && sum.prolific >= WORTH_MOVING * ranks;
    if (pays) { /* the same on all ranks, so all or none enter */
        int *destination = alloc_array((size_t)prolific->count, sizeof *destination);
        deal_links(solver, prolific, transfers, count, destination);
        solver->bytes_migration += links_migrate(solver, prolific, destination);
        alloc_free(destination);
    }
    alloc_free(transfers);
    alloc_free(loads);
    alloc_free(notices);
    progress_begin(solver->progress, "refining", level, sum.prolific);
    done->last_links = prolific->count;
    done->last_load = load_of(prolific);
    solver->seconds[PHASE_MIGRATION] += comm_seconds() - start;
    return sum;
}

/* Splits all links of the level; their children go to `next` or to the rank's links. */
static void split_level(struct solver *solver, const struct link_list *prolific,
                        struct link_list *next)
{
    for (int64_t i = 0; i < prolific->count; i++) {
        if (i % 64 == 0)
            progress_tick(solver->progress, (double)i / (double)prolific->count);
        const struct link *link = &prolific->items[i];
        struct link children[4];
        int32_t patch = oracle_patch_to_split(&solver->method, link);
        int count = link_split(&solver->method, link, patch, children);
        for (int k = 0; k < count; k++) {
            bool goes_on = oracle_patch_to_split(&solver->method, &children[k]) >= 0;
            if (!goes_on)
                oracle_divide_patches(&solver->method, &children[k]);
            link_list_append(goes_on ? next : &solver->links, children[k]);
        }
    }
    solver->split_here += prolific->count;
}

/* All ranks learn which patches were split here: the trees are the same everywhere before light is
 * transferred, since a link deals light to the children of a patch, if there are any. */
static void share_splits(struct solver *solver)
{
    struct forest *forest = solver->method.forest;
    const struct comm *comm = solver->comm;
    double start = comm_seconds();
    int64_t count = 0;
    struct patch_id *split = alloc_array((size_t)(forest->count - solver->shared) / 4,
                                         sizeof *split);
    for (int64_t p = solver->shared; p < forest->count; p += 4)
        split[count++] = forest->patches[p].id;
    int *at = alloc_array((size_t)comm->size + 1, sizeof *at);
    uint8_t *all = comm_gather_all(comm, split, count * (int64_t)sizeof *split, at);
    for (int i = 0; i < at[comm->size]; i += (int)sizeof *split) {
        struct patch_id id;
        memcpy(&id, all + i, sizeof id);
        forest_reach(forest, id);
    }
    solver->shared = forest->count;
    solver->bytes_scatter += count * (int64_t)sizeof *split * (comm->size - 1);
    alloc_free(all);
    alloc_free(at);
    alloc_free(split);
    solver->seconds[PHASE_SCATTER] += comm_seconds() - start;
}

/* A link that is looked at may give both its patches children; one that is split, a patch too. */
enum { PATCHES_PER_LOOK = 8, PATCHES_PER_SPLIT = 4 + 4 * PATCHES_PER_LOOK };

/* True if the memory limit lets the level be split. `made` is a bound on the patches that all ranks
 * have made and not shared; only where it is not good enough are they shared and counted. */
static bool level_fits(struct solver *solver, const struct level *level, int64_t *made)
{
    const struct memory *memory = &solver->memory;
    if (memory_has_room(memory, level->kept, level->prolific, solver->shared + *made))
        return true;
    share_splits(solver);
    *made = 0;
    return memory_has_room(memory, level->kept, level->prolific, solver->shared);
}

/* Splits level after level. Returns false if a signal or the memory limit ended that: then the links
 * that were to be split are in `prolific`. */
static bool split_levels(struct solver *solver, struct link_list *prolific)
{
    struct link_list next = {0};
    struct load_notice done = {0};
    int64_t made = 0;
    for (int64_t level = 0;; level++) {
        struct level links = balance_load(solver, prolific, level, &done);
        if (links.prolific == 0)
            return true;
        made += level == 0 ? PATCHES_PER_LOOK * links.kept : 0;
        if (solver->stop)
            return false;
        if (!level_fits(solver, &links, &made)) {
            solver->memory.reached = solver->memory.limit;
            return false;
        }
        made += PATCHES_PER_SPLIT * links.prolific;
        double start = comm_seconds();
        int64_t work = work_so_far(solver);
        split_level(solver, prolific, &next);
        done.last_work = work_so_far(solver) - work;
        link_list_free(prolific);
        *prolific = next;
        next = (struct link_list){0};
        solver->seconds[PHASE_REFINEMENT] += comm_seconds() - start;
    }
}

bool solver_refine(struct solver *solver)
{
    struct memory *memory = &solver->memory;
    struct link_list prolific = {0};
    double start = comm_seconds();
    bool done = true;
    solver->pass++;
    forest_bound(solver->method.forest);
    solver->split_here = 0;
    solver->first_new = solver->shared = solver->method.forest->count;
    if (memory->limit == 0 || memory->reached != memory->limit) {
        memory->reached = 0;
        select_prolific(solver, &prolific);
        solver->seconds[PHASE_REFINEMENT] += comm_seconds() - start;
        done = split_levels(solver, &prolific);
        for (int64_t i = 0; i < prolific.count; i++) /* none, if it is done */
            link_list_append(&solver->links, prolific.items[i]);
        link_list_free(&prolific);
        share_splits(solver);
    }
    bool stopped = !done && solver->stop != 0;
    solver->pass -= stopped;
    return !stopped;
}
