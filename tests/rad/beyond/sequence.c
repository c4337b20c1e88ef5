/* Tests of rad/beyond/sequence.h and sample.h: points are spread evenly, on triangles and
 * hemispheres too. */
#include "rad/beyond/sequence.h"

#include <math.h>

#include "geom/hash.h"
#include "rad/beyond/sample.h"
#include "tests/scenes.h"
#include "tests/tap.h"

enum { POINTS = 256, SIDE = 16 };

/* Of the first 2^k points one lies in each interval of 2^-k, in every dimension; of the
 * first two dimensions, one in each box of that area. That is the merit of Sobol's
 * points: promise, and scrambling must keep. */
static void test_strata(void)
{
    bool one = true, two = true;
    for (uint64_t seed = 0; seed < 50; seed++) {
        struct sequence sequence = sequence_start(seed);
        int lines[SEQUENCE_DIMENSIONS][POINTS] = {{0}}, boxes[SIDE * SIDE] = {0};
        for (uint32_t i = 0; i < POINTS; i++) {
            double u[SEQUENCE_DIMENSIONS];
            sequence_point(&sequence, i, u);
            for (int d = 0; d < SEQUENCE_DIMENSIONS; d++)
                lines[d][(int)(POINTS * u[d])]++;
            boxes[(int)(SIDE * u[0]) * SIDE + (int)(SIDE * u[1])]++;
        }
        for (int i = 0; i < POINTS; i++) {
            for (int d = 0; d < SEQUENCE_DIMENSIONS; d++)
                one = one && lines[d][i] == 1;
            two = two && boxes[i] == 1;
        }
    }
    tap_ok(one, "256 points: one in each 256th, in four dimensions, for 50 seeds");
    tap_ok(two, "and one in each box of 1/16 by 1/16");
}

/* The mean of u0 u1 u2 u3 is 1/16. Points at random miss it by .08 / sqrt(256) = 5e-3 in
 * the RMS over seeds; a tenth of that is asked for. */
static void test_integral(void)
{
    double square = 0.0, all = 0.0;
    for (uint64_t seed = 0; seed < 100; seed++) {
        struct sequence sequence = sequence_start(1000 * seed);
        double sum = 0.0;
        for (uint32_t i = 0; i < POINTS; i++) {
            double u[SEQUENCE_DIMENSIONS];
            sequence_point(&sequence, i, u);
            sum += u[0] * u[1] * u[2] * u[3] / POINTS;
        }
        square += (sum - 0.0625) * (sum - 0.0625) / 100.0;
        all += sum / 100.0;
    }
    tap_ok(sqrt(square) < 1e-3, "a product of four: off by %.1e, RMS", sqrt(square));
    /* Independent seeds: the mean of 100 is ten times nearer, three deviations
     * allowed. */
    tap_ok(fabs(all - 0.0625) < 0.3 * sqrt(square), "the mean over seeds by %.1e",
           fabs(all - 0.0625));
}

static void test_triangle(void)
{
    const struct triangle t = {{{1, 1, 1}, {3, 1, 1}, {1, 2, 4}}};
    struct sequence sequence = sequence_start(7);
    struct vec3 mean = {0, 0, 0}, middle = triangle_centroid(&t);
    struct plane plane = triangle_plane(&t);
    double worst = 0.0;
    int quarter = 0;
    for (uint32_t i = 0; i < POINTS; i++) {
        double u[SEQUENCE_DIMENSIONS];
        sequence_point(&sequence, i, u);
        struct vec3 x = triangle_of_square(&t, u[0], u[1]);
        worst = fmax(worst, fabs(plane_distance(&plane, x)));
        mean = vec3_add(mean, vec3_scale(x, 1.0 / POINTS));
        quarter += 0.5 * (x.x - 1.0) + (x.y - 1.0) < 0.5; /* child 0 */
    }
    tap_ok(worst < 1e-14, "points lie in the plane of their triangle");
    tap_ok(vec3_length(vec3_sub(mean, middle)) < 0.01, "around its centroid, off by %.4f",
           vec3_length(vec3_sub(mean, middle)));
    tap_ok(abs(quarter - POINTS / 4) <= 4, "a quarter of them in a quarter: %d of %d",
           quarter, POINTS);
}

