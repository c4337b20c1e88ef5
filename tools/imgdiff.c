/* imgdiff: compares a picture, or a solution, with the expected one. A program of its
 * own, installed for users of golden pictures.
 *
 * The bound is on the largest difference, to find one wrong pixel in a large picture, and
 * relative to the root mean square of the expected side, to mean the same in dim scenes
 * and in bright ones. A bound on the RMS replaces this one if single pixels may differ,
 * at edges moved by a rounding. A sample not finite exceeds any bound.
 *
 * With an error for each pixel no bound is picked: blocks of all sizes are compared, from
 * 8 x 8 pixels to the whole picture. Noise is less in large ones, where a few percent on
 * one surface show; small ones show where. By chance, 1 block in 16,000 is beyond four
 * standard errors, and few errors are quite normal: more than 1 in 1,000 differ. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "geom/alloc.h"
#include "io/scene/camera.h"
#include "io/picture/imagefile.h"
#include "io/picture/scale.h"
#include "io/run/options.h"
#include "io/run/place.h"
#include "io/scene/ply.h"
#include "io/scene/text.h"
#include "tools/compare.h"

static const char HELP[] =
    "usage: imgdiff [options] A B\n"
    "\n"
    "Compares A with B, the expected one: two pictures of the same size (both .ppm, or\n"
    "each .pfm or .hdr), or two solution meshes of phr (.ply) of one scene, by area.\n"
    "\n"
    "  --tolerance T  pass if no sample is off by more than T (0)\n"
    "  --rms T        pass if the RMS error is at most T; --tolerance then only if "
    "given\n"
    "  --error E      pass if at most 1 in 1,000 blocks is beyond 4 standard errors;\n"
    "                 E: those of B's pixels, as phr -o B.error.pfm; A's noise is seen\n"
    "  --blocks N     compare means over blocks of N by N pixels (1; with --error 8,\n"
    "                 16, 32, ... up to the whole picture)\n"
    "  --below X      leave out blocks where a sample of B is above X, such as lamps\n"
    "  -o FILE        write |A - B|: as it is (.pfm .hdr), or scaled so that the\n"
    "                 largest is white (.png .ppm); of meshes as a mesh (.ply); with\n"
    "                 --error by how many: red where A is brighter, blue where darker\n"
    "  --help  --version\n"
    "\n"
    "T is relative to the root mean square of B's samples. Samples of a .ppm are its "
    "codes,\n"
    "as shares of the greatest. A sample that is not a finite number never passes.\n"
    "\n"
    "Exit status: 0 passed; 1 not passed, or FILE cannot be written; 2 bad usage or "
    "input.\n";

enum { SMALLEST = 8 }; /* pixels along a side of the smallest blocks with --error */

struct request {
    const char *paths[2]; /* A and B */
    const char *error;     /* picture of B's standard errors, or NULL */
    struct target output;  /* of -o; without it, no path */
    double tolerance, rms; /* negative: not given */
    double blocks;         /* pixels along a side of a block; an integer */
    double below;          /* blocks with a sample of B above it are left out */
    bool help, version;
};

/* Returns the field of an option with a number, or NULL. */
static double *number_of(struct request *request, const char *name)
{
    static const char *const names[] = {"--tolerance", "--rms", "--blocks", "--below"};
    double *numbers[] = {&request->tolerance, &request->rms, &request->blocks,
                         &request->below};
    for (int k = 0; k < 4; k++)
        if (strcmp(name, names[k]) == 0)
            return numbers[k];
    return NULL;
}

static bool set_option(struct request *request, const char *name, const char *value,
                       struct error *error)
{
    bool output = strcmp(name, "-o") == 0, errors = strcmp(name, "--error") == 0;
    double *number = number_of(request, name);
    if (!number && !output && !errors)
        return error_set(error, EXIT_USAGE, "unknown option %s; see --help", name);
    if (!value)
        return error_set(error, EXIT_USAGE, "%s needs a value", name);
    if (errors)
        request->error = value;
    if (output)
        request->output = target_parse(value);
    if (output && !request->output.has_format)
        return error_set(error, EXIT_USAGE,
                         "-o %s: the name must end in .ppm, .pfm, .png, .hdr or .ply",
                         value);
    if (number && (!text_is_number(value, number) || *number < 0.0))
        return error_set(error, EXIT_USAGE, "%s: '%s' is not a number of at least 0",
                         name, value);
    if (number == &request->blocks && !(*number >= 1.0 && *number <= IMAGE_SIZE_MAX &&
                                        *number == floor(*number)))
        return error_set(error, EXIT_USAGE, "--blocks: '%s' is not a number of pixels",
                         value);
    return true;
}

