#!/bin/sh
# Radiosity at the points of docs/oracle/cases.csv by Blender's Cycles: "id,value" lines.
# A camera .05 in front of each point that is not on an edge looks at it with a field of
# view of .2 degrees.
set -eu
cd "$(dirname "$0")/../.."
work=build/oracle/cycles
mkdir -p $work
. tests/panel/scenes.sh
awk -F, '$2 ~ /^B at/ && $6 ~ /^panel / && $1 !~ /corner|rim|-s1[.]/ {
    print $1 "|" $2 "|" $6 }' docs/oracle/cases.csv |
    while IFS='|' read -r id what scene; do
        make_scene $work/scene 0 ${scene#panel } </dev/null
        echo "${what#B at }" | awk '{
            print "eye", $1 + .05 * $4, $2 + .05 * $5, $3 + .05 * $6
            print "at", $1, $2, $3
            print "up", ($4 == 0 ? "1 0 0" : "0 0 1")
            print "fov .2" }' >$work/point.view
        blender -b --factory-startup -P tests/cycles.py -- $work/scene.obj \
            $work/point.view 64 256 1 $work/point.pfm >$work/log 2>&1 </dev/null
        python3 -c "
import array
d = open('$work/point.pfm', 'rb').read().split(b'\n', 3)[3]
a = array.array('f', d)
print('$id,%.6g' % (sum(a) / len(a)))"
    done
