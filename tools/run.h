/* One run of phr: its state, and the errors and lines on stderr shared by all its
 * parts. */
#ifndef TOOLS_RUN_H
#define TOOLS_RUN_H

#include "io/picture/solution.h"
#include "io/run/options.h"
#include "io/run/progress.h"
#include "io/scene/camera.h"
#include "io/scene/points.h"
#include "mpi/beyond/create.h"
#include "mpi/node.h"

struct run {
    struct comm comm;
    struct options options;
    struct scene *scene;
    struct camera *cameras;        /* [run_camera_count()] */
    const char *up_reason;         /* of the axis that is up, unless said; or NULL */
    char missing[200];             /* where the lamps may be: in a library or material not
                                      found, on rank 0; or "" */
    struct text_names materials;   /* names of the scene's, on rank 0; or fewer */
    struct points points;          /* of --at, on rank 0 */
    double *exposures;             /* [run_camera_count()] of pictures of bytes, 0: of
                                      none; on rank 0; or NULL */
    struct octree *octree;
    struct solution_mesh *stored;  /* the scene's file is a stored solution; else NULL */
    struct node_block block;       /* memory of scene and octree */
    struct solver *solver;
    bool half_linked;              /* linking ended at the memory limit */
    struct vote vote;              /* of the last iteration */
    struct stats stats;
    struct progress_view progress; /* on rank 0, unless --quiet */
    const char *kept;              /* path of the last checkpoint made or read, or NULL */
    int haste;                     /* the signal after which the run shows what there is;
                                      0: none */
    const char *shown;             /* what it shows then, said at its end; or NULL */
    struct error error;            /* ends the run */
    double start;                  /* comm_seconds() at the beginning */
    double first_bound;            /* vote.remaining of the first iteration of a pass */
};

/* Returns the number of cameras: the views', or one chosen. */
static inline int run_camera_count(const struct run *run)
{
    return run->options.view_count > 0 ? run->options.view_count : 1;
}

/* Prints a line on stderr, from rank 0, unless --quiet. */
#ifdef __GNUC__
__attribute__((format(printf, 2, 3)))
#endif
void run_say(struct run *run, const char *format, ...);

/* On rank 0 alone. Keeps the error of an output, if there is one, for run_end(): the run
 * goes on. If asked to stop, the error is the run's. */
void run_lose(struct run *run, const struct error *error);

/* Collective. Starts MPI, which may take arguments, and the clock; catches signals. False
 * if the ranks have different arguments: all decide alike from here on. */
bool run_start(struct run *run, int *argc, char ***argv);

/* Collective. Reads the options, and shows progress unless --quiet is given. */
bool run_parse(struct run *run, int argc, char **argv);

/* Collective. Prints the errors of the run and of its outputs, by which all ranks have an
 * error then, frees all that the run has, and stops MPI. Returns the exit status. */
int run_end(struct run *run);

/* Collective. Frees all that a run owns but its ranks. */
void run_free(struct run *run);

/* Returns the last part of the path of the scene, at most 60 characters, with '?' for
 * characters not of ASCII, or in need of a backslash somewhere. */
const char *run_scene_name(const struct run *run);

/* Lets outputs name the scene and the settings of light. Pre: the scene is prepared. */
void run_set_note(const struct run *run);

/* Sets the error of a run stopped by a signal. Returns false. */
bool run_stopped(struct run *run, int signal);

/* Collective. If a rank was asked to stop, the run hastens from here on, and no signal
 * stops its loops: it shows what there is. Returns whether it does. `shown`: as in struct
 * run. */
bool run_hastens(struct run *run, const char *shown);

/* Collective. Gives all ranks the error of one of them, if any has one; false then. On a
 * rank asked to stop, the signal is the error. */
bool run_agree(struct run *run);

/* Collective. Ends a phase that can be stopped: false if a rank was asked to stop or has
 * an error. */
bool run_goes_on(struct run *run);

#endif
