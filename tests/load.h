/* Files that a test has written, in memory. */
#ifndef TESTS_LOAD_H
#define TESTS_LOAD_H

#include <stdio.h>

/* Reads at most `room` bytes. Returns how many; 0 if there is no such file. */
static inline size_t load(const char *path, void *bytes, size_t room)
{
    FILE *file = fopen(path, "rb");
    size_t size = file ? fread(bytes, 1, room, file) : 0;
    if (file)
        fclose(file);
    return size;
}

#endif
