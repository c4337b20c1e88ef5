/* Step 9, phr's own: the final gather and its solution.
 *
 * The links have brought a solution right in the large. Here each leaf gets a row of form
 * factors by rays (rad/beyond/gather/rays.c), and
 *
 *     B = E + rho (source + W B)
 *
 * is solved for the leaves' B, from the links' solution on. The answer satisfies the
 * gathered equation, whatever the errors of the links were. Rows are kept, so all this
 * costs one tracing, and products with a sparse matrix.
 *
 * W is not symmetric: BiCGSTAB (van der Vorst, 1992), for the three bands side by side.
 * In the residual of the equation a leaf counts by its area and, for one half, relative
 * to its light: else things below a wide sky would be left as the links have them. Rows
 * are dealt to the ranks. All ranks know all vectors, so only W B takes an exchange, and
 * scalar products are the same on all ranks.
 *
 * Where rays meet a leaf too near, such as the floor under a box, their paths find the
 * light there (rays.c). There the leaf is darker than in the mean, so its rest, seen by
 * others, is brighter. With the part n of the leaf's light for near receivers and the
 * mean radiosity L met by these, far ones are shown B + n (B - L), and less where
 * n > 1/2: min(1, 2 (1 - n)) of the difference. (n / (1 - n) would be the whole, and
 * noise where hardly any far ray meets the leaf.) As a part of W this would make rows of
 * both signs, and light in bright rooms would grow with each reflection; a factor of B
 * makes none. The factors are those of the answer before, so light is solved for in
 * turns, until one changes nothing. In the first turn they are 1: by the links' light,
 * which may lack much in a gap, some would be high enough to make a bright room reflect
 * more than it receives.
 *
 * Where a box stands on part of a leaf, rays from there meet its inside: that part is
 * dark, so the part seen by others is brighter than the mean, by the inverse of its
 * share.
 *
 * In a closed scene as much light arrives as leaves, on bare surfaces (on which no other
 * face lies). Rows sum to 1, but columns have the noise of rays and the errors of leaves
 * seen in part, so W loses or makes some thousandths of the light: with rho .99 a
 * hundredfold would be missing in the end. The loss is made up for within W, where rows
 * are least sure: in proportion to s, the irradiances of the turn before over the numbers
 * of rays. (A black end of a pipe has few, and shall not tell how bright the wall is.)
 * With the areas a, the kept shares k of the light leaving, 1 but where a leaf faces out
 * of the scene, and W' = W + s (k a - W^T a)^T / (a^T s),
 *
 *     a^T W' = (k a)^T,
 *
 * whatever light there is, in each space. So the balance of the answer is true. One
 * factor for the irradiances of the answer would make the balance true as well, but would
 * correct by the hundredfold, light straight from lamps included.
 *
 * Rejected: the defect solved for over the links, and added. Where links reflect less
 * than is right, as in bright closed rooms, each round leaves nine tenths of it. */
#include "mpi/beyond/beyond.h"

#include <math.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/stop.h"
#include "mpi/beyond/gathering.h"
#include "rad/beyond/bicgstab.h"
#include "rad/pushpull.h"

enum { STEPS_MOST = 500 };

/* Turns, at most; the last one only finds what is left. Most end at five, when one
 * changes nothing. In gaps of rho .999 each leaves .6 of the error. */
enum { TURNS_MOST = 40 };

/* The part of the residual that each turn leaves: the factors of the next turn change the
 * residual by as much. */
static const double LEFT = 0.03;

/* A space is closed if no more than this part of its rays escapes, or light that is no
 * more than this part of what is absorbed. */
static const double CRACKS = 1e-5;

/* A leaf is seen brighter than its mean by at most the inverse of this. */
static const double LEAST_OUTSIDE = 0x1p-6;

/* Leaves with less than this part of the mean radiosity are solved for as if this
 * bright. */
static const double DARK = 1e-3;

/* --- rows --- */

