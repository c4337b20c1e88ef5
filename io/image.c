/* Writing pictures. Both formats are a line or three of text and then plain samples; they
 * differ in the row they begin with: PFM at the bottom, PPM at the top. */
#include "io/image.h"

#include "io/output.h"

bool pfm_write(const struct image *image, const char *path, struct error *error)
{
    struct output output;
    if (!output_open(&output, path, error))
        return false;
    fprintf(output.file, "PF\n%d %d\n-1.0\n", image->width, image->height);
    for (int y = image->height - 1; y >= 0; y--) {
        const float *row = image->rgb + (size_t)y * (size_t)image->width * 3;
        for (int i = 0; i < 3 * image->width; i++)
            output_float(&output, row[i]);
    }
    return output_close(&output, error);
}

bool ppm_write(const struct image *image, const struct tone *tone, const char *path,
               struct error *error)
{
    struct output output;
    if (!output_open(&output, path, error))
        return false;
    fprintf(output.file, "P6\n%d %d\n255\n", image->width, image->height);
    size_t samples = (size_t)image->width * (size_t)image->height * 3;
    for (size_t i = 0; i < samples; i++)
        putc(tone_encode(tone, (double)image->rgb[i]), output.file);
    return output_close(&output, error);
}
