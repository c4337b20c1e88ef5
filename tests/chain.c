/* Linked to a phr that is compiled with -finstrument-functions: writes the chain of calls
 * from main() to the first call of one function, an address a line, main() first. The
 * environment names the address of that function, CALLED_AT, of another that has to be
 * in the chain, BY_WAY_OF, if any has to, and the file, CHAIN. */
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

/* The address that the environment names; 0: none. */
static uintptr_t address(const char *name)
{
    const char *text = getenv(name);
    return text ? (uintptr_t)strtoull(text, NULL, 16) : 0;
}

static bool is_on_the_way(uintptr_t function)
{
    for (int i = 0; i < depth; i++)
        if ((uintptr_t)calls[i] == function)
            return true;
    return function == 0;
}

void __cyg_profile_func_enter(void *function, void *site);
void __cyg_profile_func_exit(void *function, void *site);

void __cyg_profile_func_enter(void *function, void *site)
{
    static bool begun;
    static uintptr_t called, by_way_of;
    (void)site;
    if (!begun) {
        begun = true;
        called = address("CALLED_AT");
        by_way_of = address("BY_WAY_OF");
    }
    if (depth < DEPTH_MAX)
        calls[depth] = function;
    depth++;
    if (!done && (uintptr_t)function == called && depth <= DEPTH_MAX &&
        is_on_the_way(by_way_of)) {
        done = true;
        write_chain();
    }
}

void __cyg_profile_func_exit(void *function, void *site)
{
    (void)function, (void)site;
    depth--;
}
