#!/bin/sh
# Computes scenes/answers.csv: the mean radiosity of each object of the scenes for
# lectures, converged, by path tracing, which shares neither links nor patches with phr's
# method.
#
#   make answers        about five minutes on two cores
#
# Each mean is found twice, by paths from the leaves of two solutions of phr, of which
# one is divided once more than the other, so that the paths are others. Written are the
# mean of both, and as `noise` half their difference: the means of small objects may be
# off by some times that. SAMPLES is the number of paths from each triangle. Where form
# factors have closed forms, they are in the heads of the scenes.
set -eu
cd "$(dirname "$0")/.."
: "${MPIEXEC:=mpiexec}" "${SAMPLES:=300000}"
work=build/answers
mkdir -p $work
cp scenes/room.mtl $work

# means SCENE LEVEL SAMPLES: "object B" by paths from the leaves of all roots at this
# level.
means() {
    ./phr --quiet --final-gather 0 --max-level "$2" "$1" -o $work/mesh.ply
    $MPIEXEC -n 2 build/pathtracer --leaves $work/mesh.ply --samples "$3" "$1" \
        -o $work/paths.ply >/dev/null
    build/course/leaves $work/paths.ply | awk -f docs/course/objects.awk "$1" -
}

# answer NAME SCENE LEVEL SAMPLES
answer() {
    means "$2" "$3" "$4" >$work/first
    means "$2" $(($3 + 1)) "$4" >$work/second
    paste $work/first $work/second | awk -v scene="$1" '{
        noise = ($2 - $4) / 2
        printf "%s,%s,%.3f,%.3f\n", scene, $1, ($2 + $4) / 2,
            noise < 0 ? -noise : noise }'
}

echo "scene,object,radiosity,noise"
for scene in squares corner box doorway corridor; do
    answer $scene scenes/$scene.obj 0 "$SAMPLES"
done
for size in 1000 4000 16000; do
    build/room $size 1 >$work/room$size.obj
    answer room$size $work/room$size.obj 2 $((SAMPLES / 300))
done
