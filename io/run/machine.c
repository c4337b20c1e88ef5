/* Memory: the physical pages, or the limit of the container (a control group, of either
 * version) if it is lower. Free memory is no measure: it changes from moment to moment,
 * and most of the memory in use is the cache of files. */
#if defined(__unix__) || defined(__APPLE__)
#define _XOPEN_SOURCE 700
#include <unistd.h>
#endif

#include "io/run/machine.h"

#include <stdio.h>

/* Reads the file of a limit: a number, or "max" and the like for none. Returns bytes or
 * 0. */
static int64_t read_limit(const char *path)
{
    long long bytes = 0;
    FILE *file = fopen(path, "r");
    if (!file)
        return 0;
    if (fscanf(file, "%19lld", &bytes) != 1)
        bytes = 0;
    fclose(file);
    return bytes;
}

static int64_t physical_memory(void)
{
#ifdef _SC_PHYS_PAGES
    long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
    return pages > 0 && size > 0 ? (int64_t)pages * size : 0;
#else
    return 0;
#endif
}

int64_t machine_memory(void)
{
    static const char *const LIMITS[] = {"/sys/fs/cgroup/memory.max",
                                         "/sys/fs/cgroup/memory/memory.limit_in_bytes"};
    int64_t least = physical_memory();
    for (int i = 0; i < 2; i++) {
        int64_t limit = read_limit(LIMITS[i]);
        if (limit > 0 && (least == 0 || limit < least))
            least = limit;
    }
    return least;
}
