/* Tests the answers to the exercises of chapter 11. */
#include ANSWERS

#include "docs/course/exercises/exercise.h"

int main(void)
{
    report(is_near(rays_for(0.5, 0.1), 100.0) && is_near(rays_for(0.01, 0.1), 9900.0),
           "rays_for()");
    double seen[3];
    share_seen(3, (int[]){0, 4, 8}, 16, seen);
    report(is_near(seen[0], 0.25 / 17.0) && is_near(seen[1], 0.25) &&
               is_near(seen[2], 8.25 / 17.0),
           "share_seen()");
    report(is_near(doubt_of(2, (double[]){30.0, 10.0}, (double[]){0.1, 0.5},
                            (int[]){9, 1}),
                   sqrt(34.0)),
           "doubt_of()");
    return finish();
}