static void gathering_start(struct gathering *g, struct solver *solver)
{
    size_t patches = (size_t)solver->model.forest->count;
    g->gather = final_gather_create(
        &solver->model, solver->model.criterion.final_gather, g->mesh->cut);
    g->leaves = g->mesh->leaves;
    g->count = g->mesh->count;
    g->areas = alloc_array((size_t)g->count, sizeof *g->areas);
    g->covers = alloc_array((size_t)g->count, sizeof *g->covers);
    for (int64_t i = 0; i < g->count; i++)
        g->areas[i] = forest_area(solver->model.forest, g->leaves[i]);
    g->near = alloc_array((size_t)g->count, sizeof *g->near);
    g->radiosity = alloc_array(patches, sizeof *g->radiosity);
    g->all = alloc_array((size_t)g->count, sizeof *g->all);
    g->spread = alloc_array((size_t)g->count, sizeof *g->spread);
    size_t spaces = (size_t)lit_count(&solver->model);
    g->closed = alloc_array(spaces, sizeof *g->closed);
    g->fired = alloc_array(2 * spaces, sizeof *g->fired);
    g->flows = alloc_array(spaces, sizeof *g->flows);
}

/* Hands the gather over to the solver. */
static void gathering_end(struct gathering *g)
{
    if (g->gather)
        final_gather_drop_rows(g->gather);
    final_gather_destroy(g->solver->beyond->answer->gather); /* of a round before */
    g->solver->beyond->answer->gather = g->gather;
    gather_mesh_free(g->mesh);
    alloc_free(g->areas);
    alloc_free(g->covers);
    alloc_free(g->near);
    alloc_free(g->radiosity);
    alloc_free(g->all);
    alloc_free(g->spread);
    alloc_free(g->closed);
    alloc_free(g->fired);
    alloc_free(g->flows);
    stages_free(g->stages);
}

static void make_row(void *context, int64_t i)
{
    struct gathering *g = context;
    const struct gather_counts *counts = &g->gather->counts;
    int64_t *fired = g->fired + 2 * gathering_space(g, i);
    fired[0] += 1 - counts->rays;
    fired[1] -= counts->escaped;
    final_gather_add_row(g->gather, g->leaves[i], g->mesh->rays[i], g->mesh->segments[i],
                         g->mesh->exact[i]);
    fired[0] += counts->rays;
    fired[1] += counts->escaped;
}

/* Collective. A space seen from another has no balance of its own: then all have one
 * together or none has any. */
static void find_closed(struct gathering *g)
{
    int32_t spaces = lit_count(&g->solver->model);
    int64_t rays = 0, escaped = 0, crossed = g->gather->counts.crossed;
    comm_add(g->solver->comm, g->fired, 2 * spaces);
    comm_add(g->solver->comm, &crossed, 1);
    for (int32_t s = 0; s < spaces; s++) {
        rays += g->fired[2 * s];
        escaped += g->fired[2 * s + 1];
    }
    g->apart = crossed == 0;
    for (int32_t s = 0; s < spaces; s++) {
        if (g->apart) {
            rays = g->fired[2 * s];
            escaped = g->fired[2 * s + 1];
        }
        g->closed[s] = (double)escaped <= CRACKS * (double)rays;
        g->balanced = g->balanced || g->closed[s];
    }
}

/* Collective. False if a signal on any rank has ended the work. */
static bool make_rows(struct gathering *g)
{
    struct solver *solver = g->solver;
    progress_begin(solver->progress, "gathering", -1, 0);
    stages_make_cuts(solver, g->gather, g->leaves, g->mesh->exact, g->count);
    *g->stages = (struct stages){.solver = solver, .gather = g->gather, .act = make_row,
                                .context = g, .work = g->mesh->work, .count = g->count};
    stages_run(g->stages);
    const struct gather_counts *counts = &g->gather->counts;
    int64_t sums[] = {stop_is_asked(), counts->rays, counts->segments, counts->exact,
                      final_gather_terms(g->gather), g->mesh->traced};
    comm_add(solver->comm, sums, sizeof sums / sizeof sums[0]);
    find_closed(g);
    solver->beyond->answer->counts = (struct gathered){
        .rays = sums[1], .segments = sums[2], .exact = sums[3],
        .terms = sums[4], .looks = sums[5], .split = g->mesh->split,
        .limited = g->mesh->limited};
    return sums[0] == 0;
}

/* --- the equation --- */

/* Sets the radiosities to be gathered: of leaves, until the pull. */
static void place_radiosities(struct gathering *g, const struct rgb *b)
{
    for (int64_t i = 0; i < g->count; i++)
        g->radiosity[g->gather->place[g->leaves[i]]] = b[i];
}

/* Collective. Adds up integers of all ranks, which go to the sum and back. */
static void add_up(struct gathering *g, int64_t *values, int64_t count)
{
    comm_add(g->solver->comm, values, count);
    g->bytes += 2 * count * (int64_t)sizeof *values;
}

