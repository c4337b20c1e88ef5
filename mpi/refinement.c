/* Step 4: Algorithm 1 of the paper.
 *
 * `prolific` holds the links of one level that will be split. Before each level the ranks
 * exchange their loads, the sums of predicted costs; each decides alike where links go
 * (mpi/balance.h). Then each rank splits what it has: children that are to be split too
 * form the next level, the others join the links.
 *
 * With --balance greedy, the paper's, a level is dealt once, and ends before the next one
 * begins. Else the ranks work in stages: each splits links, and children of theirs, up to
 * the same amount of work; then all links that are left are dealt anew, and "level"
 * counts stages. Only under --memory M, which has to stop at the same level on any number
 * of ranks, do levels end here too, each after one or more stages.
 *
 * What was split stays where that was done; light is transferred over links where they
 * are. So at the end their numbers are evened out, but for --balance greedy.
 *
 * Predicted cost and work of each stage of a level go into the ledger (mpi/ledger.h). */
#include "mpi/beyond/beyond.h"
#include "mpi/balance.h"
#include "mpi/memory.h"
#include "mpi/migrate.h"
#include "mpi/signals.h"

#include <string.h>

#include "geom/alloc.h"
#include "rad/oracle.h"

/* Counts before a stage, of a rank or of all together. */
struct level {
    int64_t prolific;   /* links that are to be split */
    int64_t of_patches; /* of these, links with a patch in them */
    int64_t load;       /* predicted work of splitting them, in tests */
    int64_t kept;       /* links that are not to be split */
    int64_t made;       /* patches that ranks have made and not shared */
    int64_t stop;       /* the largest signal that a rank has got, 0: none */
};

static int64_t count_of_patches(const struct link_list *list)
{
    int64_t count = 0;
    for (int64_t i = 0; i < list->count; i++)
        count += !node_is_cluster(list->items[i].p) || !node_is_cluster(list->items[i].q);
    return count;
}

static int64_t load_of(const struct link_list *list)
{
    int64_t load = 0;
    for (int64_t i = 0; i < list->count; i++)
        load += link_load(&list->items[i]);
    return load;
}

/* Moves the links that are to be split from the rank's links to `prolific`. */
static void select_prolific(struct solver *solver, struct link_list *prolific)
{
    int64_t kept = 0;
    double start = comm_seconds();
    struct phase_work looks = {.kind = WORK_LOOKS, .iteration = solver->turn.pass,
                               .work = solver->links.count};
    for (int64_t i = 0; i < solver->links.count; i++) {
        struct link link = solver->links.items[i];
        if (node_to_split(&solver->model, &link) != NODE_NONE) {
            link_list_append(prolific, link);
            continue;
        }
        node_divide_patches(&solver->model, &link);
        solver->links.items[kept++] = link;
    }
    solver->links.count = kept;
    ledger_add(&solver->account.ledger, looks);
    solver->account.seconds[PHASE_LOOKS] += comm_seconds() - start;
}

/* LoadBalance of Algorithm 1: first the total exchange of loads. loads[r] becomes the
 * predicted work of rank r. Waiting is idle time. */
static struct level exchange_loads(struct solver *solver,
                                   const struct link_list *prolific, int64_t *loads)
{
    const struct comm *comm = solver->comm;
    struct level own = {.prolific = prolific->count,
                        .of_patches = count_of_patches(prolific),
                        .load = load_of(prolific),
                        .kept = solver->links.count,
                        .made = solver->model.forest->count - solver->turn.shared,
                        .stop = signals_seen()};
    double start = comm_seconds();
    struct level *levels = comm_gather_each(comm, &own, sizeof own), all = {0};
    solver->account.seconds[PHASE_IDLE] += comm_seconds() - start;
    for (int r = 0; r < comm->size; r++) {
        loads[r] = levels[r].load;
        all.prolific += levels[r].prolific;
        all.of_patches += levels[r].of_patches;
        all.load += levels[r].load;
        all.kept += levels[r].kept;
        all.made += levels[r].made;
        all.stop = levels[r].stop > all.stop ? levels[r].stop : all.stop;
    }
    solver->turn.stop = (int)all.stop > solver->turn.stop ? (int)all.stop : solver->turn.stop;
    alloc_free(levels);
    return all;
}

/* Then links move. Returns the bytes sent. */
static int64_t deal_links(struct solver *solver, struct link_list *links,
                          const int64_t *loads)
{
    if (!moving_pays(
            loads, solver->comm->size)) /* the same on all ranks, so all enter, or none */
        return 0;
    double start = comm_seconds();
    int64_t bytes = links_balance(solver, links, link_load, loads);
    solver->account.bytes_migration += bytes;
    solver->account.seconds[PHASE_MIGRATION] += comm_seconds() - start;
    return bytes;
}

