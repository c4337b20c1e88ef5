/* Irradiance of leaves and points. */
#ifndef TOOLS_IRRADIANCE_H
#define TOOLS_IRRADIANCE_H

#include "io/picture/shading.h"
#include "rad/beyond/meter.h"
#include "tools/run.h"

/* Of the leaves: H is B of a forest in which nothing emits. */
struct irradiance {
    struct forest forest; /* the run's, with H as radiosity */
    struct scene scene;   /* the run's, without emission */
    struct rgb *straight; /* [patches] the part straight from lamps, W/m^2 */
    float *error;         /* [patches] bound on the error of a band of H, for 95 % of
                             leaves, W/m^2; NULL: not known */
};

/* Collective. Finds H of all leaves, on all ranks: where all bands are reflected it is
 * (B - E) / rho, else a meter's, at four points of the leaf, and 0 of a black lamp. */
void irradiance_make(struct run *run, struct irradiance *found);

/* Returns H at the vertices of the run's shading: (B - E) / rho, or the mean of leaves
 * around; all leaves around a vertex are of one material. [vertex_count], to be freed
 * with alloc_free(). */
struct rgb *irradiance_at_vertices(const struct irradiance *found,
                                   const struct shading *shading);
void irradiance_free(struct irradiance *irradiance);

/* Collective. Reads a meter `count` times, each on one rank: `read` fills in `floats`
 * floats for one. Returns [count * floats] on rank 0, to be freed; NULL on the others. */
float *irradiance_deal(struct run *run, int64_t count, int floats,
                       void (*read)(const struct meter *meter, const void *context,
                                    int64_t item, float *floats),
                       const void *context);

#endif
