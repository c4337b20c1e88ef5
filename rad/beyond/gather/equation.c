/* What rows see, and what the equation makes of it.
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
 * In the residual a leaf counts half by its area, half as one leaf, relative to its own
 * light. By area alone things below a wide sky would be as the links leave them.
 *
 * Where rays meet a leaf too near, such as the floor under a box, their paths find the
 * light there (rays.c). There the leaf is darker than in the mean, so its rest, seen by
 * others, is brighter. Near receivers get the part n of the leaf's light, and meet the
 * mean radiosity L. Far ones are shown B + n (B - L). Where n is above 1/2 they are shown
 * less: 2 (1 - n) of this difference. (The whole difference is n / (1 - n) of B - L, and
 * noise where hardly any far ray meets the leaf.) Within W the difference would be
 * weights of both signs, and light in bright rooms would grow with each reflection. So it
 * is a factor of B, found from the answer of the turn before: light is solved for in
 * turns, until one changes nothing. In the first turn all factors are 1. The links' light
 * may lack much in a gap, and by it some factors would be so high that a bright room
 * reflects more than it receives.
 *
 * Where a box stands on part of a leaf, rays from there meet its inside: that part is
 * dark, so the part seen by others is brighter than the mean, by the inverse of its
 * share.
 *
 * Rejected: the defect solved for over the links, and added. Where links reflect less
 * than is right, as in bright closed rooms, each round leaves nine tenths of it. */
#include "rad/beyond/gather/equation.h"

#include <math.h>

#include "geom/alloc.h"
#include "rad/beyond/gather/row.h"

/* A leaf is seen brighter than its mean by at most the inverse of this. */
static const double LEAST_OUTSIDE = 0x1p-6;

/* Leaves with less than this part of the mean radiosity weigh as if they had so much. */
static const double DARK = 1e-3;

/* Arrays have room for all leaves; what is not used of them takes no memory. */
struct equation equation_start(struct final_gather *gather,
                               const struct gather_mesh *mesh, struct totals totals)
{
    size_t count = (size_t)mesh->count;
    struct equation e = {.gather = gather, .mesh = mesh, .totals = totals};
    e.number = alloc_array(count, sizeof *e.number);
    e.space = alloc_array(count, sizeof *e.space);
    e.areas = alloc_array(count, sizeof *e.areas);
    e.shown = alloc_array(count, sizeof *e.shown);
    e.fired = alloc_array(2 * (size_t)lit_count(gather->model), sizeof *e.fired);
    return e;
}

void equation_free(struct equation *e)
{
    alloc_free(e->number);
    alloc_free(e->space);
    alloc_free(e->areas);
    alloc_free(e->shown);
    alloc_free(e->fired);
    alloc_free(e->radiosity);
    alloc_free(e->outside);
}

/* --- rows --- */

void equation_make_row(void *equation, int64_t number)
{
    struct equation *e = equation;
    const struct model *model = e->gather->model;
    const struct gather_mesh *mesh = e->mesh;
    const struct gather_counts *counts = &e->gather->counts;
    int32_t patch = mesh->leaves[number], space = node_space(model, patch);
    int64_t *fired = e->fired + 2 * space, leaf = e->count++;
    fired[0] += 1 - counts->rays;
    fired[1] -= counts->escaped;
    final_gather_add_row(e->gather, patch, mesh->rays[number], mesh->segments[number],
                         mesh->exact[number]);
    fired[0] += counts->rays;
    fired[1] += counts->escaped;
    e->number[leaf] = number;
    e->shown[leaf] = rgb_grey(1.0);
    e->space[leaf] = space;
    e->areas[leaf] = forest_area(model->forest, patch);
}

