/* Whole runs of the paper's method and of links, on any number of ranks: where the
 * iteration stops, where the power goes, and how links are dealt. Rank 0 reports. (How
 * far furnaces are off is in tests/panel/table.) */
#include <math.h>

#include "mpi/beyond/beyond.h"
#include "rad/beyond/patch_link.h"
#include "tests/scenes.h"
#include "tests/solve.h"
#include "tests/tap.h"

static struct scene *furnace_of(double reflectance)
{
    struct scene *cube = cube_create();
    for (int face = 0; face < 6; face++)
        cube->materials[face] = material_grey(reflectance, 1.0);
    return cube;
}

/* A cube at one level, so that all patches are alike: the error is the disk's.
 * The last change of energy is within the tolerance; the rest is that times q / (1 - q),
 * with the factor q = rho R of one iteration: the paper's stop leaves so much of it. */
static void test_iteration_stop(const struct comm *comm, double rho, double tolerance)
{
    struct solution rough = solve(comm, furnace_of(rho), criterion_of(1.0, 0, tolerance));
    double row = rough.stats.row_sum_mean; /* all rows are the same here */
    double exact = 1.0 / (1.0 - rho * row);
    double b = rough.solver->model.forest->radiosity[0].band[0];
    if (comm->rank == 0) {
        tap_ok(rough.stats.row_sum_max - rough.stats.row_sum_min < 1e-12,
               "max-level 0: all rows sum to %.6f", row);
        double left = fabs(b / exact - 1.0), q = rho * row;
        tap_ok(rough.vote.converged && left <= tolerance * q / (1.0 - q) &&
                   left > tolerance * q * q / (1.0 - q),
               "rho %g: the change is within %g when the rest of E / (1 - rho R) is %.2g",
               rho, tolerance, left);
    }
    solution_free(&rough);
}

/* Radiosity of a node, sum over bands, W/m^2. */
static double light_of(const struct model *model, int32_t node)
{
    return rgb_sum(node_is_cluster(node) ? model->clusters->radiosity[~node]
                                         : model->forest->radiosity[node]);
}

/* The radiosity of a node as a link takes it, sum over bands, W/m^2. */
static double sent_by(const struct model *model, int32_t node, const uint8_t parts[3])
{
    double sum = 0.0;
    if (!node_is_cluster(node) && patch_is_leaf(&model->forest->patches[node]))
        return light_of(model, node);
    for (int k = 0; k < 4; k++) {
        int32_t child = node_is_cluster(node)
                            ? model->clusters->tree->clusters[~node].child[k]
                            : model->forest->patches[node].children + k;
        sum += child == NODE_NONE ? 0.0 : link_part(parts, k) * light_of(model, child);
    }
    return sum;
}

/* Power delivered, link by link in double precision, on all ranks together. */
static double power_of_links(const struct solution *s)
{
    const struct model *model = &s->solver->model;
    double own = 0.0, sum = 0.0;
    if (model->clusters)
        cluster_light_average(model->clusters, model->forest, model->forest->radiosity,
                              model->clusters->radiosity);
    for (int64_t i = 0; i < s->solver->links.count; i++) {
        const struct link *link = &s->solver->links.items[i];
        own += link_area(link) * (sent_by(model, link->p, link->parts_p) +
                                  sent_by(model, link->q, link->parts_q));
    }
    MPI_Request request;
    MPI_Iallreduce(&own, &sum, 1, MPI_DOUBLE, MPI_SUM, s->solver->comm->handle, &request);
    comm_wait(&request);
    return sum;
}

/* An open cube (no front) lit from the top: light that leaves the surfaces and is not
 * delivered by the links has escaped, and all that was emitted is absorbed or escapes. */
static void test_power(const struct comm *comm, const struct criterion *criterion,
                       const char *name)
{
    struct scene *cube = cube_create();
    for (int c = 0; c < BANDS; c++) {
        for (int face = 0; face < 6; face++)
            cube->materials[face].reflectance.band[c] = 0.2 + 0.1 * face + 0.05 * c;
        cube->materials[1].emission.band[c] = 5.0 + c;
    }
    cube->areas[4] = cube->areas[5] = 0.0; /* the front is gone */
    cube->planes[4] = cube->planes[5] = (struct plane){{0.0, 0.0, 0.0}, 0.0};
    struct solution s = solve(comm, cube, *criterion);
    const struct forest *forest = s.solver->model.forest;
    double leaving = 0.0, emitted = s.stats.emitted_power;
    for (int32_t root = 0; root < forest->root_count; root++)
        leaving += forest_area(forest, root) * rgb_sum(forest->radiosity[root]);
    double escaped = (leaving - power_of_links(&s)) * scene_area_unit(s.scene);
    double balance = s.stats.absorbed_power + s.stats.escaped_power - emitted;
    if (comm->rank == 0) {
        tap_ok(fabs(balance) <= 1e-9 * emitted,
               "%s: absorbed + escaped = emitted: off by %.1e", name,
               fabs(balance) / emitted);
        tap_ok(fabs(escaped - s.stats.escaped_power) <= 1e-9 * emitted,
               "%s: the links do not deliver the escaped power: off by %.1e", name,
               fabs(escaped - s.stats.escaped_power) / emitted);
        tap_ok(escaped > 0.1 * emitted,
               "much of it escapes through the missing front: %.0f %%",
               100.0 * escaped / emitted);
    }
    solution_free(&s);
}

