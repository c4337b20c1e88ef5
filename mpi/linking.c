/* Steps 2 and 3: initial linking, and the homes of roots and links.
 *
 * Rows of the pairs of roots (rad/linking.h) are dealt by what they are expected to take, in
 * stages that make good what was wrong in the ones before (mpi/balance.h): while a stage is
 * worked on, all tell each other what they did before it, and what they left.
 *
 * Light is transferred over links where they live, so all ranks should have as many that carry
 * light (mpi/migrate.h). The paper (and --balance greedy) deals roots by their areas, and sends each link to
 * the home of one of its two roots, here the lower or the higher one by the parity of i + j; but the areas
 * of roots say little about the number of their links. */
#include "mpi/assign.h"
#include "mpi/balance.h"
#include "mpi/migrate.h"

#include <string.h>

#include "geom/alloc.h"
#include "rad/linking.h"

/* The rows while this rank links its parts of them. */
struct rows {
    struct solver *solver;
    struct linking *linking;
    int32_t count;
    struct row_news news; /* what is going to be told; news.clock as of `counted` */
    int64_t counted;      /* work of the method */
    int64_t predicted;    /* of the parts begun here */
};

static void wait_idle(struct solver *solver, MPI_Request *request)
{
    double start = comm_seconds();
    comm_wait(request);
    double idle = comm_seconds() - start;
    solver->seconds[PHASE_IDLE] += idle;
    solver->seconds[PHASE_LINKING] -= idle;
}

/* The clock goes on by the work since it was last asked for. */
static int64_t clock_now(struct rows *rows)
{
    int64_t now = method_work(&rows->solver->method);
    rows->news.clock += now - rows->counted;
    rows->counted = now;
    return rows->news.clock;
}

/* Links a part. If it is stopped, what is left is told to all, as far as there is room and there are
 * others, or else linked here, cut as they would. Returns what the rest of the row is expected to take,
 * if this is its sample. */
static int64_t link_row_part(struct rows *rows, const struct row_part *part, int64_t limit)
{
    int64_t before = method_work(&rows->solver->method), expected = 0;
    int32_t stop = part->is_sample ? linking_add_sample(rows->linking, part->place, part->from,
                                                        part->to, limit, &expected)
                                   : linking_add_part(rows->linking, part->place, part->from,
                                                      part->to, limit);
    int64_t work = method_work(&rows->solver->method) - before;
    rows->predicted += part->cost;
    if (stop == part->to)
        return expected;
    struct row_part rest = row_rest(part, stop, work);
    rows->predicted -= rest.cost < part->cost ? rest.cost : part->cost;
    if (row_news_add(&rows->news, &rest, rows->solver->comm->size))
        return expected;
    struct row_part cut[ROW_PARTS_MAX];
    int count = row_cut(&rest, cut);
    for (int i = 0; i < count; i++)
        link_row_part(rows, &cut[i], row_limit(&cut[i]));
    return expected;
}

/* Samples this rank's rows, and goes on with some of them until all know what the rests are expected to
 * take, rests[count], and what the samples of each rank took, rests[count + r]. */
static void link_samples(struct rows *rows, const int *sampler, int64_t *rests)
{
    const struct comm *comm = rows->solver->comm;
    size_t told = (size_t)rows->count + (size_t)comm->size;
    int64_t *own = alloc_array(told, sizeof *own);
    for (int32_t place = 0; place < rows->count; place++) {
        struct row_part sample = row_sample(rows->count, place,
                                            linking_sample_cost(rows->linking, place));
        if (sampler[place] == comm->rank)
            own[place] = link_row_part(rows, &sample, ROW_SAMPLE_LIMIT);
    }
    own[rows->count + comm->rank] = clock_now(rows);
    MPI_Request request;
    MPI_Iallreduce(own, rests, comm_count(comm, (int64_t)told), MPI_INT64_T, MPI_SUM, comm->handle,
                   &request);
    for (int32_t place = 0; place < rows->count; place++) {
        struct row_part whole = row_whole(rows->count, place, own[place]);
        if (sampler[place] == comm->rank && row_goes_on(place, own[place]))
            link_row_part(rows, &whole, row_limit(&whole));
    }
    wait_idle(rows->solver, &request);
    alloc_free(own);
}

static void link_stage(struct rows *rows, const struct row_deal *deal)
{
    const struct comm *comm = rows->solver->comm;
    int64_t before = method_work(&rows->solver->method);
    for (int64_t i = deal->first; i < deal->end; i++) {
        int64_t worked = method_work(&rows->solver->method) - before;
        if (deal->owner[i] != comm->rank || row_stage_is_over(deal, comm->rank, worked, &rows->news))
            continue;
        progress_tick(rows->solver->progress, (double)i / (double)deal->count);
        link_row_part(rows, &deal->parts[i], row_limit(&deal->parts[i]));
        rows->news.begun++;
    }
}

