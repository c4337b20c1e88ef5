# The course: commands print what the chapters show, exercises fail until they are solved,
# the text names what is there, radiosity.c stands alone and agrees with phr, and the
# scenes for lectures have the light of scenes/answers.csv.

. tests/tap.sh

course=docs/course
grep -q 'MPI build' <<END && is_parallel=yes || is_parallel=
$(./phr --version)
END

# --- chapters ---

for chapter in $course/[0-9]*.md; do
    name=$(basename "$chapter" .md)
    if [ -z "$is_parallel" ] && grep -q mpiexec "$chapter"; then
        tap 0 "$name: commands # SKIP without MPI"
        continue
    fi
    BUILD=$BUILD CC=$MPICC sh $course/run.sh "$chapter" >"$work/$name" 2>&1
    status=$?
    sed 's/^/# /' "$work/$name"
    tap $status "$name: its commands print what it shows"
done
[ -e "$chapter" ] || tap 1 "there are chapters"

# --- ten tasks of a student, by commands that were run above ---

# task CHAPTER WORDS NAME: commands of the chapter have these words.
task() {
    tasks=$((tasks + 1))
    sed -n '/^```sh$/,/^```$/p' $course/"$1"-*.md | grep -qF -e "$2"
    tap $? "task $tasks: $3"
}
tasks=0
task 06 '--show links:128,150' "the leaf under a pixel"
task 06 'mine/by_factor.c side_by_factor' "splits by F only"
task 09 'mine/in_blocks.c deal_in_blocks' "a balancing plan of one's own"
task 08 'keys="proxies"' "proxies of each rank"
task 09 'for ranks in 1 2 4 8' "Table 1 of the Cornell box"
task 02 'viewfactors --quiet --dense scenes/squares.obj' "F of two parallel squares"
task 04 'viewfactors --quiet --dense scenes/shadow.obj' "a form factor with a blocker"
task 09 'compare "split by F"' "a golden that fails"
task 08 'cmp build/course/ranks-1.ply build/course/ranks-3.ply' "the same bytes"
task 10 '"paper 1e-5 --paper"' "the paper's method at equal error"
check "and the README has as many" \
    [ "$(sed -n '/^## Ten/,/^## Prog/p' $course/README.md |
        grep -c '| chapter')" -eq $tasks ]

# --- exercises ---

# lines PATTERN FILE: how many there are.
lines() {
    grep -c "$1" "$2"
}

for test in $course/exercises/*-test.c; do
    number=$(basename "$test" -test.c)
    BUILD=$BUILD CC=$MPICC sh $course/exercise.sh "$number" solutions >"$work/solved" 2>&1
    check "exercises $number: the solutions are right" [ $? -eq 0 ]
    asked=$(sed '1,/^## Exercises/d' $course/"$number"-*.md | grep -c '^[0-9]\. ')
    check "exercises $number: each of the $asked in the text has a test" \
        [ "$asked" -eq "$(lines '^ok' "$work/solved")" ]
    # A reader's own answers are no failure.
    if ! git diff --quiet -- "$course/exercises/$number.c" 2>/dev/null; then
        tap 0 "exercises $number # SKIP they are being worked on"
        continue
    fi
    BUILD=$BUILD CC=$MPICC sh $course/exercise.sh "$number" >"$work/open" 2>&1
    check "exercises $number: all fail until they are solved" \
        [ "$(lines '^not ok' "$work/open")" -eq "$asked" ]
done

# --- check ---

check "chapter 2 has sixteen pairs" [ "$($course/check 2 | grep -c '^[A-Z]')" -eq 17 ]
# checked N TEXT: status 1, and the text.
checked() {
    $course/check "$1" "$work/mine" >"$work/out"
    [ $? -eq 1 ] && grep -qF "$2" "$work/out"
}
passes() { $course/check "$1" "$work/mine" >"$work/out"; }
awk -F, '{ print $1 "," $3 }' build/course/check.cases >"$work/mine"
check "right factors pass" passes 2
build/oracle/hemicube build/course/check.cases area >"$work/mine"
check "A_i for A_j is named" checked 2 "likeliest slip: A_i for A_j"
build/oracle/hemicube build/course/check.cases pi >"$work/mine"
check "and pi" checked 2 "likeliest slip: pi missing"
printf 'E02,1.5\n' >"$work/mine"
check "and a row above 1" checked 2 "likeliest slip: a row above 1"
build/course/pushpull | awk 'NR > 1 { print "7-" $1 "," $NF }' |
    grep -E '/(|0|3|30|32),' >"$work/mine"
check "push and pull pass" passes 7
sed -e 's/^7-0.,.*/7-0\/,15.8/' -e 's/^7-0.3,.*/7-0\/3,12.8/' "$work/mine" >"$work/sum"
mv "$work/sum" "$work/mine"
check "a pull that sums is named" checked 7 "likeliest slip: children summed"
build/course/plan 10 2 6 2 | awk '{ print "9-" $2 ">" $NF "," $4 }
    END { print "9-imbalance,2" }' >"$work/mine"
