# The pace: instructions of the runs of tests/pace/figures, beside their figures. Seconds
# are noisy; instructions repeat to one in ten thousand. They depend on the compiler and
# its options, so phr of another compiler is not judged. With RENEW=yes (`make pace`) what
# the runs take now becomes what is expected. Half a minute: callgrind is 50 times as slow
# as the processor.

. tests/tap.sh

figures=tests/pace/figures
# Times its figure. A run has 1 % of its instructions in the libraries of C and MPI, which
# differ with the machine; more than twice that is phr's own. A run that takes 5 % less
# is worth a new figure.
slower=1.02
faster=0.95

case $PHR in /*) ;; *) PHR=$PWD/$PHR ;; esac
cp scenes/*.obj scenes/*.mtl scenes/*.view "$work"
build/room 1000 1 >"$work/room.obj"

# millions ARGUMENTS...: the instructions of a run, in millions; 0 if it fails.
millions() (
    cd "$work" &&
        valgrind --tool=callgrind --callgrind-out-file=counts \
            --toggle-collect=compute_light --toggle-collect=results_show \
            "$PHR" --quiet "$@" >log 2>&1 || >log
    awk '$2 == "Collected" { count = $4 } END { printf "%.1f\n", count / 1e6 }' log
)

# keeps_pace FIGURE NOW: the run is not slower; tells where it is faster.
keeps_pace() {
    ! holds "$2 < $faster * $1" || echo "# $2 million, figure $1: faster"
    holds "$2 > 0 && $2 <= $slower * $1"
}

# compare FIGURE ARGUMENTS...: one run beside its figure.
compare() {
    figure=$1
    shift
    now=$(millions "$@" </dev/null)
    check "$now million instructions, figure $figure: $*" keeps_pace "$figure" "$now"
}

# renew: the lines of the figures with those of now.
renew() {
    sed -n '/^#/p' $figures
    echo "compiler $compiler"
    grep '^[0-9]' $figures | while read -r figure arguments; do
        echo "$(millions $arguments </dev/null) $arguments"
    done
}

compiler=$(strings "$PHR" | grep '^GNU C' | sort -u)
if ! command -v valgrind >/dev/null; then
    tap 0 "the pace # SKIP there is no valgrind"
elif [ "${RENEW:-no}" = yes ]; then
    renew >"$work/figures" && mv "$work/figures" $figures
elif [ "compiler $compiler" != "$(grep '^compiler' $figures)" ]; then
    tap 0 "the pace # SKIP the figures are of another compiler, or of other options"
else
    grep '^[0-9]' $figures >"$work/runs"
    while read -r figure arguments; do
        compare "$figure" $arguments
    done <"$work/runs"
    # The test can fail: the first run with an eighth more rays, by the same rule.
    read -r figure arguments <"$work/runs"
    now=$(millions $(echo "$arguments" | sed 's/final-gather 32/final-gather 36/'))
    keeps_pace "$figure" "$now"
    check "an eighth more rays are found out: $now" [ $? -eq 1 ]
fi

tap_done
