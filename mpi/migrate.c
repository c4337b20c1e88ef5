/* Sending links: count, allocate, pack, one collective, unpack.
 *
 * On the way a link names its patches by their IDs. The receiver looks them up in its own copy
 * of the forest and creates what it lacks; a patch so created has its parent's radiosity, as it
 * has where it was first split, so a link means the same wherever it lives. */
#include "mpi/migrate.h"

#include "geom/alloc.h"

/* 32 bytes, no padding. */
struct wire_link {
    struct patch_id p, q;
    double area;
    float unoccluded;
    uint32_t cost;
};

static struct wire_link pack(const struct forest *forest, const struct link *link)
{
    return (struct wire_link){forest->patches[link->p].id, forest->patches[link->q].id,
                              link->area, link->unoccluded, link->cost};
}

static struct link unpack(struct forest *forest, const struct wire_link *wire)
{
    int32_t p = forest_reach(forest, wire->p), q = forest_reach(forest, wire->q);
    return (struct link){p, q, wire->area, wire->unoccluded, wire->cost};
}

/* Packs what leaves, destination by destination, and closes the gaps in `list`. `at` is where
 * each destination's records begin, and is used up. */
static struct wire_link *pack_leaving(const struct solver *solver, struct link_list *list,
                                      const int *destination, int *at, int64_t total)
{
    struct wire_link *wire = alloc_array((size_t)total, sizeof *wire);
    int64_t kept = 0;
    for (int64_t i = 0; i < list->count; i++) {
        if (destination[i] == solver->comm->rank)
            list->items[kept++] = list->items[i];
        else
            wire[at[destination[i]]++] = pack(solver->method.forest, &list->items[i]);
    }
    list->count = kept;
    return wire;
}

int64_t links_migrate(struct solver *solver, struct link_list *list, const int *destination)
{
    const struct comm *comm = solver->comm;
    size_t ranks = (size_t)comm->size;
    int *counts = alloc_array(ranks, sizeof *counts), *at = alloc_array(ranks, sizeof *at);
    comm_count(comm, list->count);
    for (int64_t i = 0; i < list->count; i++)
        counts[destination[i]] += destination[i] != comm->rank;
    int64_t leaving = comm_displacements(comm, counts, at), arriving;
    struct wire_link *out = pack_leaving(solver, list, destination, at, leaving);
    struct wire_link *in = comm_exchange(comm, out, counts, sizeof *out, &arriving);
    for (int64_t i = 0; i < arriving; i++)
        link_list_append(list, unpack(solver->method.forest, &in[i]));
    alloc_free(in);
    alloc_free(out);
    alloc_free(at);
    alloc_free(counts);
    return leaving * (int64_t)sizeof *out;
}
