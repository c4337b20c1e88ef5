/* Rows lie where they were made. All ranks know all vectors, so a value of each row goes
 * to all ranks before it is used: the only exchange of a product with the rows. */
#include "mpi/beyond/gathering.h"

#include "mpi/comm.h"

void gathering_share_rows(struct gathering *g, struct rgb *values)
{
    comm_share(g->solver->comm, g->all, g->stages->counts, g->stages->at, sizeof *g->all);
    g->bytes += g->count * (int64_t)sizeof *g->all;
    for (int64_t i = 0; i < g->count; i++)
        values[i] = g->all[g->stages->place[i]];
}
