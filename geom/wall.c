/* Walls.
 *
 * Why the corners are enough. Let a plane have the points x of one set on one side and the points y of
 * another on the other side. x and y are weighted averages of corners e_i and f_j, and the point where
 * xy crosses the plane is a weighted average of the points where the segments between corners do
 * (their weights are l_i m_j (d_i + d'_j), with l, m those of the corners and d, d' the distances
 * to the plane, normalised). If all of these lie in a convex polygon of that plane, so does it.
 *
 * A segment uv crosses within the polygon if it passes each edge ab on the inner side, by the sign of
 * the volume of the tetrahedron a b u v: no division, and exactly 0 where u is a corner of the
 * edge, as in two faces of a box.
 *
 * Large walls prove most, and modellers cut them into small triangles: so all triangles in a plane
 * that share whole edges, corner by corner with the same coordinates, are put together. If the outline
 * of such a region is one loop without a turn to the right, and its area is that of its triangles, the
 * polygon is covered by them without a gap. Convex parts of other regions are not looked for: in
 * rooms it is one region in fifty. */
#include "geom/wall.h"

#include <stdlib.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/stop.h"

/* Triangles are in one plane if none has a corner further off the other's than this. */
static const double COPLANAR = 4.0 * GEOM_ROUNDING;

/* --- triangles that share edges --- */

struct vertex {
    struct vec3 x;
    int32_t corner; /* 3 t + k: corner k of triangle t */
};

static int compare_places(const struct vec3 *a, const struct vec3 *b)
{
    if (a->x != b->x)
        return a->x < b->x ? -1 : 1;
    if (a->y != b->y)
        return a->y < b->y ? -1 : 1;
    return a->z != b->z ? (a->z < b->z ? -1 : 1) : 0;
}

static int compare_vertices(const void *a, const void *b)
{
    const struct vertex *v = a, *w = b;
    int order = compare_places(&v->x, &w->x);
    return order ? order : v->corner < w->corner ? -1 : 1;
}

/* [3 count] numbers of the corners: equal where the coordinates are. */
static int32_t *number_corners(const struct triangle *triangles, int32_t count)
{
    size_t corners = 3 * (size_t)count;
    struct vertex *vertices = alloc_array(corners, sizeof *vertices);
    int32_t *number = alloc_array(corners, sizeof *number), last = -1;
    for (size_t i = 0; i < corners; i++)
        vertices[i] = (struct vertex){triangles[i / 3].corner[i % 3], (int32_t)i};
    qsort(vertices, corners, sizeof *vertices, compare_vertices);
    for (size_t i = 0; i < corners; i++) {
        last += i == 0 || compare_places(&vertices[i].x, &vertices[i - 1].x) != 0;
        number[vertices[i].corner] = last;
    }
    alloc_free(vertices);
    return number;
}

struct edge {
    int32_t low, high; /* numbers of its ends, low < high */
    int32_t triangle;
};

static int compare_edges(const void *a, const void *b)
{
    const struct edge *e = a, *f = b;
    if (e->low != f->low)
        return e->low < f->low ? -1 : 1;
    if (e->high != f->high)
        return e->high < f->high ? -1 : 1;
    return e->triangle < f->triangle ? -1 : e->triangle > f->triangle;
}

/* Sets of triangles: `up` leads to a member, by which the set is known. */
static int32_t set_of(int32_t *up, int32_t t)
{
    while (up[t] != t) {
        up[t] = up[up[t]];
        t = up[t];
    }
    return t;
}

static bool are_coplanar(const struct plane *plane, const struct triangle *t)
{
    for (int k = 0; k < 3; k++)
        if (!(fabs(plane_distance(plane, t->corner[k])) <= COPLANAR))
            return false;
    return true;
}

struct mesh {
    const struct triangle *triangles;
    const struct plane *planes;
    int32_t count;
    int32_t *number; /* [3 count] of the corners */
};

static bool has_area(const struct mesh *mesh, int32_t t)
{
    return vec3_dot(mesh->planes[t].normal, mesh->planes[t].normal) > 0.0;
}

