/* Holds a solution of phr, a .ply, against the truth about its scene: the errors of
 * leaves, for the panel (tests/panel/panel.sh).
 *
 *     judge [--two-sided] [--sky W] SCENE.obj SOLUTION.ply TRUTH...
 *
 * A truth is about groups of the scene, and one of
 *
 *     NAME=B         each leaf of the group has the radiosity B, W/m^2
 *     NAME~B         the mean over the group is B
 *     NAME<B         it is at most B
 *     NAME^B         its brightest leaf has B
 *     NAME@FROM=B,C  its leaves see fronts of the group FROM, nothing between, which have
 *                    the radiosity B; all else that they see has C
 *     groove=A       "first" and "second" are the walls of an endless groove of A degrees
 *     squares=H      or unit squares H apart, of these materials, in all bands
 *     FILE.ref       elements of tests/bench/reference.c; of all groups, or of those that
 *                    `of=NAME` names
 *
 * A name is that of a group, * is all, [X,Y,Z,X,Y,Z] leaves within a box. Printed are,
 * in percent, a dash for what the truths do not tell, of several truths the worst:
 *
 *     leaves   that were looked at
 *     mean     the largest relative error of a mean; of NAME<B the mean over B
 *     rms      error of the leaves over the light, weighted by area
 *     worst    the largest error of a leaf over its own light
 *     median   and
 *     tenth    errors over own light that half and a tenth of the leaves exceed
 *     held     leaves whose `error` is as large as the error, and two deviations of a
 *              truth by paths
 *     noise    of that truth, as rms
 *     claim    the mean `error` of the leaves that `mean` is about
 *
 * All is about the light that is reflected, rho H: E is given; but where two surfaces
 * have a mean by an equation, B. A truth by paths is two
 * estimates r and s, and the square of an error is (B - r)(B - s), as in
 * tests/deviation.h: noise adds nothing in the mean, but the worst leaf has it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geom/lambert.h"
#include "io/picture/solution.h"
#include "tests/equation.h"
#include "tests/reading.h"
#include "tests/truth.h"

struct leaf_error {
    double area;            /* square units of the file */
    double square[BANDS];   /* of the error, (W/m^2)^2; below 0 by noise */
    double variance[BANDS]; /* of an estimate of the truth, by chance alone, (W/m^2)^2 */
    double light[BANDS];    /* true, W/m^2 */
    double claim;           /* `error`, W/m^2 */
    int truth;              /* by number */
};

struct judge {
    struct scene *scene;
    struct solution_mesh mesh;
    struct leaf_error *errors; /* [count] */
    int64_t count, capacity;
    int truths;
    double mean, claim;        /* 1 */
    bool has_mean;
    const char *only;          /* the group that elements are looked at of, or NULL */
};

static const char *group_name(const struct scene *scene, int32_t group)
{
    const char *name = scene->groups.names;
    while (group-- > 0)
        name += strlen(name) + 1;
    return name;
}

/* `box`: six numbers. Up to a thousandth. */
static bool is_within(const struct triangle *t, const char *box)
{
    double side[6];
    for (int k = 0; k < 6; k++) {
        char *end;
        side[k] = strtod(box + 1, &end);
        box = end;
    }
    for (int k = 0; k < 3; k++) {
        const double at[3] = {t->corner[k].x, t->corner[k].y, t->corner[k].z};
        for (int axis = 0; axis < 3; axis++)
            if (at[axis] < side[axis] - 1e-3 || at[axis] > side[3 + axis] + 1e-3)
                return false;
    }
    return true;
}

static bool is_in_group(const struct judge *judge, uint32_t root, const char *name,
                        size_t length)
{
    const struct scene *scene = judge->scene;
    int32_t input = (int32_t)root % scene->input_count;
    const char *own = group_name(scene, scene->groups.of[input]);
    return (length == 1 && *name == '*') ||
           (strlen(own) == length && strncmp(own, name, length) == 0);
}

static bool is_in(const struct judge *judge, const struct solution_leaf *leaf,
                  const char *name, size_t length)
{
    return *name == '[' ? is_within(&leaf->triangle, name)
                        : is_in_group(judge, leaf->id.root, name, length);
}

static const struct material *material_of(const struct judge *judge,
                                          const struct solution_leaf *leaf)
{
    return scene_root_material(judge->scene, (int32_t)leaf->id.root);
}

