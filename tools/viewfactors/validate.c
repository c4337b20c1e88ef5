/* Form factors against exact answers.
 *
 * Each case is a pair of polygons with a known form factor. Four methods compute it:
 *
 *     disk 1     one ray: A A' cos cos' / (pi r^2 + max(A, A')) between the centroids
 *     disk 16    the same between 4 x 4 sub-areas, by rad/formfactor.c
 *     polygon    Lambert's formula from the centroids of the 4 children of the smaller
 *                patch to the larger one; from 12 points if near
 *     exact      the contour integral of geom/contour.c
 *
 * The first three work on triangles: a quadrilateral is two triangles, and pairs add.
 * Their error depends on the distance of the centres in sums of the radii, so each states
 * its error from some distance on. Errors of nearer pairs, which the solver has to split,
 * are shown in brackets.
 *
 * Polygons are scaled into the unit cube, in which the solver works, too. */
#include "tools/viewfactors/validate.h"

#include <math.h>
#include <stdlib.h>

#include "geom/alloc.h"
#include "geom/contour.h"
#include "geom/lambert.h"
#include "rad/beyond/patch_exchange.h"

/* --- cases --- */

enum { CASE_CORNERS = 4 };

/* Two polygons and the form factor from the first to the second. */
struct pair_case {
    const char *id, *text;
    double polygons[2 * (1 + 3 * CASE_CORNERS)]; /* of each the number of its corners, and
                                                    these, seen counter-clockwise */
    double factor; /* 1; exact in all digits */
};

/* P to Z were computed with 30 digits and more: parallel (P), perpendicular (L) and
 * hinged pairs (W), slivers and needles (S), general pairs (G), far ones (F), and pairs
 * without exchange (Z). E are closed forms of Howell's catalogue (C-11: aligned parallel
 * rectangles; C-14: perpendicular ones with a common edge) and their sums and differences
 * over rectangles; the tilted triangles are integrals over both by Gauss' rule of 12 x 12
 * points each, with 25 digits. */
static const struct pair_case PAIR_CASES[] = {
#include "tools/viewfactors/cases.inc"
};
enum { PAIR_CASE_COUNT = sizeof PAIR_CASES / sizeof PAIR_CASES[0] };

/* A case in the unit cube. */
struct prepared {
    const struct pair_case *known;
    int32_t count[2];
    struct vec3 corner[2][CASE_CORNERS];
    int facets[2];
    struct facet facet[2][CASE_CORNERS - 2];
    double area;  /* of the first polygon */
    double apart; /* distance of the centres in sums of the radii */
};

/* Takes the corners, from the first one on. Returns the largest coordinate. */
static double take_corners(struct prepared *pair)
{
    const double *at = pair->known->polygons, *first = at + 1;
    double extent = 0.0;
    for (int side = 0; side < 2; side++) {
        pair->count[side] = (int32_t)*at++;
        for (int32_t k = 0; k < pair->count[side]; k++, at += 3) {
            struct vec3 r = {at[0] - first[0], at[1] - first[1], at[2] - first[2]};
            extent = fmax(extent, fmax(fabs(r.x), fmax(fabs(r.y), fabs(r.z))));
            pair->corner[side][k] = r;
        }
    }
    return extent;
}

static struct vec3 centre_of(const struct vec3 *corner, int32_t count, double *radius)
{
    struct vec3 sum = {0.0, 0.0, 0.0};
    for (int32_t k = 0; k < count; k++)
        sum = vec3_add(sum, corner[k]);
    struct vec3 centre = vec3_scale(sum, 1.0 / count);
    *radius = 0.0;
    for (int32_t k = 0; k < count; k++)
        *radius = fmax(*radius, vec3_length(vec3_sub(corner[k], centre)));
    return centre;
}

static struct facet facet_of(const struct vec3 *corner, int k)
{
    struct triangle t = {{corner[0], corner[k + 1], corner[k + 2]}};
    return (struct facet){t, triangle_plane(&t), triangle_area(&t), -1};
}

