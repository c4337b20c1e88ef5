/* First hits per second of octree/, and beside it, where it is compiled in
 * (-DWITH_EMBREE), of Embree 3 on the same rays, one thread.
 *
 *   make bench && build/room 6350 1 > build/room.obj && build/mpi/hits build/room.obj
 *
 * Rays of random directions leave points of the surfaces, chosen by area: each ray a
 * point of its own, as paths do that wander, or 64 rays a point, as a gather does.
 * Programs take turns, five times, and the fastest turn counts. Embree's rays begin 1e-5
 * further on, where they would meet the triangle that they leave; what it sees otherwise
 * is counted. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "geom/alloc.h"
#include "io/obj.h"
#include "mpi/comm.h"
#include "octree/octree.h"
#include "tests/bench/embree.h"
#include "tests/random.h"

enum { TURNS = 5, GATHER = 64 };

struct figures {
    double seconds; /* of the fastest turn */
    struct octree_counts counts;
};

/* What rays are shot at. */
struct subject {
    const struct scene *scene;
    struct octree *octree;
#ifdef WITH_EMBREE
    RTCScene embree;
#endif
};

struct leaving {
    struct vec3 *origins, *directions; /* [count] */
    int32_t *hits;                     /* [count] triangle that the octree finds, or -1 */
    int count;
};

/* A direction whose density is the cosine to the normal over pi: that of a point in the
 * unit ball around its tip. */
static struct vec3 random_direction(struct vec3 normal, struct random *random)
{
    struct vec3 x;
    do {
        x.x = 2.0 * random_unit(random) - 1.0;
        x.y = 2.0 * random_unit(random) - 1.0;
        x.z = 2.0 * random_unit(random) - 1.0;
    } while (vec3_dot(x, x) > 1.0 || vec3_dot(x, x) < 1e-6);
    return vec3_add(normal, vec3_scale(x, 0.999 / vec3_length(x)));
}