/* [count] the region of each triangle, by one of its triangles. */
static int32_t *find_regions(const struct mesh *mesh)
{
    int32_t *up = alloc_array((size_t)mesh->count, sizeof *up);
    struct edge *edges = alloc_array(3 * (size_t)mesh->count, sizeof *edges);
    int64_t edge_count = 0;
    for (int32_t t = 0; t < mesh->count; t++) {
        up[t] = t;
        for (int k = 0; k < 3 && has_area(mesh, t); k++) {
            int32_t a = mesh->number[3 * t + k], b = mesh->number[3 * t + (k + 1) % 3];
            edges[edge_count++] = (struct edge){a < b ? a : b, a < b ? b : a, t};
        }
    }
    qsort(edges, (size_t)edge_count, sizeof *edges, compare_edges);
    for (int64_t i = 0; i < edge_count; i++)
        for (int64_t j = i + 1; j < edge_count && edges[j].low == edges[i].low &&
                                edges[j].high == edges[i].high; j++) {
            int32_t s = edges[i].triangle, t = edges[j].triangle;
            if (are_coplanar(&mesh->planes[s], &mesh->triangles[t]) &&
                are_coplanar(&mesh->planes[t], &mesh->triangles[s]))
                up[set_of(up, s)] = set_of(up, t);
        }
    alloc_free(edges);
    for (int32_t t = 0; t < mesh->count; t++)
        up[t] = set_of(up, t);
    return up;
}

/* --- outlines --- */

/* An edge of a region as it runs around its triangle, seen from the region's front. */
struct side {
    int32_t from, to; /* numbers */
    struct vec3 start;
};

static int compare_sides(const void *a, const void *b)
{
    const struct side *s = a, *t = b;
    if (s->from != t->from)
        return s->from < t->from ? -1 : 1;
    return s->to < t->to ? -1 : s->to > t->to;
}

/* The first of the sides that start at `from`, or NULL. */
static struct side *side_from(struct side *sides, int64_t count, int32_t from)
{
    int64_t low = 0, high = count;
    while (low < high) {
        int64_t middle = (low + high) / 2;
        if (sides[middle].from < from)
            low = middle + 1;
        else
            high = middle;
    }
    return low < count && sides[low].from == from ? &sides[low] : NULL;
}

/* The sides of the triangles of a region, sorted. */
static struct side *list_sides(const struct mesh *mesh, const int32_t *members, int32_t count)
{
    struct side *sides = alloc_array(3 * (size_t)count, sizeof *sides);
    const struct plane *front = &mesh->planes[members[0]];
    for (int32_t i = 0; i < 3 * count; i++) {
        int32_t t = members[i / 3], a = 3 * t + i % 3, b = 3 * t + (i + 1) % 3;
        bool turned = vec3_dot(mesh->planes[t].normal, front->normal) < 0.0;
        int32_t from = turned ? b : a, to = turned ? a : b;
        sides[i] = (struct side){mesh->number[from], mesh->number[to],
                                 mesh->triangles[t].corner[from % 3]};
    }
    qsort(sides, 3 * (size_t)count, sizeof *sides, compare_sides);
    return sides;
}

/* Keeps the sides that no triangle of the region has the other way round. Returns their number. */
static int64_t keep_outline(struct side *sides, int64_t count)
{
    struct side *kept = alloc_array((size_t)count, sizeof *kept);
    int64_t outer = 0;
    for (int64_t i = 0; i < count; i++) {
        struct side reverse = {.from = sides[i].to, .to = sides[i].from};
        if (!bsearch(&reverse, sides, (size_t)count, sizeof *sides, compare_sides))
            kept[outer++] = sides[i];
    }
    memcpy(sides, kept, (size_t)outer * sizeof *sides);
    alloc_free(kept);
    return outer;
}

/* Positive for a turn to the left at b. */
static double turn(struct vec3 a, struct vec3 b, struct vec3 c, struct vec3 normal)
{
    return vec3_dot(vec3_cross(vec3_sub(b, a), vec3_sub(c, b)), normal);
}

/* Walks around the outline and writes the corners where it turns. Returns how many there are, or 0 if
 * it is not one loop, turns to the right, or has too many. */
static int trace_outline(struct side *sides, int64_t count, struct vec3 normal,
                         struct vec3 corners[WALL_CORNERS_MAX])
{
    struct vec3 *loop = alloc_array((size_t)count, sizeof *loop);
    int64_t length = 0;
    int corner_count = 0;
    struct side *side = &sides[0];
    do {
        loop[length++] = side->start;
        side = side_from(sides, count, side->to);
    } while (side && side != &sides[0] && length < count);
    bool closed = side == &sides[0] && length == count;
    for (int64_t i = 0; i < length && closed; i++) {
        double left = turn(loop[(i + length - 1) % length], loop[i], loop[(i + 1) % length],
                           normal);
        if (fabs(left) <= GEOM_ROUNDING)
            continue;
        closed = left > 0.0 && corner_count < WALL_CORNERS_MAX;
        if (closed)
            corners[corner_count++] = loop[i];
    }
    alloc_free(loop);
    return closed && corner_count >= 3 ? corner_count : 0;
}

