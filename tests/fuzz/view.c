/* Fuzzing view files: a camera that is read has rays. */
#include "io/scene/camera.h"

#include <math.h>

#include "tests/fuzz/fuzz.h"
#include "tests/memory.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct error error = {0};
    struct camera camera;
    struct source source;
    struct text text;
    bool good = source_of_bytes(&source, "fuzz.view", data, size, &error) &&
                text_of_source(&text, &source, &error);
    source_close(&source);
    if (good) {
        good = camera_of_text(&camera, &text, &error);
        text_free(&text);
    }
    for (int k = 0; good && k < 9; k++) {
        double x = 0.5 * (k % 3) * camera.width, y = 0.5 * (k / 3) * camera.height;
        double length = vec3_length(camera_ray(&camera, x, y));
        FUZZ_PROMISE(length > 0.999999 && length < HUGE_VAL);
    }
    fuzz_verdict(good, &error);
    return 0;
}