/* The sum over ranks of two fields of a level. */
static void sum_shares(const struct level_balance *level, int ranks,
                       struct level_share *sum)
{
    *sum = (struct level_share){0};
    for (int r = 0; r < ranks; r++) {
        sum->links += level->shares[r].links;
        sum->load += level->shares[r].load;
        sum->predicted += level->shares[r].predicted;
        sum->sent += level->shares[r].sent;
        sum->received += level->shares[r].received;
    }
}

/* The proxies of this rank by brute force: patches of other homes that some link has. */
static int64_t find_proxies(const struct solver *solver)
{
    const struct forest *forest = solver->model.forest;
    int64_t count = 0;
    for (int32_t p = 0; p < forest->count; p++) {
        bool is_met = false;
        for (int64_t i = 0; i < solver->links.count && !is_met; i++)
            is_met = solver->links.items[i].p == p || solver->links.items[i].q == p;
        count += is_met &&
                 solver->homes.owner[forest->patches[p].id.root] != solver->comm->rank;
    }
    return count;
}

/* Links that move before the levels of a solution, on all ranks together. */
static int64_t sent_in(const struct solution *s, int ranks)
{
    int64_t sent = 0;
    for (int64_t i = 0; i < s->stats.level_count; i++)
        for (int r = 0; r < ranks; r++)
            sent += s->stats.levels[i].shares[r].sent;
    return sent;
}

/* The greedy plan at work: with several ranks links migrate, and after that no level of
 * many links is predicted to be uneven by more than a fiftieth. Links that are sent are
 * received, and their loads with them. Iteration 0 is initial linking. With --balance
 * none links are split where their parents were, with the same result. */
static void test_balance(const struct comm *comm)
{
    struct criterion criterion = criterion_of(1e-4, 10, 1e-3);
    struct solution s = solve(comm, furnace_of(0.5), criterion);
    criterion.balance = BALANCE_NONE;
    struct solution none = solve(comm, furnace_of(0.5), criterion);
    double worst = 1.0;
    int64_t large = 0, sent = sent_in(&s, comm->size);
    bool adds_up = true, proxies = true;
    for (int64_t i = 0; i < s.stats.level_count; i++) {
        const struct level_balance *level = &s.stats.levels[i];
        struct level_share sum;
        sum_shares(level, comm->size, &sum);
        adds_up = adds_up && sum.links == level->links && sum.sent == sum.received &&
                  sum.load == sum.predicted;
        if (level->pass == 0 || level->links < 100 * comm->size)
            continue;
        large++;
        worst = fmax(worst, level->predicted_max / level->predicted_mean);
    }
    for (int r = 0; r < comm->size; r++)
        proxies = proxies && (s.stats.holdings[r].proxies > 0) == (comm->size > 1);
    int64_t found = find_proxies(s.solver), told = s.stats.holdings[comm->rank].proxies;
    int64_t wrong = told < found || told > found + found / 8; /* a proxy stays one */
    comm_add(comm, &wrong, 1);
    if (comm->rank == 0) {
        tap_ok((sent > 0) == (comm->size > 1), "%lld links move before levels",
               (long long)sent);
        tap_ok(adds_up, "links that are sent are received, and their loads with them");
        tap_ok(large > 0 && worst < 1.02,
               "on %lld levels of 100 links a rank and more, the "
               "largest load is at most 2 %% above the mean: %.2f %%",
               (long long)large, 100.0 * (worst - 1.0));
        tap_ok(proxies && wrong == 0,
               "every rank reports its proxies, one alone has none");
        tap_ok(sent_in(&none, comm->size) == 0 &&
                   none.stats.checksum == s.stats.checksum,
               "without balancing no link moves, and the light is the same");
    }
    solution_free(&s);
    solution_free(&none);
}

int main(int argc, char **argv)
{
    struct comm comm;
    comm_start(&comm, &argc, &argv);
    test_iteration_stop(&comm, 0.9, 1e-6);
    struct criterion power = criterion_of(1e-4, 10, 1e-12);
    test_power(&comm, &power, "paper");
    power = criterion_best(1e-4, 10, 1e-12);
    test_power(&comm, &power, "error oracle, polygons, cg, tree");
    test_balance(&comm);
    comm_stop(&comm);
    return comm.rank == 0 ? tap_done() : alloc_balance() != 0;
}
