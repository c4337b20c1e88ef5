/* Tests of rad/beyond/bicgstab.h: systems whose solution is known. */
#include "rad/beyond/bicgstab.h"

#include <math.h>
#include <string.h>

#include "tests/random.h"
#include "tests/tap.h"

enum { SIZE = 60 };

static const struct totals ALONE = {.terms = SIZE};

/* x - scale[band] M x; rows of M sum to 1 at most. */
struct system {
    double m[SIZE][SIZE];
    double scale[BANDS];
    int products;
};

static void apply(void *context, const struct rgb *x, struct rgb *y)
{
    struct system *s = context;
    s->products++;
    for (int i = 0; i < SIZE; i++)
        for (int c = 0; c < BANDS; c++) {
            double sum = 0.0;
            for (int j = 0; j < SIZE; j++)
                sum += s->m[i][j] * x[j].band[c];
            y[i].band[c] = x[i].band[c] - s->scale[c] * sum;
        }
}

/* Rows of a closed scene: they sum to 1, and are not symmetric. */
static void fill(struct system *s, struct random *random)
{
    for (int i = 0; i < SIZE; i++) {
        double sum = 0.0;
        for (int j = 0; j < SIZE; j++) {
            s->m[i][j] = j == i ? 0.0 : pow(random_unit(random), 6.0);
            sum += s->m[i][j];
        }
        for (int j = 0; j < SIZE; j++)
            s->m[i][j] /= sum;
    }
}

static double worst_of(const struct rgb *a, const struct rgb *b)
{
    double worst = 0.0;
    for (int i = 0; i < SIZE; i++)
        for (int c = 0; c < BANDS; c++)
            worst = fmax(worst, fabs(a[i].band[c] / b[i].band[c] - 1.0));
    return worst;
}

/* The sum of weight |b - A x| over that of weight |x|. */
static double residual_of(struct system *s, const struct rgb *b, const double *weights,
                          const struct rgb *x)
{
    struct rgb y[SIZE];
    double left = 0.0, size = 0.0;
    apply(s, x, y);
    for (int i = 0; i < SIZE; i++)
        for (int c = 0; c < BANDS; c++) {
            left += weights[i] * fabs(b[i].band[c] - y[i].band[c]);
            size += weights[i] * fabs(x[i].band[c]);
        }
    return left / size;
}

/* r = b - A x. */
static void set_residual(struct system *s, const struct rgb *b, const struct rgb *x,
                         struct rgb *r)
{
    apply(s, x, r);
    for (int i = 0; i < SIZE; i++)
        for (int c = 0; c < BANDS; c++)
            r[i].band[c] = b[i].band[c] - r[i].band[c];
}

/* Steps taken from x = 1 on until `part` of the first residual is left, and at most
 * `most`; `left` becomes what is left, as a part. */
static int steps_to(struct system *s, const struct rgb *b, const double *weights,
                    double part, int most, double *left)
{
    struct rgb x[SIZE], r[SIZE];
    for (int i = 0; i < SIZE; i++)
        x[i] = (struct rgb){{1.0, 1.0, 1.0}};
    set_residual(s, b, x, r);
    double first = residual_of(s, b, weights, x);
    struct bicgstab_end end = {.part = part, .steps = most};
    struct bicgstab done = bicgstab_solve(apply, s, &ALONE, weights, SIZE, end, x, r);
    *left = done.residual / first;
    return done.steps;
}

/* A part is reached with the step that leaves less, neither sooner nor later. */
static void test_part(struct system *s, const struct rgb *b, const double *weights)
{
    enum { STEPS = 3 };
    double left, ignored;
    steps_to(s, b, weights, 0.0, STEPS, &left);
    int reached = steps_to(s, b, weights, 1.01 * left, 200, &ignored),
        missed = steps_to(s, b, weights, 0.99 * left, 200, &ignored);
    tap_ok(reached == STEPS && missed > STEPS,
           "down to 1.01 and 0.99 of what %d steps leave, %.2g: %d and %d steps", STEPS,
           left, reached, missed);
}