void equation_find_outside(struct equation *e, const int32_t *place,
                           const struct rgb *shares)
{
    const struct forest *forest = e->gather->model->forest;
    const int32_t *at = e->gather->place;
    e->radiosity = alloc_array((size_t)forest->count, sizeof *e->radiosity);
    e->outside = alloc_array((size_t)forest->count, sizeof *e->outside);
    for (int64_t k = 0; k < e->mesh->count; k++)
        e->outside[place[k]] = shares[k].band[0];
    for (int64_t first = forest->count - 4; first >= forest->root_count; first -= 4)
        for (int k = 0; k < 4; k++) /* sisters follow each other */
            e->outside[at[forest->patches[first].parent]] +=
                0.25 * e->outside[at[first + k]];
}

double equation_shining_area(const struct equation *e, int64_t leaf)
{
    const struct cover *cover = equation_cover(e, leaf);
    bool lamp = root_is_lamp(e->gather, equation_root(e, leaf));
    return (lamp ? e->areas[leaf] : equation_bare_area(e, leaf)) *
           (double)cover->outside * (double)cover->kept;
}

/* --- what rows see --- */

/* The pull: inner patches get the mean of their leaves, by the shares of these outside of
 * things. A patch without such a share gets B of its parent, since the slope over its
 * sisters takes its B, too. Where a thing is across the parent there is no slope. */
static void pull(struct equation *e)
{
    const struct final_gather *gather = e->gather;
    const struct forest *forest = gather->model->forest;
    const double *share = e->outside;
    const int32_t *place = gather->place;
    struct rgb *radiosity = e->radiosity;
    /* sisters follow each other, and are made after their parents */
    for (int64_t first = forest->count - 4; first >= forest->root_count; first -= 4) {
        int32_t parent = place[forest->patches[first].parent];
        for (int c = 0; c < BANDS && share[parent] > 0.0; c++) {
            double sum = 0.0;
            for (int k = 0; k < 4; k++)
                sum += share[place[first + k]] * radiosity[place[first + k]].band[c];
            radiosity[parent].band[c] = 0.25 * sum / share[parent];
        }
    }
    for (int64_t p = forest->root_count; p < forest->count; p++) {
        int32_t parent = forest->patches[p].parent;
        if (!(share[place[p]] > 0.0) && !(gather->cut && gather->cut[parent]))
            radiosity[place[p]] = radiosity[place[parent]];
    }
}

void equation_set(struct equation *e, const int32_t *place, const struct rgb *values)
{
    for (int64_t k = 0; k < e->mesh->count; k++)
        e->radiosity[place[k]] = values[k];
    pull(e);
}

void equation_show(const struct equation *e, const struct rgb *b, bool lamps,
                   struct rgb *seen)
{
    for (int64_t i = 0; i < e->count; i++) {
        double share = fmax(LEAST_OUTSIDE, (double)equation_cover(e, i)->outside);
        struct rgb emission = equation_material(e, i)->emission;
        seen[i] = b[i];
        for (int c = 0; c < BANDS && share < 1.0; c++) {
            double own = lamps ? emission.band[c] : 0.0;
            seen[i].band[c] = own + (b[i].band[c] - own) / share;
        }
        seen[i] = rgb_times(seen[i], e->shown[i]);
    }
}

void equation_show_means(struct equation *e, const struct rgb *b, struct rgb *seen)
{
    for (int64_t i = 0; i < e->count; i++)
        e->shown[i] = rgb_grey(1.0);
    equation_show(e, b, true, seen);
}

void equation_add_near(const struct equation *e, int64_t *watts)
{
    const struct final_gather *gather = e->gather;
    for (int64_t row = 0, i = 0; row < gather->count; row++) {
        double area = forest_area(gather->model->forest, gather->rows[row].leaf);
        for (; i < gather->rows[row].end; i++) {
            const struct gather_term *term = &gather->terms[i];
            for (int c = 0; c < BANDS && term->near >= 0; c++)
                watts[BANDS * term->near + c] += gather_units(
                    area * (double)term->weight[c] * e->radiosity[term->place].band[c],
                    gather->near->unit_watts);
        }
    }
}

