#!/bin/sh
# Golden pictures on other compilers, C libraries, MPIs and processors, as far as they are
# installed here (`make portability`). Each platform builds phr, imgdiff and two unit
# tests of what reads and writes files, makes the pictures of tests/golden/cases, and
# compares them by its own imgdiff with the golden ones; .ppm and .ply files have to be
# those of the first platform. In the table, "identical" is by cmp, for all files. Exit
# status 1: a picture is beyond its tolerance.
#
# Debian 12 has the platforms as gcc clang musl-tools mpich openmpi-bin libopenmpi-dev
# gcc-aarch64-linux-gnu gcc-s390x-linux-gnu libc6-dev-arm64-cross libc6-dev-s390x-cross
# qemu-user-static.

cd "$(dirname "$0")/.." || exit 2
: "${MAKE:=make}"
top=build/portability
failed=0
names=$(grep '^[^#]' tests/golden/cases | cut -d ' ' -f 1)

is_there() {
    for program in "$@"; do
        command -v "$program" >/dev/null || return 1
    done
}

tolerance_of() {
    sed -n "s/^$1 \([^ ]*\) .*/\1/p" tests/golden/cases
}

# compare NAME: one case on the present platform; counts it, and names the files that
# differ.
compare() {
    cmp -s "$here/golden/$1.pfm" "tests/golden/$1.pfm" && same=$((same + 1))
    for suffix in ppm ply; do
        cmp -s "$here/golden/$1.$suffix" "$first/golden/$1.$suffix" ||
            others="$others $1.$suffix"
    done
    $run "$here/imgdiff" "$here/golden/$1.pfm" "tests/golden/$1.pfm" \
        --tolerance "$(tolerance_of "$1")" >"$here/golden/$1.diff" 2>&1 && return
    beyond="$beyond $1 ($(sed -n 's/^relative *//p' "$here/golden/$1.diff"))"
}

# platform NAME WHAT RUN MAKE-ARGUMENTS...: builds and compares. WHAT are programs that it
# needs; RUN is put before a program; $launch, where set, before phr in place of RUN.
platform() {
    name=$1
    needs=$2
    run=$3
    shift 3
    is_there $needs || { printf '%-22s skipped: no %s\n' "$name" "$needs"; return; }
    here=$top/$name
    : "${first:=$here}"
    mkdir -p "$here"
    if ! $MAKE "$@" BUILD="$here" "$here/phr" "$here/imgdiff" "$here/tests/ply" \
        "$here/tests/image"         >"$here/log" 2>&1; then
        printf '%-22s FAILED to build, see %s\n' "$name" "$here/log"
        failed=1
        return
    fi
    SUFFIXES='pfm ppm ply' sh tests/golden.sh "$here/golden" ${launch:-$run} "$here/phr"
    same=0
    others=
    beyond=
    for case in $names; do compare "$case"; done
    units=
    for unit in ply image; do
        $run "$here/tests/$unit" >"$here/$unit.tap" 2>&1 || units="$units $unit"
    done
    result="$same of $(echo "$names" | wc -l) identical"
    [ -z "$others" ] || result="$result; differ:$others"
    [ -z "$beyond" ] || result="$result; BEYOND TOLERANCE:$beyond"
    [ -z "$units" ] || result="$result; FAILED unit tests:$units"
    [ -z "$beyond$units" ] || failed=1
    printf '%-22s %s\n' "$name" "$result"
}

launch=
platform gcc gcc '' SERIAL=1 CC=gcc
platform gcc-O0 gcc '' SERIAL=1 CC=gcc CFLAGS=-O0
platform gcc-O3-native gcc '' SERIAL=1 CC=gcc CFLAGS='-O3 -march=native'
platform clang clang '' SERIAL=1 CC=clang
platform musl-static musl-gcc '' SERIAL=1 CC=musl-gcc LDFLAGS=-static
platform aarch64-static 'aarch64-linux-gnu-gcc qemu-aarch64-static' qemu-aarch64-static \
    SERIAL=1 CC=aarch64-linux-gnu-gcc LDFLAGS=-static
platform s390x-static 's390x-linux-gnu-gcc qemu-s390x-static' qemu-s390x-static \
    SERIAL=1 CC=s390x-linux-gnu-gcc LDFLAGS=-static
launch='mpiexec.mpich -n 3'
platform mpich 'mpicc.mpich mpiexec.mpich' '' MPICC=mpicc.mpich
launch='mpiexec.openmpi --oversubscribe --allow-run-as-root -n 3'
platform openmpi 'mpicc.openmpi mpiexec.openmpi' '' MPICC=mpicc.openmpi
exit $failed
