/* Step 7: the homes tell all ranks how their trees look now.
 *
 * Of each home's roots, in order: one bit, set if the tree changed (least significant first,
 * padded to whole bytes), then the changed trees as in rad/treecode.h. No IDs are needed: all
 * ranks know which roots a rank is home to. */
#include "mpi/solver.h"

#include "geom/alloc.h"
#include "rad/treecode.h"

static void encode_own(struct solver *solver, struct bytes *bytes)
{
    const struct forest *forest = solver->method.forest;
    int64_t bit = 0, mask_at = 0;
    for (int32_t root = 0; root < forest->root_count; root++) {
        if (!solver->own[root])
            continue;
        if (bit % 8 == 0) {
            mask_at = bytes->count;
            bytes_append(bytes, 0);
        }
        uint8_t set = (uint8_t)((solver->touched[root] ? 1 : 0) << (bit++ % 8));
        bytes->data[mask_at] = (uint8_t)(bytes->data[mask_at] | set);
    }
    for (int32_t root = 0; root < forest->root_count; root++)
        if (solver->own[root] && solver->touched[root])
            tree_encode(forest, root, bytes);
}

static void decode_from(struct solver *solver, int rank, const uint8_t *data)
{
    struct forest *forest = solver->method.forest;
    int64_t bit = 0, owned = 0;
    for (int32_t root = 0; root < forest->root_count; root++)
        owned += solver->owner[root] == rank;
    int64_t at = (owned + 7) / 8;
    for (int32_t root = 0; root < forest->root_count; root++) {
        if (solver->owner[root] != rank)
            continue;
        if (data[bit / 8] >> (bit % 8) & 1)
            at += tree_decode(forest, root, data + at);
        bit++;
    }
}

/* A tree that was split here or through the gather has changed even if no value has. */
static void touch_split_trees(struct solver *solver)
{
    const struct forest *forest = solver->method.forest;
    for (int64_t p = solver->first_new; p < forest->count; p++)
        solver->touched[forest->patches[p].id.root] = true;
}

void solver_scatter(struct solver *solver)
{
    double start = comm_seconds();
    const struct comm *comm = solver->comm;
    struct bytes own = {0};
    touch_split_trees(solver);
    encode_own(solver, &own);
    int *at = alloc_array((size_t)comm->size + 1, sizeof *at);
    uint8_t *all = comm_gather_all(comm, own.data, own.count, at);
    for (int r = 0; r < comm->size; r++)
        if (r != comm->rank)
            decode_from(solver, r, all + at[r]);
    forest_pull(solver->method.forest);
    for (int32_t root = 0; root < solver->method.forest->root_count; root++)
        solver->touched[root] = false;
    solver->bytes_scatter += own.count * (comm->size - 1);
    alloc_free(all);
    alloc_free(at);
    bytes_free(&own);
    solver->seconds[PHASE_SCATTER] += comm_seconds() - start;
}
