/* Bundles: which of 16 segments are blocked?
 *
 * A bundle goes down as a whole, as the shaft of its eight end points (octree/shaft.h). A
 * triangle sees it as 4 + 4 points, which are eight lanes: their signed distances w to
 * its plane, and their barycentric coordinates u and v. From these follow the 16 pairs,
 * in two vectors: if w and w' differ in sign, the crossing point has u = (u |w'| + u'
 * |w|) / (|w| + |w'|), and only signs matter.
 *
 * All of this is float, and every comparison keeps a margin for its rounding. With errors
 * eu, ev and ew of the maps, u |w'| + u' |w| is off by at most eu (|w| + |w'|) + ew (|u|
 * + |u'|), and v likewise: a part for either point, so margins are computed for eight
 * points and added for 16 pairs. A pair of uncertain signs, near an edge or where an end
 * point lies in the plane, is decided by segment_is_blocked_by() in double. So float
 * decides nothing otherwise than double would, and the answers are the watertight ones of
 * geom/triangle.c to the bit.
 *
 * Made faster, most of all first (tests/bench/hits.c, beside Embree's packets of 16): a
 * link starts with the last blocker of its parent; tests inlined, masks folded in whole
 * words; the six slabs of a node written out instead of looped over; one fold of masks
 * for a triangle; numbers of the shaft spread over the lanes once, not for each node.
 * Eight-lane vectors where registers have four lanes had 0.4 of the speed of twice four.
 * Nothing was gained by a look at the eight points first (three in four triangles pass),
 * by remembering two to six blockers instead of one, by smaller leaves, and by fetching
 * the next node ahead. */
#include "octree/octree.h"
#include "octree/shaft.h"

/* --- a triangle against a bundle --- */

/* An affine map at eight points. */
#define MAP(r, p) \
    lanes_add(lanes_add(lanes_mul(lanes_all((r)[0]), (p)[0]), \
                        lanes_mul(lanes_all((r)[1]), (p)[1])), \
              lanes_add(lanes_mul(lanes_all((r)[2]), (p)[2]), lanes_all((r)[3])))

/* Points and a triangle; lanes are eight points, or one of the points of eight pairs. */
struct relation {
    lanes u, v;
    lanes w;      /* distance to the plane; 0 where its sign is not certain */
    lanes size;   /* of the distance */
    lanes margin; /* the point's part of the margin of u, v and their third */
};

/* Eight pairs whose points are on opposite sides: with the sizes of the distances, the
 * crossing point has u = (u0 w1 + u1 w0) / (w0 + w1), and likewise v; the point is inside
 * if both and their third are positive. Adds the bits of certain hits and misses. */
INLINE void judge_half(const struct relation *p, const struct relation *q,
                       const lanes_mask bits[2], lanes_mask *verdict)
{
    lanes zero = lanes_all(0.0f), product = lanes_mul(p->w, q->w);
    lanes u = lanes_add(lanes_mul(p->u, q->size), lanes_mul(q->u, p->size));
    lanes v = lanes_add(lanes_mul(p->v, q->size), lanes_mul(q->v, p->size));
    lanes third = lanes_sub(lanes_add(p->size, q->size), lanes_add(u, v));
    lanes uv = lanes_min(u, v), least = lanes_min(uv, third);
    lanes margin = lanes_add(p->margin, q->margin);
    lanes_mask inside = lanes_above(least, margin);
    lanes_mask outside = lanes_above(zero, lanes_add(least, margin));
    lanes_mask hit = mask_and(lanes_above(zero, product), inside);
    lanes_mask miss = mask_or(lanes_above(product, zero), outside);
    *verdict = mask_or(*verdict,
                       mask_or(mask_and(hit, bits[0]), mask_and(miss, bits[1])));
}

/* Bits of a verdict: a hit of pair k is bit k, a miss bit 16 + k. */
#define EIGHT_BITS(k) \
    {1u << (k), 2u << (k), 4u << (k), 8u << (k), 16u << (k), 32u << (k), 64u << (k), \
     128u << (k)}
static const uint32_t VERDICT_BITS[2][2][LANES] = {{EIGHT_BITS(0), EIGHT_BITS(16)},
                                                   {EIGHT_BITS(8), EIGHT_BITS(24)}};

/* Looks at the eight points, then at the 16 pairs. Returns the verdict of float; pairs
 * without a bit have to be decided in double. */
