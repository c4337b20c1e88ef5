/* Pictures and meshes of the solution. */
#include "tools/results.h"

#include "geom/alloc.h"
#include "io/picture/image.h"
#include "io/picture/mesh.h"
#include "io/picture/render.h"
#include "io/picture/viewpoint.h"
#include "io/run/output.h"
#include "mpi/picture.h"

/* Returns the tone of 8-bit colours: --exposure, or chosen from the picture or the
 * leaves. */
static struct tone choose_tone(const struct run *run, const float *picture)
{
    int64_t pixels = (int64_t)run->camera.width * run->camera.height;
    if (run->options.exposure > 0.0)
        return tone_make(run->options.exposure);
    if (picture)
        return tone_make(tone_automatic(picture, pixels));
    int64_t count;
    float *colours = mesh_colours(run->solver->model.forest, &count);
    struct tone tone = tone_make(tone_automatic(colours, count));
    alloc_free(colours);
    return tone;
}

/* Writes the outputs. On rank 0 alone. */
static void write_outputs(struct run *run, const struct shading *shading, float *picture)
{
    struct tone tone = choose_tone(run, picture);
    struct image image = {run->camera.width, run->camera.height, picture};
    for (int i = 0; i < run->options.output_count; i++) {
        const char *path = run->options.outputs[i];
        switch (output_format_of(path)) {
        case FORMAT_PPM: ppm_write(&image, &tone, path, &run->error); break;
        case FORMAT_PFM: pfm_write(&image, path, &run->error); break;
        case FORMAT_PLY:
            mesh_write(shading, &tone, beyond_answer(run->solver)->error, path,
                       &run->error);
            break;
        }
    }
}

/* True if a mesh, or else a picture, is among the outputs. */
static bool wants(const struct options *options, bool mesh)
{
    for (int i = 0; i < options->output_count; i++)
        if ((output_format_of(options->outputs[i]) == FORMAT_PLY) == mesh)
            return true;
    return false;
}

/* Collective. Returns the open quarters of all leaves, of which each rank examines some;
 * NULL with --flat. */
static uint8_t *survey_leaves(struct run *run)
{
    if (run->options.flat)
        return NULL;
    int64_t leaves;
    uint8_t *open = shading_open_quarters(run->solver->model.forest, run->octree,
                                          run->comm.rank, run->comm.size, &leaves);
    comm_add_bytes(&run->comm, open, leaves);
    return open;
}

/* Prepares the shading of all leaves, less the radiosities `less`, which may be NULL. */
static struct shading *shade_leaves(struct run *run, const struct rgb *less,
                                    const uint8_t *open)
{
    double start = comm_seconds();
    struct shading *shading = shading_create(run->solver->model.forest, less, open);
    run->solver->account.seconds[PHASE_SHADING] += comm_seconds() - start;
    return shading;
}

static void place_camera(struct run *run)
{
    struct camera *camera = &run->camera;
    double start = comm_seconds();
    if (!run->options.view) /* all ranks choose alike */
        *camera = viewpoint_choose(run->scene, run->octree, run->solver->model.forest,
                                   camera->width, camera->height);
    run->solver->account.seconds[PHASE_VIEWPOINT] = comm_seconds() - start;
}

/* Collective. Returns the picture of the camera on rank 0, NULL on the others. Its rays
 * are not counted among the solution's. */
static float *make_picture(struct run *run, const uint8_t *open)
{
    const struct comm *comm = &run->comm;
    struct model *model = &run->solver->model;
    struct octree_counts counts = model->counts;
    int64_t estimating = model->estimating;
    place_camera(run);
    struct answer *answer = run->solver->beyond ? &run->solver->beyond->answer : NULL;
    bool gathers = answer && answer->straight && !run->options.flat;
    struct shading *shading = NULL;
    if (!run->options.pixels)
        shading = shade_leaves(run, gathers ? answer->straight : NULL, open);
    struct renderer renderer =
        renderer_make(run->octree, shading, gathers ? &answer->gather : NULL);
    if (gathers)
        answer->gather.counts = (struct gather_counts){.rays = 0};
    progress_begin(&run->progress.progress, "rendering", -1, 0);
    float *scanlines = render_scanlines(&renderer, &run->camera, run->options.samples,
                                        comm->rank, comm->size, &run->progress.progress);
    float *picture = picture_gather(comm, scanlines, 3 * (size_t)run->camera.width,
                                    run->camera.height);
    if (gathers) {
        answer->counts.pixels =
            answer->gather.counts.rays + answer->gather.counts.segments;
        comm_add(comm, &answer->counts.pixels, 1);
    }
    model->counts = counts;
    model->estimating = estimating;
    shading_destroy(shading);
    alloc_free(scanlines);
    return picture;
}

bool results_show(struct run *run)
{
    double start = comm_seconds();
    if (run->options.output_count == 0)
        return true;
    uint8_t *open = survey_leaves(run);
    float *picture = wants(&run->options, false) ? make_picture(run, open) : NULL;
    struct shading *shading =
        wants(&run->options, true) ? shade_leaves(run, NULL, open) : NULL;
    run->solver->account.seconds[PHASE_RENDER] = comm_seconds() - start;
    start = comm_seconds();
    if (run_goes_on(run) && run->comm.rank == 0)
        write_outputs(run, shading, picture);
    alloc_free(picture);
    alloc_free(open);
    shading_destroy(shading);
    run->solver->account.seconds[PHASE_WRITE] += comm_seconds() - start;
    return run_agree(run);
}
