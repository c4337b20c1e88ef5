/* Conjugate residuals (rad/beyond/conjugate.h, mpi/beyond/descent.c) and the caps on row
 * sums against Gaussian elimination: a made-up forest with random
 * links, whose form factors are written down here once more as a dense matrix. On any
 * number of ranks; rank 0 reports. */
#include "mpi/beyond/create.h"

#include "rad/beyond/patch_link.h"
#include "tests/scenes.h"
#include "tests/solve.h"
#include "tests/tap.h"

enum { ROOTS = 9, BLACK = 4, LEAVES_MAX = 200 };

/* Of the links: rows that sum to 1 or so at most, and rows that all need a cap. */
static const double WEAK = 1.0, STRONG = 4.0;

struct problem {
    const struct comm *comm;
    struct scene *scene;
    struct solver *solver;
    int32_t leaves[LEAVES_MAX]; /* local numbers */
    int count;
};

/* Roots of made-up areas: 4 is black, 6 black in one band; 0 and 3 glow. */
static struct scene *make_scene(double rho)
{
    struct scene *scene = scene_create(ROOTS, ROOTS);
    struct random random = random_seed(3);
    for (int32_t i = 0; i < ROOTS; i++) {
        scene->areas[i] = 0.05 + 0.1 * random_unit(&random);
        scene->material_of[i] = i;
        for (int c = 0; c < BANDS && i != BLACK; c++)
            scene->materials[i].reflectance.band[c] =
                rho * (0.5 + 0.5 * random_unit(&random));
    }
    scene->materials[6].reflectance.band[1] = 0.0;
    scene->materials[0].emission = (struct rgb){{3.0, 0.5, 1.0}};
    scene->materials[3].emission = (struct rgb){{0.0, 2.0, 1e-3}};
    scene->materials[BLACK].emission = (struct rgb){{0.1, 0.0, 0.2}};
    return scene;
}

/* A link from every root, and every child if there are any, to every other root, with
 * random parts where there are children. Every rank keeps its share. */
static void add_links(struct solver *solver, double strength)
{
    struct forest *forest = solver->model.forest;
    struct random random = random_seed(99);
    int number = 0;
    for (int32_t p = 0; p < forest->count; p++)
        for (int32_t q = 0; q < ROOTS; q++) {
            struct link link = {.p = p, .q = q, .seen = LINK_ALL_SEEN};
            double least = fmin(forest_area(forest, p), forest_area(forest, q));
            link.area =
                float_below(strength * 0.035 * least * (0.5 + random_unit(&random)));
            for (int k = 0; k < 3; k++) {
                link.parts_p[k] = (uint8_t)random_below(&random, 86);
                link.parts_q[k] = (uint8_t)random_below(&random, 86);
            }
            if (forest->patches[p].id.root < (uint32_t)q &&
                number++ % solver->comm->size == solver->comm->rank)
                link_list_append(&solver->links, link);
        }
}

static struct criterion criterion_to(double tolerance, int max_iterations)
{
    return (struct criterion){.oracle = ORACLE_ERROR,
                              .solver = SOLVER_CG,
                              .tolerance = tolerance,
                              .max_level = 15,
                              .max_iterations = max_iterations};
}

/* `splits` roots are split, and a child of each of them. */
static struct problem problem_make(const struct comm *comm, double strength, double rho,
                                   int splits, const struct criterion *criterion)
{
    struct problem problem = {.comm = comm, .scene = make_scene(rho)};
    problem.solver = beyond_create(comm, problem.scene, NULL, criterion);
    struct solver *solver = problem.solver;
    struct forest *forest = solver->model.forest;
    for (int32_t root = 0; root < splits; root++) {
        forest_split(forest, root);
        forest_split(forest, forest->patches[root].children + root % 4);
    }
    solver->turn.first_new = forest->count;
    add_links(solver, strength);
    solver_assign_roots(solver);
    for (int32_t p = 0; p < forest->count; p++)
        if (patch_is_leaf(&forest->patches[p]))
            problem.leaves[problem.count++] = p;
    return problem;
}

