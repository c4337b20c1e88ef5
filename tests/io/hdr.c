/* Tests of io/picture/hdr.h: pixels byte for byte as Radiance's format says; how near
 * they come, over the whole range; and pictures as other programs write them. */
#include "io/picture/hdr.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "tests/images.h"
#include "tests/load.h"
#include "tests/random.h"

#define HDR "build/hdr_test.hdr"
#define HEAD "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n"

/* 1/2, 1/4 and 1/512 in 256ths of 2^0; 100, 99.7 and 0.1 in those of 2^7; 255.6 of them
 * are 255; and the ends of the range. */
static void test_bytes(void)
{
    static float pixels[] = {0.5f, 0.25f, 1.0f / 512.0f, 100.0f, 99.7f, 0.1f,
                             0.9985f, 0.0f, 0.0f, 0.998f, -1.0f, NAN,
                             0.0f, 0.0f, -3.0f, FLT_MAX, 1.0f, (float)1e38};
    static const unsigned char bytes[] = {128, 64, 1, 128, 200, 199, 0, 135,
                                          255, 0, 0, 128, 255, 0, 0, 128,
                                          0, 0, 0, 0, 255, 0, 150, 255};
    static const char head[] = "#?RADIANCE\nSOFTWARE=phr\nFORMAT=32-bit_rle_rgbe\n\n"
                               "-Y 3 +X 2\n";
    const struct image image = {2, 3, pixels};
    unsigned char got[200];
    forget();
    bool written = hdr_write(&image, HDR, &error);
    size_t size = load(HDR, got, sizeof got);
    tap_ok(written && size == sizeof head - 1 + sizeof bytes &&
               memcmp(got, head, sizeof head - 1) == 0,
           "the header: top row first");
    bool same = true;
    for (size_t i = 0; i < sizeof bytes; i++)
        same = same && got[size - sizeof bytes + i] == bytes[i];
    tap_ok(same, "the pixels, rounded to nearest");
    forget();
    tap_ok(!hdr_write(&image, "build/hdr_test_absent/a.hdr", &error) &&
               error.code == EXIT_FAILED,
           "into a missing folder");
    forget();
}

/* Written and read: each band within 1/256 of the largest of its pixel, from 2^-128 to
 * 2^127. */
static void test_nearness(void)
{
    enum { WIDTH = 100, HEIGHT = 255 };
    struct image image = {WIDTH, HEIGHT,
                          alloc_array(WIDTH * HEIGHT, 3 * sizeof *image.rgb)};
    struct random random = random_seed(1);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        image.rgb[i] = (float)ldexp(random_unit(&random), i / (3 * WIDTH) - 127);
    bool good = hdr_write(&image, HDR, &error) && read_back(HDR);
    tap_ok(good && kind == IMAGE_LINEAR && found.width == WIDTH && found.height == HEIGHT,
           "reads back: %s", error.text);
    double worst = 0.0, bias = 0.0;
    for (int i = 0; good && i < 3 * WIDTH * HEIGHT; i++) {
        const float *pixel = &image.rgb[i / 3 * 3];
        double largest = fmax((double)pixel[0], fmax((double)pixel[1], (double)pixel[2]));
        double off = ((double)found.rgb[i] - (double)image.rgb[i]) / largest;
        if (largest < ldexp(1.0, -128))
            continue;
        worst = fmax(worst, fabs(off));
        bias += off / (3 * WIDTH * HEIGHT);
    }
    tap_ok(worst <= 1.0 / 256.0, "within 1/256 of the largest band: 1/%.1f", 1.0 / worst);
    tap_ok(fabs(bias) < 1e-4, "neither more nor less in the mean: %g", bias);
    alloc_free(image.rgb);
    forget();
}

