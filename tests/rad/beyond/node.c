/* Nodes as ends of links (rad/beyond/node.h, node_exchange.h, node_link.h): their proofs
 * drop nothing that exchanges light, their estimates have no bias, transfer is symmetric,
 * and the tree's light goes to that of all pairs. In a closed room with boxes in it. */
#include <math.h>
#include <string.h>

#include "geom/hash.h"
#include "rad/beyond/error_oracle.h"
#include "rad/beyond/node_exchange.h"
#include "rad/beyond/node_link.h"
#include "rad/beyond/patch_link.h"
#include "rad/beyond/sample.h"
#include "rad/beyond/sequence.h"
#include "tests/scenes.h"
#include "tests/solve.h"
#include "tests/tap.h"
#include "tests/trees.h"
#include "geom/contour.h"

static const struct comm *world_comm;

/* --- scenes --- */

enum { LAMP = 0 };

/* A room of 3 m by 2.5 m by 3 m with `boxes` boxes, each face of a room in cells^2 cells.
 * With a second room behind a wall of 1 cm, if `two`. */
static struct scene *room(int cells, int boxes, bool two)
{
    struct soup soup = {0};
    struct random random = random_seed(7);
    soup_add_quad(&soup, point(1.2, 2.4, 1.2), point(0.6, 0, 0), point(0, 0, 0.6), 1);
    paint(&soup, 0.0, 100.0);
    for (int i = 0; i < boxes; i++) {
        double x = 0.1 + 0.95 * (i % 3), z = 0.1 + 0.95 * (i / 3 % 3);
        struct vec3 at = {x, 0.02, z};
        struct vec3 size = {random_between(&random, 0.3, 0.8),
                            random_between(&random, 0.2, 1.8),
                            random_between(&random, 0.3, 0.8)};
        soup_add_box(&soup, at, vec3_add(at, size), 2, false);
    }
    soup_add_box(&soup, point(0, 0, 0), point(3, 2.5, 3), cells, true);
    if (two)
        soup_add_box(&soup, point(3.01, 0, 0), point(6, 2.5, 3), cells, true);
    paint(&soup, 0.5, 0.0);
    return scene_of_soup(&soup);
}

/* A scene with clusters above it. */
struct wood {
    struct world world;
    struct cluster_tree *tree;
};

static struct wood wood_make(struct scene *scene)
{
    struct wood wood = {.world = world_make(scene)};
    struct model *model = &wood.world.model;
    model->criterion = criterion_best(0.0, 0, 1e-3);
    model->link_threshold = 0.0;
    wood.tree = tree_create(scene, wood.world.octree);
    model->clusters = cluster_light_create(wood.tree);
    cluster_light_average(model->clusters, model->forest, model->forest->radiosity,
                          model->clusters->radiosity);
    return wood;
}

static void wood_free(struct wood *wood)
{
    cluster_light_destroy(wood->world.model.clusters);
    cluster_tree_destroy(wood->tree);
    world_free(&wood->world);
}

/* A cluster of no more than `most` roots, or, one time of four, a root. */
static int32_t random_node(const struct wood *wood, struct random *random, int32_t most)
{
    const struct cluster_tree *tree = wood->tree;
    if (random_below(random, 4) == 0)
        return tree->roots[random_below(random, tree->root_count)];
    for (;;) {
        int32_t i = random_below(random, tree->count);
        if (tree->clusters[i].end - tree->clusters[i].first <= most)
            return ~i;
    }
}

/* The roots of a node are roots[first] to before roots[end]. */
static void range_of(const struct cluster_tree *tree, int32_t node, int32_t *first,
                     int32_t *end)
{
    *first = node_is_cluster(node) ? tree->clusters[~node].first : tree->place[node];
    *end = node_is_cluster(node) ? tree->clusters[~node].end : *first + 1;
}

