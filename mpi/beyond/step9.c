/* Step 9, phr's own: the final gather and its solution, on all ranks.
 *
 * 1. The mesh: leaves are looked at and split (mpi/beyond/mesh.c).
 * 2. Rows: dealt to ranks, which keep what they make (mpi/beyond/stages.c).
 * 3. The equation of rows is solved, in turns (rad/beyond/gather/equation.h): a rank has
 *    the values of its rows' leaves. For each product with the rows all ranks learn what
 *    rows see of all leaves.
 * 4. The claim: how wrong each leaf may be (rad/beyond/gather/claim.h).
 * 5. All ranks learn the answer, which pictures are made of. */
#include "mpi/beyond/step9.h"

#include <math.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/stop.h"
#include "mpi/beyond/beyond.h"
#include "mpi/beyond/descent.h"
#include "mpi/beyond/mesh.h"
#include "mpi/beyond/stages.h"
#include "rad/beyond/bicgstab.h"
#include "rad/beyond/gather/claim.h"
#include "rad/pushpull.h"

enum { STEPS_MOST = 500 };

/* Turns, at most; the last one only finds what is left. The fifth mostly changes nothing,
 * and ends them. In gaps of rho .999 each turn leaves .6 of the error. */
enum { TURNS_MOST = 40 };

/* The part of the residual that each turn leaves: the factors of the next turn change the
 * residual by as much. */
static const double LEFT = 0.03;

/* A final gather on one rank. */
struct gathering {
    struct solver *solver;
    struct gather_mesh mesh;
    struct final_gather *gather;
    struct equation equation;
    struct light_balance balance;
    struct stages stages; /* who has which rows */
    int32_t *leaf;        /* [leaves] number of each, rank by rank in the order of rows */
    int32_t *place;       /* [leaves] its place in equation.radiosity */
    struct rgb *all;      /* [leaves] buffer: a value of each, in this order */
    int64_t bytes;        /* of values exchanged by ranks so far */
};

/* --- exchange --- */

/* Lists the leaves, rank by rank. */
static void list_leaves(struct gathering *g)
{
    size_t count = (size_t)g->mesh.count;
    g->leaf = alloc_array(count, sizeof *g->leaf);
    g->place = alloc_array(count, sizeof *g->place);
    g->all = alloc_array(count, sizeof *g->all);
    for (int64_t i = 0; i < g->mesh.count; i++) {
        int32_t k = g->stages.place[i];
        g->leaf[k] = (int32_t)i;
        g->place[k] = g->gather->place[g->mesh.leaves[i]];
    }
}

/* The values of this rank's rows, in g->all. */
static struct rgb *own_values(const struct gathering *g)
{
    return g->all + g->stages.at[g->solver->comm->rank];
}

/* Collective. Brings the values of each rank's rows, in g->all, to all ranks. */
static void share_values(struct gathering *g)
{
    comm_share(g->solver->comm, g->all, g->stages.counts, g->stages.at, sizeof *g->all);
    g->bytes += g->mesh.count * (int64_t)sizeof *g->all;
}

/* Collective. What rows see of all leaves, from g->all, and of inner patches. */
static void show(struct gathering *g)
{
    share_values(g);
    equation_set(&g->equation, g->place, g->all);
}

/* Collective. Adds up integers of all ranks, which go to the sum and back. */
static void add_up(struct gathering *g, int64_t *values, int64_t count)
{
    comm_add(g->solver->comm, values, count);
    g->bytes += 2 * count * (int64_t)sizeof *values;
}

/* --- rows --- */

/* Collective. All ranks learn what the rows have met: leaves too near, the shares of
 * leaves outside of things, and which spaces are closed. */
