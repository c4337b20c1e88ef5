/* Radiosity of two surfaces whose light depends on one coordinate, or two:
 *
 *     B_i(x) = E_i + rho_i (lamp_i(x) + sum over j of integral K_ij(x, y) B_j(y) dy)
 *
 * with kernels in closed form: plates, grooves, squares, tubes, discs. Solved by
 * Nystroem's method, on panels of 16 Gauss points that get finer to where surfaces meet,
 * and bounce after bounce; the same formula gives B between the points. */
#ifndef TESTS_EQUATION_H
#define TESTS_EQUATION_H

#include <math.h>

#include "geom/alloc.h"
#include "geom/triangle.h"
#include "geom/gauss.h"

enum { NODES_MAX = 1024, BOUNCES_MAX = 10000 };

struct node {
    int surface;
    double u, v, weight; /* coordinates, and size of the part that it stands for */
    double b;            /* radiosity, W/m^2 */
};

/* `size`: a distance, an angle or a length, by the shape. */
struct shape {
    double (*kernel)(double size, int to, double u, double v, const struct node *from);
    double (*lamp)(double size, double u); /* irradiance of surface 0, W/m^2; or NULL */
    void (*place)(double size, int surface, struct vec3 x, double *u, double *v);
};

struct equation {
    const struct shape *shape;
    double size, emission[2], rho[2]; /* of both surfaces */
    struct node node[NODES_MAX];
    int count;
};

static double cubed_root(double square)
{
    return square * sqrt(square);
}

static double plates_kernel(double h, int to, double u, double v, const struct node *from)
{
    (void)v;
    return to == from->surface
               ? 0.0
               : h * h / (2.0 * cubed_root(h * h + (u - from->u) * (u - from->u)));
}

static double squares_kernel(double h, int to, double u, double v,
                             const struct node *from)
{
    double d2 = h * h + (u - from->u) * (u - from->u) + (v - from->v) * (v - from->v);
    return to == from->surface ? 0.0 : h * h / (PI * d2 * d2);
}

static void plates_place(double h, int surface, struct vec3 x, double *u, double *v)
{
    (void)h, (void)surface;
    *u = x.x;
    *v = x.y;
}

static double groove_kernel(double angle, int to, double u, double v,
                            const struct node *from)
{
    double d2 = u * u + from->u * from->u - 2.0 * u * from->u * cos(angle),
           sine = sin(angle);
    (void)v;
    return to == from->surface ? 0.0 : sine * sine * u * from->u / (2.0 * cubed_root(d2));
}

static void groove_place(double angle, int surface, struct vec3 x, double *u, double *v)
{
    (void)angle, (void)surface;
    *u = sqrt(x.x * x.x + x.z * x.z);
    *v = 0.0;
}

/* Surface 0: the wall of a tube of radius 1; surface 1: its base at u = 0, u being the
 * radius. */
static double tube_kernel(double length, int to, double u, double v,
                          const struct node *from)
{
    (void)length, (void)v;
    if (to == 0 && from->surface == 0) {
        double x = 0.5 * fabs(u - from->u);
        return 0.5 - x * (2.0 * x * x + 3.0) / (4.0 * cubed_root(x * x + 1.0));
    }
    if (to == 1 && from->surface == 1)
        return 0.0;
    double z = to == 0 ? u : from->u, r = to == 1 ? u : from->u,
           sum = z * z + r * r + 1.0;
    double kernel = 2.0 * z * (z * z + 1.0 - r * r) / cubed_root(sum * sum - 4.0 * r * r);
    return to == 1 ? kernel : kernel * r;
}

/* A black end at u = 0 with E = 1. */
static double tube_lamp(double length, double u)
{
    double x = 0.5 * u;
    (void)length;
    return (x * x + 0.5) / sqrt(x * x + 1.0) - x;
}

/* Polygons with the area of the disc reach beyond it at their corners. Beyond the wall
 * the kernel is another one, and panels are not fine enough for the last 1e-5 before it:
 * B of a place next to it counts. */
static const double NEXT_TO_WALL = 1.0 - 1e-4;

static void tube_place(double length, int surface, struct vec3 x, double *u, double *v)
{
    (void)length;
    *u = surface == 0 ? x.z : fmin(NEXT_TO_WALL, sqrt(x.x * x.x + x.y * x.y));
    *v = 0.0;
}

static double discs_kernel(double h, int to, double u, double v, const struct node *from)
{
    double r = from->u, sum = h * h + u * u + r * r;
    (void)v;
    return to == from->surface
               ? 0.0
               : 2.0 * r * h * h * sum / cubed_root(sum * sum - 4.0 * u * u * r * r);
}

static void discs_place(double h, int surface, struct vec3 x, double *u, double *v)
{
    (void)surface;
    tube_place(h, 1, x, u, v);
}

static const struct shape PLATES = {plates_kernel, NULL, plates_place};
static const struct shape SQUARES = {squares_kernel, NULL, plates_place};
static const struct shape GROOVE = {groove_kernel, NULL, groove_place};
static const struct shape CAVITY = {tube_kernel, NULL, tube_place};
static const struct shape PIPE = {tube_kernel, tube_lamp, tube_place};
static const struct shape DISCS = {discs_kernel, NULL, discs_place};

enum { POINTS = 16 };

