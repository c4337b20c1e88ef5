/* Values of options: words read into fields, by kind, and written again. A kind is the
 * function that sets the field; a message names the option and the word. */
#include "io/run/option.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/scene/sky.h"
#include "io/scene/text.h"

/* --- read --- */

bool option_is_not(const struct argument *a, const char *kind)
{
    return error_set(a->error, EXIT_USAGE, "%s: '%s' is not %s", a->option->name,
                     a->value, kind);
}

/* Checks the range of a number, which messages tell in these units. */
static bool check_range(const struct argument *a, double number, double unit,
                        const char *after_low, const char *after_high)
{
    double low = a->option->low, high = a->option->high;
    if (number >= low && number <= high)
        return true;
    return error_set(a->error, EXIT_USAGE, "%s: %s is not between %g%s and %g%s",
                     a->option->name, a->value, low / unit, after_low, high / unit,
                     after_high);
}

bool option_set_real(const struct argument *a)
{
    double *number = a->field;
    if (!text_is_number(a->value, number))
        return option_is_not(a, "a number");
    return check_range(a, *number, 1.0, "", "");
}

bool option_set_integer(const struct argument *a)
{
    double number;
    struct argument real = *a;
    real.field = &number;
    if (!option_set_real(&real))
        return false;
    if (number != (double)(int)number)
        return option_is_not(a, "a whole number");
    *(int *)a->field = (int)number;
    return true;
}

/* Sets an enum: an int, with a constant for each choice, counted from 0. */
bool option_set_choice(const struct argument *a)
{
    size_t length = strlen(a->value);
    int number = 0;
    for (const char *at = a->option->choices; at; at = strchr(at, '|'), number++) {
        at += *at == '|';
        if (strcspn(at, "|") == length && strncmp(at, a->value, length) == 0) {
            *(int *)a->field = number;
            return true;
        }
    }
    char kind[100];
    snprintf(kind, sizeof kind, "one of %s", a->option->choices);
    return option_is_not(a, kind);
}

bool option_copy_digits(const char *text, size_t length, char digits[DIGITS_ROOM])
{
    snprintf(digits, DIGITS_ROOM, "%.*s", (int)length, text);
    return length < DIGITS_ROOM;
}

/* Reads as many numbers as there are, but `most`, with commas between; 0: others. */
static int read_list(const char *at, int most, double *numbers)
{
    for (int count = 0; count < most; at++) {
        char digits[DIGITS_ROOM];
        size_t length = strcspn(at, ",");
        if (!option_copy_digits(at, length, digits) ||
            !text_is_number(digits, &numbers[count++]))
            return 0;
        at += length;
        if (!*at)
            return count;
    }
    return 0;
}

/* Sets a sky: a number for all bands, or R,G,B, alone or behind a name; or a file. */
bool option_set_sky(const struct argument *a)
{
    static const char *const NAMES[] = {[SKY_OVERCAST] = "overcast,",
                                        [SKY_CLEAR] = "clear,"};
    struct sky *sky = a->field;
    const char *at = a->value;
    double numbers[BANDS];
    sky->kind = strspn(at, "0123456789.,+-eE") == strlen(at) ? SKY_UNIFORM : SKY_TABLE;
    for (int kind = SKY_OVERCAST; kind <= SKY_CLEAR; kind++)
        if (strncmp(a->value, NAMES[kind], strlen(NAMES[kind])) == 0) {
            sky->kind = (enum sky_kind)kind;
            at += strlen(NAMES[kind]);
        }
    sky->path = sky->kind == SKY_TABLE ? a->value : NULL;
    if (sky->path)
        return true;
    int count = read_list(at, BANDS, numbers);
    if (count != 1 && count != BANDS)
        return option_is_not(a, "a number, three as in R,G,B, overcast,L, clear,L, or a "
                                "file");
    for (int c = 0; c < BANDS; c++) {
        sky->level.band[c] = numbers[c % count];
        if (!check_range(a, sky->level.band[c], 1.0, "", ""))
            return false;
    }
    if (sky->kind == SKY_UNIFORM && !(rgb_sum(sky->level) > 0.0))
        sky->kind = SKY_NONE;
    return true;
}

bool option_set_sun(const struct argument *a)
{
    struct sky *sky = a->field;
    double n[4];
    if (read_list(a->value, 4, n) != 4)
        return option_is_not(a, "x,y,z,W");
    sky->sun = (struct vec3){n[0], n[1], n[2]};
    sky->sun_irradiance = n[3];
    if (!(vec3_length(sky->sun) > 0.0))
        return option_is_not(a, "a direction and W/m^2");
    return check_range(a, n[3], 1.0, "", "");
}

