/* Tests of io/picture/open_parts.h, by the light that shading shows: none of the dark
 * under a thing, all of it on the rest of a leaf; and of the points that are covered. */
#include <math.h>

#include "rad/beyond/paths.h"
#include "tests/shaded.h"
#include "tests/tap.h"

/* Heights above the floor, whose leaves have quarters of 0.25, with 0.19 from the middle
 * to a corner: of a box; of a shelf below which rays still get out; of plates in whose
 * gap there is light, and in which there is none. */
static const double ROOMY = 1.5, KNEE = 0.1, LOW = 0.02, NARROW = 0.01, TOUCHING = 1e-9;

/* A box without bottom; its top alone, whose back is below; that turned over. */
enum cover { BOX, SHELF, PLATE };

/* A floor of 8 x 8 with a cover on (2..4) x (2..6). */
static struct scene *floor_scene(enum cover cover, double height)
{
    struct soup soup = {0};
    struct vec3 x = {2, 0, 0}, y = {0, 4, 0}, up = {0, 0, height};
    const struct vec3 at[4] = {{2, 2, 0}, {4, 2, 0}, {4, 6, 0}, {2, 6, 0}};
    const struct vec3 side[4] = {x, y, vec3_scale(x, -1.0), vec3_scale(y, -1.0)};
    soup_add_quad(&soup, point(0, 0, 0), point(8, 0, 0), point(0, 8, 0), 1);
    int corner = cover == PLATE ? 3 : 0;
    soup_add_quad(&soup, vec3_add(at[corner], up), x, corner == 3 ? side[3] : y, 1);
    for (int i = 0; i < 4 && cover == BOX; i++)
        soup_add_quad(&soup, at[i], side[i], up, 1);
    return scene_of_soup(&soup);
}

static bool is_under(struct vec3 x)
{
    return x.x >= 2.0 && x.x <= 4.0 && x.y >= 2.0 && x.y <= 6.0;
}

/* Divides the floor along the box, makes the part under it 1/4 and all else 1, and
 * returns the smallest and the largest value of the floor's vertices off the box and on
 * its edge, and the largest one inside. */
static void shade_floor(struct stage *stage, double *low, double *high, double *inside)
{
    split_regularly(stage->forest, 4);
    for (int32_t p = 0; p < stage->forest->count; p++) {
        struct triangle t = forest_triangle(stage->forest, p);
        bool dark = is_under(scene_to_input(stage->scene, triangle_centroid(&t)));
        dark = dark && stage->forest->patches[p].id.root < 2;
        double value = dark ? 0.25 : 1.0;
        stage->forest->radiosity[p] = (struct rgb){{value, value, value}};
    }
    shade_stage(stage, false);
    *low = *high = 1.0;
    *inside = 0.0;
    for (int i = 0; i <= 16; i++)
        for (int j = 0; j <= 16; j++) { /* x = 8 (b + c), y = 8 c */
            double b = (i - j) / 16.0, c = j / 16.0;
            struct rgb value = i >= j ? value_at(stage, 0, point(1.0 - b - c, b, c))
                                      : value_at(stage, 1, point(1.0 - c, i / 16.0, -b));
            if (i > 4 && i < 8 && j > 4 && j < 12) {
                *inside = fmax(*inside, value.band[0]);
                continue;
            }
            *low = fmin(*low, value.band[0]);
            *high = fmax(*high, value.band[0]);
        }
}

/* A covered leaf weighs 1e-12 of an open one; up to five lie around a vertex. Where the
 * floor counts as open the shadow blends into the light around it. */
static void test_covered(const char *name, enum cover cover, double height,
                         bool two_sided, double emission, bool covered)
{
    double low, high, inside;
    struct scene *scene = floor_scene(cover, height);
    scene->two_sided = two_sided;
    scene->materials[0] = material_grey(0.0, emission);
    struct stage stage = stage_of(scene);
    shade_floor(&stage, &low, &high, &inside);
    tap_ok(covered ? low > 1.0 - 1e-10 : low < 0.9, "%s (1 - %.1e)", name, 1.0 - low);
    if (covered && !two_sided)
        tap_ok(high <= 1.0 + 1e-15 && inside == 0.25, "and none of the light inside");
    dismantle(&stage);
}

