/* Text files: whole in memory, handed out in logical lines, words and numbers; and sets
 * of names in such files. */
#ifndef IO_SCENE_TEXT_H
#define IO_SCENE_TEXT_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/error.h"
#include "io/scene/source.h"

/* The largest magnitude of an input number: squares and products of three such numbers do
 * not overflow. */
#define TEXT_NUMBER_MAX 1e100

struct text {
    const char *path;  /* borrowed from the caller of text_read() */
    char *bytes;       /* [size + 1] with a zero behind the last; cut in place */
    int64_t size;      /* bytes */
    int64_t position;  /* of the start of the next line */
    long line;         /* number of the first physical line of the last logical line */
    long next_line;    /* number of the physical line at `position` */
    bool unreadable;   /* text_read() failed in opening or reading the file */
};

/* Reads the file `path`; a UTF-8 byte order mark is skipped. Owned by the caller until
 * text_free(), which is allowed (not needed) after a failure.
 * Errors: "PATH: cannot read: REASON" (then `unreadable` is set); "PATH: not a text file"
 * for control characters other than blanks and line ends; "PATH: is UTF-16; save it as
 * UTF-8". All ask for EXIT_USAGE. */
bool text_read(struct text *text, const char *path, struct error *error);
void text_free(struct text *text);

/* Does the same with an open file, which stays open. */
bool text_of_source(struct text *text, struct source *source, struct error *error);

/* Returns the next logical line, without its end, or NULL behind the last one. Lines end
 * in LF, CRLF, CR, or with the file. A line that ends in a backslash goes on in the next
 * one, as if after a blank, unless it is a comment (its first word starts with '#').
 * Lives as long as the text. */
char *text_line(struct text *text);

/* Cuts the next word off `*rest`, which moves on behind, or returns NULL at the end of
 * the line or at a word starting with '#'. */
char *text_word(char **rest);

/* Returns the text without the blanks around, cut in place. */
char *text_trim(char *rest);

/* True if the whole word is a decimal number in the range of a double, such as 1, +1,
 * -.5, 1. or 1e-3, which is then in `*value`. NaN, infinity, hexadecimal numbers and
 * overflow are refused; numbers too small for a double are rounded to one. */
bool text_is_number(const char *word, double *value);

/* Reads a number up to TEXT_NUMBER_MAX in magnitude, in the same form.
 * Errors: "PATH:LINE: bad number 'WORD'", "PATH:LINE: number 'WORD' is out of range". */
bool text_number(const struct text *text, const char *word, double *value,
                 struct error *error);

/* Reads a decimal integer at `*cursor`, which moves on behind. False if there is none. A
 * value of more than 18 digits is cut to its first 18. */
bool text_integer(const char **cursor, int64_t *value);

/* True if the name of a file ends in a suffix such as ".ply" (given in small letters), in
 * letters of either case, and is longer than the suffix. */
bool text_ends_with(const char *path, const char *suffix);

/* Returns the path of a file named in the file `path`, relative to the folder of `path`.
 * To be freed with alloc_free(). */
char *text_path_beside(const char *path, const char *name);

/* True if the words may be one, misspelt: at most a third of the letters of the shorter
 * one, and at most three, are inserted, left out, changed or swapped; capitals do not
 * count. Words have at most 64 letters. */
bool text_is_like(const char *a, const char *b);

/* Names not found. Starts as {0}. */
struct text_missing {
    int64_t count;
    char first[128]; /* the first name, cut if long, for a message */
    char like[128];  /* a name that is there, much like the first; or "" */
};

void text_missing_add(struct text_missing *missing, const char *name);

/* Different names, numbered 0, 1, 2, ... in the order of their addition. Starts as
 * {0}. */
struct text_names {
    char **name;       /* [count] */
    int32_t count;
    int64_t capacity;  /* of name */
    int32_t *slots;    /* hash table: 0, or the number of a name plus 1 */
    int64_t slot_count; /* a power of two, at least twice count */
};

/* Returns the number of `name`, added (copied) if new. */
int32_t text_names_add(struct text_names *names, const char *name);

/* Writes the names with blanks between, as many as fit into `size` bytes, and "..." for
 * the others. Pre: size >= 4. */
void text_names_list(const struct text_names *names, char *list, size_t size);
void text_names_free(struct text_names *names);

#endif
