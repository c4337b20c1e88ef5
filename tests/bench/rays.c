/* Visibility bench: segments per second of octree/ on the program's own workload, and
 * beside it, where it is compiled in (-DWITH_EMBREE), Embree 3 on the same segments, one
 * thread.
 *
 *   make bench BUILD=build/native CFLAGS="-O2 -march=native"
 *   build/room 6350 1 > build/room.obj
 *   build/native/rays build/room.obj [BUNDLES [SEED]]
 *
 * The workload is bundles of 16 segments between the sub-triangle centres of two facing
 * patches, both 0 to 4 levels below their roots, in two orders: pairs at random, and in
 * refinement order: a pair, the four that come from splitting one of its patches, and the
 * four of each of those. The first of four starts with the last blocker of the pair that
 * it comes from, each other one with that of the one before, as in link_split(). Both try
 * that blocker first, and both leave out the triangles that have the whole scene on one
 * side. Programs take turns, five times, and the fastest turn counts, in seconds of the
 * processor. Embree's rays are made beforehand, in float, and cut short by 1e-4 at both
 * ends, where it would meet the triangles they lie on; differences are counted and are
 * near edges or in those cuts. */
#include "rad/beyond/patch_exchange.h"
#include "tests/bench/bench.h"

enum { TURNS = 5, TRIES = 100000 };

struct load {
    struct bundle *bundles;    /* [count] */
    unsigned *blocked;         /* [count] answer of the octree */
    int *start; /* [count] the bundle before with whose blocker it starts, or -1 */
    int32_t *guess;            /* [count] the last blocker */
    int count;
    bool refinement_order;
};

struct figures {
    double seconds; /* of the fastest turn */
    struct octree_counts counts;
};

static struct vec3 sub_centre(const struct triangle *t, int child)
{
    struct triangle part = triangle_child(t, child);
    return triangle_centroid(&part);
}

static struct bundle bundle_of(const struct facet *p, const struct facet *q)
{
    struct bundle bundle = {.own = {p->input, q->input}};
    for (int k = 0; k < BUNDLE_ENDS; k++) {
        bundle.from[k] = sub_centre(&p->triangle, k);
        bundle.to[k] = sub_centre(&q->triangle, k);
    }
    for (int k = 0; k < BUNDLE_RAYS; k++) {
        struct vec3 d =
            vec3_sub(bundle.to[k % BUNDLE_ENDS], bundle.from[k / BUNDLE_ENDS]);
        bool faces =
            vec3_dot(p->plane.normal, d) > 0.0 && vec3_dot(q->plane.normal, d) < 0.0;
        bundle.asked |= (unsigned)faces << k;
    }
    return bundle;
}

static struct facet random_facet(const struct scene *scene, struct random *random,
                                 int levels)
{
    int32_t root;
    do
        root = (int32_t)(random_bits(random) % (uint64_t)scene->input_count);
    while (scene->areas[root] <= 0.0);
    struct facet facet = {scene->triangles[root], scene->planes[root], scene->areas[root],
                          root};
    for (int level = (int)(random_bits(random) % (uint64_t)levels); level > 0; level--)
        facet.triangle = triangle_child(&facet.triangle, (int)(random_bits(random) % 4));
    return facet;
}

/* Appends the bundle of a pair, unless nothing in it faces. */
static bool add_bundle(struct load *load, int *filled, const struct facet *p,
                       const struct facet *q, int start)
{
    struct bundle bundle = bundle_of(p, q);
    if (*filled == load->count || bundle.asked == 0)
        return false;
    load->bundles[*filled] = bundle;
    load->start[(*filled)++] = start;
    return true;
}

/* A pair and two generations, breadth first: p is split, then q. */
static void add_family(struct load *load, int *filled, const struct facet *p,
                       const struct facet *q)
{
    int parent = *filled, made[4];
    struct facet child[4];
    if (!add_bundle(load, filled, p, q, -1))
        return;
    for (int k = 0, start = parent; k < 4; k++) {
        child[k] = *p;
        child[k].triangle = triangle_child(&p->triangle, k);
        made[k] =
            add_bundle(load, filled, &child[k], q, start) ? start = *filled - 1 : -1;
    }
    for (int k = 0; k < 4; k++) {
        for (int m = 0, start = made[k]; m < 4 && made[k] >= 0; m++) {
            struct facet part = *q;
            part.triangle = triangle_child(&q->triangle, m);
            start =
                add_bundle(load, filled, &child[k], &part, start) ? *filled - 1 : start;
        }
    }
}

