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

/* Irradiance by the points of a group, W/m^2. */
struct spots {
    struct rgb sum, squares, half[2];
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
    struct vec3 x = remainder_point(leaf, QUARTERINGS, u[2], u[3]);
    *at = x;
    if (!(receiver_kernel(x, r->facet.plane.normal, y, facing) > 0.0))
        return 0.0;
    int32_t blocker = receiver_first_blocker(r, x, y, root);
    if (blocker >= 0 && remainder_learn(leaf, model->scene, blocker))
        return -1.0;
    return blocker < 0 ? seen : 0.0;
}

/* Adds the light of one point. */
static void add_light(struct spots *spots, int half, struct rgb light)
{
    for (int c = 0; c < BANDS; c++) {
        double h = light.band[c];
        spots->sum.band[c] += h;
        spots->squares.band[c] += h * h;
        spots->half[half].band[c] += h;
    }
}

void receiver_aim_from(struct receiver *r, const struct lamps *lamps, int32_t node,
                       int count, double share)
{
    const struct forest *forest = r->gather->model->forest;
    const struct scene *scene = forest->scene;
    struct remainder leaf =
        remainder_start(scene, (int32_t)forest->patches[r->row.leaf].id.root);
    struct sequence sequence =
        sequence_start(hash_mix((uint64_t)leaf.root + 48) ^ hash_mix((uint64_t)node));
    double start = hash_unit(sequence.scramble[0]), u[SEQUENCE_DIMENSIONS];
    struct spots spots = {.squares = {{0.0, 0.0, 0.0}}};
    struct vec3 at[POINTS_MOST];
    struct rgb each[POINTS_MOST];
    leaf.triangle = r->facet.triangle;
    count = count < POINTS_MOST ? count : POINTS_MOST;
    for (int k = 0; k < count; k++) {
        int half = 2 * k >= count, place = half ? (2 * k - count) | 1 : 2 * k;
        struct lamp lamp = lamp_choose(lamps, node, (place + start) / count);
        struct triangle t = scene_root_triangle(scene, lamp.root);
        sequence_point(&sequence, (uint32_t)k, u);
        struct vec3 y = triangle_of_square(&t, u[0], u[1]);
        double seen = look_from(r, &leaf, lamp.root, y, u, &at[k]);
        double weight = share * lamp.share * scene_root_area(scene, lamp.root) /
                        (count * r->facet.area);
        if (seen < 0.0) {
            spots = (struct spots){.squares = {{0.0, 0.0, 0.0}}};
            k = -1;
            continue;
        }
        each[k] = scene_root_material(scene, lamp.root)->emission;
        for (int c = 0; c < BANDS; c++)
            each[k].band[c] *= weight * seen;
        add_light(&spots, half, each[k]);
    }
    for (int k = 0; k < count && r->dark.catches; k++)
        if (rgb_sum(each[k]) > 0.0)
            receiver_catch(r, at[k], each[k]);
    receiver_add_source(r, &(struct rgb){{1.0, 1.0, 1.0}}, spots.sum, 1.0);
    for (int c = 0; c < BANDS; c++) {
        double sum = spots.sum.band[c];
        double apart = spots.half[0].band[c] - spots.half[1].band[c];
        r->row.chance[c] += fmax(0.0, spots.squares.band[c] - sum * sum / count);
        r->row.halves[c] += count > 1 ? apart * apart : 0.0;
    }
}
