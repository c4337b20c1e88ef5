# Circles of objects: an object points at another if it uses a symbol that the other
# defines, as nm sees them, over all folders. Objects that reach each other stand in a
# circle, and none may; nor may files of a folder that include each other. A header of
# beyond/ declares the functions of its own .c alone.

. tests/tap.sh

# symbols MODULE...: their symbols, "MODULE: VALUE TYPE NAME" or "MODULE: TYPE NAME".
symbols() {
    for module in "$@"; do
        nm "$BUILD/$module.o" | sed "s,^,$module: ,"
    done
}

# circles: of the symbols on its input, prints "circle A B ..." for each circle, and
# "A -> B: NAME ..." for each pair of it where A uses symbols of B.
circles() {
    awk '
    { module = substr($1, 1, length($1) - 1); name = $NF; type = $(NF - 1) }
    type ~ /^[ABCDGRSTVW]$/ { home[name] = module }
    type == "U" { user[++uses] = module; used[uses] = name }
    END {
        for (i = 1; i <= uses; i++) {
            from = user[i]
            to = home[used[i]]
            if (to == "" || to == from)
                continue
            reaches[from, to] = modules[from] = modules[to] = 1
            pairs[from, to] = pairs[from, to] " " used[i]
        }
        for (middle in modules)
            for (from in modules)
                if ((from, middle) in reaches)
                    for (to in modules)
                        if ((middle, to) in reaches)
                            reaches[from, to] = 1
        for (from in modules) {
            if (!((from, from) in reaches) || from in told)
                continue
            circle = ""
            for (to in modules)
                if ((from, to) in reaches && (to, from) in reaches) {
                    told[to]
                    circle = circle " " to
                }
            print "circle" circle
        }
        for (pair in pairs) {
            split(pair, end, SUBSEP)
            if ((end[2], end[1]) in reaches)
                print end[1] " -> " end[2] ":" pairs[pair]
        }
    }'
}

# includes: those of files of one folder, as symbols: each file defines its own name, and
# uses those that it includes.
includes() {
    find phr.c geom octree rad mpi io tools -name '*.[ch]' |
        xargs grep -H '^#include "' | sed 's/\.[ch]:#include "/ /; s/\.h"$//' |
        awk '{ from = $1; to = $2; sub(/[^\/]*$/, "", from); sub(/[^\/]*$/, "", to) }
            $1 != $2 && from == to { print $1 ": U " $2; print $2 ": 0 T " $2 }'
}

symbols $(find phr.c geom octree rad mpi io tools -name '*.c' | sed 's/\.c$//') \
    >"$work/symbols"
check "nm sees main() of phr.c" grep -q '^phr: .* T _*main$' "$work/symbols"
circles <"$work/symbols" | sort >"$work/circles"
sed -n 's/^circle/# circle:/p' "$work/circles"
sed -n '/->/s/^/    /p' "$work/circles"
check "no object stands in a circle" [ ! -s "$work/circles" ]

includes | circles >"$work/circles"
sed 's/^/# /' "$work/circles"
check "no file of a folder includes itself by way of others" [ ! -s "$work/circles" ]

# strangers HEADER...: the functions that these declare and the .c of their name has not.
strangers() {
    for header in "$@"; do
        sed -nE '/^(static|typedef|#|[^a-z])/d; s/^([a-z].*[ *])([a-z_0-9]+)\(.*/\2/p' \
            "$header" | while read -r name; do
            grep -qE "^${header%.h}: .* [TDR] _*$name\$" "$work/symbols" ||
                echo "# $header declares $name()"
        done
    done
}

strangers $(find rad/beyond mpi/beyond -name '*.h') | tee "$work/strangers"
check "headers of beyond/ declare functions of their own .c" [ ! -s "$work/strangers" ]
echo 'void circles_stranger(void);' >"$work/planted.h"
check "a function that is not there is found" \
    [ "$(strangers "$work/planted.h" | wc -l)" -eq 1 ]

# The test can fail: a circle of three, two of which reach a fourth.
printf '%s\n' 'a: U of_b' 'b: U of_c' 'c: U of_a' 'c: U of_d' 'b: U of_d' \
    'a: 0 T of_a' 'b: 0 T of_b' 'c: 0 D of_c' 'd: 0 T of_d' >"$work/planted"
check "a circle of three objects is found" \
    [ "$(circles <"$work/planted" | grep -cE '^circle( [abc]){3}$|->')" -eq 4 ]

tap_done
