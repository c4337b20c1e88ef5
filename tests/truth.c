/* The truth about a scene, in elements and points.
 *
 * The elements are much finer than the leaves they are to judge and all of about one
 * size, so the mean over any leaf is that of the elements in it. Their means are found by
 * light paths, which serve all elements at once: an element that has the share s of all
 * the light that arrives somewhere is known to 1 / sqrt(s N) by N of them; paths from
 * each element on have some five times the noise. Light is added in fixed point where it
 * lands, so sums are the same in any order and on any ranks. Of faces that lie on each
 * other a light path meets one; its light lands on the others, too.
 *
 * A point has no area on which light could land: paths that begin there tell its light.
 * An element of area a gets them in proportion to sqrt(a), which has the least noise,
 * weighted by area, for as many paths in all. Each point is random in its element: an
 * even grid would meet the leaves' corners or their centres alone. (Of fewer points too
 * few are near lamps, where pictures have most of their error.)
 *
 * Why two estimates: tests/deviation.h. */
#include "tests/truth.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "geom/alloc.h"
#include "tests/scenes.h"

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

struct truth truth_make(const struct scene *scene, int64_t wanted)
{
    struct truth truth = {.root_count = scene_root_count(scene),
                          .area = scene_area(scene)};
    int64_t capacity = 0;
    double lit = 0.0;
    for (int32_t root = 0; root < truth.root_count; root++)
        lit += reflects(scene, root) ? scene_root_area(scene, root) : 0.0;
    for (int32_t root = 0; root < truth.root_count; root++) {
        int level = level_of(scene, root, lit / (double)wanted);
        int64_t parts = reflects(scene, root) ? INT64_C(1) << 2 * level : 0;
        RESERVE(truth.items, &capacity, truth.count + parts);
        for (int64_t i = 0; i < parts; i++)
            truth.items[truth.count++] =
                (struct element){.id = id_of_element(root, level, i)};
    }
    return truth;
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

static bool read_elements(struct truth *truth, FILE *file, const char *path,
                          struct error *error)
{
    struct header header, own = header_of(truth);
    if (fread(&header, sizeof header, 1, file) != 1 ||
        memcmp(header.magic, own.magic, sizeof own.magic) != 0 || header.count < 0)
        return error_set(error, EXIT_USAGE, "%s: not a reference", path);
    if (header.root_count != own.root_count || header.area != own.area)
        return error_set(error, EXIT_USAGE, "%s: the reference is of another scene",
                         path);
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
    *truth =
        (struct truth){.root_count = scene_root_count(scene), .area = scene_area(scene)};
    FILE *file = fopen(path, "rb");
    if (!file)
        return error_set(error, EXIT_USAGE, "%s: cannot read", path);
    bool done = read_elements(truth, file, path, error);
    fclose(file);
    if (!done)
        truth_free(truth);
    return done;
}

/* --- means --- */

/* Of the light of a path: beyond it, single landings are rounded. */
static const double UNIT = 0x1p-24;

/* Where light lands. */
struct ground {
    const struct truth *truth;
    const struct scene *scene;
    int64_t *first; /* [roots] the first element of a root, -1: none */
    int64_t *sums;  /* [count][BANDS] light, in UNITs */
    int32_t *over;  /* roots that overlap a root in its plane, root by root */
    int64_t *end;   /* [roots + 1] of those of the root before */
    int64_t capacity;
};

static void find_overlaps(struct ground *ground)
{
    const struct scene *scene = ground->scene;
    int32_t roots = ground->truth->root_count;
    for (int32_t met = 0; met < roots; met++) {
        struct triangle s = scene_root_triangle(scene, met);
        struct plane plane = scene_root_plane(scene, met);
        int64_t *end = &ground->end[met + 1];
        *end = ground->end[met];
        for (int32_t r = 0; r < roots && scene_root_area(scene, met) > 0.0; r++) {
            struct triangle t = scene_root_triangle(scene, r);
            struct plane own = scene_root_plane(scene, r);
            if (r == met || ground->first[r] < 0 || !triangle_is_in(&t, &own, &plane) ||
                !triangles_overlap(&s, &t, &plane))
                continue;
            RESERVE(ground->over, &ground->capacity, *end + 1);
            ground->over[(*end)++] = r;
        }
    }
}

static struct ground ground_make(const struct truth *truth, const struct scene *scene)
{
    size_t roots = (size_t)truth->root_count;
    struct ground ground = {.truth = truth, .scene = scene};
    ground.end = alloc_array(roots + 1, sizeof *ground.end);
    ground.first = alloc_array(roots, sizeof *ground.first);
    ground.sums = alloc_array((size_t)truth->count * BANDS, sizeof *ground.sums);
    for (int32_t root = 0; root < truth->root_count; root++)
        ground.first[root] = -1;
    for (int64_t i = truth->count - 1; i >= 0; i--)
        ground.first[truth->items[i].id.root] = i;
    find_overlaps(&ground);
    return ground;
}

static void ground_free(struct ground *ground)
{
    alloc_free(ground->first);
    alloc_free(ground->sums);
    alloc_free(ground->over);
    alloc_free(ground->end);
}

/* Lets light land in a root, at these barycentric coordinates. */
static void land_in(struct ground *ground, int32_t root, const double weight[3],
                    const struct rgb *light)
{
    int64_t first = ground->first[root], number = 0;
    if (first < 0)
        return;
    double w[3] = {weight[0], weight[1], weight[2]};
    for (int level = id_level(ground->truth->items[first].id); level > 0; level--)
        number = number << 2 | triangle_child_at(w);
    for (int c = 0; c < BANDS; c++)
        ground->sums[(first + number) * BANDS + c] += llrint(light->band[c] / UNIT);
}

static void land(void *listener, const struct landing *landing)
{
    struct ground *ground = listener;
    const double *at = landing->weight;
    struct triangle met = scene_root_triangle(ground->scene, landing->root);
    struct vec3 normal = scene_root_plane(ground->scene, landing->root).normal;
    struct vec3 x = corners_mean(met.corner, (struct vec3){at[0], at[1], at[2]});
    land_in(ground, landing->root, at, &landing->light);
    const int64_t *end = &ground->end[landing->root];
    for (int64_t i = end[0]; i < end[1]; i++) {
        struct triangle t = scene_root_triangle(ground->scene, ground->over[i]);
        struct segment s = segment_make(vec3_add(x, normal), vec3_sub(x, normal));
        double weight[3];
        if (segment_line_meets(&s, &t, weight))
            land_in(ground, ground->over[i], weight, &landing->light);
    }
}

/* Collective. The means of all elements, on all ranks. */
static void find_means(const struct comm *comm, const struct pathtracer *pathtracer,
                       struct truth *truth, int64_t paths)
{
    const struct scene *scene = pathtracer->scene;
    double unit = UNIT * pathtracer_power(pathtracer) / (double)paths;
    for (int half = 0; half < TRUTH_HALVES; half++) {
        struct ground ground = ground_make(truth, scene);
        for (int64_t i = comm->rank; i < paths; i += comm->size)
            pathtracer_shine(pathtracer, (uint64_t)(TRUTH_HALVES * i + half), land,
                             &ground);
        comm_add(comm, ground.sums, truth->count * BANDS);
        for (int64_t i = 0; i < truth->count; i++) {
            struct element *element = &truth->items[i];
            int32_t root = (int32_t)element->id.root;
            for (int c = 0; c < BANDS; c++)
                element->mean[half].band[c] =
                    scene_root_material(scene, root)->reflectance.band[c] * unit *
                    (double)ground.sums[i * BANDS + c] / element_area(element, scene);
        }
        ground_free(&ground);
    }
}

/* --- points --- */

/* A point anywhere in an element. */
static void place_point(struct element *element, int64_t number)
{
    struct triangle part = pathtracer_part(element->id);
    struct random random = random_seed((uint64_t)number + 1);
    for (int k = 0; k < 4; k++)
        random_bits(&random); /* the first numbers of neighbouring seeds are alike */
    struct vec3 x = random_point_on(&random, &part);
    for (int axis = 0; axis < 3; axis++)
        element->weight[axis] = vec3_axis(x, axis);
}

void truth_find_point(struct truth *truth, int64_t number,
                      const struct pathtracer *pathtracer, int samples)
{
    struct element *element = &truth->items[number];
    double average = truth->area / (double)truth->count;
    double share = sqrt(element_area(element, pathtracer->scene) / average);
    place_point(element, number);
    struct vec3 x = {element->weight[0], element->weight[1], element->weight[2]};
    struct triangle point = {{x, x, x}};
    for (int half = 0; half < TRUTH_HALVES; half++)
        element->point[half] = pathtracer_reflected(
            pathtracer, (int32_t)element->id.root, &point, (int)ceil(share * samples),
            (uint64_t)(TRUTH_HALVES * number + half));
}

/* Rank 0 receives the estimates of the others. */
static void gather_elements(const struct comm *comm, struct truth *truth)
{
    int64_t own = 0, arriving, at = 0;
    int64_t most = truth->count / comm->size + 1;
    struct element *mine = alloc_array((size_t)most, sizeof *mine);
    for (int64_t i = comm->rank; i < truth->count; i += comm->size)
        mine[own++] = truth->items[i];
    int *counts = alloc_array(2 * (size_t)comm->size, sizeof *counts);
    counts[0] = comm_count(comm, own);
    struct element *all = comm_exchange(comm, mine, counts, sizeof *mine,
                                        counts + comm->size, &arriving);
    for (int rank = 0; rank < comm->size && at < arriving; rank++)
        for (int64_t i = rank; i < truth->count; i += comm->size)
            truth->items[i] = all[at++];
    alloc_free(all);
    alloc_free(counts);
    alloc_free(mine);
}

/* By paths that begin on the element: hardly any from a wide sky meet it. */
static void find_mean(struct element *element, int64_t number,
                      const struct pathtracer *pathtracer, int paths)
{
    struct triangle part = pathtracer_part(element->id);
    for (int half = 0; half < TRUTH_HALVES; half++)
        element->mean[half] =
            pathtracer_reflected(pathtracer, (int32_t)element->id.root, &part, paths,
                                 (uint64_t)(TRUTH_HALVES * number + half));
}

struct truth truth_trace(const struct comm *comm, const struct scene *scene,
                         const struct octree *octree, int64_t wanted,
                         struct truth_paths paths)
{
    bool sky = scene->sky_first < scene->input_count;
    struct pathtracer pathtracer = pathtracer_make(scene, octree);
    struct truth truth = truth_make(scene, wanted);
    if (!sky)
        find_means(comm, &pathtracer, &truth, paths.element * truth.count);
    for (int64_t i = comm->rank; i < truth.count; i += comm->size) {
        if (sky)
            find_mean(&truth.items[i], i, &pathtracer, paths.element);
        if (paths.point > 0)
            truth_find_point(&truth, i, &pathtracer, paths.point);
    }
    gather_elements(comm, &truth);
    pathtracer_free(&pathtracer);
    return truth;
}
