# Irradiance: in meshes, at points, by object and in false colours, against closed forms;
# the same on any ranks, and of stored solutions.
. tests/tap.sh

printf 'newmtl black\nKd 0 0 0\nnewmtl grey\nKd .5 .5 .5\n' >"$work/h.mtl"
printf 'newmtl lamp\nKe 5 5 5\nnewmtl glow\nKd .5 .5 .5\nKe 1 1 1\n' >>"$work/h.mtl"

# number FILE NAME COLUMN: of a report, of its line of this name.
number() { awk -F, -v n="\"$2\"" -v c="$3" '$2 == n { print $c; exit }' "$1"; }
# near A B SHARE
near() { holds "$1 - $2 <= $3 * $2 && $2 - $1 <= $3 * $2"; }
phr_on() {
    on=$1
    shift
    $MPIEXEC -n "$on" ./phr "$@" 2>"$work/log"
}

# A black square below a sky receives it all.
printf '%s\n' "mtllib h.mtl" "usemtl black" "o sensor" "v 0 0 0" "v 1 0 0" "v 1 0 -1" \
    "v 0 0 -1" "f 1 2 3 4" >"$work/square.obj"
printf 'eye .5 3 -.49\nat .5 0 -.5\nsize 160 120\nfov 20\n' >"$work/above.view"
phr_on 1 "$work/square.obj" --sky 1 --quiet --view "$work/above.view" \
    --report "$work/square.csv" --size 64x48 --show irradiance -o "$work/square.pfm"
for column in 8 9 10; do
    check "a black square below a sky of 1: irradiance 1, column $column" \
        near "$(number "$work/square.csv" sensor $column)" 1 1e-6
done
check "all is absorbed" near "$(number "$work/square.csv" black 5)" 3 1e-6
check "no radiosity" [ "$(number "$work/square.csv" black 7)" = 0 ]
printf 'x,y,z,nx,ny,nz\n.5 0 -.5 0 1 0\n.5,9,-.5,0,2,0\n.5;1;-.5;1;0;0 # up\n' \
    >"$work/sky.csv"
phr_on 1 "$work/square.obj" --sky 1 --quiet --at "$work/sky.csv" >"$work/sky.out"
check "points on it and above: 1, and an upright one .5" awk -F, '
    NR > 1 && ($10 - (NR == 4 ? .5 : 1)) ^ 2 > 2.5e-7 { exit 1 } END { exit NR != 4 }' \
    "$work/sky.out"
check "the linear picture has it, too, but for some grain" near "$(tail -c \
    $((12 * (24 * 64 + 26))) "$work/square.pfm" | od -An -tf4 -N4)" 1 .03

# A lamp of 2 x 2 at a height of 1.5, whose factor at a point below is Lambert's.
printf '%s\n' "mtllib h.mtl" "usemtl black" "o floor" "v -9 0 -9" "v -9 0 9" "v 9 0 9" \
    "v 9 0 -9" "f 1 2 3 4" "usemtl lamp" "o lamp" "v -1 1.5 -1" "v 1 1.5 -1" \
    "v 1 1.5 1" "v -1 1.5 1" "f 5 6 7 8" >"$work/lamp.obj"
echo 0 0 0 0 1 0 >"$work/lamp.csv"
expected=$(awk 'BEGIN { a = 1 / 1.5; r = sqrt(1 + a * a)
    print 5 * 4 / (2 * atan2(0, -1)) * 2 * a / r * atan2(a, r) }')
phr_on 1 "$work/lamp.obj" --quiet --at "$work/lamp.csv" >"$work/lamp.out"
check "a point below a lamp receives $expected W/m^2" \
    near "$(tail -n 1 "$work/lamp.out" | cut -d, -f10)" "$expected" 1e-5
phr_on 1 "$work/lamp.obj" --quiet --lux --at "$work/lamp.csv" >"$work/lux.out"
check "and 179 times as many lux" near "$(tail -n 1 "$work/lux.out" | cut -d, -f10)" \
    "($expected * 179)" 1e-5
check "which the heading says" grep -q ',illuminance,error$' "$work/lux.out"

# In a furnace H is 2 wherever, also in the air; powers of a report add up.
{ printf '%s\n' "mtllib h.mtl" "usemtl glow" "o walls"; box 2 2 2; } >"$work/furnace.obj"
printf '%s\n' "1 1 1 0 0 1" "1 1 1 1 2 3" "0 1 1 1 0 0" "1.9 .1 1.9 -1 0 0" \
    >"$work/furnace.csv"
phr_on 1 "$work/furnace.obj" --quiet --at "$work/furnace.csv" >"$work/furnace.out"
check "in a furnace each point receives 2" awk -F, 'NR > 1 && ($10 - 2) ^ 2 > 1e-6 ||
    NR > 1 && ($10 - 2) ^ 2 > $11 ^ 2 + 1e-12 { exit 1 } END { exit NR != 5 }' \
    "$work/furnace.out"