static void test_reading(void)
{
    CHECK_READ("pixels as they are, rows from the top",
               HEAD "-Y 2 +X 1\n\x80\x40\1\x81\xFF\0\0\x80", IMAGE_LINEAR, 1, 2, 1, 0.5f,
               1 / 128.0f, 255 / 256.0f, 0, 0);
    CHECK_READ("another magic, comments, CR LF, exposures",
               "#?RGBE\r\n# GAMMA=1\r\nEXPOSURE= 2\r\nEXPOSURE=4.0\r\n\r\n-Y 1 +X 1\r\n"
               "\x80\x40\0\x84",
               IMAGE_LINEAR, 1, 1, 1, 0.5f, 0);
    CHECK_READ("runs and counts, band by band",
               HEAD "-Y 1 +X 9\n\2\2\0\x09"
                    "\x89\x80"
                    "\3\1\2\3\x86\4"
                    "\x82\0\2\1\2\x85\xFF"
                    "\x85\x80\4\x80\x80\x80\0",
               IMAGE_LINEAR, 9, 1, 0.5f, 1 / 256.0f, 0, 0.5f, 2 / 256.0f, 0, 0.5f,
               3 / 256.0f, 1 / 256.0f, 0.5f, 4 / 256.0f, 2 / 256.0f, 0.5f, 4 / 256.0f,
               255 / 256.0f, 0.5f, 4 / 256.0f, 255 / 256.0f, 0.5f, 4 / 256.0f,
               255 / 256.0f, 0.5f, 4 / 256.0f, 255 / 256.0f, 0, 0, 0);
    CHECK_READ("beyond the largest float", HEAD "-Y 1 +X 1\n\xFF\x80\0\xFF", IMAGE_LINEAR,
               1, 1, ldexpf(255, 119), ldexpf(128, 119), 0);
    CHECK_READ("with an exposure, too",
               "#?RADIANCE\nEXPOSURE=1e-30\n\n-Y 1 +X 1\n\xFF\x80\0\xFF", IMAGE_LINEAR, 1,
               1, FLT_MAX, FLT_MAX, 0);
    CHECK_READ("2, 2 and 128 begin no runs",
               HEAD "-Y 1 +X 8\n\2\2\x80\x80\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0"
                    "\0\0\0\0\0\0\0\0",
               IMAGE_LINEAR, 8, 1, 2 / 256.0f, 2 / 256.0f, 0.5f, 0, 0, 0, 0, 0, 0, 0, 0,
               0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0);
}

static void test_refusing(void)
{
    REFUSED("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n1234",
            "the format of the pixels is not RGBE");
    REFUSED("#?RADIANCE\nEXPOSURE=0\n\n-Y 1 +X 1\n1234", "bad exposure of the picture");
    REFUSED(HEAD, "the file ends before its picture does");
    REFUSED(HEAD "+Y 1 +X 1\n1234", "the size of the picture is not '-Y N +X N'");
    REFUSED(HEAD "-Y 1 +X 0\n1234", "bad width or height of the picture");
    REFUSED(HEAD "-Y 16777216 +X 16777216\n1234",
            "the file ends before its picture does");
    REFUSED(HEAD "-Y 1 +X 1\n123", "the file ends before its picture does");
    REFUSED(HEAD "-Y 1 +X 1\n12345", "bytes are left behind the picture");
    REFUSED(HEAD "-Y 1 +X 2\n\2\2\2\2\1\1\1\1",
            "run lengths of the old kind are not read");
    REFUSED(HEAD "-Y 1 +X 8\n\2\2\0\x09\x88\1\x88\1\x88\1\x88\1",
            "the runs of a scanline have another length");
    REFUSED(HEAD "-Y 1 +X 8\n\2\2\0\x08\x89\1\x88\1\x88\1\x88\1",
            "the runs of a scanline have another length");
    REFUSED(HEAD "-Y 1 +X 8\n\2\2\0\x08\x88\1\x88\1\x88\1\0\1",
            "the runs of a scanline have another length");
}

int main(void)
{
    test_bytes();
    test_nearness();
    test_reading();
    test_refusing();
    remove(HDR);
    return tap_done();
}
