/* A receiver while its light is collected. For the files of the final gather alone. */
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

/* What light is collected for. A row keeps its terms, in the gather's sums. A look keeps
 * its light alone, and what its segments may have missed is not in its noise. So does a
 * pixel, but with this noise. */
enum receiver_kind { RECEIVER_ROW, RECEIVER_LOOK, RECEIVER_PIXEL };

struct receiver {
    enum receiver_kind kind;
    struct final_gather *gather;
    struct facet facet;   /* the leaf; for points, a triangle without extent */
    const struct gather_points *points; /* of a pixel, else NULL */
    struct gather_row *row; /* borrowed */
    uint64_t seed;        /* made of an ID */
    struct vec3 along;    /* a direction in the plane */
    int rays;             /* to be fired */
    int segments;         /* to be fired at lamps, about */
    int escaped;          /* rays and paths out of the scene, or ended on a back */
    int32_t near;         /* place of the leaf too near met first by the ray at hand; -1:
                             none */
    struct rgb light;     /* H by the ray at hand, with the forest's radiosities */
    struct rgb through;   /* H by panes aimed at, but for lamps behind, W/m^2 */
    double bright;        /* form factor of bright patches and panes aimed at, 1 */
    bool lamps_alone;     /* behind panes light of lamps alone is asked for */
    struct ray_sums *sums; /* borrowed */
};

/* A receiver on the leaf of the row, which has nothing else yet; or on points, whose
 * light is collected by `rays` segments and rays. Both borrow row and sums. */
struct receiver receiver_of_leaf(struct final_gather *gather, enum receiver_kind kind,
                                 int rays, struct gather_row *row, struct ray_sums *sums);
struct receiver receiver_of_points(struct final_gather *gather,
                                   const struct gather_points *points, uint64_t seed,
                                   int rays, struct gather_row *row,
                                   struct ray_sums *sums);

/* Adds `weight` times the radiosity of a patch with this slope at its point with the
 * barycentric coordinates `at`. */
void receiver_add_point(struct receiver *r, int32_t patch,
                        const struct gather_slope *slope, const double at[3],
                        const struct rgb *weight);

/* Adds `weight` times the light of a lamp with this form factor. */
void receiver_add_source(struct receiver *r, const struct rgb *weight,
                         struct rgb emission, double factor);

/* Adds a lamp's light to the path of the ray at hand, if that has met a leaf too near. */
void receiver_add_near(struct receiver *r, const struct rgb *weight, struct rgb emission,
                       double factor);

/* True if something is in the way from a point of the receiver to one of a root. */
bool receiver_is_blocked(struct receiver *r, struct vec3 x, struct vec3 y, int32_t root);

/* The same from a point of any input triangle. */
bool segment_is_stopped(struct receiver *r, struct vec3 from, int32_t input,
                        struct vec3 to, int32_t root);

/* The point of the receiver for u and v in [0, 1). */
static inline struct vec3 receiver_start(const struct receiver *r, double u, double v)
{
    const struct gather_points *points = r->points;
    return points ? points->at[(int)(u * points->count)]
                  : triangle_of_square(&r->facet.triangle, u, v);
}

#endif
