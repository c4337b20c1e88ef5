# make growth: rooms of 6,348 to a million triangles, from reading to a picture, on two
# ranks, at epsilon 1e-3, and the smaller four at 1e-4. Writes docs/growth.csv and, with
# gnuplot, docs/growth.svg; prints by which power of the triangles links and work grow.
# Sizes are those that the generator is asked for. Memory is the sum of the ranks' peaks;
# shared memory counts for each.
set -eu
: "${BUILD:=build/mpi}" "${MPIEXEC:=mpiexec}"
: "${SIZES:=6350 18510 31933 100000 300000 1000000}" \
    "${FINE_SIZES:=6350 18510 31933 100000}"
work=$BUILD/growth
mkdir -p "$work"
cp scenes/room.mtl "$work"

# number_of FILE KEY: the first number that a JSON key has.
number_of() { grep -o "\"$2\": *[0-9.e+-]*" "$1" | head -n 1 | sed 's/.*: *//'; }

# most_of FILE PHASE: the seconds of the slowest rank.
most_of() { sed -n "s/.*\"$2\": {.*\"max\": \([0-9.e+-]*\)}.*/\1/p" "$1"; }

# all_of FILE KIND: the work of all ranks; first levels, which all ranks split alike,
# count once.
all_of() { sed -n "s/.*\"$2\": {\"phases\": [0-9]*, \"all\": \([0-9]*\).*/\1/p" "$1"; }

# grow SIZE EPSILON: one run and its line.
grow() {
    epsilon=$2 json=$work/$1-$2.json
    $MPIEXEC -n 2 ./phr "$work/room$1.obj" --epsilon "$2" --quiet -o "$work/room.ppm" \
        --stats "$json"
    first=$(($(all_of "$json" linking) / 2))
    tests=$(($(number_of "$json" node_tests) + $(number_of "$json" triangle_tests)))
    echo "room,$epsilon,$(number_of "$json" triangles),$(number_of "$json" patches)," \
        "$(number_of "$json" links),$(number_of "$json" rays),$tests," \
        "$((first + $(all_of "$json" splitting)))," \
        "$(number_of "$json" peak_rss_bytes_sum),$(most_of "$json" tree)," \
        "$(most_of "$json" refinement),$(most_of "$json" total)" |
        tr -d ' ' | tee -a docs/growth.csv
}

echo "scene,epsilon,triangles,patches,links,rays,tests,work,bytes,tree,refinement,total" \
    >docs/growth.csv
for size in $SIZES; do
    build/room "$size" 1 >"$work/room$size.obj"
    grow "$size" 1e-3
done
for size in $FINE_SIZES; do
    grow "$size" 1e-4
done
# From the smallest to the largest room: log (y / y0) / log (k / k0).
awk -F, '$1 == "room" {
    if (!($2 in k0)) { k0[$2] = $3; links0[$2] = $5; work0[$2] = $8 }
    k[$2] = $3; links[$2] = $5; work[$2] = $8
} END {
    for (e in k) if (k[e] > k0[e]) {
        span = log(k[e] / k0[e])
        printf "epsilon %s, %d to %d triangles: ", e, k0[e], k[e]
        printf "links grow as k^%.2f, refinement work as k^%.2f\n",
               log(links[e] / links0[e]) / span, log(work[e] / work0[e]) / span
    }
}' docs/growth.csv
if command -v gnuplot >/dev/null; then
    gnuplot tests/bench/growth.gp
else
    echo "there is no gnuplot: no picture" >&2
fi
