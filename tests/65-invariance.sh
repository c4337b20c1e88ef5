# Two things must not matter: the unit of length, and where the scene lies.

. tests/tap.sh

# move EXPRESSION: the Cornell box and its view with every coordinate c replaced by
# EXPRESSION.
move() {
    awk "function f(c) { return sprintf(\"%.17g\", $1) }
         \$1 == \"v\" { print \"v\", f(\$2), f(\$3), f(\$4); next } { print }" \
        scenes/cornell.obj >"$work/moved.obj"
    awk "function f(c) { return sprintf(\"%.17g\", $1) }
         \$1 == \"eye\" || \$1 == \"at\" {
             print \$1, f(\$2), f(\$3), f(\$4); next } { print }" \
        scenes/cornell.view >"$work/moved.view"
    cp scenes/cornell.mtl "$work/"
}

# run NAME SCENE VIEW
run() {
    ./phr "$2" --view "$3" --quiet --epsilon 1e-3 --size 64x64 -o "$work/$1.pfm" \
        --stats "$work/$1.json"
}

run plain scenes/cornell.obj scenes/cornell.view
for scale in 1048576 9.5367431640625e-07 0.5; do
    move "c * $scale"
    run scaled "$work/moved.obj" "$work/moved.view"
    check "scaled by $scale: the same picture, to the bit" \
        cmp "$work/plain.pfm" "$work/scaled.pfm"
    check "scaled by $scale: the same solution" \
        [ "$(stat_of "$work/plain.json" checksum)" = \
            "$(stat_of "$work/scaled.json" checksum)" ]
done

# Seven digits of the box's 3 survive an offset of a million sizes in a double: 16 - 6 - 3
# (the coordinates' own). Decisions to split may flip on that; the powers may not notice.
move "c + 5.5e8"
run shifted "$work/moved.obj" "$work/moved.view"
a=$(stat_of "$work/plain.json" absorbed_power)
b=$(stat_of "$work/shifted.json" absorbed_power)
check "moved by a million sizes: the same absorbed power within 1e-4 ($a, $b)" \
    holds "($a - $b < 1e-4 * $a) && ($b - $a < 1e-4 * $a)"

# A scale that is not a power of two changes last bits, not the light.
move "c * 0.001"
run metres "$work/moved.obj" "$work/moved.view"
b=$(stat_of "$work/metres.json" absorbed_power)
check "in metres: a million times less power, within 1e-4" \
    holds "($a - 1e6 * $b < 1e-4 * $a) && (1e6 * $b - $a < 1e-4 * $a)"

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
