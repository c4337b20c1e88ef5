/* Reading PNG of 8 bits a sample: the stream of all chunks IDAT is inflated (RFC 1951),
 * and the filters of its rows are undone.
 *
 * A prefix code is the number of its words of each length, and its symbols in the order
 * of words: a word of some length is known by its distance from the first such word.
 * Damage is found by the codes, by the number of bytes, and by their sum; the sums of
 * chunks would tell no more. */
#include <stdlib.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/stop.h"
#include "io/picture/png.h"

enum {
    SYMBOLS = 288, DISTANCES = 32, LENGTHS = 19, /* of the three codes */
    LONGEST = 15, /* bits of a word */
    END = 256,    /* the symbol behind the last byte of a block */
    ADLER = 65521
};

struct prefix_code {
    int count[LONGEST + 1]; /* words of each length */
    int symbol[SYMBOLS];
};

struct deflated {
    const uint8_t *at, *end;                /* bytes not read yet */
    uint32_t bits;                          /* [bit_count] not taken, lowest first */
    int bit_count;
    struct prefix_code symbols, distances;
    uint8_t *bytes;                         /* [count] inflated */
    int64_t count, capacity, most;          /* most: as the picture has */
    bool bad;
};

/* Takes a number of so many bits; 0 behind the end. */
static int take_bits(struct deflated *stream, int count)
{
    for (; stream->bit_count < count; stream->bit_count += 8) {
        stream->bad = stream->bad || stream->at == stream->end;
        if (stream->bad)
            return 0;
        stream->bits |= (uint32_t)*stream->at++ << stream->bit_count;
    }
    int value = (int)(stream->bits & ((UINT32_C(1) << count) - 1));
    stream->bits >>= count;
    stream->bit_count -= count;
    return value;
}

static int take_symbol(struct deflated *stream, const struct prefix_code *code)
{
    int word = 0, first = 0, index = 0;
    for (int length = 1; length <= LONGEST; length++) {
        word = 2 * word + take_bits(stream, 1);
        first *= 2;
        if (word - first < code->count[length])
            return code->symbol[index + word - first];
        index += code->count[length];
        first += code->count[length];
    }
    stream->bad = true;
    return END;
}

/* Makes a code by the lengths of words, 0 for none. Bad: more than there can be. */
static void make_code(struct deflated *stream, struct prefix_code *code,
                      const uint8_t *lengths, int symbols)
{
    int index = 0, left = 1;
    for (int length = 1; length <= LONGEST; length++) {
        int first = index;
        for (int s = 0; s < symbols; s++)
            if (lengths[s] == length)
                code->symbol[index++] = s;
        code->count[length] = index - first;
        left = 2 * left - code->count[length];
        stream->bad = stream->bad || left < 0;
    }
}

/* Reads the lengths of the words of both codes, themselves words of a code. Returns the
 * number of symbols of the first. */
static int read_lengths(struct deflated *stream, uint8_t lengths[SYMBOLS + DISTANCES])
{
    static const uint8_t order[LENGTHS] = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                           11, 4,  12, 3, 13, 2, 14, 1, 15};
    int symbols = 257 + take_bits(stream, 5), all = symbols + 1 + take_bits(stream, 5);
    uint8_t of_lengths[LENGTHS] = {0};
    for (int i = 0, count = 4 + take_bits(stream, 4); i < count; i++)
        of_lengths[order[i]] = (uint8_t)take_bits(stream, 3);
    make_code(stream, &stream->symbols, of_lengths, LENGTHS);
    for (int i = 0; i < all && !stream->bad;) {
        int length = take_symbol(stream, &stream->symbols), repeat = 1;
        if (length >= 16) {
            repeat = length == 16   ? 3 + take_bits(stream, 2)
                     : length == 17 ? 3 + take_bits(stream, 3)
                                    : 11 + take_bits(stream, 7);
            stream->bad = stream->bad || (length == 16 && i == 0);
            length = length == 16 && i > 0 ? lengths[i - 1] : 0;
        }
        stream->bad = stream->bad || i + repeat > all;
        for (; repeat > 0 && !stream->bad; repeat--)
            lengths[i++] = (uint8_t)length;
    }
    return symbols;
}

