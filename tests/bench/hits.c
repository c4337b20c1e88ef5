/* Rays per second of octree/ and beside it, where it is compiled in (-DWITH_EMBREE), of
 * Embree 3 on the same rays, one thread.
 *
 *   make bench && build/room 6350 1 > build/room.obj && build/mpi/hits build/room.obj
 *
 * First hits of rays of random directions that leave points of the surfaces, chosen by
 * area: each ray a point of its own, as paths do that wander, or 256 rays a point, in a
 * stream, as a gather does; segments between points of surfaces that face each other, and
 * in bundles between two patches, as links have them, in the order of refinement: a pair,
 * its four when one patch is split, and the four of each of those. The first of four
 * bundles starts with the last blocker of the pair that it comes from, each other one
 * with that of the one before, as in link_split().
 * Programs take turns, nine times, and the fastest turn counts, in seconds of the
 * processor. Rays are made for either beforehand. Embree's begin 1e-5 further on, its
 * segments are cut short by 1e-4 at both ends, where they would meet the triangles that
 * they leave; both are asked about segments without the triangles that have the scene on
 * one side. Differences of Embree's answers are counted.
 *
 * Beside Embree alone, the path tracer (rad/beyond/paths.c), all of it, with the same
 * random numbers: RAYS paths, 64 from each triangle, chosen by area. The light that each
 * finds says how much the answers differ.
 *
 * Last, a picture of 1920 x 1080 pixels of 3 x 3 rays, without a final gather, from the
 * eye that phr chooses: all of render_scanlines(), beside rtcIntersect1() alone on the
 * same rays, three turns. */
#include "io/picture/render.h"
#include "io/picture/viewpoint.h"
#include "rad/formfactor.h"
#include "rad/beyond/sample.h"
#include "rad/beyond/sequence.h"
#include "tests/bench/bench.h"
#include "tests/scenes.h"
#include "tests/shaded.h"

enum { TURNS = 9, WIDTH = 1920, HEIGHT = 1080, SAMPLES = 3, PATHS = 64 };
enum { FAMILY = 1 + 4 + 16, LEVELS = 4 }; /* bundles; of patches below their roots */

struct rays {
    struct vec3 *origins, *ends; /* [count] `ends` are directions, or a segment's ends */
    int32_t (*own)[2];           /* [count] triangles that a segment joins */
    int32_t *answers;            /* [count] triangle that is hit, or -1; is it blocked? */
    int count;
    bool are_segments, are_streams, are_bundles;
    double *sums; /* [triangles] area of the triangles up to this one */
};

/* A point of the surfaces, by area. Returns its triangle. */
static int32_t random_place(const struct bench *bench, const double *sums,
                            struct random *random, struct vec3 *x)
{
    int32_t count = bench->scene->input_count;
    double at = sums[count - 1] * random_unit(random);
    int32_t t = (int32_t)sum_place(sums, count, at);
    *x = random_point_on(random, &bench->scene->triangles[t]);
    return t;
}

static void fill_leaving(const struct bench *bench, struct rays *rays,
                         struct random *random, int together)
{
    const struct plane *planes = bench->scene->planes;
    int32_t t = 0;
    rays->are_streams = together == STREAM_RAYS;
    for (int i = 0; i < rays->count; i++) {
        if (i % together == 0) {
            t = random_place(bench, rays->sums, random, &rays->origins[i]);
            rays->origins[i] = point_above(rays->origins[i], planes[t].normal);
        } else {
            rays->origins[i] = rays->origins[i - 1];
        }
        rays->ends[i] =
            cosine_direction(planes[t].normal, direction_along(planes[t].normal),
                             random_unit(random), random_unit(random));
    }
}

static void fill_segments(const struct bench *bench, struct rays *rays,
                          struct random *random, int unused)
{
    (void)unused;
    const struct plane *planes = bench->scene->planes;
    rays->are_segments = true;
    for (int i = 0; i < rays->count; i++) {
        int32_t *own = rays->own[i];
        struct vec3 *from = &rays->origins[i], *to = &rays->ends[i];
        do {
            own[0] = random_place(bench, rays->sums, random, from);
            own[1] = random_place(bench, rays->sums, random, to);
        } while (plane_distance(&planes[own[0]], *to) <= 1e-3 ||
                 plane_distance(&planes[own[1]], *from) <= 1e-3);
    }
}

/* --- bundles --- */

