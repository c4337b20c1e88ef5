#!/bin/sh
# How phr scales: the paper's Tables 1 and 2 from counted work and from seconds (on stderr),
# docs/scaling.csv and, where gnuplot is installed, docs/scaling.svg.
#
#   make scaling                                        the paper's three rooms, about eight minutes
#   CSV=build/x.csv sh tests/bench/scaling.sh scenes/cornell.obj      one scene, nothing drawn
#
# Each scene is really run on RANKS ranks, and replayed on up to 4,096 (tests/bench/simulate.c). Counts do
# not depend on how many processors there are; measured seconds do, and only mean something up to that.
#
# Columns: scene; counted or simulated; ranks; modelled seconds; speed-up from counted work; idle part of it;
# speed-up with copies of patches and links too; with messages too (2 us each, 10 GB/s); MB of links
# that moved; speed-up on the paper's Ethernet (100 us, 100 Mbit/s); measured seconds.

cd "$(dirname "$0")/../.." || exit 2
: "${BUILD:=build/mpi}" "${MPIEXEC:=mpiexec}" "${CSV:=docs/scaling.csv}" "${EPSILON:=1e-4}"
: "${RANKS:=1 2 4 8 16 32}" "${PHR:=./phr}"
export LC_ALL=C
folder=$BUILD/scaling
mkdir -p "$folder"

if [ $# -eq 0 ]; then
    cp scenes/room.mtl "$folder" || exit 1
    for triangles in 6350 18510 31933; do
        build/room $triangles 1 >"$folder/room$triangles.obj" || exit 1
        set -- "$@" "$folder/room$triangles.obj"
    done
fi

{
    echo "scene,mode,ranks,seconds_modelled,speedup_work,idle,speedup_copies,speedup_all,migration_mb,speedup_ethernet,seconds_measured"
    for scene in "$@"; do
        name=$(basename "$scene" .obj)
        files=
        for ranks in $RANKS; do
            $MPIEXEC -n "$ranks" "$PHR" "$scene" --epsilon "$EPSILON" --quiet \
                --stats "$folder/$name-$ranks.json" || exit 1
            files="$files $folder/$name-$ranks.json"
        done
        "$BUILD/simulate" "$scene" --epsilon "$EPSILON" >"$folder/$name.lines" 2>"$folder/$name.replay" || exit 1
        # Unquoted: one word for each file.
        awk -v name="$name" -v replay="$folder/$name.replay" -f tests/bench/scaling.awk $files || exit 1
        sed "s|^[^,]*,|$name,|; s|\$|,|" "$folder/$name.lines"
        cat "$folder/$name.replay" >&2
    done
} >"$folder/scaling.csv" || exit 1
mv "$folder/scaling.csv" "$CSV"
[ "$CSV" = docs/scaling.csv ] || exit 0
if command -v gnuplot >/dev/null; then
    gnuplot tests/bench/scaling.gp && echo "docs/scaling.svg is drawn"
else
    echo "docs/scaling.csv is written; install gnuplot to draw it"
fi
