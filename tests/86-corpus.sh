# Pictures of a renderer beside those of `make corpus`: the right one passes at four
# standard errors, and each of eleven slips is seen. The renderer is the path tracer, by
# 64 paths a pixel, on a scene with the slip in it.
. tests/tap.sh

: "${PATHTRACER:=build/pathtracer}"
SCENES='shadow plane' SIZE=64 CORPUS=$work PHR=$PHR \
    SETTINGS='--epsilon 1e-4 --final-gather 512,pixels' \
    sh tests/corpus.sh >"$work/log" 2>&1
check "two scenes of the corpus" [ -s "$work/shadow.error.pfm" -a -s "$work/plane.pfm" ]

# traced NAME OPTIONS...: a picture of $work/made.obj by $work/made.view.
traced() {
    picture=$work/$1.pfm
    shift
    $MPIEXEC -n 2 "$PATHTRACER" "$work/made.obj" --quiet --view "$work/made.view" \
        --samples 64 "$@" -o "$picture"
}

# beside SCENE PICTURE: compares; the words are in $work/words.
beside() {
    "$IMGDIFF" "$2" "$work/$1.pfm" --error "$work/$1.error.pfm" >"$work/words" 2>&1
}
agrees() {
    beside "$@" && return
    sed 's/^/# /' "$work/words"
    return 1
}

# edited SCENE FILE PROGRAM: $work/made.* are those of a scene, one changed by awk.
edited() {
    for end in obj mtl view; do
        cp "$work/$1.$end" "$work/made.$end"
    done
    sed "s/^mtllib .*/mtllib made.mtl/" "$work/$1.obj" >"$work/made.obj"
    cp "$work/made.$2" "$work/from"
    awk "$3" "$work/from" >"$work/made.$2"
}

for scene in shadow plane; do
    edited $scene obj '{ print }'
    traced right
    check "$scene: the right picture agrees" agrees $scene "$work/right.pfm"
done

# slip TEXT SCENE FILE PROGRAM OPTIONS...: it is seen.
slip() {
    text=$1 scene=$2
    edited "$2" "$3" "$4"
    shift 4
    traced slip "$@"
    check "$text: seen" is_seen "$scene" "$work/slip.pfm"
}
is_seen() {
    ! beside "$1" "$2" && grep -q '^differs: ' "$work/words"
}
names() { grep -q "times B: a factor of $1?" "$work/words"; }

# Pictures by the defaults, and their own errors.
for name in 1 1.02; do
    edited shadow mtl '$1 == "newmtl" { wall = $2 == "wall" }
        wall && $1 == "Kd" { $2 *= '$name'; $3 = $4 = $2 } { print }'
    "$PHR" "$work/made.obj" --quiet --view "$work/made.view" -o "$work/$name.pfm" \
        -o "$work/$name.error.pfm"
done
check "a picture by the defaults agrees by its own error" agrees 1 "$work/shadow.pfm"
check "one of another reflectance does not" is_seen 1.02 "$work/shadow.pfm"

slip "a lamp of Ke times pi" shadow mtl '$1 == "Ke" { $2 *= pi; $3 *= pi; $4 *= pi }
    BEGIN { pi = atan2(0, -1) } { print }'
check "and named" names pi
slip "a lamp of the radiance" shadow mtl '$1 == "Ke" { $2 /= pi; $3 /= pi; $4 /= pi }
    BEGIN { pi = atan2(0, -1) } { print }'
check "and named" names "1 / pi"
slip "half of a lamp" shadow obj '$1 == "usemtl" { lamp = $2 == "lamp" }
    lamp && $1 == "f" { $0 = "f " $2 " " $3 " " $4 } { print }'
slip "Kd off by 2 %" shadow mtl '$1 == "newmtl" { wall = $2 == "wall" }
    wall && $1 == "Kd" { $0 = "Kd .612 .612 .612" } { print }'
slip "one by 2 % on a plane" plane mtl '$1 == "Kd" && $2 > 0 { $0 = "Kd .51 .51 .51" }
    { print }'
slip "flipped normals of a box" shadow obj '$1 == "usemtl" { box = $2 == "box" }
    box && $1 == "f" { $0 = "f " $5 " " $4 " " $3 " " $2 } { print }'
slip "a box three centimetres off" shadow obj '
    $1 == "v" && $2 > 1.9 && $2 < 3.1 && $3 > .9 && $3 < 1.7 { $2 += .03 } { print }'
slip "a camera 2 cm off" shadow view '$1 == "eye" { $2 += .02; $3 -= .02 } { print }'
slip "an angle of 71 degrees for 70" shadow view '$1 == "fov" { $2 = 71 } { print }'
slip "lamps that shine on both sides" shadow mtl '{ print }' --two-sided-lamps

# The codes of a screen, taken for light: the root of each float, as bytes.
{ printf 'PF\n64 64\n-1\n'
    tail -c 49152 "$work/right.pfm" | od -An -v -tf4 | awk '{
        for (i = 1; i <= NF; i++) {
            x = $i > 0 ? $i ^ (1 / 2.2) : 0
            for (e = 127; x > 0 && x < 1; e--) x *= 2
            for (; x >= 2; e++) x /= 2
            bits = x > 0 ? e * 8388608 + int((x - 1) * 8388608) : 0
            for (k = 0; k < 4; k++) {
                printf "%c%03o", 92, bits % 256
                bits = int(bits / 256)
            }
        }
        print ""
    }' | while read -r bytes; do printf "$bytes"; done; } >"$work/gamma.pfm"
check "gamma twice: seen" is_seen plane "$work/gamma.pfm"

# --- the converters: Ke of 10 W/m^2 is the radiance 3.183 ---

if command -v python3 >/dev/null; then
    python3 tools/to_pbrt.py "$work/plane" >"$work/plane.pbrt"
    check "pbrt: the radiance" \
        grep -q '"rgb L" \[3.18309886[0-9]* 3.18' "$work/plane.pbrt"
    python3 tools/to_mitsuba.py "$work/plane"
    check "Mitsuba: the radiance" \
        grep -q 'name="radiance" value="3.18309886[0-9]*, 3.18' "$work/plane.xml"
    check "and the lamp's faces" [ "$(grep -c '^3 ' "$work/plane-lamp.ply")" -eq 2 ]
else
    tap 0 "pbrt and Mitsuba # SKIP there is no python3"
fi
if command -v blender >/dev/null; then
    blender -b --factory-startup -P tools/to_blender.py -- "$work/plane" >"$work/log" 2>&1
    blender -b "$work/plane.blend" -P tests/cycles.py -- 64 1 "$work/cycles.pfm" \
        >>"$work/log" 2>&1
    check "Blender: Cycles agrees, by 64 paths" agrees plane "$work/cycles.pfm"
else
    tap 0 "Blender # SKIP it is not installed"
fi

tap_done
