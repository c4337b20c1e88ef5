/* Links with a cluster in them.
 *
 * G of two patches comes from exact factors between points and polygons; a cluster is no polygon.
 * What it exchanges is sampled at points on its roots, one in each child, chosen by area:
 *
 *  - of a patch and a cluster, the exact factor from each point to each quarter of the patch, and a
 *    segment to the middle of that quarter: points on the patch would miss what stands on it;
 *
 *  - of two clusters far apart, A_a A_b cos cos / (pi r^2) for each pair of points, and a segment;
 *
 *  - of two clusters that are near, or of one with itself, 16 cosine-distributed rays from the
 *    smaller one. A ray that ends on a root of the other, which its place in the tree's order tells,
 *    counts A / 16: no 1 / r^2, no clamp, and visibility is in it. (By pairs of points, books
 *    in a shelf lose a quarter of their light: they miss the pairs that matter.)
 *
 * The points are chosen by a hash of both IDs, so that the errors of different links are not alike
 * and a link means the same on any rank.
 *
 * Stopping bias (Kirk and Arvo 1991): a link whose few samples happen to miss its light looks good,
 * is accepted, and stays too dark: 2.4 % of all light in a room of 18,000 triangles. So an accepted link is
 * estimated afresh, from points that had no say in that.
 *
 * A part of what a child of a cluster has got is its area's, as if four rays more had told so:
 * one ray into a tiny child would make it far too bright. */
#include "rad/beyond/node_link.h"

#include <math.h>
#include <string.h>

#include "geom/hash.h"
#include "geom/lambert.h"
#include "rad/oracle.h"

enum { SAMPLES = 4, RINGS = 4 };

static const double PI = 3.14159265358979323846;

/* --- one end of a link --- */

struct end {
    int32_t node;
    const struct cluster *cluster; /* NULL: a patch */
    struct facet facet;            /* of a patch */
    struct patch_id id;
    struct vec3 low, high;         /* box */
    double area, radius;
    struct rgb reflectance, radiosity;
    bool is_dark;
};

static struct vec3 least(struct vec3 a, struct vec3 b)
{
    return (struct vec3){real_min(a.x, b.x), real_min(a.y, b.y), real_min(a.z, b.z)};
}

static struct vec3 most(struct vec3 a, struct vec3 b)
{
    return (struct vec3){real_max(a.x, b.x), real_max(a.y, b.y), real_max(a.z, b.z)};
}

static struct end end_of_cluster(const struct method *method, int32_t node)
{
    const struct cluster_light *light = method->clusters;
    const struct cluster *cluster = &light->tree->clusters[~node];
    return (struct end){
        .node = node,
        .cluster = cluster,
        .id = {CLUSTER_ROOT, cluster->hierarchy},
        .low = cluster->low,
        .high = cluster->high,
        .area = cluster->area,
        .radius = 0.5 * vec3_length(vec3_sub(cluster->high, cluster->low)),
        .reflectance = cluster->reflectance,
        .radiosity = light->radiosity[~node],
        .is_dark = cluster->is_dark,
    };
}

static struct end end_of(const struct method *method, int32_t node)
{
    if (node_is_cluster(node))
        return end_of_cluster(method, node);
    const struct material *material = forest_material(method->forest, node);
    struct end end = {.node = node, .facet = facet_make(method->forest, node),
                      .id = method->forest->patches[node].id,
                      .reflectance = material->reflectance,
                      .radiosity = method->forest->patches[node].radiosity,
                      .is_dark = material_is_dark(material)};
    const struct vec3 *corner = end.facet.triangle.corner;
    end.low = least(corner[0], least(corner[1], corner[2]));
    end.high = most(corner[0], most(corner[1], corner[2]));
    end.area = end.facet.area;
    end.radius = triangle_radius(&end.facet.triangle);
    return end;
}

/* The node of child k, or NODE_NONE. */
static int32_t child_of(const struct method *method, const struct end *end, int k)
{
    return end->cluster ? end->cluster->child[k]
                        : method->forest->patches[end->node].children + k;
}

