# Faults: a rank killed, SIGTERM, a full disk. Each ends without a hang, with an exit
# status that is not 0, and with no file half written; the last checkpoint is whole, and a
# run from it equals an uninterrupted one.
. tests/tap.sh
. tests/faults.sh

# Long enough to be stopped on the way. Six runs go on to its end, in half a minute.
scene="scenes/cornell.obj --epsilon 2e-6 --flat --size 20x20 --final-gather 8"

# A launcher that was sent a signal may end with 0 whatever its ranks end with: then the
# message of phr counts.
was_stopped() {
    [ "$status" != hang ] &&
        [ "$(grep -c '^[a-z]*: stopped by SIGTERM' "$work/err")" -eq 1 ]
}

# goes_on CHECKPOINT: the run resumed from it equals the whole run.
goes_on() {
    $MPIEXEC -n 3 "$PHR" $scene --quiet --resume "$work/$1" -o "$work/on.pfm" \
        -o "$work/on.ply" \
        --stats "$work/on.json" || return 1
    cmp "$work/on.pfm" "$work/whole.pfm" && cmp "$work/on.ply" "$work/whole.ply" ||
        return 1
    for key in checksum links patches passes iterations rays node_tests; do
        [ "$(stat_of "$work/on.json" $key)" = "$(stat_of "$work/whole.json" $key)" ] ||
            return 1
    done
}

links="the light is that of the links there were"
# shows NEW WHOLE BLOCKS: a picture that is about right, as one of links is, by one ray a
# pixel: found .09. (A black one is off by 1.)
shows() {
    [ -z "$(find "$work" -name 'new.*.tmp')" ] &&
        build/imgdiff "$work/$1" "$work/$2" --blocks $3 --below 2 --rms .2 \
            >"$work/diff" && rm "$work/$1"
}

$MPIEXEC -n 2 "$PHR" $scene --quiet -o "$work/whole.pfm" -o "$work/whole.ply" \
    --stats "$work/whole.json"

# --- a rank is killed ---

# Under a launcher the others are ended by it; alone there is none.
start 2 $scene -o "$work/new.pfm" --checkpoint "$work/check"
check "a checkpoint comes before the end" wait_for 2 " split)"
kill -9 "$(tail -n 1 "$work/ranks")"
finish
check "a rank is killed: no hang, and not 0 ($status)" \
    [ "$status" != 0 ] && [ "$status" != hang ]
check "all ranks are gone" ranks_are_gone
check "no output" [ ! -e "$work/new.pfm" ]
rm -f "$work"/new.*.tmp "$work"/check.*.tmp
check "the checkpoint is whole" goes_on check

# --- SIGTERM ---

start 3 $scene -o "$work/new.pfm" --checkpoint "$work/check"
check "a run to be stopped has begun" wait_for 1 " split)"
kill -TERM "$launched"
finish
check "SIGTERM to the launcher ends the run ($status); one rank says so" was_stopped
check "and how to go on" \
    grep -q "^phr: stopped by SIGTERM: $links; go on with --resume " "$work/err"
check "there is a picture of the links" shows new.pfm whole.pfm 4
check "the checkpoint is whole" goes_on check

start 2 $scene -o "$work/new.pfm"
wait_for 1 " split)"
kill -TERM "$launched"
finish
check "SIGTERM without a checkpoint ends it too ($status)" was_stopped
check "it names the signal, and the light" \
    grep -q "^phr: stopped by SIGTERM: $links\$" "$work/err"
check "there is a picture" shows new.pfm whole.pfm 4