static struct facet random_facet(const struct scene *scene, struct random *random)
{
    int32_t root = random_below(random, scene->input_count);
    struct facet facet = {scene->triangles[root], scene->planes[root], scene->areas[root],
                          root};
    for (int level = random_below(random, LEVELS); level > 0; level--)
        facet.triangle = triangle_child(&facet.triangle, random_below(random, 4));
    return facet;
}

/* All of the triangle lies before the plane. */
static bool is_before(const struct triangle *t, const struct facet *facet)
{
    double least = HUGE_VAL;
    for (int k = 0; k < 3; k++)
        least = fmin(least, plane_distance(&facet->plane, t->corner[k]));
    return facet->area > 0.0 && least > 1e-3;
}

static void random_pair(const struct scene *scene, struct random *random,
                        struct facet *p, struct facet *q)
{
    do {
        *p = random_facet(scene, random);
        *q = random_facet(scene, random);
    } while (!is_before(&p->triangle, q) || !is_before(&q->triangle, p));
}

static void fill_bundles(const struct bench *bench, struct rays *rays,
                         struct random *random, int unused)
{
    (void)unused;
    struct facet p = {.input = -1}, q = p;
    rays->are_segments = rays->are_bundles = true;
    rays->count -= rays->count % BUNDLE_RAYS;
    for (int i = 0; i < rays->count; i++) {
        int member = i / BUNDLE_RAYS % FAMILY, ray = i % BUNDLE_RAYS;
        if (member == 0 && ray == 0)
            random_pair(bench->scene, random, &p, &q);
        struct facet a = p, b = q;
        if (member > 0)
            a.triangle = triangle_child(&p.triangle,
                                        member < 5 ? member - 1 : (member - 5) / 4);
        if (member >= 5)
            b.triangle = triangle_child(&q.triangle, (member - 5) % 4);
        struct bundle bundle = facet_pair_make(&a, &b).bundle;
        rays->origins[i] = bundle.from[ray / BUNDLE_ENDS];
        rays->ends[i] = bundle.to[ray % BUNDLE_ENDS];
        rays->own[i][0] = p.input;
        rays->own[i][1] = q.input;
    }
}

static void run_bundles(const struct octree *octree, struct rays *rays,
                        struct octree_counts *counts)
{
    int32_t guess[FAMILY];
    struct bundle bundle = {.asked = (1u << BUNDLE_RAYS) - 1};
    for (int i = 0; i < rays->count; i += BUNDLE_RAYS) {
        int member = i / BUNDLE_RAYS % FAMILY;
        int from = member % 4 == 1 ? (member < 5 ? 0 : 1 + (member - 5) / 4) : member - 1;
        guess[member] = member > 0 ? guess[from] : -1;
        for (int k = 0; k < BUNDLE_ENDS; k++) {
            bundle.from[k] = rays->origins[i + BUNDLE_ENDS * k];
            bundle.to[k] = rays->ends[i + k];
        }
        bundle.own[0] = rays->own[i][0];
        bundle.own[1] = rays->own[i][1];
        unsigned blocked = octree_block(octree, &bundle, &guess[member], counts);
        for (int k = 0; k < BUNDLE_RAYS; k++)
            rays->answers[i + k] = blocked >> k & 1u;
    }
}

/* --- the others --- */

static void run_streams(const struct octree *octree, struct rays *rays,
                        struct octree_counts *counts)
{
    struct stream stream;
    for (int i = 0; i < rays->count; i += stream.count) {
        stream.count = rays->count - i < STREAM_RAYS ? rays->count - i : STREAM_RAYS;
        for (int k = 0; k < stream.count; k++) {
            stream.origins[k] = rays->origins[i + k];
            stream.directions[k] = rays->ends[i + k];
        }
        octree_stream_hits(octree, &stream, false, counts);
        for (int k = 0; k < stream.count; k++)
            rays->answers[i + k] = stream.hits[k].triangle;
    }
}

/* Returns the seconds that it takes. */
static double run_octree(const struct octree *octree, struct rays *rays,
                         struct octree_counts *counts)
{
    struct octree_hit hit;
    double start = cpu_seconds();
    *counts = (struct octree_counts){0};
    if (rays->are_streams)
        run_streams(octree, rays, counts);
    if (rays->are_bundles)
        run_bundles(octree, rays, counts);
    for (int i = 0; i < rays->count && !rays->are_streams && !rays->are_bundles; i++) {
        int32_t guess = -1;
        if (rays->are_segments)
            rays->answers[i] =
                octree_blocks_segment(octree, rays->origins[i], rays->ends[i],
                                      rays->own[i], &guess, counts);
        else
            rays->answers[i] = octree_first_hit(octree, rays->origins[i], rays->ends[i],
                                                false, &hit, counts)
                                   ? hit.triangle
                                   : -1;
    }
    return cpu_seconds() - start;
}

