#!/bin/sh
# Speed against error: docs/chart.csv, its tables on stdout and in docs/accuracy.md and,
# where gnuplot is installed, docs/chart-leaf.svg and docs/chart-shown.svg.
#
#   make chart
#       all scenes: an hour and a half on two cores, half an hour of it for references
#   SECONDS_MOST=8 EPSILONS="1e-2 1e-3 1e-4 1e-5 1e-6" make chart
#       shorter lines: a quarter of an hour where the references are there
#   SCENES="cornell shadow" CSV=build/chart.csv make chart
#       two scenes, drawn beside the CSV; docs/accuracy.md stays
#
# A point is a run on one rank. The variants:
#   paper   --paper, nothing else: all pairs of triangles
#   mended  the same loop over all pairs, with phr's form factors, visibility and
#           criterion (--paper --oracle error --form-factor polygon)
#   links   the defaults without the final gather
#   gather  the defaults: --epsilon and --final-gather move together, as in PAIRS
#   paths   the path tracer at the leaves of the gather with the same setting, for about
#           as many seconds (tests/bench/measure.c, --trace); samples are its paths
#   octree, embree               100,000 rays that wander (tests/bench/hits.c)
#   paths octree, paths embree   the path tracer with either
# A line ends with the first run of more than SECONDS_MOST, or before one that is broken
# off: after four times as long by the clock (ulimit -t makes seconds of the processor
# coarse), or after five minutes where the path tracer follows. Lines take turns, so that
# a disturbance of the machine hits all; runs below two seconds are made three times, and
# the least time for the error counts. References are made when they are missing and kept
# under $BUILD/chart. Their noise (columns leaf_noise and shown_noise) is to be a third of
# the errors at most: L1 and median contain it, RMS does not.

cd "$(dirname "$0")/../.." || exit 2
: "${BUILD:=build/mpi}" "${MPIEXEC:=mpiexec}" "${CSV:=docs/chart.csv}"
# The command that this is, for the page.
command=$(for knob in SCENES SECONDS_MOST EPSILONS PAIRS; do
    eval "value=\${$knob:-}"
    [ -z "$value" ] || printf '%s="%s" ' "$knob" "$value"
done)"make chart"
: "${SCENES:=cornell shadow room1004 room6348 room18512 room31936}"
: "${SECONDS_MOST:=30}"
: "${EPSILONS:=1e-2 1e-3 3e-4 1e-4 3e-5 1e-5 3e-6 1e-6 3e-7}"
: "${PAIRS:=3e-2/8 3e-2/16 3e-2/32 1e-2/64 1e-2/128 3e-3/256 1e-3/512 \
3e-4/1024 1e-4/2048}"
export LC_ALL=C
. tests/bench/renew.sh
folder=$BUILD/chart work=$BUILD/chart
mkdir -p "$folder"

VARIANTS="paper mended links gather"

# settings_of VARIANT
settings_of() {
    case $1 in
    gather) echo "$PAIRS" ;;
    *) echo "$EPSILONS" ;;
    esac
}

# options_of VARIANT SETTING
options_of() {
    case $1 in
    paper) echo "--paper --epsilon $2" ;;
    mended) echo "--paper --oracle error --form-factor polygon --epsilon $2" ;;
    links) echo "--final-gather 0 --epsilon $2" ;;
    gather) echo "--trace --epsilon ${2%/*} --final-gather ${2#*/}" ;;
    esac
}

# make_room SCENE: the number that build/room is asked for.
make_room() {
    case $1 in
    room6348) size=6350 ;;
    room18512) size=18510 ;;
    room31936) size=31933 ;;
    *) size=${1#room} ;;
    esac
    cp scenes/room.mtl "$folder" && build/room "$size" 1 >"$folder/$1.obj" || exit 1
}

# samples_of NAME: paths of an element of its reference, each way.
samples_of() {
    case $1 in
    cornell) echo 8000 ;;
    room1004 | room6348) echo 4000 ;;
    room18512) echo 2500 ;;
    *) echo 1500 ;;
    esac
}

# exceeds NUMBER LIMIT
exceeds() {
    awk "BEGIN { exit !($1 > $2) }"
}

# measured SCENE VARIANT SETTING: a line of the CSV, or two with the path tracer's; none
# if the light diverges, or the run is broken off.
measured() {
    limit=$((4 * SECONDS_MOST))
    [ "$2" != gather ] || limit=300
    {
        # Unquoted: one word for each option.
        timeout $limit "$BUILD/measure" "$(file_of "$1")" "$folder/$1.ref" \
            $(options_of "$2" "$3") 2>>"$folder/log"
        [ $? -ne 124 ] || : >"$folder/ended.$2"
    } | awk -F, -v OFS=, -v scene="$1" -v variant="$2" -v setting="$3" '
            $2 ~ / paths a leaf$/ { variant = "paths"; $4 = ""; samples = ($2 + 0) * $25 }
            { print scene, variant, setting, $3, $4, $25, samples, $5,
                    $10, $11, $12, $13, $14, $15, $16, $17 }'
}

