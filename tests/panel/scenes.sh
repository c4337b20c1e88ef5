# The scenes of the panel: a function each, whose shapes tests/panel/shapes.awk makes OBJ
# of. z is up, lengths are metres, radiosities W/m^2; a paint's name is that of its group,
# which truths are told about.
#
#     . tests/panel/scenes.sh
#     make_scene FOLDER/NAME ORDER FUNCTION WORD...    NAME.obj, .mtl and perhaps .view

for shape in paint group quad sheet room block walk at view; do
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

groove() { # DEGREES RHO E: two walls of 60 unit squares, the middle ten apart
    x=$(of "cos($1 * pi / 180)") z=$(of "sin($1 * pi / 180)")
    for part in "end 0 25" "middle 25 35" "end 35 60"; do
        set -- "$1" "$2" "$3" $part
        paint "$4" "$2" "$3"
        k=$5
        while [ "$k" -lt "$6" ]; do
            sheet z 0 + 0 $k 1 $((k + 1))
            quad 0 $k 0 0 $((k + 1)) 0 "$x" $((k + 1)) "$z" "$x" $k "$z"
            k=$((k + 1))
        done
    done
}

two_squares() { # HEIGHT RHO: the lower one emits
    paint lamp "$2" 1
    sheet z 0 + 0 0 1 1
    paint other "$2" 0
    sheet z "$1" - 0 0 1 1
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

slivers() { # to 1 : 1e6, both sides
    paint all .99 .01
    room 0 0 0 1 1 1
    for z in .51 .5001 .500001; do
        quad .03 .05 .5 .93 .96 .5 .93 .96 $z .03 .05 .5
        quad .03 .05 .5 .03 .05 .5 .93 .96 $z .93 .96 .5
    done
}

pillar() { # RHO: from floor to ceiling in a corner, without the faces at the walls
    shell "$1"
    sheet x .5 + 0 0 .5 3
    sheet y .5 + 0 0 .5 3
}
step() { # RHO: a body that touches three walls and the floor, with all its faces
    shell "$1"
    block 0 0 0 4 1 .3
}
beam() { # RHO: from wall to wall below the ceiling
    shell "$1"
    block 0 1.5 2.6 4 1.9 3
}
shell() {
    paint lamp 0 10
    sheet z 2 - 1.8 1.6 2.2 2
    paint lamp-back "$1" 0
    sheet z 2 + 1.8 1.6 2.2 2
    paint all "$1" 0
    room 0 0 0 4 3.5 3
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

opening() { # THICK Y0 Z0 Y1 Z1: between a lit room and a dark one of 3 m
    far=$(of "3 + $1") end=$(of "6 + $1")
    paint dark .7 0
    sheet z 0 + "$far" 0 "$end" 3
    sheet z 3 - "$far" 0 "$end" 3
    sheet y 0 + "$far" 0 "$end" 3
    sheet y 3 - "$far" 0 "$end" 3
    sheet x "$end" - 0 0 3 3
    sheet x "$far" + 0 0 3 3 "$2" "$3" "$4" "$5"
    paint lit .7 0
    sheet z 0 + 0 0 3 3
    sheet z 3 - 0 0 3 3 1.2 1.2 1.8 1.8
    sheet y 0 + 0 0 3 3
    sheet y 3 - 0 0 3 3
    sheet x 0 + 0 0 3 3
    sheet x 3 - 0 0 3 3 "$2" "$3" "$4" "$5"
    sheet z "$3" + 3 "$2" "$far" "$4"
    sheet z "$5" - 3 "$2" "$far" "$4"
    sheet y "$2" + 3 "$3" "$far" "$5"
    sheet y "$4" - 3 "$3" "$far" "$5"
    paint lamp 0 100
    sheet z 3 - 1.2 1.2 1.8 1.8
}

window() { # WIDTH HEIGHT: a room of 5 x 4 x 2.7 m, ground and facades below a sky
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
    view .4 3.6 1.6 3 .3 1 65
}

slabs() { # of 10 cm that no light can enter, below a sky
    paint slab .7 0
    block -2.3 -2.3 -.1 2.3 2.3 0
    block -2.3 -2.3 2.6 2.3 2.3 2.7
    block -2.1 -2.1 0 2.1 -2 2.6
    block -2.1 2 0 2.1 2.1 2.6
    block -2.1 -2 0 -2 2 2.6
    block 2 -2 0 2.1 2 2.6
    paint inside .7 0
    block -.5 -.5 .5 .5 .5 1
    paint sky 0 1
    room -8 -8 -.2 8 8 8
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
