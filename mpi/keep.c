/* Collecting and restoring a run's progress.
 *
 * Between passes all ranks have the same trees with the same radiosities; what only the home of a
 * leaf knows, its irradiance and its closure factor, goes to rank 0 through a funnel, in the order
 * of the leaves. Not kept is what every pass computes anew: fluxes, bounds on rows, directions of
 * conjugate gradients (each pass starts them afresh), inner radiosities and extremes, and which
 * leaves are enclosed, for which rays are fired again.
 *
 * Links are renumbered in place (patches depth first, as in forest_order()), sorted, merged on rank
 * 0, and given their local numbers back: no copy of them is made, since a checkpoint is wanted most
 * where memory is short. (So they are sorted here: many a qsort() makes a copy.) Reading, every block of links is
 * sent to all ranks, and each takes those that are at home there: rank 0 need not know how many
 * that will be. */
#include "mpi/keep.h"

#include <math.h>

#include "geom/alloc.h"
#include "mpi/funnel.h"

enum { BLOCK = 4096 };

/* --- collecting --- */

/* What only the home of a leaf knows; no padding. */
struct home_state {
    struct rgb irradiance;
    double factor;
};

static bool is_answer(const struct accuracy *accuracy, int32_t p)
{
    return accuracy->before && p < accuracy->count && accuracy->before[p].band[0] < HUGE_VAL;
}

static void collect_trees(const struct solver *solver, const int32_t *order,
                          struct progress *progress)
{
    const struct accuracy *accuracy = &solver->accuracy;
    int64_t leaf = 0, compared = 0;
    for (int64_t i = 0; i < progress->patch_count; i++) {
        const struct patch *patch = &solver->method.forest->patches[order[i]];
        progress->kind[i] = patch_is_leaf(patch) ? 0 : PATCH_SPLIT;
        if (patch_is_leaf(patch))
            progress->leaves[leaf++].radiosity = patch->radiosity;
        if (is_answer(accuracy, order[i])) {
            progress->kind[i] |= PATCH_COMPARED;
            progress->compared[compared++] = accuracy->before[order[i]];
        }
    }
}

/* Rank 0: takes what comes from the homes, leaf by leaf. */
static void place_home_states(const struct solver *solver, const int32_t *order,
                              struct funnel *funnel, struct progress *progress)
{
    int64_t leaf = 0;
    for (int64_t i = 0; i < progress->patch_count; i++) {
        const struct patch *patch = &solver->method.forest->patches[order[i]];
        if (!patch_is_leaf(patch))
            continue;
        int home = solver->owner[patch->id.root];
        const struct home_state *state = funnel_next(funnel, home);
        progress->leaves[leaf].irradiance = state->irradiance;
        progress->leaves[leaf++].factor = state->factor;
        funnel_drop(funnel, home);
    }
}

static void collect_home_states(struct solver *solver, const int32_t *order,
                                struct progress *progress)
{
    const struct forest *forest = solver->method.forest;
    struct home_state *own = NULL;
    int64_t count = 0, capacity = 0;
    for (int64_t i = 0; i < forest->count; i++) {
        int32_t p = order[i];
        if (!patch_is_leaf(&forest->patches[p]) ||
            solver->owner[forest->patches[p].id.root] != solver->comm->rank)
            continue;
        own = alloc_reserve(own, &capacity, count + 1, sizeof *own);
        own[count++] = (struct home_state){solver->conjugate.irradiance[p],
                                           solver->closure.factor[p]};
    }
    struct funnel funnel;
    funnel_start(&funnel, solver->comm, own, count, sizeof *own);
    if (solver->comm->rank == 0)
        place_home_states(solver, order, &funnel, progress);
    funnel_end(&funnel);
    alloc_free(own);
}

