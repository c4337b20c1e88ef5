/* Fuzzing tables of skies: those that are read have radiances everywhere, 0 or more. */
#include "io/scene/skytable.h"

#include "tests/fuzz/fuzz.h"
#include "tests/memory.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct error error = {0};
    struct sky_table table = {.count = 0};
    struct source source;
    struct text text;
    bool good = source_of_bytes(&source, "fuzz.mtx", data, size, &error) &&
                text_of_source(&text, &source, &error);
    source_close(&source);
    if (good) {
        good = sky_table_of_text(&table, &text, &error);
        text_free(&text);
    }
    for (int i = 0; good && i < 1000; i++) {
        struct rgb l = sky_table_radiance(&table, i % 10 - 4.5, i / 10 % 10 - 4.5,
                                          i / 100);
        for (int c = 0; c < BANDS; c++)
            FUZZ_PROMISE(l.band[c] >= 0.0);
    }
    sky_table_free(&table);
    fuzz_verdict(good, &error);
    return 0;
}
