/* The ray caster by brute force: the interface of octree/octree.h, every triangle tested
 * against every segment in double precision. It is the truth: linked in place of octree/
 * it must give the same bytes, only slower (tests/60-ranks.sh). */
#include "octree/octree.h"

#include <stddef.h>

#include "geom/alloc.h"
#include "geom/hull.h"
#include "geom/wall.h"

struct octree {
    const struct triangle *triangles;
    const struct plane *planes;
    int32_t count;
    int32_t *neighbours;
    bool is_view;
};

struct octree *octree_create(const struct triangle *triangles, const struct plane *planes,
                             int32_t count)
{
    struct octree *octree = alloc_array(1, sizeof *octree);
    *octree = (struct octree){triangles, planes, count,
                              walls_find_neighbours(triangles, planes, count), false};
    return octree;
}

void octree_destroy(struct octree *octree)
{
    if (octree && !octree->is_view)
        alloc_free(octree->neighbours);
    alloc_free(octree);
}

void octree_pack(const struct octree *octree, struct pack *pack)
{
    pack_array(pack, &octree->count, sizeof octree->count);
    pack_array(pack, octree->neighbours, 3 * (size_t)octree->count * sizeof(int32_t));
}

struct octree *octree_view(struct pack *pack, const struct triangle *triangles,
                           const struct plane *planes)
{
    struct octree *octree = alloc_array(1, sizeof *octree);
    int32_t count = *(const int32_t *)pack_array(pack, NULL, sizeof count);
    int32_t *neighbours = pack_array(pack, NULL, 3 * (size_t)count * sizeof *neighbours);
    *octree = (struct octree){triangles, planes, count, neighbours, true};
    return octree;
}

static bool is_blocked_by(const struct octree *octree, int32_t t, struct vec3 from,
                          struct vec3 to)
{
    struct segment s = segment_make(from, to);
    return segment_is_blocked_by(&s, &octree->triangles[t], &octree->planes[t]);
}

bool octree_blocks_segment(const struct octree *octree, struct vec3 from, struct vec3 to,
                           const int32_t own[2], int32_t *guess,
                           struct octree_counts *counts)
{
    counts->rays++;
    for (int32_t t = 0; t < octree->count; t++)
        if (t != own[0] && t != own[1] && is_blocked_by(octree, t, from, to)) {
            *guess = t;
            return true;
        }
    return false;
}

unsigned octree_block(const struct octree *octree, const struct bundle *bundle,
                      int32_t *guess, struct octree_counts *counts)
{
    unsigned blocked = 0;
    for (int k = 0; k < BUNDLE_RAYS; k++)
        if ((bundle->asked >> k & 1u) &&
            octree_blocks_segment(octree, bundle->from[k / BUNDLE_ENDS],
                                  bundle->to[k % BUNDLE_ENDS], bundle->own, guess,
                                  counts))
            blocked |= 1u << k;
    return blocked;
}

bool octree_has_wall(const struct octree *octree, const struct vec3 *p, int count_p,
                     const struct vec3 *q, int count_q, struct octree_counts *counts)
{
    const struct walls walls = {octree->triangles, octree->planes, octree->neighbours};
    struct vec3 from = {0.0, 0.0, 0.0}, to = from;
    (void)counts;
    for (int k = 0; k < count_p; k++)
        from = vec3_add(from, p[k]);
    for (int k = 0; k < count_q; k++)
        to = vec3_add(to, q[k]);
    from = vec3_scale(from, 1.0 / count_p);
    to = vec3_scale(to, 1.0 / count_q);
    for (int32_t t = 0; t < octree->count; t++)
        if (is_blocked_by(octree, t, from, to) &&
            walls_stand_between(&walls, t, p, count_p, q, count_q))
            return true;
    return false;
}

int32_t octree_list_shaft(const struct octree *octree, const struct triangle *p,
                          const struct plane *plane_p, const struct triangle *q,
                          const struct plane *plane_q, const int32_t own[2],
                          int32_t *entrants, int32_t most, struct octree_counts *counts)
{
    struct hull hull = hull_of_pair(p, plane_p, q, plane_q);
    int32_t count = 0;
    (void)counts;
    for (int32_t t = 0; t < octree->count && count <= most; t++) {
        if (t == own[0] || t == own[1] ||
            !(vec3_dot(octree->planes[t].normal, octree->planes[t].normal) > 0.0) ||
            !hull_is_entered(&hull, &octree->triangles[t]))
            continue;
        if (count < most)
            entrants[count] = t;
        count++;
    }
    return count;
}

bool octree_first_hit(const struct octree *octree, struct vec3 origin,
                      struct vec3 direction, bool fronts_only, struct octree_hit *hit,
                      struct octree_counts *counts)
{
    struct segment s = segment_make(origin, vec3_add(origin, direction));
    double nearest = HUGE_VAL;
    hit->triangle = -1;
    counts->rays++;
    for (int32_t t = 0; t < octree->count; t++) {
        const struct plane *plane = &octree->planes[t];
        double start = plane_distance(plane, origin),
               slope = vec3_dot(plane->normal, direction);
        double at = -start / slope, weight[3]; /* in lengths of `direction` */
        bool faces = start > 0.0;
        bool ties = at <= nearest * (1.0 + 1e-12) && at > nearest * (1.0 - 1e-12);
        if (slope == 0.0 || !(at > 0.0) || (fronts_only && !faces) ||
            (ties ? !faces && hit->front : at > nearest) ||
            !segment_line_meets(&s, &octree->triangles[t], weight))
            continue;
        nearest = at < nearest ? at : nearest;
        *hit = (struct octree_hit){t, faces, {weight[0], weight[1], weight[2]}};
    }
    return hit->triangle >= 0;
}

void octree_first_hits(const struct octree *octree, struct vec3 origin,
                       const struct vec3 *directions, int count, bool fronts_only,
                       struct octree_hit *hits, struct octree_counts *counts)
{
    for (int i = 0; i < count; i++)
        octree_first_hit(octree, origin, directions[i], fronts_only, &hits[i], counts);
}

void octree_stream_hits(const struct octree *octree, struct stream *stream,
                        bool fronts_only, struct octree_counts *counts)
{
    for (int i = 0; i < stream->count; i++)
        octree_first_hit(octree, stream->origins[i], stream->directions[i], fronts_only,
                         &stream->hits[i], counts);
}

void octree_hit_weights(const struct octree *octree, struct vec3 origin,
                        struct vec3 direction, struct octree_hit *hit)
{
    struct segment s = segment_make(origin, vec3_add(origin, direction));
    segment_line_meets(&s, &octree->triangles[hit->triangle], hit->weight);
}
