# The scenes of the panel: a function each, whose shapes tests/panel/shapes.awk makes OBJ
# of. z is up, lengths are metres, radiosities W/m^2; a paint's name is that of its group,
# which truths are told about.
#
#     . tests/panel/scenes.sh
#     make_scene FOLDER/NAME ORDER FUNCTION WORD...    NAME.obj, .mtl and perhaps .view

for shape in paint group cells quad sheet room block walk at view; do
    eval "$shape() { echo $shape \"\$@\"; }"
done

# each FROM TO COMMAND...: the command with the numbers FROM .. TO in $k.
each() {
    k=$1 to=$2
    shift 2
    while [ "$k" -le "$to" ]; do "$@"; k=$((k + 1)); done
}

# of EXPRESSION: of awk.
of() { awk "BEGIN { pi = atan2(0, -1); printf \"%.9g\", $1 }"; }

# --- closed forms: strips, discs, tubes, cavities ---

groove() { # DEGREES RHO E: two walls of 60 unit squares, in turns
    groove_of 60 10 "$1" "$2" "$3" "$3"
    each 0 59 pair_of_groove
}
strips() { # DEGREES RHO E E2: a groove of 40, one wall after the other
    groove_of 40 4 "$@"
    each 0 39 floor_of_groove
    each 0 39 wall_of_groove
}
groove_of() { # LENGTH MIDDLE DEGREES RHO E E2
    first=$((($1 - $2) / 2)) behind=$((($1 + $2) / 2)) rho=$4 floor=$5 wall=$6
    x=$(of "cos($3 * pi / 180)") z=$(of "sin($3 * pi / 180)")
}
pair_of_groove() { floor_of_groove; wall_of_groove; }
floor_of_groove() {
    paint "$(part_of_groove)first" "$rho" "$floor"
    sheet z 0 + 0 $k 1 $((k + 1))
}
wall_of_groove() {
    paint "$(part_of_groove)second" "$rho" "$wall"
    quad 0 $k 0 0 $((k + 1)) 0 "$x" $((k + 1)) "$z" "$x" $k "$z"
}
part_of_groove() { [ "$k" -ge $first ] && [ "$k" -lt $behind ] || echo end-; }

facing() { # HEIGHT RHO E E2 [SPECK]: unit squares; a small thing between, black behind
    paint first "$2" "$3"
    sheet z 0 + 0 0 1 1
    paint second "$2" "$4"
    sheet z "$1" - 0 0 1 1
    [ $# -eq 5 ] || return 0
    paint speck 0 0
    quad .5 .5 .5 .501 .5 .5 .5 .501 .5 .5 .501 .5
    sheet z -1 - -5 -5 5 5
}

facing_unlike() { # HEIGHT RHO RHO: the first shines
    paint first "$2" 1
    sheet z 0 + 0 0 1 1
    paint second "$3" 0
    sheet z "$1" - 0 0 1 1
}

coaxial() { # SIDES R R LENGTH: one tube in another, open at their ends
    paint inner .5 1
    walk "$1" "$2" "$4" "$2" 0
    paint outer .5 0
    walk "$1" "$3" 0 "$3" "$4"
}

discs() { # SIDES RHO
    paint lamp "$2" 1
    walk "$1" 0 0 1 0
    paint other "$2" 0
    walk "$1" 1 1 0 1
}

pipe() { # SIDES RINGS RHO LENGTH: black ends, of which the lower one shines
    paint lamp 0 1
    walk "$1" 0 0 1 0 1
    paint wall "$3" 0
    walk "$1" 1 0 1 "$4" "$2"
    paint end 0 0
    walk "$1" 1 "$4" 0 "$4"
}

frustum() { # R TOP HEIGHT RHO: closed, the base shines
    paint lamp 0 1
    walk 64 0 0 "$1" 0
    paint wall "$4" 0
    walk 64 "$1" 0 "$2" "$3" 4
    paint top "$4" 0
    walk 64 "$2" "$3" 0 "$3"
}

cavity() { # SIDES LENGTH EPS: open above, isothermal
    rho=$(of "1 - $3")
    paint base "$rho" "$3"
    walk "$1" 0 0 1 0 2
    paint wall "$rho" "$3"
    walk "$1" 1 0 1 "$2" 8
}

crater() { # RHO: a cap of 60 degrees, a zone of it shines; steps of 4 degrees
    paint lamp "$1" 1
    each 0 3 zone 1
    paint dark "$1" 0
    each 4 14 zone 1
}
zone() { # RADIUS: the k-th of 4 degrees, seen from the inside
    set -- "$1" $(of "sin($k * pi / 45)") $(of "-cos($k * pi / 45)") \
        $(of "sin(($k + 1) * pi / 45)") $(of "-cos(($k + 1) * pi / 45)")
    walk 48 "$(of "$1 * $2")" "$(of "$1 * $3")" "$(of "$1 * $4")" "$(of "$1 * $5")"
}

cie() { # RHO: a cube of 4 m, a square metre of a side shines 10,000 lm
    paint wall "$1" 0
    sheet x 0 + 0 0 4 4 1 1 2 2
    sheet x 4 - 0 0 4 4
    sheet y 0 + 0 0 4 4
    sheet y 4 - 0 0 4 4
    sheet z 0 + 0 0 4 4
    sheet z 4 - 0 0 4 4
    paint lamp "$1" 10000
    sheet x 0 + 1 1 2 2
}

glowing() { # RHO: a unit cube of twelve triangles, of which the bottom, y = 0, shines
    paint bottom "$1" 1
    quad 0 0 0 0 0 1 1 0 1 1 0 0
    paint top "$1" 0
    quad 0 1 0 1 1 0 1 1 1 0 1 1
    paint low-1 "$1" 0
    quad 0 0 0 1 0 0 1 1 0 1 1 0
    quad 0 0 0 0 1 1 0 0 1 0 0 1
    paint high-1 "$1" 0
    quad 0 0 0 1 1 0 0 1 0 0 1 0
    quad 0 0 0 0 1 0 0 1 1 0 1 1
    paint low-2 "$1" 0
    quad 0 0 1 1 1 1 1 0 1 1 0 1
    quad 1 0 0 1 0 1 1 1 1 1 1 1
    paint high-2 "$1" 0
    quad 0 0 1 0 1 1 1 1 1 1 1 1
    quad 1 0 0 1 1 1 1 1 0 1 1 0
}

shells() { # a ball that shines in another of twice its size
    paint inner .5 1
    each 0 11 zone_out .5 24
    paint outer .8 0
    each 0 11 zone_in 1 24
}
zone_in() { zone_out "$@" | awk '{ print $1, $2, $5, $6, $3, $4 }'; }

spot() { # HALF_SIZE HEIGHT E: above a unit square
    paint floor .5 0
    sheet z 0 + -.5 -.5 .5 .5
    paint lamp 0 "$3"
    sheet z "$2" - "-$1" "-$1" "$1" "$1"
}

sheet_on_floor() { # lying, or in a hole
    paint lamp .5 1
    sheet z 1 - 0 0 1 1
    paint floor .8 0
    case $1 in lying) cells 4; sheet z 0 + 0 0 1 1; cells 1 ;; *)
        sheet z 0 + 0 0 1 1 .25 .25 .75 .75 ;;
    esac
    paint sheet .1 0
    sheet z 0 + .25 .25 .75 .75
}

