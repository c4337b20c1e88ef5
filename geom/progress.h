/* How far a phase of the work has come. The loops of the method tick, cheaply; whether
 * somebody looks, and how progress is drawn, is not their business
 * (io/run/progress.h). */
#ifndef GEOM_PROGRESS_H
#define GEOM_PROGRESS_H

#include <stdint.h>

struct progress {
    void (*show)(struct progress *progress); /* NULL: nobody looks */
    int64_t stage;     /* counts phases and levels begun */
    const char *phase; /* such as "linking" */
    int64_t level;     /* of refinement; -1: there are none */
    int64_t links;     /* gone over by the phase, on all ranks; 0: none */
    double share;      /* of the phase, or of its level, done so far, 0..1 */
};

/* A phase, or a level of it, begins. `progress` may be NULL, here and below. */
static inline void progress_begin(struct progress *progress, const char *phase,
                                  int64_t level, int64_t links)
{
    if (progress)
        *progress = (struct progress){.show = progress->show,
                                      .stage = progress->stage + 1,
                                      .phase = phase,
                                      .level = level,
                                      .links = links};
}

static inline void progress_tick(struct progress *progress, double share)
{
    if (!progress || !progress->show)
        return;
    progress->share = share;
    progress->show(progress);
}

/* The tick of a loop over all pairs of `count` things, before those of thing i with later
 * ones. */
static inline void progress_tick_pairs(struct progress *progress, int64_t i,
                                       int64_t count)
{
    double left = (double)(count - i) / (double)count;
    progress_tick(progress, 1.0 - left * left);
}

#endif
