/* Light that surfaces in the dark reflect, right where an opening lets it in.
 *
 * Light that comes below a door or through a keyhole falls onto a strip or a spot of the
 * dark room, often a thousandth of a leaf or of the room. Few rays of the room's leaves
 * meet that leaf, so most of the light in the dark would be that of one or two rays; and
 * as the leaf's mean it would begin all over the leaf, where half of it, beside the door,
 * lights the door, and a part goes back through the gap.
 *
 * The points where the first light lands are known, for leaves in the dark aim at it
 * (gather_narrow.c, gather_spots.c). So that part of a leaf's radiosity is sent from
 * there: of all such points of a region a few are chosen, the sparks, and a
 * leaf r in the dark gets
 *
 *     H  =  1 / A_r  sum over sparks of  power F(spark, r) V
 *
 * with the exact factor from a point to a polygon, and one segment for V. To rays of such
 * leaves the leaf where it lands is as bright as without its first light. All know the
 * same sparks, so that, of each, all of its light arrives somewhere.
 *
 * A floor that goes on below the door has leaves that are lit at one end alone, below the
 * door and beside it. The dark room sees their dark ends, and with the mean of the leaf
 * a few rays made it up to 28 % too bright. So leaves of lit regions that are beside the
 * dark send sparks, too: where the light of their own rays lands, which find what is lit
 * often enough. */
#include "rad/beyond/gather_sparks.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/hash.h"
#include "geom/stop.h"
#include "rad/beyond/gather_narrow.h"
#include "rad/beyond/gather_regions.h"
#include "rad/beyond/met.h"
#include "rad/beyond/remainder.h"
#include "rad/beyond/sample.h"

/* Sparks of a region, and candidates; points of a region from which it is seen whether it
 * sees any of another one; quarterings of a leaf for the end of a segment. */
enum { SPARKS = 64, CANDIDATES = 1024, VIEWS = 8, QUARTERINGS = 3 };

/* A leaf is beside the dark if one so many levels above it has a dark leaf, or nearer. */
enum { BESIDE = 2 };

/* A spark is worth its power times the part of its light that goes into the dark, plus
 * this. */
static const double LEAST_SENT = 0.05;

/* Light that a leaf reflects, for its mean: `source` and terms, which begin where those
 * of the item before end. */
struct spark {
    struct vec3 at;
    int32_t region; /* that it is on */
    double power;      /* over all bands, W in square scene units */
    double area;       /* of the leaf, square scene units */
    struct rgb source; /* W/m^2 */
    int64_t end;
};

struct spark_list {
    struct spark *items; /* [count] */
    int64_t count, capacity;
    struct gather_term *terms;
    int64_t term_capacity;
};

struct sparks {
    struct spark_list chosen; /* of all regions */
    struct spark_list first;  /* all first light of a leaf in one */
    struct spark_list caught; /* of the region at hand */
    int32_t *number;          /* [patches] 1 + number in `first`; 0: none */
    int32_t from;             /* region that has been tested for; -1: none */
    uint8_t *seen;            /* [patches] 1: region that is seen from there */
    bool any;                 /* is seen from there */
};

/* --- lists --- */

static int64_t first_term(const struct spark_list *list, int64_t i)
{
    return i > 0 ? list->items[i - 1].end : 0;
}

static void add_spark(struct spark_list *list, struct spark spark)
{
    RESERVE(list->items, &list->capacity, list->count + 1);
    spark.end = first_term(list, list->count);
    list->items[list->count++] = spark;
}

/* Adds a term to the last spark. */
static void add_term(struct spark_list *list, int32_t place, const double *weight)
{
    int64_t at = list->items[list->count - 1].end++;
    RESERVE(list->terms, &list->term_capacity, at + 1);
    list->terms[at] = (struct gather_term){.place = place, .near = -1};
    for (int c = 0; c < BANDS; c++)
        list->terms[at].weight[c] = (float)weight[c];
}

static void list_free(struct spark_list *list)
{
    alloc_free(list->items);
    alloc_free(list->terms);
}

