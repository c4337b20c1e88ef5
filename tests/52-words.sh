# The words: --help fits a screen and agrees with the man page, which renders without a
# warning, as do those of other programs; --version; and progress, on a terminal, in a log
# and with --quiet.

. tests/tap.sh

# --- help and man page (help and parser are one table) ---

./phr --help >"$work/help"
check "--help fits a screen of 24 lines" [ "$(wc -l <"$work/help")" -le 24 ]
check "and 79 columns" [ -z "$(grep -E '^.{80}' "$work/help")" ]
check "and shows two examples" \
    [ "$(sed '1,/Examples:/d' "$work/help" | grep -cE '^  (mpiexec .*)?phr ')" -eq 2 ]

# same_lines A B: the files are alike; differing lines are shown.
same_lines() {
    diff "$1" "$2" >"$work/diff" && return
    sed 's/^/# /' "$work/diff"
    return 1
}

grep -oE '(^|[^a-zA-Z-])-(o|-[a-z][a-z-]*)' "$work/help" | grep -oE '\-(o|-[a-z-]+)' |
    sort -u >"$work/in-help"
# The first words of a tagged paragraph of OPTIONS.
sed 's/\\-/-/g' phr.1 | sed -n '/^\.SH OPTIONS/,/^\.SH EXIT/p' | grep -A1 '^\.TP' |
    sed -n 's/^\(\\fB\|\.B \)\(-[a-z-]*\).*/\2/p' | sort -u >"$work/in-man"
check "the man page has a paragraph for each option of --help, and no other" \
    same_lines "$work/in-help" "$work/in-man"
sed 's/\\-/-/g' phr.1 | grep -oE '(^|[^a-zA-Z-])--[a-z][a-z-]+' |
    grep -oE '\-\-[a-z-]+' | sort -u >"$work/named"
check "the man page names no option that does not exist" \
    [ -z "$(grep -vxF -f "$work/in-help" "$work/named")" ]

missing=$(while read -r option; do
    ./phr --help="${option#--}" | sed -n 1p | grep -q -- "^  $option" || echo "$option"
done <"$work/in-help")
check "--help=OPTION has each of them: $missing" [ -z "$missing" ]

if command -v groff >/dev/null; then
    groff -man -ww -Tascii phr.1 >"$work/page" 2>"$work/warnings"
    check "the man page renders without a warning" [ ! -s "$work/warnings" ]
    check "and is not empty" [ "$(wc -l <"$work/page")" -gt 100 ]
else
    tap 0 "the man page renders # SKIP there is no groff"
fi

# The other programs (their --version: tests/50-house.sh).
for program in tools/imgdiff tools/viewfactors/viewfactors; do
    name=$(basename $program)
    "$BUILD/$name" --help >"$work/$name"
    check "$name --help fits a screen" [ "$(wc -l <"$work/$name")" -le 24 ]
    sed 's/\\-/-/g' "$program.1" >"$work/$name.1"
    missing=$(grep -oE '(^|[^a-zA-Z-])--[a-z-]+' "$work/$name" | grep -oE '\-\-[a-z-]+' |
        while read -r option; do
            grep -q -e "$option" "$work/$name.1" || echo "$option"; done)
    check "its man page has every option: $missing" [ -z "$missing" ]
done

version=$(./phr --version)
case $version in
"phr "[0-9]*" (MPI build), MIT licence" | "phr "[0-9]*" (serial build), MIT licence")
    tap 0 "--version: $version" ;;
*) tap 1 "--version: $version" ;;
esac
number=$(echo "$version" | sed 's/^phr \([0-9.]*\).*/\1/')
check "the man page is of this version" grep -q "^\.TH PHR 1 .*\"phr $number\"" phr.1

check "--help=view tells what a view is" \
    [ "$(./phr --help=view | grep -cE '^    (eye|at|up|fov|size) [-0-9 ]+  ')" -eq 5 ]
./phr --help=view | sed -n 's/^    \([a-z]* [-0-9. ]*\)  .*/\1/p' >"$work/help.view"
check "by an example, which is one" ./phr scenes/squares.obj --epsilon 1e-2 --quiet \
    --view "$work/help.view" --size 8x8 -o "$work/help.ppm"
./phr scenes/squares.obj --paper 2>"$work/log" >"$work/out"
check "a run that writes nothing says how to get a picture" \
    grep -qx "phr: nothing is written: -o room.png writes a picture, .*" "$work/log"
./phr scenes/squares.obj --paper --stats "$work/some.json" 2>"$work/log" >"$work/out"
check "and one that writes does not" sh -c '! grep "nothing is written" "$0"' "$work/log"

# --- options that do nothing ---

