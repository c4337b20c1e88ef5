/* H of leaves, and meters dealt to ranks. Items go to the ranks in turn, like the
 * scanlines of a picture. */
#include "tools/irradiance.h"

#include "geom/alloc.h"
#include "geom/hash.h"
#include "io/picture/mesh.h"
#include "mpi/picture.h"
#include "rad/pushpull.h"

/* A leaf has as many rays as the final gather has in the mean, or RAYS without one. */
enum { RAYS = 256, LEAF_POINTS = 4, LEAF_FLOATS = 2 * BANDS + 1 };

float *irradiance_deal(struct run *run, int64_t count, int floats,
                       void (*read)(const struct meter *meter, const void *context,
                                    int64_t item, float *floats),
                       const void *context)
{
    struct comm *comm = &run->comm;
    struct meter meter = meter_make(run->solver->model.forest, run->octree,
                                    beyond_answer(run->solver)->error);
    int64_t own = (count - comm->rank + comm->size - 1) / comm->size;
    float *read_here = alloc_array((size_t)own * (size_t)floats, sizeof *read_here);
    progress_begin(&run->progress.progress, "metering", -1, 0);
    for (int64_t i = 0; i < own; i++) {
        progress_tick(&run->progress.progress, (double)i / (double)own);
        read(&meter, context, comm->rank + i * comm->size, read_here + i * floats);
    }
    meter_free(&meter);
    return picture_gather(comm, read_here, (size_t)floats, (int)count);
}

/* The leaves without H. */
struct unknown {
    const struct forest *forest;
    int32_t *leaves; /* [count], in the order of forest_next_leaf() */
    int64_t count;
    int rays;        /* at each */
};

static void read_leaf(const struct meter *meter, const void *context, int64_t item,
                      float *floats)
{
    const struct unknown *unknown = context;
    const struct forest *forest = unknown->forest;
    int32_t leaf = unknown->leaves[item];
    struct triangle t = forest_triangle(forest, leaf);
    struct patch_id id = forest->patches[leaf].id;
    struct vec3 normal = scene_root_plane(forest->scene, (int32_t)id.root).normal;
    for (int k = 0; k < LEAF_POINTS; k++) {
        struct triangle child = triangle_child(&t, k);
        struct metered reading =
            meter_read(meter, triangle_centroid(&child), normal,
                       unknown->rays / LEAF_POINTS,
                       hash_mix(id_number(id)) + (uint64_t)k);
        for (int c = 0; c < BANDS; c++) {
            floats[c] += (float)(reading.irradiance.band[c] / LEAF_POINTS);
            floats[BANDS + c] += (float)(reading.lamps.band[c] / LEAF_POINTS);
        }
        floats[2 * BANDS] += (float)(reading.error / LEAF_POINTS);
    }
}

/* Takes H from B. False if a band is not reflected. */
static bool take_reflected(const struct run *run, int32_t leaf, struct irradiance *found)
{
    const struct answer *answer = beyond_answer(run->solver);
    const struct material *m = forest_material(run->solver->model.forest, leaf);
    struct rgb b = run->solver->model.forest->radiosity[leaf];
    double most = 0.0;
    for (int c = 0; c < BANDS; c++) {
        double rho = m->reflectance.band[c];
        if (!(rho > 0.0))
            return false;
        most = real_max(most, rho);
        double reflected = real_max(0.0, b.band[c] - m->emission.band[c]);
        found->forest.radiosity[leaf].band[c] = reflected / rho;
        found->straight[leaf].band[c] =
            answer->straight ? answer->straight[leaf].band[c] / rho : 0.0;
    }
    if (found->error)
        found->error[leaf] = (float)((double)answer->error[leaf] / most);
    return true;
}

/* The scene and the forest of H, which is 0. */
static void make_white(const struct forest *forest, struct irradiance *found)
{
    size_t patches = (size_t)forest->count;
    size_t materials = (size_t)forest->scene->material_count;
    found->scene = *forest->scene;
    found->scene.materials = alloc_array(materials, sizeof *found->scene.materials);
    for (size_t i = 0; i < materials; i++)
        found->scene.materials[i].reflectance = forest->scene->materials[i].reflectance;
    found->forest = *forest;
    found->forest.scene = &found->scene;
    found->forest.radiosity = alloc_array(patches, sizeof *found->forest.radiosity);
    found->straight = alloc_array(patches, sizeof *found->straight);
    found->error = NULL;
}

void irradiance_make(struct run *run, struct irradiance *found)
{
    const struct forest *forest = run->solver->model.forest;
    size_t patches = (size_t)forest->count;
    int rays = run->solver->model.criterion.final_gather;
    struct unknown unknown = {forest, alloc_array(patches, sizeof *unknown.leaves), 0,
                              rays > 0 ? rays : RAYS};
    make_white(forest, found);
    if (beyond_answer(run->solver)->error)
        found->error = alloc_array(patches, sizeof *found->error);
    int32_t leaf = forest_next_leaf(forest, -1);
    for (; leaf >= 0; leaf = forest_next_leaf(forest, leaf))
        if (!scene_is_sky(forest->scene, (int32_t)forest->patches[leaf].id.root) &&
            !take_reflected(run, leaf, found) &&
            !material_emits(forest_material(forest, leaf)))
            unknown.leaves[unknown.count++] = leaf;
    float *read = irradiance_deal(run, unknown.count, LEAF_FLOATS, read_leaf, &unknown);
    size_t bytes = (size_t)unknown.count * LEAF_FLOATS * sizeof *read;
    if (!read)
        read = alloc_array((size_t)unknown.count * LEAF_FLOATS, sizeof *read);
    comm_broadcast(&run->comm, read, bytes);
    for (int64_t i = 0; i < unknown.count; i++) {
        const float *from = read + i * LEAF_FLOATS;
        leaf = unknown.leaves[i];
        for (int c = 0; c < BANDS; c++) {
            found->forest.radiosity[leaf].band[c] = (double)from[c];
            found->straight[leaf].band[c] = (double)from[BANDS + c];
        }
        if (found->error)
            found->error[leaf] = from[2 * BANDS];
    }
    forest_average(&found->forest);
    alloc_free(read);
    alloc_free(unknown.leaves);
}

struct rgb *irradiance_at_vertices(const struct irradiance *found,
                                   const struct shading *shading)
{
    const struct forest *forest = shading->forest;
    size_t vertices = (size_t)shading->vertex_count;
    struct rgb *at = alloc_array(vertices, sizeof *at);
    double *leaves = alloc_array(vertices, sizeof *leaves);
    int32_t leaf = mesh_next_leaf(forest, -1);
    for (; leaf >= 0; leaf = mesh_next_leaf(forest, leaf)) {
        const struct material *m = forest_material(forest, leaf);
        for (int k = 0; k < 3; k++) {
            int32_t v = shading->corners[3 * (int64_t)leaf + k];
            leaves[v] += 1.0;
            for (int c = 0; c < BANDS; c++) {
                double rho = m->reflectance.band[c], mean = at[v].band[c];
                double b = shading->values[v].band[c] - m->emission.band[c];
                double h = found->forest.radiosity[leaf].band[c];
                at[v].band[c] = rho > 0.0 ? real_max(0.0, b) / rho
                                          : mean + (h - mean) / leaves[v];
            }
        }
    }
    alloc_free(leaves);
    return at;
}

void irradiance_free(struct irradiance *irradiance)
{
    alloc_free(irradiance->scene.materials);
    alloc_free(irradiance->forest.radiosity);
    alloc_free(irradiance->straight);
    alloc_free(irradiance->error);
}
