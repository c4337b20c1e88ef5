/* Pictures and meshes of the solution. An output depends on the solution and on its own
 * options alone: the colours of a mesh have the exposure of its leaves, also where there
 * are pictures. Pictures are written view by view, so many views take no more memory than
 * one. */
#include "tools/results.h"

#include <string.h>

#include "geom/alloc.h"
#include "io/picture/glb.h"
#include "io/picture/imagefile.h"
#include "io/picture/mesh.h"
#include "io/picture/render.h"
#include "io/picture/scale.h"
#include "io/picture/viewpoint.h"
#include "io/picture/vtk.h"
#include "mpi/picture.h"
#include "rad/pushpull.h"
#include "tools/irradiance.h"
#include "tools/dark.h"
#include "tools/input.h"
#include "tools/show.h"
#include "tools/table.h"

/* Turns a picture into false colours, and says with which scale. Returns the tone whose
 * exposure asks for this scale. */
static struct tone colour_falsely(struct run *run, struct image *image)
{
    const struct options *options = &run->options;
    struct scale scale =
        scale_choose(image, options->exposure, options->lux, options->lines);
    run_say(run, "legend: %s from 0, dark, to %.6g %s, yellow", options->show ==
            SHOW_IRRADIANCE ? "irradiance" : "radiosity", scale.top,
            options->lux ? "lux" : "W/m^2");
    scale_paint(&scale, image);
    struct tone tone = tone_make(scale_value(&(struct rgb){{1.0, 1.0, 1.0}}, scale.lux) /
                                 scale.top);
    for (int64_t i = 0; i < BANDS * (int64_t)image->width * image->height; i++)
        image->rgb[i] = (float)((double)image->rgb[i] / tone.exposure);
    return tone;
}

/* Writes the pictures of a view: those of bytes last, as these may have false colours. On
 * rank 0 alone. `errors`: of pixels; NULL: none are wanted. */
static void write_pictures(struct run *run, int view, float *picture, float *errors)
{
    const struct options *options = &run->options;
    const struct camera *camera = &run->cameras[view];
    struct image image = {camera->width, camera->height, picture};
    struct image of_errors = {camera->width, camera->height, errors};
    struct tone tone = tone_choose(options->exposure, picture,
                                   (int64_t)camera->width * camera->height);
    bool falsely = options->show == SHOW_RADIOSITY || options->show == SHOW_IRRADIANCE;
    dark_warn(run, view, picture);
    for (int i = 0; i < 2 * options->output_count; i++) {
        bool has_tone = i >= options->output_count;
        const struct target *target = &options->outputs[i % options->output_count];
        struct error error = {.code = EXIT_DONE};
        if (target->view != view || format_is_mesh(target->format) ||
            format_has_tone(target->format) != has_tone)
            continue;
        if (falsely && has_tone) {
            tone = colour_falsely(run, &image);
            falsely = false;
        }
        if (has_tone)
            run->exposures[view] = tone.exposure;
        image_write(target->format == FORMAT_ERROR ? &of_errors : &image, &tone, target,
                    &error);
        run_lose(run, &error);
    }
}

/* Writes the meshes. On rank 0 alone. `irradiance_at`: H at the shading's vertices. */
static void write_meshes(struct run *run, const struct shading *shading,
                         const struct irradiance *irradiance,
                         const struct rgb *irradiance_at)
{
    int64_t count;
    float *colours = mesh_colours(run->solver->model.forest, &count);
    struct tone tone = tone_choose(run->options.exposure, colours, count);
    const struct answer *answer = beyond_answer(run->solver);
    struct mesh_answer solved = {
        .error = answer->error, .straight = answer->straight,
        .outside = answer->open, .irradiance = irradiance->forest.radiosity,
        .irradiance_error = irradiance->error, .irradiance_at = irradiance_at,
        .lamps = {answer->straight,
                  answer->straight ? answer->gather->lit->lamp_least : 0.0,
                  answer->gather ? answer->gather->lit->mean : 0.0}};
    for (int i = 0; i < run->options.output_count; i++) {
        const struct target *target = &run->options.outputs[i];
        struct error error = {.code = EXIT_DONE};
        if (target->format == FORMAT_VTK)
            vtk_write(shading, &solved, target->path, &error);
        else if (target->format == FORMAT_GLB)
            glb_write(shading, &tone, target->path, &error);
        else if (target->format == FORMAT_PLY)
            mesh_write(shading, &tone, &solved, target->path, &error);
        run_lose(run, &error);
    }
    alloc_free(colours);
}

/* Prepares the shading of all leaves, or of their H unless NULL; with `rest` without the
 * light straight from lamps. */
