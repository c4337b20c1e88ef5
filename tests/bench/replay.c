/* replay RANKS[,RANKS...] SCENE [OPTIONS of phr]: refinement on more ranks than there
 * are.
 *
 * A run on one rank tells of each link that it splits the predicted load, the work that
 * it took, and the number of its children that are to be split too. Links come level by
 * level, each behind its parent's other children, so these three numbers are the whole
 * tree of a pass. It is then dealt to so many ranks by the functions that phr deals by
 * (mpi/balance.h), without a memory limit.
 *
 * The replay does not know where the first links of a later pass live: they are spread
 * evenly, in turn. One line for each number of ranks: ranks, work of all, sum over levels
 * of the slowest rank's and of the most bytes that a rank sends. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mpi/beyond/create.h"
#include "geom/alloc.h"
#include "io/run/options.h"
#include "mpi/balance.h"
#include "tests/reading.h"
#include "tests/solve.h"

enum { BYTES_PER_LINK = 32, PASSES_MAX = 1000 };

struct split {
    int64_t load, work, children, first_child;
};

struct record {
    struct split *splits; /* [count] */
    int64_t count, capacity;
    int64_t pass_at[PASSES_MAX + 1]; /* a pass begins at splits[pass_at[pass]] */
    int passes;
};

struct pile { /* links of one rank, by number */
    int64_t *items, count, capacity;
};

struct tally {
    int64_t dealt, slowest, bytes;
};

/* --- recording --- */

/* The recorded method; the functions below call its functions in their place. */
static struct method recorded;
static struct record *record_of_run;

static int split_and_note(struct model *model, const struct link *link, int32_t side,
                          struct link *children)
{
    struct record *record = record_of_run;
    int64_t before = model_work(model);
    int count = recorded.split_link(model, link, side, children);
    struct split split = {.load = (int64_t)link_cost(link),
                          .work = model_work(model) - before};
    for (int k = 0; k < count; k++)
        split.children += recorded.side_to_split(model, &children[k]) != NODE_NONE;
    RESERVE(record->splits, &record->capacity, record->count + 1);
    record->splits[record->count++] = split;
    return count;
}

/* A new link that stays is a child of the last one that was split. */
static void keep_and_note(struct model *model, struct link *link)
{
    struct record *record = record_of_run;
    int64_t before = model_work(model);
    if (recorded.keep_link)
        recorded.keep_link(model, link);
    if (record->count > 0)
        record->splits[record->count - 1].work += model_work(model) - before;
}

static void record_run(const struct comm *comm, const struct scene *scene,
                       const struct criterion *criterion, struct record *record)
{
    struct octree *octree = octree_of(scene);
    struct solver *solver = beyond_create(comm, scene, octree, criterion);
    struct vote vote;
    recorded = solver->model.method;
    record_of_run = record;
    solver->model.method.split_link = split_and_note;
    solver->model.method.keep_link = keep_and_note;
    solver_link_roots(solver);
    solver_assign_roots(solver);
    do {
        solver_refine(solver);
        record->pass_at[++record->passes] = record->count;
        vote = solve_links(solver);
    } while (!vote.converged && !vote.diverged && record->passes < PASSES_MAX);
    solver_destroy(solver);
    octree_destroy(octree);
}

/* Numbers the children. Returns how many links the pass begins with. */
static int64_t number_children(struct record *record, int64_t begin, int64_t end)
{
    int64_t roots = end - begin;
    for (int64_t i = begin; i < end; i++)
        roots -= record->splits[i].children;
    for (int64_t i = begin, next = begin + roots; i < end; i++) {
        record->splits[i].first_child = next;
        next += record->splits[i].children;
    }
    return roots;
}

/* --- replay --- */

static void put(struct pile *pile, int64_t item)
{
    RESERVE(pile->items, &pile->capacity, pile->count + 1);
    pile->items[pile->count++] = item;
}

/* As load_balance() in mpi/refinement.c: each rank keeps the order of links that stay;
 * those that come, come behind them. Returns the most bytes that a rank sends. */
