/* Tests of io/picture/shading.h. Proved are: the interpolation is continuous over every
 * smooth surface, also where large leaves meet small ones and where roots meet; it keeps
 * constants and, on a regular subdivision, linear functions; it neither depends on the
 * order in which patches were made nor blends across bounds (materials, creases, sides,
 * the dark under a box); facets whose normals agree show one curved surface.
 *
 *      3-------2     the square: roots (0, 1, 2) and (0, 2, 3), whose common edge is
 *      | 1  /  |     the diagonal
 *      |  / 0  |
 *      0-------1
 *
 * Barycentric coordinates of all leaves are dyadic numbers, so a point on an edge, and
 * one 2^-50 beside it, are exact, and so is the way down the quadtree to its leaf.
 *
 * 2^-50 off an edge of a leaf of level 6 the value is off by 2^6 2^-50 = 6e-14 at most;
 * the tolerance of continuity, 1e-12, leaves room for rounding. */
#include "io/picture/shading.h"

#include <math.h>
#include <stdlib.h>

#include "rad/beyond/paths.h"
#include "rad/pushpull.h"
#include "tests/scenes.h"
#include "tests/shaded.h"
#include "tests/tap.h"

static const double CONTINUOUS = 1e-12;
enum { DEEPEST = 6 };

/* A scene with all that stands on it. */
struct stage {
    struct scene *scene;
    struct octree *octree;
    struct forest *forest;
    struct shading *shading;
};

/* --- scenes --- */

/* The quadrilateral abcd as the roots (a, b, c) and (a, c, d). */
static void add_face(struct soup *soup, struct vec3 a, struct vec3 b, struct vec3 c,
                     struct vec3 d)
{
    soup_add(soup, (struct triangle){{a, b, c}});
    soup_add(soup, (struct triangle){{a, c, d}});
}

static struct stage stage_of(struct scene *scene)
{
    struct world world = world_make(scene);
    return (struct stage){scene, world.octree, world.model.forest, NULL};
}

/* The square with its corner 3 lifted by `lift`; a second material is there. */
static struct scene *folded_square(double lift)
{
    struct soup soup = {0};
    add_face(&soup, point(0, 0, 0), point(1, 0, 0), point(1, 1, 0), point(0, 1, lift));
    paint(&soup, 0.0, 0.0);
    paint(&soup, 0.0, 0.0);
    return scene_of_soup(&soup);
}

/* The square folded by 45 degrees about its diagonal, with the same normal at all corners
 * of both roots but for corner 2 of root 1 = (0, 2, 3), which is one end of the
 * diagonal. */
static struct scene *curved_square(struct vec3 normal, struct vec3 other)
{
    struct scene *scene = folded_square(0.0);
    double half = sqrt(0.125); /* cos 45 / 2, sin 45 / 2 */
    scene->triangles[1].corner[2] = point(0.5 - half, 0.5 + half, 0.5);
    scene_add_normals(scene);
    for (int i = 0; i < 6; i++)
        scene->normals[i] = vec3_unit(normal);
    scene->normals[3 + 1] = vec3_length(other) > 0.0 ? vec3_unit(other) : other;
    return scene;
}

static const struct vec3 UP = {0.0, 0.0, 1.0};
static const struct vec3 BETWEEN = {0.27059805007309849, -0.27059805007309849,
                                    0.92387953251128674};

static struct stage curved_stage(void)
{
    return stage_of(curved_square(BETWEEN, BETWEEN));
}

static struct stage square_stage(void)
{
    return stage_of(folded_square(0.0));
}

static void shade(struct stage *stage, bool flat)
{
    shading_destroy(stage->shading);
    stage->shading = flat ? shading_create(stage->forest, NULL, NULL, NULL)
                          : shade_forest(stage->forest, stage->octree, NULL, NULL);
}

static void dismantle(struct stage *stage)
{
    shading_destroy(stage->shading);
    forest_destroy(stage->forest);
    octree_destroy(stage->octree);
    scene_destroy(stage->scene);
}

/* --- subdivisions and fields --- */

static void split_regularly(struct forest *forest, int level)
{
    for (int32_t p = 0; p < forest->count; p++)
        if (id_level(forest->patches[p].id) < level)
            forest_split(forest, p);
}

/* Splits about `share` of the patches of each root: leaves of all levels side by side. */
static void split_randomly(struct forest *forest, struct random *random, double share)
{
    for (int32_t p = 0; p < forest->count; p++) {
        int level = id_level(forest->patches[p].id);
        if (level < DEEPEST && random_unit(random) < (level < 2 ? 0.9 : share))
            forest_split(forest, p);
    }
}

static void set_constant(struct forest *forest, double value)
{
    for (int64_t p = 0; p < forest->count; p++)
        forest->radiosity[p] = (struct rgb){{value, 2.0 * value, 0.0}};
}

static struct rgb linear_field(struct vec3 x)
{
    return (struct rgb){{1.0 + x.x, 2.0 - x.x + 0.5 * x.y, 1.0 + x.y}};
}

static void set_linearly(struct forest *forest)
{
    for (int32_t p = 0; p < forest->count; p++) {
        struct triangle t = forest_triangle(forest, p);
        forest->radiosity[p] = linear_field(triangle_centroid(&t));
    }
}

static double difference(struct rgb a, struct rgb b)
{
    double largest = 0.0;
    for (int c = 0; c < BANDS; c++)
        largest = fmax(largest, fabs(a.band[c] - b.band[c]));
    return largest;
}

/* A root in its own barycentric coordinates. */
static const struct triangle WHOLE = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

