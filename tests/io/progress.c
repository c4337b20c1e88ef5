/* Tests of geom/progress.h and io/run/progress.h. Proved are the text of the line, that
 * it fits its width whatever it has to say, that a log is not flooded, and that nobody
 * looks unless asked to. (The line on a terminal is tests/52-words.sh's.) */
#include "io/run/progress.h"

#include <string.h>

#include "tests/tap.h"

#define LOG "build/progress_test.txt"

static void check_text(const char *expected, int64_t level, int64_t links, double share,
                       double seconds)
{
    struct progress progress = {.phase = "refining", .level = level, .links = links,
                                .share = share};
    char text[PROGRESS_WIDTH + 1];
    int length = progress_text(text, &progress, seconds);
    bool right = strcmp(text, expected) == 0 && length == (int)strlen(expected);
    tap_ok(right, "%s%s%s", expected, right ? "" : " is not: ", right ? "" : text);
}

static void test_text(void)
{
    check_text("phr: refining, 0 %", -1, 0, 0.0, 9.0);
    check_text("phr: refining, level 0, 12 links, 1 %", 0, 12, 0.019, 100.0);
    check_text("phr: refining, level 3, 12 links, 50 %", 3, 12, 0.5, 0.9);
    check_text("phr: refining, 25 %, about 31 s left", -1, 0, 0.25, 10.0);
    check_text("phr: refining, 99 %, about 1 s left", -1, 0, 0.999, 10.0);
    check_text("phr: refining, 50 %, about 5 min left", -1, 0, 0.5, 300.0);
    check_text("phr: refining, 10 %, about 3 h 15 min left", -1, 0, 0.1, 1300.0);
    check_text("phr: refining, 100 %, about 1 s left", -1, 0, 1.5, 10.0);
}

static void test_width(void)
{
    struct progress progress = {.phase = "something with a long name", .level = INT64_MAX,
                                .links = INT64_MAX, .share = 0.02};
    char text[PROGRESS_WIDTH + 1];
    int length = progress_text(text, &progress, 1e300);
    tap_ok(length == PROGRESS_WIDTH && strlen(text) == PROGRESS_WIDTH,
           "the longest line: %s", text);
}

/* Ticks that nobody looks at. */
static void test_nobody(void)
{
    struct progress progress = {0};
    progress_begin(NULL, "linking", -1, 0);
    progress_tick(NULL, 0.5);
    progress_begin(&progress, "linking", -1, 0);
    progress_tick(&progress, 0.5);
    progress_tick_pairs(&progress, 5, 10);
    tap_ok(progress.share == 0.0, "ticks that nobody looks at");
}

static double last_share;

static void keep_share(struct progress *progress)
{
    last_share = progress->share;
}

static void test_pairs(void)
{
    struct progress progress = {.show = keep_share};
    progress_tick_pairs(&progress, 0, 10);
    bool right = last_share == 0.0;
    progress_tick_pairs(&progress, 5, 10);
    right = right && last_share == 0.75;
    progress_tick_pairs(&progress, 10, 10);
    tap_ok(right && last_share == 1.0,
           "half of the rows are three quarters of the pairs");
}

/* --- a log --- */

static double now;

static double test_clock(void)
{
    return now;
}

static int log_lines(void)
{
    FILE *file = fopen(LOG, "r");
    int lines = 0, c;
    while (file && (c = getc(file)) != EOF)
        lines += c == '\n';
    if (file)
        fclose(file);
    return lines;
}

/* Two minutes of ticks, 100 a second; other lines come at the second 40. */
static void test_log(void)
{
    struct progress_view view;
    now = 0.0;
    if (!tap_ok(freopen(LOG, "w", stderr) != NULL, "stderr goes to a file"))
        return;
    progress_view_open(&view, test_clock);
    progress_begin(&view.progress, "linking", -1, 0);
    for (int i = 0; i < 12000; i++) {
        now = 0.01 * i;
        if (i == 4000)
            progress_view_clear(&view);
        progress_tick(&view.progress, i / 12000.0);
    }
    fflush(stderr);
    int lines = log_lines(); /* at the seconds 30, 70, 100 */
    tap_ok(!view.terminal && lines == 3, "a log of two minutes has %d lines", lines);
    remove(LOG);
}

/* Ticks of a phase that seems to take so many seconds, and from the fifth on `times` as
 * many, one a second; the lines of the log after ten. */
static int lines_of_paces(const char *phase, double seconds, double times)
{
    struct progress_view view;
    now = 0.0;
    if (!freopen(LOG, "w", stderr))
        return -1;
    progress_view_open(&view, test_clock);
    progress_begin(&view.progress, phase, -1, 0);
    for (int i = 0; i <= 10; i++) {
        now = i;
        progress_tick(&view.progress, i / (i < 5 ? seconds : times * seconds));
    }
    fflush(stderr);
    return log_lines();
}

static int lines_of_phase(const char *phase, double seconds)
{
    return lines_of_paces(phase, seconds, 1.0);
}

static void test_long(void)
{
    char line[100] = "";
    int lines = lines_of_phase("gathering", 240.0);
    FILE *file = fopen(LOG, "r");
    tap_ok(lines == 1 && file && fgets(line, sizeof line, file) &&
               strcmp(line, "phr: gathering takes about 4 min; a smaller --final-gather "
                            "or a larger --epsilon takes less\n") == 0,
           "a phase of four minutes is said to be long, once: %.40s", line);
    if (file)
        fclose(file);
    tap_ok(lines_of_phase("gathering", 25.0) == 0, "one of 25 s is not");
    lines = lines_of_phase("looking", 15.0);
    file = fopen(LOG, "r");
    tap_ok(lines == 1 && file && fgets(line, sizeof line, file) &&
               strstr(line, "gathering takes about 61 s"),
           "looks of 15 s are a quarter of a gather of a minute: %.40s", line);
    if (file)
        fclose(file);
    tap_ok(lines_of_phase("checking", 240.0) == 0, "nor one that nothing shortens");
    tap_ok(lines_of_paces("gathering", 50.0, 2.0) == 2 &&
               lines_of_paces("gathering", 50.0, 1.4) == 1,
           "it is said again when it has become twice as long, and not 1.4 times");
    remove(LOG);
}

int main(void)
{
    test_text();
    test_width();
    test_nobody();
    test_pairs();
    test_log();
    test_long();
    return tap_done();
}
