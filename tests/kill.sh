# `make check-long`: a rank is killed at forty moments, spread evenly over a run that
# writes a checkpoint after every pass. Each time the run ends, the checkpoint there is
# whole (or there is none yet), and a run from it equals an uninterrupted one.
. tests/tap.sh
. tests/faults.sh

scene="scenes/cornell.obj --epsilon 2e-6 --flat --size 20x20 --quiet"
moments=40

# now: seconds with fraction.
now() { date +%s.%N; }

goes_on() {
    [ -e "$work/check" ] || return 0
    $MPIEXEC -n 2 "$PHR" $scene --resume "$work/check" -o "$work/on.pfm" \
        -o "$work/on.ply" &&
        cmp "$work/on.pfm" "$work/whole.pfm" && cmp "$work/on.ply" "$work/whole.ply"
}

begun=$(now)
$MPIEXEC -n 3 "$PHR" $scene -o "$work/whole.pfm" -o "$work/whole.ply" \
    --checkpoint "$work/check"
lasts=$(awk "BEGIN { print $(now) - $begun }")
rm -f "$work/check"

moment=0
killed=0
found=0
while [ $moment -lt $moments ]; do
    rm -f "$work"/check* "$work"/new*
    start 3 $scene -o "$work/new.pfm" --checkpoint "$work/check"
    sleep "$(awk "BEGIN { print $lasts * ($moment + 0.5) / $moments }")"
    victim=$(sed -n "$((moment % 3 + 1))p" "$work/ranks" 2>/dev/null)
    [ -n "$victim" ] && kill -9 "$victim" 2>/dev/null && killed=$((killed + 1))
    finish
    check "moment $moment: no hang" [ "$status" != hang ]
    check "moment $moment: all ranks are gone" ranks_are_gone
    [ -e "$work/check" ] && found=$((found + 1))
    check "moment $moment: the checkpoint, if there is one, is whole" goes_on
    if [ -e "$work/new.pfm" ]; then
        check "moment $moment: the picture, if there is one, is whole" \
            cmp "$work/new.pfm" "$work/whole.pfm"
    fi
    moment=$((moment + 1))
done
check "most runs were killed ($killed), many with a checkpoint ($found)" \
    [ $killed -ge $((moments / 2)) -a $found -ge $((moments / 4)) ]
tap_done
