# Runs that lose nothing: an output that cannot be written takes no other along, and a
# line at the end names it; a checkpoint that was not made is said; limits of the
# address space and of the stack are kept; no file waits for a writer; signals of batch
# systems and terminals stop a run as SIGTERM does. On 1 and on 3 ranks.
. tests/tap.sh
. tests/faults.sh

two_triangles

# limited RANKS LIMITS ARGUMENTS...: a run below these limits of the shell; $status, and
# its words in $work/err.
limited() {
    on=$1 limits=$2
    shift 2
    : >"$work/err"
    LIMITS=$limits $MPIEXEC -n "$on" sh -c \
        'eval "$LIMITS"; exec 2>>"$0"; exec "$@"' "$work/err" "$PHR" "$@" \
        >/dev/null 2>&1 </dev/null
    status=$?
}

# lost FILE REASON: the last run ended with 1 and one line on the file.
lost() {
    [ "$status" -eq 1 ] && [ "$(cat "$work/err")" = "phr: $work/$1: $2" ] && return
    echo "# status $status: $(cat "$work/err")"
    return 1
}

# --- outputs ---

two="$work/two.obj --epsilon 1e-2 --size 1000x1000 --samples 1 --quiet"
"$PHR" $two -o "$work/c.ppm" -o "$work/c.ply"
for ranks in 1 3; do
    rm -f "$work"/[ab].*
    limited $ranks "ulimit -f 10000" $two -o "$work/a.pfm" -o "$work/b.ppm" \
        -o "$work/b.ply" --stats "$work/b.json" --checkpoint "$work/b.check"
    check "an output that is too large, on $ranks: status 1, one line" \
        lost a.pfm "cannot write: File too large"
    check "is not there, nor beside its place" [ -z "$(ls "$work" | grep '^a')" ]
    check "the others are" \
        [ "$(ls "$work" | grep '^b' | tr '\n' ' ')" = "b.check b.json b.ply b.ppm " ]
    check "and whole" cmp "$work/b.ppm" "$work/c.ppm" && cmp "$work/b.ply" "$work/c.ply"

    # --- checkpoints ---

    rm -f "$work"/[ab].*
    limited $ranks true $two --max-iterations 1 --epsilon 1e-3 -o "$work/b.ppm" \
        --checkpoint "$work/a.check"
    check "a pass that is not whole, on $ranks" lost a.check \
        "not written: no pass is whole"
    check "there is no checkpoint, but the picture" \
        [ ! -e "$work/a.check" -a -s "$work/b.ppm" ]
    limited $ranks true $two --checkpoint "$work/a.check"
    limited $ranks true $two --resume "$work/a.check" --checkpoint "$work/b.check"
    check "a finished run goes on, on $ranks: its checkpoint is kept as well" \
        cmp "$work/a.check" "$work/b.check"
done

# --- limits ---

build/room 1000 3 >"$work/room.obj"
cp scenes/room.mtl "$work"
for ranks in 1 3; do
    limited $ranks "ulimit -v 250000" "$work/room.obj" --epsilon 1e-6 --final-gather 64 \
        --quiet --stats "$work/v.json"
    limit=$(stat_of "$work/v.json" memory_limit)
    check "ulimit -v, on $ranks: the run keeps to $limit bytes" \
        [ "$status" -eq 0 -a "$(stat_of "$work/v.json" memory_limited)" = true ]
done

# An octree of 14 levels, whose streams of rays took 9 kB of the stack for each.
awk 'BEGIN {
    print "mtllib two.mtl\nv -1 -1 1\nv -1 1 1\nv 1 -1 1\nusemtl lamp\nf 1 2 3"
    print "usemtl wall\nv -1 1 -1\nv 1 1 -1\nv 1 -1 -1\nf 5 4 6"
    for (k = 0; k < 40; k++)
        for (i = 0; i < 12; i++) {
            s = 2 ^ -k; x = s * (i % 3 + 1) / 4; y = s * (int(i / 3) + 1) / 5
            z = s / 2 + s * i / 40
            printf "v %.17g %.17g %.17g\nv %.17g %.17g %.17g\nv %.17g %.17g %.17g\n",
                x, y, z, x + s / 9, y, z, x, y + s / 9, z
            print "f -3 -2 -1"
        }
}' >"$work/deep.obj"
for ranks in 1 3; do
    limited $ranks "ulimit -s 160" "$work/deep.obj" --epsilon 1e-2 --final-gather 64 \
        --quiet -o "$work/deep.ppm"
    check "a deep tree takes less than 160 kB of the stack, on $ranks ($status)" \
        [ "$status" -eq 0 -a -s "$work/deep.ppm" ]
done

# --- files ---

mkfifo "$work/pipe.mtl"
sed 's/two.mtl/pipe.mtl/' "$work/two.obj" >"$work/waits.obj"
for ranks in 1 3; do
    : >"$work/err"
    timeout -s KILL 20 $MPIEXEC -n $ranks sh -c 'exec 2>>"$0"; exec "$@"' "$work/err" \
        "$PHR" "$work/waits.obj" --quiet >/dev/null 2>&1
    status=$?
    check "a library that is a pipe is refused, on $ranks ($status)" \
        [ $status -eq 2 -a "$(cat "$work/err")" = \
            "phr: $work/waits.obj:1: $work/pipe.mtl is not a file" ]
done

# fdopen() that fails behind open().
cat >"$work/fdopen.c" <<'END_C'
#include <errno.h>
#include <stdio.h>
FILE *fdopen(int file, const char *mode)
{
    (void)file;
    (void)mode;
    errno = ENOMEM;
    return NULL;
}
END_C
if [ "$(uname)" = Linux ] && ! ldd "$PHR" 2>/dev/null | grep -q asan &&
    $CC -shared -fPIC -o "$work/fdopen.so" "$work/fdopen.c" 2>/dev/null; then
    LD_PRELOAD=$work/fdopen.so "$PHR" $two -o "$work/left.ppm" 2>"$work/err"
    status=$?
    check "no memory for a stream: one line" \
        lost left.ppm "cannot write: Cannot allocate memory"
    check "nothing is left behind" [ -z "$(ls "$work" | grep '^left')" ]
else
    tap 0 "no memory for a stream # SKIP there is no way to fail fdopen()"
fi

# --- signals ---

box="scenes/cornell.obj --epsilon 2e-6 --final-gather 8 --checkpoint $work/signal.check"
for signal in HUP XCPU USR1; do
    for ranks in 1 3; do
        start $ranks $box
        wait_for 2 " split)"
        kill -$signal "$(tail -n 1 "$work/ranks")"
        finish
        check "SIG$signal to one rank of $ranks: status 1 ($status), how to go on" \
            grep -q "^phr: stopped by SIG$signal: .*; go on with --resume" "$work/err"
        check "all ranks are gone" ranks_are_gone
    done
done
# The system sends SIGXCPU each second from then on.
limited 1 "ulimit -S -t 3" scenes/cornell.obj --epsilon 1e-6 --size 2000x2000 --quiet \
    -o "$work/slow.ppm"
check "ulimit -t ends a run in good order ($status)" sh -c \
    '[ "$1" -eq 1 ] && grep -qx "phr: stopped by SIGXCPU: the light .*" "$0"' \
    "$work/err" "$status"
check "with a picture" [ -s "$work/slow.ppm" ]

tap_done
