/* The command line.
 *
 * Options are a table: name, kind of value, field in struct options, and range. --help is
 * plain text beside it, so that it reads as it prints, and fits a screen of 24 lines;
 * tests/io/options.c compares the two, tests/52-words.sh the man page. */
#include "io/run/options.h"

#include <ctype.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "geom/alloc.h"
#include "io/scene/camera.h"
#include "io/scene/text.h"

enum kind { KIND_FLAG, KIND_TEXT, KIND_REAL, KIND_INTEGER, KIND_OUTPUT, KIND_VIEW,
            KIND_SIZE, KIND_CHOICE, KIND_FRACTION, KIND_BYTES, KIND_GATHER, KIND_SHOW,
            KIND_PAPER };

struct option {
    const char *name;
    enum kind kind;
    size_t offset;       /* of the field in struct options */
    double low, high;    /* inclusive range of a number */
    const char *choices; /* names, separated by bars, in the order of the field's enum */
};

#define FIELD(name) offsetof(struct options, name)

static const struct option OPTIONS[] = {
    {"-o", KIND_OUTPUT, 0, 0, 0, NULL},
    {"--view", KIND_VIEW, 0, 0, 0, NULL},
    {"--size", KIND_SIZE, 0, 0, 0, NULL},
    {"--samples", KIND_INTEGER, FIELD(samples), 1, 64, NULL},
    {"--exposure", KIND_REAL, FIELD(exposure), 1e-30, 1e30, NULL},
    {"--flat", KIND_FLAG, FIELD(flat), 0, 0, NULL},
    {"--epsilon", KIND_REAL, FIELD(criterion.epsilon), 0, 1e30, NULL},
    {"--accuracy", KIND_FRACTION, FIELD(criterion.accuracy), 1e-4, 1, NULL},
    {"--max-level", KIND_INTEGER, FIELD(criterion.max_level), 0, ID_MAX_LEVEL, NULL},
    {"--min-area", KIND_REAL, FIELD(criterion.min_area), 0, 1, NULL},
    {"--oracle", KIND_CHOICE, FIELD(criterion.oracle), 0, 0, "bf|error"},
    {"--linking", KIND_CHOICE, FIELD(criterion.linking), 0, 0, "pairs|tree"},
    {"--form-factor", KIND_CHOICE, FIELD(criterion.form_factor), 0, 0, "disk|polygon"},
    {"--solver", KIND_CHOICE, FIELD(criterion.solver), 0, 0, "jacobi|cg"},
    {"--balance", KIND_CHOICE, FIELD(criterion.balance), 0, 0, "none|greedy|default"},
    {"--final-gather", KIND_GATHER, FIELD(criterion.final_gather), 0,
     GATHER_RAYS_MOST, NULL},
    {"--paper", KIND_PAPER, 0, 0, 0, NULL},
    {"--alpha", KIND_REAL, FIELD(criterion.alpha), 0, 1, NULL},
    {"--tolerance", KIND_REAL, FIELD(criterion.tolerance), 0, 1, NULL},
    {"--max-iterations", KIND_INTEGER, FIELD(criterion.max_iterations), 1, 1e9, NULL},
    {"--ke", KIND_CHOICE, FIELD(ke), 0, 0, "radiosity|radiance"},
    {"--two-sided", KIND_FLAG, FIELD(two_sided), 0, 0, NULL},
    {"--two-sided-lamps", KIND_FLAG, FIELD(two_sided_lamps), 0, 0, NULL},
    {"--save-links", KIND_TEXT, FIELD(save_links), 0, 0, NULL},
    {"--load-links", KIND_TEXT, FIELD(load_links), 0, 0, NULL},
    {"--checkpoint", KIND_TEXT, FIELD(checkpoint), 0, 0, NULL},
    {"--every", KIND_INTEGER, FIELD(every), 1, 1e9, NULL},
    {"--resume", KIND_TEXT, FIELD(resume), 0, 0, NULL},
    {"--memory", KIND_BYTES, FIELD(memory), 1, 1e18, NULL},
    {"--stats", KIND_TEXT, FIELD(stats), 0, 0, NULL},
    {"--dump", KIND_CHOICE, FIELD(dump), 0, 0, "nothing|patches|links"},
    {"--show", KIND_SHOW, FIELD(show), 0, 0, "light|mesh|owner|level|error|links"},
    {"--quiet", KIND_FLAG, FIELD(quiet), 0, 0, NULL},
    {"--verbose", KIND_FLAG, FIELD(verbose), 0, 0, NULL},
    {"--validate", KIND_FLAG, FIELD(validate), 0, 0, NULL},
    {"--form-factors", KIND_FLAG, FIELD(form_factors), 0, 0, NULL},
    {"--help", KIND_FLAG, FIELD(help), 0, 0, NULL},
    {"--version", KIND_FLAG, FIELD(version), 0, 0, NULL},
};

