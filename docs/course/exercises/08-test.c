/* Tests the answers to the exercises of chapter 8. */
#include ANSWERS

#include "docs/course/exercises/exercise.h"

int main(void)
{
    report(to_units(1.5, 1) == 3 && to_units(0.1, 40) == 109951162778 &&
               to_units(-0.75, 2) == -3,
           "to_units()");
    double areas[40], sums[3] = {0.0};
    int home[40];
    for (int i = 0; i < 40; i++)
        areas[i] = 1.0 + i % 7 + (i < 5 ? 10.0 : 0.0);
    deal_roots(areas, 40, 3, home);
    int is_right = 1;
    for (int i = 0; i < 40; i++) {
        is_right &= home[i] >= 0 && home[i] < 3;
        sums[(home[i] % 3 + 3) % 3] += areas[i];
    }
    double high = fmax(sums[0], fmax(sums[1], sums[2]));
    double low = fmin(sums[0], fmin(sums[1], sums[2]));
    report(is_right && high - low <= 15.0, "deal_roots()");
    return finish();
}
