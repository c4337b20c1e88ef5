/* Light through narrow openings.
 *
 * Below a door light comes from the next room, where all is a thousand times as bright,
 * and one ray in ten thousand finds it. For a leaf all that is lit there is a lamp,
 * whatever it is in the whole scene. So a large region in the dark (gather_regions.c) is
 * examined once: which bright regions can be seen from it past the blockers that a few
 * segments find, as with wide lamps (gather_wide.c)? Of small ones, as of furniture, it
 * is asked which of those they see. At these the leaves of a region aim, each at the
 * remainder of the bright one behind the blockers, and rays that meet one are put aside,
 * as with bright patches. The examination decides only how light is looked for, and from
 * other points, so answers are right in the mean.
 *
 * Of a region that is behind many things, such as furniture, not just a few walls, too
 * much stays hidden in the remainder: if no point of it is seen, it is left to rays. */
#include "rad/beyond/gather_narrow.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/hash.h"
#include "rad/beyond/gather_regions.h"
#include "rad/beyond/remainder.h"

/* Regions examined, those that send most; points from which each is looked at, or until
 * SEEN past known blockers; points of a leaf, least and most. */
enum { MOST_REGIONS = 64, POINTS_LOOKED = 256, SEEN = 8 };
enum { POINTS = 64, MOST_POINTS = 256 };

/* From a leaf beside a wall of 75 m that is seen along it, most of the factor is that of
 * some centimetres. */
enum { QUARTERINGS = 16 };

/* A region is worth aiming at if fewer rays than this find it. */
static const double WORTH = 16.0;

/* A leaf has MOST_POINTS where the factor of a remainder is more than this. */
static const double PEAK = 0.04;

struct opening {
    int32_t region; /* that is seen through it */
    struct remainder remainder;
};

/* Regions that are aimed at from the leaves of one region. */
struct openings {
    struct opening *items; /* [count] */
    int64_t count, capacity;
    int32_t from;   /* region; -1: none yet */
    uint8_t *aimed; /* [patches] 1: one of the items */
    int32_t *known; /* [known_count] regions that large ones in the dark aim at */
    int64_t known_count, known_capacity;
};

bool receiver_is_in_the_dark(const struct receiver *r)
{
    struct final_gather *g = r->gather;
    return r->keeps && (patch_is_dark(g, r->row.leaf) ||
                        patch_is_dark(g, region_of(g, r->row.leaf)));
}

/* --- the view of a region --- */

static double watts_of(const struct forest *forest, int32_t patch)
{
    return forest_area(forest, patch) * patch_reflected(forest, patch);
}

/* Finds the regions that reflect DARK_TIMES the irradiance, of those that the receiver
 * faces but is not in the dark with, largest senders first; [MOST_REGIONS]. Candidates
 * are those of `among`, [among_count]. Returns their number. */
static int find_bright(struct final_gather *g, const struct facet *receiver,
                       double irradiance, const int32_t *among, int64_t among_count,
                       int32_t *bright)
{
    const struct forest *forest = g->model->forest;
    int count = 0;
    for (int64_t i = 0; i < among_count; i++) {
        int32_t region = among[i];
        if (!(patch_reflected(forest, region) > DARK_TIMES * irradiance) ||
            region_is_dark(g, region))
            continue;
        struct facet facet = facet_make(forest, region);
        double watts = watts_of(forest, region);
        if (!facets_face(receiver, &facet) ||
            (count == MOST_REGIONS && watts <= watts_of(forest, bright[count - 1])))
            continue;
        int at = count < MOST_REGIONS ? count++ : count - 1;
        for (; at > 0 && watts > watts_of(forest, bright[at - 1]); at--)
            bright[at] = bright[at - 1];
        bright[at] = region;
    }
    return count;
}

/* Looks from a point `x` of the receiver at a point `y` of the remainder: returns the
 * weight of y, its kernel over the density at which it was chosen; in the mean that is
 * the factor of all that is seen, and light that differs over the remainder has the right
 * mean. 0: nothing is seen. */