above() { # HEIGHT X0 Y0 X1 Y1: a plate over a unit square that shines
    paint lamp 0 1
    sheet z 0 + 0 0 1 1
    paint plate .5 0
    sheet z "$1" - "$2" "$3" "$4" "$5"
}

right_angle() { # two squares at a right angle
    paint lamp 0 1
    sheet z 0 + 0 0 1 1
    paint plate .5 0
    sheet x 0 + 0 0 1 1
}

around() { # the floor around a lamp that hangs 2 mm above it
    paint lamp 0 1
    sheet z .002 - 0 0 1 1
    paint plate .5 0
    sheet z 0 + -1 -1 2 2 0 0 1 1
}

foliage() { # forty small black squares between a floor and a lamp as wide
    paint floor .999 0
    sheet z 0 + 0 0 1 1
    paint lamp 0 1
    sheet z 1 - 0 0 1 1
    paint leaf 0 0
    each 0 39 leaf_of_foliage
}
leaf_of_foliage() {
    awk -v k=$k 'function part(i) { return .5 + .5 * sin(1000 * sin(4 * k + i)) }
        BEGIN { x = part(0); y = part(1); z = .1 + .8 * part(2); t = .1 * part(3)
                print "quad", x, y, z, x + .06, y, z + t, x + .06, y + .06, z, x,
                      y + .06, z - t }'
}

screen() { # four hundred black squares halfway to a wide lamp
    paint floor .5 0
    sheet z 0 + -.1 -.1 .1 .1
    paint lamp 0 1
    sheet z 1 - -5 -5 5 5
    paint screen 0 0
    awk 'BEGIN {
        for (k = 0; k < 400; k++) {
            x = k % 20 * .1 - .9975; y = int(k / 20) * .1 - .9975
            print "sheet z .5 -", x, y, x + .095, y + .095
        }
    }'
}

