/* View factors by facets, quadtrees, exact parts past few blockers, and 16 segments.
 *
 * For a pair of patches, with G their exact exchange without blockers (geom/contour.h)
 * and T a threshold:
 *
 *   - if G is at most T, the exchange is G times the visible fraction of 16 segments,
 *     weighted by the light of each; exact if nothing is in the shaft;
 *   - if not, the triangles in the shaft between the two are listed. None: the exchange
 *     is G, for patches of any size. Few: the exchange is found from points of the
 *     smaller patch, each of which knows exactly what it sees past the triangles
 *     (screened.h), within a tenth of T for each part of the patch. More, or a strong
 *     pair whose points all see nothing, or all, without a proof: the exchange is the
 *     sum over the four children of the larger patch. One wall between all corners
 *     proves an exchange of 0.
 *
 * So scenes without blockers are exact at any epsilon, a file of a few polygons takes
 * milliseconds, and patches shrink only where much stands between them.
 *
 * The threshold is epsilon times the area of the smaller group: as the factors of a row
 * have a bounded sum, they cost about 1 / epsilon for each group and not for each pair,
 * and small factors count little in heat balances. Rejected: T relative to the power in
 * the scene, as for the light, where small groups would be lost; T relative to G itself,
 * where each faint pair costs as much as a strong one.
 *
 * The error of a factor. Each sampled pair has random ends of its own, so variances add:
 * the variance of a fraction is told by the spread of its four ends on either side, which
 * is more than stratified ends deserve, and not less than the square of a tenth and of
 * the factor between the two patches: a few segments carry most of the light of near
 * ones. Where a patch is in part behind the other's plane, few segments count, or none.
 * Exchanges known exactly by points have an upper limit of error (screened.c), which
 * counts as three standard errors. The largest of N errors is sqrt(4 + 2 ln N) times its
 * standard error at most: 2 for one factor, 5.5 for half a million.
 *
 * The ends of the segments are random (hashed from the IDs of the patches, so always the
 * same): walls at halves and quarters of each other cast shadows exactly through the
 * centres of patches at every level. With ends at the centres, all these ties would be
 * decided the same way, and the error would fall only with the size of the patches; and
 * the decision would depend on the last bit, so a rotated scene would get other
 * factors. */
#include "tools/viewfactors/viewfactor.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/elementary.h"
#include "geom/hash.h"
#include "geom/stop.h"
#include "rad/id.h"
#include "geom/contour.h"
#include "tools/viewfactors/screened.h"

/* Greatest error of a part of a patch past few blockers, in parts of the threshold. */
static const double FINER = 0.1;

/* Standard error of a visible fraction: of 0 or 1 by the agreement of 16 segments with
 * the same light, of 0 or 1 by the agreement of points with exact views, and of one of
 * which no segment tells. */
static const double ERROR_AGREED = 0.1, ERROR_SEEN = 0.02, ERROR_UNKNOWN = 0.5;

/* Standard errors in a limit. */
static const double LIMIT = 3.0;

/* No error but 0 is stated below this one: there, differences of sums tell little, and
 * sums over parts are as good as this, relative to the sums. */
static const double LEAST = 1e-5;

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
    double variance;        /* of those sampled, square scene units squared */
    double error;           /* limit of those past screens, square scene units */
    int32_t blocker;        /* the last triangle to stop a segment */
};

/* The visible part of an exchange as found by 16 segments. */
struct visible {
    double fraction; /* 0 to 1, and exactly 0 or 1 if all agree */
    double variance; /* of the fraction as a random sample */
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
    factors->errors = alloc_array((size_t)factors->pairs, sizeof *factors->errors);
    factors->done = alloc_array((size_t)factors->pairs, sizeof *factors->done);
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
    alloc_free(factors->errors);
    alloc_free(factors->done);
    alloc_free(factors);
}

/* --- one pair of roots --- */

static double square(double x)
{
    return x * x;
}

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

/* Returns the light carried by a segment, up to a constant: cos cos' / (pi r^2 + A), with
 * A a quarter of the larger area, lest close ends outweigh all others. 0 below a
 * horizon. */
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

/* Returns the sum of squares by which the light seen from each of the ends on one side is
 * off the fraction, for the variance of their mean. */
static double spread_of(const double *seen, const double *all, double fraction)
{
    double sum = 0.0;
    for (int k = 0; k < BUNDLE_ENDS; k++)
        sum += square(seen[k] - fraction * all[k]);
    return sum * BUNDLE_ENDS / (BUNDLE_ENDS - 1);
}

static double squares_of(const double *numbers)
{
    double sum = 0.0;
    for (int k = 0; k < BUNDLE_ENDS; k++)
        sum += square(numbers[k]);
    return sum;
}

/* Returns the visible fraction of 16 segments; `otherwise` if no segment faces both
 * patches. Segments have ends in common, so there are 4 and 4 independent numbers, not
 * 16; fewer, where some ends carry most of the light. */
