/* Collecting and restoring a run's snapshot.
 *
 * A snapshot is taken between passes, of a solution made whole: all ranks have the same
 * trees with the same radiosities. Not kept are the quantities computed anew by every
 * pass: fluxes, directions of conjugate residuals (started afresh by each pass), inner
 * radiosities and ranges, and proofs of open leaves, for which rays are fired again.
 *
 * Links are renumbered in place (patches depth first, as in forest_order()), sorted,
 * merged on rank 0, and given their local numbers back: no copy of them is made, since a
 * checkpoint is wanted most where memory is short. (So links are sorted here: many a
 * qsort() makes a copy.) On reading, every block of links is sent to all ranks, to be
 * taken in turn; homes are found once all links are there. */
#include "mpi/beyond/beyond.h"
#include "mpi/beyond/keep.h"

#include "geom/alloc.h"
#include "mpi/beyond/funnel.h"

enum { BLOCK = 4096 };

/* --- collecting --- */

static void collect_trees(const struct solver *solver, const int32_t *order,
                          struct snapshot *snapshot)
{
    int64_t leaf = 0;
    for (int64_t i = 0; i < snapshot->patch_count; i++) {
        const struct patch *patch = &solver->model.forest->patches[order[i]];
        snapshot->split[i] = !patch_is_leaf(patch);
        if (patch_is_leaf(patch))
            snapshot->leaves[leaf++] = solver->model.forest->radiosity[order[i]];
    }
}

static void collect_numbers(const struct solver *solver, const struct vote *vote,
                            struct snapshot *snapshot)
{
    const struct model *model = &solver->model;
    int64_t sums[] = {solver->links.count, model->counts.rays, model->counts.node_tests,
                      model->counts.triangle_tests, model->walled_off,
                      model->rays_spared};
    comm_add(solver->comm, sums, sizeof sums / sizeof sums[0]);
    snapshot->link_count = sums[0];
    for (int i = 0; i < 5; i++)
        snapshot->number[SNAPSHOT_RAYS + i] = sums[1 + i];
    snapshot->number[SNAPSHOT_PASSES] = solver->turn.pass;
    snapshot->number[SNAPSHOT_ITERATIONS] = solver->turn.iteration;
    snapshot->number[SNAPSHOT_SETTLED] = vote->settled;
    snapshot->number[SNAPSHOT_LIMITED] = solver->memory.reached;
    snapshot->number[SNAPSHOT_ROUNDS] = solver->beyond->accuracy.rounds;
    snapshot->number[SNAPSHOT_GATHER] = model->criterion.final_gather;
    snapshot->value[SNAPSHOT_REMAINING] = vote->remaining;
    snapshot->value[SNAPSHOT_ABSORBED] = vote->absorbed;
    snapshot->value[SNAPSHOT_ESCAPED] = vote->escaped;
    snapshot->value[SNAPSHOT_EPSILON] = model->criterion.epsilon;
    snapshot->value[SNAPSHOT_COARSE] = solver->beyond->accuracy.coarse;
    snapshot->value[SNAPSHOT_COARSE_EPSILON] = solver->beyond->accuracy.coarse_epsilon;
}

void snapshot_collect(struct solver *solver, const struct vote *vote,
                      struct snapshot *snapshot)
{
    struct forest *forest = solver->model.forest;
    bool collects = solver->comm->rank == 0;
    beyond_attach(solver);
    solver_complete(solver);
    int32_t *order = forest_order(forest);
    *snapshot = (struct snapshot){
        .root_count = forest->root_count,
        .patch_count = collects ? forest->count : forest->root_count};
    snapshot_allocate(snapshot);
    collect_numbers(solver, vote, snapshot);
    if (collects)
        collect_trees(solver, order, snapshot);
    alloc_free(order);
}

/* --- collecting links --- */

static bool is_before(const struct link *a, const struct link *b)
{
    return a->p != b->p ? a->p < b->p : a->q < b->q;
}

static void swap_links(struct link *a, struct link *b)
{
    struct link kept = *a;
    *a = *b;
    *b = kept;
}

/* Heapsort: moves the link at `i` down to where it belongs among the first `count`. */
static void sift_down(struct link *links, int64_t i, int64_t count)
{
    for (int64_t child = 2 * i + 1; child < count; child = 2 * i + 1) {
        child += child + 1 < count && is_before(&links[child], &links[child + 1]);
        if (!is_before(&links[i], &links[child]))
            return;
        swap_links(&links[i], &links[child]);
        i = child;
    }
}

static void sort_links(struct link *links, int64_t count)
{
    for (int64_t i = count / 2 - 1; i >= 0; i--)
        sift_down(links, i, count);
    for (int64_t last = count - 1; last > 0; last--) {
        swap_links(&links[0], &links[last]);
        sift_down(links, 0, last);
    }
}

/* Rank 0: merges the sorted links of all ranks. */
static void merge(struct funnel *funnel, link_sink *sink, void *context)
{
    struct link *block = alloc_array(BLOCK, sizeof *block);
    int *owners = alloc_array(BLOCK, sizeof *owners);
    int64_t count = 0;
    for (;;) {
        int first = -1;
        const struct link *least = NULL;
        for (int r = 0; r < funnel->comm->size; r++) {
            const struct link *link = funnel_next(funnel, r);
            if (link && (!least || is_before(link, least))) {
                least = link;
                first = r;
            }
        }
        if (least) {
            owners[count] = first;
            block[count++] = *least;
            funnel->spouts[first].at++;
        }
        if (count == BLOCK || !least) {
            sink(context, block, owners, count);
            count = 0;
        }
        if (!least)
            break;
    }
    alloc_free(owners);
    alloc_free(block);
}