void equation_set_shown(struct equation *e, const int64_t *watts)
{
    const struct gather_nears *nears = e->gather->near;
    for (int64_t i = 0; i < e->count; i++) {
        int32_t place = equation_place(e, i);
        const struct gather_near *near = &nears->items[place];
        const struct rgb *own = &e->radiosity[place];
        const struct cover *cover = equation_cover(e, i);
        double area = e->areas[i] * fmax(LEAST_OUTSIDE, (double)cover->outside);
        double part = (double)near->area * nears->unit_area / area;
        double unit = nears->unit_watts / (area * fmax(1.0, part));
        double n = fmin(1.0, part), damping = fmin(1.0, 2.0 * (1.0 - n));
        for (int c = 0; c < BANDS; c++) {
            double met = (double)(watts[BANDS * place + c] + near->watts[c]) * unit;
            met = fmax(0.0, met); /* n L; slopes may bring it below */
            double excess = own->band[c] > 0.0 ? n - met / own->band[c] : 0.0;
            e->shown[i].band[c] = fmax(0.0, 1.0 + damping * excess);
        }
    }
}

/* --- light --- */

void equation_multiply(const struct equation *e, bool lamps, struct rgb *h)
{
    for (int64_t row = 0; row < e->gather->count; row++)
        h[row] = final_gather_irradiance(e->gather, row, e->radiosity, lamps);
}

void equation_reflect(const struct equation *e, const struct rgb *h, struct rgb *b)
{
    for (int64_t i = 0; i < e->count; i++) {
        const struct material *m = equation_material(e, i);
        b[i] = m->emission;
        rgb_add(&b[i], 1.0, rgb_times(m->reflectance, h[i]));
    }
}

double *equation_weigh(const struct equation *e, const struct rgb *b)
{
    int32_t spaces = lit_count(e->gather->model);
    double *weights = alloc_array((size_t)e->count, sizeof *weights);
    double *terms = alloc_array(2 * (size_t)e->count, sizeof *terms);
    double *sums = alloc_array(2 * (size_t)spaces, sizeof *sums); /* light, leaves */
    for (int64_t i = 0; i < e->count; i++) {
        terms[2 * i] = e->areas[i] * rgb_sum(b[i]);
        terms[2 * i + 1] = 1.0;
    }
    total_groups(&e->totals, terms, e->space, e->count, spaces, 2, sums);
    for (int64_t i = 0; i < e->count; i++) {
        const double *sum = &sums[2 * e->space[i]];
        double least = DARK * e->gather->lit[e->space[i]].mean;
        if (sum[0] > 0.0)
            weights[i] = e->areas[i] / sum[0] +
                         1.0 / (sum[1] * fmax(rgb_sum(b[i]), least));
    }
    alloc_free(sums);
    alloc_free(terms);
    return weights;
}

void equation_powers(const struct equation *e, const struct rgb *h,
                     const struct rgb *b, double *absorbed, double *escaped)
{
    double sums[3], *terms = alloc_array(3 * (size_t)e->count, sizeof *terms);
    for (int64_t i = 0; i < e->count; i++) {
        const struct material *m = equation_material(e, i);
        double bare = equation_bare_area(e, i), *term = &terms[3 * i];
        if (scene_is_sky(e->gather->model->scene, equation_root(e, i)))
            continue;
        for (int c = 0; c < BANDS; c++) {
            double rho = m->reflectance.band[c], stays = 1.0 - m->transmittance.band[c];
            term[0] += bare * (stays - rho) * h[i].band[c];
            term[1] += bare * stays * h[i].band[c];
            term[2] += bare * (b[i].band[c] - m->emission.band[c]) +
                       e->areas[i] * m->emission.band[c]; /* what is covered, is lost */
        }
    }
    total_up(&e->totals, terms, e->count, 3, sums);
    *absorbed = sums[0];
    *escaped = sums[2] - sums[1];
    alloc_free(terms);
}
