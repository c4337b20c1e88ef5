/* What travels between the ranks, as text for diff and awk.
 *
 * Patches come depth first, root by root; links in the order of their two patches. Areas
 * are in square units of the scene's file, radiosities in W/m^2. */
#include "tools/dump.h"

#include "geom/alloc.h"
#include "geom/stop.h"
#include "mpi/beyond/keep.h"
#include "rad/beyond/patch_link.h"
#include "tools/label.h"

/* --- patches --- */

static void print_patch(const struct run *run, double unit, int32_t p)
{
    const struct forest *forest = run->solver->model.forest;
    struct patch_id id = forest->patches[p].id;
    struct rgb b = forest->radiosity[p];
    int32_t parent = forest->patches[p].parent;
    char name[LABEL_SIZE], above[LABEL_SIZE] = "-";
    if (parent >= 0)
        label_write(forest->patches[parent].id, above);
    printf("%s %d %s %.9g %.9g %.9g %.9g %d\n", label_write(id, name), id_level(id),
           above, unit * forest_area(forest, p), b.band[0], b.band[1], b.band[2],
           run->solver->homes.owner[id.root]);
}

static void print_patches(const struct run *run, const int32_t *order, double unit)
{
    const struct forest *forest = run->solver->model.forest;
    puts("# id level parent area radiosity_r radiosity_g radiosity_b owner");
    for (int64_t i = 0; i < forest->count && !stop_is_asked(); i++)
        if (forest_area(forest, order[i]) > 0.0)
            print_patch(run, unit, order[i]);
}

/* --- links --- */

struct links_printer {
    const struct model *model;
    const int32_t *order; /* local numbers of patches, by their numbers in links */
    double unit;          /* of an area */
};

static const char *name_node(const struct links_printer *printer, int32_t node,
                             char text[LABEL_SIZE])
{
    const struct model *model = printer->model;
    int32_t local = node_is_cluster(node) ? node : printer->order[node];
    return label_write(model->method.node_id(model, local), text);
}

static void print_parts(const uint8_t parts[3])
{
    printf(" %d,%d,%d,%d", parts[0], parts[1], parts[2],
           256 - parts[0] - parts[1] - parts[2]);
}

static void print_links(void *context, const struct link *links, const int *owners,
                        int64_t count)
{
    const struct links_printer *printer = context;
    for (int64_t i = 0; i < count && !stop_is_asked(); i++) {
        const struct link *link = &links[i];
        char p[LABEL_SIZE], q[LABEL_SIZE];
        int seen = link_is_open(link) ? LINK_ALL_SEEN : link->seen;
        printf("%s %s %.9g %.4g", name_node(printer, link->p, p),
               name_node(printer, link->q, q), printer->unit * link_area(link),
               (double)seen / LINK_ALL_SEEN);
        print_parts(link->parts_p);
        print_parts(link->parts_q);
        printf(" %d\n", owners[i]);
    }
}

bool dump_print(struct run *run)
{
    if (!run->options.dump)
        return true;
    struct model *model = &run->solver->model;
    double unit = scene_area_unit(run->scene);
    int32_t *order = forest_order(model->forest);
    struct links_printer printer = {model, order, unit};
    if (run->options.dump == DUMP_PATCHES) {
        if (run->comm.rank == 0)
            print_patches(run, order, unit);
    } else {
        if (run->comm.rank == 0)
            puts("# p q exchange_area visibility parts_of_p parts_of_q owner");
        links_collect(run->solver, print_links, &printer);
    }
    alloc_free(order);
    return run_goes_on(run);
}
