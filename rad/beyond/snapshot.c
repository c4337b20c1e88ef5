/* Checking a snapshot and its links.
 *
 * A file may say anything. Every number is compared with the numbers of possible runs, so
 * nothing later on meets a patch that does not exist, a NaN, or a flux that overflows:
 * the transfer of light relies on the precondition of links_transfer(), no overlap among
 * the patches linked with one patch, so their exchange areas add up to no more than the
 * area of the scene. This sum is checked for each patch. */
#include "rad/beyond/snapshot.h"

#include <math.h>

#include "geom/alloc.h"

void snapshot_allocate(struct snapshot *snapshot)
{
    size_t leaves = (size_t)snapshot_leaf_count(snapshot);
    snapshot->split = alloc_array((size_t)snapshot->patch_count, sizeof *snapshot->split);
    snapshot->leaves = alloc_array(leaves, sizeof *snapshot->leaves);
}

void snapshot_free(struct snapshot *snapshot)
{
    alloc_free(snapshot->split);
    alloc_free(snapshot->leaves);
    *snapshot = (struct snapshot){0};
}

/* --- trees --- */

/* A walk over the trees, depth first. */
struct walk {
    int32_t root; /* of the next patch */
    int level;    /* of the next patch */
    int child[ID_MAX_LEVEL + 1]; /* child number of the patch at each level */
};

/* Moves on to the next patch. Pre: not split at the level ID_MAX_LEVEL. */
static void walk_on(struct walk *walk, uint8_t split)
{
    if (split) {
        walk->child[++walk->level] = 0;
        return;
    }
    while (walk->level > 0 && ++walk->child[walk->level] == 4)
        walk->level--;
    walk->root += walk->level == 0;
}

static bool trees_are_whole(const struct snapshot *snapshot)
{
    struct walk walk = {0};
    for (int64_t i = 0; i < snapshot->patch_count; i++) {
        uint8_t split = snapshot->split[i];
        if (split > 1 || walk.root >= snapshot->root_count ||
            (walk.level == ID_MAX_LEVEL && split))
            return false;
        walk_on(&walk, split);
    }
    return walk.level == 0 && walk.root == snapshot->root_count;
}

/* --- numbers --- */

/* No run exceeds these, with room left for sums, and for radiosities as floats. */
static const int64_t MOST_COUNTED = INT64_C(1) << 60;
static const double MOST_LIGHT = 1e37, MOST_POWER = 1e60;

/* False for a NaN, too. */
static bool is_within(double value)
{
    return value >= 0.0 && value <= MOST_LIGHT;
}

static bool numbers_are_sane(const struct snapshot *snapshot)
{
    const double *value = snapshot->value;
    for (int i = 0; i < SNAPSHOT_NUMBERS; i++)
        if (snapshot->number[i] < 0 || snapshot->number[i] > MOST_COUNTED)
            return false;
    return snapshot->number[SNAPSHOT_SETTLED] <= 1 &&
           snapshot->number[SNAPSHOT_GATHER] <= GATHER_RAYS_MOST &&
           value[SNAPSHOT_REMAINING] >= 0.0 &&
           fabs(value[SNAPSHOT_ABSORBED]) <= MOST_POWER &&
           fabs(value[SNAPSHOT_ESCAPED]) <= MOST_POWER &&
           is_within(value[SNAPSHOT_EPSILON]) && is_within(value[SNAPSHOT_COARSE]) &&
           is_within(value[SNAPSHOT_COARSE_EPSILON]);
}

static bool leaves_are_sane(const struct snapshot *snapshot)
{
    for (int64_t k = 0; k < BANDS * snapshot_leaf_count(snapshot); k++)
        if (!(fabs(snapshot->leaves[k / BANDS].band[k % BANDS]) <= MOST_LIGHT))
            return false;
    return true;
}

bool snapshot_check(const struct snapshot *snapshot, struct error *error)
{
    if (!trees_are_whole(snapshot))
        return error_set(error, EXIT_USAGE, "its patches are no trees");
    if (!numbers_are_sane(snapshot) || !leaves_are_sane(snapshot))
        return error_set(error, EXIT_USAGE, "a number in it is out of range");
    return true;
}

/* --- links --- */

struct link_check link_check_start(const struct snapshot *snapshot,
                                   const struct scene *scene,
                                   const struct cluster_tree *tree)
{
    struct link_check check = {.scene = scene, .patch_count = snapshot->patch_count,
                               .cluster_count = tree ? tree->count : 0,
                               .most = (1.0 + 1e-6) * scene_area(scene)};
    size_t nodes = (size_t)(check.patch_count + check.cluster_count);
    struct walk walk = {0};
    check.root = alloc_array((size_t)check.patch_count, sizeof *check.root);
    check.area = alloc_array(nodes, sizeof *check.area);
    check.load = alloc_array(nodes, sizeof *check.load);
    for (int64_t i = 0; i < check.cluster_count; i++)
        check.area[check.cluster_count + ~i] = tree->clusters[i].area;
    for (int64_t i = 0; i < snapshot->patch_count; i++) {
        double share = 1.0 / (double)(UINT32_C(1) << (2 * walk.level));
        check.root[i] = walk.root;
        check.area[check.cluster_count + i] = scene_root_area(scene, walk.root) * share;
        walk_on(&walk, snapshot->split[i]);
    }
    return check;
}

void link_check_free(struct link_check *check)
{
    alloc_free(check->root);
    alloc_free(check->area);
    alloc_free(check->load);
    *check = (struct link_check){0};
}

static bool parts_are_sane(const uint8_t parts[3])
{
    return parts[0] + parts[1] + parts[2] <= 256;
}

/* True if the pair of the link comes after the pair of the last one. */
static bool is_behind(const struct link_check *check, const struct link *link)
{
    return !check->begun || link->p > check->last.p ||
           (link->p == check->last.p && link->q > check->last.q);
}

/* True if both nodes exist and neither is part of the other, which is checked of patches
 * alone; a cluster may be linked with itself. */
static bool are_nodes(const struct link_check *check, int32_t p, int32_t q)
{
    int64_t first = -check->cluster_count, end = check->patch_count;
    if (p < first || q < first || p >= end || q >= end)
        return false;
    return node_is_cluster(p) || node_is_cluster(q) || check->root[p] != check->root[q];
}

/* The blocker of a link of patches is a triangle; of a link with a cluster, a finite
 * number, not negative. */
static bool blocker_is_sane(const struct link_check *check, const struct link *link)
{
    const int32_t infinite = 0x7f800000;
    if (node_is_cluster(link->p) || node_is_cluster(link->q))
        return link->blocker >= 0 && link->blocker < infinite &&
               link->seen <= LINK_ALL_SEEN;
    return link->blocker >= -1 && link->blocker < check->scene->input_count;
}

bool link_check_next(struct link_check *check, const struct link *link)
{
    if (!are_nodes(check, link->p, link->q) || !is_behind(check, link))
        return false;
    int64_t p = check->cluster_count + link->p, q = check->cluster_count + link->q;
    double smaller = fmin(check->area[p], check->area[q]);
    double most = link->seen > 0 ? (1.0 + 1e-6) * smaller : check->most; /* rounding */
    if (!(smaller > 0.0 && link->area >= 0.0f && (double)link->area <= most) ||
        link->seen > LINK_OPEN || !blocker_is_sane(check, link) ||
        !parts_are_sane(link->parts_p) || !parts_are_sane(link->parts_q))
        return false;
    check->load[p] += link_area(link);
    check->load[q] += link_area(link);
    check->last = *link;
    check->begun = true;
    return check->load[p] <= check->most && check->load[q] <= check->most;
}
