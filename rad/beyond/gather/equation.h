/* The equation of rows: the radiosities of all leaves,
 *
 *     B = E + rho H,    H = source + W B,
 *
 * with a row of W for each. The rows of a rank are in the order of its leaves. Nothing
 * here is collective: a sum over rows, and the value of a row, is brought to all ranks by
 * the caller. */
#ifndef RAD_BEYOND_GATHER_EQUATION_H
#define RAD_BEYOND_GATHER_EQUATION_H

#include "rad/beyond/gather/mesh.h"
#include "rad/beyond/gather/rows.h"

/* A leaf too near for some. */
struct too_near {
    int64_t leaf;     /* number */
    struct rgb shown; /* B as seen from afar over its mean, 1 */
};

/* Leaves have numbers, those of the mesh, the same on all ranks. */
struct equation {
    struct final_gather *gather;    /* with the rows of this rank; borrowed */
    const struct gather_mesh *mesh; /* borrowed */
    int64_t count;          /* leaves */
    double *areas;          /* [count] square scene units */
    struct cover *covers;   /* [count] */
    struct too_near *near;  /* [near_count], once numbered */
    int64_t near_count;
    int64_t *fired;         /* [2 * lit_count()] rays of each space, and those escaping */
    struct rgb *radiosity;  /* by place: as rows see them */
    double *outside;        /* by place: shares of patches outside of things, 1 */
};

/* Borrows gather and mesh, which has leaves, and rays for each. */
struct equation equation_start(struct final_gather *gather,
                               const struct gather_mesh *mesh);
void equation_free(struct equation *e);

/* The material of a leaf, its space, and its bare area, square scene units. */
static inline const struct material *equation_material(const struct equation *e,
                                                       int64_t leaf)
{
    return forest_material(e->gather->model->forest, e->mesh->leaves[leaf]);
}

static inline int32_t equation_space(const struct equation *e, int64_t leaf)
{
    return node_space(e->gather->model, e->mesh->leaves[leaf]);
}

static inline double equation_bare_area(const struct equation *e, int64_t leaf)
{
    return e->areas[leaf] * (double)e->covers[leaf].bare;
}

/* The place of a leaf in e->radiosity. */
static inline int32_t equation_place(const struct equation *e, int64_t leaf)
{
    return e->gather->place[e->mesh->leaves[leaf]];
}

/* The area of a leaf whose emission arrives: of a lamp the part outside of things, for
 * segments pass through a ceiling in the lamp's plane; else the bare area. The top of a
 * lamp at the ceiling shines out of the room: nothing of its light is kept. */
double equation_shining_area(const struct equation *e, int64_t leaf);

/* Makes the row of a leaf of an equation, and counts its rays. */
void equation_make_row(void *equation, int64_t leaf);

/* Numbers leaves too near, in the order of all. Pre: the items of gather->near are summed
 * over ranks. */
void equation_number_near(struct equation *e);

/* Finds the shares of patches outside of things. Pre: e->covers are of all rows. */
void equation_find_outside(struct equation *e);

/* Makes e->radiosity the radiosities `b`, by leaf, and the means of these over inner
 * patches. */
void equation_set(struct equation *e, const struct rgb *b);

/* Makes e->radiosity what rows see of the radiosities `b`, by leaf: of leaves partly
 * inside of things the part outside, which receives all their light; of leaves too near
 * what is shown; of inner patches the mean. `lamps`: with emission. */
void equation_show(struct equation *e, const struct rgb *b, bool lamps);

/* Finds how bright far receivers see leaves too near, in three steps: all leaves are
 * shown by their means; rows add the light that they bring to leaves too near to `watts`,
 * [BANDS * near_count], in gather->near->unit_watts; sums over all rows set the
 * factors. */
void equation_show_means(struct equation *e, const struct rgb *b);
void equation_add_near(const struct equation *e, int64_t *watts);
void equation_set_shown(struct equation *e, const int64_t *watts);

/* H of each row, W/m^2, for what rows see; with the source if `lamps`. */
void equation_multiply(const struct equation *e, bool lamps, struct rgb *h);

/* b = E + rho h. */
void equation_reflect(const struct equation *e, const struct rgb *h, struct rgb *b);

/* Returns weights of leaves with the radiosities `b`, [count], to be freed: in each space
 * all of `b` has the size 1 by area, and 1 by leaf. */
double *equation_weigh(const struct equation *e, const struct rgb *b);

/* The power absorbed and the power escaping, W in square scene units. */
void equation_powers(const struct equation *e, const struct rgb *h,
                         const struct rgb *b, double *absorbed, double *escaped);

#endif
