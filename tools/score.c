/* score: somebody's numbers against right ones, and the likeliest slip where these are
 * wrong.
 *
 * A number is wrong if it is off by more than the sum of the error that it claims and the
 * uncertainty of the right one. Digits that agree are -log10 of the relative error, of
 * which the uncertainty is no part; 16 at most, as a double has. A slip (tools/slips.h)
 * explains a wrong number that is within 2 % of what the slip makes of the case, and four
 * times nearer to that than to the right one; the slip that explains most is named. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/elementary.h"
#include "tools/slips.h"

static const char HELP[] =
    "usage: score [options] CASES.csv RESULTS.csv\n"
    "       score --obj CASES.csv ID\n"
    "Scores the numbers of any program: view factors, means, light at points, powers.\n"
    "\n"
    "CASES    right answers, as docs/oracle/cases.csv, whose head names the columns\n"
    "RESULTS  lines of  id,value  or  id,value,error,  with what the program claims to\n"
    "         be off at most; # begins a comment. Cases that are not there are left out\n"
    "\n"
    "  --within R  what may be off where no error is claimed: R of the right value,\n"
    "              or of 1e-6, whichever is larger (0.01)\n"
    "  --brief     only what is wrong, and the summary\n"
    "  --obj       writes the polygons of a case as OBJ: groups 1, 2, ...\n"
    "  --help\n"
    "\n"
    "A line for each case: the right value and its uncertainty, the value given and its\n"
    "error, digits that agree, verdict. Then the first that is wrong, the slip that\n"
    "explains most of what is wrong (pi missing, A_i for A_j, a cosine missing,\n"
    "visibility from centre to centre, rows scaled to 1, half of a lamp, and those that\n"
    "a case names), and the median and the worst of the digits.\n"
    "Exit status: 0 all right; 1 something is wrong; 2 bad usage or input.\n";

static const double DIGITS_MOST = 16.0, LEAST = 1e-6, WITHIN = 0.01;

/* Of a slip: how near, relative; and how much nearer than to the right value. */
static const double NEAR = 0.02, NEARER = 0.25;

/* The share of what is wrong that a slip has to explain to be named. */
static const double MANY = 0.25;

struct scoring {
    const char *cases, *results; /* paths; of --obj the second is an ID */
    double within;
    bool brief, obj, help;
};

/* A number of RESULTS. */
struct given {
    const struct known_case *known;
    double value, error; /* `error`: as claimed, or below 0 */
    double digits;
    bool wrong;
    char slip[SLIP_NAME]; /* the one that explains it best, or "" */
};

struct score {
    struct cases cases;
    struct text text;
    struct given *given; /* [count] */
    int64_t count, capacity, wrong;
};

/* --- reading --- */

/* Words such as nan and inf are numbers, too, and wrong ones. */
static bool read_value(const struct text *text, const char *word, double *value,
                       struct error *error)
{
    char *end;
    if (text_is_number(word, value))
        return true;
    *value = strtod(word, &end);
    if (end == word || *end || isfinite(*value))
        return text_number(text, word, value, error);
    return true;
}

static bool add_result(struct score *score, char *line, struct error *error)
{
    char *field[3];
    int count = cases_cut(line, field, 3);
    struct given given = {.known = cases_find(&score->cases, field[0]), .error = -1.0};
    const char *path = score->text.path;
    long number = score->text.line;
    if (strcmp(field[0], "id") == 0)
        return true;
    if (count < 2 || count > 3)
        return error_set(error, EXIT_USAGE, "%s:%ld: not id,value or id,value,error",
                         path, number);
    if (!given.known)
        return error_set(error, EXIT_USAGE, "%s:%ld: no case is called '%s'", path,
                         number, field[0]);
    for (int64_t i = 0; i < score->count; i++)
        if (score->given[i].known == given.known)
            return error_set(error, EXIT_USAGE, "%s:%ld: %s is there twice", path,
                             number, field[0]);
    if (!read_value(&score->text, field[1], &given.value, error) ||
        (*field[2] && !text_number(&score->text, field[2], &given.error, error)))
        return false;
    if (*field[2] && given.error < 0.0)
        return error_set(error, EXIT_USAGE, "%s:%ld: an error below 0", path, number);
    RESERVE(score->given, &score->capacity, score->count + 1);
    score->given[score->count++] = given;
    return true;
}

