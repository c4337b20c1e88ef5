/* The equation of rows: the radiosities of all leaves,
 *
 *     B = E + rho H,    H = source + W B,
 *
 * with a row of W for each. A rank has the rows that it has made, and of all vectors the
 * values of their leaves, in the order of the rows; so `leaf` below is a row. What rows
 * see, of all leaves, is brought to all ranks by the caller. Sums over leaves are in
 * fixed point, the same however rows are dealt. */
#ifndef RAD_BEYOND_GATHER_EQUATION_H
#define RAD_BEYOND_GATHER_EQUATION_H

#include "rad/beyond/gather/mesh.h"
#include "rad/beyond/gather/rows.h"
#include "rad/beyond/total.h"

struct equation {
    struct final_gather *gather;    /* with the rows of this rank; borrowed */
    const struct gather_mesh *mesh; /* borrowed */
    struct totals totals;   /* over leaves, a band at a time */
    int64_t count;          /* leaves of this rank */
    int64_t *number;        /* [count] in the mesh */
    int32_t *space;         /* [count] */
    double *areas;          /* [count] square scene units */
    struct rgb *shown;      /* [count] B as seen from afar over its mean, 1: of leaves too
                               near for some */
    int64_t *fired;         /* [2 * lit_count()] rays of each space, and those escaping */
    struct rgb *radiosity;  /* by place: as rows see them; NULL: rows are being made */
    double *outside;        /* by place: shares of patches outside of things, 1; NULL:
                               rows are being made */
};

/* Borrows gather and mesh, which has leaves, and rays for each. `totals`: how ranks
 * agree. */
struct equation equation_start(struct final_gather *gather,
                               const struct gather_mesh *mesh, struct totals totals);
void equation_free(struct equation *e);

/* The local number of a leaf, its root, and what covers it. */
static inline int32_t equation_leaf(const struct equation *e, int64_t leaf)
{
    return e->gather->rows[leaf].leaf;
}

static inline int32_t equation_root(const struct equation *e, int64_t leaf)
{
    const struct patch *patches = e->gather->model->forest->patches;
    return (int32_t)patches[equation_leaf(e, leaf)].id.root;
}

static inline struct cover *equation_cover(const struct equation *e, int64_t leaf)
{
    return &e->gather->rows[leaf].cover;
}

/* The material of a leaf, and its bare area, square scene units. */
static inline const struct material *equation_material(const struct equation *e,
                                                       int64_t leaf)
{
    return forest_material(e->gather->model->forest, equation_leaf(e, leaf));
}

static inline double equation_bare_area(const struct equation *e, int64_t leaf)
{
    return e->areas[leaf] * (double)equation_cover(e, leaf)->bare;
}

/* The place of a leaf in e->radiosity. */
static inline int32_t equation_place(const struct equation *e, int64_t leaf)
{
    return e->gather->place[equation_leaf(e, leaf)];
}

/* The area of a leaf whose emission arrives: of a lamp the part outside of things, for
 * segments pass through a ceiling in the lamp's plane; else the bare area. The top of a
 * lamp at the ceiling shines out of the room: nothing of its light is kept. */
double equation_shining_area(const struct equation *e, int64_t leaf);

/* Makes the row of a leaf of the mesh, and counts its rays. */
void equation_make_row(void *equation, int64_t number);

/* Finds the shares of patches outside of things, by those of all leaves, `shares[k]` of
 * the leaf at place[k], in the first band; makes room for e->radiosity. */
void equation_find_outside(struct equation *e, const int32_t *place,
                           const struct rgb *shares);

/* Makes e->radiosity the values of all leaves, values[k] at place[k], and the means of
 * these over inner patches. */
void equation_set(struct equation *e, const int32_t *place, const struct rgb *values);

/* Finds what rows see of leaves with the radiosities `b`. Of a leaf partly inside of
 * things they see the part outside, which reflects all the light of the leaf. Leaves too
 * near are shown. `lamps`: `b` has emission. To be followed by equation_set(). */
void equation_show(const struct equation *e, const struct rgb *b, bool lamps,
                   struct rgb *seen);

/* Finds how bright far receivers see leaves too near, in three steps: all leaves are
 * shown by their means; rows add the light that they bring to leaves too near to `watts`,
 * [BANDS * forest->count] by place, in gather->near->unit_watts; sums over all rows, and
 * of the items of gather->near, set the factors of own leaves. */
void equation_show_means(struct equation *e, const struct rgb *b, struct rgb *seen);
void equation_add_near(const struct equation *e, int64_t *watts);
void equation_set_shown(struct equation *e, const int64_t *watts);

/* H of leaves, W/m^2, for what rows see; with the source if `lamps`. */
void equation_multiply(const struct equation *e, bool lamps, struct rgb *h);

/* b = E + rho h. */
void equation_reflect(const struct equation *e, const struct rgb *h, struct rgb *b);

/* Collective. Returns weights of leaves with the radiosities `b`, [count], to be freed:
 * in each space all of `b` has the size 1 by area, and 1 by leaf. */
double *equation_weigh(const struct equation *e, const struct rgb *b);

/* Collective. The power absorbed and the power escaping, W in square scene units. */
void equation_powers(const struct equation *e, const struct rgb *h,
                     const struct rgb *b, double *absorbed, double *escaped);

#endif
