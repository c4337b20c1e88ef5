/* Tests the answers to the exercises of chapter 1. */
#include ANSWERS

#include "docs/course/exercises/exercise.h"

int main(void)
{
    double b[2];
    two_patches((double[]){100.0, 0.0}, (double[]){0.5, 0.5}, 0.2, b);
    int is_right = is_near(b[0], 100.0 / 0.99) && is_near(b[1], 10.0 / 0.99);
    two_patches((double[]){3.0, 7.0}, (double[]){0.2, 0.9}, 0.6, b);
    is_right &= is_near(b[0], 3.0 + 0.12 * b[1]) && is_near(b[1], 7.0 + 0.54 * b[0]);
    report(is_right, "two_patches()");
    report(bounces_needed() == 8, "bounces_needed()");
    report(is_near(power_lost() + 0.5 * 0.2 * 110.0 / 0.99, 100.0),
           "power_lost(): with what is absorbed it is what the lamp emits");
    return finish();
}
