# `make cycles`: pictures of phr beside those of Cycles, the path tracer of Blender 3.4
# (Debian's package blender): the Cornell box and a furnished room of 1,506 triangles,
# 256 x 256. phr's are compared with the average of two by Cycles, of other seeds: the
# mean of each band, and the means of 8 x 8 pixels, both without blocks in which phr shows
# a lamp (a sample above LAMP), RMS relative to that of the rest. Half the RMS between the
# two is the noise of their average.
#
# With SAMPLES=128 a picture of Cycles takes one or two minutes on two cores. They stay in
# $BUILD/cycles. In the room the noise is then 1.3 %.
. tests/tap.sh

: "${SAMPLES:=256}" "${SIZE:=256}" "${LAMP:=2}" "${LENGTH:=1}"
export LENGTH
folder=$BUILD/cycles
mkdir -p "$folder"
cp scenes/room.mtl "$folder"
build/room 1500 1 >"$folder/room1500.obj"
printf 'eye 2.4 0.37 1.8\nat -0.57 7.79 0.2\nup 0 0 1\nfov 70\n' >"$folder/room1500.view"

# trace SCENE VIEW SEED: Cycles' picture, if it is not there.
trace() {
    traced=$folder/$name-$SIZE-$SAMPLES-$LENGTH-$3.pfm
    [ -e "$traced" ] || blender -b --factory-startup -P tests/cycles.py -- \
        "$1" "$2" "$SIZE" "$SAMPLES" "$3" "$traced" >"$work/log" 2>&1 ||
        cat "$work/log"
}

# picture NAME SCENE VIEW
picture() {
    name=$1
    $MPIEXEC -n 2 "$PHR" "$2" --quiet --view "$3" --size "${SIZE}x$SIZE" \
        -o "$work/$name.pfm"
    trace "$2" "$3" 1
    first=$traced
    trace "$2" "$3" 2
    python3 tests/cycles.py "$work/$name.pfm" "$first" "$traced" "$work/average.pfm" \
        "$LAMP" >"$work/means"
    sed 's/^/# /' "$work/means"
    noise=$(sed -n 's/noise //p' "$work/means")
    all=$(sed -n 's/all //p' "$work/means")
    rms=$("$IMGDIFF" --blocks 8 --below "$LAMP" "$work/average.pfm" "$work/$name.pfm" |
        awk '$1 == "relative" { print 100 * $4 }')
    check "$name: noise of Cycles $noise %" holds "$noise <= 1"
    check "mean $all %" holds "$all ^ 2 <= 0.5 ^ 2"
    check "RMS $rms %" holds "$rms <= 2.5"
}

picture cornell scenes/cornell.obj scenes/cornell.view
picture room1500 "$folder/room1500.obj" "$folder/room1500.view"
tap_done
