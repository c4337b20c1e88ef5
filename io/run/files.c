/* The files of a run. */
#include "io/run/files.h"

#include <string.h>

#include "io/run/output.h"
#include "io/run/place.h"

/* Returns the i-th path to write, or NULL if not given. Sets `*count` to the number of
 * such paths. */
static const char *written_path(const struct options *options, int i, int *count)
{
    const char *others[] = {options->stats, options->save_links, options->checkpoint,
                            options->report};
    int last = (int)(sizeof others / sizeof others[0]);
    *count = options->output_count + last;
    return i < options->output_count ? options->outputs[i].path
                                     : others[i - options->output_count];
}

static bool check_formats(const struct options *options, struct error *error)
{
    for (int i = 0; i < options->output_count; i++) {
        const struct target *target = &options->outputs[i];
        if (!target->has_format && !output_is_stream(target->path))
            return target_refuse(target->path, error);
    }
    return true;
}

bool files_check_input(const struct options *options, const char *path,
                       struct error *error)
{
    int count = 1;
    for (int i = 0; i < count; i++) {
        const char *output = written_path(options, i, &count);
        bool renewed = output == options->checkpoint && path == options->resume;
        if (!output || renewed || !place_is_read(output, path))
            continue;
        if (strcmp(output, path) == 0)
            return error_set(error, EXIT_USAGE, "%s is read: no output goes over it",
                             path);
        return error_set(error, EXIT_USAGE, "%s is %s, which is read: no output goes "
                         "over it", output, path);
    }
    return true;
}

static bool check_outputs(const struct options *options, struct error *error)
{
    int count = 1;
    for (int i = 0; i < count; i++) {
        const char *path = written_path(options, i, &count);
        for (int j = 0; j < i; j++) {
            const char *other = written_path(options, j, &count);
            if (!path || !other || !place_is_written(path, other))
                continue;
            if (strcmp(path, other) == 0)
                return error_set(error, EXIT_USAGE, "%s is named twice", path);
            return error_set(error, EXIT_USAGE, "%s and %s are the same file", other,
                             path);
        }
    }
    return true;
}

/* Returns the number of outputs to the standard output. */
static int files_to_stdout(const struct options *options)
{
    int count = 1, outputs = options->at != NULL; /* its lines go there */
    for (int i = 0; i < count; i++) {
        const char *path = written_path(options, i, &count);
        outputs += path && place_is_stdout(path);
    }
    return outputs;
}

bool files_check(const struct options *options, struct error *error)
{
    const char *others[] = {options->scene, options->load_links, options->resume,
                            options->at, options->sky.path};
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
        if (others[i] && !files_check_input(options, others[i], error))
            return false;
    for (int i = 0; i < options->view_count; i++)
        if (!files_check_input(options, options->views[i], error))
            return false;
    int outputs = files_to_stdout(options);
    if ((options->dump || options->at) && outputs > (options->at && !options->dump))
        return error_set(error, EXIT_USAGE, "%s and an output to the standard output "
                         "do not go together", options->dump ? "--dump" : "--at");
    return check_formats(options, error) && check_outputs(options, error);
}

bool files_probe(const struct options *options, struct error *error)
{
    int count = 1;
    for (int i = 0; i < count; i++) {
        const char *path = written_path(options, i, &count);
        if (path && !output_probe(path, error))
            return false;
    }
    return true;
}

bool files_take_stdout(const struct options *options)
{
    return files_to_stdout(options) > 0;
}
