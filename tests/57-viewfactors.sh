# viewfactors: exact without blockers (tests/rad/beyond/factors.c), within 0.5 % with
# them and within 0.1 % if asked for; the error is what it says, or smaller; tables have
# what they should have, and are the same on any number of ranks and without MPI, whatever
# the unit of length and the place of the scene.

. tests/tap.sh

# table FILE ARGUMENTS...: the table of $work/FILE.obj goes to $work/FILE.csv.
table() {
    table_name=$1
    shift
    "$BUILD/viewfactors" --quiet --dense "$work/$table_name.obj" "$@" \
        >"$work/$table_name.csv"
}

# value FILE FROM TO: F.
value() {
    awk -F, -v from="$2" -v to="$3" '$1 == from && $2 == to { print $4 }' "$work/$1.csv"
}

# near VALUE EXPECTED RELATIVE ABSOLUTE
near() {
    awk -v v="$1" -v e="$2" -v r="$3" -v a="$4" 'BEGIN {
        d = v - e; d = d < 0 ? -d : d; limit = r * (e < 0 ? -e : e) + a
        if (v == "" || !(d <= limit)) { print "# " v " instead of " e; exit 1 } }'
}

# --- with blockers: F, and the largest error of F as it is told ---

# claimed FILE ARGUMENTS...: the table, and the error that the run tells in $claim.
claimed() {
    claimed_name=$1
    shift
    $MPIEXEC -n 1 "$BUILD/viewfactors" --dense "$work/$claimed_name.obj" "$@" </dev/null \
        >"$work/$claimed_name.csv" 2>"$work/log"
    claim=$(sed -n 's/.*largest error of F: //p' "$work/log")
}

# keeps_claim FILE FROM TO EXACT: F is within 1.5 times the error that was told.
keeps_claim() {
    near "$(value "$1" "$2" "$3")" "$4" 0 "$(echo "${claim:-x}" |
        awk '{ print 1.5 * $1 + 1e-11 }')"
}

awk -F, '/^(OB|V)[0-9]+,/ { print $1, $3 }' docs/oracle/cases.csv >"$work/cases"
check "17 blocked pairs" [ "$(wc -l <"$work/cases")" -eq 17 ]
while read -r id exact; do
    "$BUILD/score" --obj docs/oracle/cases.csv "$id" >"$work/$id.obj"
    table "$id"
    check "$id by default" near "$(value "$id" 1 2)" "$exact" 0.005 1e-12
    table "$id" --epsilon 1e-4
    check "$id at epsilon 1e-4" near "$(value "$id" 1 2)" "$exact" 0.001 1e-12
    for wanted in "--epsilon 0.1" "--epsilon 0.01" "--accuracy 1e-3" "--accuracy 1e-4"; do
        claimed "$id" $wanted
        check "$id with $wanted: within 1.5 times the error that it tells ($claim)" \
            keeps_claim "$id" 1 2 "$exact"
        case $wanted in
        *accuracy*) check "which is what was asked for" holds "$claim <= ${wanted#* }" ;;
        esac
    done
done <"$work/cases"

# less FILE SCREEN: F(A, B) without screens, of which none is in the shadow of another,
# less F(A, screens): F(A, B) past them, exact.
less() {
    echo "$(value bare a b)" "$(value "$1" a "$2")" | awk '{ printf "%.15g", $1 - $2 }'
}

# Twenty-five small squares in one plane.
awk 'BEGIN {
    print "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0"
    print "v -9 -9 1\nv -9 10 1\nv 10 10 1\nv 10 -9 1"
    print "g a\nf 1 2 3 4\ng b\nf 5 6 7 8" }' >"$work/bare.obj"
{ cat "$work/bare.obj"; awk 'BEGIN {
    print "g squares"
    for (k = 0; k < 25; k++) {
        x = 0.2 * (k % 5); y = 0.2 * int(k / 5)
        print "v", x, y, 0.5; print "v", x, y + 0.1, 0.5
        print "v", x + 0.1, y + 0.1, 0.5; print "v", x + 0.1, y, 0.5
        print "f -4 -3 -2 -1"
    } }'; } >"$work/grid.obj"