static double child_area(const struct method *method, const struct end *end, int k)
{
    if (!end->cluster)
        return 0.25 * end->area;
    int32_t node = end->cluster->child[k];
    if (node == NODE_NONE)
        return 0.0;
    return node_is_cluster(node) ? method->clusters->tree->clusters[~node].area
                                 : scene_root_area(method->scene, node);
}

/* --- two ends --- */

/* The largest product of a number in [a, b] and one in [c, d]. */
static double largest_product(double a, double b, double c, double d)
{
    return real_max(real_max(a * c, a * d), real_max(b * c, b * d));
}

/* No point of b is further in front of a plane of a than this. */
static double reach_above(const struct end *a, const struct end *b)
{
    double reach = 0.0;
    struct vec3 n_low = a->cluster ? a->cluster->normal_low : a->facet.plane.normal;
    struct vec3 n_high = a->cluster ? a->cluster->normal_high : n_low;
    for (int axis = 0; axis < 3; axis++) {
        double from = a->cluster ? vec3_axis(a->high, axis) : 0.0;
        double to = a->cluster ? vec3_axis(a->low, axis) : 0.0;
        reach += largest_product(vec3_axis(n_low, axis), vec3_axis(n_high, axis),
                                 vec3_axis(b->low, axis) - from, vec3_axis(b->high, axis) - to);
    }
    return a->cluster ? reach : reach - a->facet.plane.offset;
}

static bool vec3_is_equal(struct vec3 a, struct vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* Roots of exactly one normal never face each other: of two parallel planes one lies behind the
 * other. */
static bool look_the_same_way(const struct end *a, const struct end *b)
{
    struct vec3 normal = a->cluster ? a->cluster->normal_low : a->facet.plane.normal;
    return (!a->cluster || vec3_is_equal(normal, a->cluster->normal_high)) &&
           vec3_is_equal(normal, b->cluster ? b->cluster->normal_low : b->facet.plane.normal) &&
           (!b->cluster || vec3_is_equal(normal, b->cluster->normal_high));
}

/* False if it is certain that nothing of one end faces anything of the other. */
static bool may_face(const struct end *a, const struct end *b)
{
    if (!a->cluster && !b->cluster)
        return facets_face(&a->facet, &b->facet);
    const double margin = 0.5 * GEOM_ROUNDING; /* beyond rounding, facets_face() is stricter */
    return !look_the_same_way(a, b) && reach_above(a, b) > margin && reach_above(b, a) > margin;
}

static double gap_between(const struct end *a, const struct end *b)
{
    double square = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        double above = vec3_axis(b->low, axis) - vec3_axis(a->high, axis);
        double below = vec3_axis(a->low, axis) - vec3_axis(b->high, axis);
        double gap = real_max(0.0, real_max(above, below));
        square += gap * gap;
    }
    return sqrt(square);
}

/* Two ends, of which one at least is a cluster. */
struct meeting {
    struct end p, q;
    bool near;    /* their boxes are closer than half of the sum of their radii */
    double most;  /* no more can be exchanged than this, G */
    double light; /* what is made of G both ways, W per square scene unit */
};

static double light_to(const struct end *to, const struct end *from)
{
    double light = 0.0;
    for (int c = 0; c < BANDS; c++)
        light += to->reflectance.band[c] * from->radiosity.band[c];
    return light;
}

static struct meeting meet(const struct end *p, const struct end *q)
{
    struct meeting m = {.p = *p, .q = *q};
    double gap = gap_between(p, q), limit = real_min(p->area, q->area);
    m.near = gap < 0.5 * (p->radius + q->radius);
    m.most = real_min(limit, p->area * q->area / (PI * gap * gap + 1e-300));
    m.light = light_to(p, q) + light_to(q, p);
    return m;
}

/* Near ends are sampled by rays from the smaller one, but for a cluster before a larger patch: the
 * exact factor of the patch does as well. */
static bool is_by_rays(const struct meeting *m)
{
    return m->near && (m->p.area <= m->q.area ? m->q.cluster : m->p.cluster) != NULL;
}

