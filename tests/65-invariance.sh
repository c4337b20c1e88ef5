# The unit of length must not matter, to the bit for powers of two, nor faces without
# area, a lamp that nobody sees, or a ground that no light reaches.

. tests/tap.sh

# move SCALE: the Cornell box and its view with every coordinate times SCALE.
move() {
    for file in cornell.obj cornell.view; do
        awk -v s="$1" '$1 == "v" || $1 == "eye" || $1 == "at" {
            printf "%s %.17g %.17g %.17g\n", $1, s * $2, s * $3, s * $4; next }
            { print }' scenes/$file >"$work/moved.${file#*.}"
    done
    cp scenes/cornell.mtl "$work/"
}

# run NAME SCENE VIEW
run() {
    ./phr "$2" --view "$3" --quiet --epsilon 1e-3 --size 64x64 -o "$work/$1.pfm" \
        --stats "$work/$1.json"
}

run plain scenes/cornell.obj scenes/cornell.view
for scale in 1048576 9.5367431640625e-07 0.5; do
    move $scale
    run scaled "$work/moved.obj" "$work/moved.view"
    check "scaled by $scale: the same picture, to the bit" \
        cmp "$work/plain.pfm" "$work/scaled.pfm"
    check "scaled by $scale: the same solution" \
        [ "$(stat_of "$work/plain.json" checksum)" = \
            "$(stat_of "$work/scaled.json" checksum)" ]
done

move 1
printf 'v 10 20 30\nv 40 50 60\nv 25 35 45\nf -3 -3 -2\nf -3 -3 -3\nf -3 -2 -1\n' \
    >>"$work/moved.obj"
run thin "$work/moved.obj" "$work/moved.view"
check "faces without area change no bit" cmp "$work/plain.pfm" "$work/thin.pfm"
for key in links absorbed_power; do
    check "nor $key" [ "$(stat_of "$work/plain.json" $key)" = \
        "$(stat_of "$work/thin.json" $key)" ]
done

# A room with a box, a lamp and a sheet half a thousandth in front of a wall, which it
# lights, with and without a black ground a thousand times as wide below it. Both answers
# err by chance, of 64 rays a leaf; they are apart by .3 %, root by root. With leaves
# limited to 1e-7 of the whole area it is 2.6 %, and if the ground's black dilutes the
# room's reflectance, so that one link seems enough for all, 2.1 %; 44 % of the light is
# lost if the sheet is taken to cover the wall.
for ground in none wide; do
    (. tests/panel/scenes.sh && make_scene "$work/$ground" 0 on_ground $ground)
    ./phr "$work/$ground.obj" --quiet --dump patches --stats "$work/$ground.json" |
        awk '$2 == 0 && $1 + 0 < 26 { print $4, $5 }' >"$work/$ground.roots"
done
apart=$(paste -d ' ' "$work/none.roots" "$work/wide.roots" | awk '
    { off += $1 * ($4 - $2) ^ 2; light += $1 * $2 ^ 2; roots++ }
    END { print roots == 26 ? 100 * sqrt(off / light) : "nan" }')
check "a room on a wide ground: apart by $apart %" holds "$apart <= 0.5"
a=$(stat_of "$work/none.json" absorbed_power)
b=$(stat_of "$work/wide.json" absorbed_power)
check "which absorbs as much light: $a, $b" holds "($b / $a - 1)^2 <= 0.005^2"

# A lamp far away that shines into the void, with 200 times the power of the other, is no
# reason to look less closely at what the other lights: with as much less epsilon, as many
# links. A fifth more or less, since clusters are cut by place, direction and size, of
# which place is told in units of the scene's box.
cp scenes/cornell.mtl "$work/void.mtl"
printf 'newmtl away\nKd 0 0 0\nKe 200 200 200\n' >>"$work/void.mtl"
{
    sed 's/^mtllib .*/mtllib void.mtl/' scenes/cornell.obj
    printf 'v 0 -2000 0\nv 1000 -2000 0\nv 0 -2000 1000\nusemtl away\nf -3 -2 -1\n'
} >"$work/void.obj"
emitted=$(stat_of "$work/plain.json" emitted_power)
./phr "$work/void.obj" --quiet --final-gather 0 --stats "$work/void.json" \
    --epsilon "$(awk "BEGIN { printf \"%.9g\", 1e-3 * $emitted / ($emitted + 3e8) }")"
a=$(stat_of "$work/plain.json" links)
b=$(stat_of "$work/void.json" links)
check "beside a strong lamp that shines into the void: links $a, $b" \
    holds "($b - $a)^2 < (0.2 * $a)^2"

tap_done
