# make ablation: each idea of phr off and on at equal error: docs/ablation.md.
#
# Every variant runs with one epsilon after the other, from 1e-2 down, until its error
# is below that of the table or a run takes more than SECONDS_MOST seconds. Counts
# between two runs are interpolated, logarithm by logarithm, at the last pair of runs
# between which the error comes below. The error is the RMS at the leaves, relative to
# the reflected light (tests/bench/measure.c); that of pictures, where pictures are told
# of. References are small, and kept under $BUILD/ablation. About three minutes on two
# cores.
# Knobs: SCENES, as NAME:PERCENT, with the error of the table; EPSILONS; PAIRS, of
# epsilon and rays of the final gather; OUT, the file.
set -eu
: "${BUILD:=build/mpi}" "${MPIEXEC:=mpiexec}" "${OUT:=docs/ablation.md}"
: "${SCENES:=cornell:5 shadow:2 room1000:8 doorway:10}"
: "${EPSILONS:=1e-2 3e-3 1e-3 3e-4 1e-4 3e-5 1e-5 3e-6}" "${SECONDS_MOST:=2}"
: "${PAIRS:=1e-2/16 3e-3/32 1e-3/64 3e-4/128 1e-4/256 3e-5/512}"
. tests/bench/renew.sh
export LC_ALL=C
work=$BUILD/ablation
mkdir -p "$work"

# measured SCENE OPTIONS...: "seconds links rays error", a line of a curve.
measured() {
    scene=$1
    shift
    timeout 30 "$BUILD/measure" "$(file_of $scene)" "$work/$scene.ref" "$@" \
        2>>"$work/log" | awk -F, '{ print $3, $4, $5, $10 }'
}

# curve SCENE ERROR OPTIONS...: the lines of falling epsilons, until the error is less in
# two runs, the light diverges, or runs take too long.
curve() {
    scene=$1 limit=$2 below=0
    shift 2
    case "$*" in
    *--final-gather*) settings=$EPSILONS ;;
    *) settings=$PAIRS ;;
    esac
    for setting in $settings; do
        case $setting in
        */*) line=$(measured $scene "$@" --epsilon ${setting%/*} \
            --final-gather ${setting#*/}) ;;
        *) line=$(measured $scene "$@" --epsilon $setting) ;;
        esac
        [ -n "$line" ] || return 0
        echo "$line"
        below=$(echo "$line" | awk -v n=$below -v e=$limit '{ print $4 < e ? n + 1 : 0 }')
        [ $below -lt 2 ] || return 0
        echo "$line" | awk -v most=$SECONDS_MOST '{ exit $1 > most }' || return 0
    done
}

# at ERROR: of a curve, "links rays seconds" where the error is that, or
# "-", the least error reached, and whether that is less, though not for good.
at() {
    awk -v error="$1" '
        function between(a, b, part) { return exp(log(a) * (1 - part) + log(b) * part) }
        { s[NR] = $1; links[NR] = $2; rays[NR] = $3 + 1; e[NR] = $4 }
        NR == 1 || $4 < least { least = $4 }
        END {
            for (i = NR; i > 0 && e[i] < error; i--)
                ;
            if (i == NR)
                print "-", NR ? least : "none", least < error
            else if (i == 0)
                print links[1], rays[1], s[1]
            else {
                part = log(error / e[i]) / log(e[i + 1] / e[i])
                print between(links[i], links[i + 1], part),
                    between(rays[i], rays[i + 1], part), between(s[i], s[i + 1], part)
            }
        }'
}

# row TEXT ERROR FILE: a curve beside the first one of its scene, "$work/base".
row() {
    at "$2" <"$3" >"$work/own"
    awk -v text="$1" '
        NR == FNR { for (k = 1; k <= 3; k++) base[k] = $k; next }
        base[1] == "-" {
            print "| " text " | the links alone do not reach it | | |"
            next
        }
        $1 == "-" && $2 == "none" { print "| " text " | no result | | |"; next }
        $1 == "-" {
            printf "| %s | %.2g %% at best%s | | |\n", text, 100 * $2,
                $3 ? ", not for good" : ""
            next
        }
        { printf "| %s | %.2f | %.2f | %.2f |\n", text, $1 / base[1], $2 / base[2],
              $3 / base[3] }' "$work/base" "$work/own"
}

