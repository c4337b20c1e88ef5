/* Means of light over spaces, and what is a lamp there.
 *
 * A lamp emits more than GLOW times the mean radiosity, if surfaces doing so are LAMP
 * times as bright as the mean; if not, more than LAMP times the mean: where all surfaces
 * are as bright, as in a furnace, there is no lamp. Where little is reflected,
 * BRIGHT times the mean reflected light is enough; a bright patch reflects more than
 * this. Where no more than FEW of the surface emits, all emitters are lamps. */
#include "rad/beyond/gather/lit.h"

#include <math.h>

#include "geom/alloc.h"

static const double GLOW = 0.25, LAMP = 1.1, BRIGHT = 4.0, FEW = 0.05;

static int32_t space_of(const struct model *model, int32_t root)
{
    return model->spaces ? model->spaces->of[root] : 0;
}

static void find_means(struct lit *lit, const struct model *model)
{
    const struct rgb *radiosity = model->forest->radiosity;
    int32_t count = lit_count(model);
    for (int32_t root = 0; root < scene_root_count(model->scene); root++) {
        struct lit *own = &lit[space_of(model, root)];
        double area = scene_root_own_area(model->scene, root);
        own->mean += area * rgb_sum(radiosity[root]);
        for (int c = 0; c < BANDS; c++)
            own->scale.band[c] += area * radiosity[root].band[c];
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
        lit[space_of(model, root)].reflected +=
            scene_root_area(forest->scene, root) *
            (rgb_sum(forest->radiosity[root]) -
             rgb_sum(forest_material(forest, root)->emission));
    for (int32_t s = 0; s < lit_count(model); s++) {
        lit[s].reflected /= lit[s].area > 0.0 ? lit[s].area : 1.0;
        lit[s].bright_least = BRIGHT * lit[s].reflected;
    }
}

/* The surfaces of a space emitting more than GLOW times its mean radiosity, and more than
 * 0. */
struct emitters {
    double area, glowing; /* square scene units */
    double mean;          /* radiosity of the glowing, over bands, W/m^2 */
};

static void find_emitters(struct emitters *all, const struct model *model,
                          const struct lit *lit)
{
    for (int32_t root = 0; root < scene_root_count(model->scene); root++) {
        int32_t s = space_of(model, root);
        double area = scene_root_area(model->scene, root);
        double emitted = rgb_sum(scene_root_material(model->scene, root)->emission);
        if (emitted > 0.0)
            all[s].area += area;
        if (!(emitted > GLOW * lit[s].mean))
            continue;
        all[s].glowing += area;
        all[s].mean += area * rgb_sum(model->forest->radiosity[root]);
    }
    for (int32_t s = 0; s < lit_count(model); s++)
        all[s].mean /= all[s].glowing > 0.0 ? all[s].glowing : 1.0;
}

static double least_of_lamps(const struct emitters *all, const struct lit *lit)
{
    if (all->area <= FEW * lit->area)
        return 0.0;
    bool glow = all->mean > LAMP * lit->mean;
    return fmin((glow ? GLOW : LAMP) * lit->mean, lit->bright_least);
}

struct lit *lit_find(const struct model *model)
{
    struct lit *lit = alloc_array((size_t)lit_count(model), sizeof *lit);
    find_means(lit, model);
    lit_renew(lit, model);
    struct emitters *all = alloc_array((size_t)lit_count(model), sizeof *all);
    find_emitters(all, model, lit);
    for (int32_t s = 0; s < lit_count(model); s++)
        lit[s].lamp_least = least_of_lamps(&all[s], &lit[s]);
    alloc_free(all);
    return lit;
}
