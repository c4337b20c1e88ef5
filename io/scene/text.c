/* Reading text.
 *
 * The file is read in chunks to its end, so no size has to be known. Each chunk is
 * searched for control characters before the next one is read: a mesh in a binary format,
 * UTF-16 or /dev/zero ends there and not in a thousand messages about bad lines. Lines
 * and words are then cut out in place: the characters of a continuation become blanks,
 * the blank behind a word becomes a zero. So lines may have any length.
 *
 * Numbers are rounded correctly. Almost all numbers in files are an integer below 2^53
 * times or over a power of ten up to 10^22; a double holds both exactly, so one operation
 * rounds once, in a fifth of the time of strtod. The others go to strtod, which also
 * takes NaN, infinity and hexadecimal numbers, so the characters are checked first, and
 * follows the locale, which the program never sets. Rejected: sscanf, whose behaviour on
 * overflow is undefined.
 *
 * Names are found by hashing (linear probing): searching a list takes time quadratic in
 * the number of materials, and a file can have a million. */
#include "io/scene/text.h"

#include <ctype.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/hash.h"

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

static char *skip_blanks(char *at)
{
    while (is_blank(*at))
        at++;
    return at;
}

static bool is_text(const char *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        unsigned char c = (unsigned char)bytes[i];
        if (c < 32 && c != '\t' && c != '\n' && c != '\v' && c != '\f' && c != '\r')
            return false;
    }
    return true;
}

/* UTF-16 starts with a mark of its byte order, or every other one of its first bytes is
 * zero. */
static bool is_utf16(const char *bytes, size_t count)
{
    if (count >= 2 &&
        (memcmp(bytes, "\xFF\xFE", 2) == 0 || memcmp(bytes, "\xFE\xFF", 2) == 0))
        return true;
    return count >= 4 && !bytes[0] == !bytes[2] && !bytes[1] == !bytes[3] &&
           !bytes[0] != !bytes[1];
}

/* Checks the bytes of a chunk, which follow text->size bytes of the text. */
static bool check_bytes(const struct text *text, const char *bytes, size_t count,
                        struct error *error)
{
    if (text->size == 0 && is_utf16(bytes, count))
        return error_set(error, EXIT_USAGE, "%s: is UTF-16; save it as UTF-8",
                         text->path);
    if (!is_text(bytes, count))
        return error_set(error, EXIT_USAGE, "%s: not a text file", text->path);
    return true;
}