static int64_t deal(const struct record *record, dealing *rule, struct pile *piles,
                    int ranks, const int64_t *all)
{
    struct pile *arriving = alloc_array((size_t)ranks, sizeof *arriving);
    int64_t most = 0;
    for (int r = 0; r < ranks; r++) {
        int64_t count = piles[r].count, kept = 0;
        int64_t *costs = alloc_array((size_t)count, sizeof *costs);
        int *destination = alloc_array((size_t)count, sizeof *destination);
        for (int64_t i = 0; i < count; i++)
            costs[i] = record->splits[piles[r].items[i]].load;
        rule((struct loads){all, ranks, r}, costs, count, destination);
        for (int64_t i = 0; i < count; i++) {
            if (destination[i] == r)
                piles[r].items[kept++] = piles[r].items[i];
            else
                put(&arriving[destination[i]], piles[r].items[i]);
        }
        most = BYTES_PER_LINK * (count - kept) > most ? BYTES_PER_LINK * (count - kept)
                                                      : most;
        piles[r].count = kept;
        alloc_free(destination);
        alloc_free(costs);
    }
    for (int r = 0; r < ranks; r++) {
        for (int64_t i = 0; i < arriving[r].count; i++)
            put(&piles[r], arriving[r].items[i]);
        alloc_free(arriving[r].items);
    }
    alloc_free(arriving);
    return most;
}

/* Splits the links of a rank; their children take their place. Returns the work. */
static int64_t split(const struct record *record, struct pile *pile)
{
    struct pile next = {0};
    int64_t work = 0;
    for (int64_t i = 0; i < pile->count; i++) {
        const struct split *split = &record->splits[pile->items[i]];
        work += split->work;
        for (int64_t child = 0; child < split->children; child++)
            put(&next, split->first_child + child);
    }
    alloc_free(pile->items);
    *pile = next;
    return work;
}

/* Returns the number of links of a level. */
static int64_t find_loads(const struct record *record, const struct pile *piles,
                          int ranks, int64_t *loads)
{
    int64_t links = 0;
    for (int r = 0; r < ranks; r++) {
        loads[r] = 0;
        for (int64_t i = 0; i < piles[r].count; i++)
            loads[r] += record->splits[piles[r].items[i]].load;
        links += piles[r].count;
    }
    return links;
}

static void replay_pass(struct record *record, const struct criterion *criterion,
                        int pass, int ranks, struct tally *totals)
{
    int64_t at = record->pass_at[pass];
    int64_t links = number_children(record, at, record->pass_at[pass + 1]);
    struct pile *piles = alloc_array((size_t)ranks, sizeof *piles);
    int64_t *loads = alloc_array((size_t)ranks, sizeof *loads);
    for (int64_t i = 0; i < links; i++)
        put(&piles[i % ranks], at + i);
    while (find_loads(record, piles, ranks, loads) > 0) {
        int64_t slowest = 0;
        if (DEALINGS[criterion->balance])
            totals->bytes +=
                deal(record, DEALINGS[criterion->balance], piles, ranks, loads);
        for (int r = 0; r < ranks; r++) {
            int64_t work = split(record, &piles[r]);
            totals->dealt += work;
            slowest = work > slowest ? work : slowest;
        }
        totals->slowest += slowest;
    }
    alloc_free(loads);
    for (int r = 0; r < ranks; r++)
        alloc_free(piles[r].items);
    alloc_free(piles);
}

int main(int argc, char **argv)
{
    struct comm comm;
    struct options options = {0};
    struct error error = {0};
    struct record record = {0};
    comm_start(&comm, &argc, &argv);
    struct scene *scene = NULL;
    if (argc < 3 || !options_parse(&options, argc - 1, argv + 1, &error) ||
        !(scene = scene_read((struct reading){.path = options.scene}, &error))) {
        fprintf(stderr, "replay RANKS[,RANKS...] SCENE [OPTIONS of phr] %s\n",
                error.text);
        return EXIT_FAILURE;
    }
    record_run(&comm, scene, &options.criterion, &record);
    for (char *ranks = strtok(argv[1], ","); ranks; ranks = strtok(NULL, ",")) {
        struct tally totals = {0};
        for (int pass = 0; pass < record.passes; pass++)
            replay_pass(&record, &options.criterion, pass, atoi(ranks), &totals);
        printf("%s %lld %lld %lld\n", ranks, (long long)totals.dealt,
               (long long)totals.slowest, (long long)totals.bytes);
    }
    alloc_free(record.splits);
    scene_destroy(scene);
    options_free(&options);
    comm_stop(&comm);
    return EXIT_SUCCESS;
}
