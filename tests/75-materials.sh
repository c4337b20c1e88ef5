# Materials that are no materials, but for numbers that are none (tests/io/obj.c): an
# emission out of range is refused; reflectances of 1 and more are not, but said to be set
# to 0.999; statements without effect are noted.

. tests/tap.sh

cat >"$work/scene.obj" <<END
mtllib scene.mtl
usemtl one
v 0 0 0
v 1 0 0
v 0 1 0
f 1 2 3
END

# try KD KE: runs phr with this material; its words in $said, its exit status in $status.
try() {
    printf 'newmtl one\nKd %s\nKe %s\n' "$1" "$2" >"$work/scene.mtl"
    said=$(./phr "$work/scene.obj" 2>&1 >"$work/stdout")
    status=$?
}

try "0 0 0" "1e31 0 0"
largest="$work/scene.obj: the largest Ke, 1e+31, is not within 1e-30 and 1e+30"
check "an emission beyond the floats of the outputs is refused: $said" \
    [ "$status" -eq 2 -a "$said" = "phr: $largest" -a ! -s "$work/stdout" ]
try "1 2 1" "1 1 1"
clamped="warning: 1 material(s) with a reflectance of 1 or more, set to 0.999"
is_clamped() {
    [ "$status" -eq 0 ] && case $said in *"$clamped"*) ;; *) return 1 ;; esac
}
check "reflectances of 1 and 2 are clamped, with a warning" is_clamped
try "0.5 0.5 0.5" "1e30 1e30 1e30"
is_done() { [ "$status" -eq 0 ] && ! grep -qiE 'nan|inf' "$work/stdout"; }
check "the largest emission has a defined result" is_done

# Statements without effect are noted once for each kind.
cat >"$work/notes.mtl" <<END
newmtl lamp
Kd 0 0 0
Ke 1 1 1
newmtl glass
Kd 0.5 0.5 0.5
d 0.25
newmtl painted
map_Kd wood.png
Ks .5 .5 .5
illum 2
norm wood.png
newmtl measured
Kd spectral grass.rfl
newmtl
Kd 0.5 0.5 0.5
END
cat >"$work/notes.obj" <<END
mtllib notes.mtl
mtllib absent.mtl
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
vn nan nan nan
curv 0 1 1 2
usemtl lamp
f 1 2 3
usemtl glass
f 1//1 4//1 2
usemtl painted
f 1 3 4
usemtl nothing
f 2 4 3
usemtl measured
f 2 3 4
surf 0 1 0 1 1 2 3
END
said=$(./phr "$work/notes.obj" 2>&1 >"$work/stdout" | grep warning)
notes="phr: $work/notes.obj: warning:"
texture="material(s) with a texture: Kd, or Ke, times the mean over its faces counts"
texture="$texture; where that cannot be read (1, first: $work/wood.png), Kd alone,"
texture="$texture or .5 if it is 1; PNG of 8 bits and PPM are read: \`magick a.jpg"
texture="$texture a.png\` makes one"
unread="material(s) with Kd or Ke as spectral or xyz, not read: Kd is grey, and Ke 0"
expected="$notes 1 material file(s) missing or not readable (first: absent.mtl)
$notes 1 material(s) without a definition, taken as grey (first: nothing)
$notes 1 newmtl without a name: taken as the material of usemtl without one
$notes 1 material(s) with d, Tr, Tf or illum 4 are panes, which links, view factors and \
--paper do not see
$notes 1 $texture
$notes 2 keyword(s) of materials passed over: Ks norm
$notes 1 $unread
$notes 2 corner(s) with a vn that is no direction, or not there: ignored
$notes 2 line(s) with other keywords or numbers passed over (first: line 8)"
are_the_notes() {
    [ "$said" = "$expected" ] && return
    echo "$said" | sed 's/^/# /'
    return 1
}
check "statements without effect are noted once for each kind" are_the_notes

