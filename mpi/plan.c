/* The greedy plan.
 *
 * Senders are the ranks above the mean, in descending order of their loads; each gives
 * its excess away piece by piece, always to the receiver with the smallest load, never
 * more than lifts that receiver to the mean. Ties go to the lower rank, so the plan is
 * unique. Every piece empties a sender or fills a receiver: fewer than 2 P pieces. */
#include "mpi/plan.h"

#include <stddef.h>

#include "geom/alloc.h"

/* The rank with the largest (sign 1) or smallest (sign -1) load among those whose
 * distance to their target has this sign; -1 if there is none. */
static int extreme_rank(const int64_t *loads, const int64_t *targets, int ranks, int sign)
{
    int found = -1;
    for (int r = 0; r < ranks; r++) {
        if (sign * (loads[r] - targets[r]) <= 0)
            continue;
        if (found < 0 || sign * (loads[r] - loads[found]) > 0)
            found = r;
    }
    return found;
}

int plan_transfers(const int64_t *loads, int ranks, struct transfer *transfers)
{
    int64_t total = 0;
    for (int r = 0; r < ranks; r++)
        total += loads[r];
    int64_t *now = alloc_array((size_t)ranks, sizeof *now);
    int64_t *targets = alloc_array((size_t)ranks, sizeof *targets);
    for (int r = 0; r < ranks; r++) {
        now[r] = loads[r];
        targets[r] = total / ranks + (r < total % ranks ? 1 : 0);
    }
    int count = 0;
    for (int from = extreme_rank(now, targets, ranks, 1); from >= 0;
         from = extreme_rank(now, targets, ranks, 1)) {
        while (now[from] > targets[from]) {
            int to = extreme_rank(now, targets, ranks, -1);
            int64_t excess = now[from] - targets[from], room = targets[to] - now[to];
            int64_t load = excess < room ? excess : room;
            transfers[count++] = (struct transfer){from, to, load};
            now[from] -= load;
            now[to] += load;
        }
    }
    alloc_free(now);
    alloc_free(targets);
    return count;
}
