/* Step 7: proxies get the radiosities of their patches.
 *
 * "This step is the inverse of Step 5" (Sec. 3.2). A rank has proxies of the patches of
 * other homes at the ends of its links. The rank names a new one to the home once, and
 * from then on both have the patch in their lists of each other. Step 5 sends flux along
 * the lists, step 7 sends radiosities back, without IDs, counts or searching. A proxy
 * stays one. (Clusters, where there are any, are nodes with homes as patches are.)
 *
 * While links are split, a rank gets links whose ends are no proxies there, and children
 * of patches come to have links. Before each level the homes are asked for the
 * radiosities of these, which hold for the pass. A patch made in the pass has the
 * radiosity of the patch split for it.
 *
 * The radiosities of all leaves go to all ranks once, at the end, for what looks at the
 * whole solution. */
#include "mpi/solver.h"

#include <string.h>

#include "geom/alloc.h"

/* --- lists --- */

void route_free(struct route *route)
{
    alloc_free(route->nodes);
    alloc_free(route->counts);
    *route = (struct route){0};
}

void routes_free(struct routes *routes)
{
    route_free(&routes->proxies);
    route_free(&routes->originals);
    alloc_free(routes->known);
    *routes = (struct routes){0};
}

/* Puts the nodes of `more` behind those of the same rank. */
static void route_extend(struct route *route, const struct route *more, int ranks)
{
    int64_t count = route->count + more->count;
    int32_t *all = alloc_array((size_t)count, sizeof *all), *to = all;
    const int32_t *old = route->nodes, *new = more->nodes;
    if (!route->counts)
        route->counts = alloc_array((size_t)ranks, sizeof *route->counts);
    for (int r = 0; r < ranks; r++) {
        for (int i = 0; i < route->counts[r]; i++)
            *to++ = *old++;
        for (int i = 0; i < more->counts[r]; i++)
            *to++ = *new++;
        route->counts[r] += more->counts[r];
    }
    alloc_free(route->nodes);
    route->nodes = all;
    route->count = count;
}

static struct rgb *radiosity_of(const struct solver *solver, int32_t node)
{
    return node_is_cluster(node) ? &solver->above.radiosity[~node]
                                 : &solver->model.forest->radiosity[node];
}

struct route route_to_homes(const struct solver *solver, const int32_t *nodes,
                            int64_t count)
{
    size_t ranks = (size_t)solver->comm->size;
    struct route route = {.count = count};
    route.nodes = alloc_array((size_t)count, sizeof *route.nodes);
    route.counts = alloc_array(ranks, sizeof *route.counts);
    int *at = alloc_array(ranks, sizeof *at);
    for (int64_t i = 0; i < count; i++)
        route.counts[home_of(solver, nodes[i])]++;
    comm_displacements(solver->comm, route.counts, at);
    for (int64_t i = 0; i < count; i++)
        route.nodes[at[home_of(solver, nodes[i])]++] = nodes[i];
    alloc_free(at);
    return route;
}

/* Collective. The nodes at home here that other ranks have in theirs, rank by rank. */
static struct route route_to_proxies(struct solver *solver, const struct route *asked)
{
    const struct model *model = &solver->model;
    int64_t messages = comm_counts().messages;
    struct route route = {0};
    struct patch_id *ids = alloc_array((size_t)asked->count, sizeof *ids), *own;
    for (int64_t i = 0; i < asked->count; i++)
        ids[i] = model->method.node_id(model, asked->nodes[i]);
    route.counts = alloc_array((size_t)solver->comm->size, sizeof *route.counts);
    own = comm_exchange(solver->comm, ids, asked->counts, sizeof *ids, route.counts,
                        &route.count);
    route.nodes = alloc_array((size_t)route.count, sizeof *route.nodes);
    for (int64_t i = 0; i < route.count; i++)
        route.nodes[i] = model->method.node_reach(model, own[i]);
    solver->account.bytes[CARGO_LIGHT] += route.count * (int64_t)sizeof *own;
    solver->account.messages[CARGO_LIGHT] += comm_counts().messages - messages;
    alloc_free(own);
    alloc_free(ids);
    return route;
}

