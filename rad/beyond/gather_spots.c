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
 * where V tells whether a segment to the remainder passes: if not, a blocker more is
 * known, and all begins anew. All leaves of a root have the same points y, so that of
 * each all of the light lands somewhere. That is the light of wide lamps (gather_wide.c)
 * seen from the other end. Behind more than BLOCKERS_MOST blockers V decides alone. */
#include "rad/beyond/receiver.h"

#include <math.h>

#include "geom/hash.h"
#include "rad/beyond/remainder.h"

/* Points of a group, at most; quarterings of the remainder. */
enum { POINTS_MOST = 32, QUARTERINGS = 3 };

/* The light of one point of a lamp. */
struct spot {
    struct vec3 at;   /* where it lands on the leaf */
    struct rgb light; /* irradiance of the leaf, W/m^2 */
};

/* The factor of the leaf from a point y of a lamp; below 0: a blocker has been met that
 * was not known. */
static double look_from(struct receiver *r, struct remainder *leaf, int32_t root,
                        struct vec3 y, const double u[SEQUENCE_DIMENSIONS],
                        struct vec3 *at)
{
    struct model *model = r->gather->model;
    struct vec3 facing = scene_root_plane(model->scene, root).normal;
    if (!(plane_distance(&r->facet.plane, y) > 0.0))
        return 0.0;
    double seen = remainder_look(leaf, model->scene, y, facing);
    model->estimating += 1 + leaf->count;
    if (!(seen > 0.0))
        return 0.0;
    *at = remainder_point(leaf, QUARTERINGS, u[2], u[3], NULL);
    if (!(receiver_kernel(*at, r->facet.plane.normal, y, facing) > 0.0))
        return 0.0;
    int32_t blocker = receiver_first_blocker(r, *at, y, root);
    if (blocker >= 0 && remainder_learn(leaf, model->scene, blocker))
        return -1.0;
    return blocker < 0 ? seen : 0.0;
}

/* Finds the spots of `count` points of a group, which bring `share` of its light. False
 * if a blocker has been met that was not known. */
static bool find_spots(struct receiver *r, struct remainder *leaf,
                       const struct lamps *lamps, int32_t node, int count, double share,
                       struct spot *spots)
{
    const struct scene *scene = r->gather->model->scene;
    struct sequence sequence =
        sequence_start(hash_mix((uint64_t)leaf->root + 48) ^ hash_mix((uint64_t)node));
    double start = hash_unit(sequence.scramble[0]);
    for (int k = 0; k < count; k++) {
        double u[SEQUENCE_DIMENSIONS];
        double place = (lamp_place(k, count) + start) / count;
        struct lamp lamp = lamp_choose(lamps, node, place);
        struct triangle t = scene_root_triangle(scene, lamp.patch);
        sequence_point(&sequence, (uint32_t)k, u);
        struct vec3 y = triangle_of_square(&t, u[0], u[1]);
        double seen = look_from(r, leaf, lamp.patch, y, u, &spots[k].at);
        if (seen < 0.0)
            return false;
        double weight = share * lamp.share * scene_root_area(scene, lamp.patch) /
                        (count * r->facet.area);
        spots[k].light = scene_root_material(scene, lamp.patch)->emission;
        for (int c = 0; c < BANDS; c++)
            spots[k].light.band[c] *= weight * seen;
    }
    return true;
}

void receiver_aim_from(struct receiver *r, const struct lamps *lamps, int32_t node,
                       int count, double share)
{
    const struct forest *forest = r->gather->model->forest;
    struct remainder leaf = remainder_start(forest, r->row.leaf);
    struct spot spots[POINTS_MOST];
    struct rgb sum = {{0.0, 0.0, 0.0}}, squares = sum, half[2] = {sum, sum};
    count = count < POINTS_MOST ? count : POINTS_MOST;
    while (!find_spots(r, &leaf, lamps, node, count, share, spots))
        ;
    for (int k = 0; k < count; k++) {
        for (int c = 0; c < BANDS; c++) {
            double h = spots[k].light.band[c];
            sum.band[c] += h;
            squares.band[c] += h * h;
            half[2 * k >= count].band[c] += h;
        }
        if (rgb_sum(spots[k].light) > 0.0)
            receiver_catch(r, spots[k].at, spots[k].light);
    }
    receiver_add_source(r, &(struct rgb){{1.0, 1.0, 1.0}}, sum, 1.0);
    for (int c = 0; c < BANDS; c++) {
        double h = sum.band[c], apart = half[0].band[c] - half[1].band[c];
        r->row.chance[c] += fmax(0.0, squares.band[c] - h * h / count);
        r->row.halves[c] += count > 1 ? apart * apart : 0.0;
    }
}
