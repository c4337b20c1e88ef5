#!/bin/sh
# golden.sh FOLDER COMMAND...: makes the pictures of tests/golden/cases in FOLDER, with
# COMMAND as phr: NAME.pfm, or the suffixes of SUFFIXES; with CASE=NAME that of one case.
# `make golden` has it renew tests/golden itself.

folder=$1
shift
mkdir -p "$folder"
cases="^${CASE:-[^#][^ ]*} "
if ! grep -q "$cases" tests/golden/cases; then
    echo "golden.sh: tests/golden/cases has no case $CASE" >&2
    exit 2
fi
grep "$cases" tests/golden/cases | while read -r name tolerance arguments; do
    for suffix in ${SUFFIXES:-pfm}; do
        arguments="$arguments -o $folder/$name.$suffix"
    done
    "$@" --quiet $arguments </dev/null || echo "# $name: exit status $?"
done
