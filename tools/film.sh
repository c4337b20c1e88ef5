# make film: a solution that grows, frame by frame. Writes light-NN.png, mesh-NN.png and
# owner-NN.png to the folder $FILM and, where ImageMagick is installed, film.gif, in which
# the three are side by side.
#
# The method is the paper's, whose passes each refine the links and let light go on by one
# bounce. The first frames are the first pass, with roots divided at most 0, 1, ... times;
# then each frame is a pass more, up to the last. A frame is a run that ends early: it
# goes on from the checkpoint of the frame before, and three runs draw its own.
set -eu
: "${MPIEXEC:=mpiexec}" "${RANKS:=4}" "${FILM:=build/film}" "${SCENE:=scenes/cornell}"
: "${EPSILON:=1e-4}" "${LEVELS:=0 1 2 3 4 10}" "${SIZE:=200x200}" "${EXPOSURE:=0.8}"
checkpoint=$FILM/checkpoint
mkdir -p "$FILM"
rm -f "$FILM"/*-[0-9][0-9].png "$FILM/film.gif"

run() {
    $MPIEXEC -n "$RANKS" ./phr "$SCENE.obj" --quiet --paper --epsilon "$EPSILON" \
        --tolerance 1e-3 --max-level "$level" --max-iterations "$pass" "$@"
}

# frame OPTIONS...: the pictures of a run with these.
frame() {
    run "$@" --checkpoint "$checkpoint" --stats "$FILM/stats.json"
    frames=$((frames + 1))
    for show in light mesh owner; do
        exposure="--exposure $EXPOSURE"
        [ $show != owner ] || exposure=
        run --resume "$checkpoint" --view "$SCENE.view" --size "$SIZE" $exposure \
            --show $show -o "$FILM/$show-$(printf %02d $frames).png"
    done
}

frames=0
pass=1
for level in $LEVELS; do
    frame
done
until grep -q '"converged": true' "$FILM/stats.json"; do
    pass=$((pass + 1))
    frame --resume "$checkpoint"
done
echo "$frames frames, $pass passes: $FILM/light-01.png and so on"

magick=$(command -v magick || command -v convert) || exit 0
for light in "$FILM"/light-*.png; do
    number=${light##*-}
    $magick "$light" "$FILM/mesh-$number" "$FILM/owner-$number" +append +repage \
        "$FILM/frame-$number"
done
$magick -delay 60 "$FILM"/frame-*.png -delay 300 "$FILM/frame-$number" -loop 0 \
    -layers optimize "$FILM/film.gif"
echo "$FILM/film.gif, $(wc -c <"$FILM/film.gif") bytes"
