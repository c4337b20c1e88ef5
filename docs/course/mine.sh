#!/bin/sh
# Builds build/course/phr: phr with a function of yours in the row of a table.
#
#   sh docs/course/mine.sh TABLE.c OLD FUNCTION.c NEW
#
# TABLE.c, of phr, has OLD in a table; FUNCTION.c, of yours, has the function NEW. phr's
# files stay as they are: a copy of TABLE.c, with NEW for OLD in the table and FUNCTION.c
# above it, is compiled and linked in its place.
: "${CC:=mpicc}" "${BUILD:=build/mpi}"
cd "$(dirname "$0")/../.." || exit 2
work=build/course
mkdir -p $work
awk -v old="$2" -v new="$4" '
    /^[a-z].*(PAPER|DEALINGS)/ { inside = 1 }
    inside { gsub(old, new) }
    { print }' "$1" >$work/table.c
cat "$3" $work/table.c >$work/mine.c
$CC -std=c99 -ffp-contract=off -fno-math-errno -O2 -w -I. -c -o $work/mine.o \
    $work/mine.c &&
    $CC -o $work/phr "$BUILD/phr.o" $work/mine.o "$BUILD/libphr.a" -lm
