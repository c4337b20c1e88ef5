/* The leaves of a solution as text: chapters 3, 5, 6 and 10 of the course.
 *
 *     phr SCENE.obj -o SOLUTION.ply
 *     leaves SOLUTION.ply
 *
 * prints a line for each leaf: root/path, the mean of B over the three bands [W/m^2], and
 * the nine coordinates of its corners. The path is the hierarchy part of the patch ID,
 * read from the root down: 7/203 is child 3 of child 0 of child 2 of root 7. A root that
 * is a leaf itself is 7/. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void fail(const char *text)
{
    fprintf(stderr, "leaves: %s\n", text);
    exit(2);
}

/* PLY files are little-endian, on any machine. */
static uint32_t read_bytes(FILE *file, int count)
{
    uint32_t value = 0;
    for (int k = 0; k < count; k++) {
        int byte = getc(file);
        if (byte == EOF)
            fail("the file ends too early");
        value |= (uint32_t)byte << 8 * k;
    }
    return value;
}

static float read_float(FILE *file)
{
    uint32_t bits = read_bytes(file, 4);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* What the header of a solution tells. */
struct header {
    long vertices, faces;
    int behind_vertex, behind_face; /* bytes after x y z, and after the hierarchy */
};

/* The bytes of a number, by the name of its type. */
static int size_of(const char *type)
{
    return strcmp(type, "double") == 0 ? 8 : strstr(type, "char") ? 1 : 4;
}

static struct header read_header(FILE *file)
{
    struct header header = {0, 0, 0, 0};
    char line[256], element[64] = "", type[64], name[64];
    int *behind = NULL; /* grows with each property; NULL: those have been counted */
    do {
        if (!fgets(line, sizeof line, file))
            fail("this is no solution of phr");
        if (sscanf(line, "element %63s", element) == 1)
            behind = NULL;
        sscanf(line, "element vertex %ld", &header.vertices);
        sscanf(line, "element face %ld", &header.faces);
        if (sscanf(line, "property %63s %63s", type, name) != 2)
            continue;
        if (behind)
            *behind += size_of(type);
        if (strcmp(element, "vertex") == 0 && strcmp(name, "z") == 0)
            behind = &header.behind_vertex;
        if (strcmp(element, "face") == 0 && strcmp(name, "hierarchy") == 0)
            behind = &header.behind_face;
    } while (strcmp(line, "end_header\n") != 0);
    return header;
}

/* Prints root/path. The path is behind the sentinel, the leftmost 1. */
static void print_id(uint32_t root, uint32_t hierarchy)
{
    int below = 0; /* digits */
    while (hierarchy >> 2 * below > 1)
        below++;
    printf("%lu/", (unsigned long)root);
    while (below-- > 0)
        printf("%lu", (unsigned long)(hierarchy >> 2 * below & 3));
}

static void print_leaf(FILE *file, const struct header *header, float (*vertices)[3])
{
    uint32_t corner[3];
    if (read_bytes(file, 1) != 3)
        fail("a leaf is no triangle");
    for (int k = 0; k < 3; k++)
        corner[k] = read_bytes(file, 4);
    double mean = 0.0;
    for (int band = 0; band < 3; band++)
        mean += (double)read_float(file) / 3.0;
    uint32_t root = read_bytes(file, 4), hierarchy = read_bytes(file, 4);
    print_id(root, hierarchy);
    printf(" %.4f ", mean);
    for (int k = 0; k < 3; k++) {
        if (corner[k] >= (uint32_t)header->vertices)
            fail("a leaf has a corner that is not there");
        const float *v = vertices[corner[k]];
        printf(" %.4f %.4f %.4f", (double)v[0], (double)v[1], (double)v[2]);
    }
    printf("\n");
    for (int k = 0; k < header->behind_face; k++)
        read_bytes(file, 1);
}

int main(int argc, char **argv)
{
    FILE *file = argc == 2 ? fopen(argv[1], "rb") : NULL;
    if (!file)
        fail("usage: leaves SOLUTION.ply");
    struct header header = read_header(file);
    float (*vertices)[3] = malloc((size_t)header.vertices * sizeof *vertices);
    if (!vertices)
        fail("no memory");
    for (long v = 0; v < header.vertices; v++) {
        for (int k = 0; k < 3; k++)
            vertices[v][k] = read_float(file);
        for (int k = 0; k < header.behind_vertex; k++)
            read_bytes(file, 1);
    }
    for (long f = 0; f < header.faces; f++)
        print_leaf(file, &header, vertices);
    free(vertices);
    fclose(file);
    return 0;
}
