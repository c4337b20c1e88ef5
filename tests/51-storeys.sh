# The two storeys: how much of phr a reader of the paper has to walk through, in
# figures. Each is printed with its limit and its goal, and may not be above its limit.
# A limit above its goal is the figure of the day when it was written here: whoever
# makes a figure smaller writes it down, and no figure rises.

. tests/tap.sh

# The function of the form factor of Eq. (2), with visibility.
factor=exchange_area

# name                limit  goal
limits='
functions_run           149   150
files_run                20    20
calls_to_form_factor      6     7
includes_of_beyond        0     0
ground_floor_lines     4236  4500
source_lines          30395 16000
test_lines            32372 16000
long_lines                0     0
what_per_1000_words     1.2     2
large_structs             0     0
structs_twice             0     0
files_in_circles         0     0
upstairs_lines        11777  9200
named_numbers_upstairs  172    70
bare_numbers_upstairs   134   134
fields_upstairs         120    20
fields_elsewhere        158    20
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
judge test_lines "$(test_files | lines_of)"
judge long_lines "$( (source_files; test_files
    ls Makefile tools/*.[ch] tools/*.sh tools/*.awk scenes/*.c scenes/*.sh
    ls docs/course/*.c docs/course/*.sh docs/course/*.awk docs/course/*/*.[ch]) |
    xargs cat | grep -cE '^.{91}')"
awk -f tests/storeys.awk $(source_files) tools/*.[ch] >"$work/figures"
while read -r name figure details; do
    judge "$name" "$figure" "$details"
done <"$work/figures"

# --- figures of a run of --paper: two triangles that face each other, no picture ---

here=$BUILD/storeys # kept, so that the next build is short
flags='-O0 -w -fno-inline --coverage -finstrument-functions -no-pie'
mkdir -p "$here/hooks"
rm -f "$here/phr"
if ! command -v gcov >/dev/null ||
    ! $CC -O0 -c tests/chain.c -o "$here/hooks/chain.o" ||
    ! $MAKE SERIAL=1 CC="$CC" BUILD="$here" CFLAGS="$flags" CPPFLAGS= \
        LDFLAGS="$here/hooks/chain.o" "$here/phr" >"$work/make.log" 2>&1; then
    tap 0 "the run of --paper # SKIP there is no gcov, or no compiler that goes with it"
    tap_done
fi

cat >"$work/two.mtl" <<'END'
newmtl lamp
Kd 0.5 0.5 0.5
Ke 1 1 1
newmtl wall
Kd 0.5 0.5 0.5
END
cat >"$work/two.obj" <<'END'
mtllib two.mtl
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
v 1 0 1
v 0 1 1
usemtl lamp
f 1 2 3
usemtl wall
f 4 6 5
END
find "$here" -name '*.gcda' -exec rm -f {} +
nm "$here/phr" | awk '$2 ~ /^[tT]$/ { print $1, $3 }' >"$work/symbols"
FACTOR_AT=$(awk -v name=$factor '$2 == name { print $1 }' "$work/symbols")
CHAIN=$work/chain
export FACTOR_AT CHAIN
"$here/phr" --paper "$work/two.obj" >"$work/out" 2>"$work/log"
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

[ -s "$work/chain" ] || echo 0 >"$work/chain" # it is not called
chain=$(awk 'NR == FNR { name[$1] = $2; next }
    { while (length($1) < 16) $1 = "0" $1; print name[$1] }' \
    "$work/symbols" "$work/chain" | sed -n '/^main$/,$p')
calls=$(echo "$chain" | sed 1d | grep -c .)
[ "$calls" -gt 0 ] || calls=
judge calls_to_form_factor "$calls" "$(echo $chain | sed 's/ / > /g')"
check "which ends in $factor()" [ "$(echo "$chain" | tail -n 1)" = $factor ]

tap_done
