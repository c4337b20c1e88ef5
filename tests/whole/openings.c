/* Light that comes into a dark room through a narrow opening, most of it by reflections.
 *
 * Two rooms of 3 m, rho 0.7, share a wall with an opening; a lamp of 0.36 m^2 and 100
 * W/m^2 is in the ceiling of the first. The light of the second was computed by a
 * program of its own that follows paths from points of the opening both ways, to the
 * lamp and into the dark, so each of its 300,000 samples counts: its noise is below 0.4
 * %.
 *
 * Few rays find the opening, so single answers are noisy; how noisy is not asked. Three
 * claims are tested: the room's error is within the mean error that its leaves
 * claim; the answer is right in the mean, where few rays find light at all (behind a
 * keyhole 64 rays a leaf do not); and more rays leave less noise. The mean is that over
 * orders of the faces, each with rays and segments of its own, and is known as well as
 * these scatter: within four standard errors, Student's 1 % for six orders. */
#include <math.h>

#include "geom/contour.h"
#include "geom/lambert.h"
#include "mpi/beyond/beyond.h"
#include "tests/defaults.h"
#include "tests/tap.h"

static const double SIZE = 3.0;

enum { ORDERS = 6 }; /* of the faces */
static int rays = 64;

/* The walls of a room from x on without the floor and the wall to the other room; `from`
 * and `to`: the hole in its ceiling. */
static void add_room(struct soup *soup, double x, int side, double from, double to)
{
    double end = x + SIZE, far = side > 0 ? end : x;
    soup_add_rectangle(soup, point(x, 0, 0), point(end, 0, SIZE), 1);
    soup_add_rectangle(soup, point(x, SIZE, 0), point(end, SIZE, SIZE), -1);
    soup_add_rectangle(soup, point(far, 0, 0), point(far, SIZE, SIZE), -side);
    soup_add_rectangle(soup, point(x, 0, SIZE), point(end, from, SIZE), -1);
    soup_add_rectangle(soup, point(x, to, SIZE), point(end, SIZE, SIZE), -1);
    soup_add_rectangle(soup, point(x, from, SIZE), point(x + from, to, SIZE), -1);
    soup_add_rectangle(soup, point(x + to, from, SIZE), point(end, to, SIZE), -1);
}

/* A side of the wall at x, with a hole. */
static void add_wall(struct soup *soup, double x, int sign, struct vec3 low,
                     struct vec3 high)
{
    soup_add_rectangle(soup, point(x, 0, 0), point(x, low.y, SIZE), sign);
    soup_add_rectangle(soup, point(x, high.y, 0), point(x, SIZE, SIZE), sign);
    soup_add_rectangle(soup, point(x, low.y, 0), point(x, high.y, low.z), sign);
    soup_add_rectangle(soup, point(x, low.y, high.z), point(x, high.y, SIZE), sign);
}

/* Moves the triangles from number `first` on: the one `by` after it comes first. */
static void turn(struct soup *soup, int64_t first, int64_t by)
{
    for (; by > 0; by--) {
        struct triangle t = soup->items[first];
        for (int64_t i = first; i + 1 < soup->count; i++)
            soup->items[i] = soup->items[i + 1];
        soup->items[soup->count - 1] = t;
    }
}

static void add_floor(struct soup *soup, double x, double end)
{
    soup_add_rectangle(soup, point(x, 0, 0), point(end, SIZE, 0), 1);
}

/* Adds two rooms, the triangles of the dark one first, and a lamp in the other, faces in
 * this order. Returns the number behind those of the dark room, but for the floor if
 * there is `one_floor` of both. */
static int32_t add_rooms(struct soup *soup, double thick, struct vec3 low,
                         struct vec3 high, bool one_floor, int order)
{
    double end = SIZE + thick;
    int64_t first = soup->count;
    if (!one_floor)
        add_floor(soup, end, end + SIZE);
    add_room(soup, end, 1, SIZE, SIZE);
    add_wall(soup, end, 1, low, high);
    turn(soup, first, 3 * order);
    int32_t dark = (int32_t)soup->count;
    add_floor(soup, 0.0, one_floor ? end + SIZE : SIZE);
    add_room(soup, 0.0, -1, 1.2, 1.8);
    add_wall(soup, SIZE, -1, low, high);
    if (!one_floor)
        soup_add_rectangle(soup, point(SIZE, low.y, low.z), point(end, high.y, low.z), 1);
    soup_add_rectangle(soup, point(SIZE, low.y, high.z), point(end, high.y, high.z), -1);
    soup_add_rectangle(soup, point(SIZE, low.y, low.z), point(end, low.y, high.z), 1);
    soup_add_rectangle(soup, point(SIZE, high.y, low.z), point(end, high.y, high.z), -1);
    turn(soup, dark, 3 * order);
    paint(soup, 0.7, 0.0);
    soup_add_rectangle(soup, point(1.2, 1.2, SIZE), point(1.8, 1.8, SIZE), -1);
    paint(soup, 0.0, 100.0);
    return dark;
}

