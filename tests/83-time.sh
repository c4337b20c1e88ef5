# Runs that end before they are done: --time, and signals in each phase. Each ends with
# status 1, a line that says what light its outputs have, and outputs that are whole and
# about right. On 1 and on 3 ranks.
. tests/tap.sh
. tests/faults.sh

view="--view scenes/cornell.view"
says() { grep -qx "phr: stopped by $1: $2" "$work/err"; }
links="the light is that of the links there were"
pixels="pixels not done have the light of the mesh"

# shown RELATIVE: the picture is off from the whole one by less, RMS of blocks. (A black
# one is off by 1.)
shown() {
    build/imgdiff "$work/new.pfm" "$work/whole.pfm" --blocks 40 --below 2 \
        --rms "$1" >"$work/diff" || { sed 's/^/# /' "$work/diff"; false; }
}
./phr scenes/cornell.obj $view --size 400x400 --quiet -o "$work/whole.pfm"
for ranks in 1 3; do
    rm -f "$work"/new.*
    $MPIEXEC -n $ranks ./phr scenes/cornell.obj $view --size 400x400 --epsilon 1e-7 \
        --time 2 -o "$work/new.pfm" -o "$work/new.ply" >"$work/out" 2>"$work/err"
    check "refinement out of time, on $ranks: status 1" [ $? = 1 ]
    check "the light is that of the links" says --time "$links"
    check "it is about right" shown .3
    check "the mesh is whole" [ "$(build/imgdiff "$work/new.ply" "$work/new.ply" |
        sed -n 's/^max *//p')" = 0 ]

    start $ranks scenes/cornell.obj $view --size 400x400 --final-gather 16384 \
        -o "$work/new.pfm"
    wait_for 1 "(0 split)"
    sleep 1
    kill -TERM "$(tail -n 1 "$work/ranks")"
    finish
    check "rows out of time, on $ranks: status 1" [ "$status" -eq 1 ]
    check "so is that" says SIGTERM "$links"
    check "it is about right" shown .3

    $MPIEXEC -n $ranks ./phr scenes/cornell.obj $view --size 400x400 --epsilon 1e-2 \
        --final-gather 16,pixels --samples 64 --time 4 -o "$work/new.pfm" \
        >"$work/out" 2>"$work/err"
    check "a picture out of time, on $ranks: status 1" [ $? = 1 ]
    check "some of its pixels are done" says --time "$pixels"
    check "it is about right" shown .3
done

tap_done
