/* Step 3: re-assignment. Roots in descending order of area, each to the rank with the
 * smallest sum so far (Graham's rule: no sum is above 4/3 of the best possible maximum).
 * The paper's root processor decides and informs the others; here all have the areas and
 * decide alike.
 *
 * Then links settle, and after each pass of refinement the new ones: at the home of the
 * smaller patch. So proxies are larger patches, of which there are few. A home with more
 * links than others sends away those of some of its patches. Proxies of all ranks, and
 * the links of the rank with most, in means (room of 1,004 triangles, --paper --epsilon
 * 1e-5):
 *
 *     links of                8 ranks          32 ranks
 *     smaller patches         28,958   1.05     75,548   1.05
 *     these, none sent away   26,849   1.51     58,789   3.6
 *     larger, none sent away  52,776   1.65    101,822   4.0
 *
 * Rejected: links where they are made (56,619, 1.08 and 126,270, 1.17). */
#include "mpi/assign.h"

#include <stdlib.h>

#include "geom/alloc.h"
#include "mpi/balance.h"
#include "mpi/plan.h"
#include "mpi/migrate.h"
#include "rad/oracle.h"

/* Links are dealt anew if a rank has more that carry light than so many times the mean.
 * Without this slack 32 ranks have a fifth more proxies. */
static const double UNEVEN = 1.05;

/* --- homes of roots --- */

/* A heap of ranks, the smallest load on top. */
struct heap {
    int *ranks; /* [count] */
    int count;
    int64_t *loads; /* [count] of each rank */
};

static bool goes_before(const struct heap *heap, int a, int b)
{
    int64_t x = heap->loads[a], y = heap->loads[b];
    return x != y ? x < y : a < b;
}

static void sink(struct heap *heap, int at)
{
    for (int child = 2 * at + 1; child < heap->count; child = 2 * at + 1) {
        if (child + 1 < heap->count &&
            goes_before(heap, heap->ranks[child + 1], heap->ranks[child]))
            child++;
        int rank = heap->ranks[at], below = heap->ranks[child];
        if (!goes_before(heap, below, rank))
            return;
        heap->ranks[at] = below;
        heap->ranks[child] = rank;
        at = child;
    }
}

struct weighted {
    int64_t weight;
    int32_t number;
};

static int compare_items(const void *left, const void *right)
{
    const struct weighted *a = left, *b = right;
    if (a->weight != b->weight)
        return a->weight > b->weight ? -1 : 1;
    return a->number < b->number ? -1 : 1;
}

void items_deal(const int64_t *weights, int32_t count, int ranks, int *owner)
{
    struct weighted *items = alloc_array((size_t)count, sizeof *items);
    for (int32_t i = 0; i < count; i++)
        items[i] = (struct weighted){weights[i], i};
    qsort(items, (size_t)count, sizeof *items, compare_items);
    struct heap heap = {.count = ranks};
    heap.ranks = alloc_array((size_t)ranks, sizeof *heap.ranks);
    heap.loads = alloc_array((size_t)ranks, sizeof *heap.loads);
    for (int r = 0; r < ranks; r++)
        heap.ranks[r] = r; /* a heap, as all loads are 0 */
    for (int32_t i = 0; i < count; i++) {
        owner[items[i].number] = heap.ranks[0];
        heap.loads[heap.ranks[0]] += items[i].weight;
        sink(&heap, 0);
    }
    alloc_free(heap.loads);
    alloc_free(heap.ranks);
    alloc_free(items);
}

/* --- step 3 --- */

int home_of(const struct solver *solver, int32_t node)
{
    return node_is_cluster(node)
               ? solver->above.owner[~node]
               : solver->homes.owner[solver->model.forest->patches[node].id.root];
}

/* The node that a link belongs to: the smaller patch; or the patch and not the cluster,
 * or of two clusters the later one. */
static int32_t smaller_of(const struct forest *forest, const struct link *link)
{
    bool p_is_patch = !node_is_cluster(link->p), q_is_patch = !node_is_cluster(link->q);
    if (p_is_patch && q_is_patch)
        return p_is_larger(forest, link) ? link->q : link->p;
    if (p_is_patch || q_is_patch)
        return p_is_patch ? link->p : link->q;
    return link->p < link->q ? link->p : link->q;
}

/* Where the links of each node go, clusters, last one first, and patches; to be freed:
 * home. */