check "the greedy plan passes" passes 9
sed -i.old '$d' "$work/mine"
check "a number is missing" checked 9 "not all are there"

# --- names ---

gone=$(grep -ohE '`--[a-z-]+`' $course/*.md | tr -d '`' | sort -u |
    while read -r option; do
        grep -qF -e "$option" io/run/options.c || echo "$option"; done)
check "the options that the course names are there: $gone" [ -z "$gone" ]
missing=$(ls -d $course/* | while read -r file; do
    name=$(basename "$file")
    grep -qF "\`$name" $course/README.md || [ "$name" = README.md ] ||
        [ "${name%.svg}" != "$name" ] || [ "${name%.png}" != "$name" ] ||
        echo "$name"; done)
check "the README of the course has every file: $missing" [ -z "$missing" ]
unseen=$(for figure in $course/*.svg $course/*.png; do
    grep -qF "($(basename "$figure"))" $course/*.md || echo "$figure"; done)
check "each figure is shown: $unseen" [ -z "$unseen" ]

# --- radiosity.c ---

check "radiosity.c has at most 300 lines" [ "$(wc -l <$course/radiosity.c)" -le 300 ]
check "and includes nothing but the standard library" \
    [ "$(lines '^#include' $course/radiosity.c)" -eq \
    "$(lines '^#include <[a-z]*\.h>' $course/radiosity.c)" ]

# agree FILE FILE PART: the numbers behind equal names are alike within this part.
agree() {
    awk -v part="$3" 'NR == FNR { value[$1] = $2; next }
        { d = $2 - value[$1]; seen++
          if (d < 0) d = -d
          if (!(d <= part * value[$1])) { print "# " $1, $2, value[$1]; exit bad = 1 } }
        END { exit bad || seen == 0 }' "$1" "$2"
}

# objects SCENE SOLUTION: the means of phr's solution, to $work/SCENE.
objects() {
    build/course/leaves "$2" | awk -f $course/objects.awk scenes/"$1".obj - >"$work/$1"
}

# solve SCENE OPTIONS...: the same of a new solution.
solve() {
    solve_name=$1
    shift
    ./phr --quiet "$@" scenes/"$solve_name".obj -o "$work/$solve_name.ply"
    objects "$solve_name" "$work/$solve_name.ply"
}

objects squares build/course/squares.ply # of chapter 1
objects box build/course/box.ply         # of chapter 3
solve corner
for scene in squares corner box; do
    build/course/radiosity scenes/$scene.obj 0.25 | sed 1d >"$work/plain"
    check "$scene: phr agrees with radiosity.c within 2 %" \
        agree "$work/plain" "$work/$scene" 0.02
done

# --- scenes for lectures (1 %: behind doors, and far away, by reflections alone) ---

solve doorway
solve corridor --epsilon 1e-3 --final-gather 512
for scene in squares corner box doorway corridor; do
    awk -F, -v scene=$scene '$1 == scene { print $2, $3 }' scenes/answers.csv \
        >"$work/answers"
    check "$scene: phr is within 3 % of the converged answer" \
        agree "$work/answers" "$work/$scene" 0.03
    check "$scene: there are both of each object" \
        [ "$(wc -l <"$work/answers")" -eq "$(wc -l <"$work/$scene")" ]
    check "$scene: it has a view" \
        ./phr --quiet --max-level 0 --final-gather 0 --size 8x8 scenes/$scene.obj \
        --view scenes/$scene.view -o "$work/view.ppm"
done

tap_done
