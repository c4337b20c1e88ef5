# score: verdicts, digits and claims; bad input; planted faults, in a student's hemicube
# and in phr's light, are named.

. tests/tap.sh

score=$BUILD/score
list=docs/oracle/cases.csv
hemicube=build/oracle/hemicube

# scored STATUS ARGUMENTS...: the exit status; what is printed is in $work/out.
scored() {
    expected=$1
    shift
    "$score" "$@" >"$work/out" 2>"$work/errors"
    [ $? -eq "$expected" ]
}
# says TEXT: that is printed.
says() { grep -qF -- "$1" "$work/out" || { sed 's/^/# /' "$work/out"; false; }; }

check "the help fits on a screen" \
    [ "$("$score" --help | awk 'length > 90 { n += 99 } END { print NR + n }')" -le 40 ]

# --- verdicts: off by .0001, .00001 and .1 of .2 ---

cat >"$work/cases.csv" <<'END'
# id, quantity, right, uncertainty, unit, geometry, formula, source, slips
a,F 1 2,.2,0,1,words,text,book
b,B mean x,2,.01,W/m^2,words,text,book,forgotten=5;doubled=4
c,F 1 2,0,0,1,words,text,book
END
cat >"$work/right.csv" <<'END'
id,value,error
a, .20001 , 2e-5
b,2.005
c,0
END
check "right numbers" scored 0 "$work/cases.csv" "$work/right.csv"
check "digits that agree" says "digits: median 4.3, worst 2.3 (b)"
check "each has its line" [ "$(grep -c 'right$' "$work/out")" -eq 3 ]
printf 'a,.20001,5e-6\n' >"$work/claim.csv"
check "wrong by more than it says" scored 1 "$work/cases.csv" "$work/claim.csv"
printf 'a,.20001\n' >"$work/none.csv"
check "without a claim 1 % holds" scored 0 "$work/cases.csv" "$work/none.csv"
check "or what --within says" scored 1 --within 1e-5 "$work/cases.csv" "$work/none.csv"
printf 'b,2.0100001,0\n' >"$work/edge.csv"
check "beyond the uncertainty" scored 1 "$work/cases.csv" "$work/edge.csv"
printf 'b,2.0099,0\n' >"$work/edge.csv"
check "and within" scored 0 "$work/cases.csv" "$work/edge.csv"
printf 'a,nan\nb,inf,1\n' >"$work/nan.csv"
check "nan and inf are wrong" scored 1 "$work/cases.csv" "$work/nan.csv"
check "both" says "0 right, 2 wrong"
printf 'b,5.01\n' >"$work/slip.csv"
check "a slip that the case names" scored 1 "$work/cases.csv" "$work/slip.csv"
check "is named" says "likeliest slip: forgotten (explains 1 of 1"
printf 'a,1.4\n' >"$work/above.csv"
check "a factor above 1" scored 1 "$work/cases.csv" "$work/above.csv"
check "is named" says "likeliest slip: a row above 1"
printf 'a,.13\n' >"$work/odd.csv"
check "what no slip explains" scored 1 "$work/cases.csv" "$work/odd.csv"
check "is said" says "likeliest slip: none that is known"

# refused TEXT ARGUMENTS...: status 2 and a line with the text.
refused() {
    text=$1
    shift
    scored 2 "$@" && [ ! -s "$work/out" ] && grep -qF -- "$text" "$work/errors"
}
printf 'a,.2\nz,1\n' >"$work/bad.csv"
check "no such case" refused "bad.csv:2: no case is called 'z'" "$work/cases.csv" \
    "$work/bad.csv"
printf 'a,.2\na,.2\n' >"$work/bad.csv"
check "twice" refused "bad.csv:2: a is there twice" "$work/cases.csv" "$work/bad.csv"
printf 'a,two\n' >"$work/bad.csv"
check "no number" refused "bad.csv:1: bad number 'two'" "$work/cases.csv" "$work/bad.csv"
printf 'a,2,-1\n' >"$work/bad.csv"
check "a negative error" refused "below 0" "$work/cases.csv" "$work/bad.csv"
check "an empty file" refused "no results" "$work/cases.csv" /dev/null
printf 'a,F,1,0\n' >"$work/short.csv"
check "a short case" refused "short.csv:1: 4 fields" "$work/short.csv" "$work/right.csv"
check "an option" refused "unknown option" --all "$work/cases.csv" "$work/right.csv"
check "no polygons" refused "no polygons are in 'a'" --obj "$work/cases.csv" a

# --- the list ---

check "each case has what it should, and no comma too many" \
    awk -F, '!/^#/ && (NF < 8 || NF > 9 || $3 == "" || $7 == "" || $8 == "") {
        print "# " $1; bad = 1 } END { exit bad || NR < 250 }' $list
check "an exact copy of it is right to the last digit" sh -c "
    awk -F, '!/^#/ { print \$1 \",\" \$3 \",0\" }' $list >$work/copy.csv &&
    $score $list $work/copy.csv | grep -q ' 0 wrong'"

# --- factors by a hemicube ---

# planted FAULT SLIP: is named first.
planted() {
    $hemicube $list "$1" >"$work/$1.csv"
    scored 1 --within .1 $list "$work/$1.csv" && says "likeliest slip: $2"
}
check "a sound hemicube has no slip" planted none "none that is known"
check "pi" planted pi "pi missing"
check "A_i for A_j" planted area "A_i for A_j"
check "a cosine" planted cosine "a cosine missing"
check "visibility" planted centre "visibility from centre to centre"
check "rows scaled" planted row "row scaled to 1"
check "half of a lamp" planted half "half: one triangle"

# --- light by phr, with a lamp of other strength ---

. tests/panel/scenes.sh
make_scene "$work/squares" 0 facing 1 .5 1 0
# light FILE OPTIONS...: the mean radiosities of the scene.
light() {
    file=$1
    shift
    "$PHR" --quiet "$work/$file.obj" "$@" --report "$work/report"
    awk -F, '$1 == "object" { gsub(/"/, "", $2); print "squares." $2 "," $7 }' \
        "$work/report" >"$work/light.csv"
}
light squares
check "phr's light is right" scored 0 $list "$work/light.csv"
light squares --ke radiance
check "Ke as radiance" scored 1 $list "$work/light.csv"
check "is named" says "likeliest slip: a factor of pi: Ke"
awk '/^f/ && !cut { cut = 1; $NF = "" } { print }' "$work/squares.obj" >"$work/half.obj"
light half
check "half of the lamp" scored 1 $list "$work/light.csv"
check "is named" says "likeliest slip: half: one triangle"

tap_done
