/* Tests of io/scene/text.h. Proved are: how bytes become logical lines with the right
 * line numbers (LF, CRLF, CR, continuation, comments, byte order mark), how lines become
 * words, numbers and integers, which files are refused and with which words, and that
 * names keep their numbers.
 *
 * Lines and words are compared in one string, "1:first|2:second|". */
#include "io/scene/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "geom/alloc.h"
#include "tests/load.h"
#include "tests/random.h"
#include "tests/refusal.h"

#define FILE_NAME "build/text_test.txt"

enum { BLOCK = 65536 }; /* the reader's block: sizes around it are the doubtful ones */

static bool read_bytes(struct text *text, const char *bytes, size_t count)
{
    forget_error();
    write_bytes(FILE_NAME, bytes, count);
    return text_read(text, FILE_NAME, &error);
}

static bool is_same(const char *found, const char *expected)
{
    bool same = strcmp(found, expected) == 0;
    if (!same)
        printf("# expected '%s', got '%s'\n", expected, found);
    return same;
}

static void append(char *to, size_t size, const char *piece)
{
    size_t used = strlen(to);
    snprintf(to + used, size - used, "%s|", piece);
}

static void check_lines(const char *name, const char *bytes, const char *expected)
{
    struct text text;
    char found[400] = "", piece[200];
    bool good = read_bytes(&text, bytes, strlen(bytes));
    for (char *line; good && (line = text_line(&text)) != NULL;) {
        snprintf(piece, sizeof piece, "%ld:%s", text.line, line);
        append(found, sizeof found, piece);
    }
    tap_ok(good && is_same(found, expected) && !text_line(&text), "%s", name);
    text_free(&text);
}

static void test_line_ends(void)
{
    check_lines("no bytes, no lines", "", "");
    check_lines("LF", "a\nb b\nc\n", "1:a|2:b b|3:c|");
    check_lines("CRLF", "a\r\nb b\r\nc\r\n", "1:a|2:b b|3:c|");
    check_lines("CR", "a\rb b\rc\r", "1:a|2:b b|3:c|");
    check_lines("the last line need not end", "a\nb", "1:a|2:b|");
    check_lines("empty lines count", "\n\na\r\n\r\nb\n", "1:|2:|3:a|4:|5:b|");
    check_lines("LF and CR in this order are two ends", "a\n\rb", "1:a|2:|3:b|");
    check_lines("other blanks end no line", "a\tb\vc\fd\n", "1:a\tb\vc\fd|");
    check_lines("bytes from 127 on are text", "\x7F\xC3\xA9\xFF\n",
                "1:\x7F\xC3\xA9\xFF|");
}

static void test_continuation(void)
{
    check_lines("continuation with LF", "a\\\nb\nc", "1:a  b|3:c|");
    check_lines("continuation with CRLF", "a\\\r\nb\r\nc", "1:a   b|3:c|");
    check_lines("continuation with CR", "a\\\rb\rc", "1:a  b|3:c|");
    check_lines("three lines in one", "a\\\nb\\\nc\nd", "1:a  b  c|4:d|");
    check_lines("continuation at the end of the file", "a\\", "1:a |");
    check_lines("continuation into the end of the file", "a\\\n", "1:a  |");
    check_lines("a backslash inside a line stays", "a\\b\nc\\ \nd", "1:a\\b|2:c\\ |3:d|");
    check_lines("a comment does not go on", "# a\\\nb\n \t# c\\\nd",
                "1:# a\\|2:b|3: \t# c\\|4:d|");
    check_lines("a line with a comment behind it goes on", "a # b\\\nc", "1:a # b  c|");
}

static void test_byte_order_mark(void)
{
    check_lines("a byte order mark is skipped", "\xEF\xBB\xBF" "a\nb", "1:a|2:b|");
    check_lines("a mark elsewhere is text",
                "a\n\xEF\xBB\xBF" "b",
                "1:a|2:\xEF\xBB\xBF" "b|");
    check_lines("half a mark is text", "\xEF\xBB" "a", "1:\xEF\xBB" "a|");
}

/* Two lines of `count` characters in all; the first one ends in the middle. */
static bool size_is_read(size_t count)
{
    char *bytes = alloc_array(count, 1);
    memset(bytes, 'x', count);
    bytes[count / 2] = '\n';
    struct text text;
    bool good = read_bytes(&text, bytes, count);
    const char *first = good ? text_line(&text) : NULL,
               *second = first ? text_line(&text) : NULL;
    good = second && strlen(first) == count / 2 &&
           strlen(second) == count - count / 2 - 1 && text.line == 2 && !text_line(&text);
    text_free(&text);
    alloc_free(bytes);
    return good;
}

