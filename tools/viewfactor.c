/* View factors by facets, quadtrees, proofs of visibility and 16 segments, as in solving.
 *
 * For a pair of patches, with G their exact exchange without blockers (tools/contour.h):
 *
 *   - an empty shaft is proved open, and the exchange is G, for patches of any size;
 *   - one triangle that stops all nine segments between the corners proves that it is 0;
 *   - else the pair is in doubt: if G is at most the threshold, the exchange is G times
 *     the visible fraction of 16 segments, weighted by the light that they would carry;
 *     if not, the sum over the four children of the larger patch.
 *
 * So scenes without blockers are exact at any epsilon, and patches shrink along the edges
 * of shadows only.
 *
 * The threshold T: each pair in doubt has an error of some part of G <= T, independent of
 * the others, since each has its own random ends of segments. A sum D of exchange in
 * doubt has about D / T such pairs, so that the error goes with sqrt(T D), and the cost
 * with D / T. Let T be epsilon times the area A of the smaller group. D is a part,
 * smaller the finer the patches are, of F A, with F the factor from the smaller group
 * without blockers. Then the error of the factor is at most c sqrt(epsilon F) (measured
 * in the 17 cases of tests/57-viewfactors.sh, each with several sets of ends, epsilon
 * from 1e-3 to 1e-6: c = 0.03 RMS and 0.13 at worst), and the cost F / epsilon for each
 * pair of groups: as the factors of a row have a bounded sum, they cost about 1 / epsilon
 * for each group and not for each pair. The relative error of a factor goes with 1 /
 * sqrt(F), which suits heat balances: small factors count little there. Rejected: T
 * relative to the power in the scene, as for the light, where small groups would be lost;
 * T relative to G itself, where each faint pair costs as much as a strong one.
 *
 * Pairs whose segments agree are split like those whose segments differ: to stop earlier
 * at fractions of 0 or 1 would bias the mean. With twice the threshold for them the time
 * falls by a fifth and the errors are three times as large.
 *
 * The ends of the segments are random (hashed from the IDs of the patches, so always the
 * same): walls at halves and quarters of each other cast shadows exactly through the
 * centres of patches at every level. With ends at the centres, all these ties would be
 * decided the same way, so that the error would fall only with the size of the patches;
 * and the decision would depend on the last bit, so that a rotated scene would get other
 * factors. */
#include "tools/viewfactor.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/hash.h"
#include "geom/stop.h"
#include "rad/id.h"
#include "tools/contour.h"

/* A patch of a pair. */
struct piece {
    struct facet facet;
    struct patch_id id;
};

/* The common data of all parts of a pair of roots. */
struct root_pair {
    struct viewfactors *factors;
    double threshold;       /* of an exchange in doubt, square scene units */
    struct flux_unit unit;  /* of the sum */
    int64_t sum;            /* exchange of the parts added so far */
    int32_t blocker;        /* the last triangle that stopped a segment */
};

struct viewfactors *viewfactors_create(const struct scene *scene,
                                       const struct octree *octree, double epsilon,
                                       int max_level)
{
    struct viewfactors *factors = alloc_array(1, sizeof *factors);
    factors->scene = scene;
    factors->octree = octree;
    factors->epsilon = epsilon;
    factors->max_level = max_level;
    factors->count = scene->groups.count;
    factors->pairs = (int64_t)factors->count * (factors->count + 1) / 2;
    factors->areas = alloc_array((size_t)factors->count, sizeof *factors->areas);
    factors->roots = alloc_array((size_t)factors->count, sizeof *factors->roots);
    factors->sums = alloc_array((size_t)factors->pairs, sizeof *factors->sums);
    for (int32_t root = 0; root < scene_root_count(scene); root++) {
        int32_t group = scene->groups.of[scene_input_of(scene, root)];
        factors->areas[group] += scene_root_area(scene, root);
        factors->roots[group] += scene_root_area(scene, root) > 0.0;
    }
    return factors;
}

