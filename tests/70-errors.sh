# Bad input, bad usage, outputs that cannot be written, some of each kind (tests/io/ has
# every complaint of a reader): on 1 and on 4 ranks each ends with one line on stderr,
# nothing on stdout, the right exit status, and no file touched. Nothing hangs (10 seconds
# are the limit of a hang, not of a speed).
#
# Output is taken from each rank itself, so that words of the launcher about an exit
# status that is not 0 do not count as ours. A hundred launches take ten seconds.
. tests/tap.sh

out=$work/stdout
err=$work/stderr
old=$work/old.ppm

# phr_on RANKS LIMIT ARGUMENTS...: runs it; leaves $out, $err and the exit status in
# $status.
phr_on() {
    ranks=$1
    limit=$2
    shift 2
    : >"$out"
    : >"$err"
    timeout "$limit" $MPIEXEC -n "$ranks" sh -c 'exec 2>>"$1" >>"$0"; shift; exec "$@"' \
        "$out" "$err" "$PHR" "$@" >"$work/launcher" 2>&1 </dev/null
    status=$?
}

is_one_line() { [ "$(wc -l <"$1")" -eq 1 ]; }

starts_with() {
    case $(cat "$1") in "$2"*) ;; *) return 1 ;; esac
}

is_untouched() {
    [ "$(cat "$old")" = "old bytes" ] && [ -z "$(find "$work" -name '*.tmp')" ] &&
        [ ! -e "$work/new.ppm" ] && [ ! -e "$work/new.json" ]
}

# ended CODE START: the last run ended as an error should.
ended() {
    [ "$status" -eq "$1" ] && [ ! -s "$out" ] && is_one_line "$err" &&
        starts_with "$err" "$2" &&
        is_untouched && ! grep -q 'BAD TERMINATION' "$work/launcher" && return
    echo "# expected status $1 and '$2...', got status $status and:"
    sed 's/^/# /' "$err" "$out"
    return 1
}

# refuse CODE START NAME ARGUMENTS...: the arguments fail on 1 and 4 ranks.
refuse() {
    code=$1
    start=$2
    name=$3
    shift 3
    for ranks in 1 4; do
        echo "old bytes" >"$old"
        phr_on $ranks 10 "$@"
        check "$name, on $ranks" ended "$code" "phr: $start"
    done
}

# refuse_scene SUFFIX NAME: $scene is refused with "FILE" and the suffix, whatever else is
# asked.
refuse_scene() {
    refuse 2 "$scene$1" "$2" "$scene" -o "$old" -o "$work/new.ppm" \
        --stats "$work/new.json"
}

# scene NAME: the file that stdin becomes is the scene of the following tests.
scene() {
    scene=$work/$1
    cat >"$scene"
}

vertices='v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0'
printf 'newmtl lamp\nKd 0.5 0.5 0.5\nKe 1 1 1\n' >"$work/lamp.mtl"
lamp="mtllib lamp.mtl
usemtl lamp"

# --- scenes ---

scene=$work/absent.obj
refuse_scene ": cannot read: " "a missing scene"

scene index.obj <<END
$lamp
$vertices
f 1 2 3
f 1 3 5
END
refuse_scene ":8: face refers to vertex 5 of 4" "an index out of range"

printf 'newmtl lamp\nKe 1 one 1\n' >"$work/bad.mtl"
scene library.obj <<END
mtllib bad.mtl
$vertices
f 1 2 3
END
refuse 2 "$work/bad.mtl:2: bad number 'one'" "a bad material library" "$scene" -o "$old"

printf 'newmtl grey\nKd 0.5 0.5 0.5\n' >"$work/grey.mtl"
scene dark.obj <<END
mtllib grey.mtl
$vertices
usemtl grey
f 1 2 3 4
END
./phr "$work/dark.obj" -o "$work/dark.pfm" --size 8x8 >/dev/null 2>"$work/err"
check "a scene without a light gets a sky, with a line that says so" \
    [ "$? $(grep -c 'nothing emits light: --sky 1 is taken' "$work/err")" = "0 1" ]

scene degenerate.obj <<END
$lamp
$vertices
v 2 0 0
f 1 2 2
f 1 2 5
END
refuse_scene ": all faces of the scene are degenerate" "only faces without area"

# --- views and usage ---

scene good.obj <<END
$lamp
$vertices
f 1 2 3 4
END

printf 'eye 0 0 5\nat 0 0 0\nfov 200\n' >"$work/bad.view"
refuse 2 "$work/bad.view:3: fov must" "a bad view" "$scene" --view "$work/bad.view" \
    -o "$old"
refuse 2 "$work/absent.view: cannot read: " "a missing view" "$scene" \
    --view "$work/absent.view" -o "$old"
refuse 2 "unknown option --fast" "an unknown option" "$scene" -o "$old" --fast
refuse 2 "-o $work/new.gif: the name must" "an unknown format" "$scene" -o "$old" \
    -o "$work/new.gif"

# --- outputs ---

refuse 1 "$work/absent/new.ppm: cannot write: " "an output in a missing folder" \
    "$scene" -o "$old" -o "$work/absent/new.ppm" -o "$work/new.ppm"
refuse 1 "$work/absent/new.json: cannot write: " "a report in a missing folder" \
    "$scene" -o "$old" -o "$work/new.ppm" --stats "$work/absent/new.json"

# Over files that are read (every spelling: tests/io/files.c).
cp "$scene" "$work/kept.obj"
cp "$work/lamp.mtl" "$work/kept.mtl"
over="which is read: no output goes over it"
refuse 2 "$work/./good.obj is $scene, $over" "a report over the scene" \
    "$scene" -o "$old" --stats "$work/./good.obj"
refuse 2 "$work/./lamp.mtl is $work/lamp.mtl, $over" "a report over the library" \
    "$scene" -o "$old" --stats "$work/./lamp.mtl"
check "the scene and its library are untouched" \
    cmp "$scene" "$work/kept.obj" && cmp "$work/lamp.mtl" "$work/kept.mtl"

# --- no errors ---

help_is_right() {
    [ "$status" -eq 0 ] && [ ! -s "$err" ] && [ "$(grep -c '^usage: phr' "$out")" -eq 1 ]
}

version_is_right() {
    [ "$status" -eq 0 ] && [ ! -s "$err" ] && is_one_line "$out" &&
        starts_with "$out" "phr "
}

for ranks in 1 4; do
    phr_on $ranks 10 --help
    check "--help, on $ranks" help_is_right
    phr_on $ranks 10 --version
    check "--version, on $ranks" version_is_right
done

tap_done
