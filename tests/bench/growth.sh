# make growth: rooms of 1,000 to 32,000 triangles, from reading to a picture, on two ranks. Writes
# docs/growth.csv and, with gnuplot, docs/growth.svg: links and seconds against the number of triangles. About a minute on two cores.
set -eu
: "${BUILD:=build/mpi}" "${MPIEXEC:=mpiexec}"
epsilon=1e-4
work=$BUILD/growth
mkdir -p "$work"
cp scenes/room.mtl "$work"

# stat_of FILE KEY: the first number that JSON key has.
stat_of() { grep -o "\"$2\": *[0-9.e+-]*" "$1" | head -n 1 | sed 's/.*: *//'; }

# most_of FILE PHASE: the seconds of the slowest rank.
most_of() { sed -n "s/.*\"$2\": {\"min\": [^,]*, \"mean\": [^,]*, \"max\": \([0-9.e+-]*\)}.*/\1/p" "$1"; }

echo "triangles,pairs,links,linking_seconds,seconds,peak_rss_megabytes" >docs/growth.csv
for size in 1000 2000 4000 6350 12000 18510 31933; do
    room=$work/room$size
    build/room $size 1 >"$room.obj"
    $MPIEXEC -n 2 ./phr "$room.obj" --epsilon $epsilon --quiet -o "$room.ppm" --stats "$room.json"
    count=$(stat_of "$room.json" triangles)
    printf '%s,%s,%s,%s,%s,%s\n' "$count" $((count * (count - 1) / 2)) \
        "$(stat_of "$room.json" links)" "$(most_of "$room.json" linking)" "$(most_of "$room.json" total)" \
        $(($(stat_of "$room.json" peak_rss_bytes) / 1000000)) | tee -a docs/growth.csv
done
if command -v gnuplot >/dev/null; then
    gnuplot tests/bench/growth.gp
else
    echo "there is no gnuplot: no picture" >&2
fi
