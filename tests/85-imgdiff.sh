# imgdiff: the figures it prints, against ones worked out by hand; its exit status; its
# files. Solutions of phr against themselves and against a finer one.
. tests/tap.sh

out=$work/stdout
err=$work/stderr

# diff_of ARGUMENTS...: runs imgdiff; leaves $out, $err and $status.
diff_of() {
    "$IMGDIFF" "$@" >"$out" 2>"$err"
    status=$?
}

# ends CODE NAME ARGUMENTS...: imgdiff ends with the status, on an error with one line.
ends() {
    code=$1
    name=$2
    shift 2
    diff_of "$@"
    check "$name" [ "$status" -eq "$code" ]
    [ "$code" -ne 2 ] || check "with one line: $(cat "$err")" is_complaint
}

is_complaint() {
    [ ! -s "$out" ] && [ "$(wc -l <"$err")" -eq 1 ] && grep -q '^imgdiff: ' "$err"
}

says() {
    grep -qxF -- "$1" "$out" && return
    sed 's/^/# /' "$out" "$err"
    return 1
}

# --- pictures: 2 x 1 pixels, of 100 ---

plain() { printf 'P3 %s 100 %s\n' "$2" "$3" >"$work/$1.ppm"; }
plain b '2 1' '60 80 0  0 0 0'
plain off '2 1' '60 80 0  0 0 30'
plain small '1 1' '60 80 0'
plain cut '2 1' '60 80 0'

diff_of "$work/off.ppm" "$work/b.ppm"
check "largest difference" says 'max         0.3'
check "mean over samples: 0.3 / 6" says 'mean        0.05'
check "rms: sqrt(0.09 / 6)" says 'rms         0.122474'
check "relative to sqrt(1 / 6) of the expected" says 'relative    0.734847 max, 0.3 rms'
check "psnr: 20 lg (1 / rms)" says 'psnr        18.24 dB (peak 1)'
check "not the same" [ "$status" -eq 1 ]
ends 0 "the same" "$work/b.ppm" "$work/b.ppm"
check "no difference" says 'psnr        infinite'
ends 1 "below the difference" --tolerance 0.7348 "$work/off.ppm" "$work/b.ppm"
ends 0 "above it" --tolerance 0.7349 "$work/off.ppm" "$work/b.ppm"
ends 1 "below the RMS" "$work/off.ppm" "$work/b.ppm" --rms 0.29
ends 0 "above it, whatever the largest" "$work/off.ppm" "$work/b.ppm" --rms 0.31
ends 1 "both bounds count" "$work/off.ppm" "$work/b.ppm" --rms 0.31 --tolerance 0.5

printf 'Pf 1 1 -1 \0\0\300\177' >"$work/nan.pfm"
printf 'Pf 1 1 -1 \0\0\200\077' >"$work/one.pfm"
printf 'PF 1 1 1 \077\200\0\0\077\200\0\0\077\200\0\0' >"$work/big.pfm"
ends 0 "grey and colour, both byte orders" "$work/one.pfm" "$work/big.pfm"
ends 1 "NaN never passes" --tolerance 1e30 "$work/nan.pfm" "$work/one.pfm"
ends 1 "not against itself" --tolerance 1e30 "$work/nan.pfm" "$work/nan.pfm"
check "and is counted" says 'not finite  3 samples'

hdr='#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X'
printf "$hdr 1\n\200\200\200\201" >"$work/one.hdr"
printf "$hdr 2\n\231\314\0\200\0\0\0\0" >"$work/b.hdr"
ends 0 "linear, of two formats" "$work/one.hdr" "$work/big.pfm"
ends 2 "HDR and codes" "$work/b.hdr" "$work/b.ppm"

