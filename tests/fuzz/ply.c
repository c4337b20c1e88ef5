/* Fuzzing PLY: reading a scene, and the preparation of what was read. */
#include "io/ply.h"

#include "io/plyfile.h"
#include "tests/fuzz/fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct error error = {0};
    struct scene_repairs prepared;
    struct binary binary;
    struct scene *scene = NULL;
    if (binary_of_bytes(&binary, "fuzz.ply", data, size, "ply", "a PLY file", &error))
        scene = ply_of_binary(&binary, &error);
    FUZZ_PROMISE(!scene == (error.code != EXIT_DONE));
    bool good = scene && scene_prepare(scene, &prepared, &error);
    for (int32_t i = 0; scene && i < scene->input_count; i++)
        FUZZ_PROMISE(scene->material_of[i] >= 0 && scene->material_of[i] < scene->material_count);
    for (int32_t i = 0; scene && i < scene->material_count; i++)
        FUZZ_PROMISE(rgb_sum(scene->materials[i].reflectance) >= 0.0 &&
                     rgb_sum(scene->materials[i].emission) >= 0.0);
    scene_destroy(scene);
    fuzz_verdict(good, &error);
    return 0;
}
