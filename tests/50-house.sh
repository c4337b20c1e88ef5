# The house: layers point one way, MPI stays in mpi/, the READMEs agree with the program
# and its files, and install puts things where it should.

. tests/tap.sh

# forbidden FOLDER PATTERN: no source in FOLDER includes a file that matches.
forbidden() {
    ! grep -nE "#include \"($2)/" "$1"/*.[ch]
}

check "geom/ includes no other layer" forbidden geom 'octree|rad|mpi|io|tools'
check "octree/ includes geom/ only" forbidden octree 'rad|mpi|io|tools'
check "rad/ includes neither mpi/, io/ nor tools/" forbidden rad 'mpi|io|tools'
check "nor does rad/beyond/" forbidden rad/beyond 'mpi|io|tools'
check "mpi/ includes neither io/ nor tools/" forbidden mpi 'io|tools'
check "nor does mpi/beyond/" forbidden mpi/beyond 'io|tools'
check "io/scene/ includes geom/ only" \
    forbidden io/scene 'octree|rad|mpi|io/run|io/picture|tools'
check "io/run/ includes neither mpi/, io/picture/ nor tools/" \
    forbidden io/run 'mpi|io/picture|tools'
check "io/picture/ includes neither mpi/ nor tools/" forbidden io/picture 'mpi|tools'
check "tools/ does not include tests/" forbidden tools 'tests'
check "nor does tools/viewfactors/" forbidden tools/viewfactors 'tests'

house="geom/*.[ch] octree/*.[ch] rad/*.[ch] rad/beyond/*.[ch] io/*/*.[ch] tools/*.[ch]"
house="$house rad/beyond/gather/*.[ch] tools/*/*.[ch]"
mpi_outside=$(grep -lE '<mpi\.h>|\bMPI_[A-Z]' phr.c $house)
check "MPI is used in mpi/ only" [ -z "$mpi_outside" ]

# named FILE README: it names the file, with or without its ending.
named() {
    name=$(basename "$1")
    grep -qF -e "\`$name\`" -e "\`${name%.*}\`" "$2"
}

missing=
for file in $house mpi/*.[ch] mpi/beyond/*.[ch] lib/*.[ch] scenes/* docs/*; do
    folder=$(dirname "$file")
    [ "$file" = "$folder/README.md" ] || named "$file" "$folder/README.md" ||
        missing="$missing $file"
done
for file in tests/*.[ch] tests/*.sh tests/*.awk tests/*.py \
    tests/*/*.[ch] tests/*/*/*.c tests/bench/*; do
    named "$file" tests/README.md || missing="$missing $file"
done
check "each folder's README has every file:$missing" [ -z "$missing" ]

gone=
for folder in geom octree rad rad/beyond mpi mpi/beyond io/* tools lib \
    tools/viewfactors; do
    for name in $(sed -n 's/^| `\([^`]*\)`.*/\1/p' "$folder/README.md"); do
        ls "$folder/$name".[ch] >/dev/null 2>&1 || gone="$gone $folder/$name"
    done
done
check "and none that is not there:$gone" [ -z "$gone" ]

missing=$(git ls-files 2>/dev/null | sed -n 's,/.*,,p' | sort -u |
    while read -r folder; do grep -qF "\`$folder/" README.md || echo "$folder"; done)
check "the README has every folder: $missing" [ -z "$missing" ]

# Names in backquotes that match PATTERN, of the README, of docs/ and of the course.
quoted() {
    grep -ohE "\`$1\`" README.md docs/*.md docs/course/*.md | tr -d '\`' | sort -u
}
gone=$(quoted '[a-zA-Z0-9_]+[a-zA-Z0-9_./-]*/[a-zA-Z0-9_.-]+\.[a-z0-9]+' |
    grep -v '^build/' | while read -r file; do [ -e "$file" ] || echo "$file"; done)
check "the files that README and docs/ name are there: $gone" [ -z "$gone" ]
gone=$(quoted '[a-z0-9_]+\(\)' | while read -r name; do
    grep -qE "^[a-z].*\b${name%()}\(" phr.c $house mpi/*.[ch] mpi/beyond/*.[ch] \
        docs/course/*.c docs/course/exercises/*.c || echo "$name"; done)
check "and the functions: $gone" [ -z "$gone" ]
# Stops of the README's reading order: FILE FUNCTION, pair by pair.
gone=$(sed -n '/^## Reading order/,/^## The house/p' README.md |
    grep -oE '`[a-z_/]+\.c`: `[a-z_]+\(\)' | tr -d '`:()' |
    while read -r file name; do
        grep -qE "^[a-z].*\b$name\(" "$file" || echo "$file $name"; done)
check "each function of the reading order is in its file: $gone" [ -z "$gone" ]

$MPIEXEC -n 2 ./phr scenes/cornell.obj >"$work/summary" 2>/dev/null
missing=$(while IFS= read -r line; do
    grep -qxF -- "$line" README.md || echo "$line"
done <"$work/summary")
check "the README shows the summary of make demo: $missing" [ -z "$missing" ]
check "which has ten lines" [ "$(wc -l <"$work/summary")" -eq 10 ]

$MAKE BUILD="$BUILD" install DESTDIR="$work/root" prefix=/opt/phr \
    >"$work/install.log" 2>&1
check "install: the program runs" \
    [ "$("$work/root/opt/phr/bin/phr" --version)" = "$(./phr --version)" ]
check "install: imgdiff runs" \
    [ "$("$work/root/opt/phr/bin/imgdiff" --version)" = "imgdiff 0.3" ]
check "install: viewfactors runs" [ "$("$work/root/opt/phr/bin/viewfactors" --version)" \
    = "$(./phr --version | sed s/phr/viewfactors/)" ]
for program in phr imgdiff viewfactors; do
    check "install: the man page of $program is there" \
        [ -s "$work/root/opt/phr/share/man/man1/$program.1" ]
done
check "install: the licence is there" \
    cmp LICENSE "$work/root/opt/phr/share/doc/phr/LICENSE"
check "CITATION.cff has this version" grep -q \
    "^version: \"$(./phr --version | sed 's/phr \([0-9.]*\).*/\1/')\"" CITATION.cff
$MAKE BUILD="$BUILD" uninstall DESTDIR="$work/root" prefix=/opt/phr \
    >>"$work/install.log" 2>&1
check "uninstall leaves no file" [ -z "$(find "$work/root" -type f)" ]

x87='-std=c99 -fsyntax-only -mfpmath=387 -I.'
echo 'int main(void) { return 0; }' >"$work/empty.c"
if $CC $x87 "$work/empty.c" 2>/dev/null; then
    $CC $x87 geom/error.c geom/triangle.c 2>"$work/x87.log"
    check "x87 is refused with advice" grep -q 'add -msse2 -mfpmath=sse' "$work/x87.log"
else
    tap 0 "x87 is refused # SKIP the compiler has no x87"
fi

tap_done
