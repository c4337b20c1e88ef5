/* The ledger: the work of all ranks in many phases, told with one exchange. A phase lasts
 * as long as its slowest rank, so the maxima of all phases together are the time of a
 * run, and the sums over ranks are the work there was. */
#include "mpi/ledger.h"

#include "geom/alloc.h"
#include "geom/vec.h"

void ledger_add(struct ledger *ledger, struct phase_work phase)
{
    RESERVE(ledger->items, &ledger->capacity, ledger->count + 1);
    ledger->items[ledger->count++] = phase;
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
        level.predicted_max = real_max(level.predicted_max, (double)share->predicted);
        level.predicted_mean += (double)share->predicted / ranks;
        level.work_max = real_max(level.work_max, (double)share->done);
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

void ledger_free(struct ledger *ledger)
{
    for (int64_t i = 0; i < ledger->level_count; i++)
        alloc_free(ledger->levels[i].shares);
    alloc_free(ledger->items);
    alloc_free(ledger->levels);
    *ledger = (struct ledger){0};
}
