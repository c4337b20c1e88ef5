/* Fuzzing checkpoints. */
#include "tests/fuzz/store.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    store_try(STORE_CHECKPOINT, LINKING_PAIRS, data, size);
    return 0;
}
