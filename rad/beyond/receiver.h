/* A receiver of the final gather while its light is collected: a leaf, or a point of the
 * surfaces. For the files of the final gather alone. */
#ifndef RAD_BEYOND_RECEIVER_H
#define RAD_BEYOND_RECEIVER_H

#include "rad/beyond/rows.h"
#include "rad/beyond/sequence.h"

/* Sums over the rays of a receiver. */
struct ray_sums {
    struct rgb h, squares, half[2]; /* of H, of H^2, of H by halves */
    int aside[2];     /* rays that have met what is aimed at, by halves */
    int inside;       /* rays from points inside of things */
    int on_lamps;     /* rays that have met lamps first */
    bool on_back;     /* some ray has met a back: a thing may stand on the leaf */
    struct rgb taken; /* H by the emission that these have not counted, below 0 */
    struct rgb *each; /* [rays] H by each ray is added to these; NULL: not wanted */
};

/* Shares of the view that are aimed at. */
struct aimed_shares {
    double bright; /* form factor of bright patches and regions, 1 */
    double lit;    /* form factor of the lamps, as segments have found it, 1 */
    double direct; /* light of all that is aimed at, over all bands, if nothing hid any,
                      W/m^2 */
    double doubt;  /* part of `lit` that may be wrong: something hides a lamp, or it is
                      near */
};

/* What a leaf in the dark looks for. */
struct in_the_dark {
    double least;           /* that regions reflect which are aimed at through openings,
                               W/m^2; below 0: none is */
    struct sparks *catches; /* that keep the light which is aimed at; NULL: none do */
    struct sparks *sparks;  /* of which the leaf sees some; NULL: of none */
};

struct receiver {
    struct final_gather *gather;
    struct facet facet;   /* the leaf; for points, a triangle without extent */
    const struct gather_points *points; /* NULL: the receiver is a leaf */
    bool keeps;           /* its terms are kept, as a row, in the gather's sums */
    struct gather_row row;
    uint64_t seed;        /* made of an ID */
    struct vec3 along;    /* a direction in the plane */
    int rays;             /* to be fired */
    int segments;         /* to be fired at lamps, about */
    int escaped;          /* rays and paths that have left the scene,
                             or ended on a back */
    int32_t near;         /* place of the leaf too near that the ray at hand met first;
                             -1: none */
    struct rgb light;     /* H by the ray at hand, with the forest's radiosities */
    struct rgb lamps;     /* H by lamps */
    struct aimed_shares shares;
    struct in_the_dark dark;
    struct ray_sums sums;
};

/* A number made of the ID of a patch. */
uint64_t patch_seed(const struct forest *forest, int32_t patch);

/* A receiver that is a leaf. */
struct receiver receiver_of_leaf(struct final_gather *gather, int32_t leaf, int rays);

/* Adds `weight` times the mean radiosity of a patch. */
void receiver_add_patch(struct receiver *r, int32_t patch, const struct rgb *weight);

/* Adds `weight` times the radiosity that a patch has at a point of it, which has the
 * barycentric coordinates `at`: see gather_slope(). */
void receiver_add_point(struct receiver *r, int32_t patch, const double at[3],
                        const struct rgb *weight);

/* True if a thing stands on the leaf or cuts it: light may differ on both sides. */
bool leaf_is_cut(struct final_gather *gather, int32_t leaf);

/* Adds the light of lamps, by segments. */
void receiver_aim(struct receiver *r);

/* Adds the light of lamps by the receiver's segments, or of bright patches by a part of
 * as many rays as it has. */
void receiver_aim_at(struct receiver *r, struct lamps *lamps);

/* Adds `share` times the light of a node's lamps to a leaf in the dark, by `count` points
 * of the lamps at most. */
void receiver_aim_from(struct receiver *r, const struct lamps *lamps, int32_t node,
                       int count, double share);

/* Adds `weight` times the light of one lamp at a point x of a patch beside the leaf. */
void receiver_aim_beside(struct receiver *r, struct vec3 x, struct vec3 normal,
                         int32_t patch, const struct rgb *weight, uint64_t seed);

/* True if a lamp is so near, for its size, that rays from a point find it often enough:
 * on the way of a path they count its emission, and segments do not. */
bool receiver_lamp_is_near(const struct scene *scene, int32_t lamp, struct vec3 x);

