/* Step 1: rank 0 reads, all receive.
 *
 * The prepared scene is sent, planes and areas included, so that no rank repeats the work and
 * none could end with other bits. Ranks of a run share one machine architecture: plain bytes. */
#include "mpi/broadcast.h"

#include "geom/alloc.h"

struct scene *scene_broadcast(const struct comm *comm, struct scene *scene)
{
    struct scene head = {0};
    if (comm->rank == 0)
        head = *scene;
    comm_broadcast(comm, &head, sizeof head);
    if (comm->rank != 0) {
        scene = scene_create(head.input_count, head.material_count);
        scene->two_sided = head.two_sided;
        scene->centre = head.centre;
        scene->exponent = head.exponent;
        scene->low = head.low;
        scene->high = head.high;
        scene_set_groups(scene, head.group_count, head.group_bytes);
        if (head.normals)
            scene_add_normals(scene);
    }
    size_t count = (size_t)head.input_count;
    comm_broadcast(comm, scene->triangles, count * sizeof *scene->triangles);
    comm_broadcast(comm, scene->planes, count * sizeof *scene->planes);
    comm_broadcast(comm, scene->areas, count * sizeof *scene->areas);
    comm_broadcast(comm, scene->material_of, count * sizeof *scene->material_of);
    comm_broadcast(comm, scene->materials,
                   (size_t)head.material_count * sizeof *scene->materials);
    comm_broadcast(comm, scene->group_of, count * sizeof *scene->group_of);
    comm_broadcast(comm, scene->group_names, (size_t)head.group_bytes);
    if (head.normals)
        comm_broadcast(comm, scene->normals, 3 * count * sizeof *scene->normals);
    return scene;
}
