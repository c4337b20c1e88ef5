/* Tests the answers to the exercises of chapter 9. */
#include ANSWERS

#include "docs/course/exercises/exercise.h"

int main(void)
{
    report(is_near(imbalance((int64_t[]){10, 2, 6, 2}, 4), 2.0), "imbalance()");
    enum { RANKS = 4, LINKS = 400 };
    int64_t costs[RANKS][LINKS], before[RANKS] = {0}, after[RANKS] = {0};
    unsigned number = 1;
    for (int r = 0; r < RANKS; r++)
        for (int i = 0; i < LINKS; i++) {
            number = number * 1103515245u + 12345u;
            costs[r][i] = r == 0 ? 1 + number % 97 : 1 + number % 13;
            before[r] += costs[r][i];
        }
    /* Predictions are wrong, those of neighbours alike: of each rank's links every other
     * hundred takes four times as much. */
    int is_right = 1;
    for (int r = 0; r < RANKS; r++) {
        int destination[LINKS] = {0};
        deal_mine((struct loads){before, RANKS, r}, costs[r], LINKS, destination);
        for (int i = 0; i < LINKS; i++) {
            is_right &= destination[i] >= 0 && destination[i] < RANKS;
            after[destination[i] & (RANKS - 1)] += (i / 100 % 2 ? 4 : 1) * costs[r][i];
        }
    }
    int64_t most = 0, sum = 0;
    for (int r = 0; r < RANKS; r++) {
        most = after[r] > most ? after[r] : most;
        sum += after[r];
    }
    printf("# the largest load is %.2f means\n", (double)(RANKS * most) / (double)sum);
    report(is_right && 10 * RANKS * most <= 12 * sum, "deal_mine()");
    return finish();
}
