#!/bin/sh
# Runs all tests: the unit tests named as arguments, the corpora of the fuzz harnesses and
# the scripts tests/[0-9]*.sh, as many at a time as there are cores, but for those that
# run many ranks for long or have limits of time, one by one after them. Each prints TAP
# lines; failures are shown, and the last line is "N passed, N failed". A test that dies
# or ends without its plan counts as one failure more. Called by `make check`, which sets
# BUILD, MPIEXEC, MPICC, CC and MAKE.

cd "$(dirname "$0")/.." || exit 2
logs=$BUILD/tests/logs
rm -rf "$logs"
mkdir -p "$logs"
passed=0
failed=0
apart="60-ranks 67-restart 70-errors 72-faults 74-pipes"

# judge NAME STATUS: shows the verdict on a test from its log, and adds it to the counts.
judge() {
    name=$1
    status=$2
    log=$logs/$name.tap
    good=$(grep -c '^ok ' "$log")
    bad=$(grep -c '^not ok ' "$log")
    grep -q '^1\.\.[0-9]' "$log" ||
        { bad=$((bad + 1)); echo "# $name ended without its plan"; }
    if [ "$status" != 0 ] && [ "$bad" -eq 0 ]; then
        bad=1
        echo "# $name: exit status $status"
    fi
    passed=$((passed + good))
    failed=$((failed + bad))
    grep '^# ' "$log"
    if [ "$bad" -gt 0 ]; then
        echo "FAIL $name ($good passed, $bad failed), from $log:"
        grep -v '^ok ' "$log" | tail -n 40
    else
        echo "ok   $name ($good)"
    fi
}

# run NAME COMMAND...: runs one test.
run() {
    name=$1
    shift
    timeout -k 10 900 "$@" >"$logs/$name.tap" 2>&1
    judge "$name" $?
}

# run_together FILE: runs the tests of the file's lines, "NAME COMMAND", side by side.
run_together() {
    xargs -P "$(getconf _NPROCESSORS_ONLN || echo 1)" -I LINE sh -c '
        log=$1/${2%% *}
        timeout -k 10 900 ${2#* } >"$log.tap" 2>&1
        echo $? >"$log.status"' sh "$logs" LINE <"$1"
    while read -r name command; do
        judge "$name" "$(cat "$logs/$name.status")"
    done <"$1"
}

# run_on_ranks NAME P...: the unit test NAME with mpiexec, once for each number of ranks.
run_on_ranks() {
    program=$1
    shift
    for ranks in "$@"; do
        run "$program-on-$ranks" $MPIEXEC -n "$ranks" "$BUILD/tests/$program"
    done
}

{
    for test in "$@"; do
        case $test in
        linking | exchange | conjugate | exact | converge) ;;
        *) echo "$test $BUILD/tests/$test" ;;
        esac
    done
    for harness in tests/fuzz/*.c; do
        format=$(basename "$harness" .c)
        echo "fuzz-$format $BUILD/tests/fuzz/$format tests/fuzz/corpus/$format/*"
    done
    for script in tests/[0-9]*.sh; do
        name=$(basename "$script" .sh)
        case " $apart " in
        *" $name "*) ;;
        *) echo "$name sh $script" ;;
        esac
    done
} >"$logs/together"
run_together "$logs/together"
for test in "$@"; do
    case $test in
    linking) run_on_ranks "$test" 1 3 7 ;;
    exchange) run_on_ranks "$test" 1 2 3 4 6 7 8 ;;
    conjugate) run_on_ranks "$test" 1 3 6 ;;
    exact) run_on_ranks "$test" 1 3 ;;
    converge)
        cp scenes/room.mtl "$BUILD/tests"
        build/room 1000 1 >"$BUILD/tests/room.obj"
        "$BUILD/direct" scenes/shadow.obj "$BUILD/tests/shadow.ref" 10000
        run "$test" $MPIEXEC -n 2 "$BUILD/tests/$test" "$BUILD/tests/room.obj" \
            "$BUILD/tests/shadow.ref"
        ;;
    esac
done
for name in $apart; do
    run "$name" sh "tests/$name.sh"
done

echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
