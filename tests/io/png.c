/* Tests of io/picture/png.h, of the parts that its own reader passes over (ISO/IEC 15948,
 * RFC 1951): chunks and their CRC bit by bit, and complete codes. The reader, which
 * opens pictures of other programs (tests/85-imgdiff.sh), finds the pixels of the PPM. */
#include "io/picture/png.h"

#include <stdint.h>
#include <string.h>

#include "io/picture/pnm.h"
#include "tests/images.h"
#include "tests/load.h"
#include "tests/random.h"

#define PNG "build/png_test.png"
#define PPM "build/png_test.ppm"

enum { SIZE_MOST = 1 << 20 };

static uint8_t file[SIZE_MOST], stream[SIZE_MOST];

static uint32_t number(const uint8_t *at)
{
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

/* The remainder of the bits as a polynomial, lowest bit first. */
static uint32_t crc_of(const uint8_t *bytes, size_t count)
{
    uint32_t rest = 0xFFFFFFFFu;
    for (size_t bit = 0; bit < 8 * count; bit++) {
        uint32_t top = (rest ^ (uint32_t)bytes[bit / 8] >> bit % 8) & 1;
        rest = rest >> 1 ^ (top ? 0xEDB88320u : 0);
    }
    return ~rest;
}

struct chunks {
    char types[200]; /* of the chunks, equal ones that follow each other once */
    uint32_t width, height;
    bool right;      /* all chunks are whole, with their CRC */
    size_t size;     /* of the stream, bytes */
};

/* Takes the chunks apart; puts those of the picture together in `stream`. */
static struct chunks read_chunks(size_t size)
{
    struct chunks chunks = {.right = size > 8 && !memcmp(file, "\x89PNG\r\n\x1A\n", 8)};
    for (size_t at = 8; at < size && chunks.right;) {
        size_t length = number(file + at), seen = strlen(chunks.types);
        const uint8_t *type = file + at + 4;
        chunks.right = length <= size - at - 12 && seen < sizeof chunks.types - 5 &&
                      crc_of(type, length + 4) == number(type + 4 + length);
        if (seen < 4 || memcmp(chunks.types + seen - 4, type, 4) != 0)
            memcpy(chunks.types + seen, type, 4);
        if (memcmp(type, "IHDR", 4) == 0) {
            chunks.width = number(type + 4);
            chunks.height = number(type + 8);
            chunks.right = chunks.right && !memcmp(type + 12, "\x08\x02\0\0\0", 5);
        }
        if (chunks.right && memcmp(type, "IDAT", 4) == 0) {
            memcpy(stream + chunks.size, type + 4, length);
            chunks.size += length;
        }
        at += 12 + length;
    }
    return chunks;
}

/* --- the stream --- */

static size_t next_bit, bits_left;

static int take_bits(int count)
{
    int value = 0;
    for (int k = 0; k < count && bits_left > 0; k++, next_bit++, bits_left--)
        value |= (stream[next_bit / 8] >> next_bit % 8 & 1) << k;
    return value;
}

/* A prefix code: symbols by length, and among these by number. Bits come first bit
 * first. */
static int take_symbol(const uint8_t *lengths, int symbols)
{
    int code = 0, first = 0;
    for (int length = 1; length <= 15; length++) {
        int count = 0;
        code = code << 1 | take_bits(1);
        for (int s = 0; s < symbols; s++)
            count += lengths[s] == length;
        if (code - first < count) {
            for (int s = 0, k = code - first;; s++)
                if (lengths[s] == length && k-- == 0)
                    return s;
        }
        first = (first + count) << 1;
    }
    return -1;
}

/* The share of all words that begin with a symbol, in 32768ths: 32768 if the code is
 * complete. */
static int share_of(const uint8_t *lengths, int symbols)
{
    int share = 0;
    for (int s = 0; s < symbols; s++)
        share += lengths[s] ? 1 << (15 - lengths[s]) : 0;
    return share;
}

/* True if the first block is the only one, and brings two complete codes. */
static bool codes_are_complete(size_t size)
{
    static const int order[19] = {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2,
                                  14, 1, 15};
    uint8_t of_lengths[19] = {0}, lengths[288 + 32] = {0};
    next_bit = 16;
    bits_left = 8 * size - 16;
    bool good = take_bits(1) == 1 && take_bits(2) == 2;
    int symbols = 257 + take_bits(5), distances = 1 + take_bits(5);
    for (int i = 0, count = 4 + take_bits(4); i < count; i++)
        of_lengths[order[i]] = (uint8_t)take_bits(3);
    for (int i = 0; i < symbols + distances; i++)
        lengths[i] = (uint8_t)take_symbol(of_lengths, 19);
    return good && symbols == 257 && share_of(of_lengths, 19) == 32768 &&
           share_of(lengths, symbols) == 32768 &&
           share_of(lengths + symbols, distances) == 32768;
}

/* --- pictures --- */

/* Codes anywhere, or near those of the pixels to their left. */
static void check_picture(int width, int height, bool smooth)
{
    size_t w = (size_t)width, h = (size_t)height, samples = 3 * w * h;
    struct tone tone = tone_make(1.0);
    struct image image = {width, height, alloc_array(samples, sizeof *image.rgb)};
    struct random random = random_seed(samples);
    for (size_t i = 0; i < samples; i++)
        image.rgb[i] =
            smooth && i > 2 ? image.rgb[i - 3] + (float)(random_unit(&random) - 0.5) / 100
                            : (float)random_unit(&random);
    bool written = png_write(&image, &tone, PNG, &error) &&
                   ppm_write(&image, &tone, PPM, &error);
    size_t size = load(PNG, file, SIZE_MOST);
    struct chunks chunks = read_chunks(size);
    tap_ok(written && chunks.right && strcmp(chunks.types, "IHDRsRGBIDATIEND") == 0 &&
               chunks.width == w && chunks.height == h,
           "%d x %d: chunks %s and their CRC", width, height, chunks.types);
    tap_ok(codes_are_complete(chunks.size), "one block of complete codes");
    bool read = read_back(PPM);
    struct image codes = found;
    found.rgb = NULL;
    read = read_back(PNG) && read && kind == IMAGE_CODES && found.width == width &&
           found.height == height;
    for (size_t i = 0; read && i < samples; i++)
        read = found.rgb[i] == codes.rgb[i];
    tap_ok(read && (!smooth || 3 * size < 2 * samples),
           "the pixels of the PPM in %zu bytes", size);
    alloc_free(codes.rgb);
    alloc_free(image.rgb);
    forget();
}

int main(void)
{
    check_picture(1, 1, false);
    check_picture(3, 2, false);
    check_picture(7, 300, false);
    check_picture(400, 200, true);
    struct tone tone = tone_make(1.0);
    float rgb[3] = {0};
    struct image image = {1, 1, rgb};
    tap_ok(!png_write(&image, &tone, "build/png_test_absent/a.png", &error) &&
               error.code == EXIT_FAILED,
           "into a missing folder");
    remove(PNG);
    remove(PPM);
    return tap_done();
}