# PNG of another program, with all types of colours, filters and blocks, and its PPM of
# the same codes.
for png in tests/fuzz/corpus/image/*.png; do
    ends 0 "the codes of $png" --tolerance 0 "$png" "${png%.png}.ppm"
done
png=tests/fuzz/corpus/image/rgba.png
# changed AT BYTE: the file with this byte, in octal, at this place from 0.
changed() {
    head -c "$1" "$png"
    printf "\\$2"
    tail -c +"$(($1 + 2))" "$png"
}
changed 24 20 >"$work/deep.png"
changed 28 1 >"$work/interlaced.png"
changed 150 0 >"$work/damaged.png"
head -c 200 "$png" >"$work/short.png"
changed 19 12 >"$work/wider.png"
changed 16 177 >"$work/huge.png"
for kind in deep interlaced huge; do
    ends 2 "PNG: $kind" "$work/$kind.png" "${png%.png}.ppm"
    check "$kind: not read" grep -q 'not a PNG of 8 bits a sample, without interl' "$err"
done
for kind in damaged short wider; do
    ends 2 "PNG: $kind" "$work/$kind.png" "${png%.png}.ppm"
    check "$kind: damaged" grep -q 'the PNG is damaged' "$err"
done

# --- blocks: 3 x 2 grey pixels, of 64; the third column is a block of its own ---

printf 'P3 3 2 64 16 16 16 32 32 32 32 32 32  48 48 48 32 32 32 16 16 16' \
    >"$work/noisy.ppm"
printf 'P3 3 2 64 32 32 32 32 32 32 32 32 32  32 32 32 32 32 32 64 64 64' \
    >"$work/smooth.ppm"
ends 0 "a block has the mean of its pixels" --blocks 2 --below 0.9 "$work/noisy.ppm" \
    "$work/smooth.ppm"
check "the one with a bright pixel is left out" says 'psnr        infinite'
diff_of --blocks 2 "$work/noisy.ppm" "$work/smooth.ppm" -o "$work/map.pfm"
check "its means: 0.75 - 0.375" says 'max         0.375'
check "by area: 0.375 / 3" says 'mean        0.125'
check "0.375 / sqrt(3), of sqrt((2 * 0.5^2 + 0.75^2) / 3)" says \
    'relative    0.630126 max, 0.363803 rms'
row='\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\300\076\0\0\300\076\0\0\300\076'
printf "PF\n3 2\n-1.0\n$row$row" >"$work/map.expected"
check "-o: the difference of a block in its pixels" \
    cmp "$work/map.pfm" "$work/map.expected"
ends 2 "nothing is left" --below 0.1 "$work/noisy.ppm" "$work/smooth.ppm"
ends 2 "half a pixel" --blocks 2.5 "$work/noisy.ppm" "$work/smooth.ppm"
ends 2 "no pixel" --blocks 0 "$work/noisy.ppm" "$work/smooth.ppm"

# --- the difference as a picture ---

diff_of "$work/off.ppm" "$work/b.ppm" -o "$work/map.pfm"
printf 'PF\n2 1\n-1.0\n\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\232\231\231\076' \
    >"$work/map.expected"
check "-o: |A - B| as PFM" cmp "$work/map.pfm" "$work/map.expected"
diff_of "$work/off.ppm" "$work/b.ppm" -o "$work/map.ppm"
printf 'P6\n2 1\n255\n\0\0\0\0\0\377' >"$work/map.expected"
check "-o: the largest is white as PPM" cmp "$work/map.ppm" "$work/map.expected"
diff_of "$work/off.ppm" "$work/b.ppm" -o "$work/map.hdr"
check "-o: |A - B| as HDR: 0.3 is 153.6 / 256 of 2^-1" \
    [ "$(tail -c 2 "$work/map.hdr" | od -An -tx1)" = ' 9a 7f' ]
diff_of "$work/off.ppm" "$work/b.ppm" -o "png:$work/map"
check "-o: as PNG" [ "$(head -c 4 "$work/map" | tail -c 3)" = PNG ]
cp "$work/map.ppm" "$work/map.expected"
diff_of "$work/off.ppm" "$work/b.ppm" -o ppm:-
check "-o to the standard output: the map alone" cmp "$out" "$work/map.expected"
check "and the report on stderr" grep -qx 'max         0.3' "$err"
ends 1 "-o into a missing folder" "$work/off.ppm" "$work/b.ppm" -o "$work/absent/map.ppm"

# --- standard errors: 16 x 8 grey pixels, two blocks of 8 x 8, by fours in turns ---

# turns NAME FLOAT FLOAT FLOAT FLOAT: a picture of these floats, as bytes in octal.
turns() {
    turn="$2$3$4$5" file=$work/$1.pfm
    turn=$turn$turn$turn$turn turn=$turn$turn$turn$turn
    printf "Pf 16 8 -1 $turn$turn" >"$file"
}
one='\0\0\200\077' two='\0\0\0\100' more='\0\0\220\077' less='\0\0\140\077'
turns one $one $one $one $one
turns more $more $more $more $more      # 1.125
turns less $less $less $less $less      # 0.875
turns noisy $two $one $one $one         # mean 1.25, scatter 0.0546 of it
for e in 074 075; do                    # 2^-6 and 2^-5
    byte='\0\0\'$([ $e = 074 ] && echo 200 || echo 0)'\'$e
    turns error-$e "$byte" "$byte" "$byte" "$byte"
done
ends 0 "--error: 0.125 is four errors of 2^-5" --error "$work/error-075.pfm" \
    "$work/more.pfm" "$work/one.pfm"
check "and so it agrees" says \
    'agrees: 0 of 2 blocks of 8 x 8 beyond 4 standard errors, worst 4 at (0, 0), brighter'
ends 1 "and eight of 2^-6" --error "$work/error-074.pfm" "$work/less.pfm" \
    "$work/one.pfm" -o "$work/map.ppm"
check "and so it differs" says \
    'differs: 2 of 2 blocks of 8 x 8 beyond 4 standard errors, worst 8 at (0, 0), darker'
check "the whole, too" grep -q '^differs: 1 of 1 blocks of 16 x 16 .* worst 8 at' "$out"
check "-o: darker by eight is blue" \
    [ "$(tail -c 3 "$work/map.ppm" | od -An -tx1)" = ' 00 00 ff' ]
ends 1 "brighter" --error "$work/error-074.pfm" "$work/more.pfm" "$work/one.pfm" \
    -o "$work/map.ppm"
check "is red" [ "$(tail -c 3 "$work/map.ppm" | od -An -tx1)" = ' ff 00 00' ]
ends 1 "-o: as numbers" --error "$work/error-074.pfm" "$work/more.pfm" "$work/one.pfm" \
    -o "$work/map.pfm"
check "of standard errors: $(tail -c 4 "$work/map.pfm" | od -An -tf4)" \
    holds "$(tail -c 4 "$work/map.pfm" | od -An -tf4) / 8 - 1 < 1e-6"
ends 1 "0.25 with noise of 0.0546 and an error of 2^-6: 4.4" \
    --error "$work/error-074.pfm" "$work/noisy.pfm" "$work/one.pfm"
check "the scatter counts" grep -q '^differs: 2 of 2 .* worst 4.4 at' "$out"
ends 1 "the whole picture has less noise: 5.0 by an error of 2^-5" \
    --error "$work/error-075.pfm" "$work/noisy.pfm" "$work/one.pfm"
check "its blocks agree" says \
    'agrees: 0 of 2 blocks of 8 x 8 beyond 4 standard errors, worst 4 at (0, 0), brighter'
ends 2 "an error of another size" --error "$work/one.hdr" "$work/one.pfm" "$work/one.pfm"
ends 2 "an error of codes" --error "$work/error-074.pfm" "$work/b.ppm" "$work/b.ppm"
ends 2 "no block is left" --error "$work/error-074.pfm" --below 0.5 "$work/one.pfm" \
    "$work/one.pfm"
printf "Pf 16 8 -1 " >"$work/broken.pfm"
tail -c 512 "$work/one.pfm" | head -c 508 >>"$work/broken.pfm"
printf '\0\0\300\177' >>"$work/broken.pfm"
ends 1 "NaN is beyond all errors" --error "$work/error-075.pfm" "$work/broken.pfm" \
    "$work/one.pfm"

# --- bad usage and input ---

ends 2 "no files"
ends 2 "one file" "$work/b.ppm"
ends 2 "three files" "$work/b.ppm" "$work/b.ppm" "$work/b.ppm"
ends 2 "unknown option" "$work/b.ppm" "$work/b.ppm" --fast
ends 2 "no value" "$work/b.ppm" "$work/b.ppm" --tolerance
ends 2 "bad tolerance" "$work/b.ppm" "$work/b.ppm" --tolerance -1
ends 2 "bad name of the map" "$work/b.ppm" "$work/b.ppm" -o "$work/map.gif"
ends 2 "missing file" "$work/b.ppm" "$work/absent.ppm"
ends 2 "cut off" "$work/cut.ppm" "$work/b.ppm"
ends 2 "another size" "$work/small.ppm" "$work/b.ppm"
ends 2 "linear and not" "$work/one.pfm" "$work/small.ppm"
ends 2 "a picture and a mesh" "$work/one.pfm" tests/golden/mesh.ply
ends 2 "a mesh that is no solution" tests/golden/mesh.ply tests/golden/mesh.ply

# --- solutions ---

solve() {
    $MPIEXEC -n 2 "$PHR" --quiet tests/golden/room.obj --epsilon "$1" -o "$2"
}
solve 1e-2 "$work/coarse.ply"
solve 1e-3 "$work/fine.ply"
$MPIEXEC -n 2 "$PHR" --quiet --epsilon 1e-2 tests/golden/furnace.obj \
    -o "$work/furnace.ply"
ends 0 "a solution and itself" "$work/fine.ply" "$work/fine.ply"
ends 1 "a coarse one and a finer one" "$work/coarse.ply" "$work/fine.ply"
coarse=$(sed -n 's/.* max, \(.*\) rms/\1/p' "$out")
check "are some percent apart: $coarse" holds "$coarse > 0.001 && $coarse < 0.2"
diff_of "$work/fine.ply" "$work/coarse.ply"
check "the way back is alike" holds \
    "$(sed -n 's/.* max, \(.*\) rms/\1/p' "$out") / $coarse > 0.9 && 1.1 > $coarse / $(
        sed -n 's/.* max, \(.*\) rms/\1/p' "$out")"
ends 2 "blocks of a mesh" --blocks 2 "$work/fine.ply" "$work/fine.ply"
ends 2 "solutions of two scenes" "$work/fine.ply" "$work/furnace.ply"
ends 2 "a mesh, its difference as a picture" "$work/fine.ply" "$work/fine.ply" \
    -o "$work/map.ppm"
ends 2 "pictures, their difference as a mesh" "$work/b.ppm" "$work/b.ppm" \
    -o "$work/map.ply"
diff_of "$work/coarse.ply" "$work/coarse.ply" -o "$work/nothing.ply"
diff_of "$work/coarse.ply" "$work/fine.ply" -o "$work/map.ply"
mean=$(sed -n 's/^mean *//p' "$out")
diff_of "$work/map.ply" "$work/nothing.ply"
found=$(sed -n 's/^mean *//p' "$out")
check "the mesh of the differences has their mean: $found" holds \
    "$mean > 0 && $found / $mean > 0.9999 && $found / $mean < 1.0001"
head -c 3000 "$work/fine.ply" >"$work/cut.ply"
ends 2 "a solution cut off" "$work/cut.ply" "$work/fine.ply"

area() {
    $MPIEXEC -n 2 "$BUILD/viewfactors" --quiet --max-level 0 --epsilon 1 "$1" |
        awk -F, '$2 == "*" { s += $3 } END { print s }'
}
check "a mesh is a scene for viewfactors, of the same area" \
    holds "$(area "$work/coarse.ply") / $(area tests/golden/room.obj) - 1 < 1e-6"

tap_done
