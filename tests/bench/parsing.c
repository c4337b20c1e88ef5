/* How fast OBJ files are read: parsing FILE.obj [RUNS]
 *
 * Prints the megabytes per second (10^6 bytes) of obj_read(), and of a reader that only
 * looks at every byte of the file, one fgetc() after the other; each the best of some
 * runs, since a machine can only be slower than it is. Seconds are those of the
 * processor, so that a crowded machine counts less. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "io/scene/obj.h"

static double seconds(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

/* Number of bytes in the file; `*lines` makes it look at them. */
static long count_bytes(const char *path, long *lines)
{
    FILE *file = fopen(path, "rb");
    long count = 0;
    *lines = 0;
    if (!file)
        return 0;
    for (int c; (c = fgetc(file)) != EOF; count++)
        *lines += c == '\n';
    fclose(file);
    return count;
}

static double best_of_bytes(const char *path, int runs, long *bytes)
{
    double best = 1e30;
    for (int i = 0; i < runs; i++) {
        long lines;
        double start = seconds();
        *bytes = count_bytes(path, &lines);
        double taken = seconds() - start;
        best = taken < best ? taken : best;
    }
    return best;
}

static double best_of_scenes(const char *path, int runs, long *triangles)
{
    double best = 1e30;
    for (int i = 0; i < runs; i++) {
        struct error error = {0};
        struct obj_repairs repairs = {0};
        double start = seconds();
        struct scene *scene = obj_read(path, &repairs, &error);
        double taken = seconds() - start;
        if (!scene) {
            fprintf(stderr, "parsing: %s\n", error.text);
            exit(error.code);
        }
        best = taken < best ? taken : best;
        *triangles = scene->input_count;
        scene_destroy(scene);
    }
    return best;
}

int main(int count, char **arguments)
{
    if (count < 2 || count > 3) {
        fprintf(stderr, "usage: parsing FILE.obj [RUNS]\n");
        return EXIT_USAGE;
    }
    int runs = count > 2 ? atoi(arguments[2]) : 5;
    long bytes = 0, triangles = 0;
    double parse = best_of_scenes(arguments[1], runs, &triangles);
    double look = best_of_bytes(arguments[1], runs, &bytes);
    printf("%ld triangles, %.1f MB\n", triangles, 1e-6 * (double)bytes);
    printf("obj_read       %7.1f MB/s\n", 1e-6 * (double)bytes / parse);
    printf("byte by byte   %7.1f MB/s\n", 1e-6 * (double)bytes / look);
    printf("ratio          %7.2f\n", look / parse);
    return EXIT_DONE;
}
