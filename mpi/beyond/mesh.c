/* Looks at leaves by all ranks, round by round, between which the mesh splits leaves. The
 * looks are dealt by the work predicted for them, and all ranks learn all looks. */
#include "mpi/beyond/mesh.h"

#include <string.h>

#include "geom/alloc.h"
#include "geom/stop.h"
#include "mpi/beyond/open.h"
#include "mpi/beyond/stages.h"
#include "mpi/memory.h"

enum { ROUNDS = 6 };

struct looking {
    struct meshing *meshing;
    const int32_t *leaves;     /* looked at */
    struct gather_look *looks; /* [count] of this rank */
    int64_t count;
};

static void look_at(void *context, int64_t item)
{
    struct looking *l = context;
    l->looks[l->count++] =
        final_gather_look(l->meshing->gather, l->leaves[item], l->meshing->rays);
}

/* Collective. Looks at leaves, [count]; [count], on all ranks, to be freed. */
static struct gather_look *look(struct solver *solver, struct meshing *meshing,
                                const int32_t *leaves, int64_t count)
{
    const struct comm *comm = solver->comm;
    int64_t *work = meshing_work(meshing, leaves, count, NULL);
    struct gather_look *looks = alloc_array((size_t)count, sizeof *looks);
    struct looking l = {.meshing = meshing, .leaves = leaves};
    struct stages stages = {.solver = solver, .gather = meshing->gather, .act = look_at,
                            .context = &l, .work = work, .count = count};
    l.looks = alloc_array((size_t)count, sizeof *looks);
    final_gather_renew(meshing->gather);
    stages_make_cuts(solver, meshing->gather, leaves, NULL, count);
    stages_run(&stages);
    memmove(l.looks + stages.at[comm->rank], l.looks, (size_t)l.count * sizeof *looks);
    comm_share(comm, l.looks, stages.counts, stages.at, sizeof *looks);
    for (int64_t i = 0; i < count; i++)
        looks[i] = l.looks[stages.place[i]];
    stages_free(&stages);
    alloc_free(l.looks);
    alloc_free(work);
    return looks;
}

/* The number of patches from which on the memory limit keeps leaves from being split. */
static int64_t patches_most(const struct memory *memory, int64_t links)
{
    int64_t low = 0, high = INT32_MAX;
    while (low < high) {
        int64_t middle = (low + high) / 2;
        if (memory_has_room(memory, links, 1, middle))
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

bool solver_make_mesh(struct solver *solver, int64_t links, struct gather_mesh *mesh)
{
    struct model *model = &solver->model;
    struct final_gather *gather =
        final_gather_create(model, model->criterion.final_gather, NULL);
    uint8_t *open = solver_find_open_roots(solver, gather);
    struct meshing meshing = {.model = model, .gather = gather, .mesh = mesh,
                              .open = open,
                              .patches_most = patches_most(&solver->memory, links)};
    meshing_begin(&meshing);
    int64_t count = 0;
    int32_t *leaves = meshing_looks(&meshing) ? meshing_choose(&meshing, &count) : NULL;
    for (int round = 0; round < ROUNDS && count > 0; round++) {
        progress_begin(solver->progress, "looking", round, 0);
        struct gather_look *looks = look(solver, &meshing, leaves, count);
        count = meshing_split(&meshing, looks, &leaves, count);
        alloc_free(looks);
    }
    meshing_end(&meshing);
    int64_t stopped = stop_is_asked();
    comm_add(solver->comm, &stopped, 1);
    alloc_free(leaves);
    alloc_free(open);
    final_gather_destroy(gather);
    return stopped == 0;
}