static double look(struct receiver *r, struct remainder *remainder,
                   const struct sequence *sequence, int index, struct vec3 *x,
                   struct vec3 *y)
{
    struct vec3 normal = r->facet.plane.normal;
    double u[SEQUENCE_DIMENSIONS], density;
    sequence_point(sequence, (uint32_t)index, u);
    *x = receiver_start(r, u[0], u[1]);
    double seen = remainder_look(remainder, r->gather->model->scene, *x, normal);
    r->gather->model->estimating += 1 + remainder->count;
    if (!(seen > 0.0))
        return 0.0;
    *y = remainder_point(remainder, QUARTERINGS, u[2], u[3], &density);
    double kernel = receiver_kernel(*x, normal, *y, remainder->plane.normal);
    return density > 0.0 ? kernel / density : 0.0;
}

/* True if the remainder of a region can be seen from the receiver, and is so small that
 * few points of it tell more than many rays in all directions. It is looked at from
 * POINTS at least: one of them in the opening itself may see much of it. */
static bool is_worth_aiming(struct receiver *r, struct opening *opening)
{
    struct remainder *remainder = &opening->remainder;
    struct sequence sequence = sequence_start(
        hash_mix(r->seed) ^ patch_seed(r->gather->model->forest, opening->region));
    double sum = 0.0;
    int i = 0, passed = 0; /* since a blocker was learnt */
    for (; i < POINTS_LOOKED && (passed < SEEN || i < POINTS); i++) {
        struct vec3 x, y;
        double weight = look(r, remainder, &sequence, i, &x, &y);
        int32_t blocker =
            weight > 0.0 ? receiver_first_blocker(r, x, y, remainder->root) : -1;
        if (blocker >= 0 &&
            remainder_learn(remainder, r->gather->model->scene, blocker)) {
            passed = 0;
            i--;
            continue;
        }
        sum += blocker < 0 ? weight : 0.0;
        passed += weight > 0.0 && blocker < 0;
    }
    return passed > 0 && sum * r->gather->rays < WORTH * i;
}

static void make_known(struct openings *openings, int32_t region)
{
    for (int64_t i = 0; i < openings->known_count; i++)
        if (openings->known[i] == region)
            return;
    RESERVE(openings->known, &openings->known_capacity, openings->known_count + 1);
    openings->known[openings->known_count++] = region;
}

/* Each rank that has a leaf of the region finds the same. */
static void examine_region(struct openings *openings, struct receiver *whole,
                           int32_t region)
{
    struct final_gather *g = whole->gather;
    struct apart apart = apart_begin(g);
    struct opening opening = {region, remainder_start(g->model->forest, region)};
    if (is_worth_aiming(whole, &opening)) {
        RESERVE(openings->items, &openings->capacity, openings->count + 1);
        openings->items[openings->count++] = opening;
        openings->aimed[region] = 1;
        if (region_is_dark(g, openings->from))
            make_known(openings, region);
    }
    apart_end(g, &apart);
}

/* Large regions are all examined before the first row is made: gather_find_sparks(). */
static void find_openings(struct openings *openings, const struct receiver *r,
                          int32_t from)
{
    struct final_gather *g = r->gather;
    const struct forest *forest = g->model->forest;
    struct receiver whole = *r;
    for (int64_t i = 0; i < openings->count; i++)
        openings->aimed[openings->items[i].region] = 0;
    openings->from = from;
    openings->count = 0;
    bool large = region_is_dark(g, from);
    if (!large && !patch_is_dark(g, from))
        return;
    whole.facet = facet_make(forest, from);
    whole.seed = hash_mix(patch_seed(forest, from) + 32);
    int32_t bright[MOST_REGIONS];
    const struct regions *all = gather_regions(g);
    int count = find_bright(g, &whole.facet, patch_irradiance(forest, from),
                            large ? all->items : openings->known,
                            large ? all->count : openings->known_count, bright);
    for (int i = 0; i < count; i++)
        examine_region(openings, &whole, bright[i]);
}

/* --- the view of a leaf --- */

