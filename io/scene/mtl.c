/* Material libraries.
 *
 * Names used by faces and names defined are in one table, and definitions are looked up
 * after the last line: a library may come after the faces that use its materials. A name
 * without a definition keeps its first colour in the table, neutral grey.
 *
 * Ke is not in the original description of the format, but modelling programs write Ke
 * for lights. A material with Ke alone is a black light: grey would be a reflectance that
 * nobody wrote down. A texture that is not found is neutral grey unless Kd says another
 * colour: exporters write Kd 1 1 1 beside map_Kd, and a room of white walls would be
 * nearly a furnace. So is a Kd as `spectral` or `xyz`: the reflectance with an X, Y and Z
 * depends on the light of the measurement, which no file says. Such a Ke has no neutral
 * value, and is 0. Where d and Tr contradict each other, d counts: programs disagree on
 * the meaning of Tr 1. Without both, Tf or illum 4, 6, 7 or 9 tell of a clear pane; Tf 1
 * alone does not: programs write it for walls.
 *
 * Kd and Ke themselves are read strictly: a negative or misspelt number would give a
 * wrong picture without a message. */
#include "io/scene/mtl.h"

#include <ctype.h>
#include <string.h>

#include "geom/alloc.h"

static const struct material NEUTRAL = {.reflectance = {{0.5, 0.5, 0.5}}};
static const struct rgb WHITE = {{1.0, 1.0, 1.0}};

int32_t mtl_find(struct mtl_table *table, const char *name)
{
    int32_t count = table->names.count;
    int32_t number = text_names_add(&table->names, name);
    if (number == count) {
        RESERVE(table->entries, &table->capacity, (int64_t)count + 1);
        table->entries[number] = (struct mtl_entry){.material = NEUTRAL,
                                                    .opacity = 1.0, .filter = WHITE};
    }
    return number;
}

static bool is_keyword(const char *word, const char *keyword)
{
    while (*keyword && tolower((unsigned char)*word) == *keyword) {
        word++;
        keyword++;
    }
    return *word == *keyword;
}

/* Reads up to three numbers; further ones are skipped. */
static bool read_numbers(const struct text *text, char *word, char *rest,
                         struct rgb *colour, int *count, struct error *error)
{
    for (*count = 0; word && *count < BANDS; word = text_word(&rest)) {
        double *value = &colour->band[*count];
        if (!text_number(text, word, value, error))
            return false;
        if (*value < 0.0)
            return error_set(error, EXIT_USAGE, "%s:%ld: negative number '%.40s'",
                             text->path, text->line, word);
        ++*count;
    }
    return true;
}

/* A reflectance not read is grey, unless there is one in numbers. */
static void take_neutral(struct mtl_entry *entry)
{
    if (!entry->has_kd)
        entry->material.reflectance = NEUTRAL.reflectance;
}

static bool read_colour(const struct text *text, const char *keyword, char *rest,
                        struct mtl_entry *entry, struct error *error)
{
    bool is_kd = is_keyword(keyword, "kd");
    char *word = text_word(&rest);
    if (word && (is_keyword(word, "spectral") || is_keyword(word, "xyz"))) {
        entry->unread = true;
        if (is_kd)
            take_neutral(entry);
        return true;
    }
    struct rgb numbers;
    int count;
    if (!read_numbers(text, word, rest, &numbers, &count, error))
        return false;
    if (count != 1 && count != BANDS)
        return error_set(error, EXIT_USAGE, "%s:%ld: %s has %d numbers instead of 1 or 3",
                         text->path, text->line, keyword, count);
    for (int c = count; c < BANDS; c++)
        numbers.band[c] = numbers.band[0];
    if (is_kd)
        entry->material.reflectance = numbers;
    else
        entry->material.emission = numbers;
    *(is_kd ? &entry->has_kd : &entry->has_ke) = true;
    return true;
}

/* Returns the number of the material begun by a newmtl line. */
static int32_t start_material(struct mtl_table *table, char *rest)
{
    const char *name = text_trim(rest);
    int32_t number = mtl_find(table, name);
    bool used = table->entries[number].used;
    table->entries[number] = (struct mtl_entry){.defined = true, .used = used,
                                                .opacity = 1.0, .filter = WHITE};
    table->nameless += *name == '\0';
    return number;
}

static double within_1(double value)
{
    return value < 0.0 ? 0.0 : value > 1.0 ? 1.0 : value;
}

/* Takes d or Tr. A malformed value is no error. */
static void take_opacity(struct mtl_entry *entry, char *rest, bool is_d)
{
    const char *word = text_word(&rest);
    double value;
    if (word && strcmp(word, "-halo") == 0)
        word = text_word(&rest);
    if (!word || !text_is_number(word, &value) || (entry->has_d && !is_d))
        return;
    entry->opacity = within_1(is_d ? value : 1.0 - value);
    *(is_d ? &entry->has_d : &entry->has_tr) = true;
}

/* Takes Tf, of one number or three. A malformed one is no error. */
static void take_filter(struct mtl_entry *entry, char *rest)
{
    double value = 1.0;
    int count = 0;
    for (const char *word; count < BANDS && (word = text_word(&rest)) != NULL; count++) {
        if (!text_is_number(word, &value))
            break;
        entry->filter.band[count] = within_1(value);
        entry->clear |= value < 1.0;
    }
    for (int c = count; c < BANDS && count == 1; c++)
        entry->filter.band[c] = entry->filter.band[0];
}

