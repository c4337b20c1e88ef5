/* The balance of light.
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
 * correct by the hundredfold, light straight from lamps included. */
#include "rad/beyond/gather/balance.h"

#include <math.h>

#include "geom/alloc.h"

/* A space is closed if no more than this part of its rays escapes, or light that is no
 * more than this part of what is absorbed. */
static const double CRACKS = 1e-5;

static int32_t spaces_of(const struct light_balance *b)
{
    return lit_count(b->equation->gather->model);
}

/* In a closed space a leaf keeps all of its light; or none, if it faces out. */
static void keep_light(struct light_balance *b)
{
    for (int64_t i = 0; i < b->equation->count; i++) {
        struct cover *cover = &b->equation->covers[i];
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
}

struct flows *balance_of(const struct light_balance *b, int64_t leaf)
{
    return &b->flows[b->apart ? equation_space(b->equation, leaf) : 0];
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
    for (int64_t i = 0; i < b->equation->count; i++)
        for (int c = 0; c < BANDS; c++)
            b->spread[i].band[c] = h[i].band[c] / b->equation->mesh->rays[i];
}

void balance_close(struct light_balance *b, const struct rgb *from, bool lamps,
                   struct rgb *h)
{
    const struct equation *e = b->equation;
    for (int32_t s = 0; s < spaces_of(b); s++)
        b->flows[s] = (struct flows){.leaving = {{0.0, 0.0, 0.0}}};
    for (int64_t i = 0; i < e->count; i++) {
        const struct material *m = equation_material(e, i);
        double bare = equation_bare_area(e, i), kept = (double)e->covers[i].kept * bare;
        double more = lamps ? equation_shining_area(e, i) - kept : 0.0;
        struct flows *own = balance_of(b, i);
        for (int c = 0; c < BANDS; c++) {
            double stays = bare * (1.0 - m->transmittance.band[c]);
            own->leaving.band[c] += kept * from[i].band[c] + more * m->emission.band[c];
            own->arriving.band[c] += stays * h[i].band[c];
            own->spread.band[c] += stays * b->spread[i].band[c];
        }
    }
    for (int32_t s = 0; s < spaces_of(b); s++)
        for (int c = 0; c < BANDS; c++) {
            struct flows *own = &b->flows[s];
            /* where no light arrives, none is missing */
            bool lit = own->spread.band[c] > 0.0 && b->closed[s];
            double leaving = own->leaving.band[c];
            double missing = lit ? leaving - own->arriving.band[c] : 0.0;
            own->spread.band[c] = lit ? missing / own->spread.band[c] : 0.0;
            own->missing.band[c] = leaving > 0.0 ? missing / leaving : 0.0;
        }
    for (int64_t i = 0; i < e->count; i++)
        for (int c = 0; c < BANDS; c++)
            h[i].band[c] += balance_of(b, i)->spread.band[c] * b->spread[i].band[c];
}

void balance_absorb(struct light_balance *b, struct rgb *h)
{
    const struct equation *e = b->equation;
    for (int32_t s = 0; s < spaces_of(b); s++)
        b->flows[s].leaving = b->flows[s].arriving = (struct rgb){{0.0, 0.0, 0.0}};
    for (int64_t i = 0; i < e->count; i++) {
        const struct material *m = equation_material(e, i);
        struct flows *own = balance_of(b, i);
        for (int c = 0; c < BANDS; c++) {
            double on = (double)e->covers[i].kept * m->reflectance.band[c] +
                        m->transmittance.band[c];
            own->leaving.band[c] += equation_shining_area(e, i) * m->emission.band[c];
            own->arriving.band[c] += equation_bare_area(e, i) * (1.0 - on) * h[i].band[c];
        }
    }
    for (int64_t i = 0; i < e->count; i++)
        for (int c = 0; c < BANDS; c++) {
            const struct flows *own = balance_of(b, i);
            double gone = own->arriving.band[c];
            if (gone > 0.0 && b->closed[own - b->flows])
                h[i].band[c] *= own->leaving.band[c] / gone;
        }
}

bool balance_find_more(struct light_balance *b, const struct rgb *radiosity)
{
    const struct equation *e = b->equation;
    int32_t spaces = spaces_of(b);
    double *lost = alloc_array((size_t)spaces, sizeof *lost);
    double *absorbed = alloc_array((size_t)spaces, sizeof *absorbed);
    bool more = false;
    for (int64_t i = 0; i < e->count; i++) {
        int64_t s = balance_of(b, i) - b->flows;
        struct rgb rho = equation_material(e, i)->reflectance;
        double kept = (double)e->covers[i].kept, bare = equation_bare_area(e, i);
        const struct forest *forest = e->gather->model->forest;
        uint32_t root = forest->patches[e->mesh->leaves[i]].id.root;
        if (scene_is_sky(forest->scene, (int32_t)root))
            lost[s] = HUGE_VAL;
        for (int c = 0; c < BANDS; c++)
            absorbed[s] += bare * (1.0 - rho.band[c]) * radiosity[i].band[c];
        if (kept > 0.0 && !e->mesh->cut[e->mesh->leaves[i]])
            lost[s] += (1.0 - kept) * bare * rgb_sum(radiosity[i]);
    }
    for (int32_t s = 0; s < spaces; s++)
        if (!b->closed[s] && absorbed[s] > 0.0 && lost[s] <= CRACKS * absorbed[s])
            more = b->any = b->closed[s] = true;
    keep_light(b);
    alloc_free(absorbed);
    alloc_free(lost);
    return more;
}

void balance_find_unsure(struct light_balance *b, const struct rgb *h,
                         const struct rgb *reflected, const struct rgb *again)
{
    const struct equation *e = b->equation;
    int32_t spaces = spaces_of(b);
    struct rgb *missing = alloc_array((size_t)spaces, sizeof *missing);
    double *straight = alloc_array((size_t)spaces, sizeof *straight);
    for (int64_t i = 0; i < e->count; i++) {
        int64_t s = balance_of(b, i) - b->flows;
        double bare = equation_bare_area(e, i), kept = (double)e->covers[i].kept;
        for (int c = 0; c < BANDS; c++) {
            missing[s].band[c] += bare * (kept * reflected[i].band[c] - again[i].band[c]);
            straight[s] += bare * (h[i].band[c] - again[i].band[c]);
        }
    }
    for (int32_t s = 0; s < spaces; s++) {
        double all = 0.0;
        for (int c = 0; c < BANDS; c++)
            all += fabs(missing[s].band[c]);
        if (!b->closed[s] && straight[s] > 0.0) /* the balance sees to closed ones */
            b->flows[s].unsure = fmin(1.0, all / straight[s]);
    }
    alloc_free(straight);
    alloc_free(missing);
}
