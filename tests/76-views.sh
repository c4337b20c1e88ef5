# Several views in one run, outputs that do not depend on each other, and pictures of
# stored solutions.

. tests/tap.sh

quiet="--quiet --epsilon 1e-2"
box="scenes/cornell.obj $quiet"
printf 'eye 278 273 -800\nat 278 273 0\nsize 40 30\n' >"$work/front.view"
printf 'eye 100 400 100\nat 278 100 400\nsize 24 32\n' >"$work/above.view"
front="--view $work/front.view"
above="--view $work/above.view"

# --- each output alone, and all together ---

./phr $box $front -o "$work/front.ppm"
./phr $box $front -o "$work/front.pfm"
./phr $box $front -o "$work/front.error.pfm"
./phr $box $above -o "$work/above.ppm"
./phr $box -o "$work/mesh.ply"
./phr $box -o "$work/mesh.vtk"
for ranks in 1 4; do
    all=$work/all-$ranks
    $MPIEXEC -n $ranks ./phr $box -o "$all-first.ppm" $front -o "$all-front.ppm" \
        -o "$all-front.pfm" -o "$all-front.error.pfm" -o "$all-mesh.ply" \
        $above -o "$all-above.ppm" -o "$all-mesh.vtk" \
        --stats "$all.json"
    for output in front.ppm front.pfm front.error.pfm above.ppm mesh.ply mesh.vtk; do
        check "$output, with all others on $ranks ranks: as alone" \
            cmp "$all-$output" "$work/$output"
    done
    check "a picture before all views is of the first" \
        cmp "$all-first.ppm" "$work/front.ppm"
done
check "the views differ" \
    [ "$(head -c 12 "$work/front.ppm")" != "$(head -c 12 "$work/above.ppm")" ]
./phr $box --stats "$work/none.json"
for key in checksum rays node_tests links error_estimate; do
    check "$key of --stats does not depend on outputs" \
        [ "$(stat_of "$work/none.json" $key)" = "$(stat_of "$all.json" $key)" ]
done

./phr $box $front -o "$work/size-front.ppm" $above -o "$work/size-above.ppm" --size 9x7
check "--size overrides all views" \
    [ "$(head -c 6 "$work/size-front.ppm")$(head -c 6 "$work/size-above.ppm")" = \
        "$(printf 'P6\n9 7P6\n9 7')" ]

# --- stored solutions ---

# same A B TOLERANCE: the pictures or solutions are the same.
same() {
    build/imgdiff "$1" "$2" --tolerance "$3" >"$work/log"
}

# shows NAME SCENE OPTIONS...: on 1 and 4 ranks, a stored solution gives the picture of
# the run that made it, and its leaves to the bit. OPTIONS behind -- are those of both
# runs.
shows() {
    name=$1
    scene=$2
    shift 2
    once=
    while [ "$1" != -- ]; do
        once="$once $1"
        shift
    done
    shift
    mesh=$work/$name.ply
    ./phr "$scene" --quiet $once "$@" -o "$work/$name.pfm" -o "$mesh"
    for ranks in 1 4; do
        $MPIEXEC -n $ranks ./phr "$mesh" --quiet "$@" -o "$work/again.pfm" \
            -o "$work/again.ply"
        check "stored, $name, on $ranks ranks: the picture of the run" \
            same "$work/again.pfm" "$work/$name.pfm" 1e-4
        check "and its leaves" same "$work/again.ply" "$mesh" 0
        rm -f "$work/again.pfm" "$work/again.ply"
    done
}

small="--size 48x36 --samples 2"
shows plain scenes/cornell.obj --epsilon 1e-2 -- $small $front
shows flat scenes/cornell.obj --epsilon 1e-2 -- $small --flat
shows twins scenes/cornell.obj --epsilon 1e-2 --two-sided -- $small $above
shows paper scenes/cornell.obj --epsilon 1e-2 --paper -- $small
shows normals tests/golden/spheres.obj --epsilon 1e-2 -- $small \
    --view tests/golden/spheres.view
shows pixels tests/golden/spheres.obj --epsilon 1e-2 -- --size 24x18 --samples 2 \
    --view tests/golden/spheres.view --final-gather 16,pixels

./phr scenes/cornell.obj --epsilon 1e-2 --quiet $small $front -o "$work/run.error.pfm"
./phr "$work/plain.ply" --quiet $small $front -o "$work/again.error.pfm"
check "the errors of a stored solution's picture are those of the run" \
    same "$work/again.error.pfm" "$work/run.error.pfm" 1e-4
for options in --paper "--final-gather 0" "--show level"; do
    ./phr scenes/cornell.obj --epsilon 1e-2 $small $front $options \
        -o "$work/none.error.pfm" >"$work/log" 2>&1
    check "$options: no errors" [ $? -eq 2 ]
    check "and it is said" grep -q 'none.error.pfm: only pictures of light' "$work/log"
