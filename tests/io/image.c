/* Tests of io/picture/pnm.h and imagefile.h: one picture of 2 x 3 pixels, byte for byte
 * as the two formats say; the reader on pictures of other programs, and on bad ones.
 *
 *      top    -> 1, 2, 4          0.5, 0.25, 0
 *      middle -> 0, 0, 0          -1, 100, 0.125
 *      bottom -> 8, 16, 32        0.0625, 1, 0        W/m^2 */
#include "io/picture/pnm.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "tests/images.h"
#include "tests/load.h"

#define PFM "build/image_test.pfm"
#define PPM "build/image_test.ppm"

static float pixels[3 * 2 * 3] = {1.0f, 2.0f, 4.0f, 0.5f, 0.25f, 0.0f, 0.0f, 0.0f, 0.0f,
                                  -1.0f, 100.0f, 0.125f, 8.0f, 16.0f, 32.0f, 0.0625f,
                                  1.0f, 0.0f};
static const struct image picture = {2, 3, pixels};

static bool file_is(const char *path, const char *header, const unsigned char *bytes,
                    size_t count)
{
    unsigned char written[200];
    size_t length = strlen(header);
    return load(path, written, sizeof written) == length + count &&
           memcmp(written, header, length) == 0 &&
           memcmp(written + length, bytes, count) == 0;
}

/* A power of two 2^k is (k + 127) << 23 as a float: two bytes tell all. Bottom first. */
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
    tap_ok(pfm_write(&picture, PFM, &error) && error.code == EXIT_DONE &&
               file_is(PFM, "PF\n2 3\n-1.0\n", bytes, sizeof bytes),
           "PFM: little endian, the bottom row first");
    tap_ok(read_back(PFM) && kind == IMAGE_LINEAR && found.width == 2 &&
               found.height == 3 && memcmp(found.rgb, pixels, sizeof pixels) == 0,
           "which reads back");
    forget();
}

/* sRGB codes by the formula: 1 is 255, 1/2 188, 1/4 137, 1/8 99, 1/16 71. Top first. */
static void test_ppm(void)
{
    static const unsigned char plain[] = {255, 255, 255, 188, 137, 0, 0,  0,   0,
                                          0,   255, 99,  255, 255, 255, 71, 255, 0};
    static const unsigned char quarter[] = {137, 188, 255, 99,  71,  0, 0,  0,   0,
                                            0,   255, 49,  255, 255, 255, 34, 137, 0};
    struct tone tone = tone_make(1.0);
    tap_ok(ppm_write(&picture, &tone, PPM, &error) &&
               file_is(PPM, "P6\n2 3\n255\n", plain, sizeof plain),
           "PPM: the top row first");
    tap_ok(read_back(PPM) && kind == IMAGE_CODES &&
               found.rgb[3] == (float)(188 / 255.0) && found.rgb[0] == 1.0f,
           "which reads back, in codes");
    forget();
    tone = tone_make(0.25);
    tap_ok(ppm_write(&picture, &tone, PPM, &error) &&
               file_is(PPM, "P6\n2 3\n255\n", quarter, sizeof quarter),
           "PPM with an exposure of 1/4");
}

static void test_errors(void)
{
    struct tone tone = tone_make(1.0);
    tap_ok(!pfm_write(&picture, "build/image_test_absent/a.pfm", &error) &&
               error.code == EXIT_FAILED,
           "PFM into a missing folder");
    forget();
    tap_ok(!ppm_write(&picture, &tone, "build/image_test_absent/a.ppm", &error) &&
               error.code == EXIT_FAILED,
           "PPM into a missing folder");
}

