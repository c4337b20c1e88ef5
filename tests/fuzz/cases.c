/* Fuzzing lists of right answers: of those that are read, polygons have corners, and the
 * slips come to an end. */
#include "tools/cases.h"

#include "tests/fuzz/fuzz.h"
#include "tests/memory.h"
#include "tools/slips.h"

static void look_at(const struct known_case *known)
{
    struct case_polygons polygons;
    struct slip slips[SLIPS_MOST];
    if (case_polygons(known, &polygons)) {
        FUZZ_PROMISE(polygons.count > 0);
        for (int32_t i = 0; i < polygons.count; i++)
            FUZZ_PROMISE(polygons.corners[i] >= 3);
    }
    int count = slips_of(known, slips);
    FUZZ_PROMISE(count >= 0 && count <= SLIPS_MOST);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct error error = {0};
    struct cases cases = {.count = 0};
    struct source source;
    bool good = source_of_bytes(&source, "fuzz.csv", data, size, &error) &&
                text_of_source(&cases.text, &source, &error) &&
                cases_of_text(&cases, &error);
    source_close(&source);
    for (int64_t i = 0; good && i < cases.count; i++)
        look_at(&cases.items[i]);
    cases_free(&cases);
    fuzz_verdict(good, &error);
    return 0;
}
