#!/bin/sh
# Speed against error: docs/chart.csv, the table of README.md on stdout and, where gnuplot is
# installed, docs/chart-seconds.svg and docs/chart-links.svg.
#
#   make chart           all, about ten minutes
#   SCENES=shadow CSV=build/chart.csv sh tests/bench/chart.sh       one scene, nothing drawn
#
# Each variant is run on one rank with ever smaller epsilon until a run takes more than SECONDS or
# has more than LINKS. The variants take turns, so that a disturbance of the machine hits all of
# them; of a run below two seconds three are made and the fastest counts. References are made
# when they are missing and kept under $BUILD/chart.

cd "$(dirname "$0")/../.." || exit 2
: "${BUILD:=build/mpi}" "${MPIEXEC:=mpiexec}" "${SCENES:=cornell shadow room}" "${CSV:=docs/chart.csv}"
: "${SECONDS_MOST:=3}" "${LINKS_MOST:=5000000}"
export LC_ALL=C
folder=$BUILD/chart
mkdir -p "$folder"

EPSILONS="1e-2 3e-3 1e-3 3e-4 1e-4 3e-5 1e-5 3e-6 1e-6 3e-7 1e-7"
PATHS="1 4 16 64 256"
VARIANTS="paper error polygon cg rows all all+rows"

options_of() {
    case $1 in
    paper) echo --paper ;;
    error) echo --paper --oracle error ;;
    polygon) echo --paper --form-factor polygon ;;
    cg) echo --paper --solver cg ;;
    rows) echo --paper --closure rows ;;
    all) ;;
    all+*) echo --closure "${1#all+}" ;;
    esac
}

scene_of() {
    case $1 in
    room) echo "$folder/room.obj" ;;
    *) echo "scenes/$1.obj" ;;
    esac
}

# make_reference SCENE: the file beside it, unless it is there.
make_reference() {
    if [ "$1" = room ] && ! [ -f "$folder/room.obj" ]; then
        cp scenes/room.mtl "$folder" && build/room 1000 1 >"$folder/room.obj" || exit 1
    fi
    [ -f "$folder/$1.ref" ] && return
    case $1 in
    shadow) "$BUILD/direct" scenes/shadow.obj "$folder/new.ref" ;;
    room) $MPIEXEC -n 2 "$BUILD/reference" "$folder/room.obj" "$folder/new.ref" 10000 1000 ;;
    *) $MPIEXEC -n 2 "$BUILD/reference" "$(scene_of "$1")" "$folder/new.ref" 20000 3000 ;;
    esac >&2 && mv "$folder/new.ref" "$folder/$1.ref" || exit 1
}

# exceeds NUMBER LIMIT
exceeds() {
    awk "BEGIN { exit !($1 > $2) }"
}

# fastest COMMAND...: of its lines of three runs, or of one that takes long, the one with the
# smallest second field.
fastest() {
    "$@" >"$folder/runs"
    [ -s "$folder/runs" ] || return
    exceeds "$(cut -d, -f 2 "$folder/runs")" 2 || { "$@" && "$@"; } >>"$folder/runs" || return
    sort -t, -g -k 2,2 "$folder/runs" | head -n 1
}

# measured SCENE VARIANT EPSILON: epsilon and what docs/chart.csv has of the run.
measured() {
    # Unquoted: one word for each option.
    "$BUILD/measure" "$(scene_of "$1")" "$folder/$1.ref" --epsilon "$3" $(options_of "$2") |
        awk -F, -v OFS=, -v epsilon="$3" '{ print epsilon, $3, $4, $5, $10, $11, $12, $13, $14, $15 }'
}

# traced SCENE PATHS
traced() {
    "$BUILD/tracing" "$(scene_of "$1")" "$folder/$1.ref" "$2" | sed 's/^\([^,]*,[^,]*\),/\1,,,/'
}

# turn SCENE VARIANT KNOB COMMAND: one point of a line, unless the line has ended.
turn() {
    [ -f "$folder/ended.$2" ] && return
    # A run that diverges gives no line.
    if ! line=$(fastest "$4" "$1" ${5:+"$5"} "$3") || [ -z "$line" ]; then
        echo "chart: $1, $2, $3: no result" >&2
        return
    fi
    echo "$1,$2,$line" | tee -a "$folder/lines" >&2
    exceeds "$(echo "$line" | cut -d, -f 2)" "$SECONDS_MOST" && : >"$folder/ended.$2"
    exceeds "$(echo "$line" | awk -F, '{ print 0 + $3 }')" "$LINKS_MOST" && : >"$folder/ended.$2"
}

# The lines of a scene, one variant after the other.
sweep() {
    rm -f "$folder/lines" "$folder"/ended.*
    : >"$folder/lines"
    for epsilon in $EPSILONS; do
        for variant in $VARIANTS; do
            turn "$1" "$variant" "$epsilon" measured "$variant"
        done
    done
    for paths in $PATHS; do
        turn "$1" paths "$paths" traced
    done
    for variant in $VARIANTS paths; do
        grep "^$1,$variant," "$folder/lines"
    done
}

for scene in $SCENES; do
    make_reference "$scene"
done
{
    echo "scene,variant,epsilon_or_paths,seconds,links,rays,leaf_rms,leaf_l1,leaf_median,shown_rms,shown_l1,shown_median"
    for scene in $SCENES; do
        sweep "$scene"
    done
} >"$folder/chart.csv"
mv "$folder/chart.csv" "$CSV"
rm -f "$folder/lines" "$folder/runs" "$folder"/ended.*
awk -f tests/bench/chart.awk "$CSV"
if [ "$CSV" != docs/chart.csv ]; then
    exit
elif command -v gnuplot >/dev/null; then
    gnuplot tests/bench/chart.gp && echo "docs/chart-seconds.svg and docs/chart-links.svg are drawn"
else
    echo "docs/chart.csv is written; install gnuplot to draw it"
fi
