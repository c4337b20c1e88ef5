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
 * sentinel and two per level leave room for 15 levels. */
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

struct patch_id id_of_root(uint32_t root);

/* Pre: child in 0..3 and id_level(id) < ID_MAX_LEVEL. */
struct patch_id id_child(struct patch_id id, int child);

/* Pre: id_level(id) > 0. */
struct patch_id id_parent(struct patch_id id);

/* Number of steps from the root, 0..15. Pre: the hierarchy part is not 0. */
int id_level(struct patch_id id);

/* The child number 0..3 taken at step `step` (0 is the first) on the path from the root.
 * Pre: 0 <= step < id_level(id). */
int id_step(struct patch_id id, int step);

/* Negative, 0 or positive. Order: by root, then level by level, each from left to
 * right. */
int id_compare(struct patch_id a, struct patch_id b);

/* True for what can be the ID of a patch: a sentinel in one of the 16 places that it may
 * have. */
bool id_is_valid(struct patch_id id);

#endif