static void share_met(struct gathering *g)
{
    enum { EACH = (int)(sizeof *g->gather->near->items / sizeof(int64_t)) };
    struct equation *e = &g->equation;
    int64_t patches = g->solver->model.forest->count, crossed = g->gather->counts.crossed;
    comm_add(g->solver->comm, e->fired, 2 * lit_count(&g->solver->model));
    comm_add(g->solver->comm, &crossed, 1);
    add_up(g, &g->gather->near->items->area, EACH * patches);
    for (int64_t i = 0; i < e->count; i++)
        own_values(g)[i].band[0] = (double)equation_cover(e, i)->outside;
    share_values(g);
    equation_find_outside(e, g->place, g->all);
    g->balance = balance_start(e, crossed);
}

/* Collective. False if a signal on any rank has ended the work. */
static bool make_rows(struct gathering *g)
{
    struct solver *solver = g->solver;
    struct gather_mesh *mesh = &g->mesh;
    g->gather = mesh->gather;
    mesh->gather = NULL;
    g->gather->cut = mesh->cut;
    final_gather_renew(g->gather);
    g->equation =
        equation_start(g->gather, mesh, totals_of(solver, BANDS * mesh->count));
    progress_begin(solver->progress, "gathering", -1, 0);
    g->stages = (struct stages){.solver = solver, .gather = g->gather,
                                .act = equation_make_row, .context = &g->equation,
                                .work = mesh->work, .count = mesh->count};
    stages_run(&g->stages);
    final_gather_drop_cuts(g->gather);
    list_leaves(g);
    const struct gather_counts *counts = &g->gather->counts;
    int64_t sums[] = {stop_is_asked(), counts->rays, counts->segments, counts->exact,
                      final_gather_terms(g->gather), mesh->traced};
    comm_add(solver->comm, sums, sizeof sums / sizeof sums[0]);
    solver->beyond->answer->counts = (struct gathered){
        .rays = sums[1], .segments = sums[2], .exact = sums[3],
        .terms = sums[4], .looks = sums[5], .split = mesh->split,
        .limited = mesh->limited};
    return sums[0] == 0;
}

/* --- light --- */

/* Collective. Finds the irradiances `h` of own leaves, W/m^2, for their radiosities `b`.
 * `lamps`: `b` has emission, `h` the source. Closed spaces lose none. */
static void irradiances(struct gathering *g, const struct rgb *b, bool lamps,
                        struct rgb *h)
{
    equation_show(&g->equation, b, lamps, own_values(g));
    show(g);
    account_begin(&g->solver->account, PHASE_PRODUCTS);
    equation_multiply(&g->equation, lamps, h);
    account_end(&g->solver->account, PHASE_PRODUCTS);
    if (g->balance.any)
        balance_close(&g->balance, b, lamps, h);
}

/* Collective. Finds how bright far receivers see leaves too near. */
static void find_shown(struct gathering *g, const struct rgb *b)
{
    size_t count = BANDS * (size_t)g->solver->model.forest->count;
    int64_t *watts = alloc_array(count, sizeof *watts);
    equation_show_means(&g->equation, b, own_values(g));
    show(g);
    account_begin(&g->solver->account, PHASE_PRODUCTS);
    equation_add_near(&g->equation, watts);
    account_end(&g->solver->account, PHASE_PRODUCTS);
    add_up(g, watts, (int64_t)count);
    equation_set_shown(&g->equation, watts);
    alloc_free(watts);
}

/* Collective. y = x - rho W x. */
static void reflect(void *context, const struct rgb *x, struct rgb *y)
{
    struct gathering *g = context;
    irradiances(g, x, false, y);
    for (int64_t i = 0; i < g->equation.count; i++) {
        struct rgb rho = equation_material(&g->equation, i)->reflectance;
        y[i] = rgb_sub(x[i], rgb_times(rho, y[i]));
    }
}

/* Collective. One turn: finds how missing light is spread, by `answer`; solves for `b`;
 * makes `answer` this solution, without values below 0. `h` and `r`: buffers. */
