# Which axis is up, and why; what --up changes: the sky, and the view that is chosen.
. tests/tap.sh

printf 'newmtl white\nKd .5 .5 .5\nnewmtl lamp\nKe 1 1 1\n' >"$work/up.mtl"

# square AXIS SIGN AT SIZE: a level square across the axis (1 x, 2 y, 3 z), facing the
# side of the sign.
square() {
    awk -v a="$1" -v s="$2" -v at="$3" -v d="$4" 'BEGIN {
        for (k = 0; k < 4; k++) {
            p[a] = at
            p[a % 3 + 1] = (k == 1 || k == 2) * d
            p[(a + 1) % 3 + 1] = (k > 1) * d
            print "v", p[1], p[2], p[3]
        }
        print (s > 0 ? "f -4 -3 -2 -1" : "f -1 -2 -3 -4") }'
}
# turned: a scene with z up of one with y up.
turned() { awk '/^v/ { print "v", $2, -$4, $3; next } { print }'; }

# is_up AXIS REASON SCENE OPTIONS...: what a run says; without AXIS, nothing.
is_up() {
    axis=$1 reason=$2 scene=$3
    shift 3
    $MPIEXEC -n ${ranks:-1} ./phr "$work/$scene.obj" --epsilon 1e-1 --final-gather 0 \
        --size 32x24 -o "$work/$scene.ppm" "$@" 2>"$work/log" >"$work/out" || return 1
    said=$(sed -n 's/^phr: .*: \(-*[xyz] is up: .*\) (see --up)$/\1/p' "$work/log")
    [ "$said" = "${axis:+$axis is up: $reason}" ] && return
    echo "# '$said'"
    return 1
}

{ echo mtllib up.mtl; echo usemtl white; box 4 3 5; echo usemtl lamp
    square 2 -1 2.9 1; } >"$work/lamp.obj"
# Slabs around a room, and a lamp of six sides below the upper one.
slab() {
    box "$4" "$5" "$6" | awk -v x="$1" -v y="$2" -v z="$3" -v n="$7" '
        /^v/ { print "v", $2 + x, $3 + y, $4 + z; next }
        { print "f", $5 + n, $4 + n, $3 + n, $2 + n }'
}
{ echo mtllib up.mtl; echo usemtl white; slab 0 -1 0 8 1 8 0; slab 0 3 0 8 1 8 8
    slab -1 0 0 1 3 8 16; slab 8 0 0 1 3 8 24; slab 0 0 -1 8 3 1 32
    slab 0 0 8 8 3 1 40; echo usemtl lamp; slab 4 2.7 4 1 .2 1 48; } >"$work/slabs.obj"
# Blocks of several heights, without ground.
for k in 1 2 3 4 5 6; do slab $((k * 20)) -$((k % 3)) $((k * 37 % 50)) 12 $((k * 9)) 12 \
    $((8 * k - 8)); done | awk '!/^f/ || ++n % 6 != 3' >"$work/city.obj"
{ square 2 1 0 4; square 1 1 -1 1; square 1 -1 3 1; square 3 1 7 1; square 3 -1 5 1
    square 2 -1 -2 1; square 2 1 -2.1 1; } >"$work/leaves.obj"
slab 0 0 0 1 1 1 0 >"$work/cube.obj"
{ echo "# FreeCAD v0.20"; cat "$work/cube.obj"; } >"$work/cad.obj"
for scene in lamp slabs city leaves cube; do
    turned <"$work/$scene.obj" >"$work/$scene-z.obj"
done
for ranks in 1 3; do
    check "lamps, on $ranks" is_up y "lamps shine down" lamp
    check "the other way" is_up z "lamps shine down" lamp-z
    check "lamps of six sides" is_up y "lamps hang near the top" slabs
    check "the other way" is_up z "lamps hang near the top" slabs-z
    check "a city" is_up y "more faces look that way than any other" city
    check "the other way" is_up z "more faces look that way than any other" city-z
    check "leaves over a floor, and below" \
        is_up y "more faces look that way than any other" leaves
    check "the other way" is_up z "more faces look that way than any other" leaves-z
    check "nothing" \
        is_up y "as in most files, for nothing in this one says otherwise" cube
    check "the program" is_up z "as in files of the program that made this one" cad
done
ranks=1
printf 'eye 9 5 7\nat 0 0 0\nup 0 0 1\n' >"$work/z.view"
printf 'eye 9 5 7\nat 0 0 0\n' >"$work/none.view"
printf 'eye 0 0 9\nat 0 0 0\nup 0 1 0\n' >"$work/plan.view"
check "a view" is_up z "$work/z.view" cube --view "$work/z.view"
check "nothing is said where it makes no difference" \
    is_up "" "" lamp --view "$work/z.view"
check "a plan" is_up z "more faces look that way than any other" city-z \
    --view "$work/plan.view" --sky 1
check "nor where it is given" is_up "" "" cube --up z
is_up "" "" cube --up z --view "$work/none.view"
cp "$work/cube.ppm" "$work/given.ppm"
is_up z "$work/z.view" cube --view "$work/z.view"
check "--up is that of a view without one" cmp "$work/given.ppm" "$work/cube.ppm"

# A square below a sky absorbs H (1 - rho), and none below the horizon.
for up in "1 1 x" "1 -1 -x" "2 1 y" "2 -1 -y" "3 1 z" "3 -1 -z"; do
    set -- $up
    { echo mtllib up.mtl; echo usemtl white; square $1 $2 0 1; } >"$work/level.obj"
    for given in x -x y -y z -z; do
        is_up "" "" level --sky 1 --up=$given --final-gather 64 --stats "$work/up.json"
        absorbed=$(stat_of "$work/up.json" absorbed_power)
        case $given in
        "$3") check "--up $given: a level square receives all" \
            holds "$absorbed > 1.5 - 2e-3 && $absorbed < 1.5 + 2e-3" ;;
        "-$3" | "${3#-}") check "--up $given: one that looks down, nothing" \
            holds "$absorbed < 1e-3" ;;
        esac
    done
done
is_up "" "" city --up y --final-gather 16
cp "$work/city.ppm" "$work/one.ppm"
is_up "" "" city-z --up z --final-gather 16
check "a view is chosen as it stands" sh -c \
    'build/imgdiff "$0" "$1" --blocks 4 --tolerance .2 >"$2"' \
    "$work/one.ppm" "$work/city-z.ppm" "$work/out"

tap_done
