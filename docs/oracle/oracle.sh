#!/bin/sh
# `make oracle`: phr, viewfactors, the paper's method and a student's hemicube over
# docs/oracle/cases.csv, and what others have published (published.csv), scored. Results
# go to build/oracle/, a line for each to docs/oracle.md. Two minutes on two cores.
#
# Knob: ONLY, a pattern of scenes.
set -eu
cd "$(dirname "$0")/../.."
: "${ONLY:=.}"
export LC_ALL=C
cases=docs/oracle/cases.csv
work=build/oracle
settings='quick   --epsilon 1e-2 --final-gather 64
middle  --epsilon 1e-3 --final-gather 64
default
paper   --paper --epsilon 1e-2'

# --- view factors ---

# factors NAME OPTIONS...: of all polygons by viewfactors, with the error that it tells.
factors() {
    name=$1
    shift
    awk -F, '$2 ~ /^F 1 2/ { print $1 }' $cases | while read -r id; do
        build/score --obj $cases "$id" >$work/pair.obj
        build/viewfactors --dense "$@" $work/pair.obj >$work/pair.csv 2>$work/log
        told=$(sed -n 's/.*largest error of F: //p' $work/log)
        awk -F, -v id="$id" -v told="$told" '$1 == 1 && $2 == 2 {
            print id "," $4 "," told * 1.5 + 1e-11 }' $work/pair.csv
    done >$work/factors-"$name".csv
}

# --- scenes of the panel ---

# solve SCENE: of all settings; "ID,B,claim" to files of its own. Facets of round bodies
# count to the claim: (2 pi / N)^2 / 6 of N-gons.
solve() {
    . tests/panel/scenes.sh
    file=$work/scenes/$(echo "$1" | cksum | cut -d ' ' -f 1)
    make_scene "$file" 0 $1
    echo "$settings" | while read -r name options; do
        awk -F, -v scene="panel $1" '$6 == scene && $2 ~ /^B at/ {
            sub("B at ", "", $2); print $2 }' $cases >"$file.points"
        at=
        [ ! -s "$file.points" ] || at="--at $file.points"
        # The paper's method takes hours in a white furnace, and knows no clusters.
        case $name-$1 in paper-closed* | paper-furnished* | paper-picture* | \
            paper-wedge* | paper-level* | paper-slot*) continue ;; paper-*) at= ;; esac
        case $1 in level_plate* | slot*) at="$at --sky 3" ;; esac
        ./phr --quiet "$file.obj" $options $at --report "$file.report" >"$file.at" \
            2>"$file.log" || continue
        awk -F, -v scene="panel $1" -v point="$([ "$name" = paper ] || echo yes)" '
            FILENAME ~ /mtl$/ {
                split($0, word, " ")
                if (word[1] == "newmtl") paint = word[2]
                if (word[1] == "Kd") rho[paint] = word[2]
                if (word[1] == "Ke") glow[paint] = word[2]
            }
            FILENAME ~ /at$/ && points++ { h[points - 1] = $10; off[points - 1] = $11 }
            FILENAME ~ /report$/ && $1 == "object" {
                gsub(/"/, "", $2)
                b[$2] = $7; e[$2] = $8; claim[$2] = $11
            }
            FILENAME ~ /cases.csv$/ && $6 == scene {
                group = $1; sub(/.*\./, "", group)
                split(scene, word, " ")
                n = word[3]
                if (word[2] == "frustum") n = 64
                if (word[2] == "shells") n = 24
                if (word[2] == "crater") n = 48
                facets = 0
                if (word[2] ~ /discs|pipe|cavity|frustum|shells|crater/)
                    facets = 6.58 / n ^ 2
                if ($2 ~ /^B mean/ && group in b)
                    give($1, b[group], rho[group] * claim[group])
                if ($2 ~ /^H mean/ && e[group] > 0) # none is looked for on black lamps
                    give($1, e[group], claim[group])
                if ($2 ~ /^B at/ && point == "yes" && ++k in h)
                    give($1, glow[group] + rho[group] * h[k], rho[group] * off[k])
            }
            function give(id, value, error) {
                printf "%s,%.12g,%.4g\n", id, value, error + facets * value
            }' "$file.mtl" "$file.at" "$file.report" $cases >"$file.$name"
    done
}

if [ "${1-}" = solve ]; then
    solve "$2"
    exit
fi

# --- the table ---

# row WHO WHAT FILE NOTE: a line of the table.
row() {
    build/score $cases "$3" >$work/score || true
    sed -n '$p' $work/score | sed 's/[(),:;]//g' | awk -v who="$1" -v what="$2" \
        -v note="$4" '{ printf "| %s | %s | %d | %s | %s | %s | %s |\n", who, what, $1,
            $11, $13, $7, note }'
}

mkdir -p $work/scenes
rm -f $work/scenes/*
factors default
factors 1e-4 --accuracy 1e-4
awk -F, '$6 ~ /^panel / && $2 !~ /^F/ { sub("panel ", "", $6); print $6 }' $cases |
    grep "$ONLY" | sort -u | tr '\n' '\0' |
    xargs -0 -n 1 -P 2 sh docs/oracle/oracle.sh solve
for name in quick middle default; do
    cat $work/scenes/*.$name >$work/light-$name.csv
done
cat $work/scenes/*.paper | cut -d , -f 1,2 >$work/light-paper.csv # it claims nothing
build/oracle/hemicube $cases >$work/hemicube.csv
{
    echo "| who | what | cases | digits, median | worst | beyond | remarks |"
    echo "|---|---|---|---|---|---|---|"
    awk -F, '!/^#/ && !($1 in seen) { seen[$1]; print $1 }' docs/oracle/published.csv |
        while read -r who; do
            awk -F, -v who="$who" '$1 == who { print $2 "," $3 "," $4 }' \
                docs/oracle/published.csv >$work/published
            note=$(awk -F, -v who="$who" '$1 == who { print $5; exit }' \
                docs/oracle/published.csv)
            row "${who%:*}" "${who#*: }" $work/published "$note"
        done
    row "hemicube" "view factors" $work/hemicube.csv \
        "64 x 64 pixels from 32 points; \`docs/oracle/hemicube.c\`"
    row "viewfactors" "view factors" $work/factors-default.csv "default"
    row "viewfactors" "view factors" $work/factors-1e-4.csv "\`--accuracy 1e-4\`"
    row "phr" "light" $work/light-quick.csv "\`--epsilon 1e-2 --final-gather 64\`"
    row "phr" "light" $work/light-middle.csv "\`--epsilon 1e-3 --final-gather 64\`"
    row "phr" "light" $work/light-default.csv "default"
    row "phr, the paper's method" "light, means" $work/light-paper.csv \
        "\`--paper --epsilon 1e-2\`"
} >$work/table
awk -v table=$work/table '/^<!-- table -->/ {
        print; print ""
        while ((getline line <table) > 0) print line
        print ""
        skip = 1
    }
    /^<!-- end -->/ { skip = 0 }
    !skip { print }' docs/oracle.md >$work/page
cat $work/table
cp $work/page docs/oracle.md
# What phr claims of light has to hold in 95 % of the cases, of view factors in all.
status=0
for file in factors-default factors-1e-4 light-middle light-default; do
    build/score --brief $cases $work/$file.csv >$work/$file.txt || {
        part=0
        case $file in light*) part=.05 ;; esac
        sed -n '$p' $work/$file.txt | awk -v part=$part '{ exit $7 > part * $1 }' &&
            continue
        echo "$file: wrong by more than it says"
        cat $work/$file.txt
        status=1
    }
done
exit $status
