/* Walls.
 *
 * The proof starts with one triangle, with the convex sets P in front of its plane and Q
 * behind, or the other way round, and adds the triangle beyond each side with a segment
 * from P to Q on the outer side. It succeeds when no such side is left, and fails where
 * there is no triangle beyond.
 *
 * On which side of ab the segment from x to y passes is told by the sign of the volume
 *
 *     V(x, y) = (b - a) x (x - a) . (y - a).
 *
 * V is affine in x and in y, and each point of a convex set is a weighted average of its
 * corners. So V(x, y) is one of V at pairs of corners: if none of these passes on the
 * outer side, no segment does.
 *
 * Why all segments are blocked in the end. The triangles run counter-clockwise, and where
 * two share a side its two directions cancel; so as many triangles cover a point as their
 * outline winds around it. Seen from a point on the inner side of all its sides, an
 * outline runs counter-clockwise throughout: it winds around it once or more. So it has
 * to be neither convex nor a single loop, and a wall may well have a window.
 *
 * A segment passes on the outer side only if the two lines are apart by more than
 * rounding: a floor ending at a tilted wall has corners on the line of its lowest sides.
 * Where both corners lie in the plane V is 0, and its sign, rounding.
 *
 * Rejected: outlines of whole walls, found beforehand. A large wall then takes fewer
 * tests, but beside a window, and where the wall is not convex, outlines prove little. */
#include "geom/wall.h"

#include <string.h>

#include "geom/alloc.h"
#include "geom/side.h"
#include "geom/stop.h"

/* True if triangle t lies in the plane of triangle s and faces the same way. */
static bool are_coplanar(const struct walls *walls, int32_t s, int32_t t)
{
    return triangle_is_in(&walls->triangles[t], &walls->planes[t], &walls->planes[s]);
}

/* --- neighbours --- */

enum { COMPARED_MAX = 16 }; /* sides between the same two points, with one of these */

int32_t *walls_find_neighbours(const struct triangle *triangles,
                               const struct plane *planes, int32_t count)
{
    const struct walls walls = {triangles, planes, NULL};
    int32_t *same = sides_match(triangles, count);
    int32_t *neighbours = alloc_array(3 * (size_t)count, sizeof *neighbours);
    for (int32_t n = 0; n < 3 * count; n++)
        neighbours[n] = -1;
    for (int32_t a = 0; a < 3 * count && !stop_is_asked(); a++) {
        int compared = 0;
        for (int32_t b = same[a]; b >= 0 && compared < COMPARED_MAX; b = same[b]) {
            bool back = vec3_is_equal(side_start(triangles, a), side_end(triangles, b));
            if (back && neighbours[a] < 0 && neighbours[b] < 0 &&
                are_coplanar(&walls, a / 3, b / 3)) {
                neighbours[a] = b / 3;
                neighbours[b] = a / 3;
            }
            compared++;
        }
    }
    alloc_free(same);
    return neighbours;
}

/* --- the proof --- */

struct wall_pair {
    const struct vec3 *p, *q; /* corners of the sets */
    int count_p, count_q;
    struct vec3 across; /* unit length, from the side of q to the side of p */
    double sign;        /* 1: p is in front of the wall; -1: behind */
};

/* True if a set lies on the side of this sign, reaching off the plane. */
static bool lies_beside(const struct plane *plane, double sign,
                        const struct vec3 *corners, int count)
{
    double low = 0.0, high = 0.0;
    for (int k = 0; k < count; k++) {
        low = real_min(low, sign * plane_distance(plane, corners[k]));
        high = real_max(high, sign * plane_distance(plane, corners[k]));
    }
    return low >= -GEOM_ROUNDING && high > GEOM_ROUNDING;
}

/* True if some segment passes the side from a to b on the outer side. */
static bool some_pass(const struct wall_pair *pair, struct vec3 a, struct vec3 b)
{
    struct vec3 along = vec3_sub(b, a);
    for (int k = 0; k < pair->count_p * pair->count_q; k++) {
        struct vec3 x = vec3_sub(pair->p[k / pair->count_q], a);
        struct vec3 y = vec3_sub(pair->q[k % pair->count_q], a);
        struct vec3 way = vec3_sub(x, y);
        double volume = pair->sign * vec3_dot(vec3_cross(along, x), y);
        if (volume > 0.0 && vec3_dot(pair->across, way) > 2.0 * GEOM_ROUNDING &&
            volume > GEOM_ROUNDING * vec3_length(along) * vec3_length(way))
            return true;
    }
    return false;
}

enum { GROWN_MAX = 2048, SLOTS = 2 * GROWN_MAX };

/* The triangles of a growing wall. */
struct growth {
    int32_t triangles[GROWN_MAX];
    uint16_t slots[SLOTS]; /* a hash table: 1 + place in triangles[]; 0: empty */
    int count;
};

/* Adds a triangle unless it is there. False if there is no room. */
static bool growth_add(struct growth *growth, int32_t t)
{
    uint32_t slot = (uint32_t)t * UINT32_C(2654435769) % SLOTS;
    while (growth->slots[slot] != 0 && growth->triangles[growth->slots[slot] - 1] != t)
        slot = (slot + 1) % SLOTS;
    if (growth->slots[slot] != 0)
        return true;
    if (growth->count == GROWN_MAX)
        return false;
    growth->triangles[growth->count++] = t;
    growth->slots[slot] = (uint16_t)growth->count;
    return true;
}

bool walls_stand_between(const struct walls *walls, int32_t triangle,
                         const struct vec3 *p, int count_p, const struct vec3 *q,
                         int count_q)
{
    const struct plane *plane = &walls->planes[triangle];
    double sign = lies_beside(plane, 1.0, p, count_p) ? 1.0 : -1.0;
    const struct wall_pair pair = {p, q, count_p, count_q,
                                   vec3_scale(plane->normal, sign), sign};
    if (!lies_beside(plane, sign, p, count_p) || !lies_beside(plane, -sign, q, count_q))
        return false;
    struct growth growth;
    memset(growth.slots, 0, sizeof growth.slots);
    growth.count = 0;
    growth_add(&growth, triangle);
    for (int i = 0; i < growth.count; i++)
        for (int k = 0; k < 3; k++) {
            int32_t t = growth.triangles[i], next = walls->neighbours[3 * t + k];
            const struct vec3 *corner = walls->triangles[t].corner;
            if (some_pass(&pair, corner[k], corner[(k + 1) % 3]) &&
                (next < 0 || !are_coplanar(walls, triangle, next) ||
                 !growth_add(&growth, next)))
                return false;
        }
    return true;
}
