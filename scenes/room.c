/* A generator of closed office rooms with as many triangles as one asks for.
 *
 *     room 6350 1 > room.obj        room --materials > room.mtl
 *
 * A room is a grid of cells, each a work place: desk, chair, monitor and small things,
 * with bookcases at the side. There are about (N/1500)^(5/8) of them, so a place grows
 * too, from some 800 triangles to some 18 000.
 *
 * How N is met. The shell comes first, then the places in turn, each with an equal share
 * of what is still to be made. A place tries furniture of ever more detail (rounder
 * things, more things) and keeps the richest that takes at most two thirds of its share.
 * The rest is books, 12 triangles each, or more with a round spine; a bookcase shares
 * among its boards as the room among its places. Every surplus or lack is handed on, so
 * the room ends within a book of N.
 *
 * Three solids make all there is: a box; a relief, which is a slab with a grid of fields
 * sunk (shelves, screens, panes, lights in the ceiling) or raised (drawers, keys); and a
 * turned body, whose outline follows a profile (cups, castors, cushions, leaves). Each is
 * a closed surface that shares no vertex with another and stands GAP off whatever carries
 * it, as on felt pads: no two faces lie in one plane, so no ray starts inside the face of
 * another thing.
 *
 * Coordinates are metres with z up and the floor's corner as origin. They are kept as
 * integers, 1/100 mm, and sine and cosine are our own: nothing but + - * / sqrt floor, so
 * a seed gives the same file everywhere (with contraction off). */
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GAP 0.001 /* m; between a thing and what carries it */

enum { UNITS_PER_METRE = 100000, TRIANGLES_MIN = 1000, TRIANGLES_MAX = 1000000 };

/* --- materials --- */

enum material {
    WALL, FLOOR, CEILING, LIGHT, SKY, DOOR, WHITE, LAMINATE, WOOD, METAL, BLACK, SCREEN,
    PAPER, CLAY, SOIL, LEAF,
    FABRIC, /* the first of FABRICS */
    COVER = FABRIC + 3, /* the first of COVERS */
    MATERIALS = COVER + 8,
    FABRICS = COVER - FABRIC,
    COVERS = MATERIALS - COVER
};

static const struct {
    const char *name;
    double reflectance[3]; /* 1 */
    double emission[3];    /* W/m^2 */
} materials[MATERIALS] = {
    {"wall", {0.78, 0.76, 0.70}, {0, 0, 0}},
    {"floor", {0.30, 0.31, 0.34}, {0, 0, 0}},
    {"ceiling", {0.83, 0.83, 0.82}, {0, 0, 0}},
    {"light", {0.80, 0.80, 0.80}, {40, 38, 34}},
    {"sky", {0.10, 0.10, 0.10}, {1.7, 2.0, 2.4}},
    {"door", {0.52, 0.33, 0.19}, {0, 0, 0}},
    {"white", {0.85, 0.85, 0.85}, {0, 0, 0}},
    {"laminate", {0.68, 0.63, 0.55}, {0, 0, 0}},
    {"wood", {0.56, 0.40, 0.24}, {0, 0, 0}},
    {"metal", {0.50, 0.51, 0.53}, {0, 0, 0}},
    {"black", {0.10, 0.10, 0.10}, {0, 0, 0}},
    {"screen", {0.10, 0.10, 0.10}, {0.4, 0.5, 0.7}},
    {"paper", {0.80, 0.79, 0.75}, {0, 0, 0}},
    {"clay", {0.62, 0.33, 0.22}, {0, 0, 0}},
    {"soil", {0.12, 0.10, 0.10}, {0, 0, 0}},
    {"leaf", {0.16, 0.38, 0.12}, {0, 0, 0}},
    {"fabric_blue", {0.14, 0.22, 0.45}, {0, 0, 0}},
    {"fabric_red", {0.48, 0.14, 0.12}, {0, 0, 0}},
    {"fabric_green", {0.15, 0.35, 0.28}, {0, 0, 0}},
    {"cover_red", {0.55, 0.12, 0.10}, {0, 0, 0}},
    {"cover_blue", {0.12, 0.20, 0.50}, {0, 0, 0}},
    {"cover_green", {0.14, 0.38, 0.18}, {0, 0, 0}},
    {"cover_yellow", {0.72, 0.60, 0.18}, {0, 0, 0}},
    {"cover_brown", {0.36, 0.23, 0.14}, {0, 0, 0}},
    {"cover_grey", {0.45, 0.45, 0.47}, {0, 0, 0}},
    {"cover_white", {0.78, 0.76, 0.72}, {0, 0, 0}},
    {"cover_violet", {0.34, 0.16, 0.38}, {0, 0, 0}},
};

static void print_materials(void)
{
    puts("# Materials of the rooms that `room N SEED` makes, from `room --materials`.\n"
         "# Ke is radiosity, W/m^2.");
    for (int i = 0; i < MATERIALS; i++) {
        const double *kd = materials[i].reflectance, *ke = materials[i].emission;
        printf("\nnewmtl %s\nKd %.2f %.2f %.2f\n", materials[i].name, kd[0], kd[1],
               kd[2]);
        if (ke[0] > 0.0)
            printf("Ke %.1f %.1f %.1f\n", ke[0], ke[1], ke[2]);
    }
}

/* --- random numbers: splitmix64 --- */

struct random {
    uint64_t state;
};

static uint64_t random_bits(struct random *random)
{
    uint64_t x = random->state += UINT64_C(0x9e3779b97f4a7c15);
    x = (x ^ x >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ x >> 27) * UINT64_C(0x94d049bb133111eb);
    return x ^ x >> 31;
}

static double random_between(struct random *random, double low, double high)
{
    return low +
           (high - low) * ((double)(random_bits(random) >> 11) / 9007199254740992.0);
}

/* In 0 .. count - 1. */
static int random_below(struct random *random, int count)
{
    return (int)(random_bits(random) % (uint64_t)count);
}