table bare
for wanted in "" "--accuracy 1e-3"; do
    claimed grid $wanted
    check "50 triangles between ${wanted:-by default}: within 1.5 times $claim" \
        keeps_claim grid a b "$(less grid squares)"
done
check "as was asked for" holds "$claim <= 1e-3"
check "without a warning" [ "$(grep -c warning "$work/log")" -eq 0 ]
claimed grid --accuracy 1e-4 --max-level 0
check "an error that --max-level holds up is told ($claim)" \
    grep -q 'warning: the largest error of F is .*, not the 0.0001 of' "$work/log"
table bare --accuracy 1e-4
check "without blockers all is exact" near "$(value bare a b)" 1 0.1 0
claimed bare
check "and said to be" [ "$claim" = 0 ]

# A wall, in most part below the horizon of a small triangle, and in part behind 26
# triangles, which hide nothing but wall: ends of segments on a patch of the wall may all
# lie below the horizon, or all but one.
while read -r height hidden half; do
    awk -v h="$height" 'BEGIN {
        print "v 0 0 0\nv 0.01 0 0\nv 0 0.01 0\ng a\nf 1 2 3"
        print "v 1 -2 -9\nv 1 -2", h, "\nv 1 2", h, "\nv 1 2 -9\ng b\nf 4 5 6 7"
        }' >"$work/bare.obj"
    { cat "$work/bare.obj"; awk -v h="$hidden" -v half="$half" 'BEGIN {
        print "g screen"
        for (k = -6.5; k < 6.5; k++) {
            y = k * half / 6.5; z = (k + 1) * half / 6.5
            print "v 0.5", y, 0; print "v 0.5", y, h
            print "v 0.5", z, h; print "v 0.5", z, 0
            print "f -4 -3 -2 -1"
        } }'; } >"$work/horizon.obj"
    table bare
    for epsilon in 0.1 0.03 0.01; do
        claimed horizon --epsilon $epsilon
        check "a wall up to $height, at epsilon $epsilon: within 1.5 times $claim" \
            keeps_claim horizon a b "$(less horizon screen)"
    done
done <<END
0.15 0.05 0.9
0.4 0.1 0.2
0.8 0.2 0.8
END

# --- the unit of length, and which way the scene looks ---

# moved FROM TO SCALE: turned by 73.74 degrees about one axis and 36.87 about another,
# moved, and scaled.
moved() {
    awk -v s="$3" '$1 == "v" {
        x = 0.28 * $2 - 0.96 * $3; y = 0.96 * $2 + 0.28 * $3
        z = 0.8 * $4 - 0.6 * y; y = 0.6 * $4 + 0.8 * y
        printf "v %.17g %.17g %.17g\n", s * (x + 2.5), s * (y - 1.25), s * z; next }
        { print }' "$work/$1.obj" >"$work/$2.obj"
}

# same_factors A B SCALE: tables that are equal within 1e-9, but for the unit of area.
same_factors() {
    paste -d, "$work/$1.csv" "$work/$2.csv" | awk -F, -v s="$3" 'NR > 1 {
        d = $4 - $8; a = $7 / ($3 * s * s) - 1
        if ($1 != $5 || $2 != $6 || d * d > 1e-18 || a * a > 1e-18) {
            print "# " $0; bad = 1 } }
        END { exit bad || NR < 2 }'
}

for id in OB1 OB7 OB9 OB11 V1 V6; do
    table $id --epsilon 1e-4
    for scale in 1 1e-6 1e6; do
        moved $id moved $scale
        table moved --epsilon 1e-4
        check "$id turned and moved, times $scale" same_factors $id moved $scale
    done
done

# --- tables ---

