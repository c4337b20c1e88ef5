/* Initial linking.
 *
 * What is asked of each pair of roots: do they face each other, is a wall between them, and how
 * much do they exchange? Asked one by one that is quadratic in the number of roots, and most of
 * them exchange next to nothing: in furnished rooms the median pair has 1e-5 of the power for
 * which one segment is enough. No pair is dropped for that, since many together carry much light.
 * But a row goes down the tree of boxes, and whole groups are treated at once:
 *
 *  - those that the root cannot face (rad/boxtree.c), or that lie in a shadow, are left out. The
 *    last few shadows in which something was found are remembered: to a book on a shelf, its two
 *    neighbours hide most of the room. New ones come from segments that are all blocked: the
 *    triangle that blocked last is part of a wall, which may hide all of the partner, and then
 *    what comes next in the tree.
 *
 *  - where there is little power at stake between the root and all of a group together, four
 *    segments decide for all, each for a quarter of that power. They lead from the four children
 *    of the root to four roots of the group. How much would be exchanged is still estimated for
 *    each pair; those too near for one disk to tell, which see more of the root than others do,
 *    have a segment of their own. (If they were trusted to be hidden where all four segments of
 *    the group are blocked, rows of form factors would lose a tenth of their sum. With four
 *    segments of their own in place of one, no error is smaller, for a fifth more time.)
 *
 * Of n roots, row i has the next n / 2 in the order of the tree, around its end, so all rows are
 * equally long. What they take differs thirtyfold, by how large the root is and where it lies. So
 * each row is begun with a sample, every sixteenth block of the tree: what that takes, and how
 * large the root is, tell what the rest will take.
 *
 * The rest can be linked in parts, and what takes too long stops at any root. No group is larger than a
 * block, and what is seen of a group depends on nothing else: so neither on ranks nor on parts.
 *
 * Tried and left out: groups in place of the one root (four roots are seldom hidden by one wall:
 * half as many pairs were proved, for more work), bundles of 16 segments between four roots and
 * four others (each is blocked by something else: three times the triangle tests). */
#include "rad/linking.h"

#include "geom/alloc.h"
#include "rad/oracle.h"

static struct rgb rgb_most(struct rgb a, struct rgb b)
{
    for (int c = 0; c < BANDS; c++)
        a.band[c] = real_max(a.band[c], b.band[c]);
    return a;
}

static struct brightness brightness_of_root(const struct linking *linking, int32_t root)
{
    const struct forest *forest = linking->method->forest;
    return (struct brightness){forest->patches[root].radiosity,
                               forest_material(forest, root)->reflectance};
}

/* Of a leaf's own roots, or of both children. Pre: that of the children is known. */
static struct brightness brightness_of(const struct linking *linking, const struct boxnode *node)
{
    struct brightness most = {{{0.0, 0.0, 0.0}}, {{0.0, 0.0, 0.0}}};
    bool is_leaf = boxnode_is_leaf(node);
    int32_t first = is_leaf ? node->first : node->children, count = is_leaf ? node->count : 2;
    for (int32_t i = first; i < first + count; i++) {
        struct brightness one = is_leaf ? brightness_of_root(linking, linking->tree->roots[i])
                                        : linking->brightest[i];
        most.radiosity = rgb_most(most.radiosity, one.radiosity);
        most.reflectance = rgb_most(most.reflectance, one.reflectance);
    }
    return most;
}

static struct spot spot_of(const struct facet *facet, bool is_dark)
{
    struct spot spot = {.centre = triangle_centroid(&facet->triangle), .normal = facet->plane.normal,
                        .area = facet->area, .radius = triangle_radius(&facet->triangle),
                        .is_dark = is_dark};
    subarea_centroids(&facet->triangle, spot.points);
    return spot;
}

