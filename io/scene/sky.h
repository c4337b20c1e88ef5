/* A sky around a scene, and the sun. */
#ifndef IO_SCENE_SKY_H
#define IO_SCENE_SKY_H

#include "geom/error.h"
#include "geom/scene.h"

enum sky_kind { SKY_NONE, SKY_UNIFORM, SKY_OVERCAST, SKY_CLEAR, SKY_TABLE };

struct sky {
    enum sky_kind kind;
    struct rgb level;      /* of a uniform sky its radiosity, W/m^2; of an overcast or
                            * clear one the radiance of the zenith, W/m^2/sr */
    const char *path;      /* of a table, borrowed; else NULL */
    struct vec3 sun;       /* direction towards the sun, of any length; 0: none */
    double sun_irradiance; /* of a surface that faces the sun, by the sun alone, W/m^2 */
};

/* Adds a sky to a scene not prepared yet: a dome of facets, far away, shining inwards,
 * down to the height of the lowest point. The facets have the last numbers of the input
 * triangles. North is to the back, east to the right: +y and +x where z is up.
 * Errors: a sun below the horizon; a clear sky without a sun; those of the table. */
bool sky_add(struct scene *scene, const struct sky *sky, struct error *error);

/* If the lamps of a scene not prepared yet are a dome around all else, of one radiosity
 * and black, that shines down from everywhere above the horizon, takes it for `*sky`:
 * its faces lose their area. Returns their number, else 0. */
int32_t sky_of_dome(struct scene *scene, struct sky *sky);

#endif
