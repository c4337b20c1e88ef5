/* Tests of io/image.h: one picture of 2 x 3 pixels, byte for byte as the two formats say.
 *
 *      top    -> 1, 2, 4          0.5, 0.25, 0
 *      middle -> 0, 0, 0          -1, 100, 0.125
 *      bottom -> 8, 16, 32        0.0625, 1, 0        W/m^2 */
#include "io/image.h"

#include <stdio.h>
#include <string.h>

#include "tests/tap.h"

#define PFM "build/image_test.pfm"
#define PPM "build/image_test.ppm"

static float pixels[3 * 2 * 3] = {1.0f, 2.0f,  4.0f,  0.5f,    0.25f, 0.0f,   0.0f, 0.0f, 0.0f,
                                  -1.0f, 100.0f, 0.125f, 8.0f, 16.0f, 32.0f, 0.0625f, 1.0f, 0.0f};
static const struct image picture = {2, 3, pixels};

static bool file_is(const char *path, const char *header, const unsigned char *bytes, size_t count)
{
    unsigned char found[200];
    size_t length = strlen(header);
    FILE *file = fopen(path, "rb");
    if (!file)
        return false;
    size_t got = fread(found, 1, sizeof found, file);
    fclose(file);
    return got == length + count && memcmp(found, header, length) == 0 &&
           memcmp(found + length, bytes, count) == 0;
}

/* A power of two 2^k is (k + 127) << 23 as a float: its two last bytes tell all. Bottom first. */
static void test_pfm(void)
{
    static const unsigned char bytes[] = {
        0, 0, 0x00, 0x41, 0, 0, 0x80, 0x41, 0, 0, 0x00, 0x42, /* 8, 16, 32 */
        0, 0, 0x80, 0x3D, 0, 0, 0x80, 0x3F, 0, 0, 0x00, 0x00, /* 1/16, 1, 0 */
        0, 0, 0x00, 0x00, 0, 0, 0x00, 0x00, 0, 0, 0x00, 0x00,
        0, 0, 0x80, 0xBF, 0, 0, 0xC8, 0x42, 0, 0, 0x00, 0x3E, /* -1, 100, 1/8 */
        0, 0, 0x80, 0x3F, 0, 0, 0x00, 0x40, 0, 0, 0x80, 0x40, /* 1, 2, 4 */
        0, 0, 0x00, 0x3F, 0, 0, 0x80, 0x3E, 0, 0, 0x00, 0x00, /* 1/2, 1/4, 0 */
    };
    struct error error = {EXIT_DONE, ""};
    tap_ok(pfm_write(&picture, PFM, &error) && error.code == EXIT_DONE &&
               file_is(PFM, "PF\n2 3\n-1.0\n", bytes, sizeof bytes),
           "PFM: little endian, the bottom row first");
}

/* sRGB codes by the formula: 1 is 255, 1/2 188, 1/4 137, 1/8 99, 1/16 71. Top first. */
static void test_ppm(void)
{
    static const unsigned char plain[] = {255, 255, 255, 188, 137, 0, 0,  0,   0,
                                          0,   255, 99,  255, 255, 255, 71, 255, 0};
    static const unsigned char quarter[] = {137, 188, 255, 99,  71,  0, 0,  0,   0,
                                            0,   255, 49,  255, 255, 255, 34, 137, 0};
    struct tone tone = tone_make(1.0);
    struct error error = {EXIT_DONE, ""};
    tap_ok(ppm_write(&picture, &tone, PPM, &error) &&
               file_is(PPM, "P6\n2 3\n255\n", plain, sizeof plain),
           "PPM: the top row first");
    tone = tone_make(0.25);
    tap_ok(ppm_write(&picture, &tone, PPM, &error) &&
               file_is(PPM, "P6\n2 3\n255\n", quarter, sizeof quarter),
           "PPM with an exposure of 1/4");
}

static void test_errors(void)
{
    struct tone tone = tone_make(1.0);
    struct error error = {EXIT_DONE, ""};
    tap_ok(!pfm_write(&picture, "build/image_test_absent/a.pfm", &error) &&
               error.code == EXIT_FAILED,
           "PFM into a missing folder");
    error = (struct error){EXIT_DONE, ""};
    tap_ok(!ppm_write(&picture, &tone, "build/image_test_absent/a.ppm", &error) &&
               error.code == EXIT_FAILED,
           "PPM into a missing folder");
}

int main(void)
{
    test_pfm();
    test_ppm();
    test_errors();
    remove(PFM);
    remove(PPM);
    return tap_done();
}