# idle RANKS NAMES ARGUMENTS...: one warning names these, or none if there are none.
idle() {
    on=$1 names=$2
    shift 2
    $MPIEXEC -n "$on" ./phr "$@" 2>"$work/log" >"$work/out"
    said=$(sed -n 's/^phr: warning: no use is made of //p' "$work/log")
    [ "$said" = "$names" ] && return
    echo "# expected '$names', got '$said'"
    return 1
}

box="scenes/cornell.obj --max-level 0 --final-gather 16"
mesh="$work/idle.ply"
for ranks in 1 4; do
    check "without a picture, on $ranks" idle $ranks "--size, --samples" \
        $box --size 9x9 --samples 2 --flat -o "$mesh"
    check "without an output, on $ranks" \
        idle $ranks "--size, --exposure, --final-gather pixels" $box --size 9x9 \
        --exposure 2 --final-gather 16,pixels
done
check "without 8-bit colours" idle 1 "--exposure" $box --size 9x9 --exposure 2 \
    -o "$work/idle.pfm"
check "without predictions" idle 1 "--alpha" scenes/squares.obj --alpha 0.25
check "with them" idle 1 "" scenes/squares.obj --alpha 0.25 --paper
check "or where they are told" idle 1 "" scenes/squares.obj --alpha 0.25 \
    --stats "$work/idle.json"
check "without false colours" idle 1 "--lines, --lux" $box --size 9x9 --lines 3 --lux \
    -o "$work/idle.ppm"
check "with some" idle 1 "" $box --size 9x9 --lines 3 --lux --show irradiance \
    -o "$work/idle.ppm"
check "or with a report" idle 1 "" $box --lux --report "$work/idle.csv"
check "overruled by --paper" idle 1 "--solver: --paper follows" scenes/squares.obj \
    --solver cg --oracle error --paper --oracle error
check "none, where all do something" idle 1 "" $box --size 9x9 --samples 2 --exposure 2 \
    --flat -o "$work/idle.ppm"
check "nor with --quiet" idle 1 "" $box --quiet --size 9x9

# bytes WHAT: as mpi/memory.c counts one.
bytes() { sed -n "s/.*BYTES_PER_$1 = \([0-9]*\).*/\1/p" mpi/memory.c; }
text="$(bytes LINK) bytes for each link of all ranks, $(bytes PATCH) for each patch"
text="$text, $(bytes CLUSTER) for each cluster, and $(bytes RAY) for each patch and ray"
check "the manual counts bytes as the memory limit does: $text" \
    sh -c 'tr "\n" " " <phr.1 | grep -qF "$0"' "$text"

