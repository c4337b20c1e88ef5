/* Files that a test writes and reads, as a whole. */
#ifndef TESTS_LOAD_H
#define TESTS_LOAD_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Reads at most `room` bytes. Returns how many; 0 if there is no such file. */
static inline size_t load(const char *path, void *bytes, size_t room)
{
    FILE *file = fopen(path, "rb");
    size_t size = file ? fread(bytes, 1, room, file) : 0;
    if (file)
        fclose(file);
    return size;
}

static inline void write_bytes(const char *path, const void *bytes, size_t count)
{
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, count, file) != count || fclose(file) != 0) {
        printf("Bail out! cannot write %s (is there a folder build?)\n", path);
        exit(1);
    }
}

static inline void write_text(const char *path, const char *text)
{
    write_bytes(path, text, strlen(text));
}

#endif