static struct rgb value_at(const struct stage *stage, int32_t root, struct vec3 w)
{
    const double weight[3] = {w.x, w.y, w.z};
    return shading_at(stage->shading, root, weight, &(int32_t){0});
}

/* --- continuity --- */

/* The points on the two sides of an edge of a leaf, and the roots they lie on. */
struct crossing {
    int32_t root[2];
    struct vec3 weight[2];
};

/* Over the diagonal: (w0, 0, w2) of root 0 is (w0, w2, 0) of root 1, and back. */
static bool cross_diagonal(struct crossing *crossing, struct vec3 on_edge)
{
    const double tiny = ldexp(1.0, -50);
    bool from_first = crossing->root[0] == 0;
    if ((from_first ? on_edge.y : on_edge.z) != 0.0)
        return false;
    crossing->root[1] = 1 - crossing->root[0];
    crossing->weight[1] = from_first ? point(on_edge.x - tiny, on_edge.z, tiny)
                                     : point(on_edge.x - tiny, tiny, on_edge.y);
    return true;
}

/* Steps off a leaf over edge k at its share t. False where the surface ends there. */
static bool make_crossing(const struct stage *stage, int32_t leaf, int k, double t,
                          struct crossing *crossing)
{
    struct patch_id id = stage->forest->patches[leaf].id;
    struct triangle w = pathtracer_part(id);
    struct vec3 a = w.corner[k], b = w.corner[(k + 1) % 3], c = w.corner[(k + 2) % 3];
    struct vec3 on_edge = vec3_add(vec3_scale(a, 1.0 - t), vec3_scale(b, t));
    struct vec3 step = vec3_scale(vec3_sub(c, a), ldexp(1.0, id_level(id) - 50));
    struct vec3 beyond = vec3_sub(on_edge, step);
    crossing->root[0] = crossing->root[1] = (int32_t)id.root;
    crossing->weight[0] = vec3_add(on_edge, step);
    crossing->weight[1] = beyond;
    return fmin(beyond.x, fmin(beyond.y, beyond.z)) >= 0.0 ||
           cross_diagonal(crossing, on_edge);
}

/* Jumps and steps at the edges of a stage. */
struct continuity {
    int crossings, over_diagonal;
    double largest; /* jump */
};

static void visit_edge(const struct stage *stage, int32_t leaf, int k, double t,
                       struct continuity *seen)
{
    struct crossing crossing;
    if (!make_crossing(stage, leaf, k, t, &crossing))
        return;
    seen->crossings++;
    seen->over_diagonal += crossing.root[0] != crossing.root[1];
    double jump = difference(value_at(stage, crossing.root[0], crossing.weight[0]),
                             value_at(stage, crossing.root[1], crossing.weight[1]));
    seen->largest = fmax(seen->largest, jump);
}

/* Each edge of each leaf: its middle, a quarter (T-vertices), a random point. */
static void visit_edges(const struct stage *stage, struct random *random,
                        struct continuity *seen)
{
    for (int32_t p = 0; p < stage->forest->count; p++) {
        for (int k = 0; k < 3 && patch_is_leaf(&stage->forest->patches[p]); k++) {
            visit_edge(stage, p, k, 0.5, seen);
            visit_edge(stage, p, k, 0.25, seen);
            for (int i = 0; i < 3; i++)
                visit_edge(stage, p, k, (double)(1 + random_bits(random) % 1023) / 1024.0,
                           seen);
        }
    }
}

static void test_continuity(const char *name, struct stage (*make)(void))
{
    struct random random = random_seed(11);
    struct continuity seen = {0, 0, 0.0};
    for (int round = 0; round < 30; round++) {
        struct stage stage = make();
        split_randomly(stage.forest, &random, 0.2 + 0.01 * round);
        set_randomly(stage.forest, &random);
        shade(&stage, false);
        visit_edges(&stage, &random, &seen);
        dismantle(&stage);
    }
    tap_ok(seen.crossings > 20000 && seen.over_diagonal > 1000 &&
               seen.largest < CONTINUOUS,
           "%s: continuous at %d points, %d of them between roots (largest jump %.1e)",
           name, seen.crossings, seen.over_diagonal, seen.largest);
}

/* One root stays whole, the other one is split down to the diagonal in one place. */
static void test_large_beside_small(void)
{
    struct random random = random_seed(12);
    for (uint32_t fine = 0; fine < 2; fine++) {
        struct continuity seen = {0, 0, 0.0};
        struct stage stage = square_stage();
        struct patch_id id = id_of_root(fine);
        while (id_level(id) < DEEPEST) /* to corner 0, then away from it */
            id = id_child(id, id_level(id) < 3 ? 0 : fine ? 1 : 2);
        forest_reach(stage.forest, id);
        set_randomly(stage.forest, &random);
        shade(&stage, false);
        visit_edges(&stage, &random, &seen);
        tap_ok(seen.over_diagonal > 20 && seen.largest < CONTINUOUS,
               "level %d beside an undivided root %d (largest jump %.1e)", DEEPEST,
               1 - (int)fine, seen.largest);
        dismantle(&stage);
    }
}

/* Small leaves are lit around the middle of a large one's edge and dark at its ends: the
 * edge shows both. */