static void collect_numbers(const struct solver *solver, const struct vote *vote,
                            struct progress *progress)
{
    const struct method *method = &solver->method;
    int64_t own[] = {solver->links.count, method->counts.rays, method->counts.node_tests,
                     method->counts.triangle_tests, method->walled_off, method->rays_spared};
    int64_t sum[sizeof own / sizeof own[0]];
    MPI_Request request;
    MPI_Iallreduce(own, sum, (int)(sizeof own / sizeof own[0]), MPI_INT64_T, MPI_SUM,
                   solver->comm->handle, &request);
    comm_wait(&request);
    progress->link_count = sum[0];
    for (int i = 0; i < 5; i++)
        progress->number[PROGRESS_RAYS + i] = sum[1 + i];
    progress->number[PROGRESS_PASSES] = solver->pass;
    progress->number[PROGRESS_ITERATIONS] = solver->iteration;
    progress->number[PROGRESS_SETTLED] = vote->settled;
    progress->number[PROGRESS_LIMITED] = solver->memory.reached;
    progress->number[PROGRESS_CHANGE] = solver->last_change;
    progress->value[PROGRESS_REMAINING] = vote->remaining;
    progress->value[PROGRESS_ABSORBED] = vote->absorbed;
    progress->value[PROGRESS_ESCAPED] = vote->escaped;
    progress->value[PROGRESS_EPSILON] = method->criterion.epsilon;
    progress->value[PROGRESS_ESTIMATE] = solver->accuracy.estimate;
    progress->value[PROGRESS_LEAST_BEND] = solver->least_bend;
}

static void collect_root_changes(const struct solver *solver, struct progress *progress)
{
    int32_t roots = solver->method.forest->root_count;
    int64_t *own = alloc_array((size_t)roots, sizeof *own);
    for (int32_t root = 0; root < roots; root++)
        own[root] = solver->own[root] ? solver->root_change[root] : 0;
    MPI_Request request;
    MPI_Iallreduce(own, progress->root_change, roots, MPI_INT64_T, MPI_SUM, solver->comm->handle,
                   &request);
    comm_wait(&request);
    alloc_free(own);
}

void progress_collect(struct solver *solver, const struct vote *vote, struct progress *progress)
{
    struct forest *forest = solver->method.forest;
    bool collects = solver->comm->rank == 0;
    closure_extend(&solver->closure, forest); /* patches that refinement has made since */
    conjugate_extend(&solver->conjugate, forest, solver->own);
    int32_t *order = forest_order(forest);
    *progress = (struct progress){.root_count = forest->root_count,
                                  .patch_count = collects ? forest->count : forest->root_count};
    for (int64_t p = 0; p < forest->count && collects; p++)
        progress->compared_count += is_answer(&solver->accuracy, (int32_t)p);
    progress_allocate(progress);
    collect_numbers(solver, vote, progress);
    if (collects)
        collect_trees(solver, order, progress);
    collect_home_states(solver, order, progress);
    collect_root_changes(solver, progress);
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
            block[count++] = *least;
            funnel_drop(funnel, first);
        }
        if (count == BLOCK || !least) {
            sink(context, block, count);
            count = 0;
        }
        if (!least)
            break;
    }
    alloc_free(block);
}

static void renumber(struct link_list *list, const int32_t *number)
{
    for (int64_t i = 0; i < list->count; i++) {
        list->items[i].p = number[list->items[i].p];
        list->items[i].q = number[list->items[i].q];
    }
}

void links_collect(struct solver *solver, link_sink *sink, void *context)
{
    const struct forest *forest = solver->method.forest;
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
    alloc_free(number);
    alloc_free(order);
}

/* --- restoring --- */

/* Rank 0's progress goes to all. */
static void broadcast_progress(const struct comm *comm, struct progress *progress)
{
    struct progress head = *progress;
    comm_broadcast(comm, &head, sizeof head);
    if (comm->rank != 0) {
        *progress = head;
        progress_allocate(progress);
    }
    comm_broadcast(comm, progress->root_change,
                   (size_t)progress->root_count * sizeof *progress->root_change);
    comm_broadcast(comm, progress->kind, (size_t)progress->patch_count);
    comm_broadcast(comm, progress->leaves,
                   (size_t)progress_leaf_count(progress) * sizeof *progress->leaves);
    comm_broadcast(comm, progress->compared,
                   (size_t)progress->compared_count * sizeof *progress->compared);
}

/* Splits as in the progress, depth first: patches come to be in the same order on all ranks. */
static void restore_trees(struct forest *forest, const struct progress *progress)
{
    int64_t i = 0;
    for (int32_t root = 0; root < forest->root_count; root++)
        for (int32_t p = root; p >= 0; p = forest_next(forest, p, true))
            if (progress->kind[i++] & PATCH_SPLIT)
                forest_split(forest, p);
}