static struct prepared pair_make(const struct pair_case *known)
{
    struct prepared pair = {.known = known};
    int exponent;
    double radius[2];
    frexp(take_corners(&pair), &exponent);
    for (int side = 0; side < 2; side++) {
        struct vec3 *corner = pair.corner[side];
        for (int32_t k = 0; k < pair.count[side]; k++)
            corner[k] = vec3_scale(corner[k], ldexp(1.0, -exponent));
        pair.facets[side] = pair.count[side] - 2;
        for (int k = 0; k < pair.facets[side]; k++)
            pair.facet[side][k] = facet_of(corner, k);
    }
    struct vec3 a = centre_of(pair.corner[0], pair.count[0], &radius[0]);
    struct vec3 b = centre_of(pair.corner[1], pair.count[1], &radius[1]);
    pair.apart = vec3_length(vec3_sub(b, a)) / (radius[0] + radius[1]);
    pair.area = polygon_area(pair.corner[0], pair.count[0]);
    return pair;
}

/* --- the methods --- */

static double by_one_disk(const struct facet *p, const struct facet *q)
{
    struct vec3 d =
        vec3_sub(triangle_centroid(&q->triangle), triangle_centroid(&p->triangle));
    double rise_p = vec3_dot(p->plane.normal, d), rise_q = -vec3_dot(q->plane.normal, d);
    if (rise_p <= 0.0 || rise_q <= 0.0)
        return 0.0;
    double r2 = vec3_dot(d, d);
    double g =
        p->area * q->area * (rise_p * rise_q / r2) / (PI * r2 + fmax(p->area, q->area));
    return fmin(g, fmin(p->area, q->area));
}

static double by_disks(const struct facet *p, const struct facet *q)
{
    struct octree *empty = octree_create(NULL, NULL, 0);
    struct octree_counts counts = {0};
    int32_t blocker = -1;
    double seen, g = exchange_area(p, q, empty, &blocker, &seen, &counts);
    octree_destroy(empty);
    return g;
}

static double by_polygon(const struct facet *p, const struct facet *q)
{
    struct octree *empty = octree_create(NULL, NULL, 0);
    struct octree_counts counts = {0};
    struct visibility visibility = {.blocker = -1};
    double g = exchange_estimate(p, q, empty, &visibility, &counts).area;
    octree_destroy(empty);
    return g;
}

/* The stated error of a method from some distance on: both bounds hold. */
struct promise {
    double from;               /* in sums of the radii */
    double relative, absolute; /* errors of F */
};

enum { METHODS = 4, PROMISES = 3 };

struct estimate {
    const char *name;
    double (*exchange)(const struct facet *p, const struct facet *q); /* NULL: exact */
    int promises;
    struct promise promise[PROMISES]; /* nearest first */
};

/* Measured errors and up to a quarter more; the error of `exact` is stated in
 * geom/contour.h. */
static const struct estimate ESTIMATES[METHODS] = {
    {"disk 1", by_one_disk, 2, {{1.0, 0.3, 1.0}, {3.0, 0.02, 1.0}}},
    {"disk 16", by_disks, 2, {{1.0, 0.08, 1.0}, {3.0, 0.005, 1.0}}},
    {"polygon",
     by_polygon,
     3,
     {{0.5, 0.032, 1.0}, {1.0, 0.025, 1.0}, {3.0, 0.0025, 1.0}}},
    {"exact", NULL, 1, {{0.0, 1e-6, 1e-11}}},
};

/* The form factor from the first polygon to the second. */
static double factor_by(const struct estimate *estimate, const struct prepared *pair)
{
    if (!estimate->exchange)
        return polygon_exchange(pair->corner[0], pair->count[0], pair->corner[1],
                                pair->count[1]) / pair->area;
    double sum = 0.0;
    for (int i = 0; i < pair->facets[0]; i++)
        for (int j = 0; j < pair->facets[1]; j++)
            if (facets_face(&pair->facet[0][i], &pair->facet[1][j]))
                sum += estimate->exchange(&pair->facet[0][i], &pair->facet[1][j]);
    return sum / pair->area;
}

/* --- the table --- */

/* One method on one case. */
struct outcome {
    double relative; /* error of F, relative to F; of F = 0, absolute */
    double absolute; /* error of F */
};

static struct outcome outcome_of(const struct estimate *estimate,
                                 const struct prepared *pair)
{
    double right = pair->known->factor, value = factor_by(estimate, pair);
    return (struct outcome){right > 0.0 ? value / right - 1.0 : value, value - right};
}

