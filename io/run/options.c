/* The command line.
 *
 * Options are a table: name, words of the help, the function to set the field in struct
 * options, and its range. Parser and --help are made of this table; tests/52-words.sh
 * compares the man page with the help. */
#include "io/run/options.h"

#include <ctype.h>
#include <stddef.h>
#include <string.h>

#include "geom/alloc.h"
#include "io/run/option.h"
#include "io/scene/camera.h"
#include "io/scene/text.h"

bool options_show(const struct options *options, int view)
{
    for (int i = 0; i < options->output_count; i++)
        if (options->outputs[i].view == view &&
            !format_is_mesh(options->outputs[i].format))
            return true;
    return false;
}

/* A picture before all views belongs to the first. */
static bool add_output(const struct argument *a)
{
    struct options *options = a->options;
    struct target target = target_parse(a->value);
    target.view = options->view_count > 0 ? options->view_count - 1 : 0;
    options->outputs[options->output_count++] = target;
    return *target.path || target_refuse(a->value, a->error);
}

static bool add_view(const struct argument *a)
{
    a->options->views[a->options->view_count++] = a->value;
    return true;
}

enum { NOT_GIVEN = -1 }; /* rays of the final gather */

static bool set_size(const struct argument *a)
{
    int64_t width, height;
    const char *at = a->value;
    if (text_integer(&at, &width) && tolower((unsigned char)*at++) == 'x' &&
        text_integer(&at, &height) && *at == '\0' && width >= 1 &&
        width <= IMAGE_SIZE_MAX && height >= 1 && height <= IMAGE_SIZE_MAX) {
        a->options->width = (int)width;
        a->options->height = (int)height;
        return true;
    }
    char kind[60];
    snprintf(kind, sizeof kind, "WIDTHxHEIGHT, each from 1 to %d", (int)IMAGE_SIZE_MAX);
    return option_is_not(a, kind);
}

/* Sets rays and pixels: N, "pixels", or both as "N,pixels". Without N the number is the
 * default, whatever was given before. */
static bool set_gather(const struct argument *a)
{
    struct argument rays = *a;
    char number[DIGITS_ROOM];
    const char *comma = strrchr(a->value, ',');
    a->options->pixels = strcmp(comma ? comma + 1 : a->value, "pixels") == 0;
    if (!a->options->pixels && !strpbrk(a->value, ",p"))
        return option_set_integer(a);
    if (a->options->pixels && !comma) {
        *(int *)a->field = NOT_GIVEN;
        return true;
    }
    if (!a->options->pixels ||
        !option_copy_digits(a->value, (size_t)(comma - a->value), number))
        return option_is_not(a, "N, pixels or N,pixels");
    rays.value = number;
    return option_set_integer(&rays);
}

/* Sets what pictures show: a choice, with links the patch behind a colon. */
static bool set_show(const struct argument *a)
{
    static const char LINKS[] = "links:";
    if (strncmp(a->value, LINKS, sizeof LINKS - 1) == 0) {
        a->options->show = SHOW_LINKS;
        a->options->show_patch = a->value + sizeof LINKS - 1;
        return true;
    }
    if (strcmp(a->value, "links") == 0)
        return error_set(a->error, EXIT_USAGE,
                         "%s links: of which patch? As in links:5/023 or links:X,Y",
                         a->option->name);
    return option_set_choice(a);
}

static bool set_paper(const struct argument *a)
{
    struct criterion *criterion = a->field;
    criterion->oracle = ORACLE_BF;
    criterion->linking = LINKING_PAIRS;
    criterion->form_factor = FORM_FACTOR_DISK;
    criterion->solver = SOLVER_JACOBI;
    criterion->balance = BALANCE_GREEDY;
    a->options->overruled = a->options->given;
    return true;
}

/* --- the table --- */

#define FIELD(name) offsetof(struct options, name)
#define FLAG(name) option_set_flag, FIELD(name), 0, 0, NULL
#define TEXT(name) option_set_text, FIELD(name), 0, 0, NULL
#define REAL(name, low, high) option_set_real, FIELD(name), low, high, NULL
#define WHOLE(name, low, high) option_set_integer, FIELD(name), low, high, NULL
#define CHOICE(name, choices) option_set_choice, FIELD(name), 0, 0, choices
#define OTHER(set) set, 0, 0, 0, NULL