/* Splits a link; its children go to `next` or to the rank's links. */
static void split_link(struct solver *solver, const struct link *link,
                       struct link_list *next)
{
    struct model *model = &solver->model;
    struct link children[NODE_CHILDREN_MAX];
    int64_t before = model_work(model), waiting = next->count;
    int count = node_link_split(model, link, node_to_split(model, link), children);
    for (int k = 0; k < count; k++) {
        bool goes_on = node_to_split(model, &children[k]) != NODE_NONE;
        if (!goes_on)
            node_link_settle(model, &children[k]);
        link_list_append(goes_on ? next : &solver->links, children[k]);
    }
    if (solver->account.watch)
        solver->account.watch(solver->account.watcher, link_load(link), model_work(model) - before,
                      next->count - waiting);
}

/* Splits links until their work has reached the limit, or a signal has come; the others
 * stay. `next` may be `links`: then children go to its end. `part`: left of the level. */
static void split_stage(struct solver *solver, struct link_list *links, double part,
                        int64_t limit, struct link_list *next, struct phase_work *phase)
{
    double start = comm_seconds(), count = (double)links->count;
    int64_t before = model_work(&solver->model), done = 0;
    phase->predicted = 0;
    for (; done < links->count && model_work(&solver->model) - before < limit; done++) {
        if (done % 64 == 0) {
            double left = real_max(0.0, count - (double)done);
            progress_tick(solver->progress, 1.0 - part * left / count);
            if (signals_seen())
                break;
        }
        struct link link = links->items[done];
        phase->predicted += link_load(&link);
        split_link(solver, &link, next);
    }
    links->count -= done;
    if (links->count > 0)
        memmove(links->items, links->items + done,
                (size_t)links->count * sizeof *links->items);
    solver->turn.split_here += done;
    phase->links = done;
    phase->work = model_work(&solver->model) - before;
    ledger_add(&solver->account.ledger, *phase);
    solver->account.seconds[PHASE_REFINEMENT] += comm_seconds() - start;
}

/* True if a level ends before the next one begins: the paper's do, and under a memory
 * limit of the user (mpi/memory.h) all do. */
static bool levels_end(const struct solver *solver)
{
    const struct memory *memory = &solver->memory;
    return solver->model.criterion.balance == BALANCE_GREEDY ||
           (memory->limit > 0 && memory->copies == 1);
}

/* Splits all links of a level and puts their children in their place; where levels do not
 * end, splits the links of one stage. loads[r]: as exchanged. */
static void split_level(struct solver *solver, struct link_list *links,
                        struct phase_work phase, int64_t *loads)
{
    bool ends = levels_end(solver), again = true;
    struct link_list next = {0};
    double part = 1.0;
    while (again) {
        int64_t limit = solver->model.criterion.balance == BALANCE_GREEDY
                            ? INT64_MAX : links_limit(loads, solver->comm->size);
        phase.bytes = deal_links(solver, links, loads);
        double count = (double)links->count;
        split_stage(solver, links, part, limit, ends ? &next : links, &phase);
        part *= count > 0.0 ? (double)links->count / count : 1.0;
        again = ends && limit < INT64_MAX &&
                exchange_loads(solver, links, loads).prolific > 0 && !solver->turn.stop;
    }
    if (ends) {
        link_list_free(links);
        *links = next;
    }
}

/* All ranks learn which patches were split here: the trees are the same everywhere before
 * light is transferred, since a link deals light to the children of a patch, if there are
 * any. */
static void share_splits(struct solver *solver)
{
    struct forest *forest = solver->model.forest;
    const struct comm *comm = solver->comm;
    double start = comm_seconds();
    int64_t count = 0;
    struct patch_id *split = alloc_array((size_t)(forest->count - solver->turn.shared) / 4,
                                         sizeof *split);
    for (int64_t p = solver->turn.shared; p < forest->count; p += 4)
        split[count++] = forest->patches[p].id;
    int *at = alloc_array((size_t)comm->size + 1, sizeof *at);
    uint8_t *all = comm_gather_all(comm, split, count * (int64_t)sizeof *split, at);
    for (int i = 0; i < at[comm->size]; i += (int)sizeof *split) {
        struct patch_id id;
        memcpy(&id, all + i, sizeof id);
        forest_reach(forest, id);
    }
    solver->turn.shared = forest->count;
    solver->account.bytes_scatter += at[comm->size] - count * (int64_t)sizeof *split;
    alloc_free(all);
    alloc_free(at);
    alloc_free(split);
    solver->account.seconds[PHASE_SCATTER] += comm_seconds() - start;
}

/* A link that is being split and its four children. */
enum { LINKS_PER_SPLIT = 5 };

/* True if there is room for splitting a level, beside this number of patches. */
static bool has_room(const struct solver *solver, const struct level *level,
                     int64_t patches)
{
    int64_t links = level->kept + LINKS_PER_SPLIT * level->prolific;
    return memory_has_room(&solver->memory, links, level->of_patches, patches,
                           solver->beyond->tree ? solver->beyond->tree->count : 0);
}

/* True if the memory limit lets the level be split. Ranks may have made the same patches:
 * only where there is no room for all of them are they shared and counted. */
static bool level_fits(struct solver *solver, const struct level *level)
{
    if (has_room(solver, level, solver->turn.shared + level->made))
        return true;
    share_splits(solver);
    return has_room(solver, level, solver->turn.shared);
}

