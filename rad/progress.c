/* Checking a progress and its links.
 *
 * What comes from a file may say anything. Every number is held against what a run could have
 * written, so that nothing later on meets a patch that does not exist, a NaN, or a flux that
 * overflows: the transfer of light relies on what links_transfer() states, that the links of a
 * patch lead to patches that do not overlap, so their exchange areas add up to no more than the
 * area of the scene. That sum is checked as it stands, for each patch. */
#include "rad/progress.h"

#include <math.h>

#include "geom/alloc.h"

void progress_allocate(struct progress *progress)
{
    size_t leaves = (size_t)progress_leaf_count(progress);
    progress->root_change = alloc_array((size_t)progress->root_count,
                                        sizeof *progress->root_change);
    progress->kind = alloc_array((size_t)progress->patch_count, sizeof *progress->kind);
    progress->leaves = alloc_array(leaves, sizeof *progress->leaves);
    progress->compared = alloc_array((size_t)progress->compared_count, sizeof *progress->compared);
}

void progress_free(struct progress *progress)
{
    alloc_free(progress->root_change);
    alloc_free(progress->kind);
    alloc_free(progress->leaves);
    alloc_free(progress->compared);
    *progress = (struct progress){0};
}

/* --- trees --- */

/* A walk over the kinds, depth first. */
struct walk {
    int32_t root; /* of the patch that comes next */
    int level;    /* its level */
    int child[ID_MAX_LEVEL + 1]; /* which child of its parent the patch of each level is */
};

/* Goes past a patch. Pre: it is not split if its level is ID_MAX_LEVEL. */
static void walk_on(struct walk *walk, uint8_t kind)
{
    if (kind & PATCH_SPLIT) {
        walk->child[++walk->level] = 0;
        return;
    }
    while (walk->level > 0 && ++walk->child[walk->level] == 4)
        walk->level--;
    walk->root += walk->level == 0;
}

static bool trees_are_whole(const struct progress *progress)
{
    struct walk walk = {0};
    int64_t compared = 0;
    for (int64_t i = 0; i < progress->patch_count; i++) {
        uint8_t kind = progress->kind[i];
        if (kind > (PATCH_SPLIT | PATCH_COMPARED) || walk.root >= progress->root_count)
            return false;
        if (walk.level == ID_MAX_LEVEL && kind & PATCH_SPLIT)
            return false;
        walk_on(&walk, kind);
        compared += (kind & PATCH_COMPARED) != 0;
    }
    return walk.level == 0 && walk.root == progress->root_count &&
           compared == progress->compared_count;
}

/* --- numbers --- */

/* Beyond these no run gets: they leave room for sums, and for radiosities as floats. */
static const int64_t MOST_COUNTED = INT64_C(1) << 60;
static const double MOST_LIGHT = 1e37, MOST_POWER = 1e60, MOST_FACTOR = 1e15;

static bool light_is_sane(struct rgb light)
{
    for (int c = 0; c < BANDS; c++)
        if (!(fabs(light.band[c]) <= MOST_LIGHT))
            return false;
    return true;
}

static bool numbers_are_sane(const struct progress *progress)
{
    const double *value = progress->value;
    for (int i = 0; i < PROGRESS_NUMBERS; i++)
        if (progress->number[i] < 0 || progress->number[i] > FLUX_LIMIT ||
            (i != PROGRESS_CHANGE && progress->number[i] > MOST_COUNTED))
            return false;
    for (int64_t i = 0; i < progress->root_count; i++)
        if (progress->root_change[i] < 0 || progress->root_change[i] > FLUX_LIMIT)
            return false;
    return progress->number[PROGRESS_SETTLED] <= 1 && value[PROGRESS_REMAINING] >= 0.0 &&
           fabs(value[PROGRESS_ABSORBED]) <= MOST_POWER &&
           fabs(value[PROGRESS_ESCAPED]) <= MOST_POWER && value[PROGRESS_EPSILON] >= 0.0 &&
           value[PROGRESS_EPSILON] <= MOST_LIGHT && value[PROGRESS_ESTIMATE] >= 0.0 &&
           value[PROGRESS_ESTIMATE] <= MOST_LIGHT && fabs(value[PROGRESS_LEAST_BEND]) <= MOST_LIGHT;
}

static bool leaves_are_sane(const struct progress *progress)
{
    for (int64_t i = 0; i < progress_leaf_count(progress); i++) {
        const struct leaf_state *leaf = &progress->leaves[i];
        if (!light_is_sane(leaf->radiosity) || !light_is_sane(leaf->irradiance) ||
            !(leaf->factor >= 1.0 / MOST_FACTOR && leaf->factor <= MOST_FACTOR))
            return false;
    }
    for (int64_t i = 0; i < progress->compared_count; i++)
        if (!light_is_sane(progress->compared[i]))
            return false;
    return true;
}

bool progress_check(const struct progress *progress, struct error *error)
{
    if (!trees_are_whole(progress))
        return error_set(error, EXIT_USAGE, "its patches are no trees");
    if (!numbers_are_sane(progress) || !leaves_are_sane(progress))
        return error_set(error, EXIT_USAGE, "a number in it is out of range");
    return true;
}

/* --- links --- */

struct link_check link_check_start(const struct progress *progress, const struct scene *scene)
{
    size_t patches = (size_t)progress->patch_count;
    struct link_check check = {.scene = scene, .patch_count = progress->patch_count,
                               .most = (1.0 + 1e-6) * scene_area(scene)};
    struct walk walk = {0};
    check.root = alloc_array(patches, sizeof *check.root);
    check.area = alloc_array(patches, sizeof *check.area);
    check.load = alloc_array(patches, sizeof *check.load);
    for (int64_t i = 0; i < progress->patch_count; i++) {
        double share = 1.0 / (double)(UINT32_C(1) << (2 * walk.level));
        check.root[i] = walk.root;
        check.area[i] = scene_root_area(scene, walk.root) * share;
        walk_on(&walk, progress->kind[i]);
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

/* The pair of the link comes behind that of the last one. */
static bool is_behind(const struct link_check *check, const struct link *link)
{
    return !check->begun || link->p > check->last.p ||
           (link->p == check->last.p && link->q > check->last.q);
}

bool link_check_next(struct link_check *check, const struct link *link)
{
    int32_t p = link->p, q = link->q;
    if (p < 0 || q < 0 || p >= check->patch_count || q >= check->patch_count ||
        !is_behind(check, link) || check->root[p] == check->root[q])
        return false;
    double smaller = fmin(check->area[p], check->area[q]);
    double most = link->seen > 0 ? smaller : check->most;
    if (!(smaller > 0.0 && link->area >= 0.0f && (double)link->area <= most) ||
        link->seen > LINK_OPEN || link->blocker < -1 || link->blocker >= check->scene->input_count ||
        !parts_are_sane(link->parts_p) || !parts_are_sane(link->parts_q))
        return false;
    check->load[p] += link_area(link);
    check->load[q] += link_area(link);
    check->last = *link;
    check->begun = true;
    return check->load[p] <= check->most && check->load[q] <= check->most;
}
