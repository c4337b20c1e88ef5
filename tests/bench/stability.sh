# make stability: what breaks radiosity programs, a line each: docs/stability.md.
#
# Scenes are those of the panel (tests/panel/scenes.sh), written to $BUILD/stability and
# solved with --paper and by default; tests/panel/judge.c tells how far a mean, the worst
# or the brightest leaf is from the exact number. Exact numbers are closed forms, worked
# out here, or those of the path tracer in scenes/answers.csv. Half a minute on two cores.
# Knobs: PHR, the program; OUT, the file.
set -eu
: "${BUILD:=build/mpi}" "${PHR:=./phr}" "${OUT:=docs/stability.md}"
. tests/bench/renew.sh
. tests/panel/scenes.sh
export LC_ALL=C
work=$BUILD/stability
mkdir -p "$work"

# compute EXPRESSION: of awk, with
#   parallel(A0, A1, B0, B1, C0, C1, D0, D1, Z)   area times form factor of the level
#       rectangle A0..A1 x B0..B1 to C0..C1 x D0..D1, Z above it
#   over(A0, A1, Z)   that of a unit square to the square A0 .. A1 Z above it
#   middle(A, B, Z)   that of one of A x B over the middle of a unit square
#   edge()   form factor of two unit squares with a common edge, at a right angle
compute() {
    awk 'function piece(x, y, z,   u, v) {
            u = sqrt(x * x + z * z); v = sqrt(y * y + z * z)
            return y * u * atan2(y, u) + x * v * atan2(x, v) \
                   - z * z / 2 * log(x * x + y * y + z * z)
        }
        function parallel(a0, a1, b0, b1, c0, c1, d0, d1, z,   i, j, k, l, x, y, sum) {
            for (i = 0; i < 2; i++) for (j = 0; j < 2; j++)
            for (k = 0; k < 2; k++) for (l = 0; l < 2; l++) {
                x = (i ? a1 : a0) - (j ? c1 : c0)
                y = (k ? b1 : b0) - (l ? d1 : d0)
                sum += ((i + j + k + l) % 2 ? -1 : 1) * piece(x, y, z)
            }
            return sum / (2 * pi)
        }
        function over(a0, a1, z) { return parallel(0, 1, 0, 1, a0, a1, a0, a1, z) }
        function middle(a, b, z) {
            return parallel(-a / 2, a / 2, -b / 2, b / 2, -0.5, 0.5, -0.5, 0.5, z)
        }
        function edge() {
            return (pi / 2 - sqrt(2) * atan2(1, sqrt(2)) + log(3 / 4) / 4) / pi
        }
        BEGIN { pi = atan2(0, -1); printf "%.9g\n", '"$1"' }'
}

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

# row FAILURE TEXT EXACT TRUTH [OPTIONS]: of $file. TRUTH is one of judge.c, B the
# exact number, and `=` tells of the worst leaf.
row() {
    printf '| %s | `%s`: %s%s | %.6g |' "$1" "${file##*/}" "$2" "${5:+, \`$5\`}" "$3"
    column=2
    case $4 in *=*) column=4 ;; esac
    for method in --paper ""; do
        word=$(solved $method $5) && word=$("$BUILD/judge" "$file.obj" \
            "$work/solution.ply" "$4" | awk -v column=$column -v exact="$3" '{
                format = $column ^ 2 > 100 ? "%.0f %%" : "%.2g %%"
                if (exact == 0) format = "%.2g"
                printf format, exact == 0 ? $column / 100 : $column }')
        printf ' %s |' "$word"
    done
    echo
}

# scene NAME WORD...: $file.
scene() {
    file=$work/$1
    shift
    make_scene "$file" 0 "$@"
}

# received FAILURE TEXT F AREA [OPTIONS]: of the light of one watt, by a plate of rho .5.
received() { row "$1" "$2" "$3" "plate~$(of "$3 / $4 / 2")" "${5-}"; }

# furnace FAILURE TEXT B [OPTIONS]: its worst leaf.
furnace() { row "$1" "furnace, $2, worst leaf" "$3" "all=$3" "${4-}"; }

# --- the page ---

