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
. tests/panel/scenes.sh
export LC_ALL=C

# trace NAME SCENE PATHS OPTIONS...: $traced.pfm by $folder/NAME.view, if it is not there.
# The first of PATHS are those of a picture of fewer: as the mean of N is that of N/4 and
# of 3N/4 more, both differ by sqrt(3) times the deviation of the whole.
trace() {
    traced=$folder/$1-$3 by=$folder/$1.view of=$2 paths=$3
    shift 3
    [ -e "$traced.pfm" ] || $MPIEXEC -n 2 build/pathtracer "$of" --quiet --view "$by" \
        --samples "$paths" "$@" -o "$traced.pfm"
}

# differ SIDE LAMP A B: the RMS difference of blocks of so many pixels along a side, in
# percent; without those in which a sample of B is above LAMP.
differ() {
    build/imgdiff --blocks "$1" --below "$2" "$3" "$4" |
        awk '$1 == "relative" { print 100 * $4 }'
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
make_scene "$folder/window" 0 window_room
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
