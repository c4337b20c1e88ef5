# Of `make scaling`: what ranks do that one rank alone need not do, and the memory that
# they take, in docs/scaling.md. Needs valgrind, and the /proc of Linux.
#
# Instructions of phr's own functions, by callgrind: of one rank alone, and of rank 0 and
# one in the middle of several, where the others run as they are. No load of the machine
# changes them. Memory: RSS counts what ranks share once for each of them, PSS once in all
# (/proc/PID/smaps_rollup, some twenty times a second). What MPI takes by itself is that
# of ranks that wait for rank 0 to read the scene from a pipe.
# Knobs: RUNS, as NAME:TRIANGLES:RANKS:OPTIONS, with a comma for each space of options,
# and an even number of ranks from 4 on; LARGE, a room whose memory is measured;
# SETTINGS, of that; ON, numbers of ranks there, from 1; OUT, the page.
set -eu
: "${BUILD:=build/mpi}" "${MPIEXEC:=mpiexec}" "${OUT:=docs/scaling.md}"
: "${RUNS:=large:31933:32:--epsilon,1e-3,--final-gather,64
    small:6350:16:--epsilon,1e-3,--final-gather,16
    paper:1000:32:--paper,--epsilon,1e-5}"
: "${LARGE:=31933}" "${SETTINGS:=--epsilon 1e-3 --final-gather 16}" "${ON:=1 4 16}"
. tests/bench/renew.sh
work=$BUILD/repeated
rm -rf "$work"
mkdir -p "$work"
cp scenes/*.mtl "$work"

# counted FILE: the command that writes the instructions of a process to a file.
counted() {
    echo "valgrind --tool=callgrind --compress-strings=no --compress-pos=no" \
        "--callgrind-out-file=$work/$1 --log-file=$work/$1.log"
}

# count NAME RANKS ARGUMENTS...: $work/NAME.alone, .first and .middle; the report of the
# run on several ranks is NAME.report.
count() {
    name=$1 half=$(($2 / 2 - 1))
    shift 2
    set -- ./phr "$@" --quiet -o "$work/$name.ply"
    $(counted "$name.alone") "$@" &
    alone=$!
    set -- "$@" -o "$work/$name.many.ply" --stats "$work/$name.report"
    $MPIEXEC -n 1 $(counted "$name.first") "$@" : -n $half "$@" : \
        -n 1 $(counted "$name.middle") "$@" : -n $half "$@"
    wait $alone
}

# start RANKS ARGUMENTS...: begins a run, $run; $pids has a line for each rank.
start() {
    ranks=$1 pids=$work/pids
    shift
    : >"$pids"
    $MPIEXEC -n "$ranks" sh -c 'echo $$ >>"$0"; exec ./phr "$@" --quiet' "$pids" "$@" &
    run=$!
    while [ "$(wc -l <"$pids")" -lt "$ranks" ]; do
        sleep 0.1
    done
}

# proportional: the kB of PSS of these processes now; those that have ended have none.
proportional() {
    sed 's,.*,/proc/&/smaps_rollup,' "$pids" | xargs cat 2>/dev/null |
        awk '/^Pss:/ { sum += $2 } END { print sum + 0 }'
}

# weigh RANKS: a line with MB: RSS by the report, the most PSS, and the PSS of MPI alone.
weigh() {
    rm -f "$work/pipe.obj"
    mkfifo "$work/pipe.obj"
    start "$1" "$work/pipe.obj" --paper --epsilon 1
    sleep 2
    waiting=$(proportional)
    cat scenes/squares.obj >"$work/pipe.obj"
    wait $run
    # Unquoted: one word for each option.
    start "$1" "$work/weighed.obj" $SETTINGS -o "$work/weighed.ply" \
        --stats "$work/weighed.json"
    while kill -0 $run 2>/dev/null; do
        proportional
        sleep 0.05
    done | sort -n | tail -n 1 >"$work/most"
    wait $run
    rss=$(sed -n 's/.*"peak_rss_bytes_sum": \([0-9]*\).*/\1/p' "$work/weighed.json")
    echo "$1 $((rss / 1000)) $(cat "$work/most") $waiting"
}

# Splits an entry of RUNS at its colons.
for entry in $RUNS; do
    name=${entry%%:*} rest=${entry#*:}
    options=${rest#*:*:} rest=${rest%:"$options"}
    build/room "${rest%:*}" 1 >"$work/$name.obj"
    count "$name" "${rest#*:}" "$work/$name.obj" $(echo "$options" | tr , ' ')
done
{
    echo
    awk -v runs="$RUNS" -v work="$work" -f tests/bench/repeated.awk
    echo
} >"$work/made"
renew "$OUT" "## What ranks repeat" "## Memory" <"$work/made"
build/room "$LARGE" 1 >"$work/weighed.obj"
{
    echo
    echo "MB of all ranks, room of $(grep -c '^f' "$work/weighed.obj") triangles," \
        "\`$SETTINGS -o room.ply\`. RSS has what" \
        "ranks share once for each of them, PSS once in all:"
    echo
    echo "| ranks | RSS | PSS | of these MPI's | PSS, of one rank |"
    echo "|---|---|---|---|---|"
    for ranks in $ON; do
        weigh "$ranks"
    done | awk '{
        if (NR == 1) { most = $3 }
        printf "| %d | %d | %d | %d | %.2g |\n", $1, $2 / 1e3, $3 * 1.024e-3,
            $4 * 1.024e-3, $3 / most
    }'
} >"$work/made"
renew "$OUT" "## Memory" <"$work/made"
cat "$OUT"
