/* Tests of io/run/options.h. Proved are: each option goes to its field; each kind of
 * wrong argument is refused with a line that names it; and the help says which options
 * have values, and their defaults. */
#include "io/run/options.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "tests/refusal.h"

enum { ARGUMENTS_MAX = 12, TEXT_MAX = 100000 };

static struct options options; /* of the last line */

/* Parses a command line; blanks separate its words ("_" is an empty one). */
static bool parse(const char *line)
{
    static char words[200]; /* the options keep pointers into it */
    static char *arguments[ARGUMENTS_MAX + 1];
    int count = 0;
    options_free(&options);
    forget_error();
    snprintf(words, sizeof words, "phr %s", line);
    for (char *word = strtok(words, " "); word && count < ARGUMENTS_MAX;
         word = strtok(NULL, " "))
        arguments[count++] = strcmp(word, "_") == 0 ? word + 1 : word;
    arguments[count] = NULL;
    return options_parse(&options, count, arguments, &error);
}

static bool is_same(const char *found, const char *expected)
{
    return found && strcmp(found, expected) == 0;
}

/* True if the value is refused by a line with the option, the value and the reason. */
static bool refuses(const char *name, const char *value, const char *reason)
{
    char line[100], message[200];
    snprintf(line, sizeof line, "a.obj %s %s", name, *value ? value : "_");
    snprintf(message, sizeof message, "%s: '%s' is not %s", name, value, reason);
    return is_refused_as(parse(line), message);
}

/* --- fields --- */

static void test_defaults(void)
{
    tap_ok(parse("room.obj") && error.code == EXIT_DONE &&
               is_same(options.scene, "room.obj") && options.output_count == 0 &&
               options.view_count == 0 && !options.stats && options.width == 0 &&
               options.height == 0 && options.exposure == 0.0 && !options.flat &&
               !options.two_sided && !options.two_sided_lamps && !options.quiet &&
               !options.verbose && !options.help && !options.version,
           "a scene alone: all switches are off");
}

static void test_texts(void)
{
    tap_ok(parse("--resume a room.obj --stats b.json") && is_same(options.resume, "a") &&
               is_same(options.stats, "b.json") && is_same(options.scene, "room.obj"),
           "--resume and --stats, before and behind the scene");
    tap_ok(parse("room.obj --stats --flat") && is_same(options.stats, "--flat") &&
               !options.flat,
           "the word behind an option is its value");
    tap_ok(parse("-") && is_same(options.scene, "-"), "a lone - is a name");
}

static void test_outputs(void)
{
    tap_ok(parse("-o a.ppm room.obj -o b.ply -o d/c.pfm") && options.output_count == 3 &&
               is_same(options.outputs[0].path, "a.ppm") &&
               is_same(options.outputs[1].path, "b.ply") &&
               is_same(options.outputs[2].path, "d/c.pfm"),
           "-o, three times");
    options_free(&options);
    tap_ok(!options.outputs, "options_free() forgets the outputs");
    static const struct {
        const char *argument, *path;
        enum output_format format;
        bool has_format;
    } TARGETS[] = {
        {"a.PPM", "a.PPM", FORMAT_PPM, true},
        {"a.ppm.pfm", "a.ppm.pfm", FORMAT_PFM, true},
        {"d.ppm/a.ply", "d.ppm/a.ply", FORMAT_PLY, true},
        {"ppm:a", "a", FORMAT_PPM, true},
        {"PLY:a.ppm", "a.ppm", FORMAT_PLY, true},
        {"pfm:ppm:a", "ppm:a", FORMAT_PFM, true},
        {"./ppm:a.ply", "./ppm:a.ply", FORMAT_PLY, true},
        {"ppm1:a.ply", "ppm1:a.ply", FORMAT_PLY, true},
        {"a.ppm.gz", "a.ppm.gz", FORMAT_PPM, false},
        {".pfm", ".pfm", FORMAT_PPM, false},
        {"a.error.pfm", "a.error.pfm", FORMAT_ERROR, true},
        {"pfm:a.error.pfm", "a.error.pfm", FORMAT_PFM, true},
        {"error.pfm:a", "a", FORMAT_ERROR, true},
        {"a.ply/", "a.ply/", FORMAT_PPM, false},
    };
    for (size_t i = 0; i < sizeof TARGETS / sizeof TARGETS[0]; i++) {
        struct target target = target_parse(TARGETS[i].argument);
        tap_ok(is_same(target.path, TARGETS[i].path) &&
                   target.format == TARGETS[i].format &&
                   target.has_format == TARGETS[i].has_format,
               "a prefix or the suffix is the format: %s", TARGETS[i].argument);
    }
}

