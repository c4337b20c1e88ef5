/* Tests of octree/octree.h against brute force over all triangles, in three scenes: a
 * random soup; a closed room with boxes on its floor; a sphere with coincident triangles,
 * needles and dropped triangles. Segments are random, run through vertices and edges, lie
 * in axis planes, graze planes, join two triangles of the scene or pass through one that
 * is not to count. Then: ten thousand coincident triangles, which triangles are hull, the
 * rules of the first hit, and the counters. */
#include "octree/octree.h"

#include <string.h>

#include "geom/hull.h"
#include "geom/wall.h"
#include "octree/tree.h"
#include "tests/scenes.h"
#include "tests/tap.h"

/* Puts specks into the eight corners of space, far outside the world, so that its own
 * triangles are not the hull and segments that leave it can be asked about; and doubles
 * back, which a scene drops. */
static void surround(struct world *world)
{
    struct scene *scene = world->scene;
    for (int32_t i = 0; i < scene->input_count; i++)
        if (!triangle_is_degenerate(&scene->triangles[i]))
            scene->planes[i] = triangle_plane(&scene->triangles[i]);
    size_t count = (size_t)scene->input_count + 8;
    scene->triangles = alloc_resize(scene->triangles, count, sizeof *scene->triangles);
    scene->planes = alloc_resize(scene->planes, count, sizeof *scene->planes);
    for (int k = 0; k < 8; k++) {
        struct vec3 a = {k & 1 ? 0.99 : -0.99, k & 2 ? 0.99 : -0.99,
                         k & 4 ? 0.99 : -0.99};
        struct vec3 b = vec3_scale(a, 0.999999), c = {a.x, b.y, b.z};
        struct triangle speck = {{a, b, c}};
        scene->triangles[count - 8 + (size_t)k] = speck;
        scene->planes[count - 8 + (size_t)k] = triangle_plane(&speck);
    }
    octree_destroy(world->octree);
    world->octree = octree_create(scene->triangles, scene->planes, (int32_t)count);
}

/* The triangle that blocks a segment, or -1. */
static int32_t octree_blocker(const struct octree *octree, struct vec3 from,
                              struct vec3 to, const int32_t own[2], int32_t guess,
                              struct octree_counts *counts)
{
    return octree_blocks_segment(octree, from, to, own, &guess, counts) ? guess : -1;
}

enum { SEGMENTS = 100000, RAYS = 8000, PACKETS = 1000, WALLS = 20000,
       SHAFTS = 3000, ENTRANTS = 24 };

/* --- scenes --- */

static void make_soup(struct soup *soup)
{
    struct random random = random_seed(1);
    for (int i = 0; i < 2000; i++) {
        struct triangle t = random_triangle(&random, 0.5, i % 10 == 0 ? 0.4 : 0.05);
        int axis =
            i % 7; /* 0, 1, 2: lies in an axis plane, where rounding does not help */
        for (int k = 1; k < 3; k++) {
            t.corner[k].x = axis == 0 ? t.corner[0].x : t.corner[k].x;
            t.corner[k].y = axis == 1 ? t.corner[0].y : t.corner[k].y;
            t.corner[k].z = axis == 2 ? t.corner[0].z : t.corner[k].z;
        }
        soup_add(soup, t);
    }
}

static void make_room(struct soup *soup)
{
    soup_add_box(soup, point(0, 0, 0), point(4, 3, 2.5), 10, true);
    soup_add_box(soup, point(0.5, 0.5, 0), point(1.5, 1.25, 1), 4, false);
    soup_add_box(soup, point(2.1, 1.2, 0), point(3.3, 2.2, 0.7), 4, false);
    soup_add_box(soup, point(2.3, 1.3, 0.7), point(2.9, 1.9, 1.9), 4, false);
}

static void make_sphere(struct soup *soup)
{
    struct random random = random_seed(2);
    soup_add_sphere(soup, 0.8, 3);
    for (int i = 0; i < 100; i++)
        soup_add(soup, soup->items[i]); /* coincident */
    for (int i = 0; i < 300; i++) {
        struct vec3 a = random_point(&random, 1.0), b = random_point(&random, 1.0), c = b;
        c.x += random_between(&random, -1e-6, 1e-6);
        c.y += random_between(&random, -1e-6, 1e-6);
        soup_add(soup,
                 (struct triangle){{a, b, i % 10 == 0 ? a : c}}); /* needle, or dropped */
    }
}

