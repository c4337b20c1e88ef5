# Several views in one run, and outputs that do not depend on each other.

. tests/tap.sh

quiet="--quiet --epsilon 1e-2"
box="scenes/cornell.obj $quiet"
printf 'eye 278 273 -800\nat 278 273 0\nsize 40 30\n' >"$work/front.view"
printf 'eye 100 400 100\nat 278 100 400\nsize 24 32\n' >"$work/above.view"
front="--view $work/front.view"
above="--view $work/above.view"

# --- each output alone, and all together ---

./phr $box $front -o "$work/front.ppm"
./phr $box $front -o "$work/front.pfm"
./phr $box $above -o "$work/above.ppm"
./phr $box -o "$work/mesh.ply"
for ranks in 1 4; do
    all=$work/all-$ranks
    $MPIEXEC -n $ranks ./phr $box -o "$all-first.ppm" $front -o "$all-front.ppm" \
        -o "$all-front.pfm" -o "$all-mesh.ply" $above -o "$all-above.ppm" \
        --stats "$all.json"
    for output in front.ppm front.pfm above.ppm mesh.ply; do
        check "$output, with all others on $ranks ranks: as alone" \
            cmp "$all-$output" "$work/$output"
    done
    check "a picture before all views is of the first" \
        cmp "$all-first.ppm" "$work/front.ppm"
done
check "the views differ" \
    [ "$(head -c 12 "$work/front.ppm")" != "$(head -c 12 "$work/above.ppm")" ]
./phr $box --stats "$work/none.json"
for key in checksum rays node_tests links error_estimate; do
    check "$key of --stats does not depend on outputs" \
        [ "$(stat_of "$work/none.json" $key)" = "$(stat_of "$all.json" $key)" ]
done

./phr $box $front -o "$work/size-front.ppm" $above -o "$work/size-above.ppm" --size 9x7
check "--size overrides all views" \
    [ "$(head -c 6 "$work/size-front.ppm")$(head -c 6 "$work/size-above.ppm")" = \
        "$(printf 'P6\n9 7P6\n9 7')" ]

tap_done
