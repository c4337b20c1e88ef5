/* Reading the scene and its camera on rank 0, probing the outputs, and passing the input
 * on to all ranks. */
#include "tools/input.h"

#include <math.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/stop.h"
#include "io/picture/texture.h"
#include "io/run/files.h"
#include "io/scene/obj.h"
#include "io/scene/ply.h"
#include "io/scene/sky.h"
#include "io/scene/stl.h"
#include "geom/signals.h"
#include "mpi/broadcast.h"
#include "tools/idle.h"
#include "tools/show.h"

/* Warns of `count` cases, if there are any; `text` may have a place for `detail`. */
static void warn(struct run *run, int64_t count, const char *text, const char *detail)
{
    char line[600];
    snprintf(line, sizeof line, text, detail);
    if (count > 0)
        run_say(run, "%s: warning: %lld %s", run->options.scene, (long long)count, line);
}

static void warn_repairs(struct run *run, const struct obj_repairs *read,
                         const struct scene_repairs *prepared)
{
    char number[64] = "", lost[400] = "", materials[300];
    snprintf(materials, sizeof materials, "%s%s%s%s", read->materials.first,
             *read->materials.like ? "; did you mean " : "", read->materials.like,
             *read->materials.like ? "?" : "");
    if (read->libraries.count > 0)
        snprintf(run->missing, sizeof run->missing, "the file %.128s, which is missing",
                 read->libraries.first);
    else if (read->materials.count > 0)
        snprintf(run->missing, sizeof run->missing,
                 "the material %.128s, which has no definition", read->materials.first);
    warn(run, read->libraries.count,
         "material file(s) missing or not readable (first: %s)", read->libraries.first);
    warn(run, read->materials.count,
         "material(s) without a definition, taken as grey (first: %s)", materials);
    warn(run, read->nameless,
         "newmtl without a name: taken as the material of usemtl without one", "");
    warn(run, read->all_panes ? read->panes : 0,
         "material(s) with d, Tr, Tf or illum 4 on all faces, taken as opaque", "");
    warn(run, read->all_panes ? 0 : read->panes,
         "material(s) with d, Tr, Tf or illum 4 are panes, which links, view factors and "
         "--paper do not see", "");
    warn(run, read->all_panes ? 0 : read->glowing, "pane(s) with Ke, which emit nothing",
         "");
    if (read->textures.count > 0)
        snprintf(lost, sizeof lost,
                 "; where that cannot be read (%lld, first: %s), Kd alone, or .5 if it "
                 "is 1; PNG of 8 bits and PPM are read: `magick a.jpg a.png` makes one",
                 (long long)read->textures.count, read->textures.first);
    warn(run, read->textured,
         "material(s) with a texture: Kd, or Ke, times the mean over its faces counts%s",
         lost);
    warn(run, read->passed_count, "keyword(s) of materials passed over: %s",
         read->passed);
    warn(run, read->unread,
         "material(s) with Kd or Ke as spectral or xyz, not read: Kd is grey, and Ke 0",
         "");
    warn(run, read->bad_normals,
         "corner(s) with a vn that is no direction, or not there: ignored", "");
    snprintf(number, sizeof number, "%ld", read->first_unknown);
    warn(run, read->unknown_lines,
         "line(s) with other keywords or numbers passed over (first: line %s)", number);
    warn(run, prepared->clamped,
         "material(s) with a reflectance of 1 or more, set to 0.999", "");
    warn(run, prepared->degenerate, "face(s) without area dropped", "");
    snprintf(number, sizeof number, ", also where the materials differ (%lld)",
             (long long)prepared->unlike);
    warn(run, prepared->doubles,
         "triangle(s) are there twice, facing the same way: the first of each stays%s",
         prepared->unlike > 0 ? number : "");
}

/* Emissions beyond these would leave the range of the float outputs. */
static const double EMISSION_MIN = 1e-30, EMISSION_MAX = 1e30;

static bool check_emission(const struct run *run, struct error *error)
{
    const struct scene *scene = run->scene;
    double largest = 0.0;
    for (int32_t i = 0; i < scene->input_count; i++)
        for (int c = 0; c < BANDS && scene->areas[i] > 0.0; c++)
            largest = fmax(largest, scene_root_material(scene, i)->emission.band[c]);
    if (!(largest > 0.0))
        return error_set(error, EXIT_USAGE,
                         "%s: nothing emits light "
                         "(no face with Ke or emission_r above 0)",
                         run->options.scene);
    if (largest < EMISSION_MIN || largest > EMISSION_MAX)
        return error_set(error, EXIT_USAGE,
                         "%s: the largest Ke, %g, is not within %g and %g",
                         run->options.scene, largest, EMISSION_MIN, EMISSION_MAX);
    return true;
}