static void restore_leaves(struct solver *solver, const struct progress *progress,
                           const int32_t *order)
{
    struct forest *forest = solver->method.forest;
    struct accuracy *accuracy = &solver->accuracy;
    int64_t leaf = 0, compared = 0;
    if (progress->compared_count > 0) {
        accuracy->before = alloc_array((size_t)forest->count, sizeof *accuracy->before);
        accuracy->count = forest->count;
    }
    for (int64_t i = 0; i < forest->count; i++) {
        int32_t p = order[i];
        if (patch_is_leaf(&forest->patches[p])) {
            const struct leaf_state *state = &progress->leaves[leaf++];
            forest->patches[p].radiosity = state->radiosity;
            solver->conjugate.irradiance[p] = state->irradiance;
            solver->closure.factor[p] = state->factor;
        }
        if (progress->kind[i] & PATCH_COMPARED)
            accuracy->before[p] = progress->compared[compared++];
        else if (accuracy->before)
            accuracy->before[p].band[0] = HUGE_VAL;
    }
    forest_pull(forest);
}

/* The work so far is put down to rank 0. */
static void restore_numbers(struct solver *solver, struct vote *vote,
                            const struct progress *progress)
{
    struct method *method = &solver->method;
    const int64_t *number = progress->number;
    if (solver->comm->rank == 0) {
        method->counts = (struct octree_counts){number[PROGRESS_RAYS], number[PROGRESS_NODE_TESTS],
                                                number[PROGRESS_TRIANGLE_TESTS]};
        method->walled_off = number[PROGRESS_WALLED_OFF];
        method->rays_spared = number[PROGRESS_RAYS_SPARED];
    }
    solver->pass = number[PROGRESS_PASSES];
    solver->iteration = number[PROGRESS_ITERATIONS];
    bool as_limited = number[PROGRESS_LIMITED] == solver->memory.limit;
    solver->memory.reached = as_limited ? number[PROGRESS_LIMITED] : 0;
    solver->last_change = number[PROGRESS_CHANGE];
    solver->accuracy.estimate = progress->value[PROGRESS_ESTIMATE];
    solver->least_bend = progress->value[PROGRESS_LEAST_BEND];
    if (solver->pass > 0) { /* before the first pass a link cache does not bind epsilon */
        method->criterion.epsilon = progress->value[PROGRESS_EPSILON];
        method->link_threshold = method->criterion.epsilon * scene_emitted_power(method->scene);
    }
    *vote = (struct vote){
        .settled = number[PROGRESS_SETTLED] != 0 && (as_limited || number[PROGRESS_LIMITED] == 0),
        .links = progress->link_count,
        .remaining = progress->value[PROGRESS_REMAINING],
        .absorbed = progress->value[PROGRESS_ABSORBED],
        .escaped = progress->value[PROGRESS_ESCAPED],
    };
    vote->converged = vote->settled && vote->remaining <= method->criterion.tolerance;
}

int32_t *progress_restore(struct solver *solver, struct vote *vote, struct progress *progress)
{
    struct forest *forest = solver->method.forest;
    broadcast_progress(solver->comm, progress);
    restore_trees(forest, progress);
    closure_extend(&solver->closure, forest);
    conjugate_extend(&solver->conjugate, forest, solver->own);
    int32_t *order = forest_order(forest);
    restore_leaves(solver, progress, order);
    for (int32_t root = 0; root < forest->root_count; root++)
        solver->root_change[root] = progress->root_change[root];
    restore_numbers(solver, vote, progress);
    return order;
}

void links_deal(struct solver *solver, const int32_t *order, struct link *links, int64_t count)
{
    const struct forest *forest = solver->method.forest;
    comm_broadcast(solver->comm, links, (size_t)count * sizeof *links);
    for (int64_t i = 0; i < count; i++) {
        struct link link = links[i];
        link.p = order[link.p];
        link.q = order[link.q];
        uint32_t a = forest->patches[link.p].id.root, b = forest->patches[link.q].id.root;
        if (solver->own[(a ^ b) % 2 == 0 ? a : b])
            link_list_append(&solver->links, link);
    }
}