static bool is_kept(const struct promise *promise, const struct prepared *pair,
                    const struct outcome *outcome)
{
    return pair->apart < promise->from || (fabs(outcome->relative) <= promise->relative &&
                                           fabs(outcome->absolute) <= promise->absolute);
}

/* Prints an error in per cent, or as a power of ten if small; in brackets if none is
 * stated. */
static void print_error(FILE *file, double error, bool stated)
{
    char number[20], cell[24];
    if (error == 0.0)
        snprintf(number, sizeof number, "0");
    else if (fabs(error) >= 0.0005)
        snprintf(number, sizeof number, "%+.*f %%", fabs(error) < 1.0 ? 2 : 0,
                 100.0 * error);
    else
        snprintf(number, sizeof number, "%+.0e", error);
    snprintf(cell, sizeof cell, stated ? "%s " : "(%s)", number);
    fprintf(file, " %11s", cell);
}

static void print_pair(FILE *file, const struct prepared *pair,
                       const struct outcome *outcomes)
{
    fprintf(file, "%s %-48s %11.6g %8.3g", pair->known->id, pair->known->text,
            pair->known->factor, pair->apart);
    bool kept = true;
    for (int m = 0; m < METHODS; m++) {
        const struct estimate *estimate = &ESTIMATES[m];
        print_error(file, outcomes[m].relative, pair->apart >= estimate->promise[0].from);
        for (int k = 0; k < estimate->promises; k++)
            kept = kept && is_kept(&estimate->promise[k], pair, &outcomes[m]);
    }
    fputs(kept ? "\n" : " FAIL\n", file);
}

/* --- the summary --- */

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Prints median, 90th percentile and worst error of all cases with an exchange. */
static void print_spread(FILE *file, const struct estimate *estimate,
                         const struct outcome *outcomes)
{
    double *errors = alloc_array((size_t)PAIR_CASE_COUNT, sizeof *errors);
    int count = 0;
    for (int i = 0; i < PAIR_CASE_COUNT; i++)
        if (PAIR_CASES[i].factor > 0.0)
            errors[count++] = fabs(outcomes[METHODS * i].relative);
    qsort(errors, (size_t)count, sizeof *errors, compare_doubles);
    fprintf(file, "%-10s", estimate->name);
    print_error(file, errors[count / 2], true);
    print_error(file, errors[9 * count / 10], true);
    print_error(file, errors[count - 1], true);
    fputs("\n", file);
    alloc_free(errors);
}

/* Prints a line for a stated error. Returns true if the statement holds. */
static bool print_promise(FILE *file, const struct estimate *estimate,
                          const struct promise *promise, const struct outcome *outcomes)
{
    int cases = 0, broken = 0, worst = 0;
    double most = -1.0;
    for (int i = 0; i < PAIR_CASE_COUNT; i++) {
        const struct outcome *outcome = &outcomes[METHODS * i];
        struct prepared pair = pair_make(&PAIR_CASES[i]);
        if (pair.apart < promise->from)
            continue;
        cases++;
        broken += !is_kept(promise, &pair, outcome);
        if (fabs(outcome->relative) > most) {
            most = fabs(outcome->relative);
            worst = i;
        }
    }
    fprintf(file, "%-10s %11.1f  %10d ", estimate->name, promise->from, cases);
    print_error(file, most, true);
    fprintf(file, " %5s ", PAIR_CASES[worst].id);
    print_error(file, promise->relative, true);
    fputs(broken == 0 ? "    pass\n" : "    FAIL\n", file);
    return broken == 0;
}

static bool print_summary(FILE *file, const struct outcome *outcomes)
{
    fprintf(file, "\n%-10s %10s  %10s  %10s\n", "all cases", "median", "90 %", "worst");
    for (int m = 0; m < METHODS; m++)
        print_spread(file, &ESTIMATES[m], &outcomes[m]);
    fprintf(file, "\n%-10s %11s  %10s  %10s  %6s  %10s\n", "stated", "apart from",
            "cases", "worst", "in", "at most");
    bool kept = true;
    for (int m = 0; m < METHODS; m++)
        for (int k = 0; k < ESTIMATES[m].promises; k++)
            kept &= print_promise(file, &ESTIMATES[m], &ESTIMATES[m].promise[k],
                                  &outcomes[m]);
    return kept;
}