static enum material random_cover(struct random *random)
{
    return COVER + (enum material)random_below(random, COVERS);
}

/* --- frames: where a thing is and how it is turned --- */

struct vec {
    double x, y, z;
};

struct frame {
    struct vec origin, x, y, z; /* axes: unit vectors, right-handed */
};

static const struct frame WORLD = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

static struct vec along(struct vec p, double x, struct vec axis)
{
    return (struct vec){p.x + x * axis.x, p.y + x * axis.y, p.z + x * axis.z};
}

static struct vec frame_point(struct frame frame, double x, double y, double z)
{
    return along(along(along(frame.origin, x, frame.x), y, frame.y), z, frame.z);
}

/* The point of the unit circle after `turn` turns from the x axis, by Taylor series. */
static void circle_point(double turn, double *x, double *y)
{
    double angle = 6.283185307179586 * (turn - floor(turn + 0.5));
    double term = 1.0, sum[2] = {0.0, 0.0};
    for (int i = 0; i < 28; i++) {
        sum[i % 2] += i % 4 < 2 ? term : -term;
        term *= angle / (i + 1);
    }
    *x = sum[0];
    *y = sum[1];
}

/* At (x, y, z) of the frame, turned about its z axis. */
static struct frame frame_at(struct frame frame, double x, double y, double z,
                             double turn)
{
    const struct vec none = {0, 0, 0};
    double c, s;
    circle_point(turn, &c, &s);
    return (struct frame){frame_point(frame, x, y, z),
                          along(along(none, c, frame.x), s, frame.y),
                          along(along(none, -s, frame.x), c, frame.y), frame.z};
}

/* There, with the plane of x and y stood up: x stays, y is up, z comes out to the
 * front. */
static struct frame frame_upright(struct frame frame, double x, double y, double z)
{
    const struct vec none = {0, 0, 0};
    return (struct frame){frame_point(frame, x, y, z), frame.x, frame.z,
                          along(none, -1.0, frame.y)};
}

/* --- the mesh --- */

struct face {
    int32_t corner[3]; /* vertex numbers from 0, counter-clockwise from outside */
    enum material material;
};

struct mesh {
    int32_t (*vertices)[3]; /* 1 / UNITS_PER_METRE of a metre */
    struct face *faces;
    int32_t vertex_count, vertex_capacity;
    int32_t face_count, face_capacity;
};

static void fail(const char *what)
{
    fprintf(stderr, "room: %s\n", what);
    exit(1);
}

/* The array, with room for at least one more. */
static void *grown(void *array, int32_t count, int32_t *capacity, size_t size)
{
    if (count < *capacity)
        return array;
    *capacity = *capacity ? 2 * *capacity : 1024;
    array = realloc(array, (size_t)*capacity * size);
    if (!array)
        fail("out of memory");
    return array;
}

static int32_t snapped(double x)
{
    return (int32_t)floor(x * UNITS_PER_METRE + 0.5);
}

static int32_t add_vertex(struct mesh *mesh, struct vec p)
{
    mesh->vertices = grown(mesh->vertices, mesh->vertex_count, &mesh->vertex_capacity,
                           sizeof *mesh->vertices);
    int32_t *vertex = mesh->vertices[mesh->vertex_count];
    vertex[0] = snapped(p.x);
    vertex[1] = snapped(p.y);
    vertex[2] = snapped(p.z);
    return mesh->vertex_count++;
}

static void add_triangle(struct mesh *mesh, int32_t a, int32_t b, int32_t c,
                         enum material material)
{
    mesh->faces = grown(mesh->faces, mesh->face_count, &mesh->face_capacity,
                        sizeof *mesh->faces);
    mesh->faces[mesh->face_count++] = (struct face){{a, b, c}, material};
}

static void add_quad(struct mesh *mesh, int32_t a, int32_t b, int32_t c, int32_t d,
                     enum material material)
{
    add_triangle(mesh, a, b, c, material);
    add_triangle(mesh, a, c, d, material);
}

/* --- solid 1: the box --- */

static void box(struct mesh *mesh, struct frame frame, struct vec low, struct vec high,
                enum material material)
{
    static const int sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    int32_t v[8];
    for (int i = 0; i < 8; i++)
        v[i] = add_vertex(mesh,
                          frame_point(frame, i & 1 ? high.x : low.x,
                                      i & 2 ? high.y : low.y, i & 4 ? high.z : low.z));
    for (int i = 0; i < 6; i++) {
        const int *s = sides[i];
        add_quad(mesh, v[s[0]], v[s[1]], v[s[2]], v[s[3]], material);
    }
}

/* --- solid 2: the relief ---
 *
 *     y  +--+------+--+------+--+      Cuts in x and y make a grid of cells. Those that
 *     ^  |  |      |  |      |  |      are odd in both directions are the fields, at z =
 *     |  +--+------+--+------+--+      level; the others are at z = 0. Fields never
 *     |  |  |field |  |field |  |      touch, so each has four corners and four walls of
 *     |  +--+------+--+------+--+      its own. The back is at z = -thickness, two
 *     |  |  |      |  |      |  |      triangles, and the sides are fans between it and
 *     |  +--+------+--+------+--+      the cuts of the front.
 *     +-----------> x */

enum { CUT_MAX = 64 };

struct cuts {
    int cells;
    double at[CUT_MAX + 1]; /* m, ascending */
};

/* As many fields of one size as fit a length with bars of one width around them. */
static struct cuts cuts_even(int fields, double length, double bar)
{
    struct cuts cuts = {2 * fields + 1, {0.0}};
    double field = (length - (fields + 1) * bar) / fields;
    for (int i = 0; i <= cuts.cells; i++)
        cuts.at[i] = i / 2 * (bar + field) + (i % 2 ? bar : 0.0);
    return cuts;
}

