/* Mean colours of a picture, in place of the picture: light sent by a wall into a room is
 * hardly changed by the wall's pattern. A mean of codes would be too dark, as half the
 * light has code 188 of 255. Equal codes are counted, so the mean of a picture depends on
 * no order. That of a part is over the middles of equal triangles, about one a pixel. */
#include "io/picture/texture.h"

#include <math.h>

#include "geom/alloc.h"
#include "io/picture/imagefile.h"

enum { CODES = 256, LEAST = 4, MOST = 64 /* triangles along a side of a part */ };

static int code_of(float sample)
{
    return (int)(255.0f * sample + 0.5f);
}

static struct rgb mean_of_all(const struct image *image, const double light[CODES])
{
    int64_t counts[BANDS][CODES] = {{0}};
    int64_t pixels = (int64_t)image->width * image->height;
    struct rgb mean = {{0.0, 0.0, 0.0}};
    for (int64_t i = 0; i < BANDS * pixels; i++)
        counts[i % BANDS][code_of(image->rgb[i])]++;
    for (int code = 0; code < CODES; code++)
        for (int c = 0; c < BANDS; c++)
            mean.band[c] += (double)counts[c][code] / (double)pixels * light[code];
    return mean;
}

/* The pixel of a coordinate, which repeats, of `count` pixels along a side. */
static int pixel_of(double at, int count)
{
    double within = (at - floor(at)) * count;
    return within < count ? (int)within : count - 1;
}

static struct rgb mean_of_part(const struct image *image, const double light[CODES],
                               const struct map_part *part)
{
    const double (*at)[2] = part->at;
    double pixels = 0.5 * image->width * image->height *
                    fabs((at[1][0] - at[0][0]) * (at[2][1] - at[0][1]) -
                         (at[2][0] - at[0][0]) * (at[1][1] - at[0][1]));
    int side = pixels < LEAST * LEAST ? LEAST : pixels < MOST * MOST ? (int)sqrt(pixels)
                                                                     : MOST;
    struct rgb mean = {{0.0, 0.0, 0.0}};
    for (int i = 0; i < side; i++)
        for (int j = 0; j < 2 * (side - i) - 1; j++) { /* upright ones, and others */
            double third = j % 2 ? 2.0 / 3.0 : 1.0 / 3.0;
            double u = (i + third) / side, v = (j / 2 + third) / side;
            double x = at[0][0] + u * (at[1][0] - at[0][0]) + v * (at[2][0] - at[0][0]);
            double y = at[0][1] + u * (at[1][1] - at[0][1]) + v * (at[2][1] - at[0][1]);
            int64_t row = image->height - 1 - pixel_of(y, image->height);
            const float *rgb =
                &image->rgb[3 * (row * image->width + pixel_of(x, image->width))];
            for (int c = 0; c < BANDS; c++)
                mean.band[c] += light[code_of(rgb[c])] / ((double)side * side);
        }
    return mean;
}

bool texture_mean(const char *path, const struct map_part *parts, int64_t count,
                  struct rgb *means, struct error *error)
{
    struct source source;
    struct image image = {0};
    enum image_kind kind = IMAGE_CODES;
    double light[CODES];
    bool good = source_open_regular(&source, path, error) &&
                image_read(&image, &kind, &source, error) &&
                (kind == IMAGE_CODES ||
                 error_set(error, EXIT_USAGE, "%s: a picture of light", path));
    source_close(&source);
    for (int code = 0; code < CODES; code++)
        light[code] = tone_decode(code / 255.0);
    for (int64_t i = 0; i < count && good; i++)
        means[i] = mean_of_part(&image, light, &parts[i]);
    if (good)
        means[count] = mean_of_all(&image, light);
    alloc_free(image.rgb);
    return good;
}