/* Collective. Adds up the constant light of leaves too near, and numbers these leaves, in
 * the order of all. */
static void share_near(struct gathering *g)
{
    enum { EACH = (int)(sizeof *g->gather->near->items / sizeof(int64_t)) };
    struct final_gather *gather = g->gather;
    struct gather_near *items = gather->near->items;
    size_t patches = (size_t)g->solver->model.forest->count;
    int32_t *number = alloc_array(patches, sizeof *number);
    add_up(g, &items->area, EACH * (int64_t)patches);
    for (int64_t i = 0; i < g->count; i++) {
        int32_t place = gather->place[g->leaves[i]];
        if (items[place].area == 0)
            continue;
        number[place] = (int32_t)g->near_count;
        items[g->near_count] = items[place];
        g->near[g->near_count++] = (struct too_near){i, {{1.0, 1.0, 1.0}}};
    }
    for (int64_t k = final_gather_terms(gather) - 1; k >= 0; k--)
        if (gather->terms[k].near >= 0)
            gather->terms[k].near = number[gather->terms[k].near];
    alloc_free(number);
}

/* Makes the radiosities to be gathered those of the parts of leaves outside of things,
 * which receive all their light. */
static void see_bare_parts(struct gathering *g, const struct rgb *b, bool lamps)
{
    for (int64_t i = 0; i < g->count; i++) {
        double share = fmax(LEAST_OUTSIDE, g->covers[i].outside);
        if (!(share < 1.0))
            continue;
        struct rgb e = gathering_material(g, i)->emission;
        for (int c = 0; c < BANDS; c++) {
            double own = lamps ? e.band[c] : 0.0;
            g->radiosity[g->gather->place[g->leaves[i]]].band[c] =
                own + (b[i].band[c] - own) / share;
        }
    }
}

/* Collective. Finds how bright far receivers see leaves, relative to their means, for
 * their radiosities `b`: see above. */
static void find_shown(struct gathering *g, const struct rgb *b)
{
    const struct final_gather *gather = g->gather;
    int64_t *watts = alloc_array(BANDS * (size_t)g->near_count, sizeof *watts);
    place_radiosities(g, b);
    see_bare_parts(g, b, true);
    final_gather_pull(gather, g->radiosity);
    account_begin(&g->solver->account, PHASE_PRODUCTS);
    for (int64_t row = 0; row < gather->count; row++)
        final_gather_add_near(gather, row, g->radiosity, watts);
    account_end(&g->solver->account, PHASE_PRODUCTS);
    add_up(g, watts, BANDS * g->near_count);
    for (int64_t k = 0; k < g->near_count; k++) {
        int64_t i = g->near[k].leaf;
        const struct gather_near *near = &gather->near->items[k];
        const struct rgb *own = &g->radiosity[gather->place[g->leaves[i]]];
        double area = g->areas[i] * fmax(LEAST_OUTSIDE, g->covers[i].outside);
        double part = (double)near->area * gather->near->unit_area / area;
        double unit = gather->near->unit_watts / (area * fmax(1.0, part));
        double n = fmin(1.0, part), damping = fmin(1.0, 2.0 * (1.0 - n));
        for (int c = 0; c < BANDS; c++) {
            double met = (double)(watts[BANDS * k + c] + near->watts[c]) * unit; /* n L */
            met = fmax(0.0, met); /* slopes may bring it below */
            double excess = own->band[c] > 0.0 ? n - met / own->band[c] : 0.0;
            g->near[k].shown.band[c] = fmax(0.0, 1.0 + damping * excess);
        }
    }
    alloc_free(watts);
}

/* The area of a leaf whose emission arrives: of a lamp the part outside of things, for
 * segments pass through a ceiling in the lamp's plane; else the bare area. The top of a
 * lamp at the ceiling shines out of the room: nothing of its light is kept. */
static double shining_area(const struct gathering *g, int64_t i)
{
    uint32_t root = g->solver->model.forest->patches[g->leaves[i]].id.root;
    const struct cover *cover = &g->covers[i];
    bool lamp = root_is_sender(g->gather->aims->lamps, (int32_t)root);
    return (lamp ? g->areas[i] : cover->bare) * cover->outside * cover->kept;
}

/* The flows of the balance of which a leaf is part. */
static struct flows *flows_of(const struct gathering *g, int64_t i)
{
    return &g->flows[gathering_balance(g, i)];
}