struct relief {
    struct cuts x, y;
    double thickness, level; /* m */
    enum material base, field;
};

static void relief_field(struct mesh *mesh, struct frame frame,
                         const struct relief *relief, int i, int j, const int32_t q[4])
{
    const double *x = relief->x.at + i, *y = relief->y.at + j;
    enum material wall = relief->level < 0.0 ? relief->base : relief->field;
    int32_t r[4];
    for (int k = 0; k < 4; k++)
        r[k] = add_vertex(mesh, frame_point(frame, x[k == 1 || k == 2], y[k / 2],
                                            relief->level));
    add_quad(mesh, r[0], r[1], r[2], r[3], relief->field);
    for (int k = 0; k < 4; k++)
        add_quad(mesh, q[k], q[(k + 1) % 4], r[(k + 1) % 4], r[k], wall);
}

/* Returns the first of the vertices at z = 0, which run along x, then y. */
static int32_t relief_front(struct mesh *mesh, struct frame frame,
                            const struct relief *relief)
{
    const struct cuts *x = &relief->x, *y = &relief->y;
    int32_t first = mesh->vertex_count, row = x->cells + 1;
    for (int j = 0; j <= y->cells; j++)
        for (int i = 0; i <= x->cells; i++)
            add_vertex(mesh, frame_point(frame, x->at[i], y->at[j], 0.0));
    for (int j = 0; j < y->cells; j++) {
        for (int i = 0; i < x->cells; i++) {
            int32_t a = first + j * row + i;
            const int32_t q[4] = {a, a + 1, a + 1 + row, a + row};
            if (i % 2 && j % 2)
                relief_field(mesh, frame, relief, i, j, q);
            else
                add_quad(mesh, q[0], q[1], q[2], q[3], relief->base);
        }
    }
    return first;
}

/* The side between corners a and b of the back and count + 1 vertices of the front. */
static void relief_side(struct mesh *mesh, int32_t first, int32_t step, int count,
                        int32_t a, int32_t b, enum material material)
{
    for (int i = 0; i < count; i++) {
        int32_t v = first + i * step;
        add_triangle(mesh, v + step, v, i < count / 2 ? a : b, material);
    }
    add_triangle(mesh, first + count / 2 * step, a, b, material);
}

static void relief(struct mesh *mesh, struct frame frame, const struct relief *relief)
{
    int nx = relief->x.cells, ny = relief->y.cells;
    int32_t first = relief_front(mesh, frame, relief), row = nx + 1, b[4];
    int32_t last = first + row * (ny + 1) - 1;
    for (int k = 0; k < 4; k++)
        b[k] = add_vertex(
            mesh, frame_point(frame, k == 1 || k == 2 ? relief->x.at[nx] : 0.0,
                              k / 2 ? relief->y.at[ny] : 0.0, -relief->thickness));
    relief_side(mesh, first, 1, nx, b[0], b[1], relief->base);
    relief_side(mesh, first + nx, row, ny, b[1], b[2], relief->base);
    relief_side(mesh, last, -1, nx, b[2], b[3], relief->base);
    relief_side(mesh, last - nx, -row, ny, b[3], b[0], relief->base);
    add_quad(mesh, b[0], b[3], b[2], b[1], relief->base);
}

/* --- solid 3: the turned body ---
 *
 * Point j of the outline is core + radius * out, with a radius for each ring of the
 * profile. A circle has no core; a rounded rectangle has the centres of its corners as
 * core. */

enum { OUTLINE_MAX = 64, RING_MAX = 32 };

struct outline {
    int count;
    double core[OUTLINE_MAX][2]; /* m */
    double out[OUTLINE_MAX][2];  /* unit vectors, counter-clockwise */
};

struct ring {
    double radius, height, shift; /* m; shift: of the ring along x */
};

static struct outline outline_circle(int count)
{
    struct outline outline = {count, {{0.0}}, {{0.0}}};
    for (int j = 0; j < count; j++)
        circle_point((double)j / count, &outline.out[j][0], &outline.out[j][1]);
    return outline;
}

/* Around a rectangle of x by y, with so many segments at each corner. */
static struct outline outline_rounded(double x, double y, int segments)
{
    struct outline outline = {4 * (segments + 1), {{0.0}}, {{0.0}}};
    for (int j = 0; j < outline.count; j++) {
        int corner = j / (segments + 1), step = j % (segments + 1);
        outline.core[j][0] = corner == 1 || corner == 2 ? -0.5 * x : 0.5 * x;
        outline.core[j][1] = corner / 2 ? -0.5 * y : 0.5 * y;
        circle_point(0.25 * (corner + (double)step / segments), &outline.out[j][0],
                     &outline.out[j][1]);
    }
    return outline;
}

static void turned(struct mesh *mesh, struct frame frame, const struct outline *outline,
                   const struct ring *rings, int count, enum material material)
{
    int n = outline->count;
    int32_t first = mesh->vertex_count;
    for (int i = 0; i < count; i++)
        for (int j = 0; j < n; j++)
            add_vertex(mesh, frame_point(frame,
                                         outline->core[j][0] + rings[i].shift
                                             + rings[i].radius * outline->out[j][0],
                                         outline->core[j][1]
                                             + rings[i].radius * outline->out[j][1],
                                         rings[i].height));
    int32_t low = add_vertex(mesh,
                             frame_point(frame, rings[0].shift, 0.0, rings[0].height));
    int32_t high = add_vertex(mesh, frame_point(frame, rings[count - 1].shift, 0.0,
                                                rings[count - 1].height));
    for (int j = 0; j < n; j++) {
        int next = (j + 1) % n;
        int32_t top = first + (count - 1) * n;
        add_triangle(mesh, low, first + next, first + j, material);
        for (int32_t v = first; v < top; v += n)
            add_quad(mesh, v + j, v + next, v + n + next, v + n + j, material);
        add_triangle(mesh, high, top + j, top + next, material);
    }
}