/* Counts the middles of `points` parts of a triangle of the floor that are not under the
 * box. */
static int open_points(const struct stage *stage, const struct triangle *t, int points)
{
    if (points == 1)
        return !is_under(scene_to_input(stage->scene, triangle_centroid(t)));
    int open = 0;
    for (int k = 0; k < 4; k++) {
        struct triangle child = triangle_child(t, k);
        open += open_points(stage, &child, points / 4);
    }
    return open;
}

/* Share of a leaf of the floor that is not under the box, as open_parts_survey() finds
 * it. */
static double open_share(const struct stage *stage, int32_t leaf)
{
    struct triangle t = forest_triangle(stage->forest, leaf);
    return floor(open_points(stage, &t, 256) * OPEN_PARTS / 256.0) / OPEN_PARTS;
}

/* The floor has leaves that are open to 13/16 (206 of 254 parts) and 1, divided once 1/2,
 * 3/4 and 1. With the share s open and the emission E, the radiosity E + s (1 - E) must
 * show as 1 everywhere. */
static void test_partly_covered(int levels, int smallest)
{
    static const double emission[BANDS] = {0.0, 0.5, 0.25};
    struct stage stage = stage_of(floor_scene(BOX, ROOMY));
    double least = 1.0, largest = 0.0;
    split_regularly(stage.forest, levels);
    for (int c = 0; c < BANDS; c++) {
        stage.scene->materials[0].emission.band[c] = emission[c];
        for (int32_t p = 0; p < stage.forest->count; p++)
            stage.forest->radiosity[p].band[c] =
                emission[c] + open_share(&stage, p) * (1.0 - emission[c]);
    }
    shade_stage(&stage, false);
    for (int32_t p = 0; p < stage.forest->count; p++) {
        struct patch_id id = stage.forest->patches[p].id;
        struct triangle w = pathtracer_part(id);
        if (id.root >= 2 || !patch_is_leaf(&stage.forest->patches[p]))
            continue;
        least = fmin(least, open_share(&stage, p));
        for (int i = 0; i < 3 * BANDS; i++) {
            struct rgb value = value_at(&stage, (int32_t)id.root, w.corner[i / BANDS]);
            largest = fmax(largest, fabs(value.band[i % BANDS] - 1.0));
        }
    }
    tap_ok(least * OPEN_PARTS == smallest && largest < 1e-15,
           "the open part of a leaf is shown (within %.1e)", largest);
    dismantle(&stage);
}

/* Leaves that a thing covers in part know which points of them it covers. Below a plate
 * rays get out within `margin` of its rim, where points may be either. The leaves have
 * quarters of 2, so gaps below .15 are narrow. */
static void test_shut_points(enum cover cover, double height, double margin, bool covers,
                             const char *name)
{
    struct stage stage = stage_of(floor_scene(cover, height));
    int points = 0, wrong = 0, in_part = 0;
    split_regularly(stage.forest, 1);
    shade_stage(&stage, false);
    for (int i = 0; i < 32; i++)
        for (int j = 0; j < 32; j++) {
            double b = (i - j) / 32.0, c = (j + 0.25) / 32.0;
            struct vec3 x = point(8.0 * (b + c), 8.0 * c, 0.0);
            int32_t leaf;
            double inside = fmin(fmin(x.x - 2.0, 4.0 - x.x), fmin(x.y - 2.0, 6.0 - x.y));
            if (b <= 0.0 || (is_under(x) && inside < margin))
                continue;
            shading_at(stage.shading, 0, (double[]){1.0 - b - c, b, c}, &leaf);
            in_part += stage.shading->shades[leaf] == SHADE_IN_PART;
            wrong += leaf_is_shut_at(stage.forest, stage.octree, leaf,
                                     scene_from_input(stage.scene, x)) !=
                     (covers && is_under(x));
            points++;
        }
    tap_ok(wrong == 0 && points > 256 && in_part > (covers ? points / 8 : -1),
           "%s (%d of %d wrong)", name, wrong, points);
    dismantle(&stage);
}

