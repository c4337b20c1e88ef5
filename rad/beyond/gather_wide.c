/* Lamps that are wide as seen from a receiver, and may be seen through a narrow opening.
 *
 * Segments to points all over such a lamp hardly ever find the opening. But each blocked
 * one names a blocker, and the part of the lamp that a blocker hides from a point can be
 * cut out exactly (geom/outlook.h). So each further segment is aimed at the remainder,
 * the part of the lamp that no known blocker hides: with V = 1 where it passes, and 0
 * where it does not,
 *
 *     H at x  =  E F(remainder, x) V.
 *
 * Where one does not pass, a blocker more is known, and all begins anew. A wall with a
 * hole is known after some ten segments, and the remainder is the hole. Then the light at
 * each point is exact, half-shadows included.
 *
 * Of more than BLOCKERS_MOST blockers the last ones count by V alone, as all do where
 * the lamp is small: there it is the place on the leaf that decides on light and shadow,
 * and cutting would take more time than it is worth. */
#include "rad/beyond/receiver.h"

#include <math.h>
#include <string.h>

#include "geom/lambert.h"
#include "geom/outlook.h"

enum { BLOCKERS_MOST = 8 };

/* A lamp, triangles that hide parts of it, and the remainder at one point. */
struct wide_lamp {
    int32_t root;
    struct triangle triangle;
    struct plane plane;
    int32_t blockers[BLOCKERS_MOST]; /* [count] triangles in front of the plane */
    int count;
    struct outlook outlook;
    int hidden;    /* blockers that have been cut out of the outlook; -1: there is none */
    double whole;  /* factor of the lamp without blockers, 1 */
    double before[OUTLOOK_PIECES + 1]; /* factors of the pieces before each, added up,
                                          1 */
};

/* True if the triangle is a blocker that was not known and is now. */
static bool learn(const struct receiver *r, struct wide_lamp *lamp, int32_t blocker)
{
    const struct triangle *t = &r->gather->model->scene->triangles[blocker];
    for (int k = 0; k < 3; k++)
        if (!(plane_distance(&lamp->plane, t->corner[k]) > 0.0))
            return false;
    for (int i = 0; i < lamp->count; i++)
        if (lamp->blockers[i] == blocker)
            return false;
    if (lamp->count == BLOCKERS_MOST)
        return false;
    lamp->blockers[lamp->count++] = blocker;
    return true;
}

/* The lamp as seen from x. */
static void look_out(const struct receiver *r, struct wide_lamp *lamp, struct vec3 x)
{
    struct vec3 normal = r->facet.plane.normal;
    struct outlook *outlook = &lamp->outlook;
    bool again = lamp->hidden >= 0 && memcmp(&outlook->from, &x, sizeof x) == 0;
    if (again && lamp->hidden == lamp->count)
        return;
    if (!again) {
        outlook_start(outlook, x, &lamp->triangle);
        lamp->whole = point_triangle_factor(x, normal, &lamp->triangle);
        lamp->hidden = 0;
    }
    while (lamp->hidden < lamp->count)
        outlook_hide(outlook,
                     &r->gather->model->scene->triangles[lamp->blockers[lamp->hidden++]]);
    lamp->before[1] = lamp->whole;
    for (int i = 0; i < outlook->count && lamp->count > 0; i++)
        lamp->before[i + 1] = lamp->before[i] +
                              point_polygon_factor(x, normal, outlook->piece[i].corner,
                                                   outlook->piece[i].count);
}

/* The point of a convex polygon that u and v in [0, 1] stand for. */
static struct vec3 point_of_piece(const struct outlook_piece *piece, double u, double v)
{
    double before[OUTLOOK_CORNERS] = {0.0};
    for (int k = 1; k + 1 < piece->count; k++) {
        struct triangle t = {{piece->corner[0], piece->corner[k], piece->corner[k + 1]}};
        before[k] = before[k - 1] + triangle_area(&t);
    }
    int k = 1;
    double at = u * before[piece->count - 2];
    while (k + 2 < piece->count && at >= before[k])
        k++;
    struct triangle t = {{piece->corner[0], piece->corner[k], piece->corner[k + 1]}};
    double own = before[k] - before[k - 1];
    return triangle_of_square(&t, own > 0.0 ? fmin(1.0, (at - before[k - 1]) / own) : 0.0,
                              v);
}

/* A point of the remainder, chosen by u and v in [0, 1). */
static struct vec3 point_of_remainder(const struct wide_lamp *lamp, double u, double v)
{
    int i = 0;
    double at = u * lamp->before[lamp->outlook.count];
    while (i + 1 < lamp->outlook.count && at >= lamp->before[i + 1])
        i++;
    double own = lamp->before[i + 1] - lamp->before[i];
    return point_of_piece(&lamp->outlook.piece[i],
                          own > 0.0 ? fmin(1.0, (at - lamp->before[i]) / own) : 0.0, v);
}

/* Sums over points. */
struct sums {
    double whole[2], seen[2];    /* factors, 1; of the first and second half */
    double wholes, seens, mixed; /* their squares and products */
};

/* False if a blocker has been met that was not known. */
static bool add_point(struct receiver *r, struct wide_lamp *lamp,
                      const double u[SEQUENCE_DIMENSIONS], int half, struct sums *sums)
{
    struct vec3 x = receiver_start(r, u[0], u[1]);
    look_out(r, lamp, x);
    double seen = lamp->before[lamp->outlook.count];
    if (seen > 0.0) {
        struct vec3 y = point_of_remainder(lamp, u[2], u[3]);
        int32_t blocker = -1;
        if (receiver_kernel(x, r->facet.plane.normal, y, lamp->plane.normal) > 0.0)
            blocker = receiver_blocker(r, x, y, lamp->root);
        if (blocker >= 0 && learn(r, lamp, blocker))
            return false;
        seen = blocker >= 0 ? 0.0 : seen;
    }
    sums->whole[half] += lamp->whole;
    sums->seen[half] += seen;
    sums->wholes += lamp->whole * lamp->whole;
    sums->seens += seen * seen;
    sums->mixed += lamp->whole * seen;
    return true;
}

static struct receiver_share share_of_sums(const struct sums *sums)
{
    struct receiver_share share = {.seen = 0.0};
    double whole = sums->whole[0] + sums->whole[1];
    if (!(whole > 0.0))
        return share;
    double part = fmin(1.0, (sums->seen[0] + sums->seen[1]) / whole);
    double squares = sums->seens - 2.0 * part * sums->mixed + part * part * sums->wholes;
    share.seen = part;
    share.variance = fmax(0.0, squares) / (whole * whole);
    if (sums->whole[0] > 0.0 && sums->whole[1] > 0.0) {
        double apart =
            0.5 * (sums->seen[0] / sums->whole[0] - sums->seen[1] / sums->whole[1]);
        share.halves = apart * apart;
    }
    return share;
}

struct receiver_share receiver_share_of_wide(struct receiver *r,
                                             const struct sequence *sequence, int count,
                                             int32_t root)
{
    const struct scene *scene = r->gather->model->scene;
    struct wide_lamp lamp = {.root = root, .triangle = scene_root_triangle(scene, root),
                             .plane = scene_root_plane(scene, root), .hidden = -1};
    struct sums sums = {.wholes = 0.0};
    double u[SEQUENCE_DIMENSIONS];
    for (int i = 0; i < count; i++) {
        sequence_point(sequence, (uint32_t)i, u);
        if (!add_point(r, &lamp, u, 2 * i >= count, &sums)) {
            sums = (struct sums){.wholes = 0.0};
            i = -1;
        }
    }
    return share_of_sums(&sums);
}
