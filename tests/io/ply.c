/* Tests of io/scene/ply.h, with io/scene/plyfile.h, io/scene/binary.h and
 * io/scene/palette.h behind it. Binary files are made byte by byte in both orders from
 * one list of values. */
#include "io/scene/ply.h"

#include <stdio.h>
#include <string.h>

#include "io/scene/palette.h"
#include "tests/load.h"
#include "tests/memory.h"
#include "tests/reading.h"
#include "tests/refusal.h"
#include "tests/scenes.h"

#define PLY "build/ply_test.ply"
#define XYZ "property float x\nproperty float y\nproperty float z\n"
#define SQUARE "element vertex 4\n" XYZ
#define FACE(count) "element face " #count "\nproperty list uchar int vertex_indices\n"
#define COLOURS(type) \
    "property " type " red\nproperty " type " green\nproperty " type " blue\n"
#define CORNERS "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
#define ASCII "ply\nformat ascii 1.0\n"

static struct scene *last; /* that was read */

static struct scene *read_bytes(const void *bytes, size_t size)
{
    struct source source;
    scene_destroy(last);
    forget_error();
    bool good = source_of_bytes(&source, PLY, bytes, size, &error);
    last = good ? ply_read(&source, &error) : NULL;
    source_close(&source);
    return last;
}

static struct scene *read_text(const char *text)
{
    return read_bytes(text, strlen(text));
}

/* The bytes are refused with the path and this message. */
static void check_bytes_refused(const void *bytes, size_t size, const char *message)
{
    char line[200];
    snprintf(line, sizeof line, "%s%s", PLY, message);
    check_error(read_bytes(bytes, size), line);
}

static void check_refused(const char *text, const char *message)
{
    check_bytes_refused(text, strlen(text), message);
}

/* True for the unit square, cut into (0, 1, 2) and (0, 2, 3). */
static bool is_square(const struct scene *scene)
{
    return scene && scene->input_count == 2 && corner_is(scene, 0, 0, 0, 0, 0) &&
           corner_is(scene, 0, 1, 1, 0, 0) && corner_is(scene, 0, 2, 1, 1, 0) &&
           corner_is(scene, 1, 0, 0, 0, 0) && corner_is(scene, 1, 1, 1, 1, 0) &&
           corner_is(scene, 1, 2, 0, 1, 0) && scene->groups.count == 1;
}

static void check_square(const char *name, const char *text)
{
    tap_ok(is_square(read_text(text)), "%s%s%s", name, error.code ? ": " : "",
           error.text);
}

static void test_text(void)
{
    check_square("two triangles, vertex_index, other names of types, no last line end",
                 ASCII SQUARE "element face 2\nproperty list uint8 int32 vertex_index\n"
                 "end_header\n" CORNERS "3 0 1 2\n3 0 2 3");
    check_square("faces before vertices",
                 ASCII FACE(1) SQUARE "end_header\n4 0 1 2 3\n" CORNERS);
    check_square("comments, blank lines, CR LF",
                 "ply\r\ncomment made by hand\r\nformat ascii 1.0\r\nobj_info none\r\n"
                 "element vertex 4\r\nproperty double x\r\nproperty double y\r\n"
                 "property double z\r\nelement face 1\r\n"
                 "property list uchar int vertex_indices\r\nend_header\r\n"
                 "0 0 0\r\n1 0 0\r\n\r\n1 1 0\r\n 0\t1 0 \r\n4 0 1 2 3\r\n\r\n");
    check_square("CR alone",
                 "ply\rformat ascii 1.0\relement vertex 4\rproperty int x\r"
                 "property int y\rproperty int z\relement face 1\r"
                 "property list char char vertex_indices\r"
                 "end_header\r0 0 0\r1 0 0\r1 1 0\r0 1 0\r4 0 1 2 3\r");
    check_square("other properties, lists and elements, NaN among them",
                 ASCII "element camera 2\nproperty list int float view\nproperty char c\n"
                 "element vertex 4\nproperty float nx\n" XYZ
                 "property list uchar int more\nelement nothing 1000000000\n"
                 "element face 1\nproperty int flag\n"
                 "property list uchar int vertex_indices\n"
                 "property list uchar float texcoord\nend_header\n2 nan inf 3\n0 7\n"
                 "nan 0 0 0 0\n1 1 0 0 1 9\n1 1 1 0 0\n1 0 1 0 0\n"
                 "5 4 0 1 2 3 2 0.5 0.5\n");
}