static bool parse(struct request *request, int argc, char **argv, struct error *error)
{
    int paths = 0;
    *request = (struct request){
        .tolerance = -1.0, .rms = -1.0, .blocks = 1.0, .below = HUGE_VAL};
    for (int i = 1; i < argc; i++) {
        const char *argument = argv[i];
        if (strcmp(argument, "--help") == 0)
            request->help = true;
        else if (strcmp(argument, "--version") == 0)
            request->version = true;
        else if (argument[0] != '-' && paths < 2)
            request->paths[paths++] = argument;
        else if (argument[0] != '-')
            return error_set(error, EXIT_USAGE, "more than two files to compare: %s",
                             argument);
        else if (!set_option(request, argument, argv[++i], error))
            return false;
    }
    if (paths < 2 && !request->help && !request->version)
        return error_set(error, EXIT_USAGE, "two files are needed; see --help");
    if (request->tolerance < 0.0 && request->rms < 0.0)
        request->tolerance = 0.0;
    return true;
}

/* Prints the report; on stderr if the map goes to the standard output. */
static void report(const struct request *request, const struct difference *difference,
                   double peak)
{
    double rms = difference_rms(difference);
    const char *map = request->output.path;
    FILE *file = map && place_is_stdout(map) ? stderr : stdout;
    if (difference->broken > 0)
        fprintf(file, "not finite  %lld samples\n", (long long)difference->broken);
    fprintf(file, "max         %.6g\n", difference->largest);
    fprintf(file, "mean        %.6g\n", difference_mean(difference));
    fprintf(file, "rms         %.6g\n", rms);
    fprintf(file, "relative    %.6g max, %.6g rms\n",
            difference_relative(difference, difference->largest),
            difference_relative(difference, rms));
    if (rms > 0.0)
        fprintf(file, "psnr        %.2f dB (peak %.6g)\n",
                difference_psnr(difference, peak), peak);
    else
        fprintf(file, "psnr        infinite\n");
}

static bool passes(const struct request *request, const struct difference *difference)
{
    double most = difference_relative(difference, difference->largest);
    double rms = difference_relative(difference, difference_rms(difference));
    return difference->broken == 0 &&
           (request->tolerance < 0.0 || most <= request->tolerance) &&
           (request->rms < 0.0 || rms <= request->rms);
}

static bool nothing_left(const struct request *request, struct error *error)
{
    return error_set(error, EXIT_USAGE, "%s: no block is below %g", request->paths[1],
                     request->below);
}

/* Writes a number with a comma before each thousand. Returns `text`. */
static const char *with_commas(int64_t number, char text[32])
{
    char digits[32];
    int length = snprintf(digits, sizeof digits, "%lld", (long long)number), at = 0;
    for (int i = 0; i < length; i++) {
        if (i > 0 && (length - i) % 3 == 0)
            text[at++] = ',';
        text[at++] = digits[i];
    }
    text[at] = '\0';
    return text;
}

/* Says how much brighter A is as a whole, and names a slip that makes it so. Samples that
 * are uncertain by more than a few percent, as at edges of lamps, count less. */
static void tell_ratio(FILE *file, const struct image *a, const struct image *b,
                       const struct image *errors)
{
    static const double UNSURE = 0.05;
    static const struct {
        double ratio;
        const char *name;
    } SLIPS[] = {{PI, "pi"}, {1.0 / PI, "1 / pi"}, {2.0, "2"}, {0.5, "a half"}};
    double sum = 0.0, weights = 0.0;
    for (int64_t i = 0; i < 3 * (int64_t)a->width * a->height; i++) {
        double light = (double)b->rgb[i];
        double part = (double)errors->rgb[i] / (UNSURE * light);
        if (!(light > 0.0))
            continue;
        sum += (double)a->rgb[i] / light / (1.0 + part * part);
        weights += 1.0 / (1.0 + part * part);
    }
    double ratio = sum / weights;
    fprintf(file, "in all, A is %.4g times B", ratio);
    for (size_t k = 0; k < sizeof SLIPS / sizeof *SLIPS; k++)
        if (fabs(ratio / SLIPS[k].ratio - 1.0) < 0.02)
            fprintf(file, ": a factor of %s?", SLIPS[k].name);
    fprintf(file, "\n");
}

