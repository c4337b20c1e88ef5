# Golden pictures: the cases of tests/golden/cases, made anew on two ranks and compared
# with tests/golden/NAME.pfm. A picture beyond its tolerance stays in $BUILD/golden, with
# the difference as NAME.diff.ppm, scaled so that its largest sample is white. `make
# golden` renews the expected ones.
. tests/tap.sh

made=$BUILD/golden
rm -rf "$made"

sh tests/golden.sh "$made" $MPIEXEC -n 2 "$PHR"

# is_golden NAME TOLERANCE: the picture made is the expected one.
is_golden() {
    if "$IMGDIFF" "$made/$1.pfm" "tests/golden/$1.pfm" --tolerance "$2" \
        -o "$made/$1.diff.ppm" >"$work/$1.log" 2>&1; then
        rm -f "$made/$1.diff.ppm"
        return 0
    fi
    echo "# made: $made/$1.pfm, expected: tests/golden/$1.pfm,"
    echo "# difference: $made/$1.diff.ppm"
    sed 's/^/# /' "$work/$1.log"
    return 1
}

cases=$(grep '^[^#]' tests/golden/cases | cut -d ' ' -f 1,2 | tr ' ' :)
for case in $cases; do
    check "${case%:*}, tolerance ${case#*:}" is_golden "${case%:*}" "${case#*:}"
done
check "all expected pictures have a case" \
    [ "$(ls tests/golden/*.pfm | wc -l)" -eq "$(echo "$cases" | wc -l)" ]

# The test can fail: one picture at a slightly other epsilon, judged by the same rule.
$MPIEXEC -n 2 "$PHR" --quiet scenes/cornell.obj --view tests/golden/cornell.view \
    --paper --epsilon 3.3e-4 -o "$work/planted.pfm"
"$IMGDIFF" "$work/planted.pfm" tests/golden/paper.pfm >"$work/planted" 2>&1
check "a slightly other epsilon is found out" [ $? -eq 1 ]

tap_done