/* Of what near ends might exchange, the part that may be in doubt at all for a look to be worth it. */
static const double STAKE_RAYS = 0.3;

/* True if so much is at stake between near ends that they are split whatever a look would say. */
static bool is_split_unseen(const struct method *method, const struct meeting *m)
{
    double stake = (m->p.cluster && m->q.cluster ? STAKE_RAYS : 1.0) * m->most * m->light;
    return m->near && stake > method->link_threshold;
}

/* --- sampling --- */

static uint64_t id_number(struct patch_id id)
{
    return (uint64_t)id.root << 32 | id.hierarchy;
}

/* The seed of all samples of a pair. */
static uint64_t seed_of(const struct meeting *m, int salt)
{
    return hash_mix(hash_mix(id_number(m->p.id) + (uint64_t)salt) ^ id_number(m->q.id));
}

/* A point on a root, chosen by area, of one child of a cluster. */
struct sample {
    int32_t root;
    struct vec3 point, normal;
};

static int32_t root_by_area(const struct cluster_tree *tree, const struct cluster *cluster, double u)
{
    int32_t low = cluster->first, high = cluster->end - 1;
    double from = tree->area_before[low], to = tree->area_before[high + 1];
    double wanted = from + u * (to - from);
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (tree->area_before[middle + 1] > wanted)
            high = middle;
        else
            low = middle + 1;
    }
    return tree->roots[low];
}

/* On triangle t, part of a root. */
static struct sample sample_triangle(const struct method *method, int32_t root,
                                     const struct triangle *t, uint64_t seed)
{
    return (struct sample){root, triangle_sample(t, seed + 1),
                           scene_root_plane(method->scene, root).normal};
}

/* On a cluster or a root. */
static struct sample sample_node(const struct method *method, int32_t node, uint64_t seed)
{
    const struct cluster_tree *tree = method->clusters->tree;
    int32_t root = node;
    if (node_is_cluster(node))
        root = root_by_area(tree, &tree->clusters[~node], hash_unit(seed));
    struct triangle t = scene_root_triangle(method->scene, root);
    return sample_triangle(method, root, &t, seed);
}

/* In child k of an end. */
static struct sample sample_child(const struct method *method, const struct end *end, int k,
                                  uint64_t seed)
{
    if (end->cluster)
        return sample_node(method, end->cluster->child[k], seed);
    struct triangle quarter = triangle_child(&end->facet.triangle, k);
    return sample_triangle(method, (int32_t)end->id.root, &quarter, seed);
}

/* Samples of all children. Returns their number. */
static int sample_children(const struct method *method, const struct cluster *cluster, uint64_t seed,
                           struct sample samples[SAMPLES])
{
    int count = 0;
    for (; count < SAMPLES && cluster->child[count] != NODE_NONE; count++)
        samples[count] = sample_node(method, cluster->child[count], seed + 4 * (uint64_t)count);
    return count;
}

/* --- looking --- */

/* What a look finds. */
struct finding {
    double g_p[4], g_q[4];  /* what the children of p and of q exchange, with visibility, G */
    double unoccluded;      /* G without */
    double area;            /* G with */
};

static void add_exchange(struct finding *found, int a, int b, double g, bool seen)
{
    found->unoccluded += g;
    if (!seen)
        return;
    found->area += g;
    found->g_p[a] += g;
    found->g_q[b] += g;
}

/* The 16 pairs of quarters and samples, or the four of the diagonal for all of them. */
static bool is_asked(bool all, int a, int b)
{
    return all || a == b;
}

static bool is_seen(struct method *method, struct vec3 from, int32_t on, struct vec3 to, int32_t at,
                    int32_t *blocker)
{
    const int32_t own[2] = {on, at};
    return !octree_blocks_segment(method->octree, from, to, own, blocker, &method->counts);
}

