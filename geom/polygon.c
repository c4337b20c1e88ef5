/* Triangulation by ear clipping.
 *
 * The polygon is projected along the axis in which its Newell normal (the sum of the
 * cross products of successive corners) is largest; so the orientation stays, and corners
 * may lie a little off a plane. If all triangles (0, i, i+1) then turn left, the angle
 * about corner 0 grows all the way, and the fan is a triangulation: that of most quads.
 *
 * Of others ears are cut: corners b with neighbours a and c where a, b, c turn left and
 * no other corner lies in the closed triangle. Cutting one changes the state of its two
 * neighbours only, so n corners take n^2 tests of a point against a triangle. After a cut
 * the search goes on two corners further: of a disc this leaves large triangles within,
 * where a fan has slivers alone. Straight corners are no ears, so each ends as a corner
 * of triangles with an area.
 *
 * Corners where the edges fold back over themselves (repeated corners, spikes) enclose
 * nothing and are cut before all others. Corners in the same place as one of an ear's do
 * not count as inside it: the seam of a polygon with a hole runs through the same points
 * twice. Corners outside by no more than rounding do count, since a cut would leave a
 * polygon touching itself. In a polygon crossing itself the ears may run out; then any
 * next corner is cut, and the count comes out right.
 *
 * Rejected: monotone partition in n log n, which does not survive repeated corners and
 * crossings without special cases; dropping straight corners first, which would leave
 * T-junctions. */
#include "geom/polygon.h"

#include <math.h>
#include <stdbool.h>

#include "geom/alloc.h"
#include "geom/triangle.h"

/* A corner of the projected polygon, which is scaled to size 1, and its place in the
 * ring. */
struct corner {
    double u, v;
    int32_t previous, next;
    bool ear;
};

/* Twice the area of (a, b, c), positive if counter-clockwise. */
static double turn(const struct corner *a, const struct corner *b, const struct corner *c)
{
    return (b->u - a->u) * (c->v - a->v) - (b->v - a->v) * (c->u - a->u);
}

static double largest(struct vec3 x)
{
    return fmax(fabs(x.x), fmax(fabs(x.y), fabs(x.z)));
}

/* Distance from corner 0 to the farthest one in the largest coordinate; 1 if all are
 * equal. */
static double size_of(const struct vec3 *corners, int32_t count)
{
    double size = 0.0;
    for (int32_t i = 1; i < count; i++)
        size = fmax(size, largest(vec3_sub(corners[i], corners[0])));
    return size > 0.0 ? size : 1.0;
}

/* Corner i as seen from corner 0. Divides, since 1 / size may overflow. */
static struct vec3 scaled(const struct vec3 *corners, int32_t i, double size)
{
    struct vec3 x = vec3_sub(corners[i], corners[0]);
    return (struct vec3){x.x / size, x.y / size, x.z / size};
}

static struct vec3 newell_normal(const struct vec3 *corners, int32_t count, double size)
{
    struct vec3 normal = {0.0, 0.0, 0.0};
    for (int32_t i = 1; i + 1 < count; i++)
        normal = vec3_add(normal, vec3_cross(scaled(corners, i, size),
                                             scaled(corners, i + 1, size)));
    return normal;
}

/* Fills the plane coordinates of all corners, so as to make the polygon
 * counter-clockwise. */
static void project(const struct vec3 *corners, int32_t count, struct corner *ring)
{
    double size = size_of(corners, count);
    struct vec3 normal = newell_normal(corners, count, size);
    double most = largest(normal);
    int axis = fabs(normal.z) >= most ? 2 : fabs(normal.y) >= most ? 1 : 0;
    bool front = vec3_axis(normal, axis) >= 0.0;
    int first = (axis + (front ? 1 : 2)) % 3, second = (axis + (front ? 2 : 1)) % 3;
    for (int32_t i = 0; i < count; i++) {
        struct vec3 x = scaled(corners, i, size);
        ring[i].u = vec3_axis(x, first);
        ring[i].v = vec3_axis(x, second);
    }
}

static bool is_fan(const struct corner *ring, int32_t count)
{
    for (int32_t i = 1; i + 1 < count; i++)
        if (!(turn(&ring[0], &ring[i], &ring[i + 1]) > GEOM_ROUNDING))
            return false;
    return true;
}