void routes_carry(struct solver *solver, const struct route *from, const struct route *to,
                  struct record_kind kind)
{
    struct account *account = &solver->account;
    int64_t messages = comm_counts().messages;
    char *out = alloc_array((size_t)from->count, kind.bytes);
    char *in = alloc_array((size_t)to->count, kind.bytes);
    for (int64_t i = 0; i < from->count; i++)
        kind.pack(solver, from->nodes[i], out + (size_t)i * kind.bytes);
    comm_deliver(solver->comm, out, from->counts, in, to->counts, kind.bytes);
    for (int64_t i = 0; i < to->count; i++)
        kind.unpack(solver, to->nodes[i], in + (size_t)i * kind.bytes);
    account->bytes[kind.cargo] += from->count * (int64_t)kind.bytes;
    account->messages[kind.cargo] += comm_counts().messages - messages;
    account->copied += from->count + to->count;
    alloc_free(in);
    alloc_free(out);
}

static void pack_light(struct solver *solver, int32_t node, void *record)
{
    memcpy(record, radiosity_of(solver, node), sizeof(struct rgb));
}

static void unpack_light(struct solver *solver, int32_t node, void *record)
{
    memcpy(radiosity_of(solver, node), record, sizeof(struct rgb));
}

/* Radiosities, from originals to proxies. */
static const struct record_kind LIGHT = {CARGO_LIGHT, sizeof(struct rgb), pack_light,
                                         unpack_light};

/* --- proxies --- */

/* Marks in routes->known: a proxy. */
enum { ALWAYS = INT32_MAX };

/* The marks in routes->known, with room for all nodes; that of a cluster is below 0. */
static int32_t *marks_of(struct solver *solver)
{
    struct routes *routes = &solver->routes;
    int64_t clusters = solver->memory.clusters, before = routes->capacity;
    RESERVE(routes->known, &routes->capacity, solver->model.forest->count + clusters);
    memset(routes->known + before, 0,
           (size_t)(routes->capacity - before) * sizeof *routes->known);
    return routes->known + clusters;
}

/* True of a node of another home that is not marked so far, or with less. Nodes at home
 * are marked, too: a mark is cheaper to find than a home. */
static bool is_new(struct solver *solver, int32_t *marks, int32_t node, int32_t mark)
{
    if (marks[node] >= mark)
        return false;
    marks[node] = mark;
    return home_of(solver, node) != solver->comm->rank;
}

void routes_renew(struct solver *solver)
{
    const struct model *model = &solver->model;
    const struct link_list *links = &solver->links;
    int64_t count = 0, all = model->forest->count + solver->memory.clusters;
    int32_t *wanted = alloc_array((size_t)all, sizeof *wanted), *marks = marks_of(solver);
    for (int64_t i = 0; i < links->seen && solver->comm->size > 1; i++) {
        int32_t ends[METHOD_ENDS_MAX] = {links->items[i].p, links->items[i].q};
        int number =
            model->method.ends ? model->method.ends(model, &links->items[i], ends) : 2;
        for (int k = 0; k < number; k++)
            if (is_new(solver, marks, ends[k], ALWAYS))
                wanted[count++] = ends[k];
    }
    struct route asked = route_to_homes(solver, wanted, count);
    struct route own = route_to_proxies(solver, &asked);
    routes_carry(solver, &own, &asked, LIGHT);
    route_extend(&solver->routes.proxies, &asked, solver->comm->size);
    route_extend(&solver->routes.originals, &own, solver->comm->size);
    solver->account.own.proxies = solver->routes.proxies.count;
    route_free(&own);
    route_free(&asked);
    alloc_free(wanted);
}

/* The node, from before this pass, of which a node has the radiosity. */
static int32_t origin_of(const struct solver *solver, int32_t p)
{
    while (p >= solver->turn.first_new)
        p = solver->model.forest->patches[p].parent;
    return p;
}

