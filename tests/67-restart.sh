# Link caches, checkpoints and the memory limit: a file is the same whatever the number of
# ranks that wrote it; a run that goes on from it, on any number of ranks, equals an
# uninterrupted one; what was made from another scene or with other settings is refused,
# with the reason (every reason there is: tests/io/store.c; settings: tests/io/options.c).
. tests/tap.sh

# Small runs: files differ in the way that the code goes, not in the size. (Runs that are
# stopped: tests/72-faults.sh.)
links="scenes/cornell.obj --epsilon 1e-3 --size 40x40 --quiet"
gathered="$links --final-gather 16"
cornell=$gathered
counts="checksum links patches passes iterations rays node_tests converged memory_limited
        absorbed_power error_estimate"

# run NAME RANKS ARGUMENTS...: outputs and stats to $work/NAME.*.
run() {
    out=$work/$1
    on=$2
    shift 2
    $MPIEXEC -n "$on" "$PHR" "$@" -o "$out.pfm" -o "$out.ppm" -o "$out.ply" \
        --stats "$out.json" 2>"$out.err"
}

# same A B: equal files and equal counts.
same() {
    for suffix in pfm ppm ply; do
        cmp "$work/$1.$suffix" "$work/$2.$suffix" || return 1
    done
    for key in $counts; do
        value=$(stat_of "$work/$2.json" $key)
        [ -n "$value" ] && [ "$(stat_of "$work/$1.json" $key)" = "$value" ] && continue
        echo "# $key differs or is missing: $1 and $2"
        return 1
    done
    [ "$(grep '"closure"' "$work/$1.json")" = "$(grep '"closure"' "$work/$2.json")" ] &&
        return
    echo "# row sums differ: $1 and $2"
    return 1
}

# refused START ARGUMENTS...: exit status 2 and one line that begins so.
refused() {
    start=$1
    shift
    $MPIEXEC -n 2 sh -c 'exec 2>>"$0"; exec "$@"' "$work/refused" "$PHR" "$@" \
        >/dev/null 2>&1
    status=$?
    line=$(cat "$work/refused")
    rm -f "$work/refused"
    case $line in "phr: $start"*) [ "$status" -eq 2 ] && return ;; esac
    echo "# expected '$start', got status $status and: $line"
    return 1
}

# --- link caches: of all pairs ---

pairs="$links --linking pairs"
run plain 2 $pairs
for ranks in 1 3 4; do
    run save-$ranks $ranks $pairs --save-links "$work/links-$ranks"
done
check "a link cache by 3 ranks is that by 1" cmp "$work/links-3" "$work/links-1"
check "and that by 4" cmp "$work/links-4" "$work/links-1"
check "saving changes nothing" same save-3 plain
run load 2 $pairs --load-links "$work/links-4"
check "2 ranks go on from it" same load plain
run load-closed 3 $pairs --load-links "$work/links-1" --solver jacobi --tolerance 1e-3
run closed 1 $pairs --solver jacobi --tolerance 1e-3
check "other settings than those of links are free" same load-closed closed

# --- the end of the paper's iterations ---

few="scenes/cornell.obj --paper --epsilon 1e-3 --quiet"
run one 2 $few --tolerance 1 --checkpoint "$work/one"
check "the paper's first iteration changes less than all light: it is the last" \
    [ "$(stat_of "$work/one.json" iterations)" -eq 1 ]
run again 3 $few --tolerance 1 --resume "$work/one"
check "as it is for who resumes" same again one

mkdir "$work/folder"
cp scenes/cornell.obj scenes/cornell.mtl "$work/folder"
run moved 2 "$work/folder/cornell.obj" --epsilon 1e-3 --linking pairs --size 40x40 \
    --quiet --load-links "$work/links-1"
check "the scene may have moved" same moved plain
sed 's/^Kd 0.7/Kd 0.6/' scenes/cornell.mtl >"$work/folder/cornell.mtl"
check "another material is another scene" \
    refused "$work/links-1: made from another scene" \
    "$work/folder/cornell.obj" --epsilon 1e-3 --linking pairs --load-links "$work/links-1"

# --- checkpoints ---

run plain 2 $cornell
for ranks in 1 3 4; do
    $MPIEXEC -n $ranks "$PHR" $cornell --max-iterations 8 \
        --checkpoint "$work/check-$ranks"
