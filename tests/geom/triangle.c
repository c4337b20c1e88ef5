/* Tests of geom/triangle.h: areas, planes, subdivision to equal bits along shared edges,
 * degenerate triangles, and the segment test: nothing slips through the edges and
 * vertices of a closed mesh, a line in the plane misses, and an end point in the plane is
 * not blocked. */
#include "geom/triangle.h"

#include <string.h>

#include "tests/scenes.h"
#include "tests/tap.h"

enum { TRIANGLES = 10000, SEGMENTS = 30000 };

static bool same_bits(struct vec3 a, struct vec3 b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

/* --- measure --- */

static void test_measure(void)
{
    struct triangle t = {{{1, 1, 2}, {4, 1, 2}, {1, 5, 2}}};
    struct plane plane = triangle_plane(&t);
    struct vec3 centroid = triangle_centroid(&t);
    tap_ok(triangle_area(&t) == 6.0 && triangle_cross(&t).z == 12.0,
           "the 3-4-5 triangle");
    /* The factors 1 / 12 and 1 / 3 round once each: a few units in the last place. */
    tap_ok(fabs(plane.normal.z - 1.0) < 1e-15 && plane.normal.x == 0.0 &&
               plane.normal.y == 0.0 && fabs(plane.offset - 2.0) < 2e-15 &&
               fabs(centroid.x - 2.0) < 2e-15 && fabs(centroid.y - 7.0 / 3.0) < 2e-15,
           "its plane and centroid; the front is where it is counter-clockwise");
    tap_ok(plane_distance(&plane, point(9, 9, 5)) > 0 &&
               plane_distance(&plane, point(9, 9, 1)) < 0,
           "the distance is positive in front");
}

static void test_planes(void)
{
    struct random random = random_seed(1);
    double longest = 0.0, furthest = 0.0;
    for (int i = 0; i < TRIANGLES; i++) {
        struct triangle t = random_triangle(&random, 0.4, 0.1);
        if (triangle_area(&t) < 1e-4)
            continue;
        struct plane plane = triangle_plane(&t);
        longest = fmax(longest, fabs(vec3_length(plane.normal) - 1.0));
        for (int k = 0; k < 3; k++)
            furthest = fmax(furthest, fabs(plane_distance(&plane, t.corner[k])));
    }
    /* One division, one square root and three products. */
    tap_ok(longest <= 1e-15, "normals have unit length");
    /* Points round by 1e-16; an area of 1e-4 with edges up to 0.35 tilts the normal by
     * 6e-15 at the worst, over 0.2: the program's bound of rounding has room to
     * spare. */
    tap_ok(furthest <= GEOM_ROUNDING, "corners lie in their plane within GEOM_ROUNDING");
}

/* --- subdivision --- */

static void test_children(void)
{
    struct triangle t = {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
    static const struct triangle expected[4] = {{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}},
                                                {{{2, 0, 0}, {4, 0, 0}, {2, 2, 0}}},
                                                {{{0, 2, 0}, {2, 2, 0}, {0, 4, 0}}},
                                                {{{2, 2, 0}, {0, 2, 0}, {2, 0, 0}}}};
    bool right = true;
    for (int k = 0; k < 4; k++) {
        struct triangle child = triangle_child(&t, k);
        for (int c = 0; c < 3; c++)
            right = right && same_bits(child.corner[c], expected[k].corner[c]);
    }
    tap_ok(right, "children are (a, ab, ca), (ab, b, bc), (ca, bc, c), (bc, ca, ab)");
}

/* Two triangles with an edge in common, at any place in their lists of corners and in
 * opposite directions, split it at the same point. (So do their children, which have its
 * halves in common.) */
static void test_shared_edges(void)
{
    struct random random = random_seed(3);
    bool right = true;
    for (int i = 0; i < 900; i++) {
        struct triangle t = random_triangle(&random, 0.4, 0.1), u = t;
        int from = i % 3, to = i / 3 % 3;
        u.corner[to] = t.corner[(from + 1) % 3];
        u.corner[(to + 1) % 3] = t.corner[from];
        struct triangle first = triangle_child(&t, from), second = triangle_child(&u, to);
        right = right &&
                same_bits(first.corner[(from + 1) % 3], second.corner[(to + 1) % 3]);
    }
    tap_ok(right, "neighbours split their edge at the same bits");
}

/* --- degenerate triangles --- */

static void test_degenerate(void)
{
    struct random random = random_seed(4);
    bool repeated = true, collinear = true, sliver = true, plain = true;
    for (int i = 0; i < TRIANGLES; i++) {
        struct vec3 a = random_point(&random, 0.5), b = random_point(&random, 0.5);
        struct vec3 c = random_point(&random, 0.5);
        struct vec3 step = vec3_sub(b, a);
        struct vec3 across = vec3_unit(vec3_cross(step, vec3_sub(c, a)));
        struct vec3 between =
            vec3_add(a, vec3_scale(step, random_between(&random, 0.1, 0.9)));
        struct vec3 beside =
            vec3_add(between, vec3_scale(across, 1e-6 * vec3_length(step)));
        repeated = repeated && triangle_is_degenerate(&(struct triangle){{a, b, a}}) &&
                   triangle_is_degenerate(&(struct triangle){{a, b, b}}) &&
                   triangle_is_degenerate(&(struct triangle){{a, a, a}});
        collinear = collinear &&
                    triangle_is_degenerate(&(struct triangle){{a, b, between}}) &&
                    triangle_is_degenerate(&(struct triangle){{between, a, b}});
        sliver = sliver && !triangle_is_degenerate(&(struct triangle){{a, b, beside}}) &&
                 !triangle_is_degenerate(&(struct triangle){{beside, b, a}});
        plain = plain && !triangle_is_degenerate(&(struct triangle){{a, b, c}});
    }
    tap_ok(repeated, "triangles with repeated corners are degenerate");
    tap_ok(collinear, "triangles with corners on a line are degenerate");
    tap_ok(sliver, "slivers of 1 : 1e6 are not");
    tap_ok(plain, "random triangles are not");
}

/* --- the segment test --- */

static bool blocks(struct vec3 from, struct vec3 to, const struct triangle *t)
{
    struct segment segment = segment_make(from, to);
    struct plane plane = triangle_plane(t);
    return segment_is_blocked_by(&segment, t, &plane);
}

static bool mesh_blocks(const struct soup *mesh, struct vec3 from, struct vec3 to)
{
    for (int64_t i = 0; i < mesh->count; i++)
        if (blocks(from, to, &mesh->items[i]))
            return true;
    return false;
}

/* The rule by signed volumes, for segments that stay away from edges. */
static void test_inside(void)
{
    struct random random = random_seed(5);
    bool right = true, weights = true, both = true;
    int blocked = 0;
    for (int i = 0; i < 10 * TRIANGLES; i++) {
        struct triangle t = random_triangle(&random, 0.1, 0.4);
        struct vec3 from = random_point(&random, 0.5), to = random_point(&random, 0.5);
        if (triangle_area(&t) < 1e-3)
            continue;
        struct vec3 d = vec3_sub(to, from);
        double volume[3], least = 1.0, most = -1.0;
        for (int k = 0; k < 3; k++) {
            struct vec3 v = vec3_sub(t.corner[(k + 1) % 3], from);
            struct vec3 w = vec3_sub(t.corner[(k + 2) % 3], from);
            volume[k] = vec3_dot(d, vec3_cross(v, w));
            least = fmin(least, volume[k]);
            most = fmax(most, volume[k]);
        }
        if (fabs(least) < 1e-9 || fabs(most) < 1e-9)
            continue; /* too near an edge for this rule */
        struct segment segment = segment_make(from, to);
        struct plane plane = triangle_plane(&t);
        double weight[3];
        bool meets = segment_line_meets(&segment, &t, weight);
        bool crosses = plane_distance(&plane, from) * plane_distance(&plane, to) < 0.0;
        right = right && meets == (least > 0.0 || most < 0.0) &&
                blocks(from, to, &t) == (meets && crosses);
        both = both && blocks(from, to, &t) == blocks(to, from, &t);
        blocked += blocks(from, to, &t);
        double sum = volume[0] + volume[1] + volume[2];
        for (int k = 0; meets && k < 3;
             k++) /* volumes above 1e-9 have 6 digits at least */
            weights = weights && fabs(weight[k] - volume[k] / sum) < 1e-6;
    }
    tap_ok(right && blocked > 1000, "segments are blocked where signed volumes say so");
    tap_ok(weights, "the weights are the shares of the volumes");
    tap_ok(both, "a blocked segment is blocked in both directions");
}

/* A sphere whose vertices are moved at random, those of different triangles alike: each
 * vertex is scaled by a hash of its bits. */
static void make_potato(struct soup *mesh, int level)
{
    soup_add_sphere(mesh, 0.4, level);
    for (int64_t i = 0; i < 3 * mesh->count; i++) {
        struct vec3 *v = &mesh->items[i / 3].corner[i % 3];
        struct random random = random_seed((uint64_t)(int64_t)(1e6 * v->x) * 31 +
                                           (uint64_t)(int64_t)(1e6 * v->y) * 37 +
                                           (uint64_t)(int64_t)(1e6 * v->z) * 41);
        *v = vec3_scale(*v, 0.9 + 0.2 * random_unit(&random));
    }
}

/* From near the centre, through a point that lies on an edge or a vertex up to rounding,
 * and as far again: an end inside, an end outside. The mesh is star-shaped about the
 * origin. */
static void test_closed_mesh(void)
{
    struct soup mesh = {0};
    make_potato(&mesh, 2);
    struct random random = random_seed(6);
    int escapes[3] = {0, 0, 0};
    for (int i = 0; i < SEGMENTS; i++) {
        const struct triangle *t =
            &mesh.items[random_below(&random, (int32_t)mesh.count)];
        struct vec3 a = t->corner[i % 3], b = t->corner[(i + 1) % 3];
        struct vec3 along = vec3_scale(vec3_sub(b, a), random_unit(&random));
        struct vec3 from = random_point(&random, 0.05);
        struct vec3 through[3] = {a, vec3_add(a, along), random_point_on(&random, t)};
        for (int k = 0; k < 3; k++) {
            struct vec3 to = vec3_add(through[k], vec3_sub(through[k], from));
            escapes[k] += !mesh_blocks(&mesh, from, to);
        }
    }
    tap_ok(escapes[0] == 0, "no segment escapes at a vertex of a closed mesh");
    tap_ok(escapes[1] == 0, "none through an edge");
    tap_ok(escapes[2] == 0, "none through a face");
    soup_free(&mesh);
}

/* Segments through the apex of a fan to the last bit: the apex has few bits, and so has
 * the step to either side. Then the same, moved by units in the last place. */
static void test_fan(void)
{
    struct random random = random_seed(7);
    int exact = 0, near = 0;
    for (int i = 0; i < SEGMENTS; i++) {
        enum { BLADES = 7 };
        struct vec3 apex = point(random_below(&random, 64) / 128.0 - 0.25,
                                 random_below(&random, 64) / 128.0 - 0.25, 0.0);
        struct vec3 ring[BLADES];
        for (int k = 0; k < BLADES; k++) {
            double angle = (k + 0.8 * random_unit(&random)) * 6.283185307179586 / BLADES;
            ring[k] = vec3_add(apex, point(0.2 * cos(angle), 0.2 * sin(angle),
                                           random_between(&random, -0.05, 0.05)));
        }
        struct vec3 step = point(random_below(&random, 9) / 64.0 - 1.0 / 16.0,
                                 random_below(&random, 9) / 64.0 - 1.0 / 16.0, 0.25);
        struct vec3 from = vec3_sub(apex, step), to = vec3_add(apex, step), moved = to;
        moved.x += random_between(&random, -4e-16, 4e-16);
        moved.y += random_between(&random, -4e-16, 4e-16);
        bool blocked = false, blocked_near = false;
        for (int k = 0; k < BLADES; k++) {
            struct triangle t = {{apex, ring[k], ring[(k + 1) % BLADES]}};
            blocked = blocked || blocks(from, to, &t);
            blocked_near = blocked_near || blocks(from, moved, &t);
        }
        exact += !blocked;
        near += !blocked_near;
    }
    tap_ok(exact == 0, "no segment slips through the apex of a fan");
    tap_ok(near == 0, "nor beside it");
}

static void test_plane(void)
{
    struct random random = random_seed(8);
    bool missed = true, axis = true;
    for (int i = 0; i < TRIANGLES; i++) {
        struct triangle t = random_triangle(&random, 0.3, 0.2);
        if (triangle_area(&t) < 1e-4)
            continue;
        struct triangle far = {{vec3_sub(vec3_scale(t.corner[0], 2.0), t.corner[1]),
                                vec3_sub(vec3_scale(t.corner[1], 2.0), t.corner[2]),
                                vec3_sub(vec3_scale(t.corner[2], 2.0), t.corner[0])}};
        struct vec3 outside = random_point_on(&random, &far);
        missed = missed && !blocks(outside, random_point_on(&random, &t), &t) &&
                 !blocks(far.corner[0], far.corner[1], &t);
        t.corner[0].z = t.corner[1].z = t.corner[2].z;
        struct vec3 from = random_point(&random, 0.5), to = random_point(&random, 0.5);
        from.z = to.z = t.corner[0].z;
        struct segment segment = segment_make(from, to);
        axis = axis && !segment_line_meets(&segment, &t, NULL);
    }
    tap_ok(missed, "segments in the plane of a triangle are not blocked by it");
    tap_ok(axis, "and in an axis plane, without rounding, not even their line meets it");
}

/* An end point on the triangle, on the line to a start in front of it or behind it. */
static void test_decals(void)
{
    struct random random = random_seed(9);
    bool seen = true, hidden = true;
    for (int i = 0; i < TRIANGLES; i++) {
        struct triangle t = random_triangle(&random, 0.3, 0.2);
        struct plane plane = triangle_plane(&t);
        struct vec3 from = random_point(&random, 0.5);
        if (triangle_area(&t) < 1e-4 || fabs(plane_distance(&plane, from)) < 0.05)
            continue;
        struct vec3 on =
            vec3_add(vec3_scale(random_point_on(&random, &t), 0.98),
                     vec3_scale(triangle_centroid(&t), 0.02)); /* not at an edge */
        struct vec3 step = vec3_unit(vec3_sub(on, from));
        struct vec3 beyond = vec3_add(on, vec3_scale(step, 1e-11));
        seen = seen && !blocks(from, on, &t) && !blocks(on, from, &t);
        hidden = hidden && blocks(from, beyond, &t) && blocks(beyond, from, &t);
    }
    tap_ok(seen, "a point on a triangle is seen from both sides");
    tap_ok(hidden, "a point 1e-11 behind it is not");
}

static void test_overlap(void)
{
    struct random random = random_seed(10);
    bool over = true, beside = true;
    for (int i = 0; i < TRIANGLES; i++) {
        struct triangle t = random_triangle(&random, 0.3, 0.2);
        if (triangle_area(&t) < 1e-4)
            continue;
        struct plane plane = triangle_plane(&t);
        struct triangle turned = triangle_turned(&t), child[4];
        struct plane other = triangle_plane(&turned);
        over = over && !triangle_is_in(&turned, &other, &plane);
        for (int k = 0; k < 4; k++) {
            child[k] = triangle_child(&t, k);
            over = over && triangle_is_in(&child[k], &plane, &plane) &&
                   triangles_overlap(&t, &child[k], &plane);
            for (int j = 0; j < k; j++)
                beside = beside && !triangles_overlap(&child[j], &child[k], &plane);
        }
    }
    tap_ok(over && beside, "a child overlaps its parent, and no sister");
}

int main(void)
{
    test_measure();
    test_planes();
    test_children();
    test_shared_edges();
    test_degenerate();
    test_inside();
    test_closed_mesh();
    test_fan();
    test_plane();
    test_decals();
    test_overlap();
    return tap_done();
}
