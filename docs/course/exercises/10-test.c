/* Tests the answers to the exercises of chapter 10. */
#include ANSWERS

#include "docs/course/exercises/exercise.h"

int main(void)
{
    report(is_near(still_missing(0.1, 0.5), 0.1) &&
               is_near(still_missing(0.1, 0.95), 1.9),
           "still_missing()");
    report(is_near(relative_rms(2, (double[]){1.1, 1.8}, (double[]){1.0, 2.0}), 0.1),
           "relative_rms()");
    report(bounces_for(0.5, 1.5e-3) == 11 && bounces_for(0.9, 1.5e-3) == 84,
           "bounces_for()");
    return finish();
}
