/* Makes the truth about a scene that has direct light only, exact from points: a file
 * like that of tests/bench/reference.c, without noise.
 *
 *   make chart, or  build/mpi/direct scenes/shadow.obj shadow.ref [ELEMENTS]
 *
 * What reflects sees nothing else that does; lamps and screens are black. A point x has
 *
 *     rho H(x) = rho  sum over lamps of  E F(x, part of the lamp that it sees),
 *
 * where F is Lambert's form factor (geom/lambert.h), and the part that it sees past all
 * screens is that of tools/viewfactors/outlook.h. The mean over an element is its
 * exchange with the lamp (tools/viewfactors/screened.h). Both halves of the truth are the
 * same, and its points are those that reference.c has, from truth_find_point() with one
 * path. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "geom/contour.h"
#include "geom/lambert.h"
#include "rad/beyond/patch_exchange.h"
#include "tests/reading.h"
#include "tests/truth.h"
#include "tools/viewfactors/outlook.h"
#include "tools/viewfactors/screened.h"

enum { ELEMENTS = 20000 };

/* The error of the form factor of a part of an element. */
static const double CLOSE = 1e-8;

/* What is black and has no light of its own. */
struct screens {
    int32_t root[SCREENS_MAX];
    int32_t count;
};

static struct facet root_facet(const struct scene *scene, int32_t root)
{
    return (struct facet){scene->triangles[root], scene->planes[root], scene->areas[root],
                          root};
}

/* Form factor from a point to the part of a lamp that it sees. */
static double seen_from(const struct scene *scene, const struct screens *screens,
                        struct vec3 x, struct vec3 normal, const struct facet *lamp)
{
    struct outlook outlook;
    double factor = 0.0;
    outlook_start(&outlook, x, &lamp->triangle);
    for (int32_t i = 0; i < screens->count; i++)
        outlook_hide(&outlook, &scene->triangles[screens->root[i]]);
    for (int i = 0; i < outlook.count; i++)
        factor += point_polygon_factor(x, normal, outlook.piece[i].corner,
                                       outlook.piece[i].count);
    return factor;
}

/* The mean of the same over a part of a root. */
static double seen_by(const struct scene *scene, const struct screens *screens,
                      const struct facet *part, const struct facet *lamp)
{
    double open = triangle_exchange(&part->triangle, &lamp->triangle);
    struct screened found = {.exchange = 0.0};
    if (facets_face(part, lamp))
        screened_exchange(part, lamp, scene->triangles, screens->root, screens->count,
                          open, CLOSE * part->area, &found);
    return found.exchange / part->area;
}

static void find_element(const struct scene *scene, const struct screens *screens,
                         struct element *element)
{
    int32_t root = (int32_t)element->id.root;
    struct facet whole = root_facet(scene, root), part = whole;
    struct vec3 weight = {element->weight[0], element->weight[1], element->weight[2]};
    struct vec3 x = corners_mean(whole.triangle.corner, weight);
    struct rgb mean = {{0.0, 0.0, 0.0}}, at = mean;
    for (int step = 0; step < id_level(element->id); step++)
        part.triangle = triangle_child(&part.triangle, id_step(element->id, step));
    part.area = triangle_area(&part.triangle);
    for (int32_t i = 0; i < scene->input_count; i++) {
        struct rgb e = scene_root_material(scene, i)->emission;
        struct facet lamp = root_facet(scene, i);
        if (!(rgb_sum(e) > 0.0))
            continue;
        double all = seen_by(scene, screens, &part, &lamp);
        double there = seen_from(scene, screens, x, whole.plane.normal, &lamp);
        for (int c = 0; c < BANDS; c++) {
            double rho = scene_root_material(scene, root)->reflectance.band[c];
            mean.band[c] += rho * e.band[c] * all;
            at.band[c] += rho * e.band[c] * there;
        }
    }
    for (int half = 0; half < TRUTH_HALVES; half++) {
        element->mean[half] = mean;
        element->point[half] = at;
    }
}

static void make_truth(const struct scene *scene, const struct screens *screens,
                       struct truth *truth)
{
    struct octree *octree =
        octree_create(scene->triangles, scene_blocking_planes(scene),
                      scene->input_count);
    struct pathtracer pathtracer = pathtracer_make(scene, octree);
    for (int64_t i = 0; i < truth->count; i++) {
        truth_find_point(truth, i, &pathtracer, 1);
        find_element(scene, screens, &truth->items[i]);
    }
    pathtracer_free(&pathtracer);
    octree_destroy(octree);
}

/* The screens of a scene whose light is direct. False if it is none. */
static bool find_screens(const struct scene *scene, struct screens *screens,
                         struct error *error)
{
    bool direct = true;
    screens->count = 0;
    for (int32_t i = 0; i < scene->input_count; i++) {
        const struct material *material = scene_root_material(scene, i);
        struct facet own = root_facet(scene, i);
        if (material_is_dark(material)) {
            direct = direct && screens->count < SCREENS_MAX;
            if (direct)
                screens->root[screens->count++] = i;
        }
        for (int32_t k = 0; k < i; k++) {
            struct facet other = root_facet(scene, k);
            const struct material *of_other = scene_root_material(scene, k);
            direct = direct && !(facets_face(&own, &other) &&
                                 rgb_sum(material->reflectance) > 0.0 &&
                                 rgb_sum(of_other->reflectance) > 0.0);
        }
    }
    return direct ||
           error_set(error, EXIT_USAGE,
                     "what reflects sees other light, or past too many screens");
}

int main(int argc, char **argv)
{
    struct comm comm;
    struct error error = {0};
    long long elements = argc > 3 ? atoll(argv[3]) : ELEMENTS;
    comm_start(&comm, &argc, &argv);
    struct screens screens;
    struct scene *scene = NULL;
    if (argc < 3 || elements < 1)
        error_set(&error, EXIT_USAGE, "usage: direct SCENE.obj OUT.ref [ELEMENTS]");
    else
        scene = scene_read((struct reading){.path = argv[1]}, &error);
    if (scene && find_screens(scene, &screens, &error)) {
        double start = comm_seconds();
        struct truth truth = truth_make(scene, elements);
        make_truth(scene, &screens, &truth);
        if (truth_write(&truth, argv[2], &error))
            printf("%s: %lld elements exact, %.1f s\n", argv[2],
                   (long long)truth.count, comm_seconds() - start);
        truth_free(&truth);
    }
    if (error.code != EXIT_DONE)
        fprintf(stderr, "direct: %s\n", error.text);
    scene_destroy(scene);
    comm_stop(&comm);
    return error.code;
}
