/* Exact rows of the final gather.
 *
 * Where proofs show that nothing stands between a root and the roots that it faces, its
 * leaves need no rays: their rows are exact factors (noise 0). That is so in grooves,
 * between plates and in empty rooms, where the exact answers are.
 *
 * A sender over which B varies is taken in parts: its leaves, and quarters of leaves over
 * which B is linear.
 *
 * Rejected: exact factors to senders open to a leaf and rays for the rest. Proofs for all
 * pairs cost more than the rays saved. */
#include "rad/beyond/gather/exact.h"

#include <math.h>

#include "geom/alloc.h"
#include "rad/beyond/gather/covers.h"
#include "rad/beyond/gather/factor.h"
#include "rad/beyond/sample.h"

/* An exact row takes a sender as a whole if F times the range of B over the sender, times
 * the number of rays, is at most VARIES times the root of epsilon times the mean
 * radiosity. (A far one counts less: is_to_be_split().) So errors fall with this root, as
 * the mesh's. */
static const double VARIES = 10.0;

/* Most quarterings of a leaf. */
enum { QUARTERINGS = 3 };

/* An exact row whose sum is within CLOSED of 1 sees no way out. One within ALL_BUT may
 * see none: in an acute corner single points miss near faces. */
static const double CLOSED = 1e-3, ALL_BUT = 0.1;

/* The square of the size of a triangle over the distance to another. */
static double nearness(const struct triangle *to, const struct triangle *triangle)
{
    struct vec3 apart = vec3_sub(triangle_centroid(to), triangle_centroid(triangle));
    double radius = triangle_radius(triangle);
    return radius * radius / vec3_dot(apart, apart);
}

/* The mean place of a sender's light on the sender, in barycentric coordinates, by three
 * points: else the senders along a tube all err to the same side, and reflection after
 * reflection adds to the error. */
static void place_of_light(const struct facet *to, const struct triangle *sender,
                           struct vec3 normal, double w[3])
{
    const struct triangle at = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
    struct vec3 x[3], y[3], weights[3], sum = {0.0, 0.0, 0.0};
    double all = 0.0;
    triangle_three_points(&to->triangle, x);
    triangle_three_points(sender, y);
    triangle_three_points(&at, weights);
    for (int k = 0; k < 3; k++) {
        double light = 0.0;
        for (int i = 0; i < 3; i++)
            light += point_kernel(x[i], to->plane.normal, y[k], normal);
        sum = vec3_add(sum, vec3_scale(weights[k], light));
        all += light;
    }
    for (int k = 0; k < 3; k++)
        w[k] = all > 0.0 ? vec3_axis(sum, k) / all : 1.0 / 3.0;
}

/* True if a sender over which B varies by `range` is to be taken in parts. The kernel
 * varies over a sender by about the ratio of size to distance, and the part of this that
 * is not linear by the square of the ratio. That part is the error. */
static bool is_to_be_split(const struct receiver *r, const struct triangle *sender,
                           double factor, double range)
{
    const struct final_gather *g = r->gather;
    double near2 = fmin(1.0, nearness(&r->facet.triangle, sender));
    double varies = VARIES * sqrt(g->model->criterion.epsilon);
    return factor * range * near2 * g->rays >
           varies * g->lit[node_space(g->model, r->row->leaf)].mean;
}

/* A patch as a sender, or a part of a leaf. */
struct sender_part {
    int32_t patch;
    struct triangle triangle;
    struct vec3 normal;
    double centre[3]; /* barycentric coordinates in the patch */
    double size;      /* of its edges, those of the patch being 1; below 0 upside down */
    struct gather_slope slope; /* of B over the patch */
    triangle_factor *factor;   /* that is taken to it */
};

static struct sender_part part_child(const struct sender_part *part, int k)
{
    struct sender_part child = *part;
    child.triangle = triangle_child(&part->triangle, k);
    child.size = k == 3 ? -0.5 * part->size : 0.5 * part->size;
    for (int j = 0; j < 3 && k < 3; j++)
        child.centre[j] += child.size * ((j == k ? 1.0 : 0.0) - 1.0 / 3.0);
    return child;
}

static double factor_to(const struct receiver *r, const struct sender_part *part)
{
    return part->factor(&r->facet.triangle, r->facet.plane.normal, &part->triangle,
                        &r->gather->model->estimating);
}