static bool overlap(const struct cluster_tree *tree, int32_t p, int32_t q)
{
    int32_t first_p, end_p, first_q, end_q;
    range_of(tree, p, &first_p, &end_p);
    range_of(tree, q, &first_q, &end_q);
    return first_p < end_q && first_q < end_p;
}

/* --- proofs --- */

/* Pairs of their roots that face each other, and those of these of which a look sees
 * something. */
struct pairs {
    int facing, seen;
};

static struct pairs count_pairs(struct wood *wood, int32_t p, int32_t q)
{
    struct model *model = &wood->world.model;
    struct pairs pairs = {0, 0};
    int32_t first_p, end_p, first_q, end_q;
    range_of(wood->tree, p, &first_p, &end_p);
    range_of(wood->tree, q, &first_q, &end_q);
    for (int32_t i = first_p; i < end_p; i++)
        for (int32_t j = first_q; j < end_q; j++) {
            int32_t a = wood->tree->roots[i], b = wood->tree->roots[j];
            struct facet facet_a = facet_make(model->forest, a);
            struct facet facet_b = facet_make(model->forest, b);
            struct link link;
            bool made = a != b &&
                        patch_link_make(model, a, &facet_a, b, &facet_b, NULL, &link);
            pairs.facing += made;
            pairs.seen += made && link.seen > 0;
        }
    return pairs;
}

static void test_proofs(struct scene *scene, const char *name, int walls)
{
    struct wood wood = wood_make(scene);
    struct random random = random_seed(8);
    struct octree_counts counts = {0};
    int away = 0, hidden = 0, wrong = 0, seen = 0;
    for (int i = 0; i < 4000; i++) {
        int32_t p = random_node(&wood, &random, 40), q = random_node(&wood, &random, 40);
        struct end a = end_of(&wood.world.model, p), b = end_of(&wood.world.model, q);
        struct pairs pairs = count_pairs(&wood, p, q);
        bool faces = ends_may_face(&a, &b);
        bool apart = p != q && ends_are_walled_off(&a, &b, wood.world.octree, &counts);
        wrong += (!faces && pairs.facing > 0) || (apart && pairs.seen > 0);
        away += !faces;
        hidden += apart && pairs.facing > 0;
        seen += pairs.seen > 0;
    }
    tap_ok(wrong == 0 && away > 100 && hidden >= walls && seen > 400,
           "%s: of 4000 pairs %d do not face, %d are walled off (at least %d), %d see "
           "each other; no proof is wrong", name, away, hidden, walls, seen);
    wood_free(&wood);
}

static struct scene *triangles_at_random(void)
{
    struct soup soup = {0};
    struct random random = random_seed(9);
    for (int i = 0; i < 300; i++)
        soup_add(&soup, random_triangle(&random, 1.0, i % 4 == 0 ? 0.5 : 0.1));
    paint(&soup, 0.5, 1.0);
    return scene_of_soup(&soup);
}

/* --- estimates --- */

/* Mean of samples, and the standard error of it. */
struct mean {
    double sum, square;
    int count;
};

static void mean_add(struct mean *mean, double value)
{
    mean->sum += value;
    mean->square += value * value;
    mean->count++;
}

static double mean_of(const struct mean *mean)
{
    return mean->sum / mean->count;
}

static double variance_of(const struct mean *mean)
{
    double square = mean->square / mean->count - mean_of(mean) * mean_of(mean);
    return fmax(0.0, square) / (mean->count - 1);
}

/* The part of a root's light that arrives at roots of q, G. Where few rays do, their
 * number scatters by one at least. */
