# The two storeys: how much of phr a reader of the paper has to walk through, and one of
# the final gather, in figures. Each is printed with its limit and its goal, and may not
# be above its limit. A limit above its goal is the figure of the day when it was written
# here: whoever makes a figure smaller writes it down, and no figure rises.

. tests/tap.sh

# The function of the form factor of Eq. (2), with visibility; that which makes a row of
# the final gather, and those that fire its rays and its segments to lamps.
factor=exchange_area
row=final_gather_add_row
ray=octree_stream_hits
segment=octree_blocks_segment

# name                limit  goal
limits='
functions_run           148   150
files_run                20    20
calls_to_form_factor      6     7
includes_of_beyond        0     0
ground_floor_lines 4495  4500
source_lines      34862 16000
test_lines        31768 16000
long_lines                0     0
lines_of_geom          3645  3500
lines_of_octree    2600  2600
lines_of_io       11537  8600
lines_of_lib            228   300
lines_of_tools     6597  4700
lines_of_scenes        1025  1100
lines_of_course    1822  1900
structs_twice             0     0
upstairs_lines    12307  9200
named_numbers_upstairs 115    70
tuned_numbers        41    70
bare_numbers_upstairs 122   134
functions_of_row    321   200
calls_to_first_ray       11     9
calls_to_first_segment   16    10
'

# judge NAME FIGURE [DETAILS]: the figure is not above its limit.
judge() {
    limit=$(echo "$limits" | awk -v name="$1" '$1 == name { print $2 }')
    goal=$(echo "$limits" | awk -v name="$1" '$1 == name { print $3 }')
    check "$1 $2 (limit $limit, goal $goal)" holds "${2:-1e9} <= ${limit:-0}"
    holds "${2:-1e9} <= $goal" || echo "# $1 $2, goal $goal${3:+: $3}"
}

# --- figures of the sources ---

source_files() {
    find phr.c geom octree rad mpi io -name '*.[ch]'
}

test_files() {
    find tests -name '*.[ch]' -o -name '*.sh' -o -name '*.awk' -o -name '*.gp'
}

lines_of() {
    xargs cat | wc -l
}

judge includes_of_beyond "$(cat rad/*.[ch] mpi/*.[ch] | grep -c '#include ".*beyond/')" \
    "$(grep -l '#include ".*beyond/' rad/*.[ch] mpi/*.[ch] | tr '\n' ' ')"
judge ground_floor_lines "$(ls phr.c rad/*.[ch] mpi/*.[ch] | lines_of)"
judge source_lines "$(source_files | lines_of)"
judge upstairs_lines "$(find rad/beyond mpi/beyond -name '*.[ch]' | lines_of)"
judge test_lines "$( (test_files; echo tests/panel/table) | lines_of)"
for folder in geom octree io lib tools scenes docs/course; do
    judge lines_of_${folder##*/} "$(find $folder -name '*.[ch]' | lines_of)"
done
judge long_lines "$( (source_files; test_files
    ls Makefile compute.h lib/*.[ch] tools/*.[ch] tools/*/*.[ch] tools/*.sh tools/*.awk
    ls scenes/*.c scenes/*.sh
    ls docs/course/*.c docs/course/*.sh docs/course/*.awk docs/course/*/*.[ch]) |
    xargs cat | grep -cE '^.{91}')"
awk -f tests/storeys.awk $(source_files) tools/*.[ch] tools/*/*.[ch] >"$work/figures"
while read -r name figure details; do
    judge "$name" "$figure" "$details"
done <"$work/figures"

judge tuned_numbers "$(grep -c '^| `' docs/numbers.md)"
tr -d '`' <docs/numbers.md | grep '^| [A-Z]' | while IFS='|' read -r _ name value _ _ _ \
    file _; do
    grep -qF "$(echo $name = $value)" $file || echo $name = $value
done >"$work/numbers"
check "numbers are as docs/numbers.md says" [ ! -s "$work/numbers" ]

# --- figures of runs, of a build whose functions stay apart and tell of their calls ---