done
check "a checkpoint by 3 ranks is that by 1" cmp "$work/check-3" "$work/check-1"
check "and that by 4" cmp "$work/check-4" "$work/check-1"
run resume 3 $cornell --resume "$work/check-4"
check "3 ranks go on from a checkpoint by 4" same resume plain
cp "$work/check-1" "$work/going"
run going 2 $cornell --resume "$work/going" --checkpoint "$work/going" --every 2
check "renewing it on the way" same going plain
run final 3 $cornell --resume "$work/going"
check "that of a finished run needs no iteration" same final plain
run tight 2 $cornell --resume "$work/going" --tolerance 1e-8
check "but can be taken further" \
    holds "$(stat_of "$work/tight.json" iterations) > \
        $(stat_of "$work/plain.json" iterations)"

# resumes NAME N OPTIONS...: another method, interrupted by a limit of N iterations.
resumes() {
    name=$1
    limit=$2
    shift 2
    run "$name" 1 $cornell "$@"
    $MPIEXEC -n 2 "$PHR" $cornell --max-iterations "$limit" \
        --checkpoint "$work/$name.check" "$@"
    run "$name-on" 3 $cornell --resume "$work/$name.check" "$@"
    check "goes on: $*" same "$name-on" "$name"
}

cornell=$links
resumes paper 3 --paper --max-level 4
for limit in $(proves && echo 5) 24 40; do # in the first round, the second, at its end
    resumes accuracy-$limit $limit --accuracy 1.5% --epsilon 1e-2
done
check "which takes two rounds and more" \
    grep -q '"rounds": [2-9]' "$work/accuracy-40.json"
"$PHR" scenes/cornell.obj --accuracy 1.5% --epsilon 1e-2 --final-gather 300 \
    --resume "$work/accuracy-40.check" >"$work/out" 2>"$work/err"
check "and says that it does not take other rays" grep -q \
    'warning: no use is made of --final-gather 300: --accuracy has come to' "$work/err"
"$PHR" scenes/cornell.obj --accuracy 1.5% --epsilon 1e-2 --final-gather pixels \
    --size 4x4 --resume "$work/accuracy-40.check" -o "$work/4x4.pfm" \
    >"$work/out" 2>"$work/err"
check "but not of rays that nobody gave" holds "$(grep -c 'no use' "$work/err") == 0"
cornell=$gathered
# Rays fired again are counted again.
counts="checksum links patches passes iterations absorbed_power"
resumes two-sided 8 --two-sided --max-level 4
resumes jacobi 8 --solver jacobi --max-level 3

check "--solver is bound" \
    refused "$work/check-1: made with --solver cg, this run has --solver jacobi" \
    $cornell --resume "$work/check-1" --solver jacobi
# --- memory ---

counts="checksum links patches passes iterations rays node_tests converged memory_limited
        absorbed_power"
fine="scenes/cornell.obj --epsilon 1e-5 --size 40x40 --final-gather 16"
for ranks in 1 2 3 4; do
    run small-$ranks $ranks $fine --memory 2M \
        --checkpoint "$work/small-$ranks.check" >/dev/null
done
for ranks in 2 3 4; do
    check "2 MiB on $ranks ranks are 2 MiB on one" same small-$ranks small-1
    check "its checkpoint too" cmp "$work/small-$ranks.check" "$work/small-1.check"
done
run large 2 $fine --memory 1G >/dev/null
check "1 GiB is enough" [ "$(stat_of "$work/large.json" memory_limited)" = false ]
check "2 MiB are not, and the run says so" \
    [ "$(stat_of "$work/small-1.json" memory_limited)" = true ]
check "once" [ "$(grep -c 'phr: warning: refinement ended at the memory limit' \
    "$work/small-3.err")" -eq 1 ]
check "so it has not converged" [ "$(stat_of "$work/small-1.json" converged)" = false ]
check "the links absorb within 5 % as much" \
    holds "($(stat_of "$work/small-1.json" absorbed_power) / \
        $(stat_of "$work/large.json" absorbed_power) - 1) ^ 2 < 0.05 ^ 2"
run grown 3 $fine --memory 1G --resume "$work/small-2.check" >/dev/null
check "it goes on where there is more memory" \
    [ "$(stat_of "$work/grown.json" memory_limited)" = false ]
check "to the end" [ "$(stat_of "$work/grown.json" converged)" = true ]
run still 3 $fine --memory 2M --resume "$work/small-1.check" >/dev/null
check "and not where there is not" same still small-1
check "what it counts is within the limit" \
    holds "$(stat_of "$work/small-1.json" counted_bytes) <= 2 * 1024 ^ 2"

# Room for all links, and not for all leaves that the gather would split.
whole="scenes/cornell.obj --epsilon 1e-3 --size 40x40"
run gathers 2 $whole >/dev/null
most=$(stat_of "$work/gathers.json" counted_bytes)
for ranks in 1 3; do
    run cut-$ranks $ranks $whole --memory $((most * 9 / 10)) >/dev/null
