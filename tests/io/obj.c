/* Tests of io/scene/obj.h, with io/scene/mtl.h and io/scene/text.h behind it. Files are
 * written into build/. */
#include "io/scene/obj.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "geom/alloc.h"
#include "io/scene/text.h"
#include "tests/load.h"
#include "tests/reading.h"
#include "tests/refusal.h"
#include "tests/scenes.h"

#define OBJ "build/obj_test.obj"
#define MTL "build/obj_test.mtl"
#define STL "build/obj_test.STL"
#define OTHER "build/obj test two.mtl"
#define CORNERS "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

static struct obj_repairs repairs;
static struct scene *last; /* that was read */

static struct scene *read_scene(const char *text)
{
    scene_destroy(last);
    forget_error();
    write_text(OBJ, text);
    return last = obj_read(OBJ, &repairs, &error);
}

static void check_refused(const char *text, const char *message)
{
    check_error(read_scene(text), message);
}

/* A library is refused with this line by an OBJ file that is right. */
static void check_library_refused(const char *library, const char *message)
{
    write_text(MTL, library);
    check_refused("mtllib obj_test.mtl\n" CORNERS "f 1 2 3\n", message);
}

/* Whether the text is one or more triangles, each (0,0,0), (1,0,0), (1,1,0). */
static void check_triangle(const char *name, const char *text)
{
    struct scene *scene = read_scene(text);
    bool right = scene && scene->input_count > 0;
    for (int32_t i = 0; right && i < scene->input_count; i++)
        right = corner_is(scene, i, 0, 0, 0, 0) && corner_is(scene, i, 1, 1, 0, 0) &&
                corner_is(scene, i, 2, 1, 1, 0);
    tap_ok(right, "%s%s%s", name, error.code ? ": " : "", error.text);
}

static bool colour_is(struct rgb colour, double red, double green, double blue)
{
    return colour.band[0] == red && colour.band[1] == green && colour.band[2] == blue;
}

static const struct material *material_at(const struct scene *scene, int32_t triangle)
{
    return &scene->materials[scene->material_of[triangle]];
}

/* Lines, words and numbers themselves: tests/io/text.c. */
static void test_lines(void)
{
    check_triangle("blanks, comments, continuation, no last newline",
                   "\n \t\n # one\n  v\t0 0 \\\n0 \nv\\\r\n1 0 0\t\n\tv 1 1 0\n\n"
                   " f 1 \\\r2 3 # three\n#");
    check_refused("v 1 2 3\nv 1 \\\n2 \\\nz\n", OBJ ":2: bad number 'z'");
}

static void test_long_file(void)
{
    enum { LINES = 100000 };
    static const char line[] = "# sixteen bytes\n", end[] = CORNERS "f 1 2 3\nf 1 2 9\n";
    size_t length = LINES * (sizeof line - 1);
    char *text = alloc_array(length + sizeof end, 1);
    for (size_t i = 0; i < LINES; i++)
        memcpy(text + i * (sizeof line - 1), line, sizeof line - 1);
    memcpy(text + length, end, sizeof end);
    check_refused(text, OBJ ":100006: face refers to vertex 9 of 4");
    *strstr(text + length, "f 1 2 9") = '#';
    check_triangle("a file of many blocks", text);
    alloc_free(text);
}

static void test_vertices(void)
{
    struct scene *scene =
        read_scene("v 1e3 -.5 2.\nv +4 5 6 1.0\nv 7 8 9 0.1 .2 .3 x\nf 1 2 3\n");
    tap_ok(scene && corner_is(scene, 0, 0, 1000, -0.5, 2) &&
               corner_is(scene, 0, 1, 4, 5, 6) && corner_is(scene, 0, 2, 7, 8, 9),
           "coordinates; more numbers behind them are passed over");
    check_triangle("unknown keywords",
                   "vt 0 0\nvn x y z\ns off\nl 1 2\np 1\no thing\ng a b\nfo\n"
                   "\xC3\xA9t\xC3\xA9\nvp 1\ncall x.obj\n" CORNERS "f 1 2 3\n");
    tap_ok(repairs.unknown_lines == 3 && repairs.first_unknown == 8,
           "of which those that may mean something are counted");
    check_refused("v 1 2\n", OBJ ":1: vertex has 2 coordinates instead of 3");
    check_refused("v 1 2 3\nv nan 0 0\n", OBJ ":2: bad number 'nan'");
}

