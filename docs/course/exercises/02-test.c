/* Tests the answers to the exercises of chapter 2. */
#include ANSWERS

#include "docs/course/exercises/exercise.h"

int main(void)
{
    report(is_near(disk_factor(1.0, 1.0), 1.0 / (3.14159265358979323846 + 1.0)) &&
               is_near(disk_factor(4.0, 2.0), disk_factor(1.0, 1.0)),
           "disk_factor()");
    report(is_near(other_way(0.2, 3.0, 2.0), 0.3), "other_way()");
    report(is_near(floor_to_wall(0.19982489569838743), 0.20004377607540316),
           "floor_to_wall(): it is that of the squares at right angles");
    return finish();
}
