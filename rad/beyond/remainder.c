/* The parts that blockers hide are cut out exactly (geom/outlook.h), and so is the part
 * below the horizon, where no segment can tell whether light comes from a point. A
 * blocker may touch the root's plane, as a wall touches its floor, but has to be in front
 * of it. */
#include "rad/beyond/remainder.h"

#include <math.h>
#include <string.h>

#include "geom/lambert.h"
#include "rad/beyond/sequence.h"

/* Quarterings that are made wherever a part is; more, as long as the square of its radius
 * is more than this times the square of its distance. */
enum { LEAST_QUARTERINGS = 3 };
static const double NEAR = 0.01;

struct remainder remainder_start(const struct forest *forest, int32_t patch)
{
    int32_t root = (int32_t)forest->patches[patch].id.root;
    return (struct remainder){.root = root,
                              .triangle = forest_triangle(forest, patch),
                              .plane = scene_root_plane(forest->scene, root),
                              .hidden = -1};
}

bool remainder_learn(struct remainder *remainder, const struct scene *scene,
                     int32_t blocker)
{
    static const double TOUCHING = 1e-9; /* scene units */
    const struct triangle *t = &scene->triangles[blocker];
    bool in_front = false;
    for (int k = 0; k < 3; k++) {
        double height = plane_distance(&remainder->plane, t->corner[k]);
        if (!(height > -TOUCHING))
            return false;
        in_front = in_front || height > TOUCHING;
    }
    for (int i = 0; i < remainder->count; i++)
        if (remainder->blockers[i] == blocker)
            return false;
    if (!in_front || remainder->count == BLOCKERS_MOST)
        return false;
    remainder->blockers[remainder->count++] = blocker;
    return true;
}

double remainder_look(struct remainder *remainder, const struct scene *scene,
                      struct vec3 x, struct vec3 normal)
{
    struct outlook *outlook = &remainder->outlook;
    bool again = remainder->hidden >= 0 && memcmp(&outlook->from, &x, sizeof x) == 0 &&
                 memcmp(&remainder->normal, &normal, sizeof normal) == 0;
    remainder->normal = normal;
    if (again && remainder->hidden == remainder->count)
        return remainder->before[outlook->count];
    if (!again) {
        outlook_start(outlook, x, &remainder->triangle);
        outlook_keep_above(outlook, normal);
        remainder->whole = point_triangle_factor(x, normal, &remainder->triangle);
        remainder->hidden = 0;
    }
    while (remainder->hidden < remainder->count)
        outlook_hide(outlook,
                     &scene->triangles[remainder->blockers[remainder->hidden++]]);
    remainder->before[1] = remainder->whole;
    for (int i = 0; i < outlook->count && remainder->count > 0; i++)
        remainder->before[i + 1] =
            remainder->before[i] + point_polygon_factor(x, normal,
                                                        outlook->piece[i].corner,
                                                        outlook->piece[i].count);
    return remainder->before[outlook->count];
}

/* A number in [0, 1), spread anew over [0, 1) for the item that it has chosen. */
static double spread(double u, double before, double own)
{
    return own > 0.0 ? fmin(1.0 - 0x1p-32, fmax(0.0, (u - before) / own)) : u;
}

/* True if a part is so near to x, for its size, that it is not as good as a point. */
static bool is_near(const struct triangle *part, struct vec3 x)
{
    double radius = triangle_radius(part);
    struct vec3 apart = vec3_sub(triangle_centroid(part), x);
    return radius * radius > NEAR * vec3_dot(apart, apart);
}

/* Quarters are chosen by their factors, three times at least, and until they are as good
 * as points: of a wall that is seen along it, a small part has most of the factor. */
static struct triangle quarter_of(const struct remainder *r, struct triangle t,
                                  int quarterings, double *u)
{
    for (int step = 0; step < quarterings && (step < LEAST_QUARTERINGS ||
                                              is_near(&t, r->outlook.from));
         step++) {
        double before[5] = {0.0};
        struct triangle child[4];
        for (int k = 0; k < 4; k++) {
            child[k] = triangle_child(&t, k);
            before[k + 1] = before[k] + point_triangle_factor(r->outlook.from, r->normal,
                                                              &child[k]);
        }
        int k = 0;
        while (k < 3 && *u * before[4] >= before[k + 1])
            k++;
        *u = spread(*u * before[4], before[k], before[k + 1] - before[k]);
        t = child[k];
    }
    return t;
}

struct vec3 remainder_point(const struct remainder *remainder, int quarterings, double u,
                            double v, double *density)
{
    int i = 0, k = 1;
    double at = u * remainder->before[remainder->outlook.count];
    while (i + 1 < remainder->outlook.count && at >= remainder->before[i + 1])
        i++;
    u = spread(at, remainder->before[i], remainder->before[i + 1] - remainder->before[i]);
    const struct outlook_piece *piece = &remainder->outlook.piece[i];
    double before[OUTLOOK_CORNERS] = {0.0};
    struct triangle t[OUTLOOK_CORNERS];
    for (; k + 1 < piece->count; k++) {
        t[k] = (struct triangle){
            {piece->corner[0], piece->corner[k], piece->corner[k + 1]}};
        before[k] = before[k - 1] + point_triangle_factor(remainder->outlook.from,
                                                          remainder->normal, &t[k]);
    }
    at = u * before[k - 1];
    for (k = 1; k + 2 < piece->count && at >= before[k];)
        k++;
    u = spread(at, before[k - 1], before[k] - before[k - 1]);
    struct triangle quarter = quarter_of(remainder, t[k], quarterings, &u);
    if (density)
        *density = point_triangle_factor(remainder->outlook.from, remainder->normal,
                                         &quarter) /
                   (remainder->before[remainder->outlook.count] *
                    triangle_area(&quarter));
    return triangle_of_square(&quarter, u, v);
}