void viewfactors_destroy(struct viewfactors *factors)
{
    if (!factors)
        return;
    alloc_free(factors->areas);
    alloc_free(factors->roots);
    alloc_free(factors->sums);
    alloc_free(factors);
}

/* --- one pair of roots --- */

/* Returns a random point of the triangle, uniformly distributed, never on its edges. */
static struct vec3 point_of(const struct triangle *t, uint64_t bits)
{
    double u = ((double)(bits >> 32) + 0.5) / 4294967296.0;
    double v = ((double)(bits & 0xffffffffu) + 0.5) / 4294967296.0;
    if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
    }
    struct vec3 along_u = vec3_scale(vec3_sub(t->corner[1], t->corner[0]), u);
    struct vec3 along_v = vec3_scale(vec3_sub(t->corner[2], t->corner[0]), v);
    return vec3_add(t->corner[0], vec3_add(along_u, along_v));
}

/* Sets one random point in each quarter. */
static void points_of(const struct piece *piece, uint64_t seed,
                      struct vec3 points[BUNDLE_ENDS])
{
    for (int k = 0; k < BUNDLE_ENDS; k++) {
        struct triangle quarter = triangle_child(&piece->facet.triangle, k);
        seed = hash_mix(seed);
        points[k] = point_of(&quarter, seed);
    }
}

/* Returns the light that a segment carries, up to a constant: cos cos' / (pi r^2 + A),
 * with A a quarter of the larger area, so that close ends do not outweigh all others. 0
 * below a horizon. */
static double weight_of(const struct piece *p, const struct piece *q, struct vec3 x,
                        struct vec3 y)
{
    struct vec3 d = vec3_sub(y, x);
    double rise_p = vec3_dot(p->facet.plane.normal, d);
    double rise_q = -vec3_dot(q->facet.plane.normal, d); /* r cos theta */
    if (rise_p <= 0.0 || rise_q <= 0.0)
        return 0.0;
    double r2 = vec3_dot(d, d);
    return rise_p * rise_q / r2 / (PI * r2 + 0.25 * fmax(p->facet.area, q->facet.area));
}

/* Returns the visible fraction of 16 segments, 0 to 1, and exactly 0 or 1 if all agree;
 * `otherwise` if none of them faces both patches. */
static double fraction_seen(struct root_pair *pair, const struct piece *p,
                         const struct piece *q, double otherwise)
{
    struct bundle bundle = {.own = {p->facet.input, q->facet.input}};
    uint64_t seed =
        hash_finish(hash_mix(id_number(p->id)) + 3 * hash_mix(id_number(q->id)));
    points_of(p, seed, bundle.from);
    points_of(q, ~seed, bundle.to);
    double weights[BUNDLE_RAYS], all = 0.0, seen = 0.0;
    for (int ray = 0; ray < BUNDLE_RAYS; ray++) {
        weights[ray] = weight_of(p, q, bundle.from[ray / BUNDLE_ENDS],
                                 bundle.to[ray % BUNDLE_ENDS]);
        bundle.asked |= (unsigned)(weights[ray] > 0.0) << ray;
    }
    if (bundle.asked == 0)
        return otherwise;
    unsigned blocked = octree_block(pair->factors->octree, &bundle, &pair->blocker,
                                    &pair->factors->counts);
    for (int ray = 0; ray < BUNDLE_RAYS; ray++) {
        all += weights[ray];
        seen += blocked >> ray & 1u ? 0.0 : weights[ray];
    }
    return seen / all;
}

static struct piece piece_child(const struct piece *piece, int child)
{
    struct piece part = *piece;
    part.facet.triangle = triangle_child(&piece->facet.triangle, child);
    part.facet.area = 0.25 * piece->facet.area;
    part.id = id_child(piece->id, child);
    return part;
}

/* Returns the side of the larger patch, 0 or 1, or -1 if neither may be split. Areas that
 * differ by rounding count as equal, lest a rotated scene gets other patches. */
