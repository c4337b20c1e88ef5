/* The accounts of a rank, and the report at the end.
 *
 * The ledger tells the work of all ranks in many phases with one exchange. A phase lasts
 * as long as its slowest rank, so the maxima of all phases together are the time of a
 * run, and the sums over ranks are the work there was. */
#if defined(__unix__) || defined(__APPLE__)
#define _XOPEN_SOURCE 600
#include <sys/resource.h>
#define HAVE_RUSAGE 1
#endif

#include "mpi/account.h"

#include <math.h>
#include <string.h>

#include "geom/alloc.h"

void account_begin(struct account *account, enum phase phase)
{
    account->seconds[phase] -= comm_seconds();
}

void account_end(struct account *account, enum phase phase)
{
    account->seconds[phase] += comm_seconds();
}

void ledger_add(struct ledger *ledger, struct phase_work phase)
{
    RESERVE(ledger->items, &ledger->capacity, ledger->count + 1);
    ledger->items[ledger->count++] = phase;
}

void account_work(struct account *account, enum work kind, int64_t done, int64_t bytes)
{
    ledger_add(&account->ledger, (struct phase_work){.kind = (int32_t)kind,
                                                     .share.done = done, .bytes = bytes});
}

/* phases[r * stride]: rank r's. */
static void add_level(struct ledger *ledger, const struct phase_work *phases,
                      int64_t stride, int ranks)
{
    struct level_balance level = {.pass = phases->pass, .level = phases->level};
    level.shares = alloc_array((size_t)ranks, sizeof *level.shares);
    for (int r = 0; r < ranks; r++) {
        const struct level_share *share = &phases[r * stride].share;
        level.shares[r] = *share;
        level.links += share->links;
        level.predicted_max = fmax(level.predicted_max, (double)share->predicted);
        level.predicted_mean += (double)share->predicted / ranks;
        level.work_max = fmax(level.work_max, (double)share->done);
        level.work_mean += (double)share->done / ranks;
    }
    RESERVE(ledger->levels, &ledger->level_capacity, ledger->level_count + 1);
    ledger->levels[ledger->level_count++] = level;
}

static void add_sums(struct work_sums *sums, const struct phase_work *phases,
                     int64_t stride, int ranks)
{
    int64_t slowest = 0, bytes = 0;
    for (int r = 0; r < ranks; r++) {
        const struct phase_work *phase = &phases[r * stride];
        sums->all += phase->share.done;
        slowest = phase->share.done > slowest ? phase->share.done : slowest;
        bytes = phase->bytes > bytes ? phase->bytes : bytes;
    }
    sums->phases++;
    sums->slowest += slowest;
    sums->bytes += bytes;
}

void ledger_share(struct ledger *ledger, const struct comm *comm)
{
    int64_t count = ledger->count;
    size_t bytes = (size_t)count * sizeof *ledger->items;
    struct phase_work *all = comm_gather_each(comm, ledger->items, bytes);
    for (int64_t i = 0; i < count; i++) {
        add_sums(&ledger->sums[all[i].kind], all + i, count, comm->size);
        if (all[i].kind == WORK_LINKING || all[i].kind == WORK_SPLITTING)
            add_level(ledger, all + i, count, comm->size);
    }
    ledger->count = 0;
    alloc_free(all);
}

void account_free(struct account *account)
{
    struct ledger *ledger = &account->ledger;
    for (int64_t i = 0; i < ledger->level_count; i++)
        alloc_free(ledger->levels[i].shares);
    alloc_free(ledger->items);
    alloc_free(ledger->levels);
    alloc_free(account->each);
}

/* Most bytes ever held by this process, 0 where the system does not tell. */
static int64_t peak_memory(void)
{
#ifdef HAVE_RUSAGE
    struct rusage usage;
    if (getrusage(RUSAGE_SELF, &usage) == 0)
#ifdef __APPLE__
        return usage.ru_maxrss;
#else
        return (int64_t)usage.ru_maxrss * 1024;
#endif
#endif
    return 0;
}

static void report_counts(const struct account *own, const struct comm *comm,
                          const struct model *model, const struct link_list *links,
                          struct stats *stats)
{
    const struct octree_counts *counts = &model->counts;
    int64_t sum[] = {counts->rays, counts->node_tests, counts->triangle_tests,
                     model->walled_off, model->rays_spared};
    stats->messages = (int64_t)comm_largest(comm, (double)comm_counts().messages);
    for (int k = 0; k < CARGO_COUNT; k++)
        stats->messages_with[k] = (int64_t)comm_largest(comm, (double)own->messages[k]);
    memcpy(stats->bytes_of, own->bytes, sizeof stats->bytes_of);
    for (int64_t i = 0; i < links->count; i++) {
        int seen = links->items[i].seen;
        int kind = seen == LINK_ALL_SEEN ? 1 : seen > 0 ? 2 : 3;
        stats->links_of[link_is_open(&links->items[i]) ? 0 : kind]++;
    }
    comm_add(comm, sum, sizeof sum / sizeof *sum);
    comm_add(comm, stats->bytes_of, CARGO_COUNT);
    comm_add(comm, stats->links_of, 4);
    stats->rays = sum[0];
    stats->node_tests = sum[1];
    stats->triangle_tests = sum[2];
    stats->walled_off = sum[3];
    stats->rays_spared = sum[4];
}

void account_report(struct account *account, const struct comm *comm,
                    const struct model *model, const struct link_list *links,
                    struct stats *stats)
{
    ledger_share(&account->ledger, comm);
    stats->levels = account->ledger.levels;
    stats->level_count = account->ledger.level_count;
    memcpy(stats->work, account->ledger.sums, sizeof stats->work);
    stats->exchanges = comm_counts().collectives;
    account->own.memory = peak_memory();
    alloc_free(account->each);
    account->each = comm_gather_each(comm, &account->own, sizeof *account->each);
    stats->holdings = account->each;
    report_counts(account, comm, model, links, stats);
    double *all = comm_gather_each(comm, account->seconds, sizeof account->seconds);
    for (int phase = 0; phase < PHASE_COUNT; phase++) {
        struct spread *spread = &stats->seconds[phase];
        *spread = (struct spread){all[phase], 0.0, all[phase]};
        for (int r = 0; r < comm->size; r++) {
            double seconds = all[r * PHASE_COUNT + phase];
            spread->min = fmin(spread->min, seconds);
            spread->mean += seconds / comm->size;
            spread->max = fmax(spread->max, seconds);
        }
    }
    alloc_free(all);
}