/* --- segments --- */

struct question {
    struct vec3 from, to;
    int32_t own[2];
};

static struct vec3 random_corner(struct random *random, const struct scene *scene)
{
    int32_t t = random_below(random, scene->input_count);
    return scene->triangles[t].corner[random_below(random, 3)];
}

static struct vec3 random_edge_point(struct random *random, const struct scene *scene)
{
    const struct triangle *t =
        &scene->triangles[random_below(random, scene->input_count)];
    int k = random_below(random, 3);
    struct vec3 along = vec3_sub(t->corner[(k + 1) % 3], t->corner[k]);
    return vec3_add(t->corner[k], vec3_scale(along, random_unit(random)));
}

/* As far behind `through` as it is from `from`. */
static struct vec3 beyond(struct vec3 from, struct vec3 through)
{
    return vec3_add(through, vec3_sub(through, from));
}

/* The point above x, by a height. */
static struct vec3 lift_to(const struct plane *plane, struct vec3 x, double height)
{
    return vec3_add(x, vec3_scale(plane->normal, height - plane_distance(plane, x)));
}

static struct question random_question(struct random *random, const struct scene *scene)
{
    int32_t t;
    struct vec3 along;
    struct question q = {random_point(random, 0.5), random_point(random, 0.5), {-1, -1}};
    int side = random_below(random, 2);
    switch (random_below(random, 8)) {
    case 0: q.to = beyond(q.from, random_corner(random, scene)); break;
    case 1: q.to = beyond(q.from, random_edge_point(random, scene)); break;
    case 2: /* in an axis plane through a corner, every other one along an axis */
        q.from = random_corner(random, scene);
        q.to.x = q.from.x;
        q.to.y = random_bits(random) & 1 ? q.from.y : q.to.y;
        break;
    case 3: /* from edge to edge */
        q.from = random_edge_point(random, scene);
        q.to = random_edge_point(random, scene);
        break;
    case 4: /* as form factors ask */
        for (int k = 0; k < 2; k++)
            q.own[k] = random_below(random, scene->input_count);
        q.from = triangle_centroid(&scene->triangles[q.own[0]]);
        q.to = triangle_centroid(&scene->triangles[q.own[1]]);
        break;
    case 5: /* through a triangle that is one's own and would block */
        q.own[side] = random_below(random, scene->input_count);
        q.to = beyond(q.from, random_point_on(random, &scene->triangles[q.own[side]]));
        break;
    case 6: /* grazes a plane near an edge: where it is crossed is lost in rounding */
        t = random_below(random, scene->input_count);
        q.to = random_point_on(random, &scene->triangles[t]);
        q.from = vec3_add(scene->triangles[t].corner[0], random_point(random, 1e-5));
        along = vec3_scale(vec3_sub(q.to, q.from), 0.1);
        q.to = lift_to(&scene->planes[t], vec3_sub(q.from, along), 3e-14);
        q.from = lift_to(&scene->planes[t], vec3_add(q.from, along), -3e-14);
        break;
    default: break;
    }
    if (memcmp(&q.from, &q.to, sizeof q.from) == 0)
        q.to.z += 0.25;
    return q;
}

/* --- blockers --- */

static bool is_blocker(const struct scene *scene, const struct question *q, int32_t t)
{
    struct segment segment = segment_make(q->from, q->to);
    return t >= 0 && t < scene->input_count && t != q->own[0] && t != q->own[1] &&
           segment_is_blocked_by(&segment, &scene->triangles[t], &scene->planes[t]);
}

/* Work of a plain loop over all triangles, to be undercut. */
static int64_t plain_work(const struct scene *scene)
{
    return (int64_t)SEGMENTS * scene->input_count;
}

