/* Slips that others have made in programs of radiosity.
 *
 * A wrong number says more where it is known what a slip would make of it: pi forgotten,
 * A_i where A_j belongs, a cosine left out, visibility taken from centre to centre. Each
 * is a number by itself, and a program with one slip gets this number in all cases.
 *
 * Integrals without a cosine have no closed form: both polygons are cut into small
 * triangles, and pairs of their centres add up; within 2 % where the two do not touch. */
#include "tools/slips.h"

#include <stdio.h>
#include <string.h>

#include "geom/contour.h"
#include "geom/triangle.h"

enum { FINENESS = 3 }; /* quarterings of each triangle, for integrals */

struct list {
    struct slip *slips; /* [count] */
    int count;
};

static void add_slip(struct list *list, const char *name, double value)
{
    if (list->count == SLIPS_MOST)
        return;
    struct slip *slip = &list->slips[list->count++];
    slip->value = value;
    snprintf(slip->name, SLIP_NAME, "%s", name);
}

/* --- without a cosine --- */

/* Sums over pairs of parts: dA dA' / (pi r^2), times the cosines. */
struct cosine_sums {
    double both, first, second, none; /* cosines */
};

static void add_parts(const struct triangle *t, const struct triangle *u, int level,
                      struct cosine_sums *sums)
{
    for (int k = 0; k < 16 && level > 0; k++) {
        struct triangle a = triangle_child(t, k / 4), b = triangle_child(u, k % 4);
        add_parts(&a, &b, level - 1, sums);
    }
    if (level > 0)
        return;
    struct vec3 d = vec3_sub(triangle_centroid(u), triangle_centroid(t));
    double r2 = vec3_dot(d, d), r = sqrt(r2);
    double rise = vec3_dot(triangle_plane(t).normal, d),
           fall = -vec3_dot(triangle_plane(u).normal, d);
    if (rise <= 0.0 || fall <= 0.0)
        return;
    double all = triangle_area(t) * triangle_area(u) / (PI * r2);
    sums->none += all;
    sums->first += all * rise / r;
    sums->second += all * fall / r;
    sums->both += all * rise * fall / r2;
}

/* The k-th triangle of the fan of a polygon. */
static struct triangle part_of(const struct case_polygons *p, int32_t polygon, int32_t k)
{
    const struct vec3 *corner = p->corner[polygon];
    return (struct triangle){{corner[0], corner[k + 1], corner[k + 2]}};
}

static void add_cosines(struct list *list, const struct case_polygons *p, double right)
{
    struct cosine_sums sums = {0.0, 0.0, 0.0, 0.0};
    for (int32_t i = 0; i < p->corners[0] - 2; i++)
        for (int32_t k = 0; k < p->corners[1] - 2; k++) {
            struct triangle t = part_of(p, 0, i), u = part_of(p, 1, k);
            add_parts(&t, &u, FINENESS, &sums);
        }
    if (!(sums.both > 0.0))
        return;
    /* Blockers take the same share, nearly. */
    add_slip(list, "a cosine missing: the receiver's", right * sums.first / sums.both);
    add_slip(list, "a cosine missing: the sender's", right * sums.second / sums.both);
    add_slip(list, "both cosines missing", right * sums.none / sums.both);
}

/* --- visibility --- */

static struct vec3 centre_of(const struct vec3 *corner, int32_t count)
{
    struct vec3 sum = {0.0, 0.0, 0.0};
    for (int32_t k = 0; k < count; k++)
        sum = vec3_add(sum, corner[k]);
    return vec3_scale(sum, 1.0 / count);
}

static bool is_blocked(const struct case_polygons *p, struct vec3 from, struct vec3 to)
{
    struct segment segment = segment_make(from, to);
    for (int32_t i = 2; i < p->count; i++)
        for (int32_t k = 0; k < p->corners[i] - 2; k++) {
            struct triangle t = part_of(p, i, k);
            struct plane plane = triangle_plane(&t);
            if (segment_is_blocked_by(&segment, &t, &plane))
                return true;
        }
    return false;
}

static void add_visibility(struct list *list, const struct case_polygons *p, double area)
{
    double open = polygon_exchange(p->corner[0], p->corners[0], p->corner[1],
                                   p->corners[1]) / area;
    double by_triangles = 0.0;
    bool blocked = is_blocked(p, centre_of(p->corner[0], p->corners[0]),
                              centre_of(p->corner[1], p->corners[1]));
    for (int32_t i = 0; i < p->corners[0] - 2; i++)
        for (int32_t k = 0; k < p->corners[1] - 2; k++) {
            struct triangle t = part_of(p, 0, i), u = part_of(p, 1, k);
            if (!is_blocked(p, triangle_centroid(&t), triangle_centroid(&u)))
                by_triangles += triangle_exchange(&t, &u) / area;
        }
    add_slip(list, "visibility from centre to centre", blocked ? 0.0 : open);
    add_slip(list, "visibility from centre to centre of triangles", by_triangles);
    add_slip(list, "blockers left out", open);
}

/* --- all --- */

static void add_factor(struct list *list, const struct case_polygons *p, double right)
{
    double own = polygon_area(p->corner[0], p->corners[0]),
           other = polygon_area(p->corner[1], p->corners[1]), row = 0.0;
    for (int32_t k = 1; k < p->count; k++)
        row += polygon_exchange(p->corner[0], p->corners[0], p->corner[k],
                                p->corners[k]) / own;
    add_slip(list, "A_i for A_j", right * own / other);
    add_slip(list, "pi missing", right * PI);
    add_slip(list, "pi twice", right / PI);
    if (p->count > 2)
        add_visibility(list, p, own);
    if (p->count > 2 && row > 0.0)
        add_slip(list, "row scaled to 1", right / row);
    if (right > 0.0 && p->count == 2)
        add_cosines(list, p, right);
}

int slips_of(const struct known_case *known, struct slip slips[SLIPS_MOST])
{
    struct list list = {slips, 0};
    struct case_polygons p;
    char name[SLIP_NAME];
    double value, right = known->right;
    for (const char *at = known->slips; cases_next_slip(&at, name, &value);)
        add_slip(&list, name, value);
    if (known->what[0] == 'F' && case_polygons(known, &p)) {
        add_factor(&list, &p, right);
    } else if (strchr(known->unit, '/') || strcmp(known->unit, "lx") == 0) {
        add_slip(&list, "a factor of pi: Ke, or L, for pi L", right * PI);
        add_slip(&list, "a factor of 1 / pi: Ke, or L, for pi L", right / PI);
    }
    add_slip(&list, "half: one triangle, or one side, of two", 0.5 * right);
    add_slip(&list, "twice: both sides, or both ways, counted", 2.0 * right);
    add_slip(&list, "nothing: faces turned away", 0.0);
    return list.count;
}
