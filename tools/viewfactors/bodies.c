/* View factors by rays over bodies.
 *
 * Pairs of facets grow with the square of their number, rays do not: from points that are
 * spread evenly over all facets of group i, rays leave with the cosine's distribution,
 * and the share whose first meeting is a front of group j is F_ij. Both ways give the one
 * exchange,
 *
 *     G_ij = (G_i / A_i^2 + G_j / A_j^2) / (1 / A_i^2 + 1 / A_j^2),
 *     G_i = A_i n_ij / N, G_j = A_j n_ji / N,
 *
 * weighted as n has the same deviation from either side; so reciprocity is exact. Points
 * and directions are those of a sequence that fills its four dimensions evenly: the error
 * falls nearly with the number of rays, and not with its root. It is told by 16 batches
 * of independent sequences. Hits are counted, so ranks and order change nothing. */
#include "tools/viewfactors/bodies.h"

#include "geom/alloc.h"
#include "geom/hash.h"
#include "geom/stop.h"
#include "rad/beyond/sample.h"
#include "rad/beyond/sequence.h"

enum { BATCHES = 16, GROUPS_MOST = 2048 };

/* Microseconds of a pair of roots that face each other, and rays in a millionth of a
 * second; a quarter of all pairs do. */
static const double PAIR = 15.0, RAY = 1.0, FACING = 0.25;

/* Hits of the rays of all groups. */
struct hits {
    int64_t *sums;    /* [count * count] of the batches */
    int64_t *squares; /* [count * count] of the batches */
};

bool bodies_are_meant(const struct viewfactors *factors)
{
    double roots = 0.0;
    for (int32_t i = 0; i < factors->count; i++)
        roots += factors->roots[i];
    return factors->count <= GROUPS_MOST &&
           FACING * roots * roots * PAIR > (double)(1 << 20) * factors->count * RAY;
}

/* The roots of a group, and the sums of their areas. */
struct body {
    int32_t *roots; /* [count] */
    double *sums;   /* [count], square scene units */
    int64_t count;
};

static struct body body_of(const struct scene *scene, int32_t group)
{
    struct body body = {NULL, NULL, 0};
    int64_t capacity = 0, sums_capacity = 0;
    double sum = 0.0;
    for (int32_t root = 0; root < scene_root_count(scene); root++) {
        if (scene->groups.of[scene_input_of(scene, root)] != group ||
            !(scene_root_area(scene, root) > 0.0))
            continue;
        RESERVE(body.roots, &capacity, body.count + 1);
        RESERVE(body.sums, &sums_capacity, body.count + 1);
        body.roots[body.count] = root;
        body.sums[body.count++] = sum += scene_root_area(scene, root);
    }
    return body;
}

/* The ray of a point of the sequence: its first coordinate chooses the root, and what is
 * left of it a place there. */
static struct half_line ray_of(const struct scene *scene, const struct body *body,
                               const double u[SEQUENCE_DIMENSIONS])
{
    double at = u[0] * body->sums[body->count - 1];
    int64_t k = sum_place(body->sums, body->count, at);
    double from = k > 0 ? body->sums[k - 1] : 0.0;
    double rest = fmin(1.0 - 1e-12, fmax(0.0, (at - from) / (body->sums[k] - from)));
    struct triangle t = scene_root_triangle(scene, body->roots[k]);
    struct vec3 normal = scene_root_plane(scene, body->roots[k]).normal;
    struct vec3 point = triangle_of_square(&t, rest, u[1]);
    return (struct half_line){
        point_above(point, normal),
        cosine_direction(normal, direction_along(normal), u[2], u[3])};
}

/* Counts the first meetings of one batch, group by group. */
static void fire(struct viewfactors *factors, const struct body *body, int64_t rays,
                 uint64_t seed, int64_t *met)
{
    struct sequence sequence = {0};
    for (int64_t i = 0; i < rays && !stop_is_asked(); i++) {
        double u[SEQUENCE_DIMENSIONS];
        if (i % SEQUENCE_POINTS == 0)
            sequence = sequence_start(hash_mix(seed + (uint64_t)i));
        sequence_point(&sequence, (uint32_t)(i % SEQUENCE_POINTS), u);
        struct half_line ray = ray_of(factors->scene, body, u);
        int32_t root =
            root_met(factors->scene, factors->octree, &ray, -1, &factors->counts);
        if (root >= 0)
            met[factors->scene->groups.of[scene_input_of(factors->scene, root)]]++;
    }
}

/* Counts the hits of this rank's batches. */
static void fire_own(const struct comm *comm, struct viewfactors *factors, int64_t rays,
                     struct hits *hits)
{
    int64_t *met = alloc_array((size_t)factors->count, sizeof *met);
    for (int32_t i = 0; i < factors->count && !stop_is_asked(); i++) {
        struct body body = body_of(factors->scene, i);
        for (int batch = 0; batch < BATCHES && body.count > 0; batch++) {
            int64_t item = (int64_t)i * BATCHES + batch;
            if (item % comm->size != comm->rank)
                continue;
            for (int32_t j = 0; j < factors->count; j++)
                met[j] = 0;
            fire(factors, &body, rays / BATCHES, hash_mix((uint64_t)item), met);
            for (int32_t j = 0; j < factors->count; j++) {
                hits->sums[(int64_t)i * factors->count + j] += met[j];
                hits->squares[(int64_t)i * factors->count + j] += met[j] * met[j];
            }
        }
        alloc_free(body.roots);
        alloc_free(body.sums);
    }
    alloc_free(met);
}

/* An estimate of F from one side. */
struct share {
    double mean, variance;
};

static struct share share_of(const struct hits *hits, int64_t at, double rays)
{
    double mean = (double)hits->sums[at] / BATCHES, batch = rays / BATCHES;
    double spread = (double)hits->squares[at] / BATCHES - mean * mean;
    return (struct share){mean / batch,
                          fmax(0.0, spread) / (BATCHES - 1) / (batch * batch)};
}

static void set_pair(struct viewfactors *factors, const struct hits *hits, int32_t i,
                     int32_t j, double rays)
{
    double a = factors->areas[i], b = factors->areas[j];
    if (!(a > 0.0) || !(b > 0.0))
        return;
    struct share from_i = share_of(hits, (int64_t)i * factors->count + j, rays);
    struct share from_j = share_of(hits, (int64_t)j * factors->count + i, rays);
    double own = b * b / (a * a + b * b) * a, other = a * a / (a * a + b * b) * b;
    double exchange = own * from_i.mean + other * from_j.mean;
    double variance = own * own * from_i.variance + other * other * from_j.variance;
    if (i == j) /* the two are one */
        variance *= 2.0;
    viewfactors_set(factors, i, j, exchange, variance);
}

void bodies_set(const struct comm *comm, struct viewfactors *factors, int64_t rays)
{
    int64_t cells = (int64_t)factors->count * factors->count;
    struct hits hits = {alloc_array((size_t)cells, sizeof *hits.sums),
                        alloc_array((size_t)cells, sizeof *hits.squares)};
    fire_own(comm, factors, rays, &hits);
    for (int32_t i = 0; i < factors->count; i++) {
        comm_add(comm, hits.sums + (int64_t)i * factors->count, factors->count);
        comm_add(comm, hits.squares + (int64_t)i * factors->count, factors->count);
    }
    for (int32_t i = 0; i < factors->count; i++)
        for (int32_t j = i; j < factors->count; j++)
            set_pair(factors, &hits, i, j, (double)rays);
    alloc_free(hits.sums);
    alloc_free(hits.squares);
}