/* What a leaf reflects. */
static struct rgb reflected(const struct judge *judge, const struct solution_leaf *leaf)
{
    return rgb_sub(leaf->radiosity, material_of(judge, leaf)->emission);
}

static void add_error(struct judge *judge, double area, struct rgb value, struct rgb r,
                      struct rgb s, double claim)
{
    struct leaf_error e = {.area = area, .claim = claim, .truth = judge->truths};
    for (int c = 0; c < BANDS; c++) {
        e.square[c] = (value.band[c] - r.band[c]) * (value.band[c] - s.band[c]);
        e.variance[c] = 0.5 * (r.band[c] - s.band[c]) * (r.band[c] - s.band[c]);
        e.light[c] = 0.5 * (r.band[c] + s.band[c]);
    }
    RESERVE(judge->errors, &judge->capacity, judge->count + 1);
    judge->errors[judge->count++] = e;
}

/* --- truths in closed form --- */

/* `off` and `claim` are relative. */
static void take_mean(struct judge *judge, double off, double claim)
{
    if (judge->has_mean && fabs(judge->mean) >= fabs(off))
        return;
    judge->mean = off;
    judge->claim = claim;
    judge->has_mean = true;
}

/* Over a group, of one band. */
struct group_mean {
    double light, claim; /* W/m^2 */
    double most;         /* of a leaf */
};

static struct group_mean mean_of_group(const struct judge *judge, const char *name,
                                       size_t length, int band)
{
    struct group_mean mean = {0.0, 0.0, 0.0};
    double area = 0.0;
    for (int64_t i = 0; i < judge->mesh.count; i++) {
        const struct solution_leaf *leaf = &judge->mesh.leaves[i];
        if (!is_in(judge, leaf, name, length))
            continue;
        mean.light += leaf->area * leaf->radiosity.band[band];
        mean.claim += leaf->area * leaf->error;
        mean.most = fmax(mean.most, leaf->radiosity.band[band]);
        area += leaf->area;
    }
    return (struct group_mean){mean.light / area, mean.claim / area, mean.most};
}

static void judge_uniform(struct judge *judge, const char *name, size_t length, double b)
{
    for (int64_t i = 0; i < judge->mesh.count; i++) {
        const struct solution_leaf *leaf = &judge->mesh.leaves[i];
        if (!is_in(judge, leaf, name, length))
            continue;
        struct rgb light = rgb_sub((struct rgb){{b, b, b}},
                                   material_of(judge, leaf)->emission);
        add_error(judge, leaf->area, reflected(judge, leaf), light, light, leaf->error);
    }
}

/* A light at a point of a leaf, W/m^2. */
typedef double light_at_point(const void *of, struct vec3 x);

/* Its mean over a triangle: four quarters, three points each, exact to the second
 * degree. */
static double mean_over(const struct triangle *t, light_at_point *light, const void *of)
{
    double sum = 0.0;
    for (int q = 0; q < 4; q++)
        for (int k = 0; k < 3; k++) {
            double w[3];
            for (int c = 0; c < 3; c++) {
                double part = c == k ? 2.0 / 3.0 : 1.0 / 6.0;
                w[c] = q == 3 ? 0.5 - 0.5 * part : 0.5 * part + (c == q ? 0.5 : 0.0);
            }
            sum += light(of, corners_mean(t->corner, (struct vec3){w[0], w[1], w[2]}));
        }
    return sum / 12.0;
}

/* A surface of an equation. */
struct surface {
    const struct equation *equation;
    int number;
};

static double light_on_surface(const void *of, struct vec3 x)
{
    const struct surface *surface = of;
    double u, v;
    surface->equation->shape->place(x, &u, &v);
    return light_at(surface->equation, surface->number, u, v);
}

/* One band of one of two surfaces, whose truth is its own. */
static void judge_surface(struct judge *judge, const struct surface *surface, int band,
                          const char *name)
{
    double exact = equation_mean(surface->equation, surface->number);
    struct group_mean found = mean_of_group(judge, name, strlen(name), band);
    for (int64_t i = 0; i < judge->mesh.count; i++) {
        const struct solution_leaf *leaf = &judge->mesh.leaves[i];
        if (!is_in(judge, leaf, name, strlen(name)))
            continue;
        struct rgb value = {{0}}, light = {{0}};
        value.band[band] = leaf->radiosity.band[band];
        light.band[band] = mean_over(&leaf->triangle, light_on_surface, surface);
        add_error(judge, leaf->area, value, light, light, leaf->error);
    }
    take_mean(judge, found.light / exact - 1.0, found.claim / exact);
    judge->truths++;
}

