/* A balancing plan for the table DEALINGS of mpi/beyond/balance.c (chapter 9): each rank
 * cuts the row of its links into as many blocks as there are ranks, one for each. */
#include "mpi/balance.h"

static void deal_in_blocks(struct loads loads, const int64_t *costs, int64_t count,
                           int *destination)
{
    (void)costs;
    for (int64_t i = 0; i < count; i++)
        destination[i] = (int)((loads.rank + i * loads.ranks / count) % loads.ranks);
}