/* True if these arguments are taken, and the outputs belong to these views. */
static bool belong(const char *arguments, int views, const int *view_of)
{
    bool good = parse(arguments) && options.view_count == views;
    for (int i = 0; good && i < options.output_count; i++)
        good = options.outputs[i].view == view_of[i];
    return good;
}

static void test_views(void)
{
    tap_ok(belong("a.obj -o a.ppm -o b.pfm", 0, (const int[]){0, 0}), "no view");
    tap_ok(belong("a.obj --view a -o a.ppm --view b -o b.pfm -o c.ppm", 2,
                  (const int[]){0, 1, 1}),
           "each picture belongs to the last view before it");
    tap_ok(belong("-o a.ppm a.obj --view a", 1, (const int[]){0}) &&
               belong("-o a.ppm --view a --view b -o b.ppm a.obj", 2,
                      (const int[]){0, 1}),
           "those before all views to the first");
}

static void test_switches(void)
{
    tap_ok(parse("--flat a.obj") && options.flat && !options.two_sided, "--flat");
    tap_ok(parse("--two-sided a.obj") && options.two_sided && !options.flat &&
               !options.two_sided_lamps,
           "--two-sided");
    tap_ok(parse("--two-sided-lamps a.obj") && options.two_sided &&
               options.two_sided_lamps,
           "--two-sided-lamps includes --two-sided");
    const double *sky = options.sky.level.band;
    tap_ok(parse("--sky 2.5 a.obj") && sky[0] == 2.5 && sky[1] == 2.5 && sky[2] == 2.5,
           "--sky of one number");
    tap_ok(parse("--sky 1,2,0 a.obj") && sky[0] == 1.0 && sky[1] == 2.0 && sky[2] == 0.0,
           "of R,G,B");
    tap_ok(!parse("--sky 1,2 a.obj") && !parse("--sky 1,2,3,4 a.obj") &&
               !parse("--sky 1,,2 a.obj") && !parse("--sky -1 a.obj"),
           "of nothing else");
    tap_ok(parse("--time 5m a.obj") && options.seconds == 300 &&
               parse("--time 90 a.obj") && options.seconds == 90 &&
               !parse("--time 0 a.obj") && !parse("--time 5x a.obj"),
           "--time, in seconds or a unit");
    tap_ok(parse("--sky clear,1,2,3 --sun 1,-2,3,4 a.obj") && sky[2] == 3.0 &&
               options.sky.kind == SKY_CLEAR && options.sky.sun.y == -2.0 &&
               options.sky.sun_irradiance == 4.0,
           "a clear sky, and a sun");
    tap_ok(parse("--sky a.mtx a.obj") && is_same(options.sky.path, "a.mtx") &&
               parse("--sky overcast,2 a.obj") && !options.sky.path &&
               options.sky.kind == SKY_OVERCAST && sky[0] == 2.0 &&
               !parse("--sky overcast,x a.obj") && !parse("--sun 1,2,3 a.obj") &&
               !parse("--sun 0,0,0,1 a.obj") && !parse("--sun 1,2,3,-1 a.obj"),
           "an overcast sky, a file, and what is neither");
    tap_ok(parse("--quiet a.obj") && options.quiet && !options.verbose &&
               parse("--verbose a.obj") && options.verbose && !options.quiet,
           "--quiet and --verbose");
    tap_ok(parse("--help") && options.help && !options.version && !options.scene &&
               parse("-h") && options.help && !options.help_on &&
               parse("--version") && options.version && !options.help,
           "--help, -h and --version need no scene");
    tap_ok(parse("--help=epsilon") && strcmp(options.help_on, "--epsilon") == 0 &&
               parse("--help=-o") && strcmp(options.help_on, "-o") == 0,
           "--help=OPTION, with dashes or without");
    tap_ok(parse("--samples=5 --size=7x8 -- -a.obj") && options.samples == 5 &&
               options.width == 7 && strcmp(options.scene, "-a.obj") == 0,
           "values behind '=', and a scene behind --");
    tap_ok(parse("--accuracy 2.5% a.obj") && options.criterion.accuracy == 0.025 &&
               options.criterion.epsilon == 1e-3 && options.criterion.final_gather == 64,
           "--accuracy in percent, from a coarse epsilon and few rays");
    tap_ok(parse("--accuracy 0.5 --epsilon 1e-4 --final-gather 32 a.obj") &&
               options.criterion.accuracy == 0.5 && options.criterion.epsilon == 1e-4 &&
               options.criterion.final_gather == 32,
           "--accuracy from a given epsilon and number of rays");
    tap_ok(!parse("--accuracy % a.obj") && !parse("--accuracy 0.001% a.obj") &&
               !parse("--accuracy 1%% a.obj"),
           "not %% alone, not too little, not twice");
}

