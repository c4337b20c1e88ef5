# make growth: rooms of 6,348 to a million triangles, from reading to a picture, on two
# ranks, at epsilon 1e-3, and the smaller four at 1e-4. Writes docs/growth.csv,
# docs/growth.svg, and in docs/scaling.md the table and by which power of the triangles
# links and work grow. Memory is the sum of the ranks' peaks; shared memory counts for
# each. Seconds are of the clock: the machine should have two idle cores.
# Knobs: SIZES and FINE_SIZES, of rooms, as the generator is asked for; CSV, FIGURE and
# OUT, the files.
set -eu
: "${BUILD:=build/mpi}" "${MPIEXEC:=mpiexec}" "${OUT:=docs/scaling.md}"
: "${CSV:=docs/growth.csv}" "${FIGURE:=docs/growth.svg}"
: "${SIZES:=6350 18510 31933 100000 300000 1000000}" \
    "${FINE_SIZES:=6350 18510 31933 100000}"
. tests/bench/renew.sh
work=$BUILD/growth
mkdir -p "$work"
cp scenes/room.mtl "$work"

# number_of FILE KEY: the first number that a JSON key has.
number_of() { grep -o "\"$2\": *[0-9.e+-]*" "$1" | head -n 1 | sed 's/.*: *//'; }

# most_of FILE PHASE: the seconds of the slowest rank.
most_of() { sed -n "s/.*\"$2\": {.*\"max\": \([0-9.e+-]*\)}.*/\1/p" "$1"; }

# all_of FILE KIND: the work of all ranks.
all_of() { sed -n "s/.*\"$2\": {\"phases\": [0-9]*, \"all\": \([0-9]*\).*/\1/p" "$1"; }

# grow SIZE EPSILON: one run and its line.
grow() {
    epsilon=$2 json=$work/$1-$2.json
    $MPIEXEC -n 2 ./phr "$work/room$1.obj" --epsilon "$2" --quiet -o "$work/room.ppm" \
        --stats "$json"
    tests=$(($(number_of "$json" node_tests) + $(number_of "$json" triangle_tests)))
    echo "room,$epsilon,$(number_of "$json" triangles),$(number_of "$json" patches)," \
        "$(number_of "$json" links),$(number_of "$json" rays),$tests," \
        "$(all_of "$json" splitting)," \
        "$(number_of "$json" peak_rss_bytes_sum),$(most_of "$json" tree)," \
        "$(most_of "$json" refinement),$(most_of "$json" total)" |
        tr -d ' ' | tee -a "$CSV"
}

echo "scene,epsilon,triangles,patches,links,rays,tests,work,bytes,tree,refinement,total" \
    >"$CSV"
for size in $SIZES; do
    build/room "$size" 1 >"$work/room$size.obj"
    grow "$size" 1e-3
done
for size in $FINE_SIZES; do
    grow "$size" 1e-4
done
{
    # From the smallest to the largest room: log (y / y0) / log (k / k0).
    awk -F, 'NR > 1 {
        if (!($2 in k0)) { k0[$2] = $3; links0[$2] = $5; work0[$2] = $8; order[++n] = $2 }
        k[$2] = $3; links[$2] = $5; work[$2] = $8
    } END {
        for (i = 1; i <= n; i++) {
            e = order[i]
            if (k[e] == k0[e]) continue
            span = log(k[e] / k0[e])
            printf "\nAt epsilon %s, from %d to %d triangles k, links grow as k^%.2f,\n",
                   e, k0[e], k[e], log(links[e] / links0[e]) / span
            printf "the work of refinement as k^%.2f.\n", log(work[e] / work0[e]) / span
        }
    }' "$CSV"
    echo
    echo "| epsilon | triangles | links | rays | memory | tree but for its rays |" \
        "refinement | all |"
    echo "|---|---|---|---|---|---|---|---|"
    awk -F, 'NR > 1 {
        printf "| %s | %d | %d | %.3g M | %.2g GB | %.2g s | %.2g s | %.3g s |\n", $2, $3,
               $5, $6 / 1e6, $9 / 1e9, $10, $11, $12
    }' "$CSV"
    echo
} >"$work/made"
renew "$OUT" "![Links against triangles]" "## Balance" <"$work/made"
awk -F, 'NR > 1 { print "epsilon_" $2, $3, $5 }' "$CSV" |
    awk -v title="Links of rooms" -v xlabel=triangles -v ylabel=links -v logx=1 \
        -v logy=1 -f docs/course/chart.awk >"$FIGURE"
