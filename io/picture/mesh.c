/* The solution mesh. Leaves share the vertices of the smooth shading, so a viewer
 * interpolating vertex colours shows the same light as phr's pictures, but for steps
 * where a leaf has T-vertices. */
#include "io/picture/mesh.h"

#include "geom/alloc.h"
#include "geom/stop.h"

int32_t mesh_next_leaf(const struct forest *forest, int32_t leaf)
{
    do
        leaf = forest_next_leaf(forest, leaf);
    while (leaf >= 0 &&
           scene_is_sky(forest->scene, (int32_t)forest->patches[leaf].id.root));
    return leaf;
}

int64_t mesh_count(const struct forest *forest)
{
    int64_t count = 0;
    for (int32_t i = mesh_next_leaf(forest, -1); i >= 0; i = mesh_next_leaf(forest, i))
        count++;
    return count;
}

static const char IRRADIANCE[] = "property float irradiance_r\nproperty float "
                                 "irradiance_g\nproperty float irradiance_b\n";

void mesh_write_header(struct output *output, int64_t vertices, int64_t faces,
                       bool irradiance)
{
    fprintf(output->file,
            "ply\nformat binary_little_endian 1.0\n"
            "comment radiosity in W/m^2, made by phr\n"
            "element vertex %lld\n"
            "property float x\nproperty float y\nproperty float z\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
            "property float radiosity_r\nproperty float radiosity_g\n"
            "property float radiosity_b\n%s"
            "element face %lld\n"
            "property list uchar int vertex_indices\n"
            "property float radiosity_r\nproperty float radiosity_g\n"
            "property float radiosity_b\n"
            "property uint root\nproperty uint hierarchy\n",
            (long long)vertices, irradiance ? IRRADIANCE : "", (long long)faces);
}

static void write_vertices(struct output *output, const struct shading *shading,
                           const struct tone *tone, const struct rgb *irradiance)
{
    for (int64_t v = 0; v < shading->own_count && !stop_is_asked(); v++) {
        struct vec3 x = scene_to_input(shading->forest->scene, shading->positions[v]);
        output_float(output, (float)x.x);
        output_float(output, (float)x.y);
        output_float(output, (float)x.z);
        for (int c = 0; c < BANDS; c++)
            putc(tone_encode(tone, shading->values[v].band[c]), output->file);
        for (int c = 0; c < BANDS; c++)
            output_float(output, (float)shading->values[v].band[c]);
        for (int c = 0; c < BANDS && irradiance; c++)
            output_float(output, (float)irradiance[v].band[c]);
    }
}

static void write_face(struct output *output, const struct shading *shading,
                       const struct mesh_answer *answer, int32_t leaf)
{
    const struct patch *patch = &shading->forest->patches[leaf];
    putc(3, output->file);
    for (int k = 0; k < 3; k++)
        output_uint32(output, (uint32_t)shading->corners[3 * (int64_t)leaf + k]);
    for (int c = 0; c < BANDS; c++)
        output_float(output, (float)shading->forest->radiosity[leaf].band[c]);
    output_uint32(output, patch->id.root);
    output_uint32(output, patch->id.hierarchy);
    if (answer->error)
        output_float(output, answer->error[leaf]);
    for (int c = 0; c < BANDS && answer->straight; c++)
        output_float(output, (float)(shading->forest->radiosity[leaf].band[c] -
                                     answer->straight[leaf].band[c]));
    if (answer->outside)
        output_float(output, answer->outside[leaf]);
    for (int c = 0; c < BANDS && answer->irradiance; c++)
        output_float(output, (float)answer->irradiance[leaf].band[c]);
    if (answer->irradiance_error)
        output_float(output, answer->irradiance_error[leaf]);
}

bool mesh_write(const struct shading *shading, const struct tone *tone,
                const struct mesh_answer *answer, const char *path, struct error *error)
{
    const struct forest *forest = shading->forest;
    const struct scene *scene = forest->scene;
    if (scene->sky_first < scene->input_count)
        scene = NULL; /* the sky would be missing */
    struct output output;
    if (!output_open(&output, path, error))
        return false;
    mesh_write_header(&output, shading->own_count, mesh_count(forest),
                      answer->irradiance != NULL);
    output_write_note(&output, "comment ");
    fprintf(output.file, "%s%s%s%s%s", answer->error ? "property float error\n" : "",
            answer->straight ? "property float rest_r\nproperty float rest_g\n"
                               "property float rest_b\n"
                             : "",
            answer->outside ? "property float outside\n" : "",
            answer->irradiance ? IRRADIANCE : "",
            answer->irradiance_error ? "property float irradiance_error\n" : "");
    solution_write_header(&output, scene, answer->lamps.known);
    write_vertices(&output, shading, tone, answer->irradiance_at);
    int32_t leaf = mesh_next_leaf(forest, -1);
    for (; leaf >= 0 && stop_check(error); leaf = mesh_next_leaf(forest, leaf))
        write_face(&output, shading, answer, leaf);
    solution_write_scene(&output, scene, &answer->lamps);
    return output_close(&output, error);
}

float *mesh_colours(const struct forest *forest, int64_t *count)
{
    float *rgb = alloc_array((size_t)mesh_count(forest) * 3, sizeof *rgb);
    int64_t at = 0;
    int32_t leaf = mesh_next_leaf(forest, -1);
    for (; leaf >= 0; leaf = mesh_next_leaf(forest, leaf))
        for (int c = 0; c < BANDS; c++)
            rgb[at++] = (float)forest->radiosity[leaf].band[c];
    *count = at / 3;
    return rgb;
}
