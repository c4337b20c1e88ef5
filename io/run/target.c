/* Formats of outputs: the name of a format is a prefix and a suffix, too. */
#include "io/run/target.h"

#include <ctype.h>
#include <stdio.h>

#include "io/scene/text.h"

static const struct {
    const char *name;
    bool is_mesh, has_tone;
} FORMATS[] = {
    [FORMAT_PPM] = {"ppm", false, true},
    [FORMAT_PFM] = {"pfm", false, false},
    [FORMAT_PNG] = {"png", false, true},
    [FORMAT_HDR] = {"hdr", false, false},
    [FORMAT_PLY] = {"ply", true, true},
    [FORMAT_VTK] = {"vtk", true, false},
    [FORMAT_GLB] = {"glb", true, true},
    [FORMAT_ERROR] = {"error.pfm", false, false},
};
enum { FORMAT_COUNT = sizeof FORMATS / sizeof FORMATS[0] };

bool format_is_mesh(enum output_format format)
{
    return FORMATS[format].is_mesh;
}

bool format_has_tone(enum output_format format)
{
    return FORMATS[format].has_tone;
}

/* Returns the length of "FORMAT:" at the start of an argument, or 0. */
static size_t prefix_length(const char *argument, const char *format)
{
    size_t i = 0;
    while (format[i] && tolower((unsigned char)argument[i]) == format[i])
        i++;
    return !format[i] && argument[i] == ':' ? i + 1 : 0;
}

struct target target_parse(const char *argument)
{
    struct target target = {argument, FORMAT_PPM, false, 0};
    char suffix[16];
    for (int i = 0; i < FORMAT_COUNT; i++) {
        size_t prefix = prefix_length(argument, FORMATS[i].name);
        if (prefix > 0)
            return (struct target){argument + prefix, (enum output_format)i, true, 0};
        snprintf(suffix, sizeof suffix, ".%s", FORMATS[i].name);
        if (text_ends_with(argument, suffix))
            target = (struct target){argument, (enum output_format)i, true, 0};
    }
    return target;
}

bool target_refuse(const char *argument, struct error *error)
{
    char list[200] = "";
    for (int i = 0, at = 0; i < FORMAT_COUNT; i++)
        at += snprintf(list + at, sizeof list - (size_t)at, "%s.%s",
                       i == 0 ? "" : i + 1 < FORMAT_COUNT ? ", " : " or ",
                       FORMATS[i].name);
    return error_set(error, EXIT_USAGE, "-o %s: the name must end in %s, or be "
                     "FORMAT:FILE, as in ppm:FILE", argument, list);
}
