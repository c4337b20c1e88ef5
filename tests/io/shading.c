/* Tests of io/picture/shading.h. Proved are: the interpolation is continuous over every
 * smooth surface, also where large leaves meet small ones and where roots meet; it keeps
 * constants and, on a regular subdivision, linear functions; it neither depends on the
 * order in which patches were made nor blends across bounds (materials, creases, sides);
 * facets whose normals agree show one curved surface.
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
#include "tests/shaded.h"
#include "tests/tap.h"

static const double CONTINUOUS = 1e-12;
enum { DEEPEST = 6 };

/* --- scenes --- */

/* The square with its corner 3 lifted by `lift`; a second material is there. */
static struct scene *folded_square(double lift)
{
    struct soup soup = {0};
    struct vec3 a = {0, 0, 0}, b = {1, 0, 0}, c = {1, 1, 0}, d = {0, 1, lift};
    soup_add(&soup, (struct triangle){{a, b, c}});
    soup_add(&soup, (struct triangle){{a, c, d}});
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

/* --- subdivisions and fields --- */

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
    int32_t p = forest_next_leaf(stage->forest, -1);
    for (; p >= 0; p = forest_next_leaf(stage->forest, p))
        for (int k = 0; k < 3; k++) {
            visit_edge(stage, p, k, 0.5, seen);
            visit_edge(stage, p, k, 0.25, seen);
            for (int i = 0; i < 3; i++)
                visit_edge(stage, p, k, (double)(1 + random_bits(random) % 1023) / 1024.0,
                           seen);
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
        shade_stage(&stage, false);
        visit_edges(&stage, &random, &seen);
        dismantle(&stage);
    }
    tap_ok(seen.crossings > 20000 && seen.over_diagonal > 1000 &&
               seen.largest < CONTINUOUS,
           "%s: continuous at %d points, %d of them between roots (largest jump %.1e)",
           name, seen.crossings, seen.over_diagonal, seen.largest);
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
    shade_stage(&stage, false);
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
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 1);
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
    shade_stage(&stage, false);
    double b = value_at(&stage, 2, point(0.2, 0.3, 0.5)).band[0];
    tap_ok(fabs(b - 1.0) < 1e-12, "leaves of a sliver, collapsed: B = %g", b);
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
    shade_stage(&stage, false);
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
    shade_stage(&stage, false);
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
        error[p] = (float)(2.5 * deviation); /* as rad/beyond/gather/claim.c tells */
    shading_destroy(stage->shading);
    stage->shading =
        shading_create(stage->forest, stage->octree, reflected ? lamps : NULL, error,
                       NULL);
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
    shade_stage(stage, flat);
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
    shade_stage(&stage, false);
    double shown = shading_at(stage.shading, stage.shading->values, 0, corner).band[0];
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
    int32_t p = forest_next_leaf(forest, -1);
    for (; p >= 0; p = forest_next_leaf(forest, p)) {
        const struct patch *patch = &forest->patches[p];
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
    shade_stage(&stage, true);
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
        struct random random = random_seed(id_number(id));
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
    int32_t p = forest_next_leaf(a->forest, -1);
    for (; agree && p >= 0; p = forest_next_leaf(a->forest, p)) {
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
        shade_stage(&one, flat);
        shade_stage(&other, flat);
        tap_ok(corners_agree(&one, &other) && vertices_agree(one.shading, other.shading),
               "%s: patches made in another order, the same vertices to the bit",
               flat ? "flat" : "smooth");
        dismantle(&one);
        dismantle(&other);
    }
}

/* --- bounds: no blend across them --- */

/* The jump in the middle of the diagonal when root 0 has B = 1 and root 1 has 0. */
static double jump_of(struct stage *stage)
{
    stage->forest->radiosity[0] = (struct rgb){{1.0, 1.0, 1.0}};
    stage->forest->radiosity[1] = (struct rgb){{0.0, 0.0, 0.0}};
    split_regularly(stage->forest, 2);
    shade_stage(stage, false);
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
    scene = folded_square(0.0);
    scene_add_normals(scene);
    for (int i = 0; i < 6; i++)
        scene->normals[i] = i == 4 ? point(0.6, 0, 0.8) : UP;
    check_jump("normals differ on a plane", scene, 0.0);
}

/* The square, its corner 3 lifted, shown as smooth by normals, and a wall that stands on
 * so much of the diagonal, from corner 0 on; or on none. */