/* Refuses options for files of a computation, or for links. */
static bool check_stored(struct run *run)
{
    static const char *const FILES[] = {"--stats",      "--save-links", "--load-links",
                                        "--checkpoint", "--resume",     NULL};
    const char *path = run->options.scene, *given = options_given(&run->options, FILES);
    if (*given)
        return error_set(&run->error, EXIT_USAGE,
                         "%s is a stored solution: nothing is computed for %s", path,
                         given);
    if (run->options.dump == DUMP_LINKS)
        return error_set(&run->error, EXIT_USAGE,
                         "%s is a stored solution: it has no links", path);
    idle_warn_stored(run);
    return true;
}

/* Takes the scene of a stored solution. */
static bool take_stored(struct run *run, struct ply_file *file)
{
    run->stored = alloc_array(1, sizeof *run->stored);
    if (!solution_mesh_of_file(run->stored, file, &run->error))
        return false;
    run->scene = run->stored->scene;
    run->stored->scene = NULL;
    if (!run->scene)
        return error_set(&run->error, EXIT_USAGE,
                         "%s: a solution without its roots (element root_corner), "
                         "which cannot be shown: make it anew from its scene, "
                         "without --sky",
                         run->options.scene);
    return check_stored(run);
}

/* Reads a scene, or a stored solution. */
static bool read_ply(struct run *run, struct source *source)
{
    struct ply_file file;
    char number[32], names[200];
    bool good = ply_file_open(&file, source, &run->error);
    if (good && solution_is_stored(&file) && !run->options.unlit)
        good = take_stored(run, &file);
    else if (good)
        run->scene = ply_of_file(&file, &run->error);
    snprintf(number, sizeof number, "%ld", file.first_long);
    if (good)
        warn(run, file.long_lines,
             "line(s) with more values than the header says, passed over "
             "(first: line %s)",
             number);
    text_names_list(&file.passed, names, sizeof names);
    if (good && !run->stored)
        warn(run, file.passed.count, "element(s) or propert(ies) passed over: %s", names);
    ply_file_close(&file);
    return good && run->scene;
}

/* Reads the scene, its libraries and its pictures, over which no output goes, unless the
 * scene is there. */
static bool read_file(struct run *run, struct obj_repairs *repairs)
{
    struct text_names files = {0};
    struct source source;
    if (run->scene)
        return true;
    repairs->files = &files;
    bool good = source_open(&source, run->options.scene, &run->error);
    if (good && ply_is_meant(&source))
        good = read_ply(run, &source);
    else if (good && stl_is_meant(&source))
        good = (run->scene = stl_of_source(&source, &run->error)) != NULL;
    else if (good)
        good = (run->scene = obj_of_source(&source, repairs, &run->error)) != NULL;
    source_close(&source);
    for (int32_t i = 0; i < files.count && good; i++)
        good = files_check_input(&run->options, files.name[i], &run->error);
    repairs->files = NULL;
    text_names_free(&files);
    return good;
}

void input_say_up(struct run *run)
{
    static const char *const NAMES[] = {"-z", "-y", "-x", "", "x", "y", "z"};
    if (run->up_reason)
        run_say(run, "%s: %s is up: %s (see --up)", run->options.scene,
                NAMES[run->scene->up + 3], run->up_reason);
    run->up_reason = NULL;
}

/* Adds the sky asked for, or one in place of a dome, of `*faces` faces, or one to make a
 * scene without lamps visible. */
static bool add_sky(struct run *run, int32_t *faces)
{
    struct scene *scene = run->scene;
    struct sky *sky = &run->options.sky;
    *faces = sky->kind == SKY_NONE ? sky_of_dome(scene, sky) : 0;
    if (*faces > 0)
        run_say(run, "%s: lamps all around, of %g,%g,%g W/m^2, are taken as a sky: as "
                     "--sky", run->options.scene, sky->level.band[0],
                sky->level.band[1], sky->level.band[2]);
    bool emits = sky->kind != SKY_NONE || sky->sun_irradiance > 0.0, reflects = false;
    for (int32_t i = 0; i < scene->input_count && !(emits && reflects); i++) {
        emits = emits || material_emits(scene_root_material(scene, i));
        reflects = reflects || rgb_sum(scene_root_material(scene, i)->reflectance) > 0.0;
    }
    if (!emits) {
        run_say(run, "%s: nothing emits light: --sky 1 is taken%s", run->options.scene,
                reflects ? ""
                         : "; and nothing reflects any (Kd, or colours of vertices)");
        sky->kind = SKY_UNIFORM;
        sky->level = (struct rgb){{1.0, 1.0, 1.0}};
    }
    if (scene->input_count == 0 ||
        (sky->kind == SKY_NONE && !(sky->sun_irradiance > 0.0)))
        return true;
    input_say_up(run);
    return sky_add(scene, sky, &run->error);
}