struct linking linking_start(struct method *method, struct link_list *links)
{
    struct linking linking = {.method = method, .links = links,
                              .tree = boxtree_create(method->scene)};
    int32_t count = linking.tree->root_count, nodes = linking.tree->node_count;
    linking.facets = alloc_array((size_t)count, sizeof *linking.facets);
    linking.spots = alloc_array((size_t)count, sizeof *linking.spots);
    linking.brightest = alloc_array((size_t)nodes, sizeof *linking.brightest);
    for (int32_t i = 0; i < count; i++) {
        int32_t root = linking.tree->roots[i];
        linking.facets[i] = facet_make(method->forest, root);
        linking.spots[i] = spot_of(&linking.facets[i],
                                   material_is_dark(forest_material(method->forest, root)));
    }
    for (int32_t at = nodes - 1; at >= 0; at--) /* children come after their parent */
        linking.brightest[at] = brightness_of(&linking, &linking.tree->nodes[at]);
    return linking;
}

void linking_end(struct linking *linking)
{
    boxtree_destroy(linking->tree);
    alloc_free(linking->facets);
    alloc_free(linking->spots);
    alloc_free(linking->brightest);
    *linking = (struct linking){0};
}

/* Shadows that a row remembers: with 8 in place of 4 a tenth less is left, with 16 hardly less. */
enum { SHADOWS = 8 };

struct row {
    struct linking *linking;
    int32_t place;       /* of the root p, in the order of the tree */
    bool is_sample;      /* the sample of the row, or the rest */
    int32_t first, end;  /* places of the roots to pair it with */
    int64_t limit;       /* of the method's work: when it is passed, `end` is where the row stands */
    struct boxnode node; /* of p alone */
    struct brightness brightness;
    int32_t blocker;     /* the last */
    struct shadow shadows[SHADOWS]; /* as seen from p */
    int count, next;     /* shadows there are; the oldest */
    int64_t sampled, work, left; /* of a sample: roots of its blocks, work on them; other roots */
};

static bool is_in_row(const struct row *row, int32_t place)
{
    return place >= row->first && place < row->end;
}

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

/* True if the wall that a blocking triangle is part of hides all of one of the roots; then it is
 * remembered. */
static bool find_shadow(struct row *row, int32_t blocker, const int32_t *places, int count)
{
    struct linking *linking = row->linking;
    const struct walls *walls = octree_walls(linking->method->octree);
    int32_t wall = blocker >= 0 ? walls->of_triangle[blocker] : -1;
    struct shadow shadow;
    if (wall < 0 || is_known(row, wall))
        return false;
    linking->method->counts.triangle_tests++;
    bool found = false, made = shadow_make(&shadow, walls, wall,
                                           &linking->facets[row->place].triangle);
    for (int k = 0; k < count && made && !found; k++)
        found = shadow_holds_triangle(&shadow, &linking->facets[places[k]].triangle);
    if (!found)
        return false;
    row->shadows[row->next] = shadow;
    row->next = (row->next + 1) % SHADOWS;
    row->count += row->count < SHADOWS;
    return true;
}

/* --- one pair --- */

static void link_pair(struct row *row, int32_t place)
{
    struct linking *linking = row->linking;
    const struct facet *own = &linking->facets[row->place], *other = &linking->facets[place];
    int32_t p = linking->tree->roots[row->place], q = linking->tree->roots[place];
    struct sight sight = {.blocker = row->blocker};
    struct link link;
    linking->touched++;
    if (is_in_shadow(row, other))
        return;
    bool made = p < q ? link_make(linking->method, p, own, q, other, 0.0, &sight, &link)
                      : link_make(linking->method, q, other, p, own, 0.0, &sight, &link);
    row->blocker = sight.blocker;
    bool hidden = made && link.seen == 0 && find_shadow(row, sight.blocker, &place, 1);
    if (made && !hidden)
        link_list_append(linking->links, link);
}

/* --- a group --- */

/* A root that the row's root sees but for blockers. */
struct sighting {
    int32_t place;
    int quarter;        /* of its group */
    bool is_far;        /* far enough away for one disk to tell what it exchanges */
    double unoccluded;  /* what that is, or about what */
};

/* Roots that are looked at together, in four quarters that would exchange equally much. */
struct group {
    struct sighting *sightings; /* [count] */
    double sum;                 /* of what they would exchange */
    int count;
};