static void test_t_vertices(void)
{
    struct stage stage = square_stage();
    for (int32_t p = 0; p < stage.forest->count; p++) {
        struct patch_id id = stage.forest->patches[p].id;
        if (id.root == 1 && id_level(id) < 4)
            forest_split(stage.forest, p);
        struct triangle t = forest_triangle(stage.forest, p);
        struct vec3 x = scene_to_input(stage.scene, triangle_centroid(&t));
        double lit = id.root == 1 && fabs(x.x + x.y - 1.0) < 0.5;
        stage.forest->radiosity[p] = (struct rgb){{lit, lit, lit}};
    }
    shade(&stage, false);
    double middle = value_at(&stage, 1, point(0.5, 0.5, 0)).band[0];
    double end = value_at(&stage, 1, point(1, 0, 0)).band[0];
    tap_ok(middle > 0.5 && end < 0.1, "an edge shows the light of its middle: %.2f, %.2f",
           middle, end);
    dismantle(&stage);
}

/* A sliver is divided until its leaves have corners in the same place, or next to each
 * other, with nothing in between: they have no T-vertices, and show what they have. */
static void test_collapsed_leaves(void)
{
    const double width = 3e-14;
    struct soup soup = {0};
    add_face(&soup, point(0, 0, 0), point(1, 0, 0), point(1, 1, 0), point(0, 1, 0));
    soup_add(&soup, (struct triangle){
                        {{0.9, 0.1, 0.5}, {0.9 + width, 0.1, 0.5}, {0.9, 0.9, 0.5}}});
    paint(&soup, 0.0, 0.0);
    struct stage stage = stage_of(scene_of_soup(&soup));
    for (int way = 0; way < 4; way++) {
        struct patch_id id = id_of_root(2);
        while (id_level(id) < ID_MAX_LEVEL)
            id = id_child(id, way);
        forest_reach(stage.forest, id);
    }
    set_constant(stage.forest, 1.0);
    shade(&stage, false);
    double b = value_at(&stage, 2, point(0.2, 0.3, 0.5)).band[0];
    tap_ok(fabs(b - 1.0) < 1e-12, "leaves of a sliver, collapsed: B = %g", b);
    dismantle(&stage);
}

/* The visits can see a jump: flat shading has one at nearly every edge. */
static void test_jumps_are_seen(void)
{
    struct random random = random_seed(13);
    struct continuity seen = {0, 0, 0.0};
    struct stage stage = square_stage();
    split_randomly(stage.forest, &random, 0.4);
    set_randomly(stage.forest, &random);
    shade(&stage, true);
    visit_edges(&stage, &random, &seen);
    tap_ok(seen.largest > 0.5, "flat shading jumps (by %.2f)", seen.largest);
    dismantle(&stage);
}

/* --- fields that are known --- */

/* Some ten roundings of 1.1e-16, in the mean and the interpolation: 1e-15 relative. */
static void test_constant(void)
{
    struct random random = random_seed(14);
    struct stage stage = square_stage();
    const struct rgb expected = {{0.7, 1.4, 0.0}};
    double largest = 0.0;
    split_randomly(stage.forest, &random, 0.4);
    set_constant(stage.forest, 0.7);
    shade(&stage, false);
    for (int i = 0; i < 20000; i++) {
        struct vec3 w = random_point_on(&random, &WHOLE);
        struct rgb value = value_at(&stage, i % 2, w);
        /* weights that add up to 1 only within rounding are not the shading's fault */
        for (int c = 0; c < BANDS; c++)
            value.band[c] /= w.x + w.y + w.z;
        largest = fmax(largest, difference(value, expected) / 1.4);
    }
    tap_ok(largest <= 1e-15, "a constant stays constant (within %.1e)", largest);
    dismantle(&stage);
}

/* Around a vertex inside a regular subdivision the leaves lie in opposite pairs; those at
 * the border have too little on one side, and leaves there hand that on to the vertices
 * next to it. 1e-14: about 30 roundings of numbers of size 2. */
static void test_linear(void)
{
    struct stage stage = square_stage();
    split_regularly(stage.forest, 4);
    set_linearly(stage.forest);
    shade(&stage, false);
    int inner = 0;
    double largest = 0.0;
    double border = fmax(stage.scene->high.x, stage.scene->high.y) * (1.0 - 2.5 / 16.0);
    for (int64_t v = 0; v < stage.shading->vertex_count; v++) {
        struct vec3 x = stage.shading->positions[v];
        if (fmax(fabs(x.x), fabs(x.y)) >= border)
            continue;
        inner++;
        largest = fmax(largest, difference(stage.shading->values[v], linear_field(x)));
    }
    tap_ok(stage.shading->vertex_count == 17 * 17 && inner == 13 * 13 && largest < 1e-14,
           "a linear field at %d inner vertices (within %.1e)", inner, largest);
    dismantle(&stage);
}

/* RMS over all vertices of the values less the field, where all light is reflected. A
 * leaf's radiosity is said to have this standard deviation. */
static double reflected_error(struct stage *stage, double deviation, bool reflected)
{
    size_t count = (size_t)stage->forest->count;
    struct rgb *lamps = alloc_array(count, sizeof *lamps);
    float *error = alloc_array(count, sizeof *error);
    for (size_t p = 0; p < count; p++)
        error[p] = (float)(2.5 * deviation); /* as mpi/beyond/gather_error.c tells */
    shading_destroy(stage->shading);
    stage->shading =
        shade_forest(stage->forest, stage->octree, reflected ? lamps : NULL, error);
    double square = 0.0;
    for (int64_t v = 0; v < stage->shading->vertex_count; v++) {
        double off = difference(stage->shading->values[v],
                                linear_field(stage->shading->positions[v]));
        square += off * off / (double)stage->shading->vertex_count;
    }
    alloc_free(error);
    alloc_free(lamps);
    return sqrt(square);
}

/* Reflected light goes on up to the border, where it is beyond the means of all leaves:
 * four corrections leave a third of the error that the mean and one have. Noise as large
 * as is said is exaggerated by the last correction alone; taken for light, by all. */
