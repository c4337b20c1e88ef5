# Skies that vary, tables of directions, the sun, domes: the light of black squares
# against closed forms; one line for each error; the same bytes on any ranks.
. tests/tap.sh

printf 'newmtl black\nKd 0 0 0\nnewmtl grey\nKd .5 .5 .5\nnewmtl lamp\nKe 2 3 4\n' \
    >"$work/sky.mtl"
printf '%s\n' "mtllib sky.mtl" "usemtl black" "v 0 0 0" "v 1 0 0" "v 1 1 0" "v 0 1 0" \
    "f 1 2 3 4" >"$work/square.obj"
echo "0 .5 1e-3 0 1 0
0 .5 1e-3 0 -1 0
0 .5 1e-3 1 0 0
0 .5 1e-3 -1 0 0" >"$work/sides.csv"

near() { holds "$1 - $2 <= $3 * $2 && $2 - $1 <= $3 * $2"; }
# receives OPTIONS...: H of the square, mean of the bands.
receives() {
    $MPIEXEC -n ${ranks:-1} ./phr "$work/square.obj" --up z "$@" --quiet \
        --report "$work/h.csv" 2>"$work/log"
    awk -F, '$2 == "\"black\"" { print $8; exit }' "$work/h.csv"
}
# mean_of_clear X Y Z: H below a clear sky of zenith 1, the sun at (x, y, z), by points.
mean_of_clear() {
    awk -v x="$1" -v y="$2" -v z="$3" '
        function acos(c) { return atan2(sqrt(1 - c * c > 0 ? 1 - c * c : 0), c) }
        function f(s) { return .91 + 10 * exp(-3 * s) + .45 * cos(s) * cos(s) }
        BEGIN {
            pi = atan2(0, -1); n = 300; l = sqrt(x * x + y * y + z * z)
            for (i = 0; i < n; i++) for (j = 0; j < 4 * n; j++) {
                t = (i + .5) / n * pi / 2; a = (j + .5) / n * pi / 2
                c = (sin(t) * (cos(a) * x + sin(a) * y) + cos(t) * z) / l
                sum += f(acos(c)) * (1 - exp(-.32 / cos(t))) * cos(t) * sin(t)
            }
            print sum * (pi / 2 / n) ^ 2 / f(acos(z / l)) / (1 - exp(-.32)) }'
}

pi=3.14159265358979
for ranks in 1 3; do
    check "uniform, on $ranks" near "$(receives --sky 2)" 2 1e-6
    check "overcast: 7 pi / 9 Lz" near "$(receives --sky overcast,3,6,9)" \
        "(6 * 7 * $pi / 9)" 1e-5
    check "sun: W cos, by any of its surfaces" \
        near "$(receives --sun 2,-1,2,900)" 600 1e-5
    check "both" near "$(receives --sky overcast,3 --sun 0,0,7,50)" \
        "(50 + 3 * 7 * $pi / 9)" 1e-5
done
ranks=1
for sun in 1,0,1 -1,1,9 0,9,1; do
    check "a clear sky with the sun at $sun" near \
        "$(receives --sky clear,1 --sun $sun,0)" \
        "$(mean_of_clear $(echo $sun | tr , ' '))" 1e-4
done

# table PARTS BANDS GROUND: a sky brighter in the east, with a bright spot; and its H.
table() {
    awk -v m="$1" -v bands="$2" -v ground="$3" -v out="$work/H" '
        function put(l, weight) {
            l = sprintf("%.5g", l)
            H += l * weight
            print bands == 3 ? l " " 2 * l " 0" : l
        }
        BEGIN {
            pi = atan2(0, -1); split("30 30 24 24 18 12 6", n); a = pi / 2 / (7 * m + .5)
            if (bands == 3)
                print "#?RADIANCE\ngendaymtx -m 1\nNROWS=146\nFORMAT=ascii\n"
            if (ground) print bands == 3 ? "9 9 9" : 9
            for (i = 0; i < 7 * m; i++) {
                k = n[int(i / m) + 1] * m
                for (j = 0; j < k; j++) {
                    t = 2 * pi * j / k
                    put(1 + sin(t) + 5 * (i == 2 * m && j == m),
                        pi / k * (sin(a * (i + 1)) ^ 2 - sin(a * i) ^ 2))
                }
            }
            put(1, pi * cos(7 * m * a) ^ 2)
            print H >out }'
}
for kind in "1 3 1" "1 1 0" "2 1 1" "4 3 0"; do
    table $kind >"$work/table.mtx"
    check "a table of parts, bands, ground $kind" \
        near "$(receives --sky "$work/table.mtx")" "$(cat "$work/H")" 1e-4
done
./phr "$work/square.obj" --up z --sky "$work/table.mtx" --quiet --at "$work/sides.csv" \
    >"$work/sides.out"
check "the east is +x, where z is up" awk -F, 'NR > 1 { h[NR] = $10 } END {
    exit !(h[4] > 2 * h[5] && h[2] < 1.3 * h[3] && h[3] < 1.3 * h[2]) }' "$work/sides.out"

