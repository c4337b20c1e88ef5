# `make corpus`: twelve scenes for other renderers in build/corpus/: NAME.obj, .mtl,
# .view; the right picture, NAME.pfm, and the standard errors of its pixels,
# NAME.error.pfm, by phr: all light at each pixel, by RAYS rays. docs/corpus.md says how
# they get into a renderer, and how its pictures are compared.
#
# No back of a face is lit but of black ones, so renderers that reflect on both sides may
# take part. SCENES: names of some; SIZE: pixels along a side; SETTINGS: of phr.
set -eu
: "${PHR:=./phr}" "${MPIEXEC:=mpiexec}" "${SCENES:=}" "${SIZE:=128}"
: "${CORPUS:=build/corpus}"
: "${SETTINGS:=--epsilon 1e-5 --final-gather 1024,pixels}"
export LC_ALL=C
. tests/panel/scenes.sh
mkdir -p "$CORPUS"

below_a_sky() { # all light comes through a window
    paint wall .6 0
    sheet z 0 + 0 0 5 4
    sheet z 2.7 - 0 0 5 4
    sheet x 0 + 0 0 4 2.7
    sheet x 5 - 0 0 4 2.7
    sheet y 4 - 0 0 5 2.7
    sheet y 0 + 0 0 5 2.7 1 1 4 2.4
    paint sky 0 1
    room -20 -20 -20 25 25 25
    view .4 3.6 1.7 3 .3 1 65
}

# name | scene, as in tests/panel/table | eye, at and angle, where it has no view
while IFS='|' read -r name scene eye; do
    name=${name%% *}
    case " $SCENES " in "  " | *" $name "*) ;; *) continue ;; esac
    file=$CORPUS/$name
    if [ -f "scenes/${scene# }.obj" ]; then
        scene=scenes/${scene# }
        cp scenes/*.mtl "$CORPUS" && cp "$scene.obj" "$file.obj"
        cp "$scene.view" "$file.view"
    else
        make_scene "$file" 0 $scene
        [ -z "$eye" ] || echo $eye | while read -r x y z a b c angle; do
            printf '%s\n' "eye $x $y $z" "at $a $b $c" "up 0 0 1" "fov $angle"
        done >"$file.view"
    fi
    grep -v -e '^size' -e '^#' "$file.view" >"$file.new"
    echo "size $SIZE $SIZE" >>"$file.new"
    mv "$file.new" "$file.view"
    echo "$file"
    $MPIEXEC -n 2 "$PHR" "$file.obj" --quiet $SETTINGS --view "$file.view" \
        -o "$file.pfm" -o "$file.error.pfm" </dev/null
done <<END
cornell  |cornell
furnace  | furnished .5 | .05 .05 .5 .9 .8 .45 85
box      | white .7 1.6 1.2 .8 2.4 1.9 1.5 x- x+ y- y+ z- z+ | .3 .3 1.4 2.2 1.6 1.1 75
corridor |corridor
doorway  |doorway
window   | below_a_sky
plane    | spot .2 1 10 | 0 -1.6 1.2 0 0 .2 50
pipe     | pipe 24 16 .9 4 | .6 0 3.8 -.3 .1 0 70
colours  | one_band | .3 .3 1.4 3 2 .8 75
shadow   | long_lamp
ball     | ball_lamp 24
contact  | contact
END