void sparks_free(struct sparks *sparks)
{
    if (!sparks)
        return;
    list_free(&sparks->chosen);
    list_free(&sparks->first);
    list_free(&sparks->caught);
    alloc_free(sparks->number);
    alloc_free(sparks->seen);
    alloc_free(sparks);
}

/* --- making them --- */

/* Adds the sums of the row at hand, from `first` on, as a spark of its leaf. */
static void add_sums(struct receiver *r, struct spark_list *list, int64_t first,
                     struct vec3 x, struct rgb source)
{
    const struct final_gather *g = r->gather;
    const struct forest *forest = g->model->forest;
    struct rgb rho = forest_material(forest, r->row.leaf)->reflectance;
    struct spark spark = {.at = x, .area = r->facet.area,
                          .region = region_of(r->gather, r->row.leaf)};
    for (int c = 0; c < BANDS; c++) {
        spark.source.band[c] = rho.band[c] * source.band[c];
        spark.power += r->facet.area * spark.source.band[c];
    }
    add_spark(list, spark);
    for (int64_t i = first; i < g->sums.count; i++) {
        const struct gather_sum *sum = &g->sums.items[i];
        const struct rgb *b = &forest->radiosity[g->order[sum->place]];
        double weight[BANDS];
        for (int c = 0; c < BANDS; c++) {
            weight[c] = rho.band[c] * sum->weight[c];
            list->items[list->count - 1].power += r->facet.area * weight[c] * b->band[c];
        }
        add_term(list, sum->place, weight);
    }
}

void receiver_catch(struct receiver *r, struct vec3 x, struct rgb source)
{
    struct gather_sums *sums = &r->gather->sums;
    if (!r->dark.catches)
        return;
    add_sums(r, &r->dark.catches->caught, sums->first, x, source);
    sums->first = sums->count;
}

/* Makes all sparks that have been caught of a leaf, from number `begin` on, one. */
static void add_up(struct sparks *sparks, struct receiver *r, int64_t begin)
{
    const struct spark_list *caught = &sparks->caught;
    struct gather_sums *sums = &r->gather->sums;
    struct rgb source = {{0.0, 0.0, 0.0}};
    sums->count = sums->first = 0;
    for (int64_t i = begin; i < caught->count; i++) {
        for (int c = 0; c < BANDS; c++)
            source.band[c] += caught->items[i].source.band[c];
        for (int64_t k = first_term(caught, i); k < caught->items[i].end; k++) {
            const struct gather_term *term = &caught->terms[k];
            struct rgb weight;
            for (int c = 0; c < BANDS; c++)
                weight.band[c] = (double)term->weight[c];
            receiver_add_patch(r, r->gather->order[term->place], &weight);
        }
    }
    if (caught->count == begin)
        return;
    add_spark(&sparks->first, (struct spark){.source = source});
    for (int64_t i = 0; i < sums->count; i++)
        add_term(&sparks->first, sums->items[i].place, sums->items[i].weight);
    sparks->number[r->row.leaf] = (int32_t)sparks->first.count;
}

/* Catches the first light of the leaves of a patch. */
static void catch_light(struct sparks *sparks, struct final_gather *g, int32_t patch)
{
    const struct patch *at = &g->model->forest->patches[patch];
    if (!patch_is_leaf(at)) {
        for (int k = 0; k < 4 && !stop_is_asked(); k++)
            catch_light(sparks, g, at->children + k);
        return;
    }
    struct receiver r = receiver_of_leaf(g, patch, g->rays);
    int64_t begin = sparks->caught.count;
    r.keeps = true;
    r.dark.catches = sparks;
    g->sums.count = g->sums.first = 0;
    receiver_find_openings(&r);
    if (!openings_are_known(g)) /* lamps alone may light it all over */
        return;
    receiver_aim_at(&r, &g->lamps);
    g->sums.first = g->sums.count;
    receiver_aim_through(&r);
    add_up(sparks, &r, begin);
}

