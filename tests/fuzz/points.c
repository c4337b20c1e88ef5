/* Fuzzing points: those that are read have normals of length 1. */
#include "io/scene/points.h"

#include <math.h>

#include "tests/fuzz/fuzz.h"
#include "tests/memory.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct error error = {0};
    struct points points = {.count = 0};
    struct source source;
    struct text text;
    bool good = source_of_bytes(&source, "fuzz.csv", data, size, &error) &&
                text_of_source(&text, &source, &error);
    source_close(&source);
    if (good) {
        good = points_of_text(&points, &text, &error);
        text_free(&text);
    }
    for (int64_t i = 0; good && i < points.count; i++) {
        double length = vec3_length(points.sensors[i].normal);
        FUZZ_PROMISE(length > 0.999999 && length < 1.000001);
    }
    points_free(&points);
    fuzz_verdict(good, &error);
    return 0;
}