static bool read_results(struct score *score, const char *path, struct error *error)
{
    if (!text_read(&score->text, path, error))
        return false;
    for (char *line; (line = text_line(&score->text)) != NULL;)
        if (*line != '#' && *text_trim(line) && !add_result(score, line, error))
            return false;
    return score->count > 0 || error_set(error, EXIT_USAGE, "%s: no results", path);
}

/* --- verdicts --- */

static double digits_of(const struct given *given)
{
    const struct known_case *known = given->known;
    double off = fmax(fabs(given->value - known->right), known->uncertainty);
    double part = known->right != 0.0 ? off / fabs(known->right) : off;
    if (!(part > 0.0) || !isfinite(part))
        return part == 0.0 ? DIGITS_MOST : 0.0;
    return fmax(0.0, fmin(DIGITS_MOST, -logarithm(part) / logarithm(10.0)));
}

static double allowed(const struct given *given, double within)
{
    return given->error >= 0.0 ? given->error
                               : within * fmax(fabs(given->known->right), LEAST);
}

/* True if both are factors from one polygon, or group, of a scene: IDs are alike up to
 * the last - or . */
static bool are_of_a_row(const struct known_case *a, const struct known_case *b)
{
    const char *end = strpbrk(a->id, "-."), *slash = strstr(a->geometry, " / ");
    if (a == b)
        return true;
    if (!end || a->what[0] != 'F' || b->what[0] != 'F' ||
        strncmp(a->id, b->id, (size_t)(end - a->id) + 1) != 0)
        return false;
    if (slash)
        return strncmp(a->geometry, b->geometry, (size_t)(slash - a->geometry)) == 0;
    size_t from = strcspn(a->what + 2, " ");
    return strncmp(a->what, b->what, from + 3) == 0;
}

/* Returns the sum of the right factors of the row of one, as far as it is given. */
static double row_of(const struct score *score, const struct known_case *known)
{
    double sum = 0.0;
    for (int64_t i = 0; i < score->count; i++)
        if (are_of_a_row(known, score->given[i].known))
            sum += score->given[i].known->right;
    return sum;
}

/* True if the slip makes nearly this of the case. */
static bool explains(const struct given *given, const struct slip *slip)
{
    double away = fabs(given->value - slip->value);
    double off = fabs(given->value - given->known->right);
    return away <= NEAR * fabs(slip->value) && away < NEARER * off;
}

/* The slips of a case, that of its row among them, and last what no factor can be. */
static int all_slips(const struct score *score, const struct given *given,
                     struct slip slips[SLIPS_MOST + 2])
{
    const struct known_case *known = given->known;
    int count = given->wrong ? slips_of(known, slips) : 0;
    if (count > 0 && known->what[0] == 'F' && known->right > 0.0)
        slips[count++] = (struct slip){"row scaled to 1",
                                       known->right / row_of(score, known)};
    if (count > 0 && known->what[0] == 'F' && given->value > 1.0 + NEAR)
        slips[count++] = (struct slip){"a row above 1", given->value};
    return count;
}

static void judge(struct score *score, struct given *given, double within)
{
    double off = fabs(given->value - given->known->right);
    given->digits = digits_of(given);
    given->wrong = !(off <= allowed(given, within) + given->known->uncertainty);
    score->wrong += given->wrong;
}

/* --- slips --- */

/* A slip and the number of wrong values that it explains. */
struct slip_tally {
    char name[SLIP_NAME];
    int64_t explained;
};

enum { NAMES_MOST = 256 };