/* Compares blocks of all sizes, and makes false colours of the deviations of the smallest
 * if they are to be seen. `passed`: the pictures agree. */
static bool diff_by_errors(const struct request *request, const struct image *a,
                           const struct image *b, const struct image *errors,
                           struct image *map, bool *passed, struct error *error)
{
    static const double LIMIT = 4.0, SHARE = 1e-3;
    const struct target *output = &request->output;
    FILE *file = output->path && place_is_stdout(output->path) ? stderr : stdout;
    struct scale scale = {.top = 2.0 * LIMIT, .step = LIMIT, .signs = true};
    int first = request->blocks > 1.0 ? (int)request->blocks : SMALLEST;
    *passed = true;
    for (int side = first; side == first || side <= b->width || side <= b->height;
         side *= 2) {
        char beyond[32], blocks[32];
        struct deviations found = compare_errors(a, b, errors, side, request->below,
                                                 LIMIT, side == first ? map : NULL);
        bool differs = (double)found.beyond > SHARE * (double)found.blocks;
        *passed = *passed && !differs;
        if (found.blocks == 0 && side == first)
            return nothing_left(request, error);
        if (found.blocks > 0)
            fprintf(file, "%s: %s of %s blocks of %d x %d beyond %g standard errors, "
                    "worst %.2g at (%d, %d), %s\n", differs ? "differs" : "agrees",
                    with_commas(found.beyond, beyond), with_commas(found.blocks, blocks),
                    side, side, LIMIT, fabs(found.worst), found.x, found.y,
                    found.moved ? "moved" : found.worst < 0.0 ? "darker" : "brighter");
    }
    if (!*passed)
        tell_ratio(file, a, b, errors);
    if (output->path && format_has_tone(output->format))
        scale_paint(&scale, map);
    return true;
}

static bool write_map(const struct request *request, const struct image *map,
                      double largest, struct error *error)
{
    struct tone tone = tone_make(largest > 0.0 ? 1.0 / largest : 1.0);
    return image_write(map, &tone, &request->output, error);
}

/* Refuses -o with the name of a mesh for pictures, or of a picture for meshes; and
 * options of pixels for meshes. */
static bool check_output(const struct request *request, bool meshes, struct error *error)
{
    const struct target *output = &request->output;
    if (output->path &&
        (meshes ? output->format != FORMAT_PLY : format_is_mesh(output->format)))
        return error_set(error, EXIT_USAGE, "-o %s: the difference of %s", output->path,
                         meshes ? "meshes is a mesh (.ply)" : "pictures is a picture");
    for (int i = 0; i < 2; i++)
        if (output->path && place_is_read(output->path, request->paths[i]))
            return error_set(error, EXIT_USAGE, "%s is read: no output goes over it",
                             request->paths[i]);
    if (meshes && (request->blocks > 1.0 || request->below < HUGE_VAL || request->error))
        return error_set(error, EXIT_USAGE,
                         "--blocks, --below and --error are for pictures");
    return true;
}

/* Refuses two pictures that cannot be compared. */
static bool check_images(const char *const paths[2], const struct image *a,
                         const struct image *b, bool alike, struct error *error)
{
    if (!alike)
        return error_set(error, EXIT_USAGE,
                         "%s and %s: one is linear (PFM, HDR), the other not (PPM, PNG)",
                         paths[0], paths[1]);
    return (a->width == b->width && a->height == b->height) ||
           error_set(error, EXIT_USAGE, "%s is %dx%d, %s is %dx%d", paths[0], a->width,
                     a->height, paths[1], b->width, b->height);
}

/* Reads the errors of B. */
static bool read_errors(const struct request *request, const struct image *b,
                        bool is_linear, struct image *errors, struct error *error)
{
    const char *const paths[2] = {request->paths[1], request->error};
    struct source source;
    enum image_kind kind = IMAGE_CODES;
    bool good = is_linear || error_set(error, EXIT_USAGE,
                                       "--error: %s has codes, and not W/m^2", paths[0]);
    good = good && source_open(&source, request->error, error);
    if (!good)
        return false;
    good = image_read(errors, &kind, &source, error) &&
           check_images(paths, b, errors, kind == IMAGE_LINEAR, error);
    source_close(&source);
    return good;
}