/* Adds the light of a lamp at a point x of a leaf, and of one ray if it meets a lit
 * surface, times `weight`. */
static void add_light_at(struct receiver *r, struct vec3 x, const double *u,
                         const struct rgb *weight, uint64_t seed)
{
    const struct final_gather *g = r->gather;
    const struct forest *forest = g->model->forest;
    struct vec3 normal = r->facet.plane.normal, above = point_above(x, normal);
    struct point met;
    receiver_aim_beside(r, above, normal, r->row.leaf, weight, seed);
    if (trace(r, above, cosine_direction(normal, r->along, u[0], u[1]), &met) !=
            MET_FRONT ||
        patch_is_dark(g, met.patch))
        return;
    receiver_add_patch(r, met.patch, weight);
    int32_t root = (int32_t)forest->patches[met.patch].id.root;
    if (root_is_lamp(&g->lamps, root))
        receiver_add_source(r, weight, forest_material(forest, met.patch)->emission,
                            -1.0);
}

/* Catches the light of a leaf by its rays. */
static void catch_by_rays(struct sparks *sparks, struct final_gather *g, int32_t leaf)
{
    struct receiver r = receiver_of_leaf(g, leaf, g->rays);
    struct sequence sequence = sequence_start(hash_mix(r.seed + 71));
    int64_t begin = sparks->caught.count;
    double u[SEQUENCE_DIMENSIONS], share = 1.0 / r.rays;
    g->sums.count = g->sums.first = 0;
    r.keeps = true;
    r.dark.catches = sparks;
    for (int i = 0; i < r.rays; i++) {
        sequence_point(&sequence, (uint32_t)i, u);
        struct vec3 x = receiver_start(&r, u[2], u[3]);
        struct rgb source = r.row.source;
        add_light_at(&r, x, u, &(struct rgb){{share, share, share}},
                     hash_mix(sequence.scramble[0] + (uint64_t)i));
        receiver_catch(&r, x, rgb_sub(r.row.source, source));
    }
    add_up(sparks, &r, begin);
}

/* Catches the light of the leaves of a patch that are beside the dark; `near`: levels
 * that they may be below a patch with a dark leaf. */
static void catch_beside(struct sparks *sparks, struct final_gather *g, int32_t patch,
                         int near)
{
    const struct patch *at = &g->model->forest->patches[patch];
    if (patch_is_leaf(at)) {
        catch_by_rays(sparks, g, patch);
        return;
    }
    near = patch_has_dark(g, patch) ? BESIDE : near - 1;
    for (int k = 0; k < 4 && near > 0 && !stop_is_asked(); k++)
        catch_beside(sparks, g, at->children + k, near);
}

/* Chooses `wanted` sparks of a list by their worth, [list->count], and adds them to the
 * others, each with the part of light that it stands for. */
static void choose(const struct spark_list *list, const double *worth, int wanted,
                   double start, struct spark_list *chosen)
{
    double all = 0.0, sum = 0.0;
    for (int64_t i = 0; i < list->count; i++)
        all += worth[i];
    double each = all / wanted, next = each * start;
    for (int64_t i = 0; i < list->count && all > 0.0; i++) {
        struct spark spark = list->items[i];
        double part = 0.0;
        for (sum += worth[i]; next < sum; next += each)
            part += each / worth[i];
        if (!(part > 0.0))
            continue;
        spark.power *= part;
        for (int c = 0; c < BANDS; c++)
            spark.source.band[c] *= part;
        add_spark(chosen, spark);
        for (int64_t k = first_term(list, i); k < list->items[i].end; k++) {
            double weight[BANDS];
            for (int c = 0; c < BANDS; c++)
                weight[c] = part * (double)list->terms[k].weight[c];
            add_term(chosen, list->terms[k].place, weight);
        }
    }
}

/* Chooses from the sparks that have been caught: candidates by their power, and of these
 * by the light that they send into the dark, deep in a gap next to none. */