static bool print_pairs(FILE *file)
{
    struct outcome *outcomes =
        alloc_array((size_t)(METHODS * PAIR_CASE_COUNT), sizeof *outcomes);
    fprintf(file, "%-52s %11s %8s", "form factor from one polygon to another", "exact",
            "apart");
    for (int m = 0; m < METHODS; m++)
        fprintf(file, "  %10s", ESTIMATES[m].name);
    fputs("\n", file);
    for (int i = 0; i < PAIR_CASE_COUNT; i++) {
        struct prepared pair = pair_make(&PAIR_CASES[i]);
        for (int m = 0; m < METHODS; m++)
            outcomes[METHODS * i + m] = outcome_of(&ESTIMATES[m], &pair);
        print_pair(file, &pair, &outcomes[METHODS * i]);
    }
    bool kept = print_summary(file, outcomes);
    alloc_free(outcomes);
    return kept;
}

/* --- points --- */

/* Illuminances of CIE 171:2006, 5.3: at a point of a room of 4 x 4 x 3 m, by a light of 1
 * x 1 m and 1000 cd/m^2 in the middle of its ceiling. */
struct point_case {
    const char *text;
    struct vec3 x;      /* m */
    struct vec3 normal; /* 1 */
    double exact;       /* lx */
    double printed;     /* lx, as rounded in the report */
};

static const struct point_case POINT_CASES[] = {
    {"wall, z = 2.75", {2, 0, 2.75}, {0, 1, 0}, 32.676898014391845, 32.68},
    {"wall, z = 2.25", {2, 0, 2.25}, {0, 1, 0}, 75.19392456629544, 75.09},
    {"wall, z = 1.75", {2, 0, 1.75}, {0, 1, 0}, 81.32317212494463, 81.38},
    {"wall, z = 1.25", {2, 0, 1.25}, {0, 1, 0}, 69.06062701304937, 69.12},
    {"wall, z = 0.75", {2, 0, 0.75}, {0, 1, 0}, 53.4035311081542, 53.41},
    {"wall, z = 0.25", {2, 0, 0.25}, {0, 1, 0}, 40.001852019851064, 39.90},
    {"floor, y = 0.25", {2, 0.25, 0}, {0, 0, 1}, 61.424098538461486, 61.27},
    {"floor, y = 0.75", {2, 0.75, 0}, {0, 0, 1}, 79.25515731623122, 79.18},
    {"floor, y = 1.25", {2, 1.25, 0}, {0, 0, 1}, 95.66727633333511, 95.52},
    {"floor, y = 1.75", {2, 1.75, 0}, {0, 0, 1}, 105.77824217629438, 105.89},
};
enum { POINT_CASE_COUNT = sizeof POINT_CASES / sizeof POINT_CASES[0] };

static const struct vec3 CIE_LIGHT[4] = {
    {1.5, 1.5, 3}, {1.5, 2.5, 3}, {2.5, 2.5, 3}, {2.5, 1.5, 3}};

/* The error stated in geom/lambert.h. */
static const double POINT_BOUND = 1e-9;

static bool print_points(FILE *file)
{
    bool good = true;
    fprintf(file, "\n%-52s %11s %8s  %10s\n", "CIE 171:2006, 5.3: illuminance in lx",
            "exact", "printed", "polygon");
    for (int i = 0; i < POINT_CASE_COUNT; i++) {
        const struct point_case *known = &POINT_CASES[i];
        double factor = point_polygon_factor(known->x, known->normal, CIE_LIGHT, 4);
        double error = 1000.0 * PI * factor / known->exact - 1.0;
        fprintf(file, "%-52s %11.6f %8.2f", known->text, known->exact, known->printed);
        print_error(file, error, true);
        fputs(fabs(error) <= POINT_BOUND ? "\n" : " FAIL\n", file);
        good = good && fabs(error) <= POINT_BOUND;
    }
    return good;
}

bool validate_print(FILE *file)
{
    fputs("Relative errors; apart: distance of the centres in sums of the radii; "
          "in brackets:\nnearer than anything is stated of the method.\n\n",
          file);
    bool pairs = print_pairs(file), points = print_points(file);
    fputs(pairs && points ? "\nall as stated\n" : "\nNOT as stated\n", file);
    return pairs && points;
}
