/* Aiming at lamps and at bright patches, from a receiver of the final gather.
 *
 * Rays that leave a receiver in all directions rarely meet a lamp, which is where most of
 * their noise would come from. Lamps (rad/beyond/lamps.c) are aimed at by segments, in
 * proportion to the light that they would bring unoccluded, which is known from exact
 * factors.
 *
 * Next come bright patches, those that reflect more than a lamp emits at least, be they
 * roots or the parts of a wall beside a lamp: the inside of a lamp's housing sends a
 * tenth of the light of a furnished room and brings most of the variance, as one ray in
 * 500 meets it. Rays are aimed at them, too. */
#include "rad/beyond/receiver.h"

#include <math.h>
#include <string.h>

#include "geom/hash.h"
#include "geom/lambert.h"
#include "rad/beyond/gather_narrow.h"
#include "rad/beyond/gather_regions.h"
#include "rad/beyond/lamps_seen.h"
#include "rad/beyond/sample.h"
#include "rad/beyond/sequence.h"

/* A lamp is wide if its factor from the receiver, unoccluded, is more than this. Points
 * of pixels are few, so that cutting takes less time there, and noise shows. */
static const double WIDE = 0.05, WIDE_AT_POINTS = 0.03;

/* A lamp is near if the square of its distance is less than this times its area. */
static const double NEAR_LAMP = 4.0;

/* For each ray in all directions there are as many that are aimed at bright patches as
 * these send of the reflected light, at least so many. */
static const double AIMED_LEAST = 0.25;

/* Fewest segments that are enough to estimate the visible share of lamps; fewest for a
 * lamp of less than WIDE to be cut; most tries for a point of a lamp above the
 * horizon. */
enum { VOLLEY = 4, CUTS_LEAST = 8, AIMS_MOST = 16 };

static const struct rgb ALL = {{1.0, 1.0, 1.0}};

void receiver_add_near(struct receiver *r, const struct rgb *weight, struct rgb emission,
                       double factor)
{
    struct gather_nears *near = &r->gather->near;
    for (int c = 0; c < BANDS && r->near >= 0; c++)
        near->paths[near->path_count - 1].light.band[c] +=
            weight->band[c] * factor * emission.band[c];
}

void receiver_add_source(struct receiver *r, const struct rgb *weight,
                         struct rgb emission, double factor)
{
    receiver_add_near(r, weight, emission, factor);
    for (int c = 0; c < BANDS; c++) {
        double h = weight->band[c] * factor * emission.band[c];
        r->row.source.band[c] += h;
        r->light.band[c] += h;
    }
}

/* Adds a lamp that has this form factor. */
static void add_lamp(struct receiver *r, struct rgb emission, double factor)
{
    r->shares.lit += factor;
    receiver_add_source(r, &ALL, emission, factor);
}

/* The triangle that blocks a segment to a lamp, or -1. */
static inline int32_t blocker_of(struct receiver *r, struct vec3 from, int32_t input,
                                 struct vec3 to, int32_t lamp)
{
    int32_t own[2] = {input, scene_input_of(r->gather->model->scene, lamp)}, guess = -1;
    r->gather->counts.segments++;
    return octree_blocks_segment(r->gather->model->octree, from, to, own, &guess,
                                 &r->gather->model->counts)
               ? guess
               : -1;
}

int32_t receiver_blocker(struct receiver *r, struct vec3 x, struct vec3 y, int32_t lamp)
{
    int32_t input = r->facet.input;
    if (r->points && r->points->above) {
        const struct scene *scene = r->gather->model->scene;
        struct segment segment = segment_make(x, y);
        if (segment_is_blocked_by(&segment, &scene->triangles[input],
                                  &scene->planes[input]))
            return input;
    }
    return blocker_of(r, x, input, y, lamp);
}

int32_t receiver_first_blocker(struct receiver *r, struct vec3 x, struct vec3 y,
                               int32_t lamp)
{
    struct model *model = r->gather->model;
    int32_t blocker = receiver_blocker(r, x, y, lamp);
    struct octree_hit hit;
    if (blocker >= 0 && blocker != r->facet.input &&
        octree_first_hit(model->octree, point_above(x, r->facet.plane.normal),
                         vec3_sub(y, x), false, &hit, &model->counts) &&
        hit.triangle != r->facet.input &&
        hit.triangle != scene_input_of(model->scene, lamp))
        blocker = hit.triangle;
    return blocker;
}

/* Segments to groups that are next to each other in the tree, in two halves. */
struct volley {
    double direct[2]; /* light without blockers, about, over all bands, W/m^2 */
    double seen[2];   /* light with them */
    int count[2];     /* segments */
    double direct2, seen2, both; /* sums over segments of `direct` and `seen` squared, and
                                    of their product */
};

