/* The exchange of clusters.
 *
 * G of two patches comes from exact factors between points and polygons; a cluster is no
 * polygon. It is sampled at points on its roots, one in each child, chosen by area:
 *
 *  - with a node far away: by A_a A_b cos cos / (pi r^2) for each pair of points, and a
 *    segment; of a patch there is a point in each quarter;
 *
 *  - with itself, or with a node that is near and not larger: by 16 cosine-distributed
 *    rays from the smaller one. A ray ending on a root of the other, told by its place in
 *    the tree's order, counts A / 16: no 1 / r^2, no clamp, visibility included. (By
 *    pairs of points, books in a shelf lose a quarter of their light: points miss the
 *    pairs that matter.)
 *
 * Rejected: exact factors from points to the quarters of a patch (no less error, 8 % more
 * time); four pairs of points of the 16 where a link can carry little (a fifth fewer
 * rays, and up to 6 % more links).
 *
 * The points are chosen by a hash of both IDs: the errors of different links are not
 * alike, and a link means the same on any rank. */
#include "rad/beyond/node_exchange.h"

#include "geom/hash.h"
#include "rad/beyond/sample.h"

enum { SAMPLES = 4, RINGS = 4 };

/* Near ends are sampled by rays from the smaller one, but for a cluster before a larger
 * patch: in which of its quarters a ray ends is not known. */
bool is_by_rays(const struct meeting *m)
{
    return m->near && (m->p->area <= m->q->area ? m->q->cluster : m->p->cluster) != NULL;
}

/* The triangle in which a sample lies: a root, or a quarter of a patch. */
struct ground {
    int32_t root;
    struct triangle triangle;
    struct vec3 normal, point; /* the sample */
};

static int32_t root_by_area(const struct cluster_tree *tree,
                            const struct cluster *cluster, double u)
{
    const double *after = tree->area_before + cluster->first; /* root by root */
    int32_t count = cluster->end - cluster->first;
    double wanted = after[0] + u * (after[count] - after[0]);
    return tree->roots[cluster->first + sum_place(after + 1, count, wanted)];
}

/* In child k of an end: a quarter of a patch, or a root of a cluster, chosen by area. */
static struct ground ground_in(const struct model *model, const struct end *end, int k,
                               uint64_t seed)
{
    const struct cluster_tree *tree = model->clusters->tree;
    int32_t root = (int32_t)end->id.root;
    if (end->cluster) {
        int32_t child = end->cluster->child[k];
        root = node_is_cluster(child)
                   ? root_by_area(tree, &tree->clusters[~child], hash_unit(seed))
                   : child;
    }
    return (struct ground){
        .root = root,
        .triangle = end->cluster ? scene_root_triangle(model->scene, root)
                                 : triangle_child(&end->facet.triangle, k),
        .normal = scene_root_plane(model->scene, root).normal};
}

/* Samples of all children. Returns their number. */
static int sample_children(const struct model *model, const struct end *end,
                           uint64_t seed, struct ground samples[SAMPLES])
{
    int count = 0;
    for (; count < SAMPLES && end_child_area(model, end, count) > 0.0; count++) {
        uint64_t own = seed + 4 * (uint64_t)count;
        samples[count] = ground_in(model, end, count, own);
        samples[count].point = triangle_sample(&samples[count].triangle, own + 1);
    }
    return count;
}

/* --- looking --- */

static void add_exchange(struct node_exchange *found, int a, int b, double g, bool seen)
{
    found->unoccluded += g;
    if (!seen)
        return;
    found->area += g;
    found->g_p[a] += g;
    found->g_q[b] += g;
}

static void look_from_afar(struct model *model, const struct meeting *m, uint64_t seed,
                           struct node_exchange *found)
{
    struct ground from[SAMPLES], to[SAMPLES];
    int count_p = sample_children(model, m->p, seed, from);
    int count_q = sample_children(model, m->q, seed + 32, to);
    int32_t blocker = -1;
    for (int a = 0; a < count_p; a++)
        for (int b = 0; b < count_q; b++) {
            struct vec3 d = vec3_sub(to[b].point, from[a].point);
            double rise_a = vec3_dot(from[a].normal, d),
                   rise_b = -vec3_dot(to[b].normal, d);
            if (!(rise_a > 0.0 && rise_b > 0.0))
                continue;
            double r2 = vec3_dot(d, d), area_a = end_child_area(model, m->p, a);
            double g = area_a * end_child_area(model, m->q, b) *
                       (rise_a * rise_b / r2) / (PI * r2);
            const int32_t own[2] = {scene_input_of(model->scene, from[a].root),
                                    scene_input_of(model->scene, to[b].root)};
            bool seen = !octree_blocks_segment(model->octree, from[a].point, to[b].point,
                                               own, &blocker, &model->counts);
            add_exchange(found, a, b, g, seen);
        }
}

/* The child of the cluster of which this root is part, or -1. */
static int cluster_child_at(const struct cluster_tree *tree,
                            const struct cluster *cluster, int32_t root)
{
    int32_t place = root < 0 ? -1 : tree->place[root];
    if (place < cluster->first || place >= cluster->end)
        return -1;
    for (int k = 0; k < 3 && cluster->child[k] != NODE_NONE; k++) {
        int32_t node = cluster->child[k];
        if (node == root || (node_is_cluster(node) && place < tree->clusters[~node].end))
            return k;
    }
    return 3;
}

static void look_nearby(struct model *model, const struct meeting *m, uint64_t seed,
                        struct node_exchange *found)
{
    bool from_p = m->p->area <= m->q->area;
    const struct end *from = from_p ? m->p : m->q, *to = from_p ? m->q : m->p;
    for (int a = 0; a < SAMPLES && end_child_area(model, from, a) > 0.0; a++)
        for (int ring = 0; ring < RINGS; ring++) {
            uint64_t own = seed + 64 + 8 * (uint64_t)(RINGS * a + ring);
            struct ground ground = ground_in(model, from, a, own);
            struct half_line ray =
                ray_sample(&ground.triangle, ground.normal, own + 1, ring, RINGS);
            int32_t root = root_met(model->scene, model->octree, &ray, -1,
                                     &model->counts);
            int b = cluster_child_at(model->clusters->tree, to->cluster, root);
            if (b >= 0)
                add_exchange(found, from_p ? a : b, from_p ? b : a,
                             end_child_area(model, from, a) / RINGS, true);
        }
}

/* No more than the smaller area. */
static void limit_exchange(struct node_exchange *found, double limit)
{
    if (found->unoccluded <= limit)
        return;
    double scale = limit / found->unoccluded;
    for (int k = 0; k < 4; k++) {
        found->g_p[k] *= scale;
        found->g_q[k] *= scale;
    }
    found->area *= scale;
    found->unoccluded = limit;
}

struct node_exchange node_exchange_estimate(struct model *model,
                                            const struct meeting *m, int salt)
{
    struct node_exchange found = {.area = 0.0};
    uint64_t seed =
        hash_mix(hash_mix(id_number(m->p->id) + (uint64_t)salt) ^ id_number(m->q->id));
    if (is_by_rays(m))
        look_nearby(model, m, seed, &found);
    else
        look_from_afar(model, m, seed, &found);
    limit_exchange(&found, real_min(m->p->area, m->q->area));
    return found;
}
