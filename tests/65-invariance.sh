# The unit of length must not matter, to the bit for powers of two (other scales and
# places: tests/whole/stability.c), nor a lamp that nobody sees.

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
