/* Fuzzing STL: those that are read can be prepared, and each face is of a group. */
#include "io/scene/stl.h"

#include "tests/fuzz/fuzz.h"
#include "tests/memory.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct error error = {0};
    struct scene_repairs prepared;
    struct source source;
    struct scene *scene = NULL;
    if (source_of_bytes(&source, "fuzz.stl", data, size, &error))
        scene = stl_of_source(&source, &error);
    source_close(&source);
    FUZZ_PROMISE(!scene == (error.code != EXIT_DONE));
    for (int32_t i = 0; scene && i < scene->input_count; i++)
        FUZZ_PROMISE(scene->groups.of[i] >= 0 &&
                     scene->groups.of[i] < scene->groups.count);
    bool good = scene && scene_prepare(scene, &prepared, &error);
    scene_destroy(scene);
    fuzz_verdict(good, &error);
    return 0;
}