large="scenes/cornell.obj --epsilon 1e-3 --size 1000x1000"
"$PHR" $large --samples 1 --quiet -o "$work/one.ppm"
start 2 $large --samples 32 -o "$work/new.ppm" --checkpoint "$work/check"
wait_for 1 "(0 split)"
begun=$(date +%s)
kill -TERM "$launched"
finish
check "SIGTERM while a picture is made ends it ($status)" was_stopped
check "soon" [ $(($(date +%s) - begun)) -lt 10 ]
check "there is a picture of what was done" shows new.ppm one.ppm 20
check "it goes on from the checkpoint of the solution" \
    grep -q "^phr: stopped by SIGTERM: .*; go on with --resume $work/check\$" "$work/err"

# stopped_early NAME: the run is stopped before its first checkpoint.
stopped_early() {
    kill -TERM "$launched"
    finish
    check "SIGTERM $1 ends it ($status)" was_stopped
    check "it does not say how to go on" grep -q ': stopped by SIGTERM$' "$work/err"
    check "nothing is printed" [ ! -s "$work/out" ]
    check "nothing is written" [ ! -e "$work/new.ppm" -a ! -e "$work/early" ]
    check "all ranks are gone" ranks_are_gone
}

# Opening a pipe waits for phr, writing to it for phr to read. (Other loops that break
# off: tests/whole/stop.c.)
cp scenes/room.mtl "$work"
mkfifo "$work/pipe.obj"
start 2 "$work/pipe.obj" -o "$work/new.ppm" --checkpoint "$work/early"
exec 3>"$work/pipe.obj"
cat scenes/cornell.obj >&3
sleep 0.3
stopped_early "while a pipe is read that stays open"
exec 3>&-

start 2 scenes/cornell.obj -o "$work/new.ppm" --resume "$work/pipe.obj"
sleep 2
stopped_early "while a checkpoint is waited for"

# Linking of all pairs takes longer than the three seconds that are allowed.
build/room 16000 1 >"$work/room.obj"
cp scenes/room.mtl "$work"
start 3 "$work/room.obj" --paper -o "$work/new.ppm" --checkpoint "$work/early"
wait_for 1 "; linking"
sleep 0.5
begun=$(date +%s)
kill -TERM "$(tail -n 1 "$work/ranks")"
finish
check "SIGTERM to one rank while roots are linked: exit status 1 ($status)" \
    [ "$status" -eq 1 ]
check "within 3 s" [ $(($(date +%s) - begun)) -le 3 ]
check "before roots are linked" [ "$(grep -c 'roots are linked' "$work/err")" -eq 0 ]
check "it does not say how to go on" grep -q '^phr: stopped by SIGTERM$' "$work/err"
check "for there is nothing" [ ! -e "$work/early" -a ! -e "$work/new.ppm" ]

# --- a full disk ---

# A limit of the size of files takes the place of a disk that fills up half way: the
# checkpoint of the first pass fits, that of the second does not. (MPI's shared memory has
# to fit as well.)
$MPIEXEC -n 2 \
    sh -c 'ulimit -f 10000; exec 2>>"$0/full.err"; exec "$@"' "$work" "$PHR" $scene \
    --quiet -o "$work/new.pfm" --checkpoint "$work/full" >/dev/null 2>&1
status=$?
check "a disk that fills up: exit status 1" [ "$status" -eq 1 ]
check "one line says which file" \
    [ "$(cat "$work/full.err")" = "phr: $work/full: cannot write: File too large" ]
check "the run goes on all the same" cmp "$work/new.pfm" "$work/whole.pfm"
check "nothing is left beside the checkpoint" [ -z "$(find "$work" -name '*.tmp')" ]
rm -f "$work/new.pfm"
check "which is the one before, whole" goes_on full

if [ -c /dev/full ]; then
    $MPIEXEC -n 2 sh -c 'exec 2>"$0/full.err"; exec "$@"' "$work" "$PHR" \
        scenes/cornell.obj --max-level 2 --quiet --paper --save-links /dev/full \
        >/dev/null 2>&1
    status=$?
    check "--save-links on a full device: exit status 1" [ "$status" -eq 1 ]
else
    tap 0 "a full device # SKIP there is no /dev/full"
fi

tap_done