static const struct option OPTIONS[] = {
    {"-o", "[FORMAT:]FILE", "picture .png .ppm .hdr .pfm .error.pfm; mesh .ply .vtk .glb",
     OTHER(add_output)},
    {"--view", "FILE", "of the -o behind it", OTHER(add_view)},
    {"--size", "WxH", "pixels (512x512)", OTHER(set_size)},
    {"--samples", "N", "N x N rays a pixel (3)", WHOLE(samples, 1, 64)},
    {"--exposure", "X", "factor (automatic)", REAL(exposure, 1e-30, 1e30)},
    {"--flat", "", "no interpolation", FLAG(flat)},
    {"--show", "radiosity|irradiance|mesh|owner|level|error|links:P", "", set_show,
     FIELD(show), 0, 0, "light|radiosity|irradiance|mesh|owner|level|error|links"},
    {"--lux", "", "numbers, not W/m^2", FLAG(lux)},
    {"--lines", "N", "in false colours", WHOLE(lines, 0, 100)},
    {"--at", "FILE", "light at its points", TEXT(at)},
    {"--report", "FILE", "by object, CSV", TEXT(report)},
    {"--epsilon", "E", "error of a link (1e-4)", REAL(criterion.epsilon, 0, 1e30)},
    {"--accuracy", "A", "refine to this error",
     option_set_fraction, FIELD(criterion.accuracy), 1e-4, 1, NULL},
    {"--max-level", "N", "",
     WHOLE(criterion.max_level, 0, ID_MAX_LEVEL)},
    {"--min-area", "A", "", REAL(criterion.min_area, 0, 1)},
    {"--tolerance", "T", "", REAL(criterion.tolerance, 0, 1)},
    {"--max-iterations", "N", "", WHOLE(criterion.max_iterations, 1, 1e9)},
    {"--oracle", "error|bf", "", CHOICE(criterion.oracle, "bf|error")},
    {"--form-factor", "polygon|disk", "", CHOICE(criterion.form_factor, "disk|polygon")},
    {"--linking", "tree|pairs", "",
     CHOICE(criterion.linking, "pairs|tree")},
    {"--final-gather", "N[,pixels]", "rays (256)",
     set_gather, FIELD(criterion.final_gather), 0, GATHER_RAYS_MOST, NULL},
    {"--solver", "cg|jacobi", "", CHOICE(criterion.solver, "jacobi|cg")},
    {"--balance", "default|greedy|none", "",
     CHOICE(criterion.balance, "none|greedy|default")},
    {"--paper", "", "the paper's method", set_paper, FIELD(criterion), 0, 0, NULL},
    {"--alpha", "A", "", REAL(criterion.alpha, 0, 1)},
    {"--two-sided", "", "backs reflect", FLAG(two_sided)},
    {"--two-sided-lamps", "", "and those of lamps", FLAG(two_sided_lamps)},
    {"--ke", "radiosity|radiance", "Blender: 2nd", CHOICE(ke, "radiosity|radiance")},
    {"--up", "y|z|-y|-z|x|-x", "(guessed)", CHOICE(up, "guessed|y|z|-y|-z|x|-x")},
    {"--sky", "B|overcast,L|clear,L|FILE", "", option_set_sky, FIELD(sky), 0, 1e30, NULL},
    {"--sun", "X,Y,Z,W", "", option_set_sun, FIELD(sky), 0, 1e30, NULL},
    {"--save-links", "F", "", TEXT(save_links)},
    {"--load-links", "F", "", TEXT(load_links)},
    {"--checkpoint", "F", "after each pass", TEXT(checkpoint)},
    {"--every", "N", "", WHOLE(every, 1, 1e9)},
    {"--resume", "F", "go on from there", TEXT(resume)},
    {"--time", "T", "", option_set_time, FIELD(seconds), 1, 1e9, NULL},
    {"--memory", "M", "limit, as in 2G (80%)",
     option_set_bytes, FIELD(memory), 1, 1e18, NULL},
    {"--stats", "FILE", "report as JSON", TEXT(stats)},
    {"--dump", "patches|links", "", CHOICE(dump, "nothing|patches|links")},
    {"--verbose", "", "", FLAG(verbose)},
    {"--quiet", "", "print nothing", FLAG(quiet)},
    {"--help", "", "or --help=OPTION", FLAG(help)},
    {"--version", "", "and licence", FLAG(version)},
    {"--form-factors", NULL, "viewfactors SCENE", OTHER(NULL)},
};
enum { OPTION_COUNT = sizeof OPTIONS / sizeof OPTIONS[0] };

