/* Initial linking.
 *
 * What is asked of each pair of roots: do they face each other, is a wall between them, and how much
 * do they exchange? Asked one by one that is quadratic in the number of roots. A row goes down the
 * tree of boxes instead, and whole groups are left out that the root cannot face (rad/boxtree.c), or
 * that lie in a shadow. The last few shadows in which something was found are remembered: to a book
 * on a shelf, its two neighbours hide most of the room. New ones come from the pairs whose segments
 * are all blocked: the triangle that blocked last is part of a wall, which may hide all of the
 * partner, and then what comes next in the tree.
 *
 * Of n roots, row i has the next n / 2 in the order of the tree, around its end, so all rows are
 * equally long. What they take differs thirtyfold, by where they lie, and next to nothing that can be
 * known of a row tells it beforehand. So each row is begun with a sample, every sixteenth leaf of
 * the tree: what that takes tells what the rest will take (correlation 0.97 in furnished rooms), and costs
 * 1 % more, since shadows are found twice. The rest can be linked in parts.
 *
 * Tried and left out: groups in place of the one root (four roots are seldom hidden by one wall: half
 * as many pairs were proved, for more work), bundles of 16 segments between four roots and four
 * others (each is blocked by something else: three times the triangle tests), and one segment to each
 * of four partners in a bundle (2 % less work). */
#include "rad/linking.h"

#include "geom/alloc.h"

struct linking linking_start(struct method *method, struct link_list *links)
{
    struct linking linking = {.method = method, .links = links,
                              .tree = boxtree_create(method->scene)};
    int32_t count = linking.tree->root_count;
    linking.facets = alloc_array((size_t)count, sizeof *linking.facets);
    for (int32_t i = 0; i < count; i++)
        linking.facets[i] = facet_make(method->forest, linking.tree->roots[i]);
    return linking;
}

void linking_end(struct linking *linking)
{
    boxtree_destroy(linking->tree);
    alloc_free(linking->facets);
    *linking = (struct linking){0};
}

/* Shadows that a row remembers: with 8 in place of 4 a tenth less is left, with 16 hardly less. */
enum { SHADOWS = 8 };

struct row {
    struct linking *linking;
    int32_t place;       /* of the root p, in the order of the tree */
    bool is_sample;      /* the sample of the row, or the rest */
    int32_t first, end;  /* places of the roots to pair it with */
    struct boxnode node; /* of p alone */
    int32_t blocker;     /* the last */
    struct shadow shadows[SHADOWS]; /* as seen from p */
    int count, next;     /* shadows there are; the oldest */
};

static bool is_known(const struct row *row, int32_t wall)
{
    for (int k = 0; k < row->count; k++)
        if (row->shadows[k].wall == wall)
            return true;
    return false;
}

static bool is_in_shadow(const struct row *row, const struct facet *q)
{
    for (int k = 0; k < row->count; k++)
        if (shadow_holds_triangle(&row->shadows[k], &q->triangle))
            return true;
    return false;
}

static bool is_all_in_shadow(const struct row *row, const struct boxnode *node)
{
    for (int k = 0; k < row->count; k++)
        if (shadow_holds_box(&row->shadows[k], node->low, node->high))
            return true;
    return false;
}

/* True if the wall that a blocking triangle is part of hides all of q; then it is remembered. */
static bool find_shadow(struct row *row, int32_t blocker, const struct facet *q)
{
    struct linking *linking = row->linking;
    const struct walls *walls = octree_walls(linking->method->octree);
    int32_t wall = walls->of_triangle[blocker];
    struct shadow shadow;
    if (is_known(row, wall))
        return false;
    linking->method->counts.triangle_tests++;
    if (!shadow_make(&shadow, walls, wall, &linking->facets[row->place].triangle) ||
        !shadow_holds_triangle(&shadow, &q->triangle))
        return false;
    row->shadows[row->next] = shadow;
    row->next = (row->next + 1) % SHADOWS;
    row->count += row->count < SHADOWS;
    return true;
}

static void link_pair(struct row *row, int32_t place)
{
    struct linking *linking = row->linking;
    const struct facet *own = &linking->facets[row->place], *other = &linking->facets[place];
    int32_t p = linking->tree->roots[row->place], q = linking->tree->roots[place];
    struct sight sight = {.blocker = row->blocker};
    struct link link;
    linking->touched++;
    if (!facets_face(own, other) || is_in_shadow(row, other))
        return;
    bool made = p < q ? link_make(linking->method, p, own, q, other, 0.0, &sight, &link)
                      : link_make(linking->method, q, other, p, own, 0.0, &sight, &link);
    row->blocker = sight.blocker;
    bool hidden = made && link.seen == 0 && sight.blocker >= 0 &&
                  find_shadow(row, sight.blocker, other);
    if (made && !hidden)
        link_list_append(linking->links, link);
}

static bool is_sampled(int32_t row, int32_t place)
{
    return (place / BOX_ROOTS + row) % LINKING_SAMPLE == 0;
}

static void link_below(struct row *row, int32_t at)
{
    const struct boxnode *node = &row->linking->tree->nodes[at];
    int32_t first = node->first > row->first ? node->first : row->first;
    int32_t end = node->first + node->count < row->end ? node->first + node->count : row->end;
    if (first >= end)
        return;
    if (!boxnodes_may_face(&row->node, node) || is_all_in_shadow(row, node))
        return;
    if (boxnode_is_leaf(node)) {
        for (int32_t place = first; place < end; place++)
            if (is_sampled(row->place, place) == row->is_sample)
                link_pair(row, place);
    } else {
        link_below(row, node->children);
        link_below(row, node->children + 1);
    }
}

/* Links what `row` describes of the places from `first` on, around the end of the order. */
static void link_places(struct row *row, int32_t first, int32_t end)
{
    struct linking *linking = row->linking;
    int32_t n = linking->tree->root_count;
    row->node = boxnode_of_root(linking->method->scene, linking->tree->roots[row->place]);
    row->first = first;
    row->end = end < n ? end : n;
    link_below(row, 0);
    row->first = first < n ? 0 : first - n;
    row->end = end - n;
    link_below(row, 0);
}

/* Roots that the row of this place has. */
static int32_t length_of_row(const struct linking *linking, int32_t place)
{
    int32_t n = linking->tree->root_count;
    return n % 2 == 1 || place < n / 2 ? n / 2 : n / 2 - 1;
}

void linking_add_sample(struct linking *linking, int32_t place)
{
    struct row row = {.linking = linking, .place = place, .blocker = -1, .is_sample = true};
    link_places(&row, place + 1, place + 1 + length_of_row(linking, place));
}

void linking_add_part(struct linking *linking, int32_t place, int part, int parts)
{
    struct row row = {.linking = linking, .place = place, .blocker = -1};
    int64_t length = length_of_row(linking, place);
    link_places(&row, place + 1 + (int32_t)(length * part / parts),
                place + 1 + (int32_t)(length * (part + 1) / parts));
}
