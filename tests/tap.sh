# TAP for shell tests: `. tests/tap.sh` at the top, `tap_done` as the last line. The
# current directory is the top of the source tree; $work is an empty folder of the test's
# own.

: "${BUILD:=build/mpi}" "${MPIEXEC:=mpiexec}" "${MPICC:=mpicc}" "${CC:=cc}" \
    "${MAKE:=make}" "${PHR:=./phr}" "${IMGDIFF:=build/imgdiff}"
case $PHR in */*) ;; *) PHR=./$PHR ;; esac
tap_count=0
tap_failed=0
work=$BUILD/tests/$(basename "$0" .sh).work
rm -rf "$work"
mkdir -p "$work"

# tap STATUS NAME: one test, passed if STATUS is 0.
tap() {
    tap_count=$((tap_count + 1))
    if [ "$1" -eq 0 ]; then
        echo "ok $tap_count - $2"
    else
        tap_failed=$((tap_failed + 1))
        echo "not ok $tap_count - $2"
    fi
}

# check NAME COMMAND...: passed if the command succeeds.
check() {
    check_name=$1
    shift
    "$@"
    tap $? "$check_name"
}

# stat_of FILE KEY: the value of a top-level key of a --stats file.
stat_of() {
    sed -n "s/^  \"$2\": \"\{0,1\}\([^\",]*\)\"\{0,1\},\{0,1\}\$/\1/p" "$1"
}

# holds EXPRESSION: true if the awk expression is not 0.
holds() {
    awk "BEGIN { exit !($1) }"
}

# ply_head VERTICES FACES [PROPERTY...]: the header of a PLY file of text, whose faces
# have these properties, too.
ply_head() {
    printf 'ply\nformat ascii 1.0\nelement vertex %d\n' "$1"
    printf 'property float %s\n' x y z
    printf 'element face %d\nproperty list uchar int vertex_indices\n' "$2"
    shift 2
    [ $# -eq 0 ] || printf 'property float %s\n' "$@"
    echo end_header
}

# two_triangles: that face each other, a lamp and a wall: $work/two.obj.
two_triangles() {
    printf 'newmtl lamp\nKd 0.5 0.5 0.5\nKe 1 1 1\nnewmtl wall\nKd 0.5 0.5 0.5\n' \
        >"$work/two.mtl"
    echo mtllib two.mtl >"$work/two.obj"
    printf 'v %d %d %d\n' 0 0 0 1 0 0 0 1 0 0 0 1 1 0 1 0 1 1 >>"$work/two.obj"
    printf 'usemtl %s\nf %d %d %d\n' lamp 1 2 3 wall 4 6 5 >>"$work/two.obj"
}

# box X Y Z: OBJ of a room of this size at the origin, fronts inside: 8 vertices, 6 faces,
# the low one and the high one of z, of y, of x.
box() {
    awk -v x="$1" -v y="$2" -v z="$3" 'BEGIN {
        for (k = 0; k < 8; k++) print "v", k % 2 * x, int(k / 2) % 2 * y, int(k / 4) * z
        print "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4" }'
}

# proves: true in `make prove`, which tries more ranks, compilers and limits.
proves() {
    [ -n "${PROVE-}" ]
}

tap_done() {
    echo "1..$tap_count"
    [ "$tap_failed" -eq 0 ]
    exit
}
