/* Tests of geom/alloc.h: blocks are zeroed and never NULL, growth keeps the items and is
 * amortised, the balance counts blocks, and a request that fails calls the handler. */
#include "geom/alloc.h"

#include <setjmp.h>
#include <string.h>

#include "tests/tap.h"

static bool is_zero(const unsigned char *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (bytes[i] != 0)
            return false;
    return true;
}

static void test_zeroing(void)
{
    bool zero = true;
    for (size_t count = 1; count < 5000; count += 7) {
        unsigned char *block = alloc_array(count, 3);
        zero = zero && is_zero(block, 3 * count);
        memset(block, 0xA5, 3 * count); /* the next block may be this one */
        alloc_free(block);
    }
    tap_ok(zero, "arrays are zeroed");
}

static void test_nothing(void)
{
    void *blocks[4] = {alloc_array(0, 8), alloc_array(8, 0), alloc_resize(NULL, 0, 8),
                       alloc_resize(alloc_array(5, 8), 0, 8)};
    bool there = true;
    for (int k = 0; k < 4; k++)
        there = there && blocks[k];
    tap_ok(there && alloc_balance() == 4, "blocks of no bytes are blocks");
    for (int k = 0; k < 4; k++)
        alloc_free(blocks[k]);
    alloc_free(NULL);
    tap_ok(alloc_balance() == 0, "freeing NULL counts nothing");
}

static void test_balance(void)
{
    void *blocks[100];
    bool right = alloc_balance() == 0;
    for (int k = 0; k < 100; k++) {
        blocks[k] = alloc_array((size_t)k, 5);
        right = right && alloc_balance() == k + 1;
    }
    blocks[50] = alloc_resize(blocks[50], 100000, 5);
    tap_ok(right && alloc_balance() == 100,
           "the balance counts blocks, resized ones once");
    for (int k = 0; k < 100; k++) {
        alloc_free(blocks[k]);
        right = right && alloc_balance() == 99 - k;
    }
    tap_ok(right, "and goes down with each block that is freed");
}

static void test_resize(void)
{
    int32_t *block = alloc_resize(NULL, 10, sizeof *block);
    for (int32_t i = 0; i < 10; i++)
        block[i] = i * i;
    block = alloc_resize(block, 100000, sizeof *block);
    block = alloc_resize(block, 7, sizeof *block);
    bool kept = true;
    for (int32_t i = 0; i < 7; i++)
        kept = kept && block[i] == i * i;
    tap_ok(kept, "resizing keeps the items that both sizes have");
    alloc_free(block);
}

static void test_reserve(void)
{
    int64_t capacity = 0, growths = 0, largest_jump = 0;
    int64_t *items = alloc_reserve(NULL, &capacity, 0, sizeof *items);
    tap_ok(items && alloc_balance() == 1, "reserving nothing makes a block too");
    for (int64_t i = 0; i < 1000000; i++) {
        int64_t before = capacity;
        RESERVE(items, &capacity, i + 1);
        items[i] = 3 * i;
        growths += capacity != before;
        if (capacity - before - before / 2 > largest_jump)
            largest_jump = capacity - before - before / 2;
    }
    bool kept = true;
    for (int64_t i = 0; i < 1000000; i++)
        kept = kept && items[i] == 3 * i;
    tap_ok(kept, "a million numbers appended one by one");
    /* log(1e6) / log(1.5) = 34 growths by half; the constant saves a few. */
    tap_ok(growths <= 35, "in %d growths, so at constant cost each", (int)growths);
    tap_ok(largest_jump <= 16, "room for no more than half as much again and 16");
    int64_t before = capacity;
    RESERVE(items, &capacity, before);
    tap_ok(capacity == before, "an array with room does not grow");
    RESERVE(items, &capacity, 5 * before);
    tap_ok(capacity == 5 * before, "a large need is met exactly");
    alloc_free(items);
}

static void test_string(void)
{
    const char *text = "a\tb";
    char *copy = alloc_string(text), *empty = alloc_string("");
    tap_ok(copy != text && strcmp(copy, text) == 0 && *empty == '\0' &&
               alloc_balance() == 2,
           "strings are copied");
    alloc_free(copy);
    alloc_free(empty);
}

static jmp_buf failure;
static size_t failed_bytes;

static void handle_failure(size_t bytes)
{
    failed_bytes = bytes;
    longjmp(failure, 1);
}

/* Sizes are volatile so that no compiler judges them. */
static void test_overflow(void)
{
    static volatile size_t huge = SIZE_MAX / 4 + 2;
    static void *volatile block;
    alloc_on_failure(handle_failure);
    block = alloc_array(3, 8);
    if (setjmp(failure) == 0) {
        block = alloc_resize(block, huge, 8);
        tap_ok(false, "a product that overflows must not succeed");
    } else {
        tap_ok(failed_bytes == SIZE_MAX && alloc_balance() == 1,
               "an overflow in resizing calls the handler and leaves the block");
    }
    alloc_free(block);
    if (setjmp(failure) == 0) {
        block = alloc_array(huge, 8);
        tap_ok(false, "a product that overflows must not succeed");
    } else {
        tap_ok(failed_bytes == SIZE_MAX && alloc_balance() == 0,
               "an overflow in a new array calls the handler");
    }
    alloc_on_failure(NULL);
}

int main(void)
{
    test_zeroing();
    test_nothing();
    test_balance();
    test_resize();
    test_reserve();
    test_string();
    test_overflow();
    return tap_done();
}
