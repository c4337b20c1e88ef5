/* Tests of io/run/output.h. Proved are: a file appears whole or not at all; after an
 * error the old file has its old bytes and nothing lies beside it; a probe tells a file
 * that cannot be written, with a line that says why, and opens no pipe; modes and links
 * stay; a name may be as long as the system allows; and numbers have one byte order. */
#define _XOPEN_SOURCE 700
#include "io/run/output.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/load.h"
#include "tests/refusal.h"

#define PATH "build/output_test.bin"
#define BESIDE PATH ".0.tmp"

/* True if the file holds exactly these bytes. */
static bool file_is(const char *path, const char *bytes, size_t count)
{
    char found[200];
    return load(path, found, sizeof found) == count && memcmp(found, bytes, count) == 0;
}

static bool path_is_free(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (file)
        fclose(file);
    return !file;
}

static bool start(struct output *output, const char *path)
{
    forget_error();
    return output_open(output, path, &error);
}

static void test_whole_file(void)
{
    struct output output;
    remove(PATH);
    tap_ok(start(&output, PATH) && path_is_free(PATH) && !path_is_free(BESIDE),
           "a new file grows beside its place");
    fputs("new", output.file);
    tap_ok(output_close(&output, &error) && file_is(PATH, "new", 3) &&
               path_is_free(BESIDE),
           "and goes there when it is closed");
    start(&output, PATH);
    fputs("newer", output.file);
    tap_ok(fflush(output.file) == 0 && file_is(PATH, "new", 3),
           "the old file is there while the next one grows");
    tap_ok(output_close(&output, &error) && file_is(PATH, "newer", 5) &&
               path_is_free(BESIDE) && error.code == EXIT_DONE,
           "which then takes its place");
}

/* After an error of another part of the program. */
static void test_error_elsewhere(void)
{
    struct output output;
    write_text(PATH, "old");
    start(&output, PATH);
    fputs("new", output.file);
    error_set(&error, EXIT_USAGE, "elsewhere");
    tap_ok(!output_close(&output, &error) && file_is(PATH, "old", 3) &&
               path_is_free(BESIDE),
           "an error elsewhere leaves the old file");
    tap_ok(error.code == EXIT_USAGE && strcmp(error.text, "elsewhere") == 0,
           "and stays the error that is told");
    remove(PATH);
    start(&output, PATH);
    error_set(&error, EXIT_USAGE, "elsewhere");
    tap_ok(!output_close(&output, &error) && path_is_free(PATH) && path_is_free(BESIDE),
           "and makes no file where there was none");
}

static bool is_refused(bool good, const char *path)
{
    return !good && error_is_of_system(EXIT_FAILED, path, ": cannot write: ");
}

/* A stream that was reopened for reading refuses every byte: a full disk, anywhere. */
static void test_write_error(void)
{
    struct output output;
    write_text(PATH, "old");
    start(&output, PATH);
    output.file = freopen(BESIDE, "rb", output.file);
    bool refused = output.file && putc('x', output.file) == EOF;
    tap_ok(refused && is_refused(output_close(&output, &error), PATH),
           "a write error: %s", error.text);
    tap_ok(file_is(PATH, "old", 3) && path_is_free(BESIDE),
           "leaves the old file and no other");
}

/* A path that both output_probe() and output_open() refuse, for the same reason. */
static void check_unwritable(const char *path)
{
    struct output output = {0};
    forget_error();
    bool probed = is_refused(output_probe(path, &error), path);
    struct error first = error;
    bool opened = is_refused(start(&output, path), path);
    tap_ok(probed && opened && strcmp(first.text, error.text) == 0, "'%s' is refused: %s",
           path, error.text);
    tap_ok(!output_close(&output, &error),
           "an output that did not open does not close well");
}

static void test_probe(void)
{
    forget_error();
    remove(PATH);
    tap_ok(output_probe(PATH, &error) && path_is_free(PATH) && path_is_free(BESIDE),
           "probing a new file leaves nothing");
    write_text(PATH, "old");
    tap_ok(output_probe(PATH, &error) && file_is(PATH, "old", 3) &&
               path_is_free(BESIDE) && error.code == EXIT_DONE,
           "probing an old file leaves it");
    check_unwritable("build");
    check_unwritable("build/output_test_absent/file.ppm");
    check_unwritable(PATH "/file.ppm");
    check_unwritable("");
}

/* True if there is a file that can be opened and takes nothing. */
static bool is_full(const char *path)
{
    FILE *device = fopen(path, "ab");
    bool full = device && putc('x', device) == 'x' && fflush(device) != 0;
    if (device)
        fclose(device);
    return full;
}

/* A device is written in place. Where the system has none, there is nothing to prove;
 * where one was opened beside its place, closing would replace it, so an error keeps that
 * from happening. */
static void test_full_device(void)
{
    static const char path[] = "/dev/full";
    struct output output;
    if (!is_full(path)) {
        tap_ok(true, "a full device # SKIP there is no %s", path);
        return;
    }
    tap_ok(start(&output, path) && output_probe(path, &error),
           "a device is opened in place");
    if (!tap_ok(!output.temporary, "and not beside it")) {
        error_set(&error, EXIT_FAILED, "do not rename");
        output_close(&output, &error);
        return;
    }
    for (int i = 0; i < 100000; i++)
        output_uint32(&output, 1);
    tap_ok(is_refused(output_close(&output, &error), path), "many bytes: %s", error.text);
    tap_ok(path_is_free("/dev/full.0.tmp") && is_full(path), "the device stays");
}

