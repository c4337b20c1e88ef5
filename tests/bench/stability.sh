# make stability: what breaks radiosity programs, a line each: docs/stability.md.
#
# Scenes are written to $BUILD/stability, solved with --paper and by default, and one
# number is told of each, beside the exact one. Exact numbers are closed forms, worked
# out here, or those of the path tracer in scenes/answers.csv. Half a minute on two
# cores.
# Knobs: PHR, the program; OUT, the file.
set -eu
: "${BUILD:=build/mpi}" "${PHR:=./phr}" "${OUT:=docs/stability.md}"
. tests/bench/renew.sh
export LC_ALL=C
work=$BUILD/stability
mkdir -p "$work"

# --- scenes: functions print OBJ; paint also writes the material ---

# face X Y Z ...: four corners, counter-clockwise as seen from the front.
face() {
    printf 'v %s %s %s\n' "$@"
    echo "f $order"
}
forth="-4 -3 -2 -1" back="-1 -2 -3 -4"
order=$forth

# up X0 Y0 X1 Y1 Z: a level rectangle; down: one that faces the floor.
up() { order=$forth; level "$@"; }
down() { order=$back; level "$@"; }
level() { face $1 $2 $5 $3 $2 $5 $3 $4 $5 $1 $4 $5; }

# room X0 Y0 Z0 X1 Y1 Z1: a box seen from inside; block: from outside.
room() { order=$forth; box "$@"; }
block() { order=$back; box "$@"; }
box() {
    left "$@"
    others "$@"
}
left() { face $1 $2 $3 $1 $5 $3 $1 $5 $6 $1 $2 $6; }
others() {
    face $1 $2 $3 $4 $2 $3 $4 $5 $3 $1 $5 $3
    face $1 $2 $6 $1 $5 $6 $4 $5 $6 $4 $2 $6
    face $1 $2 $3 $1 $2 $6 $4 $2 $6 $4 $2 $3
    face $1 $5 $3 $4 $5 $3 $4 $5 $6 $1 $5 $6
    face $4 $2 $3 $4 $2 $6 $4 $5 $6 $4 $5 $3
}

# paint NAME RHO E: the faces that follow.
paint() {
    printf 'newmtl %s\nKd %s %s %s\nKe %s %s %s\n' $1 $2 $2 $2 $3 $3 $3 \
        >>"$work/$name.mtl"
    echo "usemtl $1"
}

# scene NAME FUNCTION ...: the file.
scene() {
    name=$1
    : >"$work/$name.mtl"
    shift
    {
        echo "mtllib $name.mtl"
        "$@"
    } >"$work/$name.obj"
}

# --- exact numbers ---

# compute EXPRESSION: of awk, with
#   parallel(A0, A1, B0, B1, C0, C1, D0, D1, Z)   area times form factor of the level
#       rectangle A0..A1 x B0..B1 to C0..C1 x D0..D1, Z above it
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
        function middle(a, b, z) {
            return parallel(-a / 2, a / 2, -b / 2, b / 2, -0.5, 0.5, -0.5, 0.5, z)
        }
        function edge() {
            return (pi / 2 - sqrt(2) * atan2(1, sqrt(2)) + log(3 / 4) / 4) / pi
        }
        BEGIN { pi = atan2(0, -1); printf "%.9g\n", '"$1"' }'
}

# answer SCENE OBJECT: of the path tracer.
answer() {
    awk -F, -v s="$1" -v o="$2" '$1 == s && $2 == o { print $3 }' scenes/answers.csv
}

# --- numbers of a run ---

# solve NAME: a run of $method with $options; prints a word, and fails, if there is none.
solve() {
    file=$work/$1.obj
    [ -f "$file" ] || file=scenes/$1.obj
    rm -f "$work/stats" "$work/patches"
    (ulimit -t 15 && exec $PHR $method $options "$file" --dump patches \
        --stats "$work/stats") >"$work/patches" 2>"$work/log" && return
    if grep -q diverge "$work/log"; then
        echo diverges
    elif grep -q "not converge\|memory" "$work/log"; then
        echo fails
    else
        echo "no end"
    fi
    return 1
}

