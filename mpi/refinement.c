/* Step 4: Algorithm 1 of the paper, line by line in refine() below.
 *
 * Links are split breadth first: all links to be split make a level, are dealt to the
 * ranks (mpi/balance.h) and split; those of their children to be split too make the next
 * level. (Depth first, a link split down to the deepest level keeps one rank busy.)
 *
 * A level begins with one exchange: of loads, the first two steps of LoadBalance, and of
 * counts by which all ranks decide alike whether there is a level, and room for its links
 * (mpi/memory.h). At the end new links settle (mpi/assign.c). */
#include "mpi/balance.h"
#include "mpi/memory.h"
#include "mpi/migrate.h"
#include "geom/signals.h"

#include "geom/alloc.h"

/* --- before a level --- */

/* Counts of a rank before a level. */
struct level_counts {
    int64_t prolific;   /* links to be split */
    int64_t of_patches; /* of these, links with a patch on a side */
    int64_t load;       /* predicted work of the splits, in tests */
    int64_t kept;       /* links not to be split */
    int64_t made;       /* patches made and not shared by the rank */
    int64_t stop;       /* signal of the rank, 0: none */
};

/* A level of Algorithm 1, on one rank. */
struct level {
    struct level_counts all; /* sums over ranks; `stop`: the largest */
    int64_t *loads;          /* [ranks] predicted work of each before links move */
    struct phase_work phase;
    int64_t work;            /* of this rank before the splits, tests */
};

/* Predicted work of splitting links, in tests: their costs (Sec. 3.3.1). */
static int64_t load_of_all(const struct link_list *list)
{
    int64_t load = 0;
    for (int64_t i = 0; i < list->count; i++)
        load += (int64_t)link_cost(&list->items[i]);
    return load;
}

static struct level_counts count_level(const struct solver *solver,
                                       const struct link_list *prolific)
{
    struct level_counts own = {.prolific = prolific->count,
                               .load = load_of_all(prolific),
                               .kept = solver->links.count,
                               .made = solver->model.forest->count - solver->turn.shared,
                               .stop = signals_seen()};
    for (int64_t i = 0; i < prolific->count; i++) {
        const struct link *link = &prolific->items[i];
        own.of_patches += link->p >= 0 || link->q >= 0; /* below 0: a cluster */
    }
    return own;
}

/* Collective. The first two steps of LoadBalance (Sec. 3.3.2): each rank sums the costs
 * of its links, and all learn all loads. Waiting is idle time. */
static void exchange_loads(struct solver *solver, const struct link_list *prolific,
                           struct level *level)
{
    const struct comm *comm = solver->comm;
    struct level_counts own = count_level(solver, prolific), *all = &level->all;
    account_begin(&solver->account, PHASE_IDLE);
    struct level_counts *each = comm_gather_each(comm, &own, sizeof own);
    account_end(&solver->account, PHASE_IDLE);
    *all = (struct level_counts){0};
    for (int r = 0; r < comm->size; r++) {
        level->loads[r] = each[r].load;
        all->prolific += each[r].prolific;
        all->of_patches += each[r].of_patches;
        all->kept += each[r].kept;
        all->made += each[r].made;
        all->stop = each[r].stop > all->stop ? each[r].stop : all->stop;
    }
    if (all->stop > solver->turn.stop)
        solver->turn.stop = (int)all->stop;
    alloc_free(each);
}

/* All ranks learn which patches were split here: the trees are the same everywhere before
 * light is transferred, since a link deals light to the children of a patch, if there are
 * any. */
static void share_splits(struct solver *solver)
{
    struct forest *forest = solver->model.forest;
    const struct comm *comm = solver->comm;
    account_begin(&solver->account, PHASE_SCATTER);
    int64_t count = 0;
    int64_t made = forest->count - solver->turn.shared;
    struct patch_id *split = alloc_array((size_t)made / 4, sizeof *split);
    for (int64_t p = solver->turn.shared; p < forest->count; p += 4)
        split[count++] = forest->patches[p].id;
    int64_t number;
    struct patch_id *all =
        comm_gather_all(comm, split, count, sizeof *split, &number);
    for (int64_t i = 0; i < number; i++)
        forest_reach(forest, all[i]);
    solver->turn.shared = forest->count;
    solver->account.bytes[CARGO_LIGHT] += (number - count) * (int64_t)sizeof *split;
    alloc_free(all);
    alloc_free(split);
    account_end(&solver->account, PHASE_SCATTER);
}

/* A link being split and its four children. */
enum { LINKS_PER_SPLIT = 5 };