/* --- choices --- */

/* Where a choice goes, and its names in the order of its enum. */
struct choice {
    const char *name;
    size_t offset; /* in struct options */
    int count;
    const char *values[4];
    const char *kind; /* as an error says it */
};

#define FIELD(field) offsetof(struct options, field)

static const struct choice CHOICES[] = {
    {"--oracle", FIELD(criterion.oracle), 2, {"bf", "error", NULL}, "one of bf|error"},
    {"--linking", FIELD(criterion.linking), 2, {"pairs", "tree", NULL},
     "one of pairs|tree"},
    {"--form-factor", FIELD(criterion.form_factor), 2, {"disk", "polygon", NULL},
     "one of disk|polygon"},
    {"--solver", FIELD(criterion.solver), 2, {"jacobi", "cg", NULL}, "one of jacobi|cg"},
    {"--balance", FIELD(criterion.balance), 3, {"none", "greedy", "default", NULL},
     "one of none|greedy|default"},
    {"--dump", FIELD(dump), 3, {"nothing", "patches", "links", NULL},
     "one of nothing|patches|links"},
};
enum { CHOICE_COUNT = sizeof CHOICES / sizeof CHOICES[0] };

static int chosen(const struct choice *choice, const struct options *from)
{
    return *(const int *)(const void *)((const char *)from + choice->offset);
}

static void test_choices(void)
{
    parse("a.obj");
    const struct options plain = options; /* its choices */
    for (int i = 0; i < CHOICE_COUNT; i++) {
        const struct choice *choice = &CHOICES[i];
        char line[100];
        for (int k = 0; k < choice->count; k++) {
            bool others = true;
            snprintf(line, sizeof line, "%s %s a.obj", choice->name, choice->values[k]);
            bool parsed = parse(line);
            for (int j = 0; j < CHOICE_COUNT; j++)
                others = others && (j == i || chosen(&CHOICES[j], &options) ==
                                                  chosen(&CHOICES[j], &plain));
            tap_ok(parsed && chosen(choice, &options) == k && others,
                   "%s %s, and no other", choice->name, choice->values[k]);
        }
        /* The start of a name is none. */
        snprintf(line, sizeof line, "%.2s", choice->values[1]);
        const char *const wrong[] = {"of-delphi", "", strchr(choice->kind, ' ') + 4,
                                     strlen(choice->values[1]) == 2 ? "x" : line};
        for (int k = 0; k < 4; k++)
            tap_ok(refuses(choice->name, wrong[k], choice->kind), "%s refuses '%s'",
                   choice->name, wrong[k]);
    }
}

