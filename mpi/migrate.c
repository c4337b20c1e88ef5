/* Sending links: count, allocate, pack, one collective, unpack.
 *
 * On the way a link names its patches by their IDs. The receiver looks these up in its
 * own copy of the forest and creates missing ones; a patch so created has its parent's
 * radiosity, as every new child has, so a link means the same wherever it lives. */
#include "mpi/migrate.h"

#include <string.h>

#include "geom/alloc.h"

/* 32 bytes, no padding: a link with IDs in place of local numbers. */
struct wire_link {
    struct patch_id p, q;
    float area;
    int32_t blocker;
    uint8_t parts_p[3], parts_q[3], seen, cost;
};

static struct wire_link pack(const struct model *model, const struct link *link)
{
    struct wire_link wire = {.p = model->method.node_id(model, link->p),
                             .q = model->method.node_id(model, link->q),
                             .area = link->area,
                             .blocker = link->blocker,
                             .seen = link->seen,
                             .cost = link->cost};
    memcpy(wire.parts_p, link->parts_p, sizeof wire.parts_p);
    memcpy(wire.parts_q, link->parts_q, sizeof wire.parts_q);
    return wire;
}

static struct link unpack(const struct model *model, const struct wire_link *wire)
{
    struct link link = {.p = model->method.node_reach(model, wire->p),
                        .q = model->method.node_reach(model, wire->q),
                        .area = wire->area,
                        .blocker = wire->blocker,
                        .seen = wire->seen,
                        .cost = wire->cost};
    memcpy(link.parts_p, wire->parts_p, sizeof link.parts_p);
    memcpy(link.parts_q, wire->parts_q, sizeof link.parts_q);
    return link;
}

/* Packs the leaving links, destination by destination, and closes the gaps in `list`.
 * `at` is where each destination's records begin, and is used up. */
static struct wire_link *pack_leaving(const struct solver *solver, struct link_list *list,
                                      const int *destination, int *at, int64_t total)
{
    struct wire_link *wire = alloc_array((size_t)total, sizeof *wire);
    int64_t kept = 0;
    for (int64_t i = 0; i < list->count; i++) {
        if (destination[i] == solver->comm->rank)
            list->items[kept++] = list->items[i];
        else
            wire[at[destination[i]]++] = pack(&solver->model, &list->items[i]);
    }
    list->count = kept;
    return wire;
}

struct traffic links_migrate(struct solver *solver, struct link_list *list,
                             const int *destination)
{
    const struct comm *comm = solver->comm;
    size_t ranks = (size_t)comm->size;
    int *counts = alloc_array(ranks, sizeof *counts);
    int *at = alloc_array(ranks, sizeof *at);
    comm_count(comm, list->count);
    for (int64_t i = 0; i < list->count; i++)
        counts[destination[i]] += destination[i] != comm->rank;
    struct traffic traffic = {.sent = comm_displacements(comm, counts, at)};
    int64_t messages = comm_counts().messages;
    struct wire_link *out = pack_leaving(solver, list, destination, at, traffic.sent);
    struct wire_link *in = /* `at` is used up */
        comm_exchange(comm, out, counts, sizeof *out, at, &traffic.received);
    for (int64_t i = 0; i < traffic.received; i++)
        link_list_append(list, unpack(&solver->model, &in[i]));
    solver->account.messages[CARGO_LINKS] += comm_counts().messages - messages;
    solver->account.bytes[CARGO_LINKS] += traffic.sent * (int64_t)sizeof *out;
    alloc_free(in);
    alloc_free(out);
    alloc_free(at);
    alloc_free(counts);
    return traffic;
}