static struct scene *walled_square(double lift, double share)
{
    struct soup soup = {0};
    struct vec3 a = {0, 0, 0}, b = {1, 0, 0}, c = {1, 1, 0}, d = {0, 1, lift};
    soup_add(&soup, (struct triangle){{a, b, c}});
    soup_add(&soup, (struct triangle){{a, c, d}});
    if (share > 0.0)
        soup_add_quad(&soup, a, point(share, share, 0), point(0, 0, 0.3), 1);
    paint(&soup, 0.0, 0.0);
    struct scene *scene = scene_of_soup(&soup);
    scene_add_normals(scene);
    for (int i = 0; i < 6; i++)
        scene->normals[i] = UP;
    return scene;
}

/* A wall parts what it stands between, on flat, hollow and bulging surfaces; beyond its
 * end, in the middle of an edge, the sides blend. */
static void test_walls(void)
{
    static const double lifts[] = {0.0, 0.4, -0.4};
    for (int k = 0; k < 3; k++) {
        char name[80];
        snprintf(name, sizeof name, "a corner lifted by %g, no wall", lifts[k]);
        check_jump(name, walled_square(lifts[k], 0.0), 0.0);
        snprintf(name, sizeof name, "a corner lifted by %g, a wall", lifts[k]);
        check_jump(name, walled_square(lifts[k], 1.0), 1.0);
        snprintf(name, sizeof name, "a corner lifted by %g, a wall of .3", lifts[k]);
        check_jump(name, walled_square(lifts[k], 0.3), 0.0);
    }
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
    shade_stage(&stage, false);
    struct rgb front = value_at(&stage, 0, point(0.5, 0, 0.5));
    struct rgb back = value_at(&stage, 2, point(0.5, 0.5, 0)); /* corners 0, 2, 1 */
    tap_ok(difference(front, (struct rgb){{0.5, 0.0, 0.5}}) < 1e-14 &&
               difference(back, (struct rgb){{2.5, 1.0, 0.5}}) < 1e-14,
           "two-sided: sides do not blend, neighbours do");
    dismantle(&stage);
}

/* --- covered leaves --- */

static void shade_outside(struct stage *stage, const float *outside)
{
    shading_destroy(stage->shading);
    stage->shading = shading_create(stage->forest, stage->octree, NULL, NULL, outside);
}

/* A box stands on the square, whose leaves end at its feet; it is dark inside. Returns
 * the smallest and the largest value that is shown outside and at the feet; `inside`: the
 * largest in the box. `outside`: [patches] or NULL. */
static void shade_feet(struct stage *stage, const float *outside, double *low,
                       double *high, double *inside)
{
    shade_outside(stage, outside);
    *low = HUGE_VAL;
    *high = *inside = 0.0;
    for (int64_t v = 0; v < stage->shading->vertex_count; v++) {
        struct vec3 x = scene_to_input(stage->scene, stage->shading->positions[v]);
        double value = stage->shading->values[v].band[0];
        if (x.x > 0.25 && x.x < 0.5 && x.y > 0.25 && x.y < 0.75) {
            *inside = fmax(*inside, value);
            continue;
        }
        *low = fmin(*low, value);
        *high = fmax(*high, value);
    }
}

/* A covered leaf weighs 1e-12 of an open one; up to five lie around a vertex. Where all
 * leaves count as open the dark blends into the light around it. */
static void test_covered(void)
{
    struct stage stage = square_stage();
    double low, high, inside;
    split_regularly(stage.forest, 4);
    float *outside = alloc_array((size_t)stage.forest->count, sizeof *outside);
    for (int32_t p = 0; p < stage.forest->count; p++) {
        struct triangle t = forest_triangle(stage.forest, p);
        struct vec3 x = scene_to_input(stage.scene, triangle_centroid(&t));
        bool under = x.x > 0.25 && x.x < 0.5 && x.y > 0.25 && x.y < 0.75;
        double b = under ? 0.25 : 1.0;
        outside[p] = under ? 0.0f : 1.0f;
        stage.forest->radiosity[p] = (struct rgb){{b, b, b}};
    }
    shade_feet(&stage, outside, &low, &high, &inside);
    tap_ok(low > 1.0 - 1e-10 && high <= 1.0 + 1e-15,
           "under a box: no darkness at its feet (1 - %.1e)", 1.0 - low);
    tap_ok(inside == 0.25, "and none of the light inside");
    shade_feet(&stage, NULL, &low, &high, &inside);
    tap_ok(low < 0.9, "taken for open it darkens the rest (%.2f)", low);
    alloc_free(outside);
    dismantle(&stage);
}

/* Things stand on parts of leaves, of which a quarter is open at least. With the share s
 * open and the emission E, the radiosity E + s (1 - E) is shown as 1 everywhere. */
