/* Writing VTK's legacy format: lines of text announcing arrays, and the arrays, most
 * significant bytes first. The mesh is an unstructured grid, which meshio knows, too; it
 * does not know POLYDATA. ParaView and VTK drop the properties of PLY faces; here all
 * numbers arrive. Arrays are columns, so the leaves are walked once for each. */
#include "io/picture/vtk.h"

#include <string.h>

#include "geom/stop.h"
#include "io/picture/mesh.h"
#include "io/run/output.h"

enum { VTK_TRIANGLE = 5 }; /* the format's number of this type of cells */

enum column { CORNERS, TYPE, RADIOSITY, ROOT, HIERARCHY, LEVEL, ERROR,
              IRRADIANCE, IRRADIANCE_ERROR, COLUMNS };

static void write_rgb(struct output *output, const struct rgb *rgb)
{
    for (int c = 0; c < BANDS; c++)
        output_float_big(output, (float)rgb->band[c]);
}

static void write_cell(struct output *output, const struct shading *shading,
                       const struct mesh_answer *answer, int32_t leaf,
                       enum column column)
{
    struct patch_id id = shading->forest->patches[leaf].id;
    switch (column) {
    case CORNERS:
        output_uint32_big(output, 3);
        for (int k = 0; k < 3; k++)
            output_uint32_big(output, (uint32_t)shading->corners[3 * (int64_t)leaf + k]);
        break;
    case TYPE: output_uint32_big(output, VTK_TRIANGLE); break;
    case RADIOSITY: write_rgb(output, &shading->forest->radiosity[leaf]); break;
    case ROOT: output_uint32_big(output, id.root); break;
    case HIERARCHY: output_uint32_big(output, id.hierarchy); break;
    case LEVEL: putc(id_level(id), output->file); break;
    case ERROR: output_float_big(output, answer->error[leaf]); break;
    case IRRADIANCE: write_rgb(output, &answer->irradiance[leaf]); break;
    case IRRADIANCE_ERROR:
        output_float_big(output, answer->irradiance_error[leaf]);
        break;
    default: break;
    }
}

static void write_column(struct output *output, const struct shading *shading,
                         const struct mesh_answer *answer, enum column column,
                         struct error *error)
{
    const struct forest *forest = shading->forest;
    int32_t leaf = mesh_next_leaf(forest, -1);
    for (; leaf >= 0 && stop_check(error); leaf = mesh_next_leaf(forest, leaf))
        write_cell(output, shading, answer, leaf, column);
    putc('\n', output->file);
}

static void write_points(struct output *output, const struct shading *shading,
                         struct error *error)
{
    fprintf(output->file, "POINTS %lld float\n", (long long)shading->own_count);
    for (int64_t v = 0; v < shading->own_count && stop_check(error); v++) {
        struct vec3 x = scene_to_input(shading->forest->scene, shading->positions[v]);
        for (int axis = 0; axis < 3; axis++)
            output_float_big(output, (float)vec3_axis(x, axis));
    }
    putc('\n', output->file);
}

static void write_point_data(struct output *output, const struct shading *shading,
                             const struct rgb *irradiance, struct error *error)
{
    long long count = shading->own_count;
    fprintf(output->file, "POINT_DATA %lld\nFIELD points %d\nradiosity 3 %lld float\n",
            count, irradiance ? 2 : 1, count);
    for (int64_t v = 0; v < count && stop_check(error); v++)
        write_rgb(output, &shading->values[v]);
    putc('\n', output->file);
    if (!irradiance)
        return;
    fprintf(output->file, "irradiance 3 %lld float\n", count);
    for (int64_t v = 0; v < count && stop_check(error); v++)
        write_rgb(output, &irradiance[v]);
    putc('\n', output->file);
}

/* Writes the title, for which the format allows 256 characters. */
static void write_title(struct output *output)
{
    char title[256];
    snprintf(title, sizeof title, "radiosity in W/m^2, made by %s",
             *output_note() ? output_note() : "phr\n");
    for (char *c = title; *c; c++)
        *c = *c == '\n' ? ' ' : *c;
    fprintf(output->file, "%.*s\n", (int)strlen(title) - 1, title);
}

bool vtk_write(const struct shading *shading, const struct mesh_answer *answer,
               const char *path, struct error *error)
{
    static const char *const ARRAYS[][2] = {
        [RADIOSITY] = {"radiosity 3", "float"},
        [ROOT] = {"root 1", "unsigned_int"},
        [HIERARCHY] = {"hierarchy 1", "unsigned_int"},
        [LEVEL] = {"level 1", "unsigned_char"},
        [ERROR] = {"error 1", "float"},
        [IRRADIANCE] = {"irradiance 3", "float"},
        [IRRADIANCE_ERROR] = {"irradiance_error 1", "float"}};
    const bool is_there[COLUMNS] = {
        [RADIOSITY] = true, [ROOT] = true, [HIERARCHY] = true, [LEVEL] = true,
        [ERROR] = answer->error, [IRRADIANCE] = answer->irradiance,
        [IRRADIANCE_ERROR] = answer->irradiance_error};
    long long cells = mesh_count(shading->forest);
    int fields = 0;
    struct output output;
    if (!output_open(&output, path, error))
        return false;
    for (int column = RADIOSITY; column < COLUMNS; column++)
        fields += is_there[column];
    fprintf(output.file, "# vtk DataFile Version 3.0\n");
    write_title(&output);
    fprintf(output.file, "BINARY\nDATASET UNSTRUCTURED_GRID\n");
    write_points(&output, shading, error);
    fprintf(output.file, "CELLS %lld %lld\n", cells, 4 * cells);
    write_column(&output, shading, answer, CORNERS, error);
    fprintf(output.file, "CELL_TYPES %lld\n", cells);
    write_column(&output, shading, answer, TYPE, error);
    fprintf(output.file, "CELL_DATA %lld\nFIELD cells %d\n", cells, fields);
    for (int column = RADIOSITY; column < COLUMNS; column++) {
        if (!is_there[column])
            continue;
        fprintf(output.file, "%s %lld %s\n", ARRAYS[column][0], cells,
                ARRAYS[column][1]);
        write_column(&output, shading, answer, (enum column)column, error);
    }
    write_point_data(&output, shading, answer->irradiance_at, error);
    return output_close(&output, error);
}
