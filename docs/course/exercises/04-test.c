/* Tests the answers to the exercises of chapter 4. */
#include ANSWERS

#include "docs/course/exercises/exercise.h"

int main(void)
{
    double t[3][3] = {{0, 0, 1}, {4, 0, 1}, {0, 4, 1}};
    report(is_blocked(t, (double[]){1, 1, 0}, (double[]){1, 1, 2}) &&
               is_blocked(t, (double[]){1, 1, 3}, (double[]){0.5, 2, 0}) &&
               !is_blocked(t, (double[]){1, 1, 0}, (double[]){1, 1, 0.9}) &&
               !is_blocked(t, (double[]){3, 3, 0}, (double[]){3, 3, 2}) &&
               !is_blocked(t, (double[]){-1, 1, 0}, (double[]){-1, 1, 2}),
           "is_blocked()");
    const double low[3] = {0, 0, 0}, high[3] = {1, 2, 3};
    report(misses_box((double[]){2, 0, 0}, (double[]){2, 1, 1}, low, high) &&
               misses_box((double[]){-1, 1.5, 1}, (double[]){1.5, 4, 1}, low, high) &&
               misses_box((double[]){-3, 1, 1}, (double[]){-1, 1, 1}, low, high) &&
               !misses_box((double[]){-1, 1, 1}, (double[]){2, 1, 1}, low, high) &&
               !misses_box((double[]){0.5, 1, 1}, (double[]){0.6, 1, 1}, low, high) &&
               !misses_box((double[]){-1, -1, -1}, (double[]){2, 3, 4}, low, high),
           "misses_box()");
    return finish();
}