static struct shading *shade_leaves(struct run *run, const struct irradiance *irradiance,
                                    bool rest)
{
    const struct forest *forest =
        irradiance ? &irradiance->forest : run->solver->model.forest;
    const struct answer *answer = beyond_answer(run->solver);
    const struct rgb *straight = irradiance ? irradiance->straight : answer->straight;
    const float *error = irradiance ? irradiance->error : answer->error;
    account_begin(&run->solver->account, PHASE_SHADING);
    struct shading *shading =
        run->options.flat
            ? shading_create_flat(forest)
            : shading_create(forest, run->octree, rest ? straight : NULL,
                             rest ? error : NULL, answer->open);
    account_end(&run->solver->account, PHASE_SHADING);
    return shading;
}

/* All ranks choose alike. */
static void place_camera(struct run *run)
{
    struct camera *camera = run->cameras;
    account_begin(&run->solver->account, PHASE_VIEWPOINT);
    input_say_up(run);
    *camera = viewpoint_choose(run->scene, run->octree, run->solver->model.forest,
                               camera->width, camera->height);
    account_end(&run->solver->account, PHASE_VIEWPOINT);
}

/* True if the errors of the pixels of a view are wanted; -1: of any. */
static bool wants_errors(const struct options *options, int view)
{
    bool wants = false;
    for (int i = 0; i < options->output_count; i++)
        wants = wants || (options->outputs[i].format == FORMAT_ERROR &&
                          (view < 0 || options->outputs[i].view == view));
    return wants;
}

/* Takes the errors of pixels, which stand behind the light of each scanline, to a picture
 * of their own. Leaves the light. */
static float *part_errors(float *picture, const struct camera *camera)
{
    size_t length = BANDS * (size_t)camera->width, height = (size_t)camera->height;
    float *errors = alloc_array(length * height, sizeof *errors);
    for (size_t y = 0; y < height; y++) {
        memcpy(errors + y * length, picture + (2 * y + 1) * length,
               length * sizeof *errors);
        memmove(picture + y * length, picture + 2 * y * length, length * sizeof *errors);
    }
    return errors;
}

/* Collective. Returns the picture of a camera on rank 0, NULL on the others; in haste by
 * one ray a pixel. */
static float *make_picture(struct run *run, const struct renderer *renderer,
                           const struct camera *camera)
{
    const struct comm *comm = &run->comm;
    progress_begin(&run->progress.progress, "rendering", -1, 0);
    float *scanlines =
        render_scanlines(renderer, camera, run->haste ? 1 : run->options.samples,
                         comm->rank, comm->size, &run->progress.progress);
    size_t floats = (renderer->error ? 2u : 1u) * BANDS * (size_t)camera->width;
    return picture_gather(comm, scanlines, floats, camera->height);
}

/* Where a signal has come to pictures. */
struct halt {
    int view;       /* to go on with */
    float *picture; /* the pixels done of it, on rank 0, others below 0; or NULL */
    float *errors;  /* theirs, or NULL */
};

static void halt_free(struct halt *halt)
{
    alloc_free(halt->picture);
    alloc_free(halt->errors);
    halt->picture = halt->errors = NULL;
}

/* Puts the pixels done before a signal into a picture made in haste; frees them. */
static void keep_done(struct halt *halt, float *picture, float *errors,
                      const struct camera *camera)
{
    size_t floats = BANDS * (size_t)camera->width * (size_t)camera->height;
    for (size_t i = 0; halt->picture && i < floats; i++)
        if (halt->picture[i] >= 0.0f) {
            picture[i] = halt->picture[i];
            if (halt->errors && errors)
                errors[i] = halt->errors[i];
        }
    halt_free(halt);
}

/* Collective. Renders and writes the pictures of the views from halt->view on. False on
 * an error, and after a signal: `*halt` is the place to go on, in haste. */
static bool show_views(struct run *run, const struct renderer *renderer,
                       struct halt *halt)
{
    static const char DONE[] = "pixels not done have the light of the mesh";
    struct account *account = &run->solver->account;
    for (; halt->view < run_camera_count(run); halt->view++) {
        struct camera *camera = &run->cameras[halt->view];
        account_begin(account, PHASE_RENDER);
        struct renderer own = *renderer;
        if (!wants_errors(&run->options, halt->view))
            own.error = NULL;
        float *picture = make_picture(run, &own, camera);
        float *errors = picture && own.error ? part_errors(picture, camera) : NULL;
        int32_t *leaves = show_leaves(run, camera);
        bool halts = !run->haste && run_hastens(run, DONE);
        if (picture && !halts)
            keep_done(halt, picture, errors, camera);
        bool good = !halts && show_overlay(run, camera, leaves, picture);
        alloc_free(leaves);
        account_end(account, PHASE_RENDER);
        account_begin(account, PHASE_WRITE);
        if (good && run->comm.rank == 0)
            write_pictures(run, halt->view, picture, errors);
        if (halts) {
            halt->picture = picture;
            halt->errors = errors;
        } else {
            alloc_free(errors);
            alloc_free(picture);
        }
        account_end(account, PHASE_WRITE);
        if (!run_agree(run) || halts)
            return false;
    }
    return true;
}

