/* Tests of geom/wall.h: how walls go on from triangle to triangle, and the pairs that
 * they block. */
#include "geom/wall.h"

#include <string.h>

#include "tests/pairs.h"
#include "tests/tap.h"

/* Triangles with all that walls are made of. */
struct surface {
    struct soup soup;
    struct plane *planes;
    int32_t *neighbours;
    int32_t count;
};

/* Takes over the soup. */
static struct surface surface_make(struct soup soup)
{
    struct surface surface = {.soup = soup, .count = (int32_t)soup.count};
    surface.planes = alloc_array((size_t)soup.count, sizeof *surface.planes);
    for (int64_t i = 0; i < soup.count; i++)
        if (!triangle_is_degenerate(&soup.items[i]))
            surface.planes[i] = triangle_plane(&soup.items[i]);
    surface.neighbours = walls_find_neighbours(soup.items, surface.planes, surface.count);
    return surface;
}

static void surface_free(struct surface *surface)
{
    soup_free(&surface->soup);
    alloc_free(surface->planes);
    alloc_free(surface->neighbours);
}

/* n x n cells of the unit square in the plane z = 0, but for `holes` from `hole` on. */
static struct soup grid(int n, int hole, int holes)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), n);
    memmove(soup.items + 2 * hole, soup.items + 2 * (hole + holes),
            (size_t)(soup.count - 2 * (hole + holes)) * sizeof *soup.items);
    soup.count -= 2 * holes;
    return soup;
}

/* --- neighbours --- */

/* Checks at how many sides walls go on, each of them both ways; takes over the soup. */
static void expect(struct soup soup, int joined, const char *name)
{
    struct surface made = surface_make(soup);
    int count = 0, mutual = 0;
    for (int32_t n = 0; n < 3 * made.count; n++) {
        const int32_t *back = made.neighbours + 3 * made.neighbours[n];
        count += made.neighbours[n] >= 0;
        mutual += made.neighbours[n] >= 0 &&
                  (back[0] == n / 3 || back[1] == n / 3 || back[2] == n / 3);
    }
    tap_ok(count == joined && mutual == joined, "%s: %d sides have a neighbour", name,
           count);
    surface_free(&made);
}

static void test_neighbours(void)
{
    expect(grid(4, 0, 0), 2 * (16 + 2 * 12), "16 cells in one plane");
    expect(grid(4, 5, 1), 2 * (15 + 2 * 12 - 4), "one of them missing");
    struct soup soup = grid(4, 0, 0);
    for (int k = 0; k < 32; k++) {
        struct triangle t = soup.items[k];
        soup_add(&soup, (struct triangle){{t.corner[0], t.corner[2], t.corner[1]}});
    }
    expect(soup, 4 * (16 + 2 * 12), "a wall with two faces: each by itself");
    soup = grid(4, 0, 0);
    soup.items[12].corner[0].z += 1e-6;
    expect(soup, 2 * (16 + 2 * 12 - 3), "one triangle is a little higher");
    soup = grid(1, 0, 0);
    soup_add_quad(&soup, point(1, 0, 0), point(0.5, 0, 0), point(0, 0.5, 0), 1);
    soup_add(&soup, (struct triangle){{point(0, 0, 0), point(1, 0, 0), point(2, 0, 0)}});
    for (int k = 0; k < 3; k++)
        soup_add(&soup, tile(3, 0, 1, true));
    expect(soup, 4, "sides that do not match, no area, three in one place");
}

/* --- proofs, all of them tilted, so that coordinates are rounded --- */

static void tilt(struct vec3 *points, int count)
{
    for (int k = 0; k < count; k++) {
        struct vec3 x = points[k];
        points[k] = point(0.8 * x.x - 0.6 * x.z, 0.96 * x.y - 0.28 * x.x,
                          0.6 * x.x + 0.8 * x.z + 0.28 * x.y);
    }
}

static struct surface tilted(struct soup soup)
{
    for (int64_t k = 0; k < soup.count; k++)
        tilt(soup.items[k].corner, 3);
    return surface_make(soup);
}

/* A convex set. */
struct body {
    struct vec3 corners[8];
    int count;
};

static struct body box(struct vec3 low, struct vec3 high)
{
    struct body body = {.count = 8};
    for (int k = 0; k < 8; k++)
        body.corners[k] = point(k & 1 ? high.x : low.x, k & 2 ? high.y : low.y,
                                k & 4 ? high.z : low.z);
    tilt(body.corners, body.count);
    return body;
}

