/* Counted allocation.
 *
 * The count is of blocks, not bytes: C99 offers no portable way to ask a block for its
 * size, and a header in front of each block would cost memory for facts better learnt
 * from a leak checker, once the balance shows a leak. */
#include "geom/alloc.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "geom/error.h"

static int64_t balance;
static void (*failure_handler)(size_t bytes);

void alloc_fail(size_t bytes)
{
    if (failure_handler)
        failure_handler(bytes);
    fprintf(stderr, "%s: out of memory (%zu bytes more were needed)\n", error_program,
            bytes);
    exit(1);
}

void *alloc_array(size_t count, size_t size)
{
    void *block = calloc(count ? count : 1, size ? size : 1);
    if (!block)
        alloc_fail(size && count > SIZE_MAX / size ? SIZE_MAX : count * size);
    balance++;
    return block;
}

void *alloc_resize(void *block, size_t count, size_t size)
{
    if (!block)
        return alloc_array(count, size);
    if (size && count > SIZE_MAX / size)
        alloc_fail(SIZE_MAX);
    size_t bytes = count * size;
    void *resized = realloc(block, bytes ? bytes : 1);
    if (!resized)
        alloc_fail(bytes);
    return resized;
}

void *alloc_reserve(void *block, int64_t *capacity, int64_t needed, size_t size)
{
    if (block && needed <= *capacity)
        return block;
    int64_t grown = *capacity + *capacity / 2 + 16;
    *capacity = grown > needed ? grown : needed;
    return alloc_resize(block, (size_t)*capacity, size);
}

char *alloc_string(const char *text)
{
    size_t length = strlen(text) + 1;
    return memcpy(alloc_array(length, 1), text, length);
}

void alloc_free(void *block)
{
    if (!block)
        return;
    balance--;
    free(block);
}

int64_t alloc_balance(void)
{
    return balance;
}

void alloc_on_failure(void (*handler)(size_t bytes))
{
    failure_handler = handler;
}