static void test_known(struct random *random, struct system *s, double bright)
{
    struct rgb truth[SIZE], b[SIZE], x[SIZE], r[SIZE];
    double weights[SIZE];
    for (int i = 0; i < SIZE; i++) {
        weights[i] = 0.01 + random_unit(random);
        for (int c = 0; c < BANDS; c++) {
            truth[i].band[c] = 1.0 + random_unit(random);
            x[i].band[c] = 1.0;
        }
    }
    s->scale[0] = bright;
    s->scale[1] = 0.5;
    s->scale[2] = 0.0; /* solved after half a step */
    apply(s, truth, b);
    test_part(s, b, weights);
    set_residual(s, b, x, r);
    struct bicgstab_end end = {.residual = 1e-13, .steps = 1};
    struct bicgstab done = bicgstab_solve(apply, s, &ALONE, weights, SIZE, end, x, r);
    double own = residual_of(s, b, weights, x);
    tap_ok(done.steps == 1 && fabs(done.residual / own - 1.0) < 1e-9,
           "bright %g: a residual of %.2e after one step", bright, done.residual);
    end = (struct bicgstab_end){.residual = 1e-13, .part = 0.03, .steps = 200};
    done = bicgstab_solve(apply, s, &ALONE, weights, SIZE, end, x, r);
    double part = residual_of(s, b, weights, x) / own;
    /* A step or two are enough for that part, and leave more than the goal. */
    tap_ok(part <= 0.03 && part * own > 1e-13, "%.2g of it is left after %d steps more",
           part, done.steps);
    s->products = 0;
    end.part = 0.0;
    done = bicgstab_solve(apply, s, &ALONE, weights, SIZE, end, x, r);
    /* The residual is amplified by 1 / (1 - bright) at most. */
    tap_ok(worst_of(x, truth) <= 1e-12 / (1.0 - bright) && done.residual <= 1e-13,
           "solved after %d steps, off by %.1e", done.steps, worst_of(x, truth));
    tap_ok(s->products == 2 * done.steps, "two products a step: %d", s->products);
    double before = worst_of(x, truth);
    end.residual = 1e-12;
    done = bicgstab_solve(apply, s, &ALONE, weights, SIZE, end, x, r);
    tap_ok(done.steps == 0 && worst_of(x, truth) == before,
           "a band that is solved stays as it is");
    memset(r, 0, sizeof r);
    memset(x, 0, sizeof x);
    end.residual = 0.0;
    done = bicgstab_solve(apply, s, &ALONE, weights, SIZE, end, x, r);
    tap_ok(done.steps == 0 && done.residual == 0.0, "no light, no step");
}

/* A product that is 0 has no solution: the method ends and makes no numbers that are
 * none. */
static void zero(void *context, const struct rgb *x, struct rgb *y)
{
    (void)context;
    (void)x;
    memset(y, 0, SIZE * sizeof *y);
}

static void test_hopeless(void)
{
    struct rgb r[SIZE], x[SIZE];
    double weights[SIZE];
    for (int i = 0; i < SIZE; i++) {
        r[i] = x[i] = (struct rgb){{1.0, 1.0, 1.0}};
        weights[i] = 1.0;
    }
    struct bicgstab_end end = {.residual = 1e-9, .steps = 50};
    struct bicgstab done = bicgstab_solve(zero, NULL, &ALONE, weights, SIZE, end, x, r);
    bool finite = true;
    for (int i = 0; i < SIZE; i++)
        finite = finite && isfinite(x[i].band[0]);
    tap_ok(done.residual > 0.5 && finite && done.steps <= 2,
           "without a solution it ends, after %d steps, and says so", done.steps);
}

int main(void)
{
    static struct system system;
    struct random random = {.state = 5};
    fill(&system, &random);
    test_known(&random, &system, 0.5);
    test_known(&random, &system, 0.999);
    test_hopeless();
    return tap_done();
}
