# Other programs open phr's outputs and find the numbers of the .pfm, the .ppm and the
# .ply, the right way up. Those that are not installed are skipped. Debian has them in the
# packages netpbm, imagemagick, openimageio-tools, python3-vtk9, python3-meshio
# and blender.
. tests/tap.sh

./phr scenes/cornell.obj --view scenes/cornell.view --size 96x64 --samples 1 \
    --epsilon 1e-2 --final-gather 64 --quiet -o "$work/a.ply" -o "$work/a.vtk" \
    -o "$work/a.glb" \
    -o "$work/a.pfm" -o "$work/a.ppm" -o "$work/a.hdr" -o "$work/a.png"
check "outputs of all formats" [ "$(ls "$work" | wc -l)" -eq 7 ]

# has PROGRAM: true if it is installed; else a test that is skipped.
has() {
    command -v "$1" >/dev/null && return
    tap 0 "$1 opens the outputs # SKIP it is not installed"
    return 1
}

# same_codes COMMAND...: it turns the .png into the .ppm, byte for byte.
same_codes() {
    "$@" >"$work/codes.ppm" 2>"$work/log" && cmp "$work/codes.ppm" "$work/a.ppm"
}

# diff_of A B ARGUMENTS...: imgdiff passes, or shows its words.
diff_of() {
    "$IMGDIFF" "$@" >"$work/diff" && return
    sed 's/^/# /' "$work/diff"
    return 1
}

# A step of samples below 1 is 1 / 256, 0.018 of their RMS.
near_light() {
    diff_of "$1" "$work/a.pfm" --below 1 --tolerance 0.02
}

check "imgdiff: .hdr has the light of .pfm" near_light "$work/a.hdr"
if has pngtopnm; then
    check "netpbm: .png has the codes of .ppm" same_codes pngtopnm "$work/a.png"
fi

# ImageMagick has 16 bits a sample, up to 1: lamps are cut off. It takes .pfm for sRGB.
if has convert && convert -version 2>/dev/null | grep -q '^Version: ImageMagick'; then
    check "ImageMagick: .png has the codes of .ppm" \
        same_codes convert "$work/a.png" +set comment ppm:-
    convert "$work/a.hdr" +set comment -set colorspace sRGB "pfm:$work/magick.pfm"
    check "ImageMagick: .hdr has the light of .hdr read by imgdiff" \
        diff_of "$work/magick.pfm" "$work/a.hdr" --below 1 --tolerance 1e-4
    check "and of .pfm" near_light "$work/magick.pfm"
fi

# A step of the lamp is 54 / 256; single pixels are compared by the copy.
if has oiiotool; then
    oiiotool --fail 0.22 "$work/a.hdr" "$work/a.pfm" --diff >"$work/log"
    tap $? "OpenImageIO: .hdr has the light of .pfm"
    oiiotool "$work/a.hdr" -o "$work/copy.hdr"
    check "a copy with run lengths has that of .hdr" \
        diff_of "$work/copy.hdr" "$work/a.hdr" --tolerance 0
    oiiotool "$work/a.png" -o "$work/copy.ppm"
    check "OpenImageIO: .png has the codes of .ppm" cmp "$work/copy.ppm" "$work/a.ppm"
fi

# taps NAME COMMAND...: a test for each "ok" and "not ok" of the command.
taps() {
    name=$1
    shift
    "$@" >"$work/$name.log" 2>&1
    grep -E '^(not )?ok ' "$work/$name.log" >"$work/lines"
    while read -r word rest; do
        [ "$word" = ok ]
        tap $? "${rest#ok }"
    done <"$work/lines"
    grep -qx "ok $name has opened all" "$work/lines" && return
    tap 1 "$name has opened all"
    sed 's/^/# /' "$work/$name.log"
}

python=
for name in python3 /usr/bin/python3; do
    "$name" -c 'import vtkmodules.vtkIOLegacy' 2>/dev/null && python=$name
done
if [ "$python" ]; then
    taps vtk "$python" tests/foreign.py vtk "$work"
else
    tap 0 "VTK opens the outputs # SKIP there is no Python module of VTK 9"
fi
python=
for name in python3 /usr/bin/python3; do
    "$name" -c 'import meshio' 2>/dev/null && python=$name
done
if [ "$python" ]; then
    taps meshio "$python" tests/foreign.py meshio "$work"
else
    tap 0 "meshio opens the .vtk # SKIP there is no meshio"
fi
if has python3; then
    taps gltf python3 tests/foreign.py gltf "$work"
fi
if has blender; then
    taps blender blender -b --factory-startup -P tests/foreign.py -- blender "$work"
fi

tap_done
