/* Dealing by default: in turn, like cards.
 *
 * Each rank deals all of its links to all ranks, so each gets its part of every
 * neighbourhood, with the links predicted too low and too high. No prediction is needed,
 * and the links that stay, over which light is transferred, end up even, too. The work of
 * the slowest rank, in means, and the bytes of moved links
 * (phr ROOM --epsilon E --final-gather 0 --balance B --stats FILE, "work", "splitting"):
 *
 *     room, epsilon, ranks     greedy          in turn
 *     1,004    1e-4     3      1.54   0.11 MB  1.02   0.58 MB
 *     1,004    1e-4    32      2.30   0.19 MB  1.39   0.84 MB
 *     20,000   1e-3    32      2.98   0.15 MB  1.43   0.54 MB
 *     100,000  1e-3    32      2.65   0.20 MB  1.38   0.69 MB
 *
 * Rejected: the greedy plan with better predictions of links with clusters (1.23, 2.12,
 * 1.53, 1.51), for the errors of neighbours are alike; in turn by descending costs (no
 * better than in turn); stages, in which ranks stop after equal amounts of work and the
 * rest is dealt anew (1.06, 1.29, 1.18, 1.11), for some 200 lines more. */
#include "mpi/balance.h"

#include <stddef.h>

/* Begins with this rank itself, lest few links all go to the first ranks. */
static void deal_in_turn(struct loads loads, const int64_t *costs, int64_t count,
                         int *destination)
{
    (void)costs;
    for (int64_t i = 0; i < count; i++)
        destination[i] = (int)((loads.rank + i) % loads.ranks);
}

dealing *const DEALINGS[] = {NULL, deal_greedily, deal_in_turn};