/* Appends a node and, if `deep`, its children to a list. Returns their number. */
static int name_family(const struct model *model, int32_t node, bool deep, int32_t *list)
{
    int count = 1;
    list[0] = node;
    for (int k = 0; k < 4 && deep; k++) {
        list[count] = model->method.node_child(model, node, k);
        count += list[count] != NODE_NONE;
    }
    return count;
}

void solver_learn(struct solver *solver, const struct link_list *list, bool deep)
{
    enum { EACH = 10 + 1 }; /* two ends and their children; room for one that is none */
    if (solver->turn.complete)
        return;
    size_t room = (deep ? EACH : 2) * (size_t)list->count;
    int32_t *nodes = alloc_array(room, sizeof *nodes);
    int32_t *wanted = alloc_array(room, sizeof *wanted), *marks = marks_of(solver);
    int64_t count = 0, unknown = 0;
    for (int64_t i = 0; i < 2 * list->count; i++) {
        int32_t end = i % 2 ? list->items[i / 2].p : list->items[i / 2].q;
        count += name_family(&solver->model, end, deep, nodes + count);
    }
    for (int64_t i = 0; i < count; i++) {
        int32_t node = origin_of(solver, nodes[i]);
        if (is_new(solver, marks, node, (int32_t)solver->turn.pass))
            wanted[unknown++] = node;
    }
    struct route asked = route_to_homes(solver, wanted, unknown);
    struct route own = route_to_proxies(solver, &asked);
    routes_carry(solver, &own, &asked, LIGHT);
    if (solver->steps.learn)
        solver->steps.learn(solver, &own, &asked);
    for (int64_t i = 0; i < count; i++)
        *radiosity_of(solver, nodes[i]) =
            *radiosity_of(solver, origin_of(solver, nodes[i]));
    route_free(&own);
    route_free(&asked);
    alloc_free(wanted);
    alloc_free(nodes);
}

/* --- from all homes to all ranks --- */

void route_share(struct solver *solver, const struct route *route, enum cargo cargo)
{
    const struct comm *comm = solver->comm;
    int64_t messages = comm_counts().messages;
    int *at = alloc_array((size_t)comm->size, sizeof *at);
    struct rgb *values = alloc_array((size_t)route->count, sizeof *values);
    comm_displacements(comm, route->counts, at);
    for (int64_t i = 0; i < route->count; i++)
        values[i] = *radiosity_of(solver, route->nodes[i]);
    comm_share(comm, values, route->counts, at, sizeof *values);
    for (int64_t i = 0; i < route->count; i++)
        *radiosity_of(solver, route->nodes[i]) = values[i];
    solver->account.bytes[cargo] +=
        (route->count - route->counts[comm->rank]) * (int64_t)sizeof *values;
    solver->account.messages[cargo] += comm_counts().messages - messages;
    alloc_free(values);
    alloc_free(at);
}

/* B of dark leaves is 0. */
void solver_complete(struct solver *solver)
{
    struct forest *forest = solver->model.forest;
    if (solver->turn.complete)
        return;
    account_begin(&solver->account, PHASE_SCATTER);
    int32_t *leaves = alloc_array((size_t)forest->count, sizeof *leaves);
    int64_t count = 0;
    for (int32_t p = -1; (p = forest_next_leaf(forest, p)) >= 0;) {
        leaves[count] = p;
        count += !material_is_dark(forest_material(forest, p));
    }
    struct route all = route_to_homes(solver, leaves, count);
    route_share(solver, &all, CARGO_WHOLE);
    forest_average(forest);
    solver->turn.complete = true;
    route_free(&all);
    alloc_free(leaves);
    account_end(&solver->account, PHASE_SCATTER);
}

/* --- step 7 --- */

void solver_renew_proxies(struct solver *solver)
{
    account_begin(&solver->account, PHASE_SCATTER);
    routes_carry(solver, &solver->routes.originals, &solver->routes.proxies, LIGHT);
    account_end(&solver->account, PHASE_SCATTER);
}

void solver_scatter(struct solver *solver)
{
    if (solver->steps.scatter)
        solver->steps.scatter(solver);
}
