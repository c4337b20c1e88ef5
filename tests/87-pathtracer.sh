# pathtracer: a furnace, whose answer is known, through files; norms; ranks; bad usage.
#
# In a closed room with E = 1 and rho = 1/2 everywhere B is 2 everywhere, and phr with
# rows of form factors that sum to 1 says so. The light of one path has a standard
# deviation of 0.8, so means of 512 have one of 0.035, 1.8 % of B: the tolerance of the
# RMS over some 400 leaves is 2.2 %. With rho = 0.52, B is 2.083, 4 % more, and this must
# be seen.
. tests/tap.sh

: "${PATHTRACER:=build/pathtracer}"

# A room that reflects RHO and emits 1.
for rho in 0.5 0.52; do
    printf 'newmtl m\nKd %s %s %s\nKe 1 1 1\n' $rho $rho $rho >"$work/box-$rho.mtl"
    { printf 'mtllib box-%s.mtl\nusemtl m\n' $rho; box 40 30 25; } >"$work/box-$rho.obj"
done
printf 'eye 20 15 12\nat 0 0 0\nsize 16 12\n' >"$work/box.view"
"$PHR" "$work/box-0.5.obj" --max-level 3 --epsilon 1e-3 --quiet --view "$work/box.view" \
    -o "$work/phr.ply" \
    -o "$work/phr.pfm" -o "$work/phr.error.pfm"

# trace RHO: the mesh and the picture of the box, the norms in $work/norms-RHO.
trace() {
    "$PATHTRACER" "$work/box-$1.obj" --leaves "$work/phr.ply" --view "$work/box.view" \
        --samples 512 -o "$work/$1.ply" -o "$work/$1.pfm" \
        >"$work/norms-$1" 2>"$work/log-$1"
}

# norm RHO NAME
norm() {
    awk -v name="$2" '$1 == name { print $2 }' "$work/norms-$1"
}

trace 0.5
check "the mesh is that of the furnace" \
    "$IMGDIFF" "$work/phr.ply" "$work/0.5.ply" --rms 0.022
# agrees PICTURE: within four standard errors of phr's.
agrees() {
    "$IMGDIFF" "$1" "$work/phr.pfm" --error "$work/phr.error.pfm" >"$work/diff"
}
check "so is the picture" agrees "$work/0.5.pfm"
check "rays and seconds are told" \
    grep -qE '^pathtracer: [0-9]+ paths, [0-9]+ rays, [0-9.]+ s' "$work/log-0.5"
# Of rho H = 1; a fifth more or less. The product of two halves of 0.05, over 372 leaves,
# has a standard deviation of 0.05^2 / sqrt(372), whose root is 0.011.
check "the noise is as expected: $(norm 0.5 noise)" \
    holds "$(norm 0.5 noise) > 0.028 && $(norm 0.5 noise) < 0.042"
check "the RMS error does not contain it: $(norm 0.5 rms)" holds "$(norm 0.5 rms) < 0.02"
trace 0.52
check "2 % more reflectance is seen in the mesh" [ -s "$work/0.52.ply" -a -z "$(
    "$IMGDIFF" "$work/phr.ply" "$work/0.52.ply" --rms 0.022 >"$work/diff" &&
        echo passed)" ]
check "and in the picture" [ -s "$work/0.52.pfm" -a -z "$(
    agrees "$work/0.52.pfm" && echo passed)" ]
# (1.0833 - 1) / 1.0833 of the reflected light
check "and in the norms: $(norm 0.52 rms), $(norm 0.52 l1), $(norm 0.52 median)" \
    holds "$(norm 0.52 rms) > 0.06 && $(norm 0.52 rms) < 0.09 &&
        $(norm 0.52 l1) > 0.06 && $(norm 0.52 median) > 0.06"

for ranks in 2 3; do
    $MPIEXEC -n $ranks "$PATHTRACER" "$work/box-0.5.obj" --leaves "$work/phr.ply" \
        --view "$work/box.view" --samples 512 -o "$work/ranks.ply" \
        -o "$work/ranks.pfm" >"$work/norms-ranks" 2>"$work/log-ranks"
    check "the same mesh on $ranks ranks" cmp -s "$work/ranks.ply" "$work/0.5.ply"
    check "the same picture" cmp -s "$work/ranks.pfm" "$work/0.5.pfm"
    check "the same norms" cmp -s "$work/norms-ranks" "$work/norms-0.5"
done

check "help" eval '"$PATHTRACER" --help | grep -q "^usage: pathtracer"'

# refused NAME ARGUMENTS...: ends with 2 and one line.
refused() {
    name=$1
    shift
    "$PATHTRACER" "$@" >"$work/out" 2>"$work/err"
    status=$?
    check "$name: $(cat "$work/err")" [ "$status" -eq 2 -a "$(wc -l <"$work/err")" -eq 1 ]
}

refused "no output" "$work/box-0.5.obj"
refused "a mesh without leaves" "$work/box-0.5.obj" -o "$work/no.ply"
refused "too few paths" "$work/box-0.5.obj" --samples 1 -o "$work/no.pfm"
refused "no value" "$work/box-0.5.obj" -o "$work/no.pfm" --samples
refused "leaves of another scene" scenes/shadow.obj --leaves "$work/phr.ply" \
    -o "$work/no.ply"
refused "a missing scene" "$work/none.obj" -o "$work/no.pfm"
check "nothing was written" [ ! -e "$work/no.ply" -a ! -e "$work/no.pfm" ]

tap_done