# told KIND NAMES [EXACT]: of the leaves of materials or objects: mean, most, least,
# the B that is furthest from EXACT.
told() {
    awk -v kind="$1" -v names=" $2 " -v exact="${3:-0}" '
        NR == FNR {
            if ($1 == "o" || $1 == "usemtl" && !objects)
                own = index(names, " " $2 " ") > 0
            objects += $1 == "o"
            for (k = 4; $1 == "f" && k <= NF; k++)
                wanted[roots++] = own
            next
        }
        /^#/ || !wanted[$1 + 0] { next }
        { area[$1] = $4; b[$1] = $5; inner[$3] = 1 }
        END {
            for (patch in area) {
                if (patch in inner)
                    continue
                all += area[patch]; light += area[patch] * b[patch]
                off = b[patch] - exact; off = off < 0 ? -off : off
                if (!some++ || b[patch] > most) most = b[patch]
                if (some == 1 || b[patch] < least) least = b[patch]
                if (off >= furthest) { furthest = off; worst = b[patch] }
            }
            value["mean"] = light / all; value["most"] = most
            value["least"] = least; value["worst"] = worst
            printf "%.9g\n", value[kind]
        }' "$file" "$work/patches"
}

# told_of NAME KIND NAMES [EXACT]: the same of a scene.
told_of() { solve "$1" && { shift; told "$@"; }; }

# share NAME KEY: of the emitted power.
share() {
    solve "$1" && awk -v key="\"$2\":" '$1 == "\"emitted_power\":" { all = $2 + 0 }
        $1 == key { part = $2 }
        END { printf "%.9g\n", part / all }' "$work/stats"
}

# --- lines of the table ---

# row FAILURE TEXT EXACT NUMBER...: the text tells of scene and number.
row() {
    failure=$1 text=$2 exact=$3
    shift 3
    printf '| %s | `%s`: %s%s | %.6g |' "$failure" "$name" "$text" \
        "${options:+, \`$options\`}" "$exact"
    for method in --paper ""; do
        value=$("$@") || :
        awk -v value="$value" -v exact="$exact" 'BEGIN {
            off = exact == 0 ? 0 : 100 * (value / exact - 1)
            format = off * off > 100 ? " %.6g | %.0f %% |" : " %.6g | %.2g %% |"
            if (value !~ /^[-+0-9.e]+$/)
                printf " %s | |", value
            else if (exact == 0)
                printf " %.2g | |", value
            else
                printf format, value, off
        }'
    done
    echo
}
options=

# received NAME MATERIALS AREA: by surfaces of rho 0.5, of the light of one watt.
received() {
    mean=$(told_of "$1" mean "$2") || { echo "$mean"; return; }
    compute "$mean * $3 / 0.5"
}

# furnace NAME: all is painted with E 1; the leaf that is furthest from E / (1 - rho).
furnace() {
    told_of "$1" worst "all" "$exact"
}

# --- the scenes, by what they are made of ---

lamp_and_plate() { # LAMP PLATE: commands
    paint lamp 0 1
    $1
    paint plate 0.5 0
    $2
}
above() { lamp_and_plate "up 0 0 1 1 0" "down $*"; }

groove() { # two squares at a right angle
    paint lamp 0 1
    up 0 0 1 1 0
    paint plate 0.5 0
    order=$forth
    face 0 0 0 0 1 0 0 1 1 0 0 1
}

frame_below() {
    lamp_and_plate "down 0 0 1 1 0.002" :
    up -1 -1 2 0 0
    up -1 1 2 2 0
    up -1 0 0 1 0
    up 1 0 2 1 0
}

furnished() { # RHO
    paint all $1 1
    room 0 0 0 1 1 1
    block 0.3 0.2 0.1 0.7 0.5 0.4
}

closed() { # RHO LENGTH
    paint all $1 1
    room 0 0 0 $2 1 1
}

wedge() {
    paint all 0.9 1
    order=$forth
    face 0 0 0 1 0 0 1 1 0 0 1 0
    face 0 0 0 0 1 0 1 1 0.1763 1 0 0.1763
    face 1 0 0 1 0 0.1763 1 1 0.1763 1 1 0
    order="-3 -2 -1"
    face 0 0 0 1 0 0.1763 1 0 0
    face 0 1 0 1 1 0 1 1 0.1763
}

