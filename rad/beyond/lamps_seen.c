/* In a room with a window walls keep most of the sky's light off, and segments that are
 * dealt by the light without blockers rarely find the window: pixels were black, or ten
 * times too bright. So where there are more groups of lamps than segments, the surface
 * around a pixel is asked which groups are seen from it, by some segments to each. Three
 * quarters of the pixel's segments go by its answers; the rest go by light alone, or what
 * the surface has not seen would count many times where a pixel sees it. The answers
 * decide only where light is looked for.
 *
 * A leaf is asked, or a patch above it: no more patches than some thousands, and the
 * roots that are smaller. The answers are the same whichever pixel asks first, and are
 * kept for those to come. */
#include "rad/beyond/lamps_seen.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/hash.h"
#include "rad/beyond/gather_regions.h"
#include "rad/beyond/met.h"

/* Segments from a patch to all groups, about; to each of them, least and most. */
enum { ASKED = 4096, ASKED_LEAST = 4, ASKED_MOST = 32 };

/* Segments that the groups of a patch are told apart by: the same for all pixels. */
enum { TOLD_APART = 64 };

/* Patches that are kept: one takes the place of another by its number modulo this. */
enum { PATCHES_KEPT = 4096 };

/* A patch that is asked has this part of all area that reflects, or is a root. */
static const double LEAST_AREA = 1.0 / 8192.0;

/* The part of all segments that go by the shares that are seen. */
static const double PART_SEEN = 0.75;

/* Lamps between two places in the tree's order, from where the span before it ends. */
struct span {
    int32_t end;
    float seen; /* share of their light, 1 */
};

/* The lamps as a patch sees them. */
struct lamps_view {
    int32_t patch;      /* -1: none */
    struct span *spans; /* [count] of its groups, in the tree's order */
    int64_t count;
};

struct lamps_views {
    double least; /* area of a patch that is asked, square scene units */
    struct lamps_view items[PATCHES_KEPT];
};

/* The share of a group that is seen from a patch, among points that face each other; half
 * a point more counts as seen, so that no share is 0. */
static double seen_of_group(struct receiver *r, const struct lamps *lamps, int32_t node,
                            int count)
{
    const struct scene *scene = r->gather->model->scene;
    struct sequence sequence =
        sequence_start(hash_mix(r->seed + 80) ^ hash_mix((uint64_t)(int64_t)node));
    double start = hash_unit(sequence.scramble[0]), all = 0.5, seen = 0.5;
    for (int k = 0; k < count; k++) {
        double u[SEQUENCE_DIMENSIONS];
        int32_t lamp = lamp_choose(lamps, node, (k + start) / count).patch;
        struct triangle t = scene_root_triangle(scene, lamp);
        sequence_point(&sequence, (uint32_t)k, u);
        struct vec3 x = receiver_start(r, u[0], u[1]);
        struct vec3 y = triangle_of_square(&t, u[2], u[3]);
        if (receiver_kernel(x, r->facet.plane.normal, y,
                            scene_root_plane(scene, lamp).normal) > 0.0) {
            all += 1.0;
            seen += receiver_blocker(r, x, y, lamp) < 0;
        }
    }
    return seen / all;
}

/* Fills in the view of a patch. Overwrites the groups at hand. */
static void look_around(struct final_gather *g, struct lamps *lamps, int32_t patch,
                        struct lamps_view *view)
{
    const struct lamp_groups *groups = &lamps->groups;
    struct apart apart = apart_begin(g); /* each rank does the same */
    struct receiver r = receiver_of_leaf(g, patch, TOLD_APART);
    lamps_group(lamps, &r.facet, TOLD_APART, HUGE_VAL, &g->model->estimating);
    alloc_free(view->spans);
    *view = (struct lamps_view){.patch = patch, .count = groups->count};
    view->spans = alloc_array((size_t)view->count, sizeof *view->spans);
    int count = ASKED / (int)(view->count > 0 ? view->count : 1);
    count = count < ASKED_LEAST ? ASKED_LEAST : count < ASKED_MOST ? count : ASKED_MOST;
    for (int64_t i = 0; i < view->count; i++) {
        int32_t node = groups->items[i].node, first, end;
        lamps_places(lamps, node, &first, &end);
        view->spans[i] =
            (struct span){end, (float)seen_of_group(&r, lamps, node, count)};
    }
    apart_end(g, &apart);
}

static struct lamps_views *create_views(const struct model *model)
{
    struct lamps_views *views = alloc_array(1, sizeof *views);
    for (int32_t root = 0; root < scene_root_count(model->scene); root++)
        if (rgb_sum(scene_root_material(model->scene, root)->reflectance) > 0.0)
            views->least += LEAST_AREA * scene_root_area(model->scene, root);
    for (int i = 0; i < PATCHES_KEPT; i++)
        views->items[i].patch = -1;
    return views;
}

/* The view of the patch around a leaf. */
static const struct lamps_view *view_around(struct final_gather *g, struct lamps *lamps,
                                            int32_t patch)
{
    const struct forest *forest = g->model->forest;
    if (!g->view.lamps)
        g->view.lamps = create_views(g->model);
    while (forest_area(forest, patch) < g->view.lamps->least &&
           forest->patches[patch].parent >= 0)
        patch = forest->patches[patch].parent;
    struct lamps_view *view = &g->view.lamps->items[patch % PATCHES_KEPT];
    if (view->patch != patch) {
        struct lamp_groups own = lamps->groups;
        lamps->groups = (struct lamp_groups){0};
        look_around(g, lamps, patch, view);
        alloc_free(lamps->groups.items);
        lamps->groups = own;
    }
    return view;
}

/* The share of a group's light that is seen; `span`: on to the first one of the group. */
static double seen_by_spans(const struct lamps *lamps, const struct lamps_view *view,
                            int32_t node, int64_t *span)
{
    int32_t first, end, at;
    lamps_places(lamps, node, &first, &end);
    while (*span + 1 < view->count && view->spans[*span].end <= first)
        ++*span;
    double seen = 0.0;
    at = first;
    for (int64_t i = *span; at < end; i++) {
        const struct span *own = &view->spans[i];
        int32_t to = i + 1 < view->count && own->end < end ? own->end : end;
        seen += (double)own->seen * (lamps->before[to] - lamps->before[at]);
        at = to;
    }
    return seen / (lamps->before[end] - lamps->before[first]);
}

void receiver_weigh_groups(struct receiver *r, struct lamps *lamps, int segments)
{
    struct lamp_groups *groups = &lamps->groups;
    struct point point = {.at = r->points->middle};
    double sum = 0.0;
    if (groups->count <= segments)
        return;
    find_leaf(r->gather->model->forest, r->points->root, &point);
    const struct lamps_view *view = view_around(r->gather, lamps, point.patch);
    for (int64_t i = 0, span = 0; i < groups->count && view->count > 0; i++) {
        struct lamp_group *group = &groups->items[i];
        group->seen = seen_by_spans(lamps, view, group->node, &span);
        sum += group->worth * group->seen;
    }
    for (int64_t i = 0; i < groups->count && sum > 0.0; i++) {
        struct lamp_group *group = &groups->items[i];
        double by_seen = group->worth * group->seen * (groups->worth / sum);
        group->worth += PART_SEEN * (by_seen - group->worth);
    }
}

void lamps_views_free(struct lamps_views *views)
{
    for (int i = 0; views && i < PATCHES_KEPT; i++)
        alloc_free(views->items[i].spans);
    alloc_free(views);
}