# faces: the unit cube from inside, each face a group.
faces() {
    box 1 1 1 | awk 'BEGIN { split("floor ceiling front back left right", name) }
        /^f/ { print "o", name[++n] } { print }'
}

# block LOW HIGH: the cube [LOW, HIGH]^3 from outside, a group.
block() {
    awk -v low="$1" -v high="$2" 'BEGIN {
        print "g block"
        for (k = 0; k < 8; k++)
            print "v", k % 2 ? high : low, int(k / 2) % 2 ? high : low,
                int(k / 4) ? high : low
        print "f -8 -6 -5 -7\nf -4 -3 -1 -2\nf -8 -7 -3 -4"
        print "f -6 -2 -1 -5\nf -8 -4 -2 -6\nf -7 -5 -1 -3" }'
}

# rows_are_one FILE TOLERANCE: and there are as many as groups.
rows_are_one() {
    awk -F, -v t="$2" \
        'NR == 1 { next } !($1 in seen) { seen[$1] = 1; groups++ } $2 == "*" {
        rows++; if ($4 < 1 - t || $4 > 1 + t) { print "# " $0; bad = 1 } }
        END { exit bad || rows != groups || NR != 1 + groups * (groups + 1) }' \
        "$work/$1.csv"
}

# is_reciprocal FILE: A_i F_ij = A_j F_ji but for the rounding of a division.
is_reciprocal() {
    awk -F, 'NR > 1 && $2 != "*" { g[$1, $2] = $3 * $4; name[$1] = 1 } END {
        for (i in name) for (j in name) {
            d = g[i, j] - g[j, i]; d = d < 0 ? -d : d
            if (d > 1e-15 * g[i, j]) { print "# " i, j, g[i, j], g[j, i]; exit 1 } } }' \
        "$work/$1.csv"
}

faces >"$work/box.obj"
table box
check "a box: its header" [ "$(head -n 1 "$work/box.csv")" = "from,to,area_from,F" ]
check "its groups, in the order of the file" \
    [ "$(awk -F, '$2 == "*" { printf "%s ", $1 }' "$work/box.csv")" = \
        "floor ceiling front back left right " ]
check "its rows sum to 1" rows_are_one box 1e-9
check "opposite faces" near "$(value box floor ceiling)" 0.199824895698387 1e-9 0
check "adjacent faces" near "$(value box left back)" 0.200043776075403 1e-9 0
check "a plane face does not see itself" [ "$(value box floor floor)" = 0 ]

"$BUILD/viewfactors" "$work/box.obj" >"$work/sparse.csv" 2>"$work/errors"
awk -F, '$2 == "*" || $4 > 0' "$work/box.csv" >"$work/some.csv"
check "without --dense those that are 0 are left out" \
    cmp "$work/sparse.csv" "$work/some.csv"
check "a closed box has no warning" [ "$(grep -c warning "$work/errors")" -eq 0 ]
# warned TEXT COMMAND...: of the box, changed.
warned() {
    text=$1
    shift
    "$@" "$work/box.obj" >"$work/changed.obj"
    "$BUILD/viewfactors" "$work/changed.obj" 2>&1 >"$work/out" | grep -qF "$text"
}
check "a face that looks away is told" \
    warned "2 of the triangles look away from all others (first in right)" \
    awk '/^o right/ { turned = 1 }
        /^f/ && turned { print "f", $5, $4, $3, $2; next } { print }'
{ cat "$work/box.obj"; block 0.3 0.6 | awk '$1 == "v" { $4 -= 0.3 } { print }'; } \
    >"$work/stands.obj"
check "and rows of a closed scene that do not sum to 1" sh -c "
    '$BUILD/viewfactors' '$work/stands.obj' 2>&1 >'$work/out' |
    grep -qF '2 rows do not sum to 1, as the others do (first: floor, 0.91'"

sed -e 's/^o floor/o open/' -e '/^o [cfblr]/d' "$work/box.obj" |
    awk '/^f 2 6 8 4/ { print "o lid" } { print }' >"$work/concave.obj"
