/* Tests the answers to the exercises of chapter 5. */
#include ANSWERS

#include "rad/id.h"
#include "docs/course/exercises/exercise.h"

int main(void)
{
    bool is_right = level_of(1) == 0 && level_of(71) == 3;
    for (int level = 0; level <= ID_MAX_LEVEL; level++)
        is_right &= level_of((uint32_t)1 << 2 * level) == level;
    report(is_right, "level_of()");
    report(lies_below(71, 17) && lies_below(71, 1) && lies_below(71, 71) &&
               !lies_below(17, 71) && !lies_below(71, 18) && !lies_below(70, 71) &&
               !lies_below(75, 17),
           "lies_below()");
    report(is_near(share_of_root(1), 1.0) && is_near(share_of_root(71), 1.0 / 64.0),
           "share_of_root()");
    return finish();
}
