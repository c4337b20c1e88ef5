/* The open parts of leaves: those that no thing covers which stands on the leaf. */
#ifndef IO_PICTURE_OPEN_PARTS_H
#define IO_PICTURE_OPEN_PARTS_H

#include <stdbool.h>
#include <stdint.h>

#include "octree/octree.h"
#include "rad/patch.h"

/* Open parts of a leaf at most; and of one of which it is proved besides that no point
 * between them is covered. */
enum { OPEN_PARTS = 254, PROVED_OPEN = 255 };

/* Finds the open area of each leaf, not covered by a solid that stands on the leaf, in
 * 254ths, rounded down; 255 where no point of it can be covered. Leaves are in the order
 * of forest_next_leaf(). Only the leaves first, first + step, ... are examined, the
 * others get 0, so that ranks can divide the leaves and add their numbers. `octree` is
 * that of the scene.
 * Returns [count] numbers, to be freed with alloc_free(). */
uint8_t *open_parts_survey(const struct forest *forest, const struct octree *octree,
                           int first, int step, int64_t *count);

/* The open fraction of a leaf, 1/4 to 1; with fewer parts it counts as covered: 0. */
double open_parts_fraction(uint8_t parts);

/* True if a solid or a narrow gap covers a point of a leaf, scene units. */
bool leaf_is_shut_at(const struct forest *forest, const struct octree *octree,
                     int32_t leaf, struct vec3 point);

#endif