static void problem_free(struct problem *problem)
{
    solver_destroy(problem->solver);
    scene_destroy(problem->scene);
}

/* The leaf's share of a link of `patch`: 0 if the leaf is not below it. */
static double share_of(const struct forest *forest, int32_t leaf, int32_t patch,
                       const uint8_t parts[3])
{
    double share = 1.0;
    for (int32_t p = leaf; p >= 0; p = forest->patches[p].parent) {
        if (p == patch)
            return share;
        int32_t parent = forest->patches[p].parent;
        if (parent >= 0)
            share *= parent == patch
                         ? link_part(parts, p - forest->patches[parent].children)
                         : 0.25;
    }
    return 0.0;
}

/* f[i][j] += from leaf j to leaf i, summed over the links of all ranks. */
static void build(const struct problem *problem, double f[LEAVES_MAX][LEAVES_MAX])
{
    static double own[LEAVES_MAX][LEAVES_MAX];
    const struct forest *forest = problem->solver->model.forest;
    for (int i = 0; i < problem->count; i++)
        for (int j = 0; j < problem->count; j++) {
            int32_t a = problem->leaves[i], b = problem->leaves[j];
            own[i][j] = 0.0;
            for (int64_t k = 0; k < problem->solver->links.count; k++) {
                const struct link *link = &problem->solver->links.items[k];
                double there = share_of(forest, a, link->p, link->parts_p) *
                               share_of(forest, b, link->q, link->parts_q);
                double back = share_of(forest, a, link->q, link->parts_q) *
                              share_of(forest, b, link->p, link->parts_p);
                own[i][j] += (double)link->area * (there + back) / forest_area(forest, a);
            }
        }
    MPI_Request request;
    MPI_Iallreduce(own, f, LEAVES_MAX * LEAVES_MAX, MPI_DOUBLE, MPI_SUM,
                   problem->comm->handle, &request);
    comm_wait(&request);
}

/* Solves a x = b in place, with pivots. */
static void eliminate(double a[LEAVES_MAX][LEAVES_MAX], double *b, int n)
{
    for (int k = 0; k < n; k++) {
        int pivot = k;
        for (int i = k + 1; i < n; i++)
            pivot = fabs(a[i][k]) > fabs(a[pivot][k]) ? i : pivot;
        for (int j = 0; j < n; j++) {
            double swap = a[k][j];
            a[k][j] = a[pivot][j];
            a[pivot][j] = swap;
        }
        double swap = b[k];
        b[k] = b[pivot];
        b[pivot] = swap;
        for (int i = 0; i < n; i++) {
            double factor = i == k ? 0.0 : a[i][k] / a[k][k];
            for (int j = k; j < n && factor != 0.0; j++)
                a[i][j] -= factor * a[k][j];
            b[i] -= factor * b[k];
        }
    }
    for (int k = 0; k < n; k++)
        b[k] /= a[k][k];
}

/* Largest difference of B from E + rho H, (1 - d F rho) H = d F E, over the largest
 * B. */
static double deviation(const struct problem *problem, double f[LEAVES_MAX][LEAVES_MAX])
{
    static double a[LEAVES_MAX][LEAVES_MAX], h[LEAVES_MAX];
    const struct solver *solver = problem->solver;
    const struct forest *forest = solver->model.forest;
    double worst = 0.0, largest = 0.0, caps[LEAVES_MAX];
    for (int i = 0; i < problem->count; i++) /* each home chooses those of its leaves */
        caps[i] = comm_largest(problem->comm, forest->caps[problem->leaves[i]]);
    for (int c = 0; c < BANDS; c++) {
        for (int i = 0; i < problem->count; i++) {
            h[i] = 0.0;
            for (int j = 0; j < problem->count; j++) {
                const struct material *m = forest_material(forest, problem->leaves[j]);
                double factor = f[i][j] * caps[i];
                a[i][j] = (i == j ? 1.0 : 0.0) - factor * m->reflectance.band[c];
                h[i] += factor * m->emission.band[c];
            }
        }
        eliminate(a, h, problem->count);
        for (int i = 0; i < problem->count; i++) {
            const struct material *m = forest_material(forest, problem->leaves[i]);
            double exact = m->emission.band[c] + m->reflectance.band[c] * h[i];
            double b = forest->radiosity[problem->leaves[i]].band[c];
            worst = fmax(worst, fabs(b - exact));
            largest = fmax(largest, exact);
        }
    }
    return worst / largest;
}