static const struct option *find_option(const char *name)
{
    for (size_t i = 0; i < sizeof OPTIONS / sizeof OPTIONS[0]; i++)
        if (strcmp(name, OPTIONS[i].name) == 0)
            return &OPTIONS[i];
    return NULL;
}

/* A format of outputs: its name is a prefix and a suffix, too. */
struct format {
    const char *name;
    bool is_mesh;
};

static const struct format FORMATS[] = {
    [FORMAT_PPM] = {"ppm", false},
    [FORMAT_PFM] = {"pfm", false},
    [FORMAT_PNG] = {"png", false},
    [FORMAT_HDR] = {"hdr", false},
    [FORMAT_PLY] = {"ply", true},
    [FORMAT_VTK] = {"vtk", true},
};
enum { FORMAT_COUNT = sizeof FORMATS / sizeof FORMATS[0] };

bool format_is_mesh(enum output_format format)
{
    return FORMATS[format].is_mesh;
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
    char suffix[16];
    for (int i = 0; i < FORMAT_COUNT; i++) {
        size_t prefix = prefix_length(argument, FORMATS[i].name);
        if (prefix > 0)
            return (struct target){argument + prefix, (enum output_format)i, true, 0};
    }
    for (int i = 0; i < FORMAT_COUNT; i++) {
        snprintf(suffix, sizeof suffix, ".%s", FORMATS[i].name);
        if (text_ends_with(argument, suffix))
            return (struct target){argument, (enum output_format)i, true, 0};
    }
    return (struct target){argument, FORMAT_PPM, false, 0};
}

/* Writes ".ppm, .pfm or .ply". */
static void list_suffixes(char *text, size_t room)
{
    size_t at = 0;
    for (int i = 0; i < FORMAT_COUNT; i++)
        at += (size_t)snprintf(text + at, room - at, "%s.%s",
                               i == 0                  ? ""
                               : i == FORMAT_COUNT - 1 ? " or "
                                                       : ", ",
                               FORMATS[i].name);
}

bool options_show(const struct options *options, int view)
{
    for (int i = 0; i < options->output_count; i++)
        if (options->outputs[i].view == view &&
            !format_is_mesh(options->outputs[i].format))
            return true;
    return false;
}

bool target_refuse(const char *argument, struct error *error)
{
    char suffixes[8 * FORMAT_COUNT];
    list_suffixes(suffixes, sizeof suffixes);
    return error_set(error, EXIT_USAGE,
                     "-o %s: the name must end in %s, or be FORMAT:FILE, as in ppm:FILE",
                     argument, suffixes);
}

/* A picture before all views belongs to the first. */
static bool add_output(struct options *options, const char *argument, struct error *error)
{
    struct target target = target_parse(argument);
    target.view = options->view_count > 0 ? options->view_count - 1 : 0;
    options->outputs[options->output_count++] = target;
    return *target.path || target_refuse(argument, error);
}

static bool parse_number(const struct option *option, const char *value, double *number,
                         struct error *error)
{
    if (!text_is_number(value, number))
        return error_set(error, EXIT_USAGE, "%s: '%s' is not a number", option->name,
                         value);
    if (!(*number >= option->low && *number <= option->high))
        return error_set(error, EXIT_USAGE, "%s: %s is not between %g and %g",
                         option->name, value, option->low, option->high);
    return true;
}

static bool set_integer(struct options *options, const struct option *option,
                        const char *value, struct error *error)
{
    double number;
    if (!parse_number(option, value, &number, error))
        return false;
    if (number != (double)(int)number)
        return error_set(error, EXIT_USAGE, "%s: '%s' is not a whole number",
                         option->name, value);
    *(int *)(void *)((char *)options + option->offset) = (int)number;
    return true;
}

