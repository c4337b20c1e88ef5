/* Holds a solution of phr, a .ply, against the truth about its scene: the errors of
 * leaves, for the panel (tests/panel/panel.sh).
 *
 *     judge [--two-sided] [--sky W] SCENE.obj SOLUTION.ply TRUTH...
 *
 * A truth is about groups of the scene, and one of
 *
 *     NAME=B         each leaf of the group has the radiosity B, W/m^2
 *     NAME~B         the mean over the group is B; * is all of the scene
 *     NAME<B         it is at most B
 *     groove=A,RHO   the leaves of "middle" are those of an endless groove of A degrees
 *                    whose walls have RHO and emit 1 - RHO
 *     FILE.ref       elements of tests/bench/reference.c; of all groups, or of those that
 *                    `of=NAME` names
 *
 * Printed are, in percent, a dash for what the truths do not tell:
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
 *
 * All is about the light that is reflected, rho H: E is given. A truth by paths is two
 * estimates r and s, and the square of an error is (B - r)(B - s), as in
 * tests/deviation.h: noise adds nothing in the mean, but the worst leaf has it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

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
};

struct judge {
    struct scene *scene;
    struct solution_mesh mesh;
    struct leaf_error *errors; /* [count] */
    int64_t count, capacity;
    double mean;               /* 1 */
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

static bool is_in(const struct judge *judge, const struct solution_leaf *leaf,
                  const char *name, size_t length)
{
    const struct scene *scene = judge->scene;
    int32_t input = (int32_t)leaf->id.root % scene->input_count;
    const char *own = group_name(scene, scene->groups.of[input]);
    return (length == 1 && *name == '*') ||
           (strlen(own) == length && strncmp(own, name, length) == 0);
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
    struct leaf_error e = {.area = area, .claim = claim};
    for (int c = 0; c < BANDS; c++) {
        e.square[c] = (value.band[c] - r.band[c]) * (value.band[c] - s.band[c]);
        e.variance[c] = 0.5 * (r.band[c] - s.band[c]) * (r.band[c] - s.band[c]);
        e.light[c] = 0.5 * (r.band[c] + s.band[c]);
    }
    RESERVE(judge->errors, &judge->capacity, judge->count + 1);
    judge->errors[judge->count++] = e;
}

/* --- truths in closed form --- */

static void take_mean(struct judge *judge, double off)
{
    judge->mean = judge->has_mean && fabs(judge->mean) > fabs(off) ? judge->mean : off;
    judge->has_mean = true;
}

/* The mean radiosity over a group, first band. */
static double mean_of_group(const struct judge *judge, const char *name, size_t length)
{
    double light = 0.0, area = 0.0;
    for (int64_t i = 0; i < judge->mesh.count; i++) {
        const struct solution_leaf *leaf = &judge->mesh.leaves[i];
        if (!is_in(judge, leaf, name, length))
            continue;
        light += leaf->area * leaf->radiosity.band[0];
        area += leaf->area;
    }
    return light / area;
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

/* The mean of an equation's light over a triangle: four quarters, three points each,
 * exact to the second degree. */
static double mean_by(const struct equation *e, const struct triangle *t)
{
    double sum = 0.0;
    for (int q = 0; q < 4; q++)
        for (int k = 0; k < 3; k++) {
            double w[3], u, v;
            for (int c = 0; c < 3; c++) {
                double part = c == k ? 2.0 / 3.0 : 1.0 / 6.0;
                w[c] = q == 3 ? 0.5 - 0.5 * part : 0.5 * part + (c == q ? 0.5 : 0.0);
            }
            struct vec3 x = corners_mean(t->corner, (struct vec3){w[0], w[1], w[2]});
            e->shape->place(x, &u, &v);
            sum += light_at(e, 0, u, v) / 12.0;
        }
    return sum;
}

static void judge_groove(struct judge *judge, double degrees, double rho)
{
    const double both[2] = {rho, rho}, emission[2] = {1.0 - rho, 1.0 - rho};
    struct equation *e = equation_make(&GROOVE, degrees * PI / 180.0, emission, both);
    double found = mean_of_group(judge, "middle", 6);
    for (int64_t i = 0; i < judge->mesh.count; i++) {
        const struct solution_leaf *leaf = &judge->mesh.leaves[i];
        if (!is_in(judge, leaf, "middle", 6))
            continue;
        double light = mean_by(e, &leaf->triangle) - emission[0];
        struct rgb truth = {{light, light, light}};
        add_error(judge, leaf->area, reflected(judge, leaf), truth, truth, leaf->error);
    }
    take_mean(judge, found / equation_mean(e, 0) - 1.0);
    alloc_free(e);
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
    double light = 0.0, off = 0.0;
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
        take_mean(judge, off / light - 1.0);
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

static void print_errors(const struct judge *judge)
{
    struct ranked *ranked = alloc_array((size_t)judge->count, sizeof *ranked);
    double square = 0.0, light = 0.0, noise = 0.0, per_light[BANDS] = {0.0};
    int64_t held = 0, lit = 0;
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
        square += e->area * sum_of(e->square);
        light += e->area * square_of(e->light);
        noise += e->area * sum_of(e->variance);
        held += is_held(e, per_light);
        if (square_of(e->light) > 0.0)
            ranked[lit++].off =
                sqrt(fmax(sum_of(e->square), 0.0) / square_of(e->light));
    }
    qsort(ranked, (size_t)lit, sizeof *ranked, compare);
    printf("%lld ", (long long)judge->count);
    printf(judge->has_mean ? "%.3g " : "- ", 100.0 * judge->mean);
    if (lit > 0)
        printf("%.3g %.3g %.3g %.3g %.3g %.3g\n",
               100.0 * sqrt(fmax(square, 0.0) / light), 100.0 * ranked[lit - 1].off,
               100.0 * ranked[lit / 2].off, 100.0 * ranked[lit - 1 - lit / 10].off,
               100.0 * (double)held / (double)judge->count,
               100.0 * sqrt(noise / light));
    else
        printf("- - - - - -\n");
    alloc_free(ranked);
}

static bool judge_by(struct judge *judge, const char *word, struct error *error)
{
    size_t length = strcspn(word, "=~<");
    const char *value = word + length + 1;
    struct truth truth = {0};
    char *comma;
    if (word[length] == '\0') {
        if (!truth_read(&truth, word, judge->scene, error))
            return false;
        judge_elements(judge, &truth);
        truth_free(&truth);
    } else if (strncmp(word, "of=", 3) == 0) {
        judge->only = value;
    } else if (strncmp(word, "groove=", 7) == 0) {
        double degrees = strtod(value, &comma);
        judge_groove(judge, degrees, strtod(comma + 1, NULL));
    } else {
        double b = strtod(value, NULL), mean = mean_of_group(judge, word, length);
        if (!isfinite(mean))
            return error_set(error, EXIT_USAGE, "%s: there is no such group", word);
        if (word[length] == '=')
            judge_uniform(judge, word, length, b);
        take_mean(judge, word[length] != '<' ? mean / b - 1.0
                         : b > 0.0           ? mean / b
                                             : mean);
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