/* Takes illum for panes alone. True if no more is meant. */
static bool take_illum(struct mtl_entry *entry, char *rest)
{
    const char *word = text_word(&rest);
    double value;
    bool clear = word && text_is_number(word, &value) &&
                 (value == 4.0 || value == 6.0 || value == 7.0 || value == 9.0);
    entry->clear |= clear;
    return clear;
}

static char *next_word(char *at)
{
    at += strcspn(at, " \t");
    return at + strspn(at, " \t");
}

/* Returns the number of the picture named by a line behind its options, from 1; 0: none.
 * An option is a word, a value, and further numbers. */
static int32_t find_map(struct mtl_table *table, const struct text *text, char *rest)
{
    char *name = text_trim(rest);
    while (*name == '-') {
        name = next_word(next_word(name));
        for (size_t end; (end = strspn(name, "+-.0123456789eE")) > 0 &&
                         (name[end] == ' ' || name[end] == '\t');)
            name = next_word(name);
    }
    if (!*name)
        return 0;
    char *path = text_path_beside(text->path, name);
    for (char *at = path; *at; at++)
        *at = *at == '\\' ? '/' : *at;
    int32_t number = text_names_add(&table->maps, path) + 1;
    alloc_free(path);
    return number;
}

/* True if nothing is lost without the statement: all its numbers are in the range of
 * diffuse surfaces, or the statement only shapes the highlights of another statement. */
static bool is_plain(const char *keyword, char *rest)
{
    static const struct {
        const char *keyword;
        double low, high;
    } PLAIN[] = {{"ka", 0, 1e9}, {"ns", 0, 1e9},   {"ni", 0, 1e9},  {"sharpness", 0, 1e9},
                 {"pr", 0, 1e9}, {"pcr", 0, 1e9},  {"illum", 1, 2}, {"anisor", 0, 1e9},
                 {"ks", 0, 0},   {"pm", 0, 0},     {"ps", 0, 0},    {"pc", 0, 0},
                 {"aniso", 0, 0}};
    size_t row = 0, rows = sizeof PLAIN / sizeof PLAIN[0];
    double value;
    while (row < rows && !is_keyword(keyword, PLAIN[row].keyword))
        row++;
    bool plain = row < rows;
    for (const char *word; plain && (word = text_word(&rest)) != NULL;)
        plain = text_is_number(word, &value) && value >= PLAIN[row].low &&
                value <= PLAIN[row].high;
    return plain;
}

/* `*current` is the number of the material of the line, or negative. */
static bool read_line(struct mtl_table *table, const struct text *text, char *line,
                      int32_t *current, struct error *error)
{
    const char *keyword = text_word(&line);
    if (!keyword)
        return true;
    if (is_keyword(keyword, "newmtl")) {
        *current = start_material(table, line);
        return true;
    }
    bool is_colour = is_keyword(keyword, "kd") || is_keyword(keyword, "ke");
    if (*current < 0 && is_colour)
        return error_set(error, EXIT_USAGE, "%s:%ld: %s before newmtl", text->path,
                         text->line, keyword);
    if (*current < 0)
        return true;
    struct mtl_entry *entry = &table->entries[*current];
    if (is_keyword(keyword, "d") || is_keyword(keyword, "tr"))
        take_opacity(entry, line, is_keyword(keyword, "d"));
    else if (is_keyword(keyword, "tf"))
        take_filter(entry, line);
    else if (is_keyword(keyword, "illum") && take_illum(entry, line))
        return true;
    else if (is_keyword(keyword, "map_kd") || is_keyword(keyword, "map_ke"))
        entry->maps[is_keyword(keyword, "map_ke")] = find_map(table, text, line);
    else if (!is_colour && !is_plain(keyword, line))
        text_names_add(&table->passed, keyword);
    return !is_colour || read_colour(text, keyword, line, entry, error);
}

bool mtl_of_text(struct mtl_table *table, struct text *text, struct error *error)
{
    bool good = true;
    int32_t current = -1;
    for (char *line; good && (line = text_line(text)) != NULL;)
        good = read_line(table, text, line, &current, error);
    return good;
}

bool mtl_read(struct mtl_table *table, const char *path, bool *found, struct error *error)
{
    struct text text;
    struct error reason = {EXIT_DONE, ""};
    bool good = text_read(&text, path, &reason);
    *found = !text.unreadable;
    if (!good)
        return text.unreadable ? true : error_set(error, reason.code, "%s", reason.text);
    good = mtl_of_text(table, &text, error);
    text_free(&text);
    return good;
}

/* Where neither d nor Tr is given, a clear material has d 0. */
static double opacity_of(const struct mtl_entry *entry)
{
    bool told = entry->has_d || entry->has_tr;
    return !told && entry->clear ? 0.0 : entry->opacity;
}

struct rgb mtl_transmittance(const struct mtl_entry *entry)
{
    struct rgb through = entry->filter;
    for (int c = 0; c < BANDS; c++)
        through.band[c] *= 1.0 - opacity_of(entry);
    return through;
}

void mtl_make_pane(struct mtl_entry *entry)
{
    struct material *material = &entry->material;
    material->transmittance = mtl_transmittance(entry);
    material->emission = (struct rgb){{0.0, 0.0, 0.0}};
    for (int c = 0; c < BANDS; c++)
        material->reflectance.band[c] *= opacity_of(entry);
}

void mtl_free(struct mtl_table *table)
{
    text_names_free(&table->maps);
    text_names_free(&table->passed);
    text_names_free(&table->names);
    alloc_free(table->entries);
    *table = (struct mtl_table){0};
}