void receiver_find_openings(struct receiver *r)
{
    struct final_gather *g = r->gather;
    const struct forest *forest = g->model->forest;
    if (g->model->criterion.final_gather < POINTS || /* aiming would cost more */
        !receiver_is_in_the_dark(r))
        return;
    if (!g->view.openings) {
        g->view.openings = alloc_array(1, sizeof *g->view.openings);
        g->view.openings->aimed = alloc_array((size_t)forest->count, 1);
        g->view.openings->from = -1;
    }
    int32_t from = region_of(g, r->row.leaf);
    if (g->view.openings->from != from)
        find_openings(g->view.openings, r, from);
    r->dark.least = DARK_TIMES * fmin(patch_irradiance(forest, r->row.leaf),
                            patch_irradiance(forest, from));
}

bool openings_are_known(const struct final_gather *g)
{
    return g->view.openings && g->view.openings->count > 0;
}

static bool aims_at(const struct receiver *r, int32_t region)
{
    return patch_reflected(r->gather->model->forest, region) > r->dark.least;
}

bool receiver_aims_through(const struct receiver *r, int32_t leaf)
{
    struct final_gather *g = r->gather;
    if (!(r->dark.least >= 0.0))
        return false;
    int32_t region = region_of(g, leaf);
    return g->view.openings->aimed[region] && aims_at(r, region);
}

/* Points for a leaf: the more the more of the region is seen somewhere, as beside the
 * opening, where light falls on a small part of the leaf. */
static int points_for(struct receiver *r, struct remainder *remainder, uint64_t seed)
{
    struct sequence sequence = sequence_start(hash_mix(seed + 2));
    double most = 0.0, u[SEQUENCE_DIMENSIONS];
    for (uint32_t k = 0; k < POINTS; k++) {
        sequence_point(&sequence, k, u);
        most = fmax(most, remainder_look(remainder, r->gather->model->scene,
                                         receiver_start(r, u[0], u[1]),
                                         r->facet.plane.normal));
    }
    int points = POINTS;
    while (points < MOST_POINTS && points * PEAK < MOST_POINTS * most)
        points *= 2;
    return points;
}

/* Aims at one region, and adds the variance of its light. */
static void aim_at(struct receiver *r, struct opening *opening)
{
    struct remainder *remainder = &opening->remainder;
    uint64_t seed =
        hash_mix(r->seed + 40) ^ patch_seed(r->gather->model->forest, opening->region);
    struct sequence sequence = sequence_start(seed);
    int points = points_for(r, remainder, seed);
    struct rgb first = r->light, last = first, middle = first;
    for (int k = 0; k < points; k++) {
        struct vec3 x, y;
        struct rgb source = r->row.source;
        double weight = look(r, remainder, &sequence, k, &x, &y);
        if (weight > 0.0 && receiver_blocker(r, x, y, remainder->root) < 0) {
            receiver_see(r, remainder->root, y, weight / points,
                         hash_mix(seed ^ hash_mix((uint64_t)k)));
            receiver_catch(r, x, rgb_sub(r->row.source, source));
        }
        for (int c = 0; c < BANDS; c++) {
            double h = r->light.band[c] - last.band[c];
            r->row.chance[c] += h * h;
        }
        last = r->light;
        middle = 2 * k + 2 == points ? last : middle;
    }
    for (int c = 0; c < BANDS; c++) {
        double all = last.band[c] - first.band[c];
        double apart = 2.0 * (middle.band[c] - first.band[c]) - all;
        r->row.chance[c] = fmax(0.0, r->row.chance[c] - all * all / points);
        r->row.halves[c] += apart * apart;
    }
}

void receiver_aim_through(struct receiver *r)
{
    struct openings *openings = r->gather->view.openings;
    for (int64_t i = 0; r->dark.least >= 0.0 && i < openings->count; i++)
        if (aims_at(r, openings->items[i].region))
            aim_at(r, &openings->items[i]);
}

void openings_free(struct openings *openings)
{
    if (!openings)
        return;
    alloc_free(openings->items);
    alloc_free(openings->aimed);
    alloc_free(openings->known);
    alloc_free(openings);
}
