/* Replays the files named as arguments through a fuzz harness (tests/fuzz/fuzz.h): as
 * they are, cut off at every byte, and with every byte changed, in its lowest bit and in
 * all of them. The corpus holds small files that make sense and the finds of fuzzing. A
 * harness aborts where its reader breaks a promise; the last file named in the log is the
 * culprit.
 *
 * Each variant is a block of its own size, so that sanitizers see reading past its
 * end. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "tests/fuzz/fuzz.h"
#include "tests/load.h"
#include "tests/tap.h"

enum { ROOM = 2000 }; /* bytes: more than a file of a corpus has */

static const double SLOW = 1.0; /* s, for one variant */

/* Seconds of the harness for the first `size` bytes, byte `at` changed. */
static double replay(const uint8_t *bytes, size_t size, size_t at, uint8_t change)
{
    uint8_t *copy =
        malloc(size + !size); /* uncounted: the harness asks for a balance of 0 */
    memcpy(copy, bytes, size);
    if (at < size)
        copy[at] ^= change;
    clock_t start = clock();
    LLVMFuzzerTestOneInput(copy, size);
    free(copy);
    return (double)(clock() - start) / CLOCKS_PER_SEC;
}

static double slower(double a, double b)
{
    return a > b ? a : b;
}

static void replay_file(const char *path)
{
    static uint8_t bytes[ROOM];
    size_t size = load(path, bytes, ROOM);
    if (size == 0 || size == ROOM) {
        printf("Bail out! %s is not there, or has nothing or too much\n", path);
        exit(1);
    }
    printf("replaying %s\n", path);
    fflush(stdout);
    double slowest = replay(bytes, size, size, 0);
    for (size_t at = 0; at < size; at++) {
        slowest = slower(slowest, replay(bytes, at, at, 0));
        slowest = slower(slowest, replay(bytes, size, at, 0x01));
        slowest = slower(slowest, replay(bytes, size, at, 0xFF));
    }
    tap_ok(slowest < SLOW, "%s: at most %.3f s", path, slowest);
}

int main(int count, char **arguments)
{
    for (int i = 1; i < count; i++)
        replay_file(arguments[i]);
    tap_ok(count > 1, "a corpus of %d files", count - 1);
    return tap_done();
}
