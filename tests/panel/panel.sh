# make panel: what phr makes of the scenes of tests/panel/table, a line each; with
# BEFORE=commit a line of that commit below each, and a mark at figures that have become
# worse by more than they scatter.
#
# mean, rms, worst, median, tenth, held, noise and claim are those of judge.c; specks,
# grain, block, most, peak and within those of shown.c. said: the claim of the summary
# over the truth, of RMS, median and tenth. power: absorbed over emitted. work: millions
# of tests. All others are percent. Means over orders of faces; behind +- their deviation.
#
# Knobs: SCENES, names of lines; CHECK=yes: those with an asterisk, as TAP against their
# limits; PHR; ELEMENTS and SAMPLES of a truth, PATHS of a pixel, SIZE of a picture.
set -eu
cd "$(dirname "$0")/../.."
: "${BUILD:=build/mpi}" "${PHR:=./phr}" "${MPIEXEC:=mpiexec}" "${MAKE:=make}"
: "${SCENES:=}" "${BEFORE:=}" "${CHECK:=}" "${ELEMENTS:=2000}" "${SAMPLES:=2000}"
: "${PATHS:=256}" "${SIZE:=160}"
export LC_ALL=C
folder=$BUILD/panel truths=$BUILD/panel/truth
mkdir -p "$truths"
. tests/panel/scenes.sh
. tests/bench/renew.sh

# phr_of COMMIT: its phr, built in a folder of its own.
phr_of() {
    there=$folder/before-$(git rev-parse --short "$1")
    [ -x "$there/phr" ] || {
        mkdir -p "$there" && git archive "$1" | tar xf - -C "$there"
        $MAKE -C "$there" phr >"$there/log" 2>&1
    }
    echo "$there/phr"
}