static int side_to_split(const struct root_pair *pair, const struct piece *p,
                         const struct piece *q)
{
    bool may_p = id_level(p->id) < pair->factors->max_level;
    bool may_q = id_level(q->id) < pair->factors->max_level;
    bool p_first = p->facet.area > (1.0 - 1e-6) * q->facet.area;
    return may_p && (p_first || !may_q) ? 0 : may_q ? 1 : -1;
}

static bool is_settled(struct root_pair *pair, const struct piece *p,
                       const struct piece *q, double fraction)
{
    const struct octree *octree = pair->factors->octree;
    struct octree_counts *counts = &pair->factors->counts;
    return fraction == 0.0   ? facets_are_walled_off(&p->facet, &q->facet, octree, counts)
           : fraction == 1.0 ? facets_are_open(&p->facet, &q->facet, octree, counts)
                          : false;
}

/* Adds the exchange of p and q. `otherwise`: the visible fraction of their parents'
 * pair. */
static void add_pair(struct root_pair *pair, const struct piece *p, const struct piece *q,
                     double otherwise)
{
    if (stop_is_asked() || !facets_face(&p->facet, &q->facet))
        return;
    double exchange = triangle_exchange(&p->facet.triangle, &q->facet.triangle);
    if (!(exchange > 0.0))
        return;
    double fraction = fraction_seen(pair, p, q, otherwise);
    int side = exchange <= pair->threshold ? -1 : side_to_split(pair, p, q);
    if (side < 0 || is_settled(pair, p, q, fraction)) {
        pair->sum += flux_from_watts(pair->unit, fraction * exchange);
        pair->factors->links++;
        return;
    }
    for (int k = 0; k < 4; k++) {
        struct piece part = piece_child(side == 0 ? p : q, k);
        add_pair(pair, side == 0 ? &part : p, side == 0 ? q : &part, fraction);
    }
}

/* --- groups --- */

static int64_t place_of(const struct viewfactors *factors, int32_t i, int32_t j)
{
    int64_t row = i < j ? i : j, column = i < j ? j : i;
    return row * factors->count - row * (row - 1) / 2 + (column - row);
}

/* Returns the unit of G_ij, a sum over pairs of roots with at most the area of the
 * smaller root each: at most n_j A_i and n_i A_j, with n the numbers of roots. Twice this
 * bound leaves room for rounding. */
static struct flux_unit unit_of(const struct viewfactors *factors, int32_t i, int32_t j)
{
    double of_i = factors->roots[j] * factors->areas[i];
    double of_j = factors->roots[i] * factors->areas[j];
    return flux_unit_for(2.0 * fmin(of_i, of_j));
}

void viewfactors_add(struct viewfactors *factors, int32_t p, const struct facet *fp,
                     int32_t q, const struct facet *fq)
{
    int32_t i = factors->scene->groups.of[fp->input],
            j = factors->scene->groups.of[fq->input];
    struct root_pair pair = {
        .factors = factors,
        .threshold = factors->epsilon * fmin(factors->areas[i], factors->areas[j]),
        .unit = unit_of(factors, i, j),
        .blocker = -1,
    };
    struct piece piece_p = {*fp, id_of_root((uint32_t)p)},
                 piece_q = {*fq, id_of_root((uint32_t)q)};
    add_pair(&pair, &piece_p, &piece_q, 1.0);
    factors->sums[place_of(factors, i, j)] += pair.sum;
}

/* Returns G_ij by the pairs added so far, square scene units. */
static double exchange_between(const struct viewfactors *factors, int32_t i, int32_t j)
{
    double one_way =
        flux_to_watts(unit_of(factors, i, j), factors->sums[place_of(factors, i, j)]);
    return i == j ? 2.0 * one_way : one_way; /* a pair within a group counts both ways */
}

double viewfactors_factor(const struct viewfactors *factors, int32_t i, int32_t j)
{
    return factors->areas[i] > 0.0 ? exchange_between(factors, i, j) / factors->areas[i]
                                   : 0.0;
}
