/* Tests of mpi/beyond/spotcheck.h: errors that are planted in an exact answer are found,
 * and no others. In a furnace, a closed cube whose faces emit E = 1 W/m^2 and reflect
 * the part rho of the arriving light, B - E is rho / (1 - rho) everywhere; the final
 * gather finds that within rounding. */
#include "mpi/beyond/beyond.h"
#include "mpi/beyond/spotcheck.h"

#include <math.h>

#include "tests/defaults.h"
#include "tests/tap.h"

static const double GOAL = 0.02;

static struct solution furnace(double rho)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), 1, true);
    paint(&soup, rho, 1.0);
    return solve_soup(&soup, "--max-level 2 --epsilon 1e-3");
}

/* Scales the reflected light of the leaves of some roots. */
static void spoil(struct solution *s, uint32_t roots, double factor)
{
    struct forest *forest = s->solver->model.forest;
    for (int64_t p = 0; p < forest->count; p++)
        if (forest->patches[p].id.root < roots)
            for (int c = 0; c < BANDS; c++)
                forest->radiosity[p].band[c] =
                    1.0 + factor * (forest->radiosity[p].band[c] - 1.0);
}

/* The square of the error is found, within 3 of the deviations that are told, which are
 * as small as promised. */
static void expect(struct solution *s, double square, const char *name)
{
    struct spotcheck check = spotcheck_run(s->solver, GOAL);
    double enough = 0.36 * fmax(check.square, 0.25 * GOAL * GOAL);
    tap_ok(check.done && check.paths >= check.leaves && check.rays >= check.paths &&
               fabs(check.square - square) <= 3.0 * check.doubt + 1e-9 &&
               check.doubt <= enough,
           "%s: %.3g, found %.3g +- %.2g by %lld paths", name, square, check.square,
           check.doubt, (long long)check.paths);
}

/* What is told of an error of 2 %, by rays and the mesh alike, becomes what a check finds
 * of it. Where that is nothing, or less, for it scatters, both parts are as large as its
 * doubt, and there is something left to tighten. */
static void test_settling(double square, bool clear, double rays, double mesh)
{
    const double even = sqrt(2e-4), doubt = 1e-4;
    struct gathered g = {.error = 0.02, .by_rays = even, .by_mesh = even};
    struct spotcheck check = {.square = square, .doubt = doubt};
    bool found = spotcheck_settle(&check, &g);
    tap_ok(found == clear && fabs(g.by_rays - rays) < 1e-12 &&
               fabs(g.by_mesh - mesh) < 1e-12 &&
               fabs(g.error - sqrt(fmax(0.0, square) + doubt)) < 1e-12,
           "%.2g +- %.2g in place of 0.02: %.4f by rays, %.4f by the mesh", square, doubt,
           g.by_rays, g.by_mesh);
}

int main(int argc, char **argv)
{
    comm_start(&world_comm, &argc, &argv);
    struct solution s = furnace(0.5), bright = furnace(0.999);
    expect(&s, 0.0, "an exact answer");
    spoil(&s, 12, 1.1);
    expect(&s, 0.01 / 1.21, "all leaves too bright by a tenth");
    spoil(&s, 12, 1.0 / 1.1);
    spoil(&s, 1, 1.5);
    expect(&s, 0.25 / (11.0 + 2.25), "one of twelve by a half");
    for (int64_t p = 0; p < s.solver->model.forest->count; p++)
        s.solver->beyond->answer->error[p] =
            s.solver->model.forest->patches[p].id.root == 0;
    expect(&s, 0.25 / (11.0 + 2.25), "which the estimate knows");
    solution_free(&s);
    expect(&bright, 0.0, "an exact answer, rho 0.999");
    spoil(&bright, 12, 1.1);
    expect(&bright, 0.01 / 1.21, "all leaves too bright by a tenth");
    solution_free(&bright);
    test_settling(1.6e-3, true, sqrt(2e-4), sqrt(1.4e-3));
    test_settling(3.6e-4, false, sqrt(1.8e-4), sqrt(1.8e-4));
    test_settling(-1e-4, false, sqrt(0.5e-4), sqrt(0.5e-4));
    comm_stop(&world_comm);
    return tap_done();
}
