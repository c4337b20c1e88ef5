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
    cat <<'EOF'
# Tables 1 and 2 of the paper, beside phr's

Made by `make scaling` (`tests/bench/tables.sh`) with `--paper`: Algorithm 1, with
LoadBalance before every level. Counts of runs on that many processes, times the price of
a test, a look, a link and a patch on one core of the machine that made this page; each
rank is taken to have such a core of its own. Messages and bytes are priced by two
networks: one of today, and the paper's Fast Ethernet. The rooms are phr's own
(`make room`): those of Soda Hall are not at hand.

phr's seconds on one rank are thousands of times fewer than the paper's, and its messages
are as many: on the paper's Ethernet they outweigh all work. "Counted" leaves the network
out. It is to be held against the paper's speed-ups, whose network took a ninth of the
time on 32 ranks.

| column | in the paper | in phr |
|---|---|---|
| refinement | yes | tests of Algorithm 1, and looks before it: mean over ranks |
| idle | yes | the slowest rank's less that mean, summed over levels |
| migration | yes | links before levels; all messages but those of the next two |
| gather, scatter | yes | steps 5 and 7; the flux of all patches, not of updated ones |
| push-pull | yes | patches of the rank that has most at home |
| light | in refinement | transfer over the links of the rank that has most |
| alike | no | parts that all ranks repeat: bounds, routes, copies |
| linking | not in Table 1 | step 2, and links sent home in step 3 |

The paper's Table 1, seconds and speed-up (without initial linking), on a Pentium 4 of
2.4 GHz for each rank:

| ranks | room 320 | | room 380 | | room 420 | |
|---|---|---|---|---|---|---|
| 1 | 11506.4 | 1 | 7283.17 | 1 | 26871.6 | 1 |
| 4 | 2917.52 | 3.9 | 1382.74 | 5.3 | 6898.85 | 3.9 |
| 8 | 1548.05 | 7.4 | 737.04 | 9.9 | 3533 | 7.6 |
| 16 | 830.83 | 13.8 | 406.62 | 17.9 | 1894.23 | 14.2 |
| 24 | 583 | 19.7 | 302.43 | 24.1 | 1296.64 | 20.7 |
| 32 | 460 | 25.0 | 259.45 | 28.1 | 1012.3 | 26.5 |

(On one rank room 380 was swapping.) Its Table 2, seconds, room 320:

| ranks | refinement | idle | migration | gather | push-pull | scatter |
|---|---|---|---|---|---|---|
| 1 | 11442.4 | 0 | 0.85 | 0.01 | 0.96 | 0 |
| 4 | 2803.08 | 93.78 | 1.29 | 7.32 | 0.21 | 8.30 |
| 8 | 1422.96 | 92.33 | 0.7 | 12.40 | 0.12 | 16.35 |
| 16 | 710.12 | 86.36 | 0.66 | 14.14 | 0.06 | 16.86 |
| 24 | 475.57 | 64.22 | 0.63 | 17.32 | 0.04 | 21.83 |
| 32 | 350.83 | 54.23 | 0.61 | 20.44 | 0.03 | 30.68 |
EOF
    for room in $ROOMS; do
        size=${room%%:*} epsilon=${room#*:}
        measure "$size" "$size" "$epsilon"
        table "$size" "$epsilon" "today" 2e-6 1e10
        table "$size" "$epsilon" "Ethernet" 1e-4 1e7
    done
} >"$OUT.new"
mv "$OUT.new" "$OUT"
cat "$OUT"