/* --- binary files --- */

struct bytes {
    unsigned char data[1000];
    size_t size;
    bool big;
};

static void put(struct bytes *to, uint64_t value, int size)
{
    for (int i = 0; i < size; i++)
        to->data[to->size++] = (unsigned char)(value >> 8 * (to->big ? size - 1 - i : i));
}

static void put_float(struct bytes *to, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(to, bits, 4);
}

static void put_double(struct bytes *to, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(to, bits, 8);
}

static void put_text(struct bytes *to, const char *text)
{
    memcpy(to->data + to->size, text, strlen(text));
    to->size += strlen(text);
}

/* All types, a list to pass over amid a row, first an element without lists. */
static struct bytes make_binary(bool big)
{
    static const float square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    struct bytes file = {.big = big};
    put_text(&file, "ply\nformat ");
    put_text(&file, big ? "binary_big_endian" : "binary_little_endian");
    put_text(&file, " 1.0\nelement first 3\nproperty ushort a\nproperty char b\n"
                    "element vertex 4\nproperty float x\nproperty list ushort double w\n"
                    "property double y\nproperty short z\n"
                    "element face 1\nproperty uchar red\nproperty ushort green\n"
                    "property float blue\nproperty list uint ushort vertex_indices\n"
                    "property float emission_r\nproperty float emission_g\n"
                    "property float emission_b\nend_header\n");
    for (int i = 0; i < 3; i++) {
        put(&file, 0xFFFF, 2);
        put(&file, 0x80, 1);
    }
    for (uint64_t i = 0; i < 4; i++) {
        put_float(&file, square[i][0]);
        put(&file, i % 2, 2);
        if (i % 2)
            put_double(&file, 1e300);
        put_double(&file, (double)square[i][1]);
        put(&file, 0, 2);
    }
    put(&file, 51, 1);
    put(&file, 13107, 2);
    put_float(&file, 0.25f);
    put(&file, 4, 4);
    for (uint64_t i = 0; i < 4; i++)
        put(&file, i, 2);
    put_float(&file, 0.0f);
    put_float(&file, 1000.0f);
    put_float(&file, 0.5f);
    return file;
}

/* Materials that the tests expect. */
static const struct material BY_TYPE = {{{0.2, 0.2, 0.25}}, {{0, 1000, 0.5}}, {{0}}},
                             GREY = {{{0.5, 0.5, 0.5}}, {{0, 0, 0}}, {{0}}},
                             MEAN = {{{1.0 / 3, 0.2, 0.2}}, {{0, 0, 0}}, {{0}}},
                             OWN = {{{0.1, 0.2, 0.3}}, {{0, 0, 0}}, {{0}}},
                             BY_FIFTHS = {{{0.2, 0.4, 0.6}}, {{0, 0, 0}}, {{0}}},
                             GREY_LAMP = {{{0.5, 0.5, 0.5}}, {{5, 6, 7}}, {{0}}};

static void check_material(const struct scene *scene, int32_t triangle,
                           const struct material *expected, const char *name)
{
    bool right = scene != NULL;
    for (int c = 0; right && c < BANDS; c++) {
        const struct material *found = &scene->materials[scene->material_of[triangle]];
        right =
            fabs(found->reflectance.band[c] - expected->reflectance.band[c]) < 1e-15 &&
            found->emission.band[c] == expected->emission.band[c];
    }
    tap_ok(right, "%s%s", name, error.text);
}

static void test_binary(void)
{
    for (int big = 0; big < 2; big++) {
        struct bytes file = make_binary(big);
        struct scene *scene = read_bytes(file.data, file.size);
        tap_ok(is_square(scene), "binary, %s endian: %s", big ? "big" : "little",
               error.text);
        check_material(scene, 1, &BY_TYPE, "colours by type, emission as it is");
    }
}

/* Cut off anywhere it is an error, and with a byte too many. */
static void test_lengths(void)
{
    struct bytes file = make_binary(false);
    int accepted = 0;
    for (size_t size = 0; size < file.size; size++) {
        struct scene *scene = read_bytes(file.data, size);
        accepted += scene != NULL;
    }
    tap_ok(accepted == 0, "cut off at every byte");
    put(&file, 1, 1);
    check_bytes_refused(file.data, file.size,
                        ": 1 bytes are left behind the last element");
}

/* A number in the binary square is replaced; the message says which element is wrong. */
static void check_patched(size_t from_end, unsigned char byte, const char *message)
{
    struct bytes file = make_binary(false);
    file.data[file.size - from_end] = byte;
    check_bytes_refused(file.data, file.size, message);
}