static double polygon_area(const struct vec3 *corners, int count)
{
    struct vec3 sum = {0.0, 0.0, 0.0};
    for (int k = 1; k + 1 < count; k++)
        sum = vec3_add(sum, vec3_cross(vec3_sub(corners[k], corners[0]),
                                       vec3_sub(corners[k + 1], corners[0])));
    return 0.5 * vec3_length(sum);
}

/* --- walls --- */

static int32_t add_wall(struct walls *walls, struct plane plane, const struct vec3 *corners, int count)
{
    walls->items[walls->count] = (struct wall){plane, polygon_area(corners, count),
                                               walls->corner_count, count};
    memcpy(walls->corners + walls->corner_count, corners, (size_t)count * sizeof *corners);
    walls->corner_count += count;
    return walls->count++;
}

/* One wall of all members, if they make a convex polygon. */
static bool add_region(struct walls *walls, const struct mesh *mesh, const int32_t *members,
                       int32_t count)
{
    struct vec3 corners[WALL_CORNERS_MAX];
    struct plane plane = mesh->planes[members[0]];
    struct side *sides = list_sides(mesh, members, count);
    double area = 0.0;
    for (int32_t i = 0; i < count; i++)
        area += triangle_area(&mesh->triangles[members[i]]);
    int64_t outer = keep_outline(sides, 3 * (int64_t)count);
    int corner_count = outer > 0 ? trace_outline(sides, outer, plane.normal, corners) : 0;
    alloc_free(sides);
    if (corner_count == 0 || fabs(polygon_area(corners, corner_count) - area) > 1e-9 * area)
        return false;
    int32_t wall = add_wall(walls, plane, corners, corner_count);
    for (int32_t i = 0; i < count; i++)
        walls->of_triangle[members[i]] = wall;
    return true;
}

/* Triangles in the order of their regions. */
struct member {
    int32_t region, triangle;
};

static int compare_members(const void *a, const void *b)
{
    const struct member *m = a, *n = b;
    if (m->region != n->region)
        return m->region < n->region ? -1 : 1;
    return m->triangle < n->triangle ? -1 : m->triangle > n->triangle;
}

static void add_walls(struct walls *walls, const struct mesh *mesh, const int32_t *region)
{
    struct member *sorted = alloc_array((size_t)mesh->count, sizeof *sorted);
    int32_t *members = alloc_array((size_t)mesh->count, sizeof *members), end;
    for (int32_t t = 0; t < mesh->count; t++)
        sorted[t] = (struct member){region[t], t};
    qsort(sorted, (size_t)mesh->count, sizeof *sorted, compare_members);
    for (int32_t i = 0; i < mesh->count && !stop_is_asked(); i = end) {
        for (end = i; end < mesh->count && sorted[end].region == sorted[i].region; end++)
            members[end - i] = sorted[end].triangle;
        bool whole = end - i > 1 && add_region(walls, mesh, members, end - i);
        for (int32_t k = 0; k < end - i && !whole; k++) {
            int32_t t = members[k];
            walls->of_triangle[t] = has_area(mesh, t) ? add_wall(walls, mesh->planes[t],
                                                                 mesh->triangles[t].corner, 3)
                                                      : -1;
        }
    }
    alloc_free(members);
    alloc_free(sorted);
}

struct walls *walls_create(const struct triangle *triangles, const struct plane *planes,
                           int32_t count)
{
    struct walls *walls = alloc_array(1, sizeof *walls);
    struct mesh mesh = {triangles, planes, count, number_corners(triangles, count)};
    if (stop_is_asked())
        mesh.count = 0;
    walls->triangle_count = count;
    walls->items = alloc_array((size_t)count, sizeof *walls->items);
    walls->corners = alloc_array(3 * (size_t)count, sizeof *walls->corners);
    walls->of_triangle = alloc_array((size_t)count, sizeof *walls->of_triangle);
    int32_t *region = find_regions(&mesh);
    add_walls(walls, &mesh, region);
    alloc_free(region);
    alloc_free(mesh.number);
    return walls;
}