static void test_blockers(const struct world *world, const char *name)
{
    const struct scene *scene = world->scene;
    struct random random = random_seed(3);
    struct octree_counts counts = {0}, guesses = {0}, again = {0};
    int wrong = 0, false_blockers = 0, misled = 0, blocked = 0, unlike = 0;
    for (int i = 0; i < SEGMENTS; i++) {
        struct question q = random_question(&random, scene);
        int32_t brute = brute_blocker(scene->triangles, scene->planes, scene->input_count,
                                      q.from, q.to, q.own);
        int32_t found = octree_blocker(world->octree, q.from, q.to, q.own, -1, &counts);
        wrong += (brute >= 0) != (found >= 0);
        unlike += found !=
                  octree_blocker(world->octree, q.from, q.to, q.own, -1, &again);
        false_blockers += found >= 0 && !is_blocker(scene, &q, found);
        int32_t guess = i % 3 == 0   ? q.own[i & 1]
                        : i % 3 == 1 ? brute
                                     : random_below(&random, scene->input_count);
        int32_t guessed =
            octree_blocker(world->octree, q.from, q.to, q.own, guess, &guesses);
        misled += (guessed >= 0) != (brute >= 0);
        misled += guessed >= 0 && !is_blocker(scene, &q, guessed);
        blocked += brute >= 0;
    }
    tap_ok(wrong == 0, "%s: %d segments, of which %d are blocked, as by brute force",
           name, (int)SEGMENTS, blocked);
    tap_ok(false_blockers == 0, "%s: the blocker named blocks and is not one's own",
           name);
    tap_ok(misled == 0, "%s: no guess changes the answer", name);
    tap_ok(counts.rays == SEGMENTS && guesses.rays == SEGMENTS,
           "%s: a question counts once", name);
    tap_ok(unlike == 0 && memcmp(&counts, &again, sizeof counts) == 0,
           "%s: the same question has the same answer and takes the same work", name);
    /* 3 % of it are box tests in the soup; needles as long as the scene make it 15 %. */
    tap_ok(counts.triangle_tests > 0 && counts.triangle_tests < plain_work(scene) / 5 &&
               counts.node_tests < plain_work(scene) / 5,
           "%s: with a small part of the work", name);
}

/* --- first hits --- */

/* Parameter of the ray's point in the triangle, in lengths of `ray`, or -1. */
static double hit_distance(const struct scene *scene, int32_t t,
                           const struct segment *ray, bool fronts_only)
{
    const struct plane *plane = &scene->planes[t];
    double start = plane_distance(plane, ray->from);
    double speed = -vec3_dot(plane->normal, vec3_sub(ray->to, ray->from));
    if (start * speed <= 0.0 || (fronts_only && start <= 0.0) ||
        !segment_line_meets(ray, &scene->triangles[t], NULL))
        return -1.0;
    return start / speed;
}

/* A ray from within, from far away, or from just above the front of a triangle; each in
 * turn with no step along one axis, or along two. */
static void random_ray(struct random *random, const struct scene *scene, int number,
                       struct vec3 *origin, struct vec3 *direction)
{
    *origin = random_point(random, number % 2 ? 0.3 : 2.0);
    *direction = vec3_scale(vec3_sub(random_point(random, 0.5), *origin),
                            random_between(random, 0.1, 9));
    if (number % 5 == 0) {
        int32_t t = random_below(random, scene->input_count);
        *origin = vec3_add(random_point_on(random, &scene->triangles[t]),
                           vec3_scale(scene->planes[t].normal, 1024.0 * GEOM_ROUNDING));
    }
    if (number % 7 < 2)
        direction->x = 0.0;
    if (number % 7 == 1)
        direction->y = 0.0;
}

/* Where two triangles are met at once any will do that is no further away than
 * rounding. */