/* Fills the load; cuts it short where facing pairs are too rare to be found. */
static void fill_load(const struct scene *scene, struct load *load, struct random *random)
{
    int filled = 0;
    for (int tries = 0; filled < load->count && tries / TRIES <= filled; tries++) {
        int levels = load->refinement_order ? 4 : 5;
        struct facet p = random_facet(scene, random, levels);
        struct facet q = random_facet(scene, random, levels);
        if (p.input == q.input || !facets_face(&p, &q))
            continue;
        if (load->refinement_order)
            add_family(load, &filled, &p, &q);
        else
            add_bundle(load, &filled, &p, &q, -1);
    }
    load->count = filled;
}

static void run_octree(const struct octree *octree, struct load *load,
                       struct figures *figures)
{
    struct octree_counts counts = {0};
    double start = cpu_seconds();
    for (int i = 0; i < load->count; i++) {
        load->guess[i] = load->start[i] >= 0 ? load->guess[load->start[i]] : -1;
        load->blocked[i] =
            octree_block(octree, &load->bundles[i], &load->guess[i], &counts);
    }
    double seconds = cpu_seconds() - start;
    figures->seconds =
        figures->seconds > 0.0 && figures->seconds < seconds ? figures->seconds : seconds;
    figures->counts = counts;
}

#ifdef WITH_EMBREE

/* Embree knows no "own" triangles. */
static const float CUT = 1e-4f;

static void set_rays(const struct bundle *bundle, struct RTCRay16 *rays, int *valid)
{
    for (int k = 0; k < BUNDLE_RAYS; k++) {
        struct vec3 from = bundle->from[k / BUNDLE_ENDS];
        struct vec3 d = vec3_sub(bundle->to[k % BUNDLE_ENDS], from);
        rays->org_x[k] = (float)from.x;
        rays->org_y[k] = (float)from.y;
        rays->org_z[k] = (float)from.z;
        rays->dir_x[k] = (float)d.x;
        rays->dir_y[k] = (float)d.y;
        rays->dir_z[k] = (float)d.z;
        rays->tnear[k] = CUT;
        rays->tfar[k] = 1.0f - CUT;
        rays->time[k] = 0.0f;
        rays->mask[k] = 0xffffffffu;
        rays->id[k] = rays->flags[k] = 0;
        valid[k] = bundle->asked >> k & 1u ? -1 : 0;
    }
}

/* Takes the rays that the triangle blocks out of `valid` (Moeller, Trumbore). */
static void mask_blocked(const struct scene *scene, int32_t blocker,
                         const struct RTCRay16 *rays, int *valid)
{
    const struct vec3 *corner = scene->triangles[blocker].corner;
    struct vec3 e1 = vec3_sub(corner[1], corner[0]), e2 = vec3_sub(corner[2], corner[0]);
    float a[3] = {(float)corner[0].x, (float)corner[0].y, (float)corner[0].z};
    float b[3] = {(float)e1.x, (float)e1.y, (float)e1.z};
    float c[3] = {(float)e2.x, (float)e2.y, (float)e2.z};
    for (int k = 0; k < BUNDLE_RAYS; k++) {
        float dx = rays->dir_x[k], dy = rays->dir_y[k], dz = rays->dir_z[k];
        float px = dy * c[2] - dz * c[1], py = dz * c[0] - dx * c[2],
              pz = dx * c[1] - dy * c[0];
        float sx = rays->org_x[k] - a[0], sy = rays->org_y[k] - a[1],
              sz = rays->org_z[k] - a[2];
        float qx = sy * b[2] - sz * b[1], qy = sz * b[0] - sx * b[2],
              qz = sx * b[1] - sy * b[0];
        float scale = 1.0f / (b[0] * px + b[1] * py + b[2] * pz);
        float u = (sx * px + sy * py + sz * pz) * scale,
              v = (dx * qx + dy * qy + dz * qz) * scale;
        float t = (c[0] * qx + c[1] * qy + c[2] * qz) * scale;
        int hit =
            (u >= 0.0f) & (v >= 0.0f) & (u + v <= 1.0f) & (t > CUT) & (t < 1.0f - CUT);
        valid[k] = hit ? 0 : valid[k];
    }
}

/* Embree's rays, made beforehand, and those that are asked for. */
struct embree_load {
    struct RTCRay16 *rays;     /* [count] */
    int (*valid)[BUNDLE_RAYS]; /* [count] */
    void *memory[2];           /* where they lie */
};

