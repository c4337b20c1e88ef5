/* Fuzzing scenes known by their first bytes, OBJ mostly: reading, and the preparation of
 * the scene. */
#include "tests/fuzz/fuzz.h"
#include "tests/memory.h"
#include "tests/reading.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct error error = {0};
    struct obj_repairs read = {0};
    struct scene_repairs prepared;
    struct source source;
    struct scene *scene = NULL;
    if (source_of_bytes(&source, "nowhere/fuzz", data, size, &error))
        scene = ply_is_meant(&source) ? ply_read(&source, &error)
                                      : obj_of_source(&source, &read, &error);
    source_close(&source);
    FUZZ_PROMISE(!scene == (error.code != EXIT_DONE));
    bool good = scene && scene_prepare(scene, &prepared, &error);
    for (int32_t i = 0; scene && i < scene->input_count; i++) {
        FUZZ_PROMISE(scene->material_of[i] >= 0 &&
                     scene->material_of[i] < scene->material_count);
        FUZZ_PROMISE(scene->groups.of[i] >= 0 &&
                     scene->groups.of[i] < scene->groups.count);
    }
    scene_destroy(scene);
    fuzz_verdict(good, &error);
    return 0;
}
