/* The state of one run. Errors of the user or the system are values (geom/error.h) on
 * which all ranks agree after each phase; rank 0 prints them once. */
#include "tools/run.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/hash.h"
#include "geom/signals.h"
#include "geom/stop.h"
#include "io/run/output.h"

void run_say(struct run *run, const char *format, ...)
{
    if (run->comm.rank != 0 || run->options.quiet)
        return;
    progress_view_clear(&run->progress);
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "%s: ", error_program);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
}

/* Errors of outputs not made, on rank 0. */
static struct error *lost;
static int lost_count;

void run_lose(struct run *run, const struct error *error)
{
    bool known = error->code == EXIT_DONE;
    if (!known && !stop_check(&run->error))
        return;
    for (int i = 0; i < lost_count && !known; i++)
        known = strcmp(lost[i].text, error->text) == 0;
    if (known)
        return;
    lost = alloc_resize(lost, (size_t)lost_count + 1, sizeof *lost);
    lost[lost_count++] = *error;
}

/* Collective. True if all ranks have the arguments of rank 0. */
static bool check_arguments(struct run *run, int argc, char **argv)
{
    uint64_t own = HASH_START, first;
    for (int i = 1; i < argc; i++)
        own = hash_bytes(own, argv[i], strlen(argv[i]) + 1);
    first = own;
    comm_broadcast(&run->comm, &first, sizeof first);
    if (own != first)
        error_set(&run->error, EXIT_USAGE, "the ranks have different arguments");
    return comm_agree(&run->comm, &run->error);
}

bool run_start(struct run *run, int *argc, char ***argv)
{
    comm_start(&run->comm, argc, argv);
    run->start = comm_seconds();
    signals_catch();
    return check_arguments(run, *argc, *argv);
}

bool run_parse(struct run *run, int argc, char **argv)
{
    bool parsed = options_parse(&run->options, argc, argv, &run->error);
    if (parsed && run->options.seconds > 0)
        signals_after(run->options.seconds);
    if (run->comm.rank == 0 && !run->options.quiet)
        progress_view_open(&run->progress, comm_seconds);
    return parsed;
}

/* Collective. Prints all errors, on rank 0. */
static void print_errors(struct run *run)
{
    if (run->comm.rank == 0 && (fflush(stdout) != 0 || ferror(stdout)))
        error_set(&run->error, EXIT_FAILED, "cannot write to the standard output");
    if (run->error.code == EXIT_DONE && lost_count > 0)
        run->error = lost[--lost_count];
    comm_agree(&run->comm, &run->error);
    progress_view_clear(&run->progress);
    for (int i = 0; i < lost_count; i++)
        fprintf(stderr, "%s: %s\n", error_program, lost[i].text);
    if (run->error.code != EXIT_DONE && run->comm.rank == 0)
        fprintf(stderr, "%s: %s\n", error_program, run->error.text);
    alloc_free(lost);
}

void run_free(struct run *run)
{
    solver_destroy(run->solver);
    octree_destroy(run->octree);
    scene_destroy(run->scene);
    if (run->stored)
        solution_mesh_free(run->stored);
    alloc_free(run->stored);
    alloc_free(run->cameras);
    alloc_free(run->exposures);
    text_names_free(&run->materials);
    points_free(&run->points);
    if (run->block.data)
        node_block_destroy(&run->block);
    options_free(&run->options);
}

int run_end(struct run *run)
{
    if (run->haste && run->error.code == EXIT_DONE)
        run_stopped(run, run->haste);
    print_errors(run);
    run_free(run);
    comm_stop(&run->comm);
    if (alloc_balance() == 0)
        return run->error.code;
    fprintf(stderr, "%s: BUG: %lld blocks of memory were not freed\n", error_program,
            (long long)alloc_balance());
    return EXIT_FAILED;
}

const char *run_scene_name(const struct run *run)
{
    static char name[61];
    const char *path = run->options.scene, *slash = strrchr(path, '/');
    snprintf(name, sizeof name, "%s", slash ? slash + 1 : path);
    for (char *c = name; *c; c++)
        *c = *c < ' ' || *c > '~' || *c == '"' || *c == '\\' ? '?' : *c;
    return name;
}

void run_set_note(const struct run *run)
{
    static char note[1200];
    snprintf(note, sizeof note,
             "phr %s, format %d\nscene %s, %ld triangles, checksum %016" PRIx64 "\n%s",
             PHR_VERSION, PHR_FORMAT, run_scene_name(run), (long)run->scene->sky_first,
             scene_hash(run->scene),
             run->stored ? "" : options_light_settings(&run->options));
    output_set_note(note);
}

bool run_stopped(struct run *run, int signal)
{
    const char *path = run->kept;
    return error_set(&run->error, EXIT_FAILED, "stopped by %s%s%s%s%s",
                     signals_name(signal), run->shown ? ": " : "",
                     run->shown ? run->shown : "", path ? "; go on with --resume " : "",
                     path ? path : "");
}

bool run_hastens(struct run *run, const char *shown)
{
    int64_t own = signals_seen(), most = 0;
    int64_t *each = comm_gather_each(&run->comm, &own, sizeof own);
    for (int r = 0; r < run->comm.size; r++)
        most = each[r] > most ? each[r] : most;
    alloc_free(each);
    if (most > 0) {
        stop_heed();
        run->haste = (int)most;
        run->shown = shown;
    }
    return run->haste != 0;
}

bool run_agree(struct run *run)
{
    if (run->error.code != EXIT_DONE && signals_seen() != 0) {
        run->error = (struct error){.code = EXIT_DONE};
        run_stopped(run, signals_seen());
    }
    return comm_agree(&run->comm, &run->error);
}

bool run_goes_on(struct run *run)
{
    stop_check(&run->error);
    return run_agree(run);
}