struct tallies {
    struct slip_tally of[NAMES_MOST]; /* [count] in the order in which they turn up */
    int count;
};

static struct slip_tally *tally_of(struct tallies *tallies, const char *name)
{
    int k = 0;
    while (k < tallies->count && strcmp(tallies->of[k].name, name) != 0)
        k++;
    if (k == tallies->count && k < NAMES_MOST)
        tallies->of[tallies->count++] = (struct slip_tally){.explained = 0};
    k = k < NAMES_MOST ? k : NAMES_MOST - 1;
    memcpy(tallies->of[k].name, name, SLIP_NAME);
    return &tallies->of[k];
}

/* Counts, for each slip, the wrong values that it explains; a value counts for each. */
static void count_slips(const struct score *score, struct tallies *tallies)
{
    struct slip slips[SLIPS_MOST + 2];
    tallies->count = 0;
    for (int64_t i = 0; i < score->count; i++)
        for (int k = all_slips(score, &score->given[i], slips) - 1; k >= 0; k--)
            tally_of(tallies, slips[k].name)->explained +=
                explains(&score->given[i], &slips[k]);
}

/* Names for each wrong value the slip that explains it and most others; of equal ones
 * the plainest. */
static void name_slips(struct score *score, struct tallies *tallies)
{
    struct slip slips[SLIPS_MOST + 2];
    for (int64_t i = 0; i < score->count; i++) {
        struct given *given = &score->given[i];
        int64_t most = 0;
        int count = all_slips(score, given, slips);
        for (int k = 0; k < count; k++) {
            const struct slip_tally *tally = tally_of(tallies, slips[k].name);
            if (explains(given, &slips[k]) && tally->explained > most) {
                most = tally->explained;
                memcpy(given->slip, tally->name, SLIP_NAME);
            }
        }
    }
}

/* --- printing --- */

static void print_given(const struct given *given)
{
    const struct known_case *known = given->known;
    printf("%-22s %-17.12g %-7.1g %-17.12g ", known->id, known->right,
           known->uncertainty, given->value);
    if (given->error >= 0.0)
        printf("%-7.1g ", given->error);
    else
        printf("%-7s ", "-");
    printf("%4.1f  %s", given->digits, given->wrong ? "WRONG" : "right");
    printf(*given->slip ? ": %s\n" : "\n", given->slip);
}

static int compare_digits(const void *a, const void *b)
{
    const struct given *x = a, *y = b;
    return x->digits < y->digits ? -1 : x->digits > y->digits ? 1
           : strcmp(x->known->id, y->known->id);
}

static void print_first_wrong(const struct score *score)
{
    for (int64_t i = 0; i < score->count; i++) {
        const struct given *given = &score->given[i];
        const struct known_case *known = given->known;
        bool unit = strcmp(known->unit, "1") != 0;
        if (!given->wrong)
            continue;
        printf("first wrong: %s, %s: %.9g, right is %.9g%s%s (%s; %s)\n", known->id,
               known->what, given->value, known->right, unit ? " " : "",
               unit ? known->unit : "", known->formula, known->source);
        return;
    }
}

static void print_likeliest(const struct score *score, struct tallies *tallies)
{
    const struct slip_tally *best = NULL;
    for (int64_t i = 0; i < score->count; i++) {
        const char *name = score->given[i].slip;
        if (*name && (!best || tally_of(tallies, name)->explained > best->explained))
            best = tally_of(tallies, name);
    }
    if (best && (double)best->explained >= MANY * (double)score->wrong)
        printf("likeliest slip: %s (explains %lld of %lld that are wrong)\n", best->name,
               (long long)best->explained, (long long)score->wrong);
    else
        printf("likeliest slip: none that is known\n");
}

static void print_summary(struct score *score)
{
    qsort(score->given, (size_t)score->count, sizeof *score->given, compare_digits);
    printf("%lld of %lld cases: %lld right, %lld wrong; digits: median %.1f, worst %.1f "
           "(%s)\n",
           (long long)score->count, (long long)score->cases.count,
           (long long)(score->count - score->wrong), (long long)score->wrong,
           score->given[score->count / 2].digits, score->given[0].digits,
           score->given[0].known->id);
}