/* Says in which quarter each is. chosen[k]: place of the root in the middle of quarter k. */
static void quarter_group(const struct group *group, int32_t chosen[BUNDLE_ENDS])
{
    double before = 0.0;
    int next = 0;
    for (int i = 0; i < group->count; i++) {
        struct sighting *sighting = &group->sightings[i];
        double middle = BUNDLE_ENDS * (before + 0.5 * sighting->unoccluded) / group->sum;
        sighting->quarter = middle < BUNDLE_ENDS ? (int)middle : BUNDLE_ENDS - 1;
        before += sighting->unoccluded;
        while (next < BUNDLE_ENDS && (BUNDLE_ENDS * before >= (next + 0.5) * group->sum ||
                                      i == group->count - 1))
            chosen[next++] = sighting->place;
    }
}

/* True if the segment from a child of the row's root to one of another is blocked. */
static bool is_blocked(struct row *row, int own_child, int32_t place, int child,
                       struct octree_counts *work)
{
    struct linking *linking = row->linking;
    const int32_t own[2] = {linking->facets[row->place].input, linking->facets[place].input};
    struct octree_counts counts = {0};
    bool blocked = octree_blocks_segment(
        linking->method->octree, linking->spots[row->place].points[own_child],
        linking->spots[place].points[child], own, &row->blocker, &counts);
    octree_counts_add(work, &counts);
    octree_counts_add(&linking->method->counts, &counts);
    linking->method->rays_spared -= counts.rays;
    return blocked;
}

/* The children of one root that are above the horizon of another. Returns how many. */
static int children_above(const struct facet *horizon, const struct spot *spot,
                          int above[BUNDLE_ENDS])
{
    int count = 0;
    for (int k = 0; k < BUNDLE_ENDS; k++)
        if (plane_distance(&horizon->plane, spot->points[k]) > 0.0)
            above[count++] = k;
    return count;
}

/* With little at stake: all that would be exchanged without blockers, or nothing. */
static void link_little(struct row *row, int32_t place, double unoccluded, bool seen, double cost)
{
    struct linking *linking = row->linking;
    int32_t p = linking->tree->roots[row->place], q = linking->tree->roots[place];
    linking->touched++;
    linking->method->estimating++;
    linking->method->rays_spared += BUNDLE_RAYS;
    if (!seen && is_in_shadow(row, &linking->facets[place]))
        return;
    link_list_append(linking->links, link_make_little(p < q ? p : q, p < q ? q : p, unoccluded, seen,
                                                      row->blocker, cost));
}

static double tests_of(const struct octree_counts *work)
{
    return (double)(work->node_tests + work->triangle_tests);
}

/* A pair of which a disk does not tell what it exchanges: a segment of its own, and points. The segment
 * leads from one of the children that can see the other root to one of the other's, which take turns
 * from pair to pair: so what is seen is right on the average. Where there is no such child, with the
 * centroid above the other's horizon, nothing is seen, as by all 16 segments. */
static void link_near(struct row *row, const struct sighting *sighting)
{
    struct linking *linking = row->linking;
    const int32_t place = sighting->place;
    const struct facet *p = &linking->facets[row->place], *q = &linking->facets[place];
    struct octree_counts work = {0};
    int from[BUNDLE_ENDS], to[BUNDLE_ENDS];
    int own = children_above(q, &linking->spots[row->place], from);
    int others = children_above(p, &linking->spots[place], to);
    double exact = 0.0;
    if (own > 0 && others > 0) {
        if (is_blocked(row, from[place % own], place, to[row->place % others], &work)) {
            find_shadow(row, row->blocker, &place, 1);
        } else {
            exact = exchange_from_points(p, q);
            linking->method->estimating += TESTS_PER_FORM_FACTOR / 2;
        }
    }
    link_little(row, place, exact > 0.0 ? exact : sighting->unoccluded, exact > 0.0,
                tests_of(&work));
}

/* Links the root with those of the group that are in its row. Those of which a disk does not tell what
 * they exchange see more of it than others: they are looked at by themselves. */
