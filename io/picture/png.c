/* Writing PNG (ISO/IEC 15948): chunks of a length, a type, bytes and their CRC. The rows
 * of the picture, each byte less that of the pixel to its left (filter 1), are one stream
 * in the format deflate (RFC 1951).
 *
 * Neighbours differ by little, so bytes near 0 are frequent, in any picture. The stream
 * has one prefix code, good for such bytes: 1 bit for 0, 3 bits for 1 and -1, and two
 * bits more for each doubling. The code needs no counts of bytes and no tree, and the
 * file is a quarter of the PPM (Cornell box; a room of 1,000: a third), where zlib -9
 * comes to a seventh. Blocks without a code ("stored") would save 50 lines here. */
#include "io/picture/png.h"

#include <stdint.h>

#include "geom/alloc.h"
#include "geom/stop.h"
#include "io/run/output.h"

enum {
    END = 256,           /* the symbol behind the last byte */
    SYMBOLS = 257,
    LONGEST = 15,        /* bits of a symbol */
    LEFT_DIFFERENCE = 1, /* the filter */
    ADLER = 65521,
    NOTE_MOST = 1000,    /* bytes of the chunk of the note */
    ROOM = 1024          /* bytes of a chunk beside the row: the note, headers, the end */
};

struct png {
    struct output output;
    uint32_t crc_of[256];     /* remainders of bytes */
    uint16_t code[SYMBOLS];   /* first bit lowest */
    uint8_t *bytes;           /* [count] of the next chunk */
    size_t count;
    uint64_t bits;            /* [bit_count] not filling a byte yet, first lowest */
    int bit_count;
    uint64_t sum, sum_of_sums; /* of the bytes compressed: Adler-32 */
};

/* --- chunks --- */

static void fill_crc_table(struct png *png)
{
    for (uint32_t byte = 0; byte < 256; byte++) {
        uint32_t crc = byte;
        for (int bit = 0; bit < 8; bit++)
            crc = crc & 1 ? UINT32_C(0xEDB88320) ^ crc >> 1 : crc >> 1;
        png->crc_of[byte] = crc;
    }
}

static uint32_t add_crc(const struct png *png, uint32_t crc, const void *bytes,
                        size_t count)
{
    const uint8_t *at = bytes;
    for (size_t i = 0; i < count; i++)
        crc = png->crc_of[(crc ^ at[i]) & 255] ^ crc >> 8;
    return crc;
}

static void append(struct png *png, int byte)
{
    png->bytes[png->count++] = (uint8_t)byte;
}

static void append_uint32(struct png *png, uint32_t value)
{
    for (int shift = 24; shift >= 0; shift -= 8)
        append(png, (int)(value >> shift & 255));
}

/* Writes the chunk of the bytes appended. */
static void write_chunk(struct png *png, const char type[4])
{
    FILE *file = png->output.file;
    uint32_t crc = add_crc(png, UINT32_MAX, type, 4);
    output_uint32_big(&png->output, (uint32_t)png->count);
    fwrite(type, 1, 4, file);
    fwrite(png->bytes, 1, png->count, file);
    output_uint32_big(&png->output, ~add_crc(png, crc, png->bytes, png->count));
    png->count = 0;
}

/* --- deflate --- */

static void append_bits(struct png *png, unsigned bits, int count)
{
    png->bits |= (uint64_t)bits << png->bit_count;
    png->bit_count += count;
    for (; png->bit_count >= 8; png->bit_count -= 8, png->bits >>= 8)
        append(png, (int)(png->bits & 255));
}

static unsigned reversed(unsigned bits, int count)
{
    unsigned result = 0;
    for (; count > 0; count--, bits >>= 1)
        result = result << 1 | (bits & 1);
    return result;
}

/* Returns the bits of a symbol: an odd number, for all codes together to be complete: 1/2
 * + 2/2^3 + 4/2^5 + ... + 128/2^15 + 2/2^9 = 1. */
static int symbol_length(int symbol)
{
    int length = 1;
    if (symbol == 128 || symbol == END)
        return 9;
    for (int size = symbol < 128 ? symbol : 256 - symbol; size > 0; size >>= 1)
        length += 2;
    return length;
}