/* Adds a segment to a half. */
static void add_segment(struct volley *volley, int half, double direct, double seen)
{
    volley->direct[half] += direct;
    volley->seen[half] += seen;
    volley->count[half]++;
    volley->direct2 += direct * direct;
    volley->seen2 += seen * seen;
    volley->both += direct * seen;
}

/* Adds the segments of another, their light times `scale`. */
static void add_volley(struct volley *volley, const struct volley *other, double scale)
{
    for (int half = 0; half < 2; half++) {
        volley->direct[half] += scale * other->direct[half];
        volley->seen[half] += scale * other->seen[half];
        volley->count[half] += other->count[half];
    }
    volley->direct2 += scale * scale * other->direct2;
    volley->seen2 += scale * scale * other->seen2;
    volley->both += scale * scale * other->both;
}

/* The half that segment `i` of `count` to a group belongs to; a single one, the
 * smaller. */
static int half_of(const struct volley *volley, int i, int count)
{
    return count > 1 ? 2 * i >= count : volley->count[0] > volley->count[1];
}

/* Adds the variance of the volley's light, in the colour of one of its lamps: as if by
 * chance, by how far single segments are from the mean share that is seen, and by the
 * difference of its halves. */
static void end_volley(struct receiver *r, struct volley *volley, struct rgb light)
{
    double direct = volley->direct[0] + volley->direct[1], apart = 0.0;
    double share = direct > 0.0 ? (volley->seen[0] + volley->seen[1]) / direct : 0.0;
    double variance =
        volley->seen2 + share * (share * volley->direct2 - 2.0 * volley->both);
    r->shares.direct += direct;
    if (volley->direct[0] > 0.0 && volley->direct[1] > 0.0)
        apart = 0.5 * (volley->seen[0] / volley->direct[0] -
                       volley->seen[1] / volley->direct[1]);
    for (int c = 0; c < BANDS && share > 0.0; c++) {
        double part = light.band[c] / rgb_sum(light), h = direct * part;
        r->row.chance[c] += part * part * fmax(0.0, variance);
        r->row.halves[c] += h * h * apart * apart;
    }
    *volley = (struct volley){.direct = {0.0, 0.0}};
}

/* The sequence of the segments to a node. Patches that are no roots have other numbers on
 * other ranks, and the same IDs. */
static struct sequence sequence_to(const struct receiver *r, int32_t node)
{
    const struct forest *forest = r->gather->model->forest;
    uint64_t number = node < forest->root_count ? (uint64_t)node
                                                : id_number(forest->patches[node].id);
    return sequence_start(hash_mix(r->seed + 8) ^ hash_mix(number));
}

/* Fires `count` segments, from number `first` of the sequence on, at a lamp: without
 * blockers they bring the irradiance `direct` all together, summed over bands, each in
 * proportion to its kernel. Points below a horizon are passed over, or the light would be
 * lost where all of few are. */
static void aim_at_lamp(struct receiver *r, const struct sequence *sequence, int first,
                        int count, int32_t root, double direct, struct volley *volley)
{
    const struct scene *scene = r->gather->model->scene;
    struct triangle lamp = scene_root_triangle(scene, root);
    struct vec3 normal = scene_root_plane(scene, root).normal;
    struct rgb emission = scene_root_material(scene, root)->emission;
    struct volley own = {.direct = {0.0, 0.0}};
    double u[SEQUENCE_DIMENSIONS];
    for (int i = 0, fired = 0; fired < count && i < AIMS_MOST * count; i++) {
        sequence_point(sequence, (uint32_t)(first + i), u);
        struct vec3 x = receiver_start(r, u[0], u[1]);
        struct vec3 y = triangle_of_square(&lamp, u[2], u[3]);
        double light = receiver_kernel(x, r->facet.plane.normal, y, normal);
        if (!(light > 0.0))
            continue;
        bool hidden = receiver_blocker(r, x, y, root) >= 0;
        add_segment(&own, half_of(volley, fired++, count), light, hidden ? 0.0 : light);
    }
    double all = own.direct[0] + own.direct[1], seen = own.seen[0] + own.seen[1];
    double factor = direct / rgb_sum(emission);
    r->shares.doubt += seen < all || !(all > 0.0) ? factor : 0.0;
    if (!(all > 0.0))
        return;
    add_volley(volley, &own, direct / all);
    add_lamp(r, emission, factor * (seen / all));
}

/* The same for a wide lamp, whose variance is known. */
static void aim_at_wide_lamp(struct receiver *r, int count, int32_t root, double direct)
{
    struct sequence sequence = sequence_to(r, root);
    struct rgb emission = scene_root_material(r->gather->model->scene, root)->emission;
    struct receiver_share share = receiver_share_of_wide(r, &sequence, count, root);
    double factor = direct / rgb_sum(emission);
    add_lamp(r, emission, factor * share.seen);
    r->shares.direct += direct;
    r->shares.doubt += share.seen < 1.0 ? factor : 0.0;
    for (int c = 0; c < BANDS; c++) {
        double h = direct * emission.band[c] / rgb_sum(emission);
        r->row.chance[c] += h * h * share.variance;
        r->row.halves[c] += h * h * share.halves;
    }
}