/* Finds the option of an argument "--option", "--option=value" or "-o". */
static const struct option *find_option(const char *name)
{
    size_t length = strncmp(name, "--", 2) == 0 ? strcspn(name, "=") : strlen(name);
    for (int i = 0; i < OPTION_COUNT; i++)
        if (strncmp(name, OPTIONS[i].name, length) == 0 && !OPTIONS[i].name[length])
            return &OPTIONS[i];
    return strcmp(name, "-h") == 0 ? find_option("--help") : NULL;
}

/* Refuses an unknown option, with the name of one like it. */
static bool refuse_option(const char *argument, struct error *error)
{
    char name[80];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(argument, "="), argument);
    for (int i = 0; i < OPTION_COUNT; i++)
        if (strcmp(name, OPTIONS[i].name) != 0 && text_is_like(name, OPTIONS[i].name))
            return error_set(error, EXIT_USAGE, "unknown option %s; did you mean %s?",
                             argument, OPTIONS[i].name);
    return error_set(error, EXIT_USAGE, "unknown option %s; see --help", argument);
}

/* Takes the option of --help=OPTION, whose dashes may be left out. */
static bool set_help_on(struct options *options, const char *name, struct error *error)
{
    char dashed[40];
    snprintf(dashed, sizeof dashed, "--%s", name);
    const struct option *option = find_option(name);
    option = option ? option : find_option(dashed);
    if (!option)
        return error_set(error, EXIT_USAGE, "--help: there is no option %s", name);
    options->help_on = option->name;
    return true;
}

static bool add_scene(struct options *options, const char *path, struct error *error)
{
    if (options->scene)
        return error_set(error, EXIT_USAGE, "one scene at a time: %s and %s",
                         options->scene, path);
    options->scene = path;
    return true;
}

/* Defaults of --epsilon and --final-gather: without --accuracy, and with it, as its
 * start. */
static const double EPSILON = 1e-4, COARSE = 1e-3;

enum { GATHER_RAYS = 256, FEW_RAYS = 64 };

static void set_defaults(struct options *options)
{
    struct criterion *criterion = &options->criterion;
    bool tree = criterion->linking == LINKING_TREE, accurate = criterion->accuracy > 0.0;
    options->pixel_rays = criterion->final_gather == NOT_GIVEN ? GATHER_RAYS : 0;
    if (criterion->final_gather == NOT_GIVEN)
        criterion->final_gather = !tree ? 0 : accurate ? FEW_RAYS : GATHER_RAYS;
    if (criterion->epsilon < 0.0)
        criterion->epsilon = accurate ? COARSE : EPSILON;
    options->two_sided = options->two_sided || options->two_sided_lamps;
}

/* Returns a view without a picture, or NULL. */
static const char *find_idle_view(const struct options *options)
{
    for (int view = 0; view < options->view_count; view++)
        if (!options_show(options, view))
            return options->views[view];
    return NULL;
}

/* Checks how options go together: the rows of the final gather find lamps in the tree,
 * and --accuracy measures the error of these rows. */
