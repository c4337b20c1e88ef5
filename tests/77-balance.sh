# Faces that are there twice, and powers that cannot be true: doubles are dropped, faces
# that are modelled from both sides give light once, and where more light is absorbed
# than emitted, or light is lost, a warning says so.

. tests/tap.sh

cp scenes/cornell.mtl "$work"

# copied NAME ORDER [MATERIAL]: the Cornell box with a copy of each face, as
# $work/NAME.obj. The copies have vertices of their own; ORDER of their corners, which are
# 4, or 6 of two triangles; MATERIAL for all of them.
copied() {
    awk -v order="$2" -v material="${3:-}" '
        { print }
        /^v / { v[++count] = $0 }
        /^usemtl / { of = $2 }
        /^f / { faces++; used[faces] = material ? material : of; face[faces] = $0 }
        END {
            for (i = 1; i <= count; i++)
                print v[i]
            corners = split(order, turn, " ")
            for (i = 1; i <= faces; i++) {
                split(face[i], word, " ")
                print "usemtl", used[i]
                for (k = 1; k <= corners; k++)
                    printf "%s %d", k == 1 || k + corners == 10 ? "\nf" : "",
                           word[turn[k] + 1] + count
                print ""
            }
        }' scenes/cornell.obj >"$work/$1.obj"
}
copied twice "2 3 4 1"
copied red "1 2 3 4" red
copied behind "4 3 2 1"
copied over "2 3 4 2 4 1"

# run RANKS SCENE OPTIONS...: runs phr; leaves its words in $work/log, its exit status in
# $status, the powers in $emitted, $absorbed, $escaped and $touching.
run() {
    ranks=$1
    shift
    $MPIEXEC -n "$ranks" ./phr --epsilon 1e-2 --final-gather 0 "$@" \
        >"$work/out" 2>"$work/log"
    status=$?
    read -r emitted absorbed escaped touching <<END
$(awk '/^power / { for (i = 2; i <= NF; i++) if ($i ~ /^-?[0-9]/) print $i }' \
    "$work/out" | tr '\n' ' ')
END
}

# says WORDS: there is one warning, and it has these words; none: there is no warning.
says() {
    if [ "$1" = none ]; then
        ! grep warning "$work/log" | sed 's/^/# /' | grep .
    else
        [ "$(grep -c warning "$work/log")" -eq 1 ] && grep -qF "$1" "$work/log" &&
            return
        grep warning "$work/log" | sed 's/^/# /'
        return 1
    fi
}

# is_as WORDS: the powers are those kept in $once, up to 0.2 % (roots have other numbers,
# so other links are refined), and the warning is as says() has it.
is_as() {
    [ "$status" -eq 0 ] && says "$1" && holds "$(echo "$emitted $absorbed $once" |
        awk '{ print $1 " == " $3 " && (" $2 " / " $4 " - 1) ^ 2 < 4e-6" }')" && return
    echo "# exit status $status, $emitted and $absorbed W, not $once"
    return 1
}

dropped="warning: 38 triangle(s) are there twice, facing the same way: the first"
for ranks in 1 4; do
    run $ranks scenes/cornell.obj
    once="$emitted $absorbed"
    run $ranks "$work/twice.obj"
    check "the Cornell box twice is the box, on $ranks" is_as "$dropped of each stays"
    run $ranks "$work/red.obj"
    check "of another material, too, on $ranks" \
        is_as "$dropped of each stays, also where the materials differ (36)"
    run $ranks scenes/cornell.obj --two-sided-lamps
    once="$emitted $absorbed"
    run $ranks "$work/twice.obj" --two-sided-lamps
    check "with twins, too, on $ranks" is_as "$dropped"
    run $ranks "$work/behind.obj"
    check "modelled from both sides it is the box with twins, on $ranks" is_as none
    run $ranks "$work/behind.obj" --two-sided-lamps
    check "and gets no twins more, on $ranks" is_as none
done
"$BUILD/viewfactors" "$work/twice.obj" --quiet >"$work/twice.csv"
"$BUILD/viewfactors" scenes/cornell.obj --quiet >"$work/once.csv"
check "form factors of doubles are those of one" cmp "$work/twice.csv" "$work/once.csv"

# A quad with a corner twice is cut into a triangle and one without an area.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 1 0\nf 1 2 3 4\n' >"$work/corner.obj"
"$BUILD/viewfactors" "$work/corner.obj" >"$work/corner.csv" 2>"$work/log"
check "a quad with a corner twice is a triangle" grep -q ',0.5,0$' "$work/corner.csv"
check "and no double" [ "$(grep -c twice "$work/log")" -eq 0 ]
# faces FILE: the line of a mesh that counts its faces.
faces() {
    sed -n '/^element face/{p;q;}' "$1"
}
run 1 "$work/twice.obj" --paper -o "$work/twice.ply"
run 1 scenes/cornell.obj --paper -o "$work/once.ply"
check "the solution has no faces of doubles" \
    [ "$(faces "$work/twice.ply")" = "$(faces "$work/once.ply")" ]

# --- powers that cannot be true ---

run 1 scenes/cornell.obj
check "the sums of the Cornell box are true" says none

# Two triangles over each quad, along the other diagonal, are no doubles.
is_absurd() {
    [ "$status" -eq 1 ] && holds "$absorbed > 1.5 * $emitted" && [ ! -e "$work/x.ppm" ] &&
        grep -q '^phr: [0-9.]* times as much light is absorbed as ' "$work/log" &&
        ! grep warning "$work/log"
}
for ranks in 1 4; do
    run $ranks "$work/over.obj" -o "$work/x.ppm"
    check "faces over others absorb too much: no picture, status 1, on $ranks" is_absurd
