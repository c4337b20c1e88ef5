/* Steps 2 and 3: initial linking, and the homes of roots and links.
 *
 * Rows of the pairs of roots (rad/linking.h) are dealt by what they are expected to take, in
 * stages that make good what was wrong in the ones before (mpi/balance.h): while a stage is
 * worked on, the work done before it is exchanged.
 *
 * Light is transferred over links where they live, so all ranks should have as many that carry
 * light: those that have more than the mean give the excess away, and all others stay where they
 * were made. The paper (and --balance greedy) sends each to the home of one of its two roots, here
 * the lower or the higher one by the parity of i + j; but the areas of roots say little about the
 * number of their links. */
#include "mpi/assign.h"
#include "mpi/balance.h"
#include "mpi/migrate.h"

#include "geom/alloc.h"
#include "rad/linking.h"

/* Every rank's number on all ranks; to be waited for before `all` is read. */
static MPI_Request start_telling(const struct comm *comm, const int64_t *own, int64_t *all)
{
    MPI_Request request;
    MPI_Iallgather(own, 1, MPI_INT64_T, all, 1, MPI_INT64_T, comm->handle, &request);
    return request;
}

static void wait_idle(struct solver *solver, MPI_Request *request)
{
    double start = comm_seconds();
    comm_wait(request);
    double idle = comm_seconds() - start;
    solver->seconds[PHASE_IDLE] += idle;
    solver->seconds[PHASE_LINKING] -= idle;
}

/* Samples this rank's rows, and goes on with some of them until all know all rests. */
static void link_samples(struct solver *solver, struct linking *linking, int64_t *rests)
{
    int ranks = solver->comm->size, rank = solver->comm->rank;
    int32_t rows = linking->tree->root_count;
    int64_t *own = alloc_array((size_t)rows, sizeof *own);
    for (int32_t place = 0; place < rows; place++) {
        if (row_sampler(place, ranks) != rank)
            continue;
        own[place] = linking_add_sample(linking, place);
    }
    MPI_Request request;
    MPI_Iallreduce(own, rests, rows, MPI_INT64_T, MPI_SUM, solver->comm->handle, &request);
    for (int32_t place = 0; place < rows; place++) {
        if (row_sampler(place, ranks) != rank || !row_goes_on(place, own[place], ranks))
            continue;
        linking_add_part(linking, place, 0, 1);
    }
    wait_idle(solver, &request);
    alloc_free(own);
}

static void link_stage(struct solver *solver, struct linking *linking, const struct row_deal *deal)
{
    for (int64_t i = deal->first; i < deal->end; i++) {
        const struct row_part *part = &deal->parts[i];
        if (deal->owner[i] != solver->comm->rank)
            continue;
        progress_tick(solver->progress, (double)i / (double)deal->count);
        linking_add_part(linking, part->place, part->part, part->parts);
    }
}

void solver_link_roots(struct solver *solver)
{
    const struct comm *comm = solver->comm;
    double start = comm_seconds();
    struct linking linking = linking_start(&solver->method, &solver->links);
    int32_t rows = linking.tree->root_count;
    int64_t *rests = alloc_array((size_t)rows, sizeof *rests);
    int64_t *done = alloc_array((size_t)comm->size, sizeof *done);
    int64_t before = method_work(&solver->method), own;
    link_samples(solver, &linking, rests);
    struct row_deal deal = row_deal_start(rests, rows, comm->size);
    while (row_deal_next(&deal)) {
        own = method_work(&solver->method) - before;
        MPI_Request request = start_telling(comm, &own, done);
        link_stage(solver, &linking, &deal);
        wait_idle(solver, &request);
        row_deal_correct(&deal, done);
    }
    struct phase_work phase = {.kind = WORK_LINKING, .links = linking.touched,
                               .predicted = deal.loads[comm->rank],
                               .work = method_work(&solver->method) - before};
    ledger_add(&solver->ledger, phase);
    solver->pairs_touched = linking.touched;
    row_deal_end(&deal);
    linking_end(&linking);
    alloc_free(rests);
    alloc_free(done);
    solver->seconds[PHASE_LINKING] += comm_seconds() - start;
}

static void send_home(struct solver *solver)
{
    int *destination = alloc_array((size_t)solver->links.count, sizeof *destination);
    for (int64_t i = 0; i < solver->links.count; i++) {
        const struct link *link = &solver->links.items[i]; /* p < q: both are roots */
        destination[i] = solver->owner[(link->p ^ link->q) % 2 == 0 ? link->p : link->q];
    }
    solver->bytes_migration += links_migrate(solver, &solver->links, destination);
    alloc_free(destination);
}

void solver_assign_roots(struct solver *solver)
{
    double start = comm_seconds();
    roots_assign(solver->method.scene, solver->comm->size, solver->owner);
    for (int32_t root = 0; root < solver->method.forest->root_count; root++)
        solver->own[root] = solver->owner[root] == solver->comm->rank;
    if (solver->method.criterion.balance == BALANCE_GREEDY)
        send_home(solver);
    else
        links_even_out(solver);
    solver->seconds[PHASE_LINKING] += comm_seconds() - start;
}