static int *deal_samples(const struct comm *comm, const struct linking *linking)
{
    int32_t rows = linking->tree->root_count;
    int *sampler = alloc_array((size_t)rows, sizeof *sampler);
    int64_t *costs = alloc_array((size_t)rows, sizeof *costs);
    for (int32_t place = 0; place < rows; place++)
        costs[place] = linking_sample_cost(linking, place);
    row_deal_samples(costs, rows, comm->size, sampler);
    alloc_free(costs);
    return sampler;
}

static void link_rows(struct rows *rows)
{
    const struct comm *comm = rows->solver->comm;
    int *sampler = deal_samples(comm, rows->linking);
    int64_t *rests = alloc_array((size_t)rows->count + (size_t)comm->size, sizeof *rests);
    struct row_news *all = alloc_array((size_t)comm->size, sizeof *all), told;
    size_t size = row_news_size(comm->size);
    uint8_t *heard = alloc_array((size_t)comm->size, size);
    link_samples(rows, sampler, rests);
    struct row_deal deal = row_deal_start(rests, sampler, rows->count, rests + rows->count,
                                          comm->size);
    do {
        MPI_Request request;
        clock_now(rows);
        rows->news.clock = row_clock(&deal, rows->news.clock);
        told = rows->news;
        rows->news.count = rows->news.begun = 0;
        row_deal_next(&deal);
        MPI_Iallgather(&told, (int)size, MPI_BYTE, heard, (int)size, MPI_BYTE, comm->handle, &request);
        link_stage(rows, &deal);
        wait_idle(rows->solver, &request);
        for (int r = 0; r < comm->size; r++)
            memcpy(&all[r], heard + (size_t)r * size, size);
    } while (row_deal_hear(&deal, all));
    row_deal_end(&deal);
    alloc_free(heard);
    alloc_free(all);
    alloc_free(rests);
    alloc_free(sampler);
}

void solver_link_roots(struct solver *solver)
{
    double start = comm_seconds();
    if (solver->tree) {
        solver_link_top(solver);
        return;
    }
    struct linking linking = linking_start(&solver->method, &solver->links);
    struct rows rows = {.solver = solver, .linking = &linking, .count = linking.tree->root_count,
                        .counted = method_work(&solver->method)};
    int64_t before = rows.counted;
    link_rows(&rows);
    struct phase_work phase = {.kind = WORK_LINKING, .links = linking.touched,
                               .predicted = rows.predicted,
                               .work = method_work(&solver->method) - before};
    ledger_add(&solver->ledger, phase);
    solver->pairs_touched = linking.touched;
    linking_end(&linking);
    solver->seconds[PHASE_LINKING] += comm_seconds() - start;
}

static uint32_t root_of(const struct solver *solver, int32_t patch)
{
    return solver->method.forest->patches[patch].id.root;
}

static void send_home(struct solver *solver)
{
    int *destination = alloc_array((size_t)solver->links.count, sizeof *destination);
    for (int64_t i = 0; i < solver->links.count; i++) {
        const struct link *link = &solver->links.items[i];
        uint32_t a = root_of(solver, link->p), b = root_of(solver, link->q);
        destination[i] = solver->owner[(a ^ b) % 2 == 0 ? a : b];
    }
    solver->bytes_migration += links_migrate(solver, &solver->links, destination);
    alloc_free(destination);
}

/* Areas, in parts of 2^-40 of all. */
static void weigh_by_area(const struct method *method, int64_t *weights)
{
    for (int32_t root = 0; root < scene_root_count(method->scene); root++)
        weights[root] = (int64_t)(scene_root_area(method->scene, root) / method->area * 0x1p40);
}

/* What there is to do at home. */
static void weigh_by_work(const struct method *method, int64_t *weights)
{
    for (int32_t root = 0; root < method->forest->root_count; root++)
        weights[root] = root_weight(method, root);
}

void solver_assign_roots(struct solver *solver)
{
    double start = comm_seconds();
    int32_t roots = solver->method.forest->root_count;
    bool greedy = solver->method.criterion.balance == BALANCE_GREEDY;
    int64_t *weights = alloc_array((size_t)roots, sizeof *weights);
    if (greedy)
        weigh_by_area(&solver->method, weights);
    else
        weigh_by_work(&solver->method, weights);
    roots_assign(weights, roots, solver->comm->size, solver->owner);
    alloc_free(weights);
    for (int32_t root = 0; root < roots; root++)
        solver->own[root] = solver->owner[root] == solver->comm->rank;
    if (greedy)
        send_home(solver);
    else
        links_even_out(solver);
    solver->seconds[PHASE_LINKING] += comm_seconds() - start;
}