static struct bicgstab take_turn(struct gathering *g, const double *weights,
                                 struct bicgstab_end end, struct rgb *b, struct rgb *h,
                                 struct rgb *r, struct rgb *answer)
{
    const struct equation *e = &g->equation;
    irradiances(g, answer, true, h);
    balance_spread(&g->balance, h);
    irradiances(g, b, true, h);
    equation_reflect(e, h, r);
    for (int64_t i = 0; i < e->count; i++) /* what b leaves, E + rho H - b */
        r[i] = rgb_sub(r[i], b[i]);
    struct bicgstab done =
        bicgstab_solve(reflect, g, &e->totals, weights, e->count, end, b, r);
    if (done.steps > 0)
        irradiances(g, b, true, h);
    for (int64_t i = 0; i < e->count; i++) /* slopes may go below 0 where B has changed */
        for (int c = 0; c < BANDS; c++)
            h[i].band[c] = fmax(0.0, h[i].band[c]);
    if (g->balance.any)
        balance_absorb(&g->balance, h);
    equation_reflect(e, h, answer);
    return done;
}

/* Collective. Solves the equation in turns, from the links' solution on: `answer`, and
 * its irradiances `h`. `b` and `r`: buffers. Returns the residual. */
static double solve(struct gathering *g, struct rgb *b, struct rgb *h, struct rgb *r,
                    struct rgb *answer)
{
    const struct model *model = &g->solver->model;
    for (int64_t i = 0; i < g->equation.count; i++)
        answer[i] = b[i] = model->forest->radiosity[equation_leaf(&g->equation, i)];
    struct bicgstab_end end = {
        .residual = 0.5 * model->criterion.tolerance * model->absorptance /
                    lit_count(model), /* of the sum over spaces */
        .part = LEFT, .steps = STEPS_MOST};
    double *weights = equation_weigh(&g->equation, b);
    struct bicgstab done = {.steps = 1};
    for (int turn = 1; done.steps > 0; turn++) {
        if (turn > 1)
            find_shown(g, answer);
        if (turn == TURNS_MOST)
            end.steps = 0;
        done = take_turn(g, weights, end, b, h, r, answer);
        if (balance_find_more(&g->balance, answer) && turn < TURNS_MOST)
            done.steps = 1; /* with the balance */
    }
    alloc_free(weights);
    return done.residual;
}

/* --- the answer --- */

/* Collective. Updates the vote for the gathered light. */
static void judge(const struct gathering *g, const struct rgb *h, const struct rgb *b,
                  double residual, struct vote *vote)
{
    const struct model *model = &g->solver->model;
    equation_powers(&g->equation, h, b, &vote->absorbed, &vote->escaped);
    vote->remaining =
        2.0 * residual * lit_count(model) / model->absorptance; /* most, in each space */
    vote->converged =
        vote->converged && vote->remaining <= model->criterion.tolerance;
}

/* Collective. Finds by which part the light of open spaces may be off. `h`: irradiances
 * for the radiosities `b`. `reflected`, `again`: buffers. */
static void find_unsure(struct gathering *g, const struct rgb *h, const struct rgb *b,
                        struct rgb *reflected, struct rgb *again)
{
    for (int64_t i = 0; i < g->equation.count; i++)
        reflected[i] = rgb_sub(b[i], equation_material(&g->equation, i)->emission);
    irradiances(g, reflected, false, again);
    balance_find_unsure(&g->balance, h, reflected, again);
}

/* Collective. Claims the errors of leaves with the radiosities `b`. */
static void claim(struct gathering *g, const struct rgb *b, double remaining,
                  double *errors)
{
    struct equation *e = &g->equation;
    const size_t count = (size_t)e->count, bytes = sizeof *b;
    struct rgb *mesh = alloc_array(2 * count, bytes), *rays = mesh + count;
    memcpy(own_values(g), b, count * bytes);
    show(g);
    claim_by_mesh(e, mesh);
    claim_by_rays(e, rays);
    claim_errors(&g->balance, remaining, mesh, rays, errors,
                 &g->solver->beyond->answer->counts);
    alloc_free(mesh);
}

