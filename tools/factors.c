/* --form-factors: exchanges between groups in place of light. */
#include "tools/factors.h"

#include "geom/stop.h"
#include "tools/pairs.h"
#include "tools/table.h"

void factors_tabulate(struct run *run)
{
    const struct criterion *criterion = &run->options.criterion;
    run_say(run, "%s: %lld triangles in %lld groups", run->options.scene,
            (long long)run->scene->input_count, (long long)run->scene->groups.count);
    struct viewfactors *factors = viewfactors_create(
        run->scene, run->octree, criterion->epsilon, criterion->max_level);
    progress_begin(&run->progress.progress, "form factors", -1, 0);
    pairs_add(&run->comm, factors, &run->progress.progress);
    progress_view_clear(&run->progress);
    if (run_goes_on(run) && run->comm.rank == 0) {
        table_print(factors, stdout);
        stop_check(&run->error);
    }
    if (run_agree(run))
        run_say(run, "%.1f s", comm_seconds() - run->start);
    viewfactors_destroy(factors);
}