done
run 1 "$work/over.obj" --final-gather 16
check "lamps over lamps shine twice, which is said" \
    says "50 % of the light is emitted under other lamps"
run 1 "$work/over.obj" --quiet
check "with --quiet, too" [ "$status" -eq 1 -a "$(wc -l <"$work/log")" -eq 1 ]

# A room, closed from within and without, and a lamp below its ceiling.
cat >"$work/room.mtl" <<'END'
newmtl wall
Kd 0.5 0.5 0.5
newmtl lamp
Ke 1 1 1
END
# room LAMP: its walls from within, and the lamp at this height.
room() {
    echo usemtl wall
    box 4 3 5
    echo usemtl lamp
    printf 'v %s %s %s\n' 1 "$1" 1 3 "$1" 1 3 "$1" 4 1 "$1" 4
    echo f -4 -3 -2 -1
}
# with_backs: the room on its input, and its walls from without.
with_backs() {
    awk '{ print } /^f [1-9]/ { back[++n] = $1 " " $5 " " $4 " " $3 " " $2 }
        END { print "usemtl wall"; for (i = 1; i <= n; i++) print back[i] }'
}
{ echo mtllib room.mtl; room 2.9 | with_backs; } >"$work/room.obj"
run 1 "$work/room.obj" --paper
check "light that coarse links lose in a closed room is missed" \
    says "% of the light of this closed scene is lost: "
run 1 "$work/room.obj" --epsilon 1e-3 --two-sided
check "light that nothing loses is not" says none
sed '/^f 1 2 4 3$/d; /^f 3 4 2 1$/d' "$work/room.obj" >"$work/open.obj"
run 1 "$work/open.obj" --paper
check "light that leaves an open room is not" says none
# Links count both of two faces in one place: light grows without end.
(. tests/panel/scenes.sh && make_scene "$work/double" 0 twice .6 1)
run 1 "$work/double.obj" --paper --epsilon 1e-3
check "a furnace of rho .6 whose faces are there twice diverges" \
    [ "$status" -eq 1 -a "$(grep -c diverge "$work/log")" -eq 1 ]
# Walls that glow, one of them under the lamp.
cat >"$work/glow.mtl" <<'END'
newmtl wall
Kd 0.5 0.5 0.5
Ke 1 1 1
newmtl lamp
Kd 0.5 0.5 0.5
END
{ echo mtllib glow.mtl; room 3; } >"$work/glow.obj"
adds_up() {
    holds "($absorbed + $escaped) / $emitted - 1 < 1e-4 &&
        ($absorbed + $escaped) / $emitted - 1 > -1e-4 && $escaped > 0.01 * $emitted" &&
        says "% of the light of this closed scene is lost: "
}
run 1 "$work/glow.obj" --final-gather 64
check "light of a wall that is covered is lost, and powers add up" adds_up

# A wall once more, along the other diagonal.
awk '{ print } /^f 1 2 4 3/ { print "f 2 4 3"; print "f 2 3 1" }' "$work/room.obj" \
    >"$work/wall.obj"
run 1 "$work/wall.obj" --epsilon 1e-3
check "a wall over a wall absorbs too much" \
    says "% more light is absorbed than emitted: faces may lie on each other"

# boxes MATERIAL X Y Z SIZES...: boxes from outside, as $work/solid.obj.
boxes() {
    echo "$@" | xargs -n 7 | awk 'BEGIN { print "mtllib solid.mtl" }
        { for (k = 0; k < 8; k++)
            print "v", $2 + k % 2 * $5, $3 + int(k / 2) % 2 * $6, $4 + int(k / 4) * $7
          print "usemtl", $1
          print "f -8 -6 -5 -7\nf -4 -3 -1 -2\nf -8 -7 -3 -4"
          print "f -6 -2 -1 -5\nf -8 -4 -2 -6\nf -7 -5 -1 -3" }' >"$work/solid.obj"
}

# A room of six slabs, as of the brushes of a level, a lamp that touches the ceiling, and
# boxes that touch walls, floor and each other; one is hidden by others on all sides.
cat >"$work/solid.mtl" <<'END'
newmtl lamp
Ke 10 10 10
Kd 0.999 0.999 0.999
newmtl wall
Kd 0.999 0.999 0.999
END
boxes wall -.2 -.2 -.2 4.4 3.4 .2  wall -.2 -.2 2.5 4.4 3.4 .2 \
    wall -.2 -.2 0 .2 3.4 2.5  wall 4 -.2 0 .2 3.4 2.5 \
    wall 0 -.2 0 4 .2 2.5  wall 0 3 0 4 .2 2.5 \
    lamp 1.5 1 2.3 1 1 .2  wall 0 0 0 1 1 1  wall 1 0 0 1 1 .7  wall 0 1 0 .5 1 1.5 \
    wall 0 0 1 .8 .8 .5
for ranks in 1 3; do
    run $ranks "$work/solid.obj" --epsilon 1e-3 --final-gather 64
    check "a room of slabs keeps its light at rho .999, on $ranks" \
        holds "($absorbed / 54 - 1)^2 < 1e-6 && ($escaped)^2 < 1e-3"
    check "what its lamp sends at the ceiling is named: $touching W" [ "$touching" = 30 ]
    check "and nothing is warned of" says none
done

# warnings COMMAND...: number of warnings about the balance of light.
warnings() {
    "$@" 2>&1 >"$work/stdout" | grep -c 'absorbed than emitted\|off its balance'
}
check "a closed room that was off its balance is said to be" \
    [ "$(warnings ./phr tests/golden/corridor.obj --epsilon 1 --final-gather 4)" = 1 ]
check "it is not with more rays" \
    [ "$(warnings ./phr tests/golden/corridor.obj --epsilon 1e-3 \
        --final-gather 256)" = 0 ]

tap_done
