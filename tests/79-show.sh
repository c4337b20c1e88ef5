# Pictures of the algorithm: --show, and the timeline of tools/timeline.awk.
. tests/tap.sh

# show RANKS WHAT OPTIONS...: $work/RANKS.WHAT.ppm, and its messages
show() {
    ranks=$1 what=$2
    shift 2
    $MPIEXEC -n "$ranks" "$PHR" scenes/cornell.obj --view scenes/cornell.view \
        --epsilon 1e-3 --size 64x64 --samples 1 --final-gather 16 --show "$what" "$@" \
        -o "$work/$ranks.${what%%:*}.ppm" >/dev/null 2>"$work/err"
}

# colours FILE: the number of different ones
colours() {
    tail -c $((3 * 64 * 64)) "$1" | od -An -v -tu1 -w3 | sort -u | wc -l
}

for what in light mesh level error links:30,40; do
    name=${what%%:*}
    show 1 "$what"
    show 4 "$what"
    check "$name: the same picture on 4 ranks" \
        cmp "$work/1.$name.ppm" "$work/4.$name.ppm"
    [ "$name" = light ] ||
        check "and not that of the light" [ "$(cmp -l "$work/1.light.ppm" \
            "$work/1.$name.ppm" | wc -l)" -gt 500 ]
done

# Undivided roots: for each rank a colour and its outlines, and the black background.
for ranks in 1 4; do
    show $ranks owner --max-level 0 --final-gather 0
    check "owners: $ranks colours on $ranks ranks" \
        [ "$(colours "$work/$ranks.owner.ppm")" -eq $((2 * ranks + 1)) ]
done
show 1 level --max-level 0 --final-gather 0
check "levels: one colour where nothing is divided" \
    [ "$(colours "$work/1.level.ppm")" -eq 3 ]
check "levels come with a legend" \
    grep -q '^phr: legend: blue is level 0, green 4, yellow 6, red 8' "$work/err"
show 1 error
check "errors, too: with their scale" grep -q \
    '^phr: legend: black is an error of 0, red .*, yellow .*, white .* W/m^2 or more' \
    "$work/err"

show 2 links:2/1 --paper --final-gather 0
said=$(sed -n 's/.*patch 2\/1: \([0-9]*\) links.*/\1/p' "$work/err")
"$PHR" scenes/cornell.obj --quiet --paper --epsilon 1e-3 --dump links >"$work/links"
check "links of a patch and of those above it: all ($said)" [ "$said" -gt 10 -a \
    "$said" = "$(grep -cE '^(2/1?|[^ ]* 2/1?) ' "$work/links")" ]

# The links of a finished run that is resumed, which has transferred no light.
for way in --checkpoint --resume; do
    show 1 links:0/ --final-gather 0 "$way" "$work/check"
    mv "$work/1.links.ppm" "$work/links$way.ppm"
done
check "links: the same picture from a checkpoint" \
    cmp "$work/links--checkpoint.ppm" "$work/links--resume.ppm"

# refused WHAT REASON OPTIONS...: refused before there is light.
refused() {
    what=$1 reason=$2
    shift 2
    show 2 "$what" "$@"
    [ $? -eq 2 ] && grep -q "$reason" "$work/err" && ! grep -q linking "$work/err"
}
check "no such patch" refused links:12/33333 'there is no such patch' --max-level 4
check "no such root" refused links:99/ 'there is no such patch'
check "no patch and no pixel" refused links:5 'neither a patch, .*, nor a pixel'
check "no such pixel" refused links:64,0 'there is no such pixel in 64x64'
check "no patch named" refused links 'of which patch'
check "no error without a final gather" refused error 'no error without' --final-gather 0
check "no such picture" refused leaves 'is not one of light|radiosity'
show 2 links:12/33333
check "a patch that is not divided so often is known to be missing later" \
    grep -q 'there is no such patch' "$work/err"

# The timeline: as much work as the slowest ranks of all levels do one after another.
$MPIEXEC -n 3 "$PHR" scenes/cornell.obj --quiet --paper --epsilon 1e-3 \
    --stats "$work/run.json"
awk -f tools/timeline.awk "$work/run.json" >"$work/run.svg"
sum=$(sed -n 's/.*"pass": [1-9].*"work_max": \([0-9]*\).*/\1/p' "$work/run.json" |
    awk '{ sum += $1 } END { print sum }')
check "the timeline is as long as the levels' most work ($sum)" \
    grep -q ">run: $sum tests" "$work/run.svg"
check "and has a row for each of 3 ranks" \
    [ "$(grep -c 'text-anchor="end">[0-2]<' "$work/run.svg")" -eq 3 ]
echo >"$work/none.json"
awk -f tools/timeline.awk "$work/none.json" >"$work/none.svg" 2>"$work/err"
check "a file without levels is refused" grep -q 'no levels' "$work/err"

# The film: frames of two levels of the first pass, then pass by pass to the end.
film=$work/film
FILM=$film RANKS=2 SCENE=scenes/squares EPSILON=1e-2 EXPOSURE=0.008 \
    LEVELS="0 10" SIZE=16x16 sh tools/film.sh >"$work/film.out"
last=$(sed -n 's/ frames.*//p' "$work/film.out")
"$PHR" scenes/squares.obj --quiet --paper --epsilon 1e-2 --tolerance 1e-3 \
    --view scenes/squares.view --size 16x16 --exposure 0.008 -o "$work/whole.png" \
    --stats "$work/whole.json"
passes=$(stat_of "$work/whole.json" iterations)
check "the film has a frame for each level and pass ($last)" \
    [ "$last" -eq $((passes + 1)) -a "$(ls "$film"/owner-*.png | wc -l)" -eq "$last" ]
check "it ends with the picture of a run that was never interrupted" \
    cmp "$film/light-0$last.png" "$work/whole.png"
check "and no two frames are alike" [ "$last" -eq \
    "$(for light in "$film"/light-*.png; do cksum <"$light"; done | sort -u | wc -l)" ]
if [ -e "$film/film.gif" ]; then # bytes 6 and 7 are the width
    check "the animation has light, mesh and owners side by side" \
        [ "$(od -An -tu1 -j6 -N2 "$film/film.gif" | tr -d ' ')" = 480 ]
else
    tap 0 "the animation # SKIP there is no ImageMagick"
fi
tap_done