static void test_first_hits(const struct world *world, const char *name, bool fronts_only)
{
    const struct scene *scene = world->scene;
    struct random random = random_seed(5);
    struct octree_counts counts = {0};
    int wrong = 0, hits = 0, wrong_weights = 0;
    for (int i = 0; i < RAYS; i++) {
        struct vec3 origin, direction;
        random_ray(&random, scene, i, &origin, &direction);
        struct segment ray = segment_make(origin, vec3_add(origin, direction));
        double nearest = HUGE_VAL;
        for (int32_t t = 0; t < scene->input_count; t++) {
            double at = hit_distance(scene, t, &ray, fronts_only);
            nearest = at >= 0.0 ? fmin(nearest, at) : nearest;
        }
        struct octree_hit hit;
        bool found = octree_first_hit(world->octree, origin, direction, fronts_only, &hit,
                                      &counts);
        hits += found;
        wrong += found != (nearest < HUGE_VAL);
        if (!found)
            continue;
        octree_hit_weights(world->octree, origin, direction, &hit);
        double at = hit_distance(scene, hit.triangle, &ray, fronts_only);
        double front = plane_distance(&scene->planes[hit.triangle], origin);
        /* Positions are right to 1e-13 or so; planes of needles, whose normals come of an
         * area of 1e-6, to 1e-8. */
        double reach = vec3_length(direction);
        wrong += at < 0.0 || (at - nearest) * reach > 1e-8 || hit.front != (front > 0.0);
        struct vec3 x = vec3_add(origin, vec3_scale(direction, at)), y = {0, 0, 0};
        for (int k = 0; k < 3; k++)
            y = vec3_add(y, vec3_scale(scene->triangles[hit.triangle].corner[k],
                                       hit.weight[k]));
        wrong_weights += vec3_length(vec3_sub(x, y)) > 1e-6;
    }
    tap_ok(wrong == 0 && hits > RAYS / 10, "%s%s: first hits as by brute force (%d hits)",
           name, fronts_only ? ", fronts only" : "", hits);
    tap_ok(wrong_weights == 0, "%s: the weights give the point", name);
    tap_ok(counts.rays == RAYS, "%s: a ray counts once", name);
}

/* From the eye of random_ray(), or in the plane of a triangle, to places in a spot that
 * is from a millionth to half of the scene; the last goes to a corner. Returns their
 * number. */
static int random_packet(struct random *random, const struct scene *scene, int number,
                         struct vec3 *eye, struct vec3 directions[PACKET_RAYS])
{
    int32_t target = random_below(random, scene->input_count);
    const struct triangle *t = &scene->triangles[target];
    int count = 1 + random_below(random, PACKET_RAYS);
    double spot = 0.5;
    for (int k = random_below(random, 7); k > 0; k--)
        spot *= 0.1;
    struct vec3 direction;
    random_ray(random, scene, number, eye, &direction);
    for (int k = 1; k < 3 && number % 8 == 3; k++) {
        struct vec3 edge = vec3_sub(t->corner[k], t->corner[0]);
        struct vec3 from = k == 1 ? t->corner[0] : *eye;
        *eye = vec3_add(from, vec3_scale(edge, random_between(random, -2, 3)));
    }
    struct vec3 to = vec3_sub(random_point_on(random, t), *eye);
    to = number % 3 == 0 ? direction : to;
    for (int k = 0; k < count; k++)
        directions[k] = vec3_add(to, random_point(random, spot));
    directions[count - 1] = vec3_sub(t->corner[number % 3], *eye);
    return count;
}

/* True if `hit` is the ray's own answer, its weights too, to the bit. */
static bool is_as_alone(const struct octree *octree, struct vec3 origin,
                        struct vec3 direction, bool fronts_only,
                        const struct octree_hit *hit, bool weighed, int *hits,
                        struct octree_counts *counts)
{
    struct octree_hit own;
    if (!octree_first_hit(octree, origin, direction, fronts_only, &own, counts))
        return hit->triangle == -1;
    ++*hits;
    octree_hit_weights(octree, origin, direction, &own);
    return hit->triangle == own.triangle && hit->front == own.front &&
           (!weighed || memcmp(hit->weight, own.weight, sizeof own.weight) == 0);
}

/* Packets answer as their rays do one by one. */
static void test_packets(const struct world *world, const char *name, bool fronts_only)
{
    struct random random = random_seed(21);
    struct octree_counts counts = {0}, single = {0};
    int wrong = 0, hits = 0;
    for (int i = 0; i < PACKETS; i++) {
        struct vec3 eye, directions[PACKET_RAYS];
        struct octree_hit together[PACKET_RAYS];
        int count = random_packet(&random, world->scene, i, &eye, directions);
        octree_first_hits(world->octree, eye, directions, count, fronts_only, together,
                          &counts);
        for (int k = 0; k < count; k++)
            wrong += !is_as_alone(world->octree, eye, directions[k], fronts_only,
                                  &together[k], true, &hits, &single);
    }
    tap_ok(wrong == 0 && hits > PACKETS && counts.rays == single.rays,
           "%s%s: packets of rays as one by one (%d hits)", name,
           fronts_only ? ", fronts only" : "", hits);
    tap_ok(counts.node_tests < single.node_tests,
           "%s: and look at fewer nodes (%d, %d)", name, (int)counts.node_tests,
           (int)single.node_tests);
}