static void test_sizes(void)
{
    static const size_t sizes[] = {3, BLOCK - 1, BLOCK, BLOCK + 1, 2 * BLOCK,
                                   5 * BLOCK + 7};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++)
        tap_ok(size_is_read(sizes[i]), "a file of %zu bytes", sizes[i]);
}

static void check_words(const char *line, const char *expected)
{
    char copy[100], found[200] = "";
    snprintf(copy, sizeof copy, "%s", line);
    char *rest = copy;
    for (const char *word; (word = text_word(&rest)) != NULL;)
        append(found, sizeof found, word);
    tap_ok(is_same(found, expected) && !text_word(&rest), "words of '%s'", line);
}

static void test_words(void)
{
    check_words("", "");
    check_words(" \t ", "");
    check_words("  f 1/2/3\t\t-1 \v2\f3 ", "f|1/2/3|-1|2|3|");
    check_words("v 1 2 # 3", "v|1|2|");
    check_words("a#b c", "a#b|c|");
    tap_ok(is_same(text_trim((char[]){" \t two words\v\f "}), "two words") &&
               is_same(text_trim((char[]){" \t "}), ""),
           "a line without blanks around");
}

/* Words that strtod takes, some of them, and the formats do not. */
static void test_no_numbers(void)
{
    static const char *const wrong[] = {"", ".", "+-1", "1e", "e1", "1e+", "1.2.3",
                                        "1,5", "1 ", " 1", "0x10", "0x1p3", "nan(1)",
                                        "-Infinity", "1e309", "1f", "1.#IND"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        double value;
        tap_ok(!text_is_number(wrong[i], &value), "'%s' is none", wrong[i]);
    }
}

/* Appends up to `most` random digits, often zeros and nines. */
static char *put_digits(char *to, struct random *random, int most)
{
    int kind = (int)(random_bits(random) % 4);
    for (int count = (int)(random_bits(random) % (uint64_t)(most + 1)); count > 0;
         count--)
        *to++ = kind == 0   ? '0'
                : kind == 1 ? '9'
                            : (char)('0' + random_bits(random) % 10);
    return to;
}

/* The same double as strtod gives, and a number where it is one to the last character. */
static void test_against_strtod(void)
{
    static const char *const doubtful[] = {
        "9007199254740992", "9007199254740993", "9007199254740991e22",
        "9007199254740993e-22", "1e22", "1e23", "1e-22", "1e-23", "-0", "-0.0",
        "0e99999999999999999999", "8.5e22", "123456789012345678901234567890",
        "0.000000000000000000000000000001", "00000000000000000000000001.5",
        "9007199254740992.00", "3e-324", "4.9e-324", "1e-400",
        "179769313486231570814527423731704356798070e267", "1.e5", ".5e+1", "+.5E-1",
        "2e0000000001", "1.7976931348623157e308"};
    struct random random = random_seed(3);
    int numbers = 0, wrong = 0, fixed = (int)(sizeof doubtful / sizeof doubtful[0]);
    for (int round = 0; round < 300000; round++) {
        char word[120], *to = word, *end;
        if (random_bits(&random) % 2)
            *to++ = "+-"[random_bits(&random) % 2];
        to = put_digits(to, &random, 20);
        if (random_bits(&random) % 2)
            *to++ = '.';
        to = put_digits(to, &random, 20);
        if (random_bits(&random) % 2)
            to += sprintf(to, "%c%d", "eE"[round % 2],
                          (int)(random_bits(&random) % 80) - 40);
        *to = '\0';
        const char *tried = round < fixed ? doubtful[round] : word;
        double value = -7.0, expected = strtod(tried, &end);
        bool is_number = end != tried && *end == '\0' && fabs(expected) < HUGE_VAL;
        numbers += is_number;
        bool same = text_is_number(tried, &value) == is_number &&
                    (!is_number || memcmp(&value, &expected, sizeof value) == 0);
        wrong += !same;
        if (!same && wrong == 1)
            printf("# '%s'\n", tried);
    }
    tap_ok(wrong == 0 && numbers > 200000, "%d random numbers are those of strtod",
           numbers);
}

/* An empty message: the word is a number in range. */
static void check_number(const char *word, const char *message)
{
    struct text text;
    double value;
    read_bytes(&text, "one\ntwo\n", 8);
    text_line(&text);
    text_line(&text);
    bool good = text_number(&text, word, &value, &error);
    tap_ok(good == !*message && error.code == (good ? EXIT_DONE : EXIT_USAGE) &&
               is_same(error.text, message),
           "number '%s' in line 2: '%s'", word, message);
    text_free(&text);
}