/* Sets `passed`. */
static bool diff_images(const struct request *request, struct source sources[2],
                        bool *passed, struct error *error)
{
    struct image a = {0}, b = {0}, map = {0}, errors = {0};
    struct difference difference = {0};
    enum image_kind kind_a, kind_b;
    bool good = image_read(&a, &kind_a, &sources[0], error) &&
                image_read(&b, &kind_b, &sources[1], error) &&
                check_images(request->paths, &a, &b, kind_a == kind_b, error);
    good = good && (!request->error || read_errors(request, &b, kind_b == IMAGE_LINEAR,
                                                   &errors, error));
    if (good) {
        map = (struct image){a.width, a.height, NULL};
        map.rgb = alloc_array((size_t)a.width * (size_t)a.height, 3 * sizeof *map.rgb);
    }
    if (good && request->error) {
        good = diff_by_errors(request, &a, &b, &errors, &map, passed, error);
        difference.largest = 1.0;
    } else if (good) {
        difference = compare_images(&a, &b, (int)request->blocks, request->below, &map);
        good = difference.samples > 0 || nothing_left(request, error);
    }
    if (good && !request->error) {
        report(request, &difference, kind_a == IMAGE_CODES ? 1.0 : difference.peak);
        *passed = passes(request, &difference);
    }
    if (good && request->output.path)
        good = write_map(request, &map, difference.largest, error);
    alloc_free(errors.rgb);
    alloc_free(a.rgb);
    alloc_free(b.rgb);
    alloc_free(map.rgb);
    return good;
}

/* Sets `passed`. */
static bool diff_solutions(const struct request *request, struct source sources[2],
                           bool *passed, struct error *error)
{
    struct solution_mesh a = {0}, b = {0};
    struct difference difference = {0};
    struct rgb *map = NULL;
    bool good = solution_mesh_read(&a, &sources[0], error) &&
                solution_mesh_read(&b, &sources[1], error);
    if (good) {
        map = alloc_array((size_t)a.count, sizeof *map);
        good = compare_solutions(&a, &b, &difference, map, error);
    }
    if (good) {
        report(request, &difference, difference.peak);
        *passed = passes(request, &difference);
        if (request->output.path)
            good = solution_write(&a, map, difference.largest, request->output.path,
                                  error);
    }
    alloc_free(map);
    solution_mesh_free(&a);
    solution_mesh_free(&b);
    return good;
}

static bool diff_sources(const struct request *request, struct source sources[2],
                         bool *passed, struct error *error)
{
    bool meshes = ply_is_meant(&sources[0]);
    if (meshes != ply_is_meant(&sources[1]))
        return error_set(error, EXIT_USAGE, "%s and %s: a picture and a mesh",
                         request->paths[0], request->paths[1]);
    return check_output(request, meshes, error) &&
           (meshes ? diff_solutions(request, sources, passed, error)
                   : diff_images(request, sources, passed, error));
}

/* Returns the exit status. */
static int diff(const struct request *request, struct error *error)
{
    struct source sources[2] = {{0}, {0}};
    bool passed = false, good = source_open(&sources[0], request->paths[0], error) &&
                source_open(&sources[1], request->paths[1], error) &&
                diff_sources(request, sources, &passed, error);
    source_close(&sources[0]);
    source_close(&sources[1]);
    return !good ? error->code : passed ? EXIT_DONE : EXIT_FAILED;
}

int main(int argc, char **argv)
{
    struct request request;
    struct error error = {EXIT_DONE, ""};
    int status = EXIT_DONE;
    if (!parse(&request, argc, argv, &error))
        status = error.code;
    else if (request.help)
        fputs(HELP, stdout);
    else if (request.version)
        printf("imgdiff %s\n", PHR_VERSION);
    else
        status = diff(&request, &error);
    if ((fflush(stdout) != 0 || ferror(stdout)) &&
        !error_set(&error, EXIT_FAILED, "cannot write to the standard output"))
        status = error.code;
    if (error.code != EXIT_DONE)
        fprintf(stderr, "imgdiff: %s\n", error.text);
    return status;
}