static bool set_size(struct options *options, const char *value, struct error *error)
{
    int64_t width, height;
    const char *at = value;
    if (text_integer(&at, &width) && (*at == 'x' || *at == 'X')) {
        at++;
        if (text_integer(&at, &height) && *at == '\0' && width >= 1 &&
            width <= IMAGE_SIZE_MAX && height >= 1 && height <= IMAGE_SIZE_MAX) {
            options->width = (int)width;
            options->height = (int)height;
            return true;
        }
    }
    return error_set(error, EXIT_USAGE,
                     "--size: '%s' is not WIDTHxHEIGHT, each from 1 to %d", value,
                     (int)IMAGE_SIZE_MAX);
}

/* Sets an enum of rad/model.h: an int, with a constant for each choice, counted from
 * 0. */
static bool set_choice(const struct option *option, const char *value, int *field,
                       struct error *error)
{
    size_t length = strlen(value);
    int number = 0;
    for (const char *at = option->choices; at; at = strchr(at, '|'), number++) {
        at += *at == '|';
        if (strcspn(at, "|") == length && strncmp(at, value, length) == 0) {
            *field = number;
            return true;
        }
    }
    return error_set(error, EXIT_USAGE, "%s: '%s' is not one of %s", option->name, value,
                     option->choices);
}

/* Sets a fraction: a number, or a percentage. */
static bool set_fraction(const struct option *option, const char *value, double *field,
                      struct error *error)
{
    char digits[64];
    size_t length = strlen(value);
    bool percent = length > 1 && length < sizeof digits && value[length - 1] == '%';
    if (!percent)
        return parse_number(option, value, field, error);
    memcpy(digits, value, length - 1);
    digits[length - 1] = '\0';
    double number;
    if (!text_is_number(digits, &number))
        return error_set(error, EXIT_USAGE, "%s: '%s' is not a number", option->name,
                         value);
    *field = number / 100.0;
    if (!(*field >= option->low && *field <= option->high))
        return error_set(error, EXIT_USAGE, "%s: %s is not between %g %% and %g %%",
                         option->name, value, 100.0 * option->low, 100.0 * option->high);
    return true;
}

/* Sets a number of bytes, or of K, M, G or T: powers of 1024. */
static bool set_bytes(const struct option *option, const char *value, int64_t *field,
                      struct error *error)
{
    static const char UNITS[] = "KMGT";
    const char *at = value;
    int64_t digits; /* at most 18 of them */
    bool number = text_integer(&at, &digits);
    const char *unit = number && *at ? strchr(UNITS, *at) : NULL;
    if (!number || at[unit != NULL] != '\0')
        return error_set(error, EXIT_USAGE,
                         "%s: '%s' is not a number of bytes, such as 512M or 2G",
                         option->name, value);
    double bytes = strtod(value, NULL);
    for (const char *u = UNITS; unit && u <= unit; u++)
        bytes *= 1024.0;
    if (!(bytes >= option->low && bytes <= option->high))
        return error_set(error, EXIT_USAGE, "%s: %s is not between %g and %g bytes",
                         option->name, value, option->low, option->high);
    *field = (int64_t)bytes;
    return true;
}

/* Sets rays and pixels: N, "pixels", or both as "N,pixels". */
static bool set_gather(struct options *options, const struct option *option,
                       const char *value, struct error *error)
{
    static const char PIXELS[] = "pixels";
    char number[64];
    size_t length = strlen(value), ending = sizeof PIXELS - 1;
    options->pixels = length >= ending && strcmp(value + length - ending, PIXELS) == 0;
    if (!options->pixels)
        return set_integer(options, option, value, error);
    if (length == ending)
        return true;
    size_t digits = length - ending - 1;
    if (value[digits] != ',' || digits >= sizeof number)
        return error_set(error, EXIT_USAGE, "%s: '%s' is not N, pixels or N,pixels",
                         option->name, value);
    memcpy(number, value, digits);
    number[digits] = '\0';
    return set_integer(options, option, number, error);
}