#ifdef WITH_EMBREE

static inline struct RTCRay embree_ray(struct vec3 o, struct vec3 end, bool is_segment)
{
    struct vec3 d = is_segment ? vec3_sub(end, o) : end;
    return (struct RTCRay){
        .org_x = (float)o.x, .org_y = (float)o.y, .org_z = (float)o.z,
        .dir_x = (float)d.x, .dir_y = (float)d.y, .dir_z = (float)d.z,
        .tnear = is_segment ? 1e-4f : 1e-5f,
        .tfar = is_segment ? 1.0f - 1e-4f : 1e30f, .mask = 0xffffffffu};
}

static void set_embree(const struct rays *rays, struct RTCRayHit *out)
{
    for (int i = 0; i < rays->count; i++) {
        out[i].ray = embree_ray(rays->origins[i], rays->ends[i], rays->are_segments);
        out[i].hit.geomID = RTC_INVALID_GEOMETRY_ID;
    }
}

static void set_packets(const struct rays *rays, struct RTCRay16 *out)
{
    for (int i = 0; i < rays->count; i++) {
        struct RTCRay ray = embree_ray(rays->origins[i], rays->ends[i], true);
        struct RTCRay16 *packet = &out[i / BUNDLE_RAYS];
        int k = i % BUNDLE_RAYS;
        packet->org_x[k] = ray.org_x, packet->dir_x[k] = ray.dir_x;
        packet->org_y[k] = ray.org_y, packet->dir_y[k] = ray.dir_y;
        packet->org_z[k] = ray.org_z, packet->dir_z[k] = ray.dir_z;
        packet->tnear[k] = ray.tnear, packet->tfar[k] = ray.tfar;
        packet->mask[k] = ray.mask, packet->time[k] = 0.0f;
        packet->id[k] = packet->flags[k] = 0;
    }
}

/* Returns the seconds that it takes; counts the answers that differ. Bundles go through
 * Embree's best mode for them, 16-wide and coherent; it remembers no blocker. */
static double run_embree(const struct bench *bench, const struct rays *rays,
                         struct RTCRayHit *embree, int64_t *differ)
{
    struct RTCIntersectContext context;
    void *memory, *memory_of_all;
    int *all = alloc_aligned(1, BUNDLE_RAYS * sizeof *all, &memory_of_all);
    struct RTCRay16 *packets = alloc_aligned(rays->count / BUNDLE_RAYS + 1,
                                             sizeof *packets, &memory);
    set_embree(rays, embree);
    if (rays->are_bundles)
        set_packets(rays, packets);
    memset(all, 0xff, BUNDLE_RAYS * sizeof *all);
    double start = cpu_seconds();
    rtcInitIntersectContext(&context);
    if (rays->are_bundles)
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (int i = 0; i < rays->count; i++)
        if (!rays->are_segments)
            rtcIntersect1(bench->whole, &context, &embree[i]);
        else if (!rays->are_bundles)
            rtcOccluded1(bench->inside, &context, &embree[i].ray);
        else if (i % BUNDLE_RAYS == 0)
            rtcOccluded16(all, bench->inside, &context, &packets[i / BUNDLE_RAYS]);
    double seconds = cpu_seconds() - start;
    *differ = 0;
    for (int i = 0; i < rays->count; i++) {
        bool found = embree[i].hit.geomID != RTC_INVALID_GEOMETRY_ID;
        int32_t hit = found ? (int32_t)embree[i].hit.primID : -1;
        float end = rays->are_bundles ? packets[i / BUNDLE_RAYS].tfar[i % BUNDLE_RAYS]
                                      : embree[i].ray.tfar;
        *differ += rays->answers[i] != (rays->are_segments ? end < 0.0f : hit);
    }
    alloc_free(memory);
    alloc_free(memory_of_all);
    return seconds;
}

/* --- paths --- */

/* Whose Embree answers the path tracer; NULL: the octree does. */
static const struct bench *beside;