/* A box covers a strip at the edge of the floor, lower than the middles of sixteenths
 * of its leaf. The points that are examined are in rows of a sixteenth of the floor's
 * side: half of such a row may be missed. Pillars may stand in the box and rise from it:
 * rays from inside of it meet their fronts. */
static void test_strip(bool pierced)
{
    static const double SIDE = 8.0;
    const double width = pierced ? 3.0 : 0.45;
    int64_t leaves;
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(SIDE, 0, 0), point(0, SIDE, 0), 1);
    soup_add_box(&soup, point(-1, -1, 0), point(SIDE + 1, width, 1.5), 1, false);
    for (double x = 0.0; x < SIDE && pierced; x += 2.0)
        soup_add_box(&soup, point(x, -0.5, -1), point(x + 0.3, 2.8, 3), 1, false);
    struct stage stage = stage_of(scene_of_soup(&soup));
    uint8_t *open = open_parts_survey(stage.forest, stage.octree, 0, 1, &leaves);
    double left = 1.0 - width / SIDE, true_share = left * left;
    double share = open_parts_fraction(open[0]);
    tap_ok(fabs(share - true_share) < 1.0 / 16.0,
           "%.3f of a leaf is open beside a strip%s, counted as %.3f", true_share,
           pierced ? " with pillars in it" : "", share);
    alloc_free(open);
    dismantle(&stage);
}

/* A box stands between the four points that are examined, the middles of the quarters:
 * (2.7, 1.3), (6.7, 1.3), (6.7, 5.3) and (5.3, 2.7). Its leaf knows of it; the other has
 * none. */
static void test_between_points(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(8, 0, 0), point(0, 8, 0), 1);
    soup_add_box(&soup, point(4.4, 0.5, 0), point(4.8, 4, 1.5), 1, false);
    struct stage stage = stage_of(scene_of_soup(&soup));
    shade_stage(&stage, false);
    struct vec3 inside = scene_from_input(stage.scene, point(4.6, 2, 0));
    struct vec3 outside = scene_from_input(stage.scene, point(5, 2, 0));
    tap_ok(stage.shading->shades[0] == SHADE_IN_PART &&
               stage.shading->shades[1] == SHADE_SMOOTH,
           "a leaf knows of a box between the points that are examined");
    tap_ok(leaf_is_shut_at(stage.forest, stage.octree, 0, inside) &&
               !leaf_is_shut_at(stage.forest, stage.octree, 0, outside),
           "which covers the points below it alone");
    dismantle(&stage);
}

int main(void)
{
    test_covered("under a box: no darkness outside", BOX, ROOMY, false, 0.0, true);
    test_covered("below a shelf the floor is open", SHELF, KNEE, false, 0.0, false);
    test_covered("under a lamp's front, too", PLATE, ROOMY, false, 0.0, false);
    test_covered("and under a plate that is hung low", PLATE, LOW, false, 0.0, false);
    test_covered("but not under one close to it", PLATE, NARROW, false, 0.0, true);
    test_covered("nor under one that touches it", PLATE, TOUCHING, false, 0.0, true);
    test_covered("two-sided, nothing is covered", BOX, ROOMY, true, 0.0, false);
    test_covered("but by a box of lamps, whose backs are black", BOX, ROOMY, true, 1.0,
                 true);
    test_partly_covered(0, 206);
    test_partly_covered(1, 127);
    test_strip(false);
    test_strip(true);
    test_between_points();
    test_shut_points(BOX, ROOMY, 0.0, true, "a box covers points below it alone");
    test_shut_points(PLATE, KNEE, 0.4, true, "a plate in a narrow gap does, too");
    test_shut_points(PLATE, 2.0 * KNEE, 0.8, false, "one in a wider gap covers none");
    return tap_done();
}