static void test_number_errors(void)
{
    check_number("-2.5", "");
    check_number("1e100", "");
    check_number("1.0000000000000002e100",
                 FILE_NAME ":2: number '1.0000000000000002e100' is out "
                           "of range");
    check_number("nan", FILE_NAME ":2: bad number 'nan'");
    check_number("a23456789b23456789c23456789d23456789e23456789",
                 FILE_NAME ":2: bad number 'a23456789b23456789c23456789d23456789e234'");
}

static void check_integer(const char *word, int64_t expected, const char *expected_rest)
{
    const char *cursor = word;
    int64_t value = 0;
    tap_ok(text_integer(&cursor, &value) && value == expected &&
               is_same(cursor, expected_rest),
           "integer at '%s'", word);
}

static void test_integers(void)
{
    int64_t value;
    static const char *const wrong[] = {"", "-", " 1", "--1", ".5"};
    check_integer("0", 0, "");
    check_integer("12/3", 12, "/3");
    check_integer("-7x", -7, "x");
    check_integer("+08 9", 8, " 9");
    check_integer("1.5", 1, ".5");
    check_integer("999999999999999999", INT64_C(999999999999999999), "");
    const char *huge = "-123456789012345678901234567890123456789012345678901234567890/";
    tap_ok(text_integer(&huge, &value) && *huge == '/' &&
               value <= -INT64_C(100000000000000000),
           "an integer of 60 digits stays huge");
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        const char *cursor = wrong[i];
        tap_ok(!text_integer(&cursor, &value) && cursor == wrong[i], "no integer at '%s'",
               wrong[i]);
    }
}

static void check_binary(const char *name, const char *bytes, size_t count,
                         const char *message)
{
    struct text text;
    char line[100];
    snprintf(line, sizeof line, FILE_NAME ": %s", message);
    tap_ok(is_refused_as(read_bytes(&text, bytes, count) || text.unreadable, line),
           "%s: %s", name, error.text);
}

static void test_binary(void)
{
    static const char BINARY[] = "not a text file";
    static const char UTF16[] = "is UTF-16; save it as UTF-8";
    check_binary("a zero byte", "a\n\0b", 4, BINARY);
    check_binary("little-endian", "\xFF\xFE" "a\0\n\0", 6, UTF16);
    check_binary("big-endian", "\xFE\xFF\0a\0\n", 6, UTF16);
    check_binary("little-endian without a mark", "v\0 \0" "1\0", 6, UTF16);
    check_binary("big-endian without a mark", "\0v\0 \0" "1", 6, UTF16);
    check_binary("without control characters", "\xFE\xFF\x4E\x2D\x65\x87", 6, UTF16);
    check_binary("zero bytes in pairs", "\0\0\0\0", 4, BINARY);
    check_binary("a bell", "a\a\n", 3, BINARY);
    char *bytes = alloc_array(3 * BLOCK, 1);
    memset(bytes, 'x', 3 * BLOCK);
    bytes[3 * BLOCK - 1] = 1;
    check_binary("a control character in the third block", bytes, 3 * BLOCK, BINARY);
    alloc_free(bytes);
}

static void check_unreadable(const char *path)
{
    struct text text;
    forget_error();
    tap_ok(!text_read(&text, path, &error) && text.unreadable &&
               error_is_of_system(EXIT_USAGE, path, ": cannot read: "),
           "%s", error.text);
}

static void test_names(void)
{
    enum { MANY = 50000 };
    struct text_names names = {0};
    char name[20];
    int numbered = 0, found = 0;
    for (int i = 0; i < MANY; i++) {
        snprintf(name, sizeof name, "name %d", i);
        numbered += text_names_add(&names, name) == i;
    }
    tap_ok(numbered == MANY && names.count == MANY, "%d names are numbered as they come",
           MANY);
    for (int i = MANY - 1; i >= 0; i--) {
        snprintf(name, sizeof name, "name %d", i);
        found += text_names_add(&names, name) == i && strcmp(names.name[i], name) == 0;
    }
    tap_ok(found == MANY && names.count == MANY, "and found again, as copies");
    tap_ok(text_names_add(&names, "") == MANY &&
               text_names_add(&names, "Name 1") == MANY + 1 &&
               text_names_add(&names, "") == MANY,
           "an empty name is a name; capitals count");
    text_names_free(&names);
    tap_ok(names.count == 0 && !names.name && text_names_add(&names, "again") == 0,
           "a freed table is empty");
    text_names_free(&names);
}

int main(void)
{
    test_line_ends();
    test_continuation();
    test_byte_order_mark();
    test_sizes();
    test_words();
    test_no_numbers();
    test_against_strtod();
    test_number_errors();
    test_integers();
    test_binary();
    check_unreadable("build/text_test_absent.txt");
    check_unreadable("build");
    test_names();
    remove(FILE_NAME);
    return tap_done();
}