static void test_binary_errors(void)
{
    check_patched(13, 1, ": face 0: corner 259, but the last vertex is 3");
    check_patched(24, 2, ": face 0: 2 corners instead of 3 to 16384");
    check_patched(21, 0x7F, ": the file ends in face 0");
    check_patched(5, 0xC4, ": face 0: a negative colour or emission");
    check_patched(92, 0x7F, ": vertex 1: a number is not finite or out of range");
}

static void test_colours(void)
{
    struct scene *scene =
        read_text(ASCII SQUARE FACE(1) "end_header\n" CORNERS "4 0 1 2 3\n");
    check_material(scene, 0, &GREY, "no colours: grey");
    scene = read_text(ASCII SQUARE COLOURS("uchar") FACE(3) COLOURS("double")
                      "end_header\n0 0 0 255 0 51\n1 0 0 0 0 51\n1 1 0 0 153 51\n"
                      "0 1 0 0 0 0\n3 0 1 2 0.1 0.2 0.3\n"
                      "3 2 3 0 0.5 0.5 0.5\n3 0 1 3 0.1 0.2 0.3\n");
    check_material(scene, 0, &OWN, "colours of faces come first");
    tap_ok(scene && scene->material_count == 2 &&
               scene->material_of[2] == scene->material_of[0],
           "faces of one colour share a material");
    scene = read_text(ASCII SQUARE FACE(2)
                      "property float emission_r\nproperty float emission_g\n"
                      "property float emission_b\nend_header\n" CORNERS
                      "3 0 1 2 5 6 7\n3 0 2 3 0 0 0\n");
    check_material(scene, 0, &GREY_LAMP, "a lamp without colours");
}

/* Colours by each of their names, of vertices and of faces; others beside them are
 * passed over. */
static void test_names_of_colours(void)
{
    static const char *const NAMES[][BANDS] = {
        {"r", "g", "b"},
        {"diffuse_red", "diffuse_green", "diffuse_blue"},
        {"color_0", "color_1", "color_2"}};
    for (size_t i = 0; i < sizeof NAMES / sizeof NAMES[0]; i++) {
        char colours[200], text[600];
        snprintf(colours, sizeof colours,
                 "property float alpha\nproperty uchar %s\nproperty uchar %s\n"
                 "property uchar %s\n", NAMES[i][0], NAMES[i][1], NAMES[i][2]);
        snprintf(text, sizeof text,
                 ASCII SQUARE "%s" FACE(2) "end_header\n0 0 0 1 255 0 51\n"
                 "1 0 0 1 0 0 51\n1 1 0 1 0 153 51\n0 1 0 1 0 0 0\n3 0 1 2\n3 2 3 0\n",
                 colours);
        struct scene *scene = read_text(text);
        check_material(scene, 0, &MEAN, NAMES[i][0]);
        snprintf(text, sizeof text,
                 ASCII SQUARE FACE(2) "%s" "end_header\n" CORNERS
                 "3 0 1 2 1 51 102 153\n3 2 3 0 1 0 0 0\n", colours);
        scene = read_text(text);
        check_material(scene, 0, &BY_FIFTHS, "the same of faces");
    }
    struct scene *scene = read_text(
        ASCII SQUARE "property float r\n" COLOURS("uchar") FACE(2) "end_header\n"
        "0 0 0 9 255 0 51\n1 0 0 9 0 0 51\n1 1 0 9 0 153 51\n0 1 0 9 0 0 0\n"
        "3 0 1 2\n3 2 3 0\n");
    check_material(scene, 0, &MEAN, "a radius r beside red");
}

/* Triangle i of a strip is (i, i + 1, i + 2), every other one turned over, so that all
 * face up. */
