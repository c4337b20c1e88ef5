# make scaling: where the seconds of a run go on 1, 32 and 1,024 ranks, line by line.
#
# Runs on one rank tell the seconds of each phase, the least of them counting: those of
# the clock times the share of a processor that the run had, so that a machine which does
# other work as well makes the same page. A run of 32
# processes tells how much of the counted work the slowest rank has in each phase, and the
# bytes sent; it may share a few cores, since counts do not depend on the clock. For
# 1,024 ranks, build/.../replay deals the links that a run splits (tests/bench/replay.c);
# its answer for 32 is printed beside that of the run. Seconds on P ranks: those on one
# rank times the slowest rank's share of the work, and messages by the prices below. A
# line says how it comes about:
#   serial    rank 0 alone, the others wait        repeated  all ranks do it alike
#   divided   counted in the run; on 1,024 ranks as uneven as on 32
#   even      divided, and taken as even
#   replayed  counted; on 1,024 ranks replayed
#   messages  bytes and messages counted on 32 ranks, by price
#   counted   records packed and unpacked by the slowest of 32 ranks, by price; one rank
#             alone has none
# Knobs: ROOM, size of the room; EPSILON; PAPER_ROOM and PAPER_EPSILON for --paper (0:
# without); RANKS, of the run; TURNS, runs on one rank; OUT, the file.
set -eu
: "${BUILD:=build/mpi}" "${MPIEXEC:=mpiexec}" "${ROOM:=31933}" "${EPSILON:=1e-3}"
: "${PAPER_ROOM:=2000}" "${PAPER_EPSILON:=1e-3}" "${RANKS:=32}"
: "${TURNS:=1 2}" "${OUT:=docs/ranks.md}"
. tests/bench/renew.sh
work=$BUILD/scaling
mkdir -p "$work"
cp scenes/room.mtl "$work"

# measure NAME SIZE OPTIONS: NAME.one.TURN on one rank; NAME.many on 32; NAME.replay.
measure() {
    name=$work/$1 size=$2
    shift 2
    rm -f "$name".one.*
    build/room "$size" 1 >"$name.obj"
    run_alone "$name" "$name.obj" "$@" -o "$name.ppm"
    $MPIEXEC -n "$RANKS" ./phr "$name.obj" "$@" --quiet -o "$name.ppm" \
        --stats "$name.many"
    "$BUILD/replay" "$RANKS,1024" "$name.obj" "$@" >"$name.replay"
}

# table NAME TITLE SECONDS_PER_MESSAGE BYTES_PER_SECOND
table() {
    name=$work/$1
    awk -v title="$2" -v ranks="$RANKS" -v message="$3" -v bandwidth="$4" -v copy=2e-8 \
        -v picture=$(($(wc -c <"$name.ppm") * 4)) -f tests/bench/scaling.awk \
        "$name".one.* "$name.many" "$name.replay"
}

measure default "$ROOM" --epsilon "$EPSILON"
[ "$PAPER_ROOM" = 0 ] || measure paper "$PAPER_ROOM" --epsilon "$PAPER_EPSILON" --paper
{
    echo "# Seconds on 1, $RANKS and 1,024 ranks"
    echo
    echo "Made by \`make scaling\`; \`tests/bench/scaling.sh\` says how."
    echo "Seconds on one rank are of the processor."
    echo "Each rank has a core of its own, like the one that the run on one rank had;"
    echo "shared memory of ranks is not made use of."
    table default "Room, epsilon $EPSILON; network of today" 2e-6 1e10
    table default "Room, epsilon $EPSILON; the paper's Ethernet" 1e-4 1e7
    [ "$PAPER_ROOM" = 0 ] ||
        table paper "Room, --paper, epsilon $PAPER_EPSILON; the paper's Ethernet" 1e-4 1e7
} | tee "$OUT"