static struct visible sample_pair(struct root_pair *pair, const struct piece *p,
                                  const struct piece *q, double otherwise)
{
    struct bundle bundle = {.own = {p->facet.input, q->facet.input}};
    uint64_t seed =
        hash_finish(hash_mix(id_number(p->id)) + 3 * hash_mix(id_number(q->id)));
    points_of(p, seed, bundle.from);
    points_of(q, ~seed, bundle.to);
    double weights[BUNDLE_RAYS], all_p[BUNDLE_ENDS] = {0.0}, all_q[BUNDLE_ENDS] = {0.0};
    double seen_p[BUNDLE_ENDS] = {0.0}, seen_q[BUNDLE_ENDS] = {0.0};
    double all = 0.0, seen = 0.0;
    for (int ray = 0; ray < BUNDLE_RAYS; ray++) {
        weights[ray] = weight_of(p, q, bundle.from[ray / BUNDLE_ENDS],
                                 bundle.to[ray % BUNDLE_ENDS]);
        bundle.asked |= (unsigned)(weights[ray] > 0.0) << ray;
    }
    if (bundle.asked == 0)
        return (struct visible){otherwise, square(ERROR_UNKNOWN)};
    unsigned blocked = octree_block(pair->factors->octree, &bundle, &pair->blocker,
                                    &pair->factors->counts);
    for (int ray = 0; ray < BUNDLE_RAYS; ray++) {
        double w = weights[ray], s = blocked >> ray & 1u ? 0.0 : w;
        all += w;
        seen += s;
        all_p[ray / BUNDLE_ENDS] += w;
        all_q[ray % BUNDLE_ENDS] += w;
        seen_p[ray / BUNDLE_ENDS] += s;
        seen_q[ray % BUNDLE_ENDS] += s;
    }
    double few = BUNDLE_ENDS * fmax(squares_of(all_p), squares_of(all_q)) / square(all);
    struct visible visible = {seen / all, square(ERROR_AGREED * few)};
    if (visible.fraction > 0.0 && visible.fraction < 1.0)
        visible.variance = (spread_of(seen_p, all_p, visible.fraction) +
                            spread_of(seen_q, all_q, visible.fraction)) / square(all);
    return visible;
}

static struct piece piece_child(const struct piece *piece, int child)
{
    struct piece part = *piece;
    part.facet.triangle = triangle_child(&piece->facet.triangle, child);
    part.facet.area = 0.25 * piece->facet.area;
    part.id = id_child(piece->id, child);
    return part;
}

/* Returns the side of the larger patch, 0 or 1, or -1 if neither may be split. Areas
 * different by rounding count as equal, lest a rotated scene gets other patches. */
static int side_to_split(const struct root_pair *pair, const struct piece *p,
                         const struct piece *q)
{
    bool may_p = id_level(p->id) < pair->factors->max_level;
    bool may_q = id_level(q->id) < pair->factors->max_level;
    bool p_first = p->facet.area > (1.0 - 1e-6) * q->facet.area;
    return may_p && (p_first || !may_q) ? 0 : may_q ? 1 : -1;
}

static void add_exchange(struct root_pair *pair, double exchange)
{
    pair->sum += flux_from_watts(pair->unit, exchange);
    pair->factors->links++;
}

/* Adds the exchange of p and q, G without blockers, if few triangles stand between them.
 * False if not. */
static bool add_past_few(struct root_pair *pair, const struct piece *p,
                         const struct piece *q, double open)
{
    const struct octree *octree = pair->factors->octree;
    bool p_views = p->facet.area <= (1.0 + 1e-6) * q->facet.area;
    const struct facet *viewer = p_views ? &p->facet : &q->facet,
                       *target = p_views ? &q->facet : &p->facet;
    const int32_t own[2] = {viewer->input, target->input};
    int32_t blockers[SCREENS_MAX];
    struct screened past = {open, 0.0, false};
    double tolerance = FINER * pair->threshold;
    int32_t count = octree_list_shaft(octree, &viewer->triangle, &viewer->plane,
                                      &target->triangle, &target->plane, own, blockers,
                                      SCREENS_MAX, &pair->factors->counts);
    if (count > SCREENS_MAX ||
        (count > 0 && !screened_exchange(viewer, target, pair->factors->scene->triangles,
                                         blockers, count, open, tolerance, &past)))
        return false;
    double doubt = past.agreed ? ERROR_SEEN * open : 0.0;
    if (doubt > tolerance)
        return false;
    add_exchange(pair, past.exchange);
    pair->error += past.error;
    pair->variance += square(doubt);
    return true;
}

/* True if it is proved that nothing stands between p and q. */
static bool are_open(struct root_pair *pair, const struct piece *p, const struct piece *q)
{
    const int32_t own[2] = {p->facet.input, q->facet.input};
    int32_t blocker;
    return octree_list_shaft(pair->factors->octree, &p->facet.triangle, &p->facet.plane,
                             &q->facet.triangle, &q->facet.plane, own, &blocker, 1,
                             &pair->factors->counts) == 0;
}

/* Adds the exchange of p and q. `parents`: the visible fraction of their parents'
 * pair. */