static int any_valid(const int *valid)
{
    int any = 0;
    for (int k = 0; k < BUNDLE_RAYS; k++)
        any |= valid[k];
    return any;
}

/* Starts with the blocker that the octree has found for the bundle before, as the octree
 * does. The rest goes through Embree's best mode here, 16-wide and coherent. */
static double run_embree(const struct bench *bench, const struct load *load,
                         struct embree_load *ready)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (int i = 0; i < load->count; i++)
        set_rays(&load->bundles[i], &ready->rays[i], ready->valid[i]);
    double start = cpu_seconds();
    for (int i = 0; i < load->count; i++) {
        struct RTCRay16 *rays = &ready->rays[i];
        int *valid = ready->valid[i];
        int32_t guess = load->start[i] >= 0 ? load->guess[load->start[i]] : -1;
        if (guess >= 0)
            mask_blocked(bench->scene, guess, rays, valid);
        if (any_valid(valid))
            rtcOccluded16(valid, bench->inside, &context, rays);
    }
    return cpu_seconds() - start;
}

/* Segments that Embree sees otherwise, after a run. */
static int64_t count_different(const struct load *load, const struct embree_load *ready)
{
    int64_t differ = 0;
    for (int i = 0; i < load->count; i++)
        for (int k = 0; k < BUNDLE_RAYS; k++) {
            bool open = ready->valid[i][k] && !(ready->rays[i].tfar[k] < 0.0f);
            bool asked = load->bundles[i].asked >> k & 1u;
            differ += asked && open == (bool)(load->blocked[i] >> k & 1u);
        }
    return differ;
}

#endif

static void print_octree(const struct load *load, const struct figures *figures)
{
    int open = 0, blocked = 0;
    for (int i = 0; i < load->count; i++) {
        open += load->blocked[i] == 0;
        blocked += load->blocked[i] == load->bundles[i].asked;
    }
    double rays = (double)figures->counts.rays;
    printf("  octree: %.3f million segments/s, per bundle %.1f nodes and %.1f triangles; "
           "bundles %.0f %% open, %.0f %% blocked, %.0f %% mixed\n",
           1e-6 * rays / figures->seconds,
           (double)figures->counts.node_tests / load->count,
           (double)figures->counts.triangle_tests / load->count,
           100.0 * open / load->count, 100.0 * blocked / load->count,
           100.0 * (load->count - open - blocked) / load->count);
}

/* One order of the bundles, the programs in turn. */
static void bench_load(const struct bench *bench, struct load *load)
{
    struct figures figures = {0};
#ifdef WITH_EMBREE
    struct embree_load ready;
    ready.rays = alloc_aligned(load->count, sizeof *ready.rays, &ready.memory[0]);
    ready.valid = alloc_aligned(load->count, sizeof *ready.valid, &ready.memory[1]);
    double embree = HUGE_VAL;
    int64_t differ = 0;
#endif
    for (int turn = 0; turn < TURNS; turn++) {
        run_octree(bench->octree, load, &figures);
#ifdef WITH_EMBREE
        embree = fmin(embree, run_embree(bench, load, &ready));
        differ = count_different(load, &ready);
#endif
    }
    print_octree(load, &figures);
#ifdef WITH_EMBREE
    alloc_free(ready.memory[0]);
    alloc_free(ready.memory[1]);
    printf("  Embree: %.3f million segments/s; octree is %.2f of that; %" PRId64
           " of %" PRId64 " segments differ\n",
           1e-6 * (double)figures.counts.rays / embree, embree / figures.seconds, differ,
           figures.counts.rays);
#endif
}

static void bench_bundles(const struct bench *bench, int count, uint64_t seed)
{
    struct load load = {.count = count};
    load.bundles = alloc_array((size_t)count, sizeof *load.bundles);
    load.blocked = alloc_array((size_t)count, sizeof *load.blocked);
    load.start = alloc_array((size_t)count, sizeof *load.start);
    load.guess = alloc_array((size_t)count, sizeof *load.guess);
    for (int order = 0; order < 2; order++) {
        struct random random = random_seed(seed);
        load.refinement_order = order == 1;
        fill_load(bench->scene, &load, &random);
        printf(" %s\n", order ? "refinement order" : "random pairs");
        bench_load(bench, &load);
    }
    alloc_free(load.bundles);
    alloc_free(load.blocked);
    alloc_free(load.start);
    alloc_free(load.guess);
}

int main(int argc, char **argv)
{
    return bench_main(argc, argv, "rays SCENE.obj [BUNDLES [SEED]]", 100000,
                         bench_bundles);
}