static bool check_rules(const struct options *o, struct error *error)
{
    const struct criterion *criterion = &o->criterion;
    bool tree = criterion->linking == LINKING_TREE, accurate = criterion->accuracy > 0.0;
    bool rays = criterion->final_gather > 0, scene = o->scene != NULL;
    const char *view = find_idle_view(o);
    const char *links = o->save_links   ? "--save-links"
                        : o->load_links ? "--load-links"
                                        : NULL;
    const struct {
        bool broken;
        const char *message, *name; /* the name for its %s */
    } rules[] = {
        {rays && !tree, "--final-gather goes with --linking tree", ""},
        {accurate && !tree, "--accuracy goes with --linking tree", ""},
        {accurate && !rays, "--accuracy and --final-gather 0 do not go together", ""},
        {o->pixels && !rays, "--final-gather pixels needs rays, and a tree", ""},
        {o->pixels && o->flat, "--flat and --final-gather pixels do not go together", ""},
        {scene && o->quiet && o->verbose, "--quiet and --verbose do not go together", ""},
        {!scene && !o->help && !o->version, "no scene given; see --help", ""},
        {scene && view, "--view %s: no picture (-o) follows it", view},
        {scene && o->resume && links,
         "--resume and %s do not go together: the initial links are long gone", links},
        {scene && o->save_links && o->load_links,
         "--save-links and --load-links do not go together", ""},
        {scene && links && tree, "%s goes with --linking pairs (--paper)", links},
        {scene && o->every > 0 && !o->checkpoint, "--every needs --checkpoint", ""},
    };
    for (size_t i = 0; i < sizeof rules / sizeof rules[0]; i++)
        if (rules[i].broken)
            return error_set(error, EXIT_USAGE, rules[i].message, rules[i].name);
    return true;
}

static const struct options DEFAULTS = {
    .samples = 3,
    .criterion = {.oracle = ORACLE_ERROR,
                  .linking = LINKING_TREE,
                  .form_factor = FORM_FACTOR_POLYGON,
                  .solver = SOLVER_CG,
                  .balance = BALANCE_DEFAULT,
                  .epsilon = -1.0,
                  .min_area = 1e-10,
                  .max_level = 10,
                  .alpha = 0.5,
                  .tolerance = 1e-5,
                  .max_iterations = 1000,
                  .final_gather = NOT_GIVEN},
};

bool options_parse(struct options *options, int argc, char **argv, struct error *error)
{
    *options = DEFAULTS;
    options->outputs = alloc_array((size_t)argc, sizeof *options->outputs);
    options->views = alloc_array((size_t)argc, sizeof *options->views);
    bool files = false; /* behind "--" */
    for (int i = 1; i < argc; i++) {
        const char *argument = argv[i];
        if (!files && strcmp(argument, "--") == 0) {
            files = true;
            continue;
        }
        if (files || argument[0] != '-' || argument[1] == '\0') {
            if (!add_scene(options, argument, error))
                return false;
            continue;
        }
        const struct option *option = find_option(argument);
        if (!option)
            return refuse_option(argument, error);
        if (!option->set)
            return error_set(error, EXIT_USAGE, "%s is a program of its own now: %s",
                             option->name, option->help);
        options->given |= UINT64_C(1) << (option - OPTIONS);
        options->overruled &= ~(UINT64_C(1) << (option - OPTIONS));
        bool alone = !*option->value;
        const char *value = argument[1] == '-' ? strchr(argument, '=') : NULL;
        value = value ? value + 1 : NULL;
        bool asks = value && option->offset == FIELD(help);
        if (asks && !set_help_on(options, value, error))
            return false;
        if (alone && value && !asks)
            return error_set(error, EXIT_USAGE, "%s takes no value", option->name);
        if (!alone && !value && ++i >= argc)
            return error_set(error, EXIT_USAGE, "%s needs a value", argument);
        if (!option->set(&(struct argument){option, value ? value : argv[i], options,
                                            (char *)options + option->offset, error}))
            return false;
    }
    set_defaults(options);
    if (!check_rules(options, error))
        return false;
    options->every = options->every > 0 ? options->every : 1;
    return true;
}

static char settings[1000]; /* of the last call of describe_all() */

/* Appends a line "--option value" to the settings. */
static void describe(const struct options *options, const char *name)
{
    size_t at = strlen(settings);
    const struct option *option = find_option(name);
    option_write(option, (const char *)options + option->offset, settings + at,
                 sizeof settings - at);
}