int64_t walls_bytes(const struct walls *walls)
{
    return walls->triangle_count * (int64_t)(sizeof *walls->items + 3 * sizeof *walls->corners +
                                             sizeof *walls->of_triangle);
}

static void pack_arrays(struct walls *walls, struct pack *pack)
{
    walls->items = pack_array(pack, walls->items, (size_t)walls->count * sizeof *walls->items);
    walls->corners = pack_array(pack, walls->corners,
                                (size_t)walls->corner_count * sizeof *walls->corners);
    walls->of_triangle = pack_array(pack, walls->of_triangle,
                                    (size_t)walls->triangle_count * sizeof *walls->of_triangle);
}

void walls_pack(const struct walls *walls, struct pack *pack)
{
    struct walls view = *walls;
    view.is_view = true;
    pack_array(pack, &view, sizeof view);
    pack_arrays(&view, pack);
}

struct walls *walls_view(struct pack *pack)
{
    struct walls *walls = alloc_array(1, sizeof *walls);
    memcpy(walls, pack_array(pack, NULL, sizeof *walls), sizeof *walls);
    pack_arrays(walls, pack);
    return walls;
}

void walls_destroy(struct walls *walls)
{
    if (walls && !walls->is_view) {
        alloc_free(walls->items);
        alloc_free(walls->corners);
        alloc_free(walls->of_triangle);
    }
    alloc_free(walls);
}

/* --- what a wall hides --- */

struct range {
    double low, high;
};

static struct range distances(const struct plane *plane, const struct triangle *t)
{
    double a = plane_distance(plane, t->corner[0]);
    double b = plane_distance(plane, t->corner[1]);
    double c = plane_distance(plane, t->corner[2]);
    return (struct range){real_min(a, real_min(b, c)), real_max(a, real_max(b, c))};
}

/* The plane through the edge ab and the point u in front of the wall, its front outwards. */
static struct plane plane_of_edge(struct vec3 a, struct vec3 b, struct vec3 u)
{
    struct vec3 normal = vec3_cross(vec3_sub(b, a), vec3_sub(u, a));
    return (struct plane){normal, vec3_dot(normal, a)};
}

bool shadow_make(struct shadow *shadow, const struct walls *walls, int32_t wall,
                 const struct triangle *p)
{
    const struct wall *w = &walls->items[wall];
    const struct vec3 *corners = walls->corners + w->first;
    struct range range = distances(&w->plane, p);
    bool in_front = range.high > GEOM_ROUNDING && range.low >= -GEOM_ROUNDING;
    bool behind = range.low < -GEOM_ROUNDING && range.high <= GEOM_ROUNDING;
    if (in_front == behind)
        return false;
    double sign = in_front ? 1.0 : -1.0;
    shadow->wall = wall;
    shadow->planes[0] = (struct plane){vec3_scale(w->plane.normal, sign), sign * w->plane.offset};
    shadow->count = 1;
    for (int k = 0; k < w->count; k++) {
        struct vec3 from = corners[k], to = corners[(k + 1) % w->count];
        for (int i = 0; i < 3; i++)
            shadow->planes[shadow->count++] = in_front ? plane_of_edge(from, to, p->corner[i])
                                                       : plane_of_edge(to, from, p->corner[i]);
    }
    return true;
}

/* The largest distance of a point of the box in front of the plane. */
static double reach_of_box(const struct plane *plane, struct vec3 low, struct vec3 high)
{
    struct vec3 n = plane->normal;
    return n.x * (n.x > 0.0 ? high.x : low.x) + n.y * (n.y > 0.0 ? high.y : low.y) +
           n.z * (n.z > 0.0 ? high.z : low.z) - plane->offset;
}

bool shadow_holds_box(const struct shadow *shadow, struct vec3 low, struct vec3 high)
{
    if (!(reach_of_box(&shadow->planes[0], low, high) < -GEOM_ROUNDING))
        return false;
    for (int k = 1; k < shadow->count; k++)
        if (!(reach_of_box(&shadow->planes[k], low, high) <= 0.0))
            return false;
    return true;
}

bool shadow_holds_triangle(const struct shadow *shadow, const struct triangle *q)
{
    struct range range = distances(&shadow->planes[0], q);
    if (!(range.low < -GEOM_ROUNDING && range.high <= GEOM_ROUNDING))
        return false;
    for (int k = 1; k < shadow->count; k++)
        for (int i = 0; i < 3; i++)
            if (!(plane_distance(&shadow->planes[k], q->corner[i]) <= 0.0))
                return false;
    return true;
}
