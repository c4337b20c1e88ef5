/* Patch IDs; the layout is in rad/id.h.
 *
 * Going down appends two bits on the right, going up drops them, and the level follows
 * from where the sentinel is. The numeric order of the hierarchy part is breadth first:
 * a deeper patch has more bits, patches of a level differ by their path. */
#include "rad/id.h"

struct patch_id id_of_root(uint32_t root)
{
    return (struct patch_id){root, 1};
}

struct patch_id id_child(struct patch_id id, int child)
{
    return (struct patch_id){id.root, id.hierarchy << 2 | (uint32_t)child};
}

struct patch_id id_parent(struct patch_id id)
{
    return (struct patch_id){id.root, id.hierarchy >> 2};
}

int id_level(struct patch_id id)
{
    int level = 0;
    for (uint32_t rest = id.hierarchy; rest > 3; rest >>= 2)
        level++;
    return level;
}

int id_step(struct patch_id id, int step)
{
    int below = id_level(id) - 1 - step;
    return (int)(id.hierarchy >> (2 * below) & 3u);
}

int id_compare(struct patch_id a, struct patch_id b)
{
    if (a.root != b.root)
        return a.root < b.root ? -1 : 1;
    return (a.hierarchy > b.hierarchy) - (a.hierarchy < b.hierarchy);
}

bool id_is_valid(struct patch_id id)
{
    uint32_t rest = id.hierarchy;
    while (rest > 3)
        rest >>= 2;
    return rest == 1 && id_level(id) <= ID_MAX_LEVEL;
}
