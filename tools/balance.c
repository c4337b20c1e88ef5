/* The balance of powers: absorbed + escaped = emitted.
 *
 * The sums tell of different faces lying on each other in one plane: light comes to both.
 * Such faces are not dropped, for a lamp in its ceiling or a picture on a wall are such
 * faces, too, and do no harm. Of lamps lying on each other the sums tell nothing, since
 * both emit; rays falling on lamps from close above do.
 *
 * A lamp may lie face to face with another surface, as the top of a box at a ceiling: the
 * light between both is absorbed there, though no row or link brings it.
 *
 * Light escaping from a closed scene is lost. A scene counts as closed if hardly any ray
 * in a random direction from the lit fronts leaves the scene (the fronts of a house,
 * outside, are dark); of an open one, the first few do. Light falling on black backs is
 * lost, too. */
#include "tools/balance.h"

#include <string.h>

#include "geom/alloc.h"
#include "geom/hash.h"
#include "rad/beyond/gather/inside.h"
#include "rad/beyond/sample.h"

/* Parts to warn of: of the emitted power, absorbed in excess or lost; of all light
 * leaving surfaces, made up for in a closed scene; and the ratio of absorbed to emitted
 * power above which a run has failed. */
static const double OFF = 0.01, OFF_BALANCE = 0.01, ABSURD = 1.5;

/* Least part of a loss to be its reason, and of the light on backs for a group to be
 * named. */
static const double REASON = 0.5, LEAST = 0.05;

/* Starts of rays over a surface, and over all others in its plane, scene units. */
static const double ABOVE = 1024.0 * GEOM_ROUNDING, HEIGHT = 0x1p-20;

enum {
    LAMP_RAYS = 1000,  /* onto all lamps */
    LAMP_POINTS = 64,  /* of each lamp */
    RAYS = 100000,     /* from all lit fronts, or by their light */
    INSIDE_RAYS = 16,  /* from a point, perhaps inside of a thing */
    NAMED = 3,         /* groups in a warning, at most */
    CRACKS = 1,        /* of these, so many may leave a closed scene */
    NOTHING = -2       /* for root_met() */
};

bool balance_is_absurd(const struct run *run)
{
    return run->vote.absorbed > ABSURD * scene_entering_power(run->scene);
}

/* A number in -1 .. 1. */
static double random_between(uint64_t seed)
{
    return 2.0 * hash_unit(seed) - 1.0;
}

/* A random point above the root. */
static struct vec3 point_over(const struct run *run, int32_t root, double height,
                              uint64_t seed)
{
    struct triangle t = scene_root_triangle(run->scene, root);
    struct vec3 normal = scene_root_plane(run->scene, root).normal;
    double u = hash_unit(seed), v = hash_unit(seed + 1);
    if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
    }
    struct vec3 along = vec3_add(vec3_scale(vec3_sub(t.corner[1], t.corner[0]), u),
                                 vec3_scale(vec3_sub(t.corner[2], t.corner[0]), v));
    return vec3_add(vec3_add(t.corner[0], along), vec3_scale(normal, height));
}

/* A ray from a random point of the root, in a random direction. */
static struct half_line ray_over(const struct run *run, int32_t root, uint64_t seed)
{
    struct vec3 normal = scene_root_plane(run->scene, root).normal;
    struct vec3 d = {random_between(seed + 2), random_between(seed + 3),
                     random_between(seed + 4)};
    return (struct half_line){point_over(run, root, ABOVE, seed),
                              vec3_dot(d, normal) < 0.0 ? vec3_scale(d, -1.0) : d};
}

/* True if another face lies face to face with the root at the ray's beginning: from
 * below, its front comes before the root's back. */
static bool touches(const struct run *run, int32_t root, uint64_t seed)
{
    struct vec3 normal = scene_root_plane(run->scene, root).normal;
    struct vec3 below = point_over(run, root, -FACES_APART, seed);
    struct octree_counts counts = {0};
    struct octree_hit hit;
    return octree_first_hit(run->octree, below, normal, false, &hit, &counts) &&
           hit.front;
}

/* The share of a lamp face to face with others; 0 if the faces are back to back, as shown
 * by any ray from there to a front outside of things, or, of a lamp modelled from both
 * sides, to nothing. */
static double share_touching(const struct run *run, int32_t lamp)
{
    struct model model = {.scene = run->scene, .octree = run->octree};
    bool single = false;
    int count = 0;
    for (int i = 0; i < LAMP_POINTS; i++) {
        uint64_t seed = hash_mix((uint64_t)i);
        struct half_line ray = ray_over(run, lamp, seed);
        if (!touches(run, lamp, seed))
            continue;
        int32_t met = root_met(run->scene, run->octree, &ray, NOTHING, &model.counts);
        bool bound = ray_is_bound(&model, ray.origin, ray.direction, &single);
        if ((met >= 0 && !bound) ||
            (met == NOTHING && run->scene->opposed[scene_input_of(run->scene, lamp)]))
            return 0.0;
        count++;
    }
    return (double)count / LAMP_POINTS;
}

