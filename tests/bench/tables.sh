# Tables 1 and 2 of the paper beside phr's: docs/tables.md; Fig. 3: docs/fig3.svg. For
# `make scaling`.
#
# phr runs with --paper on 1 to 32 processes, which may share a few cores: counts do not
# depend on the clock. Seconds are counts times prices: of work by the seconds of the runs
# on one rank, the least of them counting, times the share of a processor that the run
# had, of messages and bytes by the network. Each room runs with each way of balancing.
# Knobs: ROOMS, as SIZE:EPSILON; RANKS; TURNS, runs on one rank; OUT, the file; FIG3, the
# figure.
set -eu
: "${BUILD:=build/mpi}" "${MPIEXEC:=mpiexec}" "${ROOMS:=1000:1e-5 6348:1e-4}"
: "${RANKS:=1 4 8 16 24 32}" "${TURNS:=1 2}" "${OUT:=docs/tables.md}"
: "${FIG3:=docs/fig3.svg}"
. tests/bench/renew.sh
work=$BUILD/tables
mkdir -p "$work"
cp scenes/room.mtl "$work"

# measure NAME SIZE EPSILON: NAME.one.TURN on one rank; NAME.BALANCE.RANKS on each number.
measure() {
    name=$work/$1
    rm -f "$name".*
    build/room "$2" 1 >"$name.obj"
    run_alone "$name" "$name.obj" --paper --epsilon "$3"
    for balance in greedy none default; do
        for ranks in $RANKS; do
            $MPIEXEC -n "$ranks" ./phr "$name.obj" --paper --epsilon "$3" --quiet \
                --balance $balance --stats "$name.$balance.$ranks"
        done
    done
}

# table NAME EPSILON NETWORK SECONDS_PER_MESSAGE BYTES_PER_SECOND
table() {
    for balance in greedy none default; do
        for ranks in $RANKS; do
            set -- "$@" "$work/$1.$balance.$ranks"
        done
    done
    name=$work/$1 size=$1 epsilon=$2 network=$3 message=$4 bandwidth=$5
    shift 5
    awk -v size="$size" -v epsilon="$epsilon" -v network="$network" \
        -v message="$message" -v bandwidth="$bandwidth" -v figure="$name.$network" \
        -f tests/bench/tables.awk "$name".one.* "$@"
}

{
    for room in $ROOMS; do
        size=${room%%:*} epsilon=${room#*:}
        measure "$size" "$size" "$epsilon"
        table "$size" "$epsilon" today 2e-6 1e10
        table "$size" "$epsilon" Ethernet 1e-4 1e7
    done
} >"$work/made"
[ -f "$OUT" ] || cp docs/tables.md "$OUT"
renew "$OUT" "| 32 | 350.83 |" <"$work/made"

# Fig. 3: speed-ups without linking, the paper's by the page.
{
    awk -F'|' '/room 320 .*room 380/ { on = 1; next }
        on && /^$/ { exit }
        on && $2 + 0 > 0 {
            print "room_320", $2, $4
            print "room_380", $2, $6
            print "room_420", $2, $8
        }' "$OUT"
    cat "$work"/*.today
} | awk -v title="Speed-up without initial linking" -v xlabel=processors \
    -v ylabel=speed-up -f docs/course/chart.awk >"$FIG3"
cat "$OUT"