static void look_around(const struct wood *wood, int32_t root, int32_t first, int32_t end,
                        double *area, double *variance)
{
    enum { RAYS = 4000 };
    const struct scene *scene = wood->world.scene;
    struct triangle t = scene_root_triangle(scene, root);
    struct octree_counts counts = {0};
    struct mean hits = {0};
    struct random random = random_seed((uint64_t)root);
    struct vec3 normal = scene_root_plane(scene, root).normal;
    struct vec3 along = direction_along(normal);
    for (int i = 0; i < RAYS; i++) {
        double u[4];
        for (int d = 0; d < 4; d++)
            u[d] = random_between(&random, 0.0, 1.0);
        struct half_line ray = {
            point_above(triangle_of_square(&t, u[0], u[1]), normal),
            cosine_direction(normal, along, u[2], u[3])};
        int32_t met = root_met(scene, wood->world.octree, &ray, -1, &counts);
        int32_t place = met < 0 ? -1 : wood->tree->place[met];
        mean_add(&hits, place >= first && place < end);
    }
    double own = scene_root_area(scene, root);
    *area += own * mean_of(&hits);
    *variance += own * own * fmax(variance_of(&hits), 1.0 / ((double)RAYS * RAYS));
}

/* True if the mean is within 4 standard errors of the truth, which has a variance, too.
 * (1e-9: rounding.) */
static bool is_unbiased(const struct mean *found, double truth, double variance)
{
    double error = 4.0 * sqrt(variance_of(found) + variance) + 1e-9 * truth;
    return fabs(mean_of(found) - truth) <= error;
}

enum kind { AFAR, NEARBY, ITSELF, KINDS };

/* G of all pairs of roots, or an estimate of it and its variance. */
static double truth_of(const struct wood *wood, int32_t p, int32_t q, enum kind kind,
                       double *variance)
{
    const struct scene *scene = wood->world.scene;
    int32_t first_p, end_p, first_q, end_q;
    double area = 0.0;
    *variance = 0.0;
    range_of(wood->tree, p, &first_p, &end_p);
    range_of(wood->tree, q, &first_q, &end_q);
    for (int32_t i = first_p; i < end_p; i++) {
        int32_t root = wood->tree->roots[i];
        struct triangle t = scene_root_triangle(scene, root);
        if (kind != AFAR)
            look_around(wood, root, first_q, end_q, &area, variance);
        for (int32_t j = first_q; j < end_q && kind == AFAR; j++) {
            struct triangle other = scene_root_triangle(scene, wood->tree->roots[j]);
            area += triangle_exchange(&t, &other);
        }
    }
    return area;
}

/* The kind of a pair, or KINDS if it is not to be tested. */
static enum kind kind_of(const struct wood *wood, const struct meeting *m)
{
    if (m->p->node == m->q->node)
        return node_is_cluster(m->p->node) ? ITSELF : KINDS;
    if (overlap(wood->tree, m->p->node, m->q->node) || !ends_may_face(m->p, m->q) ||
        (!m->p->cluster && !m->q->cluster))
        return KINDS;
    return is_by_rays(m) ? NEARBY : AFAR;
}

enum { SALTS = 400, EACH = 25 };

/* Held against the truth: G without blockers where points give it, else G. */
static void test_estimates(void)
{
    struct wood wood = wood_make(room(3, 4, false));
    struct model *model = &wood.world.model;
    struct random random = random_seed(10);
    int tested[KINDS] = {0}, biased = 0;
    for (int i = 0; i < 20000; i++) {
        int32_t p = random_node(&wood, &random, 60);
        int32_t q = i % 20 == 0 ? p : random_node(&wood, &random, 60);
        struct end a = end_of(model, p), b = end_of(model, q);
        struct meeting m = ends_meet(&a, &b);
        enum kind kind = kind_of(&wood, &m);
        if (kind == KINDS || tested[kind] >= EACH)
            continue;
        double variance, truth = truth_of(&wood, p, q, kind, &variance);
        if (truth > 0.4 * fmin(a.area, b.area) || truth == 0.0)
            continue; /* estimates are cut off at the smaller area: that bias is meant */
        struct mean found = {0};
        for (int salt = 1; salt <= SALTS; salt++) {
            struct node_exchange estimate = node_exchange_estimate(model, &m, salt);
            mean_add(&found, kind == AFAR ? estimate.unoccluded : estimate.area);
        }
        tested[kind]++;
        biased += !is_unbiased(&found, truth, variance);
        if (!is_unbiased(&found, truth, variance))
            printf("# kind %d, %d and %d: %g, not %g, standard error %g\n", (int)kind,
                   (int)p, (int)q, mean_of(&found), truth,
                   sqrt(variance_of(&found) + variance));
    }
    bool enough = tested[AFAR] == EACH && tested[NEARBY] == EACH && tested[ITSELF] >= 5;
    tap_ok(enough && biased == 0,
           "estimates of %d links afar, %d nearby, %d of a cluster with itself: %d are "
           "biased", tested[AFAR], tested[NEARBY], tested[ITSELF], biased);
    wood_free(&wood);
}

