/* Solutions to the exercises of chapter 5. */
#include <stdbool.h>
#include <stdint.h>

/* The number of steps from the root in a hierarchy word: 0 of the root, which is 1. */
int level_of(uint32_t hierarchy)
{
    int level = 0;
    while (hierarchy > 1) {
        hierarchy >>= 2;
        level++;
    }
    return level;
}

/* True if the patch `inner` is a part of the patch `outer` of the same root, or is it. */
bool lies_below(uint32_t inner, uint32_t outer)
{
    while (inner > outer)
        inner >>= 2; /* its parent */
    return inner == outer;
}

/* The area of a patch as a part of the area of its root. */
double share_of_root(uint32_t hierarchy)
{
    double share = 1.0;
    for (; hierarchy > 1; hierarchy >>= 2)
        share *= 0.25;
    return share;
}
