/* A gather over all leaves of a scene that is solved over its links alone. */
#ifndef TESTS_GATHERED_H
#define TESTS_GATHERED_H

#include "geom/lambert.h"
#include "rad/beyond/gather/look.h"
#include "rad/beyond/gather/row.h"
#include "rad/beyond/gather/rows.h"
#include "tests/defaults.h"

struct trial {
    struct solution s;
    struct final_gather *gather;
    struct rgb *radiosity; /* by place */
};

static inline struct trial gather_scene(struct soup *soup, const char *words, int rays)
{
    char all[200];
    snprintf(all, sizeof all, "%s --final-gather 0", words);
    struct trial g = {.s = solve_soup(soup, all)};
    struct forest *forest = g.s.solver->model.forest;
    g.gather = final_gather_create(&g.s.solver->model, rays, NULL,
                                   lit_find(&g.s.solver->model));
    g.radiosity = alloc_array((size_t)forest->count, sizeof *g.radiosity);
    for (int64_t i = 0; i < forest->count; i++)
        g.radiosity[i] = forest->radiosity[g.gather->order[i]];
    int32_t leaf = forest_next_leaf(forest, -1);
    for (; leaf >= 0; leaf = forest_next_leaf(forest, leaf))
        final_gather_add_row(g.gather, leaf, rays, rays, true);
    return g;
}

static inline void trial_free(struct trial *g)
{
    final_gather_destroy(g->gather);
    alloc_free(g->radiosity);
    solution_free(&g->s);
}

static inline double irradiance(const struct trial *g, int64_t row)
{
    return final_gather_irradiance(g->gather, row, g->radiosity, true).band[0];
}

/* The mean of H over the leaves of these roots, W/m^2. */
static inline double mean_of_roots(const struct trial *g, uint32_t first, uint32_t count)
{
    const struct forest *forest = g->s.solver->model.forest;
    double sum = 0.0, area = 0.0;
    for (int64_t i = 0; i < g->gather->count; i++) {
        int32_t leaf = g->gather->rows[i].leaf;
        if (forest->patches[leaf].id.root - first >= count)
            continue;
        sum += forest_area(forest, leaf) * irradiance(g, i);
        area += forest_area(forest, leaf);
    }
    return sum / area;
}

/* H of a triangle that looks up, by the middles of its quarters, of lamps of E = 1. */
static inline double lit_by(const struct scene *scene, int32_t first, int32_t end,
                            const struct triangle *t)
{
    double h = 0.0;
    for (int q = 0; q < 4; q++) {
        struct triangle quarter = triangle_child(t, q);
        struct vec3 x = triangle_centroid(&quarter);
        for (int32_t k = first; k < end; k++)
            h += 0.25 * point_triangle_factor(x, point(0, 0, 1), &scene->triangles[k]);
    }
    return h;
}

#endif