slivers() {
    closed 0.99 1
    for width in 1e-2 1e-4 1e-6; do
        printf 'v %s %s %s\n' 0.03 0.05 0.5 0.93 0.96 0.5 0.93 0.96 \
            "$(compute "0.5 + $width")"
        printf 'f -3 -2 -1\nf -3 -1 -2\n'
    done
}

junctions() {
    paint all 0.9 1
    up 0 0 0.5 0.3 0
    up 0.5 0 1 0.7 0
    up 0 0.3 0.5 1 0
    up 0.5 0.7 1 1 0
    down 0 0 1 1 1
    order=$forth
    face 0 0 0 0 0 1 1 0 1 1 0 0
    face 0 0 0 0 1 0 0 1 1 0 0 1
    order=$back
    face 0 1 0 0 1 1 1 1 1 1 1 0
    face 1 0 0 1 1 0 1 1 1 1 0 1
}

lit_end() {
    order=$forth
    paint wall 0.99 0
    others 0 0 0 10 1 1
    paint lamp 0.99 1
    left 0 0 0 10 1 1
}

twice() { # RHO
    closed $1 1
    room 0 0 0 1 1 1
}

flush_lamp() {
    paint wall 0.5 0
    room 0 0 0 1 1 1
    paint lamp 0.5 1
    down 0.4 0.4 0.6 0.6 1
}

standing() {
    closed 0.9 1
    block 0.2 0.2 0 0.6 0.6 0.3
}

through() {
    standing
    block 0.5 0.5 -0.2 0.9 0.8 0.2
}

sealed() {
    paint lit 0.9 1
    room 0 0 0 1 1 1
    paint dark 0.9 0
    room 1 0 0 2 1 1
    room 0 1 0 1.5 2 1
}

thin_wall() {
    paint wall 0.5 0
    room 0 0 0 2 1 1
    block 1 0 0 1.001 1 1
    paint lamp 0 1
    down 0.7 0.2 0.9 0.8 0.9
    paint dark 0.5 0
    block 1.1 0.4 0.1 1.3 0.6 0.3
}

hole() { # HALF_WIDTH HALF_HEIGHT: in a screen between a lamp and a floor
    paint floor 0.5 0
    up -0.5 -0.5 0.5 0.5 0
    paint screen 0 0
    up -6 -6 6 -$2 0.5
    up -6 $2 6 6 0.5
    up -6 -$2 -$1 $2 0.5
    up $1 -$2 6 $2 0.5
    paint lamp 0 1
    down -4 -4 4 4 1
}

spot() { # HALF_SIZE HEIGHT E
    paint floor 0.5 0
    up -0.5 -0.5 0.5 0.5 0
    paint lamp 0 $3
    down -$1 -$1 $1 $1 $2
}

mirror() {
    paint all 1.5 1
    room 0 0 0 1 1 1
}

# --- the page ---

