/* The one counted allocator of the program.
 *
 * Every block is counted, so that alloc_balance() == 0 at exit turns each run into a leak
 * test. Running out of memory is not returned to the caller: the failure handler is
 * called and must not return (the MPI layer installs one ending all ranks with exit code
 * 1). */
#ifndef GEOM_ALLOC_H
#define GEOM_ALLOC_H

#include <stddef.h>
#include <stdint.h>

/* `count` elements of `size` bytes, zeroed. Never NULL, also for count 0.
 * Errors: overflow of count * size and exhausted memory call the failure handler. */
void *alloc_array(size_t count, size_t size);

/* Resizes a block to `count` elements; those past the old end are not initialised.
 * `block` may be NULL. */
void *alloc_resize(void *block, size_t count, size_t size);

/* Makes room for `needed` elements, growing by half so that appending costs O(1)
 * amortised. `*capacity` counts the elements with room, updated on growth. */
void *alloc_reserve(void *block, int64_t *capacity, int64_t needed, size_t size);

/* Does so for the elements behind the pointer `array`. */
#define RESERVE(array, capacity, needed) \
    ((array) = alloc_reserve(array, capacity, needed, sizeof *(array)))

/* Copy of a string. */
char *alloc_string(const char *text);

/* Gives up as if `bytes` could not be had: for arrays outgrowing the numbers of their
 * elements. */
void alloc_fail(size_t bytes);

/* Releases a block; NULL is allowed. */
void alloc_free(void *block);

/* Number of blocks allocated and not yet freed. */
int64_t alloc_balance(void);

/* `handler(bytes)` is called when `bytes` cannot be had, and must not return.
 * Without a handler: a line on stderr and exit code 1. */
void alloc_on_failure(void (*handler)(size_t bytes));

#endif
