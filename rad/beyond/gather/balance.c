/* The balance of light.
 *
 * In a closed scene as much light arrives as leaves, on bare surfaces (on which no other
 * face lies). Rows sum to 1, but columns have the noise of rays and the errors of leaves
 * seen in part, so W loses or makes some thousandths of the light: with rho .99 a
 * hundredfold would be missing in the end. W is mended where rows are least sure: in
 * proportion to s, the irradiance of the turn before over the number of rays. (So the
 * noise of a black end of a pipe, which has few rays, stays there, and does not change
 * the wall.) With the areas a, the kept shares k of the light leaving, 1 but where a leaf
 * faces out of the scene, and W' = W + s (k a - W^T a)^T / (a^T s),
 *
 *     a^T W' = (k a)^T,
 *
 * whatever light there is, in each space. So the balance of the answer is true. One
 * factor for the irradiances of the answer would make the balance true as well, but would
 * correct by the hundredfold, light straight from lamps included. */
#include "rad/beyond/gather/balance.h"

#include <math.h>

#include "geom/alloc.h"

/* A space is closed if no more than this part of its rays escapes, or light that is no
 * more than this part of what is absorbed. */
static const double CRACKS = 1e-5;

/* Sums of a space at a time, at most. */
enum { COLUMNS = 2 * BANDS };

static int32_t spaces_of(const struct light_balance *b)
{
    return lit_count(b->equation->gather->model);
}

/* Spaces with a balance of their own. */
static int32_t balances_of(const struct light_balance *b)
{
    return b->apart ? spaces_of(b) : 1;
}

/* Collective. Sums up b->terms, [columns] of each leaf, balance by balance. */
static void sum_up(struct light_balance *b, int columns)
{
    const struct equation *e = b->equation;
    total_groups(&e->totals, b->terms, b->apart ? e->space : NULL, e->count,
                 balances_of(b), columns, b->sums);
}

/* In a closed space a leaf keeps all of its light; or none, if it faces out. */
static void keep_light(struct light_balance *b)
{
    for (int64_t i = 0; i < b->equation->count; i++) {
        struct cover *cover = equation_cover(b->equation, i);
        if (b->closed[balance_of(b, i) - b->flows])
            cover->kept = cover->kept > 0.0f ? 1.0f : 0.0f;
    }
}

struct light_balance balance_start(struct equation *equation, int64_t crossed)
{
    struct light_balance b = {.equation = equation, .apart = crossed == 0};
    int32_t spaces = spaces_of(&b);
    const int64_t *fired = equation->fired;
    b.closed = alloc_array((size_t)spaces, sizeof *b.closed);
    b.flows = alloc_array((size_t)spaces, sizeof *b.flows);
    b.spread = alloc_array((size_t)equation->count, sizeof *b.spread);
    b.terms = alloc_array(COLUMNS * (size_t)equation->count, sizeof *b.terms);
    b.sums = alloc_array(COLUMNS * (size_t)spaces, sizeof *b.sums);
    int64_t rays = 0, escaped = 0;
    for (int32_t s = 0; s < spaces; s++) {
        rays += fired[2 * s];
        escaped += fired[2 * s + 1];
    }
    for (int32_t s = 0; s < spaces; s++) {
        if (b.apart) {
            rays = fired[2 * s];
            escaped = fired[2 * s + 1];
        }
        b.closed[s] = (double)escaped <= CRACKS * (double)rays;
        b.any = b.any || b.closed[s];
    }
    keep_light(&b);
    return b;
}

void balance_free(struct light_balance *b)
{
    alloc_free(b->closed);
    alloc_free(b->flows);
    alloc_free(b->spread);
    alloc_free(b->terms);
    alloc_free(b->sums);
}

struct flows *balance_of(const struct light_balance *b, int64_t leaf)
{
    return &b->flows[b->apart ? b->equation->space[leaf] : 0];
}

double balance_missing(const struct light_balance *b)
{
    double most = 0.0;
    for (int32_t s = 0; s < spaces_of(b); s++)
        for (int c = 0; c < BANDS; c++)
            most = fmax(most, fabs(b->flows[s].missing.band[c]));
    return most;
}

void balance_spread(struct light_balance *b, const struct rgb *h)
{
    const struct equation *e = b->equation;
    for (int64_t i = 0; i < e->count; i++)
        for (int c = 0; c < BANDS; c++) {
            double *own = &b->spread[i].band[c];
            double stays = 1.0 - equation_material(e, i)->transmittance.band[c];
            *own = h[i].band[c] / e->mesh->rays[e->number[i]];
            b->terms[BANDS * i + c] = equation_bare_area(e, i) * stays * *own;
        }
    sum_up(b, BANDS);
    for (int32_t s = 0; s < balances_of(b); s++)
        for (int c = 0; c < BANDS; c++)
            b->flows[s].all.band[c] = b->sums[BANDS * s + c];
}