static void test_strips(void)
{
    static const char head[] =
        ASCII "element vertex 6\n" XYZ COLOURS("uchar")
        "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
        "0 0 0 255 0 51\n1 0 0 0 0 51\n0 1 0 0 153 51\n1 1 0 0 0 0\n0 2 0 0 0 0\n"
        "1 2 0 0 0 0\n";
    char text[600];
    snprintf(text, sizeof text, "%s11 0 1 2 3 4 -1 -1 2 3 4 5\n", head);
    struct scene *scene = read_text(text);
    bool up = scene && scene->input_count == 5;
    for (int32_t i = 0; up && i < 5; i++)
        up = triangle_plane(&scene->triangles[i]).normal.z > 0.0;
    tap_ok(up, "a strip that starts again: 5 triangles, which face up%s", error.text);
    tap_ok(up && corner_is(scene, 1, 0, 0, 1, 0) && corner_is(scene, 1, 1, 1, 0, 0) &&
               corner_is(scene, 1, 2, 1, 1, 0) && corner_is(scene, 3, 0, 0, 1, 0) &&
               corner_is(scene, 4, 2, 1, 2, 0),
           "their corners");
    check_material(scene, 0, &MEAN, "the colours of its vertices");
    snprintf(text, sizeof text, "%s3 0 1 6\n", head);
    check_refused(text, ":19: corner 6, but the last vertex is 5");
    snprintf(text, sizeof text, "%s3 0 1 -2\n", head);
    check_refused(text, ":19: a corner is not the number of a vertex");
    check_refused(ASCII SQUARE "element tristrips 0\nproperty list int int vertex_index\n"
                  "end_header\n" CORNERS, ": no faces with vertex_indices");
}

/* An arrow head: corner 3 is concave; the fan from corner 0 is right, one from 1
 * wrong. */
static void test_concave(void)
{
    struct scene *scene =
        read_text(ASCII "element vertex 4\n" XYZ FACE(1)
                  "end_header\n1 3 0\n0 0 0\n1 1 0\n2 0 0\n4 1 2 3 0\n");
    double area = 0.0;
    for (int32_t i = 0; scene && i < scene->input_count; i++)
        area += triangle_area(&scene->triangles[i]);
    tap_ok(fabs(area - 2.0) < 1e-12, "a concave face");
}

static void test_palette(void)
{
    struct palette palette = {0};
    bool right = true;
    for (int round = 0; round < 2; round++)
        for (int i = 0; i < 5000; i++) {
            struct material material = {
                {{i % 17 / 17.0, i / 17, 0.5}}, {{0, 0, i % 3}}, {{0}}};
            right = palette_add(&palette, &material) == i && right;
        }
    tap_ok(right && palette.count == 5000, "5000 materials keep their numbers");
    struct material minus = {{{0.0, 0.0, 0.5}}, {{-0.0, 0, 0}}, {{0}}};
    tap_ok(palette_add(&palette, &minus) == 0, "-0 is 0");
    palette_free(&palette);
}

static void test_header_errors(void)
{
    check_refused("plyx\n", ": not a PLY file");
    check_refused("ply\n", ":1: the header has no end");
    check_refused("ply\nend_header\n", ":2: no format before 'end_header'");
    check_refused("ply\nformat ebcdic 1.0\n", ":2: unknown format 'ebcdic'");
    check_refused("ply\nformat ascii 2.0\n", ":2: unknown version of the format '2.0'");
    check_refused(ASCII "format ascii 1.0\n", ":3: a second format 'ascii'");
    check_refused(ASCII "hello\n", ":3: unknown line of the header: 'hello'");
    check_refused(ASCII "element vertex -1\n", ":3: bad number of elements '-1'");
    check_refused(ASCII "element vertex\n", ":3: bad number of elements ''");
    check_refused(ASCII "property float x\n",
                  ":3: a property before any element: 'float x'");
    check_refused(ASCII SQUARE "property real w\n", ":7: bad property 'w'");
    check_refused(ASCII SQUARE "property list float int w\n", ":7: bad property 'w'");
    check_refused(ASCII SQUARE "property float x\n", ":7: a second property 'x'");
    check_refused(ASCII SQUARE SQUARE, ":7: a second element 'vertex'");
    check_refused(ASCII "element face 1\nproperty int vertex_index\n",
                  ":4: the wrong kind of property for 'vertex_index'");
    check_refused(ASCII "element face 1\nproperty list int float vertex_index\n",
                  ":4: the wrong kind of property for 'vertex_index'");
    check_refused(ASCII FACE(1) "end_header\n3 0 1 2\n", ": no vertices with x, y and z");
    check_refused(ASCII SQUARE "end_header\n" CORNERS, ": no faces with vertex_indices");
    check_refused(ASCII "element vertex 1000000000000\n" XYZ FACE(1) "end_header\n",
                  ":3: the file is too short for 1000000000000 elements of this kind");
}