static void test_enums(void)
{
    tap_ok(ORACLE_BF == 0 && ORACLE_ERROR == 1 && FORM_FACTOR_DISK == 0 &&
               FORM_FACTOR_POLYGON == 1 && SOLVER_JACOBI == 0 && SOLVER_CG == 1 &&
               LINKING_PAIRS == 0 && LINKING_TREE == 1 && BALANCE_NONE == 0 &&
               BALANCE_GREEDY == 1 && BALANCE_DEFAULT == 2,
           "the names are in the order of the enums");
}

static void test_paper(void)
{
    parse("a.obj");
    const struct criterion plain = options.criterion, *made = &options.criterion;
    tap_ok(!parse("--solver cg --oracle error --form-factor polygon --paper") &&
               is_same(error.text, "no scene given; see --help") &&
               made->oracle == ORACLE_BF && made->solver == SOLVER_JACOBI &&
               made->form_factor == FORM_FACTOR_DISK && made->balance == BALANCE_GREEDY &&
               made->linking == LINKING_PAIRS && made->alpha == plain.alpha &&
               made->tolerance == plain.tolerance,
           "--paper is the paper's oracle, linking, form factor, solver and balance");
    tap_ok(parse("--paper --solver cg a.obj") && made->solver == SOLVER_CG &&
               made->oracle == ORACLE_BF,
           "options behind it count");
}

static void test_sizes(void)
{
    static const char *const WRONG[] = {"5", "5x", "x5", "5x5x", "0x5", "5x0", "5.5x5",
                                        "32769x1", "1x32769", "5*5",
                                        "99999999999999999999x5", "4294967297x5"};
    tap_ok(parse("--size 640x480 a.obj") && options.width == 640 &&
               options.height == 480 && parse("--size 1X32768 a.obj") &&
               options.width == 1 && options.height == 32768,
           "--size 640x480 and 1X32768");
    for (size_t i = 0; i < sizeof WRONG / sizeof WRONG[0]; i++)
        tap_ok(refuses("--size", WRONG[i], "WIDTHxHEIGHT, each from 1 to 32768"),
               "--size refuses %s", WRONG[i]);
}

/* Options with a number: its field, its range, and whether the help says its default. */
struct number {
    const char *name;
    size_t offset;         /* in struct options */
    bool is_int, in_help;
    const char *low, *high; /* inside the range */
    const char *below, *above; /* outside */
};

static const struct number NUMBERS[] = {
    {"--samples", FIELD(samples), true, true, "1", "64", "0", "65"},
    {"--exposure", FIELD(exposure), false, false, "1e-30", "1e30", "0", "2e30"},
    {"--epsilon", FIELD(criterion.epsilon), false, true, "0", "1e30", "-1e-9", "1e31"},
    {"--accuracy", FIELD(criterion.accuracy), false, false, "1e-4", "1", "0", "1.1"},
    {"--max-level", FIELD(criterion.max_level), true, true, "0", "15", "-1", "16"},
    {"--min-area", FIELD(criterion.min_area), false, true, "0", "1", "-1e-300", "1.0001"},
    {"--alpha", FIELD(criterion.alpha), false, true, "0", "1", "-0.1", "1.1"},
    {"--tolerance", FIELD(criterion.tolerance), false, true, "0", "1", "-1", "2"},
    {"--every", FIELD(every), true, true, "1", "1000000000", "0", "1e10"},
    {"--max-iterations", FIELD(criterion.max_iterations), true, true, "1", "1000000000",
     "0", "1e300"},
    {"--final-gather", FIELD(criterion.final_gather), true, true, "0", "16384", "-1",
     "16385"},
};
enum { NUMBER_COUNT = sizeof NUMBERS / sizeof NUMBERS[0] };

