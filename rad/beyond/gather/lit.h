/* How bright the spaces of a scene are: what light, noise and lamps are measured by. */
#ifndef RAD_BEYOND_GATHER_LIT_H
#define RAD_BEYOND_GATHER_LIT_H

#include "rad/beyond/node.h"

/* A band with less than this part of all light is made no more right than one with this
 * part, since the tolerance of the solution is a part of all light. */
#define GATHER_DIM 1e-3

/* Means over the surfaces of a space, but for a sky, by the radiosities of the forest. */
struct lit {
    double area;       /* of the surfaces, square scene units */
    double mean;       /* radiosity, over bands, W/m^2 */
    double reflected;  /* the reflected part, over bands, W/m^2 */
    double lamp_least; /* a lamp emits more than this, over bands, W/m^2 */
    double bright_least; /* a bright patch reflects more than this */
    double bright_part;  /* the part of the reflected light by patches aimed at, 1 */
    struct rgb scale;  /* factors that give each band the mean of all three, 1. A band
                          with less than GATHER_DIM of this mean counts as having so
                          much */
};

/* The number of spaces, and the one of a patch. */
static inline int32_t lit_count(const struct model *model)
{
    return model->spaces ? model->spaces->count : 1;
}

/* [lit_count()], to be freed with alloc_free(). Pre: there is a solution. */
struct lit *lit_find(const struct model *model);

/* Finds the reflected part anew, and what is bright beside it. */
void lit_renew(struct lit *lit, const struct model *model);

#endif
