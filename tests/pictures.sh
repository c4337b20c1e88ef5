# `make prove`: pictures of phr beside those of the path tracer, the Cornell box and a
# furnished room of 1,506 triangles, 512 x 512. They are compared in the means of 8 x 8
# pixels, without blocks in which there is a lamp: RMS and worst block, relative to the
# RMS of the rest.
#
# Traced pictures are kept in $BUILD/prove. With SAMPLES=2048 they take about half an hour
# on two cores; the noise of a block, some 0.4 % in the room, falls like the root of that
# number. The pictures to be looked at, of the same exposure, are there too, as .ppm.
. tests/tap.sh
. tests/traced.sh

: "${SAMPLES:=2048}" "${LAMP:=10}"
folder=$BUILD/prove
mkdir -p "$folder"
cp scenes/room.mtl "$folder"
build/room 1500 1 >"$folder/room1500.obj"
cp scenes/cornell.view "$folder"
printf 'eye 2.4 0.37 1.8\nat -0.57 7.79 0.2\nup 0 0 1\nfov 70\n' >"$folder/room1500.view"

# picture NAME SCENE RMS WORST OPTIONS...: at most so many percent, both without the noise
# of the reference: blocks that are off most are so by its noise, too.
picture() {
    name=$1 scene=$2 rms=$3 worst=$4
    shift 4
    shown=$folder/$name$(printf '%s' "$*" | tr -d ' ')
    trace "$name" "$scene" $((SAMPLES / 4))
    first=$traced
    trace "$name" "$scene" "$SAMPLES"
    $MPIEXEC -n "$RANKS" "$PHR" "$scene" --quiet --view "$folder/$name.view" \
        --exposure "$EXPOSURE" "$@" -o "$shown.pfm" -o "$shown.ppm"
    set -- "$*" $(differ 8 "$LAMP" "$shown.pfm" "$traced.pfm") \
        $(differ 8 "$LAMP" "$first.pfm" "$traced.pfm")
    noise=$(awk "BEGIN { print $4 / sqrt(3) }")
    worst_noise=$(awk "BEGIN { print $5 / sqrt(3) }")
    check "$name, ${1:-defaults}: noise of the reference $noise %, worst $worst_noise %" \
        holds "2 * $noise^2 < $rms^2 && $worst_noise < $worst"
    check "RMS $2 %, worst block $3 % (at most $rms and $worst)" \
        holds "$2^2 - $noise^2 <= $rms^2 && $3^2 - $worst_noise^2 <= $worst^2"
}

picture cornell scenes/cornell.obj 2 8
picture room1500 "$folder/room1500.obj" 2 8
picture cornell scenes/cornell.obj 0.7 3 --final-gather 256,pixels
picture room1500 "$folder/room1500.obj" 0.7 3 --final-gather 256,pixels
tap_done