/* --- links --- */

/* Links of all kinds: those of four levels below the top. */
static struct link_list links_below_top(struct wood *wood)
{
    struct link_list all = {0}, level = {0};
    link_list_append(&level, node_link_top());
    for (int depth = 0; depth < 4; depth++) {
        struct link_list next = {0};
        for (int64_t i = 0; i < level.count; i++) {
            const struct link *link = &level.items[i];
            struct link children[METHOD_CHILDREN_MAX];
            int32_t node = node_is_cluster(link->p) ? link->p : link->q;
            if (!node_is_cluster(node))
                continue;
            int count = node_link_split(&wood->world.model, link, node, children);
            for (int k = 0; k < count; k++) {
                link_list_append(&next, children[k]);
                link_list_append(&all, children[k]);
            }
        }
        link_list_free(&level);
        level = next;
    }
    link_list_free(&level);
    return all;
}

/* The field `blocker` of a link of far clusters has the G of its first look, and keeps it
 * when the link settles; that of near ones has nothing. */
static bool has_judgement(struct model *model, struct link *link)
{
    struct end p = end_of(model, link->p), q = end_of(model, link->q);
    struct meeting m = ends_meet(&p, &q);
    float area = 0.0f;
    if (!m.near)
        area = (float)node_exchange_estimate(model, &m, 0).unoccluded;
    node_link_keep(model, link);
    return memcmp(&area, &link->blocker, sizeof area) == 0;
}

/* Of which later looks see nothing, a far link is split by the G of its first look, if
 * that is more than looks may miss. */
static bool heeds_judgement(struct model *model, struct link link, int *heard)
{
    struct end p = end_of(model, link.p), q = end_of(model, link.q);
    struct meeting m = ends_meet(&p, &q);
    float judged;
    memcpy(&judged, &link.blocker, sizeof judged);
    double doubt = (double)judged * m.light, threshold = model->link_threshold;
    if (!(doubt > 0.125 * m.most * m.light))
        return true;
    link.seen = 0;
    model->link_threshold = 0.9 * doubt;
    bool splits = error_oracle_side_to_split(model, &link) != NODE_NONE;
    model->link_threshold = 1.1 * doubt;
    bool stays = error_oracle_side_to_split(model, &link) == NODE_NONE;
    model->link_threshold = threshold;
    ++*heard;
    return splits && stays;
}

/* If a far patch is dark and its parts are even, all error of a link to a bright cluster
 * is in doubt. True of other links. */
static bool heeds_even_parts(struct model *model, struct link link, int *heard)
{
    bool of_p = !node_is_cluster(link.p);
    int32_t patch = of_p ? link.p : link.q, cluster = of_p ? link.q : link.p;
    if (node_is_cluster(patch) || link.seen == 0)
        return true;
    struct rgb *dark = &model->forest->radiosity[patch], kept = *dark;
    struct rgb *bright = &model->clusters->radiosity[~cluster], before = *bright;
    *dark = (struct rgb){{0.0, 0.0, 0.0}};
    *bright = (struct rgb){{1.0, 1.0, 1.0}};
    struct end p = end_of(model, link.p), q = end_of(model, link.q);
    struct meeting m = ends_meet(&p, &q);
    float judged;
    memcpy(&judged, &link.blocker, sizeof judged);
    memset(of_p ? link.parts_p : link.parts_q, 64, sizeof link.parts_p);
    double threshold = model->link_threshold;
    model->link_threshold = 1.1 * fmax((double)judged, m.most / 8.0) * m.light;
    bool stays = error_oracle_side_to_split(model, &link) == NODE_NONE;
    model->link_threshold = threshold;
    *dark = kept;
    *bright = before;
    *heard += !m.near && m.light > 0.0;
    return stays || m.near;
}

