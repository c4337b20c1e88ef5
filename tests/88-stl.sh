# STL: text and binary files give the factors of the same OBJ; solids are groups; wrong
# files are refused with a line.

. tests/tap.sh

# boxes FORMAT: a unit cube from inside and a block in it.
boxes() {
    { echo g room; box 1 1 1; echo g block; box .5 .25 .125 | awk '
        $1 == "v" { $2 += .25; $3 += .25; $4 += .25 }
        $1 == "f" { for (k = 2; k <= NF; k++) $k -= 9; print "f", $4, $3, $2, $5; next }
        { print }'; } >"$work/boxes.obj"
    case $1 in obj) return ;; esac
    awk '$1 == "g" { if (name != "") print "endsolid"; name = $2; print "solid", name }
        $1 == "v" { at[++n] = $2 " " $3 " " $4 }
        function corner(k) { return k < 0 ? n + 1 + k : k }
        function face(a, b, c) {
            print "facet normal 0 0 0\nouter loop"
            print "vertex", at[corner(a)]; print "vertex", at[corner(b)]
            print "vertex", at[corner(c)]; print "endloop\nendfacet"
        }
        $1 == "f" { for (k = 4; k <= NF; k++) face($2, $(k - 1), $k) }
        END { print "endsolid" }' "$work/boxes.obj" >"$work/boxes.stl"
}
boxes stl
"$BUILD/viewfactors" --quiet "$work/boxes.obj" >"$work/obj.csv"
"$BUILD/viewfactors" --quiet "$work/boxes.stl" >"$work/stl.csv" 2>"$work/errors"
check "text: the factors of the OBJ" cmp "$work/obj.csv" "$work/stl.csv"
check "solids are bodies" grep -q '^room,block,' "$work/stl.csv"
sed 's/^solid.*/solid/' "$work/boxes.stl" >"$work/nameless.stl"
"$BUILD/viewfactors" --quiet "$work/nameless.stl" >"$work/nameless.csv"
check "without names, too" grep -q '^solid 1,solid 2,' "$work/nameless.csv"

# The same in binary; its first bytes are "solid".
if command -v python3 >/dev/null; then
    python3 - "$work/boxes.stl" "$work/binary.STL" <<'END'
import struct, sys
v = [list(map(float, l.split()[1:])) for l in open(sys.argv[1]) if l.startswith('vertex')]
out = open(sys.argv[2], 'wb')
out.write(b'solid things'.ljust(80) + struct.pack('<I', len(v) // 3))
for k in range(0, len(v), 3):
    out.write(struct.pack('<12fH', 0, 0, 0, *v[k], *v[k + 1], *v[k + 2], 0))
END
    "$BUILD/viewfactors" --quiet "$work/binary.STL" >"$work/binary.csv"
    sed 's/^g .*//' "$work/boxes.obj" >"$work/one.obj"
    "$BUILD/viewfactors" --quiet "$work/one.obj" >"$work/one.csv"
    check "binary: those of one group" cmp "$work/one.csv" "$work/binary.csv"
    head -c 300 "$work/binary.STL" >"$work/cut.stl"
else
    tap 0 "binary # SKIP there is no python3"
fi
check "phr, too" "$PHR" --quiet --epsilon 1e-1 --final-gather 0 "$work/boxes.stl" \
    -o "$work/boxes.ply"

# refused TEXT: of $work/bad.stl.
refused() {
    "$BUILD/viewfactors" "$work/bad.stl" >"$work/out" 2>"$work/errors"
    [ $? -eq 2 ] && [ ! -s "$work/out" ] && grep -qF -- "bad.stl:$1" "$work/errors" &&
        [ "$(wc -l <"$work/errors")" -eq 1 ]
}
change() { sed "$1" "$work/boxes.stl" >"$work/bad.stl"; }
change '4s/$/ 1e999/; 4s/.*/vertex 0 zero 0/'
check "no number" refused "4: bad number 'zero'"
change '4s/.*/vertex 0 0/'
check "two coordinates" refused "4: vertex has 2 coordinates instead of 3"
change '4d'
check "two corners" refused "7: a face of 2 corners"
change '4p'
check "four corners" refused "7: a face of four corners"
change '3s/.*/outer space/; 2s/.*/lamp/'
check "another word" refused "2: 'lamp' is no word of STL"
change '1d'
check "no solid" refused " not an STL file"
echo "solid nothing" >"$work/bad.stl"
check "no faces" refused " no faces"
if [ -s "$work/cut.stl" ]; then
    cp "$work/cut.stl" "$work/bad.stl"
    check "a binary file that is cut off" refused ""
fi

tap_done
