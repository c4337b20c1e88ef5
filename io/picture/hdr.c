/* Radiance's pictures: lines of text up to an empty one, a line with the size, and four
 * bytes a pixel (G. Ward, "Real Pixels", Graphics Gems II; Radiance's filefmts.pdf).
 *
 * Programs differ in the middle of a step: Blender (and Radiance's own description) takes
 * a byte R for R + 1/2, ImageMagick and OpenImageIO for R. phr rounds for the latter, and
 * reads in the same way; the former then shows up to 1/128 more.
 *
 * Scanlines may have run lengths: then they begin with 2, 2 and their length in two
 * bytes, most significant first, and each band is packed by itself: a count up to 128 and
 * so many bytes, or 128 + count and the byte to repeat. Run lengths are read, but not
 * written: little is saved in a picture with shades, and all programs read plain pixels.
 * A written pixel is never taken for the beginning of run lengths, as its largest band is
 * at least 128 or all bands are 0. */
#include "io/picture/hdr.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/stop.h"
#include "io/run/output.h"
#include "io/scene/text.h"

enum { BIAS = 128, PACKED_LEAST = 8, PACKED_MOST = 32767, RUN_MOST = 127 };

static void encode(const float *rgb, unsigned char bytes[4])
{
    double band[3], largest = 0.0;
    int exponent;
    memset(bytes, 0, 4);
    for (int c = 0; c < 3; c++) { /* NaN is not above 0 */
        band[c] = rgb[c] > 0.0f ? fmin((double)rgb[c], ldexp(255.0, 127 - 8)) : 0.0;
        largest = fmax(largest, band[c]);
    }
    frexp(largest, &exponent); /* 2^(exponent - 1) <= largest < 2^exponent */
    if (largest <= 0.0 || exponent + BIAS < 1)
        return;
    for (int c = 0; c < 3; c++)
        bytes[c] = (unsigned char)fmin(255.0, ldexp(band[c], 8 - exponent) + 0.5);
    bytes[3] = (unsigned char)(exponent + BIAS);
}

bool hdr_write(const struct image *image, const char *path, struct error *error)
{
    struct output output;
    if (!output_open(&output, path, error))
        return false;
    fprintf(output.file, "#?RADIANCE\nSOFTWARE=phr\n");
    output_write_note(&output, "# ");
    fprintf(output.file, "FORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n", image->height,
            image->width);
    const float *rgb = image->rgb;
    for (int y = 0; y < image->height && stop_check(error); y++)
        for (int x = 0; x < image->width; x++, rgb += 3) {
            unsigned char bytes[4];
            encode(rgb, bytes);
            fwrite(bytes, 1, 4, output.file);
        }
    return output_close(&output, error);
}

/* --- reading --- */

static const char ENDS[] = "the file ends before its picture does";

static bool refuse(const struct binary *binary, struct error *error, const char *reason)
{
    return error_set(error, EXIT_USAGE, "%s: %s", binary->path, reason);
}

/* Moves behind the next line, at whose end a zero takes the place of the line end.
 * Returns the line, or NULL without an end. */
static char *next_line(struct binary *binary)
{
    char *line = binary->data + binary->position;
    char *end = memchr(line, '\n', (size_t)binary_left(binary));
    if (!end)
        return NULL;
    binary->position += end + 1 - line;
    *end = '\0';
    if (end > line && end[-1] == '\r')
        end[-1] = '\0';
    return line;
}

/* Reads the lines up to the empty one. `*exposure`: the product of all exposures
 * given. */
static bool read_header(struct binary *binary, double *exposure, struct error *error)
{
    static const char EXPOSURE[] = "EXPOSURE=", FORMAT[] = "FORMAT=";
    char *line;
    *exposure = 1.0;
    while ((line = next_line(binary)) != NULL && *line) {
        double factor;
        if (strncmp(line, FORMAT, sizeof FORMAT - 1) == 0 &&
            strcmp(text_trim(line + sizeof FORMAT - 1), "32-bit_rle_rgbe") != 0)
            return refuse(binary, error, "the format of the pixels is not RGBE");
        if (strncmp(line, EXPOSURE, sizeof EXPOSURE - 1) != 0)
            continue;
        if (!text_is_number(text_trim(line + sizeof EXPOSURE - 1), &factor))
            return refuse(binary, error, "bad exposure of the picture");
        *exposure *= factor;
    }
    return (line != NULL && *exposure >= 1e-30 && *exposure <= 1e30) ||
           refuse(binary, error, line ? "bad exposure of the picture" : ENDS);
}