/* Spreads missing light, so that as much arrives as leaves in a closed space, over
 * irradiances `h` for the radiosities `b`. `lamps`: as of irradiances(). */
static void close_balance(struct gathering *g, const struct rgb *b, bool lamps,
                          struct rgb *h)
{
    int32_t spaces = lit_count(&g->solver->model);
    for (int32_t s = 0; s < spaces; s++)
        g->flows[s] = (struct flows){.leaving = {{0.0, 0.0, 0.0}}};
    for (int64_t i = 0; i < g->count; i++) {
        const struct material *m = gathering_material(g, i);
        double bare = g->covers[i].bare, kept = g->covers[i].kept * bare;
        double more = lamps ? shining_area(g, i) - kept : 0.0;
        struct flows *own = flows_of(g, i);
        for (int c = 0; c < BANDS; c++) {
            own->leaving.band[c] += kept * b[i].band[c] + more * m->emission.band[c];
            own->arriving.band[c] += bare * h[i].band[c];
            own->spread.band[c] += bare * g->spread[i].band[c];
        }
    }
    for (int32_t s = 0; s < spaces; s++)
        for (int c = 0; c < BANDS; c++) {
            struct flows *own = &g->flows[s];
            /* where no light arrives, none is missing */
            bool lit = own->spread.band[c] > 0.0 && g->closed[s];
            double leaving = own->leaving.band[c];
            double missing = lit ? leaving - own->arriving.band[c] : 0.0;
            own->spread.band[c] = lit ? missing / own->spread.band[c] : 0.0;
            own->missing.band[c] = leaving > 0.0 ? missing / leaving : 0.0;
        }
    for (int64_t i = 0; i < g->count; i++)
        for (int c = 0; c < BANDS; c++)
            h[i].band[c] += flows_of(g, i)->spread.band[c] * g->spread[i].band[c];
}

/* Collective. Irradiances of all leaves, W/m^2, for their radiosities `b`; with the
 * source and what lamps lack if `lamps`; in a closed scene as much as leaves. */
static void irradiances(struct gathering *g, const struct rgb *b, bool lamps,
                        struct rgb *h)
{
    struct rgb *own = g->all + g->stages->at[g->solver->comm->rank];
    place_radiosities(g, b);
    see_bare_parts(g, b, lamps);
    for (int64_t k = 0; k < g->near_count; k++) {
        int32_t place = g->gather->place[g->leaves[g->near[k].leaf]];
        for (int c = 0; c < BANDS; c++)
            g->radiosity[place].band[c] *= g->near[k].shown.band[c];
    }
    final_gather_pull(g->gather, g->radiosity);
    account_begin(&g->solver->account, PHASE_PRODUCTS);
    for (int64_t row = 0; row < g->gather->count; row++)
        own[row] = final_gather_irradiance(g->gather, row, g->radiosity, lamps);
    account_end(&g->solver->account, PHASE_PRODUCTS);
    gathering_share_rows(g, h);
    if (g->balanced)
        close_balance(g, b, lamps, h);
}

/* Finds the shares of patches outside of things. */
static void find_seen(struct gathering *g)
{
    const struct forest *forest = g->solver->model.forest;
    const int32_t *place = g->gather->place;
    double *seen = g->gather->near->seen;
    for (int64_t i = 0; i < g->count; i++)
        seen[place[g->leaves[i]]] = g->covers[i].outside;
    for (int64_t i = forest->count - 1; i >= 0; i--) {
        const struct patch *patch = &forest->patches[g->gather->order[i]];
        for (int k = 0; k < 4 && !patch_is_leaf(patch); k++)
            seen[i] += 0.25 * seen[place[patch->children + k]];
    }
}

/* Collective. */
static void share_covers(struct gathering *g)
{
    struct rgb *shares = alloc_array((size_t)g->count, sizeof *shares);
    const size_t bytes = offsetof(struct cover, bare);
    gathering_share_field(g, offsetof(struct gather_row, outside), bytes, shares);
    for (int64_t i = 0; i < g->count; i++) {
        memcpy(&g->covers[i], &shares[i], bytes);
        g->covers[i].bare = g->areas[i] * (double)g->covers[i].part;
    }
    find_seen(g);
    alloc_free(shares);
}

