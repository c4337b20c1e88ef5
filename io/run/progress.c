/* Progress on stderr.
 *
 * On a terminal a line is rewritten with a carriage return, ten times a second at most,
 * and padded with blanks to the length of the line before it: no terminal database and no
 * escape sequences are needed. In a log, a line is written after half a minute without
 * one: a long phase does not look dead, and a short one stays silent. Under mpiexec
 * stderr is a pipe on every rank: phr writes a log.
 *
 * Of a long phase a line says after some seconds how long, and what could be done, so
 * nobody waits in vain.
 *
 * The percentage is rank 0's. Work is balanced, so the others are about as far. */
#if defined(__unix__) || defined(__APPLE__)
#define _POSIX_C_SOURCE 200112L
#include <unistd.h>
#define HAVE_POSIX 1
#endif

#include "io/run/progress.h"

#include <stdio.h>
#include <string.h>

#include "geom/error.h"

static const double REWRITE = 0.1, LOG = 30.0; /* seconds between lines */

/* The time left is shown from this part of a stage and this many seconds on. */
static const double DONE_LEAST = 0.02, SECONDS_LEAST = 1.0;

/* A phase of more seconds than this is long: in a run of a minute some phase is. The line
 * comes with the first time left, or after so many seconds. */
static const double LONG = 30.0, SECONDS_TO_TELL = 5.0;
static const double CHANGE = 1.5; /* of the time, for it to be told again */

static bool stderr_is_terminal(void)
{
#ifdef HAVE_POSIX
    return isatty(STDERR_FILENO) == 1;
#else
    return false;
#endif
}

/* Prints "9 s", "12 min" or "3 h 05 min". */
static void print_duration(char *text, size_t size, double seconds)
{
    int64_t s = seconds < 1e9 ? (int64_t)(seconds + 1.0) : (int64_t)1e9,
            minutes = (s + 30) / 60;
    if (s < 100)
        snprintf(text, size, "%lld s", (long long)s);
    else if (minutes < 100)
        snprintf(text, size, "%lld min", (long long)minutes);
    else
        snprintf(text, size, "%lld h %02lld min", (long long)(minutes / 60),
                 (long long)(minutes % 60));
}

int progress_text(char text[PROGRESS_WIDTH + 1], const struct progress *progress,
                  double seconds)
{
    char level[32] = "", links[32] = "", left[64] = "", duration[32];
    double done = progress->share > 1.0 ? 1.0 : progress->share;
    if (progress->level >= 0)
        snprintf(level, sizeof level, ", level %lld", (long long)progress->level);
    if (progress->links > 0)
        snprintf(links, sizeof links, ", %lld links", (long long)progress->links);
    if (done >= DONE_LEAST && seconds >= SECONDS_LEAST) {
        print_duration(duration, sizeof duration, seconds * (1.0 - done) / done);
        snprintf(left, sizeof left, ", about %s left", duration);
    }
    int length = snprintf(text, PROGRESS_WIDTH + 1, "%s: %s%s%s, %d %%%s", error_program,
                          progress->phase, level, links, (int)(100.0 * done), left);
    return length < PROGRESS_WIDTH ? length : PROGRESS_WIDTH;
}

static const char *told; /* the phase last said to take long, or NULL */
static double told_seconds; /* how long that was said to take */

/* Says how long a long phase takes, and again when that has changed by more than half.
 * Looks are a quarter of the gather, or less with many splits. */
static void tell_long(struct progress_view *view, double seconds)
{
    static const char RAYS[] = "smaller --final-gather or a larger --epsilon";
    static const struct {
        const char *phase, *name, *shorter;
        double times; /* seconds of what is named, relative to those of the phase */
    } PHASES[] = {{"refining", "refining", "larger --epsilon", 1.0},
                  {"looking", "gathering", RAYS, 4.0},
                  {"gathering", "gathering", RAYS, 1.0},
                  {"rendering", "rendering", "smaller --size or --samples", 1.0}};
    double done = view->progress.share;
    char duration[32];
    bool is_known = done >= DONE_LEAST && seconds >= SECONDS_LEAST;
    if (!(done > 0.0) || (!is_known && seconds < SECONDS_TO_TELL))
        return;
    for (size_t i = 0; i < sizeof PHASES / sizeof PHASES[0]; i++) {
        double all = PHASES[i].times * seconds / done;
        bool again = told && strcmp(told, PHASES[i].name) == 0;
        if (strcmp(PHASES[i].phase, view->progress.phase) != 0 || all < LONG ||
            (again && all < CHANGE * told_seconds && told_seconds < CHANGE * all))
            continue;
        print_duration(duration, sizeof duration, all);
        progress_view_clear(view);
        fprintf(stderr, "%s: %s takes about %s; a %s takes less\n", error_program,
                PHASES[i].name, duration, PHASES[i].shorter);
        told = PHASES[i].name;
        told_seconds = all;
    }
}

static void show(struct progress *progress)
{
    struct progress_view *view = (void *)progress; /* its first field */
    double now = view->clock();
    if (view->stage != progress->stage) {
        view->stage = progress->stage;
        view->begun = now;
    }
    tell_long(view, now - view->begun);
    if (now - view->shown < (view->terminal ? REWRITE : LOG))
        return;
    char text[PROGRESS_WIDTH + 1];
    int length = progress_text(text, progress, now - view->begun);
    view->shown = now;
    if (view->terminal) {
        fprintf(stderr, "\r%-*s", view->width, text);
        view->width = length;
    } else {
        fprintf(stderr, "%s\n", text);
    }
}

void progress_view_open(struct progress_view *view, double (*clock)(void))
{
    told = NULL;
    *view = (struct progress_view){.progress = {.show = show}, .clock = clock,
                                   .shown = clock(),
                                   .terminal = stderr_is_terminal()};
}

void progress_view_clear(struct progress_view *view)
{
    if (!view->progress.show)
        return;
    if (view->width > 0)
        fprintf(stderr, "\r%*s\r", view->width, "");
    view->width = 0;
    view->shown = view->clock();
}
