# make stability: what breaks radiosity programs, a line each: docs/stability.md.
#
# Scenes are those of the panel (tests/panel/scenes.sh), and most of them lines of it with
# their exact numbers, written to $BUILD/stability and solved with --paper and by default;
# tests/panel/judge.c tells how far a mean, the worst or the brightest leaf is off. Half a
# minute on two cores.
# Knobs: PHR, the program; OUT, the file.
set -eu
: "${BUILD:=build/mpi}" "${PHR:=./phr}" "${OUT:=docs/stability.md}"
. tests/bench/renew.sh
. tests/panel/scenes.sh
export LC_ALL=C
work=$BUILD/stability
mkdir -p "$work"
awk -f tests/panel/lines.awk docs/oracle/cases.csv tests/panel/table >"$work/lines"

# solved OPTIONS...: of $file; prints a word, and fails, if there is no solution.
solved() {
    rm -f "$work/solution.ply"
    (ulimit -t 15 && exec $PHR "$@" "$file.obj" --quiet -o "$work/solution.ply") \
        >"$work/log" 2>&1 && return
    if grep -q diverge "$work/log"; then
        echo diverges
    elif grep -q "not converge\|memory\|absorbed" "$work/log"; then
        echo fails
    else
        echo "no end"
    fi
    return 1
}

# row FAILURE TEXT OPTIONS TRUTH NAME [WORD...]: of a scene of these words, or that of a
# line of the panel, and so is a TRUTH of -. `=` tells of the worst leaf.
row() {
    head="| $1 | \`$5\`: $2${3:+, \`$3\`} |" options=$3 truth=$4 file=$work/$5 name=$5
    shift 5
    line=$(grep "^[* ]$name *|" "$work/lines" || true)
    [ $# -gt 0 ] || set -- $(echo "$line" | cut -d '|' -f 2)
    [ "$truth" != - ] || truth=$(echo "$line" | cut -d '|' -f 4 | awk '{ print $1 }')
    if [ -f "scenes/$1.obj" ]; then file=scenes/$1; else make_scene "$file" 0 "$@"; fi
    exact=${truth##*[=~^]} column=2
    case $truth in *=*) column=4 ;; esac
    printf '%s %.6g |' "$head" "$exact"
    for method in --paper ""; do
        word=$(solved $method $options) && word=$("$BUILD/judge" "$file.obj" \
            "$work/solution.ply" "$truth" | awk -v column=$column -v exact="$exact" '{
                format = $column ^ 2 > 100 ? "%.0f %%" : "%.2g %%"
                if (exact == 0) format = "%.2g"
                printf format, exact == 0 ? $column / 100 : $column }')
        printf ' %s |' "$word"
    done
    echo
}

# --- the page ---

coarse="--epsilon 1e-2"

rows() {
    row "F above 1" "a unit square .1 below one of 3 x 3" "" - above-wide
    row "near patches" "two unit squares, .1 apart" "" - above-near
    row "far patches" "two unit squares, 100 apart" "" - above-far
    row "singular shared edge" "two unit squares at a right angle" "" - right-angle
    row "gap of 2 mm" "light of a lamp of 1 m, 2 mm above a floor, that gets out" "" - \
        around
    row "gap of 2 mm" "the same" "--epsilon 1e-7" - around
    for epsilon in 1e-2 1e-3 1e-4; do
        row "drift of row sums" "furnace, three blocks, rho 0.5, worst leaf" \
            "--epsilon $epsilon" all=2 furnished furnished .5 1
    done
    for rho in 0.9 0.99 0.999; do
        row "little is absorbed" "furnace, rho $rho, worst leaf" "$coarse" \
            "all=$(of "1 / (1 - $rho)")" "furnace$rho" closed 1 $rho 1
    done
    row "corridor 1:100" "furnace, rho 0.999, worst leaf" "$coarse" all=1000 long \
        closed 100 .999 1
    row "sharp edge" "furnace, a wedge of 10 degrees, rho 0.9, worst leaf" "$coarse" \
        all=10 wedge wedge .174977 .9 1
    row "slivers" "furnace, rho 0.99, slivers to 1 : 1e6 in it, worst leaf" "$coarse" - \
        slivers
    row "T-junctions" "furnace, rho 0.9, floor of four rectangles, worst leaf" \
        "$coarse" - junctions
    row "false convergence" "rho 0.99, lamp at one end, mean" "$coarse" \
        "*~$(of "1 / .42")" lit lit_end
    for rho in 0.3 0.6; do
        row "faces twice" "furnace, rho $rho, worst leaf" "$coarse" \
            "all=$(of "1 / (1 - $rho)")" twice$rho twice $rho 1
    done
    row "coplanar lamp" "flush with a ceiling, rho 0.5, mean of the walls" "" - \
        flush-lamp
    row "covered patches" "furnace, rho 0.9, a block on the floor, brightest leaf" \
        "$coarse" - standing
    row "faces through faces" \
        "furnace, rho 0.9, a block through it and the floor, brightest leaf" "$coarse" - \
        through
    row "light leaks" "dark rooms that share walls with a lit one, brightest leaf" "" \
        dark^0 three-rooms
    row "light leaks" "a block behind a wall of 1 mm, brightest leaf" "" - thin-wall
    row "partial visibility" "a floor lit through a slit, mean" "" - slit-screen
    row "partial visibility" "through a pinhole" "" - pinhole
    far=$(awk -F, '$1 == "doorway" && $2 == "walls-far" { print $3 }' scenes/answers.csv)
    row "partial visibility" "two rooms and a doorway, walls of the far one" "" \
        "walls-far~$far" doorway
    row "tiny bright lamp" "1e-4 of the floor below it, mean of that" "" \
        floor~.277063 tiny-lamp
    row "15 levels" "a lamp of 4e-5, 1e-5 above the floor, mean of that" \
        "--max-level 15 --min-area 0" - low-lamp
    row "rho above 1" "rho 1.5, which is set to 0.999 with a warning, worst leaf" \
        "$coarse" all=1000 mirror closed 1 1.5 1
}

{ echo "|---|---|---|---|---|"; rows; } >"$work/made"
[ -f "$OUT" ] || cp docs/stability.md "$OUT"
renew "$OUT" "| failure |" <"$work/made"
cat "$OUT"