static void test_reflected(void)
{
    static const double NOISE = 0.05;
    struct random random = random_seed(18);
    struct stage stage = square_stage();
    split_regularly(stage.forest, 4);
    set_linearly(stage.forest);
    double ranged = reflected_error(&stage, 0.0, false);
    double shown = reflected_error(&stage, 0.0, true);
    tap_ok(shown < 0.4 * ranged,
           "reflected light at the border: RMS error %.5f, kept in range %.5f", shown,
           ranged);
    for (int32_t p = 0; p < stage.forest->count; p++)
        for (int c = 0; c < BANDS; c++) /* uniform: its deviation is NOISE */
            stage.forest->radiosity[p].band[c] +=
                NOISE * sqrt(12.0) * (random_unit(&random) - 0.5);
    double calm = reflected_error(&stage, NOISE, true);
    double wild = reflected_error(&stage, 0.0, true);
    tap_ok(calm < 0.8 * wild, "noise that is known: RMS error %.4f, taken for light %.4f",
           calm, wild);
    dismantle(&stage);
}

/* Bright along one side of the square, as beside a lamp. `height`: of the square. */
static double edge_field(const struct stage *stage, struct vec3 x)
{
    double height = stage->scene->high.y - stage->scene->low.y;
    return exp(-25.0 * (x.y - stage->scene->low.y) / height);
}

/* Gives the leaves below `patch` their means; small ones where the field varies much. */
static double set_edge_field(struct stage *stage, int32_t patch)
{
    struct forest *forest = stage->forest;
    struct triangle t = forest_triangle(forest, patch);
    double low = HUGE_VAL, high = 0.0, mean = 0.0;
    for (int k = 0; k < 3; k++) {
        low = fmin(low, edge_field(stage, t.corner[k]));
        high = fmax(high, edge_field(stage, t.corner[k]));
    }
    bool divides = high - low > 0.5 && id_level(forest->patches[patch].id) < DEEPEST;
    if (divides)
        forest_split(forest, patch);
    for (int k = 0; k < 4 && divides; k++)
        mean += 0.25 * set_edge_field(stage, forest->patches[patch].children + k);
    for (int i = 0; i < 1024 && !divides; i++) { /* centroids five levels down */
        struct triangle at = t;
        for (int level = 0; level < 5; level++)
            at = triangle_child(&at, i >> 2 * level & 3);
        mean += edge_field(stage, triangle_centroid(&at)) / 1024.0;
    }
    forest->radiosity[patch] = (struct rgb){{mean, mean, mean}};
    return mean;
}

/* RMS of the picture less the field at many points; mean and least of the picture. */
static double edge_error(struct stage *stage, bool flat, double *mean, double *least)
{
    struct random random = random_seed(17);
    double square = 0.0;
    *mean = 0.0;
    *least = HUGE_VAL;
    shade(stage, flat);
    for (int i = 0; i < 100000; i++) {
        struct vec3 w = random_point_on(&random, &WHOLE);
        struct triangle t = scene_root_triangle(stage->scene, i % 2);
        struct vec3 x = corners_mean(t.corner, w);
        double shown = value_at(stage, i % 2, w).band[0],
               off = shown - edge_field(stage, x);
        square += off * off / 100000.0;
        *mean += shown / 100000.0;
        *least = fmin(*least, shown);
    }
    return sqrt(square);
}

/* Large leaves that only touch the bright edge must not shine like it. */
static void test_bright_edge(void)
{
    struct stage stage = square_stage();
    double flat_mean, mean, darkest, least;
    for (int32_t root = 0; root < 2; root++)
        set_edge_field(&stage, root);
    double flat = edge_error(&stage, true, &flat_mean, &darkest);
    double smooth = edge_error(&stage, false, &mean, &least);
    tap_ok(smooth < 0.6 * flat && fabs(mean / flat_mean - 1.0) < 0.05,
           "light that falls off within a few leaves: RMS error %.4f, flat %.4f; %.2f of "
           "the light",
           smooth, flat, mean / flat_mean);
    tap_ok(least >= darkest * (1.0 - 1e-12),
           "nothing is shown darker than the darkest leaf (%.2g, %.2g)", least, darkest);
    dismantle(&stage);
}

/* Where small bright leaves meet a large dark one, each gives the vertex its lack as far
 * as it is large: so the picture there is hardly brighter than the large one. */
static void test_large_leaf_counts(void)
{
    const double corner[3] = {1.0, 0.0, 0.0};
    struct stage stage = square_stage();
    struct patch_id id = id_of_root(1);
    while (id_level(id) < 4)
        id = id_child(id, 0);
    forest_reach(stage.forest, id);
    set_constant(stage.forest, 0.0);
    for (int64_t p = 0; p < stage.forest->count; p++)
        if (stage.forest->patches[p].id.root == 1)
            stage.forest->radiosity[p] = (struct rgb){{1.0, 1.0, 1.0}};
    shade(&stage, false);
    double shown = shading_at(stage.shading, 0, corner, &(int32_t){0}).band[0];
    tap_ok(shown < 0.2,
           "a bright leaf of 1/256 of its area makes a dark one shine little: %.2f",
           shown);
    dismantle(&stage);
}

/* Whether each leaf shows its constant at its centroid and at its three own vertices. The
 * vertex values are w B / w: two roundings. */