table concave
check "a box without its lid sees itself" near "$(value concave open open)" 0.8 1e-9 0
check "and the lid" near "$(value concave open lid)" 0.2 1e-9 0
check "which sees only the box" near "$(value concave lid open)" 1 1e-9 0

{ faces; block 0.3 0.6; } >"$work/blocked.obj"
table blocked
check "a box with a block in it: its rows sum to 1" rows_are_one blocked 1e-3
check "reciprocity" is_reciprocal blocked
check "the block does not see itself" [ "$(value blocked block block)" = 0 ]
table blocked --epsilon 1e-4
check "nearer at epsilon 1e-4" rows_are_one blocked 2e-4

# A block that stands on the floor: the covered part sees nothing, the rest sees all.
{ faces; block 0.3 0.6 | awk '$1 == "v" { $4 -= 0.3 } { print }'; } >"$work/standing.obj"
table standing --epsilon 1e-4
check "a block on the floor: the row of the floor lacks the covered part" \
    near "$(value standing floor '*')" 0.91 1e-3 0
check "so does that of the block, of which a face is hidden" \
    near "$(value standing block '*')" 0.8333333333333333 1e-9 0
sed -E 's/^((floor|block),\*,.*),.*/\1,1/' "$work/standing.csv" >"$work/others.csv"
check "the other rows sum to 1" rows_are_one others 1e-3

{ box 1 1 1; block 0.3 0.6 | sed 's/^g .*//'; } >"$work/nameless.obj"
table nameless --epsilon 1e-3
check "without names: one group" \
    [ "$(cut -d, -f1-2 "$work/nameless.csv" | tr '\n' ' ')" = \
    "from,to default,default default,* " ]
check "which is closed" near "$(value nameless default default)" 1 1e-3 0
check "and has the area of all" \
    near "$(awk -F, 'NR == 2 { print $3 }' "$work/nameless.csv")" \
    6.54 1e-12 0

cat >"$work/names.obj" <<'END'
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 0 1 1
v 1 1 1
v 1 0 1
o unused
o upper, "left"
f 5 6 7
g
f 1 2 3
g lower right
f 1 3 4
o upper, "left"
f 5 7 8
END
table names
check "names: order, blanks, quotes, default, repeated, unused" \
    [ "$(grep ',\*,' "$work/names.csv" | sed 's/,\*,.*//' | tr '\n' ';')" = \
    '"upper, ""left""";default;lower right;' ]