/* Sets what pictures show: a choice, with links the patch behind a colon. */
static bool set_show(struct options *options, const struct option *option,
                     const char *value, struct error *error)
{
    static const char LINKS[] = "links:";
    if (strncmp(value, LINKS, sizeof LINKS - 1) == 0) {
        options->show = SHOW_LINKS;
        options->show_patch = value + sizeof LINKS - 1;
        return true;
    }
    if (strcmp(value, "links") == 0)
        return error_set(error, EXIT_USAGE,
                         "%s links: of which patch? As in links:5/023 or links:X,Y",
                         option->name);
    int show;
    bool good = set_choice(option, value, &show, error);
    if (good)
        options->show = (enum show)show;
    return good;
}

/* Sets the path of a file, of which there is one. */
static bool set_text(const struct option *option, const char *value, const char **field,
                     struct error *error)
{
    if (*field)
        return error_set(error, EXIT_USAGE, "%s is given twice: %s and %s", option->name,
                         *field, value);
    *field = value;
    return true;
}

static void set_paper(struct criterion *criterion)
{
    criterion->oracle = ORACLE_BF;
    criterion->linking = LINKING_PAIRS;
    criterion->form_factor = FORM_FACTOR_DISK;
    criterion->solver = SOLVER_JACOBI;
    criterion->balance = BALANCE_GREEDY;
}

static bool set_value(struct options *options, const struct option *option,
                      const char *value, struct error *error)
{
    char *field = (char *)options + option->offset;
    switch (option->kind) {
    case KIND_OUTPUT:
        return add_output(options, value, error);
    case KIND_VIEW:
        options->views[options->view_count++] = value;
        return true;
    case KIND_SIZE:
        return set_size(options, value, error);
    case KIND_INTEGER:
        return set_integer(options, option, value, error);
    case KIND_SHOW:
        return set_show(options, option, value, error);
    case KIND_GATHER:
        return set_gather(options, option, value, error);
    case KIND_REAL:
        return parse_number(option, value, (double *)(void *)field, error);
    case KIND_FRACTION:
        return set_fraction(option, value, (double *)(void *)field, error);
    case KIND_BYTES:
        return set_bytes(option, value, (int64_t *)(void *)field, error);
    case KIND_CHOICE:
        return set_choice(option, value, (int *)(void *)field, error);
    default:
        return set_text(option, value, (const char **)(void *)field, error);
    }
}

static bool add_scene(struct options *options, const char *path, struct error *error)
{
    if (options->scene)
        return error_set(error, EXIT_USAGE, "one scene at a time: %s and %s",
                         options->scene, path);
    options->scene = path;
    return true;
}

/* Refuses a view that no picture belongs to. */
static bool check_views(const struct options *options, struct error *error)
{
    for (int view = 0; view < options->view_count; view++)
        if (!options_show(options, view))
            return error_set(error, EXIT_USAGE,
                             "--view %s: no picture (-o) follows it",
                             options->views[view]);
    return true;
}

static bool check_restart(const struct options *options, struct error *error)
{
    const char *links = options->save_links ? "--save-links" : "--load-links";
    if (options->resume && (options->save_links || options->load_links))
        return error_set(error, EXIT_USAGE,
                         "--resume and %s do not go together: "
                         "the initial links are long gone",
                         links);
    if (options->save_links && options->load_links)
        return error_set(error, EXIT_USAGE,
                         "--save-links and --load-links do not go together");
    if ((options->save_links || options->load_links) &&
        options->criterion.linking != LINKING_PAIRS)
        return error_set(error, EXIT_USAGE, "%s goes with --linking pairs (--paper)",
                         links);
    if (options->every > 0 && !options->checkpoint)
        return error_set(error, EXIT_USAGE, "--every needs --checkpoint");
    return true;
}

/* Refuses outputs of light with --form-factors, which computes none. */
static bool check_table(const struct options *options, struct error *error)
{
    const char *other = options->output_count > 0 ? "-o"
                        : options->view_count > 0 ? "--view"
                        : options->stats          ? "--stats"
                        : options->save_links     ? "--save-links"
                        : options->load_links     ? "--load-links"
                        : options->dump           ? "--dump"
                        : options->checkpoint     ? "--checkpoint"
                        : options->resume         ? "--resume"
                                                  : NULL;
    if (options->form_factors && other)
        return error_set(error, EXIT_USAGE, "--form-factors and %s do not go together",
                         other);
    return true;
}

/* Defaults of --epsilon and --final-gather: without --accuracy, and with it, as its
 * start. */
static const double EPSILON = 1e-4, COARSE = 1e-3;