/* y = x - rho W x. */
static void reflect(void *context, const struct rgb *x, struct rgb *y)
{
    struct gathering *g = context;
    irradiances(g, x, false, y);
    for (int64_t i = 0; i < g->count; i++) {
        const struct material *m = gathering_material(g, i);
        for (int c = 0; c < BANDS; c++)
            y[i].band[c] = x[i].band[c] - m->reflectance.band[c] * y[i].band[c];
    }
}

/* E + rho H. */
static void set_radiosities(const struct gathering *g, const struct rgb *h, struct rgb *b)
{
    for (int64_t i = 0; i < g->count; i++) {
        const struct material *m = gathering_material(g, i);
        for (int c = 0; c < BANDS; c++)
            b[i].band[c] = m->emission.band[c] + m->reflectance.band[c] * h[i].band[c];
    }
}

/* Scales the irradiances of a closed space so that all kept light is absorbed. Their
 * balance lacks values below 0, now 0, and the residual of the equation. */
static void absorb_all(const struct gathering *g, struct rgb *h)
{
    int32_t spaces = lit_count(&g->solver->model);
    for (int32_t s = 0; s < spaces; s++)
        g->flows[s].leaving = g->flows[s].arriving = (struct rgb){{0.0, 0.0, 0.0}};
    for (int64_t i = 0; i < g->count; i++) {
        const struct material *m = gathering_material(g, i);
        for (int c = 0; c < BANDS; c++) {
            double on = g->covers[i].kept * m->reflectance.band[c];
            flows_of(g, i)->leaving.band[c] += shining_area(g, i) * m->emission.band[c];
            flows_of(g, i)->arriving.band[c] +=
                g->covers[i].bare * (1.0 - on) * h[i].band[c];
        }
    }
    for (int64_t i = 0; i < g->count; i++)
        for (int c = 0; c < BANDS; c++) {
            const struct flows *own = flows_of(g, i);
            double gone = own->arriving.band[c];
            if (gone > 0.0 && g->closed[own - g->flows])
                h[i].band[c] *= own->leaving.band[c] / gone;
        }
}

/* Updates the vote for the gathered light. */
static void judge(const struct gathering *g, const struct rgb *h, const struct rgb *b,
                  double residual, struct vote *vote)
{
    double absorbed = 0.0, leaving = 0.0, arriving = 0.0;
    for (int64_t i = 0; i < g->count; i++) {
        const struct material *m = gathering_material(g, i);
        uint32_t root = g->solver->model.forest->patches[g->leaves[i]].id.root;
        if (scene_is_sky(g->solver->model.scene, (int32_t)root))
            continue;
        for (int c = 0; c < BANDS; c++) {
            double rho = m->reflectance.band[c];
            absorbed += g->covers[i].bare * (1.0 - rho) * h[i].band[c];
            arriving += g->covers[i].bare * h[i].band[c];
            leaving += g->covers[i].bare * (b[i].band[c] - m->emission.band[c]) +
                       g->areas[i] * m->emission.band[c]; /* what is covered, is lost */
        }
    }
    vote->absorbed = absorbed;
    vote->escaped = leaving - arriving;
    vote->remaining = 2.0 * residual * lit_count(&g->solver->model) /
                      g->solver->model.absorptance; /* at most, in each space */
    vote->converged =
        vote->converged && vote->remaining <= g->solver->model.criterion.tolerance;
}

/* Collective. What light in an open space may be off by in the end: rows lose or make
 * light at each reflection, besides what their leaves lose by their own rays. Of that as
 * much is left as of the light straight from lamps, of irradiances `h` for radiosities
 * `b`: little in a dark room, a hundredfold in a white one. `reflected` and `arriving`:
 * buffers. */
static void find_unsure(struct gathering *g, const struct rgb *h, const struct rgb *b,
                        struct rgb *reflected, struct rgb *arriving)
{
    int32_t spaces = lit_count(&g->solver->model);
    struct rgb *missing = alloc_array((size_t)spaces, sizeof *missing);
    double *straight = alloc_array((size_t)spaces, sizeof *straight);
    for (int64_t i = 0; i < g->count; i++)
        reflected[i] = rgb_sub(b[i], gathering_material(g, i)->emission);
    irradiances(g, reflected, false, arriving);
    for (int64_t i = 0; i < g->count; i++) {
        const struct cover *cover = &g->covers[i];
        int32_t s = gathering_balance(g, i);
        for (int c = 0; c < BANDS; c++) {
            missing[s].band[c] +=
                cover->bare *
                ((double)cover->kept * reflected[i].band[c] - arriving[i].band[c]);
            straight[s] += cover->bare * (h[i].band[c] - arriving[i].band[c]);
        }
    }
    for (int32_t s = 0; s < spaces; s++) {
        double all = 0.0;
        for (int c = 0; c < BANDS; c++)
            all += fabs(missing[s].band[c]);
        if (!g->closed[s] && straight[s] > 0.0) /* the balance sees to closed ones */
            g->flows[s].unsure = fmin(1.0, all / straight[s]);
    }
    alloc_free(straight);
    alloc_free(missing);
}

