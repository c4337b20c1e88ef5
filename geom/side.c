/* A hash table leads from two ends, in any order, to the lowest side seen so far; sides
 * are seen from the highest down.
 *
 * Rejected: sorting, which takes seven times the instructions (room of 31,936). */
#include "geom/side.h"

#include "geom/alloc.h"
#include "geom/hash.h"
#include "geom/stop.h"

static bool has_same_ends(const struct triangle *triangles, int32_t s, int32_t t)
{
    struct vec3 a = side_start(triangles, s), b = side_end(triangles, s);
    struct vec3 c = side_start(triangles, t), d = side_end(triangles, t);
    return (vec3_is_equal(a, c) && vec3_is_equal(b, d)) ||
           (vec3_is_equal(a, d) && vec3_is_equal(b, c));
}

int32_t *sides_match(const struct triangle *triangles, int32_t count)
{
    uint64_t mask = 1;
    while (mask + 1 < 4 * (uint64_t)count) /* 3 count sides fill three quarters at most */
        mask = 2 * mask + 1;
    int32_t *same = alloc_array(3 * (size_t)count, sizeof *same);
    int32_t *slots = alloc_array((size_t)mask + 1, sizeof *slots); /* side + 1, or 0 */
    for (int32_t side = 0; side < 3 * count; side++)
        same[side] = -1;
    for (int32_t t = count - 1; t >= 0; t--) {
        uint64_t hash[3];
        for (int k = 0; k < 3; k++)
            hash[k] = hash_point(0, triangles[t].corner[k]);
        for (int k = 2; k >= 0 && !stop_is_asked(); k--) {
            int32_t side = 3 * t + k;
            uint64_t slot = hash_finish(hash[k] + hash[(k + 1) % 3]) & mask;
            while (slots[slot] > 0 && !has_same_ends(triangles, side, slots[slot] - 1))
                slot = (slot + 1) & mask;
            same[side] = slots[slot] - 1;
            slots[slot] = side + 1;
        }
    }
    alloc_free(slots);
    return same;
}