/* By how much the capped row sum R of a leaf times rho exceeds c = (1 + rho) / 2, at
 * most; and by how much a factor differs from min(1, c / (rho R)). Counts capped rows. */
static double above_cap(const struct problem *problem, double f[LEAVES_MAX][LEAVES_MAX],
                        int64_t *capped)
{
    const struct solver *solver = problem->solver;
    double off = 0.0;
    *capped = 0;
    for (int i = 0; i < problem->count; i++) {
        int32_t leaf = problem->leaves[i];
        if (!solver->homes.own[solver->model.forest->patches[leaf].id.root])
            continue;
        struct rgb rho = forest_material(solver->model.forest, leaf)->reflectance;
        double largest = fmax(rho.band[0], fmax(rho.band[1], rho.band[2])), row = 0.0;
        for (int j = 0; j < problem->count; j++)
            row += f[i][j];
        double factor = solver->model.forest->caps[leaf];
        double most = 0.5 * (1.0 + largest);
        double wanted = largest * row > most ? most / (largest * row) : 1.0;
        off = fmax(off, fmax(factor * row * largest - most, fabs(factor - wanted)));
        *capped += factor < 1.0;
    }
    comm_add(problem->comm, capped, 1);
    return comm_largest(problem->comm, off);
}

static void test_dense(const struct comm *comm, double strength, double rho, int splits)
{
    static double f[LEAVES_MAX][LEAVES_MAX];
    struct criterion criterion = criterion_to(1e-12, 1000);
    struct problem problem = problem_make(comm, strength, rho, splits, &criterion);
    struct vote vote = solve_links(problem.solver);
    build(&problem, f);
    int64_t capped;
    double off = deviation(&problem, f);
    double above = above_cap(&problem, f, &capped);
    int steps =
        (int)problem.solver->turn.iteration - 1; /* the first transfer is of B itself */
    int most = 0; /* in exact arithmetic as many steps as there are unknowns, at most */
    for (int i = 0; i < problem.count; i++)
        most += rgb_sum(forest_material(problem.solver->model.forest,
                                        problem.leaves[i])->reflectance) > 0.0;
    if (comm->rank == 0) {
        /* The bound asks for 1e-12 of all light; fluxes are rounded to 2^-61 or so. */
        tap_ok(vote.converged && off < 1e-9,
               "links times %g, rho to %g, %d leaves: as by elimination, to %.1e of the "
               "largest B",
               strength, rho, problem.count, off);
        most = most < 16 ? most : 16; /* up to 13 here; 23 by weights without caps */
        tap_ok(steps <= most, "in %d steps, at most %d", steps, most);
        tap_ok(above < 1e-8 && (capped > 0 || strength == WEAK),
               "%lld rows are capped, none times rho is above its cap: by %.1e",
               (long long)capped, above);
    }
    problem_free(&problem);
}

/* A start from the last answer is good enough at once; its factors are found again. */
static void test_restart(const struct comm *comm)
{
    struct criterion criterion = criterion_to(1e-6, 1000);
    struct problem problem = problem_make(comm, STRONG, 0.9, 4, &criterion);
    solve_links(problem.solver);
    int64_t before = problem.solver->turn.iteration;
    problem.solver->turn.fresh = true;
    struct vote vote = solve_links(problem.solver);
    if (comm->rank == 0)
        tap_ok(before > 3 && vote.converged &&
                   problem.solver->turn.iteration == before + 1,
               "from its own answer it needs no step");
    problem_free(&problem);
}

