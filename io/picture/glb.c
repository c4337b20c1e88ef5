/* Writing glTF 2.0 (ISO/IEC 12113) in its binary form: a head, a chunk of JSON and one of
 * numbers, least significant byte first. Viewers show the vertices' colours as they are,
 * so light that depends on no view is seen from anywhere. */
#include "io/picture/glb.h"

#include <math.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/stop.h"
#include "io/picture/mesh.h"
#include "io/run/output.h"
#include "io/scene/subject.h"

enum { MAGIC = 0x46546C67, JSON = 0x4E4F534A, BIN = 0x004E4942, HEAD = 12, CHUNK = 8 };
enum { POSITION_BYTES = 12, COLOUR_BYTES = 8, TRIANGLE_BYTES = 12, TEXT_MOST = 4096 };

/* The position of a vertex from the middle of the scene, input units. */
static struct vec3 position_of(const struct shading *shading, int64_t v)
{
    const struct scene *scene = shading->forest->scene;
    return vec3_sub(scene_to_input(scene, shading->positions[v]), scene->place.centre);
}

static void find_box(const struct shading *shading, float low[3], float high[3])
{
    for (int64_t v = 0; v < shading->own_count; v++)
        for (int axis = 0; axis < 3; axis++) {
            float x = (float)vec3_axis(position_of(shading, v), axis);
            low[axis] = v == 0 || x < low[axis] ? x : low[axis];
            high[axis] = v == 0 || x > high[axis] ? x : high[axis];
        }
}

/* Writes the note with its quotes and ends of lines as JSON has these. */
static void put_note(char *text, size_t size)
{
    size_t at = 0;
    for (const char *c = output_note(); *c && at + 2 < size; c++) {
        if (*c == '\n' || *c == '"' || *c == '\\')
            text[at++] = '\\';
        text[at++] = *c == '\n' ? 'n' : *c;
    }
    text[at] = '\0';
}

/* Writes the description of `vertices` and `faces`, padded to a multiple of four. Returns
 * its length. */
static size_t describe(const struct shading *shading, const struct tone *tone,
                       int64_t vertices, int64_t faces, char text[TEXT_MOST])
{
    const struct scene *scene = shading->forest->scene;
    int32_t up = subject_find(scene).up;
    struct vec3 right = up_frame(up, 1.0, 0.0, 0.0), above = up_frame(up, 0.0, 0.0, 1.0);
    struct vec3 front = up_frame(up, 0.0, 1.0, 0.0), centre = scene->place.centre;
    long long colours = POSITION_BYTES * (long long)vertices,
              corners = colours + COLOUR_BYTES * (long long)vertices,
              bytes = corners + TRIANGLE_BYTES * (long long)faces;
    float low[3] = {0.0f}, high[3] = {0.0f};
    char note[TEXT_MOST / 2];
    find_box(shading, low, high);
    put_note(note, sizeof note);
    int length = snprintf(
        text, TEXT_MOST,
        "{\"asset\":{\"version\":\"2.0\",\"generator\":\"phr\",\"extras\":"
        "{\"exposure\":%.17g,\"note\":\"%s\"}},"
        "\"extensionsUsed\":[\"KHR_materials_unlit\"],\"scene\":0,"
        "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0,\"matrix\":"
        "[%g,%g,%g,0,%g,%g,%g,0,%g,%g,%g,0,%.17g,%.17g,%.17g,1]}],"
        "\"materials\":[{\"pbrMetallicRoughness\":{\"metallicFactor\":0},"
        "\"extensions\":{\"KHR_materials_unlit\":{}}}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"COLOR_0\":1},"
        "\"indices\":2,\"material\":0}]}],\"buffers\":[{\"byteLength\":%lld}],"
        "\"bufferViews\":["
        "{\"buffer\":0,\"byteOffset\":0,\"byteLength\":%lld,\"target\":34962},"
        "{\"buffer\":0,\"byteOffset\":%lld,\"byteLength\":%lld,\"target\":34962},"
        "{\"buffer\":0,\"byteOffset\":%lld,\"byteLength\":%lld,\"target\":34963}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":%lld,"
        "\"type\":\"VEC3\",\"min\":[%.9g,%.9g,%.9g],\"max\":[%.9g,%.9g,%.9g]},"
        "{\"bufferView\":1,\"componentType\":5123,\"normalized\":true,\"count\":%lld,"
        "\"type\":\"VEC4\"},{\"bufferView\":2,\"componentType\":5125,\"count\":%lld,"
        "\"type\":\"SCALAR\"}]}",
        tone->exposure, note, right.x, above.x, front.x, right.y, above.y, front.y,
        right.z, above.z, front.z, vec3_dot(right, centre), vec3_dot(above, centre),
        vec3_dot(front, centre), bytes, colours, colours, corners - colours, corners,
        bytes - corners, (long long)vertices, (double)low[0], (double)low[1],
        (double)low[2], (double)high[0], (double)high[1], (double)high[2],
        (long long)vertices, 3 * (long long)faces);
    for (; length % 4 != 0; length++)
        strcpy(text + length, " ");
    return (size_t)length;
}

static void write_colours(struct output *output, const struct shading *shading,
                          const struct tone *tone)
{
    enum { WHITE = 65535 };
    for (int64_t v = 0; v < shading->own_count && !stop_is_asked(); v++)
        for (int c = 0; c < BANDS + 1; c++) {
            double value = c < BANDS ? tone->exposure * shading->values[v].band[c] : 1.0;
            int code = (int)(real_max(0.0, real_min(1.0, value)) * WHITE + 0.5);
            putc(code & 255, output->file);
            putc(code >> 8, output->file);
        }
}

bool glb_write(const struct shading *shading, const struct tone *tone, const char *path,
               struct error *error)
{
    int64_t vertices = shading->own_count, faces = mesh_count(shading->forest);
    int64_t bytes = (POSITION_BYTES + COLOUR_BYTES) * vertices + TRIANGLE_BYTES * faces;
    char text[TEXT_MOST];
    struct output output;
    if (bytes > UINT32_MAX - TEXT_MOST)
        return error_set(error, EXIT_FAILED, "%s: too large for a .glb", path);
    if (!output_open(&output, path, error))
        return false;
    size_t length = describe(shading, tone, vertices, faces, text);
    const uint32_t head[] = {MAGIC, 2, (uint32_t)(HEAD + 2 * CHUNK + length) +
                             (uint32_t)bytes, (uint32_t)length, JSON};
    for (size_t i = 0; i < sizeof head / sizeof head[0]; i++)
        output_uint32(&output, head[i]);
    fwrite(text, 1, length, output.file);
    output_uint32(&output, (uint32_t)bytes);
    output_uint32(&output, BIN);
    for (int64_t v = 0; v < vertices && stop_check(error); v++)
        for (int axis = 0; axis < 3; axis++)
            output_float(&output, (float)vec3_axis(position_of(shading, v), axis));
    write_colours(&output, shading, tone);
    int32_t leaf = mesh_next_leaf(shading->forest, -1);
    for (; leaf >= 0 && stop_check(error); leaf = mesh_next_leaf(shading->forest, leaf))
        for (int k = 0; k < 3; k++)
            output_uint32(&output, (uint32_t)shading->corners[3 * (int64_t)leaf + k]);
    return output_close(&output, error);
}