/* Collective. The answer for pictures: light straight from lamps, and open shares. */
static void share_answer(struct gathering *g)
{
    struct answer *answer = g->solver->beyond->answer;
    struct rgb *light = alloc_array((size_t)g->count, sizeof *light);
    size_t patches = (size_t)g->solver->model.forest->count;
    gathering_share_field(g, offsetof(struct gather_row, lamps), sizeof *light, light);
    alloc_free(answer->straight);
    alloc_free(answer->outside);
    answer->straight = alloc_array(patches, sizeof *answer->straight);
    answer->outside = alloc_array(patches, sizeof *answer->outside);
    for (int64_t i = 0; i < g->count; i++) {
        struct rgb rho = gathering_material(g, i)->reflectance;
        for (int c = 0; c < BANDS; c++)
            answer->straight[g->leaves[i]].band[c] = rho.band[c] * light[i].band[c];
        answer->outside[g->leaves[i]] = g->covers[i].open;
    }
    alloc_free(light);
}

/* Weights of leaves with the radiosities `b`: in each space all of `b` has the size 1 by
 * area, and 1 by leaf. */
static double *weigh(const struct gathering *g, const struct rgb *b)
{
    size_t spaces = (size_t)lit_count(&g->solver->model);
    double *weights = alloc_array((size_t)g->count, sizeof *weights);
    double *all = alloc_array(spaces, sizeof *all);
    int64_t *count = alloc_array(spaces, sizeof *count);
    for (int64_t i = 0; i < g->count; i++) {
        all[gathering_space(g, i)] += g->areas[i] * rgb_sum(b[i]);
        count[gathering_space(g, i)]++;
    }
    for (int64_t i = 0; i < g->count; i++) {
        int32_t s = gathering_space(g, i);
        double least = DARK * g->gather->lit[s].mean;
        if (all[s] > 0.0)
            weights[i] = g->areas[i] / all[s] +
                         1.0 / ((double)count[s] * fmax(rgb_sum(b[i]), least));
    }
    alloc_free(all);
    alloc_free(count);
    return weights;
}

/* In a closed space a leaf keeps all of its light; or none, if it faces out. */
static void keep_light(struct gathering *g)
{
    for (int64_t i = 0; i < g->count; i++)
        if (g->closed[gathering_balance(g, i)])
            g->covers[i].kept = g->covers[i].kept > 0.0f ? 1.0f : 0.0f;
}

/* Finds spaces that are closed though rays escape: in a thing that touches walls and has
 * no faces there, rays are lost on backs, but no light gets in. Leaves with a thing
 * across have rays of both sides, and tell nothing. Lost light is held against what is
 * absorbed: in a white room it is missing at every reflection. Returns whether there are
 * more. */
static bool find_more_closed(struct gathering *g, const struct rgb *b)
{
    int32_t spaces = lit_count(&g->solver->model);
    double *lost = alloc_array((size_t)spaces, sizeof *lost);
    double *absorbed = alloc_array((size_t)spaces, sizeof *absorbed);
    bool more = false;
    for (int64_t i = 0; i < g->count; i++) {
        int32_t s = gathering_balance(g, i);
        struct rgb rho = gathering_material(g, i)->reflectance;
        double kept = g->covers[i].kept, bare = g->covers[i].bare;
        for (int c = 0; c < BANDS; c++)
            absorbed[s] += bare * (1.0 - rho.band[c]) * b[i].band[c];
        if (kept > 0.0 && !g->mesh->cut[g->leaves[i]])
            lost[s] += (1.0 - kept) * bare * rgb_sum(b[i]);
    }
    for (int32_t s = 0; s < spaces; s++)
        if (!g->closed[s] && absorbed[s] > 0.0 && lost[s] <= CRACKS * absorbed[s])
            more = g->balanced = g->closed[s] = true;
    keep_light(g);
    alloc_free(absorbed);
    alloc_free(lost);
    return more;
}