/* Adds the light of a bright patch that has this form factor, where a ray from x that is
 * aimed at y meets it. */
void receiver_look_at(struct receiver *r, struct vec3 x, struct vec3 y, int32_t patch,
                      double factor, uint64_t seed);

/* --- in the dark: gather_narrow.c, gather_sparks.c --- */

/* Finds the bright regions that the receiver, a leaf in the dark, sees through narrow
 * openings. */
void receiver_find_openings(struct receiver *r);

/* Finds the sparks of all large regions in the dark, once. It asks for the openings of
 * these, so those of a leaf are to be found afterwards. */
void gather_find_sparks(struct final_gather *gather);

/* Finds the sparks that a leaf in the dark sees. */
void receiver_find_sparks(struct receiver *r);

/* Keeps the sums since the last call, and `source`, as light that lands at the point x;
 * does nothing where it is not to be caught. */
void receiver_catch(struct receiver *r, struct vec3 x, struct rgb source);

/* Adds the light of a point y of a root that is seen; the root has this form factor. The
 * light at the point is found by a path: beside an opening a leaf is darker than in the
 * mean. It goes on until a ray ends far away for the size of the leaf there. */
void receiver_see(struct receiver *r, int32_t root, struct vec3 y, double factor,
                  uint64_t seed);

/* Adds `weight` times the light of a lamp that has this form factor. */
void receiver_add_source(struct receiver *r, const struct rgb *weight,
                         struct rgb emission, double factor);

/* The same to the light of the leaf too near that the ray at hand met first, if any. */
void receiver_add_near(struct receiver *r, const struct rgb *weight, struct rgb emission,
                       double factor);

/* Adds the rest of the light, by rays. Pre: receiver_aim() has been called. */
void receiver_fire(struct receiver *r);

/* The point of the receiver that u and v in [0, 1) stand for. */
static inline struct vec3 receiver_start(const struct receiver *r, double u, double v)
{
    const struct gather_points *points = r->points;
    return points ? points->at[(int)(u * points->count)]
                  : triangle_of_square(&r->facet.triangle, u, v);
}

/* The triangle that blocks the segment from a point of the receiver to one of a lamp, or
 * -1. */
int32_t receiver_blocker(struct receiver *r, struct vec3 x, struct vec3 y, int32_t lamp);

/* The same, the first one on the way: any octree names it, and so learns the same. */
int32_t receiver_first_blocker(struct receiver *r, struct vec3 x, struct vec3 y,
                               int32_t lamp);

/* The part of the light of a lamp that is seen, 1. */
struct receiver_share {
    double seen;
    double variance; /* of `seen`, if points were chosen by chance */
    double halves;   /* squared difference of the halves of the points, over 4 */
};

/* The share of a lamp that is wide as seen from the receiver, by `count` points of the
 * receiver, of the sequence. */
struct receiver_share receiver_share_of_wide(struct receiver *r,
                                             const struct sequence *sequence, int count,
                                             int32_t lamp);

/* Fills in the share of the leaf's light that is kept. Rays that seemed to begin inside
 * of a thing do so only if others begin outside of it, or all see backs: where walls show
 * their backs, and a floor and a ceiling end at them, the whole room is as the inside of
 * a column. Its rays are lost on the backs. */
void receiver_find_outside(struct receiver *r);

/* Fills in the shares of the leaf's area that are bare, not covered by another face in
 * its plane (a picture on a wall, a lamp in the ceiling), and, as its rays have shown,
 * outside of things that stand on it. Of a leaf that sees nothing, as the underside of
 * such a thing, nothing is bare. */
void receiver_find_covers(struct receiver *r);

/* Makes the row of a leaf from exact factors. False if its root is not open, or the row
 * cannot be exact; then it is to be made by rays. */
bool receiver_add_exact(struct receiver *r);

/* cos cos' / (pi r^2) of the points x and y, without visibility; 0 below a horizon. */
static inline double receiver_kernel(struct vec3 x, struct vec3 normal_x, struct vec3 y,
                                     struct vec3 normal_y)
{
    struct vec3 d = vec3_sub(y, x);
    double d2 = vec3_dot(d, d);
    double rise = vec3_dot(normal_x, d), fall = -vec3_dot(normal_y, d);
    return rise > 0.0 && fall > 0.0 ? rise * fall / (PI * d2 * d2) : 0.0;
}

#endif
