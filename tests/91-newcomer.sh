# A newcomer's change: the format of pictures that docs/README.md adds, as the page says
# it, to a copy of the files that it names.

. tests/tap.sh

page=docs/README.md
mkdir -p "$work/io/picture" "$work/io/run"
cp io/run/target.[ch] "$work/io/run"
cp io/picture/imagefile.c "$work/io/picture"

# block LANGUAGE N: the N-th block of the page in this language.
block() {
    awk -v start="^\`\`\`$1\$" -v n="$2" '
        $0 ~ start && ++count == n { inside = 1; next }
        /^```$/ { inside = 0 }
        inside' $page
}
block c 1 >"$work/io/picture/tga.c"
block c 2 >"$work/io/picture/tga.h"
lines=$(cat "$work"/io/picture/tga.? | wc -l)
check "the page writes $lines lines" holds "$lines > 30 && $lines < 50"
if ! command -v patch >/dev/null; then
    tap 0 "the changes of the page # SKIP there is no patch"
    tap_done
fi
block diff 1 | (cd "$work" && patch -s -F 0 -p1) >"$work/patched" 2>&1
check "and changes three files that are as it says" [ $? -eq 0 -a ! -s "$work/patched" ]

# The changed files, and those that read them, in the place of those in libphr.a.
link=$MPICC
./phr --version | grep -q serial && link=$CC
objects=
for file in io/picture/tga io/picture/imagefile io/run/target; do
    $CC -std=c99 -ffp-contract=off -pedantic -Wall -Wextra -Wshadow -Wconversion \
        -Werror -I"$work" -I. -c -o "$work/$file.o" "$work/$file.c" 2>>"$work/log"
    objects="$objects $work/$file.o"
done
$link -o "$work/phr" "$BUILD/phr.o" $objects "$BUILD/libphr.a" -lm 2>>"$work/log"
check "it builds without a warning" [ ! -s "$work/log" ]
sed 's/^/# /' "$work/log"

box="scenes/cornell.obj --view scenes/cornell.view --max-level 1 --final-gather 8
    --size 20x10 --exposure 0.1"
./phr $box --quiet -o "$work/a.ppm"
"$work/phr" $box -o "tga:$work/a" >/dev/null 2>"$work/log"
check "the new phr writes the picture" [ $? -eq 0 ]
check "without a warning" [ "$(grep -c warning "$work/log")" -eq 0 ]

# codes FILE HEADER: samples behind so many bytes of header.
codes() {
    tail -c +$(($2 + 1)) "$1" | od -An -v -tu1 -w3
}
check "in 18 bytes and three a pixel" [ "$(wc -c <"$work/a")" -eq 618 ]
codes "$work/a.ppm" 13 | awk '{ print $3, $2, $1 }' >"$work/expected"
codes "$work/a" 18 | awk '{ print $1, $2, $3 }' >"$work/found"
check "with the codes of a PPM, blue first" cmp "$work/expected" "$work/found"
check "which are not all the same" [ "$(sort -u "$work/found" | wc -l)" -gt 10 ]
check "and names the format where a name is none" sh -c \
    '"$0" scenes/squares.obj -o a.xyz 2>&1 | grep -q " or \.tga"' "$work/phr"

tap_done