/* That of --epsilon for form factors. */
static const double EPSILON_FACTORS = 1e-2;
enum { GATHER_RAYS = 256, FEW_RAYS = 64 };

/* Checks the final gather: its rows find lamps in the tree, and --accuracy measures the
 * error of these rows. Sets the defaults. */
static bool check_gather(struct options *options, struct error *error)
{
    struct criterion *criterion = &options->criterion;
    bool tree = criterion->linking == LINKING_TREE, accurate = criterion->accuracy > 0.0;
    if (criterion->final_gather > 0 && !tree)
        return error_set(error, EXIT_USAGE, "--final-gather goes with --linking tree");
    if (accurate && !tree)
        return error_set(error, EXIT_USAGE, "--accuracy goes with --linking tree");
    if (accurate && criterion->final_gather == 0)
        return error_set(error, EXIT_USAGE,
                         "--accuracy and --final-gather 0 do not go together");
    if (criterion->final_gather < 0) /* not given */
        criterion->final_gather = !tree ? 0 : accurate ? FEW_RAYS : GATHER_RAYS;
    if (criterion->epsilon < 0.0)
        criterion->epsilon = options->form_factors ? EPSILON_FACTORS
                             : accurate            ? COARSE
                                                   : EPSILON;
    if (options->pixels && criterion->final_gather == 0)
        return error_set(error, EXIT_USAGE,
                         "--final-gather pixels needs rays, and a tree");
    if (options->pixels && options->flat)
        return error_set(error, EXIT_USAGE,
                         "--flat and --final-gather pixels do not go together");
    return true;
}

bool options_parse(struct options *options, int argc, char **argv, struct error *error)
{
    *options = (struct options){
        .samples = 3,
        .criterion = {.oracle = ORACLE_ERROR,
                      .linking = LINKING_TREE,
                      .form_factor = FORM_FACTOR_POLYGON,
                      .solver = SOLVER_CG,
                      .balance = BALANCE_DEFAULT,
                      .epsilon = -1.0,
                      .min_area = 1e-7,
                      .max_level = 10,
                      .alpha = 0.5,
                      .tolerance = 1e-5,
                      .max_iterations = 1000,
                      .final_gather = -1},
    };
    options->outputs = alloc_array((size_t)argc, sizeof *options->outputs);
    options->views = alloc_array((size_t)argc, sizeof *options->views);
    for (int i = 1; i < argc; i++) {
        const char *argument = argv[i];
        if (argument[0] != '-' || argument[1] == '\0') {
            if (!add_scene(options, argument, error))
                return false;
            continue;
        }
        const struct option *option = find_option(argument);
        if (!option)
            return error_set(error, EXIT_USAGE, "unknown option %s; see --help",
                             argument);
        options->given |= UINT64_C(1) << (option - OPTIONS);
        options->overruled &= ~(UINT64_C(1) << (option - OPTIONS));
        if (option->kind == KIND_PAPER) {
            set_paper(&options->criterion);
            options->overruled = options->given;
            continue;
        }
        if (option->kind == KIND_FLAG) {
            *(bool *)(void *)((char *)options + option->offset) = true;
            continue;
        }
        if (++i >= argc)
            return error_set(error, EXIT_USAGE, "%s needs a value", argument);
        if (!set_value(options, option, argv[i], error))
            return false;
    }
    options->two_sided = options->two_sided || options->two_sided_lamps;
    if (!check_gather(options, error))
        return false;
    if (!options->scene && !options->help && !options->version && !options->validate)
        return error_set(error, EXIT_USAGE, "no scene given; see --help");
    if (options->scene &&
        !(check_table(options, error) && check_views(options, error) &&
          check_restart(options, error)))
        return false;
    options->every = options->every > 0 ? options->every : 1;
    return true;
}

/* Appends a line "--option value" to `text`. */
static void describe(const struct options *options, const char *name, char *text,
                     size_t room)
{
    const struct option *option = find_option(name);
    const char *field = (const char *)options + option->offset, *choice = option->choices;
    size_t at = strlen(text);
    char *line = text + at;
    room -= at;
    switch (option->kind) {
    case KIND_FLAG:
        snprintf(line, room, "%s %s\n", name,
                 *(const bool *)(const void *)field ? "on" : "off");
        break;
    case KIND_INTEGER:
        snprintf(line, room, "%s %d\n", name, *(const int *)(const void *)field);
        break;
    case KIND_CHOICE:
        for (int k = *(const int *)(const void *)field; k > 0; k--)
            choice = strchr(choice, '|') + 1;
        snprintf(line, room, "%s %.*s\n", name, (int)strcspn(choice, "|"), choice);
        break;
    default:
        snprintf(line, room, "%s %.17g\n", name, *(const double *)(const void *)field);
    }
}

