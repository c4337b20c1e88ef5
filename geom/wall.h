/* Walls: convex polygons that block. Each is made of all the triangles in one plane that hang together
 * by whole edges, where these make a convex polygon, else of one triangle.
 *
 * A wall stops every segment between two triangles if it does so between their corners; the proof is
 * in wall.c. */
#ifndef GEOM_WALL_H
#define GEOM_WALL_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/pack.h"
#include "geom/triangle.h"

enum { WALL_CORNERS_MAX = 32 }; /* what has more corners is left in pieces */

struct wall {
    struct plane plane;   /* seen from its front the corners run counter-clockwise */
    double area;          /* square scene units */
    int32_t first, count; /* corners[first] to corners[first + count - 1] */
};

struct walls {
    struct wall *items;     /* [count] */
    struct vec3 *corners;   /* [corner_count] */
    int32_t *of_triangle;   /* [triangle_count] the wall that a triangle is part of; -1: none, it has no
                               area */
    int32_t count, corner_count, triangle_count;
    bool is_view;           /* the arrays lie in memory of others */
};

/* The walls of a scene of `count` triangles with their planes, in scene units; triangles whose plane has
 * a zero normal (dropped ones) are left out. */
struct walls *walls_create(const struct triangle *triangles, const struct plane *planes,
                           int32_t count);
void walls_destroy(struct walls *walls);

/* Bytes that they take. */
int64_t walls_bytes(const struct walls *walls);

/* Into a block, and as they are there: read-only, valid as long as the block. */
void walls_pack(const struct walls *walls, struct pack *pack);
struct walls *walls_view(struct pack *pack);

/* What a wall hides from a triangle: the points behind the first plane, which is the wall's, and behind
 * all others, which lead through its edges. */
struct shadow {
    int32_t wall;
    int count; /* of planes */
    struct plane planes[1 + 3 * WALL_CORNERS_MAX];
};

/* The shadow of a wall as seen from triangle p. False if p does not lie on one side of the wall's
 * plane, reaching off it: then there is none. */
bool shadow_make(struct shadow *shadow, const struct walls *walls, int32_t wall,
                 const struct triangle *p);

/* True if it is proved that the wall blocks all segments from p to the box, or to the triangle, but for
 * those that start or end in the wall's plane (as at an edge that p or q has in common with it). */
bool shadow_holds_box(const struct shadow *shadow, struct vec3 low, struct vec3 high);
bool shadow_holds_triangle(const struct shadow *shadow, const struct triangle *q);

#endif
