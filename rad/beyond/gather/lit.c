/* Means of light over spaces, and what is a lamp there.
 *
 * All emitters are lamps if they are LAMP times as bright as the mean of all surfaces. If
 * not, a lamp emits more than LAMP times this mean: where all surfaces are as bright, as
 * in a furnace, there is no lamp. Where little is reflected, BRIGHT times the mean
 * reflected light is enough; a bright patch reflects more than this. */
#include "rad/beyond/gather/lit.h"

#include <math.h>

#include "geom/alloc.h"

static const double LAMP = 1.1, BRIGHT = 4.0;

static void find_means(struct lit *lit, const struct model *model)
{
    const struct rgb *radiosity = model->forest->radiosity;
    int32_t count = lit_count(model);
    for (int32_t root = 0; root < scene_root_count(model->scene); root++) {
        struct lit *own = &lit[node_space(model, root)];
        double area = scene_root_own_area(model->scene, root);
        own->mean += area * rgb_sum(radiosity[root]);
        rgb_add(&own->scale, area, radiosity[root]);
    }
    for (int32_t s = 0; s < count; s++) {
        lit[s].area = model->spaces ? model->spaces->area[s] : model->area;
        if (lit[s].area > 0.0)
            lit[s].mean /= lit[s].area;
        for (int c = 0; c < BANDS; c++) {
            double own = lit[s].scale.band[c] / lit[s].area;
            bool any = lit[s].mean > 0.0;
            lit[s].scale.band[c] =
                any ? lit[s].mean / fmax(own, GATHER_DIM * lit[s].mean) : 0.0;
        }
    }
}

void lit_renew(struct lit *lit, const struct model *model)
{
    const struct forest *forest = model->forest;
    for (int32_t s = 0; s < lit_count(model); s++)
        lit[s].reflected = 0.0;
    for (int32_t root = 0; root < forest->root_count; root++)
        lit[node_space(model, root)].reflected +=
            scene_root_area(forest->scene, root) *
            (rgb_sum(forest->radiosity[root]) -
             rgb_sum(forest_material(forest, root)->emission));
    for (int32_t s = 0; s < lit_count(model); s++) {
        lit[s].reflected /= lit[s].area > 0.0 ? lit[s].area : 1.0;
        lit[s].bright_least = BRIGHT * lit[s].reflected;
    }
}

/* The emitting surfaces of a space. */
struct emitters {
    double area;  /* square scene units */
    double power; /* area times radiosity, over bands */
};

static void find_emitters(struct emitters *all, const struct model *model)
{
    for (int32_t root = 0; root < scene_root_count(model->scene); root++) {
        struct emitters *own = &all[node_space(model, root)];
        double area = scene_root_area(model->scene, root);
        if (!material_emits(scene_root_material(model->scene, root)))
            continue;
        own->area += area;
        own->power += area * rgb_sum(model->forest->radiosity[root]);
    }
}

static double least_of_lamps(const struct emitters *all, const struct lit *lit)
{
    double most = LAMP * lit->mean;
    return fmin(all->power > most * all->area ? 0.0 : most, lit->bright_least);
}

struct lit *lit_find(const struct model *model)
{
    struct lit *lit = alloc_array((size_t)lit_count(model), sizeof *lit);
    find_means(lit, model);
    lit_renew(lit, model);
    struct emitters *all = alloc_array((size_t)lit_count(model), sizeof *all);
    find_emitters(all, model);
    for (int32_t s = 0; s < lit_count(model); s++)
        lit[s].lamp_least = least_of_lamps(&all[s], &lit[s]);
    alloc_free(all);
    return lit;
}