/* Rings of a slab with round edges: `bevel` is their radius. Returns how many. */
static int profile_slab(struct ring *rings, double radius, double height, double bevel,
                        int segments)
{
    for (int i = 0; i <= segments; i++) {
        double c, s;
        circle_point(0.25 * i / segments, &c, &s);
        struct ring low = {radius - bevel + bevel * s, bevel - bevel * c, 0.0};
        rings[i] = low;
        rings[2 * segments + 1 - i] = (struct ring){low.radius, height - low.height, 0.0};
    }
    return 2 * segments + 2;
}

/* Centred in x and y, from z = 0: round corners and edges, or a box for no segments. */
static void cushion(struct mesh *mesh, struct frame frame, struct vec size, double corner,
                    double bevel, int segments, enum material material)
{
    if (segments == 0) {
        box(mesh, frame, (struct vec){-0.5 * size.x, -0.5 * size.y, 0.0},
            (struct vec){0.5 * size.x, 0.5 * size.y, size.z}, material);
        return;
    }
    struct ring rings[RING_MAX];
    int count = profile_slab(rings, corner, size.z, bevel, segments);
    struct outline outline = outline_rounded(size.x - 2.0 * corner, size.y - 2.0 * corner,
                                             segments);
    turned(mesh, frame, &outline, rings, count, material);
}

static void disc(struct mesh *mesh, struct frame frame, int around, double radius_low,
                 double radius_high, double height, enum material material)
{
    struct outline outline = outline_circle(around);
    const struct ring rings[2] = {{radius_low, 0.0, 0.0}, {radius_high, height, 0.0}};
    turned(mesh, frame, &outline, rings, 2, material);
}

struct vessel {
    double low, high, belly; /* radii at the ends and what is added half-way, m */
    double height, wall, bottom; /* bottom: its thickness, m */
    enum material material;
};

static double vessel_radius(const struct vessel *v, double height)
{
    double t = height / v->height;
    return v->low + t * (v->high - v->low) + 4.0 * t * (1.0 - t) * v->belly;
}

/* Up the outside and down the inside. */
static void vessel(struct mesh *mesh, struct frame frame, struct vessel v, int around,
                   int steps)
{
    struct ring rings[RING_MAX];
    for (int i = 0; i <= steps; i++) {
        double t = (double)i / steps, outside = t * v.height;
        double inside = v.bottom + t * (v.height - v.bottom);
        rings[i] = (struct ring){vessel_radius(&v, outside), outside, 0.0};
        rings[2 * steps + 1 - i] =
            (struct ring){vessel_radius(&v, inside) - v.wall, inside, 0.0};
    }
    struct outline outline = outline_circle(around);
    turned(mesh, frame, &outline, rings, 2 * steps + 2, v.material);
}

/* --- detail, 0 .. DETAIL_MAX: how it shows in round things --- */

enum { DETAIL_MAX = 24 };

/* Points around a circle. */
static int around(int detail)
{
    return 6 + detail;
}

/* Steps of a vessel from bottom to lip. */
static int steps(int detail)
{
    return 1 + detail / 2;
}

/* Segments of a round corner; none: a box will do. */
static int corners(int detail)
{
    return detail / 2;
}

/* --- furniture; frames are on the floor, the sitter looks along y --- */

static const double DESK_HEIGHT = 0.73, DESK_X = 1.6, DESK_Y = 0.8; /* m */

/* A chest of drawers with its front at y = 0, from x = 0. */
static void drawers(struct mesh *mesh, struct frame frame, struct vec size, int count,
                    enum material material, int detail)
{
    struct frame front = frame_upright(frame, 0.0, 0.0, GAP);
    double pitch = (size.z - 0.01) / count;
    struct relief chest = {cuts_even(1, size.x, 0.01), cuts_even(count, size.z, 0.01),
                           size.y, 0.015, material, material};
    relief(mesh, front, &chest);
    for (int i = 0; i < count && detail > 0; i++) {
        struct frame handle = frame_at(front, 0.5 * size.x, (i + 0.75) * pitch,
                                       0.015 + GAP, 0.0);
        cushion(mesh, handle, (struct vec){0.12, 0.018, 0.014}, 0.007, 0.004,
                corners(detail / 4), METAL);
    }
}

/* The origin is below the middle of the top. */
static void desk(struct mesh *mesh, struct frame frame, struct random *random, int detail)
{
    const double top = 0.03, x = 0.5 * DESK_X - 0.01, y = 0.5 * DESK_Y - 0.03;
    const double under = DESK_HEIGHT - top - GAP, width = 0.43;
    double side = random_below(random, 2) ? 1.0 : -1.0; /* of the drawers */
    double chest = side > 0.0 ? x - width : -x;
    double panel = side > 0.0 ? -x : x - top;
    double left = side > 0.0 ? panel + top + GAP : chest + width + GAP;
    double right = side > 0.0 ? chest - GAP : panel - GAP;
    cushion(mesh, frame_at(frame, 0.0, 0.0, DESK_HEIGHT - top, 0.0),
            (struct vec){DESK_X, DESK_Y, top}, 0.04, 0.01, corners(detail / 3), LAMINATE);
    drawers(mesh, frame_at(frame, chest, -y, 0.0, 0.0),
            (struct vec){width, 2.0 * y, under - GAP}, 3, WOOD, detail);
    box(mesh, frame, (struct vec){panel, -y, GAP}, (struct vec){panel + top, y, under},
        WOOD);
    box(mesh, frame, (struct vec){left, y - 0.04, 0.25},
        (struct vec){right, y - 0.02, under}, WOOD);
}

