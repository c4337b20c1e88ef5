/* The roots that a root faces, and whether anything stands between. Segments find most
 * blockers; what they leave open is proved. */
#include "rad/beyond/gather/view.h"

#include "geom/alloc.h"
#include "rad/beyond/patch_exchange.h"
#include "rad/beyond/sample.h"

/* A root is slender if the square of its radius is more than this times its area: its
 * points are far apart for its width, and mean factors would take too many of them. */
static const double SLENDER = 64.0;

struct gather_view *view_create(const struct model *model, int64_t most)
{
    struct gather_view *view = alloc_array(1, sizeof *view);
    view->model = model;
    view->most = most;
    view->root = -1;
    view->overlapped = alloc_array((size_t)model->forest->root_count, 1);
    return view;
}

void view_destroy(struct gather_view *view)
{
    alloc_free(view->faced);
    alloc_free(view->overlapped);
    alloc_free(view);
}

/* Adds the roots below a node that the root faces. False once there are too many. */
static bool add_faced(struct gather_view *view, const struct end *root, int32_t node)
{
    struct end end = end_of(view->model, node);
    if (!ends_may_face(root, &end))
        return true;
    if (end.cluster) {
        bool few = true;
        for (int k = 0; k < 4 && few && end.cluster->child[k] != NODE_NONE; k++)
            few = add_faced(view, root, end.cluster->child[k]);
        return few;
    }
    if (view->count == view->most)
        return false;
    RESERVE(view->faced, &view->capacity, view->count + 1);
    view->faced[view->count++] = node;
    return true;
}

/* True if a root below the node overlaps this one in its plane: one hides part of the
 * other. */
static bool has_overlap(struct gather_view *view, const struct end *root, int32_t node)
{
    struct end end = end_of(view->model, node);
    const struct facet *s = &root->facet, *t = &end.facet;
    bool found = false;
    view->counts.node_tests++;
    if (node == root->node || !ends_meet(root, &end).near)
        return false;
    if (!end.cluster)
        return triangle_is_in(&t->triangle, &t->plane, &s->plane) &&
               triangles_overlap(&s->triangle, &t->triangle, &s->plane);
    for (int k = 0; k < 4 && !found && end.cluster->child[k] != NODE_NONE; k++)
        found = has_overlap(view, root, end.cluster->child[k]);
    return found;
}

static bool is_overlapped(struct gather_view *view, int32_t root)
{
    uint8_t *known = &view->overlapped[root];
    struct end end = end_of(view->model, root);
    if (*known == 0)
        *known = has_overlap(view, &end, NODE_TOP) ? 2 : 1;
    return *known == 2;
}

/* Lists the roots that a root faces. True if these are few, and nothing hides any as far
 * as segments tell; if `proof`, as proofs tell, too. Segments find most blockers. */
static bool finds_open(struct gather_view *view, int32_t number, bool proof)
{
    struct end root = end_of(view->model, number);
    const struct octree *octree = view->model->octree;
    struct vec3 middle = triangle_centroid(&root.facet.triangle);
    int32_t guess = -1;
    view->count = 0;
    bool slender = root.radius * root.radius > SLENDER * root.area;
    bool open = !slender && view->most >= 0 && add_faced(view, &root, NODE_TOP);
    for (int64_t i = 0; i < view->count && open; i++) {
        struct facet other = facet_make(view->model->forest, view->faced[i]);
        const int32_t own[2] = {root.facet.input, other.input};
        struct vec3 there = triangle_centroid(&other.triangle);
        open = !(point_kernel(middle, root.facet.plane.normal, there,
                                 other.plane.normal) > 0.0) ||
               !octree_blocks_segment(octree, middle, there, own, &guess, &view->counts);
    }
    for (int64_t i = 0; i < view->count && open && proof; i++) {
        struct facet other = facet_make(view->model->forest, view->faced[i]);
        open = facets_are_open(&root.facet, &other, octree, &view->counts) &&
               !is_overlapped(view, view->faced[i]);
    }
    return open;
}

bool view_is_open(struct gather_view *view, int32_t root, bool proof)
{
    if (!proof) {
        view->root = -1;
        return finds_open(view, root, false);
    }
    if (view->root != root)
        view->open = finds_open(view, root, true);
    view->root = root;
    return view->open;
}