static void test_judgement(void)
{
    struct wood wood = wood_make(room(3, 4, false));
    wood.world.model.link_threshold = HUGE_VAL;
    struct link_list links = links_below_top(&wood);
    int count = 0, right = 0, heeded = 0, heard = 0, even = 0, patches = 0;
    for (int64_t i = 0; i < links.count; i++) {
        struct link *link = &links.items[i];
        if (!link_has_cluster(link))
            continue;
        count++;
        right += has_judgement(&wood.world.model, link);
        heeded += heeds_judgement(&wood.world.model, *link, &heard);
        even += heeds_even_parts(&wood.world.model, *link, &patches);
    }
    tap_ok(count > 100 && right == count,
           "%d of %d links keep the G of their first look", right, count);
    tap_ok(heard > 20 && heeded == count, "and %d far ones are split by it", heard);
    tap_ok(patches > 10 && even == count, "%d of patches are not split for even parts",
           patches);
    link_list_free(&links);
    wood_free(&wood);
}

/* Radiosities at random; those of clusters are means. */
static void set_light(struct model *model, uint64_t seed)
{
    struct forest *forest = model->forest;
    for (int64_t p = 0; p < forest->count; p++)
        for (int c = 0; c < BANDS; c++)
            forest->radiosity[p].band[c] =
                hash_unit(hash_mix(seed) + BANDS * (uint64_t)p + (uint64_t)c);
    cluster_light_average(model->clusters, forest, forest->radiosity,
                          model->clusters->radiosity);
}

/* Sum over all nodes of their radiosity times their flux, W^2/m^2 in flux units. */
static double product(const struct model *model)
{
    const struct cluster_light *clusters = model->clusters;
    const struct forest *forest = model->forest;
    double sum = 0.0;
    for (int64_t p = 0; p < forest->count; p++)
        for (int c = 0; c < BANDS; c++)
            sum += forest->radiosity[p].band[c] *
                   (double)forest->patches[p].flux[c];
    for (int64_t i = 0; i < clusters->tree->count; i++)
        for (int c = 0; c < BANDS; c++)
            sum += clusters->radiosity[i].band[c] * (double)clusters->flux[BANDS * i + c];
    return sum;
}

/* x F y: light of `from` over the links, times that of `to`. */
static double product_over(struct model *model, const struct link_list *links,
                           uint64_t from, uint64_t to)
{
    struct cluster_light *clusters = model->clusters;
    clear_flux(model->forest);
    memset(clusters->flux, 0,
           BANDS * (size_t)clusters->tree->count * sizeof *clusters->flux);
    set_light(model, from);
    node_links_transfer(links, model, model->forest->radiosity,
                        flux_unit_for(model->area));
    set_light(model, to);
    return product(model);
}

/* One by one. The whole scene's flux is 2^62 units, so rounding is far below 1e-9, which
 * is far below the 1/256 of a part that goes astray. */