/* Values behind the last of a line change nothing, and are counted. */
static void test_long_lines(void)
{
    static const char TEXT[] =
        ASCII SQUARE FACE(2) "end_header\n0 0 0\n1 0 0 7 0.5\n1 1 0\n0 1 0 nan\n"
                             "3 0 1 2 3\n3 0 2 3\n";
    struct source source;
    struct ply_file file;
    forget_error();
    struct scene *scene = NULL;
    if (source_of_bytes(&source, PLY, TEXT, sizeof TEXT - 1, &error) &&
        ply_file_open(&file, &source, &error))
        scene = ply_of_file(&file, &error);
    source_close(&source);
    tap_ok(scene && is_square(scene) && file.long_lines == 3 && file.first_long == 11,
           "three lines with more values than the header says, from line %ld on: %s",
           file.first_long, error.text);
    ply_file_close(&file);
    scene_destroy(scene);
}

static void test_row_errors(void)
{
    static const char *const VERTICES[][2] = {
        {"1 0 nan", ":11: bad number 'nan'"},
        {"1 0 1e200", ":11: a number is not finite or out of range"},
        {"1 0", ":11: fewer values than the header says"}};
    static const char *const FACES[][2] = {
        {"3 0 1 4", ":14: corner 4, but the last vertex is 3"},
        {"3 0 1 -1", ":14: a corner is not the number of a vertex"},
        {"3 0 1 1.5", ":14: a corner is not the number of a vertex"},
        {"-3 0 1 2", ":14: the length of a list is not a natural number"},
        {"2 0 1", ":14: 2 corners instead of 3 to 16384"},
        {"4000000000 0 1", ":14: fewer values than the header says"},
        {" ", ": the file ends in face 0"},
        {"3 0 1 2\n3 0 2 3", ": 8 bytes are left behind the last element"}};
    char text[400];
    for (size_t i = 0; i < sizeof VERTICES / sizeof VERTICES[0]; i++) {
        snprintf(text, sizeof text, ASCII SQUARE FACE(1)
                 "end_header\n0 0 0\n%s\n1 1 0\n0 1 0\n3 0 1 2\n", VERTICES[i][0]);
        check_refused(text, VERTICES[i][1]);
    }
    for (size_t i = 0; i < sizeof FACES / sizeof FACES[0]; i++) {
        snprintf(text, sizeof text, ASCII SQUARE FACE(1) "end_header\n" CORNERS "%s\n",
                 FACES[i][0]);
        check_refused(text, FACES[i][1]);
    }
    check_refused(ASCII SQUARE FACE(1)
                  COLOURS("float") "end_header\n" CORNERS "3 0 1 2 0 -0.1 0\n",
                  ":17: a negative colour or emission");
}

/* Reads a file if it is to be read as PLY, and tells that in `is_ply`. */
static struct scene *read_source(const char *path, bool *is_ply)
{
    struct source source;
    forget_error();
    *is_ply = source_open(&source, path, &error) && ply_is_meant(&source);
    scene_destroy(last);
    last = *is_ply ? ply_read(&source, &error) : NULL;
    source_close(&source);
    return last;
}

static void test_choice(void)
{
    static const char text[] = ASCII SQUARE FACE(1) "end_header\n" CORNERS "4 0 1 2 3\n";
    bool is_ply;
    write_text("build/ply_test.mesh", text);
    struct scene *scene = read_source("build/ply_test.mesh", &is_ply);
    tap_ok(is_ply && is_square(scene), "another name, the content of PLY: read whole");
    static const char *const OTHERS[] = {"v 0 0 0\n", "ply", "plyx", ""};
    for (size_t i = 0; i < sizeof OTHERS / sizeof OTHERS[0]; i++) {
        write_text("build/ply_test.mesh", OTHERS[i]);
        read_source("build/ply_test.mesh", &is_ply);
        tap_ok(!is_ply, "another name, other content: %s", OTHERS[i]);
    }
    const struct source meant = {.path = "a.PLY", .start = "v 0"},
                        other = {.path = "a.obj", .start = "ply\n"};
    tap_ok(ply_is_meant(&meant) && !ply_is_meant(&other), "names come before contents");
    tap_ok(!read_source("build/ply_test_absent.ply", &is_ply) && !is_ply &&
               error.code == EXIT_USAGE,
           "a missing file: %s", error.text);
    remove("build/ply_test.mesh");
}

int main(void)
{
    test_text();
    test_binary();
    test_lengths();
    test_binary_errors();
    test_colours();
    test_names_of_colours();
    test_strips();
    test_concave();
    test_palette();
    test_header_errors();
    test_long_lines();
    test_row_errors();
    test_choice();
    scene_destroy(last);
    return tap_done();
}
