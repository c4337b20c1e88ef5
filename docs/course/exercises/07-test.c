/* Tests the answers to the exercises of chapter 7. */
#include ANSWERS

#include "docs/course/exercises/exercise.h"

int main(void)
{
    report(is_near(irradiance_of(3, (double[]){2.0, 1.0, 0.1}, (double[]){1.0, 0.25, 0.0625}),
                   7.6) &&
               is_near(irradiance_of(1, (double[]){3.0}, (double[]){2.0}), 1.5),
           "irradiance_of()");
    report(is_near(pull(4, (double[]){3.0, 3.0, 3.8, 3.0}, (double[]){1.0, 1.0, 1.0, 1.0}),
                   3.2) &&
               is_near(pull(2, (double[]){1.0, 4.0}, (double[]){2.0, 1.0}), 2.0),
           "pull()");
    return finish();
}
