# viewfactors --validate: all form factors are as good as stated, the table has what it
# should have, and it is the same with any number of ranks.

. tests/tap.sh

"$BUILD/viewfactors" --validate >"$work/table" 2>"$work/errors"
check "--validate succeeds" [ $? -eq 0 ]
check "silently" [ ! -s "$work/errors" ]
check "and says so in its last line" [ "$(tail -n 1 "$work/table")" = "all as stated" ]
check "81 pairs" [ "$(grep -cE '^[PLWSGFZE][0-9][0-9] ' "$work/table")" -eq 81 ]
check "10 points" [ "$(grep -cE '^(wall|floor), [yz] = ' "$work/table")" -eq 10 ]
check "8 stated lines, each passed" \
    [ "$(grep -c ' pass$' "$work/table")" -eq 8 ]
check "nothing fails" [ "$(grep -cE 'FAIL|[+-]nan|[+-]inf' "$work/table")" -eq 0 ]

# Opposed unit squares one apart have F = 0.199825, and the solver's 16 rays make it 2.08
# % too much.
line='^P01 opposed unit squares, distance 1 +0\.199825 +0\.707 +'
line=$line'\(\+15\.89 %\) +\(\+2\.08 %\) +-3e-04'
check "a line to be trusted" grep -qE "$line" "$work/table"

# Each rank writes into one file: only one of them may print.
$MPIEXEC -n 3 "$BUILD/viewfactors" --validate >"$work/three" 2>&1
check "3 ranks succeed" [ $? -eq 0 ]
check "and print one table" cmp -s "$work/table" "$work/three"

tap_done