/* Splits level after level. Returns false if a signal ended that, and links are lost, or
 * the memory limit: then the links that were to be split are in `prolific`. */
static bool split_levels(struct solver *solver, struct link_list *prolific,
                         int64_t *loads)
{
    for (int64_t level = 0;; level++) {
        struct level links = exchange_loads(solver, prolific, loads);
        if (links.prolific == 0 && !solver->turn.stop)
            return true;
        bool fits = solver->turn.stop || level_fits(solver, &links);
        if (!fits)
            solver->memory.reached = solver->memory.limit;
        if (!fits || solver->turn.stop)
            return false;
        progress_begin(solver->progress, "refining", level, links.prolific);
        struct phase_work phase = {.kind = WORK_SPLITTING, .iteration = solver->turn.pass,
                                   .level = level};
        split_level(solver, prolific, phase, loads);
    }
}

/* What refinement reads of the solution so far. */
static void prepare(struct solver *solver)
{
    double start = comm_seconds();
    forest_bound(solver->model.forest);
    if (solver->beyond->tree) {
        cluster_light_pull(solver->model.clusters, solver->model.forest);
        cluster_light_bound(solver->model.clusters, solver->model.forest);
    }
    solver->account.seconds[PHASE_PREPARE] += comm_seconds() - start;
}

static void begin_pass(struct solver *solver)
{
    solver->turn.pass++;
    prepare(solver);
    solver->turn.split_here = 0;
    solver->turn.first_new = solver->turn.shared = solver->model.forest->count;
}

/* --- the first levels --- */

void solver_link_top(struct solver *solver)
{
    link_list_append(&solver->links, node_link_top());
    solver->turn.alike = true;
}

/* Keeps every P-th link. */
static void keep_share(const struct comm *comm, struct link_list *list)
{
    int64_t kept = 0;
    for (int64_t i = comm->rank; i < list->count; i += comm->size)
        list->items[kept++] = list->items[i];
    list->count = kept;
}

/* All ranks have the same links, and split the same ones level by level until there are
 * enough to deal. Then each keeps its share. What all did alike counts once. */
static void split_alike(struct solver *solver, struct link_list *level)
{
    struct model *model = &solver->model;
    struct octree_counts counts = model->counts;
    int64_t before = model_work(model), estimating = model->estimating;
    int64_t spared = model->rays_spared, walled_off = model->walled_off, split = 0;
    for (int64_t i = 0; i < solver->links.count;
         i++) /* the top, if it is not to be split */
        node_link_settle(model, &solver->links.items[i]);
    while (level->count > 0 && !level_is_dealt(level->count)) {
        struct level links = {.prolific = level->count, .kept = solver->links.count,
                              .of_patches = count_of_patches(level)};
        struct link_list next = {0};
        if (!has_room(solver, &links, model->forest->count))
            break;
        for (int64_t i = 0; i < level->count; i++)
            split_link(solver, &level->items[i], &next);
        split += level->count;
        link_list_free(level);
        *level = next;
    }
    struct phase_work phase = {.kind = WORK_LINKING, .links = split,
                               .work = model_work(model) - before};
    ledger_add(&solver->account.ledger, phase);
    keep_share(solver->comm, &solver->links);
    keep_share(solver->comm, level);
    solver->turn.alike = false;
    if (solver->comm->rank == 0) {
        solver->turn.split_here += split;
    } else {
        model->counts = counts;
        model->estimating = estimating;
        model->rays_spared = spared;
        model->walled_off = walled_off;
    }
}

/* The links that the memory limit leaves unsplit join the others. At the end all ranks
 * agree on whether a signal has come meanwhile. */
static void keep_unsplit(struct solver *solver, const struct link_list *prolific,
                         int64_t *loads)
{
    for (int64_t i = 0; i < prolific->count && !(i % 64 == 0 && signals_seen()); i++) {
        struct link link = prolific->items[i];
        node_link_settle(&solver->model, &link);
        link_list_append(&solver->links, link);
    }
    exchange_loads(solver, prolific, loads);
}

bool solver_refine(struct solver *solver)
{
    struct memory *memory = &solver->memory;
    struct link_list prolific = {0};
    double start = comm_seconds();
    bool done = true;
    begin_pass(solver);
    if (memory->limit == 0 || memory->reached != memory->limit) {
        memory->reached = 0;
        select_prolific(solver, &prolific);
        if (solver->turn.alike)
            split_alike(solver, &prolific);
        solver->account.seconds[PHASE_REFINEMENT] += comm_seconds() - start;
        int64_t *loads = alloc_array((size_t)solver->comm->size, sizeof *loads);
        done = split_levels(solver, &prolific, loads);
        if (!done && !solver->turn.stop) /* the same on all ranks */
            keep_unsplit(solver, &prolific, loads);
        alloc_free(loads);
        link_list_free(&prolific);
        share_splits(solver);
    }
    if (solver->model.criterion.balance != BALANCE_GREEDY)
        links_even_out(solver);
    bool stopped = !done && solver->turn.stop != 0;
    solver->turn.pass -= stopped;
    return !stopped;
}
