/* Tests of geom/doubles.h: polygons that are there again, from another corner on, from
 * behind, or as triangles, against the list of those that were made. */
#include "geom/doubles.h"

#include <string.h>

#include "tests/scenes.h"
#include "tests/tap.h"

enum { SHAPES = 40, COPIES = 400, MOST = 5 }; /* corners */

static struct soup soup;
static bool goes_on[MOST * COPIES];
static double areas[MOST * COPIES];
static int32_t first[MOST * COPIES], opposite[MOST * COPIES];

/* Adds a polygon, cut around its first corner. */
static int32_t add(const struct vec3 *corners, int count)
{
    int32_t begin = (int32_t)soup.count;
    for (int k = 1; k + 1 < count; k++) {
        goes_on[soup.count] = k > 1;
        areas[soup.count] = 1.0;
        soup_add(&soup, (struct triangle){{corners[0], corners[k], corners[k + 1]}});
    }
    return begin;
}

static void find(void)
{
    struct faces faces = {soup.items, areas, goes_on, (int32_t)soup.count};
    doubles_find(&faces, first, opposite);
}

/* Numbers of the first copy that faces one way, and the other. */
struct shape {
    struct vec3 corners[MOST];
    int count;
    int32_t copy[2];
};

/* Adds a copy of a shape, from a random corner on. Returns false if doubles_find() is to
 * drop it. */
static bool add_copy(struct shape *shape, struct random *random, int back)
{
    struct vec3 corners[MOST];
    int turn = random_below(random, shape->count);
    for (int k = 0; k < shape->count; k++)
        corners[k] =
            shape->corners[(turn + (back ? shape->count - k : k)) % shape->count];
    int32_t at = add(corners, shape->count);
    bool is_new = shape->copy[back] < 0;
    if (is_new)
        shape->copy[back] = at;
    return is_new;
}

static void test_polygons(void)
{
    struct random random = random_seed(7);
    struct shape shapes[SHAPES], *of[COPIES];
    int32_t begin[COPIES];
    int back[COPIES], dropped = 0;
    bool right = true, paired = true;
    for (int i = 0; i < SHAPES; i++) {
        shapes[i] = (struct shape){.count = 3 + i % 3, .copy = {-1, -1}};
        for (int k = 0; k < shapes[i].count; k++)
            shapes[i].corners[k] = random_point(&random, 1.0);
    }
    for (int i = 0; i < COPIES; i++) {
        of[i] = &shapes[random_below(&random, i < COPIES / 2 ? SHAPES : SHAPES / 2)];
        back[i] = i % 3 == 0;
        begin[i] = (int32_t)soup.count;
        dropped += !add_copy(of[i], &random, back[i]);
    }
    find();
    for (int i = 0; i < COPIES; i++) {
        int32_t same = of[i]->copy[back[i]], other = of[i]->copy[!back[i]];
        for (int32_t k = 0; k < of[i]->count - 2; k++) {
            int32_t t = begin[i] + k;
            right = right && first[t] == (same == begin[i] ? t : same);
            paired = paired && opposite[t] == (same == begin[i] && other >= 0 ? other + k
                                                                              : -1);
        }
    }
    tap_ok(right && dropped > COPIES / 2,
           "of faces that face the same way the first is kept, from any corner on");
    tap_ok(paired, "and is paired with the first that faces the other way");
    soup_free(&soup);
}

static const struct vec3 A = {0, 0, 0}, B = {1, 0, 0}, C = {1, 1, 0.5}, D = {-0.0, 1, 0};

static void test_triangles_of_polygons(void)
{
    add((const struct vec3[]){A, B, C, D}, 4);
    add((const struct vec3[]){C, A, B}, 3);
    add((const struct vec3[]){C, A, D}, 3);
    add((const struct vec3[]){B, C, D}, 3);
    find();
    tap_ok(first[2] == 0 && first[3] == 3 && first[4] == 4,
           "one half of a quad is there again, not that of the other diagonal");
    tap_ok(opposite[1] == 3 && opposite[3] == 1 && opposite[0] < 0 && opposite[4] < 0,
           "the back of a half is paired with it alone");
    soup_free(&soup);
    add((const struct vec3[]){A, B, C, D}, 4);
    add((const struct vec3[]){D, C, B, A}, 4);
    add((const struct vec3[]){A, D, C}, 3);
    add((const struct vec3[]){D, C, B}, 3);
    find();
    tap_ok(first[4] == 3 && first[5] == 5,
           "the back of a quad counts as cut along the diagonal of its front");
    soup_free(&soup);
    add((const struct vec3[]){A, C, D}, 3);
    add((const struct vec3[]){A, B, C, D}, 4);
    find();
    tap_ok(first[1] == 1 && first[2] == 0, "a quad loses a half that was there before");
    soup_free(&soup);
}

static void test_odd(void)
{
    struct vec3 zero = {0.0, 1, 0};
    add((const struct vec3[]){A, B, D}, 3);
    add((const struct vec3[]){A, B, zero}, 3);
    add((const struct vec3[]){A, B, C, B}, 4);
    add((const struct vec3[]){A, B, D, B}, 4);
    find();
    tap_ok(first[1] == 0, "-0 is 0");
    tap_ok(first[2] == 2 && first[3] == 3 && first[4] == 0 && opposite[2] == 3,
           "polygons that are folded onto themselves are no doubles of each other");
    areas[0] = 0.0;
    find();
    tap_ok(first[0] == 0 && first[1] == 1, "degenerate triangles are passed over");
    soup_free(&soup);
    struct triangle one = {{A, B, C}};
    soup_add(&soup, one);
    soup_add(&soup, one);
    struct faces faces = {soup.items, areas, NULL, 2};
    areas[0] = 1.0;
    doubles_find(&faces, first, opposite);
    tap_ok(first[0] == 0 && first[1] == 0 && opposite[0] < 0, "triangles alone");
    soup_free(&soup);
}

int main(void)
{
    test_polygons();
    test_triangles_of_polygons();
    test_odd();
    return tap_done();
}
