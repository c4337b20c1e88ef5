/* The mean colour of a picture, in place of the picture: light sent by a wall into a room
 * is hardly changed by the wall's pattern. A mean of codes would be too dark, as half the
 * light has code 188 of 255. Equal codes are counted, so the mean depends on no order. */
#include "io/picture/texture.h"

#include "geom/alloc.h"
#include "io/picture/imagefile.h"

bool texture_mean(const char *path, struct rgb *mean, struct error *error)
{
    struct source source;
    struct image image = {0};
    enum image_kind kind = IMAGE_CODES;
    bool good = source_open_regular(&source, path, error) &&
                image_read(&image, &kind, &source, error) &&
                (kind == IMAGE_CODES ||
                 error_set(error, EXIT_USAGE, "%s: a picture of light", path));
    source_close(&source);
    int64_t counts[BANDS][256] = {{0}}, pixels = (int64_t)image.width * image.height;
    for (int64_t i = 0; good && i < BANDS * pixels; i++)
        counts[i % BANDS][(int)(255.0f * image.rgb[i] + 0.5f)]++;
    alloc_free(image.rgb);
    *mean = (struct rgb){{0.0, 0.0, 0.0}};
    for (int code = 0; code < 256 && good; code++)
        for (int c = 0; c < BANDS; c++)
            mean->band[c] +=
                (double)counts[c][code] / (double)pixels * tone_decode(code / 255.0);
    return good;
}