in_the_ceiling() { # [behind]: a lamp, which comes before the room or behind it
    [ $# -eq 0 ] || room_with_post
    paint lamp 0 10
    sheet z 1 - .4 .4 .6 .6
    [ $# -eq 1 ] || room_with_post
}
room_with_post() {
    paint wall .5 0
    sheet x 0 + 0 0 1 1
    sheet x 1 - 0 0 1 1
    sheet y 0 + 0 0 1 1
    sheet y 1 - 0 0 1 1
    sheet z 1 - 0 0 1 1
    paint floor .5 0
    sheet z 0 + 0 0 1 1
    paint post .5 0
    block .6 .6 0 .8 .8 .5
}

closet() { # [hall]: lit by a candle, beside a bright hall
    paint closet .5 0
    room 0 0 0 1 1 1
    paint candle .5 10
    sheet z .95 - .5 .5 .55 .55
    [ $# -eq 0 ] && return
    paint hall .5 0
    room 2 0 0 4 2 2
    paint lamp 0 1e5
    sheet z 1.9 - 2.5 .5 3.5 1.5
}

hole() { # HALF_WIDTH HALF_HEIGHT: in a screen between a lamp and a floor
    paint floor .5 0
    sheet z 0 + -.5 -.5 .5 .5
    paint screen 0 0
    sheet z .5 + -6 -6 6 6 "-$1" "-$2" "$1" "$2"
    paint lamp 0 1
    sheet z 1 - -4 -4 4 4
}

flush_lamp() { # in the plane of a ceiling
    paint wall .5 0
    room 0 0 0 1 1 1
    paint lamp .5 1
    sheet z 1 - .4 .4 .6 .6
}

lit_end() { # of a corridor
    paint lamp .99 1
    sheet x 0 + 0 0 1 1
    paint wall .99 0
    sheet x 10 - 0 0 1 1
    sheet y 0 + 0 0 10 1
    sheet y 1 - 0 0 10 1
    sheet z 0 + 0 0 10 1
    sheet z 1 - 0 0 10 1
}

thin_wall() { # a wall of 1 mm, a block behind it
    paint wall .5 0
    room 0 0 0 2 1 1
    block 1 0 0 1.001 1 1
    paint lamp 0 1
    sheet z .9 - .7 .2 .9 .8
    paint dark .5 0
    block 1.1 .4 .1 1.3 .6 .3
}

# --- furnaces: E is 1 - RHO, or the next word ---

all() { # RHO [E]
    paint all "$1" "${2:-$(of "1 - $1")}"
}

closed() { # LENGTH RHO [E]
    length=$1
    shift
    all "$@"
    room 0 0 0 "$length" 1 1
}

furnished() { # RHO [E]: with three blocks
    closed 1 "$@"
    block .1 .15 .6 .3 .35 .85
    block .38 .4 .4 .58 .6 .65
    block .66 .65 .2 .86 .85 .45
}

mixed() { # a furnished room, half of whose faces have half of the reflectance
    paint all .9 .1
    sheet x 0 + 0 0 1 1
    sheet y 0 + 0 0 1 1
    sheet z 0 + 0 0 1 1
    block .1 .15 .6 .3 .35 .85
    paint half .45 .55
    sheet x 1 - 0 0 1 1
    sheet y 1 - 0 0 1 1
    sheet z 1 - 0 0 1 1
    block .38 .4 .4 .58 .6 .65
}

black_body() { # RHO: a furnace with a black thing in it
    closed 1 "$1"
    paint black 0 1
    block .38 .4 .4 .58 .6 .65
}

picture() { # RHO: so close to a wall that paths have more than a hundred points
    closed 1 "$1"
    block .0005 .4 .4 .005 .6 .6
}

wedge() { # DEPTH RHO [E]: a prism of height 1, between walls that far apart at the end
    half=$(of "$1 / 2")
    shift
    all "$@"
    quad 0 0 0 1 "-$half" 0 1 "$half" 0 1 "$half" 0
    quad 0 0 1 1 "$half" 1 1 "-$half" 1 1 "-$half" 1
    quad 0 0 0 0 0 1 1 "-$half" 1 1 "-$half" 0
    quad 1 "-$half" 0 1 "-$half" 1 1 "$half" 1 1 "$half" 0
    quad 1 "$half" 0 1 "$half" 1 0 0 1 0 0 0
}

twice() { # RHO [E]: each face as one and as four
    closed 1 "$@"
    cells 2
    room 0 0 0 1 1 1
}

junctions() { # a floor of four rectangles, whose corners lie on edges of others
    all .9 1
    sheet z 0 + 0 0 .5 .3
    sheet z 0 + .5 0 1 .7
    sheet z 0 + 0 .3 .5 1
    sheet z 0 + .5 .7 1 1
    sheet z 1 - 0 0 1 1
    sheet x 0 + 0 0 1 1
    sheet x 1 - 0 0 1 1
    sheet y 0 + 0 0 1 1
    sheet y 1 - 0 0 1 1
}

standing() { # [THROUGH]: a block on the floor, and one through both
    closed 1 .9 1
    block .2 .2 0 .6 .6 .3
    [ $# -eq 0 ] || block .5 .5 -.2 .9 .8 .2
}

pierced() { # sixteen tetrahedra through each other, and the walls around them
    closed 1 .99
    paint heap .99 .01
    each 0 15 tetrahedron
}
tetrahedron() {
    set -- $(awk -v k="$k" '
        function at(i) { return .5 + .3 * sin(1000 * sin(k + i / 12)) }
        function edge(j, i) { return p[j + i] - p[i] }
        BEGIN {
            for (i = 0; i < 12; i++) p[i] = at(i)
            turn = edge(3, 0) * (edge(6, 1) * edge(9, 2) - edge(6, 2) * edge(9, 1)) + \
                   edge(3, 1) * (edge(6, 2) * edge(9, 0) - edge(6, 0) * edge(9, 2)) + \
                   edge(3, 2) * (edge(6, 0) * edge(9, 1) - edge(6, 1) * edge(9, 0))
            for (j = 0; j < 4; j++) for (i = 0; i < 3; i++)
                printf "%.9f ", p[3 * (turn < 0 && j > 1 ? 5 - j : j) + i]
        }')
    quad $1 $2 $3 $7 $8 $9 $4 $5 $6 $4 $5 $6
    quad $1 $2 $3 $4 $5 $6 ${10} ${11} ${12} ${10} ${11} ${12}
    quad $1 $2 $3 ${10} ${11} ${12} $7 $8 $9 $7 $8 $9
    quad $4 $5 $6 $7 $8 $9 ${10} ${11} ${12} ${10} ${11} ${12}
}

on_ground() { # none or wide: a room whose wall a sheet before it lights
    paint room .5 0
    room 0 0 0 1 1 1
    sheet x .0005 + .3 .3 .7 .7
    block .3 .2 .1 .7 .5 .4
    paint lamp 0 100
    sheet z .95 - .4 .4 .6 .6
    paint back 0 20
    sheet x .0005 - .3 .3 .7 .7
    paint ground 0 0
    [ "$1" = none ] || sheet z -1 + -500 -500 500 500
}

inside_out() {
    paint all .5 1
    block 0 0 0 1 1 1
}
one_flipped() { # half of a side of a room
    paint rest .5 1
    sheet x 0 + 0 0 1 1
    sheet y 0 + 0 0 1 1
    sheet y 1 - 0 0 1 1
    sheet z 0 + 0 0 1 1
    sheet z 1 - 0 0 1 1
    quad 1 0 0 1 0 1 1 1 1 1 1 1
    paint flipped .5 1
    quad 1 0 0 1 1 0 1 1 1 1 1 1
}

backs() { # walls show their backs to a room; floor and ceiling go on below and above
    paint wall .7 0
    sheet x 0 - 0 0 1 1
    sheet x 1 + 0 0 1 1
    sheet y 0 - 0 0 1 1
    sheet y 1 + 0 0 1 1
    paint floor .5 0
    sheet z 0 + -.02 -.02 1.02 1.02
    paint lamp .5 1
    sheet z 1 - -.02 -.02 1.02 1.02
}

kept() { # RHO: a lamp that reflects as all does
    furnished "$1" 0
    paint lamp "$1" 100
    block .45 .85 .45 .55 .86 .55
}

hung_lamp() { # a block that shines, its top in the plane of the ceiling
    paint wall .6 0
    room 0 0 0 1 1 1
    paint lamp .6 1
    block .4 .4 .9 .6 .6 1
}

cie_planes() { # RECEIVER SOURCE: of a room of 4 x 4 x 3 m one reflects, one shines
    plane_of_cie wall "$@"
    sheet y 0 + 0 0 4 3
    plane_of_cie floor "$@"
    sheet z 0 + 0 0 4 4
    plane_of_cie ceiling "$@"
    if [ "$2" = ceiling ]; then sheet z 3 - 1.5 1.5 2.5 2.5; else sheet z 3 - 0 0 4 4; fi
}
plane_of_cie() {
    rho=0 e=0
    [ "$1" != "$2" ] || rho=.5
    [ "$1" != "$3" ] || e=1
    paint "$1" $rho $e
}

cie_slab() { # AXIS: light over a slab of 1 m, at points of the wall y = 0 or floor z = 0
    paint source 0 1
    sheet y 4 - 0 0 4 3
    paint slab 0 0
    block 0 2.5 0 4 2.7 1
    for at in .25 .75 1.25 1.75 2.25 2.75; do
        paint at-$at .5 0
        sheet "$1" 0 + 1.995 "$(of "$at - .005")" 2.005 "$(of "$at + .005")"
    done
}

# --- white rooms ---

# sides X Y Z X Y Z SIDE...: these of a block, as x- (at the low x) or z+.
sides() {
    low="$1 $2 $3" high="$4 $5 $6"
    shift 6
    for side in "$@"; do
        set -- $low $high
        case $side in
        x-) sheet x $1 - $2 $3 $5 $6 ;; x+) sheet x $4 + $2 $3 $5 $6 ;;
        y-) sheet y $2 - $1 $3 $4 $6 ;; y+) sheet y $5 + $1 $3 $4 $6 ;;
        z-) sheet z $3 - $1 $2 $4 $5 ;; z+) sheet z $6 + $1 $2 $4 $5 ;;
        esac
    done
}

