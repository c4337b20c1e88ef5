# make tables: Tables 1 and 2 and Fig. 3 of the paper beside phr's, in docs/tables.md and
# docs/fig3.svg.
#
# phr runs with --paper on 4 to 32 processes, which may share a few cores: counts do not
# depend on the clock. Seconds are counts times prices, of messages and bytes those of a
# network, of work those of runs on one rank, and on two for lists of who needs what:
# seconds of the clock, of one rank times the share of a processor that the run had. These
# runs are repeated, room after room, and the median counts. All pairs are linked once, on
# one rank; the other runs load the links. Runs that load them and end tell what of the
# messages is for loading.
# Knobs: ROOMS, as SIZE:EPSILON; RANKS; TURNS, runs for prices; OUT, the page; FIG3, the
# figure.
set -eu
: "${BUILD:=build/mpi}" "${MPIEXEC:=mpiexec}" "${OUT:=docs/tables.md}"
: "${ROOMS:=6350:1e-6 31933:1e-6 18510:1e-6}" "${RANKS:=4 8 16 24 32}"
: "${TURNS:=1 2 3}" "${FIG3:=docs/fig3.svg}"
. tests/bench/renew.sh
work=$BUILD/tables
mkdir -p "$work"
cp scenes/room.mtl "$work"
rm -f "$work"/*.obj "$work"/*.links "$work"/*.*.*
only_linking="--max-level 0 --max-iterations 1"
most=${RANKS##* }

# each_room COMMAND: with $size, $name and the arguments of a run in $run.
each_room() {
    for room in $ROOMS; do
        size=${room%%:*} name=$work/$size
        run="$name.obj --paper --epsilon ${room#*:}"
        "$1"
    done
}

# $name.links: those of all pairs; $name.one.linking: of the run that makes them and ends.
link_once() {
    build/room "$size" 1 >"$name.obj"
    (TURNS=linking && run_alone "$name" $run $only_linking --save-links "$name.links") &
    linking="${linking-} $!"
}

run_once() (
    run="$run --load-links $name.links --quiet"
    TURNS=$turn
    run_alone "$name" $run
    $MPIEXEC -n 2 ./phr $run --stats "$name.two.$turn"
)

# $name.loading.RANKS, and $name.BALANCE.RANKS.
run_on_ranks() {
    for ranks in $RANKS; do
        on_ranks="$MPIEXEC -n $ranks ./phr $run --load-links $name.links --quiet"
        $on_ranks $only_linking --stats "$name.loading.$ranks"
        for balance in greedy none; do
            $on_ranks --balance $balance --stats "$name.$balance.$ranks"
        done
    done
}

each_room link_once
for process in $linking; do
    wait "$process"
done
for turn in $TURNS; do
    each_room run_once
done
each_room run_on_ranks
rm "$work"/*.links
first=$work/${ROOMS%%:*}
$MPIEXEC -n "$most" ./phr "$first.obj" --paper $only_linking --quiet \
    --stats "$first.most.linking"

awk -v rooms="$ROOMS" -v on="1 $RANKS" -v turns="$TURNS" -v figure="$work/figure" \
    -f tests/bench/tables.awk "$work"/*.*.* >"$work/made"
[ -f "$OUT" ] || cp docs/tables.md "$OUT"
renew "$OUT" "## phr's" <"$work/made"

# Fig. 3: speed-ups without linking, the paper's by the page.
{
    awk -F '[| ]+' '
        /^The paper.s Table 1/ { paper = 1 }
        /^.On one rank/ { paper = 0 }
        paper && NF == 9 && $2 ~ /^[0-9]+$/ {
            print "room_320", $2, $4
            print "room_380", $2, $6
            print "room_420", $2, $8
        }' "$OUT"
    cat "$work/figure"
} | awk -v title="Speed-up without initial linking" -v xlabel=processors \
    -v ylabel=speed-up -f docs/course/chart.awk >"$FIG3"
cat "$OUT"