static bool first_hit(const struct octree *octree, struct vec3 origin,
                      struct vec3 direction, bool fronts_only, struct octree_hit *hit,
                      struct octree_counts *counts)
{
    if (!beside)
        return octree_first_hit(octree, origin, direction, fronts_only, hit, counts);
    struct RTCIntersectContext context;
    struct RTCRayHit ray = {.ray = embree_ray(origin, direction, false)};
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcInitIntersectContext(&context);
    rtcIntersect1(beside->whole, &context, &ray);
    counts->rays++;
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    hit->triangle = (int32_t)ray.hit.primID;
    hit->front = vec3_dot(beside->scene->planes[hit->triangle].normal, direction) < 0.0;
    return true;
}

static bool blocks_segment(const struct octree *octree, struct vec3 from, struct vec3 to,
                           const int32_t own[2], int32_t *guess,
                           struct octree_counts *counts)
{
    if (!beside)
        return octree_blocks_segment(octree, from, to, own, guess, counts);
    struct RTCIntersectContext context;
    struct RTCRay ray = embree_ray(from, to, true);
    rtcInitIntersectContext(&context);
    rtcOccluded1(beside->inside, &context, &ray);
    counts->rays++;
    return ray.tfar < 0.0f;
}

#define octree_first_hit first_hit
#define octree_blocks_segment blocks_segment
#include "rad/beyond/paths.c"
#undef octree_first_hit
#undef octree_blocks_segment

/* Returns the seconds that it takes. */
static double run_paths(const struct bench *bench, const double *sums, int count,
                        uint64_t seed, const struct pathtracer *pathtracer, double *light)
{
    struct random random = random_seed(seed);
    struct triangle whole = pathtracer_part((struct patch_id){0, 1});
    double start = cpu_seconds();
    pathtracer->counts->rays = 0;
    *light = 0.0;
    for (int i = 0; i < count; i += PATHS) {
        struct vec3 unused;
        int32_t t = random_place(bench, sums, &random, &unused);
        struct rgb b = pathtracer_reflected(pathtracer, t, &whole, PATHS, (uint64_t)i);
        *light += rgb_sum(b);
    }
    return cpu_seconds() - start;
}

static void bench_paths(const struct bench *bench, const double *sums, int count,
                        uint64_t seed)
{
    struct pathtracer pathtracer = pathtracer_make(bench->scene, bench->octree);
    double best[2] = {HUGE_VAL, HUGE_VAL}, light[2], rate[2];
    for (int turn = 0; turn < 2 * TURNS; turn++) {
        int k = turn % 2;
        beside = k ? bench : NULL;
        best[k] = fmin(best[k], run_paths(bench, sums, count, seed, &pathtracer,
                                          &light[k]));
        rate[k] = 1e-6 * (double)pathtracer.counts->rays / best[k];
        if (turn >= 2 * TURNS - 2)
            printf("  %s: %.3f million/s, %" PRId64 " rays of %d paths, light %.6g%s",
                   k ? "Embree" : "octree", rate[k], pathtracer.counts->rays, count,
                   light[k], k ? "" : "\n");
    }
    printf("; octree is %.2f of that\n", rate[0] / rate[1]);
    pathtracer_free(&pathtracer);
}

#endif

static void bench_rays(const struct bench *bench, struct rays *rays)
{
    struct octree_counts counts;
    double best = HUGE_VAL;
#ifdef WITH_EMBREE
    void *memory;
    struct RTCRayHit *embree = alloc_aligned(rays->count, sizeof *embree, &memory);
    double embree_best = HUGE_VAL;
    int64_t differ = 0;
#endif
    for (int turn = 0; turn < TURNS; turn++) {
        best = fmin(best, run_octree(bench->octree, rays, &counts));
#ifdef WITH_EMBREE
        embree_best = fmin(embree_best, run_embree(bench, rays, embree, &differ));
#endif
    }
    printf("  octree: %.3f million/s, per ray %.1f nodes and %.1f triangles\n",
           1e-6 * rays->count / best, (double)counts.node_tests / rays->count,
           (double)counts.triangle_tests / rays->count);
#ifdef WITH_EMBREE
    printf("  Embree: %.3f million/s; octree is %.2f of that; %" PRId64
           " of %d answers differ\n",
           1e-6 * rays->count / embree_best, embree_best / best, differ, rays->count);
    alloc_free(memory);
#endif
}