/* Sets a fraction: a number, or a percentage. Of 5, 5% may be meant. */
bool option_set_fraction(const struct argument *a)
{
    char digits[DIGITS_ROOM];
    double *field = a->field;
    size_t length = strlen(a->value);
    bool percents = length >= 2 && a->value[length - 1] == '%' &&
                    option_copy_digits(a->value, length - 1, digits);
    if (!text_is_number(percents ? digits : a->value, field))
        return option_is_not(a, "a number");
    if (!percents)
        return check_range(a, *field, 1.0, "", "; percents end in %, as in 1%");
    *field /= 100.0;
    return check_range(a, *field, 0.01, " %", " %");
}

/* Sets a time in seconds: a number, of s, m or h, if that stands behind it. */
bool option_set_time(const struct argument *a)
{
    static const char UNITS[] = "smh";
    static const int SECONDS[] = {1, 60, 3600};
    char digits[DIGITS_ROOM];
    size_t length = strlen(a->value);
    const char *unit = length > 0 ? strchr(UNITS, a->value[length - 1]) : NULL;
    double number;
    if (!option_copy_digits(a->value, length - (unit ? 1 : 0), digits) ||
        !text_is_number(digits, &number))
        return option_is_not(a, "a time, as 90, 90s, 5m or 1h");
    number *= unit ? SECONDS[unit - UNITS] : 1;
    if (!check_range(a, number, 1.0, " s", " s"))
        return false;
    *(int *)a->field = (int)number;
    return true;
}

/* Sets a number of bytes, or of K, M, G or T: powers of 1024. */
bool option_set_bytes(const struct argument *a)
{
    static const char UNITS[] = "KMGT";
    const char *at = a->value;
    int64_t digits; /* at most 18 of them */
    bool number = text_integer(&at, &digits);
    const char *unit = number && *at ? strchr(UNITS, *at) : NULL;
    if (!number || at[unit != NULL] != '\0')
        return option_is_not(a, "a number of bytes, such as 512M or 2G");
    double bytes = strtod(a->value, NULL);
    for (const char *u = UNITS; unit && u <= unit; u++)
        bytes *= 1024.0;
    if (!check_range(a, bytes, 1.0, "", " bytes"))
        return false;
    *(int64_t *)a->field = (int64_t)bytes;
    return true;
}

/* Sets the path of a file, of which there is one. */
bool option_set_text(const struct argument *a)
{
    const char **field = a->field;
    if (*field)
        return error_set(a->error, EXIT_USAGE, "%s is given twice: %s and %s",
                         a->option->name, *field, a->value);
    *field = a->value;
    return true;
}

bool option_set_flag(const struct argument *a)
{
    *(bool *)a->field = true;
    return true;
}

/* --- written --- */

/* Writes the light of a sky behind its name, or its file. */
static void write_sky(const struct option *option, const struct sky *sky, char *line,
                      size_t room)
{
    static const char *const NAMES[] = {"", "", "overcast,", "clear,", ""};
    const double *light = sky->level.band;
    if (sky->path)
        snprintf(line, room, "%s %.200s\n", option->name, sky->path);
    else
        snprintf(line, room, "%s %s%.17g,%.17g,%.17g\n", option->name,
                 NAMES[sky->kind], light[0], light[1], light[2]);
}

void option_write(const struct option *option, const void *field, char *line, size_t room)
{
    const char *name = option->name, *choice = option->choices;
    const struct sky *sky = field;
    if (option->set == option_set_flag) {
        snprintf(line, room, "%s %s\n", name, *(const bool *)field ? "on" : "off");
    } else if (option->set == option_set_sky) {
        write_sky(option, sky, line, room);
    } else if (option->set == option_set_sun) {
        snprintf(line, room, "%s %.17g,%.17g,%.17g,%.17g\n", name, sky->sun.x,
                 sky->sun.y, sky->sun.z, sky->sun_irradiance);
    } else if (choice) {
        for (int k = *(const int *)field; k > 0; k--)
            choice = strchr(choice, '|') + 1;
        snprintf(line, room, "%s %.*s\n", name, (int)strcspn(choice, "|"), choice);
    } else if (option->set == option_set_real || option->set == option_set_fraction) {
        snprintf(line, room, "%s %.17g\n", name, *(const double *)field);
    } else {
        snprintf(line, room, "%s %d\n", name, *(const int *)field);
    }
}
