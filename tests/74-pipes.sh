# Outputs on pipes and on the standard output: the bytes of a file, and nothing else; a
# pipe is opened once; a run that waits for its reader ends at the first SIGTERM; one
# whose reader goes away ends with an error. Scenes and solutions on pipes, of whatever
# name: known by their first bytes. On 1 and on 4 ranks.
. tests/tap.sh
. tests/faults.sh
patience=20

scene="scenes/cornell.obj --max-level 1 --samples 1 --size 300x200"
view="--view scenes/cornell.view"
pipe=$work/f.fifo
mkfifo "$pipe" "$work/p.pfm"
$PHR $scene $view --quiet -o "$work/a.ppm" -o "$work/a.pfm" -o "$work/a.ply"

# bounded COMMAND...: within 20 seconds, which are the limit of a hang.
bounded() { timeout -s KILL 20 "$@"; }

# waits RANKS: it has no reader, and ends soon after one SIGTERM, and says so. (A
# launcher that was sent a signal may end with 0 whatever its ranks end with.)
waits() {
    start "$1" $scene $view -o "$pipe"
    wait_for 1 '(0 split)'
    sleep 0.5
    kill -TERM "$launched"
    finish
    [ "$status" != hang ] && tail -n 1 "$work/err" |
        grep -qx "phr: stopped by SIGTERM\(: \(pixels not done\|the light is\) .*\)*"
}

# sends RANKS FORMAT ARGUMENTS...: an output goes to stdout, alone.
sends() {
    on=$1 format=$2
    shift 2
    bounded $MPIEXEC -n "$on" "$PHR" $scene "$@" 2>"$work/err" | cat >"$work/got"
    cmp "$work/got" "$work/a.$format" && grep -q '^checksum ' "$work/err"
}

# fills RANKS FORMAT PIPE ARGUMENTS...: a reader gets the whole output.
fills() {
    on=$1 format=$2 fifo=$3
    shift 3
    bounded cat "$fifo" >"$work/got" &
    reader=$!
    bounded $MPIEXEC -n "$on" "$PHR" $scene --quiet "$@" 2>"$work/err"
    status=$?
    wait $reader
    cmp "$work/got" "$work/a.$format" && [ $status -eq 0 ]
}

# takes RANKS FILE PATH ARGUMENTS...: a scene or solution that comes through the pipe, or
# on the standard input, gives the picture of its file.
takes() {
    on=$1 file=$2 from=$3
    shift 3
    "$PHR" "$file" "$@" --quiet -o "$work/expected.pfm" 2>"$work/err"
    rm -f "$work/got.pfm"
    if [ -p "$from" ]; then
        timeout 20 cat "$file" >"$from" &
        bounded $MPIEXEC -n "$on" "$PHR" "$from" "$@" --quiet -o "$work/got.pfm"
    else
        cat "$file" | bounded $MPIEXEC -n "$on" "$PHR" "$from" "$@" --quiet \
            -o "$work/got.pfm"
    fi 2>>"$work/err"
    cmp "$work/got.pfm" "$work/expected.pfm"
}

cat >"$work/scene.ply" <<END
$(ply_head 6 2 emission_r emission_g emission_b)
0 0 0
1 0 0
0 1 0
0 0 1
0 1 1
1 0 1
3 0 1 2 0 0 0
3 3 4 5 1 2 3
END
# Its library is below the folder of the pipe, and below the current one.
sed "s,mtllib ,&scenes/," scenes/box.obj >"$work/scene"
mkdir "$work/scenes"
cp scenes/course.mtl "$work/scenes"

for ranks in 1 4; do
    for from in "$pipe" /dev/stdin; do
        check "PLY from ${from##*/}, on $ranks" \
            takes $ranks "$work/scene.ply" "$from" --size 40x30
        check "a solution from ${from##*/}, on $ranks" \
            takes $ranks "$work/a.ply" "$from" $view
        check "OBJ from ${from##*/}, on $ranks" \
            takes $ranks "$work/scene" "$from" --size 40x30
    done
    for name in - ppm:- /dev/stdout ppm:/dev/stdout; do
        check "-o $name on $ranks" sends $ranks ppm $view -o $name
    done
    check "-o pfm:- on $ranks" sends $ranks pfm $view -o pfm:-
    check "-o ply:- on $ranks" sends $ranks ply -o ply:-
    check "a pipe without a suffix, on $ranks" fills $ranks ppm "$pipe" $view -o "$pipe"
    check "a pipe with one, on $ranks" fills $ranks pfm "$work/p.pfm" $view \
        -o "$work/p.pfm"
    check "a pipe with a prefix, on $ranks" fills $ranks ply "$pipe" -o "ply:$pipe"
    check "a run without a reader ends at SIGTERM, on $ranks" waits $ranks
    # A launcher that has lost its standard output may end all ranks before phr can speak.
    { bounded $MPIEXEC -n $ranks "$PHR" $scene $view --quiet -o pfm:- 2>"$work/err"
        echo $? >"$work/status"; } | head -c 10 >"$work/got"
    check "a reader that goes away: not 0 ($(cat "$work/status")), on $ranks" \
        [ "$(cat "$work/status")" -ne 0 -a "$(cat "$work/status")" -ne 137 ]
done
{ "$PHR" $scene $view --quiet -o pfm:- 2>"$work/err"; echo $? >"$work/status"; } |
    head -c 10 >"$work/got"
check "alone, status 1" [ "$(cat "$work/status")" = 1 ]
check "and a line that says why" \
    [ "$(cat "$work/err")" = "phr: standard output: cannot write: Broken pipe" ]
echo old >"$work/log"
"$PHR" $scene $view --quiet -o - >>"$work/log"
{ echo old; cat "$work/a.ppm"; } >"$work/got"
check "a file that is appended to keeps its bytes" cmp "$work/log" "$work/got"
check "--stats - is the report alone" \
    [ "$("$PHR" $scene --stats - 2>/dev/null | sed -n '1p;$p' | tr -d '\n')" = "{}" ]

tap_done