static int *choose_homes(const struct solver *solver)
{
    int64_t clusters = solver->memory.clusters, all = solver->model.forest->count;
    int *to = alloc_array((size_t)(clusters + all), sizeof *to);
    for (int64_t node = -clusters; node < all; node++)
        to[clusters + node] = home_of(solver, (int32_t)node);
    return to;
}

/* The same for a rank with more links than others, by the plan of LoadBalance: those of
 * clusters, and of patches made early, leave; these have many links each. */
static int *choose_leaving(const struct solver *solver, const int64_t *loads)
{
    const struct forest *forest = solver->model.forest;
    int rank = solver->comm->rank;
    struct transfer *plan = alloc_array(2 * (size_t)solver->comm->size, sizeof *plan);
    int64_t all = solver->memory.clusters + forest->count;
    int64_t *links = alloc_array((size_t)all, sizeof *links);
    int *to = alloc_array((size_t)all, sizeof *to);
    for (int64_t i = 0; i < solver->links.count; i++)
        links[solver->memory.clusters + smaller_of(forest, &solver->links.items[i])] +=
            solver->links.items[i].seen > 0;
    int planned = plan_transfers(loads, solver->comm->size, plan);
    int64_t k = 0, left = 0; /* below 0: the last node had more links than planned */
    for (int t = 0; t < planned; t++) {
        left += plan[t].from == rank ? plan[t].load : 0;
        for (; left > 0 && k < all; k++) {
            to[k] = plan[t].to;
            left -= links[k];
        }
    }
    for (; k < all; k++)
        to[k] = rank;
    alloc_free(links);
    alloc_free(plan);
    return to;
}

/* Collective. Sends links, from number `first` on, to where those of their nodes go.
 * Frees `to`. */
static void send_links(struct solver *solver, int64_t first, int *to)
{
    const struct forest *forest = solver->model.forest;
    int *destination = alloc_array((size_t)solver->links.count, sizeof *destination);
    for (int64_t i = 0; i < solver->links.count; i++) {
        int64_t node = smaller_of(forest, &solver->links.items[i]);
        destination[i] =
            i < first ? solver->comm->rank : to[solver->memory.clusters + node];
    }
    links_migrate(solver, &solver->links, destination);
    alloc_free(destination);
    alloc_free(to);
}

void solver_settle_links(struct solver *solver)
{
    const struct comm *comm = solver->comm;
    int64_t most = 0, all = 0;
    if (comm->size == 1)
        return;
    account_begin(&solver->account, PHASE_MIGRATION);
    send_links(solver, solver->turn.settled, choose_homes(solver));
    link_list_sort(&solver->links);
    int64_t *loads = comm_gather_each(comm, &solver->links.seen, sizeof *loads);
    for (int r = 0; r < comm->size; r++) {
        all += loads[r];
        most = loads[r] > most ? loads[r] : most;
    }
    if (DEALINGS[solver->model.criterion.balance] &&
        (double)(most * comm->size) > UNEVEN * (double)all)
        send_links(solver, 0, choose_leaving(solver, loads));
    solver->turn.settled = solver->links.count;
    alloc_free(loads);
    account_end(&solver->account, PHASE_MIGRATION);
}

void homes_renew(struct solver *solver)
{
    struct homes *homes = &solver->homes;
    const struct forest *forest = solver->model.forest;
    for (; homes->listed < forest->count; homes->listed++) {
        if (!homes->own[forest->patches[homes->listed].id.root])
            continue;
        RESERVE(homes->patches, &homes->capacity, homes->count + 1);
        homes->patches[homes->count++] = (int32_t)homes->listed;
    }
}

void solver_deal_roots(struct solver *solver, int *owner)
{
    const struct model *model = &solver->model;
    int32_t roots = model->forest->root_count;
    int64_t *weights = alloc_array((size_t)roots, sizeof *weights);
    for (int32_t root = 0; root < roots; root++) /* areas, in parts of 2^-40 of all */
        weights[root] =
            (int64_t)(scene_root_area(model->scene, root) / model->whole_area * 0x1p40);
    items_deal(weights, roots, solver->comm->size, owner);
    alloc_free(weights);
}

void solver_assign_roots(struct solver *solver)
{
    struct homes *homes = &solver->homes;
    account_begin(&solver->account, PHASE_LINKING);
    solver->steps.deal(solver, homes->owner);
    for (int32_t root = 0; root < solver->model.forest->root_count; root++)
        homes->own[root] = homes->owner[root] == solver->comm->rank;
    account_end(&solver->account, PHASE_LINKING);
    solver_settle_links(solver);
}
