/* Initial linking, the paper's (Sec. 3.2, step 2): every pair of roots that see each
 * other is linked. */
#ifndef RAD_LINKING_H
#define RAD_LINKING_H

#include "rad/link.h"

/* One rank's way through its pairs. Pairs of roots i < j, both with an area, are numbered
 * row by row; of P ranks, rank r links those whose number is r modulo P. Here those of
 * rank 1 of 3, of five roots:
 *
 *       j   1   2   3   4
 *     i 0   0  (1)  2   3
 *       1      (4)  5   6
 *       2          (7)  8
 *       3               9
 */
struct linking {
    struct model *model;   /* borrowed; its counters count */
    struct link_list *links; /* borrowed: where links go */
    int32_t *roots;          /* [count] roots that have an area, ascending; owned */
    struct facet *facets;    /* [count] of the same roots; owned */
    int32_t count;
    int32_t i, j;            /* places in `roots` of the pair that comes next */
    int64_t number;          /* its number; linking_pairs() or more: there is none */
    int ranks;
};

/* Borrows model and list. */
struct linking linking_start(struct model *model, struct link_list *links, int rank,
                             int ranks);
void linking_end(struct linking *linking);

/* Number of pairs of all ranks. */
int64_t linking_pairs(const struct linking *linking);

/* Links the next pair of this rank, if light can pass between the two roots.
 * Pre: linking->number < linking_pairs(linking). */
void linking_add(struct linking *linking);

#endif
