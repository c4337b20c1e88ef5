/* Pictures that a test reads, from bytes and from files, and what it expects of them. */
#ifndef TESTS_IMAGES_H
#define TESTS_IMAGES_H

#include "io/picture/imagefile.h"
#include "tests/memory.h"
#include "tests/refusal.h"

/* The last one. */
static struct image found;
static enum image_kind kind;

static inline void forget(void)
{
    alloc_free(found.rgb);
    found = (struct image){0};
    forget_error();
}

/* Reads a picture, and closes its source, which was opened well or not. */
static inline bool read_picture(struct source *source, bool good)
{
    good = good && image_read(&found, &kind, source, &error);
    source_close(source);
    return good;
}

static inline bool read_bytes(const char *bytes, size_t size)
{
    struct source source;
    forget();
    return read_picture(&source, source_of_bytes(&source, "p", bytes, size, &error));
}

static inline bool read_back(const char *path)
{
    struct source source;
    forget();
    return read_picture(&source, source_open(&source, path, &error));
}

/* The bytes are a picture of that size and kind with these samples. */
static inline void check_read(const char *name, const char *bytes, size_t size,
                              enum image_kind expected, int width, int height,
                              const float *samples)
{
    bool right = read_bytes(bytes, size) && kind == expected && found.width == width &&
                 found.height == height;
    for (int i = 0; right && i < 3 * width * height; i++)
        right = found.rgb[i] == samples[i];
    tap_ok(right, "%s%s", name, error.text);
    forget();
}

#define CHECK_READ(name, bytes, kind, width, height, ...) \
    check_read(name, bytes, sizeof(bytes) - 1, kind, width, height, \
               (const float[]){__VA_ARGS__})

static inline void check_refused(const char *bytes, size_t size, const char *message)
{
    check_error(read_bytes(bytes, size) || found.rgb, message);
    forget();
}

#define REFUSED(bytes, message) check_refused(bytes, sizeof(bytes) - 1, "p: " message)

#endif