/* Aims one ray at a bright patch of a group: it stands for `share` of its light. */
static void look_at_one(struct receiver *r, int32_t patch, double share,
                        const double u[SEQUENCE_DIMENSIONS], uint64_t seed)
{
    struct facet facet = facet_make(r->gather->model->forest, patch);
    struct vec3 x = receiver_start(r, u[0], u[1]);
    struct vec3 y = triangle_of_square(&facet.triangle, u[2], u[3]);
    double factor = facet.area * receiver_kernel(x, r->facet.plane.normal, y,
                                                 facet.plane.normal);
    if (factor > 0.0)
        receiver_look_at(r, x, y, patch, share * factor, seed);
}

/* Fires one segment, number `index` of the sequence, at a lamp of a group: it stands for
 * `share` of the lamp's light. */
static void aim_at_one(struct receiver *r, const struct sequence *sequence, int index,
                       int32_t root, double share)
{
    const struct forest *forest = r->gather->model->forest;
    struct facet lamp = facet_make(forest, root);
    struct volley alone = {.direct = {0.0, 0.0}};
    if (!facets_face(&r->facet, &lamp))
        return;
    double factor = mean_factor(&r->facet.triangle, r->facet.plane.normal, &lamp.triangle,
                                &r->gather->model->estimating);
    double sent = rgb_sum(forest_material(forest, root)->emission);
    aim_at_lamp(r, sequence, index, 1, root, share * factor * sent, &alone);
}

/* Fires `count` of them at a group; unoccluded they bring `direct` all together. They are
 * spread evenly over its power, and each half of them is. */
static void aim_at_group(struct receiver *r, const struct lamps *lamps,
                         const struct lamp_group *group, int count, double direct,
                         struct volley *volley)
{
    struct sequence sequence = sequence_to(r, group->node);
    bool single = !node_is_cluster(group->node) && !lamps->reflect;
    double start = hash_unit(sequence.scramble[0]);
    if (single)
        aim_at_lamp(r, &sequence, 0, count, group->node, direct, volley);
    for (int k = 0; k < count && !single; k++) {
        int half = half_of(volley, k, count);
        double place = (lamp_place(k, count) + start) / count;
        struct lamp lamp = lamp_choose(lamps, group->node, place);
        double before = rgb_sum(r->light), u[SEQUENCE_DIMENSIONS];
        double share = lamp.share * direct / (group->direct * count);
        sequence_point(&sequence, (uint32_t)k, u);
        if (lamps->reflect)
            look_at_one(r, lamp.patch, share, u,
                        hash_mix(sequence.scramble[1] + (uint64_t)k));
        else
            aim_at_one(r, &sequence, k, lamp.patch, share);
        add_segment(volley, half, direct / count, rgb_sum(r->light) - before);
    }
}

/* With few segments to find its blockers by, a wide lamp is noisy. */
static bool is_wide(const struct receiver *r, const struct lamps *lamps,
                    const struct lamp_group *group, int count)
{
    double least = r->points && count >= CUTS_LEAST ? WIDE_AT_POINTS : WIDE;
    return !lamps->reflect && !node_is_cluster(group->node) &&
           group->direct > least * lamps->sent[group->node];
}

/* Segments that are still to be dealt, one for each so much light. */
struct dealing {
    double each; /* W/m^2 */
    double sum;  /* light of the groups so far, in segments, from a chance start on */
};

/* Returns the number of segments of the next group, which brings the light `direct`. */
static int deal(struct dealing *dealing, double direct)
{
    double before = floor(dealing->sum);
    dealing->sum += direct / dealing->each;
    return (int)(floor(dealing->sum) - before);
}

/* The irradiance that lamps can bring to a patch: that which it has. */
static double most_light(const struct forest *forest, int32_t patch)
{
    double h = patch_irradiance(forest, patch);
    return h > 0.0 ? h : HUGE_VAL; /* NaN if it is black */
}

/* Segments are dealt to the groups in proportion to the light that they can bring: lamps
 * behind walls, however bright, leave some for those in the room. A group that is sure to
 * get one counts with its own light, shared among its segments. The others are dealt
 * theirs apart, a whole number, so that together they count with their own light. Where
 * a share is seen from around, the variance is that of chance by this share at least: all
 * of few segments may miss, which would seem sure. */