/* Takes the upward axis: as given, or as a view has it, or as the scene seems to have.
 * Views without an `up` line get the one given. */
static void take_up(struct run *run, const char *exporter)
{
    static const int32_t AXES[] = {[UP_GUESSED] = 0, [UP_Y] = 2, [UP_Z] = 3,
                                   [UP_MINUS_Y] = -2, [UP_MINUS_Z] = -3, [UP_X] = 1,
                                   [UP_MINUS_X] = -1};
    struct scene *scene = run->scene;
    scene->up = AXES[run->options.up];
    for (int i = 0; i < run->options.view_count; i++) {
        struct camera *camera = &run->cameras[i];
        if (run->options.up && !camera->has_up)
            camera_set_up(camera, scene->up);
        else if (!scene->up && (scene->up = camera_up_axis(camera)) != 0)
            run->up_reason = run->options.views[i];
    }
    if (!scene->up)
        scene->up = subject_guess_up(scene, exporter, &run->up_reason);
}

/* Says of files of Blender, with lamps, whose unit of Ke they have. */
static void say_ke(struct run *run, const char *exporter)
{
    static const char *const KE[] = {"--ke", NULL};
    bool emits = false;
    for (int32_t i = 0; i < run->scene->input_count && !emits; i++)
        emits = material_emits(scene_root_material(run->scene, i));
    if (emits && strstr(exporter, "Blender") && !*options_given(&run->options, KE))
        run_say(run, "%s: made by Blender, whose Ke is a radiance: --ke radiance gives "
                     "pi times the light, which is then right", run->options.scene);
}

static bool read_scene(struct run *run)
{
    struct error *error = &run->error;
    struct obj_repairs read = {.names = &run->materials, .mean_of = texture_mean};
    struct scene_repairs prepared = {0};
    if (!read_file(run, &read) || !stop_check(error))
        return false;
    if (run->scene->input_count > 0)
        take_up(run, read.exporter);
    if (run->stored)
        return true;
    say_ke(run, read.exporter);
    if (run->options.ke == KE_RADIANCE)
        scene_take_radiances(run->scene);
    run->scene->two_sided = run->options.two_sided;
    run->scene->two_sided_lamps = run->options.two_sided_lamps;
    int32_t dome = 0;
    if (!run->options.unlit && !add_sky(run, &dome))
        return false;
    struct error wrong = {0};
    if (!scene_prepare(run->scene, &prepared, &wrong))
        return error_set(error, wrong.code, "%s: %s", run->options.scene, wrong.text);
    if (run->options.unlit || run->options.criterion.final_gather == 0)
        scene_drop_panes(run->scene);
    prepared.degenerate -= dome;
    warn_repairs(run, &read, &prepared);
    return run->options.unlit || check_emission(run, error);
}

/* Reads the view files; --size overrides their sizes. */
static bool read_cameras(struct run *run)
{
    const struct options *options = &run->options;
    for (int i = 0; i < options->view_count; i++)
        if (!camera_read(options->views[i], &run->cameras[i], &run->error))
            return false;
    for (int i = 0; i < run_camera_count(run); i++)
        if (options->width > 0 || options->view_count == 0) {
            struct camera *camera = &run->cameras[i];
            camera->width = options->width > 0 ? options->width : CAMERA_SIZE;
            camera->height = options->width > 0 ? options->height : CAMERA_SIZE;
        }
    return true;
}

/* Reads all, on rank 0. Errors are in run->error. */
static void read_input(struct run *run)
{
    signals_end_calls(true);
    if (files_check(&run->options, &run->error) &&
        files_probe(&run->options, &run->error) && read_cameras(run) &&
        (!run->options.at || points_read(&run->points, run->options.at, &run->error)) &&
        read_scene(run)) {
        run_set_note(run);
        show_check(run);
    }
    signals_end_calls(false);
}

bool input_broadcast(struct run *run)
{
    size_t cameras = (size_t)run_camera_count(run);
    run->cameras = alloc_array(cameras, sizeof *run->cameras);
    if (run->comm.rank == 0)
        read_input(run);
    if (!run_agree(run))
        return false;
    run->block = scene_broadcast(&run->comm, node_policy(), &run->scene, &run->octree);
    comm_broadcast(&run->comm, run->cameras, cameras * sizeof *run->cameras);
    if (run->block.shared && run->options.verbose)
        run_say(run, "one copy of scene and octree for %d ranks, %.1f MB",
                run->block.node.size, 1e-6 * (double)run->block.bytes);
    return run_goes_on(run);
}