static bool is_flat(const struct stage *stage)
{
    const struct forest *forest = stage->forest;
    bool flat = true;
    for (int32_t p = 0; p < forest->count; p++) {
        const struct patch *patch = &forest->patches[p];
        if (!patch_is_leaf(patch))
            continue;
        struct triangle w = pathtracer_part(patch->id), t = forest_triangle(forest, p);
        struct rgb value =
            value_at(stage, (int32_t)patch->id.root, triangle_centroid(&w));
        flat = flat && difference(value, forest->radiosity[p]) == 0.0;
        for (int k = 0; k < 3; k++) {
            int32_t v = stage->shading->corners[3 * (int64_t)p + k];
            flat =
                flat &&
                difference(stage->shading->values[v], forest->radiosity[p]) < 1e-15 &&
                vec3_length(vec3_sub(stage->shading->positions[v], t.corner[k])) == 0.0;
        }
    }
    return flat;
}

static void test_flat(void)
{
    struct random random = random_seed(15);
    struct stage stage = square_stage();
    split_randomly(stage.forest, &random, 0.4);
    set_randomly(stage.forest, &random);
    shade(&stage, true);
    tap_ok(is_flat(&stage), "flat: each leaf shows its constant");
    tap_ok(stage.shading->vertex_count == 3 * forest_count(stage.forest).leaves,
           "flat: no vertex is shared");
    dismantle(&stage);
}

/* --- numbering --- */

/* A radiosity made of the ID, the same in whatever order patches are made. */
static void set_by_id(struct forest *forest)
{
    for (int64_t p = 0; p < forest->count; p++) {
        struct patch_id id = forest->patches[p].id;
        struct random random = random_seed((uint64_t)id.root << 32 | id.hierarchy);
        for (int c = 0; c < BANDS; c++)
            forest->radiosity[p].band[c] = random_unit(&random);
    }
}

/* Makes the patches of `from` in `to`, in an order that has nothing to do with theirs. */
static void copy_shuffled(const struct forest *from, struct forest *to,
                          struct random *random)
{
    int64_t count = from->count;
    int32_t *order = alloc_array((size_t)count, sizeof *order);
    for (int64_t i = 0; i < count; i++) {
        int64_t j = (int64_t)(random_bits(random) % (uint64_t)(i + 1));
        order[i] = order[j];
        order[j] = (int32_t)i;
    }
    for (int64_t i = 0; i < count; i++)
        forest_reach(to, from->patches[order[i]].id);
    alloc_free(order);
}

static bool corners_agree(const struct stage *a, const struct stage *b)
{
    bool agree = a->forest->count == b->forest->count;
    for (int32_t p = 0; agree && p < a->forest->count; p++) {
        if (!patch_is_leaf(&a->forest->patches[p]))
            continue;
        int32_t q = forest_reach(b->forest, a->forest->patches[p].id);
        for (int k = 0; k < 3; k++)
            agree = agree && a->shading->corners[3 * (int64_t)p + k] ==
                                 b->shading->corners[3 * (int64_t)q + k];
    }
    return agree;
}

static bool vertices_agree(const struct shading *a, const struct shading *b)
{
    bool agree = a->vertex_count == b->vertex_count;
    for (int64_t v = 0; agree && v < a->vertex_count; v++)
        agree = difference(a->values[v], b->values[v]) == 0.0 &&
                vec3_length(vec3_sub(a->positions[v], b->positions[v])) == 0.0;
    return agree;
}

static void test_numbering(void)
{
    struct random random = random_seed(16);
    for (int flat = 0; flat < 2; flat++) {
        struct stage one = square_stage(), other = square_stage();
        split_randomly(one.forest, &random, 0.5);
        copy_shuffled(one.forest, other.forest, &random);
        set_by_id(one.forest);
        set_by_id(other.forest);
        shade(&one, flat);
        shade(&other, flat);
        tap_ok(corners_agree(&one, &other) && vertices_agree(one.shading, other.shading),
               "%s: patches made in another order, the same vertices to the bit",
               flat ? "flat" : "smooth");
        dismantle(&one);
        dismantle(&other);
    }
}

/* Leaves, roots in order and depth first, meet new numbers one after the other. */
static void test_vertex_order(void)
{
    struct random random = random_seed(17);
    struct stage stage = square_stage();
    split_randomly(stage.forest, &random, 0.5);
    shade(&stage, false);
    int32_t next = 0;
    bool right = true;
    int32_t leaf = forest_next_leaf(stage.forest, -1);
    for (; leaf >= 0; leaf = forest_next_leaf(stage.forest, leaf)) {
        const int32_t *corner = &stage.shading->corners[3 * (int64_t)leaf];
        for (int k = 0; k < 3; k++) {
            right = right && corner[k] >= 0 && corner[k] <= next;
            next += corner[k] == next;
        }
    }
    tap_ok(right && next == stage.shading->vertex_count,
           "vertices are numbered as leaves meet them");
    dismantle(&stage);
}

/* --- bounds: no blend across them --- */

/* The jump in the middle of the diagonal when root 0 has B = 1 and root 1 has 0. */
static double jump_of(struct stage *stage)
{
    stage->forest->radiosity[0] = (struct rgb){{1.0, 1.0, 1.0}};
    stage->forest->radiosity[1] = (struct rgb){{0.0, 0.0, 0.0}};
    split_regularly(stage->forest, 2);
    shade(stage, false);
    return difference(value_at(stage, 0, point(0.5, 0, 0.5)),
                      value_at(stage, 1, point(0.5, 0.5, 0)));
}

static void check_jump(const char *name, struct scene *scene, double expected)
{
    struct stage stage = stage_of(scene);
    double jump = jump_of(&stage);
    tap_ok(fabs(jump - expected) < CONTINUOUS, "%s: a jump of %g", name, jump);
    dismantle(&stage);
}

