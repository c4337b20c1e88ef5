/* Reading text.
 *
 * The file is read in blocks until it ends, so no size that the system claims is believed, and
 * pipes work. Each block is looked at for control characters before the next one is asked for:
 * a mesh in a binary format, UTF-16 or /dev/zero ends there and not in a thousand messages
 * about bad lines. Lines and words are then cut out in place: a continuation is two or three
 * characters that become blanks, a word ends where a blank becomes a zero. Nothing is copied,
 * and there is no longest line.
 *
 * strtod is the one function of C99 that rounds decimal numbers correctly, but it also takes
 * NaN, infinity and hexadecimal numbers, so the characters are checked first. It follows the
 * locale, which the program never sets. sscanf was rejected: its behaviour on overflow is
 * undefined.
 *
 * Names are found by hashing (FNV-1a, linear probing): a list searched from the start takes a
 * time that is quadratic in the number of materials, and a file can have a million. */
#include "io/text.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "geom/alloc.h"

enum { BLOCK = 65536 };

static const char BLANKS[] = " \t\v\f";

static bool is_text(const char *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        unsigned char c = (unsigned char)bytes[i];
        if (c < 32 && c != '\t' && c != '\n' && c != '\v' && c != '\f' && c != '\r')
            return false;
    }
    return true;
}

/* Where the first line starts: behind a byte order mark. */
static void start(struct text *text)
{
    text->bytes[text->size] = '\0';
    text->position = strncmp(text->bytes, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
}

static bool fail_to_read(struct text *text, struct error *error)
{
    text->unreadable = true;
    return error_set(error, EXIT_USAGE, "%s: cannot read: %s", text->path,
                     errno ? strerror(errno) : "unknown reason");
}

static bool read_blocks(struct text *text, FILE *file, struct error *error)
{
    int64_t capacity = 0;
    size_t got;
    do {
        text->bytes = alloc_reserve(text->bytes, &capacity, text->size + BLOCK + 1, 1);
        got = fread(text->bytes + text->size, 1, BLOCK, file);
        if (!is_text(text->bytes + text->size, got))
            return error_set(error, EXIT_USAGE, "%s: not a text file", text->path);
        text->size += (int64_t)got;
    } while (got == BLOCK);
    start(text);
    return ferror(file) ? fail_to_read(text, error) : true;
}

bool text_read(struct text *text, const char *path, struct error *error)
{
    *text = (struct text){.path = path, .next_line = 1};
    errno = 0;
    FILE *file = fopen(path, "rb");
    if (!file)
        return fail_to_read(text, error);
    bool good = read_blocks(text, file, error);
    fclose(file);
    if (!good)
        text_free(text);
    return good;
}

bool text_of_bytes(struct text *text, const char *path, const void *bytes, size_t size,
                   struct error *error)
{
    *text = (struct text){.path = path, .next_line = 1};
    if (!is_text(bytes, size))
        return error_set(error, EXIT_USAGE, "%s: not a text file", path);
    text->size = (int64_t)size;
    text->bytes = alloc_array(size + 1, 1);
    memcpy(text->bytes, bytes, size);
    start(text);
    return true;
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
    bool is_comment = line[strspn(line, BLANKS)] == '#';
    text->line = text->next_line;
    for (;;) {
        char *from = text->bytes + text->position;
        char *end = from + strcspn(from, "\r\n");
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
    char *word = *rest + strspn(*rest, BLANKS);
    if (*word == '\0' || *word == '#') {
        *rest = word;
        return NULL;
    }
    char *end = word + strcspn(word, BLANKS);
    *rest = *end ? end + 1 : end;
    *end = '\0';
    return word;
}

char *text_trim(char *rest)
{
    char *start = rest + strspn(rest, BLANKS);
    char *end = start + strlen(start);
    while (end > start && strchr(BLANKS, end[-1]))
        end--;
    *end = '\0';
    return start;
}

bool text_is_number(const char *word, double *value)
{
    if (word[strspn(word, "+-.0123456789eE")] != '\0')
        return false;
    char *end;
    *value = strtod(word, &end);
    return end != word && *end == '\0' && isfinite(*value);
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

static uint64_t hash(const char *name)
{
    uint64_t sum = UINT64_C(14695981039346656037);
    for (; *name; name++)
        sum = (sum ^ (unsigned char)*name) * UINT64_C(1099511628211);
    return sum ^ sum >> 32;
}

/* The slot of a name, or the empty one where it belongs. */
static int32_t *find_slot(const struct text_names *names, const char *name)
{
    uint64_t mask = (uint64_t)names->slot_count - 1;
    uint64_t at = hash(name) & mask;
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
        names->name = alloc_reserve(names->name, &names->capacity, (int64_t)names->count + 1,
                                    sizeof *names->name);
        names->name[names->count] = alloc_string(name);
        *slot = ++names->count;
    }
    return *slot - 1;
}

void text_names_free(struct text_names *names)
{
    for (int32_t i = 0; i < names->count; i++)
        alloc_free(names->name[i]);
    alloc_free(names->name);
    alloc_free(names->slots);
    *names = (struct text_names){0};
}