static void link_group(struct row *row, const struct group *group)
{
    struct linking *linking = row->linking;
    struct octree_counts work = {0};
    int32_t chosen[BUNDLE_ENDS];
    bool hidden[BUNDLE_ENDS], all_hidden = true;
    int mine = 0;
    for (int i = 0; i < group->count; i++)
        mine += is_in_row(row, group->sightings[i].place);
    if (mine == 0)
        return;
    quarter_group(group, chosen);
    for (int k = 0; k < BUNDLE_ENDS; k++) {
        const struct facet *p = &linking->facets[row->place], *q = &linking->facets[chosen[k]];
        bool facing = plane_distance(&p->plane, linking->spots[chosen[k]].points[k]) > 0.0 &&
                      plane_distance(&q->plane, linking->spots[row->place].points[k]) > 0.0;
        hidden[k] = facing && is_blocked(row, k, chosen[k], k, &work);
        all_hidden = all_hidden && hidden[k];
    }
    if (all_hidden)
        find_shadow(row, row->blocker, chosen, BUNDLE_ENDS);
    for (int i = 0; i < group->count; i++) {
        const struct sighting *sighting = &group->sightings[i];
        if (!is_in_row(row, sighting->place))
            continue;
        if (sighting->is_far)
            link_little(row, sighting->place, sighting->unoccluded,
                        !hidden[sighting->quarter], tests_of(&work) / group->count);
        else
            link_near(row, sighting);
    }
}

/* --- a block --- */

/* What the row's root would see of a block without blockers. Returns the number of sightings. */
static int look_at_block(const struct row *row, const struct boxnode *block,
                         struct sighting sightings[BLOCK_MAX])
{
    const struct linking *linking = row->linking;
    const struct spot *own = &linking->spots[row->place];
    int count = 0;
    linking->method->estimating += block->count;
    for (int32_t place = block->first; place < block->first + block->count; place++) {
        const struct spot *other = &linking->spots[place];
        const struct facet *p = &linking->facets[row->place], *q = &linking->facets[place];
        struct vec3 d = vec3_sub(other->centre, own->centre);
        bool centres_face = vec3_dot(own->normal, d) > GEOM_ROUNDING &&
                            vec3_dot(other->normal, d) < -GEOM_ROUNDING;
        if ((own->is_dark && other->is_dark) || !(centres_face || facets_face(p, q)))
            continue;
        sightings[count++] = (struct sighting){
            .place = place,
            .is_far = centres_face && radii_are_apart(own->radius, other->radius, vec3_length(d)),
            .unoccluded = centres_face ? disk_exchange(own->centre, own->normal, own->area,
                                                       other->centre, other->normal, other->area)
                                       : exchange_across_horizon(p, q),
        };
    }
    return count;
}

/* What comes after this place is left for later if the row has had its share of work. */
static void stop_at_limit(struct row *row, int32_t place)
{
    if (is_in_row(row, place) && method_work(row->linking->method) >= row->limit)
        row->end = place + 1;
}

/* Links the root with what it sees of a node, `sightings`: all at once if so little is at stake. */
static void link_in_block(struct row *row, int32_t at, struct sighting *sightings, int count)
{
    struct linking *linking = row->linking;
    const struct boxnode *node = &linking->tree->nodes[at];
    const struct brightness *own = &row->brightness, *most = &linking->brightest[at];
    struct group group = {.sightings = sightings, .count = count};
    for (int i = 0; i < count; i++)
        group.sum += sightings[i].unoccluded;
    double light = oracle_light(linking->method, own->radiosity, own->reflectance, most->radiosity,
                                most->reflectance);
    if (count > 1 && oracle_trusts_few(linking->method, group.sum * light)) {
        link_group(row, &group);
        stop_at_limit(row, sightings[count - 1].place);
    } else if (boxnode_is_leaf(node)) {
        for (int i = 0; i < count; i++)
            if (is_in_row(row, sightings[i].place)) {
                link_pair(row, sightings[i].place);
                stop_at_limit(row, sightings[i].place);
            }
    } else if (count > 0) {
        int32_t middle = linking->tree->nodes[node->children + 1].first;
        int left = 0;
        while (left < count && sightings[left].place < middle)
            left++;
        link_in_block(row, node->children, sightings, left);
        link_in_block(row, node->children + 1, sightings + left, count - left);
    }
}

