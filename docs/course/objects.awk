# The mean radiosity of each object of a scene: an object is what "o" names or, where
# there is none, what "usemtl" names.
#
#     leaves SOLUTION.ply | awk -f docs/course/objects.awk SCENE.obj -
#
# Roots are the triangles of the file in order; a face of k corners has k - 2 of them.

NR == FNR {
    if ($1 == "o" || $1 == "g")
        name = $2
    if ($1 == "usemtl")
        material = $2
    if ($1 == "f")
        for (k = 3; k < NF; k++) {
            own = name == "" ? material : name
            object[roots++] = own
            if (!(own in area)) {
                area[own] = 0
                order[objects++] = own
            }
        }
    next
}
{
    ax = $6 - $3; ay = $7 - $4; az = $8 - $5
    bx = $9 - $3; by = $10 - $4; bz = $11 - $5
    x = ay * bz - az * by; y = az * bx - ax * bz; z = ax * by - ay * bx
    a = sqrt(x * x + y * y + z * z) / 2
    own = object[$1 + 0]
    area[own] += a
    power[own] += a * $2
}
END {
    for (i = 0; i < objects; i++)
        printf "%-10s %8.3f\n", order[i], power[order[i]] / area[order[i]]
}