/* `patch` is p or q of the meeting, the cluster the other. */
static void look_at_patch(struct method *method, const struct meeting *m, uint64_t seed, bool all,
                          struct finding *found)
{
    bool of_p = !m->p.cluster;
    const struct end *patch = of_p ? &m->p : &m->q, *group = of_p ? &m->q : &m->p;
    struct sample samples[SAMPLES];
    int count = sample_children(method, group->cluster, seed, samples);
    int32_t blocker = -1;
    for (int b = 0; b < count; b++) {
        const struct sample *s = &samples[b];
        double area = child_area(method, group, b);
        int32_t input = scene_input_of(method->scene, s->root);
        for (int a = 0; a < 4; a++) {
            struct triangle quarter = triangle_child(&patch->facet.triangle, a);
            double g = area * point_triangle_factor(s->point, s->normal, &quarter);
            if (!(g > 0.0) || !is_asked(all, a, b))
                continue;
            bool seen = is_seen(method, s->point, input, triangle_centroid(&quarter),
                                patch->facet.input, &blocker);
            add_exchange(found, of_p ? a : b, of_p ? b : a, all ? g : 4.0 * g, seen);
        }
    }
}

static void look_from_afar(struct method *method, const struct meeting *m, uint64_t seed, bool all,
                           struct finding *found)
{
    struct sample from[SAMPLES], to[SAMPLES];
    int count_p = sample_children(method, m->p.cluster, seed, from);
    int count_q = sample_children(method, m->q.cluster, seed + 32, to);
    int32_t blocker = -1;
    for (int a = 0; a < count_p; a++)
        for (int b = 0; b < count_q; b++) {
            struct vec3 d = vec3_sub(to[b].point, from[a].point);
            double rise_a = vec3_dot(from[a].normal, d), rise_b = -vec3_dot(to[b].normal, d);
            if (!(rise_a > 0.0 && rise_b > 0.0) || !is_asked(all, a, b))
                continue;
            double r2 = vec3_dot(d, d), area_a = child_area(method, &m->p, a);
            double g = area_a * child_area(method, &m->q, b) * (rise_a * rise_b / r2) / (PI * r2);
            bool seen = is_seen(method, from[a].point, scene_input_of(method->scene, from[a].root),
                                to[b].point, scene_input_of(method->scene, to[b].root), &blocker);
            add_exchange(found, a, b, all ? g : 4.0 * g, seen);
        }
}

/* A cosine-distributed direction about the normal, in ring `ring` of four. */
static struct vec3 ring_direction(uint64_t seed, int ring, struct vec3 x, struct vec3 normal)
{
    double a = 2.0 * hash_unit(seed) - 1.0, b = 2.0 * hash_unit(seed + 1) - 1.0;
    double length = sqrt(a * a + b * b) + 1e-300;
    double sine2 = (ring + hash_unit(seed + 2)) / RINGS, scale = sqrt(sine2) / length;
    struct vec3 along = vec3_add(vec3_scale(x, a * scale),
                                 vec3_scale(vec3_cross(normal, x), b * scale));
    return vec3_add(along, vec3_scale(normal, sqrt(1.0 - sine2)));
}

/* The child of the cluster of which this root is part, or -1. */
static int cluster_child_at(const struct cluster_tree *tree, const struct cluster *cluster,
                            int32_t root)
{
    int32_t place = tree->place[root];
    if (place < cluster->first || place >= cluster->end)
        return -1;
    for (int k = 0; k < 3 && cluster->child[k] != NODE_NONE; k++) {
        int32_t node = cluster->child[k];
        if (node == root || (node_is_cluster(node) && place < tree->clusters[~node].end))
            return k;
    }
    return 3;
}

/* The child of a cluster that the ray from a sample ends on, or -1. */
static int child_met(struct method *method, const struct sample *s, uint64_t seed, int ring,
                     const struct cluster *target)
{
    const struct scene *scene = method->scene;
    struct triangle t = scene_root_triangle(scene, s->root);
    struct vec3 x = vec3_sub(t.corner[1], t.corner[0]);
    x = vec3_scale(x, 1.0 / vec3_length(x));
    struct vec3 start = vec3_add(s->point, vec3_scale(s->normal, 1024.0 * GEOM_ROUNDING));
    struct octree_hit hit;
    if (!octree_first_hit(method->octree, start, ring_direction(seed, ring, x, s->normal), false, &hit,
                          &method->counts))
        return -1;
    int32_t root = scene_root_on(scene, hit.triangle, hit.front);
    return root < 0 ? -1 : cluster_child_at(method->clusters->tree, target, root);
}

