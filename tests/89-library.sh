# The library: it is installed with no names but its own, the program of docs/library.md
# and one that has its own MPI are compiled with it and get exact light; make golden.

. tests/tap.sh

$MAKE BUILD="$BUILD" install-lib DESTDIR="$PWD/$work" prefix= >"$work/log" 2>&1
check "its global names begin with phr_" \
    [ "$(nm -g --defined-only "$work/lib/libphr.a" | grep -c ' phr_')" -eq 6 -a \
    -z "$(nm -g --defined-only "$work/lib/libphr.a" | grep ' [A-Z] ' | grep -v ' phr_')" ]

# build NAME: compiles a program with the library.
build() {
    $MPICC -std=c99 -pedantic -Wall -Wextra -Werror -I"$work/include" -o "$work/$1" \
        "$work/$1.c" -L"$work/lib" -lphr -lm
}

sed -n '/^```c/,/^```$/p' docs/library.md | grep -v '^```' >"$work/squares.c"
check "the program of docs/library.md has about 40 lines" \
    holds "$(wc -l <"$work/squares.c") <= 42"
check "and is compiled" build squares
for ranks in 1 3; do
    $MPIEXEC -n $ranks "$work/squares" >"$work/out-$ranks" 2>"$work/log"
    power=$(sed 's/.*sends \(.*\) W/\1/' "$work/out-$ranks")
    check "it finds half of the form factor, $power, on $ranks" \
        holds "(${power:-1} - .5 * .1998249)^2 < 1e-10"
done
check "and the same on both" cmp "$work/out-1" "$work/out-3"

# A program with names of phr's own, MPI of its own, and scenes that are wrong.
cat >"$work/other.c" <<'END'
#include <mpi.h>
#include <phr.h>
#include <stdio.h>
#include <string.h>

int alloc_array, scene_create; /* no function of phr */
static double box[12][9];      /* the unit cube from inside */
static int material_of[12];
static struct phr_material wall = {{.5, .5, .5}, {1, 2, 3}};
static int rank, bad;

static void make_box(void)
{
    static const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    static const int cut[6] = {0, 2, 1, 0, 3, 2};
    for (int i = 0; i < 36; i++)
        for (int axis = 0; axis < 3; axis++)
            box[i / 3][3 * (i % 3) + axis] = quads[i / 6][cut[i % 6]] >> axis & 1;
}

static void refuse(const struct phr_scene *scene, const char *option, const char *text)
{
    const char *options[] = {option, NULL};
    struct phr_solution *none = phr_solve(scene, options);
    bad += none || !strstr(phr_error(), text);
    if (bad && rank == 0)
        printf("expected '%s', got '%s'\n", text, phr_error());
    phr_free(none);
}

int main(int argc, char **argv)
{
    struct phr_scene scene = {12, &box[0][0], material_of, 1, &wall};
    MPI_Init(&argc, &argv);
    rank = phr_start();
    make_box();
    refuse(NULL, NULL, "no triangles");
    refuse(rank == 0 ? &scene : NULL, "--epsilon", "needs a value");
    refuse(&scene, "--stats=a", "takes no --stats");
    refuse(&scene, "a.obj", "one scene at a time");
    material_of[7] = 1;
    refuse(&scene, NULL, "triangle 7: there is no material 1");
    material_of[7] = 0;
    wall.emission[1] = -1;
    refuse(&scene, NULL, "material 0");
    wall.emission[1] = 2;
    box[3][2] = 0.0 / (box[0][0] - box[0][0]);
    refuse(&scene, NULL, "coordinate");
    make_box();
    struct phr_solution *light = phr_solve(rank == 0 ? &scene : NULL, NULL);
    bad += !light || *phr_error() || !light->converged;
    for (long i = 0; light && i < light->leaf_count; i++)
        for (int c = 0; c < 3; c++) { /* a furnace: E / (1 - rho) */
            double off = light->leaves[i].radiosity[c] / (2 * (c + 1)) - 1;
            bad += off * off > 1e-8;
        }
    phr_free(light);
    phr_stop();
    MPI_Finalize();
    return bad != 0;
}
END
if $MPICC -I"$work/include" -E "$work/other.c" >"$work/log" 2>&1; then
    check "a program with names of phr's and MPI of its own is compiled" build other
    for ranks in 1 3; do
        check "it has the light of a furnace, and errors, on $ranks" \
            $MPIEXEC -n $ranks "$work/other"
    done
else
    tap 0 "a program with MPI of its own # SKIP there is no MPI"
fi

check "make golden has no case of another name" \
    sh -c '! CASE=none sh tests/golden.sh "$0" ./phr 2>/dev/null' "$work"
CASE=furnace sh tests/golden.sh "$work/golden" "$PHR"
check "make golden CASE=furnace makes that picture alone" \
    [ "$(cd "$work/golden" && echo *)" = furnace.pfm ]

tap_done