static void judge_equation(struct judge *judge, const struct shape *shape, double size)
{
    static const char *const names[2] = {"first", "second"};
    for (int band = 0; band < BANDS; band++) {
        double emission[2] = {0.0}, rho[2] = {0.0};
        for (int64_t i = 0; i < judge->mesh.count; i++)
            for (int k = 0; k < 2; k++) {
                const struct solution_leaf *leaf = &judge->mesh.leaves[i];
                if (!is_in(judge, leaf, names[k], strlen(names[k])))
                    continue;
                emission[k] = material_of(judge, leaf)->emission.band[band];
                rho[k] = material_of(judge, leaf)->reflectance.band[band];
            }
        struct equation *e = equation_make(shape, size, emission, rho);
        for (int k = 0; k < 2; k++)
            judge_surface(judge, &(struct surface){e, k}, band, names[k]);
        alloc_free(e);
    }
}

/* What a leaf sees: triangles of a group whose fronts face it. */
struct view_of_group {
    const struct judge *judge;
    const char *from;
    size_t length;
    struct vec3 normal; /* of the leaf */
    double b, c;        /* W/m^2, of the group and of all else */
};

static double light_seen(const void *of, struct vec3 x)
{
    const struct view_of_group *view = of;
    const struct scene *scene = view->judge->scene;
    struct vec3 at = scene_from_input(scene, x);
    double share = 0.0;
    for (int32_t root = 0; root < scene->input_count; root++) {
        struct plane plane = scene_root_plane(scene, root);
        struct triangle t = scene_root_triangle(scene, root);
        if (is_in_group(view->judge, (uint32_t)root, view->from, view->length) &&
            plane_distance(&plane, at) > 0.0)
            share += point_triangle_factor(at, view->normal, &t);
    }
    return share * view->b + (1.0 - share) * view->c;
}

/* `word`: NAME@FROM=B,C. The whole of it is one truth, and its mean, too. */
static void judge_view(struct judge *judge, const char *word, size_t length)
{
    const char *from = word + length + 1;
    char *comma;
    struct view_of_group view = {.judge = judge, .from = from,
                                 .length = strcspn(from, "=")};
    view.b = strtod(from + view.length + 1, &comma);
    view.c = strtod(comma + 1, NULL);
    double off = 0.0, exact = 0.0, claim = 0.0;
    for (int64_t i = 0; i < judge->mesh.count; i++) {
        const struct solution_leaf *leaf = &judge->mesh.leaves[i];
        if (!is_in(judge, leaf, word, length))
            continue;
        view.normal = scene_root_plane(judge->scene, (int32_t)leaf->id.root).normal;
        double light = mean_over(&leaf->triangle, light_seen, &view) *
                       material_of(judge, leaf)->reflectance.band[0];
        struct rgb value = {{reflected(judge, leaf).band[0]}}, truth = {{light}};
        add_error(judge, leaf->area, value, truth, truth, leaf->error);
        off += leaf->area * (value.band[0] - light);
        claim += leaf->area * leaf->error;
        exact += leaf->area * light;
    }
    take_mean(judge, off / exact, claim / exact);
}

/* --- truths by paths --- */

static void add_to(struct rgb *sum, struct rgb value, double weight)
{
    for (int c = 0; c < BANDS; c++)
        sum->band[c] += weight * value.band[c];
}

/* Leaves that share an element are looked at together. */
struct pending {
    double area, claim;
    struct rgb value, truth[TRUTH_HALVES]; /* times the area */
    int64_t element; /* -1: none */
};

static void flush(struct judge *judge, struct pending *pending)
{
    double part = pending->area > 0.0 ? 1.0 / pending->area : 0.0;
    struct rgb value = {{0}}, r = {{0}}, s = {{0}};
    add_to(&value, pending->value, part);
    add_to(&r, pending->truth[0], part);
    add_to(&s, pending->truth[1], part);
    if (pending->area > 0.0)
        add_error(judge, pending->area, value, r, s, part * pending->claim);
    *pending = (struct pending){.element = -1};
}

