/* A student's hemicube, as it is taught, with faults to plant.
 *
 *     hemicube CASES.csv [none|pi|area|cosine|centre|row|half]
 *
 * Prints id,value for each factor of polygons in the list. From points of the first
 * polygon the others are looked at through the pixels of half a cube: 64 x 64 above, and
 * 64 x 32 at each side; each pixel counts for the polygon that is met first, with its
 * part of the cosine-weighted hemisphere. Nothing of phr computes here: only the list is
 * read by it. */
#include <stdio.h>
#include <string.h>

#include "geom/contour.h"
#include "geom/triangle.h"
#include "tools/cases.h"

enum { PIXELS = 64, LEVEL = 2 };

struct fault {
    bool pi, area, cosine, centre, row, half;
};

static struct triangle part_of(const struct case_polygons *p, int32_t polygon, int32_t k)
{
    const struct vec3 *corner = p->corner[polygon];
    return (struct triangle){{corner[0], corner[k + 1], corner[k + 2]}};
}

/* Returns the distance at which a ray meets a triangle, or -1. */
static double meets(struct vec3 x, struct vec3 d, const struct triangle *t)
{
    struct vec3 u = vec3_sub(t->corner[1], t->corner[0]);
    struct vec3 v = vec3_sub(t->corner[2], t->corner[0]), w = vec3_sub(x, t->corner[0]);
    struct vec3 a = vec3_cross(d, v), b = vec3_cross(w, u);
    double det = vec3_dot(u, a);
    if (det == 0.0)
        return -1.0;
    double s = vec3_dot(w, a) / det, r = vec3_dot(d, b) / det;
    return s < 0.0 || r < 0.0 || s + r > 1.0 ? -1.0 : vec3_dot(v, b) / det;
}

/* The polygon met first, 0 if none; with `first`, none is behind another. */
static int32_t met_first(const struct case_polygons *p, struct vec3 x, struct vec3 d,
                         const struct fault *fault)
{
    double nearest = 1e300;
    int32_t met = 0;
    for (int32_t i = 1; i < (fault->centre ? 2 : p->count); i++)
        for (int32_t k = 0; k < (fault->half && i == 1 ? 1 : p->corners[i] - 2); k++) {
            struct triangle t = part_of(p, i, k);
            double r = meets(x, d, &t);
            if (r > 1e-12 && r < nearest) {
                nearest = r;
                met = i == 1 && vec3_dot(triangle_cross(&t), d) >= 0.0 ? 0 : i;
            }
        }
    return met;
}

/* Adds what is seen from a point, of polygon 1 and of all. */
static void look(const struct case_polygons *p, struct vec3 x, struct vec3 normal,
                 const struct fault *fault, double weight, double seen[2])
{
    struct vec3 side = fabs(normal.x) < 0.5 ? (struct vec3){1, 0, 0}
                                            : (struct vec3){0, 1, 0};
    struct vec3 u = vec3_unit(vec3_cross(normal, side)), v = vec3_cross(normal, u);
    double pixel = 2.0 / PIXELS;
    for (int face = 0; face < 5; face++)
        for (int i = 0; i < PIXELS; i++)
            for (int k = 0; k < (face ? PIXELS / 2 : PIXELS); k++) {
                double a = pixel * (i + 0.5) - 1.0;
                double b = pixel * (k + 0.5) - (face ? 0.0 : 1.0);
                double r2 = a * a + b * b + 1.0, high = face ? b : 1.0;
                double across[5][2] = {{a, b}, {1, a}, {-1, a}, {a, 1}, {a, -1}};
                struct vec3 d = vec3_add(vec3_scale(normal, high),
                                         vec3_add(vec3_scale(u, across[face][0]),
                                                  vec3_scale(v, across[face][1])));
                double part = pixel * pixel / (r2 * r2) * high;
                if (fault->cosine)
                    part *= sqrt(r2) / high;
                part *= weight / (fault->pi ? 1.0 : PI);
                int32_t met = met_first(p, x, d, fault);
                seen[0] += met == 1 ? part : 0.0;
                seen[1] += met > 0 ? part : 0.0;
            }
}

static void look_from(const struct case_polygons *p, const struct triangle *t, int level,
                      const struct fault *fault, double weight, double seen[2])
{
    if (level == 0)
        look(p, triangle_centroid(t), vec3_unit(triangle_cross(t)), fault, weight, seen);
    for (int k = 0; k < 4 && level > 0; k++) {
        struct triangle child = triangle_child(t, k);
        look_from(p, &child, level - 1, fault, 0.25 * weight, seen);
    }
}

static struct vec3 centre_of(const struct case_polygons *p, int32_t polygon)
{
    struct vec3 sum = {0.0, 0.0, 0.0};
    for (int32_t k = 0; k < p->corners[polygon]; k++)
        sum = vec3_add(sum, p->corner[polygon][k]);
    return vec3_scale(sum, 1.0 / p->corners[polygon]);
}

static bool centres_meet(const struct case_polygons *p)
{
    struct vec3 from = centre_of(p, 0), d = vec3_sub(centre_of(p, 1), from);
    for (int32_t i = 2; i < p->count; i++)
        for (int32_t k = 0; k < p->corners[i] - 2; k++) {
            struct triangle t = part_of(p, i, k);
            double r = meets(from, d, &t);
            if (r > 0.0 && r < 1.0)
                return false;
        }
    return true;
}

static double factor(const struct case_polygons *p, const struct fault *fault)
{
    double seen[2] = {0.0, 0.0}, area = polygon_area(p->corner[0], p->corners[0]);
    for (int32_t k = 0; k < p->corners[0] - 2; k++) {
        struct triangle t = part_of(p, 0, k);
        look_from(p, &t, LEVEL, fault, triangle_area(&t) / area, seen);
    }
    if (fault->centre && !centres_meet(p))
        return 0.0;
    if (fault->row && seen[1] > 0.0)
        return seen[0] / seen[1];
    return fault->area ? seen[0] * area / polygon_area(p->corner[1], p->corners[1])
                       : seen[0];
}

int main(int argc, char **argv)
{
    struct cases cases;
    struct error error = {0};
    const char *name = argc > 2 ? argv[2] : "none";
    struct fault fault = {.pi = !strcmp(name, "pi"), .area = !strcmp(name, "area"),
                          .cosine = !strcmp(name, "cosine"),
                          .centre = !strcmp(name, "centre"),
                          .row = !strcmp(name, "row"), .half = !strcmp(name, "half")};
    if (argc < 2 || !cases_read(&cases, argv[1], &error)) {
        fprintf(stderr, "usage: hemicube CASES.csv [FAULT]: %s\n", error.text);
        return 2;
    }
    for (int64_t i = 0; i < cases.count; i++) {
        struct case_polygons p;
        if (cases.items[i].what[0] == 'F' && case_polygons(&cases.items[i], &p))
            printf("%s,%.6g\n", cases.items[i].id, factor(&p, &fault));
    }
    cases_free(&cases);
    return 0;
}