/* Gives the patches of a link their numbers. */
static void renumber_link(struct link *link, const int32_t *number)
{
    link->p = node_is_cluster(link->p) ? link->p : number[link->p];
    link->q = node_is_cluster(link->q) ? link->q : number[link->q];
}

static void renumber(struct link_list *list, const int32_t *number)
{
    for (int64_t i = 0; i < list->count; i++)
        renumber_link(&list->items[i], number);
}

void links_collect(struct solver *solver, link_sink *sink, void *context)
{
    const struct forest *forest = solver->model.forest;
    int32_t *order = forest_order(forest);
    int32_t *number = alloc_array((size_t)forest->count, sizeof *number);
    for (int64_t i = 0; i < forest->count; i++)
        number[order[i]] = (int32_t)i;
    renumber(&solver->links, number);
    sort_links(solver->links.items, solver->links.count);
    struct funnel funnel;
    funnel_start(&funnel, solver->comm, solver->links.items, solver->links.count,
                 sizeof *solver->links.items);
    if (solver->comm->rank == 0)
        merge(&funnel, sink, context);
    funnel_end(&funnel);
    renumber(&solver->links, order);
    link_list_sort(&solver->links);
    alloc_free(number);
    alloc_free(order);
}

/* --- restoring --- */

/* Rank 0's snapshot goes to all. */
static void broadcast_snapshot(const struct comm *comm, struct snapshot *snapshot)
{
    struct snapshot head = *snapshot;
    comm_broadcast(comm, &head, sizeof head);
    if (comm->rank != 0) {
        *snapshot = head;
        snapshot_allocate(snapshot);
    }
    comm_broadcast(comm, snapshot->split, (size_t)snapshot->patch_count);
    comm_broadcast(comm, snapshot->leaves,
                   (size_t)snapshot_leaf_count(snapshot) * sizeof *snapshot->leaves);
}

/* Splits patches as in the snapshot, depth first: in the same order on all ranks. */
static void restore_trees(struct forest *forest, const struct snapshot *snapshot)
{
    int64_t i = 0;
    for (int32_t root = 0; root < forest->root_count; root++)
        for (int32_t p = root; p >= 0; p = forest_next(forest, p, true))
            if (snapshot->split[i++])
                forest_split(forest, p);
}

static void restore_leaves(struct forest *forest, const struct snapshot *snapshot,
                           const int32_t *order)
{
    int64_t leaf = 0;
    for (int64_t i = 0; i < forest->count; i++) {
        int32_t p = order[i];
        if (!patch_is_leaf(&forest->patches[p]))
            continue;
        forest->radiosity[p] = snapshot->leaves[leaf++];
    }
    forest_average(forest);
}

/* Counts the work so far as rank 0's. */
static void restore_numbers(struct solver *solver, struct vote *vote,
                            const struct snapshot *snapshot)
{
    struct model *model = &solver->model;
    const int64_t *number = snapshot->number;
    if (solver->comm->rank == 0) {
        model->counts = (struct octree_counts){number[SNAPSHOT_RAYS],
            number[SNAPSHOT_NODE_TESTS], number[SNAPSHOT_TRIANGLE_TESTS]};
        model->walled_off = number[SNAPSHOT_WALLED_OFF];
        model->rays_spared = number[SNAPSHOT_RAYS_SPARED];
    }
    solver->turn.pass = number[SNAPSHOT_PASSES];
    solver->turn.iteration = number[SNAPSHOT_ITERATIONS];
    int64_t limited = number[SNAPSHOT_LIMITED];
    solver->memory.reached = limited == solver->memory.limit ? limited : 0;
    solver->beyond->accuracy = (struct accuracy){
        .rounds = number[SNAPSHOT_ROUNDS],
        .coarse = snapshot->value[SNAPSHOT_COARSE],
        .coarse_epsilon = snapshot->value[SNAPSHOT_COARSE_EPSILON]};
    if (model->criterion.accuracy > 0.0 && number[SNAPSHOT_GATHER] > 0) {
        model->criterion.final_gather = (int)number[SNAPSHOT_GATHER];
        solver->memory.rays = model->criterion.final_gather;
    }
    if (solver->turn.pass > 0) /* a link cache, before the first pass, has no epsilon */
        model_set_epsilon(model, snapshot->value[SNAPSHOT_EPSILON]);
    bool may_end = solver->turn.pass > 0 && limited == solver->memory.reached;
    *vote = (struct vote){
        .settled = number[SNAPSHOT_SETTLED] != 0 && may_end,
        .links = snapshot->link_count,
        .remaining = snapshot->value[SNAPSHOT_REMAINING],
        .absorbed = snapshot->value[SNAPSHOT_ABSORBED],
        .escaped = snapshot->value[SNAPSHOT_ESCAPED],
    };
    may_end = model->criterion.solver == SOLVER_JACOBI ? may_end : vote->settled;
    vote->converged = may_end && vote->remaining <= model->criterion.tolerance;
}

int32_t *snapshot_restore(struct solver *solver, struct vote *vote,
                          struct snapshot *snapshot)
{
    struct forest *forest = solver->model.forest;
    broadcast_snapshot(solver->comm, snapshot);
    restore_trees(forest, snapshot);
    beyond_attach(solver);
    int32_t *order = forest_order(forest);
    restore_leaves(forest, snapshot, order);
    restore_numbers(solver, vote, snapshot);
    return order;
}

void links_deal(struct solver *solver, const int32_t *order, struct link *links,
                int64_t count)
{
    comm_broadcast(solver->comm, links, (size_t)count * sizeof *links);
    for (int64_t i = solver->comm->rank; i < count; i += solver->comm->size) {
        renumber_link(&links[i], order);
        link_list_append(&solver->links, links[i]);
    }
}