static void judge_elements(struct judge *judge, const struct truth *truth)
{
    struct pending pending = {.element = -1};
    double light = 0.0, off = 0.0, claim = 0.0;
    int64_t first = 0;
    for (int64_t i = 0; i < judge->mesh.count; i++) {
        const struct solution_leaf *leaf = &judge->mesh.leaves[i];
        while (first < truth->count && truth->items[first].id.root < leaf->id.root)
            first++;
        if (first == truth->count || truth->items[first].id.root != leaf->id.root ||
            (judge->only && !is_in(judge, leaf, judge->only, strlen(judge->only))))
            continue;
        int bits = 2 * (ID_MAX_LEVEL - id_level(truth->items[first].id));
        int64_t low = first + (leaf->start >> bits), high = first + (leaf->end >> bits);
        if (low < high || low != pending.element)
            flush(judge, &pending);
        pending.element = low;
        high = high > low ? high : low + 1;
        pending.area += leaf->area;
        pending.claim += leaf->area * leaf->error;
        claim += leaf->area * leaf->error;
        add_to(&pending.value, reflected(judge, leaf), leaf->area);
        for (int half = 0; half < TRUTH_HALVES; half++)
            for (int64_t k = low; k < high; k++)
                add_to(&pending.truth[half], truth->items[k].mean[half],
                       leaf->area / (double)(high - low));
        for (int c = 0; c < BANDS; c++)
            off += leaf->area * reflected(judge, leaf).band[c];
        for (int64_t k = low; k < high; k++)
            light += leaf->area / (double)(high - low) * 0.5 *
                     (rgb_sum(truth->items[k].mean[0]) +
                      rgb_sum(truth->items[k].mean[1]));
    }
    flush(judge, &pending);
    if (!judge->has_mean)
        take_mean(judge, off / light - 1.0, claim / (light / BANDS));
}

/* --- the line --- */

struct ranked {
    double off; /* over own light, 1 */
};

static int compare(const void *left, const void *right)
{
    const struct ranked *a = left, *b = right;
    return (a->off > b->off) - (a->off < b->off);
}

static double sum_of(const double band[BANDS])
{
    return band[0] + band[1] + band[2];
}

static double square_of(const double band[BANDS])
{
    return band[0] * band[0] + band[1] * band[1] + band[2] * band[2];
}

/* The claim is as large as the error. Two estimates tell little of a leaf's own noise:
 * its variance is taken to be as light over area, `per_light` times. */
static bool is_held(const struct leaf_error *e, const double per_light[BANDS])
{
    for (int c = 0; c < BANDS; c++)
        if (e->square[c] >
            e->claim * e->claim + 2.0 * per_light[c] * e->light[c] / e->area)
            return false;
    return true;
}

/* Of one truth. */
struct sums {
    double square, light, noise; /* area times (W/m^2)^2 */
    int64_t count, held;
};

/* Prints the line by the errors of leaves over their own light, in order. */
static void print_line(const struct judge *judge, const struct sums *sums,
                       const struct ranked *ranked, int64_t lit)
{
    double rms = 0.0, noise = 0.0, held = 1.0;
    for (int k = 0; k <= judge->truths; k++) {
        if (!(sums[k].light > 0.0))
            continue;
        rms = fmax(rms, sqrt(fmax(sums[k].square, 0.0) / sums[k].light));
        noise = fmax(noise, sqrt(sums[k].noise / sums[k].light));
        held = fmin(held, (double)sums[k].held / (double)sums[k].count);
    }
    printf("%lld ", (long long)judge->count);
    printf(judge->has_mean ? "%.3g " : "- ", 100.0 * judge->mean);
    if (lit > 0)
        printf("%.3g %.3g %.3g %.3g %.3g %.3g ", 100.0 * rms,
               100.0 * ranked[lit - 1].off, 100.0 * ranked[lit / 2].off,
               100.0 * ranked[lit - 1 - lit / 10].off, 100.0 * held, 100.0 * noise);
    else
        printf("- - - - - - ");
    printf(judge->has_mean ? "%.3g\n" : "-\n", 100.0 * judge->claim);
}

