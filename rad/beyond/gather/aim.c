/* Aiming at senders, from a receiver of the final gather.
 *
 * Segments are dealt to the nodes of the cut of the receiver's region (cuts.h): half by
 * the light of nodes with nothing in the way, half by the part of this light seen from
 * the region. So a lamp behind a wall, however bright, leaves some segments for lamps in
 * the room, and a segment to a node not seen from the region counts at most twice. In the
 * first half the light of another space counts as no brighter than that of this one. As
 * long as no segment has found any of it, missing it leaves no doubt. Let F be the exact
 * factor of a sender. Each segment to it has the kernel K between its ends, and V = 1 if
 * it arrives, 0 if something blocks it. The sender brings
 *
 *     F  sum of V K / sum of K  times its light:
 *
 * exactly F where all of the sender is seen, and 0 where nothing is. Of a bright patch
 * far away F is the mean of K times its area. Of a node with several senders each segment
 * chooses one by its power.
 *
 * Rays meeting a lamp count its reflected light and not its emission. A ray meeting a
 * bright patch aimed at is put aside (rays.c). */
#include "rad/beyond/gather/aim.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/hash.h"
#include "geom/lambert.h"
#include "rad/beyond/gather/factor.h"
#include "rad/beyond/gather/path.h"
#include "rad/beyond/sample.h"
#include "rad/beyond/sequence.h"

/* A sender is near a receiver if the distance of their centres is at most so many times
 * the sum of their radii. */
static const double NEARBY = 2.0;

/* Fewest segments for an estimate of the visible share of senders. */
enum { VOLLEY = 4 };

/* Segments to neighbouring nodes of the cut, in two halves. Of a node that is a single
 * sender and has segments of its own the light without blockers is known. A draw, be it
 * of a faint node among others or of one of a node's senders, has the expected light in
 * the mean alone: its scatter around that is noise even where nothing is in the way. */
struct volley {
    bool drawn;       /* the segments are draws */
    struct rgb light; /* of one of its senders, W/m^2 */
    double direct[2]; /* light without blockers, known or expected, over all bands,
                         W/m^2 */
    double seen[2];   /* light with blockers */
    int count[2];     /* segments */
    double direct2, seen2, both; /* sums over segments of `direct` and `seen` squared, and
                                    of their product */
};

/* Adds segment `i` of `count` to a node: to its half; a single one, to the smaller. */
static void add_segment(struct volley *volley, int i, int count, double direct,
                        double seen)
{
    int half = count > 1 ? 2 * i >= count : volley->count[0] > volley->count[1];
    volley->direct[half] += direct;
    volley->seen[half] += seen;
    volley->count[half]++;
    volley->direct2 += direct * direct;
    volley->seen2 += seen * seen;
    volley->both += direct * seen;
}

static int segments_of(const struct volley *volley)
{
    return volley->count[0] + volley->count[1];
}

/* Adds the variance of the volley's light to the row, twice: as by chance, from the
 * scatter of single segments around the mean visible share, which for one draw alone is
 * 1; and by the difference of the two halves. Both have the colour of one sender of the
 * volley. */
static void end_volley(struct receiver *r, struct volley *volley)
{
    double direct = volley->direct[0] + volley->direct[1], apart = 0.0;
    double share = direct > 0.0 ? (volley->seen[0] + volley->seen[1]) / direct : 0.0;
    int count = segments_of(volley);
    if (volley->drawn && count == 1 && share > 0.0)
        share = 1.0;
    double variance =
        volley->seen2 + share * (share * volley->direct2 - 2.0 * volley->both);
    if (volley->drawn && count > 1)
        variance *= count / (count - 1.0);
    if (volley->direct[0] > 0.0 && volley->direct[1] > 0.0)
        apart = 0.5 * (volley->seen[0] / volley->direct[0] -
                       volley->seen[1] / volley->direct[1]);
    for (int c = 0; c < BANDS && share > 0.0; c++) {
        double part = volley->light.band[c] / rgb_sum(volley->light), h = direct * part;
        r->row->chance.band[c] += part * part * fmax(0.0, variance);
        r->row->halves.band[c] += h * h * apart * apart;
    }
    *volley = (struct volley){.drawn = volley->drawn};
}