here=$BUILD/storeys # kept, so that the next build is short
flags='-O0 -g1 -w -fno-inline --coverage -finstrument-functions -no-pie'
flags="$flags -ffunction-sections -fdata-sections"
mkdir -p "$here/hooks"
rm -f "$here/phr"
if ! command -v gcov >/dev/null ||
    ! $CC -O0 -c tests/chain.c -o "$here/hooks/chain.o" ||
    ! $MAKE SERIAL=1 CC="$CC" BUILD="$here" CFLAGS="$flags" CPPFLAGS= \
        LDFLAGS="$here/hooks/chain.o" "$here/phr" >"$work/make.log" 2>&1; then
    tap 0 "runs # SKIP there is no gcov, or no compiler that goes with it"
    tap_done
fi
nm "$here/phr" | awk '$2 ~ /^[tT]$/ { print $1, $3 }' >"$work/symbols"

# address_of FUNCTION: in phr; none if it has none of that name.
address_of() {
    awk -v name="$1" '$2 == name { print $1 }' "$work/symbols"
}

# judge_calls NAME FUNCTION WAY ARGUMENTS...: a run of phr has few calls from main() to
# the first of the function, if any by way of another.
judge_calls() {
    name=$1 function=$2 way=$3
    shift 3
    echo 0 >"$work/chain" # it is not called
    CALLED_AT=$(address_of "$function") BY_WAY_OF=$(address_of "$way") \
        CHAIN=$work/chain "$here/phr" "$@" >"$work/out" 2>"$work/log"
    chain=$(awk 'NR == FNR { name[$1] = $2; next }
        { while (length($1) < 16) $1 = "0" $1; print name[$1] }' \
        "$work/symbols" "$work/chain" | sed -n '/^main$/,$p')
    calls=$(echo "$chain" | sed 1d | grep -c .)
    [ "$calls" -gt 0 ] || calls=
    judge "$name" "$calls" "$(echo $chain | sed 's/ / > /g')"
    check "which ends in $function()" [ "$(echo "$chain" | tail -n 1)" = "$function" ]
}

# The linker leaves out of a program that begins with a row what can't be reached from it,
# be it by a call or through a table. Functions of a header are in many objects.
$CC -no-pie --coverage -Wl,--gc-sections -Wl,-e,$row \
    -o "$work/reached" "$here/hooks/chain.o" "$here/libphr.a" -lm >"$work/link.log" 2>&1
nm -l "$work/reached" | awk '$2 ~ /^[tT]$/ && $4 ~ /:[0-9]+$/ && $3 !~ /^_sub_/ {
    print $4, $3 }' | sort -u >"$work/reached.functions"
check "a row can reach $ray()" grep -q " $ray\$" "$work/reached.functions"
judge functions_of_row "$(wc -l <"$work/reached.functions")"
gathers="scenes/cornell.obj --epsilon 1e-2 --final-gather 16"
judge_calls calls_to_first_ray $ray $row $gathers
judge_calls calls_to_first_segment $segment $row $gathers

# --- figures of a run of --paper: two triangles that face each other, no picture ---

two_triangles
find "$here" -name '*.gcda' -exec rm -f {} +
judge_calls calls_to_form_factor $factor "" --paper "$work/two.obj"
check "two triangles are solved by --paper" grep -q '^links ' "$work/out"

gcov -b -t $(find "$here" -name '*.gcda') >"$work/listing" 2>"$work/gcov.log"
# Functions that the run called, as "FILE NAME": of phr.c, rad/ and mpi/, headers too.
awk '/^ *-: +0:Source:/ { sub(/.*Source:/, ""); file = $0 }
    file !~ /^(phr\.c|rad\/|mpi\/)/ || file ~ /serial/ { next }
    /^function / && $4 > 0 { print file, $2 }' "$work/listing" |
    sort -u >"$work/functions"
check "gcov has seen main()" grep -qx 'phr.c main' "$work/functions"
judge functions_run "$(wc -l <"$work/functions")" "$(awk '{ n[$1]++ }
    END { for (f in n) printf "%s %d, ", f, n[f] }' "$work/functions")"
judge files_run "$(grep -o '^[^ ]*\.c' "$work/functions" | sort -u | wc -l)"

tap_done
