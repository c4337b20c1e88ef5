/* Tests of io/picture/texture.h: the mean of pictures of other programs (fuzz/corpus/)
 * against libm, and files that have none. */
#include "io/picture/texture.h"

#include <math.h>

#include "geom/alloc.h"
#include "tests/images.h"
#include "tests/load.h"

#define PICTURE "build/texture_test.ppm"

static double linear_of(double code)
{
    return code <= 0.04045 ? code / 12.92 : pow((code + 0.055) / 1.055, 2.4);
}

/* The picture has the mean of its samples, each made linear. */
static void check_mean(const char *path)
{
    struct rgb mean = {{0}};
    double sum[BANDS] = {0};
    bool right = read_back(path);
    double pixels = (double)found.width * found.height;
    for (int i = 0; right && i < BANDS * found.width * found.height; i++)
        sum[i % BANDS] += linear_of((double)found.rgb[i]);
    forget();
    right = right && texture_mean(path, NULL, 0, &mean, &error);
    for (int c = 0; c < BANDS; c++)
        right = right && fabs(mean.band[c] - sum[c] / pixels) < 1e-6;
    tap_ok(right, "%s: mean %.4f %.4f %.4f%s", path, mean.band[0], mean.band[1],
           mean.band[2], error.text);
}

static void check_none(const char *path, const char *message)
{
    char line[200];
    struct rgb mean;
    forget_error();
    snprintf(line, sizeof line, "%s: %s", path, message);
    check_error(texture_mean(path, NULL, 0, &mean, &error), line);
}

int main(void)
{
    struct rgb mean;
    write_text(PICTURE, "P3 2 1 255 255 0 188 0 0 188\n");
    bool good = texture_mean(PICTURE, NULL, 0, &mean, &error);
    tap_ok(good && mean.band[0] == 0.5 && mean.band[1] == 0.0 &&
               fabs(mean.band[2] - 0.5) < 0.003,
           "black and white are half of white, code 188: %g %g %g", mean.band[0],
           mean.band[1], mean.band[2]);
    /* White on the left, and above the middle; corners count from below. */
    static const struct map_part PARTS[] = {
        {{{0.0, 0.0}, {0.5, 0.0}, {0.0, 1.0}}}, {{{1.0, 0.0}, {1.0, 0.5}, {0.5, 0.0}}},
        {{{1.0, 1.0}, {0.5, 1.0}, {1.0, 0.5}}}, {{{-3.0, 7.0}, {-2.5, 7.0}, {-3.0, 8.0}}},
        {{{0.5, 0.0}, {1.0, 0.0}, {0.5, 2.0}}}, {{{0.2, 0.2}, {0.2, 0.2}, {0.2, 0.2}}}};
    static const double EXPECTED[] = {1.0, 0.0, 1.0, 1.0, 0.375, 1.0};
    enum { COUNT = sizeof PARTS / sizeof PARTS[0] };
    struct rgb means[COUNT + 1];
    write_text(PICTURE, "P3 2 2 255 255 255 255  255 255 255  255 255 255  0 0 0\n");
    good = texture_mean(PICTURE, PARTS, COUNT, means, &error);
    for (int i = 0; i < COUNT; i++)
        tap_ok(good && fabs(means[i].band[0] - EXPECTED[i]) < 0.02, "part %d: %g", i,
               means[i].band[0]);
    tap_ok(good && means[COUNT].band[2] == 0.75, "all: %g", means[COUNT].band[2]);
    static const char *const PNG[] = {"rgb",        "rgba",    "grey",
                                      "grey_alpha", "palette", "up"};
    for (size_t i = 0; i < sizeof PNG / sizeof PNG[0]; i++) {
        char path[100];
        snprintf(path, sizeof path, "tests/fuzz/corpus/image/%s.png", PNG[i]);
        check_mean(path);
    }
    check_mean("tests/fuzz/corpus/image/raw.ppm");
    check_none("build", "not a regular file");
    check_none("/dev/zero", "not a regular file");
    check_none("tests/fuzz/corpus/image/little.pfm", "a picture of light");
    check_none("tests/fuzz/corpus/image/view", "cannot read: No such file or directory");
    write_text(PICTURE, "P3 2 1 255 255 0");
    struct error wrong = {EXIT_DONE, ""};
    tap_ok(!texture_mean(PICTURE, NULL, 0, &mean, &wrong) && wrong.code == EXIT_USAGE,
           "half a picture: %s", wrong.text);
    remove(PICTURE);
    return tap_done();
}
