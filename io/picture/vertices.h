/* Vertices of the smooth shading: corners of leaves that are one point of one surface. */
#ifndef IO_PICTURE_VERTICES_H
#define IO_PICTURE_VERTICES_H

#include "octree/octree.h"
#include "rad/patch.h"

/* The vertex of a leaf in place of a parted one. */
struct vertex_part {
    int32_t leaf;
    int32_t vertex; /* -1: none of its own, where the vertex lies inside its edge */
};

struct vertices {
    struct vec3 *positions; /* [count] scene units */
    int32_t *surfaces;      /* [count] */
    int64_t count, capacity;
    int32_t *slots;         /* [slot_count] a hash table of vertices; -1: free */
    int64_t slot_count;     /* a power of two */
    struct vertex_part *parts;     /* [part_count] one parted vertex after another */
    int64_t part_count, part_capacity;
    int64_t *first_part;           /* [known] of a vertex; -1: it is not parted */
    int64_t known;                 /* vertices before any was parted */
};

/* Appends a vertex that no other leaf finds. Returns its number. */
int32_t vertices_append(struct vertices *vertices, struct vec3 x, int32_t surface);

/* Returns the vertex of a surface at x, appended when first asked for. */
int32_t vertices_reach(struct vertices *vertices, struct vec3 x, int32_t surface);

/* Returns the leaf's vertex in the middle of two others, or -1: it has none there, or the
 * middle rounds to one of the two. */
int32_t vertices_between(const struct vertices *vertices, int32_t u, int32_t v,
                         int32_t leaf);

/* Parts the vertices at which something stands between leaves: these share a vertex if
 * a way just above the surface joins them. `corners`: [3 * forest->count] vertex of leaf
 * p, k: [3 p + k]. Pre: all leaves but those of a sky have vertices, and no others.
 * Appended vertices are the same on every rank. */
void vertices_part(struct vertices *vertices, const struct forest *forest,
                   const struct octree *octree, int32_t *corners);

void vertices_free(struct vertices *vertices);

#endif
