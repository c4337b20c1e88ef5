/* Tests of io/run/files.h and io/run/place.h. Proved are: no output goes over a file that
 * is read, or over another output, whatever link or spelling leads there; a checkpoint
 * may be renewed, and a device may take two outputs; and a name without a format is
 * refused, unless it is a device or a pipe. */
#define _XOPEN_SOURCE 700
#include "io/run/files.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/load.h"
#include "tests/refusal.h"

#define FOLDER "build/files_test"

/* Parses the words of a line, and checks the files that it names. */
static bool check(const char *line)
{
    enum { ROOM = 400, MOST = 20 };
    static char words[ROOM], *arguments[MOST];
    struct options options;
    int count = 0;
    snprintf(words, sizeof words, "phr %s", line);
    for (char *word = strtok(words, " "); word; word = strtok(NULL, " "))
        arguments[count++] = word;
    forget_error();
    bool good = options_parse(&options, count, arguments, &error) &&
                files_check(&options, &error) &&
                files_check_input(&options, "room.mtl", &error);
    options_free(&options);
    return good;
}

static void check_refused(const char *line, const char *message)
{
    tap_ok(is_refused_as(check(line), message), "%s: %s", line, error.text);
}

static void check_taken(const char *line, const char *name)
{
    tap_ok(check(line), "%s: %s%s", name, line, error.text);
}

static void make_files(void)
{
    static const char *const FILES[] = {"m.ply", "room.mtl", "a.view", "c", "old.ppm"};
    for (size_t i = 0; i < sizeof FILES / sizeof FILES[0]; i++)
        write_text(FILES[i], "old");
    bool made = mkdir("d", 0777) == 0 && symlink("m.ply", "link.ply") == 0 &&
                symlink("../m.ply", "d/two.ply") == 0 && link("m.ply", "hard.ply") == 0 &&
                symlink("absent.ppm", "dangling.ppm") == 0 &&
                symlink("d", "e") == 0 && link("old.ppm", "hard.ppm") == 0 &&
                symlink("loop.ppm", "loop.ppm") == 0 && mkfifo("pipe", 0666) == 0;
    tap_ok(made, "links and a pipe are there");
}

static void test_inputs(void)
{
    static const char over[] = "which is read: no output goes over it";
    char message[200];
    check_refused("m.ply -o m.ply", "m.ply is read: no output goes over it");
    static const char *const SPELLINGS[] = {"./m.ply", "d/../m.ply", "link.ply",
                                            "e/two.ply", "hard.ply"};
    for (size_t i = 0; i < sizeof SPELLINGS / sizeof SPELLINGS[0]; i++) {
        char line[100];
        snprintf(line, sizeof line, "m.ply -o %s", SPELLINGS[i]);
        snprintf(message, sizeof message, "%s is m.ply, %s", SPELLINGS[i], over);
        check_refused(line, message);
    }
    check_refused("link.ply -o m.ply", "m.ply is link.ply, which is read: no output goes "
                                       "over it");
    check_refused("m.ply --stats ./room.mtl",
                  "./room.mtl is room.mtl, which is read: no output goes over it");
    check_refused("m.ply --view a.view -o a.ppm --stats ./a.view",
                  "./a.view is a.view, which is read: no output goes over it");
    check_refused("m.ply --resume c -o ppm:./c",
                  "./c is c, which is read: no output goes over it");
    check_refused("m.ply --paper --load-links c --checkpoint ./c",
                  "./c is c, which is read: no output goes over it");
    check_taken("m.ply --resume c --checkpoint ./c", "a checkpoint is renewed");
    check_taken("absent.obj -o ply:./absent.obj", "a scene that is not there");
}

static void test_outputs(void)
{
    check_refused("m.ply -o a.ppm -o a.ppm", "a.ppm is named twice");
    check_refused("m.ply -o a.ppm -o pfm:./a.ppm", "a.ppm and ./a.ppm are the same file");
    check_refused("m.ply -o old.ppm --stats ./old.ppm",
                  "old.ppm and ./old.ppm are the same file");
    check_refused("m.ply -o dangling.ppm -o absent.ppm",
                  "dangling.ppm and absent.ppm are the same file");
    check_refused("m.ply --paper --save-links d/l --checkpoint e/../d/l",
                  "d/l and e/../d/l are the same file");
    check_refused("m.ply -o ppm:pipe -o pfm:./pipe", "pipe and ./pipe are the same file");
    check_refused("m.ply -o pfm:- --dump links",
                  "--dump and an output to the standard output do not go together");
    check_taken("m.ply -o a.pfm --dump links", "a dump and a file");
    check_taken("m.ply -o a.ppm -o d/a.ppm", "two folders");
    check_taken("m.ply -o old.ppm -o hard.ppm", "two names of one file");
    check_taken("m.ply -o ppm:/dev/null --stats /dev/null", "a device twice");
}

static void test_formats(void)
{
    static const char *const NAMES[] = {"a", "a.gif", "old.ppm/", "loop", "c"};
    char line[100], message[200];
    for (size_t i = 0; i < sizeof NAMES / sizeof NAMES[0]; i++) {
        snprintf(line, sizeof line, "m.ply -o %s", NAMES[i]);
        snprintf(message, sizeof message, "-o %s: the name must end in ", NAMES[i]);
        bool refused = !check(line) && error.code == EXIT_USAGE;
        tap_ok(refused && strncmp(error.text, message, strlen(message)) == 0, "%s",
               error.text);
    }
    check_taken("m.ply -o pipe", "a pipe gets a picture");
    check_taken("m.ply -o -", "so does the standard output");
    check_taken("m.ply -o /dev/null", "so does a device");
}

int main(void)
{
    tap_ok(system("rm -rf " FOLDER " && mkdir -p " FOLDER) == 0 && chdir(FOLDER) == 0,
           "there is a folder");
    make_files();
    test_inputs();
    test_outputs();
    test_formats();
    return tap_done();
}