/* Light that a and b differ by, relative to that of a. */
static double difference(const struct problem *a, const struct problem *b)
{
    const struct forest *p = a->solver->model.forest, *q = b->solver->model.forest;
    double missing = 0.0, light = 0.0;
    for (int i = 0; i < a->count; i++)
        for (int c = 0; c < BANDS; c++) {
            int32_t leaf = a->leaves[i];
            double at = p->radiosity[leaf].band[c];
            missing += forest_area(p, leaf) * fabs(at - q->radiosity[leaf].band[c]);
            light += forest_area(p, leaf) * at;
        }
    return missing / light;
}

/* The bound on the missing light holds after each step, and is not much too large. */
static void test_bound(const struct comm *comm, double strength)
{
    struct criterion criterion = criterion_to(1e-12, 1000);
    struct problem exact = problem_make(comm, strength, 0.8, 3, &criterion);
    double first = 0.0, last = 0.0, closest = 0.0, furthest = 1.0;
    bool counted = true;
    solve_links(exact.solver);
    for (int most = 1; most <= 8; most++) {
        criterion.max_iterations = most;
        struct problem problem = problem_make(comm, strength, 0.8, 3, &criterion);
        struct vote vote = solve_links(problem.solver);
        double part = difference(&problem, &exact) / vote.remaining;
        counted = counted && problem.solver->turn.iteration == most;
        closest = fmax(closest, part);
        furthest = fmin(furthest, part);
        first = most == 1 ? vote.remaining : first;
        last = vote.remaining;
        problem_free(&problem);
    }
    if (comm->rank == 0)
        tap_ok(counted && last < 1e-3 * first && closest <= 1.0 && furthest >= 0.003,
               "links times %g: the missing light is %.3f to %.3f of its bound, %.1e at "
               "first, %.1e after 7 steps",
               strength, furthest, closest, first, last);
    problem_free(&exact);
}

/* Where all rows, reflectances and emissions are the same, the bound is the missing
 * light. Rows sum to 1. */
static void test_bound_is_sharp(const struct comm *comm)
{
    const double rho = 0.6, area = 0.1;
    struct criterion criterion = criterion_to(1e-12, 1);
    struct scene *scene = make_scene(0.0);
    for (int32_t i = 0; i < ROOTS; i++) {
        scene->areas[i] = area;
        scene->materials[i] = (struct material){.reflectance = {{rho, rho, rho}},
                                                 .emission = {{1.0, 1.0, 1.0}}};
    }
    struct solver *solver = beyond_create(comm, scene, NULL, &criterion);
    solver->turn.first_new = solver->model.forest->count;
    int number = 0;
    for (int32_t p = 0; p < ROOTS; p++)
        for (int32_t q = p + 1; q < ROOTS; q++) {
            struct link link = {.p = p, .q = q, .seen = LINK_ALL_SEEN,
                                .parts_p = {64, 64, 64}, .parts_q = {64, 64, 64},
                                .area = (float)(area / (ROOTS - 1))};
            if (number++ % comm->size == comm->rank)
                link_list_append(&solver->links, link);
        }
    solver_assign_roots(solver);
    struct vote vote = solve_links(solver);
    double missing = (1.0 / (1.0 - rho) - (1.0 + rho)) / (1.0 + rho); /* B: E (1 + rho) */
    if (comm->rank == 0)
        tap_ok(fabs(vote.remaining / missing - 1.0) < 1e-6,
               "a furnace's missing light after one transfer is %.7f of the "
               "bound",
               missing / vote.remaining);
    solver_destroy(solver);
    scene_destroy(scene);
}

int main(int argc, char **argv)
{
    struct comm comm;
    comm_start(&comm, &argc, &argv);
    test_dense(&comm, WEAK, 0.5, 0);
    test_dense(&comm, WEAK, 0.99, 0);
    for (int k = 0; k < 2; k++) {
        double strength = k ? STRONG : WEAK;
        test_dense(&comm, strength, 0.9, 6);
        test_dense(&comm, strength, 0.999, 9);
        test_bound(&comm, strength);
    }
    test_dense(&comm, WEAK, 0.0, 3); /* nothing is reflected: H = F E, at once */
    test_restart(&comm);
    test_bound_is_sharp(&comm);
    comm_stop(&comm);
    return comm.rank == 0 ? tap_done() : alloc_balance() != 0;
}