# keys: those of a report, and the objects between, as paths; of seconds and work, whose
# objects are alike, the last names once.
keys() {
    awk '{ while (match($0, /"[a-z_]*": |[{}]/)) {
        word = substr($0, RSTART, RLENGTH)
        $0 = substr($0, RSTART + RLENGTH)
        if (word == "{") {
            at[++depth] = at[depth - 1] key (key == "" ? "" : ".")
            name[depth] = key
        } else if (word == "}") key = name[depth--]
        else { key = word; gsub(/[": ]/, "", key); print at[depth] key }
    } }' | sed -nE 's/^(seconds|work)\.[a-z_]+\./\1.*./; p'
}
./phr scenes/squares.obj --paper --quiet --stats "$work/report.json"
keys <"$work/report.json" | sort -u >"$work/keys"
grep -vxE "$(sed -n 's/\.[a-z_*.]*$//p' "$work/keys" | sort -u | tr '\n' '|')-" \
    "$work/keys" >"$work/in-report"
sed -n '/^## Statistics/,/^## Form/s/^| \(`[^|]*\) |.*/\1/p' docs/formats.md |
    grep -oE '[a-z_*.]+' | sort -u >"$work/in-table"
check "docs/formats.md has each key of --stats, and no other" \
    same_lines "$work/in-report" "$work/in-table"
check "of which there are many" [ "$(wc -l <"$work/in-report")" -gt 80 ]

# --- what outputs say of themselves ---

# noted RANKS FOLDER: makes outputs of a scene in a folder of any name.
noted() {
    mkdir -p "$work/$2"
    cp scenes/squares.obj "$work/$2/a\"ä.obj"
    cp scenes/*.mtl "$work/$2"
    $MPIEXEC -n "$1" ./phr "$work/$2/a\"ä.obj" --epsilon 1e-3 --two-sided --quiet \
        --size 9x9 -o "$work/$2/n.ply" -o "$work/$2/n.vtk" -o "$work/$2/n.png" \
        -o "$work/$2/n.hdr" \
        --stats "$work/$2/n.json"
}
noted 1 one
noted 3 three
hash=$(sed -n 's/.*"scene": .*"checksum": "\([0-9a-f]*\)".*/\1/p' "$work/one/n.json")
triangles=$(stat_of "$work/one/n.json" triangles)
origin="scene a[?]{3}[.]obj, $triangles triangles, checksum $hash"
for suffix in ply vtk png hdr; do
    tr '\0' '\n' <"$work/one/n.$suffix" >"$work/note"
    check "a .$suffix names version, scene and settings" [ "$(grep -aoE \
        "phr $number, format 1|$origin|--two-sided on|--epsilon 0.001" "$work/note" |
        wc -l)" -eq 4 ]
    check "and is the same on 3 ranks and in another folder" \
        cmp "$work/one/n.$suffix" "$work/three/n.$suffix"
done
check "--stats names what differs from the defaults" \
    grep -qF '"options": ["--two-sided on", "--epsilon 0.001"]' "$work/three/n.json"
# A sky is a setting, also that of a scene without lamps, and not of its triangles.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >"$work/dark.obj"
for sky in "" "--sky 1"; do
    ./phr "$work/dark.obj" $sky --quiet --stats "$work/sky.json" -o "$work/sky.vtk"
    check "a sky is named${sky:+ where it is given}" \
        grep -qF '"options": ["--sky 1,1,1"]' "$work/sky.json"
    check "and no part of the scene" \
        grep -aq 'scene dark.obj, 1 triangles' "$work/sky.vtk"
done
check "a mesh with its note is a stored solution" \
    ./phr "$work/one/n.ply" --quiet -o "$work/again.ply"

# --- brightness ---

# told ARGUMENTS...: the exposure of a picture, in summary, report and comment, which
# makes the same picture when it is given.
told() {
    ./phr $box --size 32x24 "$@" -o "$work/told.png" -o "$work/told.ppm" \
        --stats "$work/told.json" >"$work/told" 2>"$work/log" || return 1
    short=$(sed -n 's/^exposure  *//p' "$work/told")
    long=$(tr '\0' '\n' <"$work/told.png" | grep -a -m 1 '^--exposure ' | cut -d' ' -f2)
    [ "$short" ] && [ "$(printf %.6g "$long")" = "$short" ] &&
        grep -qF "\"exposures\": [$long]" "$work/told.json" || return 1
    cp "$work/told.ppm" "$work/first.ppm"
    ./phr $box --size 32x24 "$@" --exposure "$long" -o "$work/told.ppm" --quiet &&
        cmp "$work/told.ppm" "$work/first.ppm"
}
check "the exposure is told, and makes the same picture" told
check "also of false colours" told --show irradiance
check "and in lux" told --show radiosity --lux
{ echo "# Blender 3.4.1"; echo "# www.blender.org"; cat scenes/cornell.obj
} >"$work/made.obj"
cp scenes/cornell.mtl "$work"
says_ke() {
    ./phr "$work/made.obj" --max-level 0 --final-gather 0 "$@" 2>&1 >"$work/out" |
        grep -c ': made by Blender, whose Ke is a radiance: --ke radiance gives'
}
check "a file of Blender is told of --ke" [ "$(says_ke)" -eq 1 ]
check "unless that is given" [ "$(says_ke --ke radiosity)" -eq 0 ]

# --- progress ---

run="./phr scenes/cornell.obj --max-level 3 --samples 8 --size 128x128"
run="$run -o $work/cornell.pfm"
$run >"$work/out" 2>"$work/log"
check "a log has no carriage return" [ -z "$(tr -dc '\r' <"$work/log")" ]
check "and one line for linking, one for the roots, one for each iteration" \
    [ "$(grep -vcE '^phr: (iteration [0-9]+: |roots are|.*(; linking|--up\))$)' \
        "$work/log")" -eq 0 ]
$run --quiet >"$work/out" 2>"$work/log"
check "with --quiet there is no word" [ ! -s "$work/out" -a ! -s "$work/log" ]

if command -v script >/dev/null && script -qec true /dev/null >/dev/null 2>&1; then
    script -qec "$run" /dev/null </dev/null >"$work/terminal" 2>&1
    tr '\r' '\n' <"$work/terminal" >"$work/lines"
    check "on a terminal a line tells the phase and the share" \
        grep -qE '^phr: (linking|refining|solving|rendering)[^%]* [0-9]+ %' "$work/lines"
    check "which is rewritten" \
        grep -q "$(printf '\r')phr: rendering, [0-9]* %" "$work/terminal"
    check "fits 79 columns" [ -z "$(grep -E '^.{80}' "$work/lines")" ]
    # Between two carriage returns stand a line that is to go, the blanks in its place, or
    # a line that stays.
    check "and is gone when something else is written" awk -v RS='\r' '
        /^phr: [^\n]*%/ { drawn = 1; next }
        drawn && !/^ +$/ { exit bad = 1 }
        { drawn = 0 }
        END { exit bad || drawn }' "$work/terminal"
    script -qec "$run --quiet" /dev/null </dev/null >"$work/terminal" 2>&1
    check "with --quiet there is no word on a terminal" [ ! -s "$work/terminal" ]
else
    tap 0 "progress on a terminal # SKIP there is no script(1)"
fi

tap_done