box="scenes/cornell.obj --epsilon 1e-3 --final-gather 64 --quiet"
printf '%s\n' "278 0 279.5 0 1 0" "278 274 279.5 0 1 0" "100 100 100 1 1 0" \
    >"$work/box.csv"
all() {
    phr_on $1 $box --stats "$work/box.json" --at "$work/box.csv" --size 160x120 \
        --view scenes/cornell.view --report "$work/$1.csv" --show irradiance --lines 4 \
        -o "$work/$1.ppm" -o "$work/$1.pfm" -o "$work/$1.ply" -o "$work/$1.vtk" \
        -o "$work/$1.glb" \
        >"$work/$1.out"
}
all 1
for ranks in 2 3 4 7; do
    all $ranks
    for kind in csv ppm pfm ply vtk glb out; do
        check "the same .$kind on $ranks" cmp "$work/1.$kind" "$work/$ranks.$kind"
    done
done
absorbed=$(awk -F, '$1 == "object" { sum += $5 } END { print sum }' "$work/1.csv")
check "a report absorbs what the summary says" \
    near "$absorbed" "$(stat_of "$work/box.json" absorbed_power)" 1e-4
check "by material, too" near "$absorbed" \
    "$(awk -F, '$1 == "material" { sum += $5 } END { print sum }' "$work/1.csv")" 1e-5
check "least, mean and most are in order" awk -F, 'NR > 1 && ($9 > $8 || $8 > $10) {
    exit 1 }' "$work/1.csv"
phr_on 1 "$work/1.ply" --quiet --at "$work/box.csv" --report "$work/stored.csv" \
    --show irradiance --lines 4 --size 160x120 --view scenes/cornell.view \
    -o "$work/stored.pfm" >"$work/stored.out"
check "a stored solution has the same points" sh -c 'paste -d, "$0" "$1" |
    awk -F, "NR > 1 && (\$10 - \$21) ^ 2 > 1e-8 * \$10 ^ 2 { exit 1 }"' \
    "$work/1.out" "$work/stored.out"
check "and pictures" $IMGDIFF "$work/1.pfm" "$work/stored.pfm" --rms 1e-2 >"$work/out"

# False colours: with an exposure of 1 the last colour is 1 W/m^2, the strip white.
phr_on 1 "$work/square.obj" --sky 1 --quiet --view "$work/above.view" --exposure 1 \
    --show irradiance -o "$work/false.ppm"
pixel() { tail -c $((3 * (160 * (120 - $2) - $1))) "$work/false.ppm" |
    od -An -tu1 -N3 | tr -s ' '; }
check "1 is yellow in false colours:$(pixel 80 50)" \
    sh -c 'set -- $0; [ $1 -gt 240 -a $2 -gt 220 -a $3 -lt 60 ]' "$(pixel 80 50)"
check "the scale is on white:$(pixel 158 117)" [ "$(pixel 158 117)" = " 255 255 255" ]
check "which has numbers and a unit" [ "$(tail -c $((3 * 160 * 11)) "$work/false.ppm" |
    od -An -v -tu1 -w3 | grep -c '^ *0  *0  *0$')" -gt 60 ]
phr_on 1 "$work/square.obj" --sky 1 --view "$work/above.view" --show radiosity \
    -o "$work/false.ppm" >"$work/out"
check "the legend is told" grep -q '^phr: legend: radiosity from 0, dark, to ' "$work/log"

# refused WORDS LINES: as points.
refused() {
    printf "$2" >"$work/bad.csv"
    ./phr "$work/square.obj" --sky 1 --at "$work/bad.csv" >"$work/out" 2>"$work/log"
    [ $? -eq 2 ] && [ ! -s "$work/out" ] &&
        [ "$(cat "$work/log")" = "phr: $work/bad.csv$1" ] && return
    sed 's/^/# /' "$work/log"
    return 1
}
check "five numbers" refused ":2: a point is x y z nx ny nz, not 5 numbers" \
    '0 0 0 0 0 1\n1 2 3 4 5\n'
check "no number" refused ":2: bad number 'up'" '0 0 0 0 0 1\n1 2 3 0 up 0\n'
check "no normal" refused ":1: the normal has no length" '0 0 0 0 0 0\n'
check "no points" refused ": no points" 'x y z\n# none\n'
./phr "$work/square.obj" --at "$work/sky.csv" -o - >"$work/out" 2>"$work/log"
check "points and a picture on the standard output" grep -qx \
    "phr: --at and an output to the standard output do not go together" "$work/log"
./phr "$work/square.obj" --at "$work/sky.csv" --report "$work/sky.csv" 2>"$work/log"
check "no report goes over points" \
    grep -qx "phr: $work/sky.csv is read: no output goes over it" "$work/log"

tap_done