static void chair_base(struct mesh *mesh, struct frame frame, int detail)
{
    struct outline circle = outline_circle(around(detail));
    double castor = detail >= 3 ? 0.05 : GAP; /* m; the height of the legs */
    const struct ring post[4] = {{0.032, castor, 0.0}, {0.032, 0.2, 0.0},
                                 {0.02, 0.21, 0.0}, {0.02, 0.40 - GAP, 0.0}};
    turned(mesh, frame, &circle, post, 4, METAL);
    for (int i = 0; i < 5; i++) {
        struct frame leg = frame_at(frame, 0.0, 0.0, castor, 0.2 * i);
        box(mesh, leg, (struct vec){0.032 + GAP, -0.018, 0.0},
            (struct vec){0.30, 0.018, 0.03}, BLACK);
        if (detail < 3)
            continue;
        struct ring rings[RING_MAX];
        int count = profile_slab(rings, 0.024, 0.03, 0.006, 1 + detail / 8);
        turned(mesh, frame_upright(leg, 0.27, 0.015, -0.025), &circle, rings, count,
               BLACK);
    }
}

static void chair(struct mesh *mesh, struct frame frame, struct random *random,
                  int detail)
{
    enum material fabric = FABRIC + (enum material)random_below(random, FABRICS);
    chair_base(mesh, frame_at(frame, 0.0, 0.0, 0.0, random_between(random, 0.0, 1.0)),
               detail);
    box(mesh, frame, (struct vec){-0.09, -0.26, 0.40}, (struct vec){0.09, 0.12, 0.42},
        METAL);
    box(mesh, frame, (struct vec){-0.035, -0.28, 0.40},
        (struct vec){0.035, -0.26 - GAP, 0.84}, METAL);
    cushion(mesh, frame_at(frame, 0.0, 0.015, 0.42 + GAP, 0.0),
            (struct vec){0.46, 0.46, 0.07}, 0.09, 0.03, corners(detail), fabric);
    cushion(mesh, frame_upright(frame, 0.0, -0.20, 0.78), (struct vec){0.42, 0.38, 0.06},
            0.09, 0.027, corners(detail), fabric);
}

/* Origin at the middle of the foot. */
static void monitor(struct mesh *mesh, struct frame frame, int detail)
{
    const struct relief panel = {cuts_even(1, 0.56, 0.012), cuts_even(1, 0.34, 0.012),
                                 0.03, -0.004, BLACK, SCREEN};
    cushion(mesh, frame, (struct vec){0.24, 0.17, 0.012}, 0.05, 0.005,
            corners(detail / 2), BLACK);
    box(mesh, frame, (struct vec){-0.03, 0.0, 0.012 + GAP},
        (struct vec){0.03, 0.02, 0.32}, BLACK);
    relief(mesh, frame_upright(frame, -0.28, -0.03 - GAP, 0.10), &panel);
}

/* Origin at the middle. */
static void keyboard(struct mesh *mesh, struct frame frame, int detail)
{
    const double x = 0.44, y = 0.15;
    const struct relief keys = {cuts_even(15, x, 0.005), cuts_even(5, y, 0.005), 0.014,
                                0.006, BLACK, METAL};
    if (detail < 5)
        cushion(mesh, frame, (struct vec){x, y, 0.018}, 0.01, 0.004, corners(detail / 2),
                METAL);
    else
        relief(mesh, frame_at(frame, -0.5 * x, -0.5 * y, 0.014, 0.0), &keys);
}

/* Foot and stem in one, the glowing disc, and the hood above it. */
static void lamp(struct mesh *mesh, struct frame frame, struct random *random, int detail)
{
    const struct ring stem[6] = {{0.085, 0.0, 0.0},  {0.085, 0.012, 0.0},
                                 {0.03, 0.022, 0.0}, {0.008, 0.035, 0.0},
                                 {0.008, 0.30, 0.0}, {0.03, 0.31, 0.0}};
    struct outline circle = outline_circle(around(detail));
    struct ring hood[RING_MAX];
    int count = 2 + steps(detail);
    for (int i = 0; i < count; i++) {
        double t = (double)i / (count - 1);
        hood[i] = (struct ring){0.12 - 0.08 * t * t, 0.10 * t, 0.0};
    }
    turned(mesh, frame, &circle, stem, 6, METAL);
    disc(mesh, frame_at(frame, 0.0, 0.0, 0.31 + GAP, 0.0), around(detail), 0.09, 0.09,
         0.004, LIGHT);
    turned(mesh, frame_at(frame, 0.0, 0.0, 0.315 + GAP, 0.0), &circle, hood, count,
           random_cover(random));
}

static void pencils(struct mesh *mesh, struct frame frame, struct random *random,
                    int detail)
{
    const struct vessel cup = {0.034, 0.036, 0.0, 0.10, 0.003, 0.004, BLACK};
    struct outline hexagon = outline_circle(6);
    int count = 3 + random_below(random, 4);
    vessel(mesh, frame, cup, around(detail), steps(detail));
    for (int i = 0; i < count; i++) {
        struct frame foot = frame_at(frame, 0.0, 0.0, 0.004 + GAP, (double)i / count);
        const struct ring pencil[3] = {{0.0035, 0.0, 0.016}, {0.0035, 0.15, 0.028},
                                       {0.0008, 0.17, 0.029}};
        turned(mesh, foot, &hexagon, pencil, 3, random_cover(random));
    }
}

static void plant(struct mesh *mesh, struct frame frame, struct random *random,
                  int detail)
{
    const struct vessel pot = {0.11, 0.16, 0.01, 0.30, 0.012, 0.26, CLAY};
    int leaves = 7 + random_below(random, 4), rings = 3 + detail / 2;
    struct outline section = outline_circle(4 + detail / 8 * 2);
    for (int j = 0; j < section.count; j++)
        section.out[j][0] *= 0.2;
    vessel(mesh, frame, pot, around(detail), steps(detail));
    disc(mesh, frame_at(frame, 0.0, 0.0, 0.26 + GAP, 0.0), around(detail), 0.13, 0.13,
         0.01, SOIL);
    for (int i = 0; i < leaves; i++) {
        struct frame foot = frame_at(frame, 0.0, 0.0, 0.272, (double)i / leaves);
        double length = random_between(random, 0.4, 0.7);
        double reach = random_between(random, 0.1, 0.2);
        struct ring leaf[RING_MAX];
        for (int k = 0; k <= rings; k++) {
            double t = (double)k / rings;
            leaf[k] = (struct ring){0.012 + 0.06 * t * (1.0 - t) - 0.009 * t, length * t,
                                    0.06 + reach * t * t};
        }
        turned(mesh, foot, &section, leaf, rings + 1, LEAF);
    }
}

