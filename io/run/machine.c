/* Memory: the physical pages, or the lowest limit of the control groups of the process
 * (of either version; each counts, up to the outermost), and what ulimit leaves of the
 * address space. Free memory is no measure: it changes from moment to moment, and most of
 * the memory in use is the cache of files. */
#if defined(__unix__) || defined(__APPLE__)
#define _XOPEN_SOURCE 700
#include <sys/resource.h>
#include <unistd.h>
#endif

#include "io/run/machine.h"

#include <stdio.h>
#include <string.h>

enum { LINE = 4096 };

/* Returns the lower of two limits, of which 0 is none. */
static int64_t lower(int64_t a, int64_t b)
{
    return a > 0 && (b <= 0 || a < b) ? a : b > 0 ? b : 0;
}

/* Reads the file of a limit: a number, or "max" and the like for none. Returns the number
 * or 0. */
static int64_t read_limit(const char *path)
{
    long long number = 0;
    FILE *file = fopen(path, "r");
    if (!file)
        return 0;
    if (fscanf(file, "%19lld", &number) != 1)
        number = 0;
    fclose(file);
    return number;
}

/* Returns the lowest limit of the group "/OUTER/INNER" and the groups around. */
static int64_t group_limit(const char *root, const char *folder, const char *name,
                           char *group)
{
    char path[2 * LINE];
    int64_t least = 0;
    for (char *end = group + strlen(group); end; end = strrchr(group, '/')) {
        *end = '\0';
        snprintf(path, sizeof path, "%s/sys/fs/cgroup%s%s/%s", root, folder, group, name);
        least = lower(least, read_limit(path));
    }
    return least;
}

/* A line of /proc/self/cgroup is NUMBER:CONTROLLERS:GROUP, without controllers in version
 * 2. In a container the folder belongs to the container, and may lack GROUP. */
int64_t machine_groups(const char *root)
{
    char path[LINE], line[LINE], none[1] = "";
    int64_t least = lower(group_limit(root, "", "memory.max", none),
                          group_limit(root, "/memory", "memory.limit_in_bytes", none));
    snprintf(path, sizeof path, "%s/proc/self/cgroup", root);
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file)) {
        char *kind = strchr(line, ':'), *group = kind ? strchr(kind + 1, ':') : NULL;
        line[strcspn(line, "\n")] = '\0';
        if (group && group == kind + 1)
            least = lower(least, group_limit(root, "", "memory.max", group + 1));
        else if (group && strncmp(kind, ":memory:", 8) == 0)
            least = lower(least, group_limit(root, "/memory", "memory.limit_in_bytes",
                                             group + 1));
    }
    if (file)
        fclose(file);
    return least;
}

int64_t machine_memory(void)
{
    int64_t physical = 0;
#ifdef _SC_PHYS_PAGES
    physical = (int64_t)sysconf(_SC_PHYS_PAGES) * sysconf(_SC_PAGESIZE);
#endif
    return lower(physical, machine_groups(""));
}

int64_t machine_room(void)
{
    int64_t room = 0;
#ifdef RLIMIT_AS
    struct rlimit limit;
    int64_t taken = read_limit("/proc/self/statm") * sysconf(_SC_PAGESIZE);
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        room = (int64_t)limit.rlim_cur > taken ? (int64_t)limit.rlim_cur - taken : 1;
#endif
    return room;
}