/* Writes a byte; true if it arrives, and nothing lies beside. */
static bool writes(const char *path)
{
    struct output output;
    if (!start(&output, path))
        return false;
    putc('x', output.file);
    return output_close(&output, &error) && file_is(path, "x", 1);
}

static void test_modes(void)
{
    static const mode_t MODES[] = {0600, 0755};
    struct stat status;
    for (size_t i = 0; i < sizeof MODES / sizeof MODES[0]; i++) {
        write_text(PATH, "old");
        bool kept = chmod(PATH, MODES[i]) == 0 && writes(PATH) &&
                    stat(PATH, &status) == 0 && (status.st_mode & 0777) == MODES[i];
        tap_ok(kept, "a new file has the mode of the old one, %o", (unsigned)MODES[i]);
    }
}

static bool is_link(const char *path)
{
    struct stat status;
    return lstat(path, &status) == 0 && S_ISLNK(status.st_mode);
}

static void test_links(void)
{
    static const char link[] = "build/output_test.link", two[] = "build/output_test.two";
    remove(link);
    remove(two);
    remove(PATH);
    bool made = symlink("output_test.bin", link) == 0 &&
                symlink("../build/output_test.link", two) == 0;
    tap_ok(made && writes(link) && file_is(PATH, "x", 1) && is_link(link),
           "a link that leads to no file leads to one then");
    write_text(PATH, "old");
    tap_ok(writes(two) && file_is(PATH, "x", 1) && is_link(two) && is_link(link),
           "a link to a link stays, and so does that");
    remove(link);
    tap_ok(symlink("output_test.two", link) == 0 && !writes(link) &&
               error.code == EXIT_FAILED && is_link(link),
           "links in a circle are refused: %s", error.text);
    remove(link);
    remove(two);
}

static void test_long_names(void)
{
    for (int length = 249; length <= 255; length += 3) {
        char path[300] = "build/";
        memset(path + 6, 'n', (size_t)length);
        tap_ok(writes(path), "a name of %d bytes: %s", length, error.text);
        remove(path);
    }
}

/* Files that killed runs have left are named when there are too many. */
static void test_left_behind(void)
{
    enum { MOST = 100 };
    struct output output;
    char path[sizeof PATH + 20];
    for (int n = 0; n < MOST; n++) {
        snprintf(path, sizeof path, PATH ".%d.tmp", n);
        write_text(path, "half");
    }
    tap_ok(!start(&output, PATH) && error.code == EXIT_FAILED &&
               strcmp(error.text, PATH ": cannot write: " PATH ".99.tmp and all before "
                                  "it are there, as killed runs leave them") == 0,
           "a hundred files left behind: %s", error.text);
    remove(path);
    tap_ok(start(&output, PATH) && output_close(&output, &error),
           "one of them removed, there is room");
    for (int n = 0; n < MOST; n++) {
        snprintf(path, sizeof path, PATH ".%d.tmp", n);
        remove(path);
    }
}

/* A pipe that nobody reads: opening it for writing would wait, or fail. */
static void test_pipe(void)
{
    static const char path[] = "build/output_test.pipe";
    remove(path);
    tap_ok(mkfifo(path, 0600) == 0 && output_is_stream(path), "a pipe is a stream");
    forget_error();
    alarm(10);
    tap_ok(output_probe(path, &error), "probing a pipe does not open it");
    alarm(0);
    remove(path);
    tap_ok(output_is_stream("-") && output_is_stream("/dev/null") &&
               !output_is_stream("build") && !output_is_stream(PATH),
           "devices and the standard output are streams, files and folders are not");
}

static void test_numbers(void)
{
    static const unsigned char expected[] = {
        0x04, 0x03, 0x02, 0x01, /* 0x01020304 */
        0xFF, 0xFE, 0xFD, 0xFC, /* 0xFCFDFEFF */
        0x00, 0x00, 0x20, 0xC0, /* -2.5 = -1.25 * 2^1 */
        0x00, 0x00, 0x00, 0x00, /* 0 */
        0xFF, 0xFF, 0x7F, 0x7F, /* the largest: (2 - 2^-23) * 2^127 */
        0xCD, 0xCC, 0xCC, 0x3D, /* 0.1, rounded */
    };
    struct output output;
    start(&output, PATH);
    output_uint32(&output, 0x01020304u);
    output_uint32(&output, 0xFCFDFEFFu);
    output_float(&output, -2.5f);
    output_float(&output, 0.0f);
    output_float(&output, 3.40282346638528859812e38f);
    output_float(&output, 0.1f);
    tap_ok(output_close(&output, &error) &&
               file_is(PATH, (const char *)expected, sizeof expected),
           "integers and floats, least significant byte first");
}

int main(void)
{
    test_whole_file();
    test_error_elsewhere();
    test_write_error();
    test_probe();
    test_full_device();
    test_modes();
    test_links();
    test_long_names();
    test_left_behind();
    test_pipe();
    test_numbers();
    remove(PATH);
    return tap_done();
}
