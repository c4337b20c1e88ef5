# The same bytes everywhere: every output file, the checksum and the counts are the same
# on any number of ranks, in the serial build, with every compiler at hand and at every
# optimisation. On small scenes: ranks differ in the way that the code goes, not in the
# size. Most of the time is for phr, compiled twice more, in `make prove` four times.

. tests/tap.sh

counts="checksum links patches leaves passes iterations rays node_tests triangle_tests
        absorbed_power escaped_power error_estimate"
quiet="--quiet --size 40x40"
fineness="--epsilon 1e-3 --final-gather 32"

# build NAME ARGUMENTS...: another phr as $work/NAME/phr, and viewfactors beside it; fails
# with the log if it has warnings.
build() {
    name=$1
    shift
    if ! $MAKE BUILD="$work/$name" "$@" "$work/$name/phr" "$work/$name/viewfactors" \
        >"$work/$name.log" 2>&1 || grep -q 'warning:' "$work/$name.log"; then
        cat "$work/$name.log"
        return 1
    fi
}

# reuse NAME FILE: begins the build NAME with the objects of the serial one, but for those
# that read FILE.
reuse() {
    cp -Rp "$work/serial" "$work/$1"
    find "$work/$1" -name '*.d' -exec grep -l "$2" {} + | sed 's/d$/o/' | xargs rm -f
    rm -f "$work/$1/phr" "$work/$1/viewfactors" "$work/$1/libphr.a"
}

# produce DIRECTORY COMMAND...: the outputs and the stats of a run.
produce() {
    directory=$work/$1
    shift
    mkdir -p "$directory"
    "$@" $quiet $fineness -o "$directory/a.pfm" -o "$directory/a.ppm" \
        -o "$directory/a.ply" -o "$directory/a.png" -o "$directory/a.hdr" \
        -o "$directory/a.vtk" --stats "$directory/s.json"
}

# produce_all BUILD: those of the Cornell box, and its form factors to the last bit.
produce_all() {
    produce "$1" "$work/$1/phr" $cornell
    "$work/$1/viewfactors" --quiet scenes/cornell.obj >"$work/$1/table"
}

# same A B: equal files and equal counts.
same() {
    for file in a.pfm a.ppm a.ply a.png a.hdr a.vtk; do
        cmp "$work/$1/$file" "$work/$2/$file" || return 1
    done
    for run in "$1" "$2"; do
        grep '"visibility"' "$work/$run/s.json" >"$work/$run/visibility" || return 1
    done
    cmp "$work/$1/visibility" "$work/$2/visibility" || return 1
    for key in $counts; do
        if [ "$(stat_of "$work/$1/s.json" $key)" != \
            "$(stat_of "$work/$2/s.json" $key)" ] ||
            [ -z "$(stat_of "$work/$1/s.json" $key)" ]; then
            echo "# $key differs or is missing: $1 and $2"
            return 1
        fi
    done
}

# same_table A B: the same, and equal tables.
same_table() {
    [ -s "$work/$1/table" ] && cmp "$work/$1/table" "$work/$2/table" && same "$1" "$2"
}

cornell="scenes/cornell.obj --view scenes/cornell.view"

two_triangles # more ranks than roots

check "phr compiles without MPI, without warnings, hardly optimised, with plain loops" \
    build serial SERIAL=1 CFLAGS=-O1 CPPFLAGS=-DPHR_PLAIN_LANES
reuse brute octree/build.c
produce_all serial
for ranks in 1 2 3 4 7 16; do
    produce ranks-$ranks $MPIEXEC -n $ranks "$BUILD/phr" $cornell
    check "Cornell box: $ranks ranks give the bytes of the serial build" \
        same ranks-$ranks serial
done
"$BUILD/viewfactors" --quiet scenes/cornell.obj >"$work/ranks-1/table"
check "and the form factors to the last bit" same_table ranks-1 serial

# gather_tests RANKS: the tests of a final gather, of all ranks and of the slowest one.
gather_tests() {
    $MPIEXEC -n "$1" ./phr scenes/cornell.obj --quiet --epsilon 1e-4 --stats "$work/s"
    sed -n 's|.*gather": {.*"all": \(.*\), "slowest": \(.*\), .*|\1 \2|p' "$work/s"
}