static void choose_sparks(struct sparks *sparks, struct final_gather *g, uint64_t seed)
{
    struct spark_list *caught = &sparks->caught, some = {0};
    double *worth = alloc_array((size_t)caught->count, sizeof *worth);
    for (int64_t i = 0; i < caught->count; i++)
        worth[i] = caught->items[i].power;
    choose(caught, worth, CANDIDATES, hash_unit(hash_mix(seed + 56)), &some);
    for (int64_t i = 0; i < some.count; i++) {
        const struct spark *spark = &some.items[i];
        double sent = share_in_the_dark(g, spark->region, spark->at,
                                        hash_mix(hash_mix(seed + 64) + (uint64_t)i));
        worth[i] = spark->power * (LEAST_SENT + sent);
    }
    choose(&some, worth, SPARKS, hash_unit(hash_mix(seed + 57)), &sparks->chosen);
    list_free(&some);
    alloc_free(worth);
    caught->count = 0;
}

/* Each rank finds the same, so their work is counted apart. */
void gather_find_sparks(struct final_gather *g)
{
    if (g->view.sparks)
        return;
    const struct forest *forest = g->model->forest;
    const struct regions *regions = gather_regions(g);
    struct sparks *sparks = alloc_array(1, sizeof *sparks);
    g->view.sparks = sparks;
    sparks->number = alloc_array((size_t)forest->count, sizeof *sparks->number);
    sparks->seen = alloc_array((size_t)forest->count, 1);
    sparks->from = -1;
    struct apart apart = apart_begin(g);
    bool any = false;
    for (int64_t i = 0; i < regions->count; i++)
        any = any || region_is_dark(g, regions->items[i]);
    for (int64_t i = 0; i < regions->count && any && !stop_is_asked(); i++) {
        int32_t region = regions->items[i];
        if (region_is_dark(g, region))
            catch_light(sparks, g, region);
        else if (!patch_is_dark(g, region) && patch_has_dark(g, region))
            catch_beside(sparks, g, region, BESIDE);
        choose_sparks(sparks, g, patch_seed(forest, region));
    }
    apart_end(g, &apart);
}

/* --- their light --- */

/* True if a leaf gets light of the spark, from there to a point x of it; `factor`: from
 * the spark to the leaf. */
static bool reaches(struct receiver *r, const struct spark *spark,
                    struct remainder *leaf, const double *u, double *factor)
{
    const struct forest *forest = r->gather->model->forest;
    int32_t root = (int32_t)forest->patches[spark->region].id.root;
    struct vec3 normal = scene_root_plane(forest->scene, root).normal;
    if (!(plane_distance(&r->facet.plane, spark->at) > 0.0))
        return false;
    *factor = remainder_look(leaf, forest->scene, spark->at, normal);
    r->gather->model->estimating++;
    if (!(*factor > 0.0))
        return false;
    struct vec3 x = remainder_point(leaf, QUARTERINGS, u[2], u[3], NULL);
    return receiver_kernel(x, r->facet.plane.normal, spark->at, normal) > 0.0 &&
           receiver_blocker(r, x, spark->at, root) < 0;
}

/* Finds the regions with sparks of which a region sees any. */
static void find_seen(struct sparks *sparks, const struct receiver *r, int32_t from)
{
    struct final_gather *g = r->gather;
    const struct forest *forest = g->model->forest;
    struct receiver whole = *r;
    struct apart apart = apart_begin(g);
    double u[SEQUENCE_DIMENSIONS], factor;
    whole.facet = facet_make(forest, from);
    struct remainder all = remainder_start(forest, from);
    struct sequence sequence = sequence_start(hash_mix(patch_seed(forest, from) + 57));
    sparks->from = from;
    sparks->any = false;
    for (int64_t i = 0; i < sparks->chosen.count; i++)
        sparks->seen[sparks->chosen.items[i].region] = 0;
    for (int64_t i = 0; i < sparks->chosen.count; i++) {
        const struct spark *spark = &sparks->chosen.items[i];
        for (uint32_t k = 0; k < VIEWS && !sparks->seen[spark->region]; k++) {
            sequence_point(&sequence, VIEWS * (uint32_t)i + k, u);
            sparks->seen[spark->region] = reaches(&whole, spark, &all, u, &factor);
        }
        sparks->any = sparks->any || sparks->seen[spark->region];
    }
    apart_end(g, &apart);
}

