/* The ledger: maxima and sums over ranks, of many phases with two exchanges. A phase lasts as long as
 * its slowest rank, so the maxima of all phases together are what a run takes, and the sums over
 * ranks are what there was to do. */
#include "mpi/ledger.h"

#include "geom/alloc.h"

enum { FIELDS = 4 };

void ledger_add(struct ledger *ledger, struct phase_work phase)
{
    ledger->items = alloc_reserve(ledger->items, &ledger->capacity, ledger->count + 1,
                                  sizeof *ledger->items);
    ledger->items[ledger->count++] = phase;
}

/* Stages of a level follow each other; it lasts as long as all of them. */
static void add_level(struct ledger *ledger, const struct phase_work *phase, const int64_t *sum,
                      const int64_t *most, int ranks)
{
    int64_t count = ledger->level_count;
    if (count == 0 || ledger->levels[count - 1].iteration != phase->iteration ||
        ledger->levels[count - 1].level != phase->level) {
        ledger->levels = alloc_reserve(ledger->levels, &ledger->level_capacity, ++count, sizeof *ledger->levels);
        ledger->levels[count - 1] = (struct level_balance){.iteration = phase->iteration, .level = phase->level};
        ledger->level_count = count;
    }
    struct level_balance *level = &ledger->levels[count - 1];
    level->links += sum[0];
    level->predicted_max += (double)most[1];
    level->predicted_mean += (double)sum[1] / ranks;
    level->work_max += (double)most[2];
    level->work_mean += (double)sum[2] / ranks;
}

void ledger_share(struct ledger *ledger, const struct comm *comm)
{
    size_t count = FIELDS * (size_t)ledger->count;
    int64_t *own = alloc_array(3 * count, sizeof *own), *sum = own + count, *most = sum + count;
    for (int64_t i = 0; i < ledger->count; i++) {
        const struct phase_work *phase = &ledger->items[i];
        int64_t *at = own + FIELDS * i;
        at[0] = phase->links;
        at[1] = phase->predicted;
        at[2] = phase->work;
        at[3] = phase->bytes;
    }
    MPI_Request request;
    MPI_Iallreduce(own, sum, comm_count(comm, (int64_t)count), MPI_INT64_T, MPI_SUM, comm->handle,
                   &request);
    comm_wait(&request);
    MPI_Iallreduce(own, most, comm_count(comm, (int64_t)count), MPI_INT64_T, MPI_MAX, comm->handle,
                   &request);
    comm_wait(&request);
    for (int64_t i = 0; i < ledger->count; i++) {
        const struct phase_work *phase = &ledger->items[i];
        struct work_sums *sums = &ledger->sums[phase->kind];
        sums->phases++;
        sums->all += sum[FIELDS * i + 2];
        sums->slowest += most[FIELDS * i + 2];
        sums->bytes += most[FIELDS * i + 3];
        if (phase->kind == WORK_LINKING || phase->kind == WORK_SPLITTING)
            add_level(ledger, phase, sum + FIELDS * i, most + FIELDS * i, comm->size);
    }
    ledger->count = 0;
    alloc_free(own);
}

void ledger_free(struct ledger *ledger)
{
    alloc_free(ledger->items);
    alloc_free(ledger->levels);
    *ledger = (struct ledger){0};
}
