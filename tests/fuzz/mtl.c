/* Fuzzing MTL. */
#include "io/scene/mtl.h"

#include "tests/fuzz/fuzz.h"
#include "tests/memory.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct error error = {0};
    struct mtl_table table = {0};
    struct source source;
    struct text text;
    bool good = source_of_bytes(&source, "fuzz.mtl", data, size, &error) &&
                text_of_source(&text, &source, &error);
    source_close(&source);
    if (good) {
        good = mtl_of_text(&table, &text, &error);
        text_free(&text);
    }
    for (int32_t i = 0; i < table.names.count; i++)
        for (int c = 0; c < BANDS; c++)
            FUZZ_PROMISE(table.entries[i].material.reflectance.band[c] >= 0.0 &&
                         table.entries[i].material.emission.band[c] <= TEXT_NUMBER_MAX);
    mtl_free(&table);
    fuzz_verdict(good, &error);
    return 0;
}