/* --- a row --- */

static bool is_sampled(int32_t row, int32_t block)
{
    return (block + row) % LINKING_SAMPLE == 0;
}

static void link_block(struct row *row, int32_t at)
{
    struct method *method = row->linking->method;
    const struct boxnode *block = &row->linking->tree->nodes[at];
    struct sighting sightings[BLOCK_MAX];
    int64_t before = method_work(method);
    link_in_block(row, at, sightings, look_at_block(row, block, sightings));
    row->sampled += block->count;
    row->work += method_work(method) - before;
}

static void link_below(struct row *row, int32_t at)
{
    const struct boxnode *node = &row->linking->tree->nodes[at];
    bool is_block = node->block >= 0;
    bool is_due = !is_block || is_sampled(row->place, node->block) == row->is_sample;
    if (node->first >= row->end || node->first + node->count <= row->first ||
        !(is_due || row->is_sample))
        return;
    row->linking->method->estimating++;
    if (!boxnodes_may_face(&row->node, node) || is_all_in_shadow(row, node))
        return;
    if (!is_due) {
        row->left += node->count;
    } else if (is_block) {
        link_block(row, at);
    } else {
        link_below(row, node->children);
        link_below(row, node->children + 1);
    }
}

/* Links what `row` describes of the places from `first` on, around the end of the order. Returns where
 * it stops, `end` or before. */
static int32_t link_places(struct row *row, int32_t first, int32_t end)
{
    struct linking *linking = row->linking;
    int32_t n = linking->tree->root_count, middle = end < n ? end : n;
    int32_t root = linking->tree->roots[row->place];
    row->node = boxnode_of_root(linking->method->scene, root);
    row->brightness = brightness_of_root(linking, root);
    row->first = first;
    row->end = middle;
    link_below(row, 0);
    if (row->end < middle || end <= n)
        return row->end;
    row->first = first < n ? 0 : first - n;
    row->end = end - n;
    link_below(row, 0);
    return row->end + n;
}

/* Work for each root of a block as it usually is: a large root is near to many, which it is
 * paired with one by one. It counts as much as a sample of so many roots. (From furnished rooms;
 * with it, what is expected and what is found have a correlation of 0.93, without it, of 0.91;
 * by the sample's work alone, of 0.87.) */
static const double WORK_LEAST = 4.0, WORK_LARGE = 1400.0, USUAL_ROOTS = 64.0;

static double usual_work(const struct linking *linking, int32_t place)
{
    double radius = linking->spots[place].radius;
    return WORK_LEAST + WORK_LARGE * radius * radius;
}

int64_t linking_sample_cost(const struct linking *linking, int32_t place)
{
    int32_t length = linking_row_length(linking->tree->root_count, place);
    return (int64_t)(usual_work(linking, place) * length / LINKING_SAMPLE);
}

/* What the rest of a row is expected to take, by its sample up to root number `stop`. */
static int64_t expected_rest(const struct row *row, int32_t stop, int32_t to)
{
    double each = ((double)row->work + USUAL_ROOTS * usual_work(row->linking, row->place)) /
                  ((double)row->sampled + USUAL_ROOTS);
    return stop > 0 ? (int64_t)((double)row->left * each * (double)to / (double)stop) : 0;
}

int32_t linking_add_sample(struct linking *linking, int32_t place, int32_t from, int32_t to,
                           int64_t limit, int64_t *rest)
{
    struct row row = {.linking = linking, .place = place, .blocker = -1, .is_sample = true,
                      .limit = method_work(linking->method) + limit};
    int32_t stop = link_places(&row, place + 1 + from, place + 1 + to) - (place + 1);
    if (rest)
        *rest = expected_rest(&row, stop, to);
    return stop;
}

int32_t linking_add_part(struct linking *linking, int32_t place, int32_t from, int32_t to,
                         int64_t limit)
{
    struct row row = {.linking = linking, .place = place, .blocker = -1,
                      .limit = method_work(linking->method) + limit};
    return link_places(&row, place + 1 + from, place + 1 + to) - (place + 1);
}