/* Streams answer as their rays do one by one, wherever these begin: each anywhere, or
 * all in one place. */
static void test_streams(const struct world *world, const char *name, bool fronts_only)
{
    struct random random = random_seed(22);
    struct octree_counts counts = {0}, single = {0};
    int wrong = 0, hits = 0;
    for (int i = 0; i < PACKETS / 8; i++) {
        struct stream s = {.count = 1 + random_below(&random, STREAM_RAYS)};
        for (int k = 0; k < s.count; k++) {
            random_ray(&random, world->scene, i + k, &s.origins[k], &s.directions[k]);
            s.origins[k] = s.origins[i % 2 ? k : 0];
        }
        octree_stream_hits(world->octree, &s, fronts_only, &counts);
        for (int k = 0; k < s.count; k++)
            wrong += !is_as_alone(world->octree, s.origins[k], s.directions[k],
                                  fronts_only, &s.hits[k], false, &hits, &single);
    }
    tap_ok(wrong == 0 && hits > PACKETS && counts.rays == single.rays,
           "%s%s: streams of rays as one by one (%d hits)", name,
           fronts_only ? ", fronts only" : "", hits);
}

/* A random triangle, or a box at a corner of it. Returns the number of corners. */
static int random_corners(struct random *random, const struct scene *scene,
                          struct vec3 corners[8])
{
    int32_t number = random_below(random, scene->input_count);
    const struct triangle *t = &scene->triangles[number];
    bool is_box = random_below(random, 2) == 0;
    struct vec3 low = t->corner[0], high = vec3_add(low, random_point(random, 0.1));
    for (int k = 0; k < 8; k++)
        corners[k] =
            point(k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z);
    for (int k = 0; k < 3 && !is_box; k++)
        corners[k] = t->corner[k];
    return is_box ? 8 : 3;
}

static struct vec3 mean_of(const struct vec3 *corners, int count)
{
    struct vec3 sum = {0.0, 0.0, 0.0};
    for (int k = 0; k < count; k++)
        sum = vec3_add(sum, corners[k]);
    return vec3_scale(sum, 1.0 / count);
}

/* Walls are found if there are any, as by looking at all triangles. */
static void test_walls(const struct world *world, const char *name)
{
    const struct scene *scene = world->scene;
    int32_t *neighbours = walls_find_neighbours(scene->triangles, scene->planes,
                                                scene->input_count);
    const struct walls walls = {scene->triangles, scene->planes, neighbours};
    struct random random = random_seed(12);
    struct octree_counts counts = {0};
    int found = 0, wrong = 0;
    for (int i = 0; i < WALLS; i++) {
        struct vec3 p[8], q[8];
        int count_p = random_corners(&random, scene, p);
        int count_q = random_corners(&random, scene, q);
        struct segment s = segment_make(mean_of(p, count_p), mean_of(q, count_q));
        bool has = octree_has_wall(world->octree, p, count_p, q, count_q, &counts);
        bool expected = false;
        for (int32_t t = 0; t < scene->input_count && !expected; t++)
            expected = segment_is_blocked_by(&s, &scene->triangles[t],
                                             &scene->planes[t]) &&
                       walls_stand_between(&walls, t, p, count_p, q, count_q);
        found += has;
        wrong += has != expected;
    }
    alloc_free(neighbours);
    tap_ok(found > 0 && wrong == 0, "%s: %d walls are found, %d answers are wrong", name,
           found, wrong);
}

/* --- shafts --- */

/* A triangle of the scene, or a part of one. */
static struct triangle random_part(struct random *random, const struct scene *scene,
                                   int32_t *number)
{
    do {
        *number = random_below(random, scene->input_count);
    } while (!(scene->areas[*number] > 0.0));
    struct triangle part = scene->triangles[*number];
    for (int level = random_below(random, 4); level > 0; level--)
        part = triangle_child(&part, random_below(random, 4));
    return part;
}

