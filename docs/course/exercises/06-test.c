/* Tests the answers to the exercises of chapter 6. */
#include ANSWERS

#include "docs/course/exercises/exercise.h"

int main(void)
{
    report(is_to_be_split(0.012, 1000.0, 0.0, 0.01, 160.0) &&
               is_to_be_split(0.012, 0.0, 1000.0, 0.01, 160.0) &&
               !is_to_be_split(0.012, 100.0, 10.0, 0.01, 160.0),
           "is_to_be_split()");
    report(by_factor(0.1, 10.0, 0.5, 0.15) && by_factor(0.1, 0.5, 10.0, 0.15) &&
               !by_factor(0.1, 10.0, 0.5, 0.25),
           "by_factor()");
    report(is_near(links_at_last(24, 0), 276.0) && is_near(links_at_last(24, 3), 17664.0),
           "links_at_last()");
    return finish();
}
