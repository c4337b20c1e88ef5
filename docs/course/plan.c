/* The greedy plan of LoadBalance: chapter 9 of the course.
 *
 *     plan LOAD...
 *
 * prints how much load goes from which rank to which, by phr's own plan (mpi/plan.h). */
#include <stdio.h>
#include <stdlib.h>

#include "mpi/plan.h"

enum { RANKS_MOST = 64 };

int main(int argc, char **argv)
{
    int64_t loads[RANKS_MOST];
    struct transfer transfers[2 * RANKS_MOST];
    int ranks = argc - 1;
    if (ranks < 1 || ranks > RANKS_MOST) {
        fprintf(stderr, "usage: plan LOAD...\n");
        return 2;
    }
    for (int r = 0; r < ranks; r++)
        loads[r] = atoll(argv[r + 1]);
    int count = plan_transfers(loads, ranks, transfers);
    for (int t = 0; t < count; t++)
        printf("rank %d sends %lld to rank %d\n", transfers[t].from,
               (long long)transfers[t].load, transfers[t].to);
    return 0;
}
