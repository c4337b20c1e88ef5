/* A receiver of the final gather while its light is collected: a leaf, or a point of the
 * surfaces. For the files of the final gather alone. */
#ifndef RAD_BEYOND_GATHER_RECEIVER_H
#define RAD_BEYOND_GATHER_RECEIVER_H

#include "rad/beyond/gather/rows.h"
#include "rad/beyond/sequence.h"

/* Most tries for a point of a sender above the horizon. */
enum { TRIES_MOST = 16 };

/* Sums over the rays of a receiver. */
struct ray_sums {
    struct rgb h, squares, half[2]; /* of H, of H^2, of H by halves */
    int aside[2];     /* rays ended on bright patches aimed at, by halves */
    int inside;       /* rays from points inside of things */
    int in_gap;       /* rays from points in gaps narrow for the leaf */
    bool on_back;     /* some ray has met a back: a thing may stand on the leaf */
    struct rgb *each; /* [rays] H by each ray is added to these; NULL: not wanted */
};

struct receiver {
    struct final_gather *gather;
    struct facet facet;   /* the leaf; for points, a triangle without extent */
    const struct gather_points *points; /* NULL: the receiver is a leaf */
    bool keeps;           /* its terms are kept, as a row, in the gather's sums */
    bool looks;           /* its light is compared: only what was found counts as noise */
    struct gather_row *row; /* borrowed */
    uint64_t seed;        /* made of an ID */
    struct vec3 along;    /* a direction in the plane */
    int rays;             /* to be fired */
    int segments;         /* to be fired at lamps, about */
    bool by_chance;       /* few segments may agree by chance: senders are chosen, or
                             seen in part from its region */
    int escaped;          /* rays and paths out of the scene, or ended on a back */
    int32_t near;         /* place of the leaf too near met first by the ray at hand; -1:
                             none */
    struct rgb light;     /* H by the ray at hand, with the forest's radiosities */
    struct rgb through;   /* H by panes aimed at, but for lamps behind, W/m^2 */
    double bright;        /* form factor of bright patches and panes aimed at, 1 */
    bool lamps_alone;     /* behind panes light of lamps alone is asked for */
    struct ray_sums *sums; /* borrowed */
};

/* A receiver on the leaf of the row, which has nothing else yet. Borrows row and sums. */
struct receiver receiver_of_leaf(struct final_gather *gather, int rays,
                                 struct gather_row *row, struct ray_sums *sums);

/* Adds `weight` times the mean radiosity of a patch. */
void receiver_add_patch(struct receiver *r, int32_t patch, const struct rgb *weight);

/* Adds `weight` times the radiosity of a patch with this slope at its point with the
 * barycentric coordinates `at`. */
void receiver_add_point(struct receiver *r, int32_t patch,
                        const struct gather_slope *slope, const double at[3],
                        const struct rgb *weight);

/* Adds the light of lamps, by segments, and light behind panes aimed at. */
void receiver_aim(struct receiver *r);

/* Adds the light of bright patches, by as many segments as a part of its rays. */
void receiver_aim_at_bright(struct receiver *r);

/* Adds `weight` times the light of one lamp at a point x of a patch beside the leaf, and
 * of one lamp behind a pane. */
void receiver_aim_beside(struct receiver *r, struct vec3 x, struct vec3 normal,
                         int32_t patch, const struct rgb *weight, uint64_t seed);

/* Adds the light of the bright patch at its point y, visible from x, with this form
 * factor; or nothing, if rays from x are not aimed at the patch. */
void receiver_see(struct receiver *r, struct vec3 x, struct vec3 y, int32_t patch,
                  double factor, uint64_t seed);

/* Adds the light of any sender at its point y, visible from x but for panes, with this
 * form factor; or nothing, if a pane on the way brings that light. */
void receiver_see_by_panes(struct receiver *r, const struct senders *senders,
                           struct vec3 x, struct vec3 y, int32_t patch, double factor,
                           uint64_t seed);

/* Adds `weight` times the light of a lamp with this form factor. */
void receiver_add_source(struct receiver *r, const struct rgb *weight,
                         struct rgb emission, double factor);

/* The same to the light of the leaf too near met first by the ray at hand, if any. */
void receiver_add_near(struct receiver *r, const struct rgb *weight, struct rgb emission,
                       double factor);

/* Adds the rest of the light, by rays. Pre: receiver_aim() has been called. */
void receiver_fire(struct receiver *r);

/* The point of the receiver for u and v in [0, 1). */
static inline struct vec3 receiver_start(const struct receiver *r, double u, double v)
{
    const struct gather_points *points = r->points;
    return points ? points->at[(int)(u * points->count)]
                  : triangle_of_square(&r->facet.triangle, u, v);
}

/* The triangle blocking the segment from a point of the receiver to one of a root, or
 * -1. */
int32_t receiver_blocker(struct receiver *r, struct vec3 x, struct vec3 y, int32_t root);

/* Fills in the kept share of the leaf's light. Rays seeming to begin inside of a thing do
 * so only if others begin outside, or all see backs: where walls show their backs and end
 * a floor and a ceiling, the whole room is as the inside of a column, and its rays are
 * lost on the backs. */
void receiver_find_outside(struct receiver *r);

/* Fills in the shares of the leaf's area: the bare one, not covered by another face in
 * its plane (a picture on a wall, a lamp in the ceiling), and, as its rays have shown,
 * those outside of things on the leaf and of narrow gaps. A leaf with nothing in view, as
 * the underside of such a thing, has no bare share. */
void receiver_find_covers(struct receiver *r);

/* Makes the row of a leaf from exact factors. False if its root is not open, or the row
 * cannot be exact; then rays are to make the row. */
bool receiver_add_exact(struct receiver *r);

#endif
