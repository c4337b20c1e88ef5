/* Step 2: initial linking.
 *
 * "Interactions between all initial patches in the scene are computed" (Sec. 2.2): k
 * roots have k (k - 1) / 2 pairs, and each has its form factor and its rays. Nothing is
 * known of a pair before, so a link depends on its two roots alone.
 *
 * The paper deals "an equal number of patches" to each processor. If a patch takes the
 * interactions with all patches behind it, the first patch has k - 1 of them and the last
 * one none. So pairs are dealt here instead, in turn. Here those of rank 1 of 3, of five
 * roots:
 *
 *       j   1   2   3   4
 *     i 0   0  (1)  2   3
 *       1      (4)  5   6
 *       2          (7)  8
 *       3               9
 *
 * Ranks have the same number of pairs, but for one, and each a part of the costly and of
 * the cheap pairs of each line. A rank steps from one of its pairs to the next and meets
 * no other. Rejected: whole lines in turn (of 32 lines the first has
 * 31 pairs more than the last, and a large root makes its whole line costly).
 *
 * Pairs are linked in rounds. Before each all ranks agree whether there is a next one:
 * not if any has got a signal, nor if, with a link for each pair of the round, the links
 * of all ranks might exceed the memory limit. So linking ends at a pair independent of
 * the ranks. A rank with a signal leaves the rest of its round.
 *
 * With a tree above the roots there is one link to begin with, on rank 0. */
#include "mpi/solver.h"

#include "geom/alloc.h"
#include "geom/signals.h"
#include "mpi/memory.h"

/* Pairs of all ranks in a round: of 2.4 MB at most. */
enum { ROUND = 65536 };

/* A rank's state before a round, for the others. */
struct linking_notice {
    int64_t links; /* made so far */
    int64_t stop;  /* the signal of the rank, 0: none */
};

/* The links of all ranks so far. Waiting is idle time. */
static int64_t exchange_notices(struct solver *solver)
{
    const struct comm *comm = solver->comm;
    struct linking_notice own = {.links = solver->links.count, .stop = signals_seen()};
    account_end(&solver->account, PHASE_LINKING);
    account_begin(&solver->account, PHASE_IDLE);
    struct linking_notice *notices = comm_gather_each(comm, &own, sizeof own);
    account_end(&solver->account, PHASE_IDLE);
    account_begin(&solver->account, PHASE_LINKING);
    int64_t links = 0;
    for (int r = 0; r < comm->size; r++) {
        links += notices[r].links;
        int stop = (int)notices[r].stop;
        solver->turn.stop = stop > solver->turn.stop ? stop : solver->turn.stop;
    }
    alloc_free(notices);
    return links;
}

/* Collective. True if there is a round of the pairs from this number on. */
static bool begin_round(struct solver *solver, int64_t number, int64_t pairs)
{
    int64_t links = exchange_notices(solver);
    int64_t round = pairs - number < ROUND ? pairs - number : ROUND;
    if (memory_has_room(&solver->memory, links + round, 0, solver->model.forest->count))
        return solver->turn.stop == 0;
    solver->memory.reached = solver->memory.limit;
    return false;
}

/* A pair of roots, by their numbers in a list. */
struct pair_at {
    int64_t i, j;
};

/* Goes `steps` pairs on, through lines of `count` roots. */
static void step(struct pair_at *pair, int64_t steps, int64_t count)
{
    pair->j += steps;
    for (; pair->j >= count && pair->i < count; pair->i++)
        pair->j += pair->i + 2 - count; /* the next line begins behind its diagonal */
}

/* Collective. Links the pairs of these roots, each rank its own. False if a signal or the
 * memory limit has ended the step. */
static bool link_pairs(struct solver *solver, const int32_t *roots, int64_t count)
{
    struct model *model = &solver->model;
    int64_t number = solver->comm->rank, pairs = count * (count - 1) / 2, line = -1;
    struct pair_at at = {0, 1};
    struct facet facet_i;
    step(&at, number, count);
    for (int64_t round = 0; round < pairs; round += ROUND) {
        if (!begin_round(solver, round, pairs))
            return false;
        int64_t end = pairs - round < ROUND ? pairs : round + ROUND;
        while (number < end && !signals_seen()) {
            if (at.i != line) {
                line = at.i;
                facet_i = facet_make(model->forest, roots[line]);
                progress_tick_pairs(solver->progress, line, count);
            }
            struct facet facet_j = facet_make(model->forest, roots[at.j]);
            struct link link;
            bool both_sky = scene_is_sky(model->scene, roots[line]) &&
                            scene_is_sky(model->scene, roots[at.j]);
            if (!both_sky && /* a sky reflects nothing */
                model->method.make_link(model, roots[line], &facet_i, roots[at.j],
                                        &facet_j, NULL, &link))
                link_list_append(&solver->links, link);
            number += solver->comm->size;
            step(&at, solver->comm->size, count);
        }
    }
    exchange_notices(solver);
    return solver->turn.stop == 0;
}

bool solver_link_roots(struct solver *solver)
{
    struct model *model = &solver->model;
    if (model->method.first_link) {
        if (solver->comm->rank == 0) /* the first levels deal its children */
            link_list_append(&solver->links, model->method.first_link());
        return true;
    }
    account_begin(&solver->account, PHASE_LINKING);
    int64_t before = model_work(model), count = 0;
    int32_t *roots = alloc_array((size_t)model->forest->root_count, sizeof *roots);
    for (int32_t root = 0; root < model->forest->root_count; root++)
        if (scene_root_area(model->scene, root) > 0.0)
            roots[count++] = root;
    bool done = link_pairs(solver, roots, count);
    alloc_free(roots);
    ledger_add(&solver->account.ledger,
               (struct phase_work){.kind = WORK_LINKING,
                                   .share = {.links = solver->links.count,
                                             .done = model_work(model) - before}});
    account_end(&solver->account, PHASE_LINKING);
    return done;
}
