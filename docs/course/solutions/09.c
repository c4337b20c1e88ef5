/* Solutions to the exercises of chapter 9. */
#include "mpi/balance.h"

/* The largest of the loads of `ranks` ranks, in means. */
double imbalance(const int64_t *loads, int ranks)
{
    int64_t most = 0, sum = 0;
    for (int r = 0; r < ranks; r++) {
        most = loads[r] > most ? loads[r] : most;
        sum += loads[r];
    }
    return (double)most * ranks / (double)sum;
}

/* A dealing (mpi/balance.h): destination[i] becomes the rank that gets the link with
 * costs[i]. loads.of[] are the loads of all loads.ranks ranks, loads.rank is this one. */
void deal_mine(struct loads loads, const int64_t *costs, int64_t count, int *destination)
{
    (void)costs;
    for (int64_t i = 0; i < count; i++) /* like cards, beginning with oneself */
        destination[i] = (int)((loads.rank + i) % loads.ranks);
}
