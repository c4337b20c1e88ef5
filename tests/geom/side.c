/* Tests of geom/side.h: against a comparison of all pairs. */
#include "geom/side.h"

#include "geom/alloc.h"
#include "tests/scenes.h"
#include "tests/tap.h"

enum { COUNT = 300 };

/* Triangles between random points of a small grid, zeros of either sign among them, so
 * that many sides are there again, along and back, and some have no length. */
static struct soup make_soup(void)
{
    struct soup soup = {0};
    struct random random = random_seed(11);
    for (int i = 0; i < COUNT; i++) {
        struct triangle t;
        for (int k = 0; k < 3; k++) {
            double sign = random_below(&random, 2) ? 1.0 : -1.0;
            t.corner[k] = (struct vec3){random_below(&random, 3),
                                        random_below(&random, 3), sign * 0.0};
        }
        soup_add(&soup, t);
    }
    return soup;
}

static bool is_same(const struct triangle *triangles, int32_t s, int32_t t)
{
    struct vec3 a = side_start(triangles, s), b = side_end(triangles, s);
    struct vec3 c = side_start(triangles, t), d = side_end(triangles, t);
    return (vec3_is_equal(a, c) && vec3_is_equal(b, d)) ||
           (vec3_is_equal(a, d) && vec3_is_equal(b, c));
}

int main(void)
{
    struct soup soup = make_soup();
    int32_t *same = sides_match(soup.items, COUNT);
    int wrong = 0, alone = 0;
    for (int32_t s = 0; s < 3 * COUNT; s++) {
        int32_t next = -1;
        for (int32_t t = 3 * COUNT - 1; t > s; t--)
            if (is_same(soup.items, s, t))
                next = t;
        wrong += same[s] != next;
        alone += next < 0;
    }
    tap_ok(wrong == 0, "%d of %d sides lead to the wrong one", wrong, 3 * COUNT);
    tap_ok(alone > 30 && alone < COUNT, "%d sides are the last of their kind", alone);
    alloc_free(same);
    same = sides_match(NULL, 0);
    tap_ok(same != NULL, "no triangles");
    alloc_free(same);
    alloc_free(soup.items);
    return tap_done();
}