static bool is_same_place(const struct corner *a, const struct corner *b)
{
    return a->u == b->u && a->v == b->v;
}

/* True where q lies in the closed triangle (a, b, c), but not in the place of one of its
 * corners. Rounding counts as inside. */
static bool is_inside(const struct corner *a, const struct corner *b,
                      const struct corner *c, const struct corner *q)
{
    return turn(a, b, q) >= -GEOM_ROUNDING && turn(b, c, q) >= -GEOM_ROUNDING &&
           turn(c, a, q) >= -GEOM_ROUNDING && !is_same_place(q, a) &&
           !is_same_place(q, b) && !is_same_place(q, c);
}

static bool is_ear(const struct corner *ring, int32_t i)
{
    const struct corner *b = &ring[i], *a = &ring[b->previous], *c = &ring[b->next];
    if (!(turn(a, b, c) > GEOM_ROUNDING))
        return false;
    for (int32_t j = c->next; j != b->previous; j = ring[j].next)
        if (is_inside(a, b, c, &ring[j]))
            return false;
    return true;
}

/* True where the ways to corner i and from there run back over each other, or one has no
 * length. */
static bool is_fold(const struct corner *ring, int32_t i)
{
    const struct corner *b = &ring[i], *a = &ring[b->previous], *c = &ring[b->next];
    return fabs(turn(a, b, c)) <= GEOM_ROUNDING &&
           (a->u - b->u) * (c->u - b->u) + (a->v - b->v) * (c->v - b->v) >= 0.0;
}

/* The first ear from corner `from` on, or `from` if there is none. */
static int32_t find_ear(const struct corner *ring, int32_t from)
{
    int32_t i = from;
    while (!ring[i].ear && ring[i].next != from)
        i = ring[i].next;
    return ring[i].ear ? i : from;
}

static void write_triangle(const struct corner *ring, int32_t i, int32_t *triangle)
{
    triangle[0] = ring[i].previous;
    triangle[1] = i;
    triangle[2] = ring[i].next;
}

/* Takes corner i out of the ring. Returns the place for the next triangle. */
static int32_t *cut_corner(struct corner *ring, int32_t i, int32_t *triangles)
{
    write_triangle(ring, i, triangles);
    int32_t previous = ring[i].previous, next = ring[i].next;
    ring[previous].next = next;
    ring[next].previous = previous;
    ring[previous].ear = is_ear(ring, previous);
    ring[next].ear = is_ear(ring, next);
    return triangles + 3;
}

static void clip_ears(struct corner *ring, int32_t count, int32_t *triangles)
{
    const int32_t *last = triangles + 3 * ((int64_t)count - 3);
    for (int32_t i = 0; i < count; i++) {
        ring[i].previous = i > 0 ? i - 1 : count - 1;
        ring[i].next = i + 1 < count ? i + 1 : 0;
    }
    int32_t at = 1;
    for (int64_t step = 0; step < 2 * (int64_t)count && triangles < last; step++) {
        bool fold = is_fold(ring, at);
        if (fold)
            triangles = cut_corner(ring, at, triangles);
        at = fold ? ring[at].previous : ring[at].next;
    }
    int32_t first = at;
    do {
        ring[at].ear = is_ear(ring, at);
        at = ring[at].next;
    } while (at != first);
    while (triangles < last) {
        int32_t cut = find_ear(ring, at);
        triangles = cut_corner(ring, cut, triangles);
        at = ring[ring[cut].next].next;
    }
    write_triangle(ring, at, triangles);
}

void polygon_triangulate(const struct vec3 *corners, int32_t count, int32_t *triangles)
{
    struct corner *ring = alloc_array((size_t)count, sizeof *ring);
    project(corners, count, ring);
    if (count > 4 || !is_fan(ring, count)) {
        clip_ears(ring, count, triangles);
    } else {
        for (int32_t i = 1; i + 1 < count; i++, triangles += 3) {
            triangles[0] = 0;
            triangles[1] = i;
            triangles[2] = i + 1;
        }
    }
    alloc_free(ring);
}
