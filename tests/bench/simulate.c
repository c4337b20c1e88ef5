/* Replays one run on any number of ranks, in counts, and says where it stops scaling.
 *
 *   build/mpi/simulate SCENE.obj [options of phr]
 *
 * The run is made here, on one rank, and recorded: what the sample and each part of each row of
 * initial linking took, and for each link that was split where it came from, what was predicted
 * and what it took. The replay deals these with the functions that phr deals with
 * (mpi/balance.h, mpi/plan.h, mpi/assign.h) and needs no clock: a phase lasts as long as its
 * slowest rank, a rank that needs news of others waits for the slowest of them.
 *
 * Counts become seconds by what each took here: seconds per test (form factors included), per
 * link looked at, per link in a transfer, per own patch, per patch whose flux or radiosity is copied, own
 * ones out and in. Messages cost ALPHA each (an exchange with all takes log2 P of them, links take one from each
 * rank that sends some to each that gets some), bytes BETA each. Flux home, and radiosities back, are
 * BYTES_PER_PATCH for each patch that a rank keeps up to date and iteration, which has so many EXCHANGES:
 * these two, and the sums for a step. Ballots travel with the radiosities.
 *
 * One line of CSV for each number of ranks, as in tests/bench/scaling.sh; on stderr, what
 * dominates. What is not in the model: where links are not in cells, one that was moved to even out their
 * numbers is taken to be split where it was made; memory and its bandwidth. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "geom/alloc.h"
#include "io/obj.h"
#include "io/options.h"
#include "mpi/assign.h"
#include "mpi/balance.h"
#include "rad/linking.h"
#include "rad/oracle.h"
#include "tests/solve.h"

/* Seconds per message and per byte: a node of today; and the paper's Ethernet of 100 Mbit/s. */
static const double ALPHA = 2e-6, BETA = 1e-10, ALPHA_PAPER = 1e-4, BETA_PAPER = 8e-8;

/* Seconds to pack and unpack a byte of the links that move: 48 ns a link, as measured. */
static const double PACKING = 1.5e-9;

enum { BYTES_PER_PATCH = 24, BYTES_PER_LINK = 32, EXCHANGES = 3, RANKS_MOST = 4096 };

/* A part of a row, or its sample: its work, where it stopped, and its links that carry light and that do
 * not. */
struct unit {
    struct row_part part;
    int32_t stop;
    int64_t work, lit, dim;
};

/* A link that carries light, by the roots of its patches: that for the row of its cell first. */
struct pair {
    int32_t row, column;
};

struct pair_list {
    struct pair *items;
    int64_t count, capacity;
};

/* A link that was split, or one of the four children of a link, where these are made one by one. */
struct event {
    struct pair pair;
    int64_t origin; /* number of the event that made the link; initial links: -1 - the unit */
    int64_t load, work;
    bool was_lit;   /* something was seen of the link (and the event is that of its first child) */
    int64_t kept;   /* children of which something is seen and that were not split in the same pass */
};

struct level {
    int64_t first, end; /* events */
};

struct pass {
    int64_t first_level, end_level;
    int64_t looks;      /* what these took, */
    int32_t *looked[2]; /* [unit_count + events before] and how many links from each were not clear: dark
                           ones, and those that carry light, */
    struct pair_list looked_lit; /* which are these */
    int64_t iterations, patches;
    int32_t *of_root;   /* patches of each root */
    struct pair_list gained; /* links that carry light and that its splits have made, if they were not
                                split themselves */
};

struct record {
    int32_t rows;
    int64_t *first_unit;  /* [rows + 1] the sample; parts follow */
    int64_t *samples, *rests; /* [rows] what the sample, and what these are expected to take */
    struct pair_list initial; /* links that carry light */
    struct unit *units;
    struct event *events;
    struct level *levels;
    struct pass *passes;
    int64_t unit_count, unit_capacity, event_count, event_capacity, level_count, level_capacity;
    int64_t pass_count, pass_capacity;
    int64_t *origins;     /* of the solver's links, in their order */
    int64_t origin_count, origin_capacity;
    double seconds[WORK_COUNT]; /* that each kind of work took, */
    double counts[WORK_COUNT];  /* and how much of it there was */
};

/* --- recording --- */