/* Passes the text and a number behind. False if either is missing. */
static bool pass_number(const char **at, const char *text, int64_t *value)
{
    size_t length = strlen(text);
    if (strncmp(*at, text, length) != 0)
        return false;
    *at += length;
    return text_integer(at, value);
}

/* Reads "-Y HEIGHT +X WIDTH". */
static bool read_size(struct binary *binary, struct image *image, struct error *error)
{
    int64_t height, width;
    const char *line = next_line(binary);
    if (!line)
        return refuse(binary, error, ENDS);
    if (!pass_number(&line, "-Y ", &height) || !pass_number(&line, " +X ", &width) ||
        *line)
        return refuse(binary, error, "the size of the picture is not '-Y N +X N'");
    if (height < 1 || width < 1 || height > IMAGE_SIDE_MOST || width > IMAGE_SIDE_MOST)
        return refuse(binary, error, "bad width or height of the picture");
    image->width = (int)width;
    image->height = (int)height;
    return true;
}

static bool can_be_packed(int width)
{
    return width >= PACKED_LEAST && width <= PACKED_MOST;
}

/* True if the file is long enough for the picture, with the longest possible runs. */
static bool has_room(const struct binary *binary, const struct image *image)
{
    int64_t runs = (image->width + RUN_MOST - 1) / RUN_MOST;
    int64_t scanline = can_be_packed(image->width) ? 4 + 8 * runs : 4 * image->width;
    return binary_left(binary) / scanline >= image->height;
}

/* Unpacks one band of a scanline to every fourth byte. */
static bool unpack_band(struct binary *binary, int width, unsigned char *bytes)
{
    for (int x = 0; x < width;) {
        const char *at = binary->data + binary->position;
        int count = binary_left(binary) > 0 ? (unsigned char)*at : 0;
        bool repeated = count > 128;
        count -= repeated ? 128 : 0;
        int64_t size = 1 + (repeated ? 1 : count);
        if (count == 0 || count > width - x || binary_left(binary) < size)
            return false;
        for (int i = 0; i < count; i++)
            bytes[4 * x++] = (unsigned char)at[1 + (repeated ? 0 : i)];
        binary->position += size;
    }
    return true;
}

/* Reads the pixels of a scanline, [width][4]. */
static bool read_scanline(struct binary *binary, int width, unsigned char *bytes,
                          struct error *error)
{
    const char *at = binary->data + binary->position;
    int64_t size = 4 * (int64_t)width;
    if (binary_left(binary) < 4)
        return refuse(binary, error, ENDS);
    if (can_be_packed(width) && at[0] == 2 && at[1] == 2 && !(at[2] & 0x80)) {
        bool good = binary_integer(at + 2, 2, true) == (uint64_t)width;
        binary->position += 4;
        for (int band = 0; band < 4; band++)
            good = good && unpack_band(binary, width, bytes + band);
        return good ||
               refuse(binary, error, "the runs of a scanline have another length");
    }
    if (binary_left(binary) < size)
        return refuse(binary, error, ENDS);
    memcpy(bytes, at, (size_t)size);
    binary->position += size;
    for (int x = 0; x < width; x++)
        if (memcmp(bytes + 4 * x, "\1\1\1", 3) == 0)
            return refuse(binary, error, "run lengths of the old kind are not read");
    return true;
}

static bool read_pixels(struct binary *binary, struct image *image, double scale,
                        struct error *error)
{
    size_t width = (size_t)image->width;
    unsigned char *bytes = alloc_array(width, 4);
    float *rgb = image->rgb;
    bool good = true;
    for (int y = 0; y < image->height && good; y++) {
        good = read_scanline(binary, image->width, bytes, error);
        for (size_t i = 0; i < 4 * width && good; i += 4) {
            double unit = bytes[i + 3] ? ldexp(scale, bytes[i + 3] - BIAS - 8) : 0.0;
            for (size_t c = 0; c < 3; c++)
                *rgb++ = (float)fmin(bytes[i + c] * unit, (double)FLT_MAX);
        }
    }
    alloc_free(bytes);
    return good;
}

bool hdr_read(struct image *image, enum image_kind *kind, struct binary *binary,
              struct error *error)
{
    double exposure;
    *kind = IMAGE_LINEAR;
    if (!read_header(binary, &exposure, error) || !read_size(binary, image, error))
        return false;
    if (!has_room(binary, image))
        return refuse(binary, error, ENDS);
    size_t pixels = (size_t)image->width * (size_t)image->height;
    image->rgb = alloc_array(pixels, 3 * sizeof *image->rgb);
    if (!read_pixels(binary, image, 1.0 / exposure, error))
        return false;
    return binary_left(binary) == 0 ||
           refuse(binary, error, "bytes are left behind the picture");
}