double balance_touching(const struct run *run)
{
    const struct scene *scene = run->scene;
    double power = 0.0;
    for (int32_t root = 0; root < scene_root_count(scene); root++) {
        double sent = scene_root_own_area(scene, root) *
                      rgb_sum(scene_root_material(scene, root)->emission);
        if (sent > 0.0)
            power += sent * share_touching(run, root);
    }
    return power * scene_area_unit(scene);
}

/* True if a random ray from the root leaves. */
static bool leaves(const struct run *run, int32_t root, uint64_t seed)
{
    struct half_line ray = ray_over(run, root, seed);
    struct octree_counts counts = {0};
    struct octree_hit hit;
    return !octree_first_hit(run->octree, ray.origin, ray.direction, false, &hit,
                             &counts);
}

/* True if a lamp lies over a random point of the root, in its plane. */
static bool is_under_lamp(const struct run *run, int32_t root, uint64_t seed)
{
    struct vec3 normal = scene_root_plane(run->scene, root).normal;
    struct octree_counts counts = {0};
    struct octree_hit hit;
    if (!octree_first_hit(run->octree, point_over(run, root, HEIGHT, seed),
                          vec3_scale(normal, -1.0), false, &hit, &counts))
        return false;
    int32_t over = scene_root_on(run->scene, hit.triangle, hit.front);
    return over >= 0 && hit.triangle != scene_input_of(run->scene, root) &&
           material_emits(scene_root_material(run->scene, over));
}

/* The share of the emitted power from lamps under others. */
static double share_under_lamps(const struct run *run)
{
    const struct scene *scene = run->scene;
    double all = scene_emitted_power(scene), sum = 0.0;
    int64_t ray = 0, under = 0;
    for (int32_t root = 0; root < scene_root_count(scene); root++) {
        sum += scene_root_area(scene, root) *
               rgb_sum(scene_root_material(scene, root)->emission);
        for (; (double)ray < sum / all * LAMP_RAYS; ray++)
            under += is_under_lamp(run, root, hash_mix((uint64_t)ray));
    }
    return (double)under / LAMP_RAYS;
}

/* The area of a root if lit, and sending no light between touching faces. */
static double lit_area(const struct run *run, int32_t root)
{
    const struct forest *forest = run->solver->model.forest;
    if (run->stats.touching_power > 0.0 &&
        material_emits(scene_root_material(run->scene, root)) &&
        share_touching(run, root) > 0.0)
        return 0.0;
    return rgb_sum(forest->radiosity[root]) > 0.0 ? scene_root_area(run->scene, root)
                                                  : 0.0;
}

/* Fires rays from all lit roots, evenly by area. */
static bool is_closed(const struct run *run)
{
    int32_t roots = scene_root_count(run->scene);
    double all = 0.0, sum = 0.0;
    int64_t ray = 0;
    int lost = 0;
    for (int32_t root = 0; root < roots; root++)
        all += lit_area(run, root);
    for (int32_t root = 0; root < roots && lost <= CRACKS; root++) {
        sum += lit_area(run, root);
        for (; (double)ray < sum / all * RAYS && lost <= CRACKS; ray++)
            lost += leaves(run, root, hash_mix((uint64_t)ray));
    }
    return lost <= CRACKS;
}

/* Light ending on black backs, in parts of the emitted. */
struct loss {
    double *of;    /* [loss_places()] on backs of the faces of each group; of a scene of
                      one group, of each input triangle */
    double backs;  /* the sum of `of` */
    double inside; /* the part of `backs` sent from inside of things */
};

static int32_t loss_places(const struct scene *scene)
{
    return scene->groups.count > 1 ? scene->groups.count : scene->input_count;
}

/* True if all rays from a point meet backs. */
static bool is_inside(const struct run *run, const struct triangle *t,
                      struct vec3 normal, struct vec3 point)
{
    struct octree_counts counts = {0};
    for (int i = 0; i < INSIDE_RAYS; i++) {
        struct half_line ray = ray_sample(t, normal, hash_mix((uint64_t)i), 0, 1);
        ray.origin = point;
        if (root_met(run->scene, run->octree, &ray, NOTHING, &counts) != -1)
            return false;
    }
    return true;
}

