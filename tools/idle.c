/* Options that do nothing. A list names the options used for one purpose alone; the
 * options to bound a computation are in no list, since every computation heeds them. */
#include "tools/idle.h"

enum { NAMES_MOST = 64 };

/* Names of options; the last is NULL. */
struct names {
    const char *name[NAMES_MOST];
    int count;
};

static const char *const PICTURE[] = {"--size", "--samples", "--show", NULL};
static const char *const COLOUR[] = {"--exposure", NULL};
static const char *const OUTPUT[] = {"--flat", NULL};
static const char *const SCALE[] = {"--lines", NULL};
static const char *const UNIT[] = {"--lux", NULL};
static const char *const LIGHT[] = {
    "--min-area", "--oracle", "--linking", "--form-factor", "--solver", "--balance",
    "--paper", "--alpha", "--tolerance", "--max-iterations", "--ke", "--memory", NULL};
static const char *const PREDICTION[] = {"--alpha", NULL};
static const char *const GATHER[] = {"--final-gather", NULL};
static const char *const FACTORS[] = {"--epsilon", "--accuracy", "--max-level",
                                      "--sky", "--sun", "--two-sided",
                                      "--two-sided-lamps", NULL};
static const char *const METHOD[] = {"--oracle", "--linking", "--form-factor",
                                     "--solver", "--balance", NULL};

static void add(struct names *names, const char *const *list)
{
    for (; *list; list++)
        names->name[names->count++] = *list;
}

/* True if the pictures show light, also by false colours, a mesh or links: patches drawn
 * over light. */
static bool shows_light(const struct options *options)
{
    return options->show <= SHOW_MESH || options->show == SHOW_LINKS;
}

/* True if predicted costs move links, or are told. */
static bool predicts(const struct options *options)
{
    return options->criterion.balance == BALANCE_GREEDY || options->stats ||
           options->verbose || options->checkpoint;
}

/* Adds the options of no use to the outputs. Returns true if gathering pixels are among
 * them. */
static bool add_idle(const struct options *options, struct names *names)
{
    bool pictures = false, colours = false, light = false;
    for (int i = 0; i < options->output_count; i++) {
        enum output_format format = options->outputs[i].format;
        bool picture = !format_is_mesh(format);
        pictures = pictures || picture;
        colours = colours || format_has_tone(format);
        light = light || !picture || shows_light(options);
    }
    if (!pictures)
        add(names, PICTURE);
    if (!colours)
        add(names, COLOUR);
    if (!light)
        add(names, OUTPUT);
    bool falsely = colours && (options->show == SHOW_RADIOSITY ||
                               options->show == SHOW_IRRADIANCE);
    if (!falsely)
        add(names, SCALE);
    if (!falsely && !options->at && !options->report)
        add(names, UNIT);
    return options->pixels && !(pictures && shows_light(options));
}

static void warn_overruled(struct run *run)
{
    struct options before = run->options;
    before.given = run->options.overruled;
    const char *given = options_given(&before, METHOD);
    if (*given)
        run_say(run, "warning: no use is made of %s: --paper follows", given);
}

void idle_warn(struct run *run)
{
    struct names names = {.count = 0};
    warn_overruled(run);
    bool pixels = add_idle(&run->options, &names);
    if (!predicts(&run->options))
        add(&names, PREDICTION);
    const char *given = options_given(&run->options, names.name);
    if (*given || pixels)
        run_say(run, "warning: no use is made of %s%s%s", given,
                *given && pixels ? ", " : "", pixels ? "--final-gather pixels" : "");
}

void idle_warn_stored(struct run *run)
{
    struct names names = {.count = 0};
    add(&names, FACTORS);
    add(&names, LIGHT);
    if (!run->options.pixels)
        add(&names, GATHER);
    const char *given = options_given(&run->options, names.name);
    if (*given)
        run_say(run, "warning: %s is a stored solution: no use is made of %s",
                run->options.scene, given);
}