static void add_panel(struct equation *e, int surface, double low, double high)
{
    struct gauss rule = gauss_rule(POINTS);
    for (int k = 0; k < POINTS; k++) {
        struct node *node = &e->node[e->count++];
        double weight, at = gauss_point(&rule, k, &weight);
        *node = (struct node){.surface = surface,
                              .u = low + (high - low) * at,
                              .weight = fabs(high - low) * weight};
    }
}

/* Panels that double in width from `edge`, where another surface is met, to `end`. The
 * last 2^-panels at the edge are left out: their light matters only as near to it as
 * that. */
static void add_graded(struct equation *e, int surface, double edge, double end,
                       int panels)
{
    for (double part = ldexp(1.0, -panels); part < 1.0; part *= 2.0)
        add_panel(e, surface, edge + (end - edge) * part,
                  edge + (end - edge) * 2.0 * part);
}

static void add_even(struct equation *e, int surface, double end, int panels)
{
    for (int k = 0; k < panels; k++)
        add_panel(e, surface, end * k / panels, end * (k + 1) / panels);
}

static void add_square(struct equation *e, int surface)
{
    struct gauss rule = gauss_rule(POINTS);
    for (int k = 0; k < POINTS; k++) {
        double weight, at = gauss_point(&rule, k, &weight);
        int first = e->count;
        add_panel(e, surface, 0.0, 1.0);
        for (int i = first; i < e->count; i++) {
            e->node[i].v = at;
            e->node[i].weight *= weight;
        }
    }
}

/* B at a place, by the nodes. */
static double light_at(const struct equation *e, int surface, double u, double v)
{
    double h = e->shape->lamp && surface == 0 ? e->shape->lamp(e->size, u) : 0.0;
    for (int i = 0; i < e->count; i++)
        h += e->node[i].weight * e->node[i].b *
             e->shape->kernel(e->size, surface, u, v, &e->node[i]);
    return e->emission[surface] + e->rho[surface] * h;
}

static void equation_solve(struct equation *e)
{
    size_t n = (size_t)e->count;
    double *row = alloc_array(n * n, sizeof *row), *start = alloc_array(n, sizeof *start);
    double *next = alloc_array(n, sizeof *next), change = 1.0;
    for (size_t i = 0; i < n; i++) {
        const struct node *to = &e->node[i];
        start[i] = light_at(e, to->surface, to->u, to->v); /* all b are 0 */
        for (size_t j = 0; j < n; j++)
            row[i * n + j] =
                e->rho[to->surface] * e->node[j].weight *
                e->shape->kernel(e->size, to->surface, to->u, to->v, &e->node[j]);
    }
    for (int bounce = 0; bounce < BOUNCES_MAX && change > 1e-12; bounce++) {
        change = 0.0;
        for (size_t i = 0; i < n; i++) {
            next[i] = start[i];
            for (size_t j = 0; j < n; j++)
                next[i] += row[i * n + j] * e->node[j].b;
        }
        for (size_t i = 0; i < n; i++) {
            change = fmax(change, fabs(next[i] - e->node[i].b));
            e->node[i].b = next[i];
        }
    }
    alloc_free(row);
    alloc_free(start);
    alloc_free(next);
}

/* Solved. To be freed with alloc_free(). */
static struct equation *equation_make(const struct shape *shape, double size,
                                      const double emission[2], const double rho[2])
{
    struct equation *e = alloc_array(1, sizeof *e);
    e->shape = shape;
    e->size = size;
    for (int k = 0; k < 2; k++) {
        e->emission[k] = emission[k];
        e->rho[k] = rho[k];
    }
    for (int k = 0; k < 2 && shape == &SQUARES; k++)
        add_square(e, k);
    for (int k = 0; k < 2 && (shape == &PLATES || shape == &DISCS); k++)
        add_even(e, k, 1.0, 16);
    for (int k = 0; k < 2 && shape == &GROOVE; k++)
        add_graded(e, k, 0.0, 1.0, 24);
    if (shape == &CAVITY) {
        add_graded(e, 0, 0.0, 0.125 * size, 20);
        for (int k = 2; k < 16; k++)
            add_panel(e, 0, size * k / 16.0, size * (k + 1) / 16.0);
        add_graded(e, 1, 1.0, 0.0, 20);
    }
    if (shape == &PIPE)
        add_even(e, 0, size, 24);
    equation_solve(e);
    return e;
}

/* Over the area of a surface. */
static double equation_mean(const struct equation *e, int surface)
{
    bool round = e->shape == &DISCS || (e->shape == &CAVITY && surface == 1);
    double sum = 0.0, area = 0.0;
    for (int i = 0; i < e->count; i++)
        if (e->node[i].surface == surface) {
            double part = e->node[i].weight * (round ? e->node[i].u : 1.0);
            sum += part * e->node[i].b;
            area += part;
        }
    return sum / area;
}

/* The error of `sides` plane sides in place of round ones: they have the area of a
 * circle of radius 1, and the radius of the circle in them is less by (2 pi / sides)^2 /
 * 12. The relative difference of B, if that is the radius. */
static double cost_of_sides(const struct equation *e, int sides)
{
    struct equation *in =
        equation_make(e->shape, e->size * (1.0 + pow(2.0 * PI / sides, 2.0) / 12.0),
                      e->emission, e->rho);
    double cost = 0.0;
    for (int i = 0; i < e->count; i++)
        cost = fmax(cost, fabs(in->node[i].b / e->node[i].b - 1.0));
    alloc_free(in);
    return cost;
}

#endif