/* The senders aimed at, and the segments to a node of their cut. */
struct aim {
    const struct senders *senders;
    struct sequence sequence; /* of the node */
    int index;                /* in the sequence, of the next segment */
    int64_t fired, arrived;   /* segments so far, to all nodes */
    double direct;            /* their light without blockers, over all bands, W/m^2 */
    double expected;          /* of the next segments, if they are draws, each; or -1 */
    struct volley volleys[2]; /* of known senders, and of draws */
};

static struct shot shot_at(const struct receiver *r, const struct aim *aim,
                           const struct facet *sender, int index)
{
    double u[SEQUENCE_DIMENSIONS];
    sequence_point(&aim->sequence, (uint32_t)index, u);
    struct shot shot = {receiver_start(r, u[0], u[1]),
                        triangle_of_square(&sender->triangle, u[2], u[3]), 0.0};
    shot.kernel =
        point_kernel(shot.x, r->facet.plane.normal, shot.y, sender->plane.normal);
    return shot;
}

/* A shot found from the sender: in a direction by the cosine there, if this meets the
 * receiver. Where a small sender is near, most of its light arrives at a small part of
 * the receiver, and points all over it would seldom be there. */
static struct shot shot_back(const struct receiver *r, const struct aim *aim,
                             const struct facet *sender, int index)
{
    double u[SEQUENCE_DIMENSIONS], w[3];
    struct vec3 normal = sender->plane.normal;
    sequence_point(&aim->sequence, (uint32_t)index, u);
    struct vec3 d = cosine_direction(normal, direction_along(normal), u[0], u[1]);
    struct shot shot = {.y = triangle_of_square(&sender->triangle, u[2], u[3])};
    double along = plane_ahead(&r->facet.plane, shot.y, d);
    shot.x = vec3_add(shot.y, vec3_scale(d, along));
    triangle_weights(&r->facet.triangle, shot.x, w);
    bool front = along > 0.0 && vec3_dot(r->facet.plane.normal, d) < 0.0;
    if (front && w[0] > 0.0 && w[1] > 0.0 && w[2] > 0.0)
        shot.kernel = 1.0;
    return shot;
}

/* Adds the light of a sender by a shot with this form factor. Returns the light added,
 * over all bands, W/m^2. */
static double add_shot(struct receiver *r, struct aim *aim, const struct shot *shot,
                       int32_t patch, double factor, uint64_t seed)
{
    const struct forest *forest = r->gather->model->forest;
    int32_t root = (int32_t)forest->patches[patch].id.root;
    double before = rgb_sum(r->light);
    aim->fired++;
    if (receiver_is_blocked(r, shot->x, shot->y, root))
        return 0.0;
    receiver_see(r, aim->senders, shot->x, shot->y, patch, factor, seed);
    double light = rgb_sum(r->light) - before;
    aim->arrived += light > 0.0;
    return light;
}

/* The mean over points of the leaf; of the pane, if this is smaller: then few points of
 * the leaf may miss the part beside the pane. */
static double exact_factor(const struct receiver *r, const struct senders *senders,
                           const struct facet *sender)
{
    int64_t *work = &r->gather->model->estimating;
    const struct facet *to = &r->facet, *from = sender;
    if (senders->kind == WINDOWS && from->area < to->area)
        return from->area / to->area *
               mean_factor(&from->triangle, from->plane.normal, &to->triangle, work);
    return mean_factor(&to->triangle, to->plane.normal, &from->triangle, work);
}

/* Finds up to `count` shots by this many tries for each. Returns their number; adds their
 * kernels to `*all`. */
