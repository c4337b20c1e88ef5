/* Linked to a phr that is compiled with -finstrument-functions: writes the chain of calls
 * from main() to the first call of one function, an address a line, main() first. The
 * environment names the address of that function, FACTOR_AT, and the file, CHAIN. */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum { DEPTH_MAX = 256 };

static void *calls[DEPTH_MAX];
static int depth;
static bool done;

static void write_chain(void)
{
    const char *path = getenv("CHAIN");
    FILE *file = path ? fopen(path, "w") : NULL;
    for (int i = 0; file && i < depth; i++)
        fprintf(file, "%llx\n", (unsigned long long)(uintptr_t)calls[i]);
    if (file)
        fclose(file);
}

void __cyg_profile_func_enter(void *function, void *site);
void __cyg_profile_func_exit(void *function, void *site);

void __cyg_profile_func_enter(void *function, void *site)
{
    static unsigned long long wanted;
    (void)site;
    if (depth < DEPTH_MAX)
        calls[depth] = function;
    depth++;
    if (!wanted)
        wanted = getenv("FACTOR_AT") ? strtoull(getenv("FACTOR_AT"), NULL, 16) : 1;
    if (!done && (uintptr_t)function == wanted && depth <= DEPTH_MAX) {
        done = true;
        write_chain();
    }
}

void __cyg_profile_func_exit(void *function, void *site)
{
    (void)function, (void)site;
    depth--;
}