static bool has_corner_in_front(const struct triangle *t, const struct plane *plane)
{
    double highest = plane_distance(plane, t->corner[0]);
    for (int k = 1; k < 3; k++)
        highest = real_max(highest, plane_distance(plane, t->corner[k]));
    return highest > GEOM_ROUNDING;
}

/* What reaches into the space between two triangles is listed, as by looking at all;
 * nothing else stops a segment between their fronts. */
static void test_shafts(const struct world *world, const char *name)
{
    const struct scene *scene = world->scene;
    struct random random = random_seed(15);
    struct octree_counts counts = {0};
    int listed = 0, overfull = 0, wrong = 0, stopped = 0, missed = 0;
    for (int i = 0; i < SHAFTS; i++) {
        int32_t own[2], entrants[ENTRANTS], count = 0, most = i % 3 * (ENTRANTS / 2);
        struct triangle p = random_part(&random, scene, &own[0]);
        struct triangle q = random_part(&random, scene, &own[1]);
        const struct plane *plane_p = &scene->planes[own[0]],
                           *plane_q = &scene->planes[own[1]];
        if (!has_corner_in_front(&p, plane_q) || !has_corner_in_front(&q, plane_p))
            continue;
        int32_t found = octree_list_shaft(world->octree, &p, plane_p, &q, plane_q, own,
                                          entrants, most, &counts);
        struct hull hull = hull_of_pair(&p, plane_p, &q, plane_q);
        struct vec3 from = random_point_on(&random, &p);
        struct vec3 to = random_point_on(&random, &q);
        struct question segment = {from, to, {own[0], own[1]}};
        bool faces = plane_distance(plane_p, to) > 0.0 &&
                     plane_distance(plane_q, from) > 0.0;
        for (int32_t t = 0; t < scene->input_count; t++) {
            bool enters = t != own[0] && t != own[1] &&
                          vec3_length(scene->planes[t].normal) > 0.0 &&
                          hull_is_entered(&hull, &scene->triangles[t]);
            bool stops = faces && is_blocker(scene, &segment, t);
            wrong += enters && count < found && found <= most && entrants[count] != t;
            count += enters;
            stopped += stops;
            missed += stops && !enters;
        }
        wrong += found != (count > most ? most + 1 : count);
        listed += found <= most ? found : 0;
        overfull += found > most;
    }
    tap_ok(listed > 0 && overfull > 0 && wrong == 0,
           "%s: shafts list %d triangles, and %d have more; %d answers are wrong", name,
           listed, overfull, wrong);
    tap_ok(stopped > 0 && missed == 0,
           "%s: of %d triangles that stop a segment there %d reach into no shaft", name,
           stopped, missed);
}

/* The octree becomes a view of its own packed bytes, moved from where they were packed.
 * Returns their block. */
static char *repack(struct world *world)
{
    struct pack count = {0}, write = {.writes = true}, read = {0};
    octree_pack(world->octree, &count);
    write.block = alloc_array(count.bytes, 1);
    read.block = alloc_array(count.bytes, 1);
    octree_pack(world->octree, &write);
    memcpy(read.block, write.block, count.bytes);
    alloc_free(write.block);
    octree_destroy(world->octree);
    world->octree = octree_view(&read, world->scene->triangles, world->scene->planes);
    tap_ok(write.bytes == count.bytes && read.bytes == count.bytes,
           "%zu bytes when packed", count.bytes);
    return read.block;
}

static void test_scene(void (*make)(struct soup *), bool packed, const char *name)
{
    struct soup soup = {0};
    make(&soup);
    struct world world = world_make(scene_of_soup(&soup));
    surround(&world);
    char *block = packed ? repack(&world) : NULL;
    test_blockers(&world, name);
    for (int fronts_only = 0; fronts_only < 2; fronts_only++) {
        test_first_hits(&world, name, fronts_only);
        test_packets(&world, name, fronts_only);
        test_streams(&world, name, fronts_only);
    }
    test_walls(&world, name);
    test_shafts(&world, name);
    world_free(&world);
    alloc_free(block);
}

/* --- the hull --- */