void balance_close(struct light_balance *b, const struct rgb *from, bool lamps,
                   struct rgb *h)
{
    const struct equation *e = b->equation;
    double *term = b->terms;
    for (int64_t i = 0; i < e->count; i++) {
        const struct material *m = equation_material(e, i);
        double bare = equation_bare_area(e, i);
        double kept = (double)equation_cover(e, i)->kept * bare;
        bool shines = lamps && material_emits(m);
        double more = shines ? equation_shining_area(e, i) - kept : 0.0;
        for (int c = 0; c < BANDS; c++) {
            double stays = bare * (1.0 - m->transmittance.band[c]);
            *term++ = kept * from[i].band[c] + more * m->emission.band[c]; /* leaving */
            *term++ = stays * h[i].band[c]; /* arriving */
        }
    }
    sum_up(b, 2 * BANDS);
    for (int32_t s = 0; s < balances_of(b); s++)
        for (int c = 0; c < BANDS; c++) {
            struct flows *own = &b->flows[s];
            const double *sum = &b->sums[2 * (BANDS * s + c)];
            /* where no light arrives, none is missing */
            bool lit = own->all.band[c] > 0.0 && b->closed[s];
            double missing = lit ? sum[0] - sum[1] : 0.0;
            own->spread.band[c] = lit ? missing / own->all.band[c] : 0.0;
            own->missing.band[c] = sum[0] > 0.0 ? missing / sum[0] : 0.0;
        }
    for (int64_t i = 0; i < e->count; i++)
        rgb_add(&h[i], 1.0, rgb_times(balance_of(b, i)->spread, b->spread[i]));
}

void balance_absorb(struct light_balance *b, struct rgb *h)
{
    const struct equation *e = b->equation;
    double *term = b->terms;
    for (int64_t i = 0; i < e->count; i++) {
        const struct material *m = equation_material(e, i);
        double area = material_emits(m) ? equation_shining_area(e, i) : 0.0;
        for (int c = 0; c < BANDS; c++) {
            double on = (double)equation_cover(e, i)->kept * m->reflectance.band[c] +
                        m->transmittance.band[c];
            *term++ = area * m->emission.band[c]; /* emitted */
            *term++ = equation_bare_area(e, i) * (1.0 - on) * h[i].band[c];
        }
    }
    sum_up(b, 2 * BANDS);
    for (int64_t i = 0; i < e->count; i++)
        for (int c = 0; c < BANDS; c++) {
            int64_t s = balance_of(b, i) - b->flows;
            const double *sum = &b->sums[2 * (BANDS * s + c)]; /* emitted, absorbed */
            if (sum[1] > 0.0 && b->closed[s])
                h[i].band[c] *= sum[0] / sum[1];
        }
}

bool balance_find_more(struct light_balance *b, const struct rgb *radiosity)
{
    const struct equation *e = b->equation;
    bool more = false;
    for (int64_t i = 0; i < e->count; i++) {
        struct rgb rho = equation_material(e, i)->reflectance;
        double kept = (double)equation_cover(e, i)->kept, bare = equation_bare_area(e, i);
        double *term = &b->terms[3 * i], lost = (1.0 - kept) * bare;
        term[0] = 0.0; /* absorbed */
        for (int c = 0; c < BANDS; c++)
            term[0] += bare * (1.0 - rho.band[c]) * radiosity[i].band[c];
        bool tells = kept > 0.0 && !e->mesh->cut[equation_leaf(e, i)];
        term[1] = tells ? lost * rgb_sum(radiosity[i]) : 0.0;
        term[2] = scene_is_sky(e->gather->model->scene, equation_root(e, i));
    }
    sum_up(b, 3);
    for (int32_t s = 0; s < balances_of(b); s++) {
        double absorbed = b->sums[3 * s], lost = b->sums[3 * s + 1];
        bool sky = b->sums[3 * s + 2] > 0.0;
        if (!b->closed[s] && !sky && absorbed > 0.0 && lost <= CRACKS * absorbed)
            more = b->any = b->closed[s] = true;
    }
    keep_light(b);
    return more;
}

void balance_find_unsure(struct light_balance *b, const struct rgb *h,
                         const struct rgb *reflected, const struct rgb *again)
{
    const struct equation *e = b->equation;
    for (int64_t i = 0; i < e->count; i++) {
        double bare = equation_bare_area(e, i), kept = (double)equation_cover(e, i)->kept;
        double *term = &b->terms[(BANDS + 1) * i];
        term[BANDS] = 0.0; /* straight from lamps */
        for (int c = 0; c < BANDS; c++) {
            term[c] = bare * (kept * reflected[i].band[c] - again[i].band[c]);
            term[BANDS] += bare * (h[i].band[c] - again[i].band[c]);
        }
    }
    sum_up(b, BANDS + 1);
    for (int32_t s = 0; s < balances_of(b); s++) {
        const double *missing = &b->sums[(BANDS + 1) * s], straight = missing[BANDS];
        double all = 0.0;
        for (int c = 0; c < BANDS; c++)
            all += fabs(missing[c]);
        if (!b->closed[s] && straight > 0.0) /* the balance sees to closed ones */
            b->flows[s].unsure = fmin(1.0, all / straight);
    }
}
