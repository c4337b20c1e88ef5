/* Fuzzing PFM, PPM, HDR and PNG. */
#include "io/picture/imagefile.h"

#include "tests/fuzz/fuzz.h"
#include "tests/memory.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct error error = {0};
    struct source source;
    struct image image = {0};
    enum image_kind kind;
    size_t most = (size > 0 && data[0] == 0x89 ? 1032 : 16) * size; /* pixels */
    bool good = source_of_bytes(&source, "fuzz", data, size, &error) &&
                image_read(&image, &kind, &source, &error);
    source_close(&source);
    FUZZ_PROMISE(good == (image.rgb != NULL));
    FUZZ_PROMISE(!good || (image.width > 0 && image.height > 0 &&
                           (size_t)image.width * (size_t)image.height <= most));
    for (int64_t i = 0; good && i < 3 * (int64_t)image.width * image.height; i++)
        FUZZ_PROMISE(kind == IMAGE_LINEAR ||
                     (image.rgb[i] >= 0.0f && image.rgb[i] <= 1.0f));
    alloc_free(image.rgb);
    fuzz_verdict(good, &error);
    return 0;
}