/* A corner lifted by h folds the square by about atan(h sqrt 2). */
static void test_creases(void)
{
    check_jump("one plane, one material", folded_square(0.0), 0.0);
    check_jump("a fold of 2 degrees", folded_square(tan(0.0349) / sqrt(2.0)), 0.0);
    check_jump("a fold of 3 degrees", folded_square(tan(0.0524) / sqrt(2.0)), 1.0);
    check_jump("a fold of 45 degrees", folded_square(1.0 / sqrt(2.0)), 1.0);
}

static void test_materials_and_sides(void)
{
    struct scene *scene = folded_square(0.0);
    scene->material_of[1] = 1;
    check_jump("two materials", scene, 1.0);
    scene = folded_square(0.0);
    /* corners 0, 3, 2: root 1 faces away, and the edge is (w0, 0, w2) */
    scene->triangles[1] = reversed(scene->triangles[1]);
    struct stage stage = stage_of(scene);
    jump_of(&stage);
    struct vec3 middle = {0.5, 0.0, 0.5};
    tap_ok(fabs(difference(value_at(&stage, 0, middle), value_at(&stage, 1, middle)) -
                1.0) < 1e-15,
           "front beside back: a jump");
    dismantle(&stage);
}

/* --- curved surfaces --- */

static void test_curved_edges(void)
{
    check_jump("a fold of 45 degrees, normals agree", curved_square(UP, UP), 0.0);
    check_jump("normals agree within 2 degrees",
               curved_square(UP, point(tan(0.0349), 0.0, 1.0)), 0.0);
    check_jump("normals are 3 degrees apart at one end",
               curved_square(UP, point(tan(0.0524), 0.0, 1.0)), 1.0);
    check_jump("no normal at one end", curved_square(UP, point(0, 0, 0)), 1.0);
    check_jump("normals on the back agree like those on the front",
               curved_square(UP, point(0, 0, -1)), 0.0);
    struct scene *scene = curved_square(UP, UP);
    scene->material_of[1] = 1;
    check_jump("normals agree, materials do not", scene, 1.0);
}

/* Normals change nothing on a plane, to the bit. */
static void test_normals_on_a_plane(void)
{
    struct stage plain = square_stage(), with = square_stage();
    scene_add_normals(with.scene);
    for (int i = 0; i < 6; i++)
        with.scene->normals[i] = i == 4 ? point(0.6, 0, 0.8) : UP;
    struct random random = random_seed(5), again = random;
    split_randomly(plain.forest, &random, 0.5);
    split_randomly(with.forest, &again, 0.5);
    set_randomly(plain.forest, &random);
    set_randomly(with.forest, &again);
    shade(&plain, false);
    shade(&with, false);
    tap_ok(plain.forest->count > 20 && vertices_agree(plain.shading, with.shading),
           "normals on a plane change nothing");
    dismantle(&plain);
    dismantle(&with);
}

/* Twins: fronts blend with fronts (roots 0, 1), backs with backs (2, 3), no other. */
static void test_two_sided(void)
{
    struct scene *scene = folded_square(0.0);
    scene->two_sided = true;
    struct stage stage = stage_of(scene);
    for (int32_t root = 0; root < 4; root++)
        stage.forest->radiosity[root] = (struct rgb){{root, root / 2, root % 2}};
    split_regularly(stage.forest, 3);
    shade(&stage, false);
    struct rgb front = value_at(&stage, 0, point(0.5, 0, 0.5));
    struct rgb back = value_at(&stage, 2, point(0.5, 0.5, 0)); /* corners 0, 2, 1 */
    tap_ok(difference(front, (struct rgb){{0.5, 0.0, 0.5}}) < 1e-14 &&
               difference(back, (struct rgb){{2.5, 1.0, 0.5}}) < 1e-14,
           "two-sided: sides do not blend, neighbours do");
    dismantle(&stage);
}

/* --- covered leaves --- */

/* Heights above the floor, whose leaves have quarters of 0.25, with 0.19 from the middle
 * to a corner: of a box; of a shelf below which rays still get out; of plates in whose
 * gap there is light, and in which there is none. */
static const double ROOMY = 1.5, KNEE = 0.1, LOW = 0.02, NARROW = 0.01, TOUCHING = 1e-9;

/* A box without bottom; its top alone, whose back is below; that turned over. */
enum cover { BOX, SHELF, PLATE };

/* A floor of 8 x 8 with a cover on (2..4) x (2..6). */
static struct scene *floor_scene(enum cover cover, double height)
{
    struct soup soup = {0};
    struct vec3 base[4] = {{2, 2, 0}, {4, 2, 0}, {4, 6, 0}, {2, 6, 0}}, top[4];
    for (int i = 0; i < 4; i++) /* counter-clockwise seen from above */
        top[i] = point(base[i].x, base[i].y, height);
    add_face(&soup, point(0, 0, 0), point(8, 0, 0), point(8, 8, 0), point(0, 8, 0));
    if (cover == PLATE)
        add_face(&soup, top[3], top[2], top[1], top[0]);
    else
        add_face(&soup, top[0], top[1], top[2], top[3]);
    for (int i = 0; i < 4 && cover == BOX; i++)
        add_face(&soup, base[i], base[(i + 1) % 4], top[(i + 1) % 4], top[i]);
    return scene_of_soup(&soup);
}

static bool is_under(struct vec3 x)
{
    return x.x >= 2.0 && x.x <= 4.0 && x.y >= 2.0 && x.y <= 6.0;
}

/* Divides the floor along the box, makes the part under it 1/4 and all else 1, and
 * returns the smallest and the largest value of the floor's vertices off the box and on
 * its edge, and the largest one inside. */
