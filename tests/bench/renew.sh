# For commands that make tables of docs/: `. tests/bench/renew.sh`. A page has its words,
# and a command makes its tables, by processor seconds, of scenes and their truth.

# renew PAGE FROM [TO]: the standard input takes the place of the lines behind the one
# that begins with FROM, up to the line TO, or to the end of the page. Fails, and leaves
# the page, if FROM is not there.
renew() {
    awk -v from="$2" -v to="${3:-}" '
        NR == FNR { made = made $0 "\n"; next }
        to != "" && $0 == to { skip = 0 }
        !skip
        index($0, from) == 1 { printf "%s", made; found = skip = 1 }
        END { exit !found }' - "$1" >"$1.new" && mv "$1.new" "$1"
}

# processor_seconds: of the children that a shell's `times` tells of.
processor_seconds() {
    sed 's/[ms]/ /g' | awk 'END { print 60 * $1 + $2 + 60 * $3 + $4 }'
}

# file_of SCENE: one of scenes/, or a room in $work.
file_of() {
    case $1 in
    room*) echo "$work/$1.obj" ;;
    *) echo "scenes/$1.obj" ;;
    esac
}

# make_reference SCENE ELEMENTS SAMPLES: $work/SCENE.ref and, of roomN, its file, unless
# they are there.
make_reference() {
    ref=$work/$1.ref file=$(file_of "$1")
    case $1 in
    room*) [ -f "$file" ] ||
        { cp scenes/room.mtl "$work" && build/room "${1#room}" 1 >"$file"; } ;;
    esac
    [ ! -f "$ref" ] || return 0
    case $file in
    scenes/shadow.obj) "$BUILD/direct" "$file" "$work/new.ref" ;;
    *) $MPIEXEC -n 2 "$BUILD/reference" "$file" "$work/new.ref" $2 $3 ;;
    esac >&2 && mv "$work/new.ref" "$ref"
}

# run_alone NAME ARGUMENTS...: NAME.one.TURN, a report behind a line with the processor
# seconds of its run, for each of TURNS.
run_alone() {
    alone=$1
    shift
    for turn in $TURNS; do
        sh -c '"$@" && times' times ./phr "$@" --quiet --stats "$alone.json" \
            >"$alone.times"
        echo "processor $(processor_seconds <"$alone.times")" >"$alone.one.$turn"
        cat "$alone.json" >>"$alone.one.$turn"
    done
}