INLINE unsigned judge(const struct record *r, const struct shaft *shaft)
{
    const lanes *p = shaft->points;
    struct vec3 n = r->plane.normal;
    const float distance[4] = {(float)n.x, (float)n.y, (float)n.z,
                               -(float)r->plane.offset};
    lanes u = MAP(r->u, p), v = MAP(r->v, p), w = MAP(distance, p), size = lanes_abs(w);
    lanes_mask near = lanes_above(lanes_all(2.0f * r->error_w), size);
    lanes far = lanes_mul(lanes_all(r->error_u + r->error_v), size);
    lanes reach = lanes_add(lanes_add(lanes_abs(u), lanes_abs(v)), lanes_all(2.0f));
    reach = lanes_mul(reach, lanes_all(3.0f * r->error_w));
    lanes margin = lanes_add(far, reach), sure = lanes_unless(near, w);
    struct relation to = {lanes_twice_high(u), lanes_twice_high(v),
                          lanes_twice_high(sure), lanes_twice_high(size),
                          lanes_twice_high(margin)};
    struct relation first = {lanes_spread_01(u), lanes_spread_01(v),
                             lanes_spread_01(sure), lanes_spread_01(size),
                             lanes_spread_01(margin)};
    struct relation second = {lanes_spread_23(u), lanes_spread_23(v),
                              lanes_spread_23(sure), lanes_spread_23(size),
                              lanes_spread_23(margin)};
    lanes_mask verdict = mask_all(0), all = mask_all(-1), bits[2][2];
    memcpy(bits, VERDICT_BITS, sizeof bits);
    judge_half(&first, &to, bits[0], &verdict);
    judge_half(&second, &to, bits[1], &verdict);
    return mask_select(&verdict, &all);
}

/* The pairs among `wanted` blocked by the triangle. */
INLINE unsigned pairs_blocked(const struct octree *octree, const struct bundle *bundle,
                              const struct shaft *shaft, const struct record *r,
                              unsigned wanted)
{
    unsigned verdict = judge(r, shaft), blocked = verdict & wanted;
    unsigned open = wanted & ~(verdict | verdict >> BUNDLE_RAYS);
    for (int k = 0; open != 0; k++, open >>= 1) {
        if (!(open & 1u))
            continue;
        struct segment s =
            segment_make(bundle->from[k / BUNDLE_ENDS], bundle->to[k % BUNDLE_ENDS]);
        if (segment_is_blocked_by(&s, &octree->triangles[r->triangle], &r->plane))
            blocked |= 1u << k;
    }
    return blocked;
}

/* A bundle on its way. */
struct bundle_search {
    const struct octree *octree;
    const struct bundle *bundle;
    struct shaft shaft;
    unsigned blocked; /* segments known to be blocked, as bits */
    int32_t *guess;   /* the last triangle blocking some */
};

/* Visits a leaf, until all segments asked about are blocked. */
static bool find_blockers(void *at, const struct record *records, int32_t count,
                          struct octree_counts *counts)
{
    struct bundle_search *search = at;
    const struct bundle *bundle = search->bundle;
    for (int32_t i = 0; i < count && search->blocked != bundle->asked; i++) {
        int32_t t = records[i].triangle;
        if (t == bundle->own[0] || t == bundle->own[1])
            continue;
        counts->triangle_tests++;
        unsigned more = pairs_blocked(search->octree, bundle, &search->shaft, &records[i],
                                      bundle->asked & ~search->blocked);
        search->blocked |= more;
        *search->guess = more ? t : *search->guess;
    }
    return search->blocked == bundle->asked;
}

unsigned octree_block(const struct octree *octree, const struct bundle *bundle,
                      int32_t *guess, struct octree_counts *counts)
{
    const struct tree *tree = &octree->inside;
    int32_t place = *guess >= 0 ? octree->place[*guess] : -1;
    struct bundle_search search; /* set by parts, since the shaft is large */
    search.octree = octree;
    search.bundle = bundle;
    search.blocked = 0;
    search.guess = guess;
    counts->rays += bit_count(bundle->asked);
    shaft_set_points(&search.shaft, bundle->from, bundle->to);
    if (place >= 0 && find_blockers(&search, &tree->records[place], 1, counts))
        return search.blocked;
    shaft_set_slabs(&search.shaft);
    shaft_walk(tree, &search.shaft, find_blockers, &search, counts);
    return search.blocked;
}
