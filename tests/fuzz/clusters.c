/* Fuzzing checkpoints with links of clusters. */
#include "tests/fuzz/store.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    store_try(STORE_CHECKPOINT, LINKING_TREE, data, size);
    return 0;
}