static double number_of(const struct number *number)
{
    const char *field = (const char *)&options + number->offset;
    return number->is_int ? *(const int *)(const void *)field
                          : *(const double *)(const void *)field;
}

/* Whether the value is taken and arrives. */
static bool takes(const struct number *number, const char *value)
{
    char line[100];
    snprintf(line, sizeof line, "%s %s a.obj --checkpoint b", number->name, value);
    return parse(line) && number_of(number) == strtod(value, NULL);
}

/* True if the value is refused as one out of range. */
static bool refuses_range(const char *name, const char *value)
{
    char line[100], start[100];
    snprintf(line, sizeof line, "a.obj %s %s", name, value);
    snprintf(start, sizeof start, "%s: %s is not between ", name, value);
    return !parse(line) && error.code == EXIT_USAGE &&
           strncmp(error.text, start, strlen(start)) == 0;
}

static void test_numbers(void)
{
    static const char *const WORDS[] = {"", "1x", "nan"};
    for (int i = 0; i < NUMBER_COUNT; i++) {
        const struct number *number = &NUMBERS[i];
        tap_ok(takes(number, number->low) && takes(number, number->high),
               "%s takes %s and %s", number->name, number->low, number->high);
        tap_ok(refuses_range(number->name, number->below) &&
                   refuses_range(number->name, number->above),
               "%s refuses %s and %s", number->name, number->below, number->above);
        for (size_t k = 0; k < sizeof WORDS / sizeof WORDS[0]; k++)
            tap_ok(refuses(number->name, WORDS[k], "a number"), "%s refuses %s",
                   number->name, WORDS[k]);
        tap_ok(number->is_int ? refuses(number->name, "1.5", "a whole number")
                              : takes(number, "0.375"),
               "%s %s a fraction", number->name, number->is_int ? "refuses" : "takes");
    }
}

/* --- errors --- */

static void check_refused(const char *line, const char *message)
{
    check_error(parse(line), message);
}

static void test_errors(void)
{
    check_refused("", "no scene given; see --help");
    check_refused("a.obj b.obj", "one scene at a time: a.obj and b.obj");
    check_refused("a.obj --flat=1", "--flat takes no value");
    check_refused("a.obj -o=1", "unknown option -o=1; see --help");
    check_refused("a.obj --samples=x", "--samples: 'x' is not a number");
    check_refused("--help=eps", "--help: there is no option eps");
    check_refused("a.obj --Flat", "unknown option --Flat; did you mean --flat?");
    check_refused("a.obj -- --flat", "one scene at a time: a.obj and --flat");
    check_refused("a.obj -o ppm:",
                  "-o ppm:: the name must end in .ppm, .pfm, .png, .hdr, .ply, .vtk, "
                  ".glb or .error.pfm, or be FORMAT:FILE, as in ppm:FILE");
    check_refused("a.obj --accuracy 101%",
                  "--accuracy: 101% is not between 0.01 % and 100 %");
    check_refused("a.obj --accuracy 5", "--accuracy: 5 is not between 0.0001 and 1; "
                                        "percents end in %, as in 1%");
    check_refused("a.obj --memory 0", "--memory: 0 is not between 1 and 1e+18 bytes");
    check_refused("a.obj --max-level 16", "--max-level: 16 is not between 0 and 15");
    check_refused("a.obj --view a -o m.ply --view b -o b.ppm",
                  "--view a: no picture (-o) follows it");
    check_refused("--flat --fast --help", "unknown option --fast; did you mean --flat?");
    check_refused("a.obj --quiet --verbose", "--quiet and --verbose do not go together");
    check_refused("a.obj --stats a.json --stats b.json",
                  "--stats is given twice: a.json and b.json");
}

/* --- going on, and memory --- */

