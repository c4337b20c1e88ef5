/* Steps 2 and 3: initial linking, and the homes of roots and links.
 *
 * With a tree above the roots there is one link to begin with, on rank 0.
 * Without, pairs of roots are dealt in turn (rad/linking.h) and linked in rounds, by
 * number. Between two rounds all ranks agree whether there is a next one:
 * not if any of them has got a signal, nor if, with a link for each of its pairs, the
 * links of all ranks might take more memory than there may be. So linking ends at a pair
 * that does not depend on the ranks. A rank that has got a signal leaves the rest of its
 * round.
 *
 * Roots are dealt by their areas. Each link goes to
 * the home of one of its two roots, here the lower or the higher one by the parity of
 * i + j. */
#include "mpi/assign.h"
#include "mpi/memory.h"
#include "mpi/migrate.h"
#include "geom/signals.h"

#include "geom/alloc.h"
#include "rad/linking.h"

/* Pairs of all ranks in a round: of 2.4 MB at most. */
enum { ROUND = 65536 };

/* Pairs of a rank from one look at signals, and tick of the progress, to the next. */
enum { PAIRS_PER_TICK = 64 };

/* A rank's state before a round, for the others. */
struct linking_notice {
    int64_t links; /* made so far */
    int64_t stop;  /* the signal that the rank has got, 0: none */
};

/* The links of all ranks so far. Waiting is idle time. */
static int64_t exchange_notices(struct solver *solver)
{
    const struct comm *comm = solver->comm;
    struct linking_notice own = {.links = solver->links.count, .stop = signals_seen()};
    double start = comm_seconds();
    struct linking_notice *notices = comm_gather_each(comm, &own, sizeof own);
    double idle = comm_seconds() - start;
    solver->account.seconds[PHASE_IDLE] += idle;
    solver->account.seconds[PHASE_LINKING] -= idle;
    int64_t links = 0;
    for (int r = 0; r < comm->size; r++) {
        links += notices[r].links;
        int stop = (int)notices[r].stop;
        solver->turn.stop = stop > solver->turn.stop ? stop : solver->turn.stop;
    }
    alloc_free(notices);
    return links;
}

/* True before pair number `done` of a rank's round, unless a signal has come. */
static bool goes_on(struct solver *solver, const struct linking *linking, int64_t done)
{
    if (done % PAIRS_PER_TICK != 0)
        return true;
    progress_tick(solver->progress,
                  (double)linking->number / (double)linking_pairs(linking));
    return signals_seen() == 0;
}

/* Links this rank's pairs, round by round. Returns false if a signal or the memory limit
 * has ended it. */
static bool link_pairs(struct solver *solver, struct linking *linking)
{
    int64_t pairs = linking_pairs(linking), patches = solver->model.forest->count;
    for (int64_t end = 0; end < pairs;) {
        int64_t links = exchange_notices(solver);
        int64_t round = pairs - end < ROUND ? pairs - end : ROUND;
        bool fits = memory_has_room(&solver->memory, links + round, 0, patches);
        if (!fits)
            solver->memory.reached = solver->memory.limit;
        if (!fits || solver->turn.stop)
            return false;
        end += round;
        for (int64_t done = 0; linking->number < end && goes_on(solver, linking, done);
             done++)
            linking_add(linking);
    }
    exchange_notices(solver);
    return solver->turn.stop == 0;
}

bool solver_link_roots(struct solver *solver)
{
    double start = comm_seconds();
    if (solver->model.method.first_link) {
        if (solver->comm->rank == 0) /* the first levels deal what it becomes */
            link_list_append(&solver->links, solver->model.method.first_link());
        return true;
    }
    int64_t before = model_work(&solver->model);
    const struct comm *comm = solver->comm;
    struct linking linking = linking_start(&solver->model, &solver->links, comm->rank,
                                           comm->size);
    bool done = link_pairs(solver, &linking);
    struct phase_work phase = {.kind = WORK_LINKING,
                               .share.links = solver->links.count,
                               .share.done = model_work(&solver->model) - before};
    ledger_add(&solver->account.ledger, phase);
    linking_end(&linking);
    solver->account.seconds[PHASE_LINKING] += comm_seconds() - start;
    return done;
}

static uint32_t root_of(const struct solver *solver, int32_t patch)
{
    return solver->model.forest->patches[patch].id.root;
}

static void send_home(struct solver *solver)
{
    int *destination = alloc_array((size_t)solver->links.count, sizeof *destination);
    for (int64_t i = 0; i < solver->links.count; i++) {
        const struct link *link = &solver->links.items[i];
        uint32_t a = root_of(solver, link->p), b = root_of(solver, link->q);
        destination[i] = solver->homes.owner[(a ^ b) % 2 == 0 ? a : b];
    }
    links_migrate(solver, &solver->links, destination);
    alloc_free(destination);
}

/* The area of a root, in parts of 2^-40 of all. */
static int64_t root_area(const struct model *model, int32_t root)
{
    return (int64_t)(scene_root_area(model->scene, root) / model->area * 0x1p40);
}

void solver_assign_roots(struct solver *solver)
{
    double start = comm_seconds();
    int32_t roots = solver->model.forest->root_count;
    int64_t *weights = alloc_array((size_t)roots, sizeof *weights);
    for (int32_t root = 0; root < roots; root++)
        weights[root] = root_area(&solver->model, root);
    roots_assign(weights, roots, solver->comm->size, solver->homes.owner);
    alloc_free(weights);
    for (int32_t root = 0; root < roots; root++)
        solver->homes.own[root] = solver->homes.owner[root] == solver->comm->rank;
    if (!solver->memory.clusters) /* clusters have no home */
        send_home(solver);
    solver->account.seconds[PHASE_LINKING] += comm_seconds() - start;
}