/* Books that lie on each other. */
static void pile(struct mesh *mesh, struct frame frame, struct random *random, int count)
{
    double z = 0.0;
    for (int i = 0; i < count; i++) {
        double x = random_between(random, 0.17, 0.23);
        double height = random_between(random, 0.012, 0.04);
        double turn = random_between(random, -0.03, 0.03);
        cushion(mesh, frame_at(frame, 0.0, 0.0, z, turn),
                (struct vec){x, 0.65 * x, height}, 0.0, 0.0, 0, random_cover(random));
        z += height + GAP;
    }
}

/* All that stands on a desk; the frame is that of the desk. */
static void desk_things(struct mesh *mesh, struct frame frame, struct random *random,
                        int detail)
{
    const struct vessel cup = {0.030, 0.040, 0.004, 0.09, 0.004, 0.006,
                               random_cover(random)};
    struct frame top = frame_at(frame, 0.0, 0.0, DESK_HEIGHT + GAP, 0.0);
    double aside = random_between(random, -0.03, 0.03);
    monitor(mesh, frame_at(top, 0.0, 0.21, 0.0, random_between(random, -0.02, 0.02)),
            detail);
    keyboard(mesh, frame_at(top, 0.0, -0.17, 0.0, 0.2 * aside), detail);
    vessel(mesh, frame_at(top, -0.42 + aside, -0.1 - aside, 0.0, 0.0), cup,
           around(detail), steps(detail));
    if (detail >= 1) {
        cushion(mesh, frame_at(top, 0.32, -0.17 + aside, 0.0, aside),
                (struct vec){0.06, 0.10, 0.03}, 0.025, 0.013, corners(detail), BLACK);
        pile(mesh, frame_at(top, 0.56, 0.2 + aside, 0.0, 0.0), random,
             1 + random_below(random, 5));
        cushion(mesh, frame_at(top, 0.57, -0.17, 0.0, aside),
                (struct vec){0.21, 0.297, 0.008}, 0.0, 0.0, 0, PAPER);
    }
    if (detail >= 1)
        lamp(mesh, frame_at(top, -0.6 + aside, 0.22, 0.0, 0.0), random, detail);
    if (detail >= 4)
        pencils(mesh, frame_at(top, -0.38, 0.25 + aside, 0.0, 0.0), random, detail);
}

/* All of a place but the bookcases; the frame is the middle of the cell. */
static void furnish(struct mesh *mesh, struct frame frame, struct random *random,
                    int detail)
{
    const struct vessel bin = {0.11, 0.14, 0.0, 0.32, 0.004, 0.006, BLACK};
    struct frame middle = frame_at(frame, -0.55, 0.7, 0.0, 0.0);
    double x = random_between(random, -0.08, 0.08);
    double y = random_between(random, -0.9, -0.8);
    double turn = random_between(random, -0.1, 0.1);
    desk(mesh, middle, random, detail);
    desk_things(mesh, middle, random, detail);
    chair(mesh, frame_at(middle, x, y, 0.0, turn), random, detail);
    vessel(mesh, frame_at(frame, 0.5, 0.5 + x, GAP, 0.0), bin, around(detail),
           steps(detail));
    if (detail >= 2)
        plant(mesh, frame_at(frame, 0.65, 1.35, GAP, turn), random, detail);
}

/* --- bookcases --- */

/* m */
static const double CASE_X = 0.9, CASE_Y = 0.31, CASE_BAR = 0.02, CASE_PITCH = 0.33;

/* Standing, its back to the front; the origin is the lower left corner of the back. */
static void book(struct mesh *mesh, struct frame frame, struct vec size, int triangles,
                 enum material material)
{
    int segments = triangles < 60 ? (triangles - 12) / 4 : 12;
    if (segments < 2) {
        box(mesh, frame, (struct vec){0.0, 0.0, 0.0}, size, material);
        return;
    }
    struct outline outline = {segments + 3, {{0.0}}, {{0.0}}};
    double half = 0.5 * size.x, y = 0.5 * size.y;
    for (int j = 0; j <= segments; j++) {
        circle_point(0.5 + 0.5 * j / segments, &outline.core[j][0], &outline.core[j][1]);
        outline.core[j][0] *= half;
        outline.core[j][1] = 0.4 * half * (1.0 + outline.core[j][1]) - y;
    }
    outline.core[segments + 1][0] = half;
    outline.core[segments + 2][0] = -half;
    outline.core[segments + 1][1] = outline.core[segments + 2][1] = y;
    const struct ring rings[2] = {{0.0, 0.0, 0.0}, {0.0, size.z, 0.0}};
    turned(mesh, frame_at(frame, half, y, 0.0, 0.0), &outline, rings, 2, material);
}

/* Books on one board, from left to right, until the mesh has `target` triangles or the
 * board is full. The frame is at the left end of the board's front edge, on the board. */