static void test_symmetry(void)
{
    struct wood wood = wood_make(room(3, 4, false));
    struct model *model = &wood.world.model;
    model->link_threshold = HUGE_VAL;
    struct link_list links = links_below_top(&wood);
    int own = 0, even = 0, carrying = 0;
    for (int64_t i = 0; i < links.count; i++) {
        struct link_list one = {&links.items[i], 1, 1, 1};
        node_link_keep(model, &links.items[i]);
        if (links.items[i].seen == 0)
            continue;
        double there = product_over(model, &one, 1, 2);
        double back = product_over(model, &one, 2, 1);
        carrying++;
        own += links.items[i].p == links.items[i].q;
        even += there > 0.0 && fabs(there / back - 1.0) < 1e-9;
    }
    tap_ok(own >= 4 && carrying > 100 && even == carrying,
           "x F y = y F x on %d of %d links, %d of a cluster with itself", even, carrying,
           own);
    link_list_free(&links);
    wood_free(&wood);
}

/* --- whole solutions --- */

static struct solution solve_room(double epsilon, int max_level,
                                  enum linking_kind linking)
{
    struct scene *scene = prepared(room(4, 4, false));
    struct criterion criterion = criterion_best(epsilon, max_level, 1e-7);
    criterion.linking = linking;
    criterion.balance = BALANCE_DEFAULT;
    return solve(world_comm, scene, criterion);
}

/* Relative RMS over the area of all that reflects. */
static double difference(const struct solution *a, const struct solution *b)
{
    double square = 0.0, light = 0.0;
    for (int32_t root = 0; root < a->scene->input_count; root++) {
        if (a->scene->material_of[root] == LAMP)
            continue;
        double area = scene_root_area(a->scene, root);
        double x = a->solver->model.forest->radiosity[root].band[0];
        double y = b->solver->model.forest->radiosity[root].band[0];
        square += area * (x - y) * (x - y);
        light += area * y * y;
    }
    return sqrt(square / light);
}

/* Without subdivision, against all pairs looked at as closely as can be. At the last step
 * hardly a cluster is left: 0.005 %, measured. */
static void test_convergence(void)
{
    enum { STEPS = 7 };
    const double last = 2e-4;
    struct solution all = solve_room(0.0, 0, LINKING_PAIRS);
    double before = HUGE_VAL, epsilon = 4e-3;
    for (int step = 0; step < STEPS; step++, epsilon /= 4.0) {
        struct solution tree = solve_room(epsilon, 0, LINKING_TREE);
        double off = difference(&tree, &all);
        tap_ok(off < before, "epsilon %.1e: %lld links, %.3f %% from all pairs (%lld)",
               epsilon, (long long)tree.stats.links, 100.0 * off,
               (long long)all.stats.links);
        before = off;
        solution_free(&tree);
    }
    tap_ok(before < last, "which ends below %g %%", 100.0 * last);
    struct solution exact = solve_room(0.0, 0, LINKING_TREE);
    tap_ok(difference(&exact, &all) <= 2e-7, "and at 0 is within the tolerance of %.1e",
           difference(&exact, &all));
    solution_free(&exact);
    solution_free(&all);
}

/* In a closed room all that leaves arrives: more or less is the bias of the links. */
static void test_total(void)
{
    struct solution s = solve_room(1e-5, 10, LINKING_TREE);
    double leaving = 0.0, unit = scene_area_unit(s.scene);
    for (int32_t root = 0; root < s.scene->input_count; root++)
        leaving += unit * scene_root_area(s.scene, root) *
                   rgb_sum(s.solver->model.forest->radiosity[root]);
    double bias = -s.stats.escaped_power / leaving;
    tap_ok(fabs(bias) <= 0.01, "of all light %+.2f %% too much arrives (%lld links)",
           100.0 * bias, (long long)s.stats.links);
    solution_free(&s);
}

int main(int argc, char **argv)
{
    struct comm comm;
    comm_start(&comm, &argc, &argv);
    world_comm = &comm;
    test_proofs(triangles_at_random(), "triangles at random", 0);
    test_proofs(room(3, 6, true), "two rooms", 500);
    test_estimates();
    test_judgement();
    test_symmetry();
    test_convergence();
    test_total();
    comm_stop(&comm);
    return tap_done();
}