# The runs of a variant: of each kind of line that with the least seconds times the square
# of the error.
fastest() {
    measured "$@" >"$folder/runs"
    [ -s "$folder/runs" ] || return
    exceeds "$(head -n 1 "$folder/runs" | cut -d, -f 4)" 2 ||
        { measured "$@" && measured "$@"; } >>"$folder/runs"
    awk -F, '{ price = $4 * $9 ^ 2 }
        !($2 in least) || price < least[$2] { least[$2] = price; line[$2] = $0 }
        END { for (variant in line) print line[variant] }' "$folder/runs" | sort
}

# turn SCENE VARIANT SETTING: one point of a line, unless the line has ended.
turn() {
    [ -f "$folder/ended.$2" ] && return
    lines=$(fastest "$@")
    if [ -z "$lines" ]; then
        echo "chart: $1, $2, $3: no result" >&2
        return
    fi
    echo "$lines" | tee -a "$folder/lines" >&2
    exceeds "$(echo "$lines" | head -n 1 | cut -d, -f 4)" "$SECONDS_MOST" &&
        : >"$folder/ended.$2"
}

# hits SCENE: its first hits, as lines of the CSV.
hits() {
    "$BUILD/hits" "$(file_of "$1")" 100000 | awk -v OFS=, -v scene="$1" '
        function line(variant, rays, paths) {
            print scene, variant, "", 1e-6 * rays / $2, "", "", paths, rays ",,,,,,,,"
        }
        /^ [^ ]/ { kind = $1 " " $4; next }
        { program = tolower($1); sub(":", "", program) }
        kind == "rays 1" { line(program, 100000) }
        kind == "paths, each" { line("paths " program, $4, $7) }'
}

# The lines of a scene, one variant after the other.
sweep() {
    rm -f "$folder/lines" "$folder"/ended.*
    : >"$folder/lines"
    longest=$(for variant in $VARIANTS; do settings_of "$variant" | wc -w; done |
        sort -n | tail -n 1)
    place=1
    while [ "$place" -le "$longest" ]; do
        for variant in $VARIANTS; do
            setting=$(settings_of "$variant" | awk -v place="$place" '{ print $place }')
            [ -z "$setting" ] || turn "$1" "$variant" "$setting"
        done
        place=$((place + 1))
    done
    for variant in $VARIANTS paths; do
        grep "^$1,$variant," "$folder/lines"
    done
    hits "$1"
}

# Puts the tables in the place of those of docs/accuracy.md, and the command into its line
# that begins with "Made by".
renew_page() {
    awk -v made="Made by \`$command\`." '
        NR == FNR && /^$/ { tables++ }
        NR == FNR { if (/^\|/) table[tables + 0] = table[tables + 0] $0 "\n"; next }
        /^Made by / { print made; next }
        /^\| scene / { printf "%s", table[shown++]; in_table = 1 }
        !/^\|/ { in_table = 0 }
        !in_table' "$folder/tables" docs/accuracy.md >"$folder/page" &&
        cp "$folder/page" docs/accuracy.md
}

for scene in $SCENES; do
    case $scene in
    room*) [ -f "$folder/$scene.obj" ] || make_room "$scene" ;;
    esac
    make_reference "$scene" 10000 "$(samples_of "$scene")" || exit 1
done
{
    echo "scene,variant,setting,seconds,links,leaves,samples,rays,leaf_rms," \
        "leaf_l1,leaf_median,shown_rms,shown_l1,shown_median,leaf_noise,shown_noise" |
        tr -d ' '
    for scene in $SCENES; do
        sweep "$scene"
    done
} >"$folder/chart.csv"
mv "$folder/chart.csv" "$CSV"
rm -f "$folder/lines" "$folder/runs" "$folder"/ended.*
awk -f tests/bench/chart.awk "$CSV" | tee "$folder/tables"
[ "$CSV" != docs/chart.csv ] || renew_page
if command -v gnuplot >/dev/null; then
    gnuplot -e "csv='$CSV'; out='${CSV%.csv}'" tests/bench/chart.gp &&
        echo "${CSV%.csv}-leaf.svg and ${CSV%.csv}-shown.svg are drawn"
else
    echo "$CSV is written; install gnuplot to draw it"
fi
