/* Link caches and checkpoints: the state of a run in a file (io/run/store.h). Stored
 * solutions: light without links (io/picture/solution.h). */
#include "tools/stored.h"

#include "geom/alloc.h"
#include "geom/signals.h"
#include "geom/stop.h"
#include "mpi/beyond/keep.h"

static struct store_terms terms_of(const struct run *run, enum store_kind kind)
{
    const struct options *options = &run->options;
    return (struct store_terms){
        .kind = kind,
        .settings = kind == STORE_LINKS ? options_link_settings(options)
                                        : options_run_settings(options),
        .scene = run->scene,
        .tree = run->solver->beyond ? run->solver->beyond->tree : NULL,
    };
}

static void put_links(void *context, const struct link *links, const int *owners,
                      int64_t count)
{
    (void)owners;
    store_put_links(context, links, count);
}

/* Warns of a lost file: the run goes on. */
static void lose(struct run *run, const struct error *error)
{
    if (error->code != EXIT_DONE && !stop_is_asked())
        run_say(run, "warning: %s", error->text);
    if (run->comm.rank == 0)
        run_lose(run, error);
}

bool stored_save(struct run *run, enum store_kind kind, const char *path)
{
    struct store_terms terms = terms_of(run, kind);
    struct store_writer writer;
    struct snapshot snapshot;
    struct error error = {.code = EXIT_DONE};
    if (run->half_linked) {
        error_set(&error, EXIT_FAILED,
                  "%s: not written: linking ended at the memory limit", path);
        lose(run, &error);
        return true;
    }
    account_begin(&run->solver->account, PHASE_WRITE);
    snapshot_collect(run->solver, &run->vote, &snapshot);
    if (run->comm.rank == 0)
        store_create(&writer, path, &terms, &snapshot, &error);
    snapshot_free(&snapshot);
    if (comm_agree(&run->comm, &error)) {
        links_collect(run->solver, put_links, &writer);
        if (run->comm.rank == 0)
            store_finish(&writer, &error);
    }
    account_end(&run->solver->account, PHASE_WRITE);
    if (comm_agree(&run->comm, &error) && kind == STORE_CHECKPOINT)
        run->kept = path;
    lose(run, &error);
    return run_agree(run);
}

bool stored_complete(struct run *run)
{
    const char *path = run->options.checkpoint;
    struct error error = {.code = EXIT_DONE};
    if (!path || run->kept == path)
        return true;
    if (!run->vote.unfinished)
        return stored_save(run, STORE_CHECKPOINT, path);
    error_set(&error, EXIT_FAILED, "%s: not written: no pass is whole", path);
    lose(run, &error);
    return true;
}

/* Collective. Reads the links of an open file and deals them to the ranks. */
static bool load_links(struct run *run, struct store_reader *reader, const int32_t *order,
                       int64_t count)
{
    enum { CHUNK = 65536 };
    struct link *chunk = alloc_array(CHUNK, sizeof *chunk);
    bool good = true;
    for (int64_t left = count; left > 0 && good; left -= CHUNK) {
        int64_t now = left < CHUNK ? left : CHUNK;
        if (run->comm.rank == 0)
            store_get_links(reader, chunk, now, &run->error);
        good = run_agree(run);
        if (good)
            links_deal(run->solver, order, chunk, now);
    }
    alloc_free(chunk);
    return good;
}

/* With --accuracy a checkpoint goes on with as many rays as its last round had. */
static void warn_of_rays(struct run *run, int asked)
{
    int rays = run->solver->model.criterion.final_gather;
    if (run->options.pixel_rays == 0 && rays != asked) /* rays are asked for by number */
        run_say(run, "warning: no use is made of --final-gather %d: --accuracy has come "
                "to %d", asked, rays);
}

bool stored_load(struct run *run, enum store_kind kind, const char *path)
{
    int asked = run->solver->model.criterion.final_gather;
    struct store_terms terms = terms_of(run, kind);
    struct store_reader reader = {0};
    if (!run_goes_on(run)) /* a tree ended by a signal is not the file's */
        return false;
    account_begin(&run->solver->account, PHASE_LINKING);
    if (run->comm.rank == 0) {
        signals_end_calls(true); /* of a pipe, too */
        store_open(&reader, path, &terms, &run->error);
        signals_end_calls(false);
    }
    bool good = run_agree(run);
    if (good) {
        int32_t *order = snapshot_restore(run->solver, &run->vote, &reader.snapshot);
        good = load_links(run, &reader, order, reader.snapshot.link_count);
        alloc_free(order);
        warn_of_rays(run, asked);
    }
    if (good && kind == STORE_CHECKPOINT)
        run->kept = path;
    if (good)
        run_say(run, "%s: %lld links after %lld passes, %.1f s", path,
                (long long)reader.snapshot.link_count, (long long)run->solver->turn.pass,
                comm_seconds() - run->start);
    store_close(&reader);
    account_end(&run->solver->account, PHASE_LINKING);
    return good;
}

/* Collective. All ranks get the solution of rank 0. */
static void share_solution(struct run *run)
{
    bool first = run->comm.rank == 0;
    if (!first)
        run->stored = alloc_array(1, sizeof *run->stored);
    struct solution_mesh *solution = run->stored;
    struct solution_leaf *leaves = solution->leaves;
    comm_broadcast(&run->comm, solution, sizeof *solution);
    size_t count = (size_t)solution->count;
    solution->leaves = first ? leaves : alloc_array(count, sizeof *leaves);
    comm_broadcast(&run->comm, solution->leaves, count * sizeof *leaves);
}

/* The answer of the final gather, as stored, for light at any point. */
static void restore_answer(struct solver *solver, const struct solution_mesh *solution)
{
    struct forest *forest = solver->model.forest;
    struct answer *answer = solver->beyond->answer;
    size_t count = (size_t)forest->count;
    struct lit *lit = lit_find(&solver->model);
    if (solution->lamps.known) {
        lit[0].lamp_least = solution->lamps.lamp_least;
        lit[0].mean = solution->lamps.mean;
        answer->straight = alloc_array(count, sizeof *answer->straight);
    }
    answer->gather = final_gather_create(
        &solver->model, solver->model.criterion.final_gather, NULL, lit);
    if (solution->has_error)
        answer->error = alloc_array(count, sizeof *answer->error);
    if (solution->has_outside)
        answer->open = alloc_array(count, sizeof *answer->open);
    for (int64_t i = 0; i < solution->count; i++) {
        int32_t leaf = forest_reach(forest, solution->leaves[i].id);
        const struct solution_leaf *from = &solution->leaves[i];
        for (int c = 0; c < BANDS && answer->straight; c++)
            answer->straight[leaf].band[c] = from->radiosity.band[c] - from->rest.band[c];
        if (answer->error)
            answer->error[leaf] = (float)from->error;
        if (answer->open)
            answer->open[leaf] = (float)from->outside;
    }
}

bool stored_light(struct run *run)
{
    bool stored = run->stored != NULL;
    comm_broadcast(&run->comm, &stored, sizeof stored);
    if (!stored)
        return false;
    share_solution(run);
    struct criterion criterion = run->options.criterion;
    criterion.linking = LINKING_TREE; /* which groups lamps */
    run->solver = beyond_create(&run->comm, run->scene, run->octree, &criterion);
    solution_mesh_restore(run->stored, run->solver->model.forest);
    restore_answer(run->solver, run->stored);
    return true;
}