/* A triangle, by area: sums[i] is that of the triangles up to i. */
static int32_t random_by_area(const double *sums, int32_t count, struct random *random)
{
    double at = sums[count - 1] * random_unit(random);
    int32_t low = 0, high = count - 1;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (sums[middle] > at)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

static void fill_leaving(const struct scene *scene, struct leaving *rays, int together,
                         struct random *random)
{
    double *sums = alloc_array((size_t)scene->input_count, sizeof *sums), sum = 0.0;
    for (int32_t i = 0; i < scene->input_count; i++)
        sums[i] = sum += scene->areas[i];
    int32_t t = 0;
    for (int i = 0; i < rays->count; i++) {
        if (i % together == 0) {
            t = random_by_area(sums, scene->input_count, random);
            const struct vec3 *corner = scene->triangles[t].corner;
            double u = sqrt(random_unit(random)), v = u * random_unit(random);
            struct vec3 x = vec3_add(vec3_scale(corner[0], 1.0 - u),
                                     vec3_add(vec3_scale(corner[1], u - v),
                                              vec3_scale(corner[2], v)));
            double lift = 1024.0 * GEOM_ROUNDING;
            rays->origins[i] = vec3_add(x, vec3_scale(scene->planes[t].normal, lift));
        } else {
            rays->origins[i] = rays->origins[i - 1];
        }
        rays->directions[i] = random_direction(scene->planes[t].normal, random);
    }
    alloc_free(sums);
}

static void run_first_hits(const struct octree *octree, struct leaving *rays,
                           struct figures *figures)
{
    struct octree_counts counts = {0};
    double start = comm_seconds();
    for (int i = 0; i < rays->count; i++) {
        struct octree_hit hit;
        bool found = octree_first_hit(octree, rays->origins[i], rays->directions[i],
                                      false, &hit, &counts);
        rays->hits[i] = found ? hit.triangle : -1;
    }
    double seconds = comm_seconds() - start;
    if (!(figures->seconds > 0.0) || seconds < figures->seconds)
        figures->seconds = seconds;
    figures->counts = counts;
}

#ifdef WITH_EMBREE

/* Returns the rays that meet another triangle. */
static int64_t run_embree_first(RTCScene embree, const struct leaving *rays,
                                double *fastest)
{
    struct RTCIntersectContext context;
    int64_t differ = 0;
    double start = comm_seconds();
    rtcInitIntersectContext(&context);
    for (int i = 0; i < rays->count; i++) {
        struct vec3 o = rays->origins[i], d = rays->directions[i];
        struct RTCRayHit ray = {.ray = {.org_x = (float)o.x, .org_y = (float)o.y,
                                        .org_z = (float)o.z, .dir_x = (float)d.x,
                                        .dir_y = (float)d.y, .dir_z = (float)d.z,
                                        .tnear = 1e-5f, .tfar = 1e30f,
                                        .mask = 0xffffffffu}};
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(embree, &context, &ray);
        bool found = ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        differ += rays->hits[i] != (found ? (int32_t)ray.hit.primID : -1);
    }
    double seconds = comm_seconds() - start;
    *fastest = *fastest > 0.0 && *fastest < seconds ? *fastest : seconds;
    return differ;
}

#endif

static void print_first_hits(const struct leaving *rays, const struct figures *figures)
{
    printf("  octree: %.3f million first hits/s, per ray %.1f nodes and %.1f triangles\n",
           1e-6 * rays->count / figures->seconds,
           (double)figures->counts.node_tests / rays->count,
           (double)figures->counts.triangle_tests / rays->count);
}

static void bench_first_hits(const struct subject *subject, int count, uint64_t seed,
                             int together)
{
    struct leaving rays = {.count = count};
    struct random random = random_seed(seed);
    struct figures figures = {0};
    rays.origins = alloc_array((size_t)count, sizeof *rays.origins);
    rays.directions = alloc_array((size_t)count, sizeof *rays.directions);
    rays.hits = alloc_array((size_t)count, sizeof *rays.hits);
    fill_leaving(subject->scene, &rays, together, &random);
    printf(" rays from surfaces, %d from each point\n", together);
#ifdef WITH_EMBREE
    double single = 0.0;
    int64_t differ = 0;
    for (int turn = 0; turn < TURNS; turn++) {
        run_first_hits(subject->octree, &rays, &figures);
        differ = run_embree_first(subject->embree, &rays, &single);
    }
    print_first_hits(&rays, &figures);
    printf("  Embree: one by one %.3f million first hits/s; octree is %.2f of that; "
           "%" PRId64 " of %d hits differ\n",
           1e-6 * count / single, single / figures.seconds, differ, count);
#else
    for (int turn = 0; turn < TURNS; turn++)
        run_first_hits(subject->octree, &rays, &figures);
    print_first_hits(&rays, &figures);
#endif
    alloc_free(rays.origins);
    alloc_free(rays.directions);
    alloc_free(rays.hits);
}

static void bench_all(struct subject *subject, int count, uint64_t seed)
{
#ifdef WITH_EMBREE
    RTCDevice device = rtcNewDevice("threads=1");
    subject->embree = embree_create(device, subject->scene);
#endif
    bench_first_hits(subject, count, seed, 1);
    bench_first_hits(subject, count, seed, GATHER);
#ifdef WITH_EMBREE
    rtcReleaseScene(subject->embree);
    rtcReleaseDevice(device);
#endif
}

int main(int argc, char **argv)
{
    struct comm comm;
    struct error error = {0};
    struct obj_repairs read = {0};
    struct scene_repairs prepared;
    struct subject subject = {.scene = NULL};
    comm_start(&comm, &argc, &argv);
    struct scene *scene = argc > 1 ? obj_read(argv[1], &read, &error) : NULL;
    if (argc < 2)
        error_set(&error, EXIT_USAGE, "usage: hits SCENE.obj [RAYS [SEED]]");
    if (scene && scene_prepare(scene, &prepared, &error)) {
        subject.scene = scene;
        subject.octree = octree_create(scene->triangles, scene->planes,
                                       scene->input_count);
        bench_all(&subject, argc > 2 ? atoi(argv[2]) : 100000,
                  argc > 3 ? (uint64_t)atoi(argv[3]) : 1);
        octree_destroy(subject.octree);
    }
    if (error.code != EXIT_DONE)
        fprintf(stderr, "hits: %s\n", error.text);
    scene_destroy(scene);
    comm_stop(&comm);
    return error.code;
}