static void test_partly_covered(void)
{
    static const double emission[BANDS] = {0.0, 0.5, 0.25};
    struct random random = random_seed(19);
    struct stage stage = square_stage();
    double largest = 0.0;
    split_randomly(stage.forest, &random, 0.4);
    float *outside = alloc_array((size_t)stage.forest->count, sizeof *outside);
    for (int32_t p = 0; p < stage.forest->count; p++) {
        outside[p] = (float)(1.0 - 0.75 * random_unit(&random));
        for (int c = 0; c < BANDS; c++) {
            stage.scene->materials[0].emission.band[c] = emission[c];
            stage.forest->radiosity[p].band[c] =
                emission[c] + (double)outside[p] * (1.0 - emission[c]);
        }
    }
    shade_outside(&stage, outside);
    for (int64_t v = 0; v < stage.shading->vertex_count; v++)
        largest = fmax(largest, difference(stage.shading->values[v],
                                           (struct rgb){{1.0, 1.0, 1.0}}));
    tap_ok(stage.shading->vertex_count > 50 && largest < 1e-15,
           "the open part of a leaf is shown (within %.1e)", largest);
    alloc_free(outside);
    dismantle(&stage);
}

/* A leaf counts as covered if less than a quarter of it is open. */
static void test_least_open(void)
{
    const float outside[2] = {0.25f, 0.2499f};
    struct stage stage = square_stage();
    shade_outside(&stage, outside);
    tap_ok(stage.shading->shades[0] == SHADE_SMOOTH &&
               stage.shading->shades[1] == SHADE_COVERED,
           "a leaf that is open to less than a quarter is covered");
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
    shade_stage(&stage, false);
    for (int32_t p = 0; p < stage.forest->count; p++)
        steep += stage.shading->shades[p] == SHADE_STEEP;
    bool own = stage.shading->shades[first] == SHADE_STEEP;
    tap_ok(own == is_steep && (is_steep ? steep <= 8 : steep == 0),
           "a leaf %g times as bright as all others: %d leaves are steep", bright, steep);
    dismantle(&stage);
}

/* Reflected light is a hundred times as bright on one side of a jump, as in a shade on a
 * wall. Leaves next to it are steep, and others on the dark side show their light: if
 * steep leaves were corrected, the next ones would be steep, too, and the rest dark. */
static void test_beside_jump(void)
{
    struct stage stage = square_stage();
    const struct forest *forest = stage.forest;
    double least = HUGE_VAL, jump = 0.75 * stage.scene->high.x;
    int steep = 0;
    split_regularly(stage.forest, 4);
    for (int32_t p = 0; p < forest->count; p++) {
        struct triangle t = forest_triangle(forest, p);
        double b = triangle_centroid(&t).x > jump ? 100.0 : 1.0;
        forest->radiosity[p] = (struct rgb){{b, b, b}};
    }
    reflected_error(&stage, 0.0, true);
    const int32_t *corners = stage.shading->corners;
    for (int32_t p = 0; p < forest->count; p++) {
        bool is_steep = stage.shading->shades[p] == SHADE_STEEP;
        steep += is_steep;
        for (int k = 0; k < 3 && patch_is_leaf(&forest->patches[p]) && !is_steep; k++)
            least = fmin(least, stage.shading->values[corners[3 * p + k]].band[0]);
    }
    tap_ok(least >= 0.95 && steep > 0 && steep < 128,
           "beside a jump: %d leaves are steep, others show %.2f of their light", steep,
           least);
    dismantle(&stage);
}

/* Reflected light is three times as bright on one side of a jump that runs across few
 * leaves: corrections would make the far corners nearly black. They are two thirds as
 * bright as the darkest leaf at least. */
static void test_across_jump(void)
{
    struct stage stage = square_stage();
    double least = HUGE_VAL;
    split_regularly(stage.forest, 1);
    for (int32_t p = 0; p < stage.forest->count; p++) {
        struct triangle t = forest_triangle(stage.forest, p);
        double b = triangle_centroid(&t).x > 0.0 ? 3.0 : 1.0;
        stage.forest->radiosity[p] = (struct rgb){{b, b, b}};
    }
    reflected_error(&stage, 0.0, true);
    for (int64_t v = 0; v < stage.shading->vertex_count; v++)
        least = fmin(least, stage.shading->values[v].band[0]);
    tap_ok(least >= 0.66, "beside a jump across eight leaves the least light is %.2f",
           least);
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
    shade_stage(&stage, false);
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
    test_t_vertices();
    test_collapsed_leaves();
    test_constant();
    test_linear();
    test_reflected();
    test_bright_edge();
    test_large_leaf_counts();
    test_flat();
    test_numbering();
    test_creases();
    test_materials_and_sides();
    test_curved_edges();
    test_walls();
    test_two_sided();
    test_covered();
    test_partly_covered();
    test_least_open();
    test_steep(8.0, true);
    test_steep(1.5, false);
    test_beside_jump();
    test_across_jump();
    test_dropped_triangle();
    return tap_done();
}
