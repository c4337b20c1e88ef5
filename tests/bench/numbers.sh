# make numbers: half and twice of each tuned number: the rows of docs/numbers.md.
#
# In a copy of the sources each number is halved and doubled, and scenes are solved at
# three epsilons. References are those of `make ablation`. About half an hour.
# Knobs: SCENES, EPSILONS, RAYS; OUT, the page.
set -eu
: "${BUILD:=build/mpi}" "${MPIEXEC:=mpiexec}" "${MAKE:=make}" "${OUT:=docs/numbers.md}"
: "${SCENES:=cornell corridor room1000}" "${EPSILONS:=8e-4 1e-3 1.25e-3}" "${RAYS:=64}"
export LC_ALL=C
. tests/bench/renew.sh
work=$PWD/$BUILD/ablation
mkdir -p "$work"
for scene in $SCENES; do
    make_reference $scene 5000 500
done
references=$work work=$PWD/$BUILD/numbers
rm -rf "$work/copy" && mkdir -p "$work/copy"
cp -R Makefile ./*.[ch] geom octree rad mpi io lib tools scenes tests "$work/copy"

# solve FILE: "SCENE error work" of the copy, a line for each scene.
solve() {
    : >"$1"
    (cd "$work/copy" && $MAKE -s BUILD=build build/measure) >"$work/log" 2>&1 || return 0
    for scene in $SCENES; do
        for epsilon in $EPSILONS; do
            "$work/copy/build/measure" "$(work=$references file_of $scene)" \
                "$references/$scene.ref" --epsilon $epsilon --final-gather $RAYS \
                2>/dev/null
        done | awk -F, -v scene=$scene '{ square += $10 * $10; work += $NF }
            END { if (NR) print scene, sqrt(square / NR), work / NR }'
    done >"$1"
}

# compared FILE: with "$work/base", where squared error times work differs most.
compared() {
    awk 'NR == FNR { error[$1] = $2; work[$1] = $3; next }
        {
            off = (2 * log($2 / error[$1]) + log($3 / work[$1])) ^ 2
            if (off < most)
                next
            most = off
            word = sprintf("%.2f, %.2f (%s)", $2 / error[$1], $3 / work[$1], $1)
        }
        END { print word == "" ? "no result" : most < 0.01 ? "same" : word }' \
        "$work/base" "$1"
}

# change FILE NAME [FACTOR]: the number in the copy's file, times that. Prints the number.
change() {
    awk -v name="$2" -v factor="${3:-1}" -v out="$work/copy/$1" '
        !done && match($0, "[ {]" name " = [^,;}]*[^,;} ]") {
            own = substr($0, RSTART, RLENGTH)
            value = own
            sub(/.* = /, "", value)
            sub(/ = .*/, " = ", own)
            whole = value ~ /[.p]|e-/ ? "" : "(int)"
            $0 = substr($0, 1, RSTART - 1) own whole "(" factor " * (" value "))" \
                substr($0, RSTART + RLENGTH)
            done = 1
            print value
        }
        { print >out }' "$1"
}

solve "$work/base"
grep '^| `' "$OUT" | while IFS='|' read -r _ name _ unit _ _ file rest; do
    path=$(echo $file | tr -d '`') number=$(echo $name | tr -d '`')
    value=$(change "$path" "$number")
    for factor in 0.5 2; do
        change "$path" "$number" $factor >"$work/log"
        solve "$work/$factor"
    done
    change "$path" "$number" >"$work/log"
    half=$(compared "$work/0.5") twice=$(compared "$work/2")
    echo "|$name| $value |$unit| $half | $twice |$file|$rest|"
done >"$work/rows"
{ sed '/^| `/,$d' "$OUT"; cat "$work/rows"; } >"$work/page" && mv "$work/page" "$OUT"
