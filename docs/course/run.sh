#!/bin/sh
# Runs the commands of chapters of the course and compares what they print with the text.
#
#   sh docs/course/run.sh [--renew] [CHAPTER.md...]
#
# A command is a block of sh; the block behind it, if that has no language, is its output.
# Differences are shown, and the exit status is 1 if there are any; with --renew the text
# gets the new output instead. Programs and scenes: `make course`.
: "${MPIEXEC:=mpiexec}"
export MPIEXEC
cd "$(dirname "$0")/../.." || exit 2
renew=
[ "$1" = --renew ] && renew=yes && shift
[ $# -gt 0 ] || set -- docs/course/[0-9]*.md
work=build/course/run
status=0

# Commands go to N.sh, and what they are to print, if the chapter says it, to N.out.
take_blocks() {
    rm -rf $work
    mkdir -p $work
    awk -v work=$work '
        /^```/ && inside { close(inside); inside = ""; next }
        /^```sh$/ { inside = work "/" ++n ".sh"; shown = n; next }
        /^```$/ && shown {
            inside = work "/" shown ".out"
            printf "" >inside
            shown = 0
            next
        }
        /^```/ { inside = "/dev/null"; shown = 0; next }
        inside { print >inside; next }
        /[^ ]/ { shown = 0 }' "$1"
}

run_blocks() {
    for block in $(ls $work | sed -n 's/\.sh$//p' | sort -n); do
        sh -ec 'mpiexec() { command $MPIEXEC "$@"; }
            . "$0"' ./$work/$block.sh >$work/$block.got 2>&1 </dev/null ||
            echo "exit status $?" >>$work/$block.got
    done
}

# Puts what was printed in the place of what the chapter shows.
renew_text() {
    awk -v work=$work '
        inside && /^```$/ { inside = 0; old = 0; print; next }
        old { next }
        { print }
        /^```sh$/ { inside = 1; shown = ++n; next }
        /^```$/ && shown {
            inside = old = 1
            while ((getline line <(work "/" shown ".got")) > 0)
                print line
            shown = 0
            next
        }
        /^```/ { inside = 1; shown = 0; next }
        !inside && /[^ ]/ { shown = 0 }' "$1" >$work/text
    cmp -s $work/text "$1" || cp $work/text "$1"
}

for chapter in "$@"; do
    take_blocks "$chapter"
    run_blocks
    [ -z "$renew" ] || renew_text "$chapter"
    for shown in $work/*.out; do
        [ -z "$renew" ] && [ -e "$shown" ] || continue
        diff "$shown" "${shown%.out}.got" >$work/diff && continue
        echo "$chapter: other output than the text shows of"
        cat "${shown%.out}.sh" $work/diff
        status=1
    done
done
exit $status
