/* Is anything in the shaft between two triangles? */
#include "octree/shaft.h"

#include <string.h>

#include "geom/hull.h"
#include "octree/octree.h"

static float float_min(float a, float b)
{
    return a < b ? a : b;
}

static float float_max(float a, float b)
{
    return a > b ? a : b;
}

/* Pairs at a time: one after the other, each would wait for the one before. */
static struct slab slab_of(const lanes *values)
{
    float v[LANES];
    memcpy(v, values, sizeof v);
    float low = float_min(float_min(float_min(v[0], v[1]), float_min(v[2], v[3])),
                          float_min(float_min(v[4], v[5]), float_min(v[6], v[7])));
    float high = float_max(float_max(float_max(v[0], v[1]), float_max(v[2], v[3])),
                           float_max(float_max(v[4], v[5]), float_max(v[6], v[7])));
    return (struct slab){lanes_all(low - BOX_MARGIN), lanes_all(high + BOX_MARGIN)};
}

void shaft_set_points(struct shaft *shaft, const struct vec3 from[SHAFT_ENDS],
                             const struct vec3 to[SHAFT_ENDS])
{
    float points[3][LANES];
    for (int k = 0; k < SHAFT_ENDS; k++) {
        points[0][k] = (float)from[k].x;
        points[1][k] = (float)from[k].y;
        points[2][k] = (float)from[k].z;
        points[0][SHAFT_ENDS + k] = (float)to[k].x;
        points[1][SHAFT_ENDS + k] = (float)to[k].y;
        points[2][SHAFT_ENDS + k] = (float)to[k].z;
    }
    for (int axis = 0; axis < 3; axis++)
        shaft->points[axis] = lanes_at(points[axis]);
}

/* The rest, which only a walk needs: direction and slabs of the points. */
void shaft_set_slabs(struct shaft *shaft)
{
    float points[3][LANES], direction[3], largest = 1e-30f;
    memcpy(points, shaft->points, sizeof points);
    shaft->near = 0;
    for (int axis = 0; axis < 3; axis++) {
        const float *p = points[axis];
        float d = ((p[4] - p[0]) + (p[5] - p[1])) + ((p[6] - p[2]) + (p[7] - p[3]));
        direction[axis] = d;
        shaft->near |= (d < 0.0f) << axis;
        largest = fabsf(d) > largest ? fabsf(d) : largest;
    }
    mask_set_weights(&shaft->weights, shaft->near);
    for (int axis = 0; axis < 3; axis++)
        direction[axis] /= largest;
    for (int axis = 0; axis < 3; axis++)
        shaft->direction[axis] = lanes_all(direction[axis]);
    for (int axis = 0; axis < 3; axis++) {
        int i = (axis + 1) % 3, j = (axis + 2) % 3;
        lanes x = lanes_mul(shaft->direction[j], shaft->points[i]);
        lanes y = lanes_mul(shaft->direction[i], shaft->points[j]);
        lanes across = lanes_sub(x, y);
        shaft->own[axis] = slab_of(&shaft->points[axis]);
        shaft->cross[axis] = slab_of(&across);
    }
}

/* --- what is in a shaft --- */

struct shaft_query {
    const struct triangle *triangles;
    const int32_t *own; /* [2] */
    struct hull hull;
    int32_t *entrants;  /* [most] triangles reaching into the hull */
    int32_t most, count;
};

/* Visits a leaf: which of its triangles reach into the hull? The walk ends at the first
 * for which there is no room. */
INLINE bool find_entrants(void *at, const struct record *records, int32_t count,
                          struct octree_counts *counts)
{
    struct shaft_query *query = at;
    for (int32_t i = 0; i < count; i++) {
        int32_t t = records[i].triangle;
        if (t == query->own[0] || t == query->own[1])
            continue;
        counts->triangle_tests++;
        if (!hull_is_entered(&query->hull, &query->triangles[t]))
            continue;
        if (query->count++ == query->most)
            return true;
        int32_t place = query->count - 1; /* in ascending order */
        for (; place > 0 && query->entrants[place - 1] > t; place--)
            query->entrants[place] = query->entrants[place - 1];
        query->entrants[place] = t;
    }
    return false;
}

int32_t octree_list_shaft(const struct octree *octree, const struct triangle *p,
                          const struct plane *plane_p, const struct triangle *q,
                          const struct plane *plane_q, const int32_t own[2],
                          int32_t *entrants, int32_t most, struct octree_counts *counts)
{
    struct shaft_query query = {octree->triangles, own,
                                hull_of_pair(p, plane_p, q, plane_q), entrants, most, 0};
    struct vec3 from[SHAFT_ENDS], to[SHAFT_ENDS];
    struct shaft shaft;
    for (int k = 0; k < SHAFT_ENDS; k++) {
        from[k] = p->corner[k % 3];
        to[k] = q->corner[k % 3];
    }
    shaft_set_points(&shaft, from, to);
    shaft_set_slabs(&shaft);
    shaft_walk(&octree->inside, &shaft, find_entrants, &query, counts);
    return query.count;
}
