/* Reading binary files.
 *
 * The file is read in chunks to its end and kept in memory. So the counts of a header can
 * be checked against the size before anything is allocated. The first chunk has to begin
 * with a magic of the format: reading /dev/zero ends there.
 * Numbers are put together byte by byte, so the byte order of the machine does not
 * matter. */
#include "io/scene/binary.h"

#include <string.h>

#include "geom/alloc.h"

static bool has_magic(const struct binary *binary, const char *magic, const char *kind,
                      struct error *error)
{
    if (!*magic)
        return true;
    for (; *magic; magic += *magic == ' ') {
        size_t length = strcspn(magic, " ");
        if (strncmp(binary->data, magic, length) == 0)
            return true;
        magic += length;
    }
    return error_set(error, EXIT_USAGE, "%s: not %s", binary->path, kind);
}

static bool read_chunks(struct binary *binary, struct source *source, const char *magic,
                        const char *kind, struct error *error)
{
    int64_t capacity = 0;
    size_t got;
    do {
        RESERVE(binary->data, &capacity, binary->size + SOURCE_CHUNK + 1);
        if (!source_read(source, binary->data + binary->size, &got, error))
            return false;
        binary->size += (int64_t)got;
        binary->data[binary->size] = '\0';
        if (!has_magic(binary, magic, kind, error))
            return false;
    } while (got == SOURCE_CHUNK);
    binary->data = alloc_resize(binary->data, (size_t)binary->size + 1, 1);
    return true;
}

bool binary_read(struct binary *binary, struct source *source, const char *magic,
                 const char *kind, struct error *error)
{
    *binary = (struct binary){.path = source->path, .line = 1};
    bool good = read_chunks(binary, source, magic, kind, error);
    if (!good)
        binary_free(binary);
    return good;
}

void binary_free(struct binary *binary)
{
    alloc_free(binary->data);
    binary->data = NULL;
    binary->size = binary->position = 0;
}

int64_t binary_left(const struct binary *binary)
{
    return binary->size - binary->position;
}

bool binary_is_over(const struct binary *binary)
{
    const char *rest = binary->data + binary->position;
    return (int64_t)strspn(rest, " \t\v\f\r\n") == binary_left(binary);
}

uint64_t binary_integer(const char *at, int count, bool big_endian)
{
    uint64_t value = 0;
    for (int i = 0; i < count; i++)
        value = value << 8 | (unsigned char)at[big_endian ? i : count - 1 - i];
    return value;
}

int64_t binary_signed(const char *at, int count, bool big_endian)
{
    uint64_t value = binary_integer(at, count, big_endian);
    uint64_t sign = UINT64_C(1) << (8 * count - 1);
    return value < sign ? (int64_t)value : -(int64_t)(sign - 1 - (value - sign)) - 1;
}

float binary_float(const char *at, bool big_endian)
{
    uint32_t bits = (uint32_t)binary_integer(at, 4, big_endian);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

double binary_double(const char *at, bool big_endian)
{
    uint64_t bits = binary_integer(at, 8, big_endian);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}