/* Of this process: others may be on the machine. */
static double cpu_seconds(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

static void add_origin(struct record *record, int64_t origin)
{
    record->origins = alloc_reserve(record->origins, &record->origin_capacity,
                                    record->origin_count + 1, sizeof *record->origins);
    record->origins[record->origin_count++] = origin;
}

static struct pair pair_of(const struct forest *forest, const struct link *link)
{
    struct patch_id p = forest->patches[link->p].id, q = forest->patches[link->q].id;
    int32_t a = (int32_t)p.root, b = (int32_t)q.root;
    return grid_turns(p, q) ? (struct pair){b, a} : (struct pair){a, b};
}

static void add_pair(struct pair_list *list, const struct forest *forest, const struct link *link)
{
    if (link->seen == 0)
        return;
    list->items = alloc_reserve(list->items, &list->capacity, list->count + 1, sizeof *list->items);
    list->items[list->count++] = pair_of(forest, link);
}

static void add_unit(struct record *record, struct solver *solver, struct unit unit)
{
    for (int64_t i = record->origin_count; i < solver->links.count; i++) {
        const struct link *link = &solver->links.items[i];
        unit.lit += link->seen > 0;
        unit.dim += link->seen == 0;
        add_pair(&record->initial, solver->method.forest, link);
    }
    record->units = alloc_reserve(record->units, &record->unit_capacity, record->unit_count + 1,
                                  sizeof *record->units);
    record->units[record->unit_count++] = unit;
    while (record->origin_count < solver->links.count)
        add_origin(record, -record->unit_count);
}

static void record_rest(struct record *record, struct solver *solver, struct linking *linking,
                        const struct row_part *rest);

/* Records a part, and what is left of it; *expected: for the sample of a row. */
static void record_part(struct record *record, struct solver *solver, struct linking *linking,
                        const struct row_part *part, int64_t limit, int64_t *expected)
{
    int64_t before = method_work(&solver->method);
    struct unit unit = {.part = *part};
    unit.stop = part->is_sample ? linking_add_sample(linking, part->place, part->from, part->to, limit,
                                                     expected)
                                : linking_add_part(linking, part->place, part->from, part->to, limit);
    unit.work = method_work(&solver->method) - before;
    add_unit(record, solver, unit);
    if (unit.stop == part->to)
        return;
    struct row_part rest = row_rest(part, unit.stop, unit.work);
    record_rest(record, solver, linking, &rest);
}

static void record_rest(struct record *record, struct solver *solver, struct linking *linking,
                        const struct row_part *rest)
{
    struct row_part cut[ROW_PARTS_MAX];
    int count = row_cut(rest, cut);
    for (int i = 0; i < count; i++)
        record_part(record, solver, linking, &cut[i], row_limit(&cut[i]), NULL);
}

static void record_linking(struct record *record, struct solver *solver)
{
    double start = cpu_seconds();
    struct linking linking = linking_start(&solver->method, &solver->links);
    record->rows = linking.tree->root_count;
    record->first_unit = alloc_array((size_t)record->rows + 1, sizeof *record->first_unit);
    record->rests = alloc_array((size_t)record->rows, sizeof *record->rests);
    record->samples = alloc_array((size_t)record->rows, sizeof *record->samples);
    for (int32_t place = 0; place < record->rows; place++) {
        record->samples[place] = linking_sample_cost(&linking, place);
        record->first_unit[place] = record->unit_count;
        struct row_part sample = row_sample(record->rows, place, record->samples[place]);
        record_part(record, solver, &linking, &sample, ROW_SAMPLE_LIMIT, &record->rests[place]);
        struct row_part whole = row_whole(record->rows, place, record->rests[place]);
        if (row_goes_on(place, whole.cost))
            record_part(record, solver, &linking, &whole, row_limit(&whole), NULL);
        else
            record_rest(record, solver, &linking, &whole);
    }
    record->first_unit[record->rows] = record->unit_count;
    linking_end(&linking);
    record->seconds[WORK_LINKING] = cpu_seconds() - start;
    record->counts[WORK_LINKING] = (double)method_work(&solver->method);
}

/* Links to be split, with where they came from; of unmade children one is the first. */
struct batch {
    struct link_list links;
    int64_t *origins;
    bool *first;
    int64_t count, capacity, first_capacity;
};

static void batch_add(struct batch *batch, struct link link, int64_t origin, bool is_first)
{
    link_list_append(&batch->links, link);
    batch->first = alloc_reserve(batch->first, &batch->first_capacity, batch->count + 1,
                                 sizeof *batch->first);
    batch->first[batch->count] = is_first;
    batch->origins = alloc_reserve(batch->origins, &batch->capacity, batch->count + 1,
                                   sizeof *batch->origins);
    batch->origins[batch->count++] = origin;
}

static void batch_free(struct batch *batch)
{
    link_list_free(&batch->links);
    alloc_free(batch->origins);
    alloc_free(batch->first);
    *batch = (struct batch){0};
}

/* As in mpi/refinement.c. Returns how many links have been split. */
static int64_t name_children(struct solver *solver, struct batch *batch)
{
    struct batch named = {.count = 0};
    int64_t split = batch->count;
    for (int64_t i = 0; i < batch->count; i++) {
        const struct link *link = &batch->links.items[i];
        struct link children[4] = {*link};
        bool partly = link_is_partly_seen(link);
        if (partly)
            link_split_unmade(&solver->method, link, oracle_patch_to_split(&solver->method, link), children);
        for (int k = 0; k < (partly ? 4 : 1); k++)
            batch_add(&named, children[k], batch->origins[i], k == 0);
    }
    batch_free(batch);
    *batch = named;
    return split;
}

/* Units first, then events. */
static int64_t place_of_origin(const struct record *record, int64_t origin)
{
    return origin < 0 ? -1 - origin : record->unit_count + origin;
}

static void record_looks(struct record *record, struct solver *solver, struct pass *pass,
                         struct batch *batch)
{
    double start = cpu_seconds();
    int64_t kept = 0;
    pass->looks = solver->links.count;
    for (int lit = 0; lit < 2; lit++)
        pass->looked[lit] = alloc_array((size_t)(record->unit_count + record->event_count),
                                        sizeof *pass->looked[lit]);
    for (int64_t i = 0; i < solver->links.count; i++) {
        struct link link = solver->links.items[i];
        if (!oracle_is_clear(&solver->method, &link)) {
            pass->looks += LOOK_LOAD - 1;
            pass->looked[link.seen > 0][place_of_origin(record, record->origins[i])]++;
            add_pair(&pass->looked_lit, solver->method.forest, &link);
            if (oracle_patch_to_split(&solver->method, &link) >= 0) {
                batch_add(batch, link, record->origins[i], true);
                continue;
            }
            oracle_divide_patches(&solver->method, &link);
        }
        record->origins[kept] = record->origins[i];
        solver->links.items[kept++] = link;
    }
    record->counts[WORK_LOOKS] += (double)pass->looks;
    solver->links.count = record->origin_count = kept;
    record->seconds[WORK_LOOKS] += cpu_seconds() - start;
}

static void split_one(struct record *record, struct solver *solver, const struct batch *batch,
                      int64_t i, struct batch *next, struct pair_list *gained)
{
    const struct link *link = &batch->links.items[i];
    struct event event = {.pair = pair_of(solver->method.forest, link), .origin = batch->origins[i],
                          .load = link_load(link), .was_lit = batch->first[i] && link->seen > 0,
                          .work = -method_work(&solver->method)};
    struct link children[4] = {*link};
    int count = link->seen == LINK_UNMADE
                    ? link_finish(&solver->method, children)
                    : link_split(&solver->method, link, oracle_patch_to_split(&solver->method, link),
                                 children);
    for (int k = 0; k < count; k++) {
        if (oracle_patch_to_split(&solver->method, &children[k]) >= 0) {
            batch_add(next, children[k], record->event_count, true);
            continue;
        }
        oracle_divide_patches(&solver->method, &children[k]);
        link_list_append(&solver->links, children[k]);
        add_origin(record, record->event_count);
        event.kept += children[k].seen > 0;
        add_pair(gained, solver->method.forest, &children[k]);
    }
    event.work += method_work(&solver->method);
    record->events = alloc_reserve(record->events, &record->event_capacity,
                                   record->event_count + 1, sizeof *record->events);
    record->events[record->event_count++] = event;
}

static void record_levels(struct record *record, struct solver *solver, struct batch *batch,
                          struct pair_list *gained)
{
    double start = cpu_seconds();
    int64_t before = method_work(&solver->method);
    while (batch->count > 0) {
        struct batch next = {.count = 0};
        struct level level = {.first = record->event_count};
        solver->split_here += name_children(solver, batch);
        for (int64_t i = 0; i < batch->count; i++)
            split_one(record, solver, batch, i, &next, gained);
        level.end = record->event_count;
        record->levels = alloc_reserve(record->levels, &record->level_capacity,
                                       record->level_count + 1, sizeof *record->levels);
        record->levels[record->level_count++] = level;
        batch_free(batch);
        *batch = next;
    }
    batch_free(batch);
    record->seconds[WORK_SPLITTING] += cpu_seconds() - start;
    record->counts[WORK_SPLITTING] += (double)(method_work(&solver->method) - before);
}

/* The seconds of what comes between the clocks. */
static void charge(struct record *record, enum work kind, double *clock)
{
    double now = cpu_seconds();
    record->seconds[kind] += now - *clock;
    *clock = now;
}

/* Moves origins as link_list_sort() is going to move the links. */
static void sort_origins(struct record *record, const struct link_list *links)
{
    int64_t *sorted = alloc_array((size_t)links->count, sizeof *sorted), first = 0;
    int64_t end = links->count, at = 0;
    while (first < end) {
        bool is_seen = links->items[at].seen > 0;
        sorted[is_seen ? first++ : --end] = record->origins[at];
        at = is_seen ? first : end;
    }
    memcpy(record->origins, sorted, (size_t)links->count * sizeof *sorted);
    alloc_free(sorted);
}

/* What solve_links() does. */
static struct vote record_solution(struct record *record, struct solver *solver)
{
    struct vote vote;
    sort_origins(record, &solver->links);
    solver_close(solver);
    double clock = cpu_seconds();
    do {
        int64_t before = solver->copied;
        solver_transfer(solver);
        charge(record, WORK_TRANSFER, &clock);
        solver_gather(solver);
        charge(record, WORK_PATCHES, &clock);
        solver_push_pull(solver);
        charge(record, WORK_OWN, &clock);
        solver_scatter(solver);
        charge(record, WORK_PATCHES, &clock);
        record->counts[WORK_PATCHES] += (double)(solver->copied - before);
        vote = solver_vote(solver);
        charge(record, WORK_OWN, &clock);
    } while (vote.again);
    return vote;
}

/* What solver_refine() does on one rank; then the solution. */
static struct vote record_pass(struct record *record, struct solver *solver)
{
    struct forest *forest = solver->method.forest;
    struct pass pass = {.first_level = record->level_count};
    struct batch batch = {.count = 0};
    solver_begin_pass(solver);
    record_looks(record, solver, &pass, &batch);
    record_levels(record, solver, &batch, &pass.gained);
    solver->shared = forest->count;
    pass.end_level = record->level_count;
    pass.patches = forest->count;
    pass.of_root = alloc_array((size_t)forest->root_count, sizeof *pass.of_root);
    for (int64_t p = 0; p < forest->count; p++)
        pass.of_root[forest->patches[p].id.root]++;
    int64_t before = solver->iteration;
    struct vote vote = record_solution(record, solver);
    pass.iterations = solver->iteration - before;
    record->counts[WORK_TRANSFER] += (double)(pass.iterations * solver->links.seen);
    record->counts[WORK_OWN] += (double)(pass.iterations * pass.patches);
    record->passes = alloc_reserve(record->passes, &record->pass_capacity, record->pass_count + 1,
                                   sizeof *record->passes);
    record->passes[record->pass_count++] = pass;
    return vote;
}

static void record_run(struct record *record, struct solver *solver, const struct criterion *criterion)
{
    struct vote vote;
    record_linking(record, solver);
    solver_assign_roots(solver);
    do {
        vote = record_pass(record, solver);
    } while (!(vote.converged && solver_is_accurate(solver)) && !vote.diverged &&
             solver->iteration < criterion->max_iterations);
}

static void record_free(struct record *record)
{
    for (int64_t i = 0; i < record->pass_count; i++) {
        alloc_free(record->passes[i].of_root);
        alloc_free(record->passes[i].looked[0]);
        alloc_free(record->passes[i].looked[1]);
        alloc_free(record->passes[i].looked_lit.items);
        alloc_free(record->passes[i].gained.items);
    }
    alloc_free(record->initial.items);
    alloc_free(record->first_unit);
    alloc_free(record->samples);
    alloc_free(record->rests);
    alloc_free(record->units);
    alloc_free(record->events);
    alloc_free(record->levels);
    alloc_free(record->passes);
    alloc_free(record->origins);
}

/* --- replaying --- */

struct replay {
    const struct record *record;
    int ranks;
    struct grid square;
    bool in_cells;               /* links that carry light are in the cells of the square grid */
    int *owner;                  /* [roots] */
    int64_t *cells;              /* [ranks] how many would be there */
    int64_t *astray;             /* [ranks] made there since they were last placed, or all */
    int32_t *of_unit, *of_event; /* the rank that had it */
    int64_t *links;              /* [ranks] that live there and carry light */
    int64_t *dim;                /* [ranks] others */
    double slowest[WORK_COUNT], all[WORK_COUNT];
    double messages, bytes;      /* of the rank that has most, one after the other */
    double migration;            /* bytes of all ranks */
};

static double most_of(const int64_t *values, int ranks)
{
    int64_t most = 0;
    for (int r = 0; r < ranks; r++)
        most = values[r] > most ? values[r] : most;
    return (double)most;
}

static double sum_of(const int64_t *values, int ranks)
{
    double sum = 0.0;
    for (int r = 0; r < ranks; r++)
        sum += (double)values[r];
    return sum;
}

/* An exchange with all of `bytes` arriving. */
static void exchange(struct replay *replay, double bytes)
{
    replay->messages += ceil(log2(replay->ranks));
    replay->bytes += bytes;
}

/* A unit is done by a rank: `done` grows by its work. */
static void do_unit(struct replay *replay, int64_t unit, int rank, int64_t *done)
{
    done[rank] += replay->record->units[unit].work;
    replay->links[rank] += replay->record->units[unit].lit;
    replay->astray[rank] += replay->record->units[unit].lit;
    replay->dim[rank] += replay->record->units[unit].dim;
    replay->of_unit[unit] = rank;
}

/* Each rank's clock is its work and its waits. `news` is when the last rank has told. */
static void wait_for(double *clocks, int ranks, double news)
{
    for (int r = 0; r < ranks; r++)
        clocks[r] = fmax(clocks[r], news);
}

static double latest(const double *clocks, int ranks)
{
    double last = 0.0;
    for (int r = 0; r < ranks; r++)
        last = fmax(last, clocks[r]);
    return last;
}

static void advance(double *clocks, const int64_t *done, const int64_t *before, int ranks)
{
    for (int r = 0; r < ranks; r++)
        clocks[r] += (double)(done[r] - before[r]);
}

/* As link_row_part() in mpi/linking.c. */
static void do_part(struct replay *replay, const struct row_part *part, int rank, int64_t *done,
                    struct row_news *news)
{
    const struct record *record = replay->record;
    int64_t at = record->first_unit[part->place];
    while (at < record->first_unit[part->place + 1] &&
           (record->units[at].part.from != part->from ||
            record->units[at].part.is_sample != part->is_sample))
        at++;
    if (at == record->first_unit[part->place + 1]) {
        fprintf(stderr, "simulate: the replay cuts other parts than the run did\n");
        exit(EXIT_FAILURE);
    }
    const struct unit *unit = &record->units[at];
    do_unit(replay, at, rank, done);
    if (unit->stop == part->to)
        return;
    struct row_part rest = row_rest(part, unit->stop, unit->work), cut[ROW_PARTS_MAX];
    if (row_news_add(news, &rest, replay->ranks))
        return;
    int count = row_cut(&rest, cut);
    for (int i = 0; i < count; i++)
        do_part(replay, &cut[i], rank, done, news);
}

/* As in mpi/linking.c. */
static void replay_linking(struct replay *replay)
{
    const struct record *record = replay->record;
    int ranks = replay->ranks;
    int64_t *done = alloc_array(2 * (size_t)ranks, sizeof *done), *before = done + ranks;
    double *clocks = alloc_array((size_t)ranks, sizeof *clocks);
    struct row_news *own = alloc_array(2 * (size_t)ranks, sizeof *own), *told = own + ranks;
    int *sampler = alloc_array((size_t)record->rows, sizeof *sampler);
    row_deal_samples(record->samples, record->rows, ranks, sampler);
    for (int32_t place = 0; place < record->rows; place++) {
        struct row_part sample = row_sample(record->rows, place, record->samples[place]);
        do_part(replay, &sample, sampler[place], done, &own[sampler[place]]);
    }
    advance(clocks, done, before, ranks);
    double news = latest(clocks, ranks);
    memcpy(before, done, (size_t)ranks * sizeof *done);
    struct row_deal deal = row_deal_start(record->rests, sampler, record->rows, done, ranks);
    for (int32_t place = 0; place < record->rows; place++) {
        struct row_part whole = row_whole(record->rows, place, record->rests[place]);
        int rank = sampler[place];
        if (row_goes_on(place, whole.cost))
            do_part(replay, &whole, rank, done, &own[rank]);
    }
    advance(clocks, done, before, ranks);
    wait_for(clocks, ranks, news);
    exchange(replay, 8.0 * (record->rows + ranks));
    do {
        news = latest(clocks, ranks);
        memcpy(before, done, (size_t)ranks * sizeof *done);
        for (int r = 0; r < ranks; r++) {
            told[r] = own[r];
            told[r].clock = (int64_t)clocks[r];
            own[r].count = own[r].begun = 0;
        }
        row_deal_next(&deal);
        for (int64_t i = deal.first; i < deal.end; i++) {
            int rank = deal.owner[i];
            if (row_stage_is_over(&deal, rank, done[rank] - before[rank], &own[rank]))
                continue;
            do_part(replay, &deal.parts[i], rank, done, &own[rank]);
            own[rank].begun++;
        }
        advance(clocks, done, before, ranks);
        wait_for(clocks, ranks, news);
        exchange(replay, (double)row_news_size(ranks) * ranks);
    } while (row_deal_hear(&deal, told));
    replay->slowest[WORK_LINKING] = latest(clocks, ranks);
    replay->all[WORK_LINKING] = sum_of(done, ranks);
    row_deal_end(&deal);
    alloc_free(sampler);
    alloc_free(clocks);
    alloc_free(done);
    alloc_free(own);
}

/* Links move as planned: they are counted, and packed into messages. */
static void move_links(struct replay *replay, const struct transfer *plan, int planned, double bytes)
{
    int64_t *partners = alloc_array((size_t)replay->ranks, sizeof *partners);
    for (int t = 0; t < planned; t++) {
        partners[plan[t].from]++;
        partners[plan[t].to]++;
    }
    exchange(replay, 0.0);
    replay->messages += most_of(partners, replay->ranks);
    replay->bytes += bytes;
    alloc_free(partners);
}

static int cell_of(const struct replay *replay, struct pair pair)
{
    return grid_cell(replay->square, replay->owner[pair.row], replay->owner[pair.column]);
}

static void count_cells(struct replay *replay, const struct pair_list *pairs)
{
    for (int64_t i = 0; i < pairs->count; i++)
        replay->cells[cell_of(replay, pairs->items[i])]++;
}

/* As send_to_cells(): in two hops, and to fewer ranks than there are links. */
static void send_to_cells(struct replay *replay)
{
    int ranks = replay->ranks, reached[] = {replay->square.columns, replay->square.rows};
    double most = most_of(replay->astray, ranks);
    for (int hop = 0; hop < 2; hop++) {
        exchange(replay, 0.0);
        replay->messages += 2.0 * fmin(most, reached[hop] - 1);
        replay->bytes += BYTES_PER_LINK * most;
        replay->migration += BYTES_PER_LINK * sum_of(replay->astray, ranks);
    }
    memcpy(replay->links, replay->cells, (size_t)ranks * sizeof *replay->links);
}

/* As where links are too uneven in cells. */
static void even_out(struct replay *replay)
{
    int ranks = replay->ranks;
    double sum = sum_of(replay->links, ranks), most = most_of(replay->links, ranks);
    if (most * ranks <= 1.02 * sum)
        return;
    struct transfer *plan = alloc_array(2 * (size_t)ranks, sizeof *plan);
    int planned = plan_transfers(replay->links, ranks, plan);
    for (int t = 0; t < planned; t++)
        replay->migration += BYTES_PER_LINK * (double)plan[t].load;
    move_links(replay, plan, planned, BYTES_PER_LINK * (most - sum / ranks));
    alloc_free(plan);
    for (int r = 0; r < ranks; r++)
        replay->links[r] = (int64_t)sum / ranks + (r < (int64_t)sum % ranks);
}

/* As links_want_cells(). */
static bool cells_may_pay(const struct replay *replay, int64_t lit, int64_t patches)
{
    int64_t astray = replay->in_cells ? 0 : lit - lit / replay->ranks;
    return grid_pays(replay->square, lit, lit / replay->ranks, patches, astray);
}

/* As links_place(). */
static void place_links(struct replay *replay, int64_t patches)
{
    size_t bytes = (size_t)replay->ranks * sizeof *replay->links;
    int64_t lit = (int64_t)sum_of(replay->links, replay->ranks);
    exchange(replay, 8.0 * replay->ranks);
    if (!replay->in_cells)
        memcpy(replay->astray, replay->links, bytes);
    bool may = replay->in_cells || cells_may_pay(replay, lit, patches);
    if (may)
        exchange(replay, 8.0 * replay->ranks);
    replay->in_cells = may && grid_pays(replay->square, lit, (int64_t)most_of(replay->cells, replay->ranks),
                                        patches, (int64_t)sum_of(replay->astray, replay->ranks));
    if (replay->in_cells)
        send_to_cells(replay);
    else
        even_out(replay);
    memset(replay->astray, 0, bytes);
}

/* Deals one level's events that are on `rank`, at[0 .. count - 1]. */
static void deal_events(struct replay *replay, const int64_t *at, int64_t count, int rank,
                        const struct transfer *plan, int planned, int64_t *sent)
{
    int64_t *costs = alloc_array((size_t)count, sizeof *costs);
    int *destination = alloc_array((size_t)count, sizeof *destination);
    for (int64_t i = 0; i < count; i++)
        costs[i] = replay->record->events[at[i]].load;
    links_deal_out(costs, count, plan, planned, rank, destination);
    for (int64_t i = 0; i < count; i++) {
        replay->of_event[at[i]] = destination[i];
        sent[rank] += destination[i] != rank ? BYTES_PER_LINK : 0;
    }
    alloc_free(destination);
    alloc_free(costs);
}

/* As exchange_loads() and deal_links() in mpi/refinement.c: deals the events `at`, puts them in the order of their
 * ranks before that, and returns the work after which ranks leave the rest. */
static int64_t balance_stage(struct replay *replay, int64_t *at, int64_t count, int stage)
{
    const struct record *record = replay->record;
    int ranks = replay->ranks;
    int64_t *loads = alloc_array(3 * (size_t)ranks + 1, sizeof *loads);
    int64_t *sent = loads + ranks, *first = sent + ranks;
    int64_t *sorted = alloc_array((size_t)count, sizeof *sorted);
    struct transfer *plan = alloc_array(2 * (size_t)ranks, sizeof *plan);
    for (int64_t i = 0; i < count; i++) {
        int rank = replay->of_event[at[i]];
        loads[rank] += record->events[at[i]].load;
        first[rank + 1]++;
    }
    for (int r = 0; r < ranks; r++)
        first[r + 1] += first[r];
    int64_t limit = links_limit(loads, ranks, stage);
    int planned = moving_pays(loads, ranks) ? plan_transfers(loads, ranks, plan) : 0;
    for (int64_t i = count - 1; i >= 0; i--) /* ranks end where they began */
        sorted[--first[replay->of_event[at[i]] + 1]] = at[i];
    memcpy(at, sorted, (size_t)count * sizeof *at);
    if (planned > 0) {
        for (int r = 0; r < ranks; r++)
            deal_events(replay, at + first[r + 1], (r + 1 < ranks ? first[r + 2] : count) - first[r + 1], r,
                        plan, planned, sent);
        move_links(replay, plan, planned, most_of(sent, ranks));
        replay->migration += sum_of(sent, ranks);
    }
    exchange(replay, 40.0 * ranks);
    alloc_free(plan);
    alloc_free(sorted);
    alloc_free(loads);
    return limit;
}

static void replay_level(struct replay *replay, const struct level *level)
{
    const struct record *record = replay->record;
    int64_t count = level->end - level->first, limit = 0;
    int64_t *at = alloc_array((size_t)count, sizeof *at);
    for (int64_t i = 0; i < count; i++)
        at[i] = level->first + i;
    for (int stage = 0; limit < INT64_MAX; stage++) {
        int64_t *work = alloc_array((size_t)replay->ranks, sizeof *work), left = 0;
        limit = balance_stage(replay, at, count, stage);
        for (int64_t i = 0; i < count; i++) {
            const struct event *event = &record->events[at[i]];
            int rank = replay->of_event[at[i]];
            if (work[rank] >= limit) {
                at[left++] = at[i];
                continue;
            }
            work[rank] += event->work;
            replay->links[rank] += event->kept;
            replay->astray[rank] += event->kept;
        }
        count = left;
        replay->slowest[WORK_SPLITTING] += most_of(work, replay->ranks);
        replay->all[WORK_SPLITTING] += sum_of(work, replay->ranks);
        alloc_free(work);
    }
    alloc_free(at);
}

/* Own patches of the rank that has most, and those that the rank with most keeps up to date. */
struct share {
    int64_t own, renewed;
};

static struct share largest_share(const struct replay *replay, const struct pass *pass, int32_t roots)
{
    struct grid grid = replay->in_cells ? replay->square : (struct grid){1, replay->ranks};
    int64_t *own = alloc_array(3 * (size_t)replay->ranks, sizeof *own);
    int64_t *in_row = own + replay->ranks, *in_column = in_row + replay->ranks;
    struct share most = {0, 0};
    for (int32_t root = 0; root < roots; root++) {
        int home = replay->owner[root];
        own[home] += pass->of_root[root];
        in_row[home / grid.columns] += pass->of_root[root];
        in_column[home % grid.columns] += pass->of_root[root];
    }
    for (int r = 0; r < replay->ranks; r++) {
        int64_t renewed = in_row[r / grid.columns];
        renewed += grid.rows > 1 ? in_column[r % grid.columns] : 0;
        most.own = own[r] > most.own ? own[r] : most.own;
        most.renewed = renewed > most.renewed ? renewed : most.renewed;
    }
    alloc_free(own);
    return most;
}

static void replay_solution(struct replay *replay, const struct pass *pass, int32_t roots)
{
    double ranks = replay->ranks, times = (double)pass->iterations;
    double links = most_of(replay->links, replay->ranks), patches = (double)pass->patches;
    struct share most = largest_share(replay, pass, roots);
    double renewed = times * 2.0 * (double)most.renewed + patches; /* and in the end all */
    double copied = renewed + (times * 2.0 + 1.0) * (double)most.own;
    replay->slowest[WORK_TRANSFER] += times * links;
    replay->all[WORK_TRANSFER] += times * sum_of(replay->links, replay->ranks);
    replay->slowest[WORK_OWN] += times * (double)most.own;
    replay->all[WORK_OWN] += times * patches;
    replay->slowest[WORK_PATCHES] += copied;
    replay->all[WORK_PATCHES] += copied * ranks;
    if (replay->ranks == 1)
        return;
    double ballots = replay->in_cells ? replay->square.rows + replay->square.columns : ranks;
    replay->messages += (times * EXCHANGES + 1.0) * ceil(log2(ranks));
    replay->bytes += (BYTES_PER_PATCH * renewed + (times + 1.0) * (double)sizeof(struct ballot) * ballots) *
                     (ranks - 1.0) / ranks;
}

/* Of the rank that has most to look at, before its pass. */
static double most_looks(const struct replay *replay, const struct pass *pass)
{
    const struct record *record = replay->record;
    int64_t events = pass->first_level < record->level_count
                         ? record->levels[pass->first_level].first : record->event_count;
    int64_t *looks = alloc_array((size_t)replay->ranks, sizeof *looks);
    for (int r = 0; r < replay->ranks; r++)
        looks[r] = replay->links[r] + replay->dim[r];
    for (int lit = 0; lit < 2 - replay->in_cells; lit++) {
        const int32_t *looked = pass->looked[lit];
        for (int64_t i = 0; i < record->unit_count; i++)
            looks[replay->of_unit[i]] += (LOOK_LOAD - 1) * looked[i];
        for (int64_t i = 0; i < events; i++)
            looks[replay->of_event[i]] += (LOOK_LOAD - 1) * looked[record->unit_count + i];
    }
    for (int64_t i = 0; i < pass->looked_lit.count && replay->in_cells; i++)
        looks[cell_of(replay, pass->looked_lit.items[i])] += LOOK_LOAD - 1;
    double most = most_of(looks, replay->ranks);
    alloc_free(looks);
    return most;
}

/* As solver_assign_roots(). */
static void assign_roots(struct replay *replay, const struct method *method)
{
    const struct pair_list *initial = &replay->record->initial;
    int32_t roots = method->forest->root_count;
    int64_t *weights = alloc_array((size_t)roots, sizeof *weights);
    for (int32_t root = 0; root < roots; root++)
        weights[root] = root_weight(method, root);
    bool want_cells = cells_may_pay(replay, initial->count, roots);
    for (int64_t i = 0; i < initial->count && want_cells; i++) {
        weights[initial->items[i].row]++;
        weights[initial->items[i].column]++;
    }
    roots_assign(weights, roots, replay->ranks, replay->owner);
    exchange(replay, 8.0);
    if (want_cells)
        exchange(replay, 8.0 * roots);
    alloc_free(weights);
}

static void replay_run(struct replay *replay, const struct method *method)
{
    const struct record *record = replay->record;
    int32_t roots = method->forest->root_count;
    replay->owner = alloc_array((size_t)roots, sizeof *replay->owner);
    replay->cells = alloc_array((size_t)replay->ranks, sizeof *replay->cells);
    replay->astray = alloc_array((size_t)replay->ranks, sizeof *replay->astray);
    replay->of_unit = alloc_array((size_t)record->unit_count, sizeof *replay->of_unit);
    replay->of_event = alloc_array((size_t)record->event_count, sizeof *replay->of_event);
    replay->links = alloc_array((size_t)replay->ranks, sizeof *replay->links);
    replay->dim = alloc_array((size_t)replay->ranks, sizeof *replay->dim);
    replay_linking(replay);
    assign_roots(replay, method);
    count_cells(replay, &record->initial);
    place_links(replay, roots);
    for (int64_t k = 0; k < record->pass_count; k++) {
        const struct pass *pass = &record->passes[k];
        replay->slowest[WORK_LOOKS] += most_looks(replay, pass);
        replay->all[WORK_LOOKS] += (double)pass->looks;
        for (int64_t l = pass->first_level; l < pass->end_level; l++) {
            const struct level *level = &record->levels[l];
            for (int64_t i = level->first; i < level->end; i++) {
                const struct event *event = &record->events[i];
                bool selected = l == pass->first_level && event->was_lit;
                int cell = cell_of(replay, event->pair);
                replay->of_event[i] = selected && replay->in_cells ? cell
                                      : event->origin < 0 ? replay->of_unit[-1 - event->origin]
                                                          : replay->of_event[event->origin];
                replay->links[replay->of_event[i]] -= selected;
                replay->cells[cell] -= selected;
            }
            replay_level(replay, level);
        }
        count_cells(replay, &pass->gained);
        place_links(replay, pass->patches);
        replay_solution(replay, pass, roots);
    }
    alloc_free(replay->owner);
    alloc_free(replay->cells);
    alloc_free(replay->astray);
    alloc_free(replay->of_unit);
    alloc_free(replay->of_event);
    alloc_free(replay->links);
    alloc_free(replay->dim);
}

/* --- what comes out --- */

static const char *const NAMES[WORK_COUNT] = {"linking", "looks", "splitting", "transfer",
                                              "own patches", "all patches"};

static double price_of(const struct record *record, int kind)
{
    return record->counts[kind] > 0.0 ? record->seconds[kind] / record->counts[kind] : 0.0;
}

static void print_replay(const struct replay *replay, const char *scene)
{
    const struct record *record = replay->record;
    double ranks = replay->ranks, once = 0.0, shared = 0.0, parts = 0.0;
    for (int kind = 0; kind < WORK_COUNT; kind++)
        once += record->seconds[kind];
    for (int kind = 0; kind < WORK_PATCHES; kind++) {
        shared += price_of(record, kind) * replay->slowest[kind];
        parts += price_of(record, kind) * replay->all[kind] / ranks;
    }
    double copies = price_of(record, WORK_PATCHES) * replay->slowest[WORK_PATCHES] +
                    PACKING * replay->migration / ranks;
    double talk = ALPHA * replay->messages + BETA * replay->bytes;
    double paper = ALPHA_PAPER * replay->messages + BETA_PAPER * replay->bytes;
    printf("%s,simulated,%d,%.6g,%.2f,%.4f,%.2f,%.2f,%.4f,%.2f\n", scene, replay->ranks,
           shared + copies + talk, parts / shared * ranks, 1.0 - parts / shared,
           once / (shared + copies), once / (shared + copies + talk),
           1e-6 * replay->migration, once / (shared + copies + paper));
    fprintf(stderr, "%5d ranks:", replay->ranks);
    for (int kind = 0; kind < WORK_COUNT; kind++)
        fprintf(stderr, " %s %.4g s (idle %.1f %%),", NAMES[kind],
                price_of(record, kind) * replay->slowest[kind],
                kind == WORK_PATCHES || replay->slowest[kind] <= 0.0
                    ? 0.0 : 100.0 * (1.0 - replay->all[kind] / ranks / replay->slowest[kind]));
    fprintf(stderr, " messages %.4g s, bytes %.4g s\n", ALPHA * replay->messages, BETA * replay->bytes);
}

static void print_record(const struct record *record, const char *scene)
{
    int64_t largest = 0;
    for (int64_t i = 0; i < record->unit_count; i++)
        largest = record->units[i].work > largest ? record->units[i].work : largest;
    fprintf(stderr, "%s: %lld parts of rows, the largest %.2g of all; %lld links split in %lld levels, "
            "%lld passes\n", scene, (long long)record->unit_count,
            (double)largest / record->counts[WORK_LINKING], (long long)record->event_count,
            (long long)record->level_count, (long long)record->pass_count);
    for (int kind = 0; kind < WORK_COUNT; kind++)
        fprintf(stderr, "  %s: %.4g, %.4g ns each\n", NAMES[kind], record->counts[kind],
                1e9 * price_of(record, kind));
}

static void simulate(const struct comm *comm, const struct options *options, struct error *error)
{
    struct obj_repairs read = {0};
    struct scene_repairs prepared;
    struct scene *scene = obj_read(options->scene, &read, error);
    if (!scene)
        return;
    if (scene_prepare(scene, &prepared, error)) {
        struct record record = {.rows = 0};
        struct octree *octree = octree_create(scene->triangles, scene->planes, scene->input_count);
        struct solver *solver = solver_create(comm, scene, octree, &options->criterion);
        record_run(&record, solver, &options->criterion);
        print_record(&record, options->scene);
        for (int ranks = 1; ranks <= RANKS_MOST; ranks *= 2) {
            struct replay replay = {.record = &record, .ranks = ranks, .square = grid_make(ranks)};
            replay_run(&replay, &solver->method);
            print_replay(&replay, options->scene);
        }
        record_free(&record);
        solver_destroy(solver);
        octree_destroy(octree);
    }
    scene_destroy(scene);
}

int main(int argc, char **argv)
{
    struct comm comm;
    struct options options;
    struct error error = {0};
    comm_start(&comm, &argc, &argv);
    if (comm.size > 1)
        error_set(&error, EXIT_USAGE, "simulate runs on one rank");
    else if (options_parse(&options, argc, argv, &error))
        simulate(&comm, &options, &error);
    if (error.code != EXIT_DONE && comm.rank == 0)
        fprintf(stderr, "simulate: %s\n", error.text);
    options_free(&options);
    comm_stop(&comm);
    return error.code;
}