static const char *describe_all(const struct options *options, const char *const *names)
{
    settings[0] = '\0';
    for (; *names; names++)
        describe(options, *names);
    return settings;
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

const char *options_other(const struct options *options, const char *const *names)
{
    uint64_t others = options->given;
    for (; *names; names++)
        others &= ~(UINT64_C(1) << (find_option(*names) - OPTIONS));
    for (int i = 0; others; i++, others >>= 1)
        if (others & 1u)
            return OPTIONS[i].name;
    return NULL;
}

const char *options_link_settings(const struct options *options)
{
    static const char *const NAMES[] = {
        "--two-sided", "--two-sided-lamps", "--ke", "--oracle", "--form-factor", NULL};
    describe_all(options, NAMES);
    if (options->criterion.oracle == ORACLE_ERROR) /* epsilon refines visibility, too */
        describe(options, "--epsilon");
    return settings;
}

const char *options_run_settings(const struct options *options)
{
    static const char *const NAMES[] = {
        "--two-sided", "--two-sided-lamps", "--ke", "--oracle", "--linking",
        "--form-factor",
        "--solver", "--epsilon", "--accuracy", "--max-level", "--min-area", NULL};
    return describe_all(options, NAMES);
}

const char *options_light_settings(const struct options *options)
{
    static const char *const NAMES[] = {
        "--two-sided", "--two-sided-lamps", "--ke", "--sky", "--sun", "--oracle",
        "--linking", "--form-factor", "--solver", "--epsilon", "--accuracy",
        "--max-level", "--min-area", "--tolerance", "--final-gather", NULL};
    struct options plain = DEFAULTS;
    char line[100];
    size_t length = 0;
    set_defaults(&plain);
    settings[0] = '\0';
    for (const char *const *name = NAMES; *name; name++, settings[length] = '\0') {
        describe(&plain, *name);
        snprintf(line, sizeof line, "%s", settings + length);
        settings[length] = '\0';
        describe(options, *name);
        length += strcmp(settings + length, line) == 0 ? 0 : strlen(settings + length);
    }
    return settings;
}

void options_free(struct options *options)
{
    alloc_free(options->outputs);
    alloc_free((void *)options->views);
    options->outputs = NULL;
    options->views = NULL;
}

static const char HEAD[] =
    "usage: phr [options] SCENE         or  mpiexec -n P phr [options] SCENE\n"
    "Computes the light in a diffuse scene, OBJ, PLY or STL. Defaults in brackets.\n";
static const char FOOT[] =
    "Exit status: 0 done; 1 failed or stopped; 2 bad usage or input. Examples:\n"
    "  phr room.obj -o room.png\n"
    "  mpiexec -n 4 phr scenes/cornell.obj --view scenes/cornell.view -o box.pfm\n";

/* What --help=OPTION says beyond the table. */
static const struct {
    const char *option, *text;
} MORE[] = {
    {"--view", "  A view is a text file of lines, in any order; # begins a comment:\n"
               "    eye 278 273 -800     the camera's place, in units of the scene\n"
               "    at 278 273 0         a point in the middle of the picture\n"
               "    up 0 1 0             the direction that is up in it (0 1 0)\n"
               "    fov 45               the angle from bottom to top, degrees (45)\n"
               "    size 512 512         width and height, pixels (512 512)\n"
               "  Only eye and at are needed. An example is scenes/cornell.view.\n"},
    {"--time", "  as 90s, 5m, 1h: end then, with the light that there is\n"},
    {"--max-level", "  of subdivision (10)\n"},
    {"--verbose", "  the levels of refinement, and more\n"},
    {"--dump", "  prints all patches, or all links, in place of the summary\n"},
    {"--show", "  P is a patch, as 5/023, or a pixel, as 99,42. False colours of\n"
               "  radiosity or irradiance: see --lux, --lines, --exposure, too.\n"},
    {"--at", "  A point is a line of six numbers: x y z and a normal, with blanks or\n"
             "  commas between. Lines of CSV go to the standard output.\n"},
    {"--sky", "  Or overcast,L or clear,L (those of the CIE; L: radiance of the zenith,\n"
              "  or R,G,B), or a file of radiances by direction, of Radiance's\n"
              "  gendaymtx. A clear sky needs --sun.\n"},
    {"--sun", "  The direction towards the sun, and what a surface that faces it\n"
              "  receives, W/m^2. 0,0,1 is straight up where z is.\n"},
    {"--ke", "  The unit of Ke, and of emissions in PLY files: W/m^2 (radiosity), or\n"
             "  W/m^2/sr (radiance), which is what Blender writes to its files.\n"},
    {"--min-area", "  of a patch, relative to the scene (1e-10)\n"},
    {"--tolerance", "  of the solution (1e-5)\n"},
    {"--max-iterations", "  at most (1000)\n"},
    {"--oracle", "  what splits a link: its error, or as in the paper\n"},
    {"--linking", "  where links begin: at the top of a tree, or as in the paper\n"},
    {"--form-factor", "  of links: from points to polygons, or as in the paper\n"},
    {"--solver", "  over the links: conjugate residuals, or as in the paper\n"},
    {"--balance", "  how links are dealt to ranks\n"},
    {"--alpha", "  share of its parent's cost in a link's (0.5)\n"},
    {"--save-links", "  the links of all pairs, with --paper\n"},
    {"--load-links", "  the links of all pairs, with --paper, in their place\n"},
    {"--every", "  a checkpoint only at each N-th pass (1)\n"},
};

/* Prints name, value and words of an option; the words behind so many characters. Returns
 * the length. */
static int print_option(const struct option *option, int width, FILE *file)
{
    int length = fprintf(file, "%s%s%s", option->name, *option->value ? " " : "",
                         option->value);
    int gap = *option->help ? (length < width ? width - length : 0) + 2 : 0;
    return length + fprintf(file, "%*s%s", gap, "", option->help);
}

/* Prints the options with words in two columns, an option too wide on a line of its own;
 * then those without, one after the other. */
static void print_options(FILE *file)
{
    enum { COLUMN = 40, CALL_LEFT = 14, CALL_RIGHT = 12, WIDTH = 79 }; /* characters */
    bool right = false;
    for (int i = 0; i < OPTION_COUNT && OPTIONS[i].set; i++) {
        if (!*OPTIONS[i].help)
            continue;
        fputs(right ? "" : "  ", file);
        int length = print_option(&OPTIONS[i], right ? CALL_RIGHT : CALL_LEFT, file);
        right = !right && length < COLUMN;
        fprintf(file, "%*s%s", right ? COLUMN - length : 0, "", right ? "" : "\n");
    }
    int at = WIDTH;
    fputs(right ? "\n" : "", file);
    for (int i = 0; i < OPTION_COUNT && OPTIONS[i].set; i++) {
        int length = (int)(strlen(OPTIONS[i].name) + strlen(OPTIONS[i].value) + 3);
        if (*OPTIONS[i].help)
            continue;
        if (at + length > WIDTH)
            at = fprintf(file, "%s ", at < WIDTH ? "\n" : "") - (at < WIDTH);
        at += fprintf(file, " ");
        at += print_option(&OPTIONS[i], 0, file);
    }
    fputs("\n", file);
}

void options_print_help(const char *option, FILE *file)
{
    const struct option *o = option ? find_option(option) : NULL;
    if (!o || !o->set) {
        fputs(HEAD, file);
        print_options(file);
        fputs(FOOT, file);
        return;
    }
    fputs("  ", file);
    print_option(o, 0, file);
    fputs("\n", file);
    if (o->high > o->low)
        fprintf(file, "  from %g to %g\n", o->low, o->high);
    if (o->choices)
        fprintf(file, "  one of %s\n", o->choices);
    for (size_t i = 0; i < sizeof MORE / sizeof MORE[0]; i++)
        if (strcmp(MORE[i].option, o->name) == 0)
            fputs(MORE[i].text, file);
    fputs("The manual, phr.1, has more.\n", file);
}
