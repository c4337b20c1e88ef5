#!/bin/sh
# Draws the figures of the course: docs/course/*.svg and *.png. Called by `make course`.
set -eu
cd "$(dirname "$0")/../.."
here=docs/course
work=build/course

# chart NAME TITLE XLABEL YLABEL [OPTIONS OF AWK]: of lines "series x y".
chart() {
    name=$1 title=$2 xlabel=$3 ylabel=$4
    shift 4
    awk -v title="$title" -v xlabel="$xlabel" -v ylabel="$ylabel" "$@" \
        -f $here/chart.awk >$here/$name.svg
}

# patches NAME OPTIONS OF AWK: of lines as leaves prints them.
patches() {
    name=$1
    shift
    awk "$@" -f $here/patches.awk >$here/$name.svg
}

$work/bounces | awk '$1 ~ /^[0-9]+$/ {
        print "lamp", $1, 101.0101 - $2
        if ($1 < 6) print "floor", $1, 10.1010 - $3 }' |
    awk '$3 > 2e-4' |
    chart light "Light that is still missing" bounce "W/m^2" -v logy=1
$work/factors | awk '/right/ { exit }
        $1 > 0 { print "one_disk", $1, $3 / $2 - 1; print "16_disks", $1, $6 / $2 - 1
                 print "a_point", $1, $9 / $2 - 1 }' |
    chart factors "Unit squares that face each other" "distance h [m]" "error of F" \
        -v logx=1
$work/radiosity scenes/box.obj 0.3 $work/box.txt >/dev/null
patches box -v from="3 -4 2.6" -v white=60 <$work/box.txt

awk 'NR > 1 { print "brute_force", $1, $1; print "phr", $1, $5 }' $work/visibility.txt |
    chart visibility "Tests for each segment" triangles tests -v logx=1 -v logy=1
./phr --quiet --paper --epsilon 2e-3 scenes/squares.obj -o $work/names.ply
$work/leaves $work/names.ply | grep '^[01]/' |
    patches quadtree -v from="0 0 1" -v names=1
for epsilon in 1e-2 1e-3; do
    ./phr --quiet --paper --epsilon $epsilon scenes/box.obj -o $work/mesh.ply
    $work/leaves $work/mesh.ply >$work/mesh-$epsilon
done
patches mesh-coarse -v from="3 -4 2.6" -v white=60 <$work/mesh-1e-2
patches mesh-fine -v from="3 -4 2.6" -v white=60 <$work/mesh-1e-3
# Corners of the patches of pushpull.c, from their paths.
$work/pushpull | awk '
    function half(i, j) { return (i + j) / 2 }
    $3 ~ /[0-9]/ && $1 != "patch" {
        path = substr($1, 3)
        ax = ay = by = cx = 0
        bx = cy = 1
        for (s = 1; s <= length(path); s++) {
            px = half(ax, bx); py = half(ay, by); qx = half(bx, cx); qy = half(by, cy)
            rx = half(cx, ax); ry = half(cy, ay)
            k = substr(path, s, 1)
            if (k == 0) { bx = px; by = py; cx = rx; cy = ry }
            if (k == 1) { ax = px; ay = py; cx = qx; cy = qy }
            if (k == 2) { ax = rx; ay = ry; bx = qx; by = qy }
            if (k == 3) { ax = qx; ay = qy; bx = rx; by = ry; cx = px; cy = py }
        }
        print $4, 0, ax, ay, 0, bx, by, 0, cx, cy, 0
    }' | patches push-pull -v from="0 0 1" -v names=1
for balance in none greedy default; do
    awk -v name=$balance '/"level": .*"work_mean"/ {
        gsub(/[",:{}]/, " ")
        for (i = 1; i < NF; i++)
            value[$i] = $(i + 1)
        if (value["pass"] > 0 && value["work_mean"] >= 50)
            print name, ++n, value["work_max"] / value["work_mean"] }' \
        $work/$balance-8.json
done | chart balance "Most work of a rank of 8, in means" \
    "level (of more than 50 tests a rank)" "work / mean"
awk -f tools/timeline.awk $work/none-4.json $work/greedy-4.json >$here/timeline.svg
cp $work/links.png $here
${MPIEXEC:-mpiexec} -n 4 ./phr --quiet --paper --epsilon 1e-3 scenes/doorway.obj \
    --show owner --view scenes/doorway.view --size 400x300 --samples 1 -o $here/owner.png
$work/leaves $work/by-factor-0.1.ply |
    patches mesh-factor -v from="3 -4 2.6" -v white=60
awk 'NR > 1 { print $1, $3, $4 / 100 }' $work/errors.txt |
    chart errors "Two rooms and a doorway" links "RMS error of objects" \
        -v logx=1 -v logy=1

# row NAME TITLE FILE COLUMNS: columns of a table of rows.c.
row() {
    awk -v columns="$4" 'BEGIN { count = split(columns, column, " ") }
        NR == 1 { for (i = 1; i <= count; i++) name[i] = $(column[i]); next }
        { for (i = 1; i <= count; i++) print name[i], $1, $(column[i]) }' $work/"$3" |
        chart "$1" "$2" "n" "error of H [%]" -v logx=1 -v logy=1
}
row row-rays "The box: n rays" rows-box.txt "2 3"
row row-segments "A door ajar: n rays, and n segments" rows-ajar.txt "2 4 5 6"
row row-exact "The lamp in the ceiling: n rays, and n segments" rows-open.txt "2 3 6 7"
