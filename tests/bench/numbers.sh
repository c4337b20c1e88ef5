# make numbers: half and twice of each tuned number, in a scene of the panel where that is
# seen: the rows of docs/numbers.md.
#
# In a copy of the sources each number is multiplied by FACTOR if NUMBER is its file and
# name. The panel (tests/panel/panel.sh) solves its scene. A row tells which figure has
# changed by the largest factor: rms, or the mean where there is none; median, held,
# claim, work, power. Means are over orders of faces. Some minutes.
# Knobs: NUMBERS, names of rows, others stay; OUT, the page.
set -eu
: "${BUILD:=build/mpi}" "${MAKE:=make}" "${OUT:=docs/numbers.md}" "${NUMBERS:=}"
export LC_ALL=C BUILD
work=$PWD/$BUILD/numbers
rm -rf "$work" && mkdir -p "$work/copy"
cp -R Makefile ./*.[ch] geom octree rad mpi io lib tools scenes tests "$work/copy"

echo 'double number_factor(const char *name);' >"$work/number.h"
cat >>"$work/copy/geom/alloc.c" <<'END'

double number_factor(const char *name)
{
    static const char *own;
    if (!own && !(own = getenv("NUMBER")))
        own = "";
    return strcmp(own, name) == 0 ? atof(getenv("FACTOR")) : 1.0;
}
END

# change FILE NAME: in the copy the number can be multiplied. Prints the number.
change() {
    awk -v name="$2" -v file="$1" -v out="$work/changed" '
        !done && match($0, "[ {]" name " = [^,;}]*[^,;} ]") {
            own = substr($0, RSTART, RLENGTH)
            value = own
            sub(/.* = /, "", value)
            $0 = substr($0, 1, RSTART) name "_" substr($0, RSTART + length(name) + 1) \
                "\n#define " name (value ~ /[.p]|e-/ ? " (" : " (int)(") name \
                "_ * number_factor(\"" file ":" name "\"))"
            done = 1
            print value
        }
        { print >out }' "$work/copy/$1" && mv "$work/changed" "$work/copy/$1"
}

# solve SCENE: figures of the copy, means over orders of faces.
solve() {
    PHR=$work/copy/phr SCENES=$1 SIZE=8 sh tests/panel/panel.sh >"$work/log" 2>&1
    awk '{ for (i = 5; i <= NF; i++) { sum[i] += $i; if ($i == "-") none[i] = 1 } n++ }
        END { for (i = 5; i <= 23; i++) printf "%s ", none[i] ? "-" : sum[i] / n }' \
        "$BUILD/panel/figures"
}

# compared BEFORE...: with what comes in: the figure that has changed most.
compared() {
    awk -v before="$*" '
        function compare(name, i, new, old) {
            old = was[i - 4]; new = $(i - 4)
            if (old == "-" || old * new <= 0) return
            off = log(new / old) ^ 2
            if (off > most) {
                most = off
                word = sprintf("%s %.3g, %.3g", name, old, new)
            }
        }
        {
            split(before, was, " ")
            if (was[8] == "-") compare("mean", 11)
            compare("work", 5); compare("power", 6); compare("rms", 12)
            compare("median", 14); compare("held", 16); compare("claim", 18)
            print most < 1e-6 ? "same" : word
        }'
}

grep '^| `' "$OUT" >"$work/old"
while IFS='|' read -r _ name _ _ _ _ file _; do
    set -- $(echo $file $name | tr -d '`')
    change "$1" "$2" >"$work/is-$(basename "$1")-$2"
done <"$work/old"
(cd "$work/copy" && $MAKE -j2 BUILD=build CPPFLAGS="-I. -w -include $work/number.h" phr) \
    >"$work/log" 2>&1
while IFS='|' read -r _ name value unit half twice file scene _; do
    row=$(echo $name | tr -d '`')
    case " $NUMBERS " in "  " | *" $row "*)
        value=" $(cat "$work/is-$(basename $(echo $file | tr -d '`'))-$row") "
        export NUMBER=$(echo $file:$row | tr -d '` ')
        before=$(FACTOR=1 solve $scene)
        half=" $(FACTOR=0.5 solve $scene | compared $before) "
        twice=" $(FACTOR=2 solve $scene | compared $before) " ;;
    esac
    echo "|$name|$value|$unit|$half|$twice|$file|$scene|"
done <"$work/old" >"$work/rows"
{ sed '/^| `/,$d' "$OUT"; cat "$work/rows"; } >"$work/page" && mv "$work/page" "$OUT"
