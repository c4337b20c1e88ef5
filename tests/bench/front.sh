# make front: error of pictures against seconds, over --epsilon, --final-gather and
# --samples: docs/front.csv, its table in docs/accuracy.md and, with gnuplot,
# docs/front.svg.
#
# The defaults are to be on the front: no other setting is to have a picture with as small
# an error, of pixels and of blocks of 8 x 8, in less than .8 of the seconds. The table
# has the setting that needs the least. A setting is EPSILON/RAYS/SAMPLES, a scene
# NAME:LAMP; blocks with a sample above LAMP do not count. Pictures are SIZE x SIZE;
# seconds are the processor's, from reading to writing. An error below a
# third of the noise of the traced picture, of PATHS a pixel, is a dash. Traced pictures
# are kept under $BUILD/front, and so are the lines of a sweep that is broken off: it goes
# on with the next.
set -eu
: "${BUILD:=build/mpi}" "${MPIEXEC:=mpiexec}" "${PHR:=./phr}" "${CSV:=docs/front.csv}"
: "${SCENES:=cornell:2 doorway:20 corridor:40 room1000:4 room6350:4 window:0.5}"
: "${DEFAULTS:=1e-4/256/3}" "${SIZE:=256}" "${PATHS:=4096}"
: "${SETTINGS:=1e-4/0/3 1e-4/16/3 1e-3/64/3 1e-3/128/3 3e-4/128/3 3e-4/256/3 1e-4/128/3 \
1e-4/256/3 5e-5/128/3 3e-5/128/3 1e-4/256/2 1e-4/256/4}"
folder=$BUILD/front
. tests/bench/renew.sh
. tests/traced.sh
export LC_ALL=C

# quad MATERIAL X Y Z, four times.
quad() {
    printf 'usemtl %s\nv %s %s %s\nv %s %s %s\nv %s %s %s\nv %s %s %s\nf -4 -3 -2 -1\n' $@
}

# A room with a block, 5 x 4 x 2.7 m, below a sky that is seen through a window.
window_room() {
    echo mtllib room.mtl
    quad floor 0 0 0 5 0 0 5 4 0 0 4 0
    quad ceiling 0 0 2.7 0 4 2.7 5 4 2.7 5 0 2.7
    quad wall 0 0 0 0 4 0 0 4 2.7 0 0 2.7
    quad wall 5 0 0 5 0 2.7 5 4 2.7 5 4 0
    quad wall 0 4 0 5 4 0 5 4 2.7 0 4 2.7
    quad wall 0 0 0 0 0 2.7 2 0 2.7 2 0 0
    quad wall 2.8 0 0 2.8 0 2.7 5 0 2.7 5 0 0
    quad wall 2 0 0 2 0 1 2.8 0 1 2.8 0 0
    quad wall 2 0 1.8 2 0 2.7 2.8 0 2.7 2.8 0 1.8
    quad wood 1.2 1.5 .75 2.6 1.5 .75 2.6 2.3 .75 1.2 2.3 .75
    quad wood 1.2 1.5 0 2.6 1.5 0 2.6 1.5 .75 1.2 1.5 .75
    quad wood 2.6 2.3 0 1.2 2.3 0 1.2 2.3 .75 2.6 2.3 .75
    quad wood 1.2 2.3 0 1.2 1.5 0 1.2 1.5 .75 1.2 2.3 .75
    quad wood 2.6 1.5 0 2.6 2.3 0 2.6 2.3 .75 2.6 1.5 .75
}

# shown NAME LAMP SETTING OPTIONS...: a line of the CSV.
shown() {
    name=$1 lamp=$2 setting=$3 rays=${3#*/}
    shift 3
    spent=$( ("$PHR" "$folder/$name.obj" --quiet "$@" --epsilon "${setting%%/*}" \
        --final-gather "${rays%/*}" --samples "${rays#*/}" -o "$folder/shown.pfm"
        times) | processor_seconds)
    printf '%s,%s,%s,%s' "$name" "${rays%/*}" "$setting" "$spent"
    for side in 1 8; do
        { differ $side "$lamp" "$folder/shown.pfm" "$traced.pfm"
            differ $side "$lamp" "$first.pfm" "$traced.pfm"; } | awk '
            NR == 1 { square = $1 ^ 2 }
            NR == 2 { square -= $1 ^ 2 / 3; noise = $1 ^ 2 / 3 }
            END {
                printf ",%s", (square > noise / 8 ? sprintf("%.3g", sqrt(square)) : "-")
            }'
    done
    echo
}

mkdir -p "$folder"
cp scenes/*.obj scenes/*.mtl scenes/*.view "$folder"
window_room >"$folder/window.obj"
printf 'eye 0.4 3.6 1.7\nat 3 0.3 1\nup 0 0 1\nfov 65\n' >"$folder/window.view"
cp scenes/room4000.view "$folder/room6350.view"
lines=$folder/lines.csv
[ -f "$lines" ] || echo "scene,rays,setting,seconds,pixel,block" >"$lines"
for entry in $SCENES; do
    scene=${entry%:*} file=$folder/${entry%:*}.obj
    set -- --size "${SIZE}x$SIZE"
    case $scene in
    room*) build/room "${scene#room}" 1 >"$file" ;;
    window) set -- "$@" --sky 1 ;;
    esac
    trace "$scene" "$file" $((PATHS / 4)) "$@"
    first=$traced
    trace "$scene" "$file" "$PATHS" "$@"
    for setting in $SETTINGS; do
        grep -q "^$scene,[0-9]*,$setting," "$lines" ||
            shown "$scene" "${entry#*:}" "$setting" --view "$folder/$scene.view" "$@" |
            tee -a "$lines"
    done
done
mv "$lines" "$CSV"
# Of each scene the defaults, and the setting that is as good in the least seconds.
awk -F, -v defaults="$DEFAULTS" '
    function error(x) { return x == "-" ? 0 : x }
    function percent(x) { return x == "-" ? x : sprintf("%.2f %%", x) }
    { line[NR] = $0 }
    $3 == defaults { own[$1] = $0; order[++n] = $1 }
    END {
        print "|---|---|---|---|---|---|"
        for (k = 1; k <= n; k++) {
            split(own[order[k]], base)
            least = base[4]; best = base[3]
            for (i = 2; i <= NR; i++) {
                split(line[i], f)
                if (f[1] == base[1] && f[4] < least && error(f[5]) <= error(base[5]) &&
                    error(f[6]) <= error(base[6])) {
                    least = f[4]; best = f[3]
                }
            }
            printf "| %s | %.2f | %s | %s | %s | %.2f |\n", base[1], base[4],
                percent(base[5]), percent(base[6]), best, least / base[4]
        }
        print ""
    }' "$CSV" | tee "$folder/table"
[ "$CSV" != docs/front.csv ] ||
    renew docs/accuracy.md "| picture | seconds |" "## Rays beside Embree" \
        <"$folder/table"
! command -v gnuplot >/dev/null ||
    gnuplot -e "csv='$CSV'; out='${CSV%.csv}'" tests/bench/front.gp