/* Makes the codes of a block, or the fixed ones for a block without any. */
static void make_codes(struct deflated *stream, bool brings)
{
    uint8_t lengths[SYMBOLS + DISTANCES] = {0};
    for (int s = 0; s < SYMBOLS + DISTANCES && !brings; s++)
        lengths[s] = s < 144 ? 8 : s < 256 ? 9 : s < 280 ? 7 : s < SYMBOLS ? 8 : 5;
    int symbols = brings ? read_lengths(stream, lengths) : SYMBOLS;
    make_code(stream, &stream->symbols, lengths, symbols);
    make_code(stream, &stream->distances, lengths + symbols, DISTANCES);
}

static void put(struct deflated *stream, int byte)
{
    stream->bad = stream->bad || stream->count == stream->most;
    if (stream->bad)
        return;
    RESERVE(stream->bytes, &stream->capacity, stream->count + 1);
    stream->bytes[stream->count++] = (uint8_t)byte;
}

/* Returns the number begun by a symbol: the symbol itself below 2 parts; beyond, each
 * part more has a bit more behind it. */
static int take_number(struct deflated *stream, int symbol, int parts)
{
    int bits = symbol < 2 * parts ? 0 : symbol / parts - 1;
    int base = bits > 0 ? (parts + symbol % parts) << bits : symbol;
    return base + take_bits(stream, bits);
}

/* Puts out single bytes, and again those of some distance ago. */
static void inflate_block(struct deflated *stream, bool brings_codes)
{
    make_codes(stream, brings_codes);
    for (int symbol; (symbol = take_symbol(stream, &stream->symbols)) != END &&
                     !stream->bad;) {
        if (symbol < END) {
            put(stream, symbol);
            continue;
        }
        int length = symbol == 285 ? 258 : 3 + take_number(stream, symbol - 257, 4);
        int ago = take_symbol(stream, &stream->distances);
        stream->bad = stream->bad || symbol > 285 || ago > 29;
        int64_t distance = stream->bad ? 0 : 1 + take_number(stream, ago, 2);
        stream->bad = stream->bad || distance > stream->count;
        for (; length > 0 && !stream->bad; length--)
            put(stream, stream->bytes[stream->count - distance]);
    }
}

/* Puts out the bytes of a block without codes. */
static void copy_block(struct deflated *stream)
{
    stream->bits = 0;
    stream->bit_count = 0;
    int count = take_bits(stream, 16);
    stream->bad = stream->bad || take_bits(stream, 16) != 65535 - count;
    for (; count > 0 && !stream->bad; count--)
        put(stream, take_bits(stream, 8));
}

/* Inflates `most` bytes; bad if there are not as many, or their sum is wrong. */
static void inflate(struct deflated *stream)
{
    int method = take_bits(stream, 8), flags = take_bits(stream, 8);
    uint32_t sum = 1, sums = 0;
    stream->bad = stream->bad || method % 16 != 8 || (256 * method + flags) % 31 != 0;
    for (bool last = false; !last && !stream->bad && !stop_is_asked();) {
        last = take_bits(stream, 1);
        int kind = take_bits(stream, 2);
        stream->bad = stream->bad || kind == 3;
        if (kind == 0)
            copy_block(stream);
        else
            inflate_block(stream, kind == 2);
    }
    for (int64_t i = 0; i < stream->count; i++) {
        sum = (sum + stream->bytes[i]) % ADLER;
        sums = (sums + sum) % ADLER;
    }
    stream->bad = stream->bad || stream->count < stream->most ||
                  stream->end - stream->at < 4 ||
                  binary_integer((const char *)stream->at, 4, true) != (sums << 16 | sum);
}

/* Undoes the filter of a row of samples, with its number in front: each sample is the sum
 * of itself and a prediction from the samples to its left, above it, and left above.
 * `pixel`: samples of a pixel. */