done

# --accuracy begins with 64 rays of leaves, and has pixels of 256 or as many as are given.
# accurate NAME OPTIONS...: the mesh $work/NAME.ply; prints the rays of all pixels.
accurate() {
    name=$1
    shift
    ./phr scenes/cornell.obj --quiet --accuracy 50% --epsilon 1 "$@" --size 12x9 \
        --samples 1 -o "$work/$name.ply" -o "$work/$name.pfm" --stats "$work/$name.json"
    sed -n 's/.*"pixels": \([0-9]*\).*/\1/p' "$work/$name.json"
}

some=$(accurate some --final-gather 32,pixels)
default=$(accurate pixels --final-gather pixels)
accurate leaves >"$work/out"
check "--accuracy: pixels have 256 rays, and not the 64 of leaves ($some, $default)" \
    holds "$default > 7 * $some && $default < 9 * $some"
check "and leaves are the same with pixels" cmp "$work/leaves.ply" "$work/pixels.ply"

# In a shadow on a leaf that the sun lights, all light is a millionth of the leaf's.
printf 'newmtl %s\nKd %s\nKe %s\n' floor "0.5 0.5 0.5" "0 0 0" dark \
    "1e-5 1e-5 1e-5" "0 0 0" sun "0 0 0" "1e6 1e6 1e6" >"$work/sun.mtl"
cat >"$work/sun.obj" <<END
mtllib sun.mtl
v -10 0 -10
v -10 0 10
v 10 0 10
v 10 0 -10
v -2 1 -2
v -2 1 2
v 2 1 2
v 2 1 -2
v -1 100 -1
v 1 100 -1
v 1 100 1
v -1 100 1
usemtl floor
f 1 2 3 4
usemtl dark
f 5 8 7 6
f 5 6 7 8
usemtl sun
f 9 10 11 12
END
printf 'eye 0 0.5 0.1\nat 0 0 0\nup 0 0 1\nfov 60\n' >"$work/sun.view"
shows sun "$work/sun.obj" --epsilon 1e-2 --max-level 1 -- $small --view "$work/sun.view"

# says STATUS WORDS ARGUMENTS...: phr ends so, with these words.
says() {
    status=$1
    words=$2
    shift 2
    $MPIEXEC -n 2 ./phr "$@" >"$work/out" 2>"$work/log"
    [ $? -eq "$status" ] && grep -qF -e "$words" "$work/out" "$work/log" && return
    sed 's/^/# /' "$work/log"
    return 1
}

check "options of the computation are said" says 0 \
    "stored solution: no use is made of --epsilon, --two-sided, --ke, --final-gather" \
    "$work/plain.ply" --two-sided --epsilon 1 --ke radiance --final-gather 9
check "files of the computation are refused" says 2 \
    "is a stored solution: nothing is computed for --stats, --checkpoint" \
    "$work/plain.ply" --stats "$work/new.json" --checkpoint "$work/new"
check "and not written" [ ! -e "$work/new.json" -a ! -e "$work/new" ]
check "so are links, which it does not have" says 2 \
    "is a stored solution: it has no links" "$work/plain.ply" --dump links
check "nor owners" says 2 "owner and links need a run" "$work/plain.ply" --show owner \
    -o "$work/new.ppm"
check "which meshes do not show" says 0 "no use is made of --show" "$work/plain.ply" \
    --show owner -o "$work/new.ply"
check "a solution without roots is refused" says 2 "a solution without its roots" \
    tests/fuzz/corpus/ply/solution.ply -o "$work/new.pfm"
./phr scenes/squares.obj --sky 1 --epsilon 1 --final-gather 0 --quiet -o "$work/sky.ply"
check "so is one below a sky, with advice" says 2 "from its scene, without --sky" \
    "$work/sky.ply" -o "$work/new.pfm"
LC_ALL=C sed 's/^property float rest_g$/property float next_g/' "$work/plain.ply" \
    >"$work/lacking.ply"
check "so is one that lacks a part of its light" says 2 "not a solution of phr" \
    "$work/lacking.ply" -o "$work/new.pfm"
build/imgdiff "$work/plain.ply" "$work/plain.ply" -o "$work/error.ply" >"$work/log"
check "imgdiff's difference of solutions is one, too" says 0 "stored " \
    "$work/error.ply" $small -o "$work/error.pfm"
check "viewfactors takes a solution as a scene" \
    sh -c '"$0" "$1" --epsilon 1 | grep -q from,to,area_from,F' "$BUILD/viewfactors" \
        "$work/sun.ply"

tap_done