/* Collective. True if the memory limit lets the level be split. Ranks may have made the
 * same patches: only without room for all are patches shared and counted. */
static bool level_fits(struct solver *solver, const struct level_counts *level)
{
    const struct memory *memory = &solver->memory;
    int64_t links = level->kept + LINKS_PER_SPLIT * level->prolific;
    int64_t split = level->of_patches, patches = solver->turn.shared + level->made;
    if (memory_has_room(memory, links, split, patches))
        return true;
    share_splits(solver);
    return memory_has_room(memory, links, split, solver->turn.shared);
}

/* Collective. True if there is another level: a rank has a link to split. A signal ends
 * refinement, and so does the memory limit. */
static bool begin_level(struct solver *solver, const struct link_list *prolific,
                        struct level *level)
{
    exchange_loads(solver, prolific, level);
    if (solver->turn.stop || level->all.prolific == 0)
        return false;
    if (!level_fits(solver, &level->all)) {
        solver->memory.reached = solver->memory.limit;
        return false;
    }
    level->phase = (struct phase_work){.kind = WORK_SPLITTING,
                                       .pass = solver->turn.pass,
                                       .level = level->phase.level + 1};
    progress_begin(solver->progress, "refining", level->phase.level, level->all.prolific);
    return true;
}

/* Where the links of this rank go: steps 3 and 4 of Sec. 3.3.2. */
static int *deal_links(const struct solver *solver, const struct link_list *prolific,
                       const int64_t *loads)
{
    size_t count = (size_t)prolific->count;
    int64_t *costs = alloc_array(count, sizeof *costs);
    int *destination = alloc_array(count, sizeof *destination);
    for (size_t i = 0; i < count; i++)
        costs[i] = (int64_t)link_cost(&prolific->items[i]);
    DEALINGS[solver->model.criterion.balance](
        (struct loads){loads, solver->comm->size, solver->comm->rank}, costs,
        prolific->count, destination);
    alloc_free(costs);
    return destination;
}

/* Collective. LoadBalance of Algorithm 1, once the loads are known. */
static void load_balance(struct solver *solver, struct link_list *prolific,
                         struct level *level)
{
    account_begin(&solver->account, PHASE_MIGRATION);
    struct level_share *share = &level->phase.share;
    share->load = level->loads[solver->comm->rank];
    if (DEALINGS[solver->model.criterion.balance] && solver->comm->size > 1) {
        int *destination = deal_links(solver, prolific, level->loads);
        struct traffic traffic = links_migrate(solver, prolific, destination);
        share->sent = traffic.sent;
        share->received = traffic.received;
        level->phase.bytes = BYTES_PER_WIRE_LINK * traffic.sent;
        alloc_free(destination);
    }
    solver_learn(solver, prolific, true);
    share->predicted = load_of_all(prolific);
    level->work = model_work(&solver->model);
    account_end(&solver->account, PHASE_MIGRATION);
    account_begin(&solver->account, PHASE_REFINEMENT);
}

/* --- step 4 --- */

/* Begins a pass: renews the bounds on light for refinement. */
static void begin_pass(struct solver *solver)
{
    account_begin(&solver->account, PHASE_REFINEMENT);
    account_begin(&solver->account, PHASE_PREPARE);
    solver->turn.pass++;
    solver->turn.fresh = true;
    solver->turn.split_here = 0;
    solver->turn.first_new = solver->turn.shared = solver->model.forest->count;
    if (solver->steps.prepare)
        solver->steps.prepare(solver);
    account_end(&solver->account, PHASE_PREPARE);
    account_end(&solver->account, PHASE_REFINEMENT);
}

/* True before link i of a level, unless there is none or a signal has come. */
static bool goes_on(struct solver *solver, const struct link_list *prolific, int64_t i)
{
    if (i == prolific->count)
        return false;
    if (i % 64 != 0)
        return true;
    progress_tick(solver->progress, (double)i / (double)prolific->count);
    return signals_seen() == 0;
}

/* Lets a new link not to be split join those that carry light. `divides`: its patches may
 * get children. */
static void keep_link(struct solver *solver, struct link *link, bool divides)
{
    const struct method *method = &solver->model.method;
    if (method->keep_link)
        method->keep_link(&solver->model, link);
    if (method->divide && divides)
        method->divide(&solver->model, link);
    link_list_append(&solver->links, *link);
}