static void test_memory(void)
{
    static const struct {
        const char *text;
        int64_t bytes;
    } CASES[] = {{"1", 1}, {"3K", 3072}, {"512M", INT64_C(1) << 29},
                 {"2G", INT64_C(1) << 31}, {"3T", INT64_C(3) << 40}};
    static const char *const BEYOND[] = {"0", "-1G", "9999999T", "99999999999999999999"};
    static const char *const WORDS[] = {"G", "1.5G", "1g", "1GB", ""};
    char line[100];
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; i++) {
        snprintf(line, sizeof line, "a.obj --memory %s", CASES[i].text);
        tap_ok(parse(line) && options.memory == CASES[i].bytes, "--memory %s",
               CASES[i].text);
    }
    for (size_t i = 0; i < sizeof BEYOND / sizeof BEYOND[0]; i++)
        tap_ok(refuses_range("--memory", BEYOND[i]), "--memory refuses %s", BEYOND[i]);
    for (size_t i = 0; i < sizeof WORDS / sizeof WORDS[0]; i++)
        tap_ok(refuses("--memory", WORDS[i], "a number of bytes, such as 512M or 2G"),
               "--memory refuses '%s'", WORDS[i]);
}

static void test_restart(void)
{
    tap_ok(parse("a.obj --resume c --checkpoint c --every 3") &&
               is_same(options.resume, "c") && is_same(options.checkpoint, "c") &&
               options.every == 3,
           "a checkpoint may be renewed");
    tap_ok(parse("a.obj --paper --save-links l") && is_same(options.save_links, "l") &&
               parse("a.obj --load-links l --linking pairs") &&
               is_same(options.load_links, "l"),
           "--save-links and --load-links");
    check_refused("a.obj --save-links l",
                  "--save-links goes with --linking pairs (--paper)");
    check_refused("a.obj --paper --final-gather 64",
                  "--final-gather goes with --linking tree");
    check_refused("a.obj --paper --final-gather pixels",
                  "--final-gather pixels needs rays, and a tree");
    check_refused("a.obj --flat --final-gather pixels",
                  "--flat and --final-gather pixels do not go together");
    check_refused("a.obj --final-gather 64pixels",
                  "--final-gather: '64pixels' is not N, pixels or N,pixels");
    check_refused("a.obj --final-gather 6x,pixels",
                  "--final-gather: '6x' is not a number");
    tap_ok(parse("a.obj --final-gather pixels") && options.pixels &&
               options.criterion.final_gather == 256,
           "a final gather of pixels has as many rays as one of leaves");
    tap_ok(parse("a.obj --final-gather 64,pixels") && options.pixels &&
               options.criterion.final_gather == 64,
           "or as many as are given");
    tap_ok(parse("a.obj --accuracy 5% --final-gather pixels") &&
               options.criterion.final_gather == 64 && options.pixel_rays == 256 &&
               parse("a.obj --accuracy 5% --final-gather 16,pixels") &&
               options.criterion.final_gather == 16 && options.pixel_rays == 0,
           "with --accuracy pixels have the default, too, or those that are given");
    tap_ok(parse("a.obj --final-gather 16 --final-gather pixels") && options.pixels &&
               options.criterion.final_gather == 256 &&
               parse("a.obj --final-gather 0 --final-gather pixels") &&
               options.criterion.final_gather == 256 &&
               parse("a.obj --final-gather 16,pixels --final-gather 64") &&
               !options.pixels && options.criterion.final_gather == 64,
           "the last final gather counts, for rays and for pixels");
    check_refused("a.obj --paper --accuracy 1%", "--accuracy goes with --linking tree");
    check_refused("a.obj --final-gather 0 --accuracy 1%",
                  "--accuracy and --final-gather 0 do not go together");
    check_refused("a.obj --every 2", "--every needs --checkpoint");
    check_refused("a.obj --save-links l --load-links m",
                  "--save-links and --load-links do not go together");
    check_refused(
        "a.obj --resume c --load-links l",
        "--resume and --load-links do not go together: the initial links are long gone");
}

