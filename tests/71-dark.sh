# A dark picture says why; names that are nearly right are named; light that is lost is
# lost on the backs of something. Rooms of 4 x 2.8 x 5, fronts inside, and a lamp.
. tests/tap.sh

printf 'newmtl %s\nKd .5 .5 .5\n' white >"$work/room.mtl"
printf 'newmtl black\nKd 0 0 0\nnewmtl lamp\nKe 5 5 5\n' >>"$work/room.mtl"

# room WALLS LAMP HEIGHT: a room of a material, and a lamp that looks down from a height.
room() {
    printf '%s\n' "mtllib room.mtl" "usemtl $1" "o walls"
    box 4 2.8 5
    printf '%s\n' "usemtl $2" "o light" "v 1 $3 2" "v 1 $3 3" "v 2 $3 3" "v 2 $3 2" \
        "f -1 -2 -3 -4"
}

# says RANKS WORDS SCENE OPTIONS...: the run has one warning of a dark picture, with these
# words; or, without WORDS, none.
says() {
    ranks=$1 words=$2 scene=$3
    shift 3
    $MPIEXEC -n "$ranks" ./phr "$work/$scene" --epsilon 1e-2 --final-gather 16 \
        --size 64x48 -o "$work/test.pfm" "$@" 2>"$work/log" >"$work/out" || return 1
    grep -E 'warning: .*: [0-9]+ % of the picture is black' "$work/log" >"$work/dark"
    [ -z "$words" ] && [ ! -s "$work/dark" ] && return
    [ -n "$words" ] && [ "$(wc -l <"$work/dark")" -eq 1 ] &&
        grep -q -- "$words" "$work/dark" && return
    sed 's/^/# /' "$work/log"
    return 1
}

room white lamp 2.7 >"$work/room.obj"
room black lamp 2.7 >"$work/black.obj"
room white white 2.7 >"$work/none.obj"
{ room white white 2.7; room white lamp 2.7 | awk '/^v/ { $2 += 9 } NR > 1 { print }' |
    awk '/^f [1-9]/ { for (i = 2; i < 6; i++) $i += 12 } { print }'; } >"$work/other.obj"
room white lamp 3.9 | sed 's/^f -1 -2 -3 -4/f -4 -3 -2 -1/' >"$work/away.obj"
sed 's/room.mtl/rom.mtl/' "$work/room.obj" >"$work/library.obj"
sed 's/usemtl lamp/usemtl lmap/' "$work/room.obj" >"$work/material.obj"
printf 'eye %s\nat %s\n' "1 1 1" "3 1 4" >"$work/inside.view"
printf 'eye %s\nat %s\n' "1 1 -3" "1 1 0" >"$work/behind.view"
printf 'eye %s\nat %s\n' "1 9 -3" "1 20 0" >"$work/past.view"
inside="--view $work/inside.view"
within='x 0 to 4, y 0 to 2.8, z 0 to 5'
for ranks in 1 3; do
    check "a lit picture is not dark, on $ranks" says $ranks "" room.obj $inside
    check "black walls" says $ranks "reflects nothing (Kd 0)" black.obj $inside
    check "no lamp in a closed room" says $ranks \
        "there is no lamp, and the sky of --sky does not get in$" none.obj $inside
    check "a missing library" says $ranks \
        "get in; lamps may be in the file rom.mtl, which is missing" library.obj $inside
    check "a misspelt material" \
        says $ranks "lamps may be in the material lmap" material.obj $inside
    check "like another, which is named" \
        grep -q "first: lmap; did you mean lamp?" "$work/log"
    check "a lamp that looks away" \
        says $ranks "the fronts of the lamps look away from all else" away.obj $inside
    check "a lamp in another room" \
        says $ranks "lit are faces within x 9 to 13" other.obj $inside
    check "a camera behind a wall" says $ranks \
        "the backs of faces.* lies within $within" room.obj --view "$work/behind.view"
    check "a camera that looks past" says $ranks \
        "looks past the scene, which lies within $within" room.obj \
        --view "$work/past.view"
done
./phr "$work/room.obj" --epsilon 1e-2 --quiet -o "$work/lit.ply"
./phr "$work/none.obj" --epsilon 1e-2 --quiet --sky 1e-9 -o "$work/x.pfm" 2>"$work/log"
check "nothing is said with --quiet" [ ! -s "$work/log" ]
check "a stored solution is not dark" says 1 "" lit.ply $inside
check "or has a camera that looks past, too" \
    says 1 "looks past the scene" lit.ply --view "$work/past.view"

# A room whose walls have fronts outside, too, which are dark: seen from inside.
{ room white lamp 2.7; echo usemtl white
    box 4.4 3.2 5.4 | awk '/^v/ { $2 -= .2; $3 -= .2; $4 -= .2 }
        /^f/ { print "f", $5 + 12, $4 + 12, $3 + 12, $2 + 12; next } { print }'
} >"$work/house.obj"
check "a view is chosen that is not dark" says 1 "" house.obj
awk '/^v/ { $2 *= .5; $4 *= .4 } { print }' "$work/house.obj" >"$work/small.obj"
check "also of a box that is too small to stand in" says 1 "" small.obj

# refused WORDS ARGUMENTS...: with one line.
refused() {
    words=$1
    shift
    ./phr "$work/room.obj" "$@" >"$work/out" 2>"$work/log"
    [ $? -eq 2 ] && [ "$(cat "$work/log")" = "phr: unknown option $words" ] && return
    sed 's/^/# /' "$work/log"
    return 1
}
check "letters swapped" refused "--epsilno; did you mean --epsilon?" --epsilno 1
check "a capital and a letter too many, with a value" \
    refused "--Sizee=9x9; did you mean --size?" --Sizee=9x9
check "another word" refused "--colour; see --help" --colour

# lost WORDS OPTIONS...: what the warning of lost light says of the reason.
lost() {
    words=$1
    shift
    ./phr "$@" --epsilon 1e-3 --final-gather 64 2>"$work/log" >"$work/out"
    grep -q "closed scene is lost: $words" "$work/log" && return
    sed 's/^/# /' "$work/log"
    return 1
}
# A table of one side below the lamp; and a box over a lamp on the floor.
{ cat "$work/room.obj"; printf '%s\n' "usemtl white" "o table" "v 1 1 2" "v 1 1 3" \
    "v 2 1 3" "v 2 1 2" "f -4 -3 -2 -1"; } >"$work/table.obj"
check "light on backs, by name" lost "it falls on black backs .*, those of table (" \
    "$work/table.obj"
sed '/^o /d' "$work/table.obj" >"$work/nameless.obj"
check "or by number" lost "it falls on black backs .*, those of triangle 1[45] (" \
    "$work/nameless.obj"
{ cat "$work/room.obj"; printf '%s\n' "usemtl lamp" "o glow" "v 1.2 .5 1" "v 1.2 .5 2" \
    "v 2 .5 2" "v 2 .5 1" "f -4 -3 -2 -1" "usemtl white" "o crate"
    box 1.6 .8 1.6 | awk '/^v/ { $2 += .8; $3 += .2; $4 += .7 }
        /^f/ { print "f", $5 + 16, $4 + 16, $3 + 16, $2 + 16; next } { print }'
} >"$work/crate.obj"
check "light inside of things" \
    lost "it is sent inside of things or behind them, onto backs of crate (" \
    "$work/crate.obj"

tap_done