/* Follows rays from the fronts of all roots, as many as by their light. */
static struct loss find_loss(const struct run *run)
{
    const struct scene *scene = run->scene;
    const struct rgb *radiosity = run->solver->model.forest->radiosity;
    struct octree_counts counts = {0};
    struct loss loss = {.of = alloc_array((size_t)loss_places(scene), sizeof *loss.of)};
    double all = 0.0, sum = 0.0;
    int64_t ray = 0;
    for (int32_t root = 0; root < scene_root_count(scene); root++)
        all += scene_root_own_area(scene, root) * rgb_sum(radiosity[root]);
    double each = all / scene_emitted_power(scene) / RAYS; /* of a ray */
    for (int32_t root = 0; root < scene_root_count(scene); root++) {
        struct triangle t = scene_root_triangle(scene, root);
        struct vec3 normal = scene_root_plane(scene, root).normal;
        sum += scene_root_own_area(scene, root) * rgb_sum(radiosity[root]);
        for (; (double)ray < sum / all * RAYS; ray++) {
            struct half_line sent = ray_sample(&t, normal, hash_mix((uint64_t)ray), 0, 1);
            struct octree_hit hit;
            if (!octree_first_hit(run->octree, sent.origin, sent.direction, false, &hit,
                                  &counts) ||
                scene_root_on(scene, hit.triangle, hit.front) >= 0)
                continue;
            loss.of[scene->groups.count > 1 ? scene->groups.of[hit.triangle]
                                            : hit.triangle] += each;
            loss.backs += each;
            loss.inside += is_inside(run, &t, normal, sent.origin) ? each : 0.0;
        }
    }
    return loss;
}

/* Returns up to three groups, or triangles, with most light on their backs. */
static const char *name_backs(const struct scene *scene, struct loss *loss)
{
    static char text[200];
    size_t at = 0;
    text[0] = '\0';
    for (int k = 0; k < NAMED; k++) {
        int32_t most = 0;
        for (int32_t i = 0; i < loss_places(scene); i++)
            most = loss->of[i] > loss->of[most] ? i : most;
        if (!(loss->of[most] > LEAST * loss->backs))
            break;
        const char *name = scene->groups.names;
        for (int32_t i = 0; i < most && scene->groups.count > 1; i++)
            name += strlen(name) + 1;
        char number[40];
        snprintf(number, sizeof number, "triangle %ld", (long)most);
        at += (size_t)snprintf(text + at, sizeof text - at, "%s%.40s (%.0f %%)",
                               k > 0 ? ", " : "", scene->groups.count > 1 ? name : number,
                               100.0 * loss->of[most] / loss->backs);
        loss->of[most] = 0.0;
    }
    return text;
}

/* Warns of the light lost in a closed scene, in parts of the emitted. */
static void warn_of_loss(struct run *run, double lost)
{
    struct loss loss = find_loss(run);
    const char *names = name_backs(run->scene, &loss);
    bool backs = loss.backs > REASON * lost;
    bool inside = backs && loss.inside > REASON * loss.backs;
    run_say(run, "warning: %.3g %% of the light of this closed scene is lost: %s%s",
            100.0 * lost,
            inside  ? "it is sent inside of things or behind them, onto backs of "
            : backs ? "it falls on black backs (see --two-sided), those of "
            : run->vote.converged
                ? "faces may lie on each other, or --epsilon is too large"
                : "there are too few iterations",
            backs ? names : "");
    alloc_free(loss.of);
}

void balance_judge(struct run *run)
{
    static const char CAUSE[] = "faces may lie on each other, or --epsilon is too large";
    const struct stats *stats = &run->stats;
    double absorbed = stats->absorbed_power / stats->emitted_power;
    double escaped = stats->escaped_power / stats->emitted_power;
    double under = share_under_lamps(run);
    if (balance_is_absurd(run))
        error_set(&run->error, EXIT_FAILED,
                  "%.3g times as much light is absorbed as emitted: %s", absorbed, CAUSE);
    else if (under > OFF)
        run_say(run,
                "warning: %.3g %% of the light is emitted under other lamps "
                "in the same plane, and is there twice",
                100.0 * under);
    else if (absorbed > 1.0 + OFF)
        run_say(run, "warning: %.3g %% more light is absorbed than emitted: %s",
                100.0 * (absorbed - 1.0), CAUSE);
    else if (escaped < -OFF)
        run_say(run, "warning: %.3g %% more light arrives than leaves: %s",
                -100.0 * escaped, CAUSE);
    else if (stats->gathered.closing > OFF_BALANCE)
        run_say(run,
                "warning: light of this closed scene was off its balance by %.3g %%, "
                "which is made up for: --epsilon is too large, rays are too few, "
                "or faces lie on each other",
                100.0 * stats->gathered.closing);
    else if (escaped > OFF && is_closed(run))
        warn_of_loss(run, escaped);
}