static int find_shots(struct receiver *r, struct aim *aim, const struct facet *sender,
                      int count, int tries, bool back, double *all)
{
    struct gather_aims *aims = r->gather->aims;
    int found = 0, end = aim->index + tries * count;
    RESERVE(aims->shots, &aims->shot_capacity, count);
    while (found < count && aim->index < end) {
        int index = aim->index++;
        struct shot shot =
            back ? shot_back(r, aim, sender, index) : shot_at(r, aim, sender, index);
        aims->shots[found] = shot;
        found += shot.kernel > 0.0;
        *all += shot.kernel;
    }
    return found;
}

/* Fires `count` segments at a sender, for `share` of its light. `factor`: the exact one,
 * or -1. Where the exact factor is taken, points below a horizon are passed over, or the
 * light would be lost where all of few points are below. */
static void aim_at_sender(struct receiver *r, struct aim *aim, int32_t patch, int count,
                          double share, double factor)
{
    struct facet sender = facet_make(r->gather->model->forest, patch);
    struct gather_aims *aims = r->gather->aims;
    bool window = aim->senders->kind == WINDOWS;
    bool exact = factor >= 0.0 || aim->senders->kind != BRIGHT_PATCHES;
    double all = 0.0;
    int found = 0, start = aim->index;
    if (!facets_face(&r->facet, &sender))
        return;
    if (window && factor < 0.0)
        factor = exact_factor(r, aim->senders, &sender);
    if (window && TRIES_MOST * factor * r->facet.area > sender.area)
        found = find_shots(r, aim, &sender, count, TRIES_MOST, true, &all);
    if (found == 0)
        found = find_shots(r, aim, &sender, count, exact ? TRIES_MOST : 1, false, &all);
    if (found == 0)
        return;
    if (!exact)
        factor = sender.area * all / (aim->index - start);
    else if (factor < 0.0)
        factor = exact_factor(r, aim->senders, &sender);
    double sent = rgb_sum(sender_light(aim->senders, patch));
    for (int k = 0; k < found; k++) {
        struct shot shot = aims->shots[k]; /* light behind it may be aimed at by more */
        double part = share * factor * (shot.kernel / all);
        double seen =
            add_shot(r, aim, &shot, patch, part,
                     hash_mix(aim->sequence.scramble[1] + (uint64_t)(aim->index + k)));
        bool drawn = aim->expected >= 0.0;
        aim->direct += part * sent;
        add_segment(&aim->volleys[drawn], k, count, drawn ? aim->expected : part * sent,
                    seen);
    }
}

/* Fires `count` segments at a node of the cut, for `share` of its light, spread evenly
 * over its power: the first half takes every other place, the second the rest. `factor`:
 * of a single sender the exact one, or -1. */
static void aim_at_node(struct receiver *r, struct aim *aim, int32_t number, int count,
                        double share, double factor)
{
    const struct sender_node *node = &aim->senders->nodes[number];
    double start = hash_unit(aim->sequence.scramble[0]);
    if (node->child[0] < 0) {
        aim_at_sender(r, aim, aim->senders->patches[node->first], count, share, factor);
        return;
    }
    for (int k = 0; k < count; k++) {
        int place = 2 * k < count ? 2 * k : (2 * k - count) | 1;
        struct choice choice =
            sender_choose(aim->senders, node, (place + start) / count);
        aim_at_sender(r, aim, choice.patch, 1, choice.share * share / count, -1.0);
    }
}

/* Segments still to be dealt, one for each so much light. */
struct dealing {
    double each; /* W/m^2 */
    double sum;  /* light of the nodes so far, in segments, from a chance start on */
};

/* Returns the number of segments of the next node, which brings the light `direct`. */
static int deal(struct dealing *dealing, double direct)
{
    double before = floor(dealing->sum);
    dealing->sum += direct / dealing->each;
    return (int)(floor(dealing->sum) - before);
}