done
check "the limit holds for the mesh of a gather" same cut-3 cut-1
check "whose links are all there" [ "$(stat_of "$work/cut-1.json" links)" = \
    "$(stat_of "$work/gathers.json" links)" ]
check "and the run says so" \
    [ "$(stat_of "$work/cut-1.json" memory_limited)" = true -a "$(grep -c \
        'phr: warning: refinement ended at the memory limit' "$work/cut-3.err")" -eq 1 ]
check "not without a limit" [ "$(stat_of "$work/gathers.json" memory_limited)" = false ]

# The limit ends a pass that is not the first: from the checkpoint of the pass before, it
# ends there again.
later="scenes/cornell.obj --epsilon 3e-6 --linking pairs --size 20x20 --memory 15M"
run later 2 $later >/dev/null
check "a limit in the second pass" \
    [ "$(grep -c '([1-9][0-9]* split)' "$work/later.err")" -eq 2 ]
for ranks in 1 4; do
    $MPIEXEC -n $ranks "$PHR" $later --quiet --max-iterations 5 \
        --checkpoint "$work/later.check"
    run later-$ranks $((5 - ranks)) $later --resume "$work/later.check" >/dev/null
    check "comes again, from a checkpoint of $ranks" same later-$ranks later
done

# Limits that hold --accuracy back: said in words, with the error that was reached.
# held NAME HOLD WORDS OPTIONS...
held() {
    name=$1 hold=$2 words=$3
    shift 3
    run "$name-1" 1 scenes/cornell.obj --size 40x40 --accuracy 1% "$@" >/dev/null
    check "held back by $*: exit status 0" [ $? -eq 0 ]
    run "$name-3" 3 scenes/cornell.obj --size 40x40 --accuracy 1% "$@" >/dev/null
    check "on 3 ranks alike" same "$name-3" "$name-1"
    over="\\(1\\.[2-9]\\|[2-9].*\\) %" # 1.2 % and more
    said="^phr: warning: the error is $over\\( in the median of leaves\\)*"
    said="$said, not the 1 % of --accuracy: $words"
    check "and it says so" grep -q "$said" "$work/$name-3.err"
    check "has not converged, and --stats has the limit" [ "$(stat_of \
        "$work/$name-1.json" converged) $(grep -c "\"hold\": \"$hold\"" \
        "$work/$name-1.json")" = "false 1" ]
}
held by-memory memory "the memory limit is in the way" --memory 2M
held by-level level "--max-level is in the way" --max-level 1
held by-area area "--min-area is in the way" --min-area 0.01

# Linking ends there too: the roots of a room have six times as many links as fit.
build/room 1000 1 >"$work/room.obj"
cp scenes/room.mtl "$work"

# Less than the scene takes before there are links: some are made all the same.
for ranks in 1 3; do
    run least-$ranks $ranks "$work/room.obj" --size 40x40 --final-gather 0 --memory 1K \
        >/dev/null
done
check "1 KiB on 3 ranks is 1 KiB on one" same least-3 least-1
check "there is light" holds "$(stat_of "$work/least-1.json" absorbed_power) > \
    0.5 * $(stat_of "$work/least-1.json" emitted_power)"
limit=$(stat_of "$work/least-1.json" memory_limit)
check "a warning tells the limit in force, $limit bytes, as does --stats" \
    grep -q "more than --memory: the limit is $limit bytes, an eighth" "$work/least-3.err"

room="$work/room.obj --paper --size 40x40"
for ranks in 1 2 3; do
    run part-$ranks $ranks $room --memory 3M --checkpoint "$work/part.check" >/dev/null
done
check "linking that does not fit: 2 ranks give the bytes of 1" same part-2 part-1
check "and 3" same part-3 part-1
check "a warning says so" \
    [ "$(grep -c 'phr: warning: linking ended at the memory limit .*: light is missing' \
        "$work/part-3.err")" -eq 1 ]
made=$(stat_of "$work/part-1.json" links)
check "the links fit, and there are some" holds "36 * $made < 3 * 1048576 && $made > 1e4"
check "there is light" \
    holds "$(stat_of "$work/part-1.json" absorbed_power) > \
        0.1 * $(stat_of "$work/part-1.json" emitted_power)"
check "no checkpoint is made of that" [ ! -e "$work/part.check" ]
$MPIEXEC -n 2 sh -c 'exec 2>>"$0/part.err"; exec "$@"' "$work" "$PHR" $room \
    --quiet --memory 3M \
    --save-links "$work/part.links" >/dev/null 2>&1
status=$?
check "nor a link cache: exit status 1" [ "$status" -eq 1 ]
check "with one line" [ "$(cat "$work/part.err")" = \
    "phr: $work/part.links: not written: linking ended at the memory limit" ]
check "and no file" [ ! -e "$work/part.links" ]

tap_done