# By counts. Dealt once, by predicted work, 2.8 %. In smaller runs one leaf is more. Where
# each rank makes the cuts of all regions that it has a leaf of, 2.1 % are repeated.
set -- $(gather_tests 1) $(gather_tests 16)
check "16 ranks are idle for at most 1.5 % of a gather" holds "1 - $3 / 16 / $4 <= 0.015"
check "and repeat at most half a percent of it: $3 of $1" holds "$3 <= 1.005 * $1"

for twins in --two-sided --two-sided-lamps; do
    produce $twins-serial "$work/serial/phr" $cornell --flat $twins
    produce $twins-3 $MPIEXEC -n 3 "$BUILD/phr" $cornell --flat $twins
    check "the same with --flat $twins" same $twins-3 $twins-serial
done

# power NAME: the emitted power, W.
power() {
    stat_of "$work/$1/s.json" emitted_power
}

# roots OPTIONS...: those of the patches, twins too.
roots() {
    "$work/serial/phr" scenes/cornell.obj --quiet --max-level 0 --dump patches "$@" |
        sed -n 's,/.*,,p'
}

# The Cornell box has 38 triangles, of which 2 and 3 are the lamp.
check "--two-sided leaves the power as it is" \
    [ "$(power --two-sided-3)" = "$(power serial)" ]
check "and the lamp without a twin" [ "$(roots --two-sided)" = "$(seq 0 39; seq 42 75)" ]
check "--two-sided-lamps doubles the power" \
    holds "($(power --two-sided-lamps-3) / $(power serial) - 2)^2 < 1e-24"
check "and gives the lamp one" \
    [ "$(roots --two-sided-lamps)" = "$(seq 0 75)" ]

# from_above OPTIONS...: the sum of a picture of nothing but the lamp's back.
from_above() {
    printf 'eye 278 900 280\nat 278 548.8 280\nup 0 0 1\nfov 8\nsize 9 9\n' \
        >"$work/above.view"
    "$work/serial/phr" scenes/cornell.obj --view "$work/above.view" $quiet $fineness \
        --size 9x9 "$@" \
        -o "$work/above.ppm" && tail -c 243 "$work/above.ppm" | od -An -v -t u1 |
        awk '{ for (i = 1; i <= NF; i++) sum += $i } END { print sum }'
}

check "the back of the lamp is black" [ "$(from_above --two-sided)" = 0 ]
check "that of a two-sided one shines" holds "$(from_above --two-sided-lamps) > 0"

# on_ranks NAME SCENE OPTIONS...: the same bytes on 3 and 7 ranks, in `make prove` on 2.
on_ranks() {
    name=$1
    shift
    produce "$name-serial" "$work/serial/phr" "$@"
    for ranks in 3 7 $(proves && echo 2); do
        produce "$name-$ranks" $MPIEXEC -n $ranks "$BUILD/phr" "$@"
        check "$ranks ranks: $name" same "$name-$ranks" "$name-serial"
    done
}

gathered=$fineness
fineness="--epsilon 1e-3"
on_ranks paper scenes/cornell.obj --paper
fineness=$gathered
on_ranks disk scenes/cornell.obj --form-factor disk
on_ranks jacobi scenes/cornell.obj --solver jacobi --max-level 4
on_ranks bf scenes/cornell.obj --oracle bf
on_ranks accuracy scenes/cornell.obj --accuracy 3%
on_ranks pixels scenes/cornell.obj --final-gather 8,pixels --samples 2
on_ranks two "$work/two.obj"

# A room that has light from below its door alone, over one floor of both rooms: leaves
# and regions aim through the opening, and at sparks.
sed -e 's/^\(v 3\(\.2\)\{0,1\} [12]\) 2$/\1 0.02/' -e 's/^f 1 2 3 4$/f 1 14 15 4/' \
    -e '/^f 13 14 15 16$/d' -e '/^f 12 21 24 9$/d' scenes/doorway.obj >"$work/dark.obj"
cp scenes/course.mtl "$work"
on_ranks dark "$work/dark.obj" --max-level 2

produce levels-serial "$work/serial/phr" scenes/cornell.obj --max-level 3 \
    --min-area 1e-3 \
    --alpha 0 --tolerance 1e-6 --oracle bf --samples 1 --exposure 0.1
