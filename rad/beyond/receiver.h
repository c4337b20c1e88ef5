/* A receiver of the final gather while its light is collected: a leaf, or a point of the
 * surfaces. For the files of the final gather alone. */
#ifndef RAD_BEYOND_RECEIVER_H
#define RAD_BEYOND_RECEIVER_H

#include "rad/beyond/final_gather.h"
#include "rad/beyond/sequence.h"

struct receiver {
    struct final_gather *gather;
    struct facet facet;   /* the leaf; of points a triangle without extent, */
    const struct gather_points *points; /* and these; NULL: of a leaf there are any */
    bool keeps;           /* its terms are kept, as a row */
    struct gather_row row;
    int64_t first_term;
    uint64_t seed;        /* made of an ID */
    struct vec3 along;    /* a direction in the plane */
    int rays;             /* to be fired */
    int escaped;          /* rays, and what follows from them, out of the scene */
    int inside;           /* rays from points inside of things */
    struct rgb light;     /* H that this ray has found, with the radiosities there are */
    struct rgb lamps;     /* H that lamps bring */
    struct rgb sum, squares, half[2]; /* of the light of all rays */
};

/* Adds `weight` times the radiosity of a patch as a whole. */
void receiver_add(struct receiver *r, int32_t patch, const struct rgb *weight);

/* Adds `weight` times the radiosity that a patch has at a point of it, which has the
 * barycentric coordinates `at`: see gather_slope(). */
void receiver_add_point(struct receiver *r, int32_t patch, const double at[3],
                        const struct rgb *weight);

/* Adds the light that lamps bring, by segments; and after that what rays find. */
void receiver_aim(struct receiver *r);
void receiver_fire(struct receiver *r);

/* The point of the receiver that u and v in [0, 1) stand for. */
struct vec3 receiver_start(const struct receiver *r, double u, double v);

/* The triangle that blocks the segment from a point of the receiver to one of a lamp, or
 * -1. */
int32_t receiver_blocker(struct receiver *r, struct vec3 x, struct vec3 y, int32_t lamp);

/* The part of the light of a lamp that is seen, 1. */
struct receiver_share {
    double seen;
    double variance; /* by the choice of points, as if by chance, */
    double halves;   /* and as the first and second half of them tell it */
};

/* For lamps that are wide as seen from the receiver: by so many points of it, of the
 * sequence. */
struct receiver_share receiver_share_of_wide(struct receiver *r,
                                             const struct sequence *sequence, int count,
                                             int32_t lamp);

/* The share of a leaf that is met from just above it, and not a face that lies on it: a
 * picture in the plane of a wall, a lamp in that of the ceiling; and that is not inside
 * of things, as its rays have told. */
float receiver_bare_share(const struct receiver *r);

/* Makes the row of a leaf from exact factors, where its root is open to all that it
 * faces. False if that is not so; the row is to be made by rays then. */
bool receiver_add_exact(struct receiver *r);

/* Light of E = 1 that goes from dA at x to dA' at y, for each dA and dA', less
 * visibility; 0 below a horizon. */
double receiver_kernel(struct vec3 x, struct vec3 normal_x, struct vec3 y,
                       struct vec3 normal_y);

#endif
