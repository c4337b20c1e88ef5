/* Tests of io/run/machine.h: the lowest limit counts of all control groups that a process
 * is in, of either version, and what ulimit leaves. */
#define _XOPEN_SOURCE 700
#include "io/run/machine.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "tests/load.h"
#include "tests/tap.h"

#define ROOT "build/machine_test"
#define GROUPS ROOT "/sys/fs/cgroup/"

/* Writes a file of the system, below ROOT, and its folders. */
static void tell(const char *path, const char *text)
{
    char folder[200];
    snprintf(folder, sizeof folder, "%s", path);
    for (char *at = strchr(folder, '/'); at; at = strchr(at + 1, '/')) {
        *at = '\0';
        mkdir(folder, 0777);
        *at = '/';
    }
    write_text(path, text);
}

static void check(int64_t bytes, const char *what)
{
    int64_t found = machine_groups(ROOT);
    tap_ok(found == bytes, "%s: %lld", what, (long long)found);
}

/* Forgets what was told. */
static void begin(const char *own_groups)
{
    if (system("rm -rf " ROOT) != 0)
        exit(1);
    tell(ROOT "/proc/self/cgroup", own_groups);
}

static void test_version_2(void)
{
    begin("0::/outer/job/step\n");
    check(0, "no file has a limit");
    tell(GROUPS "outer/job/step/memory.max", "max\n");
    tell(GROUPS "outer/memory.max", "7000\n");
    check(7000, "the outer group has one");
    tell(GROUPS "outer/job/memory.max", "5000\n");
    check(5000, "that between is lower");
    tell(GROUPS "outer/job/step/memory.max", "6000\n");
    check(5000, "the inner one is not");
    tell(GROUPS "memory.max", "4000\n");
    check(4000, "in a container its root counts");
}

static void test_version_1(void)
{
    begin("9:name=systemd:/\n4:memory:/outer/job\n1:cpu:/fast\n0::/\n");
    tell(GROUPS "memory/outer/job/memory.limit_in_bytes", "9223372036854771712\n");
    tell(GROUPS "memory/outer/memory.limit_in_bytes", "3000\n");
    tell(GROUPS "memory/fast/memory.limit_in_bytes", "1000\n");
    check(3000, "version 1: the outer group of the memory controller");
    tell(GROUPS "memory/outer/job/memory.limit_in_bytes", "2000\n");
    check(2000, "and the inner one");
    begin("4:memory:/container/of/the/host\n");
    tell(GROUPS "memory/memory.limit_in_bytes", "8000\n");
    check(8000, "a group of the host that the container does not see");
}

static void test_room(void)
{
    enum { MORE = 1 << 28 };
    struct rlimit limit;
    getrlimit(RLIMIT_AS, &limit);
    if (limit.rlim_cur == RLIM_INFINITY)
        tap_ok(machine_room() == 0, "without ulimit -v there is room");
    limit.rlim_cur = MORE;
    setrlimit(RLIMIT_AS, &limit);
    int64_t room = machine_room();
    tap_ok(room > 0 && room < MORE, "with it, less than that: %lld", (long long)room);
    limit.rlim_cur = 4096;
    setrlimit(RLIMIT_AS, &limit);
    tap_ok(machine_room() == 1, "a limit that is passed already leaves a byte");
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_AS, &limit);
}

int main(void)
{
    test_version_2();
    test_version_1();
    test_room();
    tap_ok(machine_memory() > 0, "this machine has memory");
    return tap_done();
}
