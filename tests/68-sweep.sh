# 40 runs of options drawn at random on five odd scenes; others with another SEED, more
# with RUNS. Whatever is asked for, what is printed and written has to hold together. A
# run takes .3 s.

. tests/tap.sh

: "${RUNS:=40}" "${SEED:=1}"
case $PHR in /*) ;; *) PHR=$PWD/$PHR ;; esac
mkdir "$work/scenes"

# --- scenes: a box with a lamp in its ceiling, and what makes it odd ---

cat >"$work/scenes/m.mtl" <<END
newmtl white
Kd 0.7 0.6 0.5
newmtl lamp
Kd 0.1 0.1 0.1
Ke 10 8 6
END
lamp='usemtl lamp
v .4 .4 .999
v .6 .4 .999
v .6 .6 .999
v .4 .6 .999
f -4 -1 -2 -3'
# scene NAME LINES: the box with its lamp, and these lines.
scene() {
    { printf 'mtllib m.mtl\nusemtl white\n' && box 1 1 1 && echo "$2" && echo "$lamp"; } \
        >"$work/scenes/$1.obj"
}
scene closed ""
scene open ""
sed -i '/^f 1 3 7 5/d' "$work/scenes/open.obj"
scene doubles "f 2 4 3 1
f 7 5 1 3"
scene overlaps "v .2 .2 0
v .9 .2 0
v .9 .9 0
f -3 -2 -1"
scene two-sided "v .2 .2 .5
v .8 .3 .5
v .5 .8 .5
f -3 -2 -1
f -3 -1 -2"

# --- options: a line for each run, RANKS SCENE OPTIONS ---

# Each line is a choice: how often it is made, and between what.
cat >"$work/choices" <<END
1 1|1|2|3
1 closed|open|doubles|overlaps|two-sided
.9 --epsilon 1|--epsilon 1e-1|--epsilon 1e-2|--epsilon 3e-3
.6 --final-gather 0|--final-gather 8|--final-gather 33
.1 --final-gather pixels|--final-gather 8,pixels
.1 --paper|--linking pairs
.3 --oracle bf|--form-factor disk|--solver jacobi
.1 --alpha 0|--balance none|--balance greedy
.3 --two-sided|--two-sided-lamps|--two-sided --two-sided-lamps
.3 --max-level 0|--max-level 3|--min-area 0.01|--min-area 1
.1 --max-iterations 1|--max-iterations 3
.1 --tolerance 0.1|--tolerance 1
.1 --accuracy 30%|--memory 100K|--memory 1G
.1 --flat|--exposure 2|--verbose|--ke radiance
.1 --show mesh|--show level|--show error|--show owner
.1 --checkpoint run.check|--save-links run.links
.8 -o a.ppm|-o a.pfm|-o a.png|-o a.hdr|-o ppm:b
.5 -o a.ply|-o a.vtk|-o a.ply -o a.vtk|-o vtk:c
END
awk -v runs="$RUNS" -v seed="$SEED" '
    { chance[NR] = $1; sub(/^[^ ]* /, ""); choices[NR] = $0 }
    END {
        srand(seed)
        for (; runs > 0; runs--) {
            for (i = 1; i <= NR; i++)
                if (rand() < chance[i]) {
                    count = split(choices[i], choice, "|")
                    printf "%s ", choice[1 + int(rand() * count)]
                }
            print ""
        }
    }' "$work/choices" >"$work/runs"

# --- runs ---

# sums: reads the powers of --stats, and judges them and the words beside them.
sums() {
    emitted=$(stat_of stats emitted_power) absorbed=$(stat_of stats absorbed_power)
    escaped=$(stat_of stats escaped_power) tolerance=${options##*--tolerance }
    [ "$tolerance" != "$options" ] || tolerance=0
    tolerance=${tolerance%% *}
    converged=$(grep -c '"converged": true' stats)
    warned=$(grep -cE 'warning: .*(emitted|lost|balance|escape|memory|converged)' log)
    awk "BEGIN {
        e = $emitted; a = $absorbed; s = $escaped
        if (!(e > 0) || a < 0) exit 1
        if ($converged && (a + s - e)^2 > ((2e-3 + $tolerance) * e)^2) exit 1
        if ((a > 1.01 * e || s < -0.01 * e) && !$warned) exit 1
        if (a > 1.5 * e && $status == 0) exit 1
    }"
}

# leaves: no radiosity is negative in the patches that are printed.
leaves() {
    awk '/^[0-9]+\// { count++; wrong += !($5 >= 0 && $6 >= 0 && $7 >= 0) }
         END { exit wrong || !count }' patches
}

# files: those that were asked for are there, not empty, and no others.
files() {
    expected="patches log stats"
    for word in $options; do
        case $word in
        ppm:b) expected="$expected b" ;;
        vtk:c) expected="$expected c" ;;
        a.* | run.*) expected="$expected $word" ;;
        esac
    done
    for file in *; do
        case " $expected " in *" $file "*) ;; *) return 1 ;; esac
    done
    for file in $expected; do
        case $file in log | run.*) continue ;; esac # these may be empty, or not there
        [ -s "$file" ] || return 1
    done
}

# judge: sets `fault` to the first thing that does not hold.
judge() {
    fault=
    case $status in
    0 | 1) ;;
    2)
        [ "$(grep -c '^phr: ' log)" -ge 1 ] || fault="no word about bad usage"
        [ "$(echo *)" = "log patches" ] || fault="files in spite of bad usage"
        return ;;
    *) fault="exit status $status"; return ;;
    esac
    sums || fault="the sums: $emitted W, $absorbed W, $escaped W"
    [ "$status" -eq 1 ] && return
    leaves || fault="radiosities"
    files || fault="files: $(ls | tr '\n' ' ')"
}

seen_0=0 seen_1=0 seen_2=0 faults=0
(cd "$work/scenes" && cksum *) >"$work/before"
top=$PWD
while read -r ranks scene options; do
    rm -rf "$work/run" && mkdir "$work/run" && cd "$work/run" || exit 1
    launch="$MPIEXEC -n $ranks"
    [ "$ranks" -gt 1 ] || launch=
    $launch "$PHR" "../scenes/$scene.obj" --size 8x8 --samples 1 $options --stats stats \
        --dump patches >patches 2>log </dev/null
    status=$?
    eval "seen_$status=\$((seen_$status + 1))"
    judge
    cd "$top" || exit 1
    if [ -n "$fault" ]; then
        faults=$((faults + 1))
        echo "# $fault: $ranks ranks, $scene $options"
        grep '^phr: ' "$work/run/log" | tail -n 2 | sed 's/^/#   /'
    fi
done <"$work/runs"
(cd "$work/scenes" && cksum *) >"$work/after"

check "$RUNS runs hold together: $seen_0 done, $seen_1 failed, $seen_2 refused" \
    [ "$faults" -eq 0 ]
check "most are done, some refused" holds "$seen_0 > $RUNS / 2 && $seen_2 > 0"
check "the scenes are as they were" cmp "$work/before" "$work/after"
tap_done
