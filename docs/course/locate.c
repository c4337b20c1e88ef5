/* Which patch is at a point? Chapter 5 of the course.
 *
 *     locate X Y LEVEL
 *
 * The root is the triangle (0, 0), (1, 0), (0, 1). At each level the child that has the
 * point is found by barycentric coordinates (geom/triangle.h), and its number is appended
 * to the ID (rad/id.h). Then the same path is read back from the ID alone, and its
 * corners are computed from the root. */
#include <stdio.h>
#include <stdlib.h>

#include "geom/triangle.h"
#include "rad/id.h"

/* The hierarchy part as a number and, without leading zeros, as bits: the sentinel, then
 * two for each step. */
static void print_id(struct patch_id id)
{
    printf("%5d %9lu  1", id_level(id), (unsigned long)id.hierarchy);
    for (int step = 0; step < id_level(id); step++)
        printf(" %d%d", id_step(id, step) / 2, id_step(id, step) % 2);
    printf("\n");
}

int main(int argc, char **argv)
{
    if (argc != 4 || atoi(argv[3]) < 0 || atoi(argv[3]) > ID_MAX_LEVEL) {
        fprintf(stderr, "usage: locate X Y LEVEL\n");
        return 2;
    }
    const struct triangle root = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    struct vec3 x = {atof(argv[1]), atof(argv[2]), 0.0};
    struct patch_id id = id_of_root(0);
    double weights[3];
    triangle_weights(&root, x, weights);
    printf("level hierarchy  bits\n");
    print_id(id);
    while (id_level(id) < atoi(argv[3])) {
        id = id_child(id, triangle_child_at(weights));
        print_id(id);
    }
    struct triangle t = root;
    for (int step = 0; step < id_level(id); step++)
        t = triangle_child(&t, id_step(id, step));
    printf("corners");
    for (int k = 0; k < 3; k++)
        printf("  %.4f %.4f", t.corner[k].x, t.corner[k].y);
    printf("\n");
    return 0;
}
