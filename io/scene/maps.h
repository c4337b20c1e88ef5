/* Pictures on surfaces: the colour of what a face shows of them. */
#ifndef IO_SCENE_MAPS_H
#define IO_SCENE_MAPS_H

#include "io/scene/mtl.h"

/* A triangle in a picture, of width and height 1, which repeats beyond; from the lower
 * left corner. */
struct map_part {
    double at[3][2];
};

/* Finds the means of the linear light of a picture over parts, [count + 1], the last one
 * over all of it; 1 for white. False with an error if there is none. */
typedef bool map_mean(const char *path, const struct map_part *parts, int64_t count,
                      struct rgb *means, struct error *error);

/* A triangle of the scene. */
struct map_face {
    int32_t material;     /* number in the table */
    bool has_part;        /* else it has no texture coordinates */
    struct map_part part;
    double area;          /* in any unit */
};

/* Multiplies Kd and Ke of the materials in use, 1 where not given, by the means of their
 * pictures over their faces, by area; of faces without texture coordinates over the whole
 * picture. Where faces of a material differ by more than a tenth in a band from its mean,
 * each has its own Kd in `colours`, [count]; in all others colours[i].band[0] is -1.
 * Without a mean, Kd stays, or is halved if white, and Ke stays. `mean_of` may be NULL:
 * there is no mean. Adds the pictures without a mean to `lost`, and the paths of all to
 * `files` unless NULL. */
void maps_take(struct mtl_table *table, const struct map_face *faces, int64_t count,
               map_mean *mean_of, struct text_missing *lost, struct text_names *files,
               struct rgb *colours);

#endif
