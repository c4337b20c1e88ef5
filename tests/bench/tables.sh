# Tables 1 and 2 of the paper beside phr's, by counts: docs/tables.md. For `make scaling`.
#
# phr runs with --paper on 1 to 32 processes, which may share a few cores: counts do not
# depend on the clock. Seconds are counts times prices: of work by the seconds of the runs
# on one rank, the least of them counting, of messages and bytes by the network. Each room
# runs again with --balance none.
# Knobs: ROOMS, as SIZE:EPSILON; RANKS; TURNS, runs on one rank; OUT, the file.
set -eu
: "${BUILD:=build/mpi}" "${MPIEXEC:=mpiexec}" "${ROOMS:=1000:1e-5 2000:3e-5}"
: "${RANKS:=1 4 8 16 24 32}" "${TURNS:=1 2 3}" "${OUT:=docs/tables.md}"
. tests/bench/renew.sh
work=$BUILD/tables
mkdir -p "$work"
cp scenes/room.mtl "$work"

# measure NAME SIZE EPSILON: NAME.one.TURN on one rank, NAME.BALANCE.RANKS on each number.
measure() {
    name=$work/$1
    rm -f "$name".*
    build/room "$2" 1 >"$name.obj"
    for turn in $TURNS; do
        ./phr "$name.obj" --paper --epsilon "$3" --quiet --stats "$name.one.$turn"
    done
    for balance in greedy none; do
        for ranks in $RANKS; do
            $MPIEXEC -n "$ranks" ./phr "$name.obj" --paper --epsilon "$3" --quiet \
                --balance $balance --stats "$name.$balance.$ranks"
        done
    done
}

# table NAME EPSILON NETWORK SECONDS_PER_MESSAGE BYTES_PER_SECOND
table() {
    for balance in greedy none; do
        for ranks in $RANKS; do
            set -- "$@" "$work/$1.$balance.$ranks"
        done
    done
    name=$work/$1 size=$1 epsilon=$2 network=$3 message=$4 bandwidth=$5
    shift 5
    awk -v size="$size" -v epsilon="$epsilon" -v network="$network" \
        -v message="$message" -v bandwidth="$bandwidth" -f tests/bench/tables.awk \
        "$name".one.* "$@"
}

{
    for room in $ROOMS; do
        size=${room%%:*} epsilon=${room#*:}
        measure "$size" "$size" "$epsilon"
        table "$size" "$epsilon" "today" 2e-6 1e10
        table "$size" "$epsilon" "Ethernet" 1e-4 1e7
    done
} >"$work/made"
[ -f "$OUT" ] || cp docs/tables.md "$OUT"
renew "$OUT" "| 32 | 350.83 |" <"$work/made"
cat "$OUT"