static void fill_board(struct mesh *mesh, struct frame frame, struct random *random,
                       int32_t target)
{
    const double room = CASE_X - 2.0 * CASE_BAR, height = CASE_PITCH - CASE_BAR;
    const double mean = 0.034; /* m; the width of a book */
    double tall = random_between(random, 0.65, 0.9), x = 2.0 * GAP;
    for (;;) {
        struct vec size = {0.0, 0.0, 0.0};
        size.x = random_between(random, 0.018, 0.05);
        size.y = random_between(random, 0.14, 0.2);
        size.z = height * (tall + random_between(random, -0.12, 0.08));
        double set_back = random_between(random, 0.02, 0.06);
        int32_t left = target - mesh->face_count;
        if (left < 6 || x + size.x + GAP > room)
            return;
        double share = left / (1.0 + (room - x) / mean);
        book(mesh, frame_at(frame, x, set_back, GAP, 0.0), size, (int)share,
             random_cover(random));
        x += size.x + GAP;
    }
}

/* The origin is the lower left corner of the front. */
static void bookcase(struct mesh *mesh, struct frame frame, struct random *random,
                     int boards, int32_t target)
{
    double height = boards * CASE_PITCH + CASE_BAR;
    const struct relief corpus = {cuts_even(1, CASE_X, CASE_BAR),
                                  cuts_even(boards, height, CASE_BAR), CASE_Y,
                                  CASE_BAR - CASE_Y, WOOD, WOOD};
    relief(mesh, frame_upright(frame, 0.0, 0.0, GAP), &corpus);
    for (int i = 0; i < boards; i++) {
        int32_t share = (target - mesh->face_count) / (boards - i);
        fill_board(mesh,
                   frame_at(frame, CASE_BAR, 0.0, GAP + CASE_BAR + i * CASE_PITCH, 0.0),
                   random, mesh->face_count + share);
    }
}

/* --- places --- */

static const double PLACE_X = 3.2, PLACE_Y = 3.4; /* m */

/* The most detail for which the furniture keeps within so many triangles. */
static int detail_within(struct mesh *mesh, struct frame frame, struct random random,
                         int32_t limit)
{
    int32_t vertex_count = mesh->vertex_count, face_count = mesh->face_count, cost = 0;
    int detail = 0;
    while (cost <= limit && detail < DETAIL_MAX) {
        struct random again = random;
        furnish(mesh, frame, &again, ++detail);
        cost = mesh->face_count - face_count;
        mesh->vertex_count = vertex_count;
        mesh->face_count = face_count;
    }
    return cost <= limit ? detail : detail - 1;
}

/* A cell is filled until the mesh has `target` triangles; the frame is in its middle. */
static void place(struct mesh *mesh, struct frame frame, struct random *random,
                  int32_t target)
{
    int32_t share = target - mesh->face_count;
    int cases = share < 1600 ? 1 : share < 4500 ? 2 : 3;
    int boards = share < 1200 ? 4 : 5 + random_below(random, 2);
    int detail = detail_within(mesh, frame, *random, (share - 150 * cases) * 2 / 3);
    furnish(mesh, frame, random, detail);
    if (cases == 2)
        drawers(mesh, frame_at(frame, 1.0, -0.4, 0.0, 0.75),
                (struct vec){0.46, 0.55, 1.25}, 4, METAL, detail);
    for (int i = 0; i < cases; i++) {
        int32_t part = (target - mesh->face_count) / (cases - i);
        bookcase(mesh, frame_at(frame, 1.25, 1.65 - i * (CASE_X + 0.03), 0.0, 0.75),
                 random, boards, mesh->face_count + part);
    }
}

/* --- the room --- */

static const double MARGIN_Y = 0.5; /* m; between the places and the walls with doors */

struct plan {
    int columns, rows; /* of places */
    double x, y, z;    /* size, m */
};

static struct plan plan_make(int32_t triangles, struct random *random)
{
    double scale = triangles / 1500.0;
    double places = sqrt(sqrt(sqrt(scale * scale * scale * scale * scale)));
    double shape = random_between(random, 0.8, 1.6);
    struct plan plan = {(int)(sqrt(places * shape) + 0.5), 0, 0.0, 0.0, 0.0};
    plan.columns += plan.columns == 0;
    plan.rows = (int)(places / plan.columns + 0.5);
    plan.rows += plan.rows == 0;
    plan.x = PLACE_X * plan.columns;
    plan.y = PLACE_Y * plan.rows + 2.0 * MARGIN_Y;
    plan.z = random_between(random, 2.7, 3.1);
    return plan;
}

/* Cuts of the ceiling: a field of this size over the middle of each place. */
static struct cuts cuts_lights(int places, double pitch, double margin, double size)
{
    struct cuts cuts = {2 * places + 1, {0.0}};
    for (int i = 0; i < 2 * places; i++)
        cuts.at[i + 1] = margin + pitch * (i / 2 + 0.5) + (i % 2 ? 0.5 : -0.5) * size;
    cuts.at[cuts.cells] = 2.0 * margin + pitch * places;
    return cuts;
}

/* A wall between count + 1 vertices of the ceiling, from `first` on, and those of the
 * floor, whose numbers are `below` more. */
static void shell_wall(struct mesh *mesh, int32_t first, int32_t step, int count,
                       int32_t below)
{
    for (int i = 0; i < count; i++) {
        int32_t v = first + i * step, next = v + step;
        add_quad(mesh, next, v, v + below, next + below, WALL);
    }
}

/* Floor, walls and a ceiling with sunk lights: one closed surface seen from inside. */
static void shell(struct mesh *mesh, const struct plan *plan)
{
    const struct relief lights = {cuts_lights(plan->columns, PLACE_X, 0.0, 1.2),
                                  cuts_lights(plan->rows, PLACE_Y, MARGIN_Y, 0.6),
                                  0.0, -0.05, CEILING, LIGHT};
    struct frame back = frame_upright(WORLD, 0.0, plan->y, plan->z);
    struct frame down = frame_upright(back, 0.0, 0.0, 0.0);
    int nx = lights.x.cells, ny = lights.y.cells;
    int32_t row = nx + 1, ceiling = relief_front(mesh, down, &lights);
    int32_t last = ceiling + row * (ny + 1) - 1, floor = mesh->vertex_count;
    for (int j = 0; j <= ny; j++)
        for (int i = 0; i <= nx; i++)
            add_vertex(mesh, frame_point(down, lights.x.at[i], lights.y.at[j], plan->z));
    for (int j = 0; j < ny; j++)
        for (int32_t a = floor + j * row; a < floor + j * row + nx; a++)
            add_quad(mesh, a, a + row, a + row + 1, a + 1, FLOOR);
    int32_t below = floor - ceiling;
    shell_wall(mesh, ceiling, 1, nx, below);
    shell_wall(mesh, ceiling + nx, row, ny, below);
    shell_wall(mesh, last, -1, nx, below);
    shell_wall(mesh, last - nx, -row, ny, below);
}