/* Directions distributed as the cosine: the square of the sine is even, and so is the
 * angle around the normal. */
static void test_directions(void)
{
    enum { MANY = 4096, EACH = MANY / SIDE };
    struct vec3 normal = {2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0},
                along = direction_along(normal);
    struct vec3 across = vec3_cross(normal, along);
    struct sequence sequence = sequence_start(3);
    int rings[SIDE] = {0}, sectors[SIDE] = {0}, most = 0, least = MANY;
    double length = 0.0;
    tap_ok(fabs(vec3_dot(normal, along)) < 1e-15 &&
               fabs(vec3_length(along) - 1.0) < 1e-15,
           "a direction at right angles to another");
    for (uint32_t i = 0; i < MANY; i++) {
        double u[SEQUENCE_DIMENSIONS];
        sequence_point(&sequence, i, u);
        struct vec3 d = cosine_direction(normal, along, u[0], u[1]);
        double up = vec3_dot(d, normal);
        length = fmax(length, fabs(vec3_length(d) - 1.0));
        rings[(int)(SIDE * fmin(1.0 - up * up, 0.999999))]++;
        double angle = atan2(vec3_dot(d, across), vec3_dot(d, along));
        sectors[(int)fmin(SIDE - 1, SIDE * (angle / 6.283185307179586 + 0.5))]++;
    }
    for (int i = 0; i < SIDE; i++) {
        most = sectors[i] > most ? sectors[i] : most;
        least = sectors[i] < least ? sectors[i] : least;
    }
    tap_ok(length < 1e-8, "directions have length 1, within %.1e", length);
    tap_ok(most <= 1.05 * EACH && least >= 0.95 * EACH,
           "%d to %d of 4096 in each sixteenth of the turn", least, most);
    most = 0;
    for (int i = 0; i < SIDE; i++)
        most = rings[i] > most ? rings[i] : most;
    tap_ok(most <= 1.02 * EACH, "at most %d of 4096 in each sixteenth of the hemisphere",
           most);
}

/* Rays at random, in rings, turn evenly about the normal: of 4,096, 256 are in each of 16
 * sectors, and chi squared of 15 degrees of freedom exceeds 44 once in 10,000 times. No
 * angle to the normal is in another ring. */
static void test_rays(void)
{
    enum { RINGS = 8, EACH = 256 };
    const struct triangle t = {{{0.1, 0.2, 0.3}, {0.9, 0.1, 0.5}, {0.4, 0.8, 0.2}}};
    struct vec3 normal = triangle_plane(&t).normal, across, along;
    int sectors[SIDE] = {0};
    bool in_ring = true;
    double chi2 = 0.0;
    along = vec3_unit(vec3_sub(t.corner[1], t.corner[0]));
    across = vec3_cross(normal, along);
    for (int i = 0; i < EACH * SIDE; i++) {
        struct half_line ray =
            ray_sample(&t, normal, hash_mix((uint64_t)i), i % RINGS, RINGS);
        double up = vec3_dot(ray.direction, normal);
        in_ring = in_ring && (int)(RINGS * (1.0 - up * up)) == i % RINGS;
        double angle = atan2(vec3_dot(ray.direction, across),
                             vec3_dot(ray.direction, along));
        sectors[(int)fmin(SIDE - 1, SIDE * (angle / 6.283185307179586 + 0.5))]++;
    }
    for (int i = 0; i < SIDE; i++)
        chi2 += (double)(sectors[i] - EACH) * (sectors[i] - EACH) / EACH;
    tap_ok(in_ring && chi2 < 44.0, "rays at random turn evenly (chi squared %.1f)", chi2);
}

int main(void)
{
    test_strata();
    test_integral();
    test_triangle();
    test_directions();
    test_rays();
    return tap_done();
}
