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

/* The rank with the smaller load, of equal ones the lower. */
static int lighter(const int64_t *loads, int a, int b)
{
    return loads[a] != loads[b] ? (loads[a] < loads[b] ? a : b) : a < b ? a : b;
}

void items_deal(const int64_t *weights, int32_t count, int ranks, int *owner)
{
    struct weighted *items = alloc_array((size_t)count, sizeof *items);
    for (int32_t i = 0; i < count; i++)
        items[i] = (struct weighted){weights[i], i};
    qsort(items, (size_t)count, sizeof *items, compare_items);
    int64_t *loads = alloc_array((size_t)ranks, sizeof *loads);
    int *least = alloc_array(2 * (size_t)ranks, sizeof *least);
    for (int k = 2 * ranks - 1; k > 0; k--) /* a tree: of 2k and 2k + 1 the lighter */
        least[k] = k < ranks ? lighter(loads, least[2 * k], least[2 * k + 1]) : k - ranks;
    for (int32_t i = 0; i < count; i++) {
        int rank = owner[items[i].number] = least[1];
        loads[rank] += items[i].weight;
        for (int k = (ranks + rank) / 2; k > 0; k /= 2)
            least[k] = lighter(loads, least[2 * k], least[2 * k + 1]);
    }
    alloc_free(least);
    alloc_free(loads);
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

/* Where the links of each node go, clusters, last one first, and patches, from a rank
 * with more links than others, by the plan of LoadBalance: those of clusters, and of
 * patches made early, leave; these have many links each. To be freed. */
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

/* Collective. Sends links, from number `first` on, to where those of their nodes go; home
 * if `to` is NULL. */
static void send_links(struct solver *solver, int64_t first, const int *to)
{
    int *destination = alloc_array((size_t)solver->links.count, sizeof *destination);
    for (int64_t i = 0; i < first; i++)
        destination[i] = solver->comm->rank;
    for (int64_t i = first; i < solver->links.count; i++) {
        int32_t node = smaller_of(solver->model.forest, &solver->links.items[i]);
        destination[i] = to ? to[solver->memory.clusters + node] : home_of(solver, node);
    }
    links_migrate(solver, &solver->links, destination);
    alloc_free(destination);
}

void solver_settle_links(struct solver *solver)
{
    const struct comm *comm = solver->comm;
    int64_t most = 0, all = 0;
    if (comm->size == 1)
        return;
    account_begin(&solver->account, PHASE_MIGRATION);
    send_links(solver, solver->turn.settled, NULL);
    link_list_sort(&solver->links);
    int64_t *loads = comm_gather_each(comm, &solver->links.seen, sizeof *loads);
    for (int r = 0; r < comm->size; r++) {
        all += loads[r];
        most = loads[r] > most ? loads[r] : most;
    }
    if (DEALINGS[solver->model.criterion.balance] &&
        (double)(most * comm->size) > UNEVEN * (double)all) {
        int *to = choose_leaving(solver, loads);
        send_links(solver, 0, to);
        alloc_free(to);
    }
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
    solver->account.own.patches = homes->count;
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