static void shade_floor(struct stage *stage, double *low, double *high, double *inside)
{
    split_regularly(stage->forest, 4);
    for (int32_t p = 0; p < stage->forest->count; p++) {
        struct triangle t = forest_triangle(stage->forest, p);
        bool dark = is_under(scene_to_input(stage->scene, triangle_centroid(&t)));
        dark = dark && stage->forest->patches[p].id.root < 2;
        double value = dark ? 0.25 : 1.0;
        stage->forest->radiosity[p] = (struct rgb){{value, value, value}};
    }
    shade(stage, false);
    *low = *high = 1.0;
    *inside = 0.0;
    for (int i = 0; i <= 16; i++) {
        for (int j = 0; j <= 16;
             j++) { /* (0, 0), (8, 0), (8, 8): x = 8 (b + c), y = 8 c */
            double b = (i - j) / 16.0, c = j / 16.0;
            struct rgb value = i >= j ? value_at(stage, 0, point(1.0 - b - c, b, c))
                                      : value_at(stage, 1, point(1.0 - c, i / 16.0, -b));
            if (i > 4 && i < 8 && j > 4 && j < 12) {
                *inside = fmax(*inside, value.band[0]);
                continue;
            }
            *low = fmin(*low, value.band[0]);
            *high = fmax(*high, value.band[0]);
        }
    }
}

/* A covered leaf weighs 1e-12 of an open one; up to five lie around a vertex. Where the
 * floor counts as open the shadow blends into the light around it. */
static void test_covered(const char *name, enum cover cover, double height,
                         bool two_sided, double emission, bool covered)
{
    double low, high, inside;
    struct scene *scene = floor_scene(cover, height);
    scene->two_sided = two_sided;
    scene->materials[0] = material_grey(0.0, emission);
    struct stage stage = stage_of(scene);
    shade_floor(&stage, &low, &high, &inside);
    tap_ok(covered ? low > 1.0 - 1e-10 : low < 0.9, "%s (1 - %.1e)", name, 1.0 - low);
    if (covered && !two_sided)
        tap_ok(high <= 1.0 + 1e-15 && inside == 0.25, "and none of the light inside");
    dismantle(&stage);
}

/* Counts the quarters of a triangle of the floor whose middles are not under the box. */
static int open_quarters(const struct stage *stage, const struct triangle *t)
{
    int open = 0;
    for (int k = 0; k < 4; k++) {
        struct triangle child = triangle_child(t, k);
        open += !is_under(scene_to_input(stage->scene, triangle_centroid(&child)));
    }
    return open;
}

/* Share of a leaf of the floor that is not under the box, in sixteenths. */
static double open_share(const struct stage *stage, int32_t leaf)
{
    struct triangle t = forest_triangle(stage->forest, leaf);
    double share = 0.0;
    for (int k = 0; k < 4; k++) {
        struct triangle child = triangle_child(&t, k);
        share += open_quarters(stage, &child) / 16.0;
    }
    return open_quarters(stage, &t) == 4 ? 1.0 : share;
}

/* The floor has leaves that are open to 13/16 and 1, divided once 1/2, 3/4 and 1. With
 * the share s open and the emission E, the radiosity E + s (1 - E) must show as 1
 * everywhere. */
static void test_partly_covered(int levels, double smallest)
{
    static const double emission[BANDS] = {0.0, 0.5, 0.25};
    struct stage stage = stage_of(floor_scene(BOX, ROOMY));
    double least = 1.0, largest = 0.0;
    split_regularly(stage.forest, levels);
    for (int c = 0; c < BANDS; c++) {
        stage.scene->materials[0].emission.band[c] = emission[c];
        for (int32_t p = 0; p < stage.forest->count; p++)
            stage.forest->radiosity[p].band[c] =
                emission[c] + open_share(&stage, p) * (1.0 - emission[c]);
    }
    shade(&stage, false);
    for (int32_t p = 0; p < stage.forest->count; p++) {
        struct patch_id id = stage.forest->patches[p].id;
        struct triangle w = pathtracer_part(id);
        if (id.root >= 2 || !patch_is_leaf(&stage.forest->patches[p]))
            continue;
        least = fmin(least, open_share(&stage, p));
        for (int k = 0; k < 3; k++)
            largest =
                fmax(largest, difference(value_at(&stage, (int32_t)id.root, w.corner[k]),
                                         (struct rgb){{1.0, 1.0, 1.0}}));
    }
    tap_ok(least == smallest && largest < 1e-15,
           "the open part of a leaf is shown (within %.1e)", largest);
    dismantle(&stage);
}

/* Leaves that a thing covers in part know which points of them it covers. Below a plate
 * rays get out within `margin` of its rim, where points may be either. The leaves have
 * quarters of 2, so gaps below .15 are narrow. */
static void test_shut_points(enum cover cover, double height, double margin, bool covers,
                             const char *name)
{
    struct stage stage = stage_of(floor_scene(cover, height));
    int points = 0, wrong = 0, in_part = 0;
    split_regularly(stage.forest, 1);
    set_constant(stage.forest, 1.0);
    shade(&stage, false);
    for (int i = 0; i < 32; i++)
        for (int j = 0; j < 32; j++) {
            double b = (i - j) / 32.0, c = (j + 0.25) / 32.0;
            struct vec3 x = point(8.0 * (b + c), 8.0 * c, 0.0);
            int32_t leaf;
            double inside = fmin(fmin(x.x - 2.0, 4.0 - x.x), fmin(x.y - 2.0, 6.0 - x.y));
            if (b <= 0.0 || (is_under(x) && inside < margin))
                continue;
            shading_at(stage.shading, 0, (double[]){1.0 - b - c, b, c}, &leaf);
            in_part += stage.shading->shades[leaf] == SHADE_IN_PART;
            wrong += shading_is_shut(stage.shading, stage.octree, leaf,
                                     scene_from_input(stage.scene, x)) !=
                     (covers && is_under(x));
            points++;
        }
    tap_ok(wrong == 0 && points > 256 && in_part > (covers ? points / 8 : -1),
           "%s (%d of %d wrong)", name, wrong, points);
    dismantle(&stage);
}