static void look_nearby(struct method *method, const struct meeting *m, uint64_t seed,
                        struct finding *found)
{
    bool from_p = m->p.area <= m->q.area;
    const struct end *from = from_p ? &m->p : &m->q, *to = from_p ? &m->q : &m->p;
    for (int a = 0; a < SAMPLES && child_area(method, from, a) > 0.0; a++)
        for (int ring = 0; ring < RINGS; ring++) {
            uint64_t own = seed + 64 + 8 * (uint64_t)(RINGS * a + ring);
            struct sample s = sample_child(method, from, a, own);
            int b = child_met(method, &s, own + 4, ring, to->cluster);
            if (b >= 0)
                add_exchange(found, from_p ? a : b, from_p ? b : a,
                             child_area(method, from, a) / RINGS, true);
        }
}

/* --- making a link of it --- */

/* A part of a cluster's light is dealt by area, as if so many samples of 16 had told so. */
static const double PRIOR = 4.0 / 16.0;

/* The parts of the children; none of them gets more than its area. Lowers `area` by what is cut. */
static void find_parts(const struct method *method, const struct end *end, const double g[4],
                       double *area, uint8_t parts[3])
{
    double prior = end->cluster ? PRIOR : 0.0, exact[4], sum = 0.0;
    for (int k = 0; k < 4; k++) {
        double own = child_area(method, end, k);
        exact[k] = *area > 0.0 ? (g[k] + prior * *area * own / end->area) / (1.0 + prior) : own;
        exact[k] = *area > 0.0 ? real_min(exact[k], own) : own / end->area;
        sum += exact[k];
    }
    *area = *area > 0.0 ? sum : 0.0;
    for (int k = 0; k < 4; k++)
        exact[k] /= sum;
    link_set_parts(parts, exact);
}

/* Both directions of what a cluster exchanges with itself are one. */
static void make_even(struct finding *found)
{
    for (int k = 0; k < 4; k++)
        found->g_p[k] = found->g_q[k] = 0.5 * (found->g_p[k] + found->g_q[k]);
}

/* What the first look found, which the criterion goes by: if it went by the G that counts, links that
 * happen to lack light would stay, and those that have too much be split. In the place of the
 * blocker, which a link with a cluster in it has none of:
 *
 *     0eeeeeeeemmmmmmm  ssss  pppppp  qqqqqq
 *     G as a float      seen  spread  spread
 */
struct judgement {
    double unoccluded;         /* G without blockers */
    double seen;               /* the share of it that arrives, in 15ths */
    double spread_p, spread_q; /* see spread_of(); in 63rds of 4 */
};

static void judge(struct link *link, const struct judgement *found)
{
    float area = (float)found->unoccluded;
    uint32_t bits;
    memcpy(&bits, &area, sizeof bits);
    bits &= 0xffff0000u;
    bits |= (uint32_t)(found->seen > 0.0 ? real_max(1.0, rint(15.0 * found->seen)) : 0.0) << 12;
    bits |= (uint32_t)rint(63.0 / 4.0 * found->spread_p) << 6;
    bits |= (uint32_t)rint(63.0 / 4.0 * found->spread_q);
    memcpy(&link->blocker, &bits, sizeof bits);
}

static struct judgement judgement_of(const struct link *link)
{
    uint32_t bits, high;
    float area;
    memcpy(&bits, &link->blocker, sizeof bits);
    high = bits & 0xffff0000u;
    memcpy(&area, &high, sizeof area);
    return (struct judgement){.unoccluded = (double)area, .seen = (bits >> 12 & 15u) / 15.0,
                              .spread_p = (bits >> 6 & 63u) * (4.0 / 63.0),
                              .spread_q = (bits & 63u) * (4.0 / 63.0)};
}