/* Adds a part whose factor is known as a whole. */
static void add_whole(struct receiver *r, const struct sender_part *part, double factor)
{
    double w[3] = {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}, at[3];
    if (part->slope.rise != 0.0)
        place_of_light(&r->facet, &part->triangle, part->normal, w);
    for (int k = 0; k < 3; k++)
        at[k] = part->centre[k] + part->size * (w[k] - 1.0 / 3.0);
    struct rgb weight = rgb_grey(factor);
    receiver_add_point(r, part->patch, &part->slope, at, &weight);
}

/* Adds the exact factors to a part of a leaf, or to its quarters. */
static void add_part(struct receiver *r, const struct sender_part *part, double range,
                     double factor, int quarterings)
{
    if (quarterings == 0 || !is_to_be_split(r, &part->triangle, factor, range)) {
        add_whole(r, part, factor);
        return;
    }
    for (int k = 0; k < 4; k++) {
        struct sender_part child = part_child(part, k);
        double of_child = factor_to(r, &child);
        if (of_child > 0.0)
            add_part(r, &child, 0.5 * range, of_child, quarterings - 1);
    }
}

/* Adds the exact factor to a patch, or to its leaves where B varies. */
static void add_sender(struct receiver *r, int32_t patch, triangle_factor *by)
{
    const struct final_gather *g = r->gather;
    const struct forest *forest = g->model->forest;
    struct sender_part whole = {.patch = patch,
                                .triangle = forest_triangle(forest, patch),
                                .centre = {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0},
                                .size = 1.0,
                                .factor = by};
    double factor = factor_to(r, &whole);
    if (!(factor > 0.0))
        return;
    uint32_t root = forest->patches[patch].id.root;
    whole.normal = scene_root_plane(forest->scene, (int32_t)root).normal;
    whole.slope = slope_of(forest, g->cut, patch,
                           &g->lit[node_space(g->model, patch)].scale);
    if (patch_is_leaf(&forest->patches[patch])) {
        add_part(r, &whole, whole.slope.range, factor, QUARTERINGS);
    } else if (!is_to_be_split(r, &whole.triangle, factor,
                               (double)g->sums->ranges[patch])) {
        add_whole(r, &whole, factor);
    } else {
        for (int k = 0; k < 4; k++)
            add_sender(r, forest->patches[patch].children + k, by);
    }
}

static double sum_of_row(const struct gather_sums *sums)
{
    double sum = 0.0;
    for (int64_t i = 0; i < sums->count; i++)
        sum += sums->items[i].weight[0];
    return sum;
}

/* False if an exact row has an impossible sum, as where faces lie on each other, or is
 * inside of a thing. A row all but summing to 1 is made to do so. */
static bool close_row(struct receiver *r)
{
    const struct gather_sums *sums = r->gather->sums;
    double sum = sum_of_row(sums);
    bool partial = sum > 0.0 && sum < 1.0 - CLOSED;
    struct vec3 normal = r->facet.plane.normal, x = triangle_centroid(&r->facet.triangle);
    if (sum > 1.0 + CLOSED ||
        (partial && ray_comes_from_inside(r, point_above(x, normal), normal)))
        return false;
    r->gather->counts.exact++;
    r->row->cover.kept = sum < 1.0 - CLOSED ? (float)sum : 1.0f;
    r->gather->counts.escaped += partial;
    for (int64_t i = 0; i < sums->count && sum >= 1.0 - CLOSED; i++)
        for (int c = 0; c < BANDS; c++)
            sums->items[i].weight[c] /= sum;
    return true;
}

bool receiver_add_exact(struct receiver *r)
{
    struct final_gather *g = r->gather;
    const struct forest *forest = g->model->forest;
    uint32_t root = forest->patches[r->row->leaf].id.root;
    const struct gather_view *view = g->view;
    if (!view_is_open(g->view, (int32_t)root, true))
        return false;
    for (int turn = 0; turn < 2; turn++) {
        double off = fabs(sum_of_row(g->sums) - 1.0);
        if (turn > 0 && (off <= CLOSED || off > ALL_BUT))
            break;
        g->sums->count = 0;
        r->light = (struct rgb){{0.0, 0.0, 0.0}};
        for (int64_t i = 0; i < view->count; i++)
            add_sender(r, view->faced[i], turn > 0 ? near_factor : mean_factor);
    }
    return close_row(r);
}