rows() {
    scene large above .1 -1 -1 2 2
    received "F above 1" "F of a unit square to one of 3 x 3, 0.1 above it" \
        "$(compute "over(-1, 2, .1)")" 9
    scene near above .1 0 0 1 1
    received "near patches" "F of two unit squares, 0.1 apart" \
        "$(compute "over(0, 1, .1)")" 1
    scene far above 100 0 0 1 1
    received "far patches" "F of two unit squares, 100 apart" \
        "$(compute "over(0, 1, 100)")" 1
    scene groove right_angle
    received "singular shared edge" "F of two unit squares at a right angle" \
        "$(compute "edge()")" 1
    scene gap around
    out=$(compute "over(-1, 2, .002) - over(0, 1, .002)")
    received "gap of 2 mm" "light of a lamp of 1 m, 2 mm above a floor, that gets out" \
        "$out" 8
    received "gap of 2 mm" "the same" "$out" 8 "--epsilon 1e-7"
    scene furnished furnished .5 1
    for epsilon in 1e-2 1e-3 1e-4; do
        furnace "drift of row sums" "three blocks, rho 0.5" 2 "--epsilon $epsilon"
    done
    coarse="--epsilon 1e-2"
    for rho in 0.9 0.99 0.999; do
        scene furnace$rho closed 1 $rho 1
        furnace "little is absorbed" "rho $rho" "$(of "1 / (1 - $rho)")" "$coarse"
    done
    scene long closed 100 .999 1
    furnace "corridor 1:100" "rho 0.999" 1000 "$coarse"
    scene wedge wedge .174977 .9 1
    furnace "sharp edge" "a wedge of 10 degrees, rho 0.9" 10 "$coarse"
    scene slivers slivers
    furnace "slivers" "rho 0.99, slivers to 1 : 1e6 in it" 1 "$coarse"
    scene junctions junctions
    furnace "T-junctions" "rho 0.9, floor of four rectangles" 10 "$coarse"
    scene lit lit_end
    row "false convergence" "rho 0.99, lamp at one end, mean" "$(of "1 / .42")" \
        "*~$(of "1 / .42")" "$coarse"
    for rho in 0.3 0.6; do
        scene twice$rho twice $rho 1
        furnace "faces twice" "rho $rho" "$(of "1 / (1 - $rho)")" "$coarse"
    done
    scene flush flush_lamp
    row "coplanar lamp" "flush with a ceiling, rho 0.5, mean of the walls" \
        "$(of ".04 / 6")" "wall~$(of ".04 / 6")" ""
    scene standing standing
    row "covered patches" "furnace, rho 0.9, a block on the floor, brightest leaf" 10 \
        "all^10" "$coarse"
    scene through standing through
    row "faces through faces" \
        "furnace, rho 0.9, a block through it and the floor, brightest leaf" 10 "all^10" \
        "$coarse"
    scene sealed three_rooms
    row "light leaks" "dark rooms that share walls with a lit one, brightest leaf" 0 \
        "dark^0" ""
    scene thin thin_wall
    row "light leaks" "a block behind a wall of 1 mm, brightest leaf" 0 "dark^0" ""
    scene slit hole .02 .4
    half=$(compute "middle(.04, .8, .5) / 2")
    row "partial visibility" "a floor lit through a slit, mean" "$half" "floor~$half" ""
    scene pinhole hole .03 .03
    half=$(compute "middle(.06, .06, .5) / 2")
    row "partial visibility" "through a pinhole" "$half" "floor~$half" ""
    file=scenes/doorway
    far=$(awk -F, '$1 == "doorway" && $2 == "walls-far" { print $3 }' scenes/answers.csv)
    row "partial visibility" "two rooms and a doorway, walls of the far one" "$far" \
        "walls-far~$far" ""
    scene tiny spot 5e-5 .5 1e8
    light=$(compute "5e7 * middle(1e-4, 1e-4, .5)")
    row "tiny bright lamp" "1e-4 of the floor below it, mean of that" "$light" \
        "floor~$light" ""
    scene low spot 2e-5 1e-5 1e8
    light=$(compute "5e7 * middle(4e-5, 4e-5, 1e-5)")
    row "15 levels" "a lamp of 4e-5, 1e-5 above the floor, mean of that" "$light" \
        "floor~$light" "--max-level 15 --min-area 0"
    scene mirror closed 1 1.5 1
    furnace "rho above 1" "rho 1.5, which is set to 0.999 with a warning" 1000 "$coarse"
}

{ echo "|---|---|---|---|---|"; rows; } >"$work/made"
[ -f "$OUT" ] || cp docs/stability.md "$OUT"
renew "$OUT" "| failure |" <"$work/made"
cat "$OUT"
