/* Light that lamps cast onto leaves in the dark.
 *
 * Through a slit or a pinhole a lamp in the next room lights a strip or a spot of a wide
 * leaf. Of the segments from points all over the leaf one in a hundred or fewer begins
 * there; where none does the leaf stays dark, and nothing tells so. But each blocked
 * segment names a blocker, and the part of the leaf that a blocker hides from a point y
 * of the lamp can be cut out exactly (remainder.h). So with all lamps of a group, of
 * power P, and n points y chosen by it, each from a lamp of emission E,
 *
 *     H  =  P / (n area)  sum of F(y, remainder of the leaf) V E / (sum over bands of E),
 *
 * where V tells whether a segment to the remainder passes. That is the light of wide
 * lamps (gather_wide.c) seen from the other end; as there, blockers are learnt by other
 * points y than those that the light is estimated at. All leaves of a root that have as
 * many points have the same ones, so that of each all of the light lands somewhere.
 * Behind more than BLOCKERS_MOST blockers V decides alone. */
#include "rad/beyond/receiver.h"

#include <math.h>

#include "geom/hash.h"
#include "rad/beyond/remainder.h"

/* Points of a group, at most; those that learn blockers for each of them; quarterings of
 * the remainder. */
enum { POINTS_MOST = 32, LEARNERS = 2, QUARTERINGS = 3 };

/* The light of one point of a lamp. */
struct spot {
    struct vec3 at;   /* where it lands on the leaf */
    struct rgb light; /* irradiance of the leaf, W/m^2 */
};

/* The factor of the part of the leaf that is seen from a point y of a lamp; `blocker`: of
 * the segment to the point `at` of it, or -1. */
static double look_from(struct receiver *r, struct remainder *leaf, int32_t root,
                        struct vec3 y, const double u[SEQUENCE_DIMENSIONS],
                        struct vec3 *at, int32_t *blocker)
{
    struct model *model = r->gather->model;
    struct vec3 facing = scene_root_plane(model->scene, root).normal;
    *blocker = -1;
    if (!(plane_distance(&r->facet.plane, y) > 0.0))
        return 0.0;
    double seen = remainder_look(leaf, model->scene, y, facing);
    model->estimating += 1 + leaf->count;
    if (!(seen > 0.0))
        return 0.0;
    *at = remainder_point(leaf, QUARTERINGS, u[2], u[3], NULL);
    if (!(receiver_kernel(*at, r->facet.plane.normal, y, facing) > 0.0))
        return 0.0;
    *blocker = receiver_first_blocker(r, *at, y, root);
    return *blocker < 0 ? seen : 0.0;
}

/* Point k of `count` of the lamps of a group, number `index` of the leaf's sequence. */
struct aim {
    struct lamp lamp;
    struct vec3 y;
    double u[SEQUENCE_DIMENSIONS];
};

static struct aim aim_of(const struct receiver *r, const struct lamps *lamps,
                         int32_t node, int k, int count, int index)
{
    const struct scene *scene = r->gather->model->scene;
    const struct patch *leaf = &r->gather->model->forest->patches[r->row.leaf];
    struct sequence sequence = sequence_start(hash_mix((uint64_t)leaf->id.root + 48) ^
                                              hash_mix((uint64_t)node));
    double start = hash_unit(sequence.scramble[0] + (uint64_t)(index - k));
    struct aim aim = {
        .lamp = lamp_choose(lamps, node, (lamp_place(k, count) + start) / count)};
    struct triangle t = scene_root_triangle(scene, aim.lamp.patch);
    sequence_point(&sequence, (uint32_t)index, aim.u);
    aim.y = triangle_of_square(&t, aim.u[0], aim.u[1]);
    return aim;
}

/* Learns the blockers that are found from `count` points, other than those of spots. */
static void learn(struct receiver *r, struct remainder *leaf, const struct lamps *lamps,
                  int32_t node, int count)
{
    for (int k = 0; k < count; k++) {
        struct aim aim = aim_of(r, lamps, node, k, count, POINTS_MOST + k);
        struct vec3 at;
        int32_t blocker;
        look_from(r, leaf, aim.lamp.patch, aim.y, aim.u, &at, &blocker);
        if (blocker >= 0 && remainder_learn(leaf, r->gather->model->scene, blocker))
            k = -1; /* all begins anew */
    }
}

/* The spot of point k of `count` of a group, which bring `share` of its light. */
static struct spot find_spot(struct receiver *r, struct remainder *leaf,
                             const struct lamps *lamps, int32_t node, int k, int count,
                             double share)
{
    const struct scene *scene = r->gather->model->scene;
    struct aim aim = aim_of(r, lamps, node, k, count, k);
    struct spot spot = {.light = scene_root_material(scene, aim.lamp.patch)->emission};
    int32_t blocker;
    double seen =
        look_from(r, leaf, aim.lamp.patch, aim.y, aim.u, &spot.at, &blocker);
    double weight = share * aim.lamp.share * scene_root_area(scene, aim.lamp.patch) /
                    (count * r->facet.area);
    for (int c = 0; c < BANDS; c++)
        spot.light.band[c] *= weight * seen;
    return spot;
}

void receiver_aim_from(struct receiver *r, const struct lamps *lamps, int32_t node,
                       int count, double share)
{
    const struct forest *forest = r->gather->model->forest;
    struct remainder leaf = remainder_start(forest, r->row.leaf);
    struct rgb sum = {{0.0, 0.0, 0.0}}, squares = sum, half[2] = {sum, sum};
    count = count < POINTS_MOST ? count : POINTS_MOST;
    learn(r, &leaf, lamps, node, LEARNERS * count);
    for (int k = 0; k < count; k++) {
        struct spot spot = find_spot(r, &leaf, lamps, node, k, count, share);
        for (int c = 0; c < BANDS; c++) {
            double h = spot.light.band[c];
            sum.band[c] += h;
            squares.band[c] += h * h;
            half[2 * k >= count].band[c] += h;
        }
        if (rgb_sum(spot.light) > 0.0)
            receiver_catch(r, spot.at, spot.light);
    }
    receiver_add_source(r, &(struct rgb){{1.0, 1.0, 1.0}}, sum, 1.0);
    for (int c = 0; c < BANDS; c++) {
        double h = sum.band[c], apart = half[0].band[c] - half[1].band[c];
        r->row.chance[c] += fmax(0.0, squares.band[c] - h * h / count);
        r->row.halves[c] += count > 1 ? apart * apart : 0.0;
    }
}
