/* Fuzzing: the common part of the harnesses tests/fuzz/<format>.c.
 *
 * A harness is one function, the entry of libFuzzer and of AFL++'s persistent mode, that
 * gives the bytes to the reader of its format and checks the promises of every reader:
 * it succeeds, or fails with one line of text and the exit code for bad input, and leaves
 * no memory behind. A broken promise aborts. `make fuzz` links it with libFuzzer;
 * tests/corpus.c replays files. */
#ifndef TESTS_FUZZ_FUZZ_H
#define TESTS_FUZZ_FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/error.h"
#include "mpi/comm.h"

/* Reads the bytes as a file of the format. Returns 0. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Aborts with the place and the promise unless it is kept. */
#define FUZZ_PROMISE(kept) \
    ((kept) \
         ? (void)0 \
         : (fprintf(stderr, "%s:%d: broken: %s\n", __FILE__, __LINE__, #kept), abort()))

/* Ends a harness that has freed all it got; `good`: the reader's answer. */
static inline void fuzz_verdict(bool good, const struct error *error)
{
    FUZZ_PROMISE(good == (error->code == EXIT_DONE));
    FUZZ_PROMISE(good || error->code == EXIT_USAGE);
    FUZZ_PROMISE(good == (error->text[0] == '\0'));
    FUZZ_PROMISE(!strchr(error->text, '\n'));
    FUZZ_PROMISE(alloc_balance() == 0);
}

static struct comm fuzz_comm;

static inline void fuzz_stop(void)
{
    comm_stop(&fuzz_comm);
}

/* The process as the only rank, for harnesses that run more than a reader. */
static inline struct comm *fuzz_alone(void)
{
    if (fuzz_comm.size == 0) {
        comm_start(&fuzz_comm, NULL, NULL);
        atexit(fuzz_stop);
    }
    return &fuzz_comm;
}

#endif