rows() {
    scene large above -1 -1 2 2 0.1
    row "F above 1" "F of a unit square to one of 3 x 3, 0.1 above it" \
        "$(compute "parallel(0, 1, 0, 1, -1, 2, -1, 2, 0.1)")" received large plate 9
    scene near above 0 0 1 1 0.1
    row "near patches" "F of two unit squares, 0.1 apart" \
        "$(compute "parallel(0, 1, 0, 1, 0, 1, 0, 1, 0.1)")" received near plate 1
    scene far above 0 0 1 1 100
    row "far patches" "F of two unit squares, 100 apart" \
        "$(compute "parallel(0, 1, 0, 1, 0, 1, 0, 1, 100)")" received far plate 1
    scene groove groove
    row "singular shared edge" "F of two unit squares at a right angle" \
        "$(compute "edge()")" received groove plate 1
    scene gap frame_below
    row "gap of 2 mm" "light of a lamp of 1 m, 2 mm above a floor, that gets out" \
        "$(compute "parallel(0, 1, 0, 1, -1, 2, -1, 2, 0.002) \
                  - parallel(0, 1, 0, 1, 0, 1, 0, 1, 0.002)")" received gap plate 8
    options="--epsilon 1e-7"
    row "gap of 2 mm" "the same" \
        "$(compute "parallel(0, 1, 0, 1, -1, 2, -1, 2, 0.002) \
                  - parallel(0, 1, 0, 1, 0, 1, 0, 1, 0.002)")" received gap plate 8
    scene furnished furnished 0.5
    for epsilon in 1e-2 1e-3 1e-4; do
        options="--epsilon $epsilon"
        row "drift of row sums" "furnace with a block, rho 0.5, worst leaf" 2 \
            furnace furnished
    done
    options="--epsilon 1e-2"
    for rho in 0.9 0.99 0.999; do
        scene furnace$rho closed $rho 1
        row "little is absorbed" "furnace, rho $rho, worst leaf" \
            "$(compute "1 / (1 - $rho)")" furnace furnace$rho
    done
    scene long closed 0.999 100
    row "corridor 1:100" "furnace, rho 0.999, worst leaf" 1000 furnace long
    scene wedge wedge
    row "sharp edge" "furnace, a wedge of 10 degrees, rho 0.9, worst leaf" 10 \
        furnace wedge
    scene slivers slivers
    row "slivers" "furnace, rho 0.99, slivers to 1 : 1e6 in it, worst leaf" 100 \
        furnace slivers
    scene junctions junctions
    row "T-junctions" "furnace, rho 0.9, floor of four rectangles, worst leaf" 10 \
        furnace junctions
    scene lit lit_end
    row "false convergence" "rho 0.99, lamp at one end, absorbed of emitted" 1 \
        share lit absorbed_power
    for rho in 0.3 0.6; do
        scene twice$rho twice $rho
        row "faces twice" "furnace, rho $rho, worst leaf" "$(compute "1 / (1 - $rho)")" \
            furnace twice$rho
    done
    options=
    scene flush flush_lamp
    row "coplanar lamp" "flush with a ceiling, rho 0.5, mean of the walls" \
        "$(compute "0.04 / 6")" told_of flush mean wall
    options="--epsilon 1e-2"
    scene standing standing
    row "covered patches" "furnace, rho 0.9, a block on the floor, brightest leaf" 10 \
        told_of standing most all
    scene through through
    row "faces through faces" \
        "furnace, rho 0.9, a block through it and the floor, brightest leaf" 10 \
        told_of through most all
    options=
    scene sealed sealed
    row "light leaks" "dark rooms that share walls with a lit one, brightest leaf" 0 \
        told_of sealed most dark
    scene thin thin_wall
    row "light leaks" "a block behind a wall of 1 mm, brightest leaf" 0 \
        told_of thin most dark
    scene slit hole 0.02 0.4
    row "partial visibility" "a floor lit through a slit, mean" \
        "$(compute "middle(0.04, 0.8, 0.5) / 2")" \
        told_of slit mean floor
    scene pinhole hole 0.03 0.03
    row "partial visibility" "through a pinhole" \
        "$(compute "middle(0.06, 0.06, 0.5) / 2")" \
        told_of pinhole mean floor
    name=doorway
    row "partial visibility" "two rooms and a doorway, walls of the far one" \
        "$(answer doorway walls-far)" told_of doorway mean walls-far
    scene tiny spot 5e-5 0.5 1e8
    row "tiny bright lamp" "1e-4 of the floor below it, mean of that" \
        "$(compute "5e7 * middle(1e-4, 1e-4, 0.5)")" \
        told_of tiny mean floor
    scene low spot 2e-5 1e-5 1e8
    options="--max-level 15 --min-area 0"
    row "15 levels" "a lamp of 4e-5, 1e-5 above the floor, mean of that" \
        "$(compute "5e7 * middle(4e-5, 4e-5, 1e-5)")" \
        told_of low mean floor
    options=
    options="--epsilon 1e-2"
    scene mirror mirror
    row "rho above 1" "furnace, rho 1.5, which is set to 0.999 with a warning" 1000 \
        furnace mirror
}

{ echo "|---|---|---|---|---|---|---|"; rows; } >"$work/made"
[ -f "$OUT" ] || cp docs/stability.md "$OUT"
renew "$OUT" "| failure |" <"$work/made"
cat "$OUT"