produce levels-4 $MPIEXEC -n 4 "$BUILD/phr" scenes/cornell.obj --max-level 3 \
    --min-area 1e-3 \
    --alpha 1 --tolerance 1e-6 --oracle bf --samples 1 --exposure 0.1
check "other limits, no view; alpha moves links, not light" same levels-4 levels-serial

# A lamp that reflects nothing is split by other ranks than its home, and no radiosity
# tells.
sed 's/^Kd.*/Kd 0 0 0/' "$work/two.mtl" >"$work/lamp.mtl"
printf 'newmtl floor\nKd 0.5 0.5 0.5\n' >>"$work/lamp.mtl"
cat >"$work/lamp.obj" <<END
mtllib lamp.mtl
v -4 2 -4
v 4 2 -4
v 4 2 4
v -4 2 4
v 0 0 0
v 0 0 1
v 1 0 0
v 1 0 1
usemtl lamp
f 1 2 3 4
usemtl floor
f 5 6 7
f 7 6 8
END
on_ranks lamp "$work/lamp.obj"

# Enough triangles for ranks to share one copy of scene and octree: a lamp over a floor,
# squares between.
cp "$work/lamp.mtl" "$work/tiles.mtl"
awk 'function square(x, y, z, size, name) {
         printf "usemtl %s\nv %g %g %g\nv %g %g %g\n", name, x, y, z, x, y, z + size
         printf "v %g %g %g\nv %g %g %g\nf -4 -3 -2 -1\n", x + size, y, z + size,
             x + size, y, z
     }
     BEGIN {
         print "mtllib tiles.mtl\nusemtl lamp\nv 3 9 3\nv 5 9 3\nv 4 9 5\nf 1 2 3"
         for (i = 0; i < 2500; i++)
             square(i % 50, i % 7 == 0 ? 3 : 0, int(i / 50), 0.8, "floor")
     }' >"$work/tiles.obj"
produce tiles-serial "$work/serial/phr" "$work/tiles.obj"
for ranks in 2 3; do
    produce tiles-$ranks $MPIEXEC -n $ranks "$BUILD/phr" "$work/tiles.obj"
    check "5001 triangles on $ranks ranks" same tiles-$ranks tiles-serial
done
if "$BUILD/phr" --version | grep -q "MPI build"; then
    $MPIEXEC -n 3 "$BUILD/phr" "$work/tiles.obj" --verbose --max-level 0 \
        >"$work/tiles.log" 2>&1
    check "which look into one copy" \
        grep -q "one copy of scene and octree for 3 ranks" "$work/tiles.log"
fi

# compiler COMMAND FLAGS: gives the same bytes as the build without MPI.
compiler() {
    check "$1 $2 builds without warnings" build other SERIAL=1 CC="$1" CFLAGS="$2"
    produce_all other
    check "$1 $2 gives the same bytes" same_table other serial
    rm -rf "$work/other"
}
if command -v clang >/dev/null; then
    compiler clang "-O3 -march=native"
else
    tap 0 "clang is not installed # SKIP"
fi
if ! command -v clang >/dev/null || proves; then
    compiler "$CC" "-O3 -march=native"
    compiler "$CC" -O0
fi

# The ray caster by brute force, linked in place of the octree. It counts no tests.
check "brute force builds without warnings" build brute SERIAL=1 OCTREE= BRUTE=brute
produce_all brute
counts="checksum links patches leaves passes iterations rays"
check "brute force gives the same bytes" same_table brute serial

# What was built last is installed as it is.
(
    $MAKE SERIAL=1 BUILD="$work/serial" PHR="$work/phr-last" "$work/phr-last"
    unset BUILD
    $MAKE PHR="$work/phr-last" install DESTDIR="$work/last" prefix=
) >"$work/last.log" 2>&1
check "the build without MPI is installed as it is" \
    cmp "$work/serial/phr" "$work/last/bin/phr"
rm -f build/phr-last.kind

# The comparison notices one changed byte.
cp -r "$work/ranks-1" "$work/planted"
printf x | dd of="$work/planted/a.ply" bs=1 seek=1000 conv=notrunc 2>/dev/null
same planted serial >/dev/null 2>&1
check "the comparison notices one changed byte" [ $? -ne 0 ]

tap_done