static void bench_all(const struct bench *bench, int count, uint64_t seed)
{
    static const struct {
        const char *name;
        void (*fill)(const struct bench *, struct rays *, struct random *, int);
        int together;
    } kinds[] = {{"rays from surfaces, 1 from each point", fill_leaving, 1},
                 {"rays from surfaces, 256 from each point", fill_leaving, STREAM_RAYS},
                 {"segments between points of surfaces", fill_segments, 0},
                 {"segments in bundles, in the order of refinement", fill_bundles, 0}};
    const struct scene *scene = bench->scene;
    double *sums = alloc_array((size_t)scene->input_count, sizeof *sums), sum = 0.0;
    for (int32_t i = 0; i < scene->input_count; i++)
        sums[i] = sum += scene->areas[i];
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        struct rays rays = {.count = count, .sums = sums};
        struct random random = random_seed(seed);
        rays.origins = alloc_array((size_t)count, sizeof *rays.origins);
        rays.ends = alloc_array((size_t)count, sizeof *rays.ends);
        rays.own = alloc_array((size_t)count, sizeof *rays.own);
        rays.answers = alloc_array((size_t)count, sizeof *rays.answers);
        kinds[k].fill(bench, &rays, &random, kinds[k].together);
        printf(" %s\n", kinds[k].name);
        bench_rays(bench, &rays);
        alloc_free(rays.origins);
        alloc_free(rays.ends);
        alloc_free(rays.own);
        alloc_free(rays.answers);
    }
#ifdef WITH_EMBREE
    printf(" paths, 64 from each triangle\n");
    if (scene_emitted_power(scene) > 0.0)
        bench_paths(bench, sums, (count + PATHS - 1) / PATHS * PATHS, seed);
#endif
    alloc_free(sums);
}

/* --- a picture --- */

#ifdef WITH_EMBREE

/* Returns the seconds of the first hits of all rays of a picture. */
static double trace_picture(const struct bench *bench, const struct camera *camera)
{
    struct RTCIntersectContext context;
    struct camera_basis basis = camera_basis_of(camera);
    int count = camera->width * SAMPLES * SAMPLES;
    struct rays rays = {.count = count};
    rays.origins = alloc_array((size_t)count, sizeof *rays.origins);
    rays.ends = alloc_array((size_t)count, sizeof *rays.ends);
    void *memory;
    struct RTCRayHit *embree = alloc_aligned(count, sizeof *embree, &memory);
    double seconds = 0.0;
    rtcInitIntersectContext(&context);
    for (int y = 0; y < camera->height; y++) {
        for (int i = 0; i < count; i++) {
            int k = i % (SAMPLES * SAMPLES), x = i / (SAMPLES * SAMPLES);
            rays.origins[i] = scene_from_input(bench->scene, camera->eye);
            rays.ends[i] = camera_basis_ray(&basis, x + (k % SAMPLES + 0.5) / SAMPLES,
                                            y + (k / SAMPLES + 0.5) / SAMPLES);
        }
        set_embree(&rays, embree);
        double start = cpu_seconds();
        for (int i = 0; i < count; i++)
            rtcIntersect1(bench->whole, &context, &embree[i]);
        seconds += cpu_seconds() - start;
    }
    alloc_free(rays.origins);
    alloc_free(rays.ends);
    alloc_free(memory);
    return seconds;
}

#endif

static void bench_picture(const struct bench *bench)
{
    struct forest *forest = forest_create(bench->scene);
    struct shading *shading = shading_create(forest, bench->octree, NULL, NULL, NULL);
    struct renderer renderer = renderer_make(bench->octree, shading, NULL);
    struct camera camera =
        viewpoint_choose(bench->scene, bench->octree, NULL, WIDTH, HEIGHT);
    double best = HUGE_VAL, embree_best = HUGE_VAL;
    for (int turn = 0; turn < 3; turn++) {
        double start = cpu_seconds();
        alloc_free(render_scanlines(&renderer, &camera, SAMPLES, 0, 1, NULL));
        best = fmin(best, cpu_seconds() - start);
#ifdef WITH_EMBREE
        embree_best = fmin(embree_best, trace_picture(bench, &camera));
#endif
    }
    printf(" a picture\n  phr: %.2f s\n", best);
    if (embree_best < HUGE_VAL)
        printf("  Embree: %.2f s; phr takes %.2f of that\n", embree_best,
               best / embree_best);
    shading_destroy(shading);
    forest_destroy(forest);
}

static void bench_scene(const struct bench *bench, int count, uint64_t seed)
{
    bench_all(bench, count, seed);
    bench_picture(bench);
}

int main(int argc, char **argv)
{
    return bench_main(argc, argv, "hits SCENE.obj [RAYS [SEED]]", 100000, bench_scene);
}
