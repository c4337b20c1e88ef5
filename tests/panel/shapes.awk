# Shapes, a line each, to OBJ: `awk -f shapes.awk -v name=NAME -v order=K/N`.
#
#   paint NAME RHO EMISSION [D]   the faces that follow; a number, or three as r,g,b; with
#                                 D they are panes
#   group NAME                    the same, of the paint there is, are another group
#   cells N                       sheets that follow are N x N of them
#   quad X Y Z, four times        corners counter-clockwise as seen from the front
#   sheet AXIS AT SIGN A B C D    the rectangle A..C x B..D across an axis, at AT on it;
#     [HOLE, four numbers]        A is of the first of the other axes; the front looks
#                                 along the axis (+) or against it (-)
#   room X Y Z X Y Z              a box seen from inside, by two corners
#   block X Y Z X Y Z             one seen from outside
#   walk SIDES R Z R Z [RINGS]    what the line from (R, Z) to (R, Z) sweeps around the z
#                                 axis; its front is to the left of the walk
#   at X Y Z                      where the axis of walks is
#   view EYE AT FOV               seven numbers: the camera, z up, or y if FOV is below 0
#
# Faces of one paint are a group of its name. `order`, K/N: faces in K N-ths of their
# number later come first. NAME.obj, NAME.mtl and NAME.view are written.

function number(x) { return sprintf("%.15g", x) }
function corner(x, y, z,   key) {
    key = "v " number(x) " " number(y) " " number(z)
    if (!(key in vertex)) {
        vertex[key] = ++vertices
        points[vertices] = key
    }
    return vertex[key]
}
# The corners 1 .. n of px, py, pz, those that meet once.
function face(n,   k, c, last, first, text, count) {
    for (k = 1; k <= n; k++) {
        c = corner(px[k], py[k], pz[k])
        if (c != last && c != first) {
            text = text " " c
            count++
            if (!first) first = c
        }
        last = c
    }
    if (count < 3) return
    faces[++face_count] = "f" text
    paint_of[face_count] = painted
    group_of[face_count] = grouped
}
function put(k, x, y, z) { px[k] = x; py[k] = y; pz[k] = z }
function across(axis, k, at, a, b) {
    if (axis == "x") put(k, at, a, b)
    else if (axis == "y") put(k, a, at, b)
    else put(k, a, b, at)
}
function cell(axis, at, turned, a, b, c, d) {
    across(axis, 1, at, a, b)
    across(axis, turned ? 4 : 2, at, c, b)
    across(axis, 3, at, c, d)
    across(axis, turned ? 2 : 4, at, a, d)
    face(4)
}
function sheet(axis, at, sign, a, b, c, d,   turned, i, k) {
    if (a >= c || b >= d) return
    turned = (sign == "-") != (axis == "y")
    for (i = 0; i < cells; i++)
        for (k = 0; k < cells; k++)
            cell(axis, at, turned, a + (c - a) * i / cells, b + (d - b) * k / cells,
                 a + (c - a) * (i + 1) / cells, b + (d - b) * (k + 1) / cells)
}
function box(inwards,   low, high) {
    low = inwards ? "+" : "-"; high = inwards ? "-" : "+"
    sheet("x", $2, low, $3, $4, $6, $7); sheet("x", $5, high, $3, $4, $6, $7)
    sheet("y", $3, low, $2, $4, $5, $7); sheet("y", $6, high, $2, $4, $5, $7)
    sheet("z", $4, low, $2, $3, $5, $6); sheet("z", $7, high, $2, $3, $5, $6)
}
function swept(k, r, angle, z) {
    put(k, ax + r * cos(angle), ay + r * sin(angle), az + z)
}
function ring(n, r0, z0, r1, z1,   k, a, b) {
    for (k = 0; k < n; k++) {
        a = 2 * pi * k / n
        b = k + 1 < n ? 2 * pi * (k + 1) / n : 0
        swept(1, r0, a, z0); swept(2, r1, a, z1); swept(3, r1, b, z1); swept(4, r0, b, z0)
        face(4)
    }
}
function bands(x,   part) {
    return split(x, part, ",") == 3 ? part[1] " " part[2] " " part[3] : x " " x " " x
}

BEGIN { pi = atan2(0, -1); cells = 1 }
$1 == "cells" { cells = $2 }
$1 == "paint" {
    painted = grouped = $2
    if (!known[$2]++)
        materials = materials "newmtl " $2 "\nKd " bands($3) "\nKe " bands($4) "\n" \
            (NF > 4 ? "d " $5 "\n" : "")
}
$1 == "group" { grouped = $2 }
$1 == "quad" {
    for (k = 1; k <= 4; k++)
        put(k, $(3 * k - 1), $(3 * k), $(3 * k + 1))
    face(4)
}
$1 == "sheet" && NF == 8 { sheet($2, $3, $4, $5, $6, $7, $8) }
$1 == "sheet" && NF == 12 {
    sheet($2, $3, $4, $5, $6, $7, $10); sheet($2, $3, $4, $5, $12, $7, $8)
    sheet($2, $3, $4, $5, $10, $9, $12); sheet($2, $3, $4, $11, $10, $7, $12)
}
$1 == "room" { box(1) }
$1 == "block" { box(0) }
$1 == "at" { ax = $2; ay = $3; az = $4 }
$1 == "walk" {
    rings = NF > 6 ? $7 : 1
    for (j = 0; j < rings; j++)
        ring($2, $3 + ($5 - $3) * j / rings, $4 + ($6 - $4) * j / rings,
             $3 + ($5 - $3) * (j + 1) / rings, $4 + ($6 - $4) * (j + 1) / rings)
}
$1 == "view" {
    up = $8 < 0 ? "0 1 0" : "0 0 1"
    printf "eye %s %s %s\nat %s %s %s\nup %s\nfov %s\n", $2, $3, $4, $5, $6, $7, up,
        $8 < 0 ? -$8 : $8 >(name ".view")
}
END {
    printf "%s", materials >(name ".mtl")
    own = name; sub(/.*\//, "", own)
    print "mtllib " own ".mtl" >(name ".obj")
    for (k = 1; k <= vertices; k++) print points[k] >(name ".obj")
    split(order, turn, "/")
    first = turn[1] ? int(face_count / turn[2]) * turn[1] : 0
    for (k = 0; k < face_count; k++) {
        at = (first + k) % face_count + 1
        head = "g " group_of[at] "\nusemtl " paint_of[at]
        if (head != last) print head >(name ".obj")
        last = head
        print faces[at] >(name ".obj")
    }
}