static const char *describe_all(const struct options *options, const char *const *names)
{
    static char text[1000];
    text[0] = '\0';
    for (; *names; names++)
        describe(options, *names, text, sizeof text);
    return text;
}

const char *options_given(const struct options *options, const char *const *names)
{
    static char text[1000];
    size_t at = 0;
    text[0] = '\0';
    for (; *names; names++)
        if (options->given >> (find_option(*names) - OPTIONS) & 1u)
            at += (size_t)snprintf(text + at, sizeof text - at, "%s%s",
                                   at > 0 ? ", " : "", *names);
    return text;
}

const char *options_link_settings(const struct options *options)
{
    static const char *const BY_ENERGY[] = {
        "--two-sided", "--two-sided-lamps", "--ke", "--oracle", "--form-factor", NULL};
    static const char *const BY_ERROR[] = { /* visibility is refined by --epsilon, too */
        "--two-sided", "--two-sided-lamps", "--ke", "--oracle", "--form-factor",
        "--epsilon", NULL};
    bool by_error = options->criterion.oracle == ORACLE_ERROR;
    return describe_all(options, by_error ? BY_ERROR : BY_ENERGY);
}

const char *options_run_settings(const struct options *options)
{
    static const char *const NAMES[] = {
        "--two-sided", "--two-sided-lamps", "--ke", "--oracle", "--linking",
        "--form-factor",
        "--solver", "--epsilon", "--accuracy", "--max-level", "--min-area", NULL};
    return describe_all(options, NAMES);
}

void options_free(struct options *options)
{
    alloc_free(options->outputs);
    alloc_free((void *)options->views);
    options->outputs = NULL;
    options->views = NULL;
}

static const char HELP[] =
    "usage: phr [options] SCENE         or  mpiexec -n P phr [options] SCENE\n"
    "Computes the light in a diffuse scene, OBJ or PLY. Defaults in brackets.\n"
    "  -o [FORMAT:]FILE picture .png .ppm, linear .hdr .pfm; mesh .ply .vtk\n"
    "  --view FILE      of the -o behind it: eye x y z, at, up, fov, size (chosen)\n"
    "  --size WxH       pixels (512x512)       --samples N   N x N rays a pixel (3)\n"
    "  --exposure X     factor (automatic)     --flat        no interpolation\n"
    "  --epsilon E      error of a link (1e-4) --accuracy A  refine to this error\n"
    "  --max-level N    of subdivision (10)    --min-area A  of a patch (1e-7)\n"
    "  --tolerance T    of the solution (1e-5) --max-iterations N   at most (1000)\n"
    "  --oracle error|bf   what splits a link  --form-factor polygon|disk\n"
    "  --linking tree|pairs  where links begin --final-gather N[,pixels]  rays (256)\n"
    "  --solver cg|jacobi  over the links      --balance default|greedy|none\n"
    "  --paper          the paper's of these   --alpha A     inherited cost (0.5)\n"
    "  --two-sided, and --two-sided-lamps      --ke radiosity|radiance  unit of Ke\n"
    "  --save-links F   those of all pairs     --load-links F  in their place\n"
    "  --checkpoint F   after each pass        --every N     only each N-th pass (1)\n"
    "  --resume F       go on from there       --memory M    limit, as in 2G (80%)\n"
    "  --form-factors   CSV of F, epsilon 1e-2 --validate    check form factors\n"
    "  --stats FILE     report as JSON         --verbose     levels of refinement\n"
    "  --dump patches|links  print these       --quiet       print nothing\n"
    "  --show light|mesh|owner|level|error|links:PATCH       --help, --version\n"
    "Exit status: 0 done; 1 failed or stopped; 2 bad usage or input. Examples:\n"
    "  phr room.obj -o room.png\n"
    "  mpiexec -n 4 phr scenes/cornell.obj --view scenes/cornell.view -o box.pfm\n";

void options_print_help(FILE *file)
{
    fputs(HELP, file);
}
