/* Lamps that are wide as seen from a receiver, and may be seen through a narrow opening.
 *
 * Segments to points all over such a lamp hardly ever find the opening. But each blocked
 * one names a blocker, and the part of the lamp that a blocker hides from a point can be
 * cut out exactly (remainder.h). So each further segment is aimed at the remainder,
 * the part of the lamp that no known blocker hides: with V = 1 where it passes, and 0
 * where it does not,
 *
 *     H at x  =  E F(remainder, x) (p + (V - p) w),
 *
 * where w is the density of F at the segment's end over that with which the end was
 * chosen, 1 in the mean, and p an estimate of V. Without w light would be lost or won
 * where V depends on the place: behind a screen of 400 squares 38 % were won. A wall with
 * a hole is known after some ten segments, and the remainder is the hole. Then the light
 * at each point is exact, half-shadows included.
 *
 * Blockers are learnt by other points than those that the light is estimated at: from
 * each until its segment passes, and from all until none finds a new one; p is the part
 * of these segments that pass in the end. The estimate is right in the mean, whatever has
 * been learnt. By one and the same points, whose segments all pass in the end, the
 * blockers that they had missed would not count at all: below a bush of 150 leaves, these
 * were 4 % too bright.
 *
 * Of more than BLOCKERS_MOST blockers the last ones count by V alone, as all do where
 * the lamp is small: there it is the place on the leaf that decides on light and shadow,
 * and cutting would take more time than it is worth. */
#include "rad/beyond/receiver.h"

#include <math.h>

#include "rad/beyond/remainder.h"

/* Sums over points. */
struct sums {
    double whole[2], seen[2];    /* factors, 1; of the first and second half */
    double wholes, seens, mixed; /* their squares and products */
};

/* Point i of `count` of the receiver. Those of a pixel are few, so that each is looked
 * from several times on end. */
static struct vec3 point_of(const struct receiver *r, const double *u, int i, int count)
{
    const struct gather_points *points = r->points;
    return points ? points->at[(int64_t)i * points->count / count]
                  : receiver_start(r, u[0], u[1]);
}

/* Looks from the point x at a point of the remainder that u chooses. Returns an estimate
 * of the factor of the part that is seen; `passing`: of that part of the remainder, by
 * other points, 1; `blocker`: of the segment, or -1. */
static double look(struct receiver *r, struct remainder *lamp, struct vec3 x,
                   const double u[SEQUENCE_DIMENSIONS], double passing, int32_t *blocker)
{
    struct vec3 normal = r->facet.plane.normal;
    double whole = remainder_look(lamp, r->gather->model->scene, x, normal), density;
    *blocker = -1;
    if (!(whole > 0.0))
        return 0.0;
    struct vec3 y = remainder_point(lamp, 0, u[2], u[3], &density);
    double kernel = receiver_kernel(x, normal, y, lamp->plane.normal);
    if (kernel > 0.0)
        *blocker = receiver_first_blocker(r, x, y, lamp->root);
    double passes = *blocker < 0 ? 1.0 : 0.0;
    double likely = kernel > 0.0 && density > 0.0 ? kernel / density : 0.0;
    return whole * passing + (passes - passing) * likely;
}

/* Learns the blockers that are found from the points behind the first `count`, as many
 * again. Returns the part of the segments from these that pass, 1. */
static double learn(struct receiver *r, struct remainder *lamp,
                    const struct sequence *sequence, int count)
{
    const struct scene *scene = r->gather->model->scene;
    double u[SEQUENCE_DIMENSIONS], passed = 0.0;
    bool learnt = true;
    while (learnt) {
        learnt = false;
        passed = 0.0;
        for (int i = 0; i < count; i++) {
            int32_t blocker;
            sequence_point(sequence, (uint32_t)(count + i), u);
            struct vec3 x = point_of(r, u, i, count);
            for (look(r, lamp, x, u, 1.0, &blocker);
                 blocker >= 0 && remainder_learn(lamp, scene, blocker);
                 look(r, lamp, x, u, 1.0, &blocker))
                learnt = true;
            passed += blocker < 0 ? 1.0 : 0.0;
        }
    }
    return passed / count;
}

static struct receiver_share share_of_sums(const struct sums *sums)
{
    struct receiver_share share = {.seen = 0.0};
    double whole = sums->whole[0] + sums->whole[1];
    if (!(whole > 0.0))
        return share;
    double part = fmax(0.0, fmin(1.0, (sums->seen[0] + sums->seen[1]) / whole));
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
    struct remainder lamp = remainder_start(r->gather->model->forest, root);
    struct sums sums = {.wholes = 0.0};
    double u[SEQUENCE_DIMENSIONS];
    double passing = learn(r, &lamp, sequence, count);
    for (int i = 0; i < count; i++) {
        int32_t blocker;
        sequence_point(sequence, (uint32_t)i, u);
        double seen = look(r, &lamp, point_of(r, u, i, count), u, passing, &blocker);
        sums.whole[2 * i >= count] += lamp.whole;
        sums.seen[2 * i >= count] += seen;
        sums.wholes += lamp.whole * lamp.whole;
        sums.seens += seen * seen;
        sums.mixed += lamp.whole * seen;
    }
    return share_of_sums(&sums);
}