/* A mean over the dark room, and what is claimed of it. */
struct answer_in_dark {
    double light; /* radiosity, W/m^2; NaN if it has not converged */
    double error; /* mean of those of the leaves, W/m^2 */
};

static struct answer_in_dark light_of(struct soup *soup, int32_t count)
{
    char words[100];
    snprintf(words, sizeof words, "--epsilon 1e-3 --final-gather %d", rays);
    struct solution s = solve_soup(soup, words);
    const struct forest *forest = s.solver->model.forest;
    struct answer_in_dark dark = {
        s.vote.converged ? mean_radiosity(&s, 0, count) : NAN, 0.0};
    double area = 0.0;
    int32_t leaf = forest_next_leaf(forest, -1);
    for (; leaf >= 0; leaf = forest_next_leaf(forest, leaf)) {
        if (forest->patches[leaf].id.root >= (uint32_t)count)
            continue;
        area += forest_area(forest, leaf);
        dark.error += forest_area(forest, leaf) *
                      (double)s.solver->beyond->answer->error[leaf];
    }
    dark.error /= area;
    solution_free(&s);
    return dark;
}

/* Light that comes through an opening from y, z = `low` to `high` of a wall that is so
 * thick. If there is `one_floor` of both rooms, that of the other faces of the dark
 * one. `rare`: hardly any ray finds it. Returns the RMS of the orders. */
static double test_opening(const char *name, double thick, struct vec3 low,
                           struct vec3 high, bool one_floor, double truth, bool rare)
{
    double sum = 0.0, squares = 0.0;
    int within = 0;
    for (int order = 0; order < ORDERS; order++) {
        struct soup soup = {0};
        int32_t count = add_rooms(&soup, thick, low, high, one_floor, order);
        struct answer_in_dark dark = light_of(&soup, count);
        double off = dark.light / truth - 1.0;
        sum += off / ORDERS;
        squares += off * off / ORDERS;
        within += fabs(off) * truth <= dark.error;
        printf("# %s order %d: off %+.3f, claimed %.3f\n", name, order, off,
               dark.error / truth);
    }
    double error = sqrt(fmax(0.0, squares - sum * sum) / (ORDERS - 1));
    if (!rare)
        tap_ok(fabs(sum) <= 4.0 * error + 0.004,
               "light through a %s is off by %+.1f %% in the mean, of orders that leave "
               "%.1f %% in doubt", name, 100.0 * sum, 100.0 * error);
    tap_ok(10 * within >= 9 * ORDERS - 5, "%s: %d of %d orders are within the claim",
           name, within, ORDERS);
    return sqrt(squares);
}

int main(int argc, char **argv)
{
    comm_start(&world_comm, &argc, &argv);
    struct vec3 low = point(0, 1.05, 0), high = point(0, 1.95, 0.015);
    struct vec3 key = point(0, 1.6, 1.0), end = point(0, 1.61, 1.03);
    test_opening("gap below a door", 0.04, low, high, false, 2.505e-4, false);
    test_opening("gap over one floor", 0.04, low, high, true, 2.179e-4, false);
    test_opening("thin one", 0.0, low, high, true, 7.653e-4, false);
    test_opening("wide one", 0.1, low, high, true, 7.474e-5, false);
    test_opening("one in a thick wall", 0.2, low, high, true, 2.945e-5, false);
    test_opening("gap below a thin door", 0.0, low, high, false, 9.422e-4, true);
    test_opening("keyhole", 0.04, key, end, false, 2.938e-6, true);
    test_opening("keyhole in a thin wall", 0.0, key, end, false, 3.204e-5, true);
    high.z = 0.06;
    double coarse =
        test_opening("gap four times as high", 0.04, low, high, false, 2.417e-3, false);
    rays *= 4;
    double fine =
        test_opening("the same by more rays", 0.04, low, high, false, 2.417e-3, false);
    tap_ok(fine < coarse, "more rays leave %.1f %% of %.1f", 100.0 * fine,
           100.0 * coarse);
    comm_stop(&world_comm);
    return tap_done();
}