/* True if no corner of the scene is further above the plane than rounding. */
static bool is_highest(const struct scene *scene, struct vec3 normal, double offset)
{
    const struct plane plane = {normal, offset};
    for (int32_t i = 0; i < scene->input_count; i++)
        for (int k = 0; k < 3; k++)
            if (plane_distance(&plane, scene->triangles[i].corner[k]) >
                0.5 * GEOM_ROUNDING)
                return false;
    return true;
}

/* Tiles at four heights, apart by rounding and by more, each tilted as little, in a mixed
 * order: what one of them has shown is no proof for the next. Triangles are hull that
 * have the whole scene on one side, and no others. */
static void test_terrace(void)
{
    enum { TILES = 30 };
    struct soup soup = {0};
    struct random random = random_seed(9);
    for (int i = 0; i < TILES * TILES; i++) {
        struct vec3 at = point(i % TILES, i / TILES, 5e-14 * random_below(&random, 4));
        struct vec3 u = point(1, 0, 1e-14 * random_below(&random, 4));
        soup_add_quad(&soup, at, u, point(0, 1, 0), 1);
    }
    struct world world = world_make(scene_of_soup(&soup));
    const struct scene *scene = world.scene;
    int hull = 0, wrong = 0;
    for (int32_t i = 0; i < scene->input_count; i++) {
        const struct plane *plane = &scene->planes[i];
        bool apart = is_highest(scene, plane->normal, plane->offset) ||
                     is_highest(scene, vec3_scale(plane->normal, -1.0), -plane->offset);
        hull += apart;
        wrong += apart != (world.octree->place[i] < 0);
    }
    tap_ok(wrong == 0 && hull > 0 && hull < scene->input_count,
           "of %d tiles apart by hairs %d are hull", (int)scene->input_count, hull);
    world_free(&world);
}

/* A floor of so many tiles that to walk over all of them for each would take minutes. */
static void test_floor(void)
{
    enum { TILES = 200 };
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(2, 0, 0), point(0, 1, 0), TILES);
    soup_add_box(&soup, point(0.5, 0.5, 0), point(0.7, 0.7, 0.1), 1, false);
    struct world world = world_make(scene_of_soup(&soup));
    int32_t hull = 0;
    for (int32_t i = 0; i < 2 * TILES * TILES; i++)
        hull += world.octree->place[i] < 0;
    tap_ok(hull == 2 * TILES * TILES, "a floor of %d triangles is hull", hull);
    world_free(&world);
}

/* --- special cases --- */

static void test_coincident(void)
{
    enum { COUNT = 10000 };
    struct soup soup = {0};
    struct triangle t = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5}}};
    for (int i = 0; i < COUNT; i++)
        soup_add(&soup, t);
    struct world world = world_make(scene_of_soup(&soup));
    surround(&world);
    struct vec3 through = triangle_centroid(&t), up = world.scene->planes[0].normal;
    through = scene_from_input(world.scene, through);
    struct vec3 from = vec3_add(through, vec3_scale(up, 0.1));
    struct vec3 to = beyond(from, through);
    struct octree_counts counts = {0};
    struct octree_hit hit = {0};
    const int32_t own[2] = {5, 6};
    int32_t blocker = octree_blocker(world.octree, from, to, own, -1, &counts);
    bool right =
        blocker >= 0 && blocker != 5 && blocker != 6 &&
        octree_blocker(world.octree, to, beyond(from, to), own, -1, &counts) < 0 &&
        octree_first_hit(world.octree, from, vec3_sub(to, from), false, &hit, &counts) &&
        hit.triangle == COUNT - 1;
    tap_ok(right, "ten thousand coincident triangles: they block, the last is met first");
    world_free(&world);
}

/* A floor of tiles under, or over, one triangle in their plane that covers them all and
 * is sorted away from most of them: of all that a slanting ray meets the last counts. */