# ideas SCENE PERCENT: the table of a scene.
ideas() {
    scene=$1 error=$(awk "BEGIN { print $2 / 100 }")
    half=$(awk "BEGIN { print $error / 2 }")
    curve $scene $half --final-gather 0 >"$work/links"
    at $error <"$work/links" >"$work/base"
    awk -v scene=$scene -v percent=$2 '{
        printf "\n## %s, %g %%\n\n", scene, percent
        printf "Links alone take %.0f links, %.0f rays.\n\n", $1, $2 }' "$work/base"
    echo "| | links | rays | seconds |"
    echo "|---|---|---|---|"
    echo "| links alone | 1 | 1 | 1 |"
    while IFS='|' read -r text options; do
        # Unquoted: one word for each option.
        curve $scene $error $options </dev/null >"$work/curve"
        row "$text" $error "$work/curve"
    done <<END
all pairs of triangles, no tree|--final-gather 0 --linking pairs
split by energy, not by error|--final-gather 0 --oracle bf
the paper's disks, not polygons|--final-gather 0 --form-factor disk
Jacobi, not conjugate residuals|--final-gather 0 --solver jacobi
the paper: all four|--final-gather 0 --paper
END
    curve $scene $half >"$work/curve"
    row "with the final gather" $error "$work/curve"
    at $half <"$work/links" >"$work/base"
    row "the same at half the error" $half "$work/curve"
}

# pictures SCENE: one line; the picture is one of 128 x 128 pixels.
pictures() {
    file=$(file_of $1)
    printf '| %s |' $1
    for options in "--final-gather 0 --flat" "--final-gather 0" "--final-gather 64" \
        "--final-gather 64,pixels"; do
        "$BUILD/measure" $file "$work/$1.ref" --epsilon 1e-3 $options 2>>"$work/log" |
            awk -F, '{ printf " %.1f %% |", 100 * $13 }'
    done
    for gather in 64 64,pixels; do
        ./phr $file --epsilon 1e-3 --final-gather $gather --size 128x128 --samples 1 \
            --quiet -o "$work/picture.pfm" --stats "$work/stats"
        awk '$1 == "\"gathered\":" { gsub(/[^0-9. ]/, ""); print $1, $7 }' "$work/stats"
    done | awk '{ rays[NR] = $1 + $2 } END { printf " %d | %.2f |\n", rays[1],
        rays[2] / rays[1] }'
}

# balance SCENE: one line.
balance() {
    printf '| %s |' $1
    for plan in none greedy default; do
        $MPIEXEC -n 8 ./phr "$(file_of $1)" --final-gather 0 --epsilon 1e-4 --quiet \
            --balance $plan --stats "$work/stats"
        awk '/"work_max":/ {
                split($0, part, /"work_max": |, "work_mean": /)
                most += part[2]; mean += part[3]
            }
            /"sent": \[/ { gsub(/[^0-9,]/, ""); n = split($0, sent, ",")
                for (k = 1; k <= n; k++) moved += sent[k] }
            END { printf " %.0f %% | %d |", 100 * mean / most, moved }' "$work/stats"
    done
    echo
}

for entry in $SCENES; do
    make_reference ${entry%:*} 5000 500
done
[ -f "$OUT" ] || cp docs/ablation.md "$OUT"
{
    for entry in $SCENES; do
        ideas ${entry%:*} ${entry#*:}
    done
    echo
} >"$work/made"
renew "$OUT" '`room1000` is' "## Pictures" <"$work/made"
{
    echo "|---|---|---|---|---|---|---|"
    for entry in $SCENES; do
        pictures ${entry%:*}
    done
    echo
} >"$work/made"
renew "$OUT" "| scene | flat |" "## Balance" <"$work/made"
{
    echo "|---|---|---|---|---|---|---|"
    for entry in $SCENES; do
        balance ${entry%:*}
    done
} >"$work/made"
renew "$OUT" "| scene | none |" <"$work/made"
cat "$OUT"