static bool read_chunks(struct text *text, struct source *source, struct error *error)
{
    int64_t capacity = 0;
    size_t got;
    do {
        RESERVE(text->bytes, &capacity, text->size + SOURCE_CHUNK + 1);
        text->unreadable = !source_read(source, text->bytes + text->size, &got, error);
        if (text->unreadable || !check_bytes(text, text->bytes + text->size, got, error))
            return false;
        text->size += (int64_t)got;
    } while (got == SOURCE_CHUNK);
    text->bytes = alloc_resize(text->bytes, (size_t)text->size + 1, 1);
    text->bytes[text->size] = '\0';
    text->position = strncmp(text->bytes, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
    return true;
}

bool text_of_source(struct text *text, struct source *source, struct error *error)
{
    *text = (struct text){.path = source->path, .next_line = 1};
    bool good = read_chunks(text, source, error);
    if (!good)
        text_free(text);
    return good;
}

bool text_read(struct text *text, const char *path, struct error *error)
{
    struct source source;
    *text = (struct text){.path = path, .unreadable = true};
    bool good =
        source_open(&source, path, error) && text_of_source(text, &source, error);
    source_close(&source);
    return good;
}

void text_free(struct text *text)
{
    alloc_free(text->bytes);
    text->bytes = NULL;
    text->size = text->position = 0;
}

/* Length of the line end at `end`: 0 at the end of the text. */
static int64_t end_length(const char *end)
{
    return *end == '\0' ? 0 : end[0] == '\r' && end[1] == '\n' ? 2 : 1;
}

char *text_line(struct text *text)
{
    if (text->position == text->size)
        return NULL;
    char *line = text->bytes + text->position;
    bool is_comment = *skip_blanks(line) == '#';
    text->line = text->next_line;
    for (;;) {
        char *from = text->bytes + text->position;
        char *end = from;
        while (*end != '\n' && *end != '\r' && *end != '\0')
            end++;
        int64_t length = end_length(end);
        text->position = end - text->bytes + length;
        text->next_line++;
        bool goes_on = !is_comment && end > from && end[-1] == '\\';
        if (goes_on)
            end[-1] = ' ';
        if (!goes_on || length == 0) {
            *end = '\0';
            return line;
        }
        memset(end, ' ', (size_t)length);
    }
}

char *text_word(char **rest)
{
    char *word = skip_blanks(*rest);
    if (*word == '\0' || *word == '#') {
        *rest = word;
        return NULL;
    }
    char *end = word;
    while (*end != '\0' && !is_blank(*end))
        end++;
    *rest = *end ? end + 1 : end;
    *end = '\0';
    return word;
}

char *text_trim(char *rest)
{
    char *first = skip_blanks(rest);
    char *end = first + strlen(first);
    while (end > first && is_blank(end[-1]))
        end--;
    *end = '\0';
    return first;
}

/* A decimal number as written: +-digits * 10^exponent. */
struct decimal {
    bool negative;
    uint64_t digits; /* above DIGITS_MAX: not exact */
    int64_t exponent;
};

/* Doubles hold every integer up to this one. */
static const uint64_t DIGITS_MAX = UINT64_C(1) << 53;

static const char *scan_digits(const char *at, struct decimal *decimal)
{
    for (; *at >= '0' && *at <= '9'; at++)
        if (decimal->digits <= DIGITS_MAX)
            decimal->digits = 10 * decimal->digits + (uint64_t)(*at - '0');
    return at;
}

/* Reads the word as a decimal number; false for any other word. */
static bool scan_decimal(const char *word, struct decimal *decimal)
{
    *decimal = (struct decimal){.negative = *word == '-'};
    const char *first = word + (*word == '-' || *word == '+');
    const char *at = scan_digits(first, decimal);
    ptrdiff_t count = at - first;
    if (*at == '.') {
        const char *point = at;
        at = scan_digits(point + 1, decimal);
        decimal->exponent = point + 1 - at;
        count += at - (point + 1);
    }
    if (*at == 'e' || *at == 'E') {
        int64_t exponent;
        at++;
        if (!text_integer(&at, &exponent))
            return false;
        decimal->exponent += exponent;
    }
    return count > 0 && *at == '\0';
}

bool text_is_number(const char *word, double *value)
{
    static const double power[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                   1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                   1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    struct decimal decimal;
    if (!scan_decimal(word, &decimal))
        return false;
    int64_t e = decimal.exponent;
    if (FLT_EVAL_METHOD == 0 && decimal.digits <= DIGITS_MAX && e >= -22 && e <= 22) {
        double digits = (double)decimal.digits;
        *value = e < 0 ? digits / power[-e] : digits * power[e];
        *value = decimal.negative ? -*value : *value;
    } else {
        *value = strtod(word, NULL);
    }
    return isfinite(*value);
}

bool text_number(const struct text *text, const char *word, double *value,
                 struct error *error)
{
    if (!text_is_number(word, value))
        return error_set(error, EXIT_USAGE, "%s:%ld: bad number '%.40s'", text->path,
                         text->line, word);
    if (fabs(*value) > TEXT_NUMBER_MAX)
        return error_set(error, EXIT_USAGE, "%s:%ld: number '%.40s' is out of range",
                         text->path, text->line, word);
    return true;
}

bool text_integer(const char **cursor, int64_t *value)
{
    const char *digit = *cursor;
    bool negative = *digit == '-';
    if (*digit == '-' || *digit == '+')
        digit++;
    if (*digit < '0' || *digit > '9')
        return false;
    for (*value = 0; *digit >= '0' && *digit <= '9'; digit++)
        if (*value < INT64_C(100000000000000000))
            *value = *value * 10 + (*digit - '0');
    *value = negative ? -*value : *value;
    *cursor = digit;
    return true;
}

void text_missing_add(struct text_missing *missing, const char *name)
{
    if (missing->count++ == 0)
        snprintf(missing->first, sizeof missing->first, "%s", name);
}

bool text_ends_with(const char *path, const char *suffix)
{
    size_t length = strlen(path), tail = strlen(suffix);
    const char *end = length > tail ? path + length - tail : "";
    while (*end && tolower((unsigned char)*end) == *suffix) {
        end++;
        suffix++;
    }
    return length > tail && *end == '\0';
}

static void least_of(int *least, int value)
{
    *least = value < *least ? value : *least;
}

/* Edits between the first i letters of one and the first j of the other, pair by pair. */
bool text_is_like(const char *a, const char *b)
{
    enum { LETTERS = 64, EDITS = 3 };
    int edits[LETTERS + 1][LETTERS + 1];
    size_t rows = strlen(a), columns = strlen(b);
    size_t third = (rows < columns ? rows : columns) / 3;
    if (rows > LETTERS || columns > LETTERS)
        return false;
    for (size_t i = 0; i <= rows; i++)
        for (size_t j = 0; j <= columns; j++) {
            int *least = &edits[i][j];
            *least = (int)(i + j); /* right where i or j is 0 */
            if (i == 0 || j == 0)
                continue;
            const char *p = a + i, *q = b + j; /* behind the letters */
            bool same = tolower((unsigned char)p[-1]) == tolower((unsigned char)q[-1]);
            least_of(least, edits[i - 1][j] + 1);
            least_of(least, edits[i][j - 1] + 1);
            least_of(least, edits[i - 1][j - 1] + !same);
            if (i > 1 && j > 1 && p[-1] == q[-2] && p[-2] == q[-1])
                least_of(least, edits[i - 2][j - 2] + 1);
        }
    return edits[rows][columns] <= (int)(third < EDITS ? third : EDITS);
}

char *text_path_beside(const char *path, const char *name)
{
    const char *slash = strrchr(path, '/');
    size_t folder = slash && name[0] != '/' ? (size_t)(slash - path) + 1 : 0;
    char *joined = alloc_array(folder + strlen(name) + 1, 1);
    memcpy(joined, path, folder);
    strcpy(joined + folder, name);
    return joined;
}

/* Returns the slot of a name, or the empty slot for a new one. */
static int32_t *find_slot(const struct text_names *names, const char *name)
{
    uint64_t mask = (uint64_t)names->slot_count - 1;
    uint64_t at = hash_bytes(HASH_START, name, strlen(name)) & mask;
    while (names->slots[at] && strcmp(names->name[names->slots[at] - 1], name) != 0)
        at = (at + 1) & mask;
    return &names->slots[at];
}

static void make_slots(struct text_names *names, int64_t slot_count)
{
    alloc_free(names->slots);
    names->slots = alloc_array((size_t)slot_count, sizeof *names->slots);
    names->slot_count = slot_count;
    for (int32_t i = 0; i < names->count; i++)
        *find_slot(names, names->name[i]) = i + 1;
}

int32_t text_names_add(struct text_names *names, const char *name)
{
    if (names->slot_count < 2 * ((int64_t)names->count + 1))
        make_slots(names, names->slot_count ? 2 * names->slot_count : 16);
    int32_t *slot = find_slot(names, name);
    if (*slot == 0) {
        RESERVE(names->name, &names->capacity, (int64_t)names->count + 1);
        names->name[names->count] = alloc_string(name);
        *slot = ++names->count;
    }
    return *slot - 1;
}

void text_names_list(const struct text_names *names, char *list, size_t size)
{
    size_t used = 0;
    *list = '\0';
    for (int32_t i = 0; i < names->count; i++) {
        size_t length = strlen(names->name[i]);
        bool fits = used + length + 5 < size;
        snprintf(list + used, size - used, "%s%s", used ? " " : "",
                 fits ? names->name[i] : "...");
        if (!fits)
            return;
        used += length + (used > 0);
    }
}

void text_names_free(struct text_names *names)
{
    for (int32_t i = 0; i < names->count; i++)
        alloc_free(names->name[i]);
    alloc_free(names->name);
    alloc_free(names->slots);
    *names = (struct text_names){0};
}
