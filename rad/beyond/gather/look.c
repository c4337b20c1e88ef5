/* Looks at leaves, before rows are made.
 *
 * A few rays from each quarter of a leaf, in the same directions, tell whether its light
 * varies, and with how much noise: by rays, and by segments to lamps. */
#include "rad/beyond/gather/look.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/hash.h"
#include "rad/beyond/gather/aim.h"
#include "rad/beyond/gather/rays.h"
#include "rad/beyond/sample.h"

/* The variance by chance, over bands, common to the quarters: their rays have the same
 * directions. `each`, [rays]: H by each ray, summed over quarters. */
static double variance_in_common(const struct rgb *each, int rays, const struct rgb *rho)
{
    double variance = 0.0;
    for (int c = 0; c < BANDS; c++) {
        double sum = 0.0, squares = 0.0;
        for (int i = 0; i < rays; i++) {
            sum += each[i].band[c];
            squares += each[i].band[c] * each[i].band[c];
        }
        variance += 0.0625 * rho->band[c] * rho->band[c] * (squares - sum * sum / rays);
    }
    return fmax(0.0, variance);
}

/* True if a thing stands on the leaf or across it: just above the leaf something is
 * between a corner and the middle of the edge opposite. */
static bool is_cut(struct final_gather *gather, int32_t leaf)
{
    static const double INSET = 0.99;
    struct facet facet = facet_make(gather->model->forest, leaf);
    const struct vec3 *corner = facet.triangle.corner, normal = facet.plane.normal;
    struct vec3 middle = triangle_centroid(&facet.triangle);
    int32_t own[2] = {-1, -1}, guess = -1;
    for (int k = 0; k < 3; k++) {
        struct vec3 ends[2] = {corner[k],
                               vec3_middle(corner[(k + 1) % 3], corner[(k + 2) % 3])};
        for (int j = 0; j < 2; j++)
            ends[j] = point_above(
                vec3_add(middle, vec3_scale(vec3_sub(ends[j], middle), INSET)), normal);
        if (octree_blocks_segment(gather->model->octree, ends[0], ends[1], own, &guess,
                                  &gather->view->counts))
            return true;
    }
    return false;
}

struct gather_look final_gather_look(struct final_gather *gather, int32_t leaf, int rays)
{
    const struct forest *forest = gather->model->forest;
    const struct rgb *rho = &forest_material(forest, leaf)->reflectance;
    struct gather_look look = {.cut = is_cut(gather, leaf)};
    struct rgb *each = alloc_array((size_t)rays, sizeof *each);
    double variance = 0.0, by_segments = 0.0;
    int64_t before = model_work(gather->model), fixed = gather->model->estimating;
    for (int k = 0; k < 4; k++) {
        struct gather_row row = {.leaf = leaf};
        struct ray_sums sums = {.each = each};
        struct receiver r = receiver_of_leaf(gather, RECEIVER_LOOK, rays, &row, &sums);
        r.seed = hash_mix(r.seed + 1);
        r.facet.triangle = triangle_child(&r.facet.triangle, k);
        r.facet.area *= 0.25;
        receiver_aim(&r);
        receiver_fire(&r); /* aims at bright patches, too */
        for (int c = 0; c < BANDS; c++) {
            double part = rho->band[c], square = 0.25 * part * part;
            look.reflected[k][c] =
                (float)(part * (row.straight.band[c] + sums.h.band[c]));
            variance += square * row.chance.band[c];
            by_segments += square * row.of_segments.band[c];
        }
    }
    look.noise = fmax(0.0, variance - variance_in_common(each, rays, rho));
    look.variance = variance * rays;
    look.of_segment = by_segments * rays;
    fixed = gather->model->estimating - fixed;
    look.fixed = 0.25f * (float)fixed;
    look.work =
        (float)(model_work(gather->model) - before - fixed) / (4.0f * (float)rays);
    alloc_free(each);
    return look;
}