/* Enters a level into the ledger; the children to be split make the next one. */
static void end_level(struct solver *solver, struct link_list *prolific,
                      struct link_list *next, struct level *level)
{
    level->phase.share.links = prolific->count;
    level->phase.share.done = model_work(&solver->model) - level->work;
    ledger_add(&solver->account.ledger, level->phase);
    solver->turn.split_here += prolific->count;
    link_list_free(prolific);
    *prolific = *next;
    *next = (struct link_list){0};
    account_end(&solver->account, PHASE_REFINEMENT);
}

/* Evaluates a link: true if it should be subdivided. */
static bool is_prolific(const struct solver *solver, const struct link *link)
{
    return solver->model.method.side_to_split(&solver->model, link) != NODE_NONE;
}

/* Moves the links to be split from the rank's links to `prolific`. In the first pass the
 * others are new, too. */
static void select_prolific(struct solver *solver, struct link_list *prolific)
{
    struct model *model = &solver->model;
    int64_t kept = 0;
    account_begin(&solver->account, PHASE_REFINEMENT);
    account_begin(&solver->account, PHASE_LOOKS);
    account_work(&solver->account, WORK_LOOKS, solver->links.count, 0);
    for (int64_t i = 0; i < solver->links.count; i++) {
        struct link link = solver->links.items[i];
        if (is_prolific(solver, &link)) {
            link_list_append(prolific, link);
            continue;
        }
        if (model->method.keep_link && solver->turn.pass == 1)
            model->method.keep_link(model, &link);
        if (model->method.divide)
            model->method.divide(model, &link);
        solver->links.items[kept++] = link;
    }
    solver->links.count = solver->turn.settled = kept;
    account_end(&solver->account, PHASE_LOOKS);
    account_end(&solver->account, PHASE_REFINEMENT);
}

/* Collective. Algorithm 1, its lines as comments: `solver->links` are allInteractions,
 * `prolific` prolificInteractions, `next` newInteractions. */
static void refine(struct solver *solver, struct link_list *prolific, struct level *level)
{
    struct model *model = &solver->model;
    struct link children[METHOD_CHILDREN_MAX];
    struct link_list next = {0};
    /* for all interaction in allInteractions do
     *   Evaluate interaction
     *   if interaction should be subdivided then
     *     Remove interaction from allInteractions
     *     Add interaction to prolificInteractions */
    select_prolific(solver, prolific);
    /* while prolificInteractions not empty do
     *   newInteractions <- empty list */
    while (begin_level(solver, prolific, level)) {
        /* LoadBalance(prolificInteractions) */
        load_balance(solver, prolific, level);
        /* for all interaction in prolificInteractions do */
        int64_t i = 0;
        for (; goes_on(solver, prolific, i); i++) {
            /* Subdivide interaction and its associated patches */
            const struct link *link = &prolific->items[i];
            int32_t side = model->method.side_to_split(model, link);
            int count = model->method.split_link(model, link, side, children);
            /* for all newInteraction in children of interaction do */
            for (int k = 0; k < count; k++) {
                /* Evaluate newInteraction
                 * if newInteraction should be subdivided then */
                if (is_prolific(solver, &children[k]))
                    /* Add newInteraction to newInteractions */
                    link_list_append(&next, children[k]);
                else
                    /* Add newInteraction to allInteractions */
                    keep_link(solver, &children[k], true);
            }
        }
        for (; i < prolific->count; i++) /* after a signal */
            link_list_append(&next, prolific->items[i]);
        /* prolificInteractions <- newInteractions */
        end_level(solver, prolific, &next, level);
    }
}

/* Collective. The links left unsplit by the memory limit or a signal join the others, and
 * divide no patch. At the end all ranks agree on whether a signal has come meanwhile. */
static void keep_unsplit(struct solver *solver, struct link_list *prolific,
                         struct level *level)
{
    for (int64_t i = 0; i < prolific->count; i++)
        keep_link(solver, &prolific->items[i], false);
    exchange_loads(solver, prolific, level);
}

bool solver_refine(struct solver *solver)
{
    struct memory *memory = &solver->memory;
    struct link_list prolific = {0};
    struct level level = {.phase.level = -1};
    begin_pass(solver);
    if (memory->limit > 0 && memory->reached == memory->limit)
        return true;
    memory->reached = 0;
    level.loads = alloc_array((size_t)solver->comm->size, sizeof *level.loads);
    refine(solver, &prolific, &level);
    if (memory->reached || solver->turn.stop)
        keep_unsplit(solver, &prolific, &level);
    alloc_free(level.loads);
    link_list_free(&prolific);
    share_splits(solver);
    solver_settle_links(solver);
    solver->turn.pass -= solver->turn.stop != 0;
    return !solver->turn.stop;
}