static void test_corners(void)
{
    static const char *const ABSENT[] = {"0", "5", "-5", "4294967297",
                                         "18446744073709551617",
                                         "-99999999999999999999999"};
    static const char *const BAD[] = {"3.0", "x", "-", "/3", "3/1/1/1", "3/a", "1//1a"};
    char text[200], message[200];
    check_triangle("v/vt, v//vn, v/vt/vn, v/, v//, v/vt/",
                   CORNERS "f 1/1 2//-2 +3/3/9\nf 1/ 2// 3/1/\n");
    check_triangle(
        "negative indices count from their line",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 5 5 5\nf -4 -3 -2\nf 1/1 -3//1 3\n");
    for (size_t i = 0; i < sizeof ABSENT / sizeof ABSENT[0]; i++) {
        snprintf(text, sizeof text, CORNERS "\nf 1 %s/1 2\n", ABSENT[i]);
        snprintf(message, sizeof message, OBJ ":6: face refers to vertex %s of 4",
                 ABSENT[i]);
        check_refused(text, message);
    }
    check_refused("f 1 2 3\n" CORNERS, OBJ ":1: face refers to vertex 1 of 0");
    for (size_t i = 0; i < sizeof BAD / sizeof BAD[0]; i++) {
        snprintf(text, sizeof text, CORNERS "f 1 2 %s\n", BAD[i]);
        snprintf(message, sizeof message, OBJ ":5: bad corner '%s' of a face", BAD[i]);
        check_refused(text, message);
    }
    check_refused(CORNERS "f 1 2\n", OBJ ":5: face has 2 corners instead of 3 or more");
}

static bool normal_is(const struct scene *scene, int32_t triangle, int k, double x,
                      double y, double z)
{
    struct vec3 n = scene->normals[3 * triangle + k];
    return vec3_length(vec3_sub(n, (struct vec3){x, y, z})) < 1e-15;
}

static void test_normals(void)
{
    struct scene *scene = read_scene(CORNERS "vn 0 0 2\nvn 3 0 4 # not of length 1\n"
                                     "f 1//1 2//2 3//-1\nvn 1e-90 0 0\nf 1 2/7/-1 3/7\n"
                                     "f 1//2 2//2 3//2 4//1\n");
    tap_ok(scene && scene->normals && normal_is(scene, 0, 0, 0, 0, 1) &&
               normal_is(scene, 0, 1, 0.6, 0, 0.8) &&
               normal_is(scene, 0, 2, 0.6, 0, 0.8) && normal_is(scene, 1, 0, 0, 0, 0) &&
               normal_is(scene, 1, 1, 1, 0, 0) && normal_is(scene, 1, 2, 0, 0, 0) &&
               normal_is(scene, 2, 2, 0.6, 0, 0.8) && normal_is(scene, 3, 2, 0, 0, 1) &&
               repairs.bad_normals == 0,
           "normals, where corners have some");
    scene = read_scene(CORNERS "vn 0 0 1\nf 1 2 3\nf 1//2 2//0 3//-2\n");
    tap_ok(scene && !scene->normals && repairs.bad_normals == 3,
           "normals that are not there");
    scene = read_scene(
        CORNERS "vn 0 0 0\nvn nan nan nan\nvn -1.#IND 0 1\nvn 1 0\nvn\nvn 1e101 0 0\n"
                "vn 1e-101 0 0\nvn x y z\nf 1//1 2//2 3//3 4//4\nf 1//5 2//6 3//7\n");
    tap_ok(scene && !scene->normals && repairs.bad_normals == 7 &&
               repairs.unknown_lines == 0,
           "normals without a direction");
}

/* Colours behind coordinates. */
static void test_colours(void)
{
    static const char coloured[] = "v 0 0 0 0 .5 0\nv 1 0 0 1 .5 0\nv 1 1 0 .5 .5 0\n"
                                   "v 0 1 0 .5 .5 1\nv 0 2 0\nv 0 3 0 1 -1 0\n"
                                   "v 0 4 0 1 1\nv 0 5 0 1 1 1 1\nv 0 6 0 .9\n";
    char text[400];
    write_text(MTL, "newmtl wall\nKd .75 0 0\nnewmtl lamp\nKe 1 2 3\n");
    snprintf(text, sizeof text,
             "mtllib obj_test.mtl\n%susemtl wall\nf 1 2 3 4\nf 2 3 5\nf 2 3 6\nf 2 3 7\n"
             "f 2 3 8\nf 2 3 9\nusemtl lamp\nf 1 2 3 4\nusemtl wall\nf 4 3 2 1\n",
             coloured);
    struct scene *scene = read_scene(text);
    tap_ok(scene && colour_is(material_at(scene, 0)->reflectance, 0.5, 0.5, 0.25) &&
               scene->material_of[1] == scene->material_of[0] &&
               scene->material_of[9] == scene->material_of[0],
           "the mean of the corners' colours%s", error.text);
    bool named = scene != NULL;
    for (int32_t i = 2; named && i < 7; i++)
        named = colour_is(material_at(scene, i)->reflectance, 0.75, 0, 0);
    tap_ok(named, "Kd where a corner has none");
    tap_ok(scene && colour_is(material_at(scene, 7)->reflectance, 0.5, 0.5, 0.25) &&
               colour_is(material_at(scene, 7)->emission, 1, 2, 3),
           "a lamp with a colour");
    tap_ok(repairs.unknown_lines == 3 && repairs.first_unknown == 7,
           "numbers that are neither colour nor weight are counted");
}

static void test_polygons(void)
{
    struct scene *scene = read_scene(CORNERS "f 3 3 3\nf 1 2 3 4\nf 4 3 2\n");
    tap_ok(scene && scene->input_count == 4 && corner_is(scene, 0, 0, 1, 1, 0) &&
               corner_is(scene, 0, 1, 1, 1, 0) && corner_is(scene, 0, 2, 1, 1, 0),
           "a face with repeated corners keeps its number");
    tap_ok(scene && corner_is(scene, 1, 1, 1, 0, 0) && corner_is(scene, 2, 1, 1, 1, 0) &&
               corner_is(scene, 2, 2, 0, 1, 0) && corner_is(scene, 3, 0, 0, 1, 0),
           "its triangles follow one another");
}

/* One face of 1000 corners: a strip 2.5 wide that winds about the origin four times. The
 * area of all triangles is that of the polygon: none lies outside or over another. */
static void test_spiral(void)
{
    enum { HALF = 500 };
    char *text = alloc_array(2 * HALF * 60, 1), *to = text;
    double expected = 0.0, area = 0.0;
    for (int i = 0; i < 2 * HALF; i++) {
        double turn = 0.05 * (i < HALF ? i : 2 * HALF - 1 - i),
               r = turn + (i < HALF ? 3.5 : 1.0);
        to += sprintf(to, "v %.17g %.17g 5\n", r * cos(turn), r * sin(turn));
    }
    *to++ = 'f';
    for (int i = 1; i <= 2 * HALF; i++)
        to += sprintf(to, " %d", i);
    struct scene *scene = read_scene(text);
    bool right = scene && scene->input_count == 2 * HALF - 2;
    for (int32_t i = 0; right && i < scene->input_count; i++) {
        struct vec3 cross = triangle_cross(&scene->triangles[i]);
        area += 0.5 * fabs(cross.z);
        expected += 0.5 * cross.z;
    }
    tap_ok(right && expected > 2.5 * 25 * 10 && fabs(area / expected - 1.0) < 1e-12,
           "a spiral of %d corners is cut inside", 2 * HALF);
    alloc_free(text);
}

static void test_many_corners(void)
{
    enum { CORNER_LIMIT = 16384 };
    static const char start[] = CORNERS "f";
    char *text = alloc_array(sizeof start + 2 * (CORNER_LIMIT + 1), 1);
    strcpy(text, start);
    for (int i = 0; i <= CORNER_LIMIT; i++)
        memcpy(text + sizeof start - 1 + 2 * i, " 1", 2);
    check_refused(text, OBJ ":5: face of more than 16384 corners");
    text[sizeof start - 1 + 2 * CORNER_LIMIT] = '\0';
    struct scene *scene = read_scene(text);
    tap_ok(scene && scene->input_count == CORNER_LIMIT - 2, "a face of %d equal corners",
           (int)CORNER_LIMIT);
    alloc_free(text);
}

static void test_materials(void)
{
    write_text(MTL,
               "# library\nnewmtl red brick \r\nKa 1 1 1\nKd .8 .1 0\nKs 1 1 1\n"
               "map_Kd a b.png\nnewmtl lamp\nkd 0.25\nKE 17 12 4 1\nillum 2\n"
               "newmtl bright\nKd 1.5 1 1\n"
               "newmtl spectral\nKd spectral file.rfl 1\n\tnewmtl\ttwice\n"
               "Kd 1 0 0\nKe 1 # one\nnewmtl twice\nKe 3\nnewmtl unused\nKd 9\n");
    struct scene *scene = read_scene(
        CORNERS
        "f 1 2 3\nusemtl red brick\nmtllib obj_test.mtl\nf 1 2 3 4\nusemtl  lamp \n"
        "f 1 2 3\nusemtl bright\nf 1 2 3\nusemtl red brick\nf 1 2 3\nusemtl spectral\n"
        "f 1 2 3\nusemtl twice\nf 1 2 3\nusemtl\nf 1 2 3\n");
    if (!tap_ok(scene && scene->input_count == 9, "a scene with materials %s",
                error.text))
        return;
    const struct material *grey = material_at(scene, 0);
    tap_ok(colour_is(grey->reflectance, 0.5, 0.5, 0.5) &&
               colour_is(grey->emission, 0, 0, 0) && material_at(scene, 8) == grey &&
               scene->material_count == 6,
           "faces without a material are grey; no other materials than used ones");
    tap_ok(colour_is(material_at(scene, 1)->reflectance, 0.8, 0.1, 0.0) &&
               colour_is(material_at(scene, 1)->emission, 0, 0, 0) &&
               material_at(scene, 2) == material_at(scene, 1) &&
               material_at(scene, 5) == material_at(scene, 1),
           "a name with a blank, used before its library");
    tap_ok(colour_is(material_at(scene, 3)->reflectance, 0.25, 0.25, 0.25) &&
               colour_is(material_at(scene, 3)->emission, 17, 12, 4),
           "kd with one number, KE with four");
    tap_ok(colour_is(material_at(scene, 4)->reflectance, 1.5, 1, 1),
           "Kd of 1 and more is left");
    tap_ok(colour_is(material_at(scene, 7)->reflectance, 0, 0, 0) &&
               colour_is(material_at(scene, 7)->emission, 3, 3, 3),
           "the later of two definitions counts");
    tap_ok(repairs.materials.count == 0 && repairs.libraries.count == 0 &&
               repairs.materials.first[0] == '\0' && repairs.libraries.first[0] == '\0',
           "nothing is missing");
}

static void test_notes(void)
{
    write_text(MTL,
               "newmtl opaque\nKd 1 1 1\nd 1.0\nTr 1.0\nnewmtl also opaque\nTr 1\nd 1\n"
               "newmtl clear\nd 0.5\nnewmtl glass\nTr 0.25\nnewmtl halo\nd -halo 0.5\n"
               "newmtl words\nd\nTr none\nnewmtl painted\nmap_Kd a b.png\n"
               "newmtl dyed\nmap_Kd x.png\nKd 0.25 0 0\nnewmtl dyed too\nKd 0.25 0 0\n"
               "map_Kd x.png\nnewmtl unused\nd 0\nmap_Kd x.png\nKd xyz 1\n"
               "newmtl lit\nKd xyz 1\nKd 0.25 0 0\nKe 1 0 0\nKe Spectral x.rfl\n"
               "newmtl dim\nKe xyz 1 1 1\n");
    struct scene *scene = read_scene(
        "mtllib obj_test.mtl\n" CORNERS
        "usemtl opaque\nf 1 2 3\nusemtl also opaque\nf 1 2 3\n"
        "usemtl clear\nf 1 2 3\nf 1 2 3\nusemtl glass\nf 1 2 3\nusemtl halo\nf 1 2 3\n"
        "usemtl words\nf 1 2 3\nusemtl painted\nf 1 2 3\nusemtl dyed\nf 1 2 3\n"
        "usemtl dyed too\nf 1 2 3\nusemtl lit\nf 1 2 3\nusemtl dim\nf 1 2 3\n");
    tap_ok(scene && repairs.panes == 3 && !repairs.all_panes,
           "materials of panes that are used are counted");
    tap_ok(scene && !material_is_pane(material_at(scene, 0)) &&
               !material_is_pane(material_at(scene, 1)) &&
               colour_is(material_at(scene, 2)->transmittance, 0.5, 0.5, 0.5) &&
               colour_is(material_at(scene, 4)->transmittance, 0.25, 0.25, 0.25),
           "they let 1 - d through, or Tr; d counts where Tr contradicts it");
    tap_ok(scene && repairs.textured == 3 &&
               colour_is(material_at(scene, 7)->reflectance, 0.5, 0.5, 0.5) &&
               colour_is(material_at(scene, 8)->reflectance, 0.25, 0, 0) &&
               colour_is(material_at(scene, 9)->reflectance, 0.25, 0, 0),
           "textures too; without Kd they are grey");
    tap_ok(scene && repairs.unread == 2 &&
               colour_is(material_at(scene, 10)->reflectance, 0.25, 0, 0) &&
               colour_is(material_at(scene, 10)->emission, 1, 0, 0) &&
               colour_is(material_at(scene, 11)->reflectance, 0, 0, 0),
           "spectral and xyz too; beside them numbers count");
}

/* Finds the mean of pictures called found.png beside the library. */
static bool mean_of(const char *path, const struct map_part *parts, int64_t count,
                    struct rgb *means, struct error *reason)
{
    means[count] = (struct rgb){{0.5, 0.25, 0}};
    for (int64_t i = 0; i < count; i++) /* any numbers: the first coordinate */
        means[i] = (struct rgb){{parts[i].at[0][0], parts[i].at[0][0], 0}};
    return strcmp(path, "build/found.png") == 0 || strcmp(path, "build/a/b c.png") == 0 ||
           error_set(reason, EXIT_USAGE, "%s: no picture", path);
}

static void test_textures(void)
{
    static const double EXPECTED[][6] = {
        {.25, .125, 0}, {.5, .25, 0}, {.5, .25, 0, 1, .25, 0}, {0, 0, 0, .5, .25, 0},
        {.5, .5, .5},   {.25, 0, 0},  {.5, .5, .5}, {.75, 1, 1, 2, 2, 2}, {.25, .125, 0},
        {.5, .5, .5}};
    char text[400] = "mtllib obj_test.mtl\n" CORNERS;
    write_text(MTL,
               "newmtl a\nKd .5 .5 .5\nmap_Kd found.png\nnewmtl b\nmap_kd found.png\n"
               "newmtl c\nKe 2 1 1\nKd 1 1 1\nmap_Ke found.png\nmap_Kd -s 1 2 3 "
               "-clamp on -mm 0 1 a\\b c.png\nnewmtl d\nmap_Ke -o 1 found.png\n"
               "newmtl e\nKd 1 1 1\n"
               "map_Kd lost.png\nnewmtl f\nKd .25 0 0\nmap_Kd lost.png\nnewmtl g\n"
               "map_Kd x y.jpg\nnewmtl h\nKd .75 1 1\nKe 2\nmap_Ke lost.png\n"
               "map_Kd lost.png\nnewmtl i\nKd xyz 1 1 1\nmap_Kd found.png\n"
               "newmtl j\nKd 1.5\nmap_Kd lost.png\nnewmtl unused\nmap_Kd lost.png\n");
    for (char name = 'a'; name <= 'j'; name++)
        sprintf(text + strlen(text), "usemtl %c\nf 1 2 3\n", name);
    struct text_names files = {0};
    repairs.files = &files;
    repairs.mean_of = mean_of;
    struct scene *scene = read_scene(text);
    for (int32_t i = 0; scene && i < 10; i++) {
        const double *e = EXPECTED[i];
        tap_ok(colour_is(material_at(scene, i)->reflectance, e[0], e[1], e[2]) &&
                   colour_is(material_at(scene, i)->emission, e[3], e[4], e[5]),
               "texture of material %c", 'a' + i);
    }
    tap_ok(scene && repairs.textured == 10 && repairs.textures.count == 6 &&
               strcmp(repairs.textures.first, "build/lost.png") == 0,
           "pictures that are not found are counted%s", error.text);
    tap_ok(files.count == 5 && strcmp(files.name[1], "build/found.png") == 0,
           "the paths of all are told");
    text_names_free(&files);
    repairs.files = NULL;
    scene = read_scene("mtllib obj_test.mtl\n" CORNERS "vt .5\nvt .5625\nvt .1\nvt .7\n"
                       "v 0 0 9\nv 1 0 9\nv 1 1 9\nusemtl a\nf 1/1 2/1 3/1\n"
                       "f -3/2 -2/2 -1/2\nusemtl b\nf 1/1 2/1 3/1\nf -3/3 -2/3 -1/3\n"
                       "f 1 2 3\nusemtl d\nf 1/1 2/1 3/1\nf 1/4 2/4 3/4\n");
    const double mean = 0.265625; /* half of the mean of .5 and .5625 */
    tap_ok(scene && colour_is(material_at(scene, 0)->reflectance, mean, mean, 0) &&
               colour_is(material_at(scene, 1)->reflectance, mean, mean, 0),
           "faces that are nearly alike have their mean by area");
    tap_ok(scene && colour_is(material_at(scene, 2)->reflectance, 0.5, 0.5, 0) &&
               colour_is(material_at(scene, 3)->reflectance, 0.1, 0.1, 0) &&
               colour_is(material_at(scene, 4)->reflectance, 0.5, 0.25, 0),
           "others their own, those without coordinates the whole picture's");
    tap_ok(scene && colour_is(material_at(scene, 5)->emission, 0.6, 0.6, 0) &&
               colour_is(material_at(scene, 6)->emission, 0.6, 0.6, 0),
           "lamps have one light");
    repairs = (struct obj_repairs){0};
}

/* Statements that are passed over, but for those that say what is so anyway. */
static void test_passed(void)
{
    write_text(MTL, "newmtl a\nKa .5 .5 .5\nKs 0 0 0\nNs 250\nNi 1.45\nd 1\nillum 2\n"
                    "Tf 1 1 1\nPr .5\nPm 0\nsharpness 60\n");
    struct scene *scene =
        read_scene("mtllib obj_test.mtl\n" CORNERS "s off\nusemtl a\nf 1 2 3\ns 0\n");
    tap_ok(scene && repairs.passed_count == 0 && repairs.unknown_lines == 0,
           "of statements that say what is so no word is said: %s", repairs.passed);
    write_text(MTL, "newmtl a\nKs .5 .5 .5\nillum 3\nTf .5 1 1\nPm 1\nnorm n.png\n"
                    "bump -bm 2 b.png\nmap_Bump b.png\nKs 1 1 1\nillum x\nhello\n");
    scene = read_scene("mtllib obj_test.mtl\n" CORNERS
                       "s 1\nusemtl a\nf 1 2 3\nusemap x\nbevel on\n");
    tap_ok(scene && repairs.passed_count == 7 &&
               strcmp(repairs.passed, "Ks illum Pm norm bump map_Bump hello") == 0,
           "others are named: %s", repairs.passed);
    tap_ok(repairs.unknown_lines == 3 && repairs.first_unknown == 6,
           "as are settings of an OBJ that would change light or picture");
    scene = read_scene(CORNERS "vn 0 0 1\ns 1\nf 1//1 2//1 3//1\n");
    tap_ok(scene && repairs.unknown_lines == 0, "smoothing that normals say");
}

static void test_missing(void)
{
    struct scene *scene = read_scene(
        CORNERS "usemtl none\nf 1 2 3\nusemtl nothing\nf 1 2 3\nusemtl none\nf 1 2 3\n"
                "usemtl no face\n");
    tap_ok(scene && repairs.materials.count == 2 && repairs.libraries.count == 0 &&
               strcmp(repairs.materials.first, "none") == 0 &&
               colour_is(material_at(scene, 1)->reflectance, 0.5, 0.5, 0.5) &&
               colour_is(material_at(scene, 1)->emission, 0, 0, 0),
           "a missing material counts once for its name, and is grey");
    scene =
        read_scene("mtllib nowhere.mtl\nmtllib nowhere.mtl\nmtllib\nmtllib .\n" CORNERS
                   "usemtl none\nf 1 2 3\n");
    tap_ok(scene && repairs.libraries.count == 2 && repairs.materials.count == 1 &&
               strcmp(repairs.materials.first, "none") == 0 &&
               strcmp(repairs.libraries.first, "nowhere.mtl") == 0,
           "a missing library counts once for its name");
}

static void check_libraries(const char *name, const char *line, int64_t missing)
{
    char text[400];
    snprintf(text, sizeof text,
             "%s\n" CORNERS "usemtl one\nf 1 2 3\nusemtl two\nf 1 2 3\n", line);
    struct scene *scene = read_scene(text);
    tap_ok(scene && repairs.libraries.count == missing && repairs.materials.count == 0 &&
               colour_is(material_at(scene, 0)->reflectance, 0.125, 0.125, 0.125) &&
               colour_is(material_at(scene, 1)->reflectance, 0.25, 0.25, 0.25),
           "%s", name);
}

static void test_libraries(void)
{
    write_text(MTL, "newmtl one\nKd 0.125\n");
    write_text(OTHER, "\xEF\xBB\xBFnewmtl two\nKd 0.25");
    check_libraries("two libraries", "mtllib  obj_test.mtl \nmtllib obj test two.mtl", 0);
    check_libraries("two in one line", "mtllib obj_test.mtl obj\\ test\\ two.mtl", 0);
    check_libraries("two of four",
                    "mtllib x.mtl\tobj\\ test\\ two.mtl y.mtl  obj_test.mtl", 2);
    check_libraries("names with folders",
                    "mtllib ../build/obj_test.mtl\nmtllib ./obj test two.mtl", 0);
    check_libraries("folders of other machines",
                    "mtllib /home/a/obj_test.mtl\nmtllib C:\\a\\b c\\obj test two.mtl",
                    0);
    check_libraries("a folder with a blank: perhaps a list",
                    "mtllib /home/a b/obj_test.mtl\nmtllib obj test two.mtl", 1);
    check_libraries("no file is a folder's name",
                    "mtllib obj_test.mtl a/b/ obj\\ test\\ two.mtl a\\ /", 2);
    check_libraries("a list, not a folder with a blank",
                    "mtllib obj_test.mtl c/obj_test.mtl\n"
                    "mtllib x obj_test.mtl\nmtllib c/d/obj test two.mtl",
                    1);
    check_libraries("a list of names with blanks",
                    "mtllib obj test two.mtl obj_test.mtl obj test two.mtl", 0);
    check_libraries("of which some are missing",
                    "mtllib my obj_test.mtl your obj test two.mtl his", 3);
    check_libraries("back slashes", "mtllib ..\\scenes\\cornell.mtl obj_test.mtl\n"
                                    "mtllib obj test two.mtl", 0);
    char *text = alloc_array(20000, 1);
    for (int i = 0; i <= 1000; i++)
        sprintf(text + strlen(text), "mtllib x%d\n", i);
    check_refused(text, OBJ ":1001: more than 1000 material libraries");
    alloc_free(text);
}

static void test_many_names(void)
{
    enum { NAMES = 20000 };
    char *text = alloc_array(NAMES * 40, 1), *library = alloc_array(NAMES * 40, 1);
    char *end = text + sprintf(text, "mtllib obj_test.mtl\n" CORNERS),
         *library_end = library;
    for (int i = 0; i < NAMES; i++) {
        end += sprintf(end, "usemtl m%d\nf 1 2 3\n", i);
        library_end +=
            sprintf(library_end, "newmtl m%d\nKd %d\n", NAMES - 1 - i, NAMES - 1 - i);
    }
    write_text(MTL, library);
    struct scene *scene = read_scene(text);
    bool right = scene && scene->input_count == NAMES && scene->material_count == NAMES;
    for (int i = 0; i < NAMES && right; i++)
        right = material_at(scene, i)->reflectance.band[2] == i;
    tap_ok(right && repairs.materials.count == 0, "%d materials", (int)NAMES);
    alloc_free(text);
    alloc_free(library);
}

static void test_bad_libraries(void)
{
    check_library_refused("newmtl a\nKd -0.1 0 0\n", MTL ":2: negative number '-0.1'");
    check_library_refused("newmtl a\nKd 1 1\n",
                          MTL ":2: Kd has 2 numbers instead of 1 or 3");
    check_library_refused("Ka 1\nKd 1 1 1\n", MTL ":2: Kd before newmtl");
}

/* A material without a name is that of usemtl without one, and of no other face. */
static void test_nameless(void)
{
    write_text(MTL, "newmtl  \nKd 0.25 0.25 0.25\nKe 1 1 1\nnewmtl b\n");
    struct scene *scene = read_scene("mtllib obj_test.mtl\n" CORNERS
                                     "f 1 2 3\nusemtl\nf 1 3 4\nusemtl b\nf 1 2 4\n");
    const double expected[3][2] = {{0.5, 0.0}, {0.25, 1.0}, {0.0, 0.0}};
    bool right = scene && repairs.nameless == 1 && repairs.materials.count == 0;
    for (int i = 0; right && i < 3; i++) {
        const struct material *m = &scene->materials[scene->material_of[i]];
        right = m->reflectance.band[0] == expected[i][0] &&
                m->emission.band[0] == expected[i][1];
    }
    tap_ok(right, "a material without a name: %s", error.text);
}

static void test_bad_files(void)
{
    check_refused("", OBJ ": no faces");
    check_refused("just some words\n\nand more", OBJ ": no faces");
    check_refused("solid cube\nfacet normal 0 0 1\n",
                  OBJ ": not an OBJ file: it looks like STL");
    check_refused("glTF\2\1", OBJ ": not an OBJ file: it looks like glTF");
    check_refused("{\"v\": [1, 2]}\n", OBJ ": not an OBJ file: it looks like glTF");
    check_refused("<?xml version=\"1.0\"?>\nf 1 2 3\n",
                  OBJ ": not an OBJ file: it looks like XML");
    check_triangle("an OBJ that begins as STL", "solid wood\n" CORNERS "f 1 2 3\n");
    check_refused("solid wood\n" CORNERS "f 1 2 9\n",
                  OBJ ":6: face refers to vertex 9 of 4");
    forget_error();
    write_text(STL, "binary\1");
    check_error(obj_read(STL, &repairs, &error),
                STL ": not an OBJ file: it looks like STL");
    remove(STL);
}

int main(void)
{
    test_lines();
    test_long_file();
    test_vertices();
    test_corners();
    test_normals();
    test_colours();
    test_polygons();
    test_spiral();
    test_many_corners();
    test_materials();
    test_notes();
    test_textures();
    test_passed();
    test_missing();
    test_libraries();
    test_many_names();
    test_bad_libraries();
    test_nameless();
    test_bad_files();
    scene_destroy(last);
    remove(OBJ);
    remove(MTL);
    remove(OTHER);
    return tap_done();
}