/* Numbers the codes of each length in the order of their symbols. */
static void fill_codes(struct png *png)
{
    unsigned next = 0;
    for (int length = 1; length <= LONGEST; length++, next <<= 1)
        for (int symbol = 0; symbol < SYMBOLS; symbol++)
            if (symbol_length(symbol) == length)
                png->code[symbol] = (uint16_t)reversed(next++, length);
}

/* Appends the length of a code: three bits, for the eight odd ones are as frequent. */
static void append_length(struct png *png, int length)
{
    append_bits(png, reversed((unsigned)(length - 1) / 2, 3), 3);
}

/* Appends the head of the stream and of its only block: the lengths of all codes. */
static void begin_stream(struct png *png)
{
    static const int ORDER[] = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                11, 4,  12, 3, 13, 2, 14, 1, 15};
    append(png, 0x78); /* deflate, distances up to 32768 */
    append(png, 0x01);
    append_bits(png, 1, 1);  /* the last block */
    append_bits(png, 2, 2);  /* its codes follow */
    append_bits(png, 0, 5);  /* 257 symbols */
    append_bits(png, 1, 5);  /* 2 distances, which do not occur: nothing is repeated */
    append_bits(png, 15, 4); /* 19 lengths of the codes of lengths */
    for (int i = 0; i < 19; i++)
        append_bits(png, ORDER[i] % 2 == 1 && ORDER[i] <= LONGEST ? 3 : 0, 3);
    for (int symbol = 0; symbol < SYMBOLS; symbol++)
        append_length(png, symbol_length(symbol));
    append_length(png, 1);
    append_length(png, 1);
}

static void compress(struct png *png, int byte)
{
    png->sum += (uint64_t)byte;
    png->sum_of_sums += png->sum;
    append_bits(png, png->code[byte], symbol_length(byte));
}

static void end_stream(struct png *png)
{
    append_bits(png, png->code[END], symbol_length(END));
    append_bits(png, 0, 7); /* fills the last byte */
    append_uint32(png, (uint32_t)(png->sum_of_sums << 16 | png->sum));
}

/* --- the picture --- */

static void compress_row(struct png *png, const float *row, int width,
                         const struct tone *tone)
{
    int left[3] = {0, 0, 0};
    compress(png, LEFT_DIFFERENCE);
    for (int i = 0; i < 3 * width; i++) {
        int code = tone_encode(tone, (double)row[i]);
        compress(png, (code - left[i % 3]) & 255);
        left[i % 3] = code;
    }
    png->sum %= ADLER;
    png->sum_of_sums %= ADLER;
}

static void append_text(struct png *png, const char *text)
{
    for (; *text && png->count < NOTE_MOST; text++)
        append(png, *text);
}

static void write_head(struct png *png, const struct image *image,
                       const struct tone *tone)
{
    char exposure[64];
    fwrite("\x89PNG\r\n\x1A\n", 1, 8, png->output.file);
    append_uint32(png, (uint32_t)image->width);
    append_uint32(png, (uint32_t)image->height);
    append(png, 8); /* bits a sample */
    append(png, 2); /* red, green, blue */
    append(png, 0); /* deflate */
    append(png, 0); /* a filter for each row */
    append(png, 0); /* top to bottom, without a preview */
    write_chunk(png, "IHDR");
    append(png, 0); /* for looking at */
    write_chunk(png, "sRGB");
    snprintf(exposure, sizeof exposure, "--exposure %.17g\n", tone->exposure);
    append_text(png, "Comment");
    append(png, 0);
    append_text(png, output_note());
    append_text(png, exposure);
    if (*output_note())
        write_chunk(png, "tEXt");
    png->count = 0;
}

bool png_write(const struct image *image, const struct tone *tone, const char *path,
               struct error *error)
{
    struct png png = {.sum = 1};
    if (!output_open(&png.output, path, error))
        return false;
    size_t samples = 3 * (size_t)image->width;
    png.bytes = alloc_array(2 * samples + ROOM, 1);
    fill_crc_table(&png);
    fill_codes(&png);
    write_head(&png, image, tone);
    begin_stream(&png);
    for (int y = 0; y < image->height && stop_check(error); y++) {
        compress_row(&png, image->rgb + (size_t)y * samples, image->width, tone);
        if (y == image->height - 1)
            end_stream(&png);
        write_chunk(&png, "IDAT");
    }
    write_chunk(&png, "IEND");
    alloc_free(png.bytes);
    return output_close(&png.output, error);
}