static void test_overlay(bool large_first)
{
    struct soup soup = {0};
    struct triangle large = {{{-2, -2, 0}, {4, -2, 0}, {-2, 4, 0}}};
    if (large_first)
        soup_add(&soup, large);
    struct vec3 corner = {-1, -1, 0}, u = {2, 0, 0}, v = {0, 2, 0};
    soup_add_quad(&soup, corner, u, v, 9);
    if (!large_first)
        soup_add(&soup, large);
    struct world world = world_make(scene_of_soup(&soup));
    surround(&world);
    const struct scene *scene = world.scene;
    struct random random = random_seed(8);
    struct octree_counts counts = {0};
    bool right = true;
    for (int i = 0; i < 1000; i++) {
        int32_t tile = 1 + random_below(&random, scene->input_count - 2);
        struct vec3 through = random_point_on(&random, &scene->triangles[tile]);
        struct vec3 from = vec3_add(through, random_point(&random, 0.2));
        from.z = through.z + 0.1;
        struct vec3 to = beyond(from, through);
        struct segment ray = segment_make(from, to);
        int32_t last = -1;
        for (int32_t t = 0; t < scene->input_count; t++)
            last = hit_distance(scene, t, &ray, false) >= 0.0 ? t : last;
        struct octree_hit hit = {-1, false, {0, 0, 0}};
        octree_first_hit(world.octree, from, vec3_sub(to, from), false, &hit, &counts);
        right = right && last >= 0 && hit.triangle == last;
    }
    tap_ok(right, "%s",
           large_first ? "tiles that come after the floor are met instead of it"
                       : "a cover that comes after the tiles is met instead of them");
    world_free(&world);
}

/* A floor, a decal in its plane that comes after it, and a lid above both. With the decal
 * turned over, a front is met before a back, whichever comes later. */
static void test_layers(void)
{
    static const struct {
        const char *name;
        struct vec3 origin, direction;
        bool turned, fronts_only;
        int32_t triangle; /* that is met, or -1 */
        bool front;       /* it is met on */
    } RAYS_OF[] = {
        {"of two in one plane the later is met", {0.01, 0.02, 0.1}, {0, 0, -0.1}, false,
         false, 1, true},
        {"but a front before a back", {0.01, 0.02, 0.1}, {0, 0, -0.1}, true, false, 0,
         true},
        {"from the other side the other one", {0.01, 0.02, -0.1}, {0, 0, 0.3}, true,
         false, 1, true},
        {"the lid above faces down", {0.01, 0.02, 0.1}, {0, 0, 0.3}, true, true, 2, true},
        {"from above it is met", {0.01, 0.02, 4}, {0, 0, -0.1}, true, false, 2, false},
        {"or looked through", {0.01, 0.02, 4}, {0, 0, -0.1}, true, true, 0, true},
        {"nothing lies behind", {0.01, 0.02, 4}, {0, 0, 0.3}, true, false, -1, false}};
    struct triangle triangles[3] = {
        {{{-0.4, -0.4, 0}, {0.4, -0.4, 0}, {0, 0.4, 0}}},
        {{{-0.1, -0.1, 0}, {0.1, -0.1, 0}, {0, 0.1, 0}}},
        {{{-0.4, -0.4, 0.2}, {0, 0.4, 0.2}, {0.4, -0.4, 0.2}}}};
    const struct triangle decal = triangles[1];
    for (size_t i = 0; i < sizeof RAYS_OF / sizeof RAYS_OF[0]; i++) {
        struct plane planes[3];
        triangles[1] = RAYS_OF[i].turned ? reversed(decal) : decal;
        for (int k = 0; k < 3; k++)
            planes[k] = triangle_plane(&triangles[k]);
        struct octree *octree = octree_create(triangles, planes, 3);
        struct octree_counts counts = {0};
        struct octree_hit hit = {.triangle = -1};
        bool met = octree_first_hit(octree, RAYS_OF[i].origin, RAYS_OF[i].direction,
                                    RAYS_OF[i].fronts_only, &hit, &counts);
        tap_ok((met ? hit.triangle : -1) == RAYS_OF[i].triangle &&
                   (!met || hit.front == RAYS_OF[i].front),
               "%s", RAYS_OF[i].name);
        octree_destroy(octree);
    }
}

int main(void)
{
    test_layers();
    test_coincident();
    test_overlay(true);
    test_overlay(false);
    test_terrace();
    test_floor();
    test_scene(make_soup, false, "soup");
    test_scene(make_room, true, "furnished room, packed");
    test_scene(make_sphere, false, "sphere with needles");
    return tap_done();
}