/* What the children get beyond or below their even share, twice: 1 for all in one half. */
static double spread_of(const struct method *method, const struct end *end, const uint8_t parts[3])
{
    double off = 0.0;
    for (int k = 0; k < 4; k++)
        off += fabs(link_part(parts, k) - child_area(method, end, k) / end->area);
    return 2.0 * off;
}

/* Fills G, parts and visibility of a link. */
static void look(struct method *method, const struct meeting *m, int salt, struct link *link)
{
    struct finding found = {.area = 0.0};
    struct octree_counts before = method->counts;
    uint64_t seed = seed_of(m, salt);
    bool all = true; /* TODO stake */
    if (is_by_rays(m))
        look_nearby(method, m, seed, &found);
    else if (m->p.cluster && m->q.cluster)
        look_from_afar(method, m, seed, all, &found);
    else
        look_at_patch(method, m, seed, all, &found);
    if (link->p == link->q)
        make_even(&found);
    double limit = real_min(m->p.area, m->q.area), area = found.area;
    if (found.unoccluded > limit) {
        double scale = limit / found.unoccluded;
        area *= scale;
        for (int k = 0; k < 4; k++) {
            found.g_p[k] *= scale;
            found.g_q[k] *= scale;
        }
        found.unoccluded = limit;
    }
    double seen = found.unoccluded > 0.0 ? area / found.unoccluded : 0.0;
    find_parts(method, &m->p, found.g_p, &area, link->parts_p);
    double area_q = area;
    find_parts(method, &m->q, found.g_q, &area_q, link->parts_q);
    area = real_min(area, area_q) * (link->p == link->q ? 0.5 : 1.0);
    if (salt == 0)
        judge(link, &(struct judgement){found.unoccluded, seen,
                                        spread_of(method, &m->p, link->parts_p),
                                        spread_of(method, &m->q, link->parts_q)});
    link->seen = area > 0.0 ? link_seen(seen) : 0;
    link->area = float_below(area > 0.0 ? area : found.unoccluded);
    double tests = (double)(method->counts.node_tests + method->counts.triangle_tests -
                            before.node_tests - before.triangle_tests);
    method->estimating += TESTS_PER_FORM_FACTOR;
    method->rays_spared += BUNDLE_RAYS - (method->counts.rays - before.rays);
    link->cost = compact8(real_max(1.0, tests));
}

struct link node_link_top(void)
{
    return (struct link){.p = NODE_TOP, .q = NODE_TOP, .blocker = -1, .cost = compact8(1.0)};
}

/* Makes the link of two ends. False if no light can ever pass. */
static bool make(struct method *method, const struct end *p, const struct end *q, struct link *link)
{
    if ((p->is_dark && q->is_dark) || !may_face(p, q))
        return false;
    *link = (struct link){.p = p->node, .q = q->node, .cost = compact8(1.0)};
    if (!p->cluster && !q->cluster) {
        struct sight sight = {.blocker = -1};
        return link_make(method, p->node, &p->facet, q->node, &q->facet, 0.0, &sight, link);
    }
    struct meeting m = meet(p, q);
    if (!is_split_unseen(method, &m))
        look(method, &m, 0, link);
    return true;
}

/* --- splitting --- */

static int split_itself(struct method *method, int32_t node, struct link children[NODE_CHILDREN_MAX])
{
    struct end whole = end_of(method, node), ends[4];
    int parts = 0, count = 0;
    for (; parts < 4 && whole.cluster->child[parts] != NODE_NONE; parts++)
        ends[parts] = end_of(method, whole.cluster->child[parts]);
    for (int a = 0; a < parts; a++)
        for (int b = a; b < parts; b++)
            count += (a != b || ends[a].cluster) &&
                     make(method, &ends[a], &ends[b], &children[count]);
    return count;
}