/* Collective. All ranks learn the answer: radiosities `b`, their errors, light straight
 * from lamps, and open shares. */
static void share_answer(struct gathering *g, const struct rgb *b, const double *errors)
{
    struct answer *answer = g->solver->beyond->answer;
    struct forest *forest = g->solver->model.forest;
    const struct equation *e = &g->equation;
    size_t patches = (size_t)forest->count, count = (size_t)e->count;
    alloc_free(answer->error);
    alloc_free(answer->straight);
    alloc_free(answer->open);
    answer->error = alloc_array(patches, sizeof *answer->error);
    answer->straight = alloc_array(patches, sizeof *answer->straight);
    answer->open = alloc_array(patches, sizeof *answer->open);
    memcpy(own_values(g), b, count * sizeof *b);
    share_values(g);
    for (int64_t k = 0; k < g->mesh.count; k++)
        forest->radiosity[g->mesh.leaves[g->leaf[k]]] = g->all[k];
    for (size_t i = 0; i < count; i++)
        own_values(g)[i] =
            rgb_times(equation_material(e, (int64_t)i)->reflectance,
                      g->gather->rows[i].straight);
    share_values(g);
    for (int64_t k = 0; k < g->mesh.count; k++)
        answer->straight[g->mesh.leaves[g->leaf[k]]] = g->all[k];
    for (size_t i = 0; i < count; i++)
        own_values(g)[i] = (struct rgb){
            {errors[i], (double)equation_cover(e, (int64_t)i)->open, 0.0}};
    share_values(g);
    for (int64_t k = 0; k < g->mesh.count; k++) {
        answer->error[g->mesh.leaves[g->leaf[k]]] = (float)g->all[k].band[0];
        answer->open[g->mesh.leaves[g->leaf[k]]] = (float)g->all[k].band[1];
    }
    forest_average(forest);
}

/* Collective. Solves for light by the rows. */
static void solve_rows(struct gathering *g, struct vote *vote)
{
    size_t count = (size_t)g->equation.count;
    struct rgb *b = alloc_array(4 * count, sizeof *b);
    double *errors = alloc_array(count, sizeof *errors);
    struct rgb *h = b + count, *r = h + count, *answer = r + count;
    share_met(g);
    double residual = solve(g, b, h, r, answer);
    g->solver->beyond->answer->counts.closing = balance_missing(&g->balance);
    judge(g, h, answer, residual, vote);
    find_unsure(g, h, answer, b, r);
    claim(g, answer, vote->remaining, errors);
    share_answer(g, answer, errors);
    alloc_free(errors);
    alloc_free(b);
}

/* Hands the gather over to the solver. */
static void end(struct gathering *g)
{
    struct answer *answer = g->solver->beyond->answer;
    if (g->gather)
        final_gather_forget(g->gather);
    final_gather_destroy(answer->gather); /* of a round before */
    answer->gather = g->gather;
    equation_free(&g->equation);
    balance_free(&g->balance);
    gather_mesh_free(&g->mesh);
    stages_free(&g->stages);
    alloc_free(g->leaf);
    alloc_free(g->place);
    alloc_free(g->all);
}

enum finish solver_finish(struct solver *solver, struct vote *vote)
{
    struct gathering g = {.solver = solver};
    conjugate_free(solver->beyond->descent); /* of the links, which are solved */
    account_begin(&solver->account, PHASE_FINAL_GATHER);
    account_begin(&solver->account, PHASE_ROWS);
    bool done = solver_make_mesh(solver, vote->links, &g.mesh) && make_rows(&g);
    account_end(&solver->account, PHASE_ROWS);
    if (done)
        solve_rows(&g, vote);
    account_work(&solver->account, WORK_FINAL_GATHER, 0, g.bytes);
    end(&g);
    if (!done)
        answer_clear(solver->beyond->answer);
    account_end(&solver->account, PHASE_FINAL_GATHER);
    return done ? FINISH_DONE : FINISH_STOPPED;
}
