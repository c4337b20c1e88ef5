# Pictures of the path tracer beside phr's: `. tests/traced.sh`, with $folder.
#
# The noise of a traced picture is told by that of a quarter of the samples, which are the
# first of the others: as the mean of N is that of N/4 and of 3N/4 more, both differ by
# sqrt(3) times the deviation of the whole.

: "${PATHTRACER:=build/pathtracer}" "${IMGDIFF:=build/imgdiff}" "${RANKS:=2}" \
    "${EXPOSURE:=0.8}"

# trace NAME SCENE SAMPLES OPTIONS...: $traced.pfm and .ppm by $folder/NAME.view, if they
# are not there.
trace() {
    traced=$folder/$1-$3 by=$folder/$1.view of=$2 paths=$3
    shift 3
    [ -e "$traced.pfm" ] || $MPIEXEC -n "$RANKS" "$PATHTRACER" "$of" --quiet \
        --view "$by" --samples "$paths" --exposure "$EXPOSURE" "$@" \
        -o "$traced.pfm" -o "$traced.ppm"
}

# differ SIDE LAMP A B: the RMS and the largest difference of blocks of so many pixels
# along a side, in percent; without those in which a sample of B is above LAMP.
differ() {
    "$IMGDIFF" --blocks "$1" --below "$2" "$3" "$4" |
        awk '$1 == "relative" { print 100 * $4, 100 * $2 }'
}