check "the groups of a repeated name are one" \
    near "$(sed -n 's/^"upper, ""left""",\*,1,//p' "$work/names.csv")" \
        0.199824895698387 1e-9 0

# Two squares, back to back: with twins each has two sides, one of which sees the other.
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n' \
    >"$work/back.obj"
printf 'g a\nf 4 3 2 1\ng b\nf 5 6 7 8\n' >>"$work/back.obj"
table back
check "squares back to back" [ "$(value back a b)" = 0 ]
table back --two-sided
check "see each other with --two-sided" near "$(value back a b)" 0.0999124478491935 1e-9 0
check "where both sides count" \
    [ "$(awk -F, 'NR == 2 { print $3 }' "$work/back.csv")" = 2 ]
# The first is a lamp.
printf 'newmtl lamp\nKe 1 1 1\nnewmtl grey\n' >"$work/lamp.mtl"
awk 'BEGIN { print "mtllib lamp.mtl" }
    { print }
    $1 == "g" { print "usemtl", $2 == "a" ? "lamp" : "grey" }' \
    "$work/back.obj" >"$work/lamps.obj"
table lamps --two-sided
check "the back of a lamp is not seen" [ "$(value lamps a b)" = 0 ]
check "one side of it counts" grep -q '^a,b,1,' "$work/lamps.csv"
table lamps --two-sided-lamps
check "with --two-sided-lamps both do" grep -q '^a,b,2,' "$work/lamps.csv"
check "and it is seen" near "$(value lamps a b)" 0.0999124478491935 1e-9 0
table OB1 --two-sided
check "a blocked pair with --two-sided" near "$(value OB1 1 2)" 0.074934335887 0.01 0

# --- bodies of thousands of facets, by rays ---

# Coaxial tubes of 4,088 triangles: inscribed, so smaller than Howell's C-91 by up to
# (2 pi / 146)^2 / 6 = 3.1e-4.
(. tests/panel/scenes.sh
    tubes() {
        paint inner .5 1
        walk 146 .25 1 .25 0 7
        paint outer .5 0
        walk 146 .5 0 .5 1 7
    }
    make_scene "$work/tubes" 0 tubes)
check "4,088 triangles" [ "$(grep -c '^f' "$work/tubes.obj")" -eq 2044 ]
for row in "inner outer" "outer outer"; do
    exact=$(awk -F, -v what="F $row" '$1 ~ /^coaxial-1/ && $2 == what { print $3 }' \
        docs/oracle/cases.csv)
    for wanted in 1e-2 2e-3; do
        claimed tubes --accuracy $wanted
        check "$row at $wanted is within $claim and its facets" near \
            "$(value tubes $row)" "$exact" 3.1e-4 "$claim"
        check "which is what was asked for" holds "$claim <= $wanted"
    done
done
check "reciprocity" is_reciprocal tubes
$MPIEXEC -n 3 "$BUILD/viewfactors" --quiet --dense "$work/tubes.obj" --accuracy 2e-3 \
    >"$work/three.csv"
check "the same on three ranks" cmp "$work/tubes.csv" "$work/three.csv"

# --- the same bytes everywhere ---

cp scenes/cornell.obj scenes/cornell.mtl "$work"
for scene in cornell blocked V7; do
    "$BUILD/viewfactors" --quiet "$work/$scene.obj" --accuracy 1e-3 >"$work/alone.csv"
    for ranks in 2 3 4 7; do
        $MPIEXEC -n $ranks "$BUILD/viewfactors" --quiet "$work/$scene.obj" \
            --accuracy 1e-3 >"$work/ranks.csv" 2>"$work/errors"
        check "$scene on $ranks ranks" cmp "$work/alone.csv" "$work/ranks.csv"
        check "silently" [ ! -s "$work/errors" ]
    done
done

# --- refused options and scenes ---

# refused TEXT ARGUMENTS...: status 2 at once, one line that begins with the text, no
# table.
refused() {
    text=$1
    shift
    timeout 5 "$BUILD/viewfactors" "$@" >"$work/out" 2>"$work/errors"
    [ $? -eq 2 ] && [ ! -s "$work/out" ] && [ "$(wc -l <"$work/errors")" -eq 1 ] &&
        case $(cat "$work/errors") in
        "viewfactors: $text"*) ;;
        *) cat "$work/errors"; false ;;
        esac
}

awk 'BEGIN { print "v 0 0 0\nv 1 0 0"; for (i = 0; i < 8193; i++)
    print "v 0 1 " i "\ng " i "\nf 1 2 -1" }' \
    >"$work/many.obj"
check "no scene" refused "no scene given"
check "a scene that is not there" \
    refused "$work/absent.obj: cannot read" "$work/absent.obj"
for option in "-o a.ppm" "--stats a.json" "--samples 2" "--solver cg" \
    "--sky 1"; do
    check "${option% *}" refused "unknown option ${option% *};" "$work/box.obj" $option
done
check "too many groups" \
    refused "$work/many.obj: 8193 groups are more than 8192" "$work/many.obj"

# --- the words ---

said=$("$PHR" --form-factors "$work/box.obj" 2>&1)
check "phr --form-factors says where it went: $said" \
    [ $? -eq 2 -a \
    "${said% *}" = "phr: --form-factors is a program of its own now: viewfactors" ]

tap_done
