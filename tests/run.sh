#!/bin/sh
# Runs all tests: the unit tests named as arguments, the corpora of the fuzz harnesses and
# the scripts tests/[0-9]*.sh, as many at a time as there are cores, the long ones first.
# Each prints TAP lines; failures are shown, the seconds of each test, slowest last, and
# in the last line "N passed, N failed". A test that dies or ends without its plan counts
# as one failure more. Called by `make check`, which sets BUILD, MPIEXEC, MPICC, CC and
# MAKE. With PROVE set, by `make prove`, there are more ranks, compilers and limits.

cd "$(dirname "$0")/.." || exit 2
logs=$BUILD/tests/logs
rm -rf "$logs"
mkdir -p "$logs"
passed=0
failed=0
# Those of more than ten seconds, longest first.
long="58-panel 60-ranks 67-restart 72-faults 56-pace 57-viewfactors 51-storeys"

# judge NAME STATUS SECONDS: shows the verdict on a test from its log, and adds it to the
# counts.
judge() {
    name=$1
    status=$2
    seconds=$3
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
        echo "FAIL $name ($good passed, $bad failed), $seconds s, from $log:"
        grep -v '^ok ' "$log" | tail -n 40
    else
        echo "ok   $name ($good), $seconds s"
    fi
}

# on_ranks TEST RANKS...: lines of a unit test with mpiexec, one for each number of ranks.
on_ranks() {
    program=$1
    shift
    for ranks in "$@"; do
        echo "$program-on-$ranks $MPIEXEC -n $ranks $BUILD/tests/$program"
    done
}

# tests TEST...: a line "NAME COMMAND" for each test, of these unit tests.
tests() {
    for test in "$@"; do
        case $test in
        linking) on_ranks "$test" 1 3 7 ;;
        exchange) on_ranks "$test" 1 2 3 4 7 ${PROVE:+6 8} ;;
        conjugate) on_ranks "$test" 1 3 6 ;;
        exact) on_ranks "$test" 1 3 ;;
        converge)
            scenes=$BUILD/tests
            echo "$test-box $BUILD/tests/$test scenes/cornell.obj"
            echo "$test-room $BUILD/tests/$test $scenes/room.obj"
            echo "$test-shadow $BUILD/tests/$test scenes/shadow.obj $scenes/shadow.ref"
            ;;
        *) echo "$test $BUILD/tests/$test" ;;
        esac
    done
    for harness in tests/fuzz/*.c; do
        format=$(basename "$harness" .c)
        echo "fuzz-$format $BUILD/tests/fuzz/$format tests/fuzz/corpus/$format/*"
    done
    for script in tests/[0-9]*.sh; do
        echo "$(basename "$script" .sh) sh $script"
    done
}

tests "$@" >"$logs/tests"
{ for name in $long; do grep "^$name " "$logs/tests"; done; cat "$logs/tests"; } |
    awk '!dealt[$1]++' >"$logs/dealt"
xargs -P "$(getconf _NPROCESSORS_ONLN || echo 1)" -I LINE sh -c '
    name=${2%% *} begun=$(date +%s)
    timeout -k 10 900 ${2#* } >"$1/$name.tap" 2>&1
    status=$?
    echo "$(($(date +%s) - begun)) $status $name" >>"$1/ended"' sh "$logs" LINE \
    <"$logs/dealt"
sort -n "$logs/ended" >"$logs/sorted"
while read -r seconds status name; do
    judge "$name" "$status" "$seconds"
done <"$logs/sorted"

echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