static void add_pair(struct root_pair *pair, const struct piece *p, const struct piece *q,
                     double parents)
{
    if (stop_is_asked() || !facets_face(&p->facet, &q->facet))
        return;
    double open = triangle_exchange(&p->facet.triangle, &q->facet.triangle);
    bool small = open <= pair->threshold;
    if (!(open > 0.0) || (!small && add_past_few(pair, p, q, open)))
        return;
    struct visible visible = sample_pair(pair, p, q, parents);
    int side = small ? -1 : side_to_split(pair, p, q);
    if (side >= 0 && visible.fraction == 0.0 &&
        facets_are_walled_off(&p->facet, &q->facet, pair->factors->octree,
                              &pair->factors->counts))
        return;
    if (side < 0) {
        add_exchange(pair, visible.fraction * open);
        if (visible.fraction == 1.0 && are_open(pair, p, q))
            return;
        double near = ERROR_AGREED + open / fmin(p->facet.area, q->facet.area);
        pair->variance += fmax(visible.variance, square(fmin(near, ERROR_UNKNOWN))) *
                          square(open);
        return;
    }
    pair->variance += square(LEAST * open);
    for (int k = 0; k < 4; k++) {
        struct piece part = piece_child(side == 0 ? p : q, k);
        add_pair(pair, side == 0 ? &part : p, side == 0 ? q : &part, visible.fraction);
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

/* Returns the unit of the variance of G_ij: no error is larger than the bound of G_ij. */
static struct flux_unit error_unit_of(const struct viewfactors *factors, int32_t i,
                                      int32_t j)
{
    return flux_unit_for(square(unit_of(factors, i, j).watt * (double)FLUX_LIMIT));
}

void viewfactors_add(struct viewfactors *factors, int32_t p, const struct facet *fp,
                     int32_t q, const struct facet *fq)
{
    int32_t i = factors->scene->groups.of[fp->input],
            j = factors->scene->groups.of[fq->input];
    int64_t place = place_of(factors, i, j);
    if (factors->done[place])
        return;
    struct root_pair pair = {
        .factors = factors,
        .threshold = factors->epsilon * fmin(factors->areas[i], factors->areas[j]),
        .unit = unit_of(factors, i, j),
        .blocker = -1,
    };
    struct piece piece_p = {*fp, id_of_root((uint32_t)p)},
                 piece_q = {*fq, id_of_root((uint32_t)q)};
    add_pair(&pair, &piece_p, &piece_q, 1.0);
    factors->sums[place] += pair.sum;
    factors->errors[place] += flux_from_watts(
        error_unit_of(factors, i, j), pair.variance + square(pair.error / LIMIT));
}

void viewfactors_set(struct viewfactors *factors, int32_t i, int32_t j, double exchange,
                     double variance)
{
    int64_t place = place_of(factors, i, j);
    double ways = i == j ? 2.0 : 1.0; /* see exchange_between() */
    factors->sums[place] = flux_from_watts(unit_of(factors, i, j), exchange / ways);
    factors->errors[place] =
        flux_from_watts(error_unit_of(factors, i, j), variance / (ways * ways));
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

double viewfactors_row(const struct viewfactors *factors, int32_t i)
{
    double sum = 0.0;
    for (int32_t j = 0; j < factors->count; j++)
        sum += viewfactors_factor(factors, i, j);
    return sum;
}

/* Returns the standard error of F_ij or F_ji, whichever is larger. */
static double error_between(const struct viewfactors *factors, int32_t i, int32_t j)
{
    double area = fmin(factors->areas[i], factors->areas[j]);
    double variance = flux_to_watts(error_unit_of(factors, i, j),
                                    factors->errors[place_of(factors, i, j)]);
    return area > 0.0 ? (i == j ? 2.0 : 1.0) * sqrt(variance) / area : 0.0;
}

/* Returns how many standard errors the largest of all errors is at most. */
static double largest_of_all(const struct viewfactors *factors)
{
    int64_t uncertain = 0;
    for (int64_t k = 0; k < factors->pairs; k++)
        uncertain += factors->errors[k] > 0;
    return sqrt(4.0 + 2.0 * logarithm(fmax(1.0, (double)uncertain)));
}

double viewfactors_error(const struct viewfactors *factors)
{
    double largest = 0.0;
    for (int32_t i = 0; i < factors->count; i++)
        for (int32_t j = i; j < factors->count; j++)
            largest = fmax(largest, error_between(factors, i, j));
    return largest > 0.0 ? fmax(LEAST, largest_of_all(factors) * largest) : 0.0;
}

void viewfactors_refine(struct viewfactors *factors, double accuracy)
{
    double most = accuracy / largest_of_all(factors);
    double ratio = 0.5 * accuracy / viewfactors_error(factors);
    for (int32_t i = 0; i < factors->count; i++)
        for (int32_t j = i; j < factors->count; j++) {
            int64_t place = place_of(factors, i, j);
            factors->done[place] = error_between(factors, i, j) <= most;
            if (!factors->done[place])
                factors->sums[place] = factors->errors[place] = 0;
        }
    factors->epsilon *= fmax(1.0 / 16.0, fmin(0.25, ratio));
}