/* A box or a triangle on the side of the square that `up` says, 1 or -1; one in four
 * touches its plane, one in four reaches through it. */
static struct body random_body(struct random *random, double up)
{
    double x = random_unit(random), y = random_unit(random);
    double z = 0.05 * (random_below(random, 4) - 1),
           size = random_between(random, 0.0, 0.5);
    struct body body = box(point(x, y, up * z),
                           point(x + size, y + 0.5 * size, up * (z + 0.1)));
    for (int k = 0; k < 3; k++)
        body.corners[k] = body.corners[3 * k];
    body.count = random_below(random, 2) ? 3 : 8;
    return body;
}

static struct vec3 random_point_in(struct random *random, const struct body *body)
{
    struct vec3 sum = {0, 0, 0};
    double weights = 0.0;
    for (int k = 0; k < body->count; k++) {
        double weight = random_unit(random) * random_unit(random) * random_unit(random);
        weights += weight;
        sum = vec3_add(sum, vec3_scale(body->corners[k], weight));
    }
    return vec3_scale(sum, 1.0 / weights);
}

static bool is_blocked(const struct surface *surface, struct vec3 x, struct vec3 y)
{
    const int32_t none[2] = {-1, -1};
    return brute_blocker(surface->soup.items, surface->planes, surface->count, x, y,
                         none) >= 0;
}

/* From how many triangles it is proved that the wall blocks all. */
static int proofs(const struct surface *wall, const struct body *p, const struct body *q)
{
    const struct walls walls = {wall->soup.items, wall->planes, wall->neighbours};
    int count = 0;
    for (int32_t t = 0; t < wall->count; t++)
        count += walls_stand_between(&walls, t, p->corners, p->count, q->corners,
                                     q->count);
    return count;
}

enum { TRIALS = 4000, SEGMENTS = 200 };

/* Random pairs on both sides of `wall`, which blocks segments; proofs are of `claimed`.
 * Convex: where all segments between corners are blocked, there is a proof. */
static void test_proofs(const struct surface *claimed, const struct surface *wall,
                        bool convex, bool right, const char *name)
{
    struct random random = random_seed(31);
    int proved = 0, passing = 0, missed = 0;
    for (int i = 0; i < TRIALS; i++) {
        double up = i % 2 ? 1.0 : -1.0;
        struct body p = random_body(&random, up), q = random_body(&random, -up);
        bool is_proved = proofs(claimed, &p, &q) > 0, all = true;
        for (int k = 0; k < p.count * q.count && all; k++)
            all = is_blocked(wall, p.corners[k / q.count], q.corners[k % q.count]);
        proved += is_proved;
        missed += convex && all && !is_proved;
        for (int k = 0; k < SEGMENTS && is_proved; k++)
            passing += !is_blocked(wall, random_point_in(&random, &p),
                                   random_point_in(&random, &q));
    }
    tap_ok(proved > TRIALS / 10 && missed == 0 && (passing == 0) == right,
           "%s: %d pairs are proved, %d missed, %d segments pass", name, proved, missed,
           passing);
}

/* Two rooms fill all up to the wall between them. */
static void test_rooms(int n)
{
    struct surface wall = tilted(grid(n, 0, 0)), holed = tilted(grid(n, n * n / 2, 1));
    struct body low = box(point(0, 0, -1), point(1, 1, 0));
    struct body high = box(point(0, 0, 0), point(1, 1, 1));
    struct body larger = box(point(0, -1e-9, 0), point(1, 1, 1));
    tap_ok(proofs(&wall, &low, &high) == wall.count && proofs(&holed, &low, &high) == 0 &&
               proofs(&wall, &larger, &low) == 0,
           "a wall of %d cells parts two rooms, unless it has a window or ends", n * n);
    surface_free(&wall);
    surface_free(&holed);
}

int main(void)
{
    struct surface whole = tilted(grid(4, 0, 0)), holed = tilted(grid(4, 5, 1));
    test_neighbours();
    test_proofs(&whole, &whole, true, true, "16 cells");
    test_proofs(&holed, &holed, false, true, "with a window");
    test_proofs(&whole, &holed, false, false, "with one that proofs do not know of");
    test_rooms(1);
    test_rooms(3);
    test_rooms(30);
    surface_free(&whole);
    surface_free(&holed);
    return tap_done();
}