static void print_errors(const struct judge *judge)
{
    struct ranked *ranked = alloc_array((size_t)judge->count, sizeof *ranked);
    struct sums *sums = alloc_array((size_t)judge->truths + 1, sizeof *sums);
    double per_light[BANDS] = {0.0};
    int64_t lit = 0;
    for (int c = 0; c < BANDS; c++) {
        double variance = 0.0, expected = 0.0;
        for (int64_t i = 0; i < judge->count; i++) {
            const struct leaf_error *e = &judge->errors[i];
            variance += e->area * e->variance[c];
            expected += e->light[c];
        }
        per_light[c] = expected > 0.0 ? variance / expected : 0.0;
    }
    for (int64_t i = 0; i < judge->count; i++) {
        const struct leaf_error *e = &judge->errors[i];
        struct sums *sum = &sums[e->truth];
        sum->square += e->area * sum_of(e->square);
        sum->light += e->area * square_of(e->light);
        sum->noise += e->area * sum_of(e->variance);
        sum->held += is_held(e, per_light);
        sum->count++;
        if (square_of(e->light) > 0.0)
            ranked[lit++].off =
                sqrt(fmax(sum_of(e->square), 0.0) / square_of(e->light));
    }
    qsort(ranked, (size_t)lit, sizeof *ranked, compare);
    print_line(judge, sums, ranked, lit);
    alloc_free(ranked);
    alloc_free(sums);
}

static bool judge_mean(struct judge *judge, const char *word, size_t length,
                       struct error *error)
{
    double b = strtod(word + length + 1, NULL);
    struct group_mean mean = mean_of_group(judge, word, length, 0);
    if (!isfinite(mean.light))
        return error_set(error, EXIT_USAGE, "%s: there is no such group", word);
    if (word[length] == '=')
        judge_uniform(judge, word, length, b);
    double over = b > 0.0 ? b : 1.0;
    double light = word[length] == '^' ? mean.most : mean.light;
    take_mean(judge, (light - (word[length] == '<' ? 0.0 : b)) / over,
              mean.claim / over);
    return true;
}

static bool judge_by(struct judge *judge, const char *word, struct error *error)
{
    size_t length = strcspn(word, "=~<^@");
    const char *value = word + length + 1;
    struct truth truth = {0};
    if (word[length] == '\0') {
        if (!truth_read(&truth, word, judge->scene, error))
            return false;
        judge_elements(judge, &truth);
        truth_free(&truth);
    } else if (strncmp(word, "of=", 3) == 0) {
        judge->only = value;
    } else if (strncmp(word, "groove=", 7) == 0) {
        judge_equation(judge, &GROOVE, strtod(value, NULL) * PI / 180.0);
    } else if (strncmp(word, "squares=", 8) == 0) {
        judge_equation(judge, &SQUARES, strtod(value, NULL));
    } else if (word[length] == '@') {
        judge_view(judge, word, length);
    } else {
        return judge_mean(judge, word, length, error);
    }
    return true;
}

static bool run(struct judge *judge, int argc, char **argv, struct error *error)
{
    struct reading reading = {0};
    struct source source;
    int at = 1;
    for (; at < argc && argv[at][0] == '-'; at++)
        if (strcmp(argv[at], "--two-sided") == 0)
            reading.two_sided = true;
        else if (strcmp(argv[at], "--sky") == 0 && at + 1 < argc)
            reading.sky = strtod(argv[++at], NULL);
    if (argc - at < 2)
        return error_set(error, EXIT_USAGE,
                         "usage: judge [--two-sided] [--sky W] SCENE.obj SOLUTION.ply "
                         "TRUTH...");
    reading.path = argv[at];
    judge->scene = scene_read(reading, error);
    bool good = judge->scene && source_open(&source, argv[at + 1], error);
    if (good) {
        good = solution_mesh_read(&judge->mesh, &source, error);
        source_close(&source);
    }
    for (at += 2; good && at < argc; at++)
        good = judge_by(judge, argv[at], error);
    return good;
}

int main(int argc, char **argv)
{
    struct judge judge = {.scene = NULL};
    struct error error = {0};
    if (run(&judge, argc, argv, &error))
        print_errors(&judge);
    else
        fprintf(stderr, "judge: %s\n", error.text);
    solution_mesh_free(&judge.mesh);
    scene_destroy(judge.scene);
    alloc_free(judge.errors);
    return error.code;
}