int node_link_split(struct method *method, const struct link *link, int32_t node,
                    struct link children[NODE_CHILDREN_MAX])
{
    if (!node_is_cluster(link->p) && !node_is_cluster(link->q))
        return link_split(method, link, node, children);
    if (link->p == link->q)
        return split_itself(method, node, children);
    if (!node_is_cluster(node))
        forest_split(method->forest, node);
    bool of_p = node == link->p;
    struct end own = end_of(method, node), other = end_of(method, of_p ? link->q : link->p);
    int count = 0;
    for (int k = 0; k < 4; k++) {
        int32_t child = child_of(method, &own, k);
        if (child == NODE_NONE)
            break;
        struct end part = end_of(method, child);
        count += of_p ? make(method, &part, &other, &children[count])
                      : make(method, &other, &part, &children[count]);
    }
    return count;
}

/* --- the criterion --- */

static double range_within(const struct method *method, const struct end *end)
{
    return end->cluster ? method->clusters->range[~end->node]
                        : oracle_range_within(method->forest, end->node);
}

static double mean_reflectance(const struct end *end)
{
    return rgb_sum(end->reflectance) / BANDS;
}

static const double SPREAD_LEFT = 0.5, DOUBT_MIXED = 0.25, DOUBT_AGREED = 0.125;
static const double DOUBT_RAYS = 0.25, DOUBT_NEAR = 0.3;

/* The exchange area that is in doubt. */
static double doubt_of(const struct meeting *m, const struct judgement *found)
{
    double limit = real_min(m->p.area, m->q.area), area = found->unoccluded;
    if (is_by_rays(m))
        return DOUBT_RAYS * area * real_max(0.0, 1.0 - area / limit) + DOUBT_NEAR * m->most;
    bool agreed = found->seen <= 0.0 || found->seen >= 1.0;
    return area * (agreed ? DOUBT_AGREED : DOUBT_MIXED) +
           (m->near ? real_max(0.0, m->most - area) : 0.0);
}

/* What one side causes: spread of what it receives within its children, range of what it sends. */
static double error_of(const struct method *method, const struct end *own, const struct end *other,
                       double spread, double area)
{
    return area * (SPREAD_LEFT * spread * light_to(own, other) +
                   mean_reflectance(other) * range_within(method, own));
}

static bool may_split(const struct method *method, const struct end *end)
{
    return end->cluster || oracle_patch_may_split(method, end->node);
}

/* The larger one; of equal ones that with the lower ID. */
static bool p_is_larger(const struct meeting *m)
{
    if (m->p.radius != m->q.radius)
        return m->p.radius > m->q.radius;
    return id_compare(m->p.id, m->q.id) <= 0;
}

/* The side that goes first if it may, else the other. */
static int32_t choose(const struct method *method, const struct meeting *m, bool p_first)
{
    const struct end *first = p_first ? &m->p : &m->q, *second = p_first ? &m->q : &m->p;
    return may_split(method, first) ? first->node
           : may_split(method, second) ? second->node : NODE_NONE;
}

int32_t node_to_split(const struct method *method, const struct link *link)
{
    if (!node_is_cluster(link->p) && !node_is_cluster(link->q)) {
        int32_t patch = oracle_patch_to_split(method, link);
        return patch < 0 ? NODE_NONE : patch;
    }
    struct end p = end_of(method, link->p), q = end_of(method, link->q);
    struct meeting m = meet(&p, &q);
    if (is_split_unseen(method, &m))
        return choose(method, &m, p_is_larger(&m));
    struct judgement found = judgement_of(link);
    double area = found.unoccluded * found.seen;
    double error_p = error_of(method, &p, &q, found.spread_p, area);
    double error_q = error_of(method, &q, &p, found.spread_q, area);
    double doubt = doubt_of(&m, &found) * m.light;
    if (error_p + error_q + doubt <= method->link_threshold)
        return NODE_NONE;
    bool larger = p_is_larger(&m);
    error_p += larger ? doubt : 0.0;
    error_q += larger ? 0.0 : doubt;
    return choose(method, &m, error_p != error_q ? error_p > error_q : larger);
}