# A picture of half white counts, on any number of ranks, and no output goes over it.
printf 'P3 2 1 255 255 255 255 0 0 0\n' >"$work/wood.png"
printf 'newmtl lamp\nKe 1 1 1\nKd 1 1 1\nmap_Kd wood.png\n' >"$work/notes.mtl"
printf 'newmtl lamp\nKe 1 1 1\nKd .5 .5 .5\n' >"$work/half.mtl"
sed 's/notes.mtl/half.mtl/' "$work/notes.obj" >"$work/half.obj"
for ranks in 1 3; do
    for name in half notes; do
        $MPIEXEC -n $ranks ./phr "$work/$name.obj" --epsilon 1e-2 -o "$work/$name.pfm" \
            --size 9x9 >"$work/$name.out" 2>"$work/said"
    done
    check "a texture of half white is a Kd of one half, on $ranks" \
        cmp "$work/half.pfm" "$work/notes.pfm"
done
check "which is said" grep -q ': 1 material(s) with a texture: .*counts$' "$work/said"
said=$(./phr "$work/notes.obj" -o "$work/wood.png" 2>&1)
check "no output goes over a texture: $said" \
    [ "$said" = "phr: $work/wood.png is read: no output goes over it" ]

# emitted FILE OPTIONS...: the emitted power, W.
emitted() {
    ./phr --epsilon 1e-2 --final-gather 0 "$@" 2>/dev/null |
        sed -n 's/^power *\([^ ]*\) W emitted.*/\1/p'
}
cat >"$work/lamp.ply" <<END
$(ply_head 3 1 emission_r emission_g emission_b)
0 0 0
1 0 0
0 1 0
3 0 1 2 1 1 1
END
try "0.5 0.5 0.5" "1 1 1"
for lamp in scene.obj lamp.ply; do
    radiosity=$(emitted "$work/$lamp" --ke radiosity)
    radiance=$(emitted "$work/$lamp" --ke radiance)
    check "$lamp: $radiosity W by radiosity, $radiance by radiance" \
        holds "$radiosity == 1.5 && ($radiance / 1.5 - 3.14159265) ^ 2 < 1e-10"
done
sed 's/^1 0 0$/& 7/' "$work/lamp.ply" >"$work/long.ply"
said=$(./phr "$work/long.ply" 2>&1 >"$work/stdout" | grep warning)
long="1 line(s) with more values than the header says, passed over (first: line 14)"
check "values that the header does not have are passed over, which is said" \
    [ "$said" = "phr: $work/long.ply: warning: $long" ]
sed 's/^element face/property float nx\n&/; s/^[01] [01] 0$/& 7/
    s/^end_header/element edge 0\nproperty int vertex1\n&/' "$work/lamp.ply" \
    >"$work/more.ply"
passed="element(s) or propert(ies) passed over:"
said=$(./phr "$work/more.ply" 2>&1 >"$work/stdout" | grep warning)
check "elements and properties that are not read are named" \
    [ "$said" = "phr: $work/more.ply: warning: 2 $passed nx edge" ]
./phr "$work/scene.obj" --quiet --ke radiance --checkpoint "$work/of-radiance"
said=$(./phr "$work/scene.obj" --quiet --resume "$work/of-radiance" 2>&1)
made="made with --ke radiance, this run has --ke radiosity"
check "a checkpoint of radiances does not go on with radiosities" \
    [ "$said" = "phr: $work/of-radiance: $made" ]

# Converters write colours of 0 where a file has none.
try "0.5 0.5 0.5" "0 0 0"
sed 's/^v .*/& 0 0 0/' "$work/scene.obj" >"$work/black.obj"
for ranks in 1 3; do
    $MPIEXEC -n $ranks ./phr "$work/black.obj" --stats "$work/black.json" \
        >"$work/stdout" 2>"$work/said"
    numbers() {
        grep -q '; and nothing reflects any' "$work/said" &&
            ! grep -qiE '(nan|inf)[, ]' "$work/black.json" "$work/stdout"
    }
    check "that nothing reflects is said, and row sums are numbers, on $ranks" numbers
done

try "0 0 0" "1 1 1"
./phr "$work/scene.obj" --accuracy 1% >"$work/stdout" 2>"$work/said"
check "--accuracy does not converge where no surface reflects" \
    [ -n "$(grep '^iterations .*(not converged)' "$work/stdout")" -a \
        "$(grep -c 'warning: --accuracy has nothing to measure' "$work/said")" = 1 ]

tap_done