void receiver_aim_at(struct receiver *r, struct lamps *lamps)
{
    bool dark = !lamps->reflect && receiver_is_in_the_dark(r);
    int most = lamps->reflect ? (int)ceil(r->rays * fmax(AIMED_LEAST, lamps->part))
               : dark         ? r->gather->rays
                              : r->segments;
    r->shares.doubt += dark || (!lamps->reflect && !lamps->alike) ? 1.0 : 0.0;
    lamps_group(lamps, &r->facet, most,
                most_light(r->gather->model->forest, r->row.leaf),
                &r->gather->model->estimating);
    if (r->points && !lamps->reflect)
        receiver_weigh_groups(r, lamps, most);
    const struct lamp_groups *groups = &lamps->groups;
    if (!(groups->worth > 0.0))
        return;
    double each = groups->worth / most, start = hash_unit(r->seed + 16), faint = 0.0;
    for (int64_t i = 0; i < groups->count; i++)
        faint += groups->items[i].worth < each ? groups->items[i].worth : 0.0;
    struct dealing strong = {each, start}, weak = {faint / ceil(faint / each), start};
    struct volley volley = {.direct = {0.0, 0.0}};
    struct rgb light = {{0.0, 0.0, 0.0}}, around = light;
    for (int64_t i = 0; i < groups->count; i++) {
        const struct lamp_group *group = &groups->items[i];
        bool sure = group->worth >= each;
        int count = group->worth > 0.0 ? deal(sure ? &strong : &weak, group->worth) : 0;
        if (count == 0)
            continue;
        double direct =
            group->direct * (sure ? 1.0 : count * weak.each / group->worth);
        if (is_wide(r, lamps, group, count)) {
            aim_at_wide_lamp(r, count, group->node, direct);
            continue;
        }
        if (dark) {
            receiver_aim_from(r, lamps, group->node, count, direct / group->direct);
            continue;
        }
        aim_at_group(r, lamps, group, count, direct, &volley);
        light = lamp_light(lamps, lamp_choose(lamps, group->node, 0.5).patch);
        double squares = direct * direct / count * group->seen * (1.0 - group->seen);
        for (int c = 0; c < BANDS && squares > 0.0; c++) {
            double part = light.band[c] / rgb_sum(light);
            around.band[c] += part * part * squares;
        }
        if (volley.count[0] + volley.count[1] >= VOLLEY)
            end_volley(r, &volley, light);
    }
    end_volley(r, &volley, light);
    for (int c = 0; c < BANDS; c++)
        r->row.chance[c] = fmax(r->row.chance[c], around.band[c]);
}

bool receiver_lamp_is_near(const struct scene *scene, int32_t lamp, struct vec3 x)
{
    struct triangle t = scene_root_triangle(scene, lamp);
    struct vec3 apart = vec3_sub(triangle_centroid(&t), x);
    return vec3_dot(apart, apart) < NEAR_LAMP * scene_root_area(scene, lamp);
}

/* The lamp and a point of it are chosen by hashes; of a lamp that the horizon cuts, a
 * point above it. Light that walls may keep off counts for no more than comes to the
 * patch as the links have it. */
void receiver_aim_beside(struct receiver *r, struct vec3 x, struct vec3 normal,
                         int32_t patch, const struct rgb *weight, uint64_t seed)
{
    const struct final_gather *g = r->gather;
    const struct forest *forest = g->model->forest;
    const struct scene *scene = g->model->scene;
    int32_t input = scene_input_of(scene, (int32_t)forest->patches[patch].id.root);
    struct lamp lamp = lamp_choose_at(&g->lamps, x, normal, most_light(forest, patch),
                                      hash_unit(seed));
    if (lamp.patch < 0 || receiver_lamp_is_near(scene, lamp.patch, x))
        return;
    struct triangle triangle = scene_root_triangle(scene, lamp.patch);
    struct vec3 facing = scene_root_plane(scene, lamp.patch).normal;
    struct rgb emission = scene_root_material(scene, lamp.patch)->emission;
    double factor = point_triangle_factor(x, normal, &triangle);
    uint64_t at = seed + 2;
    for (int k = 0; k < AIMS_MOST && factor > 0.0; k++, at = hash_mix(at)) {
        struct vec3 y = triangle_of_square(&triangle, hash_unit(at), hash_unit(at + 1));
        if (!(receiver_kernel(x, normal, y, facing) > 0.0))
            continue;
        if (blocker_of(r, x, input, y, lamp.patch) < 0)
            receiver_add_source(r, weight, emission, factor * lamp.share);
        return;
    }
}

void receiver_aim(struct receiver *r)
{
    receiver_aim_at(r, &r->gather->lamps);
    r->lamps = r->light;
    r->light = (struct rgb){{0.0, 0.0, 0.0}};
    memcpy(r->row.of_segments, r->row.chance, sizeof r->row.of_segments);
}
