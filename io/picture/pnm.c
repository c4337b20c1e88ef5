/* Writing and reading PFM and PPM. Both formats are a short header of text and then the
 * samples; PFM begins with the bottom scanline, PPM with the top one.
 *
 * The reader accepts the variants of other programs: any blanks between words of the
 * header, comments in PPM, grey PFM, a scale other than 1 (a factor on the samples, as in
 * Debevec's description and most readers). Nothing is forgiven in the size: missing or
 * extra samples mean a header of another picture. */
#include "io/picture/pnm.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/stop.h"
#include "io/run/output.h"
#include "io/scene/text.h"

static const double SCALE_LEAST = 1e-30, SCALE_MOST = 1e30; /* of a PFM, magnitude */

bool pfm_write(const struct image *image, const char *path, struct error *error)
{
    struct output output;
    if (!output_open(&output, path, error))
        return false;
    fprintf(output.file, "PF\n%d %d\n-1.0\n", image->width, image->height);
    for (int y = image->height - 1; y >= 0 && stop_check(error); y--) {
        const float *scanline = image->rgb + (size_t)y * (size_t)image->width * 3;
        for (int i = 0; i < 3 * image->width; i++)
            output_float(&output, scanline[i]);
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
    for (size_t i = 0; i < samples && stop_check(error); i++)
        putc(tone_encode(tone, (double)image->rgb[i]), output.file);
    return output_close(&output, error);
}

/* --- reading --- */

struct image_reader {
    struct binary *binary;
    struct image *image;
    bool plain, grey, big_endian;
    int sample_size; /* bytes */
    double scale;    /* factor on samples: of the PFM, or 1 / most of the PPM */
    int64_t most;    /* the greatest value of PPM samples */
    struct error *error;
};

static bool refuse(const struct image_reader *reader, const char *what)
{
    return error_set(reader->error, EXIT_USAGE, "%s: %s", reader->binary->path, what);
}

static bool is_blank(char c)
{
    return c != '\0' && strchr(" \t\v\f\r\n", c) != NULL;
}

/* Reads the next word of the header or of plain samples, without the blank behind.
 * Comments, in PPM only, go from # to the end of the line. */
static bool next_word(struct image_reader *reader, bool comments, char word[32])
{
    const char *data = reader->binary->data;
    int64_t at = reader->binary->position;
    while (is_blank(data[at]) || (comments && data[at] == '#'))
        at += data[at] == '#' ? (int64_t)strcspn(data + at, "\r\n") : 1;
    int length = 0;
    while (data[at] != '\0' && !is_blank(data[at]) && !(comments && data[at] == '#') &&
           length < 31)
        word[length++] = data[at++];
    word[length] = '\0';
    reader->binary->position = at;
    return length > 0 && length < 31;
}

static bool next_integer(struct image_reader *reader, bool comments, int64_t most,
                         int64_t *value)
{
    char word[32];
    const char *end = word;
    return next_word(reader, comments, word) && text_integer(&end, value) &&
           *end == '\0' && *value >= 0 && *value <= most;
}

static bool read_size(struct image_reader *reader, bool comments)
{
    int64_t width, height;
    if (!next_integer(reader, comments, IMAGE_SIDE_MOST, &width) ||
        !next_integer(reader, comments, IMAGE_SIDE_MOST, &height) || width == 0 ||
        height == 0)
        return refuse(reader, "bad width or height of the picture");
    reader->image->width = (int)width;
    reader->image->height = (int)height;
    return true;
}

static bool read_pfm_header(struct image_reader *reader)
{
    char word[32];
    double scale;
    reader->grey = reader->binary->data[1] == 'f';
    reader->sample_size = 4;
    if (!read_size(reader, false))
        return false;
    if (!next_word(reader, false, word) || !text_is_number(word, &scale) ||
        !(fabs(scale) >= SCALE_LEAST && fabs(scale) <= SCALE_MOST))
        return refuse(reader, "bad scale of the picture");
    reader->big_endian = scale > 0.0;
    reader->scale = fabs(scale);
    return true;
}

static bool read_ppm_header(struct image_reader *reader)
{
    reader->plain = reader->binary->data[1] == '3';
    if (!read_size(reader, true))
        return false;
    if (!next_integer(reader, true, 65535, &reader->most) || reader->most == 0)
        return refuse(reader, "bad greatest value of the picture");
    reader->sample_size = reader->most > 255 ? 2 : 1;
    reader->scale = 1.0 / (double)reader->most;
    return true;
}

/* Skips the one blank behind the header; CR LF count as one if followed by all
 * samples. */
static bool find_samples(struct image_reader *reader, int64_t bytes)
{
    struct binary *binary = reader->binary;
    if (!is_blank(binary->data[binary->position]))
        return refuse(reader, "no blank behind the header of the picture");
    bool pair = strncmp(binary->data + binary->position, "\r\n", 2) == 0;
    binary->position += pair && binary_left(binary) >= bytes + 2 ? 2 : 1;
    if (binary_left(binary) < bytes)
        return refuse(reader, "the file ends before its picture does");
    return true;
}

static bool read_plain(struct image_reader *reader, int64_t count)
{
    for (int64_t i = 0; i < count; i++) {
        int64_t value;
        if (!next_integer(reader, true, reader->most, &value))
            return refuse(reader,
                          "a sample is missing or not a number up to the greatest value");
        reader->image->rgb[i] = (float)((double)value * reader->scale);
    }
    return true;
}

static bool read_raw(struct image_reader *reader, int64_t count)
{
    struct binary *binary = reader->binary;
    for (int64_t i = 0; i < count; i++, binary->position += reader->sample_size) {
        uint64_t value =
            binary_integer(binary->data + binary->position, reader->sample_size, true);
        if (value > (uint64_t)reader->most)
            return refuse(reader, "a sample is above the greatest value");
        reader->image->rgb[i] = (float)((double)value * reader->scale);
    }
    return true;
}

/* Returns the nearest float. C99 does not define the conversion of doubles beyond the
 * largest. */
static float nearest_float(double x)
{
    return fabs(x) <= (double)FLT_MAX || !isfinite(x) ? (float)x
           : x > 0.0                                  ? FLT_MAX
                                                      : -FLT_MAX;
}

static void read_floats(struct image_reader *reader)
{
    struct binary *binary = reader->binary;
    int width = reader->image->width, bands = reader->grey ? 1 : 3;
    for (int y = reader->image->height - 1; y >= 0; y--) {
        float *scanline = reader->image->rgb + (size_t)y * (size_t)width * 3;
        for (int i = 0; i < 3 * width; i++) {
            const char *at =
                binary->data + binary->position + 4 * (bands == 1 ? i / 3 : i);
            scanline[i] = nearest_float((double)binary_float(at, reader->big_endian) *
                                        reader->scale);
        }
        binary->position += 4 * (int64_t)width * bands;
    }
}

static bool read_samples(struct image_reader *reader, bool floats)
{
    int64_t pixels = (int64_t)reader->image->width * reader->image->height;
    int64_t count = pixels * (reader->grey ? 1 : 3);
    int64_t bytes = reader->plain ? 2 * count - 1 : count * reader->sample_size;
    if (!find_samples(reader, bytes))
        return false;
    reader->image->rgb = alloc_array((size_t)pixels, 3 * sizeof *reader->image->rgb);
    if (floats)
        read_floats(reader);
    else if (!(reader->plain ? read_plain(reader, count) : read_raw(reader, count)))
        return false;
    return binary_is_over(reader->binary) ||
           refuse(reader, "bytes are left behind the picture");
}

bool pnm_read(struct image *image, enum image_kind *kind, struct binary *binary,
              struct error *error)
{
    struct image_reader reader = {.binary = binary, .image = image, .error = error};
    const char *data = binary->data;
    if (!is_blank(data[0] && data[1] ? data[2] : '\0') || !strchr("Ff36", data[1]))
        return refuse(&reader, "not a picture (PFM, PPM, HDR or PNG)");
    binary->position = 2;
    bool floats = data[1] == 'F' || data[1] == 'f';
    *kind = floats ? IMAGE_LINEAR : IMAGE_CODES;
    return (floats ? read_pfm_header(&reader) : read_ppm_header(&reader)) &&
           read_samples(&reader, floats);
}
