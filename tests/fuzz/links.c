/* Fuzzing link caches. */
#include "tests/fuzz/store.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    store_try(STORE_LINKS, LINKING_PAIRS, data, size);
    return 0;
}
