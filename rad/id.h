/* Global names of patches (paper Sec. 3.1, Fig. 1).
 *
 * A patch ID is the number of a root patch and a hierarchy part of 32 bits, read left to
 * right:
 *
 *     0 0 ... 0 0 1 c c c c ... c c
 *     leading     |  |   |       |
 *     zeros   sentinel |  2nd    last child number, two bits each, 0..3
 *                     first
 *
 * The sentinel tells where the path begins; the root patch itself is 1. One bit for the
 * sentinel and two per level leave room for 15 levels. A child's ID has two bits more on
 * the right, and the level follows from where the sentinel is. */
#ifndef RAD_ID_H
#define RAD_ID_H

#include <stdbool.h>
#include <stdint.h>

enum { ID_MAX_LEVEL = 15 };

struct patch_id {
    uint32_t root;      /* number of the root patch */
    uint32_t hierarchy; /* path from the root */
};

/* Both parts as one number. */
static inline uint64_t id_number(struct patch_id id)
{
    return (uint64_t)id.root << 32 | id.hierarchy;
}

static inline struct patch_id id_of_root(uint32_t root)
{
    return (struct patch_id){root, 1};
}

/* Pre: child in 0..3 and id_level(id) < ID_MAX_LEVEL. */
static inline struct patch_id id_child(struct patch_id id, int child)
{
    return (struct patch_id){id.root, id.hierarchy << 2 | (uint32_t)child};
}

/* Number of steps from the root, 0..15. Pre: the hierarchy part is not 0. */
static inline int id_level(struct patch_id id)
{
    int level = 0;
    for (uint32_t rest = id.hierarchy; rest > 3; rest >>= 2)
        level++;
    return level;
}

/* The child number 0..3 taken at step `step` (0 is the first) on the path from the root.
 * Pre: 0 <= step < id_level(id). */
static inline int id_step(struct patch_id id, int step)
{
    int below = id_level(id) - 1 - step;
    return (int)(id.hierarchy >> (2 * below) & 3u);
}

/* Negative, 0 or positive. Order: by root, then level by level, since a deeper patch has
 * more bits, each from left to right. */
static inline int id_compare(struct patch_id a, struct patch_id b)
{
    uint64_t x = id_number(a), y = id_number(b);
    return (x > y) - (x < y);
}

/* True for what can be the ID of a patch: a sentinel in one of its 16 places. */
static inline bool id_is_valid(struct patch_id id)
{
    uint32_t rest = id.hierarchy;
    while (rest > 3)
        rest >>= 2;
    return rest == 1 && id_level(id) <= ID_MAX_LEVEL;
}

#endif
