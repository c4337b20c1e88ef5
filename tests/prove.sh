# `make prove`, the long sweeps: errors fall with every fourfold step of epsilon, over six
# steps, over links alone, and with a final gather whose rays double with each step, in
# the Cornell box and in rooms of 1,004 and 6,348 triangles. References are made first,
# where $BUILD/prove has none. And in closed rooms as much light arrives over links as
# leaves, within 1 %. And with half of the memory that it counts, phr takes 30 MB more at
# most, picture and MPI included. About an hour.
#
# A step counts as a fall where RMS and L1, of leaves and of roots, become smaller or are
# below the noise of the reference. Each epsilon is a quarter of the one before.
. tests/tap.sh

: "${ELEMENTS:=20000}" "${SAMPLES:=2000}"
folder=$BUILD/prove
mkdir -p "$folder"
cp scenes/room.mtl "$folder"

# sweep NAME WAY SCENE: one line for each step; WAY: links or gather.
sweep() {
    name=$1 way=$2 scene=$3
    before="" rays=16
    for epsilon in 4e-3 1e-3 2.5e-4 6.25e-5 1.5625e-5 3.90625e-6 9.765625e-7; do
        [ "$way" = gather ] || rays=0
        now=$("$BUILD/measure" "$scene" "$folder/$name.ref" --epsilon $epsilon \
            --final-gather $rays | awk -F, '{ print $10, $11, $20, $21, $16 }')
        if [ -z "$now" ]; then
            tap 1 "$name, $way, $epsilon: no measurement"
        elif [ -n "$before" ]; then
            check "$name, $way, $epsilon, $rays rays: $now" falls $before $now
        fi
        before=$now rays=$((2 * rays))
    done
}

# prove NAME SCENE
prove() {
    [ -e "$folder/$1.ref" ] ||
        "$BUILD/reference" "$2" "$folder/$1.ref" "$ELEMENTS" "$SAMPLES" >/dev/null
    sweep "$1" links "$2"
    sweep "$1" gather "$2"
}

# falls RMS L1 ROOT_RMS ROOT_L1 NOISE, twice: before and now.
falls() {
    awk "BEGIN { exit !(($6 < $1 || $6 < ${10}) && ($7 < $2 || $7 < ${10}) &&
                        ($8 < $3 || $8 < ${10}) && ($9 < $4 || $9 < ${10})) }"
}

# arrives SIZE EPSILON: light that arrives over links and light that leaves, in a room.
arrives() {
    "$PHR" "$folder/room$1.obj" --epsilon "$2" --final-gather 0 --quiet \
        --dump patches --stats "$work/stats" >"$work/patches"
    leaving=$(awk '$2 == 0 { sum += $4 * ($5 + $6 + $7) } END { print sum }' \
        "$work/patches")
    escaped=$(stat_of "$work/stats" escaped_power)
    check "room of $1, $2: of $leaving W that leave, $escaped W do not arrive" \
        holds "$leaving > 0 && 100 * $escaped < $leaving && 100 * $escaped > -$leaving"
}

# fits SCENE: the peak of a run over links that may count half of its memory.
fits() {
    "$PHR" "$1" --final-gather 0 --quiet --stats "$work/stats"
    half=$(($(stat_of "$work/stats" counted_bytes) / 2))
    "$PHR" "$1" --final-gather 0 --quiet --memory $half --size 512x512 \
        -o "$work/x.png" --stats "$work/stats" 2>"$work/log"
    peak=$(stat_of "$work/stats" peak_rss_bytes)
    check "$1: $peak bytes with a limit of $half" holds "$peak <= $half + 30e6"
}

for size in 1000 6350 18510 31933; do
    build/room $size 1 >"$folder/room$size.obj"
    [ $size -gt 20000 ] || arrives $size 1e-5
done
fits "$folder/room31933.obj"
prove cornell scenes/cornell.obj
prove room1000 "$folder/room1000.obj"
prove room6350 "$folder/room6350.obj"
tap_done
