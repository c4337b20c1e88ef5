/* The truth about a scene, in elements and points.
 *
 * The elements are much finer than what they are to judge and all of about one size, so the mean
 * over any leaf is that of the elements in it. Their points are random, one in each: an even grid
 * of points would meet the leaves' corners or their centres alone.
 *
 * Two estimates instead of one of twice the paths: the product of the deviations from both has
 * the square of the error as its expectation, without the variance of the estimates, which does
 * not vanish (tests/deviation.c). */
#include "tests/truth.h"

#include <stdio.h>
#include <string.h>

#include "geom/alloc.h"
#include "tests/random.h"

static bool reflects(const struct scene *scene, int32_t root)
{
    return scene_root_area(scene, root) > 0.0 &&
           rgb_sum(scene_root_material(scene, root)->reflectance) > 0.0;
}

static int level_of(const struct scene *scene, int32_t root, double area)
{
    double own = scene_root_area(scene, root);
    int level = 0;
    for (; own > area && level < TRUTH_MAX_LEVEL; level++)
        own *= 0.25;
    return level;
}

/* Element `number` of 4^level of a root. */
static struct patch_id id_of_element(int32_t root, int level, int64_t number)
{
    struct patch_id id = id_of_root((uint32_t)root);
    while (level-- > 0)
        id = id_child(id, (int)(number >> 2 * level & 3));
    return id;
}

/* Barycentric coordinates of the corners of a patch in its root. */
static struct triangle part_of(struct patch_id id)
{
    struct triangle part = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (int step = 0; step < id_level(id); step++)
        part = triangle_child(&part, id_step(id, step));
    return part;
}

struct truth truth_make(const struct scene *scene, int64_t wanted)
{
    struct truth truth = {.root_count = scene_root_count(scene), .area = scene_area(scene)};
    int64_t capacity = 0;
    for (int32_t root = 0; root < truth.root_count; root++) {
        int level = level_of(scene, root, truth.area / (double)wanted);
        int64_t parts = reflects(scene, root) ? INT64_C(1) << 2 * level : 0;
        truth.items = alloc_reserve(truth.items, &capacity, truth.count + parts,
                                    sizeof *truth.items);
        for (int64_t i = 0; i < parts; i++)
            truth.items[truth.count++] = (struct element){.id = id_of_element(root, level, i)};
    }
    return truth;
}

void truth_free(struct truth *truth)
{
    alloc_free(truth->items);
    *truth = (struct truth){0};
}

double element_area(const struct element *element, const struct scene *scene)
{
    double parts = (double)(INT64_C(1) << 2 * id_level(element->id));
    return scene_root_area(scene, (int32_t)element->id.root) / parts;
}

void truth_estimate(struct truth *truth, int64_t number, const struct pathtracer *pathtracer,
                    int samples)
{
    struct element *element = &truth->items[number];
    struct triangle part = part_of(element->id);
    struct random random = random_seed((uint64_t)number + 1);
    for (int k = 0; k < 4; k++)
        random_bits(&random); /* the first numbers of neighbouring seeds are alike */
    double u = random_unit(&random), v = random_unit(&random);
    bool beyond = u + v > 1.0;
    u = beyond ? 1.0 - u : u;
    v = beyond ? 1.0 - v : v;
    struct vec3 x = triangle_point(&part, (struct vec3){1.0 - u - v, u, v});
    struct triangle point = {{x, x, x}};
    for (int axis = 0; axis < 3; axis++)
        element->weight[axis] = vec3_axis(x, axis);
    int32_t root = (int32_t)element->id.root;
    for (int half = 0; half < TRUTH_HALVES; half++) {
        uint64_t seed = (uint64_t)(2 * TRUTH_HALVES * number + half);
        element->mean[half] = pathtracer_reflected(pathtracer, root, &part, samples, seed);
        element->point[half] = pathtracer_reflected(pathtracer, root, &point, (samples + 3) / 4,
                                                    seed + TRUTH_HALVES);
    }
}

/* --- files: a header, then the elements --- */

struct header {
    char magic[8];
    int64_t count, root_count;
    double area;
};

static struct header header_of(const struct truth *truth)
{
    struct header header = {.count = truth->count, .root_count = truth->root_count,
                            .area = truth->area};
    memcpy(header.magic, "phrtruth", sizeof header.magic);
    return header;
}

bool truth_write(const struct truth *truth, const char *path, struct error *error)
{
    struct header header = header_of(truth);
    size_t count = (size_t)truth->count;
    FILE *file = fopen(path, "wb");
    bool written = file && fwrite(&header, sizeof header, 1, file) == 1 &&
                   fwrite(truth->items, sizeof *truth->items, count, file) == count;
    bool closed = file && fclose(file) == 0;
    return (written && closed) || error_set(error, EXIT_FAILED, "%s: cannot write", path);
}

static bool read_elements(struct truth *truth, FILE *file, const char *path, struct error *error)
{
    struct header header, own = header_of(truth);
    if (fread(&header, sizeof header, 1, file) != 1 ||
        memcmp(header.magic, own.magic, sizeof own.magic) != 0 || header.count < 0)
        return error_set(error, EXIT_USAGE, "%s: not a reference", path);
    if (header.root_count != own.root_count || header.area != own.area)
        return error_set(error, EXIT_USAGE, "%s: the reference is of another scene", path);
    truth->count = header.count;
    truth->items = alloc_array((size_t)truth->count, sizeof *truth->items);
    if (fread(truth->items, sizeof *truth->items, (size_t)truth->count, file) !=
        (size_t)truth->count)
        return error_set(error, EXIT_USAGE, "%s: too short", path);
    return true;
}

bool truth_read(struct truth *truth, const char *path, const struct scene *scene,
                struct error *error)
{
    *truth = (struct truth){.root_count = scene_root_count(scene), .area = scene_area(scene)};
    FILE *file = fopen(path, "rb");
    if (!file)
        return error_set(error, EXIT_USAGE, "%s: cannot read", path);
    bool done = read_elements(truth, file, path, error);
    fclose(file);
    if (!done)
        truth_free(truth);
    return done;
}

/* --- on several ranks --- */

/* Rank 0 receives what the others have estimated. */
static void gather_elements(const struct comm *comm, struct truth *truth)
{
    int64_t own = 0, arriving, at = 0;
    struct element *mine = alloc_array((size_t)(truth->count / comm->size + 1), sizeof *mine);
    for (int64_t i = comm->rank; i < truth->count; i += comm->size)
        mine[own++] = truth->items[i];
    int *counts = alloc_array((size_t)comm->size, sizeof *counts);
    counts[0] = comm_count(comm, own);
    struct element *all = comm_exchange(comm, mine, counts, sizeof *mine, &arriving);
    for (int rank = 0; rank < comm->size && at < arriving; rank++)
        for (int64_t i = rank; i < truth->count; i += comm->size)
            truth->items[i] = all[at++];
    alloc_free(all);
    alloc_free(counts);
    alloc_free(mine);
}

struct truth truth_trace(const struct comm *comm, const struct scene *scene,
                         const struct octree *octree, int64_t wanted, int samples)
{
    struct pathtracer pathtracer = pathtracer_make(scene, octree);
    struct truth truth = truth_make(scene, wanted);
    for (int64_t i = comm->rank; i < truth.count; i += comm->size)
        truth_estimate(&truth, i, &pathtracer, samples);
    gather_elements(comm, &truth);
    pathtracer_free(&pathtracer);
    return truth;
}