static void print_score(struct score *score, const struct scoring *request)
{
    struct tallies tallies;
    for (int64_t i = 0; i < score->count; i++)
        judge(score, &score->given[i], request->within);
    count_slips(score, &tallies);
    name_slips(score, &tallies);
    if (!request->brief)
        printf("%-22s %-17s %-7s %-17s %-7s %4s\n", "id", "right", "+-", "given",
               "claimed", "digits");
    for (int64_t i = 0; i < score->count; i++)
        if (!request->brief || score->given[i].wrong)
            print_given(&score->given[i]);
    if (score->wrong > 0) {
        print_first_wrong(score);
        print_likeliest(score, &tallies);
    }
    print_summary(score);
}

/* Writes the polygons of a case: groups 1, 2, ... */
static bool print_obj(const struct cases *cases, const char *id, struct error *error)
{
    struct case_polygons p;
    const struct known_case *known = cases_find(cases, id);
    if (!known || !case_polygons(known, &p))
        return error_set(error, EXIT_USAGE, "%s: %s '%s'", cases->text.path,
                         known ? "no polygons are in" : "no case is called", id);
    printf("# %s: %s\n", id, known->formula);
    for (int32_t i = 0; i < p.count; i++) {
        printf("g %ld\n", (long)i + 1);
        for (int32_t k = 0; k < p.corners[i]; k++)
            printf("v %.17g %.17g %.17g\n", p.corner[i][k].x, p.corner[i][k].y,
                   p.corner[i][k].z);
        printf("f");
        for (int32_t k = p.corners[i]; k > 0; k--)
            printf(" -%ld", (long)k);
        printf("\n");
    }
    return true;
}

/* --- the program --- */

static bool parse(struct scoring *request, int argc, char **argv, struct error *error)
{
    *request = (struct scoring){.within = WITHIN};
    for (int i = 1; i < argc; i++) {
        const char *word = argv[i];
        if (strcmp(word, "--help") == 0)
            request->help = true;
        else if (strcmp(word, "--brief") == 0)
            request->brief = true;
        else if (strcmp(word, "--obj") == 0)
            request->obj = true;
        else if (strcmp(word, "--within") == 0) {
            const char *value = i + 1 < argc ? argv[++i] : "";
            if (!text_is_number(value, &request->within) || request->within < 0.0)
                return error_set(error, EXIT_USAGE,
                                 "--within: '%s' is not a number of at least 0", value);
        } else if (word[0] == '-' && word[1])
            return error_set(error, EXIT_USAGE, "unknown option %s; see --help", word);
        else if (!request->cases)
            request->cases = word;
        else if (!request->results)
            request->results = word;
        else
            return error_set(error, EXIT_USAGE, "more than two files; see --help");
    }
    return request->help || request->results ||
           error_set(error, EXIT_USAGE, "two files are needed; see --help");
}

int main(int argc, char **argv)
{
    struct scoring request;
    struct score score = {.count = 0};
    struct error error = {0};
    error_program = "score";
    if (parse(&request, argc, argv, &error) && request.help) {
        fputs(HELP, stdout);
    } else if (error.code == EXIT_DONE &&
               cases_read(&score.cases, request.cases, &error)) {
        if (request.obj)
            print_obj(&score.cases, request.results, &error);
        else if (read_results(&score, request.results, &error))
            print_score(&score, &request);
    }
    if (error.code != EXIT_DONE)
        fprintf(stderr, "score: %s\n", error.text);
    int code = error.code != EXIT_DONE ? error.code
               : score.wrong > 0       ? EXIT_FAILED
                                       : EXIT_DONE;
    cases_free(&score.cases);
    text_free(&score.text);
    alloc_free(score.given);
    return code;
}