/* Collective. Prepares the light of pictures, and shows the views left. Their rays are
 * not counted among the solution's. */
static bool show_pictures(struct run *run, struct halt *halt)
{
    struct model *model = &run->solver->model;
    struct octree_counts counts = model->counts;
    int64_t estimating = model->estimating;
    account_begin(&run->solver->account, PHASE_RENDER);
    if (run->options.view_count == 0)
        place_camera(run);
    struct answer *answer = run->solver->beyond ? run->solver->beyond->answer : NULL;
    struct rgb *colours = show_colours(run);
    bool white = run->options.show == SHOW_IRRADIANCE;
    struct irradiance irradiance;
    if (white)
        irradiance_make(run, &irradiance);
    bool pixels = run->options.pixels && !run->haste;
    bool gathers = answer && (answer->straight || pixels) && !run->haste &&
                   !run->options.flat && !colours;
    struct shading *shading = NULL;
    if (colours)
        shading = show_shading(run, colours);
    else if (!pixels)
        shading = shade_leaves(run, white ? &irradiance : NULL, gathers);
    struct renderer renderer =
        renderer_make(run->octree, shading, gathers ? answer->gather : NULL);
    double reflected = forest_mean_reflected(run->solver->model.forest);
    renderer.irradiance = white;
    renderer.error = white ? irradiance.error : answer ? answer->error : NULL;
    if (white && reflected > 0.0)
        renderer.brighter = forest_mean_reflected(&irradiance.forest) / reflected;
    if (pixels && renderer.rays < run->options.pixel_rays)
        renderer.rays = run->options.pixel_rays;
    if (gathers)
        answer->gather->counts = (struct gather_counts){.rays = 0};
    account_end(&run->solver->account, PHASE_RENDER);
    bool good = show_views(run, &renderer, halt);
    if (gathers) {
        answer->counts.pixels =
            answer->gather->counts.rays + answer->gather->counts.segments;
        comm_add(&run->comm, &answer->counts.pixels, 1);
    }
    model->counts = counts;
    model->estimating = estimating;
    shading_destroy(shading);
    alloc_free(colours);
    if (white)
        irradiance_free(&irradiance);
    return good;
}

/* Collective. Rank 0 alone shades and writes; anew in haste if a signal has come before
 * it writes. */
static bool show_meshes(struct run *run)
{
    account_begin(&run->solver->account, PHASE_WRITE);
    struct irradiance irradiance;
    irradiance_make(run, &irradiance);
    struct shading *shading =
        run->comm.rank == 0 ? shade_leaves(run, NULL, false) : NULL;
    struct rgb *at = shading ? irradiance_at_vertices(&irradiance, shading) : NULL;
    bool halts = !run->haste && run_hastens(run, "the light is whole");
    if (!halts && shading)
        write_meshes(run, shading, &irradiance, at);
    alloc_free(at);
    shading_destroy(shading);
    irradiance_free(&irradiance);
    account_end(&run->solver->account, PHASE_WRITE);
    return halts ? show_meshes(run) : run_agree(run);
}

/* Sets radiosities of leaves below 0, which conjugate residuals may leave in the dark
 * within their tolerance, to 0. Without any nothing changes. (Where the steps go on from
 * these, as between passes, zeros would be an error unseen by the steps.) */
static void clamp_radiosities(struct forest *forest)
{
    bool below = false;
    for (int64_t p = 0; p < forest->count; p++)
        for (int c = 0; c < BANDS && patch_is_leaf(&forest->patches[p]); c++)
            if (forest->radiosity[p].band[c] < 0.0) {
                forest->radiosity[p].band[c] = 0.0;
                below = true;
            }
    if (below)
        forest_average(forest);
}

bool results_show(struct run *run)
{
    clamp_radiosities(run->solver->model.forest);
    const struct options *options = &run->options;
    bool pictures = options_show(options, 0), meshes = false;
    for (int i = 0; i < options->output_count; i++)
        meshes = meshes || format_is_mesh(options->outputs[i].format);
    if (pictures || meshes)
        beyond_free_vectors(run->solver); /* pictures and meshes take as much */
    struct halt halt = {.view = 0};
    bool good = !meshes || show_meshes(run), hurried = run->haste != 0;
    if (pictures)
        run->exposures =
            alloc_array((size_t)run_camera_count(run), sizeof *run->exposures);
    if (good && pictures)
        good = show_pictures(run, &halt) ||
               (run->haste && !hurried && show_pictures(run, &halt));
    halt_free(&halt);
    return good && table_print_points(run) && table_write_report(run);
}