/* Hangs it on a wall; the frame is on the floor at the wall, which faces -y. */
static void hang(struct mesh *mesh, struct frame frame, double z,
                 const struct relief *thing)
{
    double x = -0.5 * thing->x.at[thing->x.cells];
    relief(mesh, frame_upright(frame, x, -thing->thickness - GAP, z), thing);
}

static void wall_things(struct mesh *mesh, const struct plan *plan)
{
    const struct relief door = {cuts_even(1, 0.9, 0.12), cuts_even(2, 2.05, 0.12),
                                0.04, -0.01, DOOR, DOOR};
    const struct relief board = {cuts_even(1, 1.3, 0.02), cuts_even(1, 1.0, 0.02),
                                 0.02, -0.005, METAL, WHITE};
    const struct relief window = {cuts_even(2, 1.7, 0.05), cuts_even(1, 1.3, 0.05),
                                  0.06, -0.03, WHITE, SKY};
    for (int i = 0; i < plan->columns; i++) {
        double x = PLACE_X * (i + 0.5);
        hang(mesh, frame_at(WORLD, x - 0.3, plan->y, 0.0, 0.0), 0.95, &window);
        hang(mesh, frame_at(WORLD, x + 0.3, 0.0, 0.0, 0.5), 1.0, &board);
        if (i == 0)
            hang(mesh, frame_at(WORLD, x - 0.95, 0.0, 0.0, 0.5), GAP, &door);
    }
}

/* Places back to back in pairs, the last column with its bookcases at the wall; a screen
 * stands behind each desk that does not face a wall. */
static void room(struct mesh *mesh, int32_t triangles, struct random *random)
{
    struct plan plan = plan_make(triangles, random);
    int places = plan.columns * plan.rows;
    shell(mesh, &plan);
    wall_things(mesh, &plan);
    for (int i = 0; i < places; i++) {
        int column = i % plan.columns, row = i / plan.columns;
        int back = (plan.columns - 1 - column) % 2;
        struct frame frame = frame_at(WORLD, PLACE_X * (column + 0.5),
                                      MARGIN_Y + PLACE_Y * (row + 0.5), 0.0, 0.5 * back);
        int32_t share = (triangles - mesh->face_count) / (places - i);
        struct random own = {random_bits(random)};
        int32_t target = mesh->face_count + share;
        if (row != (back ? 0 : plan.rows - 1))
            box(mesh, frame, (struct vec){-1.4, 1.25, GAP}, (struct vec){0.3, 1.29, 1.35},
                FABRIC + (enum material)(column % FABRICS));
        place(mesh, frame, &own, target);
    }
}

/* --- the program --- */

static void print_mesh(const struct mesh *mesh)
{
    const int32_t unit = UNITS_PER_METRE;
    for (int32_t i = 0; i < mesh->vertex_count; i++) {
        const int32_t *v = mesh->vertices[i]; /* none negative: the floor's corner is 0 */
        printf("v %d.%05d %d.%05d %d.%05d\n", (int)(v[0] / unit), (int)(v[0] % unit),
               (int)(v[1] / unit), (int)(v[1] % unit), (int)(v[2] / unit),
               (int)(v[2] % unit));
    }
    enum material material = MATERIALS;
    for (int32_t i = 0; i < mesh->face_count; i++) {
        const struct face *face = &mesh->faces[i];
        if (face->material != material)
            printf("usemtl %s\n", materials[face->material].name);
        material = face->material;
        printf("f %d %d %d\n", (int)face->corner[0] + 1, (int)face->corner[1] + 1,
               (int)face->corner[2] + 1);
    }
}

static void print_room(int32_t triangles, uint32_t seed)
{
    struct mesh mesh = {NULL, NULL, 0, 0, 0, 0};
    struct random random = {seed};
    room(&mesh, triangles, &random);
    printf("# room %d %lu: %d triangles; metres, z up\nmtllib room.mtl\n", (int)triangles,
           (unsigned long)seed, (int)mesh.face_count);
    print_mesh(&mesh);
    free(mesh.vertices);
    free(mesh.faces);
}

static int number_is_read(const char *text, unsigned long low, unsigned long high,
                          unsigned long *number)
{
    char *end;
    errno = 0;
    *number = strtoul(text, &end, 10);
    return *text >= '0' && *text <= '9' && !*end && errno == 0 && *number >= low
           && *number <= high;
}

int main(int argc, char **argv)
{
    unsigned long triangles, seed;
    if (argc == 2 && strcmp(argv[1], "--materials") == 0)
        print_materials();
    else if (argc == 3
             && number_is_read(argv[1], TRIANGLES_MIN, TRIANGLES_MAX, &triangles)
             && number_is_read(argv[2], 0, UINT32_MAX, &seed))
        print_room((int32_t)triangles, (uint32_t)seed);
    else {
        fprintf(stderr,
                "usage: room N SEED > room.obj       an office of N triangles, %d to %d\n"
                "       room --materials > room.mtl  its materials, to lie beside it\n",
                TRIANGLES_MIN, TRIANGLES_MAX);
        return 2;
    }
    if (fflush(stdout) != 0 || ferror(stdout))
        fail("cannot write");
    return 0;
}
