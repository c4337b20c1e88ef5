/* Bundles: which of 16 segments are blocked?
 *
 * A bundle goes down as a whole, as the shaft of its eight end points (octree/shaft.h). A
 * triangle sees it as 4 + 4 points, which are eight lanes: the signed distances w to its
 * plane, and if they are not all on one side, its barycentric coordinates u and v. If all
 * eight points are on the far side of an edge no segment meets it. Only then are the 16
 * pairs looked at, in two vectors: from w, u at one end and w', u' at the other, the
 * crossing point has u = (u w' - u' w) / (w' - w), and only signs matter.
 *
 * All of this is float, and every comparison keeps a margin for its rounding. A pair for
 * which the signs are not certain, near an edge or where an end point lies in the plane,
 * is decided by segment_is_blocked_by() in double. So float decides nothing that double
 * would decide otherwise, and the answers are the watertight ones of geom/triangle.c to
 * the bit.
 *
 * Made faster, most of all first (tests/bench/rays.c, beside Embree's packets of 16): a
 * link starts with the last blocker of the one that it comes from; tests inlined, masks
 * folded in whole words; the six slabs of a node written out instead of looped over;
 * numbers of the shaft spread over the lanes once, not for each node. Eight-lane vectors
 * where registers have four lanes had 0.4 of the speed of twice four. Remembering two to
 * six blockers instead of one and fetching the next node ahead gained nothing. */
#include "octree/octree.h"
#include "octree/shaft.h"

/* --- a triangle against a bundle --- */

/* An affine map at eight points. */
#define MAP(r, p) \
    lanes_add(lanes_add(lanes_mul(lanes_all((r)[0]), (p)[0]), \
                        lanes_mul(lanes_all((r)[1]), (p)[1])), \
              lanes_add(lanes_mul(lanes_all((r)[2]), (p)[2]), lanes_all((r)[3])))

/* The pairs of a triangle that float is sure of. */
struct verdict {
    unsigned hit, miss; /* bits of the pairs for which it is certain */
};

/* Eight pairs. With s = w' - w, the crossing point has u = U / s, v = V / s; it is inside
 * if U, V and s - U - V have the sign of s. The margins follow from the errors of the
 * maps. */
INLINE struct verdict judge_half(const struct record *r, const lanes *u0, const lanes *u1,
                                 const lanes *v0, const lanes *v1, const lanes *w0,
                                 const lanes *w1)
{
    lanes eu = lanes_all(r->error_u), ev = lanes_all(r->error_v),
          ew = lanes_all(r->error_w);
    lanes zero = lanes_all(0.0f);
    lanes s = lanes_sub(*w1, *w0), size = lanes_abs(s);
    lanes u = lanes_flip(lanes_sub(lanes_mul(*u0, *w1), lanes_mul(*u1, *w0)), s);
    lanes v = lanes_flip(lanes_sub(lanes_mul(*v0, *w1), lanes_mul(*v1, *w0)), s);
    lanes third = lanes_sub(size, lanes_add(u, v));
    lanes far = lanes_add(lanes_abs(*w0), lanes_abs(*w1));
    lanes mu = lanes_add(lanes_mul(eu, far),
                         lanes_mul(ew, lanes_add(lanes_abs(*u0), lanes_abs(*u1))));
    lanes mv = lanes_add(lanes_mul(ev, far),
                         lanes_mul(ew, lanes_add(lanes_abs(*v0), lanes_abs(*v1))));
    lanes ms = lanes_add(lanes_add(mu, mv), lanes_mul(lanes_all(3.0f), ew));
    lanes nw = lanes_sub(zero, ew);
    lanes_mask up = mask_and(lanes_above(*w0, ew), lanes_above(nw, *w1));
    lanes_mask down = mask_and(lanes_above(*w1, ew), lanes_above(nw, *w0));
    lanes_mask above = mask_and(lanes_above(*w0, ew), lanes_above(*w1, ew));
    lanes_mask below = mask_and(lanes_above(nw, *w0), lanes_above(nw, *w1));
    lanes_mask inside = mask_and(mask_and(lanes_above(u, mu), lanes_above(v, mv)),
                                 lanes_above(third, ms));
    lanes_mask outside = mask_or(mask_or(lanes_above(lanes_sub(zero, mu), u),
                                         lanes_above(lanes_sub(zero, mv), v)),
                                 lanes_above(lanes_sub(zero, ms), third));
    lanes_mask sure = lanes_above(size, lanes_mul(lanes_all(3.0f), ew));
    lanes_mask hit = mask_and(mask_or(up, down), inside);
    lanes_mask miss = mask_or(mask_or(above, below), mask_and(outside, sure));
    return (struct verdict){mask_bits(&hit), mask_bits(&miss)};
}

/* 1 if a > b in all lanes. Results are joined by | and not ||: one branch that is hard to
 * guess costs more than a few operations. */
INLINE int all_above(const lanes *a, const lanes *b)
{
    lanes_mask mask = lanes_above(*a, *b);
    return mask_is_full(&mask);
}

/* Looks at the eight points, then at the 16 pairs. Pairs in neither set have to be
 * decided in double. */
INLINE struct verdict judge(const struct record *r, const struct shaft *shaft,
                            unsigned wanted)
{
    const struct verdict none = {0, 0xffffu};
    const lanes *p = shaft->points;
    lanes zero = lanes_all(0.0f);
    struct vec3 n = r->plane.normal;
    const float distance[4] = {(float)n.x, (float)n.y, (float)n.z,
                               -(float)r->plane.offset};
    lanes w = MAP(distance, p), ew = lanes_all(r->error_w), nw = lanes_sub(zero, ew);
    if (all_above(&w, &ew) | all_above(&nw, &w))
        return none;
    lanes u = MAP(r->u, p), v = MAP(r->v, p), sum = lanes_add(u, v);
    lanes nu = lanes_all(-r->error_u), nv = lanes_all(-r->error_v);
    lanes one = lanes_all(1.0f + 2.0f * (r->error_u + r->error_v));
    if (all_above(&nu, &u) | all_above(&nv, &v) | all_above(&sum, &one))
        return none;
    lanes us = lanes_twice_high(u), vs = lanes_twice_high(v), ws = lanes_twice_high(w);
    lanes u0 = lanes_spread_01(u), v0 = lanes_spread_01(v), w0 = lanes_spread_01(w);
    struct verdict a = {0, 0xffu}, b = {0, 0xffu};
    if (wanted & 0xffu)
        a = judge_half(r, &u0, &us, &v0, &vs, &w0, &ws);
    if (wanted & 0xff00u) {
        u0 = lanes_spread_23(u);
        v0 = lanes_spread_23(v);
        w0 = lanes_spread_23(w);
        b = judge_half(r, &u0, &us, &v0, &vs, &w0, &ws);
    }
    return (struct verdict){a.hit | b.hit << LANES, a.miss | b.miss << LANES};
}

/* The pairs among `wanted` that the triangle blocks. */
INLINE unsigned pairs_blocked(const struct octree *octree, const struct bundle *bundle,
                              const struct shaft *shaft, const struct record *r,
                              unsigned wanted)
{
    struct verdict verdict = judge(r, shaft, wanted);
    unsigned blocked = verdict.hit & wanted, open = wanted & ~verdict.hit & ~verdict.miss;
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
    int32_t *guess;   /* the last triangle that blocked some */
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
