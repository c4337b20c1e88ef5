/* Scenes that tests and benches read from files. */
#ifndef TESTS_READING_H
#define TESTS_READING_H

#include "io/picture/texture.h"
#include "io/scene/obj.h"
#include "io/scene/ply.h"
#include "io/scene/sky.h"
#include "mpi/broadcast.h"

static inline struct scene *obj_read(const char *path, struct obj_repairs *repairs,
                                     struct error *error)
{
    struct source source;
    struct scene *scene = source_open(&source, path, error)
                              ? obj_of_source(&source, repairs, error) : NULL;
    source_close(&source);
    return scene;
}

static inline struct scene *ply_read(struct source *source, struct error *error)
{
    struct ply_file file;
    struct scene *scene =
        ply_file_open(&file, source, error) ? ply_of_file(&file, error) : NULL;
    ply_file_close(&file);
    return scene;
}

/* Adds a uniform sky of this radiosity, W/m^2. */
static inline void add_uniform_sky(struct scene *scene, double radiosity)
{
    struct sky sky = {.kind = SKY_UNIFORM, .level = {{radiosity, radiosity, radiosity}}};
    struct error error = {0};
    sky_add(scene, &sky, &error);
}

/* A file, and what is asked of its scene. */
struct reading {
    const char *path;
    bool two_sided, two_sided_lamps, radiances;
    double sky; /* radiosity of a uniform sky around it, W/m^2; 0: none */
};

/* The prepared scene, or NULL after an error. */
static inline struct scene *scene_read(struct reading reading, struct error *error)
{
    struct obj_repairs read = {.mean_of = texture_mean};
    struct scene_repairs repairs;
    struct scene *scene = obj_read(reading.path, &read, error);
    if (!scene)
        return NULL;
    if (reading.radiances)
        scene_take_radiances(scene);
    if (reading.sky > 0.0)
        add_uniform_sky(scene, reading.sky);
    scene->two_sided = reading.two_sided;
    scene->two_sided_lamps = reading.two_sided_lamps;
    if (scene_prepare(scene, &repairs, error))
        return scene;
    scene_destroy(scene);
    return NULL;
}

/* Collective. The same on all ranks; rank 0 reads. `block` is to be destroyed after the
 * scene. */
static inline struct scene *scene_read_by_all(const struct comm *comm,
                                              struct reading reading,
                                              struct node_block *block,
                                              struct error *error)
{
    struct scene *scene = comm->rank == 0 ? scene_read(reading, error) : NULL;
    *block = (struct node_block){.data = NULL};
    if (comm_agree(comm, error))
        *block = scene_broadcast(comm, node_policy(), &scene, NULL);
    return scene;
}

#endif