static void test_settings(void)
{
    parse("a.obj");
    tap_ok(is_same(options_link_settings(&options),
                   "--two-sided off\n--two-sided-lamps off\n--ke radiosity\n"
                   "--oracle error\n"
                   "--form-factor polygon\n--epsilon 0.0001\n"),
           "the options that links are bound to");
    tap_ok(is_same(options_run_settings(&options),
                   "--two-sided off\n--two-sided-lamps off\n--ke radiosity\n"
                   "--oracle error\n"
                   "--linking tree\n--form-factor polygon\n--solver cg\n"
                   "--epsilon 0.0001\n--accuracy 0\n--max-level 10\n"
                   "--min-area 1e-10\n"),
           "the options that a run is bound to");
    parse("a.obj --paper --two-sided --epsilon 0.5");
    tap_ok(is_same(options_link_settings(&options),
                   "--two-sided on\n--two-sided-lamps off\n--ke radiosity\n"
                   "--oracle bf\n--form-factor disk\n"),
           "by energy, epsilon does not matter to links");
    parse("a.obj --two-sided-lamps");
    static const char BOTH[] = "--two-sided on\n--two-sided-lamps on\n";
    tap_ok(strncmp(options_link_settings(&options), BOTH, strlen(BOTH)) == 0 &&
               strncmp(options_run_settings(&options), BOTH, strlen(BOTH)) == 0,
           "twins of lamps do");
    parse("a.obj --ke radiance");
    tap_ok(options.ke == KE_RADIANCE &&
               strstr(options_link_settings(&options), "--ke radiance\n") &&
               strstr(options_run_settings(&options), "--ke radiance\n"),
           "and what Ke is");
    check_refused("a.obj --ke watts", "--ke: 'watts' is not one of radiosity|radiance");
}

/* --- the help --- */

static char help[TEXT_MAX];

/* Keeps the help on an option, or on all if it is NULL. */
static bool read_help(const char *option)
{
    FILE *file = tmpfile();
    if (!file)
        return false;
    options_print_help(option, file);
    rewind(file);
    help[fread(help, 1, TEXT_MAX - 1, file)] = '\0';
    fclose(file);
    return strncmp(help, option ? "  -" : "usage: phr ", 3) == 0;
}

/* An option that has a value stands one space before it, a flag two before its words. */
static void test_missing_values(void)
{
    char line[50], message[100];
    int count = 0;
    tap_ok(read_help(NULL), "there is a help");
    for (const char *at = strstr(help, "--"); at; at = strstr(at + 2, "--"), count++) {
        int length = (int)strspn(at, "-abcdefghijklmnopqrstuvwxyz");
        bool flag = at[length] != ' ' || at[length + 1] == ' ';
        snprintf(line, sizeof line, "a.obj %.*s%s", length, at, flag ? "=1" : "");
        snprintf(message, sizeof message, "%.*s %s", length, at,
                 flag ? "takes no value" : "needs a value");
        if (strncmp(at, "--help", 6) != 0)
            check_refused(line, message);
    }
    check_refused("a.obj -o", "-o needs a value");
    tap_ok(count > 30, "of %d options in the help", count);
}

/* The default value stands in brackets. */
static void test_help_defaults(void)
{
    parse("a.obj");
    for (int i = 0; i < NUMBER_COUNT; i++) {
        if (!NUMBERS[i].in_help)
            continue;
        const char *bracket = read_help(NUMBERS[i].name) ? strchr(help, '(') : NULL;
        double said = bracket ? strtod(bracket + 1, NULL) : NAN,
               is = number_of(&NUMBERS[i]);
        tap_ok(said == is, "%s: the help says %g, the default is %g", NUMBERS[i].name,
               said, is);
    }
}

int main(void)
{
    test_defaults();
    test_texts();
    test_outputs();
    test_views();
    test_switches();
    test_choices();
    test_enums();
    test_paper();
    test_sizes();
    test_numbers();
    test_errors();
    test_missing_values();
    test_memory();
    test_restart();
    test_settings();
    test_help_defaults();
    options_free(&options);
    return tap_done();
}