static void test_reading(void)
{
    CHECK_READ("big endian, the bottom row first",
               "PF\n1 2\n1\n" "\x3F\x80\0\0" "\x40\0\0\0" "\0\0\0\0"
               "\xC0\0\0\0" "\x3F\0\0\0" "\x3F\x80\0\0",
               IMAGE_LINEAR, 1, 2, -2, 0.5f, 1, 1, 2, 0);
    CHECK_READ("grey, a scale",
               "Pf 2 1 -2.5 " "\0\0\x80\x3F" "\0\0\0\xC0",
               IMAGE_LINEAR, 2, 1, 2.5f, 2.5f, 2.5f, -5, -5, -5);
    CHECK_READ("CR LF behind the scale",
               "Pf\r\n1 1\r\n-1\r\n" "\0\0\x80\x3F",
               IMAGE_LINEAR, 1, 1, 1, 1, 1);
    CHECK_READ("CR alone, a sample that begins with LF", "Pf\r1 1\r-1\r" "\n\0\x80\x3F",
               IMAGE_LINEAR, 1, 1, 1.00000119f, 1.00000119f, 1.00000119f);
    CHECK_READ("beyond the largest float",
               "Pf 1 1 -1e30 " "\0\0\x80\x7E",
               IMAGE_LINEAR, 1, 1, 3.40282347e38f, 3.40282347e38f, 3.40282347e38f);
    CHECK_READ("plain, comments", "P3 # 1 2\n2#\r1\n8 # eight\n0 2 4\n6 8 #\n0",
               IMAGE_CODES, 2, 1, 0, 0.25f, 0.5f, 0.75f, 1, 0);
    CHECK_READ("raw, 255, a sample like a blank", "P6\n1 1 255\n\n\0\xFF", IMAGE_CODES, 1,
               1, 10 / 255.0f, 0, 1);
    CHECK_READ("raw, two bytes, most significant first",
               "P6 1 1 65535\n" "\xFF\xFF" "\x01\0" "\0\x01",
               IMAGE_CODES, 1, 1, 1, 256 / 65535.0f, 1 / 65535.0f);
    bool right = read_bytes("Pf 1 1 -1 \0\0\xC0\x7F", 14) && isnan(found.rgb[0]);
    tap_ok(right, "NaN is a sample");
    forget();
}

static void test_refusing(void)
{
    REFUSED("", "not a picture (PFM, PPM, HDR or PNG)");
    REFUSED("P5\n1 1 255\n\1", "not a picture (PFM, PPM, HDR or PNG)");
    REFUSED("P6", "not a picture (PFM, PPM, HDR or PNG)");
    REFUSED("PF\n0 1\n-1\n", "bad width or height of the picture");
    REFUSED("PF\n1\n", "bad width or height of the picture");
    REFUSED("PF\n99999999999999999999 1\n-1\n", "bad width or height of the picture");
    REFUSED("PF\n16777216 16777216\n-1\n1234", "the file ends before its picture does");
    REFUSED("P3\n16777216 16777216\n9\n1 2 3", "the file ends before its picture does");
    REFUSED("PF\n1 1\n0\n123412341234", "bad scale of the picture");
    REFUSED("PF\n1 1\n1e99\n123412341234", "bad scale of the picture");
    REFUSED("PF\n1 1\n-1", "no blank behind the header of the picture");
    REFUSED("PF\n1 1\n-1\n12341234123", "the file ends before its picture does");
    REFUSED("PF\n1 1\n-1\n1234123412345", "bytes are left behind the picture");
    REFUSED("P6\n1 1 65536\nabcdef", "bad greatest value of the picture");
    REFUSED("P6\n1 1 98\nabc", "a sample is above the greatest value");
    REFUSED("P3\n1 1 9\n1 2 10",
            "a sample is missing or not a number up to the greatest value");
    REFUSED("P3\n1 1 9\n1 2     ",
            "a sample is missing or not a number up to the greatest value");
    REFUSED("P3\n1 1 9\n1 2 3 4", "bytes are left behind the picture");
    tap_ok(!read_back("build/image_test_absent") && error.code == EXIT_USAGE,
           "a missing file: %s", error.text);
}

int main(void)
{
    test_pfm();
    test_ppm();
    test_errors();
    test_reading();
    test_refusing();
    remove(PFM);
    remove(PPM);
    return tap_done();
}