/* A box stands between the four points that are examined, the middles of the quarters:
 * (2.7, 1.3), (6.7, 1.3), (6.7, 5.3) and (5.3, 2.7). Its leaf knows of it; the other has
 * none. */
static void test_between_points(void)
{
    struct soup soup = {0};
    add_face(&soup, point(0, 0, 0), point(8, 0, 0), point(8, 8, 0), point(0, 8, 0));
    soup_add_box(&soup, point(4.4, 0.5, 0), point(4.8, 4, 1.5), 1, false);
    struct stage stage = stage_of(scene_of_soup(&soup));
    set_constant(stage.forest, 1.0);
    shade(&stage, false);
    struct vec3 inside = scene_from_input(stage.scene, point(4.6, 2, 0));
    struct vec3 outside = scene_from_input(stage.scene, point(5, 2, 0));
    tap_ok(stage.shading->shades[0] == SHADE_IN_PART &&
               stage.shading->shades[1] == SHADE_SMOOTH,
           "a leaf knows of a box between the points that are examined");
    tap_ok(shading_is_shut(stage.shading, stage.octree, 0, inside) &&
               !shading_is_shut(stage.shading, stage.octree, 0, outside),
           "which covers the points below it alone");
    dismantle(&stage);
}

/* --- steep leaves --- */

/* Light rises over one leaf and its neighbours by more than the mean of all; elsewhere it
 * is even. */
static void test_steep(double bright, bool is_steep)
{
    struct stage stage = square_stage();
    int steep = 0;
    split_regularly(stage.forest, 4);
    set_constant(stage.forest, 1.0);
    int32_t first = forest_reach(stage.forest, (struct patch_id){0, 256});
    stage.forest->radiosity[first] = (struct rgb){{bright, 2.0 * bright, 0.0}};
    forest_average(stage.forest);
    shade(&stage, false);
    for (int32_t p = 0; p < stage.forest->count; p++)
        steep += stage.shading->shades[p] == SHADE_STEEP;
    bool own = stage.shading->shades[first] == SHADE_STEEP;
    tap_ok(own == is_steep && (is_steep ? steep <= 8 : steep == 0),
           "a leaf %g times as bright as all others: %d leaves are steep", bright, steep);
    dismantle(&stage);
}

/* A triangle without area keeps its number, has no vertices and no neighbours. */
static void test_dropped_triangle(void)
{
    struct soup soup = {0};
    struct vec3 a = {0, 0, 0}, b = {1, 0, 0}, c = {1, 1, 0}, d = {0, 1, 0};
    soup_add(&soup, (struct triangle){{a, b, c}});
    soup_add(&soup, (struct triangle){{a, c, c}});
    soup_add(&soup, (struct triangle){{a, c, d}});
    struct stage stage = stage_of(scene_of_soup(&soup));
    set_constant(stage.forest, 1.0);
    shade(&stage, false);
    tap_ok(stage.shading->vertex_count == 4 &&
               difference(value_at(&stage, 2, point(0.25, 0.25, 0.5)),
                          (struct rgb){{1.0, 2.0, 0.0}}) < 1e-15,
           "a dropped triangle has no vertices");
    dismantle(&stage);
}

int main(void)
{
    test_continuity("flat", square_stage);
    test_continuity("curved", curved_stage);
    test_large_beside_small();
    test_t_vertices();
    test_collapsed_leaves();
    test_jumps_are_seen();
    test_constant();
    test_linear();
    test_reflected();
    test_bright_edge();
    test_large_leaf_counts();
    test_flat();
    test_numbering();
    test_vertex_order();
    test_creases();
    test_materials_and_sides();
    test_curved_edges();
    test_normals_on_a_plane();
    test_two_sided();
    test_covered("under a box: no darkness outside", BOX, ROOMY, false, 0.0, true);
    test_covered("below a shelf the floor is open", SHELF, KNEE, false, 0.0, false);
    test_covered("under a lamp's front, too", PLATE, ROOMY, false, 0.0, false);
    test_covered("and under a plate that is hung low", PLATE, LOW, false, 0.0, false);
    test_covered("but not under one close to it", PLATE, NARROW, false, 0.0, true);
    test_covered("nor under one that touches it", PLATE, TOUCHING, false, 0.0, true);
    test_covered("two-sided, nothing is covered", BOX, ROOMY, true, 0.0, false);
    test_covered("but by a box of lamps, whose backs are black", BOX, ROOMY, true, 1.0,
                 true);
    test_partly_covered(0, 0.8125);
    test_partly_covered(1, 0.5);
    test_between_points();
    test_shut_points(BOX, ROOMY, 0.0, true, "a box covers points below it alone");
    test_shut_points(PLATE, KNEE, 0.4, true, "a plate in a narrow gap does, too");
    test_shut_points(PLATE, 2.0 * KNEE, 0.8, false, "one in a wider gap covers none");
    test_steep(8.0, true);
    test_steep(1.5, false);
    test_dropped_triangle();
    return tap_done();
}