/* Collective. One turn: finds how missing light is spread, by `answer`, and solves for
 * `b`, which becomes the answer but where `b` is below 0. `h` and `r`: buffers. */
static struct bicgstab take_turn(struct gathering *g, const double *weights,
                                 struct bicgstab_end end, struct rgb *b, struct rgb *h,
                                 struct rgb *r, struct rgb *answer)
{
    size_t count = (size_t)g->count;
    irradiances(g, answer, true, h);
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < BANDS; c++)
            g->spread[i].band[c] = h[i].band[c] / g->mesh->rays[i];
    irradiances(g, b, true, h);
    set_radiosities(g, h, r);
    for (size_t i = 0; i < count; i++) /* what b leaves of the equation, E + rho H - b */
        r[i] = rgb_sub(r[i], b[i]);
    struct bicgstab done = bicgstab_solve(reflect, g, weights, g->count, end, b, r);
    if (done.steps > 0)
        irradiances(g, b, true, h);
    for (size_t i = 0; i < count; i++) /* slopes may go below 0 where B has changed */
        for (int c = 0; c < BANDS; c++)
            h[i].band[c] = fmax(0.0, h[i].band[c]);
    if (g->balanced)
        absorb_all(g, h);
    set_radiosities(g, h, answer);
    return done;
}

/* Collective. Solves for light by the rows, from the links' solution on. */
static void solve_rows(struct gathering *g, struct vote *vote)
{
    const struct model *model = &g->solver->model;
    struct forest *forest = model->forest;
    struct gathered *told = &g->solver->beyond->answer->counts;
    size_t count = (size_t)g->count;
    struct rgb *b = alloc_array(4 * count, sizeof *b);
    struct rgb *h = b + count, *r = h + count, *answer = r + count;
    share_near(g);
    share_covers(g);
    keep_light(g);
    for (int64_t i = 0; i < g->count; i++)
        answer[i] = b[i] = forest->radiosity[g->leaves[i]];
    struct bicgstab_end end = {
        .residual = 0.5 * model->criterion.tolerance * model->absorptance /
                    lit_count(model), /* of the sum over spaces */
        .part = LEFT, .steps = STEPS_MOST};
    double *weights = weigh(g, b);
    struct bicgstab done = {.steps = 1};
    for (int turn = 1; done.steps > 0; turn++) {
        if (turn > 1)
            find_shown(g, answer);
        if (turn == TURNS_MOST)
            end.steps = 0;
        done = take_turn(g, weights, end, b, h, r, answer);
        if (find_more_closed(g, answer) && turn < TURNS_MOST)
            done.steps = 1; /* with the balance */
    }
    alloc_free(weights);
    for (int32_t s = 0; s < lit_count(model); s++)
        for (int c = 0; c < BANDS; c++)
            told->closing = fmax(told->closing, fabs(g->flows[s].missing.band[c]));
    judge(g, h, answer, done.residual, vote);
    find_unsure(g, h, answer, b, r);
    place_radiosities(g, answer);
    final_gather_pull(g->gather, g->radiosity);
    gathering_estimate_errors(g, vote->remaining);
    share_answer(g);
    for (int64_t i = 0; i < g->count; i++)
        forest->radiosity[g->leaves[i]] = answer[i];
    forest_average(forest);
    g->gather->cut = NULL;
    final_gather_renew(g->gather); /* as a stored solution has them */
    alloc_free(b);
}

bool solver_final_gather(struct solver *solver, struct vote *vote)
{
    struct gather_mesh mesh = {.count = 0};
    struct stages stages = {.count = 0};
    struct gathering g = {.solver = solver, .mesh = &mesh, .stages = &stages};
    account_begin(&solver->account, PHASE_FINAL_GATHER);
    account_begin(&solver->account, PHASE_ROWS);
    bool done = solver_make_mesh(solver, vote->links, &mesh);
    if (done) {
        gathering_start(&g, solver);
        done = make_rows(&g);
    }
    account_end(&solver->account, PHASE_ROWS);
    if (done)
        solve_rows(&g, vote);
    account_work(&solver->account, WORK_FINAL_GATHER, 0, g.bytes);
    gathering_end(&g);
    account_end(&solver->account, PHASE_FINAL_GATHER);
    return done;
}