void receiver_find_sparks(struct receiver *r)
{
    struct final_gather *g = r->gather;
    int32_t from = region_of(g, r->row.leaf);
    if (!(r->dark.least >= 0.0))
        return;
    if (g->view.sparks->from != from)
        find_seen(g->view.sparks, r, from);
    if (!g->view.sparks->any)
        return;
    r->dark.sparks = g->view.sparks;
    if (region_is_dark(g, from) && r->rays < g->rays)
        r->rays = g->rays;
}

/* Adds `weight` times the light of a spark. */
static void add_light(struct receiver *r, const struct spark_list *list, int64_t i,
                      double weight)
{
    const struct spark *spark = &list->items[i];
    struct rgb all = {{weight, weight, weight}}, part;
    receiver_add_source(r, &all, spark->source, 1.0);
    for (int64_t k = first_term(list, i); k < spark->end; k++) {
        for (int c = 0; c < BANDS; c++)
            part.band[c] = weight * (double)list->terms[k].weight[c];
        receiver_add_patch(r, r->gather->order[list->terms[k].place], &part);
    }
}

/* True if the receiver gets light of the sparks of a region. Not in a gap that is narrow
 * for it: how bright the region is there is told by paths, and not by the mean. */
static bool gets_sparks(const struct receiver *r, int32_t region)
{
    const struct forest *forest = r->gather->model->forest;
    int32_t root = (int32_t)forest->patches[region].id.root;
    struct plane plane = scene_root_plane(forest->scene, root);
    double width = plane_distance(&plane, triangle_centroid(&r->facet.triangle));
    return r->dark.sparks->seen[region] &&
           !gap_is_narrow(r->facet.plane.normal, plane.normal, width, r->facet.area);
}

void receiver_add_sparks(struct receiver *r)
{
    if (!r->dark.sparks)
        return;
    const struct sparks *sparks = r->dark.sparks;
    const struct spark_list *list = &sparks->chosen;
    struct remainder leaf = remainder_start(r->gather->model->forest, r->row.leaf);
    struct sequence sequence = sequence_start(hash_mix(r->seed + 56));
    struct rgb first = r->light, last = first;
    double u[SEQUENCE_DIMENSIONS], factor;
    int count = 0;
    for (int64_t i = 0; i < list->count; i++) {
        const struct spark *spark = &list->items[i];
        if (!gets_sparks(r, spark->region) || receiver_aims_through(r, spark->region))
            continue;
        sequence_point(&sequence, (uint32_t)count++, u);
        if (reaches(r, spark, &leaf, u, &factor))
            add_light(r, list, i, factor * spark->area / r->facet.area);
        for (int c = 0; c < BANDS; c++) {
            double h = r->light.band[c] - last.band[c];
            r->row.chance[c] += h * h;
        }
        last = r->light;
    }
    for (int c = 0; c < BANDS && count > 0; c++) {
        double all = last.band[c] - first.band[c];
        r->row.chance[c] = fmax(0.0, r->row.chance[c] - all * all / count);
    }
}

bool leaf_has_sparks(const struct final_gather *g, int32_t leaf)
{
    return g->view.sparks && g->view.sparks->number[leaf] > 0;
}

bool receiver_sees_sparks(const struct receiver *r, int32_t patch)
{
    return r->dark.sparks && r->dark.sparks->number[patch] > 0 &&
           gets_sparks(r, region_of(r->gather, patch));
}

void receiver_leave_out_sparks(struct receiver *r, int32_t patch, double weight)
{
    add_light(r, &r->dark.sparks->first, r->dark.sparks->number[patch] - 1, -weight);
}
