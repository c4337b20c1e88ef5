/* Tests of row sums (rad/pushpull.h) and of the factors that cap them. (On all ranks, and
 * their effect on the light: tests/mpi/conjugate.c.) */
#include "rad/beyond/conjugate.h"
#include "rad/pushpull.h"

#include <string.h>

#include "tests/dozen.h"
#include "tests/tap.h"

/* Root 0 gets 1.25 of its area, root 1 half of it, in two of its children 0.4 more; the
 * black one does not count, and root 3 is another's. */
static void test_rows(void)
{
    struct world world = make_world();
    struct forest *forest = world.model.forest;
    struct flux_unit unit = flux_unit_for(2.0 * scene_area(world.scene));
    bool own[ROOTS] = {true, true};
    own[BLACK] = own[NO_AREA] = true;
    forest_split(forest, 1);
    double a = forest_area(forest, 0), b = forest_area(forest, 1);
    int32_t child = forest->patches[1].children;
    forest->patches[0].flux[0] = flux_from_watts(unit, 1.25 * a);
    forest->patches[0].flux[1] =
        flux_from_watts(unit, 7.0 * a); /* another band: no matter */
    forest->patches[1].flux[0] = flux_from_watts(unit, 0.5 * b);
    forest->patches[child].flux[0] = flux_from_watts(unit, 0.4 * b / 4.0);
    forest->patches[child + 3].flux[0] = flux_from_watts(unit, 0.4 * b / 4.0);
    forest->patches[3].flux[0] = flux_from_watts(unit, 9.0);
    forest->patches[BLACK].flux[0] = flux_from_watts(unit, 9.0);
    struct row_sums sums = row_sums_measure(forest, own, unit);
    /* All numbers are of size 1 and rounded a few times. */
    tap_ok(fabs(sums.min - 0.5) < 1e-13 && fabs(sums.max - 1.25) < 1e-13,
           "least and greatest row sum");
    struct flux_unit coarse = {unit.per_watt / ROW_SUMS_ROOM, unit.watt * ROW_SUMS_ROOM};
    tap_ok(fabs(flux_to_watts(coarse, sums.area) - (a + b)) < 1e-13,
           "the area counted is that of own leaves that are not dark");
    tap_ok(fabs(flux_to_watts(coarse, sums.rows) - (1.25 * a + 0.7 * b)) < 1e-13, "rows");
    double squares = 0.0625 * a + 0.5 * b * 0.25 + 0.5 * b * 0.01;
    tap_ok(fabs(flux_to_watts(coarse, sums.squares) - squares) < 1e-13, "squares");
    bool none[ROOTS] = {false};
    sums = row_sums_measure(forest, none, unit);
    tap_ok(sums.min == HUGE_VAL && sums.max == -HUGE_VAL && sums.area == 0 &&
               sums.rows == 0 && sums.squares == 0,
           "no leaf at all");
    /* The unit of a transfer of B = 1 is chosen for a flux as large as the area. */
    int tried = 0, right = 0;
    for (int32_t root = 0; root < ROOTS; root++) {
        double area = forest_area(forest, root);
        if (root == NO_AREA || root == BLACK)
            continue;
        unit = flux_unit_for(area);
        memset(none, 0, sizeof none);
        none[root] = true;
        for (int64_t p = 0; p < forest->count; p++)
            memset(forest->patches[p].flux, 0, sizeof forest->patches[p].flux);
        forest_split(forest, root);
        for (int k = 0; k < 4; k++)
            forest->patches[forest->patches[root].children + k].flux[0] =
                flux_from_watts(unit, 0.25 * 1.5 * area);
        forest->patches[root].flux[0] = flux_from_watts(unit, 0.9375 * area);
        sums = row_sums_measure(forest, none, unit);
        tried++;
        right += fabs((double)sums.rows / (double)sums.area - 2.4375) < 1e-12 &&
                 fabs((double)sums.squares / (double)sums.area - 1.4375 * 1.4375) < 1e-12;
    }
    tap_ok(tried == 10 && right == tried, "rows may sum to more than 2 all over a scene");
    world_free(&world);
}

/* The largest reflectance counts: 0.75 of root 0, 0.98 of root 1, 0 of the black one.
 * Light may grow by 0.95, or by the mean of 1 and the reflectance where that is more. */
static void test_caps(void)
{
    static const struct {
        int32_t root;
        double row, factor;
    } CASES[] = {{0, 0.0, 1.0},  {0, 1.0, 1.0},  {0, 1.26, 1.0}, {0, 2.0, 0.95 / 1.5},
                 {1, 1.01, 1.0}, {1, 2.0, 0.99 / 1.96}, {BLACK, 9.0, 1.0}};
    struct world world = make_world();
    struct forest *forest = world.model.forest;
    struct rgb rows[ROOTS] = {{{0.0}}};
    struct conjugate cg = {.count = 0};
    double off = 0.0;
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; i++) {
        rows[CASES[i].root].band[0] = CASES[i].row;
        conjugate_begin(&cg, forest, rows);
        off = fmax(off, fabs(forest->caps[CASES[i].root] - CASES[i].factor));
    }
    tap_ok(off < 1e-15, "rows that make light grow are capped, others are not");
    conjugate_free(&cg);
    world_free(&world);
}

int main(void)
{
    test_rows();
    test_caps();
    return tap_done();
}
