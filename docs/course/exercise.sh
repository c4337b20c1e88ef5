#!/bin/sh
# Tests the answers to the exercises of chapter N: `make exercise N=1`.
#
#   sh docs/course/exercise.sh N [solutions]
#
# Answers are in exercises/N.c, or in the folder named; exercises/N-test.c includes them
# and prints a line for each exercise. Exit status 0: all are right.
: "${CC:=mpicc}" "${BUILD:=build/mpi}"
cd "$(dirname "$0")/../.." || exit 2
number=$(printf %02d "${1#0}") || exit 2
answers=docs/course/${2:-exercises}/$number.c
program=build/course/${2:-exercises}-$number
if [ ! -e "$answers" ]; then
    echo "usage: make exercise N=1   (or 2, ... 11)" >&2
    exit 2
fi
mkdir -p build/course
$CC -std=c99 -O0 -Wall -Wextra -Wno-unused-parameter -I. \
    "-DANSWERS=\"$answers\"" -o "$program" docs/course/exercises/"$number"-test.c \
    "$BUILD/libphr.a" -lm || exit 2
"$program"