touching() { # RHO: a furnace with bodies that touch walls, the floor, and each other
    e=$(of "1 - $1")
    paint all "$1" "$e" # what no body touches
    sheet y 0 + 0 0 1 1
    sheet y 1 - 0 0 1 1
    sides 0 .1 0 .2 .3 .25 x+ y- z+
    sides 0 .3 0 .2 .5 .25 x+ y+ z+
    sides .4 .4 0 .7 .6 .5 x- x+ y- y+ z+
    sides .8 .75 0 1 .95 1 x- y- y+
    paint touched "$1" "$e"
    sheet x 0 + 0 0 1 1
    sheet x 1 - 0 0 1 1
    sheet z 0 + 0 0 1 1
    sheet z 1 - 0 0 1 1
    sides 0 .1 0 .2 .3 .25 x- y+ z-
    sides 0 .3 0 .2 .5 .25 x- y- z-
}

touching_boxes() { # RHO: they hide parts of walls, and of each other; one is open there
    all "$1"
    sheet x 1 - 0 0 1 1
    sheet y 0 + 0 0 1 1
    sheet y 1 - 0 0 1 1
    sheet z 1 - 0 0 1 1
    sides 0 .1 0 .2 .3 .25 x+ y-
    sides 0 .3 0 .2 .5 .25 x+ y+ z+
    sides 0 .1 .25 .2 .3 .4 x+ y- y+ z+
    sides 0 .7 0 .2 .9 .25 x+ y- y+ z+
    paint touched "$1" "$(of "1 - $1")"
    sheet x 0 + 0 0 1 1
    sheet z 0 + 0 0 1 1
    sides 0 .1 0 .2 .3 .25 x- y+ z- z+
    sides 0 .3 0 .2 .5 .25 x- y- z-
    sides 0 .1 .25 .2 .3 .4 x- z-
}

slivers() { # to 1 : 1e6, both sides
    paint all .99 .01
    room 0 0 0 1 1 1
    for z in .51 .5001 .500001; do
        quad .03 .05 .5 .93 .96 .5 .93 .96 $z .03 .05 .5
        quad .03 .05 .5 .03 .05 .5 .93 .96 $z .93 .96 .5
    done
}

white() { # RHO X Y Z X Y Z SIDE...: a white room with a thing in it, of these sides
    paint all "$1" 0
    room 0 0 0 4 3 2.5
    rho=$1
    shift
    sides "$@"
    paint lamp "$rho" 10
    block 1.5 1 2.39 2.3 1.6 2.45
}

gap_lamp() { # RHO: a one-sided lamp 1 cm below the ceiling
    paint all "$1" 0
    room 0 0 0 4 3 2.5
    paint lamp "$1" 10
    sheet z 2.49 - 1.5 1 2.3 1.6
}

bends() { # RHO: a corridor of three arms
    paint lamp "$1" 10
    sheet x 0 + 0.5 0.5 1.5 2
    paint near "$1" 0
    sheet x 0 + 0 0 2 2.5 .5 .5 1.5 2
    floors 0 0 8 2
    sheet y 0 + 0 0 8 2.5
    sheet y 2 - 0 0 6 2.5
    sheet x 8 - 0 0 2 2.5
    paint middle "$1" 0
    floors 6 2 8 8
    sheet x 6 + 2 0 8 2.5
    sheet x 8 - 2 0 10 2.5
    paint far "$1" 0
    floors 0 8 8 10
    sheet y 8 + 0 0 6 2.5
    sheet y 10 - 0 0 8 2.5
    sheet x 0 + 8 0 10 2.5
}
floors() { # X0 Y0 X1 Y1
    sheet z 0 + "$@"
    sheet z 2.5 - "$@"
}

# --- ducts ---

