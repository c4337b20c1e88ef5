/* Tests the answers to the exercises of chapter 7. */
#include ANSWERS

#include "docs/course/exercises/exercise.h"

int main(void)
{
    const double flux[] = {2.0, 1.0, 0.1}, area[] = {1.0, 0.25, 0.0625};
    report(is_near(irradiance_of(3, flux, area), 7.6) &&
               is_near(irradiance_of(1, (double[]){3.0}, (double[]){2.0}), 1.5),
           "irradiance_of()");
    const double four[] = {3.0, 3.0, 3.8, 3.0}, equal[] = {1.0, 1.0, 1.0, 1.0};
    report(is_near(pull(4, four, equal), 3.2) &&
               is_near(pull(2, (double[]){1.0, 4.0}, (double[]){2.0, 1.0}), 2.0),
           "pull()");
    return finish();
}