# built ORDER/ORDERS WORD...: $file.obj, and .view if there is one.
built() {
    order=$1
    shift
    file=$folder/$name-${order%/*}
    rm -f "$file.view"
    case $1 in
    room) cp scenes/room.mtl "$folder" && build/room "$2" 1 >"$file.obj"
        [ "${3-}" != seen ] || printf '%s\n' "eye 2.4 .37 1.8" "at -.57 7.79 .2" \
            "up 0 0 1" "fov 70" >"$file.view" ;;
    *)  if [ -f "scenes/$1.obj" ]; then
            cp scenes/*.mtl "$folder" && cp "scenes/$1.obj" "$file.obj"
            [ ! -f "scenes/$1.view" ] || cp "scenes/$1.view" "$file.view"
        else
            make_scene "$file" "$order" "$@"
        fi ;;
    esac
}

# sum_of FILE...: tells files apart.
sum_of() { cat "$@" 2>/dev/null | cksum | cut -d ' ' -f 1; }

# truth SAMPLES: elements of $file.
truth() {
    ref=$truths/$name-$(sum_of "$file.obj" "$file.mtl")-$ELEMENTS-$1.ref
    [ -f "$ref" ] || {
        $MPIEXEC -n 2 "$BUILD/reference" --no-points $sky "$file.obj" "$ref.new" \
            "$ELEMENTS" "$1" >&2
        mv "$ref.new" "$ref"
    }
}

# traced: two pictures of $file.
traced() {
    shot=$truths/$name-$(sum_of "$file.obj" "$file.mtl" "$file.view")-$SIZE
    for paths in $((PATHS / 4)) $PATHS; do
        [ -f "$shot-$paths.pfm" ] || $MPIEXEC -n 2 build/pathtracer "$file.obj" $sky \
            --quiet --view "$file.view" --size "${SIZE}x$SIZE" --samples "$paths" \
            -o "$shot-$paths.pfm" >&2
    done
    shots="$shot-$PATHS.pfm $shot-$((PATHS / 4)).pfm"
}

# is_shown: a picture is made of $file.
is_shown() {
    [ -f "$file.view" ] || return 1
    case ${CHECK:+$limits} in "" | *specks* | *peak*) ;; *) return 1 ;; esac
}

# solved SIDE PHR ORDER: a line of figures of one run.
solved() {
    picture=""
    rm -f "$folder/solution.ply" "$folder/stats" "$folder/shown.pfm"
    ! is_shown || picture="--view $file.view --size ${SIZE}x$SIZE -o $folder/shown.pfm"
    errors=$folder/shown.error.pfm
    [ "$1" = after ] || errors=
    picture="$picture${picture:+${errors:+ -o $errors}}"
    spent=$( ("$2" "$file.obj" --quiet $options --stats "$folder/stats" $picture \
        -o "$folder/solution.ply" >"$folder/log" 2>&1; times) | processor_seconds)
    [ -f "$folder/stats" ] || { echo "$name $1 $3 fails"; return; }
    set -- "$1" "$3" "$spent" $("$BUILD/judge" $sky "$file.obj" "$folder/solution.ply" \
        $by 2>>"$folder/log" || echo - - - - - - - - -)
    set -- "$@" $([ -z "$picture" ] && echo - - - - - - ||
        "$BUILD/shown" "$folder/shown.pfm" ${shots:+$shots $errors})
    cat "$folder/stats" 2>"$folder/log" | awk -v head="$name $1 $2 $3" '
        function key(name) {
            if (!match($0, "\"" name "\": [-+.e0-9]*")) return "-"
            return substr($0, RSTART + length(name) + 4, RLENGTH - length(name) - 4) + 0
        }
        function percent(x) { return x == "-" ? x : 100 * x }
        /"emitted_power"/ { emitted = key("emitted_power") }
        /"absorbed_power"/ { absorbed = key("absorbed_power") }
        /"gathered"/ {
            said = percent(key("error")) " " percent(key("median")) " " \
                   percent(key("worst_tenth"))
        }
        /"work"/ { inside = 1 }
        inside { work += key("all") }
        /^  }/ { inside = 0 }
        END { OFMT = "%.9g"; part = emitted > 0 ? absorbed / emitted : "-"
              print head, work / 1e6, part,
                  said == "" ? "- - -" : said }' | tr '\n' ' '
    shift 3
    echo "$*"
}

# factors: a line of figures of one run of viewfactors.
factors() {
    want=${by%%=*}
    found=$(build/viewfactors "$file.obj" 2>"$folder/log" |
        awk -F, -v from="${want%,*}" -v to="${want#*,}" '$1 == from && $2 == to {
            print $4 }')
    echo "$name after 0 0 0 - - - - 1 $(of "100 * ($found / ${by#*=} - 1)")" \
        "- - - - - - - - - - - - -"
}

figures=$folder/figures
: >"$figures"
[ -z "$BEFORE" ] || before=$(phr_of "$BEFORE")
awk -f tests/panel/lines.awk docs/oracle/cases.csv tests/panel/table >"$folder/lines"
while IFS='|' read -r name scene options by limits; do
    starred=${name%"${name#?}"} name=$(echo ${name#\*})
    [ -z "$CHECK" ] || [ "$starred" = '*' ] || continue
    case " $SCENES " in "  " | *" $name "*) ;; *) continue ;; esac
    options=$(echo $options | sed 's/e3/--epsilon 1e-3 --final-gather 64/
        s/eps=/--epsilon /; s/rays=/--final-gather /; s/tol=/--tolerance /
        s/level=/--max-level /; s/paper/--paper/; s/sky=/--sky /')
    sky=$(echo "$options" | sed -n 's/.*\(--sky .*\)/\1/p') by=$(echo $by) orders=1 shots=
    case $limits in *orders*) orders=${limits##*orders=} orders=${orders%% *} ;; esac
    turn=0
    while [ $turn -lt "$orders" ]; do
        built "$turn/$orders" $scene
        kept=$by
        case " $by" in *" paths"*)
            paths=${by##*paths} paths=${paths#/} by=${by%%paths*}
            case $CHECK/$limits in
            /* | *held=*) truth $((SAMPLES / ${paths:-1})); by=$by$ref ;;
            *) by=$(echo "$by" | sed 's/of=[^ ]*//') ;;
            esac ;;
        esac
        if [ "$options" = factors ]; then
            factors
        else
            [ ! -f "$file.view" ] || [ -n "$CHECK" ] || traced
            solved after "$PHR" "$turn"
            [ -z "$BEFORE" ] || solved before "$before" "$turn"
        fi
        by=$kept turn=$((turn + 1))
    done >>"$figures" </dev/null
    [ -n "$CHECK" ] || grep "^$name " "$figures" | awk -f tests/panel/line.awk \
        -v head="${head-yes}"
    head=
done <"$folder/lines"
[ -z "$CHECK" ] || awk -f tests/panel/check.awk "$folder/lines" "$figures"