duct() { # LENGTH: .3 x .3, one end shines, the other is open
    paint lamp 0 1
    sheet x 0 + 0 0 .3 .3
    paint wall .5 0
    each 0 9 ring_of_duct "$(of "$1 / 10")"
}
ring_of_duct() {
    a=$(of "$k * $1") b=$(of "($k + 1) * $1")
    sheet z 0 + "$a" 0 "$b" .3
    sheet z .3 - "$a" 0 "$b" .3
    sheet y 0 + "$a" 0 "$b" .3
    sheet y .3 - "$a" 0 "$b" .3
}

l_duct() { # two arms of 1 x 1 x 3, open at the far end
    paint lamp 0 1
    sheet x 0 + 0 0 1 1
    paint near .7 0
    sheet z 0 + 0 0 3 1
    sheet z 1 - 0 0 3 1
    sheet y 0 + 0 0 3 1
    sheet y 1 - 0 0 2 1
    sheet x 3 - 0 0 1 1
    paint far .7 0
    sheet z 0 + 2 1 3 4
    sheet z 1 - 2 1 3 4
    sheet x 2 + 1 0 4 1
    sheet x 3 - 1 0 4 1
}

# --- openings ---

opening() { # THICK Y0 Z0 Y1 Z1 [one [D]]: between a lit room and a dark one of 3 m
    far=$(of "3 + $1") end=$(of "6 + $1") floor=${6:-two} # on the dark side a pane
    paint dark .7 0
    [ "$floor" = one ] || sheet z 0 + "$far" 0 "$end" 3
    sheet z 3 - "$far" 0 "$end" 3
    sheet y 0 + "$far" 0 "$end" 3
    sheet y 3 - "$far" 0 "$end" 3
    sheet x "$end" - 0 0 3 3
    sheet x "$far" + 0 0 3 3 "$2" "$3" "$4" "$5"
    paint lit .7 0
    [ "$floor" = one ] || sheet z 0 + 0 0 3 3
    [ "$floor" = two ] || sheet z 0 + 0 0 "$end" 3
    sheet z 3 - 0 0 3 3 1.2 1.2 1.8 1.8
    sheet y 0 + 0 0 3 3
    sheet y 3 - 0 0 3 3
    sheet x 0 + 0 0 3 3
    sheet x 3 - 0 0 3 3 "$2" "$3" "$4" "$5"
    [ "$floor" = one ] || sheet z "$3" + 3 "$2" "$far" "$4"
    sheet z "$5" - 3 "$2" "$far" "$4"
    sheet y "$2" + 3 "$3" "$far" "$5"
    sheet y "$4" - 3 "$3" "$far" "$5"
    paint lamp 0 100
    sheet z 3 - 1.2 1.2 1.8 1.8
    [ $# -lt 7 ] || { paint pane 0 0 "$7" && sheet x "$far" + "$2" "$3" "$4" "$5"; }
}

furnished_rooms() { # OPEN: two, a wall of 1 cm between; a ninth of it is open
    two_rooms="$1"
    paint lit .5 0
    boxes_of_room -4
    room_of_cells -4 -.005
    paint dark .5 0
    boxes_of_room .2
    room_of_cells .005 4
    paint lamp 0 100
    sheet z 2.4 - 1.8 -2.2 2.2 -1.8
}
boxes_of_room() { # Y: a dozen of all sizes, none touches another or a wall
    cells 2
    for k in 0 1 2 3 4 5 6 7 8 9 10 11; do
        block $(awk -v k=$k -v y="$1" '
            function part(i) { return .5 + .5 * sin(7 * k + i) }
            BEGIN { x = .1 + 1.3 * (k % 3); y += .1 + .9 * int(k / 3)
                    printf "%.4g %.4g .01 %.4g %.4g %.4g", x, y, x + .3 + .8 * part(1),
                           y + .3 + .5 * part(2), .21 + 1.3 * part(3) }')
    done
}
room_of_cells() { # Y0 Y1: the wall between has a hole if that is asked for
    cells 3
    sheet x 0 + "$1" 0 "$2" 2.5
    sheet x 4 - "$1" 0 "$2" 2.5
    sheet z 0 + 0 "$1" 4 "$2"
    sheet z 2.5 - 0 "$1" 4 "$2"
    far=$1 near="$2 -" sign=+
    [ "$2" != 4 ] || far=4 near="$1 +" sign=-
    sheet y "$far" "$sign" 0 0 4 2.5
    if [ "$two_rooms" = open ]; then
        cells 1
        sheet y $near 0 0 4 2.5 2.6667 1.6667 3.9 2.4
    else
        sheet y $near 0 0 4 2.5
    fi
    cells 1
}

books() { # WIDER: a row of 24, gaps of 1 to 3 mm or as much wider, boards around
    paint lamp 0 100
    sheet z 2.4 - 1.8 2 2.2 2.4
    awk -v wider="$1" 'BEGIN {
        for (x = 1; k < 24; k++) {
            end = x + .03 + .01 * sin(7 * k)
            print "paint spine .5 0\ncells 2\nsheet y .3 +", x, 1.001, end, 1.251
            for (side = 0; side < 2; side++) {
                is_end = k + side == 0 || k + side == 24
                print "paint", is_end ? "rest" : "deep", ".5 0"
                print "sheet x", side ? end : x, side ? "+" : "-", .1, 1.001, .2, 1.251
                print "paint rest .5 0"
                print "sheet x", side ? end : x, side ? "+" : "-", .2, 1.001, .3, 1.251
                print "sheet z", side ? "1.251 +" : "1.001 -", x, .1, end, .3
            }
            print "sheet y .1 -", x, 1.001, end, 1.251
            x = end + wider * (.002 + .001 * sin(5 * k))
        }
        print "block .9 .1 .98", x + .1, ".3 1"
        print "block .9 .1 1.252", x + .1, ".3 1.272"
        print "block .9 .07 .98", x + .1, ".099 1.272"
    }'
    cells 3
    room 0 0 0 4 4 2.5
    cells 1
}

two_panes() { # D D: wide, between a shining square and another one
    paint top .5 0
    sheet z 1 - 0 0 1 1
    paint lamp 0 1
    sheet z 0 + 0 0 1 1
    paint first 0 0 "$1"
    sheet z .3 + -9 -9 10 10
    paint second 0 0 "$2"
    sheet z .6 - -9 -9 10 10
}
furnace_with_pane() { # RHO D: across a closed room in which B is 1
    paint wall .5 .5
    room 0 0 0 2 1 1
    paint pane "$1" 0 "$2"
    sheet x .9 + 0 0 1 1
}

window() { # WIDTH HEIGHT [D]: a room of 5 x 4 x 2.7 m, ground and facades below a sky
    x0=$(of "2.5 - $1 / 2") x1=$(of "2.5 + $1 / 2") z1=$(of "1 + $2")
    paint inside .6 0
    sheet z 0 + 0 0 5 4
    sheet z 2.7 - 0 0 5 4
    sheet x 0 + 0 0 4 2.7
    sheet x 5 - 0 0 4 2.7
    sheet y 4 - 0 0 5 2.7
    sheet y 0 + 0 0 5 2.7 "$x0" 1 "$x1" "$z1"
    paint outside .4 0
    sheet y -.2 - 0 0 5 2.7 "$x0" 1 "$x1" "$z1"
    sheet z 1 + "$x0" -.2 "$x1" 0
    sheet z "$z1" - "$x0" -.2 "$x1" 0
    sheet x "$x0" + -.2 1 0 "$z1"
    sheet x "$x1" - -.2 1 0 "$z1"
    sheet x 0 - -.2 0 4 2.7
    sheet x 5 + -.2 0 4 2.7
    sheet y 4 + 0 0 5 2.7
    sheet z 2.7 + 0 -.2 5 4
    sheet z -.1 + -10 -14 15 -.2
    [ $# -lt 3 ] || { paint pane .5 0 "$3" && sheet y 0 + "$x0" 1 "$x1" "$z1"; }
    view .4 3.6 1.6 3 .3 1 65
}

window_room() { # of 5 x 4 x 2.7 m, with a table, below a sky that a window shows
    paint floor .3,.31,.34 0
    sheet z 0 + 0 0 5 4
    paint ceiling .83,.83,.82 0
    sheet z 2.7 - 0 0 5 4
    paint wall .78,.76,.7 0
    sheet x 0 + 0 0 4 2.7
    sheet x 5 - 0 0 4 2.7
    sheet y 4 - 0 0 5 2.7
    sheet y 0 + 0 0 5 2.7 2 1 2.8 1.8
    paint wood .56,.4,.24 0
    sides 1.2 1.5 0 2.6 2.3 .75 x- x+ y- y+ z+
    view .4 3.6 1.7 3 .3 1 65
}

to_the_sky() { # SIGN: a room whose window shows ground and a sky; a black plain below
    paint wall .7 0
    sheet z 0 + 0 0 4 3
    sheet z 2.5 - 0 0 4 3
    sheet x 0 + 0 0 3 2.5
    sheet x 4 - 0 0 3 2.5
    sheet y 3 - 0 0 4 2.5
    sheet y 0 + 0 0 4 2.5 .8 1 3.2 2.2
    block 1 1 .7 2.6 1.8 .73
    block 1.2 1.3 .731 1.5 1.6 .931
    block 3 2 .002 3.6 2.6 1.202
    block .3 2.4 .002 1.8 2.9 1.902
    paint ground .3 0
    sheet z -.5 + -8 -6 12 -.2
    paint sky 0 5
    sheet y -6 + -8 -3 12 12
    paint plain 0 0
    sheet z -4 "$1" -40 -6 40 40
}

level_plate() { # RHO
    paint plate "$1" 0
    sheet z 0 + 0 0 2 1
}

leaning() { # RHO: ten by ten squares in a plane that leans back by 30 degrees
    paint plane "$1" 0
    each 0 99 square_of_plane
}
square_of_plane() {
    low=$(of "int($k / 10)") x=$((k % 10))
    y=$(of "$low * .5") z=$(of "$low * cos(pi / 6)")
    top="$(of "($low + 1) * .5") $(of "($low + 1) * cos(pi / 6)")"
    quad $x $y $z $((x + 1)) $y $z $((x + 1)) $top $x $top
}

box_on_plain() { # RHO: on black
    paint top "$1" 0
    sides -1 -1 0 1 1 2 z+
    paint side "$1" 0
    sides -1 -1 0 1 1 2 x- x+ y- y+
    paint plain 0 0
    sheet z 0 + -200 -200 200 200
}

slot() { # RHO [X SIGN]...: a small plate on black ground 2 wide, black walls along it
    paint plate "$1" 0
    sheet z 0 + -.01 -.01 .01 .01
    paint black 0 0
    sheet z 0 + -1 -40 1 40 -.01 -.01 .01 .01
    while [ $# -gt 2 ]; do
        sheet x "$2" "$3" -40 0 40 1
        shift 2
    done
}

below_box() { # 2 mm above the floor of a white room
    paint wall .99 0
    room 0 0 0 4 3 2.5
    paint below .99 0
    sides 1.2 1 .002 2.7 2.5 .9 z-
    paint box .99 0
    sides 1.2 1 .002 2.7 2.5 .9 x- x+ y- y+ z+
    paint lamp .99 40
    block 1.7 1.3 2.2 2.3 1.7 2.3
}

tent() { # on a wide lawn below a wide sky, open at one end above a flap
    cloth -1.5 0 0 -1.5 4 0 0 4 2
    cloth -1.5 0 0 0 4 2 0 0 2
    cloth 1.5 4 0 1.5 0 0 0 0 2
    cloth 1.5 4 0 0 0 2 0 4 2
    cloth -1.5 4 0 1.5 4 0 0 4 2
    cloth 1.5 0 0 -1.5 0 0 0 0 1.2
    paint lawn .3 0
    cells 4
    sheet z 0 + -50 -50 50 50
    cells 1
    paint sky 0 3
    sheet z 30 - -50 -50 50 50
}
cloth() { # three corners: inside and its back
    paint inside .7 0
    quad "$@" $7 $8 $9
    paint outside .7 0
    quad $1 $2 $3 $7 $8 $9 $4 $5 $6 $4 $5 $6
}

slabs() { # [BLOCK]: of 10 cm that no light can enter, below a sky; y is up
    paint slab .7 0
    block -2.3 -.1 -2.3 2.3 0 2.3
    block -2.3 2.6 -2.3 2.3 2.7 2.3
    block -2.1 0 -2.1 2.1 2.6 -2
    block -2.1 0 2 2.1 2.6 2.1
    block -2.1 0 -2 -2 2.6 2
    block 2 0 -2 2.1 2.6 2
    [ $# -eq 0 ] || { paint inside .7 0; block -.5 .5 -.5 .5 1 .5; }
    paint sky 0 1
    room -8 -.2 -8 8 8 8
}

roof() { # a flat roof below a sky, with a parapet and a box
    paint roof .5 0
    sheet z 0 + 0 0 10 8
    block 6 5 .001 7.5 6.5 1
    view 5 -7 6 5 4 0 50
}

blinds() { # a room with slats before a lamp wall
    plain_room 4 3 2.6
    paint slat .5 0
    each 0 11 slat
    paint lamp 0 20
    sheet x .01 + .1 .1 2.9 2.5
    view 3.8 .3 1.4 0 1.8 1.3 70
}
slat() { block .2 .1 "$(of ".15 + .2 * $k")" .32 2.9 "$(of ".17 + .2 * $k")"; }
plain_room() { # X Y Z
    paint wall .6 0
    room 0 0 0 "$@"
}

grate() { # a lamp above bars
    plain_room 3 3 2.5
    paint bar .3 0
    each 0 13 bar
    paint lamp 0 30
    sheet z 2.45 - 1.1 1.1 1.9 1.9
    view .3 .3 1.5 2.2 2.2 .6 75
}
bar() { block "$(of "1 + .07 * $k")" 1 2.2 "$(of "1.04 + .07 * $k")" 2 2.24; }

# --- lamps ---

long_lamp() {
    plain_room 5 4 2.7
    paint lamp 0 80
    sheet z 2.6 - .5 1.98 4.5 2.02
    paint box .4 0
    block 2 1 .001 3 1.6 .7
    view .4 .4 1.5 3.5 3 .8 70
}

ball_lamp() { # SIDES: a ball of facets
    plain_room 4 3 2.5
    paint lamp 0 12
    at 2 1.5 1.4
    each 0 11 zone_out .25 "$1"
    view 3.6 .4 1.5 1 2 .8 70
}
zone_out() { # RADIUS SIDES: the k-th of twelve, seen from outside
    set -- "$1" "$2" $(of "sin($k * pi / 12)") $(of "cos($k * pi / 12)") \
        $(of "sin(($k + 1) * pi / 12)") $(of "cos(($k + 1) * pi / 12)")
    walk "$2" "$(of "$1 * $3")" "$(of "$1 * $4")" "$(of "$1 * $5")" "$(of "$1 * $6")"
}

balls() { # bodies of facets before a window of light
    plain_room 4 3 2.5
    paint ball .7 0
    at 1.2 1 .5
    each 0 11 zone_out .4 24
    at 2.6 2 .9
    each 0 11 zone_out .5 24
    paint lamp 0 10
    sheet z 2.45 - 1 1 1.6 1.6
    view 3.7 .3 1.5 1.2 1.7 .8 70
}

shaded_lamp() { # a disc 1 mm below a shade, and a plate 1 mm below the disc
    plain_room 3 3 2.5
    paint lamp 0 50
    at 1.5 1.5 2
    walk 24 .15 0 0 0
    paint back .5 0
    walk 24 0 0 .15 0
    paint shade .8 0
    sheet z 2.001 - 1.2 1.2 1.8 1.8
    sheet z 2.001 + 1.2 1.2 1.8 1.8
}

near_disc() { # a plate 1 mm above a lamp's disc, and nothing else near
    plain_room 3 3 2.5
    paint lamp 0 20
    at 1.5 1.5 1
    walk 24 0 0 .3 0
    paint plate .5 0
    sheet z 1.001 - 1.4 1.4 1.6 1.6
    paint back 0 0
    sheet z 1.002 + 1.4 1.4 1.6 1.6
}

bright_ceiling() { # lit by lamps that look up
    plain_room 5 4 2.7
    for x in 1 2.5 4; do
        paint lamp 0 60
        sheet z 2.2 + $x 1.8 "$(of "$x + .3")" 2.2
        paint back .5 0
        sheet z 2.199 - $x 1.8 "$(of "$x + .3")" 2.2
    done
    view .3 .3 1.4 4 3.5 1 70
}

cove() { # lamps behind a ledge: indirect light alone
    plain_room 5 4 2.8
    paint ledge .7 0
    block .15 0 2.4 .2 4 2.6
    block 0 0 2.38 .2 4 2.4
    paint lamp 0 100
    sheet z 2.41 + .03 .1 .1 3.9
    view 4.7 .4 1.4 .2 3 1.5 70
}

sconces() { # half shades on a wall, open above and below
    plain_room 4 3 2.6
    for x in 1 3; do
        paint shade .6 0
        block "$(of "$x - .15")" .15 1.5 "$(of "$x + .15")" .16 1.8
        block "$(of "$x - .16")" .001 1.5 "$(of "$x - .15")" .16 1.8
        block "$(of "$x + .15")" .001 1.5 "$(of "$x + .16")" .16 1.8
        paint lamp 0 100
        block "$(of "$x - .04")" .05 1.6 "$(of "$x + .04")" .1 1.7
    done
    view 3.7 2.7 1.4 .8 0 1.2 70
}

one_band() { # lamps of one band each
    paint wall .7,.6,.5 0
    room 0 0 0 4 3 2.5
    paint red 0 10,0,0
    sheet z 2.4 - .5 .5 .9 .9
    paint green 0 0,10,0
    sheet z 2.4 - 3 .5 3.4 .9
    paint blue 0 0,0,10
    sheet z 2.4 - 1.8 2.2 2.2 2.6
    paint box .5,.1,.1 0
    block 1.5 1 .001 2.3 1.6 .8
}

tiny_beside_large() {
    plain_room 4 3 2.5
    paint large 0 10
    sheet z 2.4 - 1 1 2 2
    paint tiny 0 1e5
    sheet z .5 - 3.2 2.2 3.205 2.205
}

# --- faces that are close ---

posters() { # in the plane of a wall, one on the other's edge
    plain_room 3 3 2.5
    paint poster .2 0
    sheet y 0 + .5 .8 1.5 1.8
    sheet x 0 + 1 .8 1.8 2
    paint lamp 0 10
    sheet z 2.4 - 1.2 1.2 1.8 1.8
    view 2.7 2.7 1.5 .3 .3 1.2 70
}

plates() { # 1e-5 apart
    plain_room 3 3 2.5
    paint upper .8 0
    sheet z 1 + 1 1 2 2
    sheet z .99999 - 1 1 2 2
    paint lower .5 0
    sheet z .99998 + 1 1 2 2
    sheet z .9 - 1 1 2 2
    paint lamp 0 10
    sheet z 2.4 - 1.2 1.2 1.8 1.8
}

three_rooms() { # sealed, that share planes of walls; two are dark
    paint lit .9 1
    room 0 0 0 1 1 1
    paint dark .9 0
    room 1 0 0 2 1 1
    room 0 1 0 1.5 2 1
}

back_to_back() { # E_LEFT E_RIGHT: sealed rooms that share a wall without thickness
    for side in "left 0 1 $1" "right 1 2 $2"; do
        set -- $side
        paint grey .5 0
        group "$1"
        room "$2" 0 0 "$3" 1 1
        paint "$1-lamp" 0 "$4"
        sheet z .85 - "$2.3" .3 "$2.7" .7
    done
    view 1.8 .8 .5 1 .2 .3 80
}

gapped() { # a room in which things hang and stand 2 mm apart; lamps fill recesses
    paint wall .7 0
    sheet z 0 + 0 0 4 4
    sheet x 0 + 0 0 4 2.5
    sheet x 4 - 0 0 4 2.5
    sheet y 0 + 0 0 4 2.5
    sheet y 4 - 0 0 4 2.5
    for x in "0 .8" ".8 1.4" "1.4 2.6" "2.6 3.2" "3.2 4"; do
        for y in "0 .8" ".8 1.4" "1.4 2.6" "2.6 3.2" "3.2 4"; do
            field_of_ceiling $x $y
        done
    done
    paint thing .4 0
    block .5 .002 1.3 1.3 .022 1.9
    block 1.6 .002 1.4 2 .022 1.7
    block .002 1 1.2 .022 2.2 2
    block 3.988 .4 1.3 3.998 .9 2
    block 3.698 1.5 1.4 3.998 2.1 1.8
    block 3.698 2.102 1.4 3.998 2.702 1.8
    block 1.2 1.4 .72 2.6 2.2 .75
    for x in 1.22 2.53; do
        block $x 1.42 .002 "$(of "$x + .05")" 1.47 .718
        block $x 2.13 .002 "$(of "$x + .05")" 2.18 .718
    done
    block 1.5 1.5 .752 1.71 1.8 .753
    block .8 1 .002 3 2.6 .01
    block 1 3.698 1 2 3.998 1.02
    block 1 3.698 1.3 2 3.998 1.32
    each 0 15 gapped_book
}
field_of_ceiling() { # X0 X1 Y0 Y1: a recess of 5 cm with a lamp where both are of .6 m
    case "$1 $3" in
    ".8 .8" | ".8 2.6" | "2.6 .8" | "2.6 2.6") ;;
    *) sheet z 2.5 - $1 $3 $2 $4
        return ;;
    esac
    sheet z 2.55 - $1 $3 $2 $4
    sheet x $1 + $3 2.5 $4 2.55
    sheet x $2 - $3 2.5 $4 2.55
    sheet y $3 + $1 2.5 $2 2.55
    sheet y $4 - $1 2.5 $2 2.55
    set -- $(of "$1 + .002") $(of "$2 - .002") $(of "$3 + .002") $(of "$4 - .002")
    paint lamp .5 20
    sheet z 2.51 - $1 $3 $2 $4
    paint housing .5 0
    sides $1 $3 2.51 $2 $4 2.548 x- x+ y- y+ z+
    paint wall .7 0
}
gapped_book() {
    block $(awk -v k=$k 'BEGIN {
        x = 1 + .037 * k; print x, 3.75, 1.022, x + .035, 3.998,
            1.24 + .03 * sin(7 * k) }')
}

contact() { # a block on a floor, one that floats
    plain_room 3 3 2.5
    paint box .8 0
    block .8 .8 0 1.4 1.4 1
    block 1.8 1.5 .005 2.3 2.1 .4
    paint lamp 0 10
    sheet z 2.4 - 1.2 1.2 1.8 1.8
    view 2.8 .2 1.4 1.2 1.6 .4 65
}

# make FOLDER/NAME ORDER WORD...: its files, by a function and its words.
make_scene() {
    out=$1 order=$2
    shift 2
    "$@" | awk -v name="$out" -v order="$order" -f tests/panel/shapes.awk
}
