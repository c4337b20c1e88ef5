/* Reading the scene and its camera on rank 0, and probing the outputs. */
#include "tools/input.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/stop.h"
#include "io/run/files.h"
#include "io/scene/obj.h"
#include "io/scene/ply.h"
#include "geom/signals.h"
#include "tools/idle.h"
#include "tools/viewfactor.h"

static void warn_repairs(struct run *run, const struct obj_repairs *read,
                         const struct scene_repairs *prepared)
{
    const char *path = run->options.scene;
    if (read->libraries.count > 0)
        run_say(run, "%s: warning: %lld material file(s) missing (first: %s)", path,
                (long long)read->libraries.count, read->libraries.first);
    if (read->materials.count > 0)
        run_say(run,
                "%s: warning: %lld material(s) without a definition, "
                "taken as grey (first: %s)",
                path, (long long)read->materials.count, read->materials.first);
    if (read->nameless > 0)
        run_say(run,
                "%s: warning: %lld newmtl without a name: "
                "taken as the material of usemtl without one",
                path, (long long)read->nameless);
    if (read->transparent > 0)
        run_say(run,
                "%s: warning: %lld transparent material(s) (d or Tr), taken as opaque",
                path, (long long)read->transparent);
    if (read->textured > 0)
        run_say(run,
                "%s: warning: %lld material(s) with a texture, "
                "which is not read: Kd counts, or grey",
                path, (long long)read->textured);
    if (read->bad_normals > 0)
        run_say(run,
                "%s: warning: %lld corner(s) with a vn that is no direction, "
                "or not there: ignored",
                path, (long long)read->bad_normals);
    if (read->unknown_lines > 0)
        run_say(run,
                "%s: warning: %lld line(s) with unknown keywords "
                "passed over (first: line %ld)",
                path, (long long)read->unknown_lines, read->first_unknown);
    if (prepared->clamped > 0)
        run_say(run,
                "%s: warning: %lld material(s) with a reflectance of 1 or more, "
                "set to 0.999",
                path, (long long)prepared->clamped);
    if (prepared->degenerate > 0)
        run_say(run, "%s: warning: %lld face(s) without area dropped", path,
                (long long)prepared->degenerate);
    if (prepared->doubles > 0 && prepared->unlike == 0)
        run_say(run,
                "%s: warning: %lld triangle(s) are there twice, facing the same way: "
                "the first of each stays",
                path, (long long)prepared->doubles);
    else if (prepared->doubles > 0)
        run_say(run,
                "%s: warning: %lld triangle(s) are there twice, facing the same way: "
                "the first of each stays, also where the materials differ (%lld)",
                path, (long long)prepared->doubles, (long long)prepared->unlike);
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

static bool check_groups(const struct run *run, struct error *error)
{
    if (run->scene->groups.count > VIEWFACTOR_GROUPS_MAX)
        return error_set(error, EXIT_USAGE, "%s: %lld groups are more than %d",
                         run->options.scene, (long long)run->scene->groups.count,
                         VIEWFACTOR_GROUPS_MAX);
    return true;
}

/* Refuses options that ask for files of a computation, or for links. */
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
                         "which cannot be shown: make it anew from its scene",
                         run->options.scene);
    return check_stored(run);
}

/* Reads a scene, or a stored solution. */
static bool read_ply(struct run *run, struct source *source)
{
    struct ply_file file;
    bool good = ply_file_open(&file, source, &run->error);
    if (good && solution_is_stored(&file) && !run->options.form_factors)
        good = take_stored(run, &file);
    else if (good)
        run->scene = ply_of_file(&file, &run->error);
    if (good && file.long_lines > 0)
        run_say(run,
                "%s: warning: %lld line(s) with more values than the header says, "
                "passed over (first: line %ld)",
                run->options.scene, (long long)file.long_lines, file.first_long);
    ply_file_close(&file);
    return good && run->scene;
}

/* Reads the scene and its libraries, over which no output goes. */
static bool read_file(struct run *run, struct obj_repairs *repairs)
{
    struct text_names libraries = {0};
    struct source source;
    repairs->files = &libraries;
    bool good = source_open(&source, run->options.scene, &run->error);
    if (good && ply_is_meant(&source))
        good = read_ply(run, &source);
    else if (good)
        good = (run->scene = obj_of_source(&source, repairs, &run->error)) != NULL;
    source_close(&source);
    for (int32_t i = 0; i < libraries.count && good; i++)
        good = files_check_input(&run->options, libraries.name[i], &run->error);
    repairs->files = NULL;
    text_names_free(&libraries);
    return good;
}

static bool read_scene(struct run *run)
{
    struct error *error = &run->error;
    struct obj_repairs read = {0};
    struct scene_repairs prepared = {0};
    if (!read_file(run, &read) || !stop_check(error))
        return false;
    if (run->stored)
        return true;
    if (run->options.ke == KE_RADIANCE)
        scene_take_radiances(run->scene);
    run->scene->two_sided = run->options.two_sided;
    run->scene->two_sided_lamps = run->options.two_sided_lamps;
    struct error wrong = {0};
    if (!scene_prepare(run->scene, &prepared, &wrong))
        return error_set(error, wrong.code, "%s: %s", run->options.scene, wrong.text);
    warn_repairs(run, &read, &prepared);
    return run->options.form_factors ? check_groups(run, error)
                                     : check_emission(run, error);
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

void input_read(struct run *run)
{
    signals_end_calls(true);
    if (files_check(&run->options, &run->error) &&
        files_probe(&run->options, &run->error) && read_scene(run))
        read_cameras(run);
    signals_end_calls(false);
}