static void undo_filter(struct deflated *stream, uint8_t *row, const uint8_t *above,
                        int64_t size, int pixel)
{
    stream->bad = stream->bad || row[0] > 4;
    for (int64_t i = 1; i < size && !stream->bad; i++) {
        int a = i > pixel ? row[i - pixel] : 0, b = above ? above[i] : 0;
        int c = above && i > pixel ? above[i - pixel] : 0;
        int to_a = abs(b - c), to_b = abs(a - c), to_c = abs(a + b - 2 * c);
        int nearest = to_a <= to_b && to_a <= to_c ? a : to_b <= to_c ? b : c;
        const int predicted[] = {0, a, b, (a + b) / 2, nearest};
        row[i] = (uint8_t)(row[i] + predicted[row[0]]);
    }
}

/* Sets the pixels, of `samples` bytes; fewer than three are the number of a colour. */
static void take_pixels(struct image *image, struct deflated *stream, int samples,
                        uint8_t palette[256][3])
{
    int64_t size = stream->most / image->height;
    float *to = image->rgb =
        alloc_array((size_t)stream->count / (size_t)samples, 3 * sizeof *to);
    for (int64_t at = 0; at < stream->count; at += size) {
        uint8_t *row = stream->bytes + at;
        undo_filter(stream, row, at > 0 ? row - size : NULL, size, samples);
        for (int64_t i = 1; i < size; i += samples)
            for (int c = 0; c < 3; c++)
                *to++ = (float)((samples < 3 ? palette[row[i]][c] : row[i + c]) / 255.0);
    }
}

/* Moves the data of the stream together, and takes the palette. */
static bool read_chunks(struct binary *binary, struct deflated *stream,
                        uint8_t palette[256][3])
{
    uint8_t *to = NULL;
    for (binary->position = 8; binary_left(binary) >= 12;) {
        uint8_t *chunk = (uint8_t *)binary->data + binary->position;
        int64_t size = (int64_t)binary_integer((char *)chunk, 4, true);
        if (size > binary_left(binary) - 12)
            return false;
        binary->position += size + 12;
        if (memcmp(chunk + 4, "PLTE", 4) == 0)
            memcpy(palette, chunk + 8, size < 768 ? (size_t)size : 768);
        if (memcmp(chunk + 4, "IDAT", 4) == 0) {
            to = to ? to : chunk;
            stream->at = stream->end ? stream->at : to;
            memmove(to, chunk + 8, (size_t)size);
            stream->end = to += size;
        }
        if (memcmp(chunk + 4, "IEND", 4) == 0)
            return true;
    }
    return false;
}

bool png_read(struct image *image, enum image_kind *kind, struct binary *binary,
              struct error *error)
{
    static const int SAMPLES[] = {1, 0, 3, 1, 2, 0, 4}; /* by the type of colours */
    const char *head = binary->data + 16;
    uint64_t width = binary->size > 33 ? binary_integer(head, 4, true) : 0;
    uint64_t height = width > 0 ? binary_integer(head + 4, 4, true) : 0;
    int samples = height > 0 && (uint8_t)head[9] <= 6 ? SAMPLES[(int)head[9]] : 0;
    if (samples == 0 || width > IMAGE_SIDE_MOST || height > IMAGE_SIDE_MOST ||
        head[8] != 8 || head[12] != 0 || memcmp(head - 4, "IHDR", 4) != 0)
        return error_set(error, EXIT_USAGE,
                         "%s: not a PNG of 8 bits a sample, without interlacing",
                         binary->path);
    uint8_t palette[256][3];
    for (int i = 0; i < 256; i++)
        memset(palette[i], i, 3); /* grey */
    int64_t row = 1 + (int64_t)width * samples;
    struct deflated stream = {.most = (int64_t)height * row};
    image->width = (int)width;
    image->height = (int)height;
    *kind = IMAGE_CODES;
    stream.bad = !read_chunks(binary, &stream, palette);
    inflate(&stream);
    if (!stream.bad)
        take_pixels(image, &stream, samples, palette);
    alloc_free(stream.bytes);
    return stop_check(error) &&
           (!stream.bad ||
            error_set(error, EXIT_USAGE, "%s: the PNG is damaged", binary->path));
}
