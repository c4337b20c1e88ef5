#!/bin/sh
# Draws the figures of the course: docs/course/*.svg. Called by `make course`.
set -eu
cd "$(dirname "$0")/../.."
here=docs/course
work=build/course

# chart NAME TITLE XLABEL YLABEL [OPTIONS OF AWK]: of lines "series x y".
chart() {
    name=$1 title=$2 xlabel=$3 ylabel=$4
    shift 4
    awk -v title="$title" -v xlabel="$xlabel" -v ylabel="$ylabel" "$@" -f $here/chart.awk \
        >$here/$name.svg
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
    chart factors "Unit squares that face each other" "distance h [m]" "error of F" -v logx=1
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