static void divide(struct method *method, const struct end *to, const struct end *from,
                   const uint8_t parts[3], const struct link *link)
{
    if (to->cluster || !oracle_patch_may_split(method, to->node))
        return;
    double area = link_area(link) * spread_of(method, to, parts);
    if (area * light_to(to, from) > method->link_threshold)
        forest_split(method->forest, to->node);
}

void node_divide_patches(struct method *method, const struct link *link)
{
    if (!node_is_cluster(link->p) && !node_is_cluster(link->q)) {
        oracle_divide_patches(method, link);
    } else if (!node_is_cluster(link->p) || !node_is_cluster(link->q)) {
        struct end p = end_of(method, link->p), q = end_of(method, link->q);
        divide(method, &p, &q, link->parts_p, link);
        divide(method, &q, &p, link->parts_q, link);
    }
}

void node_link_settle(struct method *method, struct link *link)
{
    struct end p = end_of(method, link->p), q = end_of(method, link->q);
    struct meeting m = meet(&p, &q);
    if (p.cluster || q.cluster) {
        look(method, &m, 1, link);
    } else if (!link_is_open(link) && (link->seen != LINK_ALL_SEEN)) {
        struct sight sight = {.blocker = link->blocker, .seed = seed_of(&m, 1)};
        link_make(method, p.node, &p.facet, q.node, &q.facet, 0.0, &sight, link);
    }
    node_divide_patches(method, link);
}

/* --- transfer --- */

/* What a link takes from a node: B, or that of its children weighted by the parts. */
static struct rgb take(const struct method *method, int32_t node, const uint8_t parts[3])
{
    const struct forest *forest = method->forest;
    if (!node_is_cluster(node) && !link_is_divided(forest, node, parts))
        return forest->patches[node].radiosity;
    struct rgb sum = {{0.0, 0.0, 0.0}};
    for (int k = 0; k < 4; k++) {
        int32_t child = node_is_cluster(node) ? method->clusters->tree->clusters[~node].child[k]
                                              : forest->patches[node].children + k;
        if (child == NODE_NONE)
            break;
        const struct rgb *b = node_is_cluster(child) ? &method->clusters->radiosity[~child]
                                                     : &forest->patches[child].radiosity;
        for (int c = 0; c < BANDS; c++)
            sum.band[c] += link_part(parts, k) * b->band[c];
    }
    return sum;
}

static void add_flux(const struct method *method, int32_t node, double area, const struct rgb *b,
                     struct flux_unit unit)
{
    int64_t *flux = node_is_cluster(node) ? method->clusters->flux + BANDS * (int64_t)~node
                                          : method->forest->patches[node].flux;
    for (int c = 0; c < BANDS; c++)
        flux[c] += flux_from_watts(unit, area * b->band[c]);
}

/* Adds light, G B, to a node, or to its children by the parts. */
static void give(const struct method *method, int32_t node, const uint8_t parts[3], double area,
                 const struct rgb *b, struct flux_unit unit)
{
    const struct forest *forest = method->forest;
    if (!node_is_cluster(node) && !link_is_divided(forest, node, parts)) {
        add_flux(method, node, area, b, unit);
        return;
    }
    for (int k = 0; k < 4; k++) {
        int32_t child = node_is_cluster(node) ? method->clusters->tree->clusters[~node].child[k]
                                              : forest->patches[node].children + k;
        if (child == NODE_NONE)
            break;
        add_flux(method, child, link_part(parts, k) * area, b, unit);
    }
}

void node_links_transfer(const struct link_list *list, const struct method *method,
                         struct flux_unit unit)
{
    for (int64_t i = 0; i < list->seen; i++) {
        const struct link *link = &list->items[i];
        struct rgb from_p = take(method, link->p, link->parts_p);
        struct rgb from_q = take(method, link->q, link->parts_q);
        give(method, link->p, link->parts_p, (double)link->area, &from_q, unit);
        give(method, link->q, link->parts_q, (double)link->area, &from_p, unit);
    }
}
