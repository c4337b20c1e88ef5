/* BiCGSTAB (van der Vorst, 1992). With r = b - A x and a fixed r0, each step is
 *
 *     v = A p     s = r - a v,  a = (r0, r) / (r0, v)
 *     t = A s     r' = s - o t,  o = (t, s) / (t, t)     x += a p + o s
 *     p' = r' + (r0, r') / (r0, r) (a / o) (p - o v).
 *
 * Scalar products are sums in fixed point, the same however ranks have the unknowns.
 * A solved band, or one with a denominator of 0, stands still; if all do so with a
 * residual left, the method begins afresh from there. */
#include "rad/beyond/bicgstab.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "geom/alloc.h"

struct vectors {
    struct rgb *r, *r0, *p, *v, *t;
    const struct totals *totals;
    const double *weights;
    double *terms;     /* [BANDS * count] buffer, of sums */
    int64_t count;
    double rho[BANDS]; /* (r0, r) */
};

/* Collective. (x, y). */
static struct rgb product(const struct vectors *z, const struct rgb *x,
                          const struct rgb *y)
{
    struct rgb sum;
    double *term = z->terms;
    for (int64_t i = 0; i < z->count; i++)
        for (int c = 0; c < BANDS; c++)
            *term++ = z->weights[i] * x[i].band[c] * y[i].band[c];
    total_up(z->totals, z->terms, z->count, BANDS, sum.band);
    return sum;
}

/* Collective. The residual over the solution. */
static double residual_of(const struct vectors *z, const struct rgb *x)
{
    double sums[2];
    for (int64_t i = 0; i < z->count; i++) {
        double *term = z->terms + 2 * i;
        term[0] = term[1] = 0.0;
        for (int c = 0; c < BANDS; c++) {
            term[0] += z->weights[i] * fabs(z->r[i].band[c]);
            term[1] += z->weights[i] * fabs(x[i].band[c]);
        }
    }
    total_up(z->totals, z->terms, z->count, 2, sums);
    return sums[1] > 0.0 ? sums[0] / sums[1] : 0.0;
}

/* y += factor x, band by band. */
static void add(struct rgb *y, const struct rgb *x, struct rgb factor, int64_t count)
{
    for (int64_t i = 0; i < count; i++)
        rgb_add(&y[i], 1.0, rgb_times(factor, x[i]));
}

/* a / b, or 0 where the quotient is infinite, undefined or huge. */
static double quotient(double a, double b)
{
    double q = a / b;
    return b != 0.0 && fabs(q) < 1e30 ? q : 0.0;
}

static void begin(struct vectors *z)
{
    memcpy(z->r0, z->r, (size_t)z->count * sizeof *z->r);
    memcpy(z->p, z->r, (size_t)z->count * sizeof *z->r);
    struct rgb rho = product(z, z->r0, z->r);
    memcpy(z->rho, rho.band, sizeof z->rho);
}

/* False if nothing has moved. */
static bool step(struct vectors *z, linear_map *map, void *context, struct rgb *x)
{
    struct rgb a, minus, o, turn;
    map(context, z->p, z->v);
    struct rgb under = product(z, z->r0, z->v);
    for (int c = 0; c < BANDS; c++) {
        a.band[c] = quotient(z->rho[c], under.band[c]);
        minus.band[c] = -a.band[c];
    }
    add(z->r, z->v, minus, z->count); /* s */
    map(context, z->r, z->t);
    struct rgb both = product(z, z->t, z->r), own = product(z, z->t, z->t);
    for (int c = 0; c < BANDS; c++) {
        o.band[c] = quotient(both.band[c], own.band[c]);
        minus.band[c] = -o.band[c];
    }
    add(x, z->p, a, z->count);
    add(x, z->r, o, z->count);
    add(z->r, z->t, minus, z->count);
    struct rgb rho = product(z, z->r0, z->r);
    bool moved = false;
    for (int c = 0; c < BANDS; c++) {
        turn.band[c] = quotient(rho.band[c], z->rho[c]) * quotient(a.band[c], o.band[c]);
        z->rho[c] = rho.band[c];
        moved = moved || a.band[c] != 0.0 || o.band[c] != 0.0;
    }
    add(z->p, z->v, minus, z->count);
    for (int64_t i = 0; i < z->count; i++)
        for (int c = 0; c < BANDS; c++)
            z->p[i].band[c] = z->r[i].band[c] + turn.band[c] * z->p[i].band[c];
    return moved;
}

struct bicgstab bicgstab_solve(linear_map *map, void *context,
                               const struct totals *totals, const double *weights,
                               int64_t count, struct bicgstab_end end, struct rgb *x,
                               struct rgb *r)
{
    struct rgb *room = alloc_array(4 * (size_t)count, sizeof *room);
    struct vectors z = {.r = r, .r0 = room, .p = room + count, .v = room + 2 * count,
                        .t = room + 3 * count, .totals = totals, .weights = weights,
                        .count = count};
    struct bicgstab done = {0, 0.0};
    bool fresh = true, moved = true;
    z.terms = alloc_array(BANDS * (size_t)count, sizeof *z.terms);
    for (;; done.steps++) {
        done.residual = residual_of(&z, x);
        if (done.steps == 0)
            end.residual = fmax(end.residual, end.part * done.residual);
        if (done.residual <= end.residual || done.steps == end.steps || (fresh && !moved))
            break;
        if (fresh)
            begin(&z);
        fresh = !step(&z, map, context, x);
        moved = !fresh;
    }
    alloc_free(z.terms);
    alloc_free(room);
    return done;
}
