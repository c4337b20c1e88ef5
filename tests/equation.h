/* Radiosity of two surfaces that face each other:
 *
 *     B_i(x) = E_i + rho_i integral K(x, y) B_j(y) dy
 *
 * with kernels in closed form: the walls of an endless groove, and parallel squares.
 * Solved by Nystroem's method, on panels of 16 Gauss points that get finer to where
 * surfaces meet, and bounce after bounce; the same formula gives B between the points. */
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

/* `size`: a distance, or an angle. */
struct shape {
    double (*kernel)(double size, double u, double v, const struct node *from);
    void (*place)(struct vec3 x, double *u, double *v);
};

struct equation {
    const struct shape *shape;
    double size, emission[2], rho[2]; /* of both surfaces */
    struct node node[NODES_MAX];
    int count;
};

static double squares_kernel(double h, double u, double v, const struct node *from)
{
    double d2 = h * h + (u - from->u) * (u - from->u) + (v - from->v) * (v - from->v);
    return h * h / (PI * d2 * d2);
}

static void squares_place(struct vec3 x, double *u, double *v)
{
    *u = x.x;
    *v = x.y;
}

static double groove_kernel(double angle, double u, double v, const struct node *from)
{
    double d2 = u * u + from->u * from->u - 2.0 * u * from->u * cos(angle),
           sine = sin(angle);
    (void)v;
    return sine * sine * u * from->u / (2.0 * d2 * sqrt(d2));
}

static void groove_place(struct vec3 x, double *u, double *v)
{
    *u = sqrt(x.x * x.x + x.z * x.z);
    *v = 0.0;
}

static const struct shape SQUARES = {squares_kernel, squares_place};
static const struct shape GROOVE = {groove_kernel, groove_place};

enum { POINTS = 16 };

static void add_panel(struct equation *e, int surface, double low, double high)
{
    struct gauss rule = gauss_rule(POINTS);
    for (int k = 0; k < POINTS; k++) {
        struct node *node = &e->node[e->count++];
        double weight, at = gauss_point(&rule, k, &weight);
        *node = (struct node){.surface = surface,
                              .u = low + (high - low) * at,
                              .weight = (high - low) * weight};
    }
}

/* Panels that double in width from the edge, where the other wall is met. The last 2^-24
 * there is left out: its light matters only as near to it as that. */
static void add_wall(struct equation *e, int surface)
{
    for (double part = 0x1p-24; part < 1.0; part *= 2.0)
        add_panel(e, surface, part, 2.0 * part);
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
    double h = 0.0;
    for (int i = 0; i < e->count; i++)
        if (e->node[i].surface != surface)
            h += e->node[i].weight * e->node[i].b *
                 e->shape->kernel(e->size, u, v, &e->node[i]);
    return e->emission[surface] + e->rho[surface] * h;
}

static void equation_solve(struct equation *e)
{
    double next[NODES_MAX], change = 1.0;
    for (int bounce = 0; bounce < BOUNCES_MAX && change > 1e-12; bounce++) {
        change = 0.0;
        for (int i = 0; i < e->count; i++)
            next[i] = light_at(e, e->node[i].surface, e->node[i].u, e->node[i].v);
        for (int i = 0; i < e->count; i++) {
            change = fmax(change, fabs(next[i] - e->node[i].b));
            e->node[i].b = next[i];
        }
    }
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
        (shape == &GROOVE ? add_wall : add_square)(e, k);
    }
    equation_solve(e);
    return e;
}

/* Over the area of a surface. */
static double equation_mean(const struct equation *e, int surface)
{
    double sum = 0.0, area = 0.0;
    for (int i = 0; i < e->count; i++)
        if (e->node[i].surface == surface) {
            sum += e->node[i].weight * e->node[i].b;
            area += e->node[i].weight;
        }
    return sum / area;
}

#endif
