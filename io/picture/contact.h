/* Contact shadows: reflected light within a leaf that touches a darker surface. */
#ifndef IO_PICTURE_CONTACT_H
#define IO_PICTURE_CONTACT_H

#include "io/picture/shading.h"
#include "rad/beyond/gather/gather.h"

/* True if the leaf with a point of barycentric coordinates `weight` on it touches a
 * surface that sends less light than arrives on the leaf. Sets `rest` to the radiosity by
 * all light but that straight from lamps there, W/m^2. Keeps what it finds of a leaf in
 * the shading's tiles. Pre: `shading` is of light without that of lamps. */
bool contact_at(struct final_gather *gather, const struct shading *shading, int32_t leaf,
                const double weight[3], struct rgb *rest);

#endif