static bool is_near_sender(const struct sender_node *node, const struct bounds *own)
{
    struct vec3 apart = vec3_sub(node->bounds.middle, own->middle);
    double reach = NEARBY * (node->bounds.radius + own->radius);
    return node->child[0] < 0 && vec3_dot(apart, apart) <= reach * reach;
}

/* Makes the offer of a node of a single sender one by its exact factor. */
static void make_exact(const struct receiver *r, const struct senders *senders,
                       const struct sender_node *node, struct offer *offer)
{
    int32_t patch = senders->patches[node->first];
    struct facet sender = facet_make(r->gather->model->forest, patch);
    bool faces = facets_face(&r->facet, &sender);
    offer->factor = faces ? exact_factor(r, senders, &sender) : 0.0;
    offer->light = offer->factor * rgb_sum(sender_light(senders, patch));
    offer->worth = offer->light * offer->blind;
}

/* Makes the offers of the nodes of a cut: half of all by light, half by visible light.
 * Offers of near senders with the light of a segment are exact. Returns
 * the light dealt to each segment, W/m^2. */
static double make_offers(struct receiver *r, const struct cuts *cuts, struct cut cut,
                          int segments)
{
    struct gather_aims *aims = r->gather->aims;
    const struct senders *senders = cuts->senders;
    struct bounds own = facet_bounds(&r->facet);
    int32_t space = node_space(senders->model, r->row->leaf);
    double all = 0.0, sum = 0.0, found = 0.0;
    RESERVE(aims->offers, &aims->offer_capacity, cut.count);
    for (int64_t i = 0; i < cut.count; i++) {
        const struct cut_node *at = &cuts->nodes[cut.first + i];
        const struct sender_node *node = &senders->nodes[at->node];
        double blind = cuts_blind_part(senders, node, space);
        double worth = sender_node_worth(senders, node, &own) * blind;
        aims->offers[i] = (struct offer){worth, worth / blind, -1.0, blind,
                                         cut_found(&cut, at, blind)};
        all += worth;
    }
    for (int64_t i = 0; i < cut.count; i++) {
        const struct sender_node *node =
            &senders->nodes[cuts->nodes[cut.first + i].node];
        struct offer *offer = &aims->offers[i];
        if (offer->worth * segments >= all && is_near_sender(node, &own))
            make_exact(r, senders, node, offer);
        sum += offer->worth;
        found += offer->worth / offer->blind * offer->found;
    }
    double part = found > 0.0 ? 0.5 * sum / found : 0.0;
    for (int64_t i = 0; i < cut.count; i++) {
        struct offer *offer = &aims->offers[i];
        offer->worth *= (found > 0.0 ? 0.5 : 1.0) + part * offer->found / offer->blind;
    }
    return sum / segments;
}

/* The share of a node's light that a leaf may see although all of its segments miss. By
 * segments of the node's own looks alone: cut_seen() takes those of other nodes for as
 * many more, and all of these miss behind the same wall. */
static double share_in_doubt(const struct cut *cut, const struct cut_node *node)
{
    return node->asked == 0 ? cut_seen(cut, node)
                            : (node->arrived + 0.5) / (node->asked + 1.0);
}

/* Aims at the nodes of a cut. A node with the light of a segment or more gets segments of
 * its own, which share this light. The fainter nodes are dealt a whole number of segments
 * together: one that gets a segment stands for others that get none. If all segments to a
 * node miss, they agree, and would seem sure. So the row's variance is at least that of
 * draws that arrive with the share in doubt. */