# A crater, a cap of a sphere of radius 1 open to the sun: all of it sends to any of its
# points alike, rho W r^2 cos / 4 (1 - rho f); shadows receive nothing else.
awk 'BEGIN {
    print "mtllib sky.mtl\nusemtl grey"; pi = atan2(0, -1); n = 48; m = 24
    for (i = 0; i <= m; i++) for (j = 0; j < n; j++) {
        t = i / m * pi / 3; a = 2 * pi * j / n
        printf "v %.9f %.9f %.9f\n", sin(t) * cos(a), sin(t) * sin(a), 1 - cos(t)
    }
    for (i = 0; i < m; i++) for (j = 0; j < n; j++)
        print "f", i * n + j + 1, (i + 1) * n + j + 1, (i + 1) * n + (j + 1) % n + 1, \
            i * n + (j + 1) % n + 1 }' >"$work/crater.obj"
echo "-.7071 0 .293 1 0 1" >"$work/shadow.csv"
./phr "$work/crater.obj" --up z --sun -2,0,1,100 --quiet --at "$work/shadow.csv" \
    >"$work/shadow.out" 2>"$work/log"
check "a crater: light in the shadow of its rim" near \
    "$(tail -n 1 "$work/shadow.out" | cut -d, -f10)" \
    "(.5 * 100 * .75 / sqrt(5) / 4 / (1 - .5 * .25))" .02

# A dome of facets, and what it is taken for.
{ cat "$work/square.obj"; echo usemtl lamp; awk 'BEGIN {
    pi = atan2(0, -1)
    for (i = 0; i <= 4; i++) for (j = 0; j < 16; j++)
        print "v", 9 * cos(i * pi / 8) * cos(j * pi / 8), \
            9 * cos(i * pi / 8) * sin(j * pi / 8), 9 * sin(i * pi / 8)
    for (i = 0; i < 4; i++) for (j = 0; j < 16; j++) {
        k = (j + 1) % 16
        print "f", 5 + 16 * i + k, 5 + 16 * i + j, 21 + 16 * i + j, 21 + 16 * i + k
    } }'; } >"$work/dome.obj"
./phr "$work/dome.obj" --quiet --report "$work/dome.csv"
check "a dome gives what it did" near \
    "$(awk -F, '$2 == "\"black\"" { print $8; exit }' "$work/dome.csv")" 3 1e-6
./phr "$work/dome.obj" --epsilon 1 -o "$work/dome.png" >"$work/out" 2>"$work/log"
check "it is told" grep -qF "lamps all around, of 2,3,4 W/m^2, are taken as a sky" \
    "$work/log"
check "and no face is without area" [ "$(grep -c "without area" "$work/log")" = 0 ]
sed '$d' "$work/dome.obj" >"$work/hole.obj"
./phr "$work/hole.obj" --epsilon 1 -o "$work/dome.png" >"$work/out" 2>"$work/log"
check "one with a hole stays" [ "$(grep -c "taken as a sky" "$work/log")" = 0 ]

# Facets of a sky send each other much, which counts nowhere: they have no links.
sed "s/usemtl black/usemtl grey/" "$work/square.obj" >"$work/grey.obj"
./phr "$work/grey.obj" --up z --sky 1 --paper --epsilon 1e-3 --memory 64M \
    --stats "$work/stats" >"$work/out" 2>"$work/log"
check "--paper: a sky has no links with itself" \
    holds "$(stat_of "$work/stats" links) < 10000"

# Errors, and outputs.
# refuses LINE OPTIONS...
refuses() {
    line=$1
    shift
    ./phr "$work/square.obj" --up z "$@" -o "$work/no.png" >"$work/out" 2>"$work/log"
    [ $? = 2 ] && [ "$(cat "$work/log")" = "phr: $line" ] && [ ! -e "$work/no.png" ] ||
        { sed 's/^/# /' "$work/log"; false; }
}
seq 144 >"$work/few.mtx"
{ seq 145; echo -1; } >"$work/below.mtx"
check "a sun below the horizon" refuses "--sun: this sun is below the horizon" \
    --sun 1,1,-1,9
check "a clear sky without a sun" refuses "--sky clear needs --sun x,y,z,W, W may be 0" \
    --sky clear,1
check "too few numbers" refuses "$work/few.mtx: 144 numbers are no sky: 145, 577, 2305 \
... patches, and perhaps the ground first, of one number or three each" \
    --sky "$work/few.mtx"
check "a number below 0" refuses "$work/below.mtx:146: a radiance below 0" \
    --sky "$work/below.mtx"
check "no sun" refuses "--sun: '1,2,3' is not x,y,z,W" --sun 1,2,3
check "no sky" refuses "--sky: '1,2' is not a number, three as in R,G,B, overcast,L, \
clear,L, or a file" --sky 1,2
check "no file" refuses "nowhere: cannot read: No such file or directory" --sky nowhere
check "a table is read: no output goes over it" refuses \
    "$work/few.mtx is read: no output goes over it" --sky "$work/few.mtx" \
    --stats "$work/few.mtx"
for ranks in 1 2 3 4 7; do
    $MPIEXEC -n $ranks ./phr "$work/crater.obj" --up z --sky "$work/table.mtx" \
        --sun 1,2,3,40 --epsilon 1e-2 --final-gather 16 --quiet -o "$work/$ranks.ply" \
        --size 32x24 -o "$work/$ranks.pfm" 2>"$work/log"
    check "the same on $ranks ranks" cmp "$work/1.ply" "$work/$ranks.ply"
    check "and as a picture" cmp "$work/1.pfm" "$work/$ranks.pfm"
done
check "a mesh names its sky" grep -aq "^comment --sun 1,2,3,40" "$work/1.ply"

tap_done