static void aim_at_cut(struct receiver *r, struct cuts *cuts, int segments)
{
    struct cut cut = cuts_at(cuts, r->row->leaf);
    double each = make_offers(r, cuts, cut, segments);
    const struct offer *offers = r->gather->aims->offers;
    if (!(each > 0.0))
        return;
    double start = hash_unit(r->seed + 16), faint = 0.0;
    for (int64_t i = 0; i < cut.count; i++)
        faint += offers[i].worth < each ? offers[i].worth : 0.0;
    struct dealing strong = {each, start}, weak = {faint / ceil(faint / each), start};
    struct aim aim = {.senders = cuts->senders, .volleys[1].drawn = true};
    int32_t space = node_space(cuts->senders->model, r->row->leaf);
    struct rgb around = {{0.0, 0.0, 0.0}};
    for (int64_t i = 0; i < cut.count; i++) {
        const struct cut_node node = cuts->nodes[cut.first + i]; /* paths make cuts */
        double worth = offers[i].worth;
        bool sure = worth >= each;
        const struct sender_node *at = &cuts->senders->nodes[node.node];
        bool unseen = at->space != space && !(offers[i].found > 0.0);
        int count = worth > 0.0 ? deal(sure ? &strong : &weak, worth) : 0;
        if (count == 0)
            continue;
        struct aim before = aim;
        double part = sure ? 1.0 : count * weak.each / worth;
        bool drawn = !sure || at->child[0] >= 0;
        aim.expected = drawn ? part * offers[i].light / count : -1.0;
        struct volley *volley = &aim.volleys[drawn], fired = *volley;
        aim.sequence = sequence_start(hash_mix(r->seed + 8) ^
                                      hash_mix((uint64_t)node.node));
        aim.index = 0;
        aim_at_node(r, &aim, node.node, count, part, offers[i].factor);
        while (drawn && segments_of(volley) < segments_of(&fired) + count)
            add_segment(volley, 0, 1, aim.expected, 0.0); /* senders that look away */
        double direct = aim.direct - before.direct;
        bool none = aim.arrived == before.arrived;
        if (r->kind == RECEIVER_LOOK && cuts->tally) {
            cuts->tally[2 * (cut.first + i)] += aim.fired - before.fired;
            cuts->tally[2 * (cut.first + i) + 1] += aim.arrived - before.arrived;
        }
        double share = share_in_doubt(&cut, &node);
        if (!none && at->space != space)
            r->gather->counts.crossed++;
        if (none && unseen) {
            *volley = fired; /* of another space, as ever: no doubt */
            continue;
        }
        struct rgb light = sender_light(cuts->senders, cuts->senders->patches[at->first]);
        volley->light = light;
        for (int c = 0; c < BANDS && none && r->kind != RECEIVER_LOOK; c++) {
            double h = direct * light.band[c] / rgb_sum(light);
            around.band[c] += h * h / count * share * (1.0 - share);
        }
        if (segments_of(volley) >= VOLLEY)
            end_volley(r, volley);
    }
    end_volley(r, &aim.volleys[0]);
    end_volley(r, &aim.volleys[1]);
    for (int c = 0; c < BANDS; c++) {
        r->row->chance.band[c] = fmax(r->row->chance.band[c], around.band[c]);
        r->row->halves.band[c] = fmax(r->row->halves.band[c], around.band[c]);
    }
}

/* The number of segments is to the number of rays as the light of bright patches to all
 * reflected light. */
void receiver_aim_at_bright(struct receiver *r)
{
    int32_t space = node_space(r->gather->model, r->row->leaf);
    double part = r->gather->lit[space].bright_part;
    struct cuts *cuts = r->gather->aims->cuts[BRIGHT_PATCHES];
    cuts_limit(cuts);
    aim_at_cut(r, cuts, (int)ceil(r->rays * part));
}

void receiver_aim(struct receiver *r)
{
    aim_at_cut(r, r->gather->aims->cuts[LAMPS], r->segments);
    r->row->straight = r->light;
    r->light = (struct rgb){{0.0, 0.0, 0.0}};
    if (r->gather->aims->panes) {
        struct rgb before = r->row->straight;
        aim_at_cut(r, r->gather->aims->cuts[WINDOWS], r->segments);
        r->through = rgb_sub(r->light, rgb_sub(r->row->straight, before));
        r->light = (struct rgb){{0.0, 0.0, 0.0}};
    }
    r->row->of_segments = r->row->chance;
}
